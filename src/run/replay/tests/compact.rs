//! The compact run log: the run that is simulated again is the run, wherever it ended, and another run log is found.

use std::cell::Cell;

use super::procedures::{escalating, shaken, short};
use super::*;
use crate::run::Next;
use psd_plan::formula::Formula::Constant;
use psd_plan::{Impact, Interval, Mode, Until, VirtualLink};
use psd_testing::journal::{records, written};

/// An operator who stops after some questions whether to stop, notes the third step, and answers inspections.
struct Operator {
    left: Cell<usize>,
    steps: u64,
}

impl Operator {
    const fn stopping_after(questions: usize) -> Self {
        Self {
            left: Cell::new(questions),
            steps: 0,
        }
    }
}

impl Observer for Operator {
    fn inspect(&mut self, note: &str) -> Inspection {
        Witness.inspect(note)
    }

    fn step_done(&mut self, _: &StepReport) {
        self.steps += 1;
    }

    fn stop_requested(&self) -> bool {
        let left = self.left.get();
        self.left.set(left.saturating_sub(1));
        left == 0
    }

    fn next(&mut self) -> Next {
        if self.steps == 3 {
            self.steps += 1;
            return Next::Record("a noise".to_owned());
        }
        Next::GoOn
    }
}

fn compact(plan: &Plan) -> Header {
    Header {
        log: LogForm::Compact,
        ..header(plan)
    }
}

/// The run with a compact run log on this storage.
fn simulated(
    plan: &Plan,
    observer: &mut dyn Observer,
    storage: impl Storage + 'static,
) -> Recorded {
    let mut journal = Journal::create(Box::new(storage), Durability::Buffered);
    begin(&mut journal, &compact(plan), &["text".to_owned()]).unwrap();
    record_compactly(plan, &mut *virtual_rig(plan), observer, journal)
}

/// The bytes of the run log of a run that nothing interrupts.
fn run_log(plan: &Plan) -> Vec<u8> {
    let disk = PowerLoss::new();
    simulated(plan, &mut Witness, disk.clone());
    disk.written()
}

/// Simulates the run again, and compares it.
fn repeated(plan: &Plan, bytes: &[u8]) -> Replayed {
    let (recovered, logged) = logged(bytes);
    well_formed(&recovered, plan, &logged.header).unwrap();
    check_consistency(&recovered, &logged, plan).unwrap();
    replay(plan, logged)
}

/// The difference that is found.
fn difference(plan: &Plan, bytes: &[u8]) -> Option<String> {
    let recovered = recover(bytes).unwrap();
    let logged = match LoggedRun::of(&recovered) {
        Ok(logged) => logged,
        Err(unreadable) => return Some(unreadable.to_string()),
    };
    if let Err(malformed) = well_formed(&recovered, plan, &logged.header) {
        return Some(malformed.to_string());
    }
    if let Err(contradiction) = check_consistency(&recovered, &logged, plan) {
        return Some(contradiction.to_string());
    }
    let ended = logged.ended;
    let replayed = replay(plan, logged);
    let completed = replayed.record.outcome == Outcome::Completed;
    let other_end = || (completed != ended).then(|| "the end".to_owned());
    replayed
        .mismatch
        .map(|mismatch| mismatch.to_string())
        .or_else(other_end)
}

fn same(record: &Record, of: &Record, case: &str) {
    assert_eq!(format!("{record:?}"), format!("{of:?}"), "{case}");
}

/// An impact of so many steps.
fn long(steps: f64) -> Plan {
    let impact = Impact {
        duration: Constant(steps * 0.01),
        until: Until::Duration,
        ..short(Mode::RampAndHold)
    };
    elastic_plan(300.0, vec![ProcedureKind::Impact(impact)])
}

fn plans() -> Vec<Plan> {
    let mut noisy = long(30.0);
    noisy.rig.link = psd_plan::Link::Virtual(VirtualLink {
        noise: 0.1,
        resolution: 1e-6,
        lag: 2e-3,
        seed: 7,
        ..VirtualLink::default()
    });
    let mut limited = long(30.0);
    limited.limits.force = Interval {
        low: -10.0,
        high: 10.0,
    };
    let named = procedures::plans().into_iter().map(|(_, plan)| plan);
    named.chain([plan(), noisy, limited]).collect()
}

#[test]
fn simulated_again_it_is_the_same_run_as_with_a_full_run_log() {
    for (index, plan) in plans().iter().enumerate() {
        let case = format!("plan {index}");
        let disk = PowerLoss::new();
        let whole = simulated(plan, &mut Witness, disk.clone());
        let mut full = Journal::create(Box::new(PowerLoss::new()), Durability::Buffered);
        begin(&mut full, &header(plan), &["text".to_owned()]).unwrap();
        let full = record(plan, &mut *virtual_rig(plan), &mut Witness, full, no_wall());
        same(&whole.record, &full.record, &case);
        let again = repeated(plan, &disk.written());
        assert_eq!(again.mismatch, None, "{case}");
        same(&again.record, &whole.record, &case);
        let kinds = [
            EntryKind::Intent,
            EntryKind::Sample,
            EntryKind::Stroke,
            EntryKind::Step,
        ];
        let (recovered, _) = logged(&disk.written());
        assert!(
            recovered
                .lines
                .iter()
                .all(|line| !kinds.contains(&line.kind))
        );
        assert_eq!(
            difference(plan, &disk.written()).is_some(),
            !recovered.ended && whole.record.outcome == Outcome::Completed
        );
    }
}

