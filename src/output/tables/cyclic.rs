//! Tables of cycles: one row a reading, and one row a whole cycle. In: the history. Out: columns.

use polars::prelude::Column;

use super::{integers, numbers};
use crate::record::{CycleStep, WholeCycle};

pub(super) fn steps(steps: &[CycleStep]) -> Vec<Column> {
    let of = |name, read: fn(&CycleStep) -> f64| numbers(name, steps, read);
    vec![
        integers("step", steps, |step| step.step),
        of("wall_time_s", |step| step.wall_time),
        integers("cycle", steps, |step| step.cycle),
        of("amplitude_m", |step| step.amplitude),
        of("command_m", |step| step.command),
        of("displacement_m", |step| step.displacement),
        of("restoring_force_n", |step| step.restoring_force),
        of("force_scatter_n", |step| step.force_scatter),
        of("relaxation_n", |step| step.relaxation),
        of("restoring_energy_j", |step| step.energy),
    ]
}

/// One row a whole cycle.
pub(super) fn cycles(cycles: &[WholeCycle]) -> Vec<Column> {
    let of = |name, read: fn(&WholeCycle) -> f64| numbers(name, cycles, read);
    let some = |name: &str, read: fn(&WholeCycle) -> Option<f64>| {
        Column::new(name.into(), cycles.iter().map(read).collect::<Vec<Option<f64>>>())
    };
    vec![
        integers("cycle", cycles, |cycle| cycle.cycle),
        integers("repeat", cycles, |cycle| u64::from(cycle.repeat)),
        of("amplitude_m", |cycle| cycle.amplitude),
        of("measured_amplitude_m", |cycle| cycle.found.amplitude),
        of("energy_j", |cycle| cycle.found.energy),
        some("equivalent_damping_ratio", |cycle| cycle.found.damping_ratio),
        some("secant_stiffness_n_per_m", |cycle| cycle.found.stiffness),
        of("max_force_n", |cycle| cycle.found.max_force),
        of("min_force_n", |cycle| cycle.found.min_force),
    ]
}
