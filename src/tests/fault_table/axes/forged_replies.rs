//! Readings that a forger changes in the run log of a real rig, while the replies beside them stay. In: whole runs with every protocol.
//! Out: what `psd verify` reports first.

use serde_json::{Value, json};

use super::control_points;
use super::several::{apart, metered, plan as of_text, sites};
use crate::tests::fault_table::forged::{found, judged};
use crate::tests::fault_table::line::unnumbered::{as_homed, grbl, modbus};
use crate::tests::fault_table::stage::{Ended, device_link, link, plan, run};
use psd_plan::{Dialect, Plan, Settle};
use psd_rig::journal::EntryKind;
use psd_testing::journal::AlterEntry as _;

const CONTRADICTION: &str = "the replies in its `raw` give another number";

/// A rig of one axis with these protocols.
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

fn sound(name: &str, plan: &Plan) -> Ended {
    let ended = run(plan, "");
    assert!(
        ended.completed(),
        "{name}: {}\n{}",
        ended.reason(),
        ended.tail()
    );
    assert_eq!(judged(plan, &ended.recovered), Ok(()), "{name}");
    ended
}

/// Multiplies every force of the run log by 1.05, as in another stiffness.
fn stiffer(plan: &Plan, ended: &Ended) -> Result<(), String> {
    fn scaled(value: &mut Value) {
        match value {
            Value::Array(values) => values.iter_mut().for_each(scaled),
            _ => *value = json!(1.05 * value.as_f64().unwrap()),
        }
    }
    let mut forged = ended.recovered.clone();
    for line in &mut forged.lines {
        if matches!(line.kind, EntryKind::Sample | EntryKind::Step) {
            line.alter(|body| {
                scaled(&mut body["r"]);
                let axes = body.get_mut("axes").and_then(Value::as_array_mut);
                axes.into_iter()
                    .flatten()
                    .for_each(|axis| scaled(&mut axis["r"]));
            });
        }
    }
    judged(plan, &forged)
}

#[test]
fn a_reading_that_its_replies_do_not_give_is_found_with_every_protocol() {
    let rigs = vec![
        ("native", plan()),
        ("grbl and hx711", grbl()),
        (
            "grbl and indicator",
            of(Dialect::Grbl, Some(Dialect::Indicator)),
        ),
        ("grbl and scpi", of(Dialect::Grbl, Some(scpi()))),
        ("grbl and native", of(Dialect::Grbl, Some(Dialect::Native))),
        ("mark10", of(Dialect::Mark10, None)),
        (
            "mark10 and mark10_gauge",
            of(Dialect::Mark10, Some(Dialect::Mark10Gauge)),
        ),
        ("modbus", modbus()),
        ("nees", control_points::plan()),
        ("two sites", of_text(&sites("0.1 s"))),
        ("a meter of two channels", of_text(&metered("0.1 s"))),
        ("a load cell for each axis", of_text(&apart("0.1 s"))),
    ];
    for (name, plan) in rigs {
        let ended = sound(name, &plan);
        let fault = stiffer(&plan, &ended).expect_err(name);
        assert!(fault.contains(CONTRADICTION), "{name}: {fault}");
        let last = ended.count(EntryKind::Sample) - 1;
        let sample = ended.body(EntryKind::Sample, last);
        let last_bit =
            |number: &Value| json!(f64::from_bits(number.as_f64().unwrap().to_bits() ^ 1));
        let cases = [
            ("/x/0", last_bit(&sample["x"][0])),
            ("/r/0", last_bit(&sample["r"][0])),
            ("/raw", json!(["nonsense"])),
        ];
        for (pointer, value) in cases {
            let alter =
                |body: &mut Value| *body.pointer_mut(pointer).expect(pointer) = value.clone();
            let fault = found(&plan, &ended, EntryKind::Sample, last, alter).expect_err(name);
            assert!(fault.contains(CONTRADICTION), "{name} {pointer}: {fault}");
        }
        let without_replies = |body: &mut Value| drop(body.as_object_mut().unwrap().remove("raw"));
        let fault = found(&plan, &ended, EntryKind::Sample, last, without_replies).expect_err(name);
        assert!(fault.contains(CONTRADICTION), "{name}: {fault}");
    }
}

#[test]
fn the_replies_of_a_console_are_not_compared() {
    let plan = of(Dialect::Instron, None);
    let ended = sound("instron", &plan);
    let nonsense = |body: &mut Value| body["raw"] = json!(["nonsense"]);
    assert_eq!(found(&plan, &ended, EntryKind::Sample, 3, nonsense), Ok(()));
}

/// The calibration of an axis is a part of the meaning of its counts.
#[test]
fn replies_with_another_calibration_give_another_reading() {
    let mut plan = of_text(&apart("0.1 s"));
    let ended = sound("a load cell for each axis", &plan);
    link(&mut plan).axes[1].calibration.newtons_per_count = Some(0.011);
    let fault = judged(&plan, &ended.recovered).unwrap_err();
    assert!(fault.contains(CONTRADICTION), "{fault}");
}

/// Replies that are not readings stay in the entry, before those of the next reading.
#[test]
fn a_reading_that_was_requested_again_is_that_of_its_replies() {
    let most_replies = |ended: &Ended| {
        let replies = |nth| {
            ended.body(EntryKind::Sample, nth)["raw"]
                .as_array()
                .unwrap()
                .len()
        };
        (0..ended.count(EntryKind::Sample)).map(replies).max()
    };
    // Before the first move, a complete native reply without a number ends the run.
    let rigs = [
        (of(Dialect::Grbl, Some(Dialect::Indicator)), 600),
        (of(Dialect::Grbl, Some(scpi())), 600),
        (of(Dialect::Mark10, None), 600),
        (grbl(), 600),
        (plan(), 1500),
    ];
    for (plan, first) in rigs {
        let sound = most_replies(&run(&plan, ""));
        let faults: Vec<String> = (first..9000)
            .step_by(50)
            .map(|ms| format!("at {} s: number OVL", f64::from(ms) / 1e3))
            .collect();
        let ended = run(&plan, &faults.join("\n"));
        assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
        assert!(
            ended.line_statistics.reread > 0 && most_replies(&ended) > sound,
            "{:?} {sound:?}",
            ended.line_statistics
        );
        assert_eq!(judged(&plan, &ended.recovered), Ok(()));
        let fault = stiffer(&plan, &ended).unwrap_err();
        assert!(fault.contains(CONTRADICTION), "{fault}");
    }
}
