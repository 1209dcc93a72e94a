//! The common state of the recorded rig and the recorded observer: the entries still to be replayed, the run log that is
//! written, the time of the last entry. In: bodies to append, kinds to expect. Out: logged bodies.

use std::collections::VecDeque;

use serde::Serialize;

use super::Wall;
use super::entry::{
    Call, DigestBody, EndBody, EndOutcome, FaultBody, HeldBody, IntentBody, LogForm, OperatorBody,
    RigBody, SampleBody, TargetStatus,
};
use super::in_force::{InForce, Rigs};
use super::logged_run::{LoggedRun, Mismatch, body};
use super::plain_body::Body;
use super::steps_digest::{DIGEST_STEPS, StepsDigest};
use crate::run::Request;
use psd_plan::record::Event;
use psd_rig::journal::{EntryKind, Journal, JournalFault, Line, Refusal, is_written_as};
use psd_rig::{LineStatistics, Reading, Rig, RigFault};

/// The rig and the run log with which a run is continued after its replay.
pub struct Continuation<'rig> {
    pub rig: &'rig mut dyn Rig,
    /// With RESUME as its last entry.
    pub journal: Journal,
    /// The run log with this resumption.
    pub logged: LoggedRun,
}

/// Opens the continuation. None: the run cannot be continued.
pub(super) type Begin<'rig> = Box<dyn FnOnce() -> Option<Continuation<'rig>> + 'rig>;

/// An entry that counts or not, by the state of the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Undecided {
    /// A motion with readings, most of which are missing.
    Stroke(u64),
    /// A target without a reading after it. It is compared with the plan before the rig is opened.
    Target(u64),
}

