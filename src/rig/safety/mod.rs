//! The last safety measure of the program: the rig receives a hold command after any failure of the program. In: lines that can still
//! send, and a heartbeat of the driving thread. Out: hold commands, after a panic or when the heartbeat stops. It waits for no reply and
//! knows no protocol. A killed program sends nothing: the rig's own watchdog and the wired stop protect against this.

pub mod final_hold;
pub mod live;
pub mod stop_request;

pub use psd_plan::record::failpoint;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, MutexGuard, Once, TryLockError};
use std::thread::JoinHandle;
use std::time::Duration;

use super::safety::failpoint::{Guarding, on};
use super::transport::{Clock as _, Emergency, MonotonicClock};

/// Lines, each with the bytes that stop its device.
pub type Lines = Vec<(Box<dyn Emergency>, Vec<u8>)>;

/// An armed line.
struct ArmedLine {
    /// Number of the owner that armed it.
    owner: u64,
    sender: Box<dyn Emergency>,
    bytes: Vec<u8>,
}

/// All armed lines.
static LINES: Mutex<Vec<ArmedLine>> = Mutex::new(Vec::new());
static NEXT: AtomicU64 = AtomicU64::new(0);
static BEATS: AtomicU64 = AtomicU64::new(0);

/// Time between two checks of the watchdog thread, and between two attempts of a panic to lock the lines.
const LOOK: Duration = Duration::from_millis(50);
const TRIES: u32 = 20;

/// The lines are armed during its lifetime.
#[must_use = "dropping it disarms the lines"]
pub struct Armed {
    number: u64,
    watch: Option<(Sender<()>, JoinHandle<()>)>,
}

/// Arms lines: from now on a panic in any thread sends their bytes. Lines without bytes are omitted.
pub fn arm(lines: Lines) -> Armed {
    hook();
    let number = NEXT.fetch_add(1, Ordering::SeqCst);
    if let Some(mut armed) = take_lines() {
        let able = lines.into_iter().filter(|(_, bytes)| !bytes.is_empty());
        armed.extend(able.map(|(sender, bytes)| ArmedLine {
            owner: number,
            sender,
            bytes,
        }));
    }
    Armed {
        number,
        watch: None,
    }
}

impl Armed {
    /// Also sends the bytes, once, if there was no [`beat`] for `watchdog` seconds.
    pub fn watched(mut self, watchdog: f64) -> Self {
        let (stop, stopped) = channel();
        let guarded = on(Guarding::HostWatchdog);
        let thread = std::thread::spawn(move || {
            let clock = MonotonicClock::start();
            let mut pulse = Pulse::new(watchdog, BEATS.load(Ordering::SeqCst), clock.now());
            while stopped.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if guarded && pulse.stopped(BEATS.load(Ordering::SeqCst), clock.now()) {
                    hold_everything();
                }
            }
        });
        self.watch = Some((stop, thread));
        self
    }
}

impl Drop for Armed {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.watch.take() {
            drop(stop);
            thread.join().ok();
        }
        if let Some(mut lines) = take_lines() {
            lines.retain(|line| line.owner != self.number);
        }
    }
}

/// Sends the bytes of every armed line, without waiting for an answer.
pub fn hold_everything() {
    if let Some(mut lines) = take_lines() {
        for ArmedLine { sender, bytes, .. } in lines.iter_mut() {
            sender.send(bytes);
        }
    }
}

/// A heartbeat of the code that drives the rig.
pub fn beat() {
    BEATS.fetch_add(1, Ordering::SeqCst);
}

/// The lines. None if another thread has the lock, such as a thread that panicked while sending.
fn take_lines() -> Option<MutexGuard<'static, Vec<ArmedLine>>> {
    for _ in 0..TRIES {
        match LINES.try_lock() {
            Ok(lines) => return Some(lines),
            Err(TryLockError::Poisoned(poisoned)) => return Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => std::thread::sleep(LOOK / TRIES),
        }
    }
    None
}

/// Installs a panic hook that holds the rig first.
fn hook() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if on(Guarding::PanicHook) {
                hold_everything();
            }
            before(info);
        }));
    });
}

/// Detects from counted heartbeats and a clock when they stop.
struct Pulse {
    watchdog: f64,
    beats: u64,
    /// \[s\]
    last: f64,
    reported: bool,
}

