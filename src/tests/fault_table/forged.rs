//! Changes that a forger who knows the format makes in the run log of a real rig. Each is detected by a check. Times and numbers of
//! targets are compared with the earlier ones. Readings are compared with their replies, and END with the end of the replay.

use serde_json::{Value, json};

use super::axes::two_axes::base_excited_plan;
use super::stage::{Ended, link, plan, run};
use crate::run::replay;
use crate::run::replay::LoggedRun;
use psd_plan::Plan;
use psd_rig::journal::{EntryKind, Recovered};
use psd_testing::journal::AlterEntry as _;

/// Alters the `nth` entry of a kind in the run log, and returns the first finding of `psd verify`.
pub(super) fn found(
    plan: &Plan,
    ended: &Ended,
    kind: EntryKind,
    nth: usize,
    alter: impl Fn(&mut Value),
) -> Result<(), String> {
    let mut forged = ended.recovered.clone();
    let line = forged
        .lines
        .iter_mut()
        .filter(|line| line.kind == kind)
        .nth(nth)
        .unwrap();
    line.alter(alter);
    judged(plan, &forged)
}

pub(super) fn judged(plan: &Plan, forged: &Recovered) -> Result<(), String> {
    let logged_run = LoggedRun::of(forged).map_err(|fault| fault.to_string())?;
    replay::check_consistency(forged, &logged_run, plan).map_err(|fault| fault.to_string())?;
    let replayed = replay::replay(plan, logged_run);
    replayed
        .mismatch
        .map_or(Ok(()), |mismatch| Err(mismatch.to_string()))
}

#[test]
fn a_contradictory_record_is_found() {
    for plan in [plan(), base_excited_plan("50 ms")] {
        let ended = run(&plan, "");
        assert!(ended.completed());
        assert_eq!(judged(&plan, &ended.recovered), Ok(()));
        let cases: [(EntryKind, usize, &str, Value, &str); 7] = [
            (EntryKind::Intent, 3, "/n", json!(9), "it is target 4"),
            (EntryKind::Intent, 3, "/t", json!(0.001), "the entry before"),
            (
                EntryKind::Sample,
                3,
                "/x/0",
                json!(0.123),
                "the replies in its `raw`",
            ),
            (
                EntryKind::Sample,
                3,
                "/r/0",
                json!(0.123),
                "the replies in its `raw`",
            ),
            (EntryKind::Sample, 9, "/t", json!(0.001), "the entry before"),
            (EntryKind::End, 0, "/outcome", json!("aborted"), "aborted"),
            (EntryKind::Header, 0, "/psd", json!(7), "invalid type"),
        ];
        for (kind, nth, pointer, value, why) in cases {
            let alter =
                |body: &mut Value| *body.pointer_mut(pointer).expect(pointer) = value.clone();
            let fault = found(&plan, &ended, kind, nth, alter).expect_err(pointer);
            assert!(fault.contains(why), "{kind:?} {pointer}: {fault}");
        }
    }
}

#[test]
fn a_field_that_psd_does_not_write_is_found_in_every_record() {
    let plan = plan();
    let ended = run(&plan, "");
    let kinds = EntryKind::ALL
        .into_iter()
        .filter(|kind| ended.count(*kind) > 0);
    for kind in kinds.clone() {
        let fault =
            found(&plan, &ended, kind, 0, |body| body["zzz"] = json!(5)).expect_err(kind.word());
        assert!(fault.contains("`zzz`"), "{fault}");
    }
    assert!(kinds.count() >= 8);
}

#[test]
fn a_line_removed_from_a_completed_record_is_missed() {
    let mut plan = plan();
    link(&mut plan).pretest_check.zero = 5.0;
    let ended = run(&plan, "");
    let of_kind = |kind| {
        ended
            .recovered
            .lines
            .iter()
            .rposition(|line| line.kind == kind)
    };
    for kind in [
        EntryKind::Event,
        EntryKind::Step,
        EntryKind::Sample,
        EntryKind::Intent,
    ] {
        let mut forged = ended.recovered.clone();
        forged.lines.remove(of_kind(kind).unwrap());
        assert!(judged(&plan, &forged).is_err(), "{kind:?}");
    }
    // All entries from the last event on, except END.
    let mut forged = ended.recovered.clone();
    let end = forged.lines.pop().unwrap();
    forged.lines.truncate(of_kind(EntryKind::Step).unwrap());
    forged.lines.push(end);
    assert!(judged(&plan, &forged).is_err());
}
