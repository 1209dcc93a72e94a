//! Several axes on one rig. A run of two storeys over the real driver and the simulated controller equals the virtual run. A fault of one
//! axis holds all axes, and the message names that axis. A run killed at any write repeats no move.

mod axial;
mod continuous;
mod control_points;
mod elements;
mod forged_replies;
mod hybrid;
mod several;
pub(super) mod two_axes;

use super::interrupted::cut_off::{Resumed, killed, resumed};
use super::stage::{Ended, emulator, link, open, run, run_watched, run_without};
use crate::run::Unwatched;
use crate::run::replay;
use crate::run::replay::{Bands, LoggedRun, RigBody};
use psd_plan::record::{EventKind, Outcome};
use psd_plan::{Interval, Plan};
use psd_rig::emulator::Log;
use psd_rig::safety::failpoint::Guarding;
use psd_rig::{LineStatistics, Reading, Rig as _, RigFault};
use psd_testing::journal::PowerLoss;
use psd_testing::journal::recover;
use two_axes::{base_excited_plan, checked, ideal, results, same, upper};

const SINE: &str = include_str!("../../../../plans/two_storeys_sine.psd");
const YIELDING: &str = include_str!("../../../../plans/two_storeys_yielding.psd");

/// Results with their names.
type Named = Vec<(&'static str, f64)>;

/// Results of the plan on its simulated rig and on an ideal virtual rig.
fn both(text: &str) -> (Named, Named) {
    let ended = run(&checked(text, "bench"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    assert_eq!(ended.line_statistics, LineStatistics::default());
    (results(&ended.record), ideal(text))
}

#[test]
fn the_plans_of_two_storeys_give_on_two_axes_what_they_give_on_a_virtual_rig() {
    // The first three seconds of the yielding frame contain its largest drift. The pre-test check of both runs checks every axis.
    let short = YIELDING.replace("  pause         = 0.2 s\n", "  duration      = 3 s\n");
    assert_ne!(short, YIELDING);
    for text in [
        SINE.replace(
            "  time_step     = 10 ms",
            "  time_step     = 10 ms\n  duration      = 2 s",
        ),
        short,
    ] {
        let (real, ideal) = both(&text);
        // The line resolves 1 nm and 1 mN, which is 3 nm of the softer storey. Rounding errors accumulate over the steps. The energy
        // error is zero on an ideal rig, so it is compared with the input energy.
        same(&real, &ideal, |name, size| {
            if name.contains("energy_error") || name.contains("nrms_error") {
                1e-6
            } else {
                2e-8 + 1e-6 * size
            }
        });
    }
}

#[test]
fn the_pretest_check_measures_the_stiffness_matrix_column_by_column() {
    let ended = run(&base_excited_plan("50 ms"), "");
    let notes = ended.events(EventKind::Note);
    let passed: Vec<&&str> = notes
        .iter()
        .filter(|note| note.starts_with("pre-test check passed by axis"))
        .collect();
    // K = [500, −200; −200, 200] kN/m, for either polarity of the upper device.
    assert!(
        passed[0].contains("stiffness 500.0 kN/m")
            && passed[0].contains("with −200.0 kN/m in axis 2"),
        "{passed:?}"
    );
    assert!(
        passed[1].contains("stiffness 200.0 kN/m")
            && passed[1].contains("with −200.0 kN/m in axis 1"),
        "{passed:?}"
    );
    assert!(
        ended.log.contains(">MOVE ") && ended.log.contains(" 0.050000 0.000000 "),
        "one axis at a time"
    );
}

/// On hold, with no axis moving.
pub(super) fn held(ended: &Ended, why: &str) {
    assert!(
        !ended.completed() && ended.reason().contains(why),
        "{why}: {}",
        ended.reason()
    );
    assert!(!ended.emulator.lock().rig().moving(), "{why}");
}

/// Commanded to hold; nothing moved after that.
pub(super) fn stopped(ended: &Ended) {
    let held = ended
        .log
        .find("actuator > !")
        .expect("the rig was commanded to hold");
    assert!(
        !ended.completed()
            && !ended.log[held..].contains(" bench move ")
            && !ended.emulator.lock().rig().moving()
    );
}

/// The run is stopped for `why`; without the guard it is not stopped for that reason.
fn caught(guard: Guarding, plan: &Plan, script: &str, why: &str) -> Ended {
    let ended = run(plan, script);
    stopped(&ended);
    assert!(ended.reason().contains(why), "{script}: {}", ended.reason());
    let missed = run_without(guard, plan, script);
    assert!(
        !missed.reason().contains(why),
        "{script}: {}",
        missed.reason()
    );
    ended
}

#[test]
fn a_fault_of_one_axis_holds_all_axes_and_names_that_axis() {
    let plan = base_excited_plan("0.4 s");
    let mut clipped = plan.clone();
    upper(&mut clipped).force_range = Some(Interval {
        low: -400.0,
        high: 400.0,
    });
    link(&mut clipped).readings.frozen_after = 1000;
    caught(
        Guarding::Saturation,
        &clipped,
        "at 0 s: axis 2 clip force at 400 N",
        "axis 2: the force reading is saturated",
    );
    caught(
        Guarding::Frozen,
        &plan,
        "after 150 readings: axis 2 freeze force",
        "axis 2: the force sensor is frozen",
    );
    caught(
        Guarding::Following,
        &plan,
        "after 20 moves: axis 2 stick",
        "following error of axis 2: stopped",
    );
    caught(
        Guarding::Following,
        &plan,
        "after 20 moves: axis 1 reach 40 %",
        "following error of axis 1: stopped",
    );
    let numbers: Vec<String> = (60..180)
        .map(|reading| format!("after {reading} readings: axis 2 number NaN"))
        .collect();
    let ended = run(&plan, &numbers.join("\n"));
    ended.held();
    assert!(
        ended.reason().contains("axis 2 has no number"),
        "{}",
        ended.reason()
    );
    assert_eq!(ended.line_statistics.reread, 3);
}

#[test]
fn the_pretest_check_names_the_axis_that_is_wrong_and_moves_no_other() {
    let mirrored = "at 0 s: axis 2 scale force by -1";
    let mut wide = base_excited_plan("50 ms");
    upper(&mut wide)
        .pretest_check
        .as_mut()
        .unwrap()
        .stiffness
        .low = f64::NEG_INFINITY;
    caught(
        Guarding::PretestPolarity,
        &wide,
        mirrored,
        "displacement and force of axis 2 have opposite polarity",
    );
    let plan = base_excited_plan("50 ms");
    caught(
        Guarding::PretestStiffness,
        &plan,
        "at 0 s: axis 1 scale force by 0.001",
        "the stiffness of axis 1 in a move of",
    );
    caught(
        Guarding::PretestZero,
        &plan,
        "at 0 s: axis 2 drift force 6 N/s",
        "axis 2: −7.160 N at rest (limit 5 N)",
    );
    let refused = run(&plan, mirrored);
    let moves = refused.emulator.lock().rig().moves().len();
    assert_eq!(
        (refused.record.procedures.len(), moves),
        (0, 4),
        "each out and back, and nothing of the plan"
    );
}

#[test]
fn a_limit_of_one_axis_is_its_own() {
    let mut plan = base_excited_plan("0.4 s");
    upper(&mut plan).displacement = Some(Interval {
        low: -0.002,
        high: 0.001,
    });
    let ended = run(&plan, "");
    stopped(&ended);
    assert!(matches!(ended.record.outcome, Outcome::Aborted { .. }));
    assert!(
        ended.reason().contains("target displacement of axis 2"),
        "{}",
        ended.reason()
    );
    // The controller has the same limit, so nothing depends on the guard alone.
    let output = ended
        .log
        .lines()
        .find(|line| line.contains(">LIM "))
        .unwrap();
    assert!(
        output.contains(" -40.000000 40.000000 -20000.000 20000.000 -1.000000 2.000000 "),
        "{output}"
    );
    assert!(
        run_without(Guarding::TargetLimits, &plan, "")
            .reason()
            .contains("outside the limits that the rig reports")
    );
}

#[test]
fn a_controller_of_another_number_of_axes_is_refused_before_anything_is_asked_of_it() {
    let opened = |plan: &Plan, emulated_plan: &Plan| {
        let emulator = emulator(emulated_plan, "", Log::none(), 1);
        open(plan, &emulator).map(|rig| rig.degrees_of_freedom())
    };
    let (two, one) = (base_excited_plan("50 ms"), super::stage::plan());
    assert_eq!(opened(&two, &two), Ok(2));
    for (plan, emulated_plan, axes) in [(&two, &one, 1), (&one, &two, 2)] {
        let Err(RigFault::Device(reason)) = opened(plan, emulated_plan) else {
            panic!("refused")
        };
        assert!(
            reason.contains(&format!("it has {axes}, but the plan's rig has")),
            "{reason}"
        );
    }
}

/// Target of every move, by its number.
fn moves(emulator: &psd_testing::emulator::InProcess) -> Vec<(Option<u64>, Vec<f64>)> {
    emulator
        .lock()
        .rig()
        .moves()
        .iter()
        .map(|sent| (sent.id, sent.targets.clone()))
        .collect()
}

#[test]
fn killed_at_every_write_and_every_sync_it_goes_on_to_the_same_end_with_no_target_twice() {
    let plan = base_excited_plan("60 ms");
    let whole = run_watched(&plan, "", &mut Unwatched).unwrap();
    assert!(whole.completed());
    let once = moves(&whole.emulator);
    let mut kills = 0;
    for call in 4.. {
        for after in [false, true] {
            let (emulator, disk) = (emulator(&plan, "", Log::none(), 1), PowerLoss::new());
            if !killed(&plan, &emulator, &disk, (call, after)) {
                assert!(kills > 80, "{kills}");
                return;
            }
            kills += 1;
            let resumed = match resumed(&plan, &emulator, &disk, call) {
                Resumed::ToItsEnd(record) => record,
                Resumed::Ended => continue,
                Resumed::NeverBegun => {
                    assert!(moves(&emulator).is_empty());
                    continue;
                }
            };
            assert_eq!(results(&resumed), results(&whole.record), "call {call}");
            assert_eq!(
                moves(&emulator),
                once,
                "call {call}: no target twice, none left out"
            );
            let (recovered, whole) = logged_run(&disk);
            assert_eq!(
                replay::check_consistency(&recovered, &whole, &plan),
                Ok(()),
                "call {call}"
            );
            assert_eq!(replay::replay(&plan, whole).mismatch, None, "call {call}");
        }
    }
}

/// Cut off after this number of disk calls: the run log, and the replies of the rig on the same emulator afterwards.
fn cut_off(plan: &Plan, call: usize) -> (LoggedRun, RigBody, Reading) {
    let (emulator, disk) = (emulator(plan, "", Log::none(), 1), PowerLoss::new());
    assert!(
        killed(plan, &emulator, &disk, (call, true)),
        "it was to be killed"
    );
    let mut rig = open(plan, &emulator).unwrap();
    let found = rig.read().unwrap();
    (logged_run(&disk).1, RigBody::of(&rig), found)
}

#[test]
fn each_axis_is_held_to_its_own_bands_when_it_goes_on() {
    let mut plan = base_excited_plan("60 ms");
    let axes = &mut link(&mut plan).axes;
    (axes[0].resolution, axes[0].noise) = (Some(1e-4), Some(10.0));
    let bands = Bands::of(&plan.rig, plan.rig.link.as_real().unwrap());
    assert_eq!(
        bands,
        Bands {
            displacement: vec![4e-4, 5e-6],
            axial: 0,
            force: vec![60.0, 5.0],
            stiffness: vec![
                Interval {
                    low: 400e3,
                    high: 600e3
                },
                Interval {
                    low: 150e3,
                    high: 250e3
                }
            ],
        }
    );
    let (logged_run, about, found) = cut_off(&base_excited_plan("60 ms"), 60);
    let decided = |change: fn(&mut Reading)| {
        let mut found = found.clone();
        change(&mut found);
        replay::decide(&logged_run, &about, &found, &bands, false)
    };
    decided(|_| ()).unwrap();
    // A difference that the coarse axis cannot resolve is too large for the fine axis.
    decided(|found| found.displacement[0] += 5e-5).unwrap();
    decided(|found| found.force[0] += 20.0).unwrap();
    let elsewhere = decided(|found| found.displacement[1] += 5e-5).unwrap_err();
    assert!(
        matches!(
            elsewhere,
            replay::ResumeRefusal::Elsewhere {
                axis: Some(2),
                band: 5e-6,
                ..
            }
        ),
        "{elsewhere}"
    );
    let relaxed = decided(|found| found.force[1] += 20.0).unwrap_err();
    assert!(
        matches!(
            relaxed,
            replay::ResumeRefusal::Relaxed {
                axis: Some(2),
                recorded,
                low,
                high,
                ..
            } if high - recorded >= 5.0 && recorded - low >= 5.0 && high - low < 11.0
        ),
        "{relaxed}"
    );
}

pub(super) fn logged_run(disk: &PowerLoss) -> (psd_rig::journal::Recovered, LoggedRun) {
    let recovered = recover(&disk.written()).unwrap();
    let logged_run = LoggedRun::of(&recovered).unwrap();
    (recovered, logged_run)
}
