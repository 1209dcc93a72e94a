//! `stiffness ramp`: its block and its results.

use crate::ProcedureBlock;
use crate::schema::curves;
use crate::schema::methods::TRUTH;
use crate::schema::procedures::{SPECIMEN, SPEED};
use crate::schema::{BlockKind, Field, Kind, Naming, Possible, ResultKind, Variant};
use psd_text::units::Dimension;

pub const ACCURACY: Field = Field::quantity(
    "accuracy",
    Dimension::FORCE,
    "force accuracy wanted; determines the required dwell time",
)
.above_zero()
.default_in_words("`noise` of the load cell");

pub const ALLOWED_RATE: Field = Field::quantity(
    "rate",
    Dimension::FORCE_RATE,
    "force rate allowed at the end of a pause; determines the required dwell time",
)
.required("rate: 1 N/s")
.above_zero();

const WATCHED: &[Field] = &[READINGS, ACCURACY];

pub const READINGS: Field = Field::count(
    "readings",
    3.0,
    10_000.0,
    "readings in each pause, denser at the start",
)
.or(20.0, "");

const SLOW_ENOUGH: &[Field] = &[READINGS, ALLOWED_RATE];

const FITS: &[Variant] = &[
    Variant::word("linear", "one straight line through all outward steps"),
    Variant::word(
        "bilinear",
        "two lines that meet at a yield point, through the outward steps of the first repeat",
    ),
    curves::MULTILINEAR,
];

const RELAXATION_MODELS: &[Variant] = &[
    Variant::with(
        "exponential",
        WATCHED,
        "R∞ + A e^(−t/τ) in every pause, with a common τ",
    ),
    Variant::with(
        "standard_linear_solid",
        WATCHED,
        "spring in parallel with spring and dashpot, through all moves and pauses; constant velocity in \
         moves, dwell while settling",
    ),
    Variant::with(
        "logarithmic",
        SLOW_ENOUGH,
        "R falls by a ln(1 + t/t₀) of the unrelaxed force, through all moves and pauses; constant \
         velocity in moves, dwell while settling",
    ),
    Variant::with(
        "either",
        SLOW_ENOUGH,
        "logarithmic, or g (1 − e^(−t/τ)) of the unrelaxed force, by BIC",
    ),
];

pub const STIFFNESS: ResultKind = ResultKind::measured(
    "stiffness",
    Dimension::STIFFNESS,
    "slope of the line fitted to force against displacement; of the first segment in other fits",
);

pub const SECANT_STIFFNESS: ResultKind = ResultKind::measured(
    "secant_stiffness",
    Dimension::STIFFNESS,
    "force over displacement of the first increment",
);

pub const INTERCEPT_FORCE: ResultKind = ResultKind::measured(
    "intercept_force",
    Dimension::FORCE,
    "fitted force at zero displacement",
);

pub const R_SQUARED: ResultKind = ResultKind::new(
    "r_squared",
    Dimension::NUMBER,
    "coefficient of determination of the fit",
)
.near_one();

pub const MAX_FORCE: ResultKind = ResultKind::measured(
    "max_force",
    Dimension::FORCE,
    "peak absolute restoring force, minus the part due to noise",
);

pub const MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "max_displacement",
    Dimension::LENGTH,
    "peak absolute measured displacement",
)
.within(Possible::PeakDisplacement);

pub const LOOP_ENERGY: ResultKind = ResultKind::measured(
    "loop_energy",
    Dimension::ENERGY,
    "energy of the hysteresis loop, with `return = true`",
);

pub const RELAXATION: ResultKind = ResultKind::measured(
    "relaxation",
    Dimension::FORCE,
    "mean force lost during a pause",
);

pub const TANGENT_STIFFNESS: ResultKind = ResultKind::measured(
    "tangent_stiffness",
    Dimension::STIFFNESS,
    "secant of the last outward step: tangent at the end of the ramp",
);

pub const YIELD_FORCE: ResultKind = ResultKind::measured(
    "yield_force",
    Dimension::FORCE,
    "force at the yield point of a bilinear or multilinear fit",
);

pub const YIELD_DISPLACEMENT: ResultKind = ResultKind::measured(
    "yield_displacement",
    Dimension::LENGTH,
    "displacement at the yield point",
);

pub const POST_YIELD_STIFFNESS: ResultKind = ResultKind::measured(
    "post_yield_stiffness",
    Dimension::STIFFNESS,
    "post-yield slope, or slope of the last segment",
);

pub const POST_YIELD_RATIO: ResultKind = ResultKind::measured(
    "post_yield_ratio",
    Dimension::NUMBER,
    "post-yield over initial slope",
);

