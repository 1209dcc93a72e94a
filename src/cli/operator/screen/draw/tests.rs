//! The screen cell by cell, at the sizes that must be correct.

use std::time::Duration;

use ratatui::Terminal;
use ratatui::backend::TestBackend;

use super::{View, draw};
use crate::commands::explain_plan::dry_rig::Reach;
use crate::operator::dialogue::Dialogue;
use crate::operator::dialogue::keys::Key;
use crate::operator::question::{After, Question, QuestionKind, Stay};
use crate::operator::screen::curve::Curves;
use crate::operator::screen::model::Model;
use crate::operator::shown::Shown;

use psd::run::{Extent, Motion, StepReport};
use psd_plan::Interval;
use psd_plan::record::{Event, EventKind};
use psd_rig::{Feedback, Identity, StopRequest};
use psd_testing::plans::empty_plan;

/// An impact in progress: a decaying sine.
fn model() -> Model {
    let mut plan = empty_plan();
    plan.title = "Pendulum against a GFRP beam\u{1b}[2J".to_owned();
    plan.limits.displacement = Interval {
        low: -2e-3,
        high: 25e-3,
    };
    plan.limits.force = Interval {
        low: -2e3,
        high: 7e3,
    };
    plan.limits.speed = Interval {
        low: 0.0,
        high: 2e-3,
    };
    plan.limits.increment = Interval {
        low: 0.0,
        high: 2e-3,
    };
    plan.limits.tracking_error = Interval {
        low: 0.0,
        high: 0.05e-3,
    };
    plan.limits.energy_error = Interval {
        low: 0.0,
        high: 0.05,
    };
    plan.limits.tracking_energy_error = Interval {
        low: 0.0,
        high: 0.05,
    };
    let mut model = Model::new(&plan, true);
    model.procedure_started("hit", "impact", Some(600));
    for step in 1..=240_u32 {
        let time = f64::from(step) * 1e-4;
        let displacement = 20e-3 * (-20.0 * time).exp() * (130.0 * time).sin();
        let (command, force) = (displacement + 2e-6, 3e5 * displacement);
        model.step_done(&StepReport {
            speed: Some(2e-3),
            energy_error: Some(0.012),
            tracking_energy_error: Some(-0.013),
            ..StepReport::of_readings(step.into(), time, &[command], &[displacement], &[force])
        });
    }
    for (step, kind, text) in [
        (
            50_u32,
            EventKind::Inspection,
            "inspection every 50 steps: nothing to see (A. Engineer)",
        ),
        (
            120,
            EventKind::Note,
            "creaking at the left bearing\u{202e} (A. Engineer)",
        ),
        (200, EventKind::Note, "paused (A. Engineer)"),
    ] {
        let time = f64::from(step) * 2.0;
        let step = Some(u64::from(step));
        model.event(&Event {
            time,
            procedure: Some("hit".into()),
            step,
            kind,
            text: text.to_owned(),
        });
    }
    model
}

fn picture(size: (u16, u16), dialogue: &Dialogue, model: &Model) -> String {
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    let now = Duration::from_secs(83);
    let view = View {
        model,
        dialogue,
        stop_request: &StopRequest::default(),
        now,
        color: false,
    };
    terminal.draw(|frame| draw(frame, &view)).unwrap();
    let picture = terminal.backend().to_string();
    assert!(
        !picture.contains(['\u{1b}', '\u{202e}']),
        "nothing of a plan steers the terminal"
    );
    picture
}

#[test]
fn a_run_at_80_by_24() {
    insta::assert_snapshot!(picture((80, 24), &Dialogue::new(None), &model()));
}

#[test]
fn numbers_of_a_specimen_at_a_scale_are_said_to_be_those_of_the_rig() {
    let scaled = Model {
        shown: Shown {
            of_rig: " on the rig",
            ..Shown::default()
        },
        ..model()
    };
    let text = picture((100, 24), &Dialogue::new(None), &scaled);
    for said in [
        " X on the rig 0.2672 mm",
        "R on the rig (kN) over X",
        " Limits on the rig ",
    ] {
        assert!(text.contains(said), "{text}");
    }
}

