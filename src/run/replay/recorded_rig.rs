//! The recorded rig: between guard and rig, it answers from the run log while it has entries. After the last entry it forwards calls and
//! logs the answers. INTENT is durable before a target is sent, SAMPLE before a reading is used.

use std::cell::RefCell;
use std::rc::Rc;

use super::entry::{Call, FaultBody, HeldBody, IntentBody, RigBody, SampleBody, StrokeBody};
use super::entry_of::{
    append_sample, in_log_time, intent, same_bits, target_text, to_log_time, unknown_rig,
};
use super::state::{State, ended};
use super::steps_digest::DigestedTarget;
use psd_physics::tracking::trajectory::Path;
use psd_plan::{Interval, Limits};
use psd_rig::journal::EntryKind;
use psd_rig::safety::failpoint;
use psd_rig::safety::failpoint::Guarding;
use psd_rig::{
    DeclaredNoise, EachReading, EncodedMove, FinalHold, Identity, LastMove, LineStatistics,
    OWN_SPEED, Reading, Rig, RigFault, UnfinishedStep, WholeSteps,
};

/// A move with readings during the motion, as requested.
pub(super) enum ContinuousMove<'a> {
    /// \[m\], \[m/s\]
    Stroke(&'a [f64], f64),
    Paths(&'a [Path]),
}

/// A rig whose answers are all logged.
pub struct RecordedRig<'rig> {
    /// None during a replay.
    live: Option<&'rig mut dyn Rig>,
    pub(super) state: Rc<RefCell<State<'rig>>>,
    about: RigBody,
    /// Proposed, and not executed: targets and speed as requested, and as encoded by the rig.
    pending: Option<(Vec<f64>, Option<f64>, EncodedMove)>,
    /// Difference between the rig time of the run log and that of the rig \[s\].
    pub(super) offset: Option<f64>,
    /// Whether the rig is simulated and [`Rig::at_once`], as it then stays.
    does_whole_steps: bool,
}

impl<'rig> RecordedRig<'rig> {
    pub(super) fn new(live: Option<&'rig mut dyn Rig>, state: Rc<RefCell<State<'rig>>>) -> Self {
        let known = state.borrow().rigs.first().cloned();
        if let (Some(known), Some(live)) = (&known, &live) {
            state.borrow_mut().compare_rigs(known, &RigBody::of(*live));
        }
        let about = known.unwrap_or_else(|| {
            let about = live.as_deref().map_or_else(unknown_rig, RigBody::of);
            let mut state = state.borrow_mut();
            state.time = about.t;
            // A run log that fails here reports it at the first call.
            let _ = state
                .append(EntryKind::Rig, &about)
                .and_then(|()| state.sync_point());
            about
        });
        Self {
            live,
            state,
            about,
            pending: None,
            offset: None,
            does_whole_steps: false,
        }
    }

    /// Whether answers still come from the run log.
    pub(super) fn answers_from_the_log(&self) -> bool {
        self.state.borrow_mut().rig_answers_from_the_log()
    }

    /// The rig itself, if there is one.
    pub(super) fn live(&mut self) -> Option<&mut (dyn Rig + 'rig)> {
        if self.live.is_none() {
            self.live = self.state.borrow_mut().take_opened();
        }
        self.live.as_deref_mut()
    }

    /// The rig itself, after the replay.
    pub(super) fn rig(&mut self) -> Result<&mut (dyn Rig + 'rig), RigFault> {
        self.state.borrow().healthy()?;
        self.live().ok_or_else(ended)?;
        let rig = self.live.as_deref_mut().ok_or_else(ended)?;
        if self.offset.is_none() {
            self.offset = Some(self.state.borrow().time - rig.time());
        }
        Ok(rig)
    }

    /// Logs the communication errors recovered since the last entry about them.
    pub(super) fn count(&self) -> Result<(), RigFault> {
        let Some(rig) = self.live.as_deref() else {
            return Ok(());
        };
        self.state.borrow_mut().count(rig.line_statistics())
    }

    /// Rig time of the run log \[s\].
    fn now(&self) -> f64 {
        let state = self.state.borrow();
        match (&self.live, self.offset) {
            (Some(rig), Some(offset)) => offset + rig.time(),
            _ => state.time,
        }
    }

    /// Logs that a call failed, and passes its fault on.
    pub(super) fn failed<T>(&mut self, call: Call, fault: RigFault) -> Result<T, RigFault> {
        let t = self.now();
        let offset = self.offset.unwrap_or(0.0);
        let broken = self.live.as_deref_mut().and_then(Rig::take_broken);
        let broken = broken.and_then(|reading| in_log_time(reading, offset).ok());
        let mut state = self.state.borrow_mut();
        state.time = t;
        let wall = state.wall();
        let reading = broken.as_ref().map(SampleBody::of);
        state.broken = broken;
        // If the run log fails too, the fault of the rig is still the one that ended the run.
        let _ = state
            .append(
                EntryKind::Fault,
                &FaultBody {
                    t,
                    call,
                    fault: fault.clone(),
                    reading,
                    wall,
                },
            )
            .and_then(|()| state.sync_point());
        Err(fault)
    }

