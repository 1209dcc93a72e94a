//! `rig NAME { … }`: the rig that moves the specimen.

use super::devices::{LONGEST_WAIT, SERIAL, TCP};
use crate::schema::types::{BlockKind, Field, Kind, Naming, RigKind, Variant};
use crate::units::Dimension;

const VIRTUAL: Variant = Variant::with(
    "virtual",
    &[
        Field::quantity(
            "noise",
            Dimension::FORCE,
            "standard deviation of the load cell",
        )
        .or(0.0, "N")
        .at_least_zero(),
        Field::quantity(
            "resolution",
            Dimension::LENGTH,
            "quantum of the displacement reading",
        )
        .or(0.0, "mm")
        .at_least_zero(),
        Field::quantity(
            "force_resolution",
            Dimension::FORCE,
            "quantum of the force reading",
        )
        .or(0.0, "N")
        .at_least_zero(),
        Field::quantity(
            "lag",
            Dimension::TIME,
            "first-order time constant of the actuator",
        )
        .or(0.0, "s")
        .at_least_zero(),
        Field::quantity(
            "tracking",
            Dimension::NUMBER,
            "fraction of each increment not reached",
        )
        .or(0.0, "")
        .within(-1.0, 1.0),
        Field::quantity("drift", Dimension::FORCE_RATE, "drift of the load cell").or(0.0, "N/s"),
        Field::count("seed", 0.0, 9_007_199_254_740_992.0, "seed of the noise").or(0.0, ""),
    ],
    "no hardware: bends the specimen's behaviour",
);

const SETTLE: &[Variant] = &[Variant::with(
    "within",
    &[
        Field::quantity(
            "displacement",
            Dimension::LENGTH,
            "displacement stays this near its target",
        )
        .required("0.01 mm")
        .at_least_zero(),
        Field::quantity(
            "force_rate",
            Dimension::FORCE_RATE,
            "the force changes no faster than this",
        )
        .required("5 N/s")
        .at_least_zero(),
        Field::quantity("for", Dimension::TIME, "for this long")
            .or(0.0, "s")
            .at_least_zero(),
        Field::quantity("timeout", Dimension::TIME, "longest wait")
            .or(10.0, "s")
            .above_zero_up_to(LONGEST_WAIT),
    ],
    "a reading counts when it stayed within these bounds",
)];

const GATE: &[Variant] = &[Variant::with(
    "probe",
    &[
        Field::quantity(
            "displacement",
            Dimension::LENGTH,
            "a tiny move from the start",
        )
        .required("0.02 mm")
        .above_zero(),
        Field::interval(
            "stiffness",
            Dimension::STIFFNESS,
            "stiffness that it must show, which proves sign, unit and scale",
        )
        .required("stiffness: 250 kN/m .. 350 kN/m")
        .above_zero(),
        Field::quantity(
            "zero",
            Dimension::FORCE,
            "force at rest before it, by size, at most",
        )
        .required("zero: 20 N")
        .above_zero(),
    ],
    "a tiny move whose stiffness must be as expected",
)];

/// Where the force of a rig is known again when its run is over.
const AFTER: &[Variant] = &[
    Variant::word(
        "start",
        "back where the run began, which the rig goes to when all is done; of a specimen that is as it was",
    ),
    Variant::word(
        "free",
        "where it is, when a person has taken the specimen off the load cell and says so",
    ),
    Variant::word("nowhere", "the zero is not read again"),
];

const DRIFT: &[Variant] = &[Variant::with(
    "within",
    &[
        Field::quantity(
            "force",
            Dimension::FORCE,
            "change of the zero of the force, by size, at most",
        )
        .required("5 N")
        .above_zero(),
        Field::quantity(
            "displacement",
            Dimension::LENGTH,
            "change of displacement less target, by size, at most",
        )
        .above_zero()
        .or_said("told, not judged"),
        Field::quantity(
            "over",
            Dimension::TIME,
            "time over which a zero is read; a hold as long tells a slope",
        )
        .or(5.0, "s")
        .above_zero_up_to(LONGEST_WAIT),
        Field::choice("after", AFTER, "how the zero is read after the test").or_said("start"),
    ],
    "a run whose zeros drift farther decides nothing that its readings enter",
)];

const SIGN: &[Variant] = &[
    Variant::word("positive", "the rig's positive direction is the striker's"),
    Variant::word(
        "negative",
        "the rig's positive direction is against the striker's",
    ),
];