#[test]
fn a_digest_has_a_thousand_steps_and_the_last_has_the_rest() {
    let plan = long(2500.0);
    let bytes = run_log(&plan);
    let (recovered, _) = logged(&bytes);
    let digests = recovered
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Digest);
    let steps: Vec<_> = digests.map(|line| line.body()["steps"].clone()).collect();
    assert_eq!(steps, [1000, 1000, 500]);
    assert_eq!(number_of_steps(&recovered), (2500, 2500));
    assert!(bytes.len() < 4096, "{} bytes", bytes.len());
    assert_eq!(repeated(&plan, &bytes).mismatch, None);
}

/// The run ends after every question whether to stop, of which each step has one.
#[test]
fn a_run_that_was_stopped_anywhere_is_stopped_there_again() {
    for plan in [plan(), shaken(Mode::RampAndHold), escalating()] {
        let mut stopped = 0;
        loop {
            let disk = PowerLoss::new();
            let mut operator = Operator::stopping_after(stopped);
            let run = simulated(&plan, &mut operator, disk.clone());
            let again = repeated(&plan, &disk.written());
            let case = format!("stopped after {stopped} questions");
            assert_eq!(again.mismatch, None, "{case}");
            same(&again.record, &run.record, &case);
            if run.record.outcome == Outcome::Completed {
                break;
            }
            stopped += 1;
        }
        assert!(stopped > 5, "{stopped}");
    }
}

/// A simulation is not resumed. What it logged until it was killed gives the same incomplete run as a full run log of as many steps.
#[test]
fn of_a_run_that_was_killed_the_logged_part_is_repeated() {
    let plan = long(2500.0);
    let bytes = run_log(&plan);
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::Buffered);
    begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
    record(
        &plan,
        &mut *virtual_rig(&plan),
        &mut Witness,
        journal,
        no_wall(),
    );
    let (entries, full) = (records(&bytes), records(&disk.written()));
    let mut cuts = 0;
    for kept in 1..entries.len() {
        if entries[kept - 1].0 != EntryKind::Digest {
            continue;
        }
        let cut = written(entries[..kept].iter().cloned());
        let (_, steps) = number_of_steps(&logged(&cut).0);
        let mut steps_before = 0;
        let until_step = full.iter().take_while(|(kind, _)| {
            let before = steps_before;
            steps_before += u64::from(*kind == EntryKind::Step);
            before < steps
        });
        let full = written(until_step.cloned().collect::<Vec<_>>());
        let again = repeated(&plan, &cut);
        let full = repeated(&plan, &full);
        assert_eq!((&again.mismatch, &full.mismatch), (&None, &None));
        same(&again.record, &full.record, &format!("{kept} entries"));
        let is_cut_off = format!("{:?}", again.record.outcome).contains(CUT_OFF);
        assert_eq!(is_cut_off, cuts < 2, "{:?}", again.record.outcome);
        cuts += 1;
    }
    assert_eq!(cuts, 3);
    // A kill before the first step leaves the plan alone.
    let nothing = repeated(&plan, &written(entries[..2].iter().cloned()));
    assert!(nothing.mismatch.is_none() && nothing.record.procedures.is_empty());
}

#[test]
fn a_run_whose_run_log_failed_ends_there_again() {
    let plan = plan();
    let length = run_log(&plan).len();
    let mut failed = 0;
    for room in (600..length).step_by(7) {
        let disk = SickDisk::new(Sickness {
            room: Some(room),
            reserve: 1 << 16,
            ..Sickness::default()
        });
        let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
        if begin(&mut journal, &compact(&plan), &["text".to_owned()]).is_err() {
            continue;
        }
        let run = record_compactly(&plan, &mut *virtual_rig(&plan), &mut Witness, journal);
        let bytes = disk.written();
        let again = repeated(&plan, &bytes);
        assert_eq!(again.mismatch, None, "{room} bytes");
        if run.record.outcome != Outcome::Completed {
            failed += 1;
            // As with a full run log, a run whose answer of the operator was not logged ends at the question.
            let reason = format!("{:?}", again.record.outcome);
            assert!(
                reason.contains("no storage space"),
                "{room} bytes: {reason}"
            );
        }
    }
    assert!(failed > 50, "{failed}");
}

