//! A life from its first session to its last: the run, then resumptions, as `psd run` and `psd resume` perform them. In: a case. Out: the
//! breaches of laws, and what was met on the way.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::bench;
use super::case::{Case, Devices, Session, Test};
use super::disk::{Disk, Killed};
use super::fault::{Change, Fault, Kill, Part};
use super::frame::{FrameTest, Load, steps_of};
use super::laws::{Breach, Law, Released};
use super::operator::Operator;
use super::tally::Tally;
use super::world::{Endless, World, lateral_positions};
use crate::run::replay::tests::measured;
use crate::run::replay::{
    self, IntentBody, LoggedRun, Recorded, ResumeBody, SampleBody, TargetStatus,
};
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
    /// The run that was completed.
    completed: Option<Record>,
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
    let resumed = life.resumptions > 0;
    let mut lived = life.ended();
    if let (Some(record), true) = (&lived.completed, resumed && case.reads_the_truth()) {
        let undisturbed = live(&case.undisturbed()).completed;
        let unlike = match &undisturbed {
            Some(undisturbed) => unlike(case, record, undisturbed),
            None => Some("undisturbed, it is not completed".to_owned()),
        };
        lived.tally.decided(Law::SameMotion, 1);
        lived.breaches.extend(unlike.map(|how| Breach {
            law: Law::SameMotion,
            how,
        }));
    }
    lived
}

/// Where the results of a record differ from those of another, with the words before.
fn unlike(case: &Case, record: &Record, other: &Record) -> Option<String> {
    let (results, others) = (measured(record), measured(other));
    if results == others || nearly(record, other, case.differs_within()) {
        return None;
    }
    let equal = results.bytes().zip(others.bytes());
    let equal = equal.take_while(|(one, other)| one == other).count();
    let around = |text: &str| {
        let bytes = &text.as_bytes()[equal.saturating_sub(200)..text.len().min(equal + 80)];
        String::from_utf8_lossy(bytes).into_owned()
    };
    let (results, others) = (around(&results), around(&others));
    Some(format!(
        "results differ: {results:?}, undisturbed {others:?}"
    ))
}