/// The zero of the plan's displacements.
const DATUM: &[Variant] = &[
    Variant::word(
        "machine",
        "the rig's own zero; a rig that stands elsewhere when the run begins is refused",
    ),
    Variant::word(
        "here",
        "where the rig stands when the run begins, its specimen without load; on record",
    ),
];

/// The entries of one axis, each in place of the rig's own.
const AXIS: &[Variant] = &[Variant::with(
    "axis",
    &[
        Field::choice("sign", SIGN, "direction of its displacement and force").or_said("the rig's"),
        Field::choice("gate", GATE, "what its tiny move must show").or_said("the rig's"),
        Field::choice(
            "actuator",
            &[SERIAL, TCP],
            "the device that moves it, where it is another than the rig's",
        )
        .or_said("the rig's"),
        Field::choice(
            "load_cell",
            &[SERIAL, TCP],
            "the device that reads its force, where it is another than the rig's",
        )
        .or_said("the rig's"),
        Field::quantity(
            "force_per_count",
            Dimension::FORCE,
            "of a load cell that gives raw counts; not 0",
        )
        .or_said("the rig's"),
        Field::quantity("zero_count", Dimension::NUMBER, "count at no force").or_said("the rig's"),
        Field::bounds(
            "displacement",
            Dimension::LENGTH,
            true,
            "limit of its targets and readings, beside those of the run",
        ),
        Field::bounds(
            "force",
            Dimension::FORCE,
            true,
            "limit of its readings, beside those of the run",
        ),
        Field::quantity(
            "resolution",
            Dimension::LENGTH,
            "quantum of its displacement reading",
        )
        .at_least_zero()
        .or_said("the rig's"),
        Field::quantity(
            "noise",
            Dimension::FORCE,
            "standard deviation of one of its force readings",
        )
        .at_least_zero()
        .or_said("the rig's"),
        Field::bounds(
            "force_range",
            Dimension::FORCE,
            true,
            "what its load cell can read",
        )
        .or_said("the rig's"),
        Field::text(
            "calibration",
            "reference of its calibration; of its force alone, where its displacement has one",
        )
        .or_said("the rig's"),
        Field::text("calibration_due", "last day on which its calibration holds")
            .or_said("the rig's"),
        Field::text("force_class", "class of its force measurement").or_said("the rig's"),
        Field::bounds(
            "force_calibration_range",
            Dimension::FORCE,
            false,
            "forces, by size, over which that holds",
        )
        .or_said("the rig's"),
        Field::text(
            "displacement_calibration",
            "reference of the calibration of its displacement",
        )
        .or_said("the rig's"),
        Field::text(
            "displacement_calibration_due",
            "last day on which that calibration holds",
        )
        .or_said("the rig's"),
        Field::text(
            "displacement_class",
            "class of its displacement measurement",
        )
        .or_said("the rig's"),
        Field::bounds(
            "displacement_calibration_range",
            Dimension::LENGTH,
            false,
            "displacements, by size, over which that holds",
        )
        .or_said("the rig's"),
        Field::quantity(
            "force_uncertainty",
            Dimension::NUMBER,
            "standard uncertainty of its force calibration",
        )
        .within(0.0, 0.2)
        .or_said("the rig's"),
        Field::quantity(
            "displacement_uncertainty",
            Dimension::NUMBER,
            "standard uncertainty of its displacement calibration",
        )
        .within(0.0, 0.2)
        .or_said("the rig's"),
        Field::quantity(
            "zero_uncertainty",
            Dimension::FORCE,
            "standard uncertainty of its reading of no force",
        )
        .at_least_zero()
        .or_said("the rig's"),
    ],
    "an actuator with its load cell",
)];

