//! Position and readings of the rig when a run begins. In: rigs that are not at their zero position, or whose numbers are invalid. Out:
//! nothing moves, or every position counts from the present one.

use super::axes::two_axes::{base_excited_plan, results};
use super::forged::{found, judged};
use super::interrupted::cut_off::{Resumed, killed, resumed};
use super::line::unnumbered::{grbl, modbus};
use super::stage::{
    Ended, STIFFNESS, device_link, emulator, link, open, plan, plan_of, run, run_without, to,
};
use psd_plan::record::{EventKind, Outcome};
use psd_plan::{Datum, Dialect, ModbusMap, ModbusNumber, Plan};
use psd_rig::Rig as _;
use psd_rig::emulator::Log;
use psd_rig::journal::EntryKind;
use psd_rig::safety::failpoint::{Guarding, without};
use psd_testing::journal::PowerLoss;

const AT_3_MM: &str = "stands at 3 mm";

/// The rig was refused for this reason before any command was sent.
fn refused(plan: &Plan, script: &str, why: &str) -> Ended {
    let ended = run(plan, script);
    assert!(
        !ended.completed() && ended.reason().contains(why),
        "{script}: {}",
        ended.reason()
    );
    let emulator = ended.emulator.lock();
    assert!(
        emulator.rig().moves().is_empty() && !emulator.rig().moving(),
        "{script}"
    );
    drop(emulator);
    assert_eq!(ended.count(EntryKind::Intent), 0);
    ended
}

fn here(mut plan: Plan) -> Plan {
    link(&mut plan).datum = Datum::Here;
    plan
}

#[test]
fn an_unloaded_rig_elsewhere_is_not_sent_to_the_start_of_the_plan() {
    let ended = refused(&plan(), AT_3_MM, "is at 3.000 mm, but the plan starts at 0");
    assert!(
        ended.reason().contains("`datum = here`"),
        "{}",
        ended.reason()
    );
    // No motion release was requested.
    assert!(ended.events(EventKind::Inspection).is_empty());
    // Without this check, the first target of the plan moved the rig by 2.9 mm in the opposite direction.
    let sent = run_without(Guarding::PretestStart, &plan(), AT_3_MM);
    let least = sent
        .emulator
        .lock()
        .rig()
        .targets()
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    assert!(least < 0.2e-3, "{least}");
    // A start position within the settling tolerance is accepted.
    assert!(run(&plan(), "stands at 0.004 mm").completed());
    refused(&plan(), "stands at -0.006 mm", "but the plan starts at 0");
}

#[test]
fn the_force_of_a_specimen_at_the_start_is_reported() {
    // The specimen of an earlier run is still deformed: 0.1 mm correspond to 10 N.
    let bent = run(&plan_of(vec![to(1e-4)]), "").emulator;
    let mut rig = open(&plan(), &bent).unwrap();
    let record = crate::run::run(&plan(), &mut rig, &mut crate::run::Unwatched);
    let Outcome::Faulted { reason } = &record.outcome else {
        panic!("{:?}", record.outcome)
    };
    assert!(
        reason.contains("as after a run without a final `unload`"),
        "{reason}"
    );
    // The zero is not set again either, because the specimen carries load at this position.
    let mut rig = open(&here(plan()), &bent).unwrap();
    let record = crate::run::run(&here(plan()), &mut rig, &mut crate::run::Unwatched);
    let Outcome::Faulted { reason } = &record.outcome else {
        panic!("{:?}", record.outcome)
    };
    assert!(reason.contains("10.00 N at rest (limit 5 N)"), "{reason}");
    assert_eq!(bent.lock().rig().moves().len(), 3);
}

/// Every later position counts from the zero. The line of this stand has no checksum: bit 17 makes 2.50 mm of 2.70 mm.
#[test]
fn one_wrong_reading_is_not_the_zero() {
    let mut plan = here(plan());
    link(&mut plan).actuator = device_link(Dialect::Mark10);
    link(&mut plan).readings.samples = 1;
    let opened = (0..40).filter_map(|replies| {
        let script = format!("stands at 2.7 mm\nafter {replies} replies: flip bit 17");
        let rig = open(&plan, &emulator(&plan, &script, Log::none(), 1)).ok()?;
        Some((replies, rig.datum()))
    });
    let opened: Vec<_> = opened.collect();
    assert!(opened.len() > 30, "{opened:?}");
    for (replies, datum) in opened {
        assert_eq!(datum, Some(vec![2.7e-3]), "{replies}");
    }
}

