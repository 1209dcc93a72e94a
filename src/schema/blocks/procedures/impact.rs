//! `impact`: its block and its results.

use super::{INSPECT_TRIGGERS, SPECIMEN, tracking};
use crate::schema::blocks::{frames, methods};
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind, Variant};
use crate::units::Dimension;

const CONTACT_LAWS: &[Variant] = &[
    Variant::word(
        "rigid",
        "the paper's: the contact force of a step has no bound and grows as 1/Δt",
    ),
    Variant::with(
        "limit",
        &[
            Field::quantity("force", Dimension::FORCE, "largest contact force")
                .required("1500 N")
                .above_zero(),
        ],
        "the paper's: rigid–perfectly plastic",
    ),
    Variant::with(
        "restitution",
        &[Field::quantity(
            "coefficient",
            Dimension::NUMBER,
            "separation over closing speed",
        )
        .required("0.6")
        .within(0.0, 1.0)],
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
                    length: crate::units::Exponent::whole(-1),
                    mass: crate::units::Exponent::ZERO,
                    time: crate::units::Exponent::whole(1),
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

pub(crate) const MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "max_displacement",
    Dimension::LENGTH,
    "largest displacement of the structure over the run",
);

pub(crate) const TIME_OF_MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "time_of_max_displacement",
    Dimension::TIME,
    "virtual time of the largest displacement",
);

pub(crate) const STOP_TIME: ResultKind = ResultKind::measured(
    "stop_time",
    Dimension::TIME,
    "virtual time at which the striker first stood still",
);

pub(crate) const FINAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "final_displacement",
    Dimension::LENGTH,
    "displacement at the last step of the run, under whatever load it then carries",
);

pub(crate) const MAX_VELOCITY: ResultKind = ResultKind::measured(
    "max_velocity",
    Dimension::VELOCITY,
    "largest size of the structure's velocity",
);

pub(crate) const MAX_CONTACT_FORCE: ResultKind = ResultKind::measured(
    "max_contact_force",
    Dimension::FORCE,
    "largest mean contact force of a step; grows as 1/Δt under `rigid`, `restitution` and a `limit` that is not reached",
);

pub(crate) const IMPULSE: ResultKind = ResultKind::measured(
    "impulse",
    Dimension::IMPULSE,
    "contact force integrated over the run",
);

pub(crate) const CONTACTS: ResultKind = ResultKind::count(
    "contacts",
    "number of blows: contacts that began, also those inside a step",
);

pub(crate) const RESTITUTION: ResultKind = ResultKind::measured(
    "restitution",
    Dimension::NUMBER,
    "separation over closing speed of the first blow",
);

pub(crate) const INDENTATION: ResultKind = ResultKind::measured(
    "indentation",
    Dimension::LENGTH,
    "permanent indentation of the contact surface",
);

pub(crate) const INDENTATION_ENERGY: ResultKind = ResultKind::measured(
    "indentation_energy",
    Dimension::ENERGY,
    "limit force times indentation",
);

pub(crate) const ABSORBED_ENERGY: ResultKind = ResultKind::measured(
    "absorbed_energy",
    Dimension::ENERGY,
    "restoring force integrated up to the largest displacement",
);

pub(crate) const RESTORING_ENERGY: ResultKind = ResultKind::measured(
    "restoring_energy",
    Dimension::ENERGY,
    "restoring force integrated over the run, with what a damper adds to it in continuous mode",
);

pub(crate) const DAMPING_ENERGY: ResultKind = ResultKind::measured(
    "damping_energy",
    Dimension::ENERGY,
    "energy that the computed `damping` took over the run",
);

pub(crate) const STRIKER_ENERGY: ResultKind = ResultKind::measured(
    "striker_energy",
    Dimension::ENERGY,
    "kinetic energy of the striker at the start",
);

pub(crate) const ENERGY_ERROR: ResultKind = ResultKind::new(
    "energy_error",
    Dimension::NUMBER,
    "what the energy balance misses, over the input energy",
);

