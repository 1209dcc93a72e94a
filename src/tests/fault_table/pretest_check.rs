//! Errors that the pre-test check finds before the first step: polarity, unit, scale, offset, a dead sensor, zero drift. In: runs on rigs
//! with such an error from the start. Out: only the small move of the check is made.

use super::stage::{Ended, plan, run, run_without};
use psd_plan::record::{EventKind, Outcome};
use psd_rig::safety::failpoint::Guarding;

/// The pre-test check refuses the rig; no procedure of the plan was started.
fn refused(script: &str, why: &str, most_moves: usize) {
    let ended = run(&plan(), script);
    let Outcome::Faulted { reason } = &ended.record.outcome else {
        panic!("{script}: {:?}", ended.record.outcome)
    };
    assert!(
        reason.contains("did not pass the pre-test check") && reason.contains(why),
        "{script}: {reason}"
    );
    let emulator = ended.emulator.lock();
    assert!(
        ended.record.procedures.is_empty() && emulator.rig().moves().len() <= most_moves,
        "{script}"
    );
    assert!(
        emulator
            .rig()
            .targets()
            .iter()
            .all(|target| target.abs() <= 5.1e-5)
            && !emulator.rig().moving()
    );
    assert!(ended.log.contains("actuator > !"), "{script}: held");
}

#[test]
fn a_wrong_sign_unit_or_scale_is_refused_before_the_first_step() {
    refused("at 0 s: scale force by -1", "opposite polarity", 2);
    // kN instead of N, a factor of one hundred, kg instead of N, a dead cell.
    for scale in ["0.001", "100", "9.80665", "0"] {
        refused(
            &format!("at 0 s: scale force by {scale}"),
            "check unit and scale",
            2,
        );
    }
    // N instead of kN exceeds the range of the cell.
    let saturated = run(&plan(), "at 0 s: scale force by 1000");
    saturated.held();
    assert!(!past(&saturated));
}

#[test]
fn a_displacement_in_another_unit_never_gets_past_the_probe() {
    for scale in ["25.4", "0.03937", "1000", "-1"] {
        let ended = run(&plan(), &format!("at 0 s: scale displacement by {scale}"));
        ended.held();
        assert!(!past(&ended), "{scale}: {}", ended.reason());
        assert_eq!(
            ended.emulator.lock().rig().moves().len(),
            1,
            "{scale}: stopped at the first move, for it is not where it should be"
        );
    }
}

#[test]
fn an_offset_is_refused_and_nothing_moves() {
    // 6 N after the first second; 5 N are allowed.
    let offset = "at 0 s: drift force 6 N/s";
    refused(offset, "at rest", 0);
    assert!(past(&run_without(Guarding::PretestZero, &plan(), offset)));
}

#[test]
fn without_its_guards_the_pretest_check_lets_them_through() {
    let mirrored = "at 0 s: scale force by -1";
    let mut wide = plan();
    super::stage::link(&mut wide).pretest_check.stiffness.low = f64::NEG_INFINITY;
    assert!(
        !past(&run(&wide, mirrored))
            && past(&run_without(Guarding::PretestPolarity, &wide, mirrored))
    );
    let small = "at 0 s: scale force by 0.001";
    assert!(past(&run_without(
        Guarding::PretestStiffness,
        &plan(),
        small
    )));
}

/// Whether the plan's own procedures began.
fn past(ended: &Ended) -> bool {
    !ended.record.procedures.is_empty()
}

#[test]
fn the_drift_at_rest_is_reported() {
    let ended = run(&plan(), "at 0 s: drift force 0.5 N/s");
    let notes = ended.events(EventKind::Note);
    let pretest_check = notes
        .iter()
        .find(|note| note.starts_with("pre-test check passed"))
        .unwrap();
    assert!(
        pretest_check.contains("drift 0.5") || pretest_check.contains("drift 500 mN"),
        "{pretest_check}"
    );
}