/// Every value of every entry after the header, changed by somebody who computes chain and checksums again.
#[test]
fn another_value_anywhere_is_found() {
    let mut plan = long(1500.0);
    plan.procedures.splice(
        0..0,
        elastic_plan(
            300.0,
            vec![ProcedureKind::Inspect {
                note: "before the blow".to_owned(),
            }],
        )
        .procedures,
    );
    let entries = records(&run_log(&plan));
    assert_eq!(difference(&plan, &written(entries.clone())), None);
    let mut changed = 0;
    for at in 2..entries.len() - 1 {
        let pointers = pointers(&entries[at].1);
        for pointer in pointers {
            let mut forged = entries.clone();
            let value = forged[at].1.pointer_mut(&pointer).unwrap();
            *value = match value {
                serde_json::Value::Number(number) => {
                    let number = number.as_f64().unwrap();
                    serde_json::json!(number + 1.0)
                }
                serde_json::Value::String(text) => serde_json::json!(format!("{text}0")),
                serde_json::Value::Bool(truth) => serde_json::json!(!*truth),
                _ => continue,
            };
            changed += 1;
            assert!(
                difference(&plan, &written(forged)).is_some(),
                "entry {at}: {pointer} of {:?}",
                entries[at]
            );
        }
    }
    assert!(changed > 30, "{changed}");
}

#[test]
fn a_missing_a_doubled_and_a_moved_entry_are_found() {
    let plan = {
        let mut plan = long(2500.0);
        plan.procedures.extend(
            elastic_plan(
                300.0,
                vec![ProcedureKind::Inspect {
                    note: "after the blow".to_owned(),
                }],
            )
            .procedures,
        );
        plan
    };
    let entries = records(&run_log(&plan));
    let end = entries.len() - 1;
    for at in 2..end {
        let without = [&entries[..at], &entries[at + 1..]].concat();
        let twice = [&entries[..at], &entries[at..=at], &entries[at..]].concat();
        let mut moved = entries.clone();
        moved.swap(at, at + 1);
        // Entries after the end are damage that the reader finds.
        let moved = (at + 1 < end).then_some(moved);
        for forged in [Some(without), Some(twice), moved].into_iter().flatten() {
            assert!(
                difference(&plan, &written(forged)).is_some(),
                "entry {at}: {:?}",
                entries[at]
            );
        }
    }
    let digest = entries
        .iter()
        .position(|(kind, _)| *kind == EntryKind::Digest)
        .unwrap();
    let fault = difference(
        &plan,
        &written([&entries[..digest], &entries[digest + 3..]].concat()),
    )
    .unwrap();
    assert!(
        fault.contains("the run requires a reading, but the run log has OPERATOR"),
        "{fault}"
    );
    let mut forged = entries.clone();
    forged[digest + 1].1["sha256"] = serde_json::json!("0".repeat(64));
    let fault = difference(&plan, &written(forged)).unwrap();
    assert!(
        fault.contains(&format!(
            "entry {}: the run requires 1000 steps to",
            digest + 2
        )) && fault.contains(&format!("with the digest {}", "0".repeat(64))),
        "{fault}"
    );
}

#[test]
fn no_entry_of_the_other_form_is_accepted() {
    let plan = long(30.0);
    let compact = records(&run_log(&plan));
    let (_, _, full) = recorded(&plan);
    let full = records(&full);
    let digest = compact
        .iter()
        .position(|(kind, _)| *kind == EntryKind::Digest)
        .unwrap();
    let mut with_digest = full.clone();
    with_digest.insert(digest, compact[digest].clone());
    let fault = difference(&plan, &written(with_digest)).unwrap();
    assert!(
        fault.contains("a full run log has no such entry"),
        "{fault}"
    );
    let intent = full
        .iter()
        .position(|(kind, _)| *kind == EntryKind::Intent)
        .unwrap();
    let mut with_target = compact.clone();
    with_target.insert(digest, full[intent].clone());
    let fault = difference(&plan, &written(with_target)).unwrap();
    assert!(
        fault.contains("a compact run log has no such entry"),
        "{fault}"
    );
    let mut cut = compact.clone();
    cut[digest].1["steps"] = serde_json::json!(15);
    cut.insert(digest, cut[digest].clone());
    let fault = difference(&plan, &written(cut)).unwrap();
    assert!(fault.contains("no other entry ended it"), "{fault}");
}

/// The paths of all values inside a value.
fn pointers(value: &serde_json::Value) -> Vec<String> {
    let inside = |name: String, value: &serde_json::Value| {
        let mut all = vec![format!("/{name}")];
        all.extend(
            pointers(value)
                .iter()
                .map(|inner| format!("/{name}{inner}")),
        );
        all
    };
    match value {
        serde_json::Value::Object(fields) => fields
            .iter()
            .flat_map(|(name, value)| inside(name.clone(), value))
            .collect(),
        serde_json::Value::Array(items) => items
            .iter()
            .enumerate()
            .flat_map(|(at, value)| inside(at.to_string(), value))
            .collect(),
        _ => Vec::new(),
    }
}
