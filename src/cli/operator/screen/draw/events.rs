//! The last events, the newest last, as many as fit.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::{View, fitted, shown};
use psd_plan::record::{Event, EventKind};

/// Column of the second line of the newest event.
const INDENT: usize = 14;

pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, area: Rect) {
    let block = view.part(" Events ");
    let inside = block.inner(area);
    frame.render_widget(block, area);
    let events = &view.model.events;
    if events.is_empty() {
        frame.render_widget(Line::styled(" none yet", view.quiet()), inside);
    }
    let (width, height) = (usize::from(inside.width), usize::from(inside.height));
    let newest = events
        .back()
        .map_or_else(Vec::new, |newest| over_two(&words(newest), width));
    // The newest event is shown in full; the earlier ones get the remaining lines.
    let newest = &newest[..newest.len().min(height)];
    let older = events.len().saturating_sub(1);
    let before = events
        .iter()
        .take(older)
        .skip(older.saturating_sub(height - newest.len()));
    let lines = before
        .map(|event| fitted(&words(event), width))
        .chain(newest.iter().cloned());
    for (line, area) in lines.zip(inside.rows()) {
        frame.render_widget(Line::raw(line), area);
    }
}

/// A text on one line, or broken at a space onto a second one.
fn over_two(text: &str, width: usize) -> Vec<String> {
    if text.chars().count() <= width {
        return vec![text.to_owned()];
    }
    let fits = text
        .char_indices()
        .nth(width)
        .map_or(text.len(), |(at, _)| at);
    let indent = " ".repeat(INDENT);
    // A break within the first words would save no space.
    let cut = text[..fits]
        .rfind(' ')
        .filter(|cut| *cut > INDENT + 15)
        .unwrap_or(fits);
    let rest = format!("{indent}{}", text[cut..].trim_start());
    vec![text[..cut].to_owned(), fitted(&rest, width)]
}

/// The word of its kind; the answer to a release is not an inspection.
fn kind(event: &Event) -> &'static str {
    if event.kind == EventKind::Inspection && event.text.starts_with("release ") {
        "release"
    } else {
        event.kind.word()
    }
}

fn words(event: &Event) -> String {
    let procedure_and_step = match (&event.procedure, event.step) {
        (Some(procedure), Some(step)) => format!("{procedure} {step}"),
        (Some(procedure), None) => procedure.clone(),
        (None, _) => String::new(),
    };
    let decimals = if event.time < 100.0 { 3 } else { 1 };
    format!(
        " {:>9.decimals$} s  {:<10} {:<12} {}",
        event.time,
        fitted(&shown(&procedure_and_step), 18),
        kind(event),
        shown(&event.text)
    )
}
