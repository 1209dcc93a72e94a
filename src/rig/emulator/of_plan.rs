//! Makes a rig emulator that replaces the real rig of a checked plan. In: the plan, a script of faults. Out: a [`RigEmulator`] with
//! controllers for the rig's protocols, on an emulated rig with the plan's specimen, limits and noise. It opens no line.

use super::firmware::{
    Grbl, Hx711, Indicator, Instron, Mark10, Mark10Gauge, Modbus, Native, NativeSettings, Nees,
    Scpi,
};
use super::one_actuator::OneActuator;
use super::script::Script;
use super::{ActuatorSettings, EmulatedRig, EmulatedRigSettings, Firmware, Log, RigEmulator};
use psd_plan::{AxisPlan, Behaviour, Behind, Datum, Dialect, Interval, Plan, RealLink, Specimen};

/// The identity of an emulated controller.
const SIMULATED: &str = "PSD-SIM";
/// Counts of one polarity of a 24-bit converter.
const COUNTS: f64 = 8_388_608.0;
/// Default capacity of a load cell \[N\].
const CAPACITY: f64 = 100_000.0;
/// Default span of a console's transducer \[m\].
const STROKE: f64 = 1.0;
/// Conversions a second of an HX711.
const HX711_RATE: f64 = 80.0;

/// Position of a Grbl after homing, in machine coordinates \[m\]: it moves off its limit switch, which is at 0 (`$27`).
const PULLED_OFF: f64 = -1e-3;

/// The reason why the rig has no emulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoStandIn {
    #[error("the rig of this plan is a virtual rig: it needs no emulator")]
    Virtual,
    #[error("the specimen has no `behaviour`: there is nothing to load")]
    NoBehaviour,
    #[error("the script names axis {named}, but the rig has {axes}")]
    NoSuchAxis { named: usize, axes: usize },
    #[error("the script names a separate device of axis {axis}, but there is none with this role")]
    NoOwnDevice { axis: usize },
}

/// Returns the rig emulator that replaces the plan's rig. Its lines are the actuator's and the separate load cell's, if there is one.
/// `boot` is the boot identifier of this power-up; None: random, from the seed.
///
/// # Errors
/// The plan's rig is a simulated one, or its specimen has no restoring-force model.
pub fn of_plan(
    plan: &Plan,
    script: &Script,
    log: Log,
    seed: u64,
    boot: Option<u16>,
) -> Result<RigEmulator, NoStandIn> {
    let link = plan.rig.link.as_real().ok_or(NoStandIn::Virtual)?;
    let starts = starts(plan, link, script);
    let rig = emulated_rig(plan, link, seed, &starts)?.resting_at(&starts);
    let axes = rig.actuators();
    let named = script
        .faults
        .iter()
        .map(|fault| fault.actuator)
        .chain(script.starts.iter().map(|(actuator, _)| *actuator));
    if let Some(named) = named
        .map(|actuator| actuator + 1)
        .find(|named| *named > axes)
    {
        return Err(NoStandIn::NoSuchAxis { named, axes });
    }
    let of_role = |role: &str, behind: Vec<Behind<'_>>| -> Vec<(String, Box<dyn Firmware>)> {
        let one = |behind: Behind<'_>| {
            (
                behind.name(role),
                controller(plan, link, &behind, &rig, boot),
            )
        };
        behind.into_iter().map(one).collect()
    };
    let mut controllers = of_role("actuator", link.actuators());
    controllers.extend(of_role("load cell", link.load_cells()));
    let names: Vec<String> = controllers.iter().map(|(name, _)| name.clone()).collect();
    let unreachable = |fault: &&super::script::ScriptedFault| {
        fault.own_of.is_some() && fault.line_index(&names).is_none()
    };
    if let Some(axis) = script
        .faults
        .iter()
        .find(unreachable)
        .and_then(|fault| fault.own_of)
    {
        return Err(NoStandIn::NoOwnDevice { axis: axis + 1 });
    }
    Ok(RigEmulator::with_controllers(rig, log, script, controllers))
}

