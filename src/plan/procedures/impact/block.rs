//! `impact`: its block and its results.

use crate::ProcedureBlock;
use crate::procedures::shake::block as shake;
use crate::schema::procedures::{SPECIMEN, STIFFNESS, tracking};
use crate::schema::{BlockKind, Field, Kind, Naming, Peak, Possible, ResultKind, Variant};
use crate::schema::{frames, methods};
use psd_physics::contact::argument;
use psd_text::units::Dimension;

const LIMIT_FORCE: Field =
    Field::quantity(argument::FORCE, Dimension::FORCE, "largest contact force")
        .required("1500 N")
        .above_zero();

const COEFFICIENT: Field = Field::quantity(
    argument::COEFFICIENT,
    Dimension::NUMBER,
    "separation speed over closing speed",
)
.required("0.6")
.within(0.0, 1.0);

const HERTZ_STIFFNESS: Field = Field::quantity(
    argument::STIFFNESS,
    Dimension::HERTZ_STIFFNESS,
    "k of F = k δ^1.5",
)
.required("stiffness: 1e8 N/m^1.5")
.above_zero();

const LOSS: Field = Field::quantity(
    argument::LOSS,
    Dimension {
        length: psd_text::units::Exponent::whole(-1),
        mass: psd_text::units::Exponent::ZERO,
        time: psd_text::units::Exponent::whole(1),
        ..Dimension::NUMBER
    },
    "factor of Hunt and Crossley, F = k δ^1.5 (1 + loss·dδ/dt)",
)
.or(0.0, "s/m")
.at_least_zero();

const FORCE_LIMIT: Field = Field::quantity(
    argument::FORCE_LIMIT,
    Dimension::FORCE,
    "largest contact force",
)
.above_zero();

/// The contact laws. Readers take every argument of a law, in this order; [`psd_physics::contact::ContactLaw`] names the same ones.
const CONTACT_LAWS: &[Variant] = &[
    Variant::word(
        "rigid",
        "rigid impact (Melo et al. 2006): the contact force of a step is unbounded and grows as 1/Δt",
    ),
    Variant::with(
        "limit",
        &[LIMIT_FORCE],
        "rigid–perfectly plastic contact (Melo et al. 2006)",
    ),
    Variant::with(
        "restitution",
        &[COEFFICIENT],
        "impulse at the instant of impact",
    ),
    Variant::with(
        "hertz",
        &[HERTZ_STIFFNESS, LOSS, FORCE_LIMIT],
        "finite contact stiffness: the peak force converges",
    ),
];

/// A number of a contact law.
pub fn contact_number(law: &str, argument: &str) -> &'static Field {
    let law = CONTACT_LAWS.iter().find(|variant| variant.name == law);
    let mut arguments = law.iter().flat_map(|law| law.arguments);
    let named = arguments.find(|field| field.name == argument);
    named.expect("the schema has every number of every law")
}

pub const MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "max_displacement",
    Dimension::LENGTH,
    "largest displacement of the structure",
)
.within(Possible::LargestDisplacement)
.final_after(Peak::Displacement);

pub const TIME_OF_MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "time_of_max_displacement",
    Dimension::TIME,
    "simulated time of the largest displacement",
)
.within(Possible::NotNegative)
.final_after(Peak::InstantOfDisplacement);

pub const STOP_TIME: ResultKind = ResultKind::measured(
    "stop_time",
    Dimension::TIME,
    "simulated time at which the striker first stops",
)
.within(Possible::NotNegative);

pub const FINAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "final_displacement",
    Dimension::LENGTH,
    "displacement at the last step of the run, possibly under load",
);

pub const MAX_VELOCITY: ResultKind = ResultKind::measured(
    "max_velocity",
    Dimension::VELOCITY,
    "peak absolute velocity of the structure",
)
.within(Possible::NotNegative)
.final_after(Peak::Velocity);

pub const MAX_CONTACT_FORCE: ResultKind = ResultKind::measured(
    "max_contact_force",
    Dimension::FORCE,
    "largest step-mean contact force; grows as 1/Δt under `rigid`, `restitution` and an unreached `limit`",
)
.within(Possible::NotNegative)
.grows_as_inverse_step()
.final_after(Peak::ContactForce);

pub const IMPULSE: ResultKind = ResultKind::measured(
    "impulse",
    Dimension::IMPULSE,
    "contact force integrated over the run",
);

pub const CONTACTS: ResultKind = ResultKind::count(
    "contacts",
    "number of contacts, including those within a step",
);

pub const RESTITUTION: ResultKind = ResultKind::measured(
    "restitution",
    Dimension::NUMBER,
    "separation speed over closing speed of the first impact",
);

pub const INDENTATION: ResultKind = ResultKind::measured(
    "indentation",
    Dimension::LENGTH,
    "permanent indentation of the contact surface",
)
.within(Possible::NotNegative);

pub const INDENTATION_ENERGY: ResultKind = ResultKind::measured(
    "indentation_energy",
    Dimension::ENERGY,
    "limit force times indentation",
);

pub const ABSORBED_ENERGY: ResultKind = ResultKind::measured(
    "absorbed_energy",
    Dimension::ENERGY,
    "restoring force integrated up to the largest displacement",
)
.final_after(Peak::InstantOfDisplacement);

pub const RESTORING_ENERGY: ResultKind = ResultKind::measured(
    "restoring_energy",
    Dimension::ENERGY,
    "restoring force integrated over the run, including damping force in continuous mode",
);

pub const DAMPING_ENERGY: ResultKind = ResultKind::measured(
    "damping_energy",
    Dimension::ENERGY,
    "energy dissipated by the computed `damping`",
);

