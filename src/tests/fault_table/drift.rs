//! Zero drift of a load cell or a displacement transducer, for example during warm-up. In: runs on rigs that state the allowed zero
//! drift. Out: a run with more zero drift is completed, and no statement of conformity uses its readings.

use super::stage::{Ended, STIFFNESS, plan, plan_of, run, run_without, to};
use crate::tests::testing::ramp;
use crate::verdict::{Assessment, Verdict, assess};
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference};
use psd_plan::record::EventKind;
use psd_plan::{
    Comparison, Condition, DriftCheck, Plan, ProcedureKind, Requirement, StiffnessRamp, Test,
    ZeroAfter,
};
use psd_rig::safety::failpoint::{Guarding, without};
use psd_text::units::Dimension;

/// A ramp with pauses of 2 s, with requirements on its stiffness and its displacement.
fn drifting(check: DriftCheck) -> Plan {
    let slow = StiffnessRamp {
        pause: Formula::Constant(2.0),
        ..ramp(1e-4)
    };
    let mut plan = plan_of(vec![ProcedureKind::StiffnessRamp(slow)]);
    plan.rig.zero_drift = Some(check);
    let above = |name, limit, dimension| Requirement {
        label: String::new(),
        conditions: vec![Condition {
            text: String::new(),
            value: Formula::Result(ResultReference {
                procedure: ProcedureId(0),
                name,
                part: ResultPart::Value,
            }),
            test: Test::Compare {
                comparison: Comparison::Greater,
                limit: Formula::Constant(limit),
            },
            dimension,
        }],
    };
    plan.requirements = vec![
        above("stiffness", 0.5 * STIFFNESS, Dimension::STIFFNESS),
        above("max_displacement", 5e-4, Dimension::LENGTH),
    ];
    plan
}

const CHECK: DriftCheck = DriftCheck {
    force: 2.0,
    displacement: Some(3e-6),
    over: 1.0,
    after: ZeroAfter::Start,
};

/// The verdicts on stiffness, displacement and run; and the reason why the first is inconclusive.
fn decided(plan: &Plan, ended: &Ended) -> ([Verdict; 3], String) {
    assert!(ended.completed(), "{}", ended.reason());
    let Assessment {
        verdict,
        requirements,
        ..
    } = assess(plan, &ended.record);
    let reason = requirements[0].conditions[0]
        .reason
        .clone()
        .unwrap_or_default();
    (
        [requirements[0].verdict, requirements[1].verdict, verdict],
        reason,
    )
}

const SOUND: [Verdict; 3] = [Verdict::Pass; 3];

#[test]
fn a_zero_that_drifts_too_far_decides_nothing_that_the_force_enters() {
    let plan = drifting(CHECK);
    let warming = "after 20 readings: drift force 0.3 N/s";
    let ended = run(&plan, warming);
    let (verdicts, reason) = decided(&plan, &ended);
    assert_eq!(
        verdicts,
        [Verdict::Inconclusive, Verdict::Pass, Verdict::Inconclusive],
        "{reason}"
    );
    assert!(
        reason.starts_with("the zero of the force drifted by") && reason.ends_with("(limit 2 N)"),
        "{reason}"
    );
    let drift = ended.record.drift.as_ref().unwrap();
    let after = drift.axes[0].after.unwrap();
    assert!((after.force_slope - 0.3).abs() < 0.01, "{after:?}");
    assert!(
        (drift.held.slopes[0].0 - 0.3).abs() < 0.01 && drift.held.count >= 9,
        "{:?}",
        drift.held
    );
    assert!(
        ended
            .events(EventKind::Note)
            .iter()
            .any(|note| note.starts_with("zero after the test: "))
    );
    let without = without(Guarding::ZeroDrift, || decided(&plan, &ended));
    assert_eq!(without.0, SOUND, "it is this guard that holds it up");
    // Back at the start position, unloaded.
    assert!(ended.emulator.lock().rig().commanded().abs() < 1e-6);
}

