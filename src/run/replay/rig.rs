//! The taped rig: between the guard and the rig, it answers from the record while there is any, and after it passes
//! calls on and records what comes back. INTENT is durable before a target leaves, SAMPLE before a reading is used.

use std::cell::RefCell;
use std::rc::Rc;

use super::continuous_move::ContinuousMove;
use super::entry::{
    Call, Doubt, FaultBody, HeldBody, IntentBody, RigBody, SampleBody, StrokeBody, escaped,
};
use super::state::{State, ended};
use crate::physics::tracking::trajectory::Path;
use crate::record::journal::EntryKind;
use crate::rig::safety::failpoint;
use crate::rig::safety::failpoint::Guarding;
use crate::rig::{
    DeclaredNoise, EachReading, Halted, Identity, LastMove, Offer, Reading, Rig, RigFault, Tally,
};

/// A rig whose every answer is on record.
pub struct TapedRig<'rig> {
    /// None while a record is only played back.
    live: Option<&'rig mut dyn Rig>,
    pub(super) state: Rc<RefCell<State<'rig>>>,
    about: RigBody,
    /// Proposed, and not carried out: targets as asked, speed as asked, and what the rig made of them.
    pending: Option<(Vec<f64>, Option<f64>, Offer)>,
    /// Rig time of the record less the rig's own, s.
    pub(super) offset: Option<f64>,
}

impl<'rig> TapedRig<'rig> {
    pub(super) fn new(live: Option<&'rig mut dyn Rig>, state: Rc<RefCell<State<'rig>>>) -> Self {
        let known = state.borrow().rig.clone();
        let about = known.unwrap_or_else(|| {
            let about = live.as_deref().map_or_else(nobody, RigBody::of);
            let mut state = state.borrow_mut();
            // A journal that fails here says so at the first call.
            if state
                .append(EntryKind::Rig, &about)
                .and_then(|()| state.promise())
                .is_ok()
            {
                state.time = about.t;
            }
            about
        });
        Self {
            live,
            state,
            about,
            pending: None,
            offset: None,
        }
    }

    /// Whether answers still come from the record.
    pub(super) fn playing(&self) -> bool {
        self.state.borrow_mut().playing()
    }

    /// The rig itself, where there is one.
    pub(super) fn live(&mut self) -> Option<&mut (dyn Rig + 'rig)> {
        if self.live.is_none() {
            self.live = self.state.borrow_mut().take_opened();
        }
        self.live.as_deref_mut()
    }

    /// The rig itself, once the record is played.
    pub(super) fn rig(&mut self) -> Result<&mut (dyn Rig + 'rig), RigFault> {
        self.state.borrow().healthy()?;
        self.live().ok_or_else(ended)?;
        let rig = self.live.as_deref_mut().ok_or_else(ended)?;
        if self.offset.is_none() {
            self.offset = Some(self.state.borrow().time - rig.time());
        }
        Ok(rig)
    }

    /// Puts on record what was mended on the lines since the record last said so.
    pub(super) fn count(&self) -> Result<(), RigFault> {
        let Some(rig) = self.live.as_deref() else {
            return Ok(());
        };
        self.state.borrow_mut().count(rig.tally())
    }

    /// Rig time of the record, s.
    fn now(&self) -> f64 {
        let state = self.state.borrow();
        match (&self.live, self.offset) {
            (Some(rig), Some(offset)) => offset + rig.time(),
            _ => state.time,
        }
    }

    /// Records that a call failed, and gives its fault on.
    pub(super) fn failed<T>(&mut self, call: Call, fault: RigFault) -> Result<T, RigFault> {
        let t = self.now();
        let mut state = self.state.borrow_mut();
        state.time = t;
        let wall = state.wall();
        // If the record fails too, the fault of the rig is still what ended the run.
        let _ = state
            .append(
                EntryKind::Fault,
                &FaultBody {
                    t,
                    call,
                    fault: fault.clone(),
                    wall,
                },
            )
            .and_then(|()| state.promise());
        Err(fault)
    }

