//! A run is the record of it: played back it is the same, changed it is found out, and cut off anywhere it goes on to the
//! same end with no target carried out twice.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;

use super::testing::measured;
use super::*;
use crate::physics::tracking::trajectory::Path;
use crate::plan::{DampingSweep, InspectTrigger, Move, Plan, ProcedureKind, StiffnessRamp};
use crate::record::EventKind;
use crate::record::journal::testing::{Killed, PowerLoss, SickDisk, Sickness};
use crate::record::journal::{Durability, Recovered, Storage, recover};
use crate::rig::safety::failpoint::{Guarding, without};
use crate::rig::{
    CutOff, DeclaredNoise, EachReading, Identity, LastMove, Offer, Reading, RigFault, Tally,
    virtual_rig,
};
use crate::run::{Inspection, StepReport};
use crate::tests::testing::{elastic_plan, header, impact, ramp, result_of, struck_frame};

/// The same rig for program after program: it remembers its moves, as a real one does. What it mended each program counts.
#[derive(Clone)]
pub(super) struct Standing(pub(super) Rc<RefCell<Stand>>, u64);

pub(super) struct Stand {
    rig: Box<dyn Rig>,
    offered: Option<Vec<f64>>,
    last: LastMove,
    /// Every target that was carried out, of each axis, m.
    pub(super) carried_out: Vec<Vec<f64>>,
}

impl Standing {
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
            })),
            0,
        )
    }
}

impl Rig for Standing {
    fn identity(&self) -> Identity {
        self.0.borrow().rig.identity()
    }
    fn degrees_of_freedom(&self) -> usize {
        self.0.borrow().rig.degrees_of_freedom()
    }
    fn time(&self) -> f64 {
        self.0.borrow().rig.time()
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        let mut stand = self.0.borrow_mut();
        stand.offered = Some(targets.to_vec());
        let id = stand.last.id + 1;
        Ok(Offer {
            move_id: Some(id),
            ..stand.rig.propose(targets, speed)?
        })
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        let mut stand = self.0.borrow_mut();
        let target = stand.offered.take().unwrap();
        stand.carried_out.push(target.clone());
        stand.last = LastMove {
            id: stand.last.id + 1,
            targets: target,
        };
        stand.rig.execute()
    }
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.0.borrow_mut().rig.pause(seconds)
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        self.1 += 1;
        self.0.borrow_mut().rig.read()
    }
    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        // It cannot keep up: every fifth reading is late.
        let mut due = 0_usize;
        self.0
            .borrow_mut()
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
        // Four of five are on record: those that were late are done too.
        let mut due = cut_off.done + cut_off.done.saturating_sub(1) / 4;
        self.0.borrow_mut().rig.traverse_on(
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
    fn glide(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.0.borrow_mut().rig.glide(paths, samples, each)
    }
    fn glide_on(
        &mut self,
        paths: &[Path],
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.0.borrow_mut().rig.glide_on(paths, samples, done, each)
    }
    fn hold(&mut self) {
        self.0.borrow_mut().rig.hold();
    }
    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise::default()
    }
    fn last_move(&self) -> Option<LastMove> {
        Some(self.0.borrow().last.clone())
    }
    fn tally(&self) -> Tally {
        Tally {
            reread: self.1 / 20,
            ..Tally::default()
        }
    }
}

/// Answers every inspection with a name.
pub(super) struct Witness;

impl Observer for Witness {
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::GoOn {
            note: Some("no crack".to_owned()),
            by: Some("A. Witness".to_owned()),
        }
    }
}

