//! The alarm when the hold of the rig is not confirmed. It fills the whole screen until the operator acknowledges it.

use ratatui::Frame;
use ratatui::layout::{Constraint, Flex, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph, Wrap};

use super::{View, shown};
use crate::operator::question::After;
use psd_plan::record::EventKind;

pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, area: Rect) {
    let message = view
        .model
        .events
        .iter()
        .rev()
        .find(|event| event.kind == EventKind::NotHeld);
    let message = message.map_or_else(String::new, |event| shown(&event.text));
    let loud = view
        .paint(Color::Red)
        .add_modifier(Modifier::BOLD | Modifier::REVERSED);
    let [(key, _, does), ..] = After::NotHeld.choices()[..] else {
        return;
    };
    let acknowledge = if view.dialogue.hears(view.now) {
        format!("{key}   {does}")
    } else {
        String::new()
    };
    let lines = vec![
        Line::styled(" NOT CONFIRMED HELD ", loud),
        Line::raw(""),
        Line::styled(
            format!("THE RIG {} MAY STILL BE MOVING", shown(&view.model.rig)),
            Style::new().add_modifier(Modifier::BOLD),
        ),
        Line::styled(
            "PRESS THE EMERGENCY STOP",
            Style::new().add_modifier(Modifier::BOLD),
        ),
        Line::raw(""),
        Line::raw(message),
        Line::raw(""),
        Line::styled(acknowledge, Style::new().add_modifier(Modifier::BOLD)),
    ];
    let words = Paragraph::new(lines).wrap(Wrap { trim: true }).centered();
    let [middle] = Layout::vertical([Constraint::Length(area.height.min(10))])
        .flex(Flex::Center)
        .areas(area);
    frame.render_widget(Clear, area);
    frame.render_widget(words, middle);
}
