//! The procedures of a plan, and what the stages before the run know of each: in its folder its block (schema), its parameters in SI
//! (plan) and its history (record). The enums here list the procedures: their blocks, parameters and histories. They are data: they check
//! nothing and run nothing.

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

use histories::{
    CycleHistory, DampingSweepHistory, EscalateHistory, ImpactHistory, MoveStep, ShakeHistory,
    StiffnessRampHistory, UnloadHistory,
};
use parameters::{
    Cycle, DampingSweep, Escalate, Impact, Move, Preload, Shake, StiffnessRamp, Unload,
};

/// The parameters of the procedures, by the names that the crate gives on.
pub mod parameters {
    pub use crate::procedures::cycle::parameters::{
        Cycle, CycleInspection, Level, MOST_TARGETS, Sides,
    };
    pub use crate::procedures::damping_sweep::parameters::DampingSweep;
    pub use crate::procedures::escalate::parameters::{Between, Escalate, MOST_IMPACTS};
    pub use crate::procedures::impact::parameters::{
        Contact, Impact, ImpactTarget, PointTarget, StoreyTarget,
    };
    pub use crate::procedures::mode::Mode;
    pub use crate::procedures::move_to::parameters::Move;
    pub use crate::procedures::preload::parameters::Preload;
    pub use crate::procedures::shake::parameters::Shake;
    pub use crate::procedures::stepping::{
        MOST_RECORDED_STEPS, MOST_STEPS, Stepping, step_count, steps_in,
    };
    pub use crate::procedures::stiffness_ramp::parameters::{
        BreakCount, RampFit, RelaxationLaw, RelaxationModel, StiffnessRamp, WatchedHold,
        WatchedModel,
    };
    pub use crate::procedures::unload::parameters::Unload;
}

/// The histories of the procedures, by the names that `record` gives on.
pub mod histories {
    pub use crate::procedures::cycle::history::{CycleHistory, CycleStep, WholeCycle};
    pub use crate::procedures::damping_sweep::history::{
        BroughtTogether, DampingSweepHistory, SweepStep,
    };
    pub use crate::procedures::escalate::history::{EscalateHistory, SeriesImpact};
    pub use crate::procedures::impact::history::{
        CollectedSteps, ImpactConstants, ImpactHistory, ImpactStep, ImpactSteps,
    };
    pub use crate::procedures::move_to::history::MoveStep;
    pub use crate::procedures::preload::history::AxialReading;
    pub use crate::procedures::shake::history::{ShakeHistory, ShakeStep};
    pub use crate::procedures::stiffness_ramp::history::{RampStep, StiffnessRampHistory};
    pub use crate::procedures::unload::history::{Rest, UnloadHistory, UnloadStep, Unloaded};
}

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
        match self {
            Self::StiffnessRamp(_)
            | Self::DampingSweep(_)
            | Self::Cycle(_)
            | Self::Move(_)
            | Self::Preload(_) => true,
            Self::Impact(_)
            | Self::Shake(_)
            | Self::Unload(_)
            | Self::Escalate(_)
            | Self::Inspect { .. } => false,
        }
    }

    /// Whether it goes on only while its own results meet a condition.
    #[must_use]
    pub const fn is_series(&self) -> bool {
        match self {
            Self::Escalate(_) => true,
            Self::StiffnessRamp(_)
            | Self::DampingSweep(_)
            | Self::Impact(_)
            | Self::Shake(_)
            | Self::Cycle(_)
            | Self::Unload(_)
            | Self::Move(_)
            | Self::Preload(_)
            | Self::Inspect { .. } => false,
        }
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
            Self::StiffnessRamp(_)
            | Self::DampingSweep(_)
            | Self::Impact(_)
            | Self::Shake(_)
            | Self::Cycle(_)
            | Self::Unload(_)
            | Self::Escalate(_)
            | Self::Move(_)
            | Self::Inspect { .. } => None,
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

/// The history of a procedure, step by step.
#[derive(Clone, Debug)]
pub enum History {
    StiffnessRamp(StiffnessRampHistory),
    DampingSweep(DampingSweepHistory),
    Impact(ImpactHistory),
    Shake(ShakeHistory),
    Cycle(CycleHistory),
    Escalate(EscalateHistory),
    Move(Vec<MoveStep>),
    Unload(UnloadHistory),
    /// Its readings are those of the axial axes.
    Preload,
    Inspect,
}

/// The motion that a procedure integrated, step by step.
#[derive(Clone, Copy, Debug)]
pub enum Integrated<'a> {
    Impact(&'a ImpactHistory),
    Impacts(&'a EscalateHistory),
    GroundMotion(&'a ShakeHistory),
}

impl History {
    /// The motion that it integrated; None if it integrated none.
    #[must_use]
    pub const fn integrated(&self) -> Option<Integrated<'_>> {
        match self {
            Self::Impact(impact) => Some(Integrated::Impact(impact)),
            Self::Escalate(series) => Some(Integrated::Impacts(series)),
            Self::Shake(shake) => Some(Integrated::GroundMotion(shake)),
            Self::StiffnessRamp(_)
            | Self::DampingSweep(_)
            | Self::Cycle(_)
            | Self::Move(_)
            | Self::Unload(_)
            | Self::Preload
            | Self::Inspect => None,
        }
    }

    /// The time step and the critical time step \[s\], if the step was longer than the critical one; for several impacts, those of the
    /// first.
    #[must_use]
    pub fn above_critical(&self) -> Option<(f64, f64)> {
        let steps_of = |impact: &ImpactHistory| (impact.time_step, impact.critical_time_step);
        let mut steps = match self.integrated()? {
            Integrated::Impact(impact) => vec![steps_of(impact)],
            Integrated::GroundMotion(shake) => vec![(shake.time_step, shake.critical_time_step)],
            Integrated::Impacts(series) => {
                let impacts = series.impacts.iter();
                impacts.map(|impact| steps_of(&impact.history)).collect()
            }
        };
        steps.retain(|(step, critical)| step > critical);
        steps.first().copied()
    }

    /// Degrees of freedom of the scatter of a fitted result. None for a result that is not fitted.
    #[must_use]
    pub fn degrees(&self, result: &str) -> Option<f64> {
        match self {
            Self::StiffnessRamp(ramp) => ramp.degrees(result),
            Self::DampingSweep(sweep) => sweep.fit.map(|fit| fit.degrees),
            Self::Cycle(cycle) => cycle.backbone.as_ref().map(|fit| fit.degrees),
            Self::Impact(_)
            | Self::Shake(_)
            | Self::Escalate(_)
            | Self::Move(_)
            | Self::Unload(_)
            | Self::Preload
            | Self::Inspect => None,
        }
    }
}