pub(crate) const TIME_STEP: ResultKind =
    ResultKind::new("time_step", Dimension::TIME, "time step of the run");

pub(crate) const CRITICAL_TIME_STEP: ResultKind = ResultKind::measured(
    "critical_time_step",
    Dimension::TIME,
    "critical time step (Melo et al. 2006, eq. 7; under `hertz` of the closed contact)",
);

pub(crate) const STEPS: ResultKind = ResultKind::count("steps", "number of steps");

pub(crate) const CONTACT_DURATION: ResultKind = ResultKind::measured(
    "contact_duration",
    Dimension::TIME,
    "virtual time of the first blow, in whole steps",
)
.of_storey();

pub(crate) const REBOUND_VELOCITY: ResultKind = ResultKind::measured(
    "rebound_velocity",
    Dimension::VELOCITY,
    "speed of the striker on its way back at the end of the run",
)
.of_storey();

pub(crate) const FLOOR_DISPLACEMENT: ResultKind = ResultKind::measured_list(
    "floor_displacement",
    Dimension::LENGTH,
    "largest size of each floor's displacement",
)
.of_storey();

pub(crate) const MAX_DRIFT: ResultKind = ResultKind::measured_list(
    "max_drift",
    Dimension::LENGTH,
    "largest size of each storey's drift",
)
.of_storey();

pub(crate) const FINAL_DRIFT: ResultKind = ResultKind::measured_list(
    "final_drift",
    Dimension::LENGTH,
    "each storey's drift at the last step of the run",
)
.of_storey();

pub(crate) const STOREY_ENERGY: ResultKind = ResultKind::measured_list(
    "storey_energy",
    Dimension::ENERGY,
    "shear of each storey integrated over its drift, over the run",
)
.of_storey();

pub(crate) const MAX_BASE_SHEAR: ResultKind = ResultKind::measured(
    "max_base_shear",
    Dimension::FORCE,
    "largest size of the restoring force of the lowest storey, less what noise adds to it",
)
.of_storey();

pub(crate) const PERIODS: ResultKind =
    ResultKind::measured_list("periods", Dimension::TIME, "natural periods, longest first")
        .of_storey();

/// What it leaves, in the order of the tables and of `summary.json`.
pub(crate) const RESULTS: &[ResultKind] = &[
    MAX_DISPLACEMENT,
    TIME_OF_MAX_DISPLACEMENT,
    STOP_TIME,
    FINAL_DISPLACEMENT,
    MAX_VELOCITY,
    MAX_CONTACT_FORCE,
    IMPULSE,
    CONTACTS,
    RESTITUTION,
    INDENTATION,
    INDENTATION_ENERGY,
    ABSORBED_ENERGY,
    RESTORING_ENERGY,
    DAMPING_ENERGY,
    STRIKER_ENERGY,
    ENERGY_ERROR,
    tracking::TRACKING_ENERGY_ERROR,
    tracking::TRACKING_INDICATOR,
    tracking::NRMS_ERROR,
    tracking::PEAK_ERROR,
    TIME_STEP,
    CRITICAL_TIME_STEP,
    STEPS,
    CONTACT_DURATION,
    REBOUND_VELOCITY,
    FLOOR_DISPLACEMENT,
    MAX_DRIFT,
    FINAL_DRIFT,
    STOREY_ENERGY,
    MAX_BASE_SHEAR,
    PERIODS,
    tracking::FLOOR_TRACKING_ENERGY_ERROR.of_storey(),
    tracking::FLOOR_TRACKING_INDICATOR.of_storey(),
    tracking::FLOOR_NRMS_ERROR.of_storey(),
    tracking::FLOOR_PEAK_ERROR.of_storey(),
];

pub(crate) const BLOCK: BlockKind = BlockKind {
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
        Field::choice("contact", CONTACT_LAWS, "contact law").or_said("rigid"),
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
    results: RESULTS,
    example: "impact hit {\n  striker = pendulum\n  duration = 50 ms\n}",
    doc: "The pseudo-dynamic impact of a striker, step by step",
};