/// A witness who notes the steps that are done, and where among them (None) the rig is opened.
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
    /// As many steps as the record has up to `from` were done before, and no other.
    fn opened_where_the_record_ends(&self, record: &Played, from: u64, call: usize) {
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

/// A ramp, a sweep, a move, an impact with an inspection: some forty steps.
fn plan() -> Plan {
    let sweep = DampingSweep {
        specimen: 0,
        velocities: vec![
            crate::plan::formula::Formula::Constant(0.01),
            crate::plan::formula::Formula::Constant(0.02),
        ],
        stroke: crate::plan::formula::Formula::Constant(1e-3),
        about: None,
        stiffness: result_of(0, "stiffness"),
        rate: Some(crate::plan::formula::Formula::Constant(60.0)),
    };
    let mut blow = impact(result_of(0, "stiffness"));
    blow.stepping.inspect = vec![InspectTrigger::Every(7)];
    let home = Move {
        to: crate::plan::formula::Formula::Constant(0.0),
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
            ProcedureKind::Impact(blow),
            ProcedureKind::Move(home),
        ],
    )
}

fn no_wall() -> Wall {
    Box::new(|| None)
}

fn journal(storage: impl Storage + 'static) -> Journal {
    Journal::create(Box::new(storage), Durability::EveryPromise)
}

/// Records the plan on a fresh rig; the rig, the record and the journal's bytes.
pub(super) fn recorded(plan: &Plan) -> (Standing, Recorded, Vec<u8>) {
    let (mut rig, disk) = (Standing::new(plan), PowerLoss::new());
    let mut journal = journal(disk.clone());
    begin(&mut journal, &header(), &["text".to_owned()]).unwrap();
    let recorded = record(plan, &mut rig, &mut Witness, journal, no_wall());
    (rig, recorded, disk.written())
}

pub(super) fn played(bytes: &[u8]) -> (Recovered, Played) {
    let recovered = recover(bytes).unwrap();
    let played = Played::of(&recovered).unwrap();
    (recovered, played)
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
    let (recovered, played) = played(&bytes);
    assert!(recovered.ended && played.texts == ["text"]);
    let replayed = replay(&plan, played);
    assert_eq!(replayed.mismatch, None);
    assert_eq!(
        format!("{:?}", replayed.record),
        format!("{:?}", whole.record),
        "to the last bit"
    );
    let told: Vec<&str> = replayed
        .record
        .events
        .iter()
        .map(|event| event.text.as_str())
        .collect();
    assert!(
        told[0].contains("no crack") && told[0].contains("A. Witness"),
        "{told:?}"
    );
}

#[test]
fn what_the_run_would_not_have_done_is_found_out() {
    let plan = plan();
    let (_, _, bytes) = recorded(&plan);
    // Another number in a reading: the run then asks for other targets.
    let mut found = 0;
    let (recovered, _) = played(&bytes);
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
            replay(&plan, Played::of(&forged).unwrap())
                .mismatch
                .is_some(),
        );
    }
    // A reading before a move that no step reports can be anything: those few prove nothing.
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
        let mismatch = replay(&plan, Played::of(&forged).unwrap())
            .mismatch
            .expect("one bit of a target");
        assert_eq!(mismatch.seq, line.seq);
    }
}

#[test]
fn killed_at_every_write_and_every_sync_it_goes_on_to_the_same_end() {
    killed_everywhere(&plan(), 200);
}

/// A blow on a storey: targets and readings of two axes.
#[test]
fn killed_at_every_write_a_blow_on_a_storey_goes_on_to_the_same_end() {
    killed_everywhere(&struck_frame(), 60);
}

/// Kills the run at every call on its disk, before and after the bytes are there, and goes on each time: more often than `least`.
pub(super) fn killed_everywhere(plan: &Plan, least: usize) {
    let (whole_rig, whole, _) = recorded(plan);
    assert_eq!(
        whole.record.outcome,
        Outcome::Completed,
        "{:?}",
        whole.record.events
    );
    let once = whole_rig.0.borrow().carried_out.clone();
    let mut kills = 0;
    for call in 4.. {
        for after in [false, true] {
            let (rig, disk) = (Standing::new(plan), PowerLoss::new());
            let storage = Killed::at(&disk, call, after);
            let ended = catch_unwind(AssertUnwindSafe(|| {
                let mut journal = journal(storage);
                begin(&mut journal, &header(), &["text".to_owned()]).unwrap();
                record(plan, &mut rig.clone(), &mut Witness, journal, no_wall())
            }));
            if ended.is_ok() {
                assert!(kills > least, "{kills}");
                return;
            }
            kills += 1;
            go_on_and_compare(plan, rig, &disk, &measured(&whole.record), &once, call);
        }
    }
}

