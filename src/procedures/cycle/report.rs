//! The cycles of a `cycle`, one row each, and the meaning of the numbers. In: the history. Out: a table.

use crate::procedures::stiffness_ramp::curve::curve_report;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use psd_physics::statistics::samples::peak;
use psd_plan::record::{CycleHistory, WholeCycle};
use psd_text::units::Dimension;

/// How the contributions to its uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "Each input was perturbed by its standard uncertainty, one at a time, and the \
 loops were computed again from their readings.";

/// Number of cycles printed; the tables contain every one.
const PRINTED: usize = 40;

pub(crate) fn table(history: &CycleHistory, body: &mut Vec<Block>) {
    let cycles = &history.cycles;
    if !cycles.is_empty() {
        body.push(rows(cycles));
    }
    if cycles.len() > PRINTED {
        body.push(Block::note(format!(
            "{} more cycles are in the table of this procedure.",
            cycles.len() - PRINTED
        )));
    }
    if let Some(fit) = &history.backbone {
        let reach = history
            .backbone_points()
            .iter()
            .map(|(x, _)| *x)
            .fold(0.0, f64::max);
        body.push(Block::note(
            "Backbone, from the centre of the cycles, both directions together:",
        ));
        curve_report::table(fit, reach, body);
    }
    body.push(Block::note(
        "Energy is ∫R dX over the cycle (trapezoidal rule). Secant stiffness is between the extreme displacements of \
         the loop. ζ = E/(4π E₀) with E₀ = ½ K a²; K is the secant stiffness and a half the width of the loop. The \
         first cycle at an amplitude starts where the one before ended, so it also contains the energy of further \
         loading.",
    ));
}

/// Every number of a column in the unit of its largest value.
fn rows(cycles: &[WholeCycle]) -> Block {
    let most = |read: fn(&WholeCycle) -> f64| peak(cycles.iter().map(read));
    let (amplitude, energy) = (
        most(|cycle| cycle.amplitude),
        most(|cycle| cycle.found.energy),
    );
    let stiffness = most(|cycle| cycle.found.stiffness.unwrap_or(0.0));
    let force = most(|cycle| cycle.found.max_force).max(most(|cycle| cycle.found.min_force));
    let optional = |value: Option<f64>, largest: f64, dimension| {
        value.map_or_else(
            || Text::from("—"),
            |value| number::text_beside(value, largest, dimension).into(),
        )
    };
    let ratio = |ratio: f64| {
        Text::from(number::text_beside(100.0 * ratio, 100.0, Dimension::NUMBER) + "\u{a0}%")
    };
    let row = |cycle: &WholeCycle| {
        let found = &cycle.found;
        let name = Text::from(cycle.cycle.to_string());
        vec![
            if cycle.repeat > 1 {
                name.soft(" (again)")
            } else {
                name
            },
            number::text_beside(cycle.amplitude, amplitude, Dimension::LENGTH).into(),
            number::text_beside(found.energy, energy, Dimension::ENERGY).into(),
            found.damping_ratio.map_or_else(|| "—".into(), ratio),
            optional(found.stiffness, stiffness, Dimension::STIFFNESS),
            number::text_beside(found.max_force, force, Dimension::FORCE).into(),
            number::text_beside(found.min_force, force, Dimension::FORCE).into(),
        ]
    };
    let columns = vec![
        Column::words("Cycle", 1),
        Column::numbers("Amplitude"),
        Column::numbers("Energy"),
        Column::numbers("ζ"),
        Column::numbers("Secant stiffness"),
        Column::numbers("Largest force"),
        Column::numbers("Smallest force"),
    ];
    Block::Table(Table {
        columns,
        rows: cycles.iter().take(PRINTED).map(row).collect(),
    })
}