    pub(super) fn record_intent(&mut self, intent: &mut IntentBody) -> Result<(), RigFault> {
        let mut state = self.state.borrow_mut();
        intent.n = state.next_target();
        intent.t = state.time;
        intent.wall = state.wall();
        state.append(EntryKind::Intent, intent)?;
        if failpoint::on(Guarding::IntentDurable) {
            state.promise()
        } else {
            Ok(())
        }
    }

    /// Sends a target that the record has already.
    pub(super) fn send_again(
        &mut self,
        targets: &[f64],
        speed: Option<f64>,
    ) -> Result<(), RigFault> {
        let rig = self.rig()?;
        let sent = rig.propose(targets, speed).and_then(|_| rig.execute());
        sent.or_else(|fault| self.failed(Call::Execute, fault))
    }

    /// The intent at the front of the record, if it is of these targets.
    fn played_intent(
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
        Err(state.disagrees(format!("a target of {targets:?} m at {speed:?} m/s")))
    }

    fn played_reading(&self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        let mut state = self.state.borrow_mut();
        if let Some(fault) = state.played_fault(Call::Read) {
            return Err(fault);
        }
        let sample: SampleBody = state.peek(EntryKind::Sample, "a reading")?;
        state.consume();
        Ok((
            Reading {
                time: sample.t,
                displacement: sample.x,
                force: sample.r,
                raw: Vec::new(),
            },
            sample.moved,
        ))
    }

    /// A reading, with when the rig went on its last move where that was asked for.
    fn take_reading(
        &mut self,
        read: impl FnOnce(&mut dyn Rig) -> Result<(Reading, Option<[f64; 2]>), RigFault>,
    ) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        if self.playing() {
            return self.played_reading();
        }
        let read = read(self.rig()?);
        let offset = self.offset.unwrap_or(0.0);
        let checked = read.and_then(|(reading, moved)| {
            let reading = finite(Reading {
                time: reading.time + offset,
                ..reading
            })?;
            Ok((
                reading,
                moved
                    .map(|ends| ends.map(|end| end + offset))
                    .filter(|ends| ends.iter().all(|end| end.is_finite())),
            ))
        });
        let (reading, moved) = checked.or_else(|fault| self.failed(Call::Read, fault))?;
        self.count()?;
        append_sample(&mut self.state.borrow_mut(), &reading, moved)?;
        if failpoint::on(Guarding::SampleDurable) {
            self.state.borrow_mut().promise()?;
        }
        Ok((reading, moved))
    }

    /// What the guard would not have is on record too, so that the run can be played back to here.
    fn forget_proposal(&mut self) {
        let Some((targets, speed, offer)) = self.pending.take() else {
            return;
        };
        if self.playing() {
            if self.played_intent(&targets, speed, None).is_ok() {
                self.state.borrow_mut().consume();
            }
        } else {
            let _ = self.record_intent(&mut intent(&targets, speed, &offer, None));
        }
    }

    /// The readings of a stroke, up to its end or to where it failed. How many there are where the record ends before it does.
    pub(super) fn played_stroke(
        &self,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<Option<usize>, RigFault> {
        let mut taken = 0;
        loop {
            if let Some(fault) = self.state.borrow_mut().played_fault(Call::Traverse) {
                return Err(fault);
            }
            if !self.playing() {
                return Ok(Some(taken));
            }
            let mut state = self.state.borrow_mut();
            if state.next_kind() == Some(EntryKind::Stroke) {
                let stroke: StrokeBody = state.peek(EntryKind::Stroke, "the end of a stroke")?;
                if stroke.samples != taken {
                    return Err(state.disagrees(format!("a stroke of {taken} readings")));
                }
                state.consume();
                return Ok(None);
            }
            drop(state);
            if taken == samples {
                return Err(self
                    .state
                    .borrow_mut()
                    .disagrees(format!("a stroke of at most {samples} readings")));
            }
            taken += 1;
            each(self.played_reading()?.0)?;
        }
    }
}