/// What was written is what a killed program leaves: the system still has it.
fn go_on_and_compare(
    plan: &Plan,
    mut rig: Standing,
    disk: &PowerLoss,
    expected: &str,
    once: &[Vec<f64>],
    call: usize,
) {
    let (recovered, before) = played(&disk.written());
    if before.ended {
        return;
    }
    rig.hold();
    let found = rig.read().unwrap();
    let axes = found.displacement.len();
    let bands = Bands {
        displacement: vec![1e-9; axes],
        force: vec![1e-6; axes],
    };
    let about = RigBody::of(&rig);
    let decision = match decide(&before, &about, &found, &bands, false) {
        Err(Refusal::NothingRecorded) => return assert!(rig.0.borrow().carried_out.is_empty()),
        other => other.unwrap_or_else(|refusal| panic!("call {call}: {refusal}")),
    };
    let resumption = decision.resumption("A. Witness", "power", &found, before.time);
    let mut journal = Journal::go_on(Box::new(disk.clone()), Durability::EveryPromise, &recovered);
    journal
        .append(
            EntryKind::Rig,
            &RigBody {
                t: before.time,
                ..about
            },
        )
        .unwrap();
    journal.append(EntryKind::Resume, &resumption).unwrap();
    let (_, again) = played(&disk.written());
    let mut followed = Followed::default();
    let steps = Rc::clone(&followed.steps);
    let goes_on = || {
        steps.borrow_mut().push(None);
        Ok::<_, Refusal>(GoesOn {
            rig: &mut rig,
            journal,
            played: again,
        })
    };
    let resumed = resume(plan, &before, &mut followed, no_wall(), goes_on)
        .unwrap_or_else(|refusal| panic!("call {call}: {refusal}"));
    followed.opened_where_the_record_ends(&before, resumption.from, call);
    assert_eq!(resumed.mismatch, None, "call {call}");
    assert_eq!(
        resumed.record.outcome,
        Outcome::Completed,
        "call {call}: {:?}",
        resumed.record.events
    );
    assert_eq!(measured(&resumed.record), expected, "call {call}");
    let mended = resumed
        .record
        .events
        .iter()
        .find(|event| event.kind == EventKind::Mended)
        .map(|event| event.text.clone());
    let both = Some(before.tally.plus(rig.tally())).filter(|tally| *tally != Tally::default());
    assert_eq!(
        mended,
        both.map(|tally| tally.to_string()),
        "call {call}: what was mended before counts too"
    );
    let carried_out = rig.0.borrow().carried_out.clone();
    if matches!(resumption.doubt, Doubt::Stroke { .. }) {
        assert_eq!(
            carried_out.len(),
            once.len() + 1,
            "call {call}: only back to where the stroke began"
        );
    } else {
        assert_eq!(
            carried_out, once,
            "call {call}: no target twice, none left out"
        );
    }
    // The record of both together is a run that can be played back.
    let (recovered, whole) = played(&disk.written());
    assert_eq!(agrees(&recovered, &whole, plan), Ok(()), "call {call}");
    let replayed = replay(plan, whole);
    assert_eq!(replayed.mismatch, None, "call {call}");
    assert_eq!(
        format!("{:?}", replayed.record),
        format!("{:?}", resumed.record),
        "call {call}"
    );
}

