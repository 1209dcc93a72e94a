//! The history of a procedure, one file a procedure: its steps, as they were read and computed. In: numbers of a run, SI. Out: data. It
//! computes no motion.

pub mod floors;

use crate::record::{
    CycleHistory, DampingSweepHistory, EscalateHistory, ImpactHistory, MoveStep, ShakeHistory,
    StiffnessRampHistory, UnloadStep,
};

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
    /// The moves that unload one degree of freedom.
    Unload(Vec<UnloadStep>),
    /// The floors of a frame during the unloading.
    FrameUnload(Vec<UnloadStep>),
    /// Of the elements of a frame of matrices.
    ElementUnload(Vec<UnloadStep>),
    /// Its readings are those of the axial axes.
    Preload,
    Inspect,
}

impl History {
    /// The time step and the critical time step \[s\], if the step was longer than the critical one; for several impacts, those of the
    /// first.
    #[must_use]
    pub fn above_critical(&self) -> Option<(f64, f64)> {
        let steps_of = |impact: &ImpactHistory| (impact.time_step, impact.critical_time_step);
        let mut steps = match self {
            Self::Impact(impact) => vec![steps_of(impact)],
            Self::Shake(history) => vec![(history.time_step, history.critical_time_step)],
            Self::Escalate(history) => history
                .impacts
                .iter()
                .map(|impact| steps_of(&impact.history))
                .collect(),
            Self::StiffnessRamp(_)
            | Self::DampingSweep(_)
            | Self::Cycle(_)
            | Self::Move(_)
            | Self::Unload(_)
            | Self::FrameUnload(_)
            | Self::ElementUnload(_)
            | Self::Preload
            | Self::Inspect => Vec::new(),
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
            | Self::FrameUnload(_)
            | Self::ElementUnload(_)
            | Self::Preload
            | Self::Inspect => None,
        }
    }
}
