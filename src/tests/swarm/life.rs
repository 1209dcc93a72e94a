//! A life from its first session to its last: the run, then resumptions, as `psd run` and `psd resume` perform them. In: a case. Out: the
//! breaches of laws, and what was met on the way.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::bench;
use super::case::{Case, Session};
use super::disk::{Disk, Killed};
use super::fault::{Change, Fault, Kill};
use super::laws::{Breach, Law, Released};
use super::operator::Operator;
use super::tally::Tally;
use super::world::{Endless, World};
use crate::run::replay::{self, LoggedRun, Recorded, ResumeBody, TargetStatus};
use crate::tests::testing::header;
use psd_plan::record::{Outcome, Record};
use psd_plan::{Behind, Plan};
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, EntryKind, Journal, Recovered};
use psd_rig::real::RealRig;
use psd_rig::{RigFault, StopRequest, controllers};
use psd_testing::journal::recover;

/// What a life left behind.
pub(super) struct Lived {
    pub(super) breaches: Vec<Breach>,
    pub(super) tally: Tally,
}

/// Lives a case.
pub(super) fn live(case: &Case) -> Lived {
    live_logged(case, Log::none())
}

/// The same, with a log of the rig.
pub(super) fn live_logged(case: &Case, log: Log) -> Lived {
    let mut life = Life::new(case, log);
    for (index, session) in case.sessions.iter().enumerate() {
        if !life.session(index, session) || !life.world.lock().witness.breaches.is_empty() {
            break;
        }
    }
    life.ended()
}

pub(super) struct Life<'a> {
    pub(super) case: &'a Case,
    pub(super) world: World,
    /// The plan that the run log states.
    pub(super) plan: Plan,
    /// The bytes on the disk.
    pub(super) bytes: Vec<u8>,
    pub(super) disk: Disk,
    /// Present at this rig: whether it is the first one, and whether it has kept its power.
    pub(super) same_rig: bool,
    pub(super) same_power: bool,
    /// Number of power-ups beside the first, and of resumptions in the run log.
    power_ups: u16,
    resumptions: usize,
    tally: Tally,
}

/// How a session ended.
pub(super) enum Ended {
    Recorded(Box<Recorded>),
    /// Nothing was recorded, or nothing more.
    Refused(String),
    Killed,
}

impl<'a> Life<'a> {
    fn new(case: &'a Case, log: Log) -> Self {
        let faults: Vec<&Fault> = case
            .sessions
            .iter()
            .flat_map(|session| &session.faults)
            .collect();
        Self {
            case,
            world: World::new(case.rig(&faults, None, log), case.witness()),
            plan: case.plan(),
            bytes: Vec::new(),
            disk: Disk::default(),
            same_rig: true,
            same_power: true,
            power_ups: 0,
            resumptions: 0,
            tally: Tally::default(),
        }
    }

    /// Whether another session can follow.
    fn session(&mut self, index: usize, session: &Session) -> bool {
        for change in &session.before {
            self.change(session, *change);
        }
        let stop_request = StopRequest::default().with_release_allowed(session.operator.let_go);
        self.disk = Disk::of_session(&self.bytes, &session.faults, &self.disk);
        self.world
            .begin(self.disk.clone(), &session.faults, stop_request.clone());
        let attempt = AssertUnwindSafe(|| {
            if index == 0 {
                self.run(session, &stop_request)
            } else {
                self.resume(session, &stop_request)
            }
        });
        let ended = catch_unwind(attempt).unwrap_or_else(|panic| {
            if panic.is::<Killed>() {
                return Ended::Killed;
            }
            let law = if panic.is::<Endless>() {
                Law::Ends
            } else {
                Law::Unbroken
            };
            let how = panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            self.check(law, false, || how.unwrap_or_default());
            Ended::Killed
        });
        for law in [Law::Unbroken, Law::Ends] {
            self.check(law, true, String::new);
        }
        self.world.die();
        self.bytes = match (&ended, killed(session)) {
            (Ended::Killed, Some(kill)) => {
                self.tally.add(Fault::Killed(kill).name());
                self.disk.left_after(kill)
            }
            _ => self.disk.written(),
        };
        for name in self.world.take_struck() {
            self.tally.add(name);
        }
        self.concluded(index, &ended)
    }

