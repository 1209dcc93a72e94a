//! The table of a damping sweep, a row a reading. In: its steps. Out: columns.

use crate::record::SweepStep;
use crate::report::tables::{Column, integers, numbers};
use crate::schema;
use crate::schema::columns::{self, column};
use crate::units::Dimension;

/// The numeric columns of its table.
pub(crate) const COLUMNS: &[schema::Column] = &[
    columns::STEP,
    columns::WALL_TIME,
    columns::VELOCITY,
    columns::DISPLACEMENT,
    columns::RESTORING_FORCE,
    column("damping_force_n", Dimension::FORCE),
];

pub(crate) fn steps(steps: &[SweepStep]) -> Vec<Column> {
    let of = |name, read: fn(&SweepStep) -> f64| numbers(name, steps, read);
    let steady: Vec<bool> = steps.iter().map(|step| step.steady).collect();
    vec![
        integers("step", steps, |step| step.step),
        of("wall_time_s", |step| step.wall_time),
        of("velocity_m_per_s", |step| step.velocity),
        of("displacement_m", |step| step.displacement),
        of("restoring_force_n", |step| step.restoring_force),
        of("damping_force_n", |step| step.damping_force),
        Column::new("steady".into(), steady),
    ]
}
