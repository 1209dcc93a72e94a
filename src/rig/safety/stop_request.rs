//! What a person wants of a run that is under way. In: wishes from signal handlers, keys and other threads. Out: the
//! wish, for whoever waits on a rig. It knows no rig and does nothing itself.

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

const NOTHING: u8 = 0;
const STOP_AFTER_STEP: u8 = 1;
const HOLD_NOW: u8 = 2;
/// A wish to hold that has been seen: holding itself must not be interrupted by it.
const HEEDED: u8 = 3;

/// A wish that all clones share.
#[derive(Clone, Debug, Default)]
pub struct Wish {
    what: Arc<AtomicU8>,
    /// How often a stop or a hold was requested.
    requests: Arc<AtomicU32>,
    letting_go: Arc<AtomicBool>,
    unasked: Arc<AtomicBool>,
    /// The bits of the longest time, s, that a line was not looked at.
    absence: Arc<AtomicU64>,
    client: Client,
}

/// Tells whether the client that asked for the move under way is gone; None: no client asked for it.
#[derive(Clone, Default)]
struct Client(Arc<Mutex<Option<IsGone>>>);

type IsGone = Box<dyn Fn() -> bool + Send>;

impl Client {
    fn set(&self, is_gone: Option<IsGone>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = is_gone;
    }

    fn is_gone(&self) -> bool {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .as_ref()
            .is_some_and(|is_gone| is_gone())
    }
}

impl std::fmt::Debug for Client {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Client")
    }
}

impl Wish {
    /// A rig that is found held when it is opened is to be let go of: a person has looked at it, and says so.
    #[must_use]
    pub fn letting_go(self, wanted: bool) -> Self {
        self.letting_go.store(wanted, Ordering::SeqCst);
        self
    }

    /// Whether a rig that is found held may be let go of.
    #[must_use]
    pub fn lets_go(&self) -> bool {
        self.letting_go.load(Ordering::SeqCst)
    }

    /// Whoever wants the end is no person at the keys: nothing is to be asked any more.
    pub fn ask_nobody(&self) {
        self.unasked.store(true, Ordering::SeqCst);
    }

    /// Whether a person may be asked at the end.
    #[must_use]
    pub fn may_ask(&self) -> bool {
        !self.unasked.load(Ordering::SeqCst)
    }

    /// A line was not looked at for this long, s: nobody sent, and nobody waited for an answer.
    pub fn was_away(&self, seconds: f64) {
        // Of numbers that are not negative the greater has the greater bits.
        self.absence
            .fetch_max(seconds.max(0.0).to_bits(), Ordering::SeqCst);
    }

    /// The longest time, s, that a line was not looked at since this was asked last.
    #[must_use]
    pub fn take_absence(&self) -> f64 {
        f64::from_bits(self.absence.swap(0, Ordering::SeqCst))
    }

    /// The run is to end when the step under way is done.
    pub fn stop_after_step(&self) {
        self.requests.fetch_add(1, Ordering::SeqCst);
        // A stronger wish stays.
        self.what
            .compare_exchange(NOTHING, STOP_AFTER_STEP, Ordering::SeqCst, Ordering::SeqCst)
            .ok();
    }

    /// The rig is to hold at once: every wait on it ends.
    pub fn hold_now(&self) {
        self.requests.fetch_add(1, Ordering::SeqCst);
        self.what.store(HOLD_NOW, Ordering::SeqCst);
    }

    /// Does a client's move. The rig is to hold at once where the client is gone meanwhile; the run does not end with that.
    pub fn for_client<T>(
        &self,
        is_gone: impl Fn() -> bool + Send + 'static,
        moves: impl FnOnce() -> T,
    ) -> T {
        self.client.set(Some(Box::new(is_gone)));
        let moved = moves();
        self.client.set(None);
        moved
    }

    /// Says that the wish to hold was seen, so that the words that hold the rig can be said and answered.
    pub fn heed(&self) {
        self.what
            .compare_exchange(HOLD_NOW, HEEDED, Ordering::SeqCst, Ordering::SeqCst)
            .ok();
        self.client.set(None);
    }

    /// Whether a hold is wanted that nobody has seen yet.
    #[must_use]
    pub fn wants_hold(&self) -> bool {
        self.what.load(Ordering::SeqCst) == HOLD_NOW || self.client.is_gone()
    }

    /// How often a stop or a hold was requested: a request that repeats an earlier one is counted too.
    #[must_use]
    pub fn requests(&self) -> u32 {
        self.requests.load(Ordering::SeqCst)
    }

    /// Whether the run is to end, now or after the step.
    #[must_use]
    pub fn wants_end(&self) -> bool {
        self.what.load(Ordering::SeqCst) != NOTHING
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wish_to_hold_outranks_one_to_stop_and_can_be_heeded_once() {
        let wish = Wish::default();
        let clone = wish.clone();
        assert!(!wish.wants_end());
        clone.stop_after_step();
        assert!(wish.wants_end() && !wish.wants_hold());
        clone.hold_now();
        clone.stop_after_step();
        assert!(wish.wants_hold(), "not weakened");
        wish.heed();
        assert!(!clone.wants_hold() && clone.wants_end());
        assert_eq!(wish.requests(), 3);
        clone.hold_now();
        assert!(wish.wants_hold(), "a second wish is a new one");
        assert_eq!(wish.requests(), 4);
        assert!(wish.may_ask());
        clone.ask_nobody();
        assert!(!wish.may_ask());
        assert!(!wish.lets_go() && Wish::default().letting_go(true).clone().lets_go());
    }

    #[test]
    fn a_client_that_is_gone_holds_its_own_move_and_ends_nothing() {
        let wish = Wish::default();
        let gone = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&gone);
        wish.for_client(
            move || seen.load(Ordering::SeqCst),
            || {
                assert!(!wish.wants_hold(), "it is there");
                gone.store(true, Ordering::SeqCst);
                assert!(wish.clone().wants_hold() && !wish.wants_end());
                wish.heed();
                assert!(
                    !wish.wants_hold(),
                    "the words that hold are not interrupted"
                );
            },
        );
        wish.for_client(|| true, || assert!(wish.wants_hold()));
        assert!(
            !wish.wants_hold() && !wish.wants_end(),
            "the next client's rig"
        );
    }
}