    /// What happened to the rig while psd was away.
    fn change(&mut self, session: &Session, change: Change) {
        self.tally.add(change.name());
        let (at, force_gone) = {
            let state = self.world.lock();
            let rig = state.bench.rig();
            (
                rig.commanded(),
                matches!(change, Change::OtherRig { loaded: false }),
            )
        };
        self.power_ups += 1;
        let boot = self.power_ups;
        let exchange = |serial_number: &str| {
            let faults: Vec<&Fault> = session.faults.iter().collect();
            self.world.exchange(
                self.case
                    .rig(&faults, Some((serial_number, boot)), Log::none()),
            );
            self.world.move_by_hand(at);
        };
        match change {
            Change::Waits(seconds) => self.world.pass(seconds),
            Change::OtherRig { .. } => {
                exchange("0099");
                (self.same_rig, self.same_power) = (false, false);
            }
            Change::Restarted => {
                exchange(if self.same_rig { "0042" } else { "0099" });
                self.same_power = false;
            }
            Change::OtherPlace(by) => self.world.move_by_hand(at + by),
            Change::ForceGone => {}
        }
        if force_gone || change == Change::ForceGone {
            let nothing = psd_rig::emulator::MechanicalFault::ScaleForce(0.0);
            self.world.lock().bench.rig_mut().strike(0, nothing);
        }
    }

    fn run(&mut self, session: &Session, stop_request: &StopRequest) -> Ended {
        let mut rig = match open(&self.plan, &self.world, stop_request) {
            Ok(rig) => rig,
            Err(fault) => return Ended::Refused(fault.to_string()),
        };
        let mut journal = Journal::create(Box::new(self.disk.clone()), Durability::EverySyncPoint);
        if let Err(fault) = replay::begin(&mut journal, &header(&self.plan), &["text".to_owned()]) {
            return Ended::Refused(fault.to_string());
        }
        let mut operator = self.operator(session, &self.plan, stop_request);
        let recorded = replay::record(
            &self.plan,
            &mut rig,
            &mut operator,
            journal,
            Box::new(|| None),
        );
        Ended::Recorded(Box::new(recorded))
    }

    pub(super) fn operator(
        &self,
        session: &Session,
        plan: &Plan,
        stop_request: &StopRequest,
    ) -> Operator {
        let (world, stop_request) = (self.world.clone(), stop_request.clone());
        Operator::new(session.operator, Released::of(plan), world, stop_request)
    }

    fn check(&self, law: Law, holds: bool, how: impl FnOnce() -> String) {
        self.world.lock().witness.check(law, holds, how);
    }

    /// Checks what the session left behind. Returns whether another one can follow.
    fn concluded(&mut self, index: usize, ended: &Ended) -> bool {
        let kind = if index == 0 { "run" } else { "resume" };
        let path = match ended {
            Ended::Killed => format!("{kind} killed"),
            Ended::Refused(reason) => {
                self.check(Law::Reasoned, in_words(reason), || reason.clone());
                let moved = self.world.lock().witness.moved;
                self.check(Law::Released, moved == 0, || {
                    format!("refused after a move: {reason}")
                });
                format!("{kind} refused: {}", short(reason))
            }
            Ended::Recorded(recorded) => {
                let outcome = match &recorded.record.outcome {
                    Outcome::Completed => "completed",
                    Outcome::Aborted { .. } => "aborted",
                    Outcome::NotReleased { .. } => "not released",
                    Outcome::Blocked { .. } => "blocked",
                    Outcome::Faulted { .. } => "faulted",
                };
                format!("{kind} {outcome}")
            }
        };
        self.tally.path(path);
        if self.bytes.is_empty() {
            return false;
        }
        // A loss of power may leave later bytes without earlier ones. Damage is then reported, behind all that was flushed.
        if let Err(damage) = recover(&self.bytes)
            && damage.offset >= self.disk.durable()
        {
            self.tally
                .path("damage reported after a loss of power".to_owned());
            return false;
        }
        let (recovered, logged) = match read(&self.bytes) {
            Ok(read) => read,
            // The first entry was never flushed.
            Err(_) if self.disk.durable() == 0 => return false,
            Err(reason) => {
                self.check(Law::Verifies, false, || reason);
                return false;
            }
        };
        let resumptions = recovered
            .lines
            .iter()
            .filter(|line| line.kind == EntryKind::Resume);
        let resumptions = resumptions.count();
        if resumptions > self.resumptions {
            // The run log has the power-up of the rig with which it went on.
            (self.resumptions, self.same_power) = (resumptions, true);
            let amended = &self.case.sessions[index].amended;
            self.tally.amendments += u64::from(!amended.is_empty());
            self.plan = bench::amended(&self.plan, amended);
        }
        self.verified(&recovered, &logged, ended);
        let allowed = repeated(&recovered, &logged) + self.tally.count("command twice");
        let at_rest = self.world.at_rest();
        let mut state = self.world.lock();
        let witness = &mut state.witness;
        // What was sent again is counted in the run log a moment later: not by a psd that was killed, and not on a full disk.
        let uncounted = match ended {
            Ended::Recorded(recorded) => recorded.fault.is_some(),
            _ => true,
        };
        if uncounted {
            (witness.repeated, witness.killed) = (witness.repeated.min(allowed), true);
        }
        if let Ended::Recorded(recorded) = ended {
            witness.session_ended(&recorded.record, at_rest, allowed);
        }
        let early = self.disk.early();
        witness.check(Law::ReadingDurable, early == 0, || {
            format!("{early} targets came early")
        });
        !logged.ended && logged.rigs.first().is_some()
    }

