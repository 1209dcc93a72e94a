//! The run log of a run: its replay gives the same run, a changed run log is found, and after an interruption anywhere the
//! run is resumed to the same end with no target executed twice.

mod amended_speed;
mod compact;
mod durable;
mod held;
mod killed;
mod measured;
mod procedures;
mod resumed;
mod words_on_disk;

use std::cell::{RefCell, RefMut};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;

use killed::killed_everywhere;
pub(crate) use measured::measured;

use super::*;
use crate::run::{Inspection, StepReport};
use crate::tests::testing::{elastic_plan, header, impact, ramp, result_of, struck_frame};
use psd_physics::tracking::trajectory::Path;
use psd_plan::record::EventKind;
use psd_plan::{DampingSweep, InspectTrigger, Move, Plan, ProcedureKind, StiffnessRamp};
use psd_rig::journal::{Durability, Recovered, Storage};
use psd_rig::safety::failpoint::{Guarding, without};
use psd_rig::{
    CutOff, DeclaredNoise, EachReading, EncodedMove, Identity, LastMove, LineStatistics, Reading,
    RigFault, virtual_rig,
};
use psd_testing::journal::AlterEntry as _;
use psd_testing::journal::{Killed, PowerLoss, SickDisk, Sickness, recover};

/// The same rig for one program after another: it remembers its moves, as a real rig does. The recovered communication errors are counted
/// for each program.
#[derive(Clone)]
pub(super) struct RestingRig(pub(super) Rc<RefCell<Stand>>, u64);

pub(super) struct Stand {
    rig: Box<dyn Rig>,
    offered: Option<Vec<f64>>,
    last: LastMove,
    /// Every target that was executed, for each axis \[m\].
    pub(super) carried_out: Vec<Vec<f64>>,
    /// Motions, pauses and readings so far.
    pub(super) calls: usize,
}

impl RestingRig {
    pub(super) fn new(plan: &Plan) -> Self {
        let rig = virtual_rig(plan);
        let last = LastMove {
            id: 0,
            targets: vec![0.0; rig.degrees_of_freedom()],
        };
        Self(
            Rc::new(RefCell::new(Stand {
                rig,
                offered: None,
                last,
                carried_out: Vec::new(),
                calls: 0,
            })),
            0,
        )
    }

    /// The stand, for one call more.
    fn called(&self) -> RefMut<'_, Stand> {
        let mut stand = self.0.borrow_mut();
        stand.calls += 1;
        stand
    }
}

impl Rig for RestingRig {
    fn identity(&self) -> Identity {
        self.0.borrow().rig.identity()
    }
    fn degrees_of_freedom(&self) -> usize {
        self.0.borrow().rig.degrees_of_freedom()
    }
    fn time(&self) -> f64 {
        self.0.borrow().rig.time()
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        let mut stand = self.0.borrow_mut();
        stand.offered = Some(targets.to_vec());
        let id = stand.last.id + 1;
        Ok(EncodedMove {
            move_id: Some(id),
            ..stand.rig.propose(targets, speed)?
        })
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        let mut stand = self.called();
        let target = stand.offered.take().unwrap();
        stand.carried_out.push(target.clone());
        stand.last = LastMove {
            id: stand.last.id + 1,
            targets: target,
        };
        stand.rig.execute()
    }
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.called().rig.pause(seconds)
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        self.1 += 1;
        self.called().rig.read()
    }
    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        // The rig cannot keep up: every fifth reading is late.
        let mut due = 0_usize;
        self.called()
            .rig
            .traverse(targets, velocity, samples, &mut |reading| {
                due += 1;
                if due.is_multiple_of(5) {
                    Ok(())
                } else {
                    each(reading)
                }
            })
    }
    fn traverse_on(
        &mut self,
        cut_off: &CutOff<'_>,
        velocity: f64,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        // Four of five readings are logged; the late ones also count as done.
        let mut due = cut_off.done + cut_off.done.saturating_sub(1) / 4;
        self.called().rig.traverse_on(
            &CutOff {
                done: due,
                ..*cut_off
            },
            velocity,
            &mut |reading| {
                due += 1;
                if due.is_multiple_of(5) {
                    Ok(())
                } else {
                    each(reading)
                }
            },
        )
    }
    fn follow_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.called().rig.follow_paths(paths, samples, each)
    }
    fn resume_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.called().rig.resume_paths(paths, samples, done, each)
    }
    fn hold(&mut self) {
        self.0.borrow_mut().rig.hold();
    }
    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise::NONE
    }
    fn last_move(&self) -> Option<LastMove> {
        Some(self.0.borrow().last.clone())
    }
    fn line_statistics(&self) -> LineStatistics {
        LineStatistics {
            reread: self.1 / 20,
            ..LineStatistics::default()
        }
    }
}

/// Answers every inspection with an operator's name.
pub(super) struct Witness;

impl Observer for Witness {
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::GoOn {
            note: Some("no crack".to_owned()),
            by: Some("A. Witness".to_owned()),
        }
    }
}

