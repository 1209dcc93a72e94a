//! Stop requests during a run. In: requests from signal handlers, keys and other threads. Out: the request, for code that
//! waits on a rig. It knows no rig and does nothing itself.

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

const NOTHING: u8 = 0;
const STOP_AFTER_STEP: u8 = 1;
const HOLD_NOW: u8 = 2;
/// A request to hold that has been acknowledged: it must not interrupt the hold command itself.
const ACKNOWLEDGED: u8 = 3;

/// A stop request that all clones share.
#[derive(Clone, Debug, Default)]
pub struct StopRequest {
    what: Arc<AtomicU8>,
    /// Number of requests to stop or to hold.
    requests: Arc<AtomicU32>,
    with_release_allowed: Arc<AtomicBool>,
    unasked: Arc<AtomicBool>,
    /// The bits of the longest time, s, that a line was not looked at.
    absence: Arc<AtomicU64>,
    client: Client,
}

/// Whether the client that requested the present move is disconnected. None: no client requested it.
#[derive(Clone, Default)]
struct Client(Arc<Mutex<Option<IsDisconnected>>>);

type IsDisconnected = Box<dyn Fn() -> bool + Send>;

impl Client {
    fn set(&self, is_disconnected: Option<IsDisconnected>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = is_disconnected;
    }

    fn is_disconnected(&self) -> bool {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .as_ref()
            .is_some_and(|is_disconnected| is_disconnected())
    }
}

impl std::fmt::Debug for Client {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Client")
    }
}

impl StopRequest {
    /// A rig that is found on hold when it is opened may be released: the operator has inspected it and allows this.
    #[must_use]
    pub fn with_release_allowed(self, wanted: bool) -> Self {
        self.with_release_allowed.store(wanted, Ordering::SeqCst);
        self
    }

    /// Whether a rig that is found on hold may be released.
    #[must_use]
    pub fn release_allowed(&self) -> bool {
        self.with_release_allowed.load(Ordering::SeqCst)
    }

    /// The end was not requested at the keyboard: no more prompts.
    pub fn suppress_prompts(&self) {
        self.unasked.store(true, Ordering::SeqCst);
    }

    /// Whether the operator may be prompted at the end.
    #[must_use]
    pub fn prompts_allowed(&self) -> bool {
        !self.unasked.load(Ordering::SeqCst)
    }

    /// A line was not looked at for this long \[s\]: no code sent to it or waited for its answer.
    pub fn note_line_gap(&self, seconds: f64) {
        // For numbers that are not negative, the larger number has the larger bit pattern.
        self.absence
            .fetch_max(seconds.max(0.0).to_bits(), Ordering::SeqCst);
    }

    /// The longest time, s, that a line was not looked at since this was asked last.
    #[must_use]
    pub fn take_line_gap(&self) -> f64 {
        f64::from_bits(self.absence.swap(0, Ordering::SeqCst))
    }

    /// The run is to end after the present step.
    pub fn stop_after_step(&self) {
        self.requests.fetch_add(1, Ordering::SeqCst);
        // A stronger request remains.
        self.what
            .compare_exchange(NOTHING, STOP_AFTER_STEP, Ordering::SeqCst, Ordering::SeqCst)
            .ok();
    }

    /// The rig is to hold immediately: every wait on it ends.
    pub fn hold_now(&self) {
        self.requests.fetch_add(1, Ordering::SeqCst);
        self.what.store(HOLD_NOW, Ordering::SeqCst);
    }

    /// Executes a client's move. The rig must hold immediately if the client disconnects meanwhile; this does not end the run.
    pub fn for_client<T>(
        &self,
        is_disconnected: impl Fn() -> bool + Send + 'static,
        moves: impl FnOnce() -> T,
    ) -> T {
        self.client.set(Some(Box::new(is_disconnected)));
        let moved = moves();
        self.client.set(None);
        moved
    }

    /// Notes that the request to hold was seen, so that the hold command can be sent and answered.
    pub fn acknowledge(&self) {
        self.what
            .compare_exchange(HOLD_NOW, ACKNOWLEDGED, Ordering::SeqCst, Ordering::SeqCst)
            .ok();
        self.client.set(None);
    }

    /// Whether a hold is requested that has not been acknowledged yet.
    #[must_use]
    pub fn hold_requested(&self) -> bool {
        self.what.load(Ordering::SeqCst) == HOLD_NOW || self.client.is_disconnected()
    }

    /// How often a stop or a hold was requested: a request that repeats an earlier one is counted too.
    #[must_use]
    pub fn requests(&self) -> u32 {
        self.requests.load(Ordering::SeqCst)
    }

    /// Whether the run is to end, now or after the step.
    #[must_use]
    pub fn end_requested(&self) -> bool {
        self.what.load(Ordering::SeqCst) != NOTHING
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wish_to_hold_outranks_one_to_stop_and_can_be_heeded_once() {
        let stop_request = StopRequest::default();
        let clone = stop_request.clone();
        assert!(!stop_request.end_requested());
        clone.stop_after_step();
        assert!(stop_request.end_requested() && !stop_request.hold_requested());
        clone.hold_now();
        clone.stop_after_step();
        assert!(stop_request.hold_requested(), "not weakened");
        stop_request.acknowledge();
        assert!(!clone.hold_requested() && clone.end_requested());
        assert_eq!(stop_request.requests(), 3);
        clone.hold_now();
        assert!(
            stop_request.hold_requested(),
            "a second request is a new one"
        );
        assert_eq!(stop_request.requests(), 4);
        assert!(stop_request.prompts_allowed());
        clone.suppress_prompts();
        assert!(!stop_request.prompts_allowed());
        assert!(
            !stop_request.release_allowed()
                && StopRequest::default()
                    .with_release_allowed(true)
                    .clone()
                    .release_allowed()
        );
    }

    #[test]
    fn a_client_that_is_gone_holds_its_own_move_and_ends_nothing() {
        let stop_request = StopRequest::default();
        let gone = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&gone);
        stop_request.for_client(
            move || seen.load(Ordering::SeqCst),
            || {
                assert!(!stop_request.hold_requested(), "it is there");
                gone.store(true, Ordering::SeqCst);
                assert!(stop_request.clone().hold_requested() && !stop_request.end_requested());
                stop_request.acknowledge();
                assert!(
                    !stop_request.hold_requested(),
                    "the words that hold are not interrupted"
                );
            },
        );
        stop_request.for_client(|| true, || assert!(stop_request.hold_requested()));
        assert!(
            !stop_request.hold_requested() && !stop_request.end_requested(),
            "the next client's rig"
        );
    }
}