#[test]
fn a_plan_with_its_zero_at_the_rig_position_counts_from_there() {
    for sign in [1.0, -1.0] {
        for displacement in [3.0, -41.7] {
            let mut plan = here(plan());
            plan.rig.polarity = sign;
            let ended = run(&plan, &format!("stands at {displacement} mm"));
            ended.sound();
            let own = displacement * 1e-3;
            assert_eq!(
                ended.body(EntryKind::Rig, 0)["datum"],
                serde_json::json!([own])
            );
            assert!(ended.events(EventKind::Note).iter().any(|note| {
                note.starts_with("the plan's zero is the present position of the rig")
            }));
            let emulator = ended.emulator.lock();
            let targets = emulator.rig().targets();
            assert!(
                (targets[0] - own - sign * 5e-5).abs() < 1e-12,
                "first the probe: {targets:?}"
            );
            assert!(
                targets.iter().all(|target| (target - own).abs() < 1.1e-3),
                "{targets:?}"
            );
            assert!(emulator.rig().violations().is_empty());
            drop(emulator);
            assert_eq!(judged(&plan, &ended.recovered), Ok(()));
            // Its limits are shifted with it.
            let beyond = run(&here(plan_of(vec![to(0.0101)])), AT_3_MM);
            assert!(
                matches!(beyond.record.outcome, Outcome::Aborted { .. }),
                "{}",
                beyond.reason()
            );
        }
    }
}

#[test]
fn each_of_several_axes_counts_from_its_position() {
    let plan = base_excited_plan("0.1 s");
    let ideal = run(&plan, "");
    let ended = run(&here(plan), "stands at 30 mm\naxis 2 stands at -17 mm");
    assert!(ended.completed(), "{}", ended.reason());
    for ((name, here), (_, ideal)) in results(&ended.record).iter().zip(&results(&ideal.record)) {
        assert!(
            (here - ideal).abs() <= 1e-3 * ideal.abs().max(1e-6),
            "{name}: {here} is not {ideal}"
        );
    }
    refused(
        &base_excited_plan("0.1 s"),
        "axis 2 stands at 1 mm",
        "axis 2 is at −1.000 mm",
    );
}

#[test]
fn a_datum_that_is_not_the_plans_is_found() {
    let plan = here(plan());
    let ended = run(&plan, AT_3_MM);
    let moved = |value: serde_json::Value| {
        found(&plan, &ended, EntryKind::Rig, 0, |body| {
            *body.pointer_mut("/datum").unwrap() = value.clone();
        })
        .unwrap_err()
    };
    assert!(moved(serde_json::json!([0.003, 0.0])).contains("datum"));
    let at_zero = super::stage::plan();
    assert!(
        judged(&at_zero, &ended.recovered)
            .unwrap_err()
            .contains("datum"),
        "the plan says the rig's own zero"
    );
}

/// Killed at any write, it resumes from the same zero, although the rig is at a different position by then.
#[test]
fn a_run_goes_on_from_the_zero_on_record() {
    let plan = here(plan());
    let whole = run(&plan, AT_3_MM);
    for call in (30..90).step_by(7) {
        let (emulator, disk) = (emulator(&plan, AT_3_MM, Log::none(), 1), PowerLoss::new());
        assert!(killed(&plan, &emulator, &disk, (call, true)), "call {call}");
        let Resumed::ToItsEnd(record) = resumed(&plan, &emulator, &disk, call) else {
            panic!("call {call}")
        };
        assert_eq!(results(&record), results(&whole.record), "call {call}");
        let emulator = emulator.lock();
        let farthest = emulator.rig().targets().iter().copied().fold(0.0, f64::max);
        assert!(
            (farthest - 4e-3).abs() < 1e-9 && emulator.rig().violations().is_empty(),
            "call {call}: {farthest}"
        );
    }
}

#[test]
fn a_record_without_a_datum_is_found() {
    let sent = run_without(Guarding::PretestStart, &plan(), AT_3_MM);
    let alter = |body: &mut serde_json::Value| drop(body.as_object_mut().unwrap().remove("datum"));
    let fault = found(&plan(), &sent, EntryKind::Rig, 0, alter).unwrap_err();
    assert!(fault.contains("a real rig states its datum"), "{fault}");
}

#[test]
fn a_grbl_as_it_comes_is_run_from_where_it_was_homed() {
    let ended = run(&grbl(), "");
    ended.sound();
    assert_eq!(
        ended.body(EntryKind::Rig, 0)["datum"],
        serde_json::json!([-1e-3]),
        "1 mm off its end switch"
    );
    // Its own zero is the limit switch, and all positions above it are outside its travel.
    let mut upwards = grbl();
    upwards.rig.polarity = 1.0;
    upwards.procedures = plan_of(vec![to(1.1e-3)]).procedures;
    let ended = run(&upwards, "");
    assert!(ended.reason().contains("error:15"), "{}", ended.reason());
    let mut own = grbl();
    link(&mut own).datum = Datum::Machine;
    refused(&own, "", "is at 1.000 mm, but the plan starts at 0");
}

/// The map of the plan's drive.
fn modbus_map() -> ModbusMap {
    let plan = modbus();
    match &plan.rig.link.as_real().unwrap().actuator.dialect {
        Dialect::Modbus(map) => *map,
        other => panic!("{other:?}"),
    }
}

fn swapped(number: ModbusNumber) -> ModbusNumber {
    match number {
        ModbusNumber::Int16 => number,
        ModbusNumber::Int32 { high_word_first } => ModbusNumber::Int32 {
            high_word_first: !high_word_first,
        },
        ModbusNumber::Float32 { high_word_first } => ModbusNumber::Float32 {
            high_word_first: !high_word_first,
        },
    }
}

