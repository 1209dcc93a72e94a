//! The same forger on rigs that do not speak psd's own protocol: whatever he changes of numbers or bytes, the one no longer says the
//! other, down to the last bit. In: whole runs in every dialect. Out: what `psd verify` finds first.

use serde_json::{Value, json};

use super::control_points;
use super::forged::{found, judged};
use super::several::{apart, metered, plan as of_text, sites};
use super::stage::{Ended, device_link, link, plan, run};
use super::unnumbered::{as_homed, grbl, modbus};
use crate::plan::{Dialect, Plan, Settle};
use crate::record::journal::EntryKind;

/// One device that moves and weighs, or two.
fn of(actuator: Dialect, load_cell: Option<Dialect>) -> Plan {
    let mut plan = plan();
    plan.rig.settle = Settle {
        band: 2e-5,
        timeout: 5.0,
        ..plan.rig.settle
    };
    let link = link(&mut plan);
    let homes = actuator == Dialect::Grbl;
    (link.actuator, link.load_cell) = (device_link(actuator), load_cell.map(device_link));
    link.readings.resolution = 1e-5;
    if homes {
        as_homed(&mut plan);
    }
    plan
}

fn scpi() -> Dialect {
    Dialect::Scpi {
        newtons_per_unit: vec![250.0],
    }
}

/// Every dialect, with what it is called; whether its bytes carry a speed.
fn dialects() -> [(&'static str, Plan, bool); 11] {
    [
        ("grbl and hx711", grbl(), true),
        (
            "grbl and indicator",
            of(Dialect::Grbl, Some(Dialect::Indicator)),
            true,
        ),
        ("grbl and scpi", of(Dialect::Grbl, Some(scpi())), true),
        (
            "grbl and a native meter",
            of(Dialect::Grbl, Some(Dialect::Native)),
            true,
        ),
        (
            "mark10 and its gauge apart",
            of(Dialect::Mark10, Some(Dialect::Mark10Gauge)),
            true,
        ),
        ("mark10", of(Dialect::Mark10, None), true),
        ("instron", of(Dialect::Instron, None), false),
        ("modbus", modbus(), true),
        ("nees", control_points::plan(), false),
        ("sites of one axis each", of_text(&sites("0.1 s")), false),
        ("a meter of two channels", of_text(&metered("0.1 s")), true),
    ]
}

/// The same number but for its last bit.
fn nearest(number: &Value) -> Value {
    let number = number.as_f64().unwrap();
    json!(f64::from_bits(number.to_bits() ^ 1))
}

#[test]
fn a_number_that_its_bytes_do_not_say_is_found_in_every_dialect() {
    for (name, plan, carries_speed) in dialects() {
        let ended = run(&plan, "");
        assert!(
            ended.completed(),
            "{name}: {}\n{}",
            ended.reason(),
            ended.tail()
        );
        assert_eq!(judged(&plan, &ended.recovered), Ok(()), "{name}");
        let last = ended.count(EntryKind::Sample) - 1;
        let sample = ended.body(EntryKind::Sample, last);
        let shorter: Vec<Value> = sample["raw"].as_array().unwrap()[1..].to_vec();
        let (sent, other) = (
            ended.body(EntryKind::Intent, 5),
            ended.body(EntryKind::Intent, 6),
        );
        let mut cases = vec![
            (
                EntryKind::Sample,
                last,
                "/x/0",
                nearest(&sample["x"][0]),
                "bytes that came",
            ),
            (
                EntryKind::Sample,
                last,
                "/r/0",
                nearest(&sample["r"][0]),
                "bytes that came",
            ),
            (
                EntryKind::Sample,
                last,
                "/raw",
                ended.body(EntryKind::Sample, last / 2)["raw"].clone(),
                "bytes that came",
            ),
            (
                EntryKind::Sample,
                last,
                "/raw",
                json!(shorter),
                "bytes that came",
            ),
            (
                EntryKind::Sample,
                last,
                "/raw",
                json!(["nonsense"]),
                "bytes that came",
            ),
            (
                EntryKind::Intent,
                5,
                "/wire",
                other["wire"].clone(),
                "bytes that were sent",
            ),
            (
                EntryKind::Intent,
                5,
                "/wire",
                json!(""),
                "bytes that were sent",
            ),
            (
                EntryKind::Rig,
                0,
                "/identity/model",
                json!("INSTRON"),
                "who it is",
            ),
        ];
        if carries_speed {
            cases.push((
                EntryKind::Intent,
                5,
                "/rate",
                json!(1.001 * sent["rate"].as_f64().unwrap()),
                "bytes that were sent",
            ));
        }
        for (kind, nth, place, value, why) in cases {
            // A device that says nothing of itself at the beginning cannot be held to it.
            if place == "/identity/model" && ended.body(EntryKind::Rig, 0)["said"].is_null() {
                continue;
            }
            let alter = |body: &mut Value| *body.pointer_mut(place).expect(place) = value.clone();
            let fault = found(&plan, &ended, kind, nth, alter)
                .expect_err(&format!("{name} {place} {value}"));
            assert!(fault.contains(why), "{name} {kind:?} {place}: {fault}");
        }
        let silent = |body: &mut Value| drop(body.as_object_mut().unwrap().remove("raw"));
        let fault = found(&plan, &ended, EntryKind::Sample, last, silent).expect_err(name);
        assert!(fault.contains("bytes that came"), "{name}: {fault}");
    }
}

/// A cell for each axis, one of which gives counts.
#[test]
fn the_calibration_of_an_axis_is_a_part_of_what_its_counts_say() {
    let mut plan = of_text(&apart("0.1 s"));
    let ended = run(&plan, "");
    assert_eq!(judged(&plan, &ended.recovered), Ok(()));
    link(&mut plan).axes[1].calibration.newtons_per_count = Some(0.011);
    let fault = judged(&plan, &ended.recovered).unwrap_err();
    assert!(
        fault.contains("bytes that came do not say") && fault.ends_with(" N"),
        "{fault}"
    );
}

/// Every reply a reading was made of counts, also of one that had to be asked for again.
#[test]
fn a_reading_that_was_asked_for_again_says_what_came_at_last() {
    let again = |ended: &Ended| {
        let raws = |nth| {
            ended.body(EntryKind::Sample, nth)["raw"]
                .as_array()
                .unwrap()
                .len()
        };
        (0..ended.count(EntryKind::Sample)).map(raws).max().unwrap()
    };
    // One that sends by itself is not heard in every line, and a console bears few questions.
    let meters = [
        (of(Dialect::Grbl, Some(Dialect::Indicator)), 50),
        (of(Dialect::Grbl, Some(scpi())), 50),
        (of(Dialect::Mark10, None), 50),
        (of(Dialect::Instron, None), 370),
        (grbl(), 50),
        // A sound reply without a number is none to ask for again before the first move.
        (plan(), 50),
    ];
    for (plan, period) in meters {
        let sound = again(&run(&plan, ""));
        let first = if matches!(
            plan.rig.link.as_real().unwrap().actuator.dialect,
            Dialect::Native
        ) {
            1500
        } else {
            600
        };
        let faults: Vec<String> = (first..9000)
            .step_by(period)
            .map(|ms| format!("at {} s: number OVL", f64::from(ms) / 1e3))
            .collect();
        let ended = run(&plan, &faults.join("\n"));
        assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
        assert!(
            ended.tally.reread > 0 && again(&ended) > sound,
            "{:?} {sound}",
            ended.tally
        );
        assert_eq!(judged(&plan, &ended.recovered), Ok(()));
    }
}
