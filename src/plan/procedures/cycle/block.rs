//! `cycle`: cycles of displacement, their protocols and results.

use crate::ProcedureBlock;
use crate::schema::curves;
use crate::schema::procedures::{SPECIMEN, SPEED};
use crate::schema::{BlockKind, Field, Kind, Naming, ResultKind, Variant};
use psd_text::units::Dimension;

pub const FIRST: Field = Field::quantity("first", Dimension::LENGTH, "smallest amplitude")
    .required("first: 1 mm")
    .above_zero();

pub const LAST: Field = Field::quantity("last", Dimension::LENGTH, "largest amplitude")
    .required("last: 10 mm")
    .above_zero();

pub const RATIO: Field =
    Field::quantity("ratio", Dimension::NUMBER, "ratio of successive amplitudes")
        .required("ratio: 1.4")
        .above_zero();

pub const LARGEST: Field =
    Field::quantity("largest", Dimension::LENGTH, "amplitude of the last level")
        .required("largest: 40 mm")
        .above_zero();

pub const LEVELS: Field = Field::count("levels", 1.0, 1000.0, "number of amplitudes");

const PROTOCOLS: &[Variant] = &[
    Variant::with(
        "ramped",
        &[
            FIRST,
            LAST,
            LEVELS
                .described("amplitudes from the first to the last")
                .required("levels: 10"),
        ],
        "amplitudes that grow by equal steps, one cycle each",
    ),
    Variant::with(
        "geometric",
        &[FIRST, RATIO, LEVELS.required("levels: 10")],
        "amplitudes that grow by a constant ratio, one cycle each",
    ),
    Variant::with(
        "fema_461",
        &[
            LARGEST,
            LEVELS
                .described("amplitudes up to the largest")
                .or(10.0, ""),
        ],
        "similar to FEMA 461 (2007): two cycles at each amplitude; amplitudes grow by 1.4 up to the largest",
    ),
];

pub const DISSIPATED_ENERGY: ResultKind = ResultKind::measured(
    "dissipated_energy",
    Dimension::ENERGY,
    "work done on the specimen in all cycles, ∫R dX",
);

pub const MAX_FORCE: ResultKind = ResultKind::measured(
    "max_force",
    Dimension::FORCE,
    "largest restoring force, minus the part due to noise",
);

pub const MIN_FORCE: ResultKind = ResultKind::measured(
    "min_force",
    Dimension::FORCE,
    "smallest (most negative) restoring force, corrected for noise",
);

pub const EQUIVALENT_DAMPING_RATIO: ResultKind = ResultKind::measured(
    "equivalent_damping_ratio",
    Dimension::NUMBER,
    "of the last cycle: E_D / (4π E_S0) with E_S0 = ½ K_sec a², a = half its width",
);

pub const STIFFNESS: ResultKind = ResultKind::measured(
    "stiffness",
    Dimension::STIFFNESS,
    "secant stiffness of the first cycle, from end to end",
);

pub const LAST_STIFFNESS: ResultKind = ResultKind::measured(
    "last_stiffness",
    Dimension::STIFFNESS,
    "secant stiffness of the last cycle",
);

pub const CYCLES: ResultKind = ResultKind::count("cycles", "number of complete cycles");

pub const AMPLITUDES: ResultKind = ResultKind::measured_list(
    "amplitudes",
    Dimension::LENGTH,
    "measured amplitude of each cycle (half its width)",
);

pub const ENERGIES: ResultKind =
    ResultKind::measured_list("energies", Dimension::ENERGY, "∫R dX of each cycle");

pub const DAMPING_RATIOS: ResultKind = ResultKind::measured_list(
    "damping_ratios",
    Dimension::NUMBER,
    "equivalent damping ratio of each cycle",
);

pub const STIFFNESSES: ResultKind = ResultKind::measured_list(
    "stiffnesses",
    Dimension::STIFFNESS,
    "secant stiffness of each cycle",
);

pub const YIELD_FORCE: ResultKind = ResultKind::measured(
    "yield_force",
    Dimension::FORCE,
    "force at which the backbone first softens (yield point)",
);

pub const YIELD_DISPLACEMENT: ResultKind = ResultKind::measured(
    "yield_displacement",
    Dimension::LENGTH,
    "displacement at the yield point, from the centre of the cycles",
);

