//! What stands over the curves: a question of the run, a line being typed, the help.

use ratatui::Frame;
use ratatui::layout::{Constraint, Flex, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, BorderType, Clear, Padding, Paragraph};

use super::{View, shown};
use crate::cli::screen::dialogue::{Typing, What};

const WIDEST: u16 = 72;

const HELP: &[&str] = &[
    "p        pause at the end of this step; p again goes on",
    "s space  one single step while paused",
    "i        a note for the record, with your name",
    "q        stop at the end of this step; the rig holds",
    "h        hold the rig now, in the middle of a step too",
    "Ctrl-C   once as q, twice as h",
    "",
    "After a stop by a person the rig holds: nothing moves unasked.",
    "",
    "any key closes this; h, q and Ctrl-C do what they say too",
];

/// Draws it in the middle of `charts`; where that is too low, in the middle of `whole`.
pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, charts: Rect, whole: Rect) {
    let width = whole.width.min(WIDEST).saturating_sub(2);
    let room = usize::from(width.saturating_sub(4)).max(1);
    let Some((title, text)) = content(view, room) else { return };
    let lines: Vec<Line<'_>> = text.iter().flat_map(|line| wrapped(line, room)).map(Line::raw).collect();
    let wanted = u16::try_from(lines.len()).unwrap_or(u16::MAX).saturating_add(2);
    let over = if wanted <= charts.height { charts } else { whole };
    let [row] = Layout::vertical([Constraint::Length(wanted.min(over.height))]).flex(Flex::Center).areas(over);
    let [area] = Layout::horizontal([Constraint::Length(width)]).flex(Flex::Center).areas(row);
    let block = Block::bordered()
        .border_type(BorderType::Double)
        .border_style(view.paint(Color::Yellow))
        .title(Span::styled(title, Style::new().add_modifier(Modifier::BOLD)))
        .padding(Padding::horizontal(1));
    frame.render_widget(Clear, area);
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn content(view: &View<'_>, width: usize) -> Option<(&'static str, Vec<String>)> {
    let dialogue = view.dialogue;
    if dialogue.help {
        return Some((" Help ", HELP.iter().map(|line| (*line).to_owned()).collect()));
    }
    let Typing { what, text } = dialogue.typing.as_ref()?;
    let typed = format!("> {}▏", tail(&shown(text), width.saturating_sub(3)));
    let question = || shown(dialogue.question.as_deref().unwrap_or_default());
    let unload = dialogue.unload;
    let title = match what {
        What::Note | What::NoteName { .. } => " Note ",
        _ if unload => " Held ",
        _ => " Inspection ",
    };
    let answer = |yes: bool| match (yes, unload) {
        (true, true) => "Yes, unload: the rig moves.",
        (false, true) => "No, it stays held.",
        (true, false) => "Yes, go on.",
        (false, false) => "No, the run ends here and the rig holds.",
    };
    let lines = match what {
        What::Note => {
            let waits = dialogue.question.is_some().then(|| "An inspection waits until this note is done.".to_owned());
            let rest = ["A note for the record; Enter keeps it, Esc does not:".to_owned(), typed];
            waits.into_iter().chain(rest).collect()
        }
        What::NoteName { note } => vec![shown(note), "Your name:".to_owned(), typed],
        What::Answer if unload => {
            vec![question(), String::new(), "Unload?   y yes, the rig MOVES   n no, it stays held".to_owned()]
        }
        What::Answer => {
            let mut lines =
                vec![question(), String::new(), "Go on?   y yes   n no, the run ends here and the rig holds".to_owned()];
            if view.model.unloads {
                lines.push("After a limit on the way the rig unloads by itself; after a stop by you it holds.".to_owned());
            }
            lines
        }
        What::Remark { yes } => {
            let answer = answer(*yes);
            let asks = format!("{answer} A remark for the record; Enter without one, Esc back:");
            vec![question(), String::new(), asks, typed]
        }
        What::AnswerName { yes, .. } => {
            let answer = answer(*yes);
            vec![question(), String::new(), format!("{answer} Your name; Esc back:"), typed]
        }
    };
    Some((title, lines))
}

/// The end of a long line: where it is being typed.
fn tail(text: &str, width: usize) -> String {
    let skipped = text.chars().count().saturating_sub(width);
    text.chars().skip(skipped).collect()
}

/// The text on lines of at most `width` characters, broken at blanks where there are any.
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
            lines.last_mut().unwrap_or(&mut String::new()).extend(characters);
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
