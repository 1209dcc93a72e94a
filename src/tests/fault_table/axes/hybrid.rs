//! A frame of which the rig carries two storeys, each on the strong floor: the storey between them is computed. A run on the emulated rig
//! equals the virtual run, and the pre-test check measures each assembly alone.

use super::two_axes::{checked, ideal, messages, results, same};
use super::{held, stopped};
use crate::tests::fault_table::stage::run;
use psd_rig::LineStatistics;

const PLAN: &str = r#"
specimen frame {
  storeys = [
    storey(mass: 2 t, stiffness: 300 kN/m),
    storey(mass: 1.5 t, part: computed, behaviour: bilinear(stiffness: 250 kN/m, yield_force: 1 kN, post_yield_ratio: 10 %)),
    storey(mass: 1 t, stiffness: 200 kN/m),
  ]
}

ground motion { file = "ground.csv" }

limits {
  displacement = -60 mm .. 60 mm
  force        = -20 kN .. 20 kN
  speed        = 500 mm/s
}

rig frame_rig {
  link        = serial(port: "/dev/ttyUSB0", dialect: native, reply_timeout: 0.1 s)
  settle      = within(0.005 mm, 5 kN/s, for: 0.05 s, timeout: 0.5 s)
  safe_state  = hold
  speed       = 100 mm/s
  rate        = 50 Hz
  resolution  = 1 nm
  force_range = 25 kN
  axes        = [
    axis(storey: 1, pretest_check: probe(0.05 mm, stiffness: 290 kN/m .. 310 kN/m, zero: 5 N)),
    axis(storey: 3, polarity: negative, pretest_check: probe(0.05 mm, stiffness: 190 kN/m .. 210 kN/m, zero: 5 N)),
  ]
}

shake quake {
  ground        = motion
  damping_ratio = 2 %
  integrator    = alpha_os(alpha: -0.05)
  time_step     = 10 ms
  duration      = 0.5 s
}

unload rest { }

require "drift" max(quake.max_drift) < 60 mm
"#;

