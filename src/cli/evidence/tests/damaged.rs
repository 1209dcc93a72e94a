//! A damaged run log never causes a panic or an endless replay. It gives an error with its position, or a run that does not fit the run
//! log.

use std::path::Path;
use std::sync::OnceLock;

use serde_json::{Value, json};

use super::{compact_run, psd, run};
use crate::args::PlanSettings;
use crate::commands::prediction::prediction;
use crate::evidence::consistency;
use crate::evidence::rebuilt::ReplayedRun;
use crate::files::provenance;
use crate::files::record_file;
use crate::files::recorded_run::JOURNAL;
use psd::check::{LoadError, Options, check};
use psd::report;
use psd::run::Unwatched;
use psd::run::replay;
use psd::run::replay::Bands;
use psd_plan::record::Outcome;
use psd_rig::Reading;
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, EntryKind, Journal};
use psd_testing::emulator;
use psd_testing::journal::{PowerLoss, Vandal, records, written};

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

/// The full run log of the first run of a language case.
fn of_case(name: &str) -> Vec<u8> {
    let root = tempfile::tempdir().unwrap();
    let plan = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/lang/ok")
        .join(name);
    let out = root.path().join("run");
    psd(&[
        "run",
        plan.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--log",
        "full",
    ]);
    std::fs::read(out.join(JOURNAL)).unwrap()
}

/// The run log of a ramp on a real rig, as its emulator answers.
fn of_a_real_rig() -> &'static [u8] {
    const PLAN: &str = r#"specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 300 kN/m)
}

limits {
  displacement = -2 mm .. 25 mm
  force        = -2 kN .. 12 kN
  speed        = 2 mm/s
}

stiffness ramp k0 {
  displacements = 0.1 mm .. 0.4 mm step 0.1 mm
  pause         = 2 s
}

rig bench {
  link          = tcp(address: "127.0.0.1:44000", dialect: native)
  settle        = within(0.01 mm, 50 N/s, for: 0.3 s)
  safe_state    = hold
  pretest_check = probe(0.1 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)
}
"#;
    static LOG: OnceLock<Vec<u8>> = OnceLock::new();
    LOG.get_or_init(|| {
        let options = Options {
            rig: Some("bench".to_owned()),
            ..Options::default()
        };
        let none = |_: &str| Err(LoadError::NotFound);
        let plan = check("ramp.psd", PLAN, &none, &options).plan.unwrap();
        let on = emulator::emulator(&plan, "", Log::none(), 1);
        let mut rig = emulator::open(&plan, &on).unwrap();
        let disk = PowerLoss::new();
        let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
        let mut header = record_file::header(
            &plan,
            record_file::device(&rig),
            &PlanSettings::default(),
            &provenance::of_this_run(&plan, None),
            record_file::Circumstances::default(),
        );
        header.rig = options.rig;
        replay::begin(&mut journal, &header, &record_file::texts(&plan)).unwrap();
        let (mut nobody, wall) = (Unwatched, Box::new(|| None));
        let recorded = replay::record(&plan, &mut rig, &mut nobody, journal, wall);
        assert_eq!(recorded.record.outcome, Outcome::Completed);
        assert_eq!(replayed(&disk.written()), Ok(()));
        disk.written()
    })
}

/// A reading with more or fewer numbers than the rig has axes, at the start, while a zero is read, and between the steps.
#[test]
fn a_reading_of_another_rig_is_malformed() {
    for name in [
        "impact_storey_rebound.psd",
        "rig_drift.psd",
        "specimen_table.psd",
        "uncertain_matrices.psd",
    ] {
        let journal = of_case(name);
        assert_eq!(replayed(&journal), Ok(()), "{name}");
        let whole = records(&journal);
        let samples = whole.iter().enumerate();
        let samples = samples.filter(|(_, (kind, _))| *kind == EntryKind::Sample);
        assert!(samples.clone().count() > 0, "{name}");
        for (at, _) in samples.take(8) {
            for (field, numbers) in [("x", 0), ("r", 0), ("x", 3), ("r", 3)] {
                let mut damaged = whole.clone();
                damaged[at].1[field] = json!(vec![0.0; numbers]);
                let fault = replayed(&written(damaged)).expect_err(name);
                let expected = format!(
                    "entry {} (SAMPLE) is malformed: its `{field}` has {numbers} entries",
                    at + 1
                );
                assert!(fault.contains(&expected), "{name}: {fault}");
            }
        }
    }
}

/// A reading that is there twice, before a pause that was interrupted: the replay does not wait for the pause to end.
#[test]
fn a_replay_that_left_its_run_log_does_not_wait() {
    let mut damaged = records(of_a_real_rig());
    let intents = damaged.iter().enumerate();
    let mut intents = intents.filter(|(_, (kind, _))| *kind == EntryKind::Intent);
    // After the two targets of the pre-test check, and three steps.
    let read = intents.nth(5).unwrap().0 + 1;
    damaged.truncate(read + 1);
    let (kind, sample) = damaged[read].clone();
    assert_eq!(kind, EntryKind::Sample);
    let interrupted = json!({"t": sample["t"], "call": "pause", "fault": "interrupted"});
    damaged.extend([(kind, sample), (EntryKind::Fault, interrupted)]);
    let fault = replayed(&written(damaged)).unwrap_err();
    let expected = format!("entry {}: the run requires the end of a step", read + 3);
    assert!(fault.contains(&expected), "{fault}");
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
                "from": from, "by": "R. T", "reason": "no power", "target_status": {"target": "none"}, "found": [[0.0], [0.0]],
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
    let real = of_a_real_rig();
    let (journal, compact) = (&run()[JOURNAL], &compact_run()[JOURNAL]);
    for seed in 0..rounds {
        let _ = replayed(&Vandal::new(seed).mangled(journal, real));
        let _ = replayed(&Vandal::new(seed).mangled(real, journal));
        let _ = replayed(&Vandal::new(seed).mangled(compact, real));
    }
}