    pub(super) fn record_intent(&mut self, intent: &mut IntentBody) -> Result<(), RigFault> {
        let mut state = self.state.borrow_mut();
        if state.digests() {
            return state.add_to_digest("a target", |digest| digest.target(&(&*intent).into()));
        }
        intent.n = state.next_target();
        intent.t = state.time;
        intent.wall = state.wall();
        state.append(EntryKind::Intent, intent)?;
        if failpoint::on(Guarding::IntentDurable) {
            state.sync_point()
        } else {
            Ok(())
        }
    }

    /// The next entry as an INTENT, if it has these targets.
    fn logged_intent(
        &self,
        targets: &[f64],
        speed: Option<f64>,
        stroke: Option<usize>,
    ) -> Result<IntentBody, RigFault> {
        let mut state = self.state.borrow_mut();
        let intent: IntentBody = state.peek(EntryKind::Intent, "a target")?;
        let same = same_bits(&intent.to, targets)
            && intent.speed.map(f64::to_bits) == speed.map(f64::to_bits)
            && intent.samples == stroke;
        if same {
            return Ok(intent);
        }
        Err(state.report_mismatch(format!("a move {}", target_text(targets, speed))))
    }

    fn logged_reading(&self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        let mut state = self.state.borrow_mut();
        if let Some(fault) = state.logged_fault(Call::Read) {
            return Err(fault);
        }
        let sample: SampleBody = state.peek(EntryKind::Sample, "a reading")?;
        state.consume();
        let moved = sample.moved;
        Ok((sample.into_reading(), moved))
    }

    /// A reading, with the time of the last motion of the rig if this was requested.
    fn take_reading(
        &mut self,
        read: impl FnOnce(&mut dyn Rig) -> Result<(Reading, Option<[f64; 2]>), RigFault>,
    ) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        if self.answers_from_the_log() {
            return self.logged_reading();
        }
        let read = read(self.rig()?);
        let offset = self.offset.unwrap_or(0.0);
        let checked = read.and_then(|(reading, moved)| {
            let reading = in_log_time(reading, offset)?;
            Ok((
                reading,
                moved
                    .map(|ends| ends.map(|end| end + offset))
                    .filter(|ends| ends.iter().all(|end| end.is_finite())),
            ))
        });
        let (reading, moved) = checked.or_else(|fault| self.failed(Call::Read, fault))?;
        self.count()?;
        self.log_reading(&reading, moved)?;
        Ok((reading, moved))
    }

    /// A reading is durable before it is used.
    fn log_reading(&self, reading: &Reading, moved: Option<[f64; 2]>) -> Result<(), RigFault> {
        let mut state = self.state.borrow_mut();
        append_sample(&mut state, reading, moved)?;
        if failpoint::on(Guarding::SampleDurable) {
            state.sync_point()?;
        }
        Ok(())
    }

    /// A move that the guard refuses is logged too, so that the run can be replayed up to here.
    fn forget_proposal(&mut self) {
        let Some((targets, speed, encoded)) = self.pending.take() else {
            return;
        };
        if self.answers_from_the_log() {
            if self.logged_intent(&targets, speed, None).is_ok() {
                self.state.borrow_mut().consume();
            }
        } else {
            let _ = self.record_target(&targets, speed, &encoded);
        }
    }

    /// The target of a move that stops there.
    fn record_target(
        &mut self,
        targets: &[f64],
        speed: Option<f64>,
        encoded: &EncodedMove,
    ) -> Result<(), RigFault> {
        let mut state = self.state.borrow_mut();
        if !state.digests() {
            drop(state);
            return self.record_intent(&mut intent(targets, speed, encoded, None));
        }
        let target = DigestedTarget {
            to: targets,
            speed,
            encoded: Some(&*encoded.targets).filter(|encoded| !same_bits(encoded, targets)),
            rate: encoded.speed,
            id: encoded.move_id,
            path: None,
            samples: None,
        };
        state.add_to_digest("a target", |digest| digest.target(&target))
    }

    /// The readings of a stroke, up to its end or to its fault. Gives their number if the run log ends before the stroke.
    pub(super) fn logged_stroke(
        &self,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<Option<usize>, RigFault> {
        let mut readings_done = 0;
        loop {
            if let Some(fault) = self.state.borrow_mut().logged_fault(Call::Traverse) {
                return Err(fault);
            }
            if !self.answers_from_the_log() {
                return Ok(Some(readings_done));
            }
            let mut state = self.state.borrow_mut();
            if state.next_kind() == Some(EntryKind::Stroke) {
                let stroke: StrokeBody = state.peek(EntryKind::Stroke, "the end of a stroke")?;
                if stroke.samples != readings_done {
                    return Err(
                        state.report_mismatch(format!("a stroke of {readings_done} readings"))
                    );
                }
                state.consume();
                return Ok(None);
            }
            drop(state);
            if readings_done == samples {
                return Err(self
                    .state
                    .borrow_mut()
                    .report_mismatch(format!("a stroke of at most {samples} readings")));
            }
            readings_done += 1;
            each(self.logged_reading()?.0)?;
        }
    }
}

