//! `shake`: its block and its results.

use crate::ProcedureBlock;
use crate::schema::procedures::{SPECIMEN, tracking};
use crate::schema::{BlockKind, Field, Kind, Naming, Peak, Possible, ResultKind, Variant};
use crate::schema::{frames, methods};
use psd_text::units::Dimension;

pub const MAX_DISPLACEMENT: ResultKind = ResultKind::measured_list(
    "max_displacement",
    Dimension::LENGTH,
    "peak absolute displacement of each floor, relative to the ground",
)
.within(Possible::PeakDisplacement)
.final_after(Peak::FloorDisplacement);

pub const MAX_DRIFT: ResultKind = ResultKind::measured_list(
    "max_drift",
    Dimension::LENGTH,
    "peak absolute drift of each storey, or deformation of each element",
)
.within(Possible::NotNegative)
.of_each_member()
.final_after(Peak::Drift);

pub const FINAL_DRIFT: ResultKind = ResultKind::measured_list(
    "final_drift",
    Dimension::LENGTH,
    "drift of each storey, or deformation of each element, at the last step of the run",
)
.of_each_member();

pub const PERIODS: ResultKind =
    ResultKind::measured_list("periods", Dimension::TIME, "natural periods, longest first")
        .within(Possible::NotNegative);

pub const MAX_BASE_SHEAR: ResultKind = ResultKind::measured(
    "max_base_shear",
    Dimension::FORCE,
    "peak absolute base shear, net of P-Δ, minus the part due to noise",
)
.final_after(Peak::BaseShear);

pub const MAX_ELEMENT_FORCE: ResultKind = ResultKind::measured_list(
    "max_element_force",
    Dimension::FORCE,
    "peak absolute force of each element, minus the part due to noise; only with `elements`",
)
.within(Possible::NotNegative)
.of_each_member()
.of_elements()
.final_after(Peak::ElementForce);

pub const ENERGY_ERROR: ResultKind = ResultKind::new(
    "energy_error",
    Dimension::NUMBER,
    "residual of the energy balance relative to the input energy",
)
.in_percent();

pub const STEPS: ResultKind = ResultKind::count("steps", "number of steps");

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
    MAX_DISPLACEMENT,
    MAX_DRIFT,
    FINAL_DRIFT,
    PERIODS,
    MAX_BASE_SHEAR,
    ENERGY_ERROR,
    STEPS,
    MAX_ELEMENT_FORCE,
    tracking::TRACKING_ENERGY_ERROR,
    tracking::TRACKING_INDICATOR,
    tracking::NRMS_ERROR,
    tracking::PEAK_ERROR,
    tracking::FLOOR_TRACKING_ENERGY_ERROR,
    tracking::FLOOR_TRACKING_INDICATOR,
    tracking::FLOOR_NRMS_ERROR,
    tracking::FLOOR_PEAK_ERROR,
];

pub const GROUND: Field =
    Field::reference("ground", Kind::Ground, "ground motion").required("ground = sine");

pub const SCALE: Field =
    Field::quantity("scale", Dimension::NUMBER, "factor on the record").or(1.0, "");

pub const UNTIL: Field = Field::choice(
    "until",
    &[
        methods::DRIFT_REACHED,
        Variant::word("duration", "the whole `duration`"),
    ],
    "end condition",
)
.default_in_words("duration");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Shake),
    keyword: &["shake"],
    naming: Naming::Named,
    fields: &[
        GROUND,
        SPECIMEN,
        frames::DAMPING_RATIO,
        frames::DAMPING_UNCERTAINTY,
        methods::INTEGRATOR,
        methods::ALLOW_UNSTABLE,
        methods::I_MODIFICATION,
        methods::MODE,
        methods::TIME_STEP
            .described("Δt; can use `critical`, a tenth of the shortest period")
            .default_in_words("critical / 5"),
        SCALE,
        methods::DURATION
            .described("simulated time; after the record the ground is at rest")
            .default_in_words("to the end of the record"),
        UNTIL,
        methods::PAUSE,
        methods::MAX_TANGENT_RATIO,
        methods::INSPECT,
    ],
    exports: &[],
    results: RESULTS,
    example: "shake quake {\n  ground = sine\n  damping_ratio = 2 %\n}",
    doc: "Ground-motion test of a frame, with one actuator and load cell per storey",
};
