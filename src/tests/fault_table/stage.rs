//! A whole run on a rig emulator. In: a plan and a script of faults. Out: the outputs of the run, with the checks that the fault tests
//! make on them.

use crate::run::replay;
use crate::run::replay::LoggedRun;
use crate::run::{Observer, Unwatched};
pub(super) use crate::tests::testing::header;
use crate::tests::testing::ramp;
use psd_plan::formula::Formula;
use psd_plan::record::{EventKind, History, Outcome, Record};
use psd_plan::{Link, Move, Plan, ProcedureKind, RealLink};
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, EntryKind, Journal, Line, Recovered};
use psd_rig::safety::failpoint::{Guarding, without};
use psd_rig::{LineStatistics, Rig as _, RigFault};
pub(super) use psd_testing::emulator::open_through;
use psd_testing::emulator::{InProcess, SharedText};
pub(crate) use psd_testing::emulator::{emulator, open};
use psd_testing::journal::PowerLoss;
use psd_testing::journal::recover;
use psd_testing::plans::real_plan;
pub(super) use psd_testing::plans::{REPLY_TIMEOUT, device_link};

/// Stiffness of the specimen \[N/m\].
pub(super) const STIFFNESS: f64 = 1e5;

/// A ramp of ten steps of 0.1 mm on a native rig, three readings each.
pub(crate) fn plan() -> Plan {
    plan_of(vec![ProcedureKind::StiffnessRamp(ramp(1e-4))])
}

pub(super) fn plan_of(procedures: Vec<ProcedureKind>) -> Plan {
    real_plan(STIFFNESS, procedures)
}

/// The link of a plan of these tests.
pub(super) const fn link(plan: &mut Plan) -> &mut RealLink {
    match &mut plan.rig.link {
        Link::Real(link) => link,
        Link::Virtual(_) => panic!("a real rig"),
    }
}

pub(super) const fn to(displacement: f64) -> ProcedureKind {
    ProcedureKind::Move(Move {
        to: Formula::Constant(displacement),
        speed: None,
    })
}

/// Outputs of a run.
pub(super) struct Ended {
    pub(super) record: Record,
    pub(super) lines: Vec<Line>,
    pub(super) recovered: Recovered,
    /// Log of the simulator.
    pub(super) log: String,
    pub(super) line_statistics: LineStatistics,
    pub(super) trusted: bool,
    pub(super) emulator: InProcess,
}

/// Runs a plan on its emulator with this script of faults.
pub(super) fn run(plan: &Plan, script: &str) -> Ended {
    run_watched(plan, script, &mut Unwatched).unwrap_or_else(|fault| panic!("{fault}"))
}

pub(super) fn run_watched(
    plan: &Plan,
    script: &str,
    observer: &mut dyn Observer,
) -> Result<Ended, RigFault> {
    let text = SharedText::default();
    let emulator = emulator(plan, script, Log::to(Box::new(text.clone())), 1);
    let mut rig = open(plan, &emulator)?;
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    replay::begin(&mut journal, &header(plan), &["text".to_owned()]).unwrap();
    let recorded = replay::record(plan, &mut rig, observer, journal, Box::new(|| None));
    assert!(recorded.mismatch.is_none() && recorded.fault.is_none());
    let recovered = recover(&disk.written()).unwrap();
    // Whatever fault occurred, the run log alone reproduces the run.
    let logged_run = LoggedRun::of(&recovered).unwrap();
    assert_eq!(
        replay::check_consistency(&recovered, &logged_run, plan),
        Ok(())
    );
    let replayed = replay::replay(plan, logged_run);
    assert_eq!(replayed.mismatch, None);
    let same = format!("{:?}", replayed.record) == format!("{:?}", recorded.record);
    assert!(
        same,
        "{:?} became {:?}",
        recorded.record.outcome, replayed.record.outcome
    );
    let (line_statistics, trusted) = (rig.line_statistics(), rig.trusted());
    assert!(
        emulator.lock().rig().violations().is_empty()
            || !psd_rig::safety::failpoint::on(Guarding::TargetLimits)
    );
    Ok(Ended {
        record: recorded.record,
        lines: recovered.lines.clone(),
        recovered,
        log: text.text(),
        line_statistics,
        trusted,
        emulator,
    })
}

/// The same run with one guard off.
pub(super) fn run_without(guard: Guarding, plan: &Plan, script: &str) -> Ended {
    without(guard, || run(plan, script))
}

impl Ended {
    pub(super) fn completed(&self) -> bool {
        self.record.outcome == Outcome::Completed
    }

    pub(super) fn reason(&self) -> &str {
        match &self.record.outcome {
            Outcome::Completed => "",
            Outcome::Aborted { reason }
            | Outcome::NotReleased { reason }
            | Outcome::Blocked { reason }
            | Outcome::Faulted { reason } => reason,
        }
    }

    /// The run was completed with the numbers of a sound rig.
    pub(super) fn sound(&self) {
        assert!(
            self.completed(),
            "{:?}\n{}",
            self.record.outcome,
            self.tail()
        );
        for (command, force) in self.forces() {
            assert!(
                (force - STIFFNESS * command).abs() < 0.1,
                "{force} N at {command} m"
            );
        }
        assert_eq!(self.count(EntryKind::Fault), 0);
    }

    /// Commanded to hold, with the reason in the run log. After that nothing moved and no reading was used.
    pub(super) fn held(&self) {
        assert!(!self.completed());
        let held = self
            .log
            .find("actuator > !")
            .expect("the rig was commanded to hold");
        assert!(
            !self.log[held..].contains(" bench move ") && !self.log[held..].contains(">MOVE"),
            "{}",
            self.tail()
        );
        assert!(!self.emulator.lock().rig().moving());
        let fault = self
            .lines
            .iter()
            .position(|line| line.kind == EntryKind::Fault)
            .expect("a FAULT record");
        let used = [
            EntryKind::Sample,
            EntryKind::Intent,
            EntryKind::Step,
            EntryKind::End,
        ];
        assert!(
            !self.lines[fault..]
                .iter()
                .any(|line| used.contains(&line.kind))
        );
    }

    /// Text of the `nth` entry of a kind.
    pub(super) fn body(&self, kind: EntryKind, nth: usize) -> serde_json::Value {
        self.lines
            .iter()
            .filter(|line| line.kind == kind)
            .nth(nth)
            .unwrap()
            .body()
    }

    pub(super) fn count(&self, kind: EntryKind) -> usize {
        self.lines.iter().filter(|line| line.kind == kind).count()
    }

    /// Command \[m\] and force \[N\] of the steps of ramps and moves.
    pub(super) fn forces(&self) -> Vec<(f64, f64)> {
        let mut forces = Vec::new();
        for procedure in &self.record.procedures {
            match &procedure.history {
                History::StiffnessRamp(ramp) => {
                    let steps = ramp.steps.iter();
                    forces.extend(steps.map(|step| (step.command, step.restoring_force)));
                }
                History::Move(steps) => {
                    let steps = steps.iter();
                    forces.extend(steps.map(|step| (step.command, step.restoring_force)));
                }
                _ => {}
            }
        }
        forces
    }

    pub(super) fn events(&self, kind: EventKind) -> Vec<&str> {
        let events = self.record.events.iter().filter(|event| event.kind == kind);
        events.map(|event| event.text.as_str()).collect()
    }

    /// The end of the simulator's log.
    pub(super) fn tail(&self) -> String {
        let lines: Vec<&str> = self.log.lines().collect();
        lines[lines.len().saturating_sub(12)..].join("\n")
    }
}
