//! A checked plan → the stand that is in place of its real rig. In: the plan, a script of faults. Out: a [`Stand`] whose
//! controllers speak what the plan's rig speaks, on a bench with the plan's specimen, limits and noise. It opens no line.

use super::firmware::{Grbl, Hx711, Indicator, Instron, Mark10, Mark10Gauge, Modbus, Native, NativeSettings, Nees, Scpi};
use super::script::Script;
use super::{Bench, BenchSettings, Firmware, Log, Stand};
use crate::plan::{DeviceLink, Dialect, Interval, Plan, ProcedureKind, RealLink, Specimen};

/// How a simulated controller says that it is one.
const SIMULATED: &str = "PSD-SIM";
/// Counts of a converter with a sign in 24 bits.
const COUNTS: f64 = 8_388_608.0;
/// What a cell carries of which nothing is said, N.
const CAPACITY: f64 = 100_000.0;
/// What a console's transducer spans of which nothing is said, m.
const STROKE: f64 = 1.0;
/// Conversions a second of an HX711.
const HX711_RATE: f64 = 80.0;

/// Why there is nothing to stand in for the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoStandIn {
    #[error("the rig of this plan is a virtual one: it needs no stand-in")]
    Virtual,
    #[error("the specimen has no `behaviour`, so that there is nothing to bend")]
    NoBehaviour,
}

/// The stand in place of the plan's rig; its lines are the actuator's and, where it has one of its own, the load cell's.
///
/// # Errors
/// The plan's rig is virtual, or its specimen has no behaviour.
pub fn of_plan(plan: &Plan, script: &Script, log: Log, seed: u64) -> Result<Stand, NoStandIn> {
    let link = plan.rig.link.as_real().ok_or(NoStandIn::Virtual)?;
    let bench = bench(plan, link, seed)?;
    let mut controllers = vec![("actuator", controller(plan, link, &link.actuator, &bench))];
    if let Some(load_cell) = &link.load_cell {
        controllers.push(("load cell", controller(plan, link, load_cell, &bench)));
    }
    Ok(Stand::of(bench, log, script, controllers))
}

fn bench(plan: &Plan, link: &RealLink, seed: u64) -> Result<Bench, NoStandIn> {
    let specimen = specimen(plan).ok_or(NoStandIn::NoBehaviour)?;
    let behaviour = specimen.behaviour.ok_or(NoStandIn::NoBehaviour)?;
    let settings = BenchSettings {
        behaviour,
        damping: specimen.damping,
        noise: link.readings.noise,
        resolution: link.readings.resolution,
        newtons_per_count: plan.rig.calibration.newtons_per_count.unwrap_or_else(|| capacity(link) / COUNTS),
        zero_count: plan.rig.calibration.zero_count,
        seed,
        limits: at_rig(plan, plan.limits.displacement),
        top_speed: plan.limits.speed.high,
    };
    Ok(Bench::new(settings).with_friction(specimen.coulomb))
}

/// The specimen that the first procedure names.
fn specimen(plan: &Plan) -> Option<&Specimen> {
    let named = plan.procedures.iter().find_map(|procedure| match &procedure.kind {
        ProcedureKind::StiffnessRamp(ramp) => Some(ramp.specimen),
        ProcedureKind::DampingSweep(sweep) => Some(sweep.specimen),
        ProcedureKind::Impact(impact) => Some(impact.specimen),
        ProcedureKind::Move(_) | ProcedureKind::Inspect { .. } => None,
    });
    plan.specimens.get(named.unwrap_or(0))
}

/// What the cell carries, N.
fn capacity(link: &RealLink) -> f64 {
    let Interval { low, high } = link.readings.force_range;
    let capacity = low.abs().max(high.abs());
    if capacity.is_finite() && capacity > 0.0 { capacity } else { CAPACITY }
}

/// The rig's own directions may be the other way round than the plan's.
fn at_rig(plan: &Plan, interval: Interval) -> Interval {
    if plan.rig.sign < 0.0 { Interval { low: -interval.high, high: -interval.low } } else { interval }
}

fn controller(plan: &Plan, link: &RealLink, device: &DeviceLink, bench: &Bench) -> Box<dyn Firmware> {
    let serial_number = device.serial_number.clone().unwrap_or_else(|| "0042".to_owned());
    match &device.dialect {
        Dialect::Native => {
            let force_limits = at_rig(plan, plan.limits.force);
            let settings = NativeSettings { serial_number, force_limits, watchdog: link.watchdog, boot: None };
            Box::new(Native::new(settings, bench))
        }
        Dialect::Grbl => Box::new(Grbl::new(SIMULATED)),
        Dialect::Hx711 => Box::new(Hx711::new(HX711_RATE)),
        Dialect::Indicator => Box::new(Indicator::default()),
        Dialect::Scpi { newtons_per_unit } => Box::new(Scpi::new(serial_number, *newtons_per_unit)),
        Dialect::Instron => Box::new(Instron::new(STROKE, capacity(link))),
        Dialect::Mark10 => Box::new(Mark10::new(1.0)),
        Dialect::Mark10Gauge => Box::new(Mark10Gauge::new(1.0)),
        Dialect::Modbus(map) => Box::new(Modbus::new(*map)),
        Dialect::Nees { control_point } => Box::new(Nees::new(control_point.as_str(), link.own_speed)),
    }
}