pub const POST_YIELD_STIFFNESS: ResultKind = ResultKind::measured(
    "post_yield_stiffness",
    Dimension::STIFFNESS,
    "slope of the last segment of the backbone",
);

pub const POST_YIELD_RATIO: ResultKind = ResultKind::measured(
    "post_yield_ratio",
    Dimension::NUMBER,
    "post-yield over initial slope of the backbone",
);

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
    DISSIPATED_ENERGY,
    MAX_FORCE,
    MIN_FORCE,
    EQUIVALENT_DAMPING_RATIO,
    STIFFNESS,
    LAST_STIFFNESS,
    CYCLES,
    AMPLITUDES,
    ENERGIES,
    DAMPING_RATIOS,
    STIFFNESSES,
    YIELD_FORCE,
    YIELD_DISPLACEMENT,
    POST_YIELD_STIFFNESS,
    POST_YIELD_RATIO,
    curves::BREAKS,
    curves::BREAK_FORCES,
    curves::CURVE_STIFFNESSES,
];

pub const GIVEN_AMPLITUDES: Field = Field::quantities(
    "amplitudes",
    Dimension::LENGTH,
    "amplitudes of the cycles, in order; or `protocol`",
)
.above_zero()
.default_in_words("the protocol's");

pub const PROTOCOL: Field = Field::choice("protocol", PROTOCOLS, "rule for the amplitudes");

pub const REPEATS: Field = Field::count("repeats", 1.0, 1e5, "cycles at each amplitude")
    .default_in_words("1, or the protocol's");

pub const SIDES: Field = Field::choice(
    "sides",
    &[
        Variant::word("both", "reversed: to + the amplitude, to −, and back"),
        Variant::word("push", "to + the amplitude and back"),
        Variant::word("pull", "to − the amplitude and back"),
    ],
    "direction of the cycles",
)
.default_in_words("both");

pub const ABOUT: Field =
    Field::quantity("about", Dimension::LENGTH, "centre of the cycles").or(0.0, "mm");

pub const POINTS: Field = Field::count(
    "points",
    1.0,
    1e5,
    "targets between the centre and an amplitude",
)
.or(25.0, "");

pub const PAUSE: Field = Field::quantity(
    "pause",
    Dimension::TIME,
    "dwell at each target before the samples; with `rate`, at the ends only",
)
.or(0.0, "s")
.at_least_zero();

pub const SAMPLES: Field =
    Field::count("samples", 1.0, 1e5, "readings averaged at each target").or(1.0, "");

pub const RATE: Field = Field::quantity(
    "rate",
    Dimension::FREQUENCY,
    "sampling rate of cycles without stops; requires `speed`",
)
.above_zero()
.default_in_words("ramp-and-hold");

pub const AMPLITUDES_BETWEEN: Field =
    Field::count("amplitudes", 1.0, 1e5, "amplitudes between inspections").required("1");

pub const FRACTION: Field = Field::quantity(
    "fraction",
    Dimension::NUMBER,
    "fraction of the largest force so far",
)
.required("20 %")
.within(0.0, 1.0);

pub const INSPECT: Field = Field::choices(
    "inspect",
    &[
        Variant::with(
            "every",
            &[AMPLITUDES_BETWEEN],
            "after a fixed number of amplitudes",
        ),
        Variant::with(
            "force_drop",
            &[FRACTION],
            "when the largest force of an amplitude has fallen by this fraction",
        ),
    ],
    "when the operator inspects the specimen, between two amplitudes",
);

pub const FIT: Field = Field::choice(
    "fit",
    &[curves::MULTILINEAR],
    "curve fitted to the backbone: the ends of the first cycles, both directions together",
)
.default_in_words("nothing");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Cycle),
    keyword: &["cycle"],
    naming: Naming::Named,
    fields: &[
        SPECIMEN,
        GIVEN_AMPLITUDES,
        PROTOCOL,
        REPEATS,
        SIDES,
        ABOUT,
        POINTS,
        PAUSE,
        SAMPLES,
        SPEED,
        RATE,
        INSPECT,
        FIT,
    ],
    exports: &[],
    results: RESULTS,
    example: "cycle fatigue { amplitudes = [1, 2, 5] mm }",
    doc: "Reversed displacement cycles at given amplitudes: energy, damping and stiffness of each loop",
};
