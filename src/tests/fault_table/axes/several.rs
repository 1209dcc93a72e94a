//! Several devices on a rig of two axes. The load cells are separate from the actuators, on one meter with two channels or each on its
//! own port. Other rigs have sites that speak NEES, each behind its own port. A run equals the virtual run. A fault of one device holds
//! every axis, and the message names that device. If one site refuses a move, no other site starts it.

use super::held;
use super::two_axes::{LINK, checked, ideal, results, same, upper, with_devices};
use crate::tests::fault_table::interrupted::cut_off::cut_off_anywhere;
use crate::tests::fault_table::stage::{run, run_without};
use psd_plan::record::Outcome;
use psd_plan::{Interval, Plan};
use psd_rig::LineStatistics;
use psd_rig::safety::failpoint::Guarding;

const LOWER: &str = "    axis(pretest_check:";
const UPPER: &str = "    axis(polarity: negative,";

/// A meter of two channels beside the controller.
pub(super) fn metered(duration: &str) -> String {
    let link = LINK.replace("link ", "actuator ");
    let devices = format!(
        "{link}\n  load_cell   = tcp(\"10.0.0.7:5025\", scpi([2.5 kN, -1 kN]), reply_timeout: 0.1 s)"
    );
    with_devices(duration, &[(LINK, devices.as_str())])
}

/// A cell for each axis on its own port: a meter, and a converter that sends counts.
pub(super) fn apart(duration: &str) -> String {
    with_devices(
        duration,
        &[
            (
                LOWER,
                "    axis(load_cell: tcp(\"10.0.0.7:5025\", scpi(1 N), reply_timeout: 0.1 s), pretest_check:",
            ),
            (
                UPPER,
                "    axis(load_cell: serial(\"/dev/ttyUSB2\", hx711, reply_timeout: 0.1 s), force_per_count: 0.01 N, zero_offset: 700, polarity: negative,",
            ),
        ],
    )
}

/// Native firmware that measures the force of the upper axis only.
fn native_cell(duration: &str) -> String {
    let cell = "    axis(load_cell: tcp(\"10.0.0.8:5025\", native, reply_timeout: 0.1 s), polarity: negative,";
    with_devices(
        duration,
        &[(LINK, &LINK.replace("link ", "actuator ")), (UPPER, cell)],
    )
}

/// Each storey behind its own site.
pub(super) fn sites(duration: &str) -> String {
    let first = "link        = tcp(\"10.0.0.1:44000\", nees(\"MDL-00-01\"), reply_timeout: 0.1 s)";
    let second = "    axis(actuator: tcp(\"10.0.0.2:44000\", nees(\"MDL-00-07\"), reply_timeout: 0.1 s), polarity: negative,";
    with_devices(duration, &[(LINK, first), (UPPER, second)])
}

pub(super) fn plan(text: &str) -> Plan {
    checked(text, "frame_rig")
}

fn as_near_as(near: f64) -> impl Fn(&str, f64) -> f64 {
    move |name, size| {
        if name.contains("energy_error") {
            100.0 * near
        } else {
            near + near * size
        }
    }
}

#[test]
fn each_layout_gives_what_the_virtual_rig_gives() {
    // Nine digits of a meter, and a resolution of 10 mN of the converter.
    let layouts = [
        (metered("0.3 s"), 2e-6),
        (apart("0.3 s"), 2e-5),
        (sites("0.3 s"), 1e-6),
        (native_cell("0.3 s"), 2e-6),
    ];
    for (text, near) in layouts {
        let ended = run(&plan(&text), "");
        assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
        assert_eq!(ended.line_statistics, LineStatistics::default());
        same(&results(&ended.record), &ideal(&text), as_near_as(near));
    }
}

