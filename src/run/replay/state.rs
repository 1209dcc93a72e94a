//! What the taped rig and the taped observer share: the records still to be played, the journal that is written, the
//! time of the last record. In: bodies to append, kinds to expect. Out: bodies played.

use std::cell::RefCell;
use std::collections::VecDeque;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Wall;
use super::entry::{
    Call, Doubt, EndBody, EndOutcome, FaultBody, HeldBody, IntentBody, OperatorBody, RigBody,
};
use super::replayed::{Mismatch, Played, body};
use crate::record::Event;
use crate::record::journal::{EntryKind, Journal, JournalFault, Line};
use crate::rig::{Rig, RigFault, Tally};
use crate::run::Request;
use crate::run::remote_control::Specimen;

/// What a run goes on with where its record ends.
pub struct GoesOn<'rig> {
    pub rig: &'rig mut dyn Rig,
    /// With RESUME as its last record.
    pub journal: Journal,
    /// The record with this resumption.
    pub played: Played,
}

/// Opens it; None: it cannot be gone on with.
pub(super) type Begin<'rig> = Box<dyn FnOnce() -> Option<GoesOn<'rig>> + 'rig>;

pub(super) struct State<'rig> {
    lines: VecDeque<Line>,
    /// What the run goes on with, until that is opened.
    begin: Option<Begin<'rig>>,
    /// The record before which it is opened, where the rig decides whether that and what follows it count.
    undecided: Option<u64>,
    /// The rig, until somebody takes it.
    opened: Option<&'rig mut dyn Rig>,
    /// A client drove the rig: between a proposal and its target stand the client's requests.
    pub(super) driven: bool,
    pub(super) rig: Option<RigBody>,
    journal: Option<Journal>,
    /// What the resumption found of the target at the end of what is played.
    doubt: Option<Doubt>,
    /// Rig time of the last record, s.
    pub(super) time: f64,
    /// Targets recorded so far.
    targets: u64,
    /// The record says that the run came to its end: what it called for last, and nothing followed, was done.
    ended: bool,
    interruptions: Vec<Event>,
    /// What was mended before the rig that is driven now was opened, and what the record says of it all so far.
    mended_before: Tally,
    mended: Tally,
    mismatch: Option<Mismatch>,
    fault: Option<JournalFault>,
    wall: Wall,
}

impl<'rig> State<'rig> {
    pub(super) fn recording(journal: Journal, wall: Wall) -> Self {
        Self {
            journal: Some(journal),
            wall,
            ..Self::empty()
        }
    }

    pub(super) fn replaying(played: Played) -> Self {
        let time = played.rig.as_ref().map_or(0.0, |rig| rig.t);
        Self {
            driven: played.header.served.is_some(),
            lines: played.lines,
            time,
            rig: played.rig,
            ended: played.ended,
            interruptions: played.interruptions,
            mended_before: played.tally,
            mended: played.tally,
            ..Self::empty()
        }
    }

    pub(super) fn resuming(
        played: Played,
        begin: Begin<'rig>,
        undecided: Option<u64>,
        wall: Wall,
    ) -> Self {
        Self {
            begin: Some(begin),
            undecided,
            wall,
            ..Self::replaying(played)
        }
    }

    fn empty() -> Self {
        Self {
            lines: VecDeque::new(),
            begin: None,
            undecided: None,
            opened: None,
            driven: false,
            rig: None,
            journal: None,
            doubt: None,
            time: 0.0,
            targets: 0,
            ended: false,
            interruptions: Vec::new(),
            mended_before: Tally::default(),
            mended: Tally::default(),
            mismatch: None,
            fault: None,
            wall: Box::new(|| None),
        }
    }

    /// Whether answers still come from the record. Where they do no more, what the run goes on with is opened: not before the last of
    /// them, for a rig is not kept waiting for a record.
    pub(super) fn playing(&mut self) -> bool {
        let decides = self
            .lines
            .front()
            .is_none_or(|line| Some(line.seq) == self.undecided);
        if decides
            && self.mismatch.is_none()
            && let Some(begin) = self.begin.take()
            && let Some(GoesOn {
                rig,
                journal,
                played,
            }) = begin()
        {
            let last = played.lines.back().map(|line| line.seq);
            self.lines.retain(|line| Some(line.seq) <= last);
            (self.doubt, self.interruptions) = (played.doubt, played.interruptions);
            (self.journal, self.opened) = (Some(journal), Some(rig));
        }
        !self.lines.is_empty() || self.mismatch.is_some()
    }

    /// The run holds. Where its record is played and nothing is open to go on with, it ends there by itself, and would again.
    pub(super) fn holds(&mut self) {
        if self.lines.is_empty() {
            self.begin = None;
        }
    }