/// Of a simulation whose targets and readings are digested.
impl WholeSteps for RecordedRig<'_> {
    fn step(
        &mut self,
        targets: &[f64],
        speed: Option<f64>,
        pause: f64,
        reading: &mut Reading,
    ) -> Result<(), UnfinishedStep> {
        let ended = |is_reached| move |fault| UnfinishedStep { is_reached, fault };
        self.pending = None;
        let target = DigestedTarget {
            to: targets,
            speed,
            encoded: None,
            rate: speed.unwrap_or(OWN_SPEED),
            id: None,
            path: None,
            samples: None,
        };
        self.state
            .borrow_mut()
            .add_to_digest("a target", |digest| digest.target(&target))
            .map_err(ended(false))?;
        if self.offset.is_none() {
            self.rig().map_err(ended(false))?;
        }
        let rig = self.live.as_deref_mut().and_then(Rig::at_once);
        let rig = rig.expect("a recorded rig does whole steps only if its rig does");
        rig.step(targets, speed, pause, reading)?;
        to_log_time(reading, self.offset.unwrap_or(0.0))
            .or_else(|fault| self.failed(Call::Read, fault))
            .and_then(|()| self.log_reading(reading, None))
            .map_err(ended(true))
    }
}

impl Rig for RecordedRig<'_> {
    fn identity(&self) -> Identity {
        self.about.identity.clone()
    }

    fn degrees_of_freedom(&self) -> usize {
        self.about.axes
    }

    fn time(&self) -> f64 {
        self.state.borrow().time
    }

    fn before_motion(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        let undecided = self.state.borrow().target_is_undecided();
        if undecided {
            self.logged_intent(targets, speed, None)?;
            self.state.borrow_mut().open();
        }
        self.answers_from_the_log();
        Ok(())
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        if self.answers_from_the_log() {
            if let Some(fault) = self.state.borrow_mut().logged_fault(Call::Propose) {
                return Err(fault);
            }
            let intent = if self.state.borrow().driven {
                self.state.borrow().intent_ahead()
            } else {
                Some(self.logged_intent(targets, speed, None)?)
            };
            // A proposal that was never sent has no bytes in the run log.
            let unsent = || EncodedMove {
                targets: targets.to_vec(),
                speed: speed.unwrap_or(0.0),
                wire: Vec::new(),
                move_id: None,
                at_the_rig: None,
            };
            let encoded = intent.map_or_else(unsent, |intent| EncodedMove {
                targets: intent.encoded.clone().unwrap_or_else(|| intent.to.clone()),
                speed: intent.rate,
                wire: Vec::new(),
                move_id: intent.id,
                at_the_rig: intent.own.clone(),
            });
            self.pending = Some((targets.to_vec(), speed, encoded.clone()));
            return Ok(encoded);
        }
        match self.rig()?.propose(targets, speed) {
            Ok(encoded) => {
                self.pending = Some((targets.to_vec(), speed, encoded.clone()));
                Ok(encoded)
            }
            Err(fault) => self.failed(Call::Propose, fault),
        }
    }

    fn execute(&mut self) -> Result<(), RigFault> {
        let (targets, speed, encoded) = self
            .pending
            .take()
            .ok_or_else(|| RigFault::Device("nothing was proposed to execute".to_owned()))?;
        if self.answers_from_the_log() {
            // A target is compared with the run log here, if a client's requests came first; else it was when it was proposed.
            if self.state.borrow().driven {
                self.logged_intent(&targets, speed, None)?;
            }
            let mut state = self.state.borrow_mut();
            state.consume();
            if let Some(fault) = state.logged_fault(Call::Execute) {
                return Err(fault);
            }
            if state.answers_from_the_log() || state.is_at_the_logged_end() {
                return Ok(());
            }
            if !state.can_continue() {
                return Err(ended());
            }
            // A target that is sent again is no longer in the run log.
            state.target_is_done();
            return Ok(());
        }
        self.rig()?;
        self.record_target(&targets, speed, &encoded)?;
        match self.rig()?.execute() {
            Ok(()) => Ok(()),
            Err(fault) => self.failed(Call::Execute, fault),
        }
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            // A wait for the next entry would never end.
            let fault = state
                .mismatch_fault()
                .or_else(|| state.logged_fault(Call::Pause));
            return fault.map_or(Ok(()), Err);
        }
        if self.state.borrow().is_at_the_logged_end() {
            return Ok(());
        }
        let paused = self.rig()?.pause(seconds);
        paused.or_else(|fault| self.failed(Call::Pause, fault))
    }

    fn read(&mut self) -> Result<Reading, RigFault> {
        self.take_reading(|rig| Ok((rig.read()?, None)))
            .map(|(reading, _)| reading)
    }

    fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        self.take_reading(|rig| rig.read_moved())
    }

    fn at_once(&mut self) -> Option<&mut dyn WholeSteps> {
        if !self.does_whole_steps {
            let is_simulated = self.state.borrow().digests() && !self.answers_from_the_log();
            self.does_whole_steps = is_simulated && self.live()?.at_once().is_some();
        }
        self.does_whole_steps.then_some(self)
    }

    fn is_ideal(&mut self) -> bool {
        self.at_once().is_some() && self.live().is_some_and(Rig::is_ideal)
    }

    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.replay_or_follow(&ContinuousMove::Stroke(targets, velocity), samples, each)
    }

    fn follow_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.replay_or_follow(&ContinuousMove::Paths(paths), samples, each)
    }

    fn hold(&mut self) {
        self.state.borrow_mut().note_hold();
        self.forget_proposal();
        if let Some(rig) = self.live() {
            rig.hold();
        }
    }

    fn halt(&mut self) -> Option<FinalHold> {
        self.state.borrow_mut().note_hold();
        self.forget_proposal();
        if self.answers_from_the_log() {
            let logged = self.state.borrow_mut().logged_final_hold();
            if let (None, Some(rig)) = (&logged, self.live()) {
                rig.hold();
            }
            return logged.map(HeldBody::into_final_hold);
        }
        // Also if the run log fails: the rig comes first, and the operator must know whether it holds.
        let rig = self.live()?;
        let before = rig.time();
        let halted = rig.halt()?;
        let time = self.state.borrow().time;
        let offset = *self.offset.get_or_insert(time - before);
        let halted = FinalHold {
            time: halted.time + offset,
            ..halted
        };
        let mut state = self.state.borrow_mut();
        let held = HeldBody::of(&halted, state.wall());
        state.time = halted.time;
        if state.healthy().is_ok() {
            // If the run log fails here, its final entries contain this one.
            let _ = state
                .append(EntryKind::Held, &held)
                .and_then(|()| state.sync_point());
        } else {
            state.append_finally(EntryKind::Held, &held);
        }
        Some(halted)
    }

    /// The limits are not part of the run log: the guard computes them from the final hold. A fault is, as that of a proposal.
    fn set_limits(&mut self, limits: &[Limits]) -> Result<(), RigFault> {
        if self.answers_from_the_log() {
            let fault = self.state.borrow_mut().logged_fault(Call::Propose);
            return fault.map_or(Ok(()), Err);
        }
        let set = self.live().map_or(Ok(()), |rig| rig.set_limits(limits));
        set.or_else(|fault| self.failed(Call::Propose, fault))
    }

    fn declared_noise(&self) -> DeclaredNoise {
        self.about.noise
    }

    fn datum(&self) -> Option<Vec<f64>> {
        self.about.datum.clone()
    }

    fn own_speed(&self) -> Option<f64> {
        let state = self.state.borrow();
        let in_force = state.rig_in_force().map(|in_force| &in_force.rig);
        in_force.unwrap_or(&self.about).own_speed
    }

    /// The limit of the plan applies to every motion that is not logged yet.
    fn logged_speed_limit(&self) -> Option<Interval> {
        let state = self.state.borrow();
        let logged = state.rig_in_force().filter(|_| state.next_kind().is_some());
        logged.map(|in_force| in_force.speed_limit)
    }

    fn take_broken(&mut self) -> Option<Reading> {
        self.state.borrow_mut().broken.take()
    }

    /// Not part of the run log: it is only displayed.
    fn seen_speed(&self) -> Option<f64> {
        self.live.as_deref().and_then(Rig::seen_speed)
    }

    fn last_move(&self) -> Option<LastMove> {
        self.live.as_deref().and_then(Rig::last_move)
    }

    fn line_statistics(&self) -> LineStatistics {
        if !self.answers_from_the_log() {
            // The fault of the run log was reported to the run already.
            let _ = self.count();
        }
        self.state.borrow().recovered()
    }
}