#[test]
fn a_fault_of_a_load_cell_names_it_and_holds_every_axis() {
    let numbers: Vec<String> = (60..180)
        .map(|reading| format!("after {reading} readings: axis 2 number OVL"))
        .collect();
    held(
        &run(&plan(&metered("0.3 s")), &numbers.join("\n")),
        "axis 2 has no number",
    );
    let silent = "after 20 moves: load cell drop replies for ever";
    held(
        &run(&plan(&metered("0.3 s")), silent),
        "load cell on 10.0.0.7:5025: no usable answer",
    );
    let text = apart("0.3 s");
    held(
        &run(
            &plan(&text),
            "after 20 moves: load cell of axis 1 drop replies for ever",
        ),
        "load cell of axis 1 on 10.0.0.7:5025: ",
    );
    held(
        &run(
            &plan(&text),
            "after 20 moves: load cell of axis 2 drop replies for ever",
        ),
        "load cell of axis 2 on /dev/ttyUSB2: ",
    );
    held(
        &run(&plan(&text), "after 150 readings: axis 2 freeze force"),
        "axis 2: the force sensor is frozen",
    );
    held(
        &run(&plan(&text), "after 20 moves: drop replies for ever"),
        "actuator on /dev/ttyUSB0: no usable answer",
    );
    let ended = run(
        &plan(&metered("0.3 s")),
        "after 20 moves: load cell drop reply\nafter 25 moves: load cell repeat reply",
    );
    assert!(
        ended.completed() && ended.line_statistics.resent == 1,
        "{} {:?}",
        ended.reason(),
        ended.line_statistics
    );
}

#[test]
fn what_one_site_refuses_no_other_begins() {
    let mut plan = plan(&sites("0.3 s"));
    upper(&mut plan).displacement = Some(Interval {
        low: -0.002,
        high: 0.001,
    });
    let ended = run(&plan, "");
    assert!(matches!(ended.record.outcome, Outcome::Aborted { .. }));
    held(&ended, "target displacement of axis 2");
    // Without the guard the site itself refuses after the other site has accepted. The other site receives a cancellation.
    let ended = run_without(Guarding::TargetLimits, &plan, "");
    held(&ended, "actuator of axis 2 on 10.0.0.2:44000: refused: ");
    let refused = ended.log.find("NOT OK").expect("a refusal");
    let after = &ended.log[refused..];
    assert!(
        after.contains("actuator > cancel") && !after.contains("> execute"),
        "{after}"
    );
    assert!(!after.contains(" bench move "), "neither moved");
    let (first, second) = ("actuator > execute", "actuator of axis 2 > execute");
    assert_eq!(
        ended.log.matches(first).count(),
        ended.log.matches(second).count(),
        "every step was sent to both"
    );
}

#[test]
fn a_site_that_is_silent_stops_every_other() {
    for script in [
        "after 41 moves: actuator of axis 2 drop replies for ever",
        "after 41 moves: actuator of axis 2 hang up",
    ] {
        let ended = run(&plan(&sites("0.3 s")), script);
        held(&ended, "actuator of axis 2 on 10.0.0.2:44000: ");
    }
    // The device whose line has failed completes its own move; the other device is held.
    let gone = run(&plan(&sites("0.3 s")), "after 41 moves: hang up");
    assert!(
        gone.reason()
            .contains("actuator on 10.0.0.1:44000: connection lost"),
        "{}",
        gone.reason()
    );
    assert!(!gone.emulator.lock().rig().any_moving(&[1]));
    held(
        &run(&plan(&sites("0.3 s")), "after 60 moves: axis 2 stick"),
        "following error of axis 2",
    );
    let late = "after 40 moves: actuator of axis 2 delay replies 3 0.05 s\nafter 50 moves: actuator of axis 2 repeat replies 4";
    let ended = run(&plan(&sites("0.3 s")), late);
    assert!(ended.completed(), "{}", ended.reason());
}

#[test]
fn sites_that_were_cut_off_anywhere_are_brought_to_the_same_end() {
    let plan = plan(&sites("40 ms"));
    let whole = run(&plan, "");
    assert!(whole.completed());
    cut_off_anywhere(
        &plan,
        20,
        |_| {},
        |resumed, _| {
            same(&results(resumed), &results(&whole.record), as_near_as(1e-9));
        },
    );
}
