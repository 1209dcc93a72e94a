//! Drawing of the live screen. In: the model and the dialogue. Out: the cells of one frame. It has no side effects: the same view gives
//! the same frame. Text of plans and operators is sanitised.

mod alarm;
mod charts;
mod events;
mod head;
mod limits;
mod popup;
#[cfg(test)]
mod tests;

use std::time::Duration;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Block, Borders};

use super::model::{Ended, Model};
use crate::operator::dialogue::Dialogue;
use psd_rig::StopRequest;
use psd_text::diagnostic::excerpt::escape;

/// The smallest terminal on which the screen is drawn: columns and rows.
pub const SMALLEST: (u16, u16) = (60, 16);

/// All data of a frame.
pub struct View<'a> {
    pub model: &'a Model,
    pub dialogue: &'a Dialogue,
    pub stop_request: &'a StopRequest,
    /// Wall time since the screen was requested.
    pub now: Duration,
    pub color: bool,
}

/// Draws the whole screen.
pub fn draw(frame: &mut Frame<'_>, view: &View<'_>) {
    let area = frame.area();
    if view.model.ended == Some(Ended::NotHeld) {
        alarm::draw(frame, view, area);
        return;
    }
    if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
        let too_small = format!("psd: this screen needs {} x {}", SMALLEST.0, SMALLEST.1);
        frame.render_widget(
            Line::raw(too_small),
            Rect {
                height: area.height.min(1),
                ..area
            },
        );
        popup::draw(frame, view, area, area, area);
        return;
    }
    // Head, curves, the heading of the limits and the keys are always shown.
    let most = usize::from(area.height.saturating_sub(3 + 5 + 1 + 1));
    let all = view.model.limit_rows();
    let rows = limits::nearest(&all, most);
    let limit_lines = u16::try_from(rows.len().max(1)).unwrap_or(1) + 1;
    // The remaining lines go to the curves first, then to the events.
    let spare = area.height.saturating_sub(3 + limit_lines + 1 + 5);
    let event_lines = if area.height < 20 {
        0
    } else {
        (1 + spare / 4).clamp(2, 10)
    };
    let [head, charts, limits, events, keys] = Layout::vertical([
        Constraint::Length(3),
        Constraint::Min(5),
        Constraint::Length(limit_lines),
        Constraint::Length(event_lines),
        Constraint::Length(1),
    ])
    .areas(area);
    head::draw(frame, view, head);
    charts::draw(frame, view, charts);
    limits::draw(frame, view, &rows, all.len(), limits);
    events::draw(frame, view, events);
    frame.render_widget(head::keys(view), keys);
    popup::draw(frame, view, charts, charts.union(limits), area);
}

impl View<'_> {
    /// A colour, if colours are on.
    fn paint(&self, color: Color) -> Style {
        if self.color {
            Style::new().fg(color)
        } else {
            Style::new()
        }
    }

    fn quiet(&self) -> Style {
        if self.color {
            Style::new().add_modifier(Modifier::DIM)
        } else {
            Style::new()
        }
    }

    /// A line with a heading above a part of the screen.
    fn part<'a>(&self, heading: &'a str) -> Block<'a> {
        Block::new()
            .borders(Borders::TOP)
            .border_style(self.quiet())
            .title(Line::raw(heading))
    }
}

/// Text on one line, without control sequences.
fn shown(text: &str) -> String {
    escape(text).replace('\n', " ")
}

/// At most `width` characters; a cut text is marked.
fn fitted(text: &str, width: usize) -> String {
    if text.chars().count() <= width {
        return text.to_owned();
    }
    let kept: String = text.chars().take(width.saturating_sub(1)).collect();
    format!("{kept}…")
}
