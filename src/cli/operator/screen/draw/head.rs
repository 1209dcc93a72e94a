//! The first three lines, with the state of the run, and the last line, with the effect of the keys.

use ratatui::Frame;
use ratatui::layout::{Alignment, Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};

use super::{View, fitted, shown};
use crate::operator::dialogue::{Typing, What};
use crate::operator::pace::clock;
use crate::operator::question::{After, QuestionKind};
use crate::operator::screen::model::{Ended, INSPECT};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, significant};

/// Title and rig; state, procedure, step and time; the last numbers.
pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, area: Rect) {
    let [title, state, numbers] = Layout::vertical([Constraint::Length(1); 3]).areas(area);
    let rig = if view.model.simulated {
        "simulated rig"
    } else {
        "REAL RIG"
    };
    let rig = format!("{rig} {} ", fitted(&shown(&view.model.rig), 24));
    sides(
        frame,
        title,
        title_line(view, title.width.into(), &rig),
        Line::raw(rig.clone()),
    );
    let left = view.model.left.filter(|_| view.model.ended.is_none());
    let left = left.map_or_else(String::new, |left| {
        format!("about {} left  ", clock(left.as_secs()))
    });
    let clock = format!("  {left}{} ", clock(view.now.as_secs()));
    sides(frame, state, state_line(view), Line::raw(clock));
    frame.render_widget(Line::raw(numbers_line(view, numbers.width.into())), numbers);
}

fn sides(frame: &mut Frame<'_>, area: Rect, left: Line<'_>, right: Line<'_>) {
    let width = u16::try_from(right.width()).unwrap_or(u16::MAX);
    let [start, end] =
        Layout::horizontal([Constraint::Min(0), Constraint::Length(width)]).areas(area);
    frame.render_widget(left, start);
    frame.render_widget(right.alignment(Alignment::Right), end);
}

fn title_line<'a>(view: &View<'_>, width: usize, rig: &str) -> Line<'a> {
    let room = width.saturating_sub(rig.chars().count() + 3);
    Line::styled(
        format!(" {}", fitted(&shown(&view.model.title), room)),
        Style::new().add_modifier(Modifier::BOLD),
    )
}

fn state_line<'a>(view: &View<'_>) -> Line<'a> {
    let (word, color) = state(view);
    let badge = Span::styled(
        format!(" {word} "),
        view.paint(color)
            .add_modifier(Modifier::BOLD | Modifier::REVERSED),
    );
    let mut words = String::new();
    if let Some(running) = &view.model.procedure {
        words = format!(
            "  {}, {}",
            fitted(&shown(&running.name), 20),
            running.keyword
        );
        let step = view.model.last.as_ref().map_or(0, |last| last.step);
        match running.steps {
            _ if running.keyword == INSPECT => {}
            Some(steps) if steps > 0 => {
                words = format!("{words}   step {step} of {}", steps.max(step));
            }
            _ if step > 0 => words = format!("{words}   step {step}"),
            _ => {}
        }
    }
    if let Some((done, of)) = view.model.study {
        words = format!("{words}   uncertainty: {done} of {of} runs re-integrated");
        return Line::from(vec![Span::raw(" "), badge, Span::raw(words)]);
    }
    let moving = view
        .model
        .procedure
        .as_ref()
        .is_none_or(|running| running.keyword != INSPECT);
    if let Some(last) = view.model.last.as_ref().filter(|_| moving) {
        words = format!("{words}   t {}", readable(last.time, Dimension::TIME));
    }
    Line::from(vec![Span::raw(" "), badge, Span::raw(words)])
}

/// One word for the state; the most severe state has priority.
fn state(view: &View<'_>) -> (&'static str, Color) {
    if let Some(ended) = view.model.ended {
        match ended {
            Ended::Held => ("HELD", Color::Yellow),
            Ended::NotHeld => ("NOT CONFIRMED HELD: EMERGENCY STOP", Color::Red),
            Ended::Unloading => ("UNLOADING: THE RIG MOVES", Color::Red),
        }
    } else if view.stop_request.hold_requested() {
        ("HOLDING", Color::Red)
    } else if view.stop_request.end_requested() {
        ("STOPPING", Color::Red)
    } else if let Some(question) = &view.dialogue.question {
        (
            if question.kind == QuestionKind::Release {
                "NOT RELEASED YET"
            } else {
                "INSPECTION"
            },
            Color::Yellow,
        )
    } else if view.dialogue.paused {
        (
            if view.dialogue.waiting {
                "PAUSED"
            } else {
                "PAUSING"
            },
            Color::Yellow,
        )
    } else {
        (view.model.by_hand.unwrap_or("RUNNING"), Color::Green)
    }
}