pub(super) struct State<'rig> {
    lines: VecDeque<Line>,
    /// The continuation, until it is opened.
    begin: Option<Begin<'rig>>,
    /// The entry before which it is opened, if the rig decides whether that and the following entries count.
    undecided: Option<Undecided>,
    /// The rig, until it is used.
    opened: Option<&'rig mut dyn Rig>,
    /// A client drove the rig: the client's requests are logged between a proposal and its target.
    pub(super) driven: bool,
    pub(super) rigs: Rigs,
    journal: Option<Journal>,
    /// The targets, readings and steps since the last entry, in the compact form of the run log.
    digest: Option<StepsDigest>,
    /// The run is simulated again, and each entry is compared with the next of `lines`: the replay of a compact run log.
    repeats: bool,
    /// The next entry to compare, if it is a digest.
    due: Option<DigestBody>,
    /// The status of the target at the end of the replay, from the resumption.
    target_status: Option<TargetStatus>,
    /// Rig time of the last entry \[s\].
    pub(super) time: f64,
    /// Targets recorded so far.
    targets: u64,
    /// The run log has an END: the last call of the run, without an entry after it, was done.
    ended: bool,
    interruptions: Vec<Event>,
    /// Communication errors recovered before the present rig was opened, and all of those logged so far.
    recovered_before: LineStatistics,
    recovered: LineStatistics,
    mismatch: Option<Mismatch>,
    fault: Option<JournalFault>,
    /// The reading of the last fault, which exceeded a limit during a motion.
    pub(super) broken: Option<Reading>,
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

    /// As `recording`, with the digests of steps.
    pub(super) fn digesting(journal: Journal) -> Self {
        Self {
            journal: Some(journal),
            digest: Some(StepsDigest::default()),
            ..Self::empty()
        }
    }

    pub(super) fn replaying(logged: LoggedRun) -> Self {
        let time = logged.rigs.first().map_or(0.0, |rig| rig.t);
        let repeats = logged.header.log == LogForm::Compact;
        Self {
            digest: repeats.then(StepsDigest::default),
            repeats,
            driven: logged.header.served.is_some(),
            lines: logged.lines,
            time,
            rigs: logged.rigs,
            ended: logged.ended,
            interruptions: logged.interruptions,
            recovered_before: logged.line_statistics,
            recovered: logged.line_statistics,
            ..Self::empty()
        }
    }

    pub(super) fn resuming(
        logged: LoggedRun,
        begin: Begin<'rig>,
        undecided: Option<Undecided>,
        wall: Wall,
    ) -> Self {
        Self {
            begin: Some(begin),
            undecided,
            wall,
            ..Self::replaying(logged)
        }
    }

    fn empty() -> Self {
        Self {
            lines: VecDeque::new(),
            begin: None,
            undecided: None,
            opened: None,
            driven: false,
            rigs: Rigs::default(),
            journal: None,
            digest: None,
            repeats: false,
            due: None,
            target_status: None,
            time: 0.0,
            targets: 0,
            ended: false,
            interruptions: Vec::new(),
            recovered_before: LineStatistics::default(),
            recovered: LineStatistics::default(),
            mismatch: None,
            fault: None,
            broken: None,
            wall: Box::new(|| None),
        }
    }

    /// Whether answers still come from the run log. After the last of them the continuation is opened: not earlier, because
    /// a rig is not kept waiting for a replay.
    pub(super) fn answers_from_the_log(&mut self) -> bool {
        let stroke = |line: &Line| self.undecided == Some(Undecided::Stroke(line.seq));
        if self.begin.is_some() && self.lines.front().is_none_or(stroke) {
            self.open();
        }
        !self.lines.is_empty() || self.mismatch.is_some()
    }

    /// Whether the answers of the rig come from there too: they do not while the run is simulated again.
    pub(super) fn rig_answers_from_the_log(&mut self) -> bool {
        self.answers_from_the_log() && (!self.repeats || self.mismatch.is_some())
    }

    /// Opens the continuation, unless plan and run log differ.
    pub(super) fn open(&mut self) {
        if self.mismatch.is_none()
            && let Some(begin) = self.begin.take()
            && let Some(Continuation {
                rig,
                journal,
                logged,
            }) = begin()
        {
            let last = logged.lines.back().map(|line| line.seq);
            self.lines.retain(|line| Some(line.seq) <= last);
            self.target_status = logged.resumption.map(|resume| resume.target_status);
            (self.interruptions, self.rigs) = (logged.interruptions, logged.rigs);
            (self.journal, self.opened) = (Some(journal), Some(rig));
        }
    }

    /// The run holds. If its run log is being replayed without a continuation, it ends there, and would end again.
    pub(super) fn note_hold(&mut self) {
        if self.lines.is_empty() {
            self.begin = None;
        }
    }

    /// The rig of the continuation, once.
    pub(super) const fn take_opened(&mut self) -> Option<&'rig mut dyn Rig> {
        self.opened.take()
    }

    /// The rig that applies to the next entry.
    pub(super) fn rig_in_force(&self) -> Option<&InForce> {
        self.rigs.at(self.lines.front().map(|line| line.seq))
    }

    /// Whether the rig decides whether the next entry, a target, counts.
    pub(super) fn target_is_undecided(&self) -> bool {
        let undecided = |line: &Line| self.undecided == Some(Undecided::Target(line.seq));
        self.begin.is_some() && self.lines.front().is_some_and(undecided)
    }

    /// Whether the replay has reached the END of the run.
    pub(super) fn is_at_the_logged_end(&self) -> bool {
        self.ended && self.lines.is_empty() && self.mismatch.is_none()
    }

    /// Whether there is a run log to write to, so that a rig may move after the replay.
    pub(super) const fn can_continue(&self) -> bool {
        self.journal.is_some()
    }

    pub(super) fn take_target_status(&mut self) -> Option<TargetStatus> {
        self.target_status.take()
    }

    /// The last target of the run log was executed. A stroke after it may still have to be repeated.
    pub(super) fn target_is_done(&mut self) {
        self.target_status = self
            .target_status
            .take()
            .filter(|status| *status != TargetStatus::Executed);
    }

    pub(super) fn wall(&self) -> Option<String> {
        (self.wall)()
    }

    pub(super) const fn next_target(&mut self) -> u64 {
        self.targets += 1;
        self.targets
    }

    /// Kind of the next entry to be replayed.
    pub(super) fn next_kind(&self) -> Option<EntryKind> {
        self.lines.front().map(|line| line.kind)
    }

    /// The next entry, not consumed.
    pub(super) fn peek<T: Body>(&mut self, kind: EntryKind, called: &str) -> Result<T, RigFault> {
        if let (None, Some(fault)) = (&self.mismatch, self.final_entry()) {
            return Err(fault);
        }
        let found = match (&self.mismatch, self.lines.front()) {
            (None, Some(line)) if line.kind == kind => body(line),
            (Some(mismatch), _) => return Err(RigFault::Device(mismatch.to_string())),
            (None, _) => return Err(self.report_mismatch(called.to_owned())),
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

    /// The next entry has been replayed.
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

    /// The reason why the replay has stopped.
    pub(super) fn mismatch_fault(&self) -> Option<RigFault> {
        self.mismatch
            .as_ref()
            .map(|mismatch| RigFault::Device(mismatch.to_string()))
    }

    /// The fault of this call, if the next entry states it.
    pub(super) fn logged_fault(&mut self, call: Call) -> Option<RigFault> {
        if self.mismatch.is_some() || self.next_kind() != Some(EntryKind::Fault) {
            return None;
        }
        match self.peek::<FaultBody>(EntryKind::Fault, "a fault") {
            Ok(fault) if fault.call == call => {
                self.consume();
                self.broken = fault.reading.map(SampleBody::into_reading);
                Some(fault.fault)
            }
            Ok(_) => None,
            // Also the final entry of a run log that failed.
            Err(fault) => Some(fault),
        }
    }

    /// The result of the final hold, which a run log that failed states after its failure. None: the log was cut off before it.
    pub(super) fn logged_final_hold(&mut self) -> Option<HeldBody> {
        let at = usize::from(self.final_entry().is_some());
        let is_held = |line: &&Line| self.mismatch.is_none() && line.kind == EntryKind::Held;
        let held: HeldBody = body(self.lines.get(at).filter(is_held)?).ok()?;
        self.lines.remove(at);
        self.time = held.t;
        Some(held)
    }

    /// The final entry of a run log that failed. It ends the run whatever the next call is, and is not consumed.
    pub(super) fn final_entry(&self) -> Option<RigFault> {
        let line = self
            .lines
            .front()
            .filter(|line| line.kind == EntryKind::Fault)?;
        body::<FaultBody>(line)
            .ok()
            .filter(|fault| fault.call == Call::Record)
            .map(|fault| fault.fault)
    }

    /// The target of the client's last proposal: the first before its next proposal. None: there was none.
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

    /// The client's next request, not consumed.
    pub(super) fn next_request(&mut self) -> Option<Request> {
        match self.peek(EntryKind::Operator, "a request of the client") {
            Ok(OperatorBody::Asked { request }) => Some(request),
            Ok(_) => {
                self.report_mismatch("a request of the client".to_owned());
                None
            }
            Err(_) => None,
        }
    }

    /// Whether the next entry states that a pause failed.
    pub(super) fn front_is_pause_fault(&self) -> bool {
        let front = self
            .lines
            .front()
            .filter(|line| self.mismatch.is_none() && line.kind == EntryKind::Fault);
        front.is_some_and(|line| {
            line.body().get("call").and_then(|call| call.as_str()) == Some("pause")
        })
    }

    /// The same, for a pause in this procedure and not at the inspection after it.
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

    /// The run and the run log differ from here on.
    pub(super) fn differs(&mut self, mismatch: Mismatch) -> RigFault {
        let fault = RigFault::Device(mismatch.to_string());
        self.mismatch.get_or_insert(mismatch);
        fault
    }

    /// The run makes a call that is not the next entry.
    pub(super) fn report_mismatch(&mut self, called: String) -> RigFault {
        let front = self.lines.front();
        let (seq, found) = front.map_or((0, "its end".to_owned()), |line| {
            (line.seq, format!("{} {}", line.kind.word(), line.body()))
        });
        self.differs(Mismatch { seq, called, found })
    }

    /// Communication errors recovered so far, in all parts of the run.
    pub(super) const fn recovered(&self) -> LineStatistics {
        self.recovered
    }

    /// Logs the communication errors recovered so far, if the present rig counts more than the run log. They are logged immediately: a
    /// run that is killed logs nothing at its end.
    pub(super) fn count(&mut self, now: LineStatistics) -> Result<(), RigFault> {
        let recovered = self.recovered_before.plus(now);
        if recovered == self.recovered {
            return Ok(());
        }
        self.recovered = recovered;
        self.append(EntryKind::LineStatistics, &recovered)
    }

    /// Appends an entry; a fault is kept and is final.
    pub(super) fn append(
        &mut self,
        kind: EntryKind,
        body: &impl Serialize,
    ) -> Result<(), RigFault> {
        self.healthy()?;
        if self.repeats {
            return self.compare(kind, body);
        }
        self.append_digest()?;
        self.append_to_journal(kind, body)
    }

    fn append_to_journal(
        &mut self,
        kind: EntryKind,
        body: &impl Serialize,
    ) -> Result<(), RigFault> {
        let Some(journal) = &mut self.journal else {
            return Err(ended());
        };
        match journal.append(kind, body) {
            Ok(()) => Ok(()),
            Err(fault) => Err(self.broken(fault)),
        }
    }

    /// Whether targets, readings and steps are digested.
    pub(super) const fn digests(&self) -> bool {
        self.digest.is_some()
    }

    /// Digests a target, a reading, the end of a stroke or a step.
    pub(super) fn add_to_digest(
        &mut self,
        called: &str,
        add: impl FnOnce(&mut StepsDigest) -> Result<(), Refusal>,
    ) -> Result<(), RigFault> {
        self.healthy()?;
        if self.repeats && self.due.is_none() {
            self.due = Some(self.peek(EntryKind::Digest, called)?);
        }
        let Some(digest) = &mut self.digest else {
            return Err(ended());
        };
        let added = add(digest);
        digest.time = self.time;
        let (entries, is_full) = (digest.entries, digest.steps == DIGEST_STEPS);
        match (added, &self.due) {
            (Err(refusal), None) => Err(self.broken(refusal.into())),
            // A run log with this would state the refusal here.
            (Err(refusal), Some(_)) => {
                Err(self.report_mismatch(format!("{called} that the run log rejects ({refusal})")))
            }
            (Ok(()), Some(due)) if due.entries == entries || is_full => self.compare_digest(),
            (Ok(()), None) if is_full => self.append_digest(),
            (Ok(()), _) => Ok(()),
        }
    }

    /// Appends the digest, if there is anything in it.
    fn append_digest(&mut self) -> Result<(), RigFault> {
        match self.digest.as_mut().and_then(StepsDigest::take) {
            Some(body) => self.append_to_journal(EntryKind::Digest, &body),
            None => Ok(()),
        }
    }

    /// The digest of the repeated run is that of the run log, or the two differ from here on.
    fn compare_digest(&mut self) -> Result<(), RigFault> {
        let own = self.digest.as_mut().and_then(StepsDigest::take);
        let due = self.due.take();
        if own == due {
            self.consume();
            return Ok(());
        }
        let described = |body: Option<DigestBody>| {
            body.map_or_else(String::new, |body| {
                format!(
                    "{} steps to {} s with the digest {}",
                    body.steps, body.t, body.sha256
                )
            })
        };
        let seq = self.lines.front().map_or(0, |line| line.seq);
        Err(self.differs(Mismatch {
            seq,
            called: described(own),
            found: described(due),
        }))
    }

    /// The next entry of the run log is this one, or the two differ from here on.
    fn compare(&mut self, kind: EntryKind, body: &impl Serialize) -> Result<(), RigFault> {
        let front = self.lines.front();
        if front.is_some_and(|line| line.kind == kind && is_written_as(line, body)) {
            self.consume();
            return Ok(());
        }
        let body = serde_json::to_string(body).unwrap_or_default();
        Err(self.report_mismatch(format!("{} {body}", kind.word())))
    }

    /// The simulated rig is that of the run log, or the two differ from the start.
    pub(super) fn compare_rigs(&mut self, known: &RigBody, live: &RigBody) {
        if self.repeats && known != live {
            let described = |rig: &RigBody| serde_json::to_string(rig).unwrap_or_default();
            self.differs(Mismatch {
                seq: 0,
                called: described(live),
                found: described(known),
            });
        }
    }

    /// The run that is simulated again has ended, and so has its run log; else the two differ.
    pub(super) fn end_of_repetition(&mut self) {
        if self.repeats
            && self.mismatch.is_none()
            && !self.lines.is_empty()
            && self.final_entry().is_none()
        {
            self.report_mismatch("its end".to_owned());
        }
    }

    /// The entries appended so far survive a loss of power from here on.
    pub(super) fn sync_point(&mut self) -> Result<(), RigFault> {
        if self.repeats {
            return Ok(());
        }
        self.healthy()?;
        let Some(journal) = &mut self.journal else {
            return Err(ended());
        };
        match journal.sync_point() {
            Ok(()) => Ok(()),
            Err(fault) => Err(self.broken(fault)),
        }
    }

    /// A run log that fails ends the run: no motion without an entry. A run that is simulated again ends where its run log failed or was
    /// interrupted.
    pub(super) fn healthy(&self) -> Result<(), RigFault> {
        if self.repeats {
            let failed = self.mismatch_fault().or_else(|| self.final_entry());
            let interrupted = || (self.lines.is_empty() && !self.ended).then(ended);
            return failed.or_else(interrupted).map_or(Ok(()), Err);
        }
        self.fault
            .as_ref()
            .map_or(Ok(()), |fault| Err(unkept(fault)))
    }

    fn broken(&mut self, fault: JournalFault) -> RigFault {
        let message = unkept(&fault);
        let words = FaultBody {
            t: self.time,
            call: Call::Record,
            fault: message.clone(),
            reading: None,
            wall: (self.wall)(),
        };
        self.append_finally(EntryKind::Fault, &words);
        self.fault = Some(fault);
        message
    }

    /// Appends an entry to a run log that has failed. It is attempted once.
    pub(super) fn append_finally(&mut self, kind: EntryKind, body: &impl Serialize) {
        let digest = self.digest.as_mut().and_then(StepsDigest::take);
        if let Some(journal) = &mut self.journal {
            if let Some(digest) = digest {
                let _ = journal.final_entry(EntryKind::Digest, &digest);
            }
            let _ = journal.final_entry(kind, body);
        }
    }

    /// The steps after the last entry.
    fn append_last_digest(&mut self) {
        if self.fault.is_none() && !self.repeats {
            // The fault is kept.
            let _ = self.append_digest();
        }
    }

    /// The run was completed.
    pub(super) fn end(&mut self) {
        self.append_last_digest();
        if self.fault.is_none()
            && let Some(journal) = &mut self.journal
        {
            let ended = journal.end(&EndBody {
                outcome: EndOutcome::Completed,
            });
            self.fault = ended.err();
        }
    }

    /// The run ended early; its run log can be continued.
    pub(super) fn close(&mut self) {
        self.append_last_digest();
        if self.fault.is_none()
            && let Some(journal) = &mut self.journal
        {
            self.fault = journal.sync().err();
        }
    }

    pub(super) fn sealed(&self) -> Option<(u64, String)> {
        self.journal
            .as_ref()
            .map(|journal| (journal.count(), journal.head().to_owned()))
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

/// Reported at the end of the replay of a run log without an END.
pub const CUT_OFF: &str = "the run log ends here: the run was interrupted";

/// The fault at the end of the replay of a run log without an END.
pub(super) fn ended() -> RigFault {
    RigFault::Device(CUT_OFF.to_owned())
}

fn unkept(fault: &JournalFault) -> RigFault {
    RigFault::Device(format!("the run log cannot be written: {fault}"))
}
