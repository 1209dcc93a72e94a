//! What a person wants of a run that is under way, heard from any thread: to end it after this step, or to hold the rig
//! at once. In: keys and signals. Out: two questions for who drives the rig. It knows no rig; a wish only ever grows.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

const NOTHING: u8 = 0;
const STOP: u8 = 1;
const HOLD: u8 = 2;
/// A wish to hold that has been seen: holding itself must not be interrupted by it.
const HEEDED: u8 = 3;

/// Shared by who asks and who obeys: a clone is the same wish.
#[derive(Clone, Debug, Default)]
pub struct Wish(Arc<AtomicU8>);

impl Wish {
    /// The run is to end at the end of this step.
    pub fn stop(&self) {
        self.0.fetch_max(STOP, Ordering::SeqCst);
    }

    /// The rig is to hold now, in the middle of a step too: every wait on it ends.
    pub fn hold_now(&self) {
        self.0.fetch_max(HOLD, Ordering::SeqCst);
    }

    /// Ctrl-C and its like: the first stops at the end of this step, the second holds now.
    pub fn interrupt(&self) {
        if self.0.compare_exchange(NOTHING, STOP, Ordering::SeqCst, Ordering::SeqCst).is_err() {
            self.hold_now();
        }
    }

    /// Says that the wish to hold was seen, so that the words that hold the rig can be said and answered.
    pub fn heed(&self) {
        self.0.compare_exchange(HOLD, HEEDED, Ordering::SeqCst, Ordering::SeqCst).ok();
    }

    /// Whether the run is to end, now or after this step.
    #[must_use]
    pub fn wants_stop(&self) -> bool {
        self.0.load(Ordering::SeqCst) != NOTHING
    }

    /// Whether a hold is wanted that nobody has seen yet.
    #[must_use]
    pub fn wants_hold(&self) -> bool {
        self.0.load(Ordering::SeqCst) == HOLD
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_interrupt_stops_and_the_second_holds() {
        let wish = Wish::default();
        let elsewhere = wish.clone();
        assert!(!wish.wants_stop() && !wish.wants_hold());
        elsewhere.interrupt();
        assert!(wish.wants_stop() && !wish.wants_hold());
        elsewhere.interrupt();
        assert!(wish.wants_hold());
        wish.stop();
        assert!(elsewhere.wants_hold(), "a wish never shrinks");
        wish.heed();
        elsewhere.hold_now();
        assert!(!wish.wants_hold() && wish.wants_stop(), "seen once is enough");
    }
}
