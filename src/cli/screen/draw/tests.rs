//! The screen as it looks, cell by cell, at the sizes it must look right at.

use ratatui::Terminal;
use ratatui::backend::TestBackend;

use super::{View, draw};
use crate::cli::screen::dialogue::Dialogue;
use crate::cli::screen::keys::Key;
use crate::cli::screen::model::Model;
use crate::plan::Interval;
use crate::record::{Event, EventKind};
use crate::rig::Wish;
use crate::run::StepReport;
use crate::run::testing::empty_plan;

/// A blow in the middle: a sine that dies away.
fn model() -> Model {
    let mut plan = empty_plan();
    plan.title = "Pendulum against a GFRP beam\u{1b}[2J".to_owned();
    plan.limits.displacement = Interval { low: -2e-3, high: 25e-3 };
    plan.limits.force = Interval { low: -2e3, high: 7e3 };
    plan.limits.speed = Interval { low: 0.0, high: 2e-3 };
    plan.limits.increment = Interval { low: 0.0, high: 2e-3 };
    plan.limits.tracking_error = Interval { low: 0.0, high: 0.05e-3 };
    plan.limits.energy_error = Interval { low: 0.0, high: 0.05 };
    plan.limits.tracking_energy_error = Interval { low: 0.0, high: 0.05 };
    let mut model = Model::new(&plan, true);
    model.procedure_started("hit", "impact", Some(600));
    for step in 1..=240_u32 {
        let time = f64::from(step) * 1e-4;
        let displacement = 20e-3 * (-20.0 * time).exp() * (130.0 * time).sin();
        model.step_done(&StepReport {
            step: step.into(),
            time,
            command: displacement + 2e-6,
            displacement,
            velocity: None,
            acceleration: None,
            force: 3e5 * displacement,
            speed: Some(2e-3),
            energy_error: Some(0.012),
            others: Vec::new(),
            tracking: None,
            tracking_energy_error: Some(-0.013),
        });
    }
    for (step, kind, text) in [
        (50_u32, EventKind::Inspection, "inspection every 50 steps: nothing to see (A. Engineer)"),
        (120, EventKind::Note, "creaking at the left bearing\u{202e} (A. Engineer)"),
        (200, EventKind::Note, "paused (A. Engineer)"),
    ] {
        let time = f64::from(step) * 2.0;
        let step = Some(u64::from(step));
        model.event(&Event { time, procedure: Some("hit".into()), step, kind, text: text.to_owned() });
    }
    model
}

fn picture(size: (u16, u16), dialogue: &Dialogue, model: &Model) -> String {
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    let view = View { model, dialogue, wish: &Wish::default(), elapsed: 83, color: false };
    terminal.draw(|frame| draw(frame, &view)).unwrap();
    let picture = terminal.backend().to_string();
    assert!(!picture.contains(['\u{1b}', '\u{202e}']), "nothing of a plan steers the terminal");
    picture
}

#[test]
fn a_run_at_80_by_24() {
    insta::assert_snapshot!(picture((80, 24), &Dialogue::new(None), &model()));
}

#[test]
fn a_run_at_120_by_40() {
    insta::assert_snapshot!(picture((120, 40), &Dialogue::new(None), &model()));
}

#[test]
fn a_run_at_60_by_16() {
    insta::assert_snapshot!(picture((60, 16), &Dialogue::new(None), &model()));
}

#[test]
fn a_run_that_has_not_begun_and_has_no_limits() {
    insta::assert_snapshot!(picture((80, 24), &Dialogue::new(None), &Model::new(&empty_plan(), false)));
}

#[test]
fn a_question_at_80_by_24() {
    let mut dialogue = Dialogue::new(None);
    dialogue.ask("Look at the bolted joints before the blow, and at the paint of the left bearing: \u{202e}cracks");
    let asked = picture((80, 24), &dialogue, &model());
    for key in "yno crack".chars() {
        dialogue.press(Key::Character(key), &Wish::default());
    }
    let remarked = picture((80, 24), &dialogue, &model());
    insta::assert_snapshot!(format!("{asked}\n{remarked}"));
}

#[test]
fn every_size_is_drawn() {
    let mut dialogue = Dialogue::new(None);
    dialogue.ask("look");
    let model = model();
    for size in [(1, 1), (20, 5), (59, 16), (60, 15), (61, 17), (300, 100)] {
        let drawn = picture(size, &dialogue, &model);
        assert_eq!(drawn.lines().count(), usize::from(size.1), "{size:?}");
    }
}

/// Whatever a plan, a person or a rig says, in every place of the screen where it is shown.
#[test]
fn hostile_labels_stand_where_they_are_shown() {
    let labels: Vec<String> = serde_json::from_str(include_str!("../../../../tests/hostile_labels.json")).unwrap();
    for label in labels {
        let mut hostile = model();
        (hostile.title, hostile.rig) = (label.clone(), label.clone());
        if let Some(running) = &mut hostile.procedure {
            running.name = label.clone();
        }
        for event in &mut hostile.events {
            (event.text, event.procedure) = (label.clone(), Some(label.clone()));
        }
        let mut dialogue = Dialogue::new(Some(label.clone()));
        dialogue.ask(&label);
        let picture = picture((120, 40), &dialogue, &hostile);
        assert!(!picture.chars().any(|c| crate::inert::steers(c) && c != '\n'), "{label:?}:\n{picture}");
    }
}