/// An observer that notes the finished steps, and the opening of the rig among them (None).
#[derive(Default)]
struct Followed {
    steps: Rc<RefCell<Vec<Option<u64>>>>,
}

impl Observer for Followed {
    fn inspect(&mut self, note: &str) -> Inspection {
        Witness.inspect(note)
    }

    fn step_done(&mut self, report: &StepReport) {
        self.steps.borrow_mut().push(Some(report.step));
    }
}

impl Followed {
    /// Exactly the steps that are in the run log before `from` were done before the rig was opened.
    fn opened_where_the_record_ends(&self, record: &LoggedRun, from: u64, call: usize) {
        let on_record = record
            .lines
            .iter()
            .filter(|line| line.kind == EntryKind::Step && line.seq < from)
            .count();
        let before = self
            .steps
            .borrow()
            .iter()
            .take_while(|step| step.is_some())
            .count();
        let opened = self
            .steps
            .borrow()
            .iter()
            .filter(|step| step.is_none())
            .count();
        assert_eq!(
            (before, opened),
            (on_record, 1),
            "call {call}: the record is played before the rig is opened"
        );
    }
}

/// A ramp, a sweep, a move, an impact with an inspection: about forty steps.
fn plan() -> Plan {
    let sweep = DampingSweep {
        specimen: 0,
        velocities: vec![
            psd_plan::formula::Formula::Constant(0.01),
            psd_plan::formula::Formula::Constant(0.02),
        ],
        stroke: psd_plan::formula::Formula::Constant(1e-3),
        about: None,
        stiffness: result_of(0, "stiffness"),
        rate: Some(psd_plan::formula::Formula::Constant(60.0)),
    };
    let mut struck = impact(result_of(0, "stiffness"));
    struck.stepping.inspect = vec![InspectTrigger::Every(7)];
    let home = Move {
        to: psd_plan::formula::Formula::Constant(0.0),
        speed: None,
    };
    elastic_plan(
        300.0,
        vec![
            ProcedureKind::StiffnessRamp(StiffnessRamp {
                samples: 2,
                ..ramp(1e-4)
            }),
            ProcedureKind::DampingSweep(sweep),
            ProcedureKind::Inspect {
                note: "before the blow".to_owned(),
            },
            ProcedureKind::Impact(struck),
            ProcedureKind::Move(home),
        ],
    )
}

fn no_wall() -> Wall {
    Box::new(|| None)
}

fn journal(storage: impl Storage + 'static) -> Journal {
    Journal::create(Box::new(storage), Durability::EverySyncPoint)
}

/// Logs a run of the plan on a new rig. Gives the rig, the run, and the bytes of the run log.
pub(super) fn recorded(plan: &Plan) -> (RestingRig, Recorded, Vec<u8>) {
    let (mut rig, disk) = (RestingRig::new(plan), PowerLoss::new());
    let mut journal = journal(disk.clone());
    begin(&mut journal, &header(plan), &["text".to_owned()]).unwrap();
    let recorded = record(plan, &mut rig, &mut Witness, journal, no_wall());
    (rig, recorded, disk.written())
}

pub(super) fn logged(bytes: &[u8]) -> (Recovered, LoggedRun) {
    let recovered = recover(bytes).unwrap();
    let logged = LoggedRun::of(&recovered).unwrap();
    (recovered, logged)
}

#[test]
fn played_back_it_is_the_same_run() {
    let plan = plan();
    let (_, whole, bytes) = recorded(&plan);
    assert_eq!(
        whole.record.outcome,
        Outcome::Completed,
        "{:?}",
        whole.record.events
    );
    assert!(whole.fault.is_none() && whole.mismatch.is_none());
    let (recovered, logged) = logged(&bytes);
    assert!(recovered.ended && logged.texts == ["text"]);
    let replayed = replay(&plan, logged);
    assert_eq!(replayed.mismatch, None);
    assert_eq!(
        format!("{:?}", replayed.record),
        format!("{:?}", whole.record),
        "to the last bit"
    );
    let texts: Vec<&str> = replayed
        .record
        .events
        .iter()
        .map(|event| event.text.as_str())
        .collect();
    assert!(
        texts[0].contains("no crack") && texts[0].contains("A. Witness"),
        "{texts:?}"
    );
}

