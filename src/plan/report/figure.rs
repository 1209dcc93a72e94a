//! Figures of a report: their kinds, and those that one report requests.

use crate::formula::ProcedureId;

/// Most procedures on one chart: more curves cannot be distinguished.
pub const MOST_TOGETHER: usize = 6;

/// One chart of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    pub kind: FigureKind,
    pub procedure: ProcedureId,
    /// Other procedures of the same kind, on the same axes.
    pub beside: Vec<ProcedureId>,
}

impl Figure {
    /// Every procedure it draws, in the order written.
    pub fn procedures(&self) -> impl Iterator<Item = ProcedureId> {
        std::iter::once(self.procedure).chain(self.beside.iter().copied())
    }
}

/// The content of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FigureKind {
    /// Displacement of structure and striker against simulated time (paper Fig. 9–11, 16).
    Displacement,
    /// Striker's velocity (paper Fig. 16).
    StrikerVelocity,
    /// Structure's and striker's velocity on one axis.
    Velocity,
    ContactForce,
    ForceDisplacement,
    Energy,
    /// Command against measurement.
    Tracking,
    DampingFit,
    /// Storey drift against simulated time.
    Drift,
    /// Storey shear against storey drift.
    Hysteresis,
    BaseShear,
    /// Shapes of the natural modes.
    Modes,
    /// Acceleration of the ground as it was applied.
    Ground,
    /// Largest forces against their displacements, one point for each amplitude.
    Backbone,
    /// Energy of each cycle.
    CycleEnergy,
    /// Secant stiffness of each cycle.
    StiffnessDegradation,
    /// Remaining relaxation of the force against the dwell time.
    Relaxation,
    /// Results of each impact of a series, against its energy.
    Escalate,
}

impl FigureKind {
    /// Every figure, in the order of the language reference.
    pub const ALL: [Self; 18] = [
        Self::Displacement,
        Self::StrikerVelocity,
        Self::Velocity,
        Self::ContactForce,
        Self::ForceDisplacement,
        Self::Energy,
        Self::Tracking,
        Self::DampingFit,
        Self::Drift,
        Self::Hysteresis,
        Self::BaseShear,
        Self::Modes,
        Self::Ground,
        Self::Backbone,
        Self::CycleEnergy,
        Self::StiffnessDegradation,
        Self::Relaxation,
        Self::Escalate,
    ];

    /// Name in `figures = [...]` and in file names.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::StrikerVelocity => "striker_velocity",
            Self::Velocity => "velocity",
            Self::ContactForce => "contact_force",
            Self::ForceDisplacement => "force_displacement",
            Self::Energy => "energy",
            Self::Tracking => "tracking",
            Self::DampingFit => "damping_fit",
            Self::Drift => "drift",
            Self::Hysteresis => "hysteresis",
            Self::BaseShear => "base_shear",
            Self::Modes => "modes",
            Self::Ground => "ground",
            Self::Backbone => "backbone",
            Self::CycleEnergy => "cycle_energy",
            Self::StiffnessDegradation => "stiffness_degradation",
            Self::Relaxation => "relaxation",
            Self::Escalate => "impacts",
        }
    }
}
