//! What the reports of frames share: the integration, the modes, and the tables of storeys and elements. In: a plan and a record. Out:
//! blocks.

use crate::report::document::{Block, Column, Table, Text};
use crate::report::number::percent;
use crate::report::sections::results::budget_table;
use crate::report::{Run, number};
use psd_physics::structure::assemblies::Assemblies;
use psd_physics::structure::{SymmetricBand, storeys_of, widen};
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::{Floors, Modes, NamedResult, ProcedureRecord};
use psd_plan::schema::ResultKind;
use psd_plan::{Frame, Integrator, Link, ShakeDamping};
use psd_text::units::Dimension;
use psd_text::units::display::significant;

/// Why the result of the base shear is smaller than the largest reading of the table; None without noise.
pub(crate) fn noise_note<S: Floors>(run: &Run<'_>, steps: &[S]) -> Option<Block> {
    let noise = match &run.plan.rig.link {
        Link::Virtual(link) => link.noise,
        Link::Real(link) => link.readings.noise,
    };
    let note = if steps.last().is_some_and(S::has_elements) {
        "Max base shear and the peak forces are the largest readings minus their part due to noise."
    } else {
        "Max base shear is the largest reading minus its part due to noise."
    };
    (noise > 0.0).then(|| Block::note(note))
}

/// The frame that a procedure tests.
pub(crate) fn frame_of<'a>(run: &Run<'a>, specimen: usize) -> Option<&'a Frame> {
    run.plan.specimens.get(specimen)?.frame.as_ref()
}

/// Whether the stiffness is that of storeys or elements, each of which shows its own as it moves.
pub(crate) fn has_tangents(frame: &Frame) -> bool {
    if frame.has_elements() {
        return true;
    }
    SymmetricBand::from_dense(&frame.stiffness)
        .is_ok_and(|stiffness| storeys_of(&stiffness).is_some())
}

/// The integration of a frame, its damping and its weights.
pub(crate) fn integrated(
    frame: Option<&Frame>,
    integrator: Integrator,
    damping: &ShakeDamping,
    ratios: &[f64],
) -> String {
    let integrator = match integrator {
        Integrator::Tangent if frame.is_some_and(|frame| !has_tangents(frame)) => {
            "constant average acceleration with the initial stiffness matrix".to_owned()
        }
        Integrator::Tangent => {
            "constant average acceleration with the measured tangent stiffness".to_owned()
        }
        Integrator::Explicit => "explicit Newmark".to_owned(),
        Integrator::AlphaOs { alpha } => {
            format!(
                "α-operator splitting with the initial stiffness, α = {}",
                number::stated(alpha, Dimension::NUMBER)
            )
        }
    };
    let damping = match (damping, ratios.iter().any(|ratio| *ratio != 0.0)) {
        (_, false) => "No computed damping.",
        (ShakeDamping::Rayleigh(_), true) => "Rayleigh damping on the first two modes.",
        (ShakeDamping::Modal(_), true) => "Each mode has a separate damping ratio.",
    };
    let p_delta = frame.map_or("", p_delta);
    format!("Integrated by {integrator}. {damping}{p_delta}")
}

/// Where the P-Δ of the storeys comes from: the weights in the computer, or the axial load of the rig in its reading.
fn p_delta(frame: &Frame) -> &'static str {
    match (frame.has_axial_load(), frame.computes_p_delta()) {
        (false, false) => "",
        (false, true) => {
            " P-Δ was computed from the weights of the floors; none was in the reading of the rig. Base shear is net of P-Δ."
        }
        (true, false) => {
            " P-Δ was in the reading of the rig, by the axial load on the specimen; none was computed. Base shear is net of P-Δ."
        }
        (true, true) => {
            " P-Δ was in part in the reading of the rig, by the axial load on the specimen; the rest was computed from the weights of the floors. Base shear is net of P-Δ."
        }
    }
}

pub(crate) fn mode_table(modes: &Modes, ratios: &[f64]) -> Block {
    let columns = vec![
        Column::numbers("Mode"),
        Column::numbers("Period"),
        Column::numbers("Damping ratio"),
        Column::numbers("Effective mass"),
        Column::words("Shape, from the lowest floor up", 1),
    ];
    let row = |mode: usize| -> Vec<Text> {
        let shape: Vec<String> = modes.shapes[mode]
            .iter()
            .map(|entry| psd_text::units::display::minus(&significant(*entry, 4)))
            .collect();
        vec![
            (mode + 1).to_string().into(),
            number::text(modes.periods[mode], Dimension::TIME).into(),
            percent(ratios.get(mode).copied().unwrap_or(0.0)).into(),
            percent(modes.effective_mass[mode]).into(),
            shape.join("  ").into(),
        ]
    };
    Block::Table(Table {
        columns,
        rows: (0..modes.periods.len()).map(row).collect(),
    })
}