/// A rig that looks, whenever it is asked for anything, at what a loss of power would leave of the record.
struct Suspicious {
    rig: Standing,
    disk: PowerLoss,
    proposed: f64,
    read: bool,
    /// What was found missing.
    missing: Vec<&'static str>,
}

impl Suspicious {
    /// Kind of the last durable record, and its target.
    fn durable(&self) -> (EntryKind, Option<f64>) {
        let recovered = recover(&self.disk.synced()).unwrap();
        let last = recovered.lines.last().unwrap();
        (last.kind, last.body()["to"][0].as_f64())
    }

    fn last_reading_is_durable(&mut self) {
        let recovered = recover(&self.disk.synced()).unwrap();
        let intent = recovered
            .lines
            .iter()
            .rposition(|line| line.kind == EntryKind::Intent);
        let sample = recovered
            .lines
            .iter()
            .rposition(|line| line.kind == EntryKind::Sample);
        if self.read && sample <= intent {
            self.missing.push("sample");
        }
        self.read = false;
    }
}

impl Rig for Suspicious {
    fn identity(&self) -> Identity {
        self.rig.identity()
    }
    fn degrees_of_freedom(&self) -> usize {
        1
    }
    fn time(&self) -> f64 {
        self.rig.time()
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        self.last_reading_is_durable();
        self.proposed = targets[0];
        self.rig.propose(targets, speed)
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        if self.durable() != (EntryKind::Intent, Some(self.proposed)) {
            self.missing.push("intent");
        }
        self.rig.execute()
    }
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.rig.pause(seconds)
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        self.last_reading_is_durable();
        self.read = true;
        self.rig.read()
    }
    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        if self.durable() != (EntryKind::Intent, Some(targets[0])) {
            self.missing.push("intent");
        }
        self.rig.traverse(targets, velocity, samples, each)
    }
    fn hold(&mut self) {
        self.rig.hold();
    }
    fn declared_noise(&self) -> DeclaredNoise {
        self.rig.declared_noise()
    }
}

/// What a loss of power at the worst moment would lose of a run.
fn lost_to_power() -> Vec<&'static str> {
    let (plan, disk) = (plan(), PowerLoss::new());
    let mut rig = Suspicious {
        rig: Standing::new(&plan),
        disk: disk.clone(),
        proposed: 0.0,
        read: false,
        missing: Vec::new(),
    };
    let mut journal = journal(disk);
    begin(&mut journal, &header(), &[]).unwrap();
    let recorded = record(&plan, &mut rig, &mut Witness, journal, no_wall());
    assert_eq!(recorded.record.outcome, Outcome::Completed);
    rig.missing
}

#[test]
fn no_target_leaves_and_no_reading_is_used_before_it_is_durable() {
    assert_eq!(lost_to_power(), [] as [&str; 0]);
    assert!(without(Guarding::IntentDurable, lost_to_power).contains(&"intent"));
    assert!(without(Guarding::SampleDurable, lost_to_power).contains(&"sample"));
}

#[test]
fn a_disk_that_fails_holds_the_rig_and_nothing_more_is_sent() {
    let plan = plan();
    let healthy = recorded(&plan).0.0.borrow().carried_out.len();
    let mut stopped = 0;
    for failed_sync in 6..60 {
        let disk = SickDisk::new(Sickness {
            failed_sync: Some(failed_sync),
            ..Sickness::default()
        });
        let mut rig = Standing::new(&plan);
        let mut journal = journal(disk.clone());
        begin(&mut journal, &header(), &[]).unwrap();
        let recorded = record(&plan, &mut rig, &mut Witness, journal, no_wall());
        assert!(
            matches!(&recorded.record.outcome, Outcome::Faulted { reason } if reason.contains("cannot be kept"))
        );
        assert!(recorded.fault.is_some());
        let carried_out = rig.0.borrow().carried_out.len();
        let known = recover(&disk.written())
            .unwrap()
            .lines
            .iter()
            .filter(|line| line.kind == EntryKind::Intent)
            .count();
        assert!(
            carried_out <= known && carried_out < healthy,
            "{carried_out} of {known}"
        );
        assert_eq!(
            replay(&plan, played(&disk.written()).1).mismatch,
            None,
            "sync {failed_sync}: its last words end it again"
        );
        stopped += 1;
    }
    assert_eq!(stopped, 54);
}

