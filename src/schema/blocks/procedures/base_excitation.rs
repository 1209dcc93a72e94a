//! `shake`: its block and its results.

use super::{INSPECT_TRIGGERS, SPECIMEN, tracking};
use crate::schema::blocks::{frames, methods};
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind};
use crate::units::Dimension;

pub(crate) const MAX_DISPLACEMENT: ResultKind = ResultKind::measured_list(
    "max_displacement",
    Dimension::LENGTH,
    "largest size of each floor's displacement, relative to the ground",
);

pub(crate) const MAX_DRIFT: ResultKind = ResultKind::measured_list(
    "max_drift",
    Dimension::LENGTH,
    "largest size of each storey's drift",
);

pub(crate) const FINAL_DRIFT: ResultKind = ResultKind::measured_list(
    "final_drift",
    Dimension::LENGTH,
    "each storey's drift at the last step of the run",
);

pub(crate) const PERIODS: ResultKind =
    ResultKind::measured_list("periods", Dimension::TIME, "natural periods, longest first");

pub(crate) const MAX_BASE_SHEAR: ResultKind = ResultKind::measured(
    "max_base_shear",
    Dimension::FORCE,
    "largest size of the restoring force of the lowest storey, less what noise adds to it",
);

pub(crate) const ENERGY_ERROR: ResultKind = ResultKind::new(
    "energy_error",
    Dimension::NUMBER,
    "what the energy balance misses, over the input energy",
);

pub(crate) const STEPS: ResultKind = ResultKind::count("steps", "number of steps");

/// What it leaves, in the order of the tables and of `summary.json`.
pub(crate) const RESULTS: &[ResultKind] = &[
    MAX_DISPLACEMENT,
    MAX_DRIFT,
    FINAL_DRIFT,
    PERIODS,
    MAX_BASE_SHEAR,
    ENERGY_ERROR,
    STEPS,
    tracking::TRACKING_ENERGY_ERROR,
    tracking::TRACKING_INDICATOR,
    tracking::NRMS_ERROR,
    tracking::PEAK_ERROR,
    tracking::FLOOR_TRACKING_ENERGY_ERROR,
    tracking::FLOOR_TRACKING_INDICATOR,
    tracking::FLOOR_NRMS_ERROR,
    tracking::FLOOR_PEAK_ERROR,
];

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Shake,
    keyword: &["shake"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("ground", Kind::Ground, "what moves below").required("ground = sine"),
        SPECIMEN,
        Field::quantities(
            "damping_ratio",
            Dimension::NUMBER,
            "one: Rayleigh damping with this ratio in the first two modes; a list: each mode its own",
        )
        .within(0.0, 1.0)
        .or(0.0, ""),
        frames::DAMPING_UNCERTAINTY,
        methods::INTEGRATOR,
        methods::ALLOW_UNSTABLE,
        methods::I_MODIFICATION,
        methods::MODE,
        Field::quantity("time_step", Dimension::TIME, "Δt; may read `critical`, a tenth of the shortest period")
            .above_zero()
            .or_said("critical / 5"),
        Field::quantity("scale", Dimension::NUMBER, "factor on the record").or(1.0, ""),
        Field::quantity("duration", Dimension::TIME, "virtual time; past its record the ground rests")
            .above_zero()
            .or_said("to the end of the record"),
        Field::quantity("pause", Dimension::TIME, "wait at every step").or(0.0, "s").at_least_zero(),
        Field::quantity("max_tangent_ratio", Dimension::NUMBER, "the tangent stiffness stays in 0 .. this times K")
            .or(2.0, "")
            .above_zero(),
        Field::choices("inspect", INSPECT_TRIGGERS, "when a person is asked to look"),
    ],
    exports: &[],
    results: RESULTS,
    example: "shake quake {\n  ground = sine\n  damping_ratio = 2 %\n}",
    doc: "A frame on moving ground: an actuator and a load cell for each storey",
};
