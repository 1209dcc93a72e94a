//! A run that is killed at every write and every sync is resumed to the same end, and no target is executed twice.

use super::*;
use psd_plan::Interval;

#[test]
fn killed_at_every_write_and_every_sync_it_goes_on_to_the_same_end() {
    killed_everywhere(&plan(), 200);
}

/// An impact on a storey: targets and readings of two axes.
#[test]
fn killed_at_every_write_an_impact_on_a_storey_resumes_to_the_same_end() {
    killed_everywhere(&struck_frame(), 60);
}

/// Kills the run at every disk call, before and after the bytes are written, and resumes it each time: more often than `least`.
pub(super) fn killed_everywhere(plan: &Plan, least: usize) {
    let (whole_rig, whole, _) = recorded(plan);
    assert_eq!(
        whole.record.outcome,
        Outcome::Completed,
        "{:?}",
        whole.record.events
    );
    let once = whole_rig.0.borrow().carried_out.clone();
    let (mut kills, mut before) = (0, None);
    for call in 4.. {
        for after in [false, true] {
            let (rig, disk) = (RestingRig::new(plan), PowerLoss::new());
            let storage = Killed::at(&disk, call, after);
            let ended = catch_unwind(AssertUnwindSafe(|| {
                let mut journal = journal(storage);
                begin(&mut journal, &header(plan), &["text".to_owned()]).unwrap();
                record(plan, &mut rig.clone(), &mut Witness, journal, no_wall())
            }));
            if ended.is_ok() {
                assert!(kills > least, "{kills}");
                return;
            }
            kills += 1;
            // Between a write and its sync nothing happens: the next program finds the same bytes and the same rig as at the kill before.
            let left = Some((disk.written(), rig.0.borrow().calls));
            if left == before {
                continue;
            }
            before = left;
            go_on_and_compare(plan, rig, &disk, &measured(&whole.record), &once, call);
        }
    }
}

/// A killed program leaves all bytes that it wrote: the operating system keeps them.
fn go_on_and_compare(
    plan: &Plan,
    mut rig: RestingRig,
    disk: &PowerLoss,
    expected: &str,
    once: &[Vec<f64>],
    call: usize,
) {
    let (recovered, before) = logged(&disk.written());
    if before.ended {
        return;
    }
    rig.hold();
    let found = rig.read().unwrap();
    let axes = found.displacement.len();
    let bands = Bands {
        displacement: vec![1e-9; axes],
        axial: 0,
        force: vec![1e-6; axes],
        stiffness: vec![Interval::ALL; axes],
    };
    let about = RigBody::of(&rig);
    let decision = match decide(&before, &about, &found, &bands, false) {
        Err(ResumeRefusal::NothingRecorded) => {
            return assert!(rig.0.borrow().carried_out.is_empty());
        }
        other => other.unwrap_or_else(|refusal| panic!("call {call}: {refusal}")),
    };
    let resumption = decision.resumption("A. Witness", "power", &found, before.time);
    let mut journal = Journal::reopen(
        Box::new(disk.clone()),
        Durability::EverySyncPoint,
        &recovered,
    );
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
    let (_, again) = logged(&disk.written());
    let mut followed = Followed::default();
    let steps = Rc::clone(&followed.steps);
    let goes_on = || {
        steps.borrow_mut().push(None);
        Ok::<_, ResumeRefusal>(Continuation {
            rig: &mut rig,
            journal,
            logged: again,
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
    let recovered_events = resumed
        .record
        .events
        .iter()
        .find(|event| event.kind == EventKind::Recovered)
        .map(|event| event.text.clone());
    let both = Some(before.line_statistics.plus(rig.line_statistics()))
        .filter(|line_statistics| *line_statistics != LineStatistics::default());
    assert_eq!(
        recovered_events,
        both.map(|line_statistics| line_statistics.to_string()),
        "call {call}: earlier recoveries count too"
    );
    let carried_out = rig.0.borrow().carried_out.clone();
    if matches!(resumption.target_status, TargetStatus::Stroke { .. }) {
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
    // The run log of both parts together is a run that can be replayed.
    let (recovered, whole) = logged(&disk.written());
    assert_eq!(
        check_consistency(&recovered, &whole, plan),
        Ok(()),
        "call {call}"
    );
    let replayed = replay(plan, whole);
    assert_eq!(replayed.mismatch, None, "call {call}");
    assert_eq!(
        format!("{:?}", replayed.record),
        format!("{:?}", resumed.record),
        "call {call}"
    );
}