/// The last numbers, with full names if they fit.
fn numbers_line(view: &View<'_>, width: usize) -> String {
    let feedback = view.model.feedback();
    if feedback.is_empty() {
        return String::new();
    }
    let line = |words: [&str; 3], between: &str| {
        format!(" {}", numbers(view, &feedback, words).join(between))
    };
    let long = line(["tracking error", "energy error", "tracking energy"], "   ");
    let short = line(["error", "energy", "Et"], "   ");
    if long.chars().count() <= width {
        long
    } else if short.chars().count() <= width {
        short
    } else {
        line(["e", "E", "Et"], "  ")
    }
}

/// The numbers by name. `words`: names of the tracking error, the energy error, and the energy error of tracking.
fn numbers(
    view: &View<'_>,
    feedback: &[(f64, f64)],
    [tracking, energy, tracking_energy]: [&str; 3],
) -> Vec<String> {
    let shown = &view.model.shown;
    let names = shown.names(feedback.len());
    let highest = feedback
        .last()
        .map_or(0.0, |(displacement, _)| *displacement);
    let shown_force = shown.force(feedback.iter().map(|(_, force)| *force));
    let (displacement, force) = (view.model.on_the_rig(&names.displacement), names.force);
    let mut words = vec![
        format!("{displacement} {}", readable(highest, Dimension::LENGTH)),
        format!("{force} {}", readable(shown_force, Dimension::FORCE)),
    ];
    let last = view.model.last.as_ref();
    if let Some(force) = last.and_then(|last| last.axial_force) {
        words.push(format!("axial force {}", readable(force, Dimension::FORCE)));
    }
    if let Some(error) = view.model.tracking_error() {
        // A rounding error is not a tracking error.
        let error = if error.abs() < 1e-12 { 0.0 } else { error };
        words.push(format!("{tracking} {}", readable(error, Dimension::LENGTH)));
    } else if view.model.open_loop {
        words.push("open loop".to_owned());
    }
    if let Some(error) = last.and_then(|last| last.energy_error) {
        words.push(format!("{energy} {}", percent(error)));
    }
    if let Some(share) = last.and_then(|last| last.tracking_energy_error) {
        words.push(format!("{tracking_energy} {}", percent(share)));
    }
    words
}

/// A fraction in readable form; rounding noise is shown as 0.
pub fn percent(fraction: f64) -> String {
    if fraction.abs() < 1e-8 {
        "0 %".to_owned()
    } else {
        format!("{} %", significant(fraction * 100.0, 3).replace('-', "−"))
    }
}

/// The last line: the keys that have an effect now.
pub fn keys<'a>(view: &View<'_>) -> Line<'a> {
    let dialogue = view.dialogue;
    let answering = dialogue
        .typing
        .as_ref()
        .is_some_and(|typing| typing.what == What::Answer);
    let text = if view.model.ended == Some(Ended::Unloading) {
        " h or Ctrl-C: hold now"
    } else if dialogue.after.is_some() && !dialogue.hears(view.now) {
        " the rig is HELD"
    } else if answering && !dialogue.hears(view.now) {
        " Ctrl-C stop, twice: hold now   other keys do not count yet"
    } else if let Some(question) = dialogue.question.as_ref().filter(|_| answering) {
        let word = question.kind.word();
        let stop = if question.kind == QuestionKind::Unload {
            "Esc back"
        } else {
            "q stop   h hold now   ? help"
        };
        &format!(" type {word}   n no   i observation   {stop}")
    } else if let Some(Typing { what, .. }) = &dialogue.typing {
        match what {
            What::Reason => " Enter resume   Esc back   Ctrl-U clear",
            _ => " Enter done   Esc back   Ctrl-U clear   Ctrl-C stop",
        }
    } else if let Some(After::Held { resume, unload }) = dialogue.after {
        match (resume, unload) {
            (true, true) => " r resume   u unload   x leave",
            (true, false) => " r resume   x leave",
            (false, _) => " x leave",
        }
    } else if view.model.ended == Some(Ended::Held) {
        " the rig is HELD"
    } else if view.stop_request.hold_requested() {
        " the rig holds now"
    } else if view.stop_request.end_requested() {
        " stops at the end of this step   h or Ctrl-C again: hold now"
    } else if dialogue.monitor {
        " q end   ? help"
    } else if dialogue.paused {
        " p continue   s step   i note   q stop   h hold now   ? help"
    } else {
        " p pause   i note   q stop   h hold now   ? help"
    };
    Line::styled(text.to_owned(), view.quiet())
}