/// One row a storey, from the ground up; `displacement` names the result with the floors' largest.
pub(crate) fn storey_table<S: Floors>(
    procedure: &ProcedureRecord,
    steps: &[S],
    frame: Option<&Frame>,
    displacement: ResultKind,
) -> Block {
    let shear = largest(steps, S::shear);
    let net = largest(steps, S::net_shear);
    let weighs = steps.last().is_some_and(S::weighs);
    let whole = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()))
    };
    let drift = procedure.list(schema::MAX_DRIFT.name).unwrap_or_default();
    let cell = |kind: ResultKind, storey: usize| cell(procedure, kind, storey);
    let with_u = |title: &str, kind: ResultKind| with_u(procedure, title, kind);
    // A frame of matrices with elements is no stack of storeys: its elements have a table.
    if steps.last().is_some_and(S::has_elements) {
        let row = |degree: usize| vec![(degree + 1).to_string().into(), cell(displacement, degree)];
        let degrees = steps.last().map_or(0, |step| step.computed().len());
        return Block::Table(Table {
            columns: vec![
                Column::words("Degree of freedom", 1),
                with_u("Peak displacement", displacement),
            ],
            rows: (0..degrees).map(row).collect(),
        });
    }
    let mut columns = vec![
        Column::words("Storey", 1),
        with_u("Peak floor displacement", displacement),
        with_u("Peak drift", schema::MAX_DRIFT),
        Column::numbers("Over height"),
        with_u("Final drift", schema::FINAL_DRIFT),
        Column::numbers(if frame.and_then(Assemblies::of).is_some() {
            "Peak shear"
        } else {
            "Peak shear as read"
        }),
    ];
    columns.extend(weighs.then(|| Column::numbers("Net of P-Δ")));
    let height = |storey: usize| {
        frame
            .and_then(|frame| frame.storeys.get(storey))
            .and_then(|storey| storey.height)
    };
    let row = |storey: usize| -> Vec<Text> {
        let ratio = height(storey)
            .zip(drift.get(storey))
            .map(|(height, drift)| percent(drift / height));
        let force = |shear: &[f64]| {
            number::text_beside(shear[storey], whole(shear), Dimension::FORCE).into()
        };
        let mut cells = vec![
            (storey + 1).to_string().into(),
            cell(displacement, storey),
            cell(schema::MAX_DRIFT, storey),
            ratio.unwrap_or_else(|| "—".to_owned()).into(),
            cell(schema::FINAL_DRIFT, storey),
            force(&shear),
        ];
        cells.extend(weighs.then(|| force(&net)));
        cells
    };
    Block::Table(Table {
        columns,
        rows: (0..shear.len()).map(row).collect(),
    })
}

/// One row an element of a frame of matrices; None without elements.
pub(crate) fn element_table<S: Floors>(procedure: &ProcedureRecord, steps: &[S]) -> Option<Block> {
    let elements = steps.last()?.elements().len();
    let results = [
        ("Peak deformation", schema::MAX_DRIFT),
        ("Final deformation", schema::FINAL_DRIFT),
        ("Peak force", schema::MAX_ELEMENT_FORCE),
    ];
    let row = |element: usize| {
        let cells = results.map(|(_, kind)| cell(procedure, kind, element));
        std::iter::once((element + 1).to_string().into())
            .chain(cells)
            .collect()
    };
    let columns = results.map(|(title, kind)| with_u(procedure, title, kind));
    (elements > 0).then(|| {
        Block::Table(Table {
            columns: std::iter::once(Column::words("Element", 1))
                .chain(columns)
                .collect(),
            rows: (0..elements).map(row).collect(),
        })
    })
}

/// An entry of a result, or a dash without it.
fn cell(procedure: &ProcedureRecord, kind: ResultKind, index: usize) -> Text {
    procedure
        .result(kind.name)
        .map_or_else(|| "—".into(), |result| entry(result, index))
}

/// A column of a result, whose title says whether its standard uncertainty is beside it.
fn with_u(procedure: &ProcedureRecord, title: &str, kind: ResultKind) -> Column {
    let known = procedure
        .result(kind.name)
        .is_some_and(|result| !result.contributions.is_empty());
    Column::numbers(if known {
        format!("{title} (u)")
    } else {
        title.to_owned()
    })
}

/// An entry of a list with its standard uncertainty where it has one, marked where that is not sure; else in the unit of the largest.
pub(crate) fn entry(result: &NamedResult, index: usize) -> Text {
    let values = result.value.list().unwrap_or_default();
    let Some(value) = values.get(index) else {
        return "—".into();
    };
    if let Some(Some(u)) = result.entry_uncertainties().get(index) {
        let mark = if budget_table::is_reliable(result, index) {
            ""
        } else {
            budget_table::MARK
        };
        return (number::with_uncertainty(*value, Some(*u), result.dimension) + mark).into();
    }
    let whole = values
        .iter()
        .fold(0.0, |largest: f64, value| largest.max(value.abs()));
    number::text_beside(*value, whole, result.dimension).into()
}

/// An entry of a list with its standard uncertainty; None without one.
pub(crate) fn known_entry(
    procedure: &ProcedureRecord,
    kind: ResultKind,
    index: usize,
) -> Option<Text> {
    let result = procedure.result(kind.name)?;
    result
        .entry_uncertainties()
        .get(index)
        .copied()
        .flatten()
        .map(|_| entry(result, index))
}

fn largest<S>(steps: &[S], read: impl Fn(&S) -> Vec<f64>) -> Vec<f64> {
    let mut largest: Vec<f64> = Vec::new();
    for step in steps {
        let values = read(step);
        largest.resize(values.len(), 0.0);
        widen(&mut largest, &values);
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{Behaviour, Storey};

    #[test]
    fn the_report_says_where_the_p_delta_comes_from() {
        let storey = |gravity, axial_load| Storey {
            height: Some(3.0),
            gravity,
            axial_load,
            ..Storey::new(1e4, 1e6, Behaviour::Elastic { stiffness: 1e6 })
        };
        let said = |gravity, axial_load| {
            let text = p_delta(&Frame::of_storeys(vec![storey(gravity, axial_load)]));
            [
                "none was in the reading",
                "none was computed",
                "the rest was",
            ]
            .map(|words| text.contains(words))
        };
        assert_eq!(said(0.0, 0.0), [false; 3]);
        assert_eq!(said(1e5, 0.0), [true, false, false]);
        assert_eq!(said(1e5, 1e5), [false, true, false]);
        assert_eq!(said(0.0, 1e5), [false, true, false]);
        assert_eq!(said(1e5, 4e4), [false, false, true]);
    }
}