impl Pulse {
    const fn new(watchdog: f64, beats: u64, now: f64) -> Self {
        Self {
            watchdog,
            beats,
            last: now,
            reported: false,
        }
    }

    /// Whether they have just stopped; reported once.
    fn stopped(&mut self, beats: u64, now: f64) -> bool {
        if beats != self.beats {
            (self.beats, self.last) = (beats, now);
        }
        let late = now - self.last > self.watchdog;
        late && !std::mem::replace(&mut self.reported, late)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::failpoint::without;
    use std::sync::Arc;
    use std::thread::{ThreadId, current, spawn};

    /// The bytes sent, and the thread that sent them: other tests panic and hold too, and their bytes reach every armed
    /// line.
    #[derive(Clone, Default)]
    struct Recorder(Arc<Mutex<Vec<Sent>>>);

    type Sent = (ThreadId, Vec<u8>);

    impl Emergency for Recorder {
        fn send(&mut self, bytes: &[u8]) {
            self.0
                .lock()
                .unwrap()
                .push((current().id(), bytes.to_vec()));
        }
    }

    impl Recorder {
        fn sent_by(&self, thread: ThreadId) -> Vec<u8> {
            let sent = self.0.lock().unwrap();
            sent.iter()
                .filter(|(by, _)| *by == thread)
                .flat_map(|(_, bytes)| bytes.clone())
                .collect()
        }
    }

    /// A thread that ends by a panic in `what`.
    fn panicked(what: impl FnOnce() + Send + 'static) -> ThreadId {
        let thread = spawn(what);
        let id = thread.thread().id();
        assert!(thread.join().is_err());
        id
    }

    #[test]
    fn a_panic_in_any_thread_stops_every_armed_line_and_no_other() {
        let (first, second, without_words) = (
            Recorder::default(),
            Recorder::default(),
            Recorder::default(),
        );
        let armed = arm(vec![
            (Box::new(first.clone()), b"!".to_vec()),
            (Box::new(second.clone()), b"\x85".to_vec()),
            (Box::new(without_words.clone()), Vec::new()),
        ]);
        let thread = panicked(|| panic!("on purpose, to see the rig held"));
        assert_eq!(
            (first.sent_by(thread), second.sent_by(thread)),
            (b"!".to_vec(), b"\x85".to_vec())
        );
        assert!(without_words.0.lock().unwrap().is_empty());
        let unguarded = panicked(|| {
            without(Guarding::PanicHook, || {
                panic!("on purpose, to see nothing held")
            });
        });
        assert!(
            first.sent_by(unguarded).is_empty(),
            "it is the hook that holds"
        );
        drop(armed);
        hold_everything();
        assert!(first.sent_by(current().id()).is_empty(), "disarmed");
    }

    #[test]
    fn missing_heartbeats_are_reported_once() {
        let mut pulse = Pulse::new(3.0, 7, 0.0);
        assert!(!pulse.stopped(7, 2.9));
        assert!(!pulse.stopped(8, 3.5), "it lives");
        assert!(!pulse.stopped(8, 6.5));
        assert!(pulse.stopped(8, 6.6));
        assert!(!pulse.stopped(8, 60.0));
    }

    /// Lines with a watch that regards any silence as too long, the bytes sent to them, and the thread of the watch.
    fn nobody_beats() -> (Armed, Recorder, ThreadId) {
        let recorder = Recorder::default();
        let armed = arm(vec![(Box::new(recorder.clone()), b"!".to_vec())]).watched(-1.0);
        let watch = armed
            .watch
            .as_ref()
            .map(|(_, thread)| thread.thread().id())
            .unwrap();
        (armed, recorder, watch)
    }

    #[test]
    fn the_watch_sends_the_bytes_when_nobody_beats() {
        let (armed, recorder, watch) = nobody_beats();
        while recorder.sent_by(watch) != b"!" {
            std::thread::yield_now();
        }
        drop(armed);
        let (armed, recorder, watch) = without(Guarding::HostWatchdog, nobody_beats);
        std::thread::sleep(LOOK * 4);
        drop(armed);
        assert!(
            recorder.sent_by(watch).is_empty(),
            "it is the watch that holds"
        );
    }
}
