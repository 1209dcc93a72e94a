//! The rig that applies to an entry of a run log. In: the RIG entries, and the headers and resumptions beside them. Out: for an entry, the
//! rig that answered last before it, and the limit of speed at that time. An amended rig moves as its own RIG states, from its
//! resumption on.

use super::entry::{Header, RigBody};
use psd_plan::Interval;
use psd_rig::safety::failpoint::{Guarding, on};

/// A rig that answered, and the entries to which it applies.
#[derive(Clone, Debug)]
pub struct InForce {
    pub rig: RigBody,
    /// The limit of speed in its header \[m/s\].
    pub speed_limit: Interval,
    /// The first entry to which it applies.
    from: u64,
}

/// The rigs that answered, in order: at the start of the run, and at each resumption.
#[derive(Clone, Debug, Default)]
pub struct Rigs {
    in_force: Vec<InForce>,
    /// The last answer, before its resumption.
    answered: Option<RigBody>,
}

impl Rigs {
    /// The rig at the start of the run.
    #[must_use]
    pub fn first(&self) -> Option<&RigBody> {
        self.in_force.first().map(|first| &first.rig)
    }

    /// The rig of the last resumption, otherwise that of the start.
    #[must_use]
    pub fn last(&self) -> Option<&InForce> {
        self.at(None)
    }

    /// The rig that applies to the entry with this number. None: to the next entry, which is not written yet.
    pub(super) fn at(&self, entry: Option<u64>) -> Option<&InForce> {
        if !on(Guarding::NewestRig) {
            return self.in_force.first();
        }
        let applies = |one: &&InForce| entry.is_none_or(|entry| one.from <= entry);
        self.in_force.iter().rev().find(applies)
    }

    /// A rig answered. The first applies at once, every other from its resumption on.
    pub(super) fn answered(&mut self, rig: RigBody, header: &Header) {
        self.answered = Some(rig);
        if self.in_force.is_empty() {
            self.applies(0, header);
        }
    }

    /// The last answer applies from this entry on, with the limit of this header.
    pub(super) fn applies(&mut self, from: u64, header: &Header) {
        let Some(rig) = self.answered.take() else {
            return;
        };
        let speed_limit = header.equipment.speed_limit();
        self.in_force.push(InForce {
            rig,
            speed_limit,
            from,
        });
    }
}