impl Rig for TapedRig<'_> {
    fn identity(&self) -> Identity {
        self.about.identity.clone()
    }

    fn degrees_of_freedom(&self) -> usize {
        self.about.axes
    }

    fn time(&self) -> f64 {
        self.state.borrow().time
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        if self.playing() {
            if let Some(fault) = self.state.borrow_mut().played_fault(Call::Propose) {
                return Err(fault);
            }
            let intent = if self.state.borrow().driven {
                self.state.borrow().intent_ahead()
            } else {
                Some(self.played_intent(targets, speed, None)?)
            };
            // Of what was proposed and never sent, no bytes are on record.
            let unsent = || Offer {
                targets: targets.to_vec(),
                speed: speed.unwrap_or(0.0),
                wire: Vec::new(),
                move_id: None,
                at_the_rig: None,
            };
            let offer = intent.map_or_else(unsent, |intent| Offer {
                targets: intent.said.clone().unwrap_or_else(|| intent.to.clone()),
                speed: intent.rate,
                wire: Vec::new(),
                move_id: intent.id,
                at_the_rig: intent.own.clone(),
            });
            self.pending = Some((targets.to_vec(), speed, offer.clone()));
            return Ok(offer);
        }
        match self.rig()?.propose(targets, speed) {
            Ok(offer) => {
                self.pending = Some((targets.to_vec(), speed, offer.clone()));
                Ok(offer)
            }
            Err(fault) => self.failed(Call::Propose, fault),
        }
    }

    fn execute(&mut self) -> Result<(), RigFault> {
        let (targets, speed, offer) = self
            .pending
            .take()
            .ok_or_else(|| RigFault::Device("nothing was proposed to execute".to_owned()))?;
        if self.playing() {
            // What is sent is held against the record here, where a client's requests came first.
            self.played_intent(&targets, speed, None)?;
            let mut state = self.state.borrow_mut();
            state.consume();
            if let Some(fault) = state.played_fault(Call::Execute) {
                return Err(fault);
            }
            if state.playing() || state.played_out() {
                return Ok(());
            }
            if !state.goes_on() {
                return Err(ended());
            }
            let doubt = state.take_doubt();
            drop(state);
            return match doubt {
                Some(Doubt::Executed) => Ok(()),
                _ => self.send_again(&targets, speed),
            };
        }
        self.rig()?;
        self.record_intent(&mut intent(&targets, speed, &offer, None))?;
        match self.rig()?.execute() {
            Ok(()) => Ok(()),
            Err(fault) => self.failed(Call::Execute, fault),
        }
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        if self.playing() {
            let mut state = self.state.borrow_mut();
            // Whoever waits for what the record says next would wait for ever.
            let fault = state.parted().or_else(|| state.played_fault(Call::Pause));
            return fault.map_or(Ok(()), Err);
        }
        if self.state.borrow().played_out() {
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

    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.take_way(&ContinuousMove::Stroke(targets, velocity), samples, each)
    }

    fn glide(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.take_way(&ContinuousMove::Paths(paths), samples, each)
    }

    fn hold(&mut self) {
        self.state.borrow_mut().holds();
        self.forget_proposal();
        if let Some(rig) = self.live() {
            rig.hold();
        }
    }

    fn halt(&mut self) -> Option<Halted> {
        self.state.borrow_mut().holds();
        self.forget_proposal();
        if self.playing() {
            let played = self.state.borrow_mut().played_hold();
            if let (None, Some(rig)) = (&played, self.live()) {
                rig.hold();
            }
            return played.map(
                |HeldBody {
                     t, doubt, found, ..
                 }| Halted {
                    time: t,
                    doubt,
                    found,
                    raw: Vec::new(),
                },
            );
        }
        // Also where the record cannot be kept: the rig comes first. What is not on record is no part of the run.
        let rig = self.live()?;
        let before = rig.time();
        let halted = rig.halt()?;
        let time = self.state.borrow().time;
        let offset = *self.offset.get_or_insert(time - before);
        let halted = Halted {
            time: halted.time + offset,
            ..halted
        };
        let mut state = self.state.borrow_mut();
        let Halted {
            doubt, found, raw, ..
        } = halted.clone();
        let raw = raw.iter().map(|raw| escaped(raw)).collect();
        let held = HeldBody {
            t: halted.time,
            doubt,
            found,
            raw,
            wall: state.wall(),
        };
        state
            .append(EntryKind::Held, &held)
            .and_then(|()| state.promise())
            .ok()?;
        state.time = halted.time;
        Some(halted)
    }

    fn declared_noise(&self) -> DeclaredNoise {
        self.about.noise
    }

    fn datum(&self) -> Option<Vec<f64>> {
        self.about.datum.clone()
    }

    fn own_speed(&self) -> Option<f64> {
        self.about.own_speed
    }

    /// No part of the record: who watches is told, and nothing comes of it.
    fn seen_speed(&self) -> Option<f64> {
        self.live.as_deref().and_then(Rig::seen_speed)
    }

    fn last_move(&self) -> Option<LastMove> {
        self.live.as_deref().and_then(Rig::last_move)
    }

    fn tally(&self) -> Tally {
        if !self.playing() {
            // Of a record that cannot be kept the run knows already.
            let _ = self.count();
        }
        self.state.borrow().mended()
    }
}

