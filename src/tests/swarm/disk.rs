//! The disk of a life: it can be full, tear a write, fail a flush or only pretend one, and psd can be killed at any of its calls. In: the
//! bytes of a run log. Out: the bytes that remain, and what the disk reported to psd about them. It knows of an entry only its kind and its target.

use std::io::{self, ErrorKind};
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::fault::{DiskFault, Fault, Kill};
use psd_rig::journal::Storage;
use psd_testing::journal::PowerLoss;

/// psd was killed: the panic of a kill, which is no fault.
pub(super) struct Killed;

/// A disk; its clones are the same.
#[derive(Clone, Default)]
pub(super) struct Disk(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    written: Vec<u8>,
    /// Bytes that survive a loss of power.
    durable: usize,
    /// Bytes that the disk reported as durable.
    promised: usize,
    calls: u32,
    faults: Vec<(u32, DiskFault)>,
    kill: Option<Kill>,
    full: bool,
    has_reserve: bool,
    lost_flushes: u32,
    dead: bool,
    struck: Vec<&'static str>,
    /// End of the last INTENT \[bytes\], and its targets \[m\].
    intent: Option<(usize, Vec<f64>)>,
    intents: u64,
    /// End of the last SAMPLE \[bytes\].
    sample: usize,
    /// INTENT entries that were written before a reading was durable.
    early: u64,
}

/// What the run log says about the target that a rig receives now.
pub(super) struct Logged {
    /// Number of INTENT entries so far.
    pub(super) number: u64,
    /// Targets of the last one \[m\].
    pub(super) targets: Vec<f64>,
    /// Whether the disk reported it as durable.
    pub(super) durable: bool,
}

impl Disk {
    /// The disk of a session: with these bytes, and these faults. `intents` is the number of INTENT entries that were ever written.
    pub(super) fn of_session(bytes: &[u8], faults: &[Fault], before: &Self) -> Self {
        let mut state = State {
            written: bytes.to_vec(),
            durable: bytes.len(),
            promised: bytes.len(),
            intents: before.lock().intents,
            ..State::default()
        };
        for fault in faults {
            match fault {
                Fault::Disk { at, what } => state.faults.push((*at, *what)),
                Fault::Killed(kill) if kill.at_the_disk => state.kill = Some(*kill),
                _ => {}
            }
        }
        // The INTENT that a resumption may send again.
        let text = String::from_utf8_lossy(bytes).into_owned();
        let mut end = 0;
        for line in text.split_inclusive('\n') {
            end += line.len();
            if is(line, "INTENT") {
                state.intent = Some((end, targets(line)));
            }
        }
        Self(Arc::new(Mutex::new(state)))
    }

    pub(super) fn written(&self) -> Vec<u8> {
        self.lock().written.clone()
    }

    /// The bytes that psd finds when it starts again after this kill.
    pub(super) fn left_after(&self, kill: Kill) -> Vec<u8> {
        let state = self.lock();
        let Some((length, sectors)) = kill.power else {
            return state.written.clone();
        };
        let mut disk = PowerLoss::holding(&state.written[..state.durable]);
        disk.append(&state.written[state.durable..]).ok();
        disk.after_loss(length, |sector| sectors >> (sector % 4) & 1 == 1)
    }

    /// Number of bytes that survive a loss of power.
    pub(super) fn durable(&self) -> u64 {
        self.lock().durable as u64
    }

    pub(super) fn logged(&self) -> Option<Logged> {
        let state = self.lock();
        let (end, targets) = state.intent.clone()?;
        Some(Logged {
            number: state.intents,
            targets,
            durable: end <= state.promised,
        })
    }

    /// Number of targets that were logged before the reading before them was durable.
    pub(super) fn early(&self) -> u64 {
        self.lock().early
    }

