//! Very many steps with random faults that can be recovered, and a wall clock that jumps. In: seeds. Out: no sample is lost, no
//! descriptor stays open, and only the steps themselves use memory. A failure reports its seed.

use std::io;
use std::process::Command;
use std::sync::{Arc, Mutex};

use crate::run::{Unwatched, replay};
use crate::tests::fault_table::stage::{STIFFNESS, emulator, header, link, open, plan_of};
use crate::tests::testing::ramp;
use psd_plan::formula::Formula;
use psd_plan::record::{EventKind, History, Outcome};
use psd_plan::{Plan, ProcedureKind, StiffnessRamp};
use psd_rig::LineStatistics;
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, Journal, Line, Storage};

/// Steps out and back: 10 000 in all. A memory leak per step shows in the memory of this many steps: 400 bytes per step are 4 MB.
const STEPS: u32 = 5_000;
/// Steps between two checks of the resources of the process.
const LOOK: usize = 1_000;
/// Memory that a step may keep \[bytes\]: its entry in the run log, and its target in the emulator.
const OF_A_STEP: usize = 400;
/// Set if the test runs alone in its process.
const ALONE: &str = "PSD_TEST_ALONE";

/// A disk that only counts.
#[derive(Clone, Default)]
struct Counted(Arc<Mutex<Counts>>);

#[derive(Default)]
struct Counts {
    samples: usize,
    steps: usize,
    /// Size of the longest run log \[bytes\].
    longest: usize,
    promised: usize,
    /// SAMPLE entries that were synced when the next target was sent.
    unsafe_samples: usize,
    /// Resident memory \[bytes\] and open descriptors, every `LOOK` steps.
    held: Vec<(usize, usize)>,
}

/// Resident memory of this process (bytes), and its open descriptors.
fn held() -> (usize, usize) {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let resident = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:")?.strip_suffix("kB"))
        .unwrap();
    (
        resident.trim().parse::<usize>().unwrap() * 1024,
        std::fs::read_dir("/proc/self/fd").unwrap().count(),
    )
}

impl Storage for Counted {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut counts = self.0.lock().unwrap();
        let text = String::from_utf8_lossy(bytes);
        for line in text.lines() {
            let kind = line.split(' ').nth(1).unwrap_or_default();
            counts.samples += usize::from(kind == "SAMPLE");
            counts.steps += usize::from(kind == "STEP");
            if kind == "STEP" && counts.steps.is_multiple_of(LOOK) {
                counts.held.push(held());
            }
            counts.longest = counts.longest.max(line.len());
            if kind == "INTENT" {
                counts.unsafe_samples += counts.samples - counts.promised;
            }
        }
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        let mut counts = self.0.lock().unwrap();
        counts.promised = counts.samples;
        Ok(())
    }

    fn cut(&mut self, _: u64) -> io::Result<()> {
        Ok(())
    }
}

/// Out and back in steps of a few µm, without pause.
fn long_plan(steps: u32) -> Plan {
    let step = 0.005 / f64::from(steps.min(1000));
    let displacements = (0..steps)
        .map(|index| Formula::Constant(f64::from(index % 1000 + 1) * step))
        .collect();
    let ramp = StiffnessRamp {
        displacements,
        return_path: true,
        ..ramp(1e-6)
    };
    let mut plan = plan_of(vec![ProcedureKind::StiffnessRamp(ramp)]);
    plan.rig.settle.dwell = 0.0;
    link(&mut plan).readings.samples = 1;
    link(&mut plan).readings.resolution = 1e-7;
    // A rest at the end of a move is not a frozen sensor.
    link(&mut plan).readings.frozen_after = 50;
    plan
}

