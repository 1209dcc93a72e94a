//! Integration and control of a run: fields that every procedure that integrates shares.

use crate::schema::types::{Field, Variant};
use crate::units::Dimension;

/// −⅓ ≤ α ≤ 0; the bound is the double nearest to −⅓.
const ALPHA: Field = Field::quantity(
    "alpha",
    Dimension::NUMBER,
    "numerical damping of what a step does not resolve",
)
.or(-0.05, "")
.within(-1.0 / 3.0, 0.0);

const INTEGRATORS: &[Variant] = &[
    Variant::word(
        "tangent",
        "Newmark with the measured tangent stiffness, eqs. 2 to 6; stable at every step while no slope changes",
    ),
    Variant::word(
        "explicit",
        "explicit Newmark: needs no stiffness; stable for Δt ≤ T/π",
    ),
    Variant::with(
        "alpha_os",
        &[ALPHA],
        "α-operator splitting with the initial stiffness: softening specimens, noisy cells",
    ),
];

pub(crate) const INTEGRATOR: Field = Field::choice("integrator", INTEGRATORS, "time integration")
    .or_said("tangent; `explicit` in continuous mode");

pub(crate) const TRUTH: &[Variant] = &[Variant::word("true", "yes"), Variant::word("false", "no")];

pub(crate) const I_MODIFICATION: Field = Field::choice(
    "i_modification",
    TRUTH,
    "whether the force is corrected to where the specimen was to be, r_m − K_I(d_m − d): as long as it is nearly elastic",
)
.or_said("false; `true` in continuous mode");

const MODES: &[Variant] = &[
    Variant::word(
        "step_and_pause",
        "the actuator stops at every target and is read at rest",
    ),
    Variant::with(
        "continuous",
        &[Field::quantity(
            "time_scale",
            Dimension::NUMBER,
            "rig time over virtual time",
        )
        .required("time_scale: 100")
        .above_zero()],
        "the actuator does not stop: what a damper does at this speed is in the force; on virtual rigs, and real ones that speak `native`",
    ),
];

pub(crate) const MODE: Field =
    Field::choice("mode", MODES, "how the actuator goes from target to target")
        .or_said("step_and_pause");

pub(crate) const ALLOW_UNSTABLE: Field = Field::choice(
    "allow_unstable",
    TRUTH,
    "whether it runs beyond the stability limit of its integrator",
)
.or_said("false");