pub const TIME_CONSTANT: ResultKind = ResultKind::measured(
    "time_constant",
    Dimension::TIME,
    "τ of the relaxation, with `relaxation`",
)
.fitted_to_dwells();

pub const RELAXED_STIFFNESS: ResultKind = ResultKind::measured(
    "relaxed_stiffness",
    Dimension::STIFFNESS,
    "slope of the fully relaxed forces",
)
.fitted_to_dwells();

pub const BRANCH_STIFFNESS: ResultKind = ResultKind::measured(
    "branch_stiffness",
    Dimension::STIFFNESS,
    "stiffness of the relaxing part of a standard linear solid",
)
.fitted_to_dwells();

pub const REMAINING_RELAXATION: ResultKind = ResultKind::measured(
    "remaining_relaxation",
    Dimension::FORCE,
    "largest remaining relaxation at the end of a pause",
)
.fitted_to_dwells();

pub const REQUIRED_PAUSE: ResultKind = ResultKind::measured(
    "required_pause",
    Dimension::TIME,
    "required dwell time for the requested `accuracy` or `rate`",
)
.fitted_to_dwells();

pub const RELAXATION_SHARE: ResultKind = ResultKind::measured(
    "relaxation_share",
    Dimension::NUMBER,
    "a or g: relaxed fraction of the unrelaxed force; only laws with a fraction",
)
.fitted_to_dwells();

pub const REFERENCE_TIME: ResultKind = ResultKind::measured(
    "reference_time",
    Dimension::TIME,
    "t₀ of the logarithmic law",
)
.fitted_to_dwells();

pub const RELAXATION_RATE: ResultKind = ResultKind::measured(
    "relaxation_rate",
    Dimension::FORCE_RATE,
    "largest force rate at the end of a pause",
)
.fitted_to_dwells();

pub const BIC_MARGIN: ResultKind = ResultKind::new(
    "bic_margin",
    Dimension::NUMBER,
    "BIC of the exponential minus BIC of the logarithm, with `either`; positive: the logarithm fits better",
);

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
    STIFFNESS,
    SECANT_STIFFNESS,
    INTERCEPT_FORCE,
    R_SQUARED,
    MAX_FORCE,
    MAX_DISPLACEMENT,
    LOOP_ENERGY,
    RELAXATION,
    TANGENT_STIFFNESS,
    YIELD_FORCE,
    YIELD_DISPLACEMENT,
    POST_YIELD_STIFFNESS,
    POST_YIELD_RATIO,
    curves::BREAKS,
    curves::BREAK_FORCES,
    curves::CURVE_STIFFNESSES,
    TIME_CONSTANT,
    RELAXED_STIFFNESS,
    BRANCH_STIFFNESS,
    REMAINING_RELAXATION,
    REQUIRED_PAUSE,
    RELAXATION_SHARE,
    REFERENCE_TIME,
    RELAXATION_RATE,
    BIC_MARGIN,
];

pub const DISPLACEMENTS: Field =
    Field::quantities("displacements", Dimension::LENGTH, "targets in order")
        .required("displacements = 0.1 mm .. 1 mm step 0.1 mm");

pub const PAUSE: Field = Field::quantity(
    "pause",
    Dimension::TIME,
    "dwell at each target before the samples",
)
.or(0.0, "s")
.at_least_zero();

pub const SAMPLES: Field =
    Field::count("samples", 1.0, 1e5, "readings averaged at each target").or(1.0, "");

pub const REPEATS: Field =
    Field::count("repeats", 1.0, 1e5, "number of repetitions of the ramp").or(1.0, "");

pub const RETURN: Field =
    Field::choice("return", TRUTH, "returns through the same targets").default_in_words("false");

pub const FIT: Field = Field::choice("fit", FITS, "curve fitted to force against displacement")
    .default_in_words("linear");

pub const WATCHED_RELAXATION: Field = Field::choice(
    "relaxation",
    RELAXATION_MODELS,
    "relaxation law fitted to the forces in the pauses of the first repeat",
)
.default_in_words("nothing");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::StiffnessRamp),
    keyword: &["stiffness", "ramp"],
    naming: Naming::Named,
    fields: &[
        SPECIMEN,
        DISPLACEMENTS,
        PAUSE,
        SAMPLES,
        REPEATS,
        RETURN,
        FIT,
        WATCHED_RELAXATION,
        SPEED,
    ],
    exports: &[],
    results: RESULTS,
    example: "stiffness ramp k0 { displacements = 0.1 mm .. 1 mm step 0.1 mm }",
    doc: "Displacement steps with a pause at each: stiffness by least squares",
};
