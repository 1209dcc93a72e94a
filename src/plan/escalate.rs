//! A checked `escalate`: blows of rising energy on one specimen, until a condition no longer holds.

use super::{Condition, Impact};
use crate::formula::{Formula, ProcedureId};

/// One impact after the other, each harder.
#[derive(Clone, Debug)]
pub struct Escalate {
    /// Its own place in the plan: results of a blow that `condition` reads bear it.
    pub own: ProcedureId,
    /// Every blow, but for the velocity of its striker.
    pub blow: Impact,
    /// Velocity of the striker of each blow, m/s.
    pub velocities: Vec<Formula>,
    /// What must hold of the results of a blow for the next to follow; every part of it.
    pub condition: Vec<Condition>,
    pub between: Between,
    /// Whether a person looks at the specimen between two blows.
    pub inspect_between: bool,
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
