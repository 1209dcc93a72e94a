//! Ctrl-C and its like → the wish. In: SIGINT, SIGTERM, SIGHUP. Out: the first stops the run at the end of its step, the second holds the
//! rig now; by hand, where there are no steps, the first holds it. The signal of a file that is too large is caught too, and does nothing.

use std::sync::Arc;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator;

use crate::rig::Wish;

/// Signals are caught as long as this lives. Afterwards they do nothing: what a run leaves is still being written. One for all
/// of a run: what came while one was given up for another would be lost.
pub struct Signals {
    handle: iterator::Handle,
    wish: Wish,
}

impl Signals {
    pub fn caught(wish: &Wish) -> std::io::Result<Self> {
        Self::become_wishes(wish, interrupt)
    }

    /// The first signal holds the rig already.
    pub fn holding(wish: &Wish) -> std::io::Result<Self> {
        Self::become_wishes(wish, Wish::hold_now)
    }

    fn become_wishes(wish: &Wish, become_wish: fn(&Wish)) -> std::io::Result<Self> {
        let mut signals = iterator::Signals::new([SIGINT, SIGTERM, SIGHUP])?;
        let handle = signals.handle();
        let (wish, theirs) = (wish.clone(), wish.clone());
        std::thread::spawn(move || {
            for _ in signals.forever() {
                become_wish(&theirs);
            }
        });
        Ok(Self { handle, wish })
    }

    /// What they become.
    pub const fn wish(&self) -> &Wish {
        &self.wish
    }
}

/// From here on a file that may not grow any further is a write that fails, and holds the rig, not the program's end.
pub fn catch_full_files() -> std::io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}

/// One Ctrl-C: the first stops the run at the end of its step, the second holds the rig now.
pub fn interrupt(wish: &Wish) {
    if wish.wants_end() {
        wish.hold_now();
    } else {
        wish.stop_after_step();
    }
}

impl Drop for Signals {
    fn drop(&mut self) {
        self.handle.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_interrupt_stops_and_the_second_holds() {
        let wish = Wish::default();
        interrupt(&wish);
        assert!(wish.wants_end() && !wish.wants_hold());
        interrupt(&wish);
        assert!(wish.wants_hold());
    }
}