/// Initial position of each actuator \[m\].
fn starts(plan: &Plan, link: &RealLink, script: &Script) -> Vec<f64> {
    let mut starts = vec![0.0; plan.rig.axes().unwrap_or(1)];
    for behind in link
        .actuators()
        .iter()
        .filter(|behind| behind.link.dialect == Dialect::Grbl)
    {
        behind
            .axes
            .iter()
            .for_each(|axis| starts[*axis] = PULLED_OFF);
    }
    for (actuator, position) in &script.starts {
        if let Some(start) = starts.get_mut(*actuator) {
            *start = *position;
        }
    }
    starts
}

/// Displacement limits of an actuator with the initial position `start` \[m\]. If the plan's zero is at that position, the
/// limits move with it.
fn limits_at_rig(link: &RealLink, sign: f64, limits: Interval, start: f64) -> Interval {
    let Interval { low, high } = at_rig(sign, limits);
    if link.datum == Datum::Machine {
        Interval { low, high }
    } else {
        Interval {
            low: low + start,
            high: high + start,
        }
    }
}

fn emulated_rig(
    plan: &Plan,
    link: &RealLink,
    seed: u64,
    starts: &[f64],
) -> Result<EmulatedRig, NoStandIn> {
    let specimen = specimen(plan).ok_or(NoStandIn::NoBehaviour)?;
    let settings = |behaviour| EmulatedRigSettings {
        behaviour,
        damping: specimen.damping,
        noise: link.readings.noise,
        resolution: link.readings.resolution,
        newtons_per_count: plan
            .rig
            .calibration
            .newtons_per_count
            .unwrap_or_else(|| capacity(link) / COUNTS),
        zero_offset: plan.rig.calibration.zero_offset,
        seed,
        limits: limits_at_rig(link, plan.rig.polarity, plan.limits.displacement, starts[0]),
        top_speed: plan.limits.speed.high,
    };
    if let Some(frame) = &specimen.frame {
        // The storeys replace it.
        let nothing = Behaviour::Elastic { stiffness: 0.0 };
        let actuators: Vec<ActuatorSettings> = (0..frame.axes())
            .map(|axis| actuator(plan, link, axis, starts.get(axis).copied().unwrap_or(0.0)))
            .collect();
        let converter = |axis| {
            let own = plan.rig.calibration_of(axis);
            (
                own.newtons_per_count
                    .unwrap_or_else(|| capacity(link) / COUNTS),
                own.zero_offset,
            )
        };
        let converters = (0..actuators.len()).map(converter).collect();
        let axial = |(axis, own): (usize, &AxisPlan)| {
            let start = starts.get(axis).copied().unwrap_or(0.0);
            Some((actuator(plan, link, axis, start), own.axial?.column(frame)?))
        };
        let axial: Vec<_> = link.axes.iter().enumerate().filter_map(axial).collect();
        return Ok(EmulatedRig::of_frame(settings(nothing), frame, &actuators)
            .with_converters(converters)
            .with_axial(&axial));
    }
    let behaviour = specimen.behaviour.clone().ok_or(NoStandIn::NoBehaviour)?;
    Ok(EmulatedRig::new(settings(behaviour)).with_friction(specimen.coulomb))
}

/// Returns the actuator of a frame's floor.
fn actuator(plan: &Plan, link: &RealLink, axis: usize, start: f64) -> ActuatorSettings {
    let (sign, readings) = (plan.rig.polarity_of(axis), link.readings_of(axis));
    let limits = limits_at_rig(
        link,
        sign,
        plan.rig.limits_of(axis, &plan.limits).displacement,
        start,
    );
    ActuatorSettings {
        sign,
        noise: readings.noise,
        resolution: readings.resolution,
        limits,
    }
}

/// Returns the specimen that the first procedure names.
fn specimen(plan: &Plan) -> Option<&Specimen> {
    plan.specimen_on_the_rig()
}

/// Returns the capacity of the load cell \[N\].
fn capacity(link: &RealLink) -> f64 {
    let of_axis = |axis| {
        let Interval { low, high } = link.readings_of(axis).force_range;
        low.abs().max(high.abs())
    };
    let capacity = (0..link.axes.len().max(1)).map(of_axis).fold(0.0, f64::max);
    if capacity.is_finite() && capacity > 0.0 {
        capacity
    } else {
        CAPACITY
    }
}

