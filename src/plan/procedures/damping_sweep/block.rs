//! `damping sweep`: its block and its results.

use crate::ProcedureBlock;
use crate::schema::procedures::SPECIMEN;
use crate::schema::{BlockKind, Field, Kind, Naming, ResultKind};
use psd_text::units::Dimension;

pub const DAMPING: ResultKind = ResultKind::measured(
    "damping",
    Dimension::DAMPING,
    "slope of damping force against velocity",
);

pub const COULOMB_FORCE: ResultKind = ResultKind::measured(
    "coulomb_force",
    Dimension::FORCE,
    "Coulomb friction: fitted damping force at zero velocity",
);

pub const R_SQUARED: ResultKind = ResultKind::new(
    "r_squared",
    Dimension::NUMBER,
    "coefficient of determination of the fit",
)
.near_one();

pub const DAMPING_RATIO: ResultKind = ResultKind::measured(
    "damping_ratio",
    Dimension::NUMBER,
    "fraction of critical damping, c / (2 sqrt(K M))",
);

pub const MAX_VELOCITY: ResultKind = ResultKind::new(
    "max_velocity",
    Dimension::VELOCITY,
    "largest velocity of the sweep",
);

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
    DAMPING,
    COULOMB_FORCE,
    R_SQUARED,
    DAMPING_RATIO,
    MAX_VELOCITY,
];

pub const VELOCITIES: Field = Field::quantities(
    "velocities",
    Dimension::VELOCITY,
    "velocities of the strokes",
)
.required("velocities = [0.5, 1, 2, 5, 10] mm/s")
.above_zero();

pub const STROKE: Field = Field::quantity("stroke", Dimension::LENGTH, "length of each stroke")
    .required("stroke = 1 mm")
    .above_zero();

pub const ABOUT: Field = Field::quantity("about", Dimension::LENGTH, "centre of the strokes")
    .default_in_words("the start position of the actuator");

pub const STIFFNESS: Field = Field::quantity(
    "stiffness",
    Dimension::STIFFNESS,
    "K of the damping force R − K·X",
)
.required("stiffness = 300 kN/m")
.above_zero();

pub const RATE: Field = Field::quantity("rate", Dimension::FREQUENCY, "sampling rate")
    .above_zero()
    .default_in_words("at least 50 samples on the steady part");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::DampingSweep),
    keyword: &["damping", "sweep"],
    naming: Naming::Named,
    fields: &[SPECIMEN, VELOCITIES, STROKE, ABOUT, STIFFNESS, RATE],
    exports: &[],
    results: RESULTS,
    example: "damping sweep c {\n  velocities = [1, 2, 5] mm/s\n  stroke = 1 mm\n  stiffness = 300 kN/m\n}",
    doc: "Strokes at increasing constant velocity: damping by least squares",
};
