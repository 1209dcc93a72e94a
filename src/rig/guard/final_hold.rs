//! The guard at the early end of a run. In: a rig that is to hold finally. Out: the result of that hold. It assesses no
//! reading, because the run is over.

use crate::rig::{FinalHold, Guard};

impl Guard<'_> {
    /// Holds finally and gives the result, for a rig with moving parts. A proposed move is discarded.
    pub fn halt(&mut self) -> Option<FinalHold> {
        self.proposed = None;
        self.going.clear();
        let halted = self.rig.halt();
        if let Some(halted) = &halted {
            self.last_contact = halted.time;
        }
        halted
    }
}