#[test]
fn what_a_person_said_has_its_time_of_day_and_plays_back_without_a_clock() {
    let (plan, disk) = (plan(), PowerLoss::new());
    let mut journal = journal(disk.clone());
    begin(&mut journal, &header(), &["text".to_owned()]).unwrap();
    let wall: Wall = Box::new(|| Some("2026-05-31T10:00:00.000Z".to_owned()));
    let whole = record(
        &plan,
        &mut Standing::new(&plan),
        &mut Witness,
        journal,
        wall,
    );
    let (recovered, played) = played(&disk.written());
    let said: Vec<_> = recovered
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Operator)
        .collect();
    assert!(
        said.len() > 2
            && said
                .iter()
                .all(|line| line.body()["wall"] == "2026-05-31T10:00:00.000Z"),
        "{said:?}"
    );
    agrees(&recovered, &played, &plan).unwrap();
    let replayed = replay(&plan, played);
    assert_eq!(
        (replayed.mismatch, format!("{:?}", replayed.record)),
        (None, format!("{:?}", whole.record))
    );
}

#[test]
fn what_cannot_be_gone_on_with_is_known_without_a_rig() {
    let plan = plan();
    let (_, _, bytes) = recorded(&plan);
    let (mut recovered, _) = played(&bytes);
    recovered.lines.pop();
    recovered.ended = false;
    let steps = recovered
        .lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent)
        .unwrap();
    recovered.lines.truncate(steps);
    let cut_off = Played::of(&recovered).unwrap();
    let rehearse = |plan: &Plan| {
        let mut opened = false;
        let open = || {
            opened = true;
            Err(Refusal::NothingRecorded)
        };
        let refused = resume(plan, &cut_off, &mut Unwatched, no_wall(), open).err();
        (refused.unwrap(), opened)
    };
    assert_eq!(
        rehearse(&plan),
        (Refusal::NothingRecorded, true),
        "what the rig's opening says"
    );

    let mut other = plan.clone();
    if let ProcedureKind::StiffnessRamp(ramp) = &mut other.procedures[0].kind {
        ramp.displacements[0] = crate::plan::formula::Formula::Constant(5e-5);
    }
    assert!(
        matches!(rehearse(&other), (Refusal::Otherwise(_), false)),
        "another target than the recorded one"
    );
    let mut shorter = plan.clone();
    shorter.procedures.truncate(1);
    assert!(
        matches!(rehearse(&shorter), (Refusal::Otherwise(_), false)),
        "the record goes on beyond the plan"
    );
    let mut narrow = plan.clone();
    narrow.limits.displacement.high = 1e-6;
    assert!(
        matches!(
            rehearse(&narrow),
            (Refusal::EndsAgain { .. } | Refusal::Otherwise(_), false)
        ),
        "a limit that it is past already"
    );

    let mut turned = plan.rig.clone();
    same_measure(&plan.rig, &turned).unwrap();
    turned.sign = -turned.sign;
    assert_eq!(
        same_measure(&plan.rig, &turned),
        Err(Refusal::OtherMeasure { what: "sign" })
    );

    let fine = DeclaredNoise {
        force: 1.0,
        resolution: 1e-6,
    };
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
    let was = Standing::new(&plan).identity();
    let is = Identity {
        firmware: "2.0".to_owned(),
        ..was.clone()
    };
    assert!(matches!(
        same_rig(&was, &is, &[Assurance::SamePowerUp]),
        Err(Refusal::OtherFirmware { .. })
    ));
    same_rig(&was, &is, &[Assurance::ReReferenced]).unwrap();
}
