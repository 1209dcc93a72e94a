//! What a run on each kind of rig writes, with the bytes of its lines, against what it was reckoned to write before it moved.

use super::stage::{device_link, link, plan_of, run};
use super::unnumbered::{as_homed, grbl, modbus};
use crate::plan::formula::Formula::Constant;
use crate::plan::{Dialect, Impact, Interval, Plan, ProcedureKind, StiffnessRamp, Until};
use crate::plan::{FRAME, WALL};
use crate::procedures::storage_bound;
use crate::tests::testing::{every, impact, ramp, result_of};

fn procedures() -> Vec<ProcedureKind> {
    let blow = Impact {
        stepping: every(1e-3),
        duration: Constant(0.1),
        until: Until::Duration,
        ..impact(result_of(0, "stiffness"))
    }
    .with_point(|point| point.mass = Constant(20.0));
    let slow = ProcedureKind::StiffnessRamp(StiffnessRamp {
        samples: 2,
        repeats: 3,
        return_path: true,
        ..ramp(5e-5)
    });
    vec![slow, ProcedureKind::Impact(blow)]
}

/// The same procedures on another rig.
fn on(mut plan: Plan) -> Plan {
    plan.procedures = plan_of(procedures()).procedures;
    plan.strikers[0].velocity = 0.05;
    plan.limits.displacement = Interval {
        low: -0.01,
        high: 0.01,
    };
    plan.rig.settle.timeout = 20.0;
    plan
}

fn with_cell(actuator: Dialect, cell: Option<Dialect>) -> Plan {
    let mut plan = plan_of(Vec::new());
    link(&mut plan).actuator = device_link(actuator);
    link(&mut plan).load_cell = cell.map(device_link);
    if link(&mut plan).actuator.dialect == Dialect::Grbl {
        as_homed(&mut plan);
    }
    on(plan)
}

/// A stand that is told places to 0.01 mm, and does not set off for less.
fn coarse(mut plan: Plan) -> Plan {
    plan.procedures.truncate(1);
    if let ProcedureKind::StiffnessRamp(slow) = &mut plan.procedures[0].kind {
        slow.displacements = ramp(1e-4).displacements;
    }
    link(&mut plan).readings.resolution = 2e-5;
    plan.rig.settle.band = 2e-5;
    plan
}

#[test]
fn no_rig_writes_more_than_was_reckoned() {
    let rigs = [
        ("native", with_cell(Dialect::Native, None)),
        ("modbus", on(modbus())),
        ("grbl and hx711", on(grbl())),
        (
            "grbl and indicator",
            with_cell(Dialect::Grbl, Some(Dialect::Indicator)),
        ),
        (
            "grbl and scpi",
            with_cell(
                Dialect::Grbl,
                Some(Dialect::Scpi {
                    newtons_per_unit: vec![1.0],
                }),
            ),
        ),
        ("instron", with_cell(Dialect::Instron, None)),
        ("mark10", coarse(with_cell(Dialect::Mark10, None))),
        (
            "nees",
            with_cell(
                Dialect::Nees {
                    control_points: vec!["MDL-00-01".to_owned()],
                },
                None,
            ),
        ),
    ];
    for (name, plan) in rigs {
        let ended = run(&plan, "");
        // Stopped half way it would have written less.
        assert!(ended.completed(), "{name}: {}", ended.reason());
        #[expect(clippy::cast_precision_loss, reason = "some hundred thousand")]
        let written = (
            ended.lines.last().unwrap().offset as f64,
            ended.lines.len() as f64,
        );
        #[expect(clippy::cast_precision_loss, reason = "some hundred thousand")]
        let reckoned = storage_bound::of(&plan).record as f64 - FRAME;
        let ratio = reckoned / (written.0 + WALL * written.1);
        assert!(
            (1.0..4.0).contains(&ratio),
            "{name}: reckoned {ratio:.2} times what was written"
        );
    }
}