/// A drive whose number has its two words in the opposite order to the plan.
#[test]
fn a_drive_in_the_other_word_order_is_not_moved() {
    let float = ModbusNumber::Float32 {
        high_word_first: true,
    };
    let whole = modbus_map();
    let shorts = ModbusMap {
        number: float,
        length_unit: 1e-3,
        speed_unit: 1e-3,
        force_unit: 1.0,
        ..whole
    };
    let whole = ModbusMap {
        number: ModbusNumber::Int32 {
            high_word_first: true,
        },
        ..whole
    };
    for map in [whole, shorts] {
        for (noise, start) in [
            (1.0, ""),
            (1.0, "stands at 0.0013 mm"),
            (0.0, "stands at 0.0013 mm"),
        ] {
            let mut drive = plan();
            link(&mut drive).actuator = device_link(Dialect::Modbus(map));
            link(&mut drive).readings.noise = noise;
            let mut asked = drive.clone();
            link(&mut asked).actuator = device_link(Dialect::Modbus(ModbusMap {
                number: swapped(map.number),
                ..map
            }));
            let emulator = emulator(&drive, start, Log::none(), 1);
            let outcome = match open(&asked, &emulator) {
                Err(fault) => fault.to_string(),
                Ok(mut rig) => {
                    let record = crate::run::run(&asked, &mut rig, &mut crate::run::Unwatched);
                    let (Outcome::Faulted { reason } | Outcome::Aborted { reason }) =
                        record.outcome
                    else {
                        panic!()
                    };
                    assert_eq!(rig.line_statistics().reread, 0, "{reason}");
                    reason
                }
            };
            assert!(
                outcome.contains("register order"),
                "{:?}, noise {noise}: {outcome}",
                map.number
            );
            assert!(
                emulator.lock().rig().moves().is_empty(),
                "{:?}, noise {noise}: {outcome}",
                map.number
            );
        }
    }
}

/// The largest target of a drive whose word order is not that of the plan, while all its readings are exactly 0 \[m\], and why the run
/// ended.
fn moved_at_zero(number: ModbusNumber) -> (f64, String) {
    let map = modbus_map();
    // 0.05 of the first unit, 50 of the second.
    let length_unit = match number {
        ModbusNumber::Float32 { .. } => 1e-3,
        _ => 1e-6,
    };
    // Nothing else holds it: the drive moves at its own speed.
    let map = ModbusMap {
        number,
        speed: None,
        length_unit,
        ..map
    };
    let mut drive = plan();
    link(&mut drive).readings.noise = 0.0;
    link(&mut drive).actuator = device_link(Dialect::Modbus(map));
    let mut asked = drive.clone();
    link(&mut asked).actuator = device_link(Dialect::Modbus(ModbusMap {
        number: swapped(number),
        ..map
    }));
    let emulator = emulator(&drive, "", Log::none(), 1);
    let mut rig = open(&asked, &emulator).unwrap();
    let record = crate::run::run(&asked, &mut rig, &mut crate::run::Unwatched);
    let (Outcome::Faulted { reason } | Outcome::Aborted { reason }) = record.outcome else {
        panic!("{:?}", record.outcome)
    };
    let emulator = emulator.lock();
    let targets = emulator.rig().moves().iter().flat_map(|sent| &sent.targets);
    (
        targets.map(|target| target.abs()).fold(0.0, f64::max),
        reason,
    )
}

/// Readings of exactly 0 are possible in both orders.
#[test]
fn a_drive_in_the_other_word_order_that_reads_zero_is_not_moved_either() {
    for high_word_first in [true, false] {
        let (float, whole) = (
            ModbusNumber::Float32 { high_word_first },
            ModbusNumber::Int32 { high_word_first },
        );
        let (moved, reason) = moved_at_zero(float);
        assert!(moved < 1e-30, "{moved} m: {reason}");
        let (moved, reason) = moved_at_zero(whole);
        assert!(
            moved == 0.0 && reason.contains("do not show the order of the two words"),
            "{moved} m: {reason}"
        );
        for number in [float, whole] {
            let (moved, _) = without(Guarding::WordOrder, || moved_at_zero(number));
            assert!(moved > 1.0, "nothing else sees it: {moved} m");
        }
    }
}

#[test]
fn a_number_that_cannot_be_is_refused_before_the_first_move_and_asked_again_after_it() {
    let at_rest = "after 3 readings: number 9.91E37";
    let ended = refused(&plan(), at_rest, "nothing has moved");
    assert_eq!(ended.line_statistics.reread, 0);
    assert!(run_without(Guarding::AtRest, &plan(), at_rest).completed());
    let later = run(&plan(), "after 3 moves: number 9.91E37");
    later.sound();
    assert_eq!(later.line_statistics.reread, 1);
    let (_, force) = *later.forces().last().unwrap();
    assert!((force - STIFFNESS * 1e-3).abs() < 0.1);
}
