//! `stiffness ramp`: its block and its results.

use super::{SPECIMEN, SPEED};
use crate::schema::blocks::{curves, methods};
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, Variant};
use crate::units::Dimension;

const WATCHED: &[Field] = &[
    READINGS,
    Field::quantity(
        "accuracy",
        Dimension::FORCE,
        "to which the force is to be known: how long a pause must be",
    )
    .above_zero()
    .or_said("the declared noise of the load cell"),
];

const READINGS: Field =
    Field::count("readings", 3.0, 10_000.0, "in each pause, closer at first").or(20.0, "");

const SLOW_ENOUGH: &[Field] = &[
    READINGS,
    Field::quantity(
        "rate",
        Dimension::FORCE_RATE,
        "how fast a pause may still lose force at its end: how long it must be",
    )
    .required("rate: 1 N/s")
    .above_zero(),
];

pub(crate) const STIFFNESS: ResultKind = ResultKind::measured(
    "stiffness",
    Dimension::STIFFNESS,
    "slope of the straight line fitted to force on displacement; of a bilinear or multilinear fit that of the first stretch",
);

pub(crate) const SECANT_STIFFNESS: ResultKind = ResultKind::measured(
    "secant_stiffness",
    Dimension::STIFFNESS,
    "force over displacement of the first increment",
);

pub(crate) const INTERCEPT_FORCE: ResultKind = ResultKind::measured(
    "intercept_force",
    Dimension::FORCE,
    "force of the fitted line at no displacement",
);

pub(crate) const R_SQUARED: ResultKind = ResultKind::new(
    "r_squared",
    Dimension::NUMBER,
    "coefficient of determination of the fit",
);

pub(crate) const MAX_FORCE: ResultKind = ResultKind::measured(
    "max_force",
    Dimension::FORCE,
    "largest size of the restoring force, less what noise adds to the largest of many readings",
);

pub(crate) const MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "max_displacement",
    Dimension::LENGTH,
    "largest size of the measured displacement",
);

pub(crate) const LOOP_ENERGY: ResultKind = ResultKind::measured(
    "loop_energy",
    Dimension::ENERGY,
    "energy of the hysteresis loop, with `return = true`",
);

pub(crate) const RELAXATION: ResultKind = ResultKind::measured(
    "relaxation",
    Dimension::FORCE,
    "mean loss of force during a pause",
);

pub(crate) const TANGENT_STIFFNESS: ResultKind = ResultKind::measured(
    "tangent_stiffness",
    Dimension::STIFFNESS,
    "secant of the last outward step: the tangent where the ramp ended",
);

pub(crate) const YIELD_FORCE: ResultKind = ResultKind::measured(
    "yield_force",
    Dimension::FORCE,
    "force at the knee of a bilinear fit, or where a multilinear one first softens",
);

pub(crate) const YIELD_DISPLACEMENT: ResultKind = ResultKind::measured(
    "yield_displacement",
    Dimension::LENGTH,
    "displacement there",
);

pub(crate) const HARDENED_STIFFNESS: ResultKind = ResultKind::measured(
    "hardened_stiffness",
    Dimension::STIFFNESS,
    "slope past the knee, or of the last stretch",
);

pub(crate) const HARDENING: ResultKind = ResultKind::measured(
    "hardening",
    Dimension::NUMBER,
    "that slope over the first one",
);

pub(crate) const TIME_CONSTANT: ResultKind = ResultKind::measured(
    "time_constant",
    Dimension::TIME,
    "τ of the relaxation, with `relaxation`",
);

pub(crate) const RELAXED_STIFFNESS: ResultKind = ResultKind::measured(
    "relaxed_stiffness",
    Dimension::STIFFNESS,
    "slope of the forces when all has relaxed",
);

pub(crate) const BRANCH_STIFFNESS: ResultKind = ResultKind::measured(
    "branch_stiffness",
    Dimension::STIFFNESS,
    "what relaxes of a standard linear solid",
);

pub(crate) const REMAINING_RELAXATION: ResultKind = ResultKind::measured(
    "remaining_relaxation",
    Dimension::FORCE,
    "largest force that a pause left to relax",
);