pub const STRIKER_ENERGY: ResultKind = ResultKind::measured(
    "striker_energy",
    Dimension::ENERGY,
    "kinetic energy of the striker at the start",
)
.within(Possible::NotNegative);

pub const ENERGY_ERROR: ResultKind = ResultKind::new(
    "energy_error",
    Dimension::NUMBER,
    "residual of the energy balance relative to the input energy",
)
.in_percent();

pub const TIME_STEP: ResultKind =
    ResultKind::new("time_step", Dimension::TIME, "time step of the run");

pub const CRITICAL_TIME_STEP: ResultKind = ResultKind::measured(
    "critical_time_step",
    Dimension::TIME,
    "critical time step (Melo et al. 2006, eq. 7); under `hertz`, with the contact closed",
);

pub const STEPS: ResultKind = ResultKind::count("steps", "number of steps");

pub const CONTACT_DURATION: ResultKind = ResultKind::measured(
    "contact_duration",
    Dimension::TIME,
    "simulated time of the first contact, in whole steps",
)
.within(Possible::NotNegative)
.of_storey();

pub const REBOUND_VELOCITY: ResultKind = ResultKind::measured(
    "rebound_velocity",
    Dimension::VELOCITY,
    "rebound speed of the striker at the end of the run",
)
.of_storey();

pub const FLOOR_DISPLACEMENT: ResultKind = ResultKind::measured_list(
    "floor_displacement",
    Dimension::LENGTH,
    "peak absolute displacement of each floor",
)
.within(Possible::PeakDisplacement)
.of_storey()
.final_after(Peak::FloorDisplacement);

pub const MAX_DRIFT: ResultKind = ResultKind::measured_list(
    "max_drift",
    Dimension::LENGTH,
    "peak absolute drift of each storey, or deformation of each element",
)
.within(Possible::NotNegative)
.of_each_member()
.of_storey()
.final_after(Peak::Drift);

pub const FINAL_DRIFT: ResultKind = ResultKind::measured_list(
    "final_drift",
    Dimension::LENGTH,
    "drift of each storey, or deformation of each element, at the last step of the run",
)
.of_each_member()
.of_storey();

pub const STOREY_ENERGY: ResultKind = ResultKind::measured_list(
    "storey_energy",
    Dimension::ENERGY,
    "work of each storey shear over its drift, or of the force of each element over its deformation, in the run",
)
.of_each_member()
.of_storey();

pub const MAX_BASE_SHEAR: ResultKind = ResultKind::measured(
    "max_base_shear",
    Dimension::FORCE,
    "peak absolute base shear, net of P-Δ, minus the part due to noise",
)
.of_storey()
.final_after(Peak::BaseShear);

pub const MAX_ELEMENT_FORCE: ResultKind = shake::MAX_ELEMENT_FORCE.of_storey();

pub const PERIODS: ResultKind =
    ResultKind::measured_list("periods", Dimension::TIME, "natural periods, longest first")
        .of_storey();

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
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
    MAX_ELEMENT_FORCE,
    tracking::FLOOR_TRACKING_ENERGY_ERROR.of_storey(),
    tracking::FLOOR_TRACKING_INDICATOR.of_storey(),
    tracking::FLOOR_NRMS_ERROR.of_storey(),
    tracking::FLOOR_PEAK_ERROR.of_storey(),
];

pub const STRIKER: Field =
    Field::reference("striker", Kind::Striker, "striker").required("striker = pendulum");

pub const STOREY: Field = Field::count(
    "storey",
    1.0,
    64.0,
    "struck floor, from the ground up; required for a frame",
)
.of_frames();

pub const MASS: Field = Field::quantity("mass", Dimension::MASS, "M of eqs. 4 and 5")
    .above_zero()
    .default_in_words("the specimen's");

pub const DAMPING: Field = Field::quantity("damping", Dimension::DAMPING, "C of eqs. 4 and 5")
    .or(0.0, "N*s/m")
    .at_least_zero();

pub const CONTACT: Field =
    Field::choice("contact", CONTACT_LAWS, "contact law").default_in_words("rigid");

pub const UNTIL: Field = Field::choice(
    "until",
    &[
        Variant::word(
            "striker_stop",
            "striker and structure have both stopped or reversed",
        ),
        Variant::word("rebound", "striker and structure have separated for good"),
        methods::DRIFT_REACHED,
        Variant::word("duration", "the whole `duration`"),
    ],
    "end condition",
)
.default_in_words("striker_stop");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Impact),
    keyword: &["impact"],
    naming: Naming::Named,
    fields: &[
        STRIKER,
        SPECIMEN,
        STOREY,
        MASS,
        STIFFNESS,
        DAMPING,
        frames::DAMPING_RATIO.described(
            "instead of `damping`: C = 2 ζ √(K M) with `stiffness` and `mass`; of a frame, one value for Rayleigh damping with this \
             ratio in the first two modes, or a list with one ratio per mode",
        ),
        frames::DAMPING_UNCERTAINTY.of_frames(),
        CONTACT,
        methods::INTEGRATOR,
        methods::ALLOW_UNSTABLE,
        methods::I_MODIFICATION,
        methods::MODE,
        methods::TIME_STEP
            .described(
                "Δt; can use `critical`: Δt of eq. 7; under `hertz`, a tenth of the shortest \
                 period in contact",
            )
            .default_in_words("critical / 20"),
        methods::DURATION
            .described("upper bound of simulated time")
            .required("duration = 50 ms"),
        UNTIL,
        methods::PAUSE,
        methods::MAX_TANGENT_RATIO,
        methods::INSPECT,
    ],
    exports: &[],
    results: RESULTS,
    example: "impact hit {\n  striker = pendulum\n  duration = 50 ms\n}",
    doc: "Pseudo-dynamic impact of a striker",
};
