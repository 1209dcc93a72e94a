//! A resumption, in the steps and the order of `psd resume`. In: the run log that the session before left, the rig, the operator. Out: the
//! run that went on, or the reason why not. The witness learns what was released, and whether this specimen may go on at all.

use std::cell::RefCell;

use super::bench;
use super::case::Session;
use super::laws::{Law, Released};
use super::life::{Ended, Life, open, read};
use crate::run::replay::{
    self, AmendBody, Assurance, Bands, Continuation, HeldBody, IntentBody, LoggedRun, RecoverBody,
    ResumeBody, ResumeDecision, ResumeRefusal, RigBody, SampleBody,
};
use crate::run::{Inspection, Motion, Observer, Shared};
use psd_plan::Plan;
use psd_rig::journal::{Durability, EntryKind, Journal, Storage as _};
use psd_rig::{Reading, Rig as _, RigFault, StopRequest};

impl Life<'_> {
    /// The same steps in the same order as `psd resume`.
    pub(super) fn resume(&mut self, session: &Session, stop_request: &StopRequest) -> Ended {
        let (recovered, before) = match read(&self.bytes) {
            Ok(read) => read,
            Err(reason) => return Ended::Refused(reason),
        };
        if before.ended {
            return Ended::Refused(ResumeRefusal::Ended.to_string());
        }
        let plan = bench::amended(&self.plan, &session.amended);
        let assured = assured(session);
        if let Err(refusal) = replay::same_measure(&self.plan.rig, &plan.rig)
            .and_then(|()| replay::not_restarted(&before, &assured))
        {
            return Ended::Refused(refusal.to_string());
        }
        let datum = before.rigs.first().and_then(|rig| rig.datum.clone());
        let at_its_datum = Plan {
            rig: plan.rig.with_recorded_datum(datum.as_deref()),
            ..plan.clone()
        };
        let operator = RefCell::new(self.operator(session, &plan, stop_request));
        let mut opened = None;
        let opened_rig = &mut opened;
        let life = &*self;
        let begin = || -> Result<Continuation<'_>, Refused> {
            let opened = opened_rig;
            let rig = opened.insert(open(&at_its_datum, &life.world, stop_request)?);
            let last = before.rigs.last().ok_or(ResumeRefusal::NothingRecorded)?;
            replay::same_rig(&last.rig.identity, &rig.identity(), &assured)?;
            replay::same_resolution(last.rig.noise, rig.declared_noise())?;
            let planned = [&life.plan, &plan].map(|plan| Some(Released::of(plan).fastest()));
            let speeds = [
                ("own speed", last.rig.own_speed, rig.own_speed()),
                ("highest speed in the plan", planned[0], planned[1]),
            ];
            replay::no_faster(&speeds, &assured)?;
            let found = rig.read()?;
            let link = plan.rig.link.as_real().expect("a real rig");
            let bands = Bands::of(&plan.rig, link);
            let decision = replay::decide(
                &before,
                &RigBody::of(rig),
                &found,
                &bands,
                session.operator.accept_relaxation,
            )?;
            let motion = Motion::of(&plan, rig.identity(), "it MOVES on".to_owned());
            loop {
                let answer = operator.borrow_mut().release("resume", &motion);
                match answer {
                    _ if stop_request.end_requested() => {
                        return Err(Refused("stopped on request".to_owned()));
                    }
                    Inspection::Stop { reason, .. } => return Err(Refused(reason)),
                    Inspection::GoOn { .. } => break,
                    Inspection::Wait => match rig.pause(0.05) {
                        Ok(()) | Err(RigFault::Interrupted) => {}
                        Err(fault) => return Err(fault.into()),
                    },
                }
            }
            life.released(session, &plan, &decision, &before, &found, &bands);
            let resumption = decision.resumption("A. Operator", "power", &found, before.time);
            let resumption = ResumeBody {
                assured: assured.clone(),
                ..resumption
            };
            let torn = recovered.torn.is_some();
            let mut storage = life.disk.clone();
            storage.cut(recovered.whole).ok();
            let mut journal =
                Journal::reopen(Box::new(storage), Durability::EverySyncPoint, &recovered);
            let mut logged = before.clone();
            if torn {
                let recovery = RecoverBody {
                    t: logged.time,
                    put_aside: "torn".to_owned(),
                };
                journal.append(EntryKind::Recover, &recovery)?;
                logged.recovered();
            }
            if !session.amended.is_empty() {
                let amendment = AmendBody {
                    by: "A. Operator".to_owned(),
                    reason: "otherwise".to_owned(),
                    differences: vec!["the plan".to_owned()],
                    header: logged.header.clone(),
                };
                replay::amend(&mut journal, &amendment, &["text".to_owned()])?;
                logged.amended(amendment);
            }
            let about = RigBody {
                t: logged.time,
                ..RigBody::of(rig)
            };
            journal.append(EntryKind::Rig, &about)?;
            logged.answered(about);
            journal.append(EntryKind::Resume, &resumption)?;
            journal.sync()?;
            logged.resumed(resumption);
            Ok(Continuation {
                rig,
                journal,
                logged,
            })
        };
        let mut shared = Shared(&operator);
        match replay::resume(&plan, &before, &mut shared, Box::new(|| None), begin) {
            Ok(recorded) => Ended::Recorded(Box::new(recorded)),
            Err(Refused(reason)) => Ended::Refused(reason),
        }
    }

    /// The operator has released a resumption: what the witness must know of it.
    fn released(
        &self,
        session: &Session,
        plan: &Plan,
        decision: &ResumeDecision,
        before: &LoggedRun,
        found: &Reading,
        bands: &Bands,
    ) {
        let mut state = self.world.lock();
        let witness = &mut state.witness;
        witness.released = Some(Released::of(plan).and(decision));
        witness.limits_of(plan);
        witness.other_specimen = other_rig(self, session)
            .or_else(|| other_specimen(plan, before, found, bands, session));
        witness.decided[Law::SameSpecimen as usize] += 1;
    }
}