pub(crate) const RIG: BlockKind = BlockKind {
    kind: Kind::Rig,
    keyword: &["rig"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::choice("link", &[VIRTUAL, SERIAL, TCP], "how the rig is reached; or `actuator` and `load_cell`, each its own")
            .required("link = virtual(noise: 2 N, seed: 7)"),
        Field::choice("actuator", &[SERIAL, TCP], "the device that moves").of_real_rigs(),
        Field::choice("load_cell", &[SERIAL, TCP], "the device that reads the force").of_real_rigs(),
        Field::choice("settle", SETTLE, "when a reading counts").required_on(
            RigKind::Real,
            "settle = within(0.01 mm, 5 N/s, for: 0.3 s)",
            "at once",
        ),
        Field::choice(
            "safe_state",
            &[
                Variant::word("hold", "stops and keeps the load"),
                Variant::word("unload", "holds; after a limit it goes back to where the run began, and where a person ended the run or stands by only when asked and told yes"),
            ],
            "what it does when a run ends early",
        )
        .required_on(RigKind::Real, "safe_state = hold", "")
        .of_real_rigs(),
        Field::choice("gate", GATE, "what must be so before the first step")
            .required_on(RigKind::Real, "gate = probe(0.02 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)", "")
            .of_real_rigs(),
        Field::choice("drift", DRIFT, "how far its zeros may drift in a run, and how they are read").or_said("not asked"),
        Field::reference("limits", Kind::Limits, "a named `limits` block that holds whenever this rig moves"),
        Field::choices("axes", AXIS, "its actuators, each with its load cell, one a storey from the ground up")
            .or_said("one axis")
            .of_real_rigs(),
        Field::choice("sign", SIGN, "direction of the rig's displacement and force").or_said("positive"),
        Field::choice("datum", DATUM, "where the plan's displacements are 0").or_said("machine").of_real_rigs(),
        Field::quantity("speed", Dimension::VELOCITY, "speed of a move for which nothing else is said")
            .or(1.0, "mm/s")
            .above_zero()
            .of_real_rigs(),
        Field::quantity(
            "watchdog",
            Dimension::TIME,
            "longest silence between program and rig; past it the rig is to hold by itself",
        )
        .or(3.0, "s")
        .above_zero_up_to(LONGEST_WAIT)
        .of_real_rigs(),
        Field::quantity("rate", Dimension::FREQUENCY, "readings a second while it settles")
            .or(20.0, "Hz")
            .above_zero_up_to(1e4)
            .of_real_rigs(),
        Field::count("samples", 1.0, 999.0, "settled readings of which the median counts; odd").or(3.0, "").of_real_rigs(),
        Field::count("frozen_after", 2.0, 1e6, "equal force readings in a row, while it moves, that show a dead sensor")
            .or(8.0, "")
            .of_real_rigs(),
        Field::quantity("resolution", Dimension::LENGTH, "quantum of the displacement reading")
            .or(0.0, "mm")
            .at_least_zero()
            .of_real_rigs(),
        Field::quantity("noise", Dimension::FORCE, "standard deviation of one force reading")
            .or(0.0, "N")
            .at_least_zero()
            .of_real_rigs(),
        Field::bounds("force_range", Dimension::FORCE, true, "what the load cell can read; at its ends it is saturated")
            .of_real_rigs(),
        Field::quantity("force_per_count", Dimension::FORCE, "of a load cell that gives raw counts; not 0").of_real_rigs(),
        Field::quantity("zero_count", Dimension::NUMBER, "count at no force, of a load cell that gives raw counts")
            .or(0.0, "")
            .of_real_rigs(),
        Field::quantity("force_uncertainty", Dimension::NUMBER, "standard uncertainty of the force calibration, of the force")
            .or(0.0, "%")
            .within(0.0, 0.2),
        Field::quantity(
            "displacement_uncertainty",
            Dimension::NUMBER,
            "standard uncertainty of the displacement calibration, of the displacement",
        )
        .or(0.0, "%")
        .within(0.0, 0.2),
        Field::quantity("zero_uncertainty", Dimension::FORCE, "standard uncertainty of the load cell's reading of no force")
            .or(0.0, "N")
            .at_least_zero(),
        Field::text("calibration", "reference of the calibration; of the force alone, where `displacement_calibration` is given"),
        Field::text("calibration_due", "last day on which the calibration holds, `YYYY-MM-DD`"),
        Field::text("force_class", "class of the force measurement, such as one of ISO 7500-1"),
        Field::bounds(
            "force_calibration_range",
            Dimension::FORCE,
            false,
            "forces, by size, over which the calibration of the force holds; the certificate wants it",
        )
        .or_said("not stated"),
        Field::text("displacement_calibration", "reference of the calibration of the displacement, where it has one of its own"),
        Field::text("displacement_calibration_due", "last day on which that calibration holds, `YYYY-MM-DD`"),
        Field::text("displacement_class", "class of the displacement measurement, such as one of ISO 9513"),
        Field::bounds(
            "displacement_calibration_range",
            Dimension::LENGTH,
            false,
            "displacements, by size, over which the calibration of the displacement holds; the certificate wants it",
        )
        .or_said("not stated"),
    ],
    exports: &[],
    results: &[],
    example: "rig rehearsal { link = virtual(noise: 2 N, seed: 7) }",
    doc: "What moves the specimen: computed, or real hardware, which moves only when `--rig` names it",
};