#[test]
fn an_axial_force_is_beside_the_lateral_one() {
    let mut loaded = model();
    let last = loaded.last.clone().unwrap();
    loaded.step_done(&StepReport {
        axial_force: Some(262_500.0),
        ..last
    });
    let text = picture((120, 40), &Dialogue::new(None), &loaded);
    assert!(text.contains("R 80.16 N   axial force 262.5 kN"), "{text}");
}

/// The measured curves grow over the predicted ones, and the time left is beside the clock.
#[test]
fn a_run_with_a_prediction() {
    let mut predicted = Curves::default();
    for step in 0..=700_u32 {
        let time = f64::from(step) * 1e-4;
        let displacement = 22e-3 * (-20.0 * time).exp() * (125.0 * time).sin();
        let force = 3.0e5 * displacement;
        let step = StepReport::of_readings(
            step.into(),
            time,
            &[displacement],
            &[displacement],
            &[force],
        );
        predicted.push(&step, &Shown::default());
    }
    let model = Model {
        predicted: [Reach {
            integrates: true,
            ..Reach::of("hit", predicted)
        }]
        .into(),
        left: Some(Duration::from_secs(3729)),
        ..model()
    };
    insta::assert_snapshot!(picture((100, 30), &Dialogue::new(None), &model));
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
    insta::assert_snapshot!(picture(
        (80, 24),
        &Dialogue::new(None),
        &Model::new(&empty_plan(), false)
    ));
}

/// The open question was drawn some time ago.
fn read(dialogue: &mut Dialogue) {
    dialogue.drawn(dialogue.appeared, Duration::ZERO);
}

fn press(dialogue: &mut Dialogue, keys: &str) {
    for key in keys.chars() {
        read(dialogue);
        let key = if key == '\n' {
            Key::Enter
        } else {
            Key::Character(key)
        };
        dialogue.press(key, Duration::from_secs(83), &StopRequest::default());
    }
}

fn motion() -> Motion {
    let mut plan = empty_plan();
    plan.rig.name = "bench".to_owned();
    plan.limits.displacement = Interval {
        low: -2e-3,
        high: 25e-3,
    };
    plan.limits.force = Interval {
        low: -2e3,
        high: 7e3,
    };
    plan.limits.speed = Interval {
        low: 0.0,
        high: 2e-3,
    };
    let identity = Identity {
        name: "bench".to_owned(),
        model: "psd simulate".to_owned(),
        serial: "STAND-IN-1".to_owned(),
        firmware: "1".to_owned(),
        boot: None,
        simulated: true,
    };
    let expected = Extent {
        travel: Some(Interval {
            low: -0.2e-3,
            high: 12.4e-3,
        }),
        force: Some(Interval {
            low: -61.0,
            high: 3.72e3,
        }),
        speed: Some(2e-3),
        duration: Some(93.0),
    };
    let does =
        "it MOVES by 0.1 mm and back (pre-test check), then MOVES as the plan specifies".to_owned();
    Motion {
        expected,
        ..Motion::of(&plan, identity, does)
    }
}

#[test]
fn a_question_at_80_by_24() {
    let mut dialogue = Dialogue::new(None);
    let note = "Look at the bolted joints before the blow, and at the paint of the left bearing: \u{202e}cracks";
    dialogue.ask(&Question::look(note, None));
    read(&mut dialogue);
    let asked = picture((80, 24), &dialogue, &model());
    press(&mut dialogue, "ino crack");
    let remarked = picture((80, 24), &dialogue, &model());
    insta::assert_snapshot!(format!("{asked}\n{remarked}"));
}

