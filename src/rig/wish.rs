//! What a person wants of a run that goes on, heard from any thread: to end it after this step, or to hold the rig at
//! once. In: keys and signals. Out: two questions for who drives the rig. A wish only ever grows.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

const STOP: u8 = 1;
const HOLD: u8 = 2;

/// Shared by who asks and who obeys: a clone is the same wish.
#[derive(Clone, Debug, Default)]
pub struct Wish(Arc<AtomicU8>);

impl Wish {
    /// The run is to end at the end of this step.
    pub fn stop(&self) {
        self.0.fetch_max(STOP, Ordering::Relaxed);
    }

    /// The rig is to hold now, in the middle of a step too.
    pub fn hold_now(&self) {
        self.0.fetch_max(HOLD, Ordering::Relaxed);
    }

    /// Ctrl-C and its like: the first stops at the end of this step, the second holds now.
    pub fn interrupt(&self) {
        if self.0.compare_exchange(0, STOP, Ordering::Relaxed, Ordering::Relaxed).is_err() {
            self.hold_now();
        }
    }

    /// Whether the run is to end, now or after this step.
    #[must_use]
    pub fn wants_stop(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= STOP
    }

    /// Whether the rig is to hold now.
    #[must_use]
    pub fn wants_hold(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= HOLD
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
    }
}
