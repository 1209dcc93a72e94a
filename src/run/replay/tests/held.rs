//! The final hold is in the run log, and the replay reproduces it. A run is not continued if the rig was moved or released after the
//! hold.

use std::cell::Cell;

use super::*;
use super::{RestingRig, Witness, logged};
use crate::run::session::Session;
use crate::run::{Inspection, Motion};
use crate::tests::testing::{elastic_plan, header, ramp};
use psd_plan::formula::Formula;
use psd_plan::record::EventKind;
use psd_plan::{Interval, Move, Plan, ProcedureKind};
use psd_rig::journal::Durability;
use psd_rig::{EncodedMove, FinalHold, Identity, RigFault};
use psd_testing::forwarded;
use psd_testing::journal::AlterEntry as _;
use psd_testing::journal::PowerLoss;

/// The operator stops the rig on the path to a target, at 40 % of the path.
struct HeldDuringMotion {
    rig: RestingRig,
    target: f64,
    moves: u32,
    /// Whether the rig confirms that it holds.
    heard: bool,
    /// For a real rig that is held during an inspection, after the operator was asked to inspect.
    at_a_look: Option<Rc<Cell<bool>>>,
}

impl Rig for HeldDuringMotion {
    forwarded!(rig: time, read, traverse, follow_paths, hold, declared_noise);

    fn identity(&self) -> Identity {
        Identity {
            simulated: self.at_a_look.is_none(),
            ..self.rig.identity()
        }
    }
    fn degrees_of_freedom(&self) -> usize {
        1
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        self.target = targets[0];
        self.rig.propose(targets, speed)
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        self.moves += 1;
        if self.moves == 3 && self.at_a_look.is_none() {
            Err(RigFault::Interrupted)
        } else {
            self.rig.execute()
        }
    }
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        let held = self.at_a_look.as_ref().is_some_and(|looks| looks.get());
        if held {
            Err(RigFault::Interrupted)
        } else {
            self.rig.pause(seconds)
        }
    }
    fn halt(&mut self) -> Option<FinalHold> {
        let unconfirmed = (!self.heard).then(|| "connection lost".to_owned());
        let found = self.heard.then(|| (vec![position()], vec![force()]));
        Some(FinalHold {
            time: self.time() + 0.25,
            unconfirmed,
            found,
            raw: Vec::new(),
        })
    }
}

/// A position between the second and the third target of the ramp \[m\]; below, its force \[N\].
fn position() -> f64 {
    2.4e-4
}

fn force() -> f64 {
    300.0 * position()
}

fn plan() -> Plan {
    elastic_plan(300.0, vec![ProcedureKind::StiffnessRamp(ramp(1e-4))])
}

/// The run and the run log after the operator stopped the rig there.
fn held(heard: bool) -> (Recorded, Vec<u8>) {
    let (plan, disk) = (plan(), PowerLoss::new());
    let mut rig = HeldDuringMotion {
        rig: RestingRig::new(&plan),
        target: 0.0,
        moves: 0,
        heard,
        at_a_look: None,
    };
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
    let recorded = record(&plan, &mut rig, &mut Witness, journal, Box::new(|| None));
    (recorded, disk.written())
}

#[test]
fn what_became_of_the_rig_plays_back() {
    for (heard, kind, text) in [
        (true, EventKind::Held, "HELD at 0.2400 mm, 0.07200 N"),
        (
            false,
            EventKind::NotHeld,
            "NOT CONFIRMED HELD (connection lost): IT MAY STILL BE MOVING. Press the emergency stop",
        ),
    ] {
        let (recorded, bytes) = held(heard);
        let last = recorded.record.events.last().unwrap();
        assert_eq!((last.kind, last.text.as_str()), (kind, text));
        let (lines, again) = logged(&bytes);
        assert_eq!(
            lines
                .lines
                .iter()
                .filter(|line| line.kind == EntryKind::Held)
                .count(),
            1
        );
        let replayed = replay(&plan(), again);
        assert_eq!(replayed.mismatch, None);
        assert_eq!(replayed.record.events, recorded.record.events, "times too");
        assert_eq!(replayed.record.outcome, recorded.record.outcome);
    }
}