#[test]
fn an_allowed_zero_drift_is_reported_and_verdicts_remain_conclusive() {
    let plan = drifting(CHECK);
    let ended = run(&plan, "after 20 readings: drift force 0.03 N/s");
    assert_eq!(decided(&plan, &ended).0, SOUND);
    let (by, _) = ended.record.drift.as_ref().unwrap().axes[0]
        .change()
        .unwrap();
    assert!(0.5 < by && by < 2.0, "{by} N");
    assert_eq!(decided(&plan, &run(&plan, "")).0, SOUND);
}

#[test]
fn a_transducer_that_drifts_decides_nothing_at_all() {
    let plan = drifting(CHECK);
    let (verdicts, reason) = decided(
        &plan,
        &run(&plan, "after 20 readings: drift displacement 0.0002 mm/s"),
    );
    assert_eq!(verdicts, [Verdict::Inconclusive; 3], "{reason}");
    assert!(
        reason.contains("zero of the displacement drifted"),
        "{reason}"
    );
    let unjudged = drifting(DriftCheck {
        displacement: None,
        ..CHECK
    });
    assert_eq!(
        decided(
            &unjudged,
            &run(
                &unjudged,
                "after 20 readings: drift displacement 0.0002 mm/s"
            )
        )
        .0,
        SOUND
    );
}

/// The zero is not read again. Relaxation in the pauses of a ramp changes the force, and this change is still detected.
#[test]
fn a_force_that_grows_in_a_hold_farther_out_than_ever_is_drift() {
    let plan = drifting(DriftCheck {
        force: 0.5,
        after: ZeroAfter::Nowhere,
        ..CHECK
    });
    let (verdicts, reason) = decided(&plan, &run(&plan, "after 20 readings: drift force 0.4 N/s"));
    assert_eq!(verdicts[0], Verdict::Inconclusive);
    assert!(
        reason.contains("in which a specimen can only relax"),
        "{reason}"
    );
    assert_eq!(
        decided(
            &plan,
            &run(&plan, "after 20 readings: drift force -0.4 N/s")
        )
        .0,
        SOUND,
        "as a specimen that relaxes"
    );
}

#[test]
fn a_drift_at_rest_is_seen_before_anything_is_loaded() {
    let plan = drifting(DriftCheck {
        force: 0.5,
        after: ZeroAfter::Nowhere,
        ..CHECK
    });
    let (verdicts, reason) = decided(&plan, &run(&plan, "at 0 s: drift force -0.6 N/s"));
    assert_eq!(verdicts[0], Verdict::Inconclusive);
    assert!(
        reason.starts_with("at rest the force drifted by"),
        "{reason}"
    );
}

/// The cell is unloaded at the present position, so reading its zero requires no move.
#[test]
fn a_free_cell_is_read_where_it_is() {
    let mut plan = drifting(DriftCheck {
        after: ZeroAfter::Free,
        ..CHECK
    });
    plan.procedures.push(psd_plan::Procedure {
        name: "out".to_owned(),
        kind: to(2e-4),
    });
    let ended = run(&plan, "");
    // The emulator has no operator, so its specimen is still mounted.
    let (verdicts, reason) = decided(&plan, &ended);
    assert!(
        verdicts[0] == Verdict::Inconclusive && reason.contains("drifted by 20"),
        "{reason}"
    );
    assert!((ended.emulator.lock().rig().commanded() - 2e-4).abs() < 1e-6);
    let asked = ended.events(EventKind::Inspection);
    assert!(
        asked.last().unwrap().contains("remove the specimen"),
        "{asked:?}"
    );
}

#[test]
fn a_rig_that_does_not_report_it_is_not_asked() {
    let ended = run_without(Guarding::ZeroDrift, &plan(), "");
    assert!(ended.completed() && ended.record.drift.is_none());
}