pub(crate) const NEEDED_PAUSE: ResultKind = ResultKind::measured(
    "needed_pause",
    Dimension::TIME,
    "pause that leaves no more to relax than the accuracy asked for, or ends at the rate asked for",
);

pub(crate) const RELAXATION_SHARE: ResultKind = ResultKind::measured(
    "relaxation_share",
    Dimension::NUMBER,
    "a or g: what the law takes of a reached force, with a law of it",
);

pub(crate) const REFERENCE_TIME: ResultKind = ResultKind::measured(
    "reference_time",
    Dimension::TIME,
    "t₀ of the logarithm of time",
);

pub(crate) const RELAXATION_RATE: ResultKind = ResultKind::measured(
    "relaxation_rate",
    Dimension::FORCE_RATE,
    "how fast the worst pause was losing force at its end",
);

pub(crate) const BIC_MARGIN: ResultKind = ResultKind::new(
    "bic_margin",
    Dimension::NUMBER,
    "BIC of the exponential less that of the logarithm, with `either`: above zero it is the logarithm",
);

/// What it leaves, in the order of the tables and of `summary.json`.
pub(crate) const RESULTS: &[ResultKind] = &[
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
    HARDENED_STIFFNESS,
    HARDENING,
    curves::BREAKS,
    curves::BREAK_UNCERTAINTIES,
    curves::BREAK_FORCES,
    curves::BREAK_FORCE_UNCERTAINTIES,
    curves::CURVE_STIFFNESSES,
    curves::CURVE_STIFFNESS_UNCERTAINTIES,
    TIME_CONSTANT,
    RELAXED_STIFFNESS,
    BRANCH_STIFFNESS,
    REMAINING_RELAXATION,
    NEEDED_PAUSE,
    RELAXATION_SHARE,
    REFERENCE_TIME,
    RELAXATION_RATE,
    BIC_MARGIN,
];

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::StiffnessRamp,
    keyword: &["stiffness", "ramp"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        SPECIMEN,
        Field::quantities("displacements", Dimension::LENGTH, "targets in order")
            .required("displacements = 0.1 mm .. 1 mm step 0.1 mm"),
        Field::quantity("pause", Dimension::TIME, "wait at each target before the samples").or(0.0, "s").at_least_zero(),
        Field::count("samples", 1.0, 1e5, "readings averaged at each target").or(1.0, ""),
        Field::count("repeats", 1.0, 1e5, "times the ramp is run").or(1.0, ""),
        Field::choice("return", methods::TRUTH, "whether it also goes back through the same targets").or_said("false"),
        Field::choice(
            "fit",
            &[
                Variant::word("linear", "one straight line through all outward steps"),
                Variant::word("bilinear", "two lines that meet at a knee, through the outward steps of the first repeat"),
                curves::MULTILINEAR,
            ],
            "what is fitted to force on displacement",
        )
        .or_said("linear"),
        Field::choice(
            "relaxation",
            &[
                Variant::with("exponential", WATCHED, "R∞ + A e^(−t/τ) in every pause, one τ for all"),
                Variant::with(
                    "standard_linear_solid",
                    WATCHED,
                    "a spring beside a spring and a dashpot, through all moves and pauses; a move is taken as even, and the settling after it as held",
                ),
                Variant::with(
                    "logarithmic",
                    SLOW_ENOUGH,
                    "R falls by a ln(1 + t/t₀) of the reached force, through all moves and pauses; a move is taken as even, and the settling after it as held",
                ),
                Variant::with(
                    "either",
                    SLOW_ENOUGH,
                    "that, or by g (1 − e^(−t/τ)) of the reached force: the law that the readings prefer by BIC",
                ),
            ],
            "what is fitted to the force while it is held, in the pauses of the first repeat",
        )
        .or_said("nothing"),
        SPEED,
    ],
    exports: &[],
    results: RESULTS,
    example: "stiffness ramp k0 { displacements = 0.1 mm .. 1 mm step 0.1 mm }",
    doc: "Prescribed displacements, a pause at each: the stiffness by least squares",
};
