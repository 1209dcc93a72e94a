//! The procedures of a plan, and what the stages before the run know of each: in its folder its block (schema), its parameters in SI
//! (plan) and its history (record). They are data: they check nothing and run nothing.

pub mod cycle {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod damping_sweep {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod escalate {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod impact {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod inspect {
    pub mod block;
}
pub mod known_steps;
pub mod mode;
pub mod move_to {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod preload {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod shake {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod stepping;
pub mod stiffness_ramp {
    pub mod block;
    pub mod history;
    pub mod parameters;
}
pub mod unload {
    pub mod block;
    pub mod history;
    pub mod parameters;
}

use crate::{Cycle, DampingSweep, Escalate, Impact, Move, Preload, Shake, StiffnessRamp, Unload};

/// The blocks of the procedures: a plan writes each by its keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcedureBlock {
    StiffnessRamp,
    DampingSweep,
    Impact,
    Shake,
    Cycle,
    Unload,
    Escalate,
    Move,
    Preload,
    Inspect,
}

/// The parameters of a procedure.
#[derive(Clone, Debug)]
pub enum ProcedureKind {
    StiffnessRamp(StiffnessRamp),
    DampingSweep(DampingSweep),
    Impact(Impact),
    Shake(Shake),
    Cycle(Cycle),
    Unload(Unload),
    Escalate(Escalate),
    Move(Move),
    Preload(Preload),
    /// The operator inspects the specimen.
    Inspect {
        note: String,
    },
}

impl ProcedureKind {
    /// Whether it tests the specimen on the rig without the structure of which it is a part.
    #[must_use]
    pub const fn tests_the_specimen_alone(&self) -> bool {
        matches!(
            self,
            Self::StiffnessRamp(_)
                | Self::DampingSweep(_)
                | Self::Cycle(_)
                | Self::Move(_)
                | Self::Preload(_)
        )
    }

    /// The block's keyword, as in `summary.json`.
    #[must_use]
    pub const fn keyword(&self) -> &'static str {
        match self {
            Self::StiffnessRamp(_) => "stiffness ramp",
            Self::DampingSweep(_) => "damping sweep",
            Self::Impact(_) => "impact",
            Self::Shake(_) => "shake",
            Self::Cycle(_) => "cycle",
            Self::Unload(_) => "unload",
            Self::Escalate(_) => "escalate",
            Self::Move(_) => "move",
            Self::Preload(_) => "preload",
            Self::Inspect { .. } => "inspect",
        }
    }

    /// The axial load that it applies: storey from 0, force \[N\].
    #[must_use]
    pub const fn axial_load(&self) -> Option<(usize, f64)> {
        match self {
            Self::Preload(load) => Some((load.storey, load.force)),
            _ => None,
        }
    }

    /// The tested specimen, as an index into `Plan::specimens`; None of a procedure that only moves or inspects.
    #[must_use]
    pub const fn specimen(&self) -> Option<usize> {
        match self {
            Self::StiffnessRamp(ramp) => Some(ramp.specimen),
            Self::DampingSweep(sweep) => Some(sweep.specimen),
            Self::Impact(impact) => Some(impact.specimen),
            Self::Shake(shake) => Some(shake.specimen),
            Self::Cycle(cycle) => Some(cycle.specimen),
            Self::Unload(unload) => Some(unload.specimen),
            Self::Escalate(series) => Some(series.impact.specimen),
            Self::Move(_) | Self::Preload(_) | Self::Inspect { .. } => None,
        }
    }
}
