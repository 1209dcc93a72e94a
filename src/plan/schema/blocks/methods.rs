//! Integration and control of a run: fields that every procedure that integrates shares.

use crate::schema::types::{Field, Variant};
use psd_text::units::Dimension;

/// −⅓ ≤ α ≤ 0; the bound is the double nearest to −⅓.
pub const ALPHA: Field = Field::quantity(
    "alpha",
    Dimension::NUMBER,
    "numerical damping of modes that the step does not resolve",
)
.or(-0.05, "")
.within(-1.0 / 3.0, 0.0)
.advanced();

const INTEGRATORS: &[Variant] = &[
    Variant::word(
        "tangent",
        "Newmark with measured tangent stiffness (eqs. 2 to 6); unconditionally stable while no slope changes",
    ),
    Variant::word(
        "explicit",
        "explicit Newmark: needs no stiffness; stable for Δt ≤ T/π",
    ),
    Variant::with(
        "alpha_os",
        &[ALPHA],
        "α-operator splitting with the initial stiffness: for softening specimens and noisy load cells",
    ),
];

pub const INTEGRATOR: Field = Field::choice("integrator", INTEGRATORS, "time integration")
    .default_in_words("tangent; `explicit` in continuous mode");

pub const REACHED: Field = Field::quantity(
    "reached",
    Dimension::LENGTH,
    "drift of any storey that ends the run",
)
.required("100 mm")
.above_zero();

/// An end condition of a frame.
pub const DRIFT_REACHED: Variant = Variant::with(
    "drift",
    &[REACHED],
    "the drift of a storey of a frame, or the deformation of an element, has reached this value",
);

pub const TRUTH: &[Variant] = &[Variant::word("true", "yes"), Variant::word("false", "no")];

pub const I_MODIFICATION: Field = Field::choice(
    "i_modification",
    TRUTH,
    "I-modification: corrects the force to the target, r_m − K_I(d_m − d); for nearly elastic specimens",
)
.default_in_words("false; `true` in continuous mode");

pub const TIME_SCALE: Field = Field::quantity(
    "time_scale",
    Dimension::NUMBER,
    "laboratory time over simulated time",
)
.required("time_scale: 100")
.above_zero();

const MODES: &[Variant] = &[
    Variant::word(
        "ramp_and_hold",
        "ramp-and-hold: the actuator stops at every target and is read at rest",
    ),
    Variant::with(
        "continuous",
        &[TIME_SCALE],
        "the actuator does not stop; the force includes damping at this speed; virtual rigs and `native` only",
    ),
];

pub const MODE: Field = Field::choice("mode", MODES, "motion of the actuator between targets")
    .default_in_words("ramp_and_hold");

pub const ALLOW_UNSTABLE: Field = Field::choice(
    "allow_unstable",
    TRUTH,
    "runs beyond the stability limit of the integrator",
)
.default_in_words("false")
.advanced();

pub const TIME_STEP: Field = Field::quantity("time_step", Dimension::TIME, "Δt").above_zero();

/// The simulated time of a run.
pub const DURATION: Field =
    Field::quantity("duration", Dimension::TIME, "simulated time").above_zero();

pub const PAUSE: Field = Field::quantity("pause", Dimension::TIME, "dwell at every step")
    .or(0.0, "s")
    .at_least_zero();

pub const MAX_TANGENT_RATIO: Field = Field::quantity(
    "max_tangent_ratio",
    Dimension::NUMBER,
    "upper bound of the tangent stiffness, as a multiple of the initial one",
)
.or(2.0, "")
.above_zero()
.advanced();

pub const STEPS_BETWEEN: Field =
    Field::count("steps", 1.0, 1e7, "steps between inspections").required("20");

pub const FRACTION: Field = Field::quantity(
    "fraction",
    Dimension::NUMBER,
    "fraction of the largest restoring force so far",
)
.required("10 %")
.within(0.0, 1.0);

pub const AT_TIME: Field = Field::quantity("time", Dimension::TIME, "simulated time")
    .required("5 ms")
    .at_least_zero();

const INSPECT_TRIGGERS: &[Variant] = &[
    Variant::with("every", &[STEPS_BETWEEN], "after a fixed number of steps"),
    Variant::with(
        "force_drop",
        &[FRACTION],
        "when the restoring force has fallen by this fraction",
    ),
    Variant::with("at", &[AT_TIME], "at a simulated time"),
];

pub const INSPECT: Field = Field::choices(
    "inspect",
    INSPECT_TRIGGERS,
    "when the operator inspects the specimen",
);
