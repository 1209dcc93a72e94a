//! Lines whose replies carry no number: Grbl with a converter, and Modbus. In: runs on which replies are lost, late or old. Out: the
//! numbers of a sound line, or a rig on hold.

use crate::tests::fault_table::stage::{device_link, link, plan, run, run_without};
use psd_plan::record::Outcome;
use psd_plan::{Datum, Dialect, Interval, ModbusMap, ModbusNumber, Plan};
use psd_rig::safety::failpoint::Guarding;

pub(crate) fn modbus() -> Plan {
    let map = ModbusMap {
        unit: 1,
        number: ModbusNumber::Float32 {
            high_word_first: true,
        },
        target: Some(0),
        speed: Some(2),
        position: Some(4),
        force: Some(6),
        status: Some(8),
        moving_mask: 1,
        command: Some(9),
        start_word: 1,
        stop_word: 2,
        length_unit: 1e-7,
        speed_unit: 1e-7,
        force_unit: 0.01,
    };
    let mut plan = plan();
    link(&mut plan).actuator = device_link(Dialect::Modbus(map));
    plan
}

/// After homing, a Grbl axis is below its zero, and moves down from there.
pub(crate) fn as_homed(plan: &mut Plan) {
    plan.rig.polarity = -1.0;
    link(plan).datum = Datum::Here;
}

pub(crate) fn grbl() -> Plan {
    let mut plan = plan();
    link(&mut plan).actuator = device_link(Dialect::Grbl);
    link(&mut plan).load_cell = Some(device_link(Dialect::Hx711));
    as_homed(&mut plan);
    plan.rig.calibration.newtons_per_count = Some(-0.01);
    link(&mut plan).readings.force_range = Interval {
        low: -2000.0,
        high: 2000.0,
    };
    plan
}

#[test]
fn lost_doubled_and_late_answers_leave_the_same_numbers() {
    for plan in [modbus(), grbl()] {
        run(&plan, "").sound();
        for fault in [
            "drop reply",
            "repeat reply",
            "replay reply",
            "delay reply 0.15 s",
            "delay reply 0.25 s",
            "cut reply at 3 bytes",
        ] {
            let ended = run(
                &plan,
                &format!("after 3 moves: {fault}\nafter 60 replies: {fault}"),
            );
            // Either recovered or on hold: never a different number.
            if ended.completed() {
                ended.sound();
            } else {
                assert!(
                    matches!(ended.record.outcome, Outcome::Faulted { .. }),
                    "{fault}: {:?}",
                    ended.record.outcome
                );
                assert!(!ended.emulator.lock().rig().moving(), "{fault}");
            }
        }
    }
}

#[test]
fn a_late_answer_is_not_accepted_for_the_next_request() {
    let late = "after 100 replies: delay replies 2 0.12 s";
    let ended = run(&modbus(), late);
    assert!(
        ended.line_statistics.resent > 0,
        "{:?}",
        ended.line_statistics
    );
    ended.sound();
    let without = run_without(Guarding::Resend, &modbus(), late);
    assert!(
        matches!(without.record.outcome, Outcome::Faulted { .. }),
        "the silence alone holds it"
    );
}

#[test]
fn a_start_of_grbl_is_seen() {
    let ended = run(&grbl(), "after 4 moves: reboot");
    assert!(
        matches!(ended.record.outcome, Outcome::Faulted { .. }),
        "{:?}",
        ended.record.outcome
    );
    assert_eq!(ended.emulator.lock().rig().moves().len(), 4);
    assert!(!ended.trusted, "{}", ended.reason());
}