/// The reason of a refusal to resume.
struct Refused(String);

impl<E: std::fmt::Display> From<E> for Refused {
    fn from(reason: E) -> Self {
        Self(reason.to_string())
    }
}

fn assured(session: &Session) -> Vec<Assurance> {
    let answers = session.operator;
    [
        (answers.same_power_up, Assurance::SamePowerUp),
        (answers.re_referenced, Assurance::ReReferenced),
        (answers.accept_relaxation, Assurance::AcceptedRelaxation),
        (answers.let_go, Assurance::LetGo),
        (answers.accept_speed, Assurance::AcceptedSpeed),
    ]
    .into_iter()
    .filter(|(given, _)| *given)
    .map(|(_, assurance)| assurance)
    .collect()
}

/// Why a rig that reports its identity must not go on.
fn other_rig(life: &Life<'_>, session: &Session) -> Option<String> {
    if !life.case.tells_identity() {
        return None;
    }
    if !life.same_rig {
        return Some("it went on with another rig".to_owned());
    }
    (!life.same_power && !session.operator.re_referenced)
        .then(|| "it went on after a restart without a reference".to_owned())
}

/// Why this specimen must not go on: it is not where the run log left it, or does not carry what it must carry there. The force follows
/// the displacement since the last reading within the stiffness window of the pre-test check.
fn other_specimen(
    plan: &Plan,
    before: &LoggedRun,
    found: &Reading,
    bands: &Bands,
    session: &Session,
) -> Option<String> {
    let last = |kind: EntryKind| before.lines.iter().rev().find(|line| line.kind == kind);
    let intent = before
        .set_aside
        .as_ref()
        .or_else(|| last(EntryKind::Intent));
    let sample = last(EntryKind::Sample)?;
    let mut sampled: SampleBody = sample.read().ok()?;
    // The final hold was read later; without one, the rig was read before the last resumption.
    let later = before
        .lines
        .iter()
        .rev()
        .take_while(|line| line.seq > sample.seq);
    let held = { later }.find(|line| line.kind == EntryKind::Held);
    let held = match held {
        Some(line) => line.read::<HeldBody>().ok()?.found,
        None => None,
    };
    let resumed = before
        .resumption
        .as_ref()
        .map(|resume| resume.found.clone());
    if let Some(found) = held.or(resumed) {
        (sampled.x, sampled.r) = found;
    }
    let target = match intent.filter(|intent| intent.seq > sample.seq) {
        Some(intent) => Some(intent.read::<IntentBody>().ok()?.to),
        None => None,
    };
    let link = plan.rig.link.as_real()?;
    let axial = |axis: usize| link.axes.get(axis).and_then(|axis| axis.axial);
    for axis in 0..found.displacement.len() {
        // What the controller of the axis holds: a displacement, or a force.
        let held = |x: &[f64], r: &[f64]| match axial(axis) {
            Some(_) => r[axis],
            None => x[axis],
        };
        let (at, from) = (
            held(&found.displacement, &found.force),
            held(&sampled.x, &sampled.r),
        );
        let to = target.as_ref().map_or(from, |target| target[axis]);
        let band = 2.0 * bands.displacement[axis];
        let (low, high) = (from.min(to), from.max(to));
        if !(low - band..=high + band).contains(&at) {
            return Some(format!(
                "it went on from {at}, the run log leaves axis {} in {low} .. {high}",
                axis + 1
            ));
        }
    }
    if session.operator.accept_relaxation {
        return None;
    }
    let window = |axis: usize| link.pretest_check_of(axis).stiffness;
    let travel = |axis: usize| found.displacement[axis] - sampled.x[axis];
    let lateral = || (0..found.force.len()).filter(|axis| axial(*axis).is_none());
    for axis in lateral() {
        let force = found.force[axis];
        // A specimen that was softer in the readings before may be so again.
        let mut own = window(axis);
        let readings = before
            .lines
            .iter()
            .rev()
            .filter(|line| line.kind == EntryKind::Sample);
        let elsewhere = readings
            .filter_map(|line| line.read::<SampleBody>().ok())
            .find(|earlier| (earlier.x[axis] - sampled.x[axis]).abs() > bands.displacement[axis]);
        if let Some(earlier) = elsewhere {
            let tangent = (sampled.r[axis] - earlier.r[axis]) / (sampled.x[axis] - earlier.x[axis]);
            own.low = own.low.min(tangent.max(0.0));
        }
        // The stiffness matrix is positive: another axis adds at most √(kᵢ kⱼ) Δⱼ.
        let others = lateral().filter(|other| *other != axis);
        let others: f64 = others
            .map(|other| (own.high * window(other).high).sqrt() * travel(other).abs())
            .sum();
        let slack = 2.0 * bands.force[axis] + others;
        let ends = [own.low, own.high].map(|stiffness| sampled.r[axis] + stiffness * travel(axis));
        let (low, high) = (ends[0].min(ends[1]) - slack, ends[0].max(ends[1]) + slack);
        if !(low..=high).contains(&force) {
            return Some(format!(
                "it went on with {force} N at axis {}, expected {low} .. {high} N",
                axis + 1
            ));
        }
    }
    None
}