/// Whether positions \[m\] and forces \[N\] of the floors differ by no more than this, in every step.
fn nearly(record: &Record, other: &Record, [far, force]: [f64; 2]) -> bool {
    let steps = |record: &Record| -> Vec<[Vec<f64>; 2]> {
        let steps = record.procedures.iter().flat_map(steps_of);
        let moved = steps.map(|step| {
            let positions = [&step.command, &step.displacement, &step.computed];
            let positions = positions.into_iter().flatten().copied().collect();
            [positions, step.restoring_force.clone()]
        });
        moved.collect()
    };
    let (steps, others) = (steps(record), steps(other));
    let near = |one: &[f64], other: &[f64], within: f64| {
        let mut numbers = one.iter().zip(other);
        numbers.all(|(one, other)| (one - other).abs() <= within)
    };
    let mut pairs = steps.iter().zip(&others);
    far > 0.0
        && steps.len() == others.len()
        && pairs
            .all(|([x, r], [other_x, other_r])| near(x, other_x, far) && near(r, other_r, force))
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
    /// The run that was completed.
    completed: Option<Record>,
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
            completed: None,
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
            self.check(law, false, || words_of(&*panic));
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
        let concluded = catch_unwind(AssertUnwindSafe(|| self.concluded(index, &ended)));
        concluded.unwrap_or_else(|panic| {
            self.check(Law::Unbroken, false, || words_of(&*panic));
            false
        })
    }

    /// What happened to the rig while psd was away.
    fn change(&mut self, session: &Session, change: Change) {
        self.tally.add(change.name());
        let at = lateral_positions(self.world.lock().bench.rig());
        self.power_ups += 1;
        let boot = self.power_ups;
        let exchange = |serial_number: &str| {
            let faults: Vec<&Fault> = session.faults.iter().collect();
            self.world.exchange(
                self.case
                    .rig(&faults, Some((serial_number, boot)), Log::none()),
            );
            self.world.move_by_hand(&at);
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
            Change::OtherPlace { axis, by } => {
                let mut to = at.clone();
                to[axis] += by;
                self.world.move_by_hand(&to);
            }
            Change::ForceGone { .. } => {}
        }
        let unloaded = match change {
            Change::OtherRig { loaded: false } => 0..self.case.axes.len(),
            Change::ForceGone { axis } => axis..axis + 1,
            _ => 0..0,
        };
        for axis in unloaded {
            let nothing = psd_rig::emulator::MechanicalFault::ScaleForce(0.0);
            self.world.lock().bench.rig_mut().strike(axis, nothing);
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
        let of = match &self.case.test {
            Test::Moves(_) => "",
            Test::Frame(_) => " of a frame",
        };
        let kind = if index == 0 { "run" } else { "resume" };
        let kind = format!("{kind}{of}");
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
            witness.ended_without_words(allowed);
        }
        if let Ended::Recorded(recorded) = ended {
            if recorded.record.outcome == Outcome::Completed {
                self.completed = Some(recorded.record.clone());
            }
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
        if let Test::Frame(test) = &self.case.test {
            let unlike = at_its_scale(test, logged, &replayed.record);
            self.check(Law::Scaled, unlike.is_none(), || unlike.unwrap_or_default());
        }
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
        let replies = |on| {
            let received = state.replies.get(self.case.line_of(on));
            received.copied().unwrap_or(0)
        };
        for fault in faults {
            let struck = match fault {
                Fault::Reply { after, on, .. } => replies(*on) > *after,
                Fault::Controller { after, axis, .. } => {
                    let on = Part {
                        axis: *axis,
                        on_load_cell: false,
                    };
                    replies(on) > *after
                }
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
            completed: self.completed,
        }
    }
}

fn words_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_default()
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
        let members = behind.into_iter().enumerate().map(member).collect();
        controllers::together(members, plan.rig.axes().unwrap_or(1))
    };
    let actuators = link.actuators().len();
    RealRig::open(
        &plan.rig,
        &plan.limits,
        devices(link.actuators(), 0).expect("an actuator"),
        devices(link.load_cells(), actuators),
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

/// The first step of the tables that is not among the targets and readings of the rig, at its scale and in its order.
fn at_its_scale(test: &FrameTest, logged: &LoggedRun, record: &Record) -> Option<String> {
    let (mut sent, mut moves) = (Vec::new(), Vec::new());
    for line in &logged.lines {
        match line.kind {
            EntryKind::Intent => sent = line.read::<IntentBody>().ok()?.to,
            EntryKind::Sample => {
                let SampleBody { x, r, .. } = line.read().ok()?;
                moves.push([sent.clone(), x, r]);
            }
            _ => {}
        }
    }
    let mut moves = moves.iter();
    for procedure in &record.procedures {
        let mut steps = steps_of(procedure);
        // A limit can end a step on its way.
        if !procedure.complete {
            steps.pop();
        }
        for step in steps {
            let stated = [
                test.axes_of(&step.command),
                test.measured_at(step),
                test.forces_of(step),
            ];
            if !moves.any(|[to, x, r]| {
                let pairs = [to, x, r].into_iter().zip(&stated);
                pairs
                    .zip([1e-12, 1e-12, 1e-6])
                    .all(|((rig, stated), near)| {
                        // The axial axis is behind the others.
                        let mut axes = rig.iter().zip(stated);
                        rig.len() == stated.len() + test.before_loads()
                            && axes.all(|(rig, stated)| (rig - stated).abs() <= near)
                    })
            }) {
                return Some(format!("no move of the rig is {stated:?}, of {step:?}"));
            }
        }
    }
    None
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

/// The laws that compare records find a rig at another scale, and a motion that is another one.
#[test]
fn another_scale_and_another_motion_are_found() {
    let is_scaled = |test: &FrameTest| *test != test.at_full_scale();
    let scaled = (0..).map(Case::of_seed).find_map(|case| match &case.test {
        Test::Frame(test) if case.devices == Devices::Native && is_scaled(test) => {
            Some((case.undisturbed(), test.clone()))
        }
        _ => None,
    });
    let (mut case, mut test) = scaled.expect("a seed with a scale");
    test.loads = vec![Load::Shake {
        steps: 9,
        peak: 0.05,
    }];
    case.test = Test::Frame(test.clone());
    case.axes.iter_mut().for_each(|axis| axis.farthest = None);
    let lived = |case: &Case| {
        let mut life = Life::new(case, Log::none());
        life.session(0, &case.sessions[0]);
        let record = life.completed.expect("it is completed");
        (record, read(&life.bytes).expect("a run log").1)
    };
    let (record, logged) = lived(&case);
    assert_eq!(at_its_scale(&test, &logged, &record), None);
    let unscaled = test.at_full_scale();
    assert!(at_its_scale(&unscaled, &logged, &record).is_some());
    let (other, _) = lived(&Case {
        test: Test::Frame(unscaled),
        ..case.clone()
    });
    assert!(unlike(&case, &record, &other).is_some());
    assert_eq!(unlike(&case, &record, &record), None);
}
