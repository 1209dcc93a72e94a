//! A checked `escalate`: an impact series of increasing energy on one specimen, until a condition no longer holds.

use crate::formula::{Formula, ProcedureId};
use crate::{Condition, Impact, Striker};

/// A series of impacts, each with a higher velocity than the previous one.
#[derive(Clone, Debug)]
pub struct Escalate {
    /// Index of the series in the plan: `condition` reads the results of an impact under it.
    pub own: ProcedureId,
    /// Every impact, except for the velocity of its striker.
    pub impact: Impact,
    /// Velocity of the striker in each impact \[m/s\].
    pub velocities: Vec<Formula>,
    /// Energy of each impact \[J\], if the plan gives energies; otherwise it follows from the velocities.
    pub energies: Option<Vec<Formula>>,
    /// The next impact follows only if the results of the present impact satisfy every part of the condition.
    pub condition: Vec<Condition>,
    pub between: Between,
    /// Whether the operator inspects the specimen between two impacts.
    pub inspect_between: bool,
}

impl Escalate {
    /// The striker of the slowest impact, among the velocities that are known before the run: it arrives last.
    #[must_use]
    pub fn slowest(&self, striker: &Striker) -> Striker {
        self.with_known_velocity(striker, f64::min)
    }

    /// The striker of the fastest impact, among the velocities that are known before the run: all impacts have its time step.
    #[must_use]
    pub fn fastest(&self, striker: &Striker) -> Striker {
        self.with_known_velocity(striker, f64::max)
    }

    /// The striker with the velocity that `choose` selects from the known ones; with its own velocity if none is known.
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

/// The position of the specimen between two impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// The position of zero restoring force.
    Unload,
    /// The position at the start of the first impact.
    Home,
    /// The position at the end of the present impact: no move.
    Stay,
}

/// Largest number of impacts of one `escalate`.
pub const MOST_IMPACTS: usize = 1000;