/// Converts an interval to the polarity of the rig.
fn at_rig(sign: f64, interval: Interval) -> Interval {
    if sign < 0.0 {
        Interval {
            low: -interval.high,
            high: -interval.low,
        }
    } else {
        interval
    }
}

fn controller(
    plan: &Plan,
    link: &RealLink,
    behind: &Behind<'_>,
    rig: &EmulatedRig,
    boot: Option<u16>,
) -> Box<dyn Firmware> {
    let firmware = firmware(plan, link, behind, rig, boot);
    match behind.axes.first() {
        // A device with one channel knows one actuator.
        Some(axis) if *axis > 0 && behind.link.dialect.abilities().most_channels == 1 => {
            Box::new(OneActuator {
                actuator: *axis,
                firmware,
            })
        }
        _ => firmware,
    }
}

fn firmware(
    plan: &Plan,
    link: &RealLink,
    behind: &Behind<'_>,
    rig: &EmulatedRig,
    boot: Option<u16>,
) -> Box<dyn Firmware> {
    let (device, actuators) = (behind.link, behind.axes.clone());
    let serial_number = device
        .serial_number
        .clone()
        .unwrap_or_else(|| "0042".to_owned());
    match &device.dialect {
        Dialect::Native => {
            let of_axis = |axis| {
                at_rig(
                    plan.rig.polarity_of(axis),
                    plan.rig.limits_of(axis, &plan.limits).force,
                )
            };
            let force_limits = actuators.iter().copied().map(of_axis).collect();
            let settings = NativeSettings {
                serial_number,
                actuators: Some(actuators),
                force_limits,
                watchdog: link.watchdog,
                boot,
            };
            Box::new(Native::new(settings, rig))
        }
        Dialect::Grbl => Box::new(Grbl::new(SIMULATED)),
        Dialect::Hx711 => Box::new(Hx711::new(HX711_RATE)),
        Dialect::Indicator => Box::new(Indicator::default()),
        Dialect::Scpi { newtons_per_unit } => Box::new(Scpi::new(
            serial_number,
            actuators
                .into_iter()
                .zip(newtons_per_unit.iter().copied())
                .collect(),
        )),
        Dialect::Instron => Box::new(Instron::new(STROKE, capacity(link))),
        Dialect::Mark10 => Box::new(Mark10::new(1.0)),
        Dialect::Mark10Gauge => Box::new(Mark10Gauge::new(1.0)),
        Dialect::Modbus(map) => Box::new(Modbus::new(*map)),
        Dialect::Nees { control_points } => {
            Box::new(Nees::new(control_points.clone(), actuators, link.own_speed))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::firmware::sealed;
    use super::*;
    use crate::testing::emulator::InProcess;
    use crate::testing::plans::elastic_plan;
    use crate::transport::{Clock as _, Port as _};
    use psd_plan::{
        Calibration, Datum, DeviceLink, Link, PortPlan, PretestCheck, ReadingRules, SafeState,
    };
    use std::time::Duration;

    fn device(dialect: Dialect) -> DeviceLink {
        let port = PortPlan::Serial {
            path: "/dev/none".to_owned(),
            baud: 115_200,
        };
        DeviceLink {
            port,
            dialect,
            reply_timeout: 0.2,
            serial_number: None,
        }
    }

    /// A beam of 100 kN/m within limits, on a real rig of these devices.
    fn plan(actuator: Dialect, load_cell: Option<Dialect>) -> Plan {
        let mut plan = elastic_plan(1e5, Vec::new());
        let interval = |low, high| Interval { low, high };
        plan.limits.displacement = interval(-1e-3, 25e-3);
        plan.limits.force = interval(-2e3, 12e3);
        plan.limits.speed = interval(0.0, 10e-3);
        plan.rig.link = Link::Real(RealLink {
            actuator: device(actuator),
            load_cell: load_cell.map(device),
            safe_state: SafeState::Hold,
            datum: Datum::Machine,
            pretest_check: PretestCheck {
                zero: 1.0,
                probe: 1e-4,
                stiffness: Interval::ALL,
            },
            readings: ReadingRules {
                samples: 1,
                rate: 50.0,
                resolution: 0.0,
                noise: 0.0,
                force_range: Interval {
                    low: -15e3,
                    high: 15e3,
                },
                frozen_after: 10,
            },
            watchdog: 3.0,
            own_speed: 1e-3,
            axes: Vec::new(),
        });
        plan
    }

    fn emulator(plan: &Plan) -> InProcess {
        InProcess::new(of_plan(plan, &Script::default(), Log::none(), 1, None).expect("a stand"))
    }

    /// Returns all bytes received within a second.
    fn received(shared: &InProcess, line: usize, sent: &[u8]) -> String {
        let mut port = shared.port(line);
        port.write(sent, Duration::from_secs(1)).expect("sent");
        let mut text = String::new();
        let mut buffer = [0; 256];
        let until = shared.clock().now() + 1.0;
        while shared.clock().now() < until {
            if let Ok(count) = port.read(&mut buffer, Duration::from_millis(10)) {
                text.push_str(&String::from_utf8_lossy(&buffer[..count]));
            }
        }
        text
    }

    #[test]
    fn an_axis_and_a_cell_hang_on_one_specimen() {
        let mut plan = plan(Dialect::Grbl, Some(Dialect::Hx711));
        plan.rig.calibration = Calibration {
            newtons_per_count: Some(0.01),
            zero_offset: 500.0,
            ..Calibration::default()
        };
        let shared = emulator(&plan);
        assert!(received(&shared, 0, b"$J=G21G90G53X-3.000F600\n").starts_with("ok\r\n"));
        let counts = received(&shared, 1, b"");
        assert_eq!(
            counts.lines().last(),
            Some("-19500"),
            "−200 N, 2 mm from where it was homed"
        );
    }

    #[test]
    fn a_rig_with_opposite_polarity_has_its_limits_reversed() {
        let mut plan = plan(Dialect::Native, None);
        plan.rig.polarity = -1.0;
        let hello = received(&emulator(&plan), 0, &sealed("HELLO 1"));
        assert!(
            hello.contains(" -25.000000 1.000000 -12000.000 2000.000 10.000000 0 "),
            "{hello}"
        );
    }

    #[test]
    fn every_dialect_has_a_stand_in() {
        let map = psd_plan::ModbusMap {
            unit: 1,
            number: psd_plan::ModbusNumber::Int16,
            target: Some(0),
            speed: None,
            position: Some(1),
            force: Some(2),
            status: None,
            moving_mask: 0,
            command: None,
            start_word: 0,
            stop_word: 0,
            length_unit: 1e-6,
            speed_unit: 1e-6,
            force_unit: 1.0,
        };
        let asked: [(Dialect, &[u8], &str); 8] = [
            (Dialect::Grbl, b"?", "<Idle|MPos:-1.000,"),
            (Dialect::Indicator, b"", "ST,GS,+0000.00,kg\r\n"),
            (
                Dialect::Scpi {
                    newtons_per_unit: vec![1.0],
                },
                b"READ?\n",
                "E+00\n",
            ),
            (Dialect::Instron, b"Q1\r\n", "0"),
            (Dialect::Mark10, b"p", "S"),
            (Dialect::Mark10Gauge, b"?\r\n", "N"),
            (
                Dialect::Modbus(map),
                &[1, 3, 0, 0, 0, 2, 0xc4, 0x0b],
                "\u{1}\u{3}\u{4}",
            ),
            (
                Dialect::Nees {
                    control_points: vec!["MDL-00-01".to_owned()],
                },
                b"open-session\tpsd\n",
                "OK\t0\t",
            ),
        ];
        for (dialect, question, answer) in asked {
            let plan = plan(dialect.clone(), None);
            let reply = received(&emulator(&plan), 0, question);
            assert!(
                reply.contains(answer),
                "{dialect:?}: `{}`",
                reply.escape_debug()
            );
        }
    }

    #[test]
    fn a_virtual_rig_and_a_specimen_of_nothing_need_none() {
        let mut plan = plan(Dialect::Native, None);
        let reason = |plan: &Plan| of_plan(plan, &Script::default(), Log::none(), 1, None).err();
        assert_eq!(reason(&plan), None);
        plan.specimens[0].behaviour = None;
        assert_eq!(reason(&plan), Some(NoStandIn::NoBehaviour));
        plan.rig.link = Link::Virtual(psd_plan::VirtualLink::default());
        assert_eq!(reason(&plan), Some(NoStandIn::Virtual));
    }
}
