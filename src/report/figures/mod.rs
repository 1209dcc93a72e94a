//! Figures, as PNG at 192 dpi and as vectors. In: a run. Out: bytes and a caption, one figure at a
//! time. It knows no HTML.

mod axis;
mod canvas;
pub(crate) mod chart;
mod data;
mod draw;
mod plain;
pub(crate) mod points;
mod raster;
pub(crate) mod structure;
mod together;
mod vector;

use super::output::file::OutputError;
use super::run::Run;
use crate::procedures;
use chart::Chart;
use psd_plan::formula::ProcedureId;
use psd_plan::record::ProcedureRecord;
use psd_plan::{Figure, FigureKind};

pub use data::{FIGURE_DATA, FigureAxis, FigureBand, FigureCurve, FigureData, Figures};
pub(crate) use draw::svg;
pub use plain::{Curve, Curves, PlainAxis};
pub(crate) use raster::png;

/// A figure, drawn in vectors.
pub(super) struct Drawn {
    pub svg: String,
    /// The content of the figure, in one sentence.
    pub caption: String,
    /// Its axes and curves in words.
    pub description: String,
    pub kind: FigureKind,
    /// The name of the procedure that it shows, the first one of several.
    pub procedure: String,
}

impl Drawn {
    /// The figure as PNG.
    pub fn png(&self) -> Result<Vec<u8>, OutputError> {
        raster::png(&self.svg).map_err(|reason| OutputError::Figure {
            figure: self.kind.name(),
            procedure: self.procedure.clone(),
            reason,
        })
    }
}

/// A figure that is not drawn yet.
pub(super) struct Undrawn {
    /// `figures/NAME_FIGURE`, without its ending.
    pub path: String,
    chart: Chart,
    caption: String,
    kind: FigureKind,
    procedure: String,
}

impl Undrawn {
    /// None if the procedure recorded no step.
    pub fn of(run: &Run<'_>, figure: &Figure) -> Option<Self> {
        let procedure = run.record.procedures.get(figure.procedure.0)?;
        let (chart, caption) = chart_of(run, procedure, figure)?;
        let path = format!("figures/{}", name_of(run, figure));
        Some(Self {
            path,
            chart,
            caption,
            kind: figure.kind,
            procedure: procedure.name.clone(),
        })
    }

    /// The figure as SVG, with its caption.
    pub fn in_vectors(self) -> Drawn {
        Drawn {
            svg: draw::svg(&self.chart),
            description: self.chart.description(),
            caption: self.caption,
            kind: self.kind,
            procedure: self.procedure,
        }
    }
}

/// The curves of the figures of a report, in its order.
#[must_use]
pub fn data(run: &Run<'_>) -> Figures {
    let figure_data = |figure: &Figure| {
        let procedure = run.record.procedures.get(figure.procedure.0)?;
        let (chart, _) = chart_of(run, procedure, figure)?;
        Some(data::figure_data(
            name_of(run, figure),
            &procedure.name,
            &chart,
        ))
    };
    Figures {
        figures: run
            .plan
            .report
            .figures
            .iter()
            .filter_map(figure_data)
            .collect(),
        ..Figures::default()
    }
}

/// `hit_displacement`, or `paused-moving_displacement`: no name of a procedure has a hyphen.
fn name_of(run: &Run<'_>, figure: &Figure) -> String {
    let name = |procedure: ProcedureId| {
        run.record
            .procedures
            .get(procedure.0)
            .map(|procedure| procedure.name.as_str())
    };
    let names: Vec<&str> = figure.procedures().filter_map(name).collect();
    format!("{}_{}", names.join("-"), figure.kind.name())
}

/// The chart and its caption; None if the procedure does not draw this figure or has no steps.
fn chart_of(
    run: &Run<'_>,
    procedure: &ProcedureRecord,
    figure: &Figure,
) -> Option<(Chart, String)> {
    if figure.beside.is_empty() {
        return procedures::chart(run, procedure, figure);
    }
    let drawn = figure
        .procedures()
        .filter_map(|procedure| run.record.procedures.get(procedure.0));
    let curves: Vec<_> = drawn
        .map(|procedure| {
            let curve = procedures::shared_curve(figure.kind, &procedure.history);
            (procedure.name.as_str(), curve)
        })
        .collect();
    together::chart(figure.kind, curves)
}
