//! The windows over the curves: a question of the run, a line being typed, the help.

use ratatui::Frame;
use ratatui::layout::{Constraint, Flex, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, BorderType, Clear, Padding, Paragraph};

use super::{View, shown};
use crate::operator::dialogue::{Typing, What};
use crate::operator::question::{After, QuestionKind, WHY_RESUME, position_and_force};
use psd_plan::record::EventKind;

const WIDEST: u16 = 72;

const HELP: &[&str] = &[
    "p        pause at the end of this step; p again continues",
    "s space  one single step while paused",
    "i        a note for the run log, with your name; at a question an observation",
    "q        stop at the end of this step; the rig holds",
    "h        hold the rig now, even during a step",
    "Ctrl-C   once as q, twice as h",
    "",
    "A rig is released by a typed word, never by a key.",
    "After a stop by the operator the rig holds. It moves only if asked.",
    "",
    "any key closes this help; h, q and Ctrl-C also act",
];

/// Draws it in the middle of `charts`; if that is too low, of `whole`, and otherwise of the full screen.
pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, charts: Rect, whole: Rect, everything: Rect) {
    let width = whole.width.min(WIDEST).saturating_sub(2);
    let room = usize::from(width.saturating_sub(4)).max(1);
    let Some((title, text)) = content(view, room) else {
        return;
    };
    let lines: Vec<Line<'_>> = text
        .iter()
        .flat_map(|line| wrapped(line, room))
        .map(Line::raw)
        .collect();
    let wanted = u16::try_from(lines.len())
        .unwrap_or(u16::MAX)
        .saturating_add(2);
    let over = [charts, whole]
        .into_iter()
        .find(|over| wanted <= over.height)
        .unwrap_or(everything);
    let [row] = Layout::vertical([Constraint::Length(wanted.min(over.height))])
        .flex(Flex::Center)
        .areas(over);
    let [area] = Layout::horizontal([Constraint::Length(width)])
        .flex(Flex::Center)
        .areas(row);
    let moves = view
        .dialogue
        .question
        .as_ref()
        .is_some_and(|question| question.kind != QuestionKind::Look);
    let block = Block::bordered()
        .border_type(BorderType::Double)
        .border_style(view.paint(if moves { Color::Red } else { Color::Yellow }))
        .title(Span::styled(
            format!(" {title} "),
            Style::new().add_modifier(Modifier::BOLD),
        ))
        .padding(Padding::horizontal(1));
    frame.render_widget(Clear, area);
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn content(view: &View<'_>, width: usize) -> Option<(&'static str, Vec<String>)> {
    let dialogue = view.dialogue;
    if dialogue.help {
        return Some(("Help", HELP.iter().map(|line| (*line).to_owned()).collect()));
    }
    let Some(Typing { what, text }) = dialogue.typing.as_ref() else {
        return dialogue.after.map(|after| held(view, after));
    };
    let typed = format!("> {}▏", tail(&shown(text), width.saturating_sub(3)));
    let Some(question) = dialogue
        .question
        .as_ref()
        .filter(|_| !matches!(what, What::Note | What::NoteName { .. }))
    else {
        let waits = dialogue
            .question
            .is_some()
            .then(|| "A question waits until this note is done.".to_owned());
        return Some(match what {
            What::Reason => (
                "RESUME",
                vec![format!("{WHY_RESUME} Enter, Esc back:"), typed],
            ),
            What::NoteName { note } => ("Note", vec![shown(note), "Your name:".to_owned(), typed]),
            _ => {
                let rest = [
                    "A note for the run log. Enter keeps it, Esc discards it:".to_owned(),
                    typed,
                ];
                ("Note", waits.into_iter().chain(rest).collect())
            }
        });
    };
    let mut lines: Vec<String> = question.lines.iter().map(|line| shown(line)).collect();
    lines.push(String::new());
    lines.extend(
        dialogue
            .remark
            .as_ref()
            .map(|remark| format!("Observation: {}", shown(remark))),
    );
    lines.extend(match what {
        What::Remark => vec![
            "An observation for the run log. Enter keeps it, Esc back:".to_owned(),
            typed,
        ],
        What::AnswerName { .. } => vec!["Your name; Esc back:".to_owned(), typed],
        _ if !dialogue.hears(view.now) => {
            vec!["Read this first: keys do not count yet.".to_owned()]
        }
        _ => vec![asked(view, question.kind), typed],
    });
    Some((question.kind.title(), lines))
}

/// The request for the line that is being typed.
fn asked(view: &View<'_>, kind: QuestionKind) -> String {
    let (word, declined) = (kind.word(), kind.declined());
    let unclear = if view.dialogue.unclear {
        "Not an answer. "
    } else {
        ""
    };
    let unloads = if view.model.unloads && kind != QuestionKind::Unload {
        " After a stop by a limit the rig MOVES back and unloads automatically; after a stop by you it holds."
    } else {
        ""
    };
    format!("{unclear}Type {word} and Enter, or n and Enter: {declined}.{unloads}")
}

/// A rig on hold after the early end of its run, and the available choices.
fn held(view: &View<'_>, after: After) -> (&'static str, Vec<String>) {
    let last = view.model.events.iter().rev().find(|event| {
        matches!(
            event.kind,
            EventKind::Hold | EventKind::LimitBreach | EventKind::Fault
        )
    });
    let mut lines = vec![
        last.map_or_else(String::new, |event| shown(&event.text)),
        String::new(),
    ];
    lines.extend(
        view.model
            .feedback()
            .into_iter()
            .map(|(displacement, force)| position_and_force(displacement, force)),
    );
    lines.push(String::new());
    if view.dialogue.hears(view.now) {
        lines.extend(
            after
                .choices()
                .into_iter()
                .map(|(key, _, does)| format!("{key}   {does}")),
        );
    } else {
        lines.push("Keys do not count yet.".to_owned());
    }
    ("HELD", lines)
}

/// The end of a long line, with the cursor.
fn tail(text: &str, width: usize) -> String {
    let skipped = text.chars().count().saturating_sub(width);
    text.chars().skip(skipped).collect()
}

/// The text on lines of at most `width` characters, broken at spaces if there are any.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut length = 0;
    for word in text.split_inclusive(' ') {
        let mut characters: Vec<char> = word.chars().collect();
        if length > 0 && length + word.trim_end().chars().count() > width {
            lines.push(String::new());
            length = 0;
        }
        while characters.len() > width {
            let rest = characters.split_off(width);
            lines
                .last_mut()
                .unwrap_or(&mut String::new())
                .extend(characters);
            lines.push(String::new());
            characters = rest;
        }
        length += characters.len();
        if let Some(line) = lines.last_mut() {
            line.extend(characters);
        }
    }
    lines
}
