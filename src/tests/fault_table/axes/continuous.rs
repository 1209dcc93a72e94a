//! A continuous run over the real driver and the simulated controller, with two axes and with one. It equals the virtual run. A fault
//! during a move holds every axis. A run that is cut off anywhere is resumed to the same end.

use super::two_axes::{checked, continuous_text, ideal, results, same, upper};
use super::{logged_run, stopped};
use crate::run::replay;
use crate::tests::fault_table::interrupted::cut_off::cut_off_anywhere;
use crate::tests::fault_table::stage::{link, run, run_without};
use psd_plan::record::Outcome;
use psd_plan::{Interval, Plan};
use psd_rig::LineStatistics;
use psd_rig::safety::failpoint::Guarding;
use psd_rig::transport::Clock as _;
use psd_testing::emulator::InProcess;

fn plan(duration: &str) -> Plan {
    checked(&continuous_text(duration), "frame_rig")
}

/// One degree of freedom under an impact.
const IMPACT: &str = r#"
specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 300 kN/m)
}

striker hammer {
  mass     = 10 kg
  velocity = 1 m/s
}

limits {
  displacement = -10 mm .. 25 mm
  force        = -9 kN .. 12 kN
  speed        = 100 mm/s
}

rig bench {
  link       = serial(port: "/dev/ttyUSB0", dialect: native, reply_timeout: 0.1 s)
  settle     = within(0.005 mm, 5 kN/s, for: 0.05 s, timeout: 0.5 s)
  safe_state = hold
  pretest_check       = probe(0.05 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 5 N)
  resolution = 1 nm
  polarity       = negative
}

impact hit {
  striker   = hammer
  stiffness = 300 kN/m
  mode      = continuous(time_scale: 10000)
  duration  = 10 ms
}

require "stays in travel" hit.max_displacement < 25 mm
"#;

/// A reading comes some milliseconds after its target. The force of an elastic specimen is corrected to the target, so the motion equals
/// the virtual motion. The reported raw forces and their work contain this error.
fn as_near_as(near: f64) -> impl Fn(&str, f64) -> f64 {
    move |name, size| {
        let from_raw_force = ["energy", "error", "indicator", "force", "shear", "impulse"]
            .iter()
            .any(|word| name.contains(word));
        if from_raw_force {
            5e-4 + 3e-3 * size
        } else {
            near + 1e-5 * size
        }
    }
}

#[test]
fn axes_that_do_not_stop_give_what_the_virtual_run_gives() {
    let text = continuous_text("0.6 s");
    let ended = run(&checked(&text, "frame_rig"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    assert_eq!(ended.line_statistics, LineStatistics::default());
    same(&results(&ended.record), &ideal(&text), as_near_as(1e-7));
    let paths: Vec<&str> = ended
        .log
        .lines()
        .filter(|line| line.contains(">GLIDE "))
        .collect();
    assert!(
        paths.len() > 100,
        "two ways a step, and a brake: {}",
        paths.len()
    );
    assert!(!ended.emulator.lock().rig().moving(), "braked at its end");
}

#[test]
fn an_impact_without_a_stop_equals_the_virtual_one() {
    let ended = run(&checked(IMPACT, "bench"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    same(&results(&ended.record), &ideal(IMPACT), as_near_as(1e-7));
}

#[test]
fn an_axis_that_does_not_follow_holds_them_all() {
    let plan = plan("0.6 s");
    let ended = run(&plan, "after 30 moves: axis 2 stick");
    stopped(&ended);
    assert!(
        ended.reason().contains("following error of axis 2"),
        "{}",
        ended.reason()
    );
    let missed = run_without(Guarding::Following, &plan, "after 30 moves: axis 2 stick");
    assert!(
        !missed.reason().contains("following error"),
        "{}",
        missed.reason()
    );
}

#[test]
fn faults_of_the_line_are_corrected_or_hold_the_rig() {
    let plan = plan("0.3 s");
    for correctable in [
        "after 20 moves: drop reply",
        "after 20 moves: delay reply 0.04 s",
        "after 20 moves: flip a bit",
    ] {
        let ended = run(&plan, correctable);
        assert!(ended.completed(), "{correctable}: {}", ended.reason());
    }
    for (script, why) in [
        (
            "after 20 moves: drop replies for ever",
            "no usable answer within",
        ),
        ("after 20 moves: hang up", "connection lost"),
        ("after 20 moves: reboot", "restarted"),
        (
            "after 20 moves: axis 1 fracture at 0 mm to 1 %\nafter 20 moves: axis 2 drift force 9000 N/s",
            "",
        ),
    ] {
        let ended = run(&plan, script);
        assert!(
            !ended.completed() && ended.reason().contains(why),
            "{script}: {}",
            ended.reason()
        );
        assert!(
            !ended.emulator.lock().rig().moving()
                || why.contains("connection lost")
                || why.contains("no usable"),
            "{script}"
        );
    }
}

#[test]
fn the_whole_path_of_each_axis_is_held_against_its_own_limits() {
    let mut plan = plan("0.6 s");
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
    // The controller also checks the whole move against its limits. The driver checks it against the limits that the controller reported.
    let missed = run_without(Guarding::TargetLimits, &plan, "");
    assert!(
        missed.reason().contains("leaves the limits"),
        "{}",
        missed.reason()
    );
}

#[test]
fn cut_off_anywhere_it_is_brought_back_and_goes_on_to_the_same_end() {
    let mut plan = plan("60 ms");
    link(&mut plan).watchdog = 3.0;
    let whole = run(&plan, "");
    assert!(whole.completed(), "{}", whole.reason());
    // Without communication the rig continues for a moment, and then holds automatically.
    let left_alone = |emulator: &InProcess| {
        emulator.clock().sleep(4.0);
        assert!(!emulator.lock().rig().moving());
    };
    cut_off_anywhere(&plan, 60, left_alone, |resumed, disk| {
        same(&results(resumed), &results(&whole.record), as_near_as(1e-6));
        assert_eq!(replay::replay(&plan, logged_run(disk).1).mismatch, None);
    });
}
