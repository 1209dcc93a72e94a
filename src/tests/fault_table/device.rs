//! Invalid readings of a device: invalid numbers, saturation, a frozen sensor, spikes, a restart. In: runs with such a device. Out: no
//! such reading is integrated.

use super::stage::{STIFFNESS, link, plan, run, run_without};
use psd_plan::Interval;
use psd_plan::record::Outcome;
use psd_rig::journal::EntryKind;
use psd_rig::safety::failpoint::Guarding;

#[test]
fn what_is_no_number_is_never_integrated() {
    let words = [
        "NaN", "inf", "-inf", "1e400", "9.91E37", "OVL", "\"\"", "1,5", "--1", "5.", ".5", "0x10",
        "+", "1.5.2",
    ];
    for word in words {
        let bad = |reading: u32| format!("after {reading} readings: number {word}\n");
        let kept = (20..26).filter(|reading| {
            let once = run(&plan(), &bad(*reading));
            once.sound();
            assert_eq!(once.line_statistics.reread, 1, "{word}");
            let bytes = format!(" {} ", word.trim_matches('"'));
            let samples = once
                .lines
                .iter()
                .filter(|line| line.kind == EntryKind::Sample);
            samples
                .filter(|line| line.body()["raw"].to_string().contains(&bytes))
                .count()
                == 1
        });
        assert!(
            kept.count() > 0,
            "the bytes of {word} are on record where they came in a reading that counts"
        );
        let always = run(&plan(), &(20..60).map(bad).collect::<String>());
        always.held();
        assert!(
            matches!(always.record.outcome, Outcome::Faulted { .. }),
            "{word}: {}",
            always.reason()
        );
        assert_eq!(always.line_statistics.reread, 3, "{word}");
    }
    // If no other limit applies, a value that is not checked as a number enters the run log.
    let mut unbounded = plan();
    link(&mut unbounded).readings.force_range = Interval::ALL;
    link(&mut unbounded).readings.samples = 1;
    unbounded.limits.force = Interval::ALL;
    let integrated = |reading: u32| {
        let bad = format!("after {reading} readings: number 9.91E37");
        run(&unbounded, &bad).sound();
        let missed = run_without(Guarding::Invalid, &unbounded, &bad);
        missed.lines.iter().any(|line| {
            line.kind == EntryKind::Sample && line.body()["r"][0].as_f64() == Some(9.91e37)
        })
    };
    assert!((20..32).any(integrated));
}

#[test]
fn a_clipped_force_holds_the_rig() {
    let mut plan = plan();
    link(&mut plan).readings.force_range = Interval {
        low: -60.0,
        high: 60.0,
    };
    // A saturated force also looks frozen, which is a different guard.
    link(&mut plan).readings.frozen_after = 1000;
    let clipped = run(&plan, "at 0 s: clip force at 60 N");
    clipped.held();
    assert!(
        matches!(&clipped.record.outcome, Outcome::Faulted { reason } if reason.contains("saturated")),
        "{}",
        clipped.reason()
    );
    assert!(clipped.forces().iter().all(|(_, force)| *force < 59.9));
    let missed = run_without(Guarding::Saturation, &plan, "at 0 s: clip force at 60 N");
    assert!(missed.completed() && (missed.forces().last().unwrap().1 - 60.0).abs() < 1e-9);
}

#[test]
fn a_frozen_sensor_holds_the_rig() {
    let frozen = run(&plan(), "after 60 readings: freeze force");
    frozen.held();
    assert!(
        frozen.reason().contains("the force sensor is frozen"),
        "{}",
        frozen.reason()
    );
    let missed = run_without(Guarding::Frozen, &plan(), "after 60 readings: freeze force");
    let (command, force) = *missed.forces().last().unwrap();
    assert!(missed.completed() && force < 0.9 * STIFFNESS * command);
}

#[test]
fn a_spike_does_not_move_the_median() {
    let spikes = "each reading: spike 400 N with 0.05";
    let ended = run(&plan(), spikes);
    ended.sound();
    let raw = ended
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Sample);
    assert!(
        raw.map(|line| line.body()["raw"].as_array().unwrap().len())
            .all(|count| count >= 3),
        "all three are on record"
    );
    let moved = run_without(Guarding::Median, &plan(), spikes);
    let spoilt = moved
        .forces()
        .iter()
        .filter(|(command, force)| (force - STIFFNESS * command).abs() > 100.0)
        .count();
    assert!(spoilt > 0 || !moved.completed());
}

#[test]
fn a_rig_that_restarts_is_held_and_not_moved_any_more() {
    let ended = run(&plan(), "after 4 moves: reboot");
    ended.held();
    assert!(
        matches!(ended.record.outcome, Outcome::Faulted { .. }) && !ended.trusted,
        "{}",
        ended.reason()
    );
    assert!(ended.reason().contains("restarted"), "{}", ended.reason());
    assert_eq!(ended.emulator.lock().rig().moves().len(), 4);
}
