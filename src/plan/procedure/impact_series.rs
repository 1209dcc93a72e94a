//! A checked `escalate`: impacts of increasing energy on one specimen, until a condition no longer holds.

use crate::plan::formula::{Formula, ProcedureId};
use crate::plan::{Condition, Impact, Striker};

/// A series of impacts, each of a higher velocity than the one before.
#[derive(Clone, Debug)]
pub struct Escalate {
    /// Its own index in the plan: the results of an impact that `condition` reads have it.
    pub own: ProcedureId,
    /// Every impact, except for the velocity of its striker.
    pub impact: Impact,
    /// Velocity of the striker in each impact, m/s.
    pub velocities: Vec<Formula>,
    /// Energy of each impact, J, where the plan gives energies; else it follows from the velocities.
    pub energies: Option<Vec<Formula>>,
    /// The next impact follows only if the results of an impact satisfy every part of it.
    pub condition: Vec<Condition>,
    pub between: Between,
    /// Whether the operator inspects the specimen between two impacts.
    pub inspect_between: bool,
}

impl Escalate {
    /// The striker of the slowest impact, as far as the velocities are known before the run: it is the last to arrive.
    #[must_use]
    pub fn slowest(&self, striker: &Striker) -> Striker {
        self.with_known_velocity(striker, f64::min)
    }

    /// The striker of the fastest impact, as far as the velocities are known before the run: all impacts have its time step.
    #[must_use]
    pub fn fastest(&self, striker: &Striker) -> Striker {
        self.with_known_velocity(striker, f64::max)
    }

    /// The striker at the velocity that `choose` reduces the known ones to; at its own where none is known.
    fn with_known_velocity(&self, striker: &Striker, choose: fn(f64, f64) -> f64) -> Striker {
        let known = self
            .velocities
            .iter()
            .filter_map(Formula::constant)
            .reduce(choose);
        Striker {
            velocity: known.unwrap_or(striker.velocity),
            ..striker.clone()
        }
    }
}

/// Where the specimen is brought between two impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// To zero restoring force.
    Unload,
    /// Back to where the first impact began.
    Home,
    /// Nowhere: the next impact begins where this one ended.
    Stay,
}

/// Impacts of one `escalate`, at most.
pub const MOST_IMPACTS: usize = 1000;
