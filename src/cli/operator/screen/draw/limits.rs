//! The limits as bars: the position of the last step between the ends, and the remaining margin.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::text::{Line, Span};

use super::{View, head};
use crate::operator::screen::model::LimitRow;
use psd_text::units::Dimension;
use psd_text::units::display::{plain, readable, stated};

/// Widths of the name, of each end, and of the margin.
const NAME: usize = 15;
const END: usize = 9;
const MARGIN: usize = 18;

/// At most `most` rows, in their order: those with the smallest margin. A bound that psd itself applies is shown only when exceeded.
pub fn nearest(rows: &[LimitRow], most: usize) -> Vec<LimitRow> {
    let left = |row: &LimitRow| {
        Bar::of(row)
            .closeness(row)
            .filter(|share| !row.kept || *share < 0.0)
            .unwrap_or(f64::INFINITY)
    };
    let mut indices: Vec<usize> = (0..rows.len()).collect();
    indices.sort_by(|one, other| left(&rows[*one]).total_cmp(&left(&rows[*other])));
    indices.truncate(most);
    indices.sort_unstable();
    indices.into_iter().map(|index| rows[index]).collect()
}

/// `all`: the total number of limits, of which these rows are shown.
pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, rows: &[LimitRow], all: usize, area: Rect) {
    let limits = view.model.on_the_rig("Limits");
    let heading = if rows.len() < all {
        format!(" {limits}, the {} nearest of {all} ", rows.len())
    } else {
        format!(" {limits} ")
    };
    let block = view.part(&heading);
    let inside = block.inner(area);
    frame.render_widget(block, area);
    let width = usize::from(inside.width).saturating_sub(1 + NAME + END + 1 + 1 + END + 1 + MARGIN);
    if rows.is_empty() {
        frame.render_widget(
            Line::styled(" no limit of this plan applies to a step", view.quiet()),
            inside,
        );
    }
    for (row, area) in rows.iter().zip(inside.rows()) {
        frame.render_widget(line(view, row, width.clamp(4, 60)), area);
    }
}

fn line<'a>(view: &View<'_>, row: &LimitRow, width: usize) -> Line<'a> {
    let bar = Bar::of(row);
    let color = match bar.closeness(row) {
        Some(share) if share < if row.kept { 0.0 } else { 0.05 } => Color::Red,
        Some(share) if share < 0.2 && !row.kept => Color::Yellow,
        _ => Color::Green,
    };
    let margin = match row.margin() {
        Some(0.0) if row.kept => "at the limit".to_owned(),
        Some(margin) if margin < 0.0 => format!("exceeded by {}", number(-margin, row.dimension)),
        Some(margin) => format!("margin {}", number(margin, row.dimension)),
        None => String::new(),
    };
    Line::from(vec![
        Span::raw(format!(
            " {:<NAME$}{:>END$} ",
            row.name,
            end(row.limit.low, row.dimension)
        )),
        Span::styled(bar.cells(width, row.value), view.paint(color)),
        Span::raw(format!(" {:<END$} ", end(row.limit.high, row.dimension))),
        Span::styled(margin, view.paint(color)),
    ])
}

fn end(bound: f64, dimension: Dimension) -> String {
    if bound == 0.0 {
        "0".to_owned()
    } else if !bound.is_finite() {
        "no limit".to_owned()
    } else if dimension == Dimension::NUMBER {
        format!("{} %", plain(bound * 100.0, dimension, 3))
    } else {
        stated(bound, dimension)
    }
}

fn number(value: f64, dimension: Dimension) -> String {
    if dimension == Dimension::NUMBER {
        head::percent(value)
    } else {
        readable(value, dimension)
    }
}

/// The span of a bar; an end without a bound is drawn as far out as the other one.
struct Bar {
    low: f64,
    high: f64,
}

impl Bar {
    fn of(row: &LimitRow) -> Self {
        let (low, high) = (row.limit.low, row.limit.high);
        match (low.is_finite(), high.is_finite()) {
            (false, true) => Self {
                low: -high.abs(),
                high,
            },
            (true, false) => Self {
                low,
                high: low.abs(),
            },
            _ => Self { low, high },
        }
    }

    /// The margin as a fraction of the distance from zero to the nearer end.
    fn closeness(&self, row: &LimitRow) -> Option<f64> {
        let value = row.value?;
        let margin = row.margin()?;
        let toward = if row.approaches_low(value) {
            self.low
        } else {
            self.high
        };
        let whole = if toward.abs() > 0.0 {
            toward.abs()
        } else {
            self.high - self.low
        };
        // A displacement limit of 0 as the nearer end is the start of a test, not a danger.
        (whole > 0.0 && !(value.abs() < 1e-3 * (self.high - self.low) && margin >= 0.0))
            .then(|| margin / whole)
    }

    fn cells(&self, width: usize, value: Option<f64>) -> String {
        let column_of = |at: f64| {
            let share = ((at - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
            #[expect(
                clippy::cast_precision_loss,
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a column"
            )]
            let column = (share * (width - 1) as f64).round() as usize;
            column
        };
        let Some(value) = value else {
            return "─".repeat(width);
        };
        let (zero, at) = (column_of(0.0), column_of(value));
        let filled = zero.min(at)..=zero.max(at);
        (0..width)
            .map(|column| match column {
                column if column == at => '●',
                column if filled.contains(&column) => '━',
                _ => '─',
            })
            .collect()
    }
}