#[test]
fn on_two_axes_a_frame_of_three_storeys_is_that_on_a_virtual_rig() {
    let ended = run(&checked(PLAN, "frame_rig"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    assert_eq!(ended.line_statistics, LineStatistics::default());
    let found = results(&ended.record);
    // The line resolves 1 nm and 1 mN.
    same(&found, &ideal(PLAN), |name, size| {
        if name.contains("energy_error") || name.contains("nrms_error") {
            1e-5
        } else {
            2e-7 + 1e-5 * size
        }
    });
    let drifts = found.iter().filter(|(name, _)| *name == "max_drift");
    let drifts: Vec<f64> = drifts.map(|(_, drift)| *drift).collect();
    assert!(drifts.len() == 3 && drifts[1] > 0.005, "{drifts:?}");
}

/// Each assembly has its own stiffness at its axis, so that an exchange of the two is found before the test.
#[test]
fn two_assemblies_that_are_exchanged_are_found_by_the_pretest_check() {
    let (lower, upper) = ("290 kN/m .. 310 kN/m", "190 kN/m .. 210 kN/m");
    let exchanged = PLAN
        .replace(lower, "LOWER")
        .replace(upper, lower)
        .replace("LOWER", upper);
    let ended = run(&checked(&exchanged, "frame_rig"), "");
    held(
        &ended,
        "the stiffness of axis 1 in a move of 50 µm is 300.0 kN/m",
    );
}

/// The first storey of two equal columns, one of which is on the rig at half scale; the third storey has two scales that are not those of
/// lengths. The windows of the pre-test check are those of the specimens: 75 kN/m and 120 kN/m.
fn scaled() -> String {
    PLAN.replace(
        "stiffness: 300 kN/m)",
        "stiffness: 300 kN/m, part: tested(scale: 1 / 2, represents: 2))",
    )
    .replace(
        "stiffness: 200 kN/m)",
        "stiffness: 200 kN/m, part: tested(scale: scale(displacement: 0.5, force: 0.3)))",
    )
    .replace("290 kN/m .. 310 kN/m", "70 kN/m .. 80 kN/m")
    .replace("190 kN/m .. 210 kN/m", "115 kN/m .. 125 kN/m")
}

#[test]
fn specimens_at_a_scale_give_the_results_of_the_prototype() {
    let ended = run(&checked(&scaled(), "frame_rig"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    let found = "axis 1: 0 kN at rest, zero drift 0 kN/s, stiffness 75.00 kN/m";
    let notes = ended.record.events.iter().map(|event| &event.text);
    assert!(
        notes.clone().any(|note| note.contains(found)),
        "{:?}",
        notes.collect::<Vec<_>>()
    );
    // The line resolves 1 nm and 1 mN of the rig: 2 nm and 8 mN of the prototype.
    same(&results(&ended.record), &ideal(PLAN), |name, size| {
        if name.contains("energy_error") || name.contains("nrms_error") {
            1e-5
        } else {
            1e-6 + 1e-5 * size
        }
    });
}

/// The same frame with P/h of 7 to 13 % of its stiffnesses.
fn weighed(text: &str) -> String {
    let mut text = text.to_owned();
    for (mass, gravity) in [("2 t", "60 kN"), ("1.5 t", "50 kN"), ("1 t", "40 kN")] {
        let with = format!("storey(mass: {mass}, height: 3 m, gravity: {gravity},");
        text = text.replace(&format!("storey(mass: {mass},"), &with);
    }
    text
}

/// The weights are those of the prototype: no scale enters them, and the axes do not carry them.
#[test]
fn with_weights_specimens_at_a_scale_give_the_results_of_the_prototype() {
    let ended = run(&checked(&weighed(&scaled()), "frame_rig"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    let prototype = ideal(&weighed(PLAN));
    same(&results(&ended.record), &prototype, |name, size| {
        if name.contains("energy_error") || name.contains("nrms_error") {
            1e-5
        } else {
            1e-6 + 1e-5 * size
        }
    });
    let drift = |results: &[(&str, f64)]| {
        let drifts = results.iter().find(|(name, _)| *name == "max_drift");
        drifts.unwrap().1
    };
    assert!((drift(&prototype) / drift(&ideal(PLAN)) - 1.0).abs() > 0.01);
}

/// Faults of one axis hold both, whatever part of the structure is computed.
#[test]
fn a_fault_of_one_assembly_at_a_scale_holds_all_axes() {
    let plan = checked(&weighed(&scaled()), "frame_rig");
    for (script, why) in [
        (
            "after 20 moves: axis 2 stick",
            "following error of axis 2: stopped",
        ),
        (
            "after 20 moves: axis 1 reach 40 %",
            "following error of axis 1: stopped",
        ),
    ] {
        let ended = run(&plan, script);
        stopped(&ended);
        assert!(ended.reason().contains(why), "{script}: {}", ended.reason());
    }
    let frozen = run(&plan, "after 60 readings: axis 2 freeze force");
    held(&frozen, "axis 2: the force sensor is frozen");
}

/// The stated stiffness of each axis is known before anything moves, and so is a window in numbers of the prototype.
#[test]
fn a_window_in_numbers_of_the_prototype_is_a_warning() {
    let warned = |text: &str| messages(text, "frame_rig", "W735");
    assert_eq!(warned(PLAN), Vec::<String>::new());
    assert_eq!(warned(&scaled()), Vec::<String>::new());
    let of_prototype = scaled().replace("115 kN/m .. 125 kN/m", "190 kN/m .. 210 kN/m");
    assert_eq!(
        warned(&of_prototype),
        [
            "pre-test check of axis 2 will refuse the specimen: its stiffness 0.12 MN/m is outside 0.19 MN/m .. 0.21 MN/m"
        ]
    );
}
