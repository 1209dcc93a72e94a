//! A whole run on a rig emulator. In: a plan and a script of faults. Out: the outputs of the run, with the checks that the fault tests
//! make on them.

use crate::run::replay;
use crate::run::replay::LoggedRun;
use crate::run::{Observer, Unwatched};
pub(super) use crate::tests::testing::header;
use crate::tests::testing::{elastic_plan, ramp};
use psd_plan::formula::Formula;
use psd_plan::record::{EventKind, History, Outcome, Record};
use psd_plan::{
    Behind, Datum, DeviceLink, Dialect, Interval, Limits, Link, Move, Plan, PortPlan, PretestCheck,
    ProcedureKind, ReadingRules, RealLink, SafeState, Settle,
};
use psd_rig::emulator::{Log, Script, of_plan};
use psd_rig::journal::{Durability, EntryKind, Journal, Line, Recovered};
use psd_rig::real::RealRig;
use psd_rig::safety::failpoint::{Guarding, without};
use psd_rig::transport::Port;
use psd_rig::{LineStatistics, Rig as _, RigFault, StopRequest, controllers};
use psd_testing::emulator::{InProcess, SharedText, SimulatedPort};
use psd_testing::journal::PowerLoss;
use psd_testing::journal::recover;

/// Stiffness of the specimen \[N/m\].
pub(super) const STIFFNESS: f64 = 1e5;

/// Time without a reply after which a frame is sent again \[s\].
pub(super) const REPLY_TIMEOUT: f64 = 0.1;

/// A ramp of ten steps of 0.1 mm on a native rig, three readings each.
pub(crate) fn plan() -> Plan {
    plan_of(vec![ProcedureKind::StiffnessRamp(ramp(1e-4))])
}

pub(super) fn plan_of(procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(STIFFNESS, procedures);
    plan.rig.name = "frame".to_owned();
    plan.rig.settle = Settle {
        band: 5e-6,
        force_rate: 0.0,
        dwell: 0.05,
        timeout: 0.5,
    };
    plan.rig.link = Link::Real(RealLink {
        actuator: device_link(Dialect::Native),
        load_cell: None,
        safe_state: SafeState::Hold,
        datum: Datum::Machine,
        pretest_check: PretestCheck {
            zero: 5.0,
            probe: 5e-5,
            stiffness: Interval {
                low: 5e4,
                high: 2e5,
            },
        },
        readings: ReadingRules {
            samples: 3,
            rate: 50.0,
            resolution: 1e-6,
            noise: 0.0,
            force_range: Interval {
                low: -2000.0,
                high: 2000.0,
            },
            frozen_after: 6,
        },
        watchdog: 3.0,
        own_speed: 0.01,
        axes: Vec::new(),
    });
    plan.limits = Limits {
        displacement: Interval {
            low: -0.002,
            high: 0.01,
        },
        force: Interval {
            low: -1500.0,
            high: 1500.0,
        },
        speed: Interval {
            low: 0.0,
            high: 0.01,
        },
        ..Limits::NONE
    };
    plan
}

/// The link of a plan of these tests.
pub(super) const fn link(plan: &mut Plan) -> &mut RealLink {
    match &mut plan.rig.link {
        Link::Real(link) => link,
        Link::Virtual(_) => panic!("a real rig"),
    }
}

pub(super) const fn device_link(dialect: Dialect) -> DeviceLink {
    let port = PortPlan::Serial {
        path: String::new(),
        baud: 115_200,
    };
    DeviceLink {
        port,
        dialect,
        reply_timeout: REPLY_TIMEOUT,
        serial_number: None,
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

pub(crate) fn emulator(plan: &Plan, script: &str, log: Log, seed: u64) -> InProcess {
    let script = Script::parse(script).unwrap_or_else(|error| panic!("{error}"));
    InProcess::new(of_plan(plan, &script, log, seed, Some(0x7f3a)).unwrap())
}

/// The plan's rig on an emulator.
pub(crate) fn open(plan: &Plan, emulator: &InProcess) -> Result<RealRig, RigFault> {
    open_through(plan, emulator, &|port| Box::new(port))
}

/// The same, with every line wrapped by `through`.
pub(super) fn open_through(
    plan: &Plan,
    emulator: &InProcess,
    through: &dyn Fn(SimulatedPort) -> Box<dyn Port>,
) -> Result<RealRig, RigFault> {
    let link = plan.rig.link.as_real().unwrap();
    let attach = |link: &DeviceLink, line: usize| {
        controllers::open(
            link,
            through(emulator.port(line)),
            Box::new(emulator.clock()),
            StopRequest::default(),
            plan.rig.settle.timeout,
        )
    };
    let (actuators, cells) = (link.actuators(), link.load_cells());
    let first_cell = actuators.len();
    let of_role = |behind: Vec<Behind<'_>>, first: usize| {
        let member = |(at, Behind { link, axes, .. }): (usize, Behind<'_>)| controllers::Member {
            device: attach(link, first + at),
            axes,
            serial_number: link.serial_number.clone(),
        };
        controllers::together(
            behind.into_iter().enumerate().map(member).collect(),
            plan.rig.axes().unwrap_or(1),
        )
    };
    let (actuator, load_cell) = (of_role(actuators, 0).unwrap(), of_role(cells, first_cell));
    RealRig::open(
        &plan.rig,
        &plan.limits,
        actuator,
        load_cell,
        Box::new(emulator.clock()),
        StopRequest::default(),
    )
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
