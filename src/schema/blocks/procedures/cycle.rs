//! `cycle`: cycles of displacement, their protocols and results.

use crate::schema::blocks::curves;
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, Variant};
use crate::units::Dimension;

const PROTOCOLS: &[Variant] = &[
    Variant::with(
        "ramped",
        &[
            Field::quantity("first", Dimension::LENGTH, "smallest amplitude")
                .required("first: 1 mm")
                .above_zero(),
            Field::quantity("last", Dimension::LENGTH, "largest amplitude")
                .required("last: 10 mm")
                .above_zero(),
            Field::count(
                "levels",
                1.0,
                1000.0,
                "amplitudes from the first to the last",
            )
            .required("levels: 10"),
        ],
        "amplitudes that grow by equal steps, one cycle each",
    ),
    Variant::with(
        "geometric",
        &[
            Field::quantity("first", Dimension::LENGTH, "smallest amplitude")
                .required("first: 1 mm")
                .above_zero(),
            Field::quantity(
                "ratio",
                Dimension::NUMBER,
                "of one amplitude to the one before",
            )
            .required("ratio: 1.4")
            .above_zero(),
            Field::count("levels", 1.0, 1000.0, "how many amplitudes").required("levels: 10"),
        ],
        "amplitudes that grow by one ratio, one cycle each",
    ),
    Variant::with(
        "fema_461",
        &[
            Field::quantity("largest", Dimension::LENGTH, "amplitude of the last level")
                .required("largest: 40 mm")
                .above_zero(),
            Field::count("levels", 1.0, 1000.0, "amplitudes up to the largest").or(10.0, ""),
        ],
        "like FEMA 461 (2007): two cycles at each amplitude, each amplitude 1.4 times the one before, the largest last",
    ),
];

pub(crate) const DISSIPATED_ENERGY: ResultKind = ResultKind::measured(
    "dissipated_energy",
    Dimension::ENERGY,
    "work done on the specimen over all cycles, ∫R dX",
);

pub(crate) const MAX_FORCE: ResultKind = ResultKind::measured(
    "max_force",
    Dimension::FORCE,
    "largest restoring force, less what noise adds to the largest of many readings",
);

pub(crate) const MIN_FORCE: ResultKind = ResultKind::measured(
    "min_force",
    Dimension::FORCE,
    "smallest restoring force: the largest pull, less what noise adds to it",
);

pub(crate) const EQUIVALENT_DAMPING_RATIO: ResultKind = ResultKind::measured(
    "equivalent_damping_ratio",
    Dimension::NUMBER,
    "of the last cycle: E_D / (4π E_S0) with E_S0 = ½ K_sec a², a half its width",
);

pub(crate) const STIFFNESS: ResultKind = ResultKind::measured(
    "stiffness",
    Dimension::STIFFNESS,
    "secant stiffness of the first cycle, from end to end",
);

pub(crate) const LAST_STIFFNESS: ResultKind = ResultKind::measured(
    "last_stiffness",
    Dimension::STIFFNESS,
    "secant stiffness of the last cycle",
);

pub(crate) const CYCLES: ResultKind = ResultKind::count("cycles", "number of whole cycles");

pub(crate) const AMPLITUDES: ResultKind = ResultKind::measured_list(
    "amplitudes",
    Dimension::LENGTH,
    "half the width of each cycle as measured",
);

pub(crate) const ENERGIES: ResultKind =
    ResultKind::measured_list("energies", Dimension::ENERGY, "∫R dX of each cycle");

pub(crate) const DAMPING_RATIOS: ResultKind = ResultKind::measured_list(
    "damping_ratios",
    Dimension::NUMBER,
    "equivalent damping ratio of each cycle",
);

pub(crate) const STIFFNESSES: ResultKind = ResultKind::measured_list(
    "stiffnesses",
    Dimension::STIFFNESS,
    "secant stiffness of each cycle",
);