    /// The rig that the run goes on with, once.
    pub(super) const fn take_opened(&mut self) -> Option<&'rig mut dyn Rig> {
        self.opened.take()
    }

    /// Whether the record is played to the end that the run came to.
    pub(super) fn played_out(&self) -> bool {
        self.ended && self.lines.is_empty() && self.mismatch.is_none()
    }

    /// Whether there is a journal to write to, so that a rig may move once the record is played.
    pub(super) const fn goes_on(&self) -> bool {
        self.journal.is_some()
    }

    pub(super) fn take_doubt(&mut self) -> Option<Doubt> {
        self.doubt.take()
    }

    pub(super) fn wall(&self) -> Option<String> {
        (self.wall)()
    }

    pub(super) const fn next_target(&mut self) -> u64 {
        self.targets += 1;
        self.targets
    }

    /// Kind of the next record to be played.
    pub(super) fn next_kind(&self) -> Option<EntryKind> {
        self.lines.front().map(|line| line.kind)
    }

    /// The next record, left where it is.
    pub(super) fn peek<T: DeserializeOwned>(
        &mut self,
        kind: EntryKind,
        called: &str,
    ) -> Result<T, RigFault> {
        if let (None, Some(fault)) = (&self.mismatch, self.last_words()) {
            return Err(fault);
        }
        let found = match (&self.mismatch, self.lines.front()) {
            (None, Some(line)) if line.kind == kind => body(line),
            (Some(mismatch), _) => return Err(RigFault::Device(mismatch.to_string())),
            (None, front) => {
                let found = front.map_or("its end".to_owned(), |line| {
                    format!("{:?} {}", line.kind, line.body())
                });
                let seq = front.map_or(0, |line| line.seq);
                return Err(self.differs(Mismatch {
                    seq,
                    called: called.to_owned(),
                    found,
                }));
            }
        };
        let seq = self.lines.front().map_or(0, |line| line.seq);
        found.map_err(|error| {
            self.differs(Mismatch {
                seq,
                called: called.to_owned(),
                found: error.to_string(),
            })
        })
    }

    /// The next record has been played.
    pub(super) fn consume(&mut self) {
        if let Some(line) = self.lines.pop_front() {
            if let Some(time) = line.time() {
                self.time = time;
            }
            if line.kind == EntryKind::Intent {
                self.targets += 1;
            }
        }
    }

    /// Why nothing more of the record is played.
    pub(super) fn parted(&self) -> Option<RigFault> {
        self.mismatch
            .as_ref()
            .map(|mismatch| RigFault::Device(mismatch.to_string()))
    }

    /// The next record says that this call failed.
    pub(super) fn played_fault(&mut self, call: Call) -> Option<RigFault> {
        if self.mismatch.is_some() || self.next_kind() != Some(EntryKind::Fault) {
            return None;
        }
        match self.peek::<FaultBody>(EntryKind::Fault, "a fault") {
            Ok(fault) if fault.call == call => {
                self.consume();
                Some(fault.fault)
            }
            Ok(_) => None,
            // Also the last words of a record that could not be kept.
            Err(fault) => Some(fault),
        }
    }

    /// What became of the rig when it was held for good; None where the record, of an older version, does not say.
    pub(super) fn played_hold(&mut self) -> Option<HeldBody> {
        if self.mismatch.is_some() || self.next_kind() != Some(EntryKind::Held) {
            return None;
        }
        let held = self.peek(EntryKind::Held, "where the rig was held").ok()?;
        self.consume();
        Some(held)
    }

    /// What a record that could not be kept says last. It ends the run whatever is called for, and stays.
    fn last_words(&self) -> Option<RigFault> {
        let line = self
            .lines
            .front()
            .filter(|line| line.kind == EntryKind::Fault)?;
        body::<FaultBody>(line)
            .ok()
            .filter(|fault| fault.call == Call::Record)
            .map(|fault| fault.fault)
    }

    /// The target that came of what the client has just proposed: the first before its next proposal. None: nothing did.
    pub(super) fn intent_ahead(&self) -> Option<IntentBody> {
        let proposes = |line: &&Line| {
            let asked = body::<OperatorBody>(line);
            line.kind == EntryKind::Operator
                && matches!(asked, Ok(OperatorBody::Asked { request }) if request.proposed().is_some())
        };
        let until_next = self.lines.iter().take_while(|line| !proposes(line));
        until_next
            .filter(|line| line.kind == EntryKind::Intent)
            .find_map(|line| body(line).ok())
    }

    /// The client's next request, left where it is.
    fn next_request(&mut self) -> Option<Request> {
        match self.peek(EntryKind::Operator, "a request of the client") {
            Ok(OperatorBody::Asked { request }) => Some(request),
            Ok(_) => {
                self.disagrees("a request of the client".to_owned());
                None
            }
            Err(_) => None,
        }
    }

    /// Whether the next record says that a pause failed.
    pub(super) fn front_is_pause_fault(&self) -> bool {
        let front = self
            .lines
            .front()
            .filter(|line| self.mismatch.is_none() && line.kind == EntryKind::Fault);
        front.is_some_and(|line| {
            line.body().get("call").and_then(|call| call.as_str()) == Some("pause")
        })
    }

    /// The same, of a pause in this procedure and not at the look that comes after it.
    pub(super) fn front_is_pause_fault_in(&self, procedure: Option<&str>) -> bool {
        let ended = || {
            self.lines
                .iter()
                .find(|line| line.kind == EntryKind::Event)
                .and_then(|line| body::<Event>(line).ok())
        };
        self.front_is_pause_fault()
            && ended().is_none_or(|event| event.procedure.as_deref() == procedure)
    }

    /// The run and the record part ways here.
    pub(super) fn differs(&mut self, mismatch: Mismatch) -> RigFault {
        let fault = RigFault::Device(mismatch.to_string());
        self.mismatch.get_or_insert(mismatch);
        fault
    }

    /// The run calls for something that the next record does not say.
    pub(super) fn disagrees(&mut self, called: String) -> RigFault {
        let front = self.lines.front();
        let (seq, found) = front.map_or((0, "its end".to_owned()), |line| {
            (line.seq, format!("{:?} {}", line.kind, line.body()))
        });
        self.differs(Mismatch { seq, called, found })
    }

    /// What was mended on the lines of the rig so far, in all parts of the run.
    pub(super) const fn mended(&self) -> Tally {
        self.mended
    }

    /// Records what was mended so far, where the rig that is driven now counts more than the record says. It is said as
    /// it happens: a run that is killed says nothing at its end.
    pub(super) fn count(&mut self, now: Tally) -> Result<(), RigFault> {
        let mended = self.mended_before.plus(now);
        if mended == self.mended {
            return Ok(());
        }
        self.mended = mended;
        self.append(EntryKind::Tally, &mended)
    }

    /// Appends a record; a fault is kept, and is final.
    pub(super) fn append(
        &mut self,
        kind: EntryKind,
        body: &impl Serialize,
    ) -> Result<(), RigFault> {
        self.healthy()?;
        let Some(journal) = &mut self.journal else {
            return Err(ended());
        };
        match journal.append(kind, body) {
            Ok(()) => Ok(()),
            Err(fault) => Err(self.broken(fault)),
        }
    }

    /// What was appended survives a loss of power from here on.
    pub(super) fn promise(&mut self) -> Result<(), RigFault> {
        self.healthy()?;
        let Some(journal) = &mut self.journal else {
            return Err(ended());
        };
        match journal.promise() {
            Ok(()) => Ok(()),
            Err(fault) => Err(self.broken(fault)),
        }
    }

    /// A record that cannot be kept ends the run: nothing moves that is not recorded.
    pub(super) fn healthy(&self) -> Result<(), RigFault> {
        self.fault
            .as_ref()
            .map_or(Ok(()), |fault| Err(unkept(fault)))
    }

    fn broken(&mut self, fault: JournalFault) -> RigFault {
        let told = unkept(&fault);
        if let Some(journal) = &mut self.journal {
            let words = FaultBody {
                t: self.time,
                call: Call::Record,
                fault: told.clone(),
                wall: (self.wall)(),
            };
            // The disk is sick already: what can be said is said, and no more is asked of it.
            let _ = journal.last_words(EntryKind::Fault, &words);
        }
        self.fault = Some(fault);
        told
    }

    /// The run came to its own end.
    pub(super) fn end(&mut self) {
        if self.fault.is_none()
            && let Some(journal) = &mut self.journal
        {
            let ended = journal.end(&EndBody {
                outcome: EndOutcome::Completed,
            });
            self.fault = ended.err();
        }
    }

    /// The run ended early; its record can be gone on with.
    pub(super) fn close(&mut self) {
        if self.fault.is_none()
            && let Some(journal) = &mut self.journal
        {
            self.fault = journal.sync().err();
        }
    }

    pub(super) fn sealed(&self) -> Option<(u64, String)> {
        self.journal
            .as_ref()
            .map(|journal| (journal.len(), journal.head().to_owned()))
    }

    pub(super) const fn mismatch(&self) -> Option<&Mismatch> {
        self.mismatch.as_ref()
    }

    pub(super) const fn take_mismatch(&mut self) -> Option<Mismatch> {
        self.mismatch.take()
    }

    pub(super) const fn take_fault(&mut self) -> Option<JournalFault> {
        self.fault.take()
    }

    pub(super) fn take_interruptions(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.interruptions)
    }
}

/// Said where a record without an end has been played.
pub const CUT_OFF: &str = "the record ends here: the run was cut off";

/// Lets the requests of the record drive the specimen once more.
pub(super) fn ask_again(state: &RefCell<State<'_>>, specimen: &mut Specimen<'_, '_>) {
    loop {
        let (over, stayed) = {
            let state = state.borrow();
            (
                state.lines.is_empty() || state.mismatch.is_some(),
                state.front_is_pause_fault(),
            )
        };
        if over {
            return;
        }
        if stayed {
            specimen.stay_again();
            continue;
        }
        let Some(request) = state.borrow_mut().next_request() else {
            return;
        };
        let last = request == Request::Close;
        specimen.carry_out(request);
        // What stands behind it the session says by itself: what was mended on the line.
        if last {
            return;
        }
    }
}

/// Of a record without an end, when it has been played.
pub(super) fn ended() -> RigFault {
    RigFault::Device(CUT_OFF.to_owned())
}

fn unkept(fault: &JournalFault) -> RigFault {
    RigFault::Device(format!("the record cannot be kept: {fault}"))
}
