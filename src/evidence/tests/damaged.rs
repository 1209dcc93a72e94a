//! A damaged run log never causes a panic or an endless replay. It gives an error with its position, or a run that does not fit the run
//! log.

use std::path::Path;

use serde_json::{Value, json};

use super::run;
use crate::cli::commands::prediction::prediction;
use crate::cli::files::record_file;
use crate::evidence::consistency;
use crate::evidence::rebuilt::ReplayedRun;
use crate::files::recorded_run::JOURNAL;
use crate::report;
use crate::rig::Reading;
use crate::rig::journal::EntryKind;
use crate::run::Unwatched;
use crate::run::replay;
use crate::run::replay::Bands;
use psd_testing::journal::{Vandal, records, written};

/// A change to the entries of a run log.
type Damage<'a> = &'a dyn Fn(&mut Vec<(EntryKind, Value)>);

/// Everything that `verify`, `report` and `resume` do with a run log before they write or move anything; the error found.
fn replayed(journal: &[u8]) -> Result<(), String> {
    let read = record_file::of_text(Path::new(JOURNAL), &journal.to_vec().into())
        .map_err(|failure| failure.to_string())?;
    let consistent = consistency::check_consistency(&read);
    // A refusal has the same effect as a missing rig.
    let no_rig = || Err(replay::ResumeRefusal::NothingRecorded);
    let _ = replay::resume(
        &read.plan,
        &read.logged,
        &mut Unwatched,
        Box::new(|| None),
        no_rig,
    );
    if let (Some(link), Some(rig)) = (
        read.plan.rig.link.as_real(),
        read.logged.rigs.last().map(|last| &last.rig),
    ) {
        let nowhere = vec![0.0; read.plan.degrees_of_freedom()];
        let reading = Reading {
            time: 0.0,
            displacement: nowhere.clone(),
            force: nowhere,
            raw: Vec::new(),
        };
        let bands = Bands::of(&read.plan.rig, link);
        let _ = replay::decide(&read.logged, rig, &reading, &bands, true);
    }
    let replayed = ReplayedRun::of(read, None, &prediction)?;
    let ReplayedRun {
        plan,
        provenance,
        record,
        assessment,
        mismatch,
        ..
    } = &replayed;
    let run = report::Run {
        plan,
        record,
        assessment,
        provenance,
    };
    report::numbers(&run).map_err(|error| error.to_string())?;
    let _ = report::figure_data(&run);
    consistent?;
    mismatch
        .as_ref()
        .map_or(Ok(()), |mismatch| Err(mismatch.to_string()))
}

/// Run logs that once caused a panic or an endless replay: each gives an error with its position.
#[test]
fn known_damage_is_an_error_with_its_position() {
    let cases: [(&str, &[u8], &str); 10] = [
        (
            "schemes_245",
            include_bytes!("../../../tests/records/schemes_245.psdj"),
            "entry 15 (SAMPLE)",
        ),
        (
            "session_296_force",
            include_bytes!("../../../tests/records/session_296_force.psdj"),
            "entry 5 (SAMPLE)",
        ),
        (
            "session_296_place",
            include_bytes!("../../../tests/records/session_296_place.psdj"),
            "entry 16 (SAMPLE)",
        ),
        (
            "solver_249",
            include_bytes!("../../../tests/records/solver_249.psdj"),
            "entry 7 (SAMPLE)",
        ),
        (
            "solver_294",
            include_bytes!("../../../tests/records/solver_294.psdj"),
            "entry 7 (SAMPLE)",
        ),
        (
            "stiffer_161",
            include_bytes!("../../../tests/records/stiffer_161.psdj"),
            "entry 8 (SAMPLE)",
        ),
        (
            "tangents_51",
            include_bytes!("../../../tests/records/tangents_51.psdj"),
            "entry 10 (SAMPLE)",
        ),
        (
            "zero_75",
            include_bytes!("../../../tests/records/zero_75.psdj"),
            "entry 13 (SAMPLE)",
        ),
        (
            "zero_76",
            include_bytes!("../../../tests/records/zero_76.psdj"),
            "entry 14 (SAMPLE)",
        ),
        (
            "waits_for_ever",
            include_bytes!("../../../tests/records/waits_for_ever.psdj"),
            "entry 31: the run requires the end of a step",
        ),
    ];
    for (name, journal, reason) in cases {
        let fault = replayed(journal).expect_err(name);
        assert!(fault.contains(reason), "{name}: {fault}");
        assert_eq!(
            fault.contains("is malformed: its `"),
            name != "waits_for_ever",
            "{name}: {fault}"
        );
    }
}