#[test]
fn a_release_states_what_will_move_and_requires_its_word() {
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    let before = Model {
        simulated: false,
        ..Model::new(&empty_plan(), false)
    };
    dialogue.ask(&Question::of(QuestionKind::Release, &motion()));
    let unread = picture((80, 24), &dialogue, &before);
    read(&mut dialogue);
    let read = picture((80, 24), &dialogue, &before);
    press(&mut dialogue, "yes\n");
    let unclear = picture((60, 16), &dialogue, &before);
    insta::assert_snapshot!(format!("{unread}\n{read}\n{unclear}"));
}

#[test]
fn an_inspection_of_a_real_rig_states_that_it_will_move_on() {
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    dialogue.ask(&Question::look(
        "Look at the bolted joints",
        Some(&motion()),
    ));
    press(&mut dialogue, "ino crack\nREL");
    insta::assert_snapshot!(picture((120, 40), &dialogue, &model()));
}

#[test]
fn a_held_rig_stays_on_the_screen_with_what_may_be_done() {
    let mut held = model();
    for (kind, text) in [
        (EventKind::Hold, "stopped on request"),
        (EventKind::Held, "held at 7.630 mm, 2.288 kN"),
    ] {
        held.event(&Event {
            time: 400.0,
            procedure: Some("hit".into()),
            step: Some(240),
            kind,
            text: text.to_owned(),
        });
    }
    held.live = Some(Feedback {
        number: 7,
        displacement: vec![7.63e-3],
        force: vec![2288.0],
    });
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    dialogue.ask_to_unload(&Question::of(QuestionKind::Unload, &motion()));
    read(&mut dialogue);
    let menu = picture((80, 24), &dialogue, &held);
    press(&mut dialogue, "r");
    let reason = picture((80, 24), &dialogue, &held);
    insta::assert_snapshot!(format!("{menu}\n{reason}"));
}

#[test]
fn nothing_is_shown_beside_a_rig_that_may_still_move() {
    let mut lost = model();
    let text = "NOT CONFIRMED HELD (rig bench, actuator: connection lost): IT MAY STILL BE MOVING. Press the emergency stop";
    lost.event(&Event {
        time: 400.0,
        procedure: None,
        step: None,
        kind: EventKind::NotHeld,
        text: text.to_owned(),
    });
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    assert_eq!(dialogue.stay(After::NotHeld), Stay::Wait);
    read(&mut dialogue);
    let picture = picture((80, 24), &dialogue, &lost);
    assert!(
        !picture.contains("resume") && !picture.contains("Displacement"),
        "{picture}"
    );
    insta::assert_snapshot!(picture);
}

#[test]
fn no_number_that_ends_a_run_is_cut_off() {
    for width in [60, 80, 90, 120] {
        let picture = picture((width, 24), &Dialogue::new(None), &model());
        let numbers = picture.lines().nth(2).unwrap();
        assert!(numbers.contains("−1.30 %"), "{width}: {numbers}");
    }
}

#[test]
fn every_size_is_drawn() {
    let mut dialogue = Dialogue::new(None);
    dialogue.ask(&Question::look("look", None));
    let model = model();
    for size in [(1, 1), (20, 5), (59, 16), (60, 15), (61, 17), (300, 100)] {
        let drawn = picture(size, &dialogue, &model);
        assert_eq!(drawn.lines().count(), usize::from(size.1), "{size:?}");
    }
}

/// Hostile text of a plan, an operator or a rig, at every position of the screen that shows it.
#[test]
fn hostile_labels_are_text_where_they_are_shown() {
    let labels: Vec<String> =
        serde_json::from_str(include_str!("../../../../../tests/hostile_labels.json")).unwrap();
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
        dialogue.ask(&Question::look(&label, None));
        let picture = picture((120, 40), &dialogue, &hostile);
        assert!(
            !picture
                .chars()
                .any(|c| psd_text::sanitize::is_control_like(c) && c != '\n'),
            "{label:?}:\n{picture}"
        );
    }
}
