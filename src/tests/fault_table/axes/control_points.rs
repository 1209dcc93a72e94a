//! A frame behind the NEES protocol, with one control point per floor. A run over the real driver and the rig emulator equals the virtual
//! run. A floor that refuses a command, or does not execute it, holds all floors.

use super::held;
use super::two_axes::{checked, ideal, results, same};
use crate::tests::fault_table::stage::run;
use psd_plan::Plan;
use psd_rig::LineStatistics;

const SINE: &str = include_str!("../../../../plans/two_storeys_sine.psd");
const LIBRARY: &str = include_str!("../../../../plans/lib/two_actuator_frame.psd");

/// Eleven digits represent a position to 1e-13 m and a force to 1e-7 N. The line resolves a target to the value below \[m\].
const NEAR: f64 = 1e-10;

/// The sine's plan, whose rig speaks NEES.
fn text() -> String {
    let (device, nees) = (
        "serial(port: \"/tmp/psd-frame\", dialect: native, serial_number: \"STAND-IN-2\")",
        "tcp(address: \"127.0.0.1:44000\", dialect: nees(\"MDL-00-01:lower, MDL-00-02\"))",
    );
    // The test measures the rounding of the protocol's text, so the load cell is ideal.
    let (noise, resolution) = (
        "  noise           = 0.001 N\n",
        "  resolution      = 1 nm\n",
    );
    assert!(
        [device, noise, resolution]
            .iter()
            .all(|text| LIBRARY.contains(text))
    );
    let rig = LIBRARY
        .replace(device, nees)
        .replace(noise, "")
        .replace(resolution, "");
    assert!(SINE.contains("use \"lib/two_actuator_frame.psd\"\n"));
    SINE.replace("use \"lib/two_actuator_frame.psd\"\n", &rig)
}

/// The results agree within the resolution of the line.
fn as_near_as_the_wire(_: &str, size: f64) -> f64 {
    NEAR + 1e-9 * size
}

pub(super) fn plan() -> Plan {
    checked(&text(), "bench")
}

#[test]
fn two_storeys_over_two_control_points_are_the_virtual_run() {
    let ended = run(&plan(), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    assert_eq!(ended.line_statistics, LineStatistics::default());
    let (real, ideal) = (results(&ended.record), ideal(&text()));
    same(&real, &ideal, as_near_as_the_wire);
    // One transaction proposes both floors, and every step is one.
    let proposals: Vec<&str> = ended
        .log
        .lines()
        .filter(|line| line.contains("> propose\\t"))
        .collect();
    assert!(
        proposals
            .iter()
            .all(|line| line.contains("MDL-00-01:lower\\tx") && line.contains("MDL-00-02\\tx")),
        "{proposals:#?}"
    );
    assert_eq!(proposals.len(), ended.emulator.lock().rig().moves().len());
}

#[test]
fn what_one_floor_does_not_do_holds_them_all() {
    held(
        &run(&plan(), "after 40 moves: axis 2 stick"),
        "following error of axis 2",
    );
    held(
        &run(&plan(), "at 0 s: axis 2 scale force by -1"),
        "displacement and force of axis 2 have opposite polarity",
    );
    let numbers: Vec<String> = (60..180)
        .map(|reading| format!("after {reading} readings: axis 2 number NaN"))
        .collect();
    held(&run(&plan(), &numbers.join("\n")), "is not a reading");
    held(
        &run(&plan(), "after 40 moves: drop replies for ever"),
        "no usable answer within",
    );
}

/// A reply to a different floor is not accepted for this floor.
#[test]
fn a_late_or_repeated_reply_is_not_accepted_for_another_floor() {
    let ended = run(
        &plan(),
        "after 40 moves: repeat replies 6\nafter 60 moves: repeat replies 5",
    );
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    assert!(
        ended.line_statistics.ignored >= 10,
        "{:?}",
        ended.line_statistics
    );
    let (real, ideal) = (results(&ended.record), ideal(&text()));
    same(&real, &ideal, as_near_as_the_wire);
}