impl RigBody {
    /// What a rig says of itself.
    #[must_use]
    pub fn of(rig: &dyn Rig) -> Self {
        Self {
            t: rig.time(),
            identity: rig.identity(),
            axes: rig.degrees_of_freedom(),
            noise: rig.declared_noise(),
            own_speed: rig.own_speed(),
            last_move: rig.last_move(),
            datum: rig.datum(),
            said: rig
                .introduction()
                .iter()
                .map(|reply| escaped(reply))
                .collect(),
        }
    }
}

/// A record that was cut off before its rig answered.
fn nobody() -> RigBody {
    let unknown = String::new;
    let identity = Identity {
        name: unknown(),
        model: unknown(),
        serial: unknown(),
        firmware: unknown(),
        boot: None,
        simulated: true,
    };
    RigBody {
        t: 0.0,
        identity,
        axes: 1,
        noise: DeclaredNoise::default(),
        own_speed: None,
        last_move: None,
        datum: None,
        said: Vec::new(),
    }
}

pub(super) fn intent(
    targets: &[f64],
    speed: Option<f64>,
    offer: &Offer,
    samples: Option<usize>,
) -> IntentBody {
    IntentBody {
        n: 0,
        t: 0.0,
        to: targets.to_vec(),
        speed,
        said: (!same_bits(&offer.targets, targets)).then(|| offer.targets.clone()),
        rate: offer.speed,
        wire: (!offer.wire.is_empty()).then(|| escaped(&offer.wire)),
        id: offer.move_id,
        own: offer.at_the_rig.clone(),
        path: None,
        samples,
        wall: None,
    }
}

pub(super) fn append_sample(
    state: &mut State,
    reading: &Reading,
    moved: Option<[f64; 2]>,
) -> Result<(), RigFault> {
    state.time = reading.time;
    let sample = SampleBody {
        t: reading.time,
        x: reading.displacement.clone(),
        r: reading.force.clone(),
        raw: reading.raw.iter().map(|raw| escaped(raw)).collect(),
        moved,
        wall: state.wall(),
    };
    state.append(EntryKind::Sample, &sample)
}

/// A reading that is no number is a fault of the rig, with the numbers as they came.
pub(super) fn finite(reading: Reading) -> Result<Reading, RigFault> {
    let numbers = || reading.displacement.iter().chain(&reading.force);
    if numbers().all(|value| value.is_finite()) {
        return Ok(reading);
    }
    Err(RigFault::Device(format!(
        "a reading is no number: {:?}",
        numbers().collect::<Vec<_>>()
    )))
}

fn same_bits(one: &[f64], other: &[f64]) -> bool {
    one.iter()
        .map(|value| value.to_bits())
        .eq(other.iter().map(|value| value.to_bits()))
}

pub(super) fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
