//! A checked `escalate`: blows of rising energy on one specimen, until a condition no longer holds.

use crate::plan::formula::{Formula, ProcedureId};
use crate::plan::{Condition, Impact, StoreyImpact, Striker};

/// One impact after the other, each harder.
#[derive(Clone, Debug)]
pub struct Escalate {
    /// Its own place in the plan: results of a blow that `condition` reads bear it.
    pub own: ProcedureId,
    /// Every blow, but for the velocity of its striker.
    pub blow: BlowOn,
    /// Velocity of the striker of each blow, m/s.
    pub velocities: Vec<Formula>,
    /// Energy of each blow, J, where the plan gives energies; else it follows from the velocities.
    pub energies: Option<Vec<Formula>>,
    /// What must hold of the results of a blow for the next to follow; every part of it.
    pub condition: Vec<Condition>,
    pub between: Between,
    /// Whether a person looks at the specimen between two blows.
    pub inspect_between: bool,
}

impl Escalate {
    /// Its place in the plan.
    #[must_use]
    pub const fn striker(&self) -> usize {
        match &self.blow {
            BlowOn::Specimen(blow) => blow.striker,
            BlowOn::Storey(blow) => blow.striker,
        }
    }

    /// The striker of the slowest blow, as far as the velocities are known before the run: it is the last to arrive.
    #[must_use]
    pub fn slowest(&self, striker: &Striker) -> Striker {
        let known = self
            .velocities
            .iter()
            .filter_map(Formula::constant)
            .reduce(f64::min);
        Striker {
            velocity: known.unwrap_or(striker.velocity),
            ..striker.clone()
        }
    }

    /// The striker of the fastest blow, as far as the velocities are known before the run: all blows have its time step.
    #[must_use]
    pub fn fastest(&self, striker: &Striker) -> Striker {
        let known = self
            .velocities
            .iter()
            .filter_map(Formula::constant)
            .reduce(f64::max);
        Striker {
            velocity: known.unwrap_or(striker.velocity),
            ..striker.clone()
        }
    }
}

/// What a blow strikes.
#[derive(Clone, Debug)]
pub enum BlowOn {
    /// A specimen of one degree of freedom.
    Specimen(Impact),
    /// One storey of a frame.
    Storey(StoreyImpact),
}

impl BlowOn {
    /// As an index into `Plan::specimens`.
    #[must_use]
    pub const fn specimen(&self) -> usize {
        match self {
            Self::Specimen(impact) => impact.specimen,
            Self::Storey(impact) => impact.specimen,
        }
    }

    /// As an index into `Plan::strikers`.
    #[must_use]
    pub const fn striker(&self) -> usize {
        match self {
            Self::Specimen(impact) => impact.striker,
            Self::Storey(impact) => impact.striker,
        }
    }
}

/// What is done between two blows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// To where the restoring force is none: the specimen rests where it would by itself.
    Unload,
    /// Back to where the first blow began.
    Home,
    /// The next blow begins where this one ended.
    Stay,
}

/// Blows of one `escalate`, at most.
pub const MOST_BLOWS: usize = 1000;