#[test]
fn very_many_steps_with_faults_by_chance_lose_no_sample_and_hold_on_to_nothing() {
    if std::env::var_os(ALONE).is_none() {
        // Other tests of this process allocate memory and open files. To exclude them, the test runs again in a separate process.
        let test = "tests::fault_table::interrupted::long::very_many_steps_with_faults_by_chance_lose_no_sample_and_hold_on_to_nothing";
        let mut alone = Command::new(std::env::current_exe().unwrap());
        let ended = alone
            .args(["--exact", test, "--nocapture"])
            .env(ALONE, "1")
            .output()
            .unwrap();
        let output = String::from_utf8_lossy(&ended.stdout).into_owned()
            + &String::from_utf8_lossy(&ended.stderr);
        assert!(
            ended.status.success() && output.contains("1 passed"),
            "{output}"
        );
        return;
    }
    let script = "
        each reply: drop reply with 0.0005
        each reply: flip a bit with 0.001
        each reply: repeat reply with 0.0005
        each reply: replay reply with 0.0003
        each reply: delay reply 0.12 s with 0.0005
        each reply: garbage 30 bytes before with 0.0005
        each reply: cut reply at 9 bytes with 0.0005
        each reading: number OVL with 0.0005";
    let plan = long_plan(STEPS);
    let seed = 20_070_319;
    let emulator = emulator(&plan, script, Log::none(), seed);
    let mut rig = open(&plan, &emulator).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
    let counted = Counted::default();
    let mut journal = Journal::create(Box::new(counted.clone()), Durability::EverySyncPoint);
    replay::begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
    let recorded = replay::record(&plan, &mut rig, &mut Unwatched, journal, Box::new(|| None));
    let record = recorded.record;
    assert_eq!(record.outcome, Outcome::Completed, "seed {seed}");
    let History::StiffnessRamp(history) = &record.procedures[0].history else {
        panic!("a ramp")
    };
    assert_eq!(history.steps.len(), 2 * STEPS as usize, "seed {seed}");
    for step in &history.steps {
        assert!(
            (step.restoring_force - STIFFNESS * step.command).abs() < 0.1,
            "seed {seed}: {step:?}"
        );
    }
    let counts = counted.0.lock().unwrap();
    assert_eq!(
        (counts.steps, counts.unsafe_samples),
        (history.steps.len(), 0),
        "seed {seed}"
    );
    assert!(
        counts.samples >= counts.steps && counts.longest < 4096,
        "seed {seed}: {}",
        counts.longest
    );
    let (first, last) = (counts.held[0], *counts.held.last().unwrap());
    let steps = counts.steps - LOOK;
    let grown = last.0.saturating_sub(first.0);
    assert!(grown < OF_A_STEP * steps, "seed {seed}: {:?}", counts.held);
    assert!(
        counts.held.len() == 10 && counts.held.iter().all(|held| held.1 == first.1),
        "seed {seed}: {:?}",
        counts.held
    );
    let LineStatistics {
        resent,
        ignored,
        reread,
    } = psd_rig::Rig::line_statistics(&rig);
    assert!(
        resent > 30 && ignored > 30 && reread > 3,
        "seed {seed}: {resent} {ignored} {reread}"
    );
    assert!(
        record
            .events
            .last()
            .is_some_and(|event| event.kind == EventKind::Recovered),
        "seed {seed}"
    );
    assert!(emulator.lock().rig().violations().is_empty(), "seed {seed}");
    assert_eq!(
        emulator.lock().rig().moves().len(),
        2 * STEPS as usize + 2,
        "seed {seed}: each target was carried out once"
    );
}

#[test]
fn a_wall_clock_that_jumps_changes_no_duration() {
    let times = |wall: replay::Wall| {
        let plan = long_plan(20);
        let emulator = emulator(&plan, "", Log::none(), 1);
        let mut rig = open(&plan, &emulator).unwrap();
        let disk = psd_testing::journal::PowerLoss::new();
        let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
        replay::begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
        let record = replay::record(&plan, &mut rig, &mut Unwatched, journal, wall).record;
        assert_eq!(record.outcome, Outcome::Completed);
        let lines = psd_testing::journal::recover(&disk.written())
            .unwrap()
            .lines;
        let stamps = lines
            .iter()
            .filter(|line| {
                line.body()
                    .get("wall")
                    .is_some_and(serde_json::Value::is_string)
            })
            .count();
        let times: Vec<f64> = lines.iter().filter_map(Line::time).collect();
        assert!(
            times.windows(2).all(|pair| pair[0] <= pair[1]),
            "never back"
        );
        (times, stamps)
    };
    let year = Mutex::new(2026);
    let jumping = Box::new(move || {
        let mut year = year.lock().unwrap();
        *year = if *year == 2026 { 2027 } else { 2026 };
        Some(format!("{year}-03-29T02:30:00+01:00"))
    });
    let (steady, none) = times(Box::new(|| None));
    let (jumped, stamps) = times(jumping);
    assert_eq!(steady, jumped);
    assert!(none == 0 && stamps > 40, "both stamps are kept");
}
