//! The last events, the newest last, as many as there is room for.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::{View, fitted, shown};
use crate::record::Event;

pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, area: Rect) {
    let block = view.part(" Events ");
    let inside = block.inner(area);
    frame.render_widget(block, area);
    let events = &view.model.events;
    if events.is_empty() {
        frame.render_widget(Line::styled(" none yet", view.quiet()), inside);
    }
    let first = events.len().saturating_sub(inside.height.into());
    for (event, area) in events.iter().skip(first).zip(inside.rows()) {
        frame.render_widget(Line::raw(fitted(&words(event), area.width.into())), area);
    }
}

fn words(event: &Event) -> String {
    let place = match (&event.procedure, event.step) {
        (Some(procedure), Some(step)) => format!("{procedure} {step}"),
        (Some(procedure), None) => procedure.clone(),
        (None, _) => String::new(),
    };
    let decimals = if event.time < 100.0 { 3 } else { 1 };
    format!(" {:>9.decimals$} s  {:<10} {:<12} {}", event.time, fitted(&shown(&place), 18), event.kind.word(), shown(&event.text))
}