    pub(super) fn struck(&self) -> Vec<&'static str> {
        self.lock().struck.clone()
    }

    /// psd is gone: nothing more is written.
    pub(super) fn die(&self) {
        self.lock().dead = true;
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A call of the disk, with its fault and with the kill that is due at it.
    fn call(&self, done: impl FnOnce(&mut State, u32) -> io::Result<()>) -> io::Result<()> {
        let mut state = self.lock();
        // A value that is dropped while psd dies writes nothing.
        if state.dead {
            return Ok(());
        }
        let call = state.calls;
        state.calls += 1;
        let kill = state.kill.filter(|kill| kill.at == call);
        if kill.is_some_and(|kill| !kill.after) {
            state.dead = true;
            drop(state);
            resume_unwind(Box::new(Killed));
        }
        let result = done(&mut state, call);
        if kill.is_some() {
            state.dead = true;
            drop(state);
            resume_unwind(Box::new(Killed));
        }
        result
    }
}

impl State {
    /// The fault that is due at this call, if it is one of a write or of a flush.
    fn due(&mut self, call: u32, of_a_write: bool) -> Option<DiskFault> {
        let writes =
            |fault: &DiskFault| matches!(fault, DiskFault::Full { .. } | DiskFault::TornWrite);
        let due = |(at, fault): &(u32, DiskFault)| *at <= call && writes(fault) == of_a_write;
        let due = self.faults.iter().position(due)?;
        Some(self.faults.remove(due).1)
    }

    fn append(&mut self, bytes: &[u8], call: u32) -> io::Result<()> {
        let fault = self.due(call, true);
        if let Some(DiskFault::Full { reserve }) = fault {
            (self.full, self.has_reserve) = (true, reserve);
        }
        let torn = fault == Some(DiskFault::TornWrite);
        if self.full || torn {
            self.struck
                .push(if torn { "torn write" } else { "disk full" });
            self.written.extend_from_slice(&bytes[..bytes.len() / 2]);
            return Err(ErrorKind::StorageFull.into());
        }
        self.written.extend_from_slice(bytes);
        let text = String::from_utf8_lossy(bytes);
        let mut end = self.written.len() - bytes.len();
        for line in text.split_inclusive('\n') {
            end += line.len();
            if is(line, "INTENT") {
                self.early += u64::from(self.sample > self.promised);
                self.intents += 1;
                self.intent = Some((end, targets(line)));
            } else if is(line, "SAMPLE") {
                self.sample = end;
            }
        }
        Ok(())
    }

    fn flush(&mut self, call: u32) -> io::Result<()> {
        match self.due(call, false) {
            Some(DiskFault::LostFlushes(count)) => self.lost_flushes = count,
            Some(_) => {
                self.struck.push("failed flush");
                return Err(io::Error::other("Input/output error"));
            }
            None => {}
        }
        self.promised = self.written.len();
        if self.lost_flushes > 0 {
            self.lost_flushes -= 1;
            self.struck.push("lost flush");
        } else {
            self.durable = self.written.len();
        }
        Ok(())
    }
}

impl Storage for Disk {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.call(|state, call| state.append(bytes, call))
    }

    fn sync(&mut self) -> io::Result<()> {
        self.call(State::flush)
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        let mut state = self.lock();
        let length = usize::try_from(length).expect("it fits into memory");
        state.written.truncate(length);
        state.durable = state.durable.min(length);
        state.promised = state.promised.min(length);
        Ok(())
    }

    fn release_reserve(&mut self) {
        let mut state = self.lock();
        if std::mem::take(&mut state.has_reserve) {
            state.full = false;
        }
    }
}

/// Whether a line of a run log is an entry of this kind.
fn is(line: &str, kind: &str) -> bool {
    line.split(' ').nth(1) == Some(kind)
}

/// The targets of an INTENT \[m\].
fn targets(line: &str) -> Vec<f64> {
    let to = line
        .split_once("\"to\":[")
        .and_then(|(_, rest)| rest.split_once(']'));
    to.map_or_else(Vec::new, |(list, _)| {
        list.split(',')
            .filter_map(|number| number.parse().ok())
            .collect()
    })
}