/// Other entries that no run writes: each is reported with its position.
#[test]
fn what_no_run_writes_is_malformed() {
    let journal = &run()[JOURNAL];
    let before_the_rig = |records: &mut Vec<(EntryKind, Value)>| {
        let sample = position(records, EntryKind::Sample);
        let sample = records.remove(sample);
        records.insert(2, sample);
    };
    let alter = |kind, pointer: &'static str, value: Value| {
        move |records: &mut Vec<(EntryKind, Value)>| {
            let at = position(records, kind);
            *records[at].1.pointer_mut(pointer).unwrap() = value.clone();
        }
    };
    let failed_pause = |records: &mut Vec<(EntryKind, Value)>| {
        let fault = json!({"t": 0.0, "call": "pause", "fault": {"device": "gone"}});
        records.insert(5, (EntryKind::Fault, fault));
    };
    let gone_on = |from: u64| {
        move |records: &mut Vec<(EntryKind, Value)>| {
            let rig = records[position(records, EntryKind::Rig)].clone();
            let resume = json!({
                "from": from, "by": "R. T", "reason": "no power", "doubt": {"target": "none"}, "found": [[0.0], [0.0]],
                "recorded": null, "t": 0.0,
            });
            records.splice(5..5, [rig, (EntryKind::Resume, resume)]);
        }
    };
    let cases: [(Damage<'_>, &str); 7] = [
        (
            &before_the_rig,
            "entry 3 (SAMPLE) is malformed: no RIG precedes it",
        ),
        (
            &alter(EntryKind::Rig, "/axes", json!(2)),
            "is malformed: the plan moves 1 axis, but the rig has 2",
        ),
        (
            &alter(EntryKind::Intent, "/to", json!([0.0, 0.0])),
            "is malformed: its `to` has 2 entries, but the rig has 1 axis",
        ),
        (
            &alter(EntryKind::Sample, "/r", json!([])),
            "is malformed: its `r` has 0 entries, but the rig has 1 axis",
        ),
        (
            &failed_pause,
            "entry 6 (FAULT) is malformed: no pause of a virtual rig fails",
        ),
        (
            &gone_on(99),
            "entry 7 (RESUME) is malformed: it continues from entry 99",
        ),
        (
            &gone_on(1),
            "entry 7 (RESUME) is malformed: it continues from entry 1,",
        ),
    ];
    for (damage, expected) in cases {
        let mut damaged = records(journal);
        damage(&mut damaged);
        let fault = replayed(&written(damaged)).expect_err(expected);
        assert!(fault.contains(expected), "{expected}: {fault}");
    }
}

fn position(records: &[(EntryKind, Value)], kind: EntryKind) -> usize {
    records.iter().position(|(of, _)| *of == kind).unwrap()
}

/// Random damage, the same in each run. The result does not matter, as long as there is one. `PSD_VANDALS=100000` makes so many rounds:
/// about an hour.
#[test]
fn no_vandal_makes_a_record_that_panics() {
    const ROUNDS: u64 = 150;
    let rounds = std::env::var("PSD_VANDALS").map_or(ROUNDS, |rounds| rounds.parse().unwrap());
    let real: &[u8] = include_bytes!("../../../tests/records/waits_for_ever.psdj");
    let journal = &run()[JOURNAL];
    for seed in 0..rounds {
        let _ = replayed(&Vandal::new(seed).mangled(journal, real));
        let _ = replayed(&Vandal::new(seed).mangled(real, journal));
    }
}