/// Inspects, and has not decided yet.
struct Looking(Rc<Cell<bool>>);

impl Observer for Looking {
    fn inspect(&mut self, _: &str) -> Inspection {
        self.0.set(true);
        Inspection::Wait
    }
}

#[test]
fn a_hold_at_a_look_behind_a_step_is_played_back_as_one_at_the_look() {
    let to = Move {
        to: Formula::Constant(1e-4),
        speed: None,
    };
    let look = ProcedureKind::Inspect {
        note: "look".to_owned(),
    };
    let (plan, disk) = (
        elastic_plan(300.0, vec![ProcedureKind::Move(to), look]),
        PowerLoss::new(),
    );
    let looks = Rc::new(Cell::new(false));
    let at_a_look = Some(Rc::clone(&looks));
    let mut rig = HeldDuringMotion {
        rig: RestingRig::new(&plan),
        target: 0.0,
        moves: 0,
        heard: true,
        at_a_look,
    };
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
    let recorded = record(
        &plan,
        &mut rig,
        &mut Looking(looks),
        journal,
        Box::new(|| None),
    );
    assert!(
        matches!(recorded.record.outcome, Outcome::Aborted { .. }),
        "{:?}",
        recorded.record.outcome
    );
    let stop = &recorded.record.events[recorded.record.events.len() - 2];
    assert_eq!(stop.text, "stopped on request", "no move was in progress");
    let replayed = replay(&plan, logged(&disk.written()).1);
    assert_eq!(replayed.mismatch, None);
    assert_eq!(replayed.record.events, recorded.record.events);
}

#[test]
fn a_hold_requested_while_a_release_is_asked_releases_nothing() {
    let (plan, looks) = (
        elastic_plan(300.0, vec![ProcedureKind::StiffnessRamp(ramp(1e-4))]),
        Rc::new(Cell::new(false)),
    );
    let mut rig = HeldDuringMotion {
        rig: RestingRig::new(&plan),
        target: 0.0,
        moves: 0,
        heard: true,
        at_a_look: Some(Rc::clone(&looks)),
    };
    let mut observer = Looking(looks);
    let Ok(mut session) = Session::begin(&plan, &mut rig, &mut observer) else {
        panic!("the session begins")
    };
    let motion = Motion::of(&plan, session.identity(), "it moves".to_owned());
    let stop = session.release("release", &motion).unwrap_err();
    let reason = "stopped on request".to_owned();
    assert_eq!(stop.outcome(), Outcome::NotReleased { reason });
}

/// The resume decision for a rig that is found with this displacement and this force.
fn decided(
    heard: bool,
    displacement: f64,
    force: f64,
    accept: bool,
) -> Result<ResumeDecision, ResumeRefusal> {
    let (_, bytes) = held(heard);
    decided_of(&logged(&bytes).1, displacement, force, accept)
}

fn decided_of(
    logged: &LoggedRun,
    displacement: f64,
    force: f64,
    accept: bool,
) -> Result<ResumeDecision, ResumeRefusal> {
    let rig = RestingRig::new(&plan());
    let about = RigBody {
        last_move: None,
        ..RigBody::of(&rig)
    };
    let found = Reading {
        time: 0.0,
        displacement: vec![displacement],
        force: vec![force],
        raw: Vec::new(),
    };
    let bands = Bands {
        displacement: vec![1e-6],
        axial: 0,
        force: vec![1e-3],
        stiffness: vec![Interval {
            low: 300.0,
            high: 300.0,
        }],
    };
    decide(logged, &about, &found, &bands, accept)
}

#[test]
fn a_rig_where_it_was_held_is_sent_to_its_target_again() {
    let decision = decided(true, position(), force(), false).unwrap();
    assert_eq!(
        (&decision.target_status, decision.held.clone()),
        (
            &TargetStatus::HeldDuringMotion,
            Some((vec![position()], vec![force()]))
        )
    );
    let (to, speed) = decision.sends.clone().unwrap();
    assert!((to[0] - 3e-4).abs() < 1e-12 && speed > 0.0, "{to:?}");
    let found = Reading {
        time: 0.0,
        displacement: vec![position()],
        force: vec![force()],
        raw: Vec::new(),
    };
    let resumption = decision.resumption("A", "so", &found, 1.0);
    assert_eq!(resumption.held, Some((vec![position()], vec![force()])));
}