    fn verified(&self, recovered: &Recovered, logged: &LoggedRun, ended: &Ended) {
        if logged.rigs.first().is_none() {
            return;
        }
        let consistent = replay::check_consistency(recovered, logged, &self.plan);
        self.check(Law::Verifies, consistent.is_ok(), || {
            format!("{consistent:?}")
        });
        let replayed = replay::replay(&self.plan, logged.clone());
        let mismatch = replayed.mismatch;
        self.check(Law::Verifies, mismatch.is_none(), || {
            mismatch.map_or_else(String::new, |mismatch| mismatch.to_string())
        });
        if let Ended::Recorded(recorded) = ended
            && recorded.fault.is_none()
        {
            let same = same(&recorded.record, &replayed.record);
            self.check(Law::Verifies, same, || {
                format!(
                    "{:?} became {:?}",
                    recorded.record.outcome, replayed.record.outcome
                )
            });
        }
    }

    fn ended(mut self) -> Lived {
        let state = self.world.lock();
        let faults = self
            .case
            .sessions
            .iter()
            .flat_map(|session| &session.faults);
        for fault in faults {
            let struck = match fault {
                Fault::Reply {
                    after,
                    on_load_cell,
                    ..
                } => state.replies[usize::from(*on_load_cell)] > *after,
                Fault::Controller { after, .. } => state.replies[0] > *after,
                Fault::Mechanical { after, .. } => state.bench.rig().moves().len() as u64 >= *after,
                _ => false,
            };
            if struck {
                self.tally.add(fault.name());
            }
        }
        for (law, count) in Law::ALL.iter().zip(state.witness.decided) {
            self.tally.decided(*law, count);
        }
        let breaches = state.witness.breaches.clone();
        drop(state);
        self.tally.seconds = self.world.now();
        Lived {
            breaches,
            tally: self.tally,
        }
    }
}

fn killed(session: &Session) -> Option<Kill> {
    session.faults.iter().find_map(|fault| match fault {
        Fault::Killed(kill) => Some(*kill),
        _ => None,
    })
}

pub(super) fn open(
    plan: &Plan,
    world: &World,
    stop_request: &StopRequest,
) -> Result<RealRig, RigFault> {
    let link = plan.rig.link.as_real().expect("a real rig");
    let devices = |behind: Vec<Behind<'_>>, first: usize| {
        let member = |(line, behind): (usize, Behind<'_>)| controllers::Member {
            device: controllers::open(
                behind.link,
                Box::new(world.line(first + line)),
                Box::new(world.clock()),
                stop_request.clone(),
                plan.rig.settle.timeout,
            ),
            axes: behind.axes,
            serial_number: behind.link.serial_number.clone(),
        };
        controllers::together(behind.into_iter().enumerate().map(member).collect(), 1)
    };
    RealRig::open(
        &plan.rig,
        &plan.limits,
        devices(link.actuators(), 0).expect("an actuator"),
        devices(link.load_cells(), 1),
        Box::new(world.clock()),
        stop_request.clone(),
    )
}

pub(super) fn read(bytes: &[u8]) -> Result<(Recovered, LoggedRun), String> {
    let recovered = recover(bytes).map_err(|damage| damage.to_string())?;
    let logged = LoggedRun::of(&recovered).map_err(|fault| fault.to_string())?;
    Ok((recovered, logged))
}

/// Number of targets that the run log says were sent again.
fn repeated(recovered: &Recovered, logged: &LoggedRun) -> u64 {
    let resumed = recovered
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Resume);
    let again = resumed.filter(|line| {
        line.read::<ResumeBody>().is_ok_and(|body| {
            matches!(
                body.target_status,
                TargetStatus::NotExecuted | TargetStatus::HeldDuringMotion
            )
        })
    });
    again.count() as u64 + logged.line_statistics.resent
}

/// Whether both are the record of the same run.
fn same(one: &Record, other: &Record) -> bool {
    one.outcome == other.outcome
        && one.events == other.events
        && one.procedures.len() == other.procedures.len()
        && format!("{:?}", one.procedures.last()) == format!("{:?}", other.procedures.last())
}

/// Whether an operator can read this.
fn in_words(reason: &str) -> bool {
    !reason.trim().is_empty()
}

/// The kind of a refusal, without its numbers.
fn short(reason: &str) -> String {
    let plain = reason
        .split(['(', ':', ',', '.'])
        .next()
        .unwrap_or_default();
    let words = plain
        .split(' ')
        .filter(|word| !word.contains(|letter: char| letter.is_ascii_digit()));
    words.take(6).collect::<Vec<_>>().join(" ")
}
