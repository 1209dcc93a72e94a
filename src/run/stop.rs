//! The reasons for an early end of a run, and the outcome of each.

use psd_plan::schema::procedures::SPECIMEN;
use std::borrow::Cow;

use psd_plan::formula::FormulaError;
use psd_plan::record::{EventKind, Outcome};
use psd_rig::RigFault;
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// The reason for an early end of a run. The rig holds by then.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Stop {
    Rig(RigFault),
    /// A reading outside its limit before any command to move.
    AtRest(RigFault),
    /// The operator requested it, or requested the end of the program.
    Person {
        reason: String,
    },
    /// The rig was not released: nothing has moved.
    NotReleased {
        reason: String,
    },
    /// A real rig did not pass the pre-test check before the first step.
    PretestCheck {
        reason: String,
    },
    /// An input of a procedure has no value, because it reads a result that does not exist.
    NoInput {
        field: &'static str,
        error: FormulaError,
    },
    /// An input of a procedure is known only now, and cannot be used.
    BadInput {
        field: &'static str,
        value: f64,
        dimension: Dimension,
        wanted: Cow<'static, str>,
    },
}

impl Stop {
    /// An input that is known only now, SI, and what it must be instead.
    pub(crate) fn bad_input(
        field: &'static str,
        value: f64,
        dimension: Dimension,
        wanted: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self::BadInput {
            field,
            value,
            dimension,
            wanted: wanted.into(),
        }
    }

    /// A procedure on a frame names a specimen that is not a frame.
    pub(crate) fn no_frame() -> Self {
        Self::bad_input(SPECIMEN.name, 0.0, Dimension::NUMBER, "a frame of storeys")
    }

    /// Limits and the operator abort a run; an input that cannot be used blocks it; a rig that fails is a fault.
    pub(crate) fn outcome(&self) -> Outcome {
        let reason = self.to_string();
        match self {
            Self::Rig(
                RigFault::LimitBreached { .. }
                | RigFault::NotSettled { .. }
                | RigFault::Interrupted,
            )
            | Self::AtRest(_)
            | Self::Person { .. } => Outcome::Aborted { reason },
            Self::NotReleased { .. } => Outcome::NotReleased { reason },
            Self::NoInput { .. } | Self::BadInput { .. } => Outcome::Blocked { reason },
            Self::Rig(RigFault::Device(_) | RigFault::Following { .. })
            | Self::PretestCheck { .. } => Outcome::Faulted { reason },
        }
    }

    /// Whether rig and readings can still be trusted for another move.
    pub(super) const fn leaves_the_rig_sound(&self) -> bool {
        !matches!(
            self,
            Self::Rig(
                RigFault::Device(_)
                    | RigFault::Following { .. }
                    | RigFault::NotSettled { .. }
                    | RigFault::Interrupted
            ) | Self::PretestCheck { .. }
                | Self::NotReleased { .. }
        )
    }

    /// Whether the operator ended the run.
    pub(super) const fn is_a_persons(&self) -> bool {
        matches!(
            self,
            Self::Person { .. } | Self::NotReleased { .. } | Self::Rig(RigFault::Interrupted)
        )
    }

    pub(crate) const fn event_kind(&self) -> EventKind {
        match self {
            Self::Rig(RigFault::LimitBreached { .. }) | Self::AtRest(_) => EventKind::LimitBreach,
            Self::Rig(RigFault::NotSettled { .. } | RigFault::Interrupted)
            | Self::Person { .. }
            | Self::NotReleased { .. } => EventKind::Hold,
            Self::Rig(RigFault::Device(_) | RigFault::Following { .. })
            | Self::PretestCheck { .. }
            | Self::NoInput { .. }
            | Self::BadInput { .. } => EventKind::Fault,
        }
    }
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rig(fault) => write!(f, "{fault}"),
            Self::AtRest(fault) => write!(
                f,
                "{fault}; nothing has moved: check unit, scale, register order, load on the specimen, and the zero (`datum`)"
            ),
            Self::Person { reason } | Self::NotReleased { reason } => f.write_str(reason),
            Self::PretestCheck { reason } => {
                write!(f, "the rig did not pass the pre-test check: {reason}")
            }
            Self::NoInput { field, error } => write!(f, "`{field}` has no value: {error}"),
            Self::BadInput {
                field,
                value,
                dimension,
                wanted,
            } => {
                write!(
                    f,
                    "`{field}` = {} is invalid: it must be {wanted}",
                    stated(*value, *dimension)
                )
            }
        }
    }
}

impl From<RigFault> for Stop {
    fn from(fault: RigFault) -> Self {
        Self::Rig(fault)
    }
}