#[test]
fn what_the_run_would_not_have_done_is_found_out() {
    let plan = plan();
    let (_, _, bytes) = recorded(&plan);
    // A changed number in a reading: the run then requests different targets.
    let mut found = 0;
    let (recovered, _) = logged(&bytes);
    for (at, line) in recovered
        .lines
        .iter()
        .enumerate()
        .filter(|(_, line)| line.kind == EntryKind::Sample)
    {
        let mut forged = recovered.clone();
        let force = line.body()["r"][0].as_f64().unwrap();
        forged.lines[at]
            .alter(|body| body["r"][0] = serde_json::json!(force + 1e-9 * force.abs().max(1.0)));
        found += usize::from(
            replay(&plan, LoggedRun::of(&forged).unwrap())
                .mismatch
                .is_some(),
        );
    }
    // A reading before a move that no step reports can have any value: these few readings verify nothing.
    let samples = recovered
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Sample)
        .count();
    assert!(found > samples * 8 / 10, "{found} of {samples}");
    for (at, line) in recovered
        .lines
        .iter()
        .enumerate()
        .filter(|(_, line)| line.kind == EntryKind::Intent)
    {
        let mut forged = recovered.clone();
        let target = line.body()["to"][0].as_f64().unwrap();
        forged.lines[at]
            .alter(|body| body["to"][0] = serde_json::json!(f64::from_bits(target.to_bits() ^ 1)));
        let mismatch = replay(&plan, LoggedRun::of(&forged).unwrap())
            .mismatch
            .expect("one bit of a target");
        assert_eq!(mismatch.seq, line.seq);
    }
}

#[test]
fn an_answer_of_the_operator_has_its_time_of_day_and_replays_without_a_clock() {
    let (plan, disk) = (plan(), PowerLoss::new());
    let mut journal = journal(disk.clone());
    begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
    let wall: Wall = Box::new(|| Some("2026-05-31T10:00:00.000Z".to_owned()));
    let whole = record(
        &plan,
        &mut RestingRig::new(&plan),
        &mut Witness,
        journal,
        wall,
    );
    let (recovered, logged) = logged(&disk.written());
    let operator_lines: Vec<_> = recovered
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Operator)
        .collect();
    assert!(
        operator_lines.len() > 2
            && operator_lines
                .iter()
                .all(|line| line.body()["wall"] == "2026-05-31T10:00:00.000Z"),
        "{operator_lines:?}"
    );
    check_consistency(&recovered, &logged, &plan).unwrap();
    let replayed = replay(&plan, logged);
    assert_eq!(
        (replayed.mismatch, format!("{:?}", replayed.record)),
        (None, format!("{:?}", whole.record))
    );
}

#[test]
fn what_cannot_be_gone_on_with_is_known_without_a_rig() {
    let plan = plan();
    let (_, _, bytes) = recorded(&plan);
    let (mut recovered, _) = logged(&bytes);
    recovered.lines.pop();
    recovered.ended = false;
    let steps = recovered
        .lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent)
        .unwrap();
    recovered.lines.truncate(steps);
    let cut_off = LoggedRun::of(&recovered).unwrap();
    let check_run = |plan: &Plan| {
        let mut opened = false;
        let open = || {
            opened = true;
            Err(ResumeRefusal::NothingRecorded)
        };
        let refused = resume(plan, &cut_off, &mut Unwatched, no_wall(), open).err();
        (refused.unwrap(), opened)
    };
    assert_eq!(
        check_run(&plan),
        (ResumeRefusal::NothingRecorded, true),
        "what the rig's opening says"
    );

    let mut other = plan.clone();
    if let ProcedureKind::StiffnessRamp(ramp) = &mut other.procedures[0].kind {
        ramp.displacements[0] = psd_plan::formula::Formula::Constant(5e-5);
    }
    assert!(
        matches!(check_run(&other), (ResumeRefusal::Otherwise(_), false)),
        "another target than the recorded one"
    );
    let mut shorter = plan.clone();
    shorter.procedures.truncate(1);
    assert!(
        matches!(check_run(&shorter), (ResumeRefusal::Otherwise(_), false)),
        "the record goes on beyond the plan"
    );
    let mut narrow = plan.clone();
    narrow.limits.displacement.high = 1e-6;
    assert!(
        matches!(
            check_run(&narrow),
            (
                ResumeRefusal::EndsAgain { .. } | ResumeRefusal::Otherwise(_),
                false
            )
        ),
        "a limit that it is past already"
    );

    let mut turned = plan.rig.clone();
    same_measure(&plan.rig, &turned).unwrap();
    turned.polarity = -turned.polarity;
    assert_eq!(
        same_measure(&plan.rig, &turned),
        Err(ResumeRefusal::OtherMeasure { what: "polarity" })
    );

    let (force, resolution) = (1.0, 1e-6);
    let fine = DeclaredNoise { force, resolution };
    same_resolution(fine, DeclaredNoise { force: 2.0, ..fine }).unwrap();
    assert!(
        same_resolution(
            fine,
            DeclaredNoise {
                resolution: 1e-5,
                ..fine
            }
        )
        .is_err()
    );
    let was = RestingRig::new(&plan).identity();
    let is = Identity {
        firmware: "2.0".to_owned(),
        ..was.clone()
    };
    assert!(matches!(
        same_rig(&was, &is, &[Assurance::SamePowerUp]),
        Err(ResumeRefusal::OtherFirmware { .. })
    ));
    same_rig(&was, &is, &[Assurance::ReReferenced]).unwrap();
}
