//! What is run: `stiffness ramp`, `damping sweep`, `impact`, `move`, `inspect`.

use super::types::{BlockKind, Field, Kind, Naming, RigKind, Variant};
use super::{curves, frames, methods, results};
use crate::quantity::Dimension;

pub(super) const SPECIMEN: Field =
    Field::reference("specimen", Kind::Specimen, "what is tested").or_said("the only one declared");

const SPEED: Field = Field::quantity("speed", Dimension::VELOCITY, "actuator speed").above_zero().or_said("the rig's own");

const WATCHED: &[Field] = &[
    READINGS,
    Field::quantity("accuracy", Dimension::FORCE, "to which the force is to be known: how long a pause must be")
        .above_zero()
        .or_said("the declared noise of the load cell"),
];

const READINGS: Field = Field::count("readings", 3.0, 10_000.0, "in each pause, closer at first").or(20.0, "");

const SLOW_ENOUGH: &[Field] = &[
    READINGS,
    Field::quantity("rate", Dimension::FORCE_RATE, "how fast a pause may still lose force at its end: how long it must be")
        .required("rate: 1 N/s")
        .above_zero(),
];

pub(super) const STIFFNESS_RAMP: BlockKind = BlockKind {
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
    results: results::STIFFNESS_RAMP,
    example: "stiffness ramp k0 { displacements = 0.1 mm .. 1 mm step 0.1 mm }",
    doc: "Prescribed displacements, a pause at each: the stiffness by least squares",
};

pub(super) const DAMPING_SWEEP: BlockKind = BlockKind {
    kind: Kind::DampingSweep,
    keyword: &["damping", "sweep"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        SPECIMEN,
        Field::quantities("velocities", Dimension::VELOCITY, "speeds of the ramps")
            .required("velocities = [0.5, 1, 2, 5, 10] mm/s")
            .above_zero(),
        Field::quantity("stroke", Dimension::LENGTH, "length of each ramp").required("stroke = 1 mm").above_zero(),
        Field::quantity("about", Dimension::LENGTH, "the middle of the strokes").or_said("they begin where the actuator is"),
        Field::quantity("stiffness", Dimension::STIFFNESS, "K of the damping force R − K·X")
            .required("stiffness = 300 kN/m")
            .above_zero(),
        Field::quantity("rate", Dimension::FREQUENCY, "sampling rate")
            .above_zero()
            .or_said("at least 50 samples on the steady part"),
    ],
    exports: &[],
    results: results::DAMPING_SWEEP,
    example: "damping sweep c {\n  velocities = [1, 2, 5] mm/s\n  stroke = 1 mm\n  stiffness = 300 kN/m\n}",
    doc: "Ramps at rising constant velocity: the damping by least squares",
};

const CONTACTS: &[Variant] = &[
    Variant::word("rigid", "the paper's: the contact force of a step has no bound and grows as 1/Δt"),
    Variant::with(
        "limit",
        &[Field::quantity("force", Dimension::FORCE, "largest contact force").required("1500 N").above_zero()],
        "the paper's: rigid–perfectly plastic",
    ),
    Variant::with(
        "restitution",
        &[Field::quantity("coefficient", Dimension::NUMBER, "separation over closing speed").required("0.6").within(0.0, 1.0)],
        "an impulse at the instant of impact",
    ),
    Variant::with(
        "hertz",
        &[
            Field::quantity("stiffness", Dimension::HERTZ_STIFFNESS, "k of F = k δ^1.5")
                .required("stiffness: 1e8 N/m^1.5")
                .above_zero(),
            Field::quantity(
                "loss",
                Dimension {
                    length: crate::quantity::Exponent::whole(-1),
                    mass: crate::quantity::Exponent::ZERO,
                    time: crate::quantity::Exponent::whole(1),
                },
                "factor of Hunt and Crossley, F = k δ^1.5 (1 + loss·dδ/dt)",
            )
            .or(0.0, "s/m")
            .at_least_zero(),
            Field::quantity("force_limit", Dimension::FORCE, "largest contact force").above_zero(),
        ],
        "finite contact stiffness: the peak force converges",
    ),
];