#[test]
fn a_rig_that_was_moved_or_let_go_of_since_is_refused() {
    // Each of them lies between the start and the target of the move.
    for elsewhere in [2.1e-4, 2.9e-4] {
        let refused = decided(true, elsewhere, 300.0 * elsewhere, true);
        assert!(
            matches!(refused, Err(ResumeRefusal::Elsewhere { .. })),
            "{refused:?}"
        );
    }
    assert!(
        matches!(
            decided(true, position(), 0.0, false),
            Err(ResumeRefusal::Relaxed { .. })
        ),
        "the specimen was taken out"
    );
    assert!(
        decided(true, position(), 0.0, true).is_ok(),
        "an operator is responsible for the force"
    );
}

/// psd was killed right after the resumption: the target went out again from where the rig was found, and the rig does not go back.
#[test]
fn a_target_that_was_sent_again_began_where_the_rig_was_found() {
    let (_, bytes) = held(false);
    let (_, mut logged) = logged(&bytes);
    let found = |displacement: f64| Reading {
        time: 0.0,
        displacement: vec![displacement],
        force: vec![300.0 * displacement],
        raw: Vec::new(),
    };
    let decision = decided_of(&logged, 2.5e-4, 300.0 * 2.5e-4, false).unwrap();
    assert_eq!(decision.target_status, TargetStatus::HeldDuringMotion);
    logged.resumed(decision.resumption("A", "so", &found(2.5e-4), 1.0));
    for (displacement, allowed) in [
        (2.5e-4, true),
        (2.7e-4, true),
        (3e-4, true),
        (2.1e-4, false),
    ] {
        let decided = decided_of(&logged, displacement, 300.0 * displacement, true);
        let refused = matches!(decided, Err(ResumeRefusal::Lost { .. }));
        assert_eq!(
            (decided.is_ok(), refused),
            (allowed, !allowed),
            "{displacement}"
        );
    }
}

/// The position at rest is not known: the run log ends with the target, and the last reading was made before it.
#[test]
fn the_force_is_compared_whatever_became_of_the_last_target() {
    for (displacement, status) in [
        (2e-4, TargetStatus::NotExecuted),
        (2.1e-4, TargetStatus::HeldDuringMotion),
        (3e-4, TargetStatus::Executed),
    ] {
        let elastic = 300.0 * displacement;
        let decision = decided(false, displacement, elastic, false).unwrap();
        assert_eq!((&decision.target_status, decision.held), (&status, None));
        // 2 mN from the elastic force, beyond the band of 1 mN, or no force: another specimen, or none.
        for force in [elastic - 2e-3, elastic + 2e-3, 0.0] {
            let refused = decided(false, displacement, force, false);
            assert!(
                matches!(refused, Err(ResumeRefusal::Relaxed { .. })),
                "{status:?}: {refused:?}"
            );
            assert!(decided(false, displacement, force, true).is_ok());
            let unguarded = without(Guarding::ForceFound, || {
                decided(false, displacement, force, false)
            });
            assert!(unguarded.is_ok(), "nothing else sees it");
        }
    }
}

#[test]
fn a_specimen_that_yielded_may_go_on_along_its_tangent_and_lose_nothing() {
    let (_, bytes) = held(false);
    let (mut recovered, _) = logged(&bytes);
    // The last readings: 0.03 N at 0.1 mm, and as much at 0.2 mm.
    for line in &mut recovered.lines {
        if line.kind == EntryKind::Sample && line.body()["r"][0].as_f64().unwrap() > 0.03 {
            line.alter(|body| body["r"][0] = serde_json::json!(0.03));
        }
    }
    let logged = LoggedRun::of(&recovered).unwrap();
    let decided = |force| decided_of(&logged, 3e-4, force, false);
    // From 0.2 mm to 0.3 mm the force may stay, or grow by 300 N/m: 0.03 N .. 0.06 N, each ± 1 mN.
    for (force, fits) in [(0.03, true), (0.06, true), (0.028, false), (0.062, false)] {
        assert_eq!(decided(force).is_ok(), fits, "{force} N");
    }
}
