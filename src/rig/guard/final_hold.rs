//! The guard at the early end of a run. In: a rig that is to hold for good. Out: what became of it. It judges no reading: the run is over.

use crate::rig::{Guard, Halted};

impl Guard<'_> {
    /// Holds for good, and gives what became of it, where anything real moves. What was proposed is forgotten.
    pub fn halt(&mut self) -> Option<Halted> {
        self.proposed = None;
        self.going.clear();
        let halted = self.rig.halt();
        if let Some(halted) = &halted {
            self.heard = halted.time;
        }
        halted
    }
}
