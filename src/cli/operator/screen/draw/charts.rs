//! The two curves: displacement over time and force over displacement of the running procedure.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::widgets::{Axis, Block, BorderType, Chart, Dataset, GraphType};

use super::View;
use crate::operator::screen::curve::Curve;
use psd_text::units::Dimension;
use psd_text::units::display::{readable_unit, significant};

pub fn draw(frame: &mut Frame<'_>, view: &View<'_>, area: Rect) {
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Fill(1)]).areas(area);
    let names = view.model.shown.names(view.model.axes());
    let [x, r] = [names.displacement, names.force].map(|name| view.model.on_the_rig(&name));
    let displacement = [("t", Dimension::TIME), (&*x, Dimension::LENGTH)];
    let force = [(&*names.across, Dimension::LENGTH), (&*r, Dimension::FORCE)];
    let curves = &view.model.curves;
    let predicted = view.model.prediction();
    // The time of a step that does not integrate is that of the laboratory, which is not predicted.
    let over_time = predicted.filter(|reach| reach.integrates);
    chart(
        frame,
        view,
        left,
        &Drawn {
            measured: &curves.displacement,
            predicted: over_time.map(|reach| &reach.curves.displacement),
        },
        "Displacement",
        displacement,
    );
    chart(
        frame,
        view,
        right,
        &Drawn {
            measured: &curves.force,
            predicted: predicted.map(|reach| &reach.curves.force),
        },
        "Force",
        force,
    );
}

/// One axis: its range in SI, and the format of its numbers.
struct Scale {
    bounds: [f64; 2],
    unit: String,
    factor: f64,
}

impl Scale {
    /// From the smallest to the largest value; a single value gets a margin around it.
    fn of(data: [f64; 2], dimension: Dimension) -> Self {
        let largest = data[0].abs().max(data[1].abs());
        let (unit, factor) = readable_unit(largest, dimension);
        let span = data[1] - data[0];
        let room = if span > largest * 1e-9 {
            0.0
        } else if largest > 0.0 {
            0.1 * largest
        } else {
            factor
        };
        Self {
            bounds: [data[0] - room, data[1] + room],
            unit,
            factor,
        }
    }

    fn labels(&self) -> [String; 2] {
        let span = self.bounds[1] - self.bounds[0];
        self.bounds.map(|bound| {
            // The first step is not exactly 0, and its exact value is not useful.
            let bound = if bound.abs() < 1e-3 * span {
                0.0
            } else {
                bound
            };
            let number = significant(bound / self.factor, 3);
            let decimals = number.contains('.') && !number.contains('e');
            if decimals {
                number
                    .trim_end_matches('0')
                    .trim_end_matches('.')
                    .to_owned()
            } else {
                number
            }
        })
    }
}

/// A measured curve and its prediction.
struct Drawn<'a> {
    measured: &'a Curve,
    predicted: Option<&'a Curve>,
}

fn chart(
    frame: &mut Frame<'_>,
    view: &View<'_>,
    area: Rect,
    curves: &Drawn<'_>,
    what: &str,
    [(across, across_dimension), (up, up_dimension)]: [(&str, Dimension); 2],
) {
    let frame_of = |title: String| {
        Block::bordered()
            .border_type(BorderType::Plain)
            .border_style(view.quiet())
            .title(title)
    };
    let curve = curves.measured;
    let predicted = curves
        .predicted
        .filter(|predicted| predicted.bounds().is_some());
    let of_prediction = predicted.and_then(Curve::bounds);
    let bounds = match (curve.bounds(), of_prediction) {
        (Some(measured), Some(predicted)) => measured.with(predicted),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => {
            frame.render_widget(frame_of(format!(" {what} ")), area);
            return;
        }
    };
    let (x, y) = (
        Scale::of(bounds.x, across_dimension),
        Scale::of(bounds.y, up_dimension),
    );
    let points: Vec<(f64, f64)> = curve.points().collect();
    let newest: Vec<(f64, f64)> = curve.newest().into_iter().collect();
    let expected: Vec<(f64, f64)> = predicted.into_iter().flat_map(Curve::points).collect();
    let datasets = vec![
        Dataset::default()
            .marker(Marker::Dot)
            .graph_type(GraphType::Scatter)
            .style(view.paint(Color::DarkGray))
            .data(&expected),
        Dataset::default()
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .style(view.paint(Color::Cyan))
            .data(&points),
        Dataset::default()
            .marker(Marker::Dot)
            .graph_type(GraphType::Scatter)
            .style(view.paint(Color::Yellow))
            .data(&newest),
    ];
    let axis = |scale: &Scale| {
        Axis::default()
            .bounds(scale.bounds)
            .labels(scale.labels())
            .style(view.quiet())
    };
    let note = if predicted.is_some() {
        ", · predicted"
    } else {
        ""
    };
    let title = format!(" {up} ({}) over {across} ({}){note} ", y.unit, x.unit);
    let chart = Chart::new(datasets)
        .block(frame_of(title))
        .x_axis(axis(&x))
        .y_axis(axis(&y))
        .legend_position(None);
    frame.render_widget(chart, area);
}