pub(crate) const YIELD_FORCE: ResultKind = ResultKind::measured(
    "yield_force",
    Dimension::FORCE,
    "force where the curve of the backbone first softens",
);

pub(crate) const YIELD_DISPLACEMENT: ResultKind = ResultKind::measured(
    "yield_displacement",
    Dimension::LENGTH,
    "displacement there, from the middle of the cycles",
);

pub(crate) const HARDENED_STIFFNESS: ResultKind = ResultKind::measured(
    "hardened_stiffness",
    Dimension::STIFFNESS,
    "slope of the last stretch of the backbone",
);

pub(crate) const HARDENING: ResultKind = ResultKind::measured(
    "hardening",
    Dimension::NUMBER,
    "that slope over the first one",
);

/// What it leaves, in the order of the tables and of `summary.json`.
pub(crate) const RESULTS: &[ResultKind] = &[
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
    HARDENED_STIFFNESS,
    HARDENING,
    curves::BREAKS,
    curves::BREAK_UNCERTAINTIES,
    curves::BREAK_FORCES,
    curves::BREAK_FORCE_UNCERTAINTIES,
    curves::CURVE_STIFFNESSES,
    curves::CURVE_STIFFNESS_UNCERTAINTIES,
];

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Cycle,
    keyword: &["cycle"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("specimen", Kind::Specimen, "what is tested")
            .or_said("the only one declared"),
        Field::quantities(
            "amplitudes",
            Dimension::LENGTH,
            "largest displacements of the cycles, in order; or `protocol`",
        )
        .above_zero()
        .or_said("the protocol's"),
        Field::choice("protocol", PROTOCOLS, "amplitudes by rule"),
        Field::count("repeats", 1.0, 1e5, "cycles at each amplitude")
            .or_said("1, or the protocol's"),
        Field::choice(
            "sides",
            &[
                Variant::word("both", "reversed: to + the amplitude, to −, and back"),
                Variant::word("push", "to + the amplitude and back"),
                Variant::word("pull", "to − the amplitude and back"),
            ],
            "to which sides of the middle the cycles go",
        )
        .or_said("both"),
        Field::quantity("about", Dimension::LENGTH, "the middle of the cycles").or(0.0, "mm"),
        Field::count(
            "points",
            1.0,
            1e5,
            "targets between the middle and an amplitude",
        )
        .or(25.0, ""),
        Field::quantity(
            "pause",
            Dimension::TIME,
            "wait at each target before the samples; with `rate` at each end of a way",
        )
        .or(0.0, "s")
        .at_least_zero(),
        Field::count("samples", 1.0, 1e5, "readings averaged at each target").or(1.0, ""),
        Field::quantity("speed", Dimension::VELOCITY, "actuator speed")
            .above_zero()
            .or_said("the rig's own"),
        Field::quantity(
            "rate",
            Dimension::FREQUENCY,
            "sampling rate of cycles that are moved without stopping, at `speed`",
        )
        .above_zero()
        .or_said("step and pause"),
        Field::choices(
            "inspect",
            &[
                Variant::with(
                    "every",
                    &[
                        Field::count("amplitudes", 1.0, 1e5, "amplitudes between looks")
                            .required("1"),
                    ],
                    "after every so many amplitudes",
                ),
                Variant::with(
                    "force_drop",
                    &[Field::quantity(
                        "fraction",
                        Dimension::NUMBER,
                        "of the largest force so far",
                    )
                    .required("20 %")
                    .within(0.0, 1.0)],
                    "when the largest force of an amplitude has fallen",
                ),
            ],
            "when a person is asked to look, between two amplitudes",
        ),
        Field::choice(
            "fit",
            &[curves::MULTILINEAR],
            "what is fitted to the backbone: the ends of the first cycles, both sides on one",
        )
        .or_said("nothing"),
    ],
    exports: &[],
    results: RESULTS,
    example: "cycle fatigue { amplitudes = [1, 2, 5] mm }",
    doc: "Reversed cycles of displacement at given amplitudes: energy, damping and stiffness of each loop",
};