pub(super) const INSPECT_TRIGGERS: &[Variant] = &[
    Variant::with("every", &[Field::count("steps", 1.0, 1e7, "steps between looks").required("20")], "every so many steps"),
    Variant::with(
        "force_drop",
        &[Field::quantity("fraction", Dimension::NUMBER, "of the largest restoring force so far")
            .required("10 %")
            .within(0.0, 1.0)],
        "when the restoring force has fallen",
    ),
    Variant::with(
        "at",
        &[Field::quantity("time", Dimension::TIME, "virtual time").required("5 ms").at_least_zero()],
        "at a virtual time",
    ),
];

pub(super) const IMPACT: BlockKind = BlockKind {
    kind: Kind::Impact,
    keyword: &["impact"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("striker", Kind::Striker, "what strikes").required("striker = pendulum"),
        SPECIMEN,
        Field::count("storey", 1.0, 64.0, "the floor that is struck, from the ground up; a frame needs it").of_frames(),
        Field::quantity("mass", Dimension::MASS, "M of eqs. 4 and 5").above_zero().or_said("the specimen's"),
        Field::quantity("stiffness", Dimension::STIFFNESS, "K0, before the first tangent").above_zero().required_on(
            RigKind::Real,
            "stiffness = k0.stiffness",
            "the behaviour's initial stiffness",
        ),
        Field::quantity("damping", Dimension::DAMPING, "C of eqs. 4 and 5").or(0.0, "N*s/m").at_least_zero(),
        Field::quantities(
            "damping_ratio",
            Dimension::NUMBER,
            "one: Rayleigh damping with this ratio in the first two modes; a list: each mode its own",
        )
        .within(0.0, 1.0)
        .or(0.0, "")
        .of_frames(),
        frames::DAMPING_UNCERTAINTY.of_frames(),
        Field::choice("contact", CONTACTS, "contact law").or_said("rigid"),
        methods::INTEGRATOR,
        methods::ALLOW_UNSTABLE,
        methods::I_MODIFICATION,
        methods::MODE,
        Field::quantity(
            "time_step",
            Dimension::TIME,
            "Δt; may read `critical`, Δt of eq. 7, under `hertz` a tenth of the shortest period with the contact closed",
        )
        .above_zero()
        .or_said("critical / 20"),
        Field::quantity("duration", Dimension::TIME, "upper bound of virtual time").required("duration = 50 ms").above_zero(),
        Field::choice(
            "until",
            &[
                Variant::word("striker_stop", "neither striker nor structure moves on"),
                Variant::word("rebound", "striker and structure are apart for good"),
                Variant::word("duration", "the whole `duration`"),
            ],
            "when the run ends",
        )
        .or_said("striker_stop"),
        Field::quantity("pause", Dimension::TIME, "wait at every step").or(0.0, "s").at_least_zero(),
        Field::quantity("max_tangent_ratio", Dimension::NUMBER, "the tangent stiffness stays in 0 .. this times K0")
            .or(2.0, "")
            .above_zero(),
        Field::choices("inspect", INSPECT_TRIGGERS, "when a person is asked to look"),
    ],
    exports: &[],
    results: results::IMPACT,
    example: "impact hit {\n  striker = pendulum\n  duration = 50 ms\n}",
    doc: "The pseudo-dynamic impact of a striker, step by step",
};

pub(super) const MOVE: BlockKind = BlockKind {
    kind: Kind::Move,
    keyword: &["move"],
    naming: Naming::Named,
    procedure: true,
    fields: &[Field::quantity("to", Dimension::LENGTH, "absolute target").required("to = 0 mm"), SPEED],
    exports: &[],
    results: &[],
    example: "move home { to = 0 mm }",
    doc: "Moves the actuator to a displacement",
};

pub(super) const INSPECT: BlockKind = BlockKind {
    kind: Kind::Inspect,
    keyword: &["inspect"],
    naming: Naming::Named,
    procedure: true,
    fields: &[Field::text("note", "what to look at").required("note = \"look for cracks at the supports\"")],
    exports: &[],
    results: &[],
    example: "inspect look { note = \"look for cracks\" }",
    doc: "Stops until a person has looked at the specimen",
};
