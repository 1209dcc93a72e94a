//! The plan of a case and its rig. In: a case. Out: the plan as psd has it, and the emulator behind its lines, which can differ from it.

use super::case::{Amendment, Case, Devices, Registers};
use super::fault::Fault;
use super::laws::{Obeys, Witness};
use crate::tests::testing::elastic_plan;
use psd_plan::formula::Formula;
use psd_plan::{
    Calibration, Datum, DeviceLink, Dialect, Interval, Limits, Link, ModbusMap, ModbusNumber, Move,
    Plan, PortPlan, PretestCheck, Procedure, ProcedureKind, ReadingRules, RealLink, SafeState,
    Settle,
};
use psd_rig::emulator::script::{Script, ScriptedFault, What, When};
use psd_rig::emulator::{Log, RigEmulator, of_plan};

/// Stiffness of the specimen \[N/m\].
const STIFFNESS: f64 = 1e5;
/// The boot identifier of the first rig.
const BOOT: u16 = 0x7f3a;

impl Case {
    /// The plan of the first session.
    pub(super) fn plan(&self) -> Plan {
        let mut plan = elastic_plan(STIFFNESS, Vec::new());
        for (index, leg) in self.legs.iter().enumerate() {
            let procedure = |name: &str, kind| Procedure {
                name: format!("{name}{index}"),
                kind,
            };
            plan.procedures.push(procedure(
                "leg",
                ProcedureKind::Move(Move {
                    to: Formula::Constant(leg.to),
                    speed: leg.speed.map(Formula::Constant),
                }),
            ));
            if leg.inspected {
                let note = format!("look {index}");
                plan.procedures
                    .push(procedure("look", ProcedureKind::Inspect { note }));
            }
        }
        let resolution = self.resolution();
        plan.rig.name = "bench".to_owned();
        plan.rig.polarity = if self.turned { -1.0 } else { 1.0 };
        plan.rig.settle = Settle {
            band: resolution.max(5e-6),
            force_rate: 0.0,
            dwell: 0.0,
            timeout: 0.5,
        };
        if self.devices == Devices::GrblAndHx711 {
            plan.rig.calibration = Calibration {
                newtons_per_count: Some(0.01),
                zero_offset: 500.0,
                ..Calibration::default()
            };
        }
        let (actuator, load_cell) = self.dialects();
        plan.rig.link = Link::Real(RealLink {
            actuator: device(actuator),
            load_cell: load_cell.map(device),
            safe_state: if self.unloads {
                SafeState::Unload
            } else {
                SafeState::Hold
            },
            datum: if self.here.is_some() {
                Datum::Here
            } else {
                Datum::Machine
            },
            pretest_check: PretestCheck {
                zero: 3.0,
                probe: 5e-5,
                stiffness: Interval {
                    low: 0.5 * STIFFNESS,
                    high: 2.0 * STIFFNESS,
                },
            },
            readings: ReadingRules {
                samples: self.samples,
                rate: 10.0,
                resolution,
                noise: self.noise,
                force_range: Interval {
                    low: -2000.0,
                    high: 2000.0,
                },
                frozen_after: 6,
            },
            watchdog: 3.0,
            own_speed: self.own_speed,
            axes: Vec::new(),
        });
        plan.limits = Limits {
            displacement: Interval {
                low: -1e-3,
                high: 1e-3,
            },
            force: Interval {
                low: -1500.0,
                high: 1500.0,
            },
            speed: Interval {
                low: 0.0,
                high: 0.01,
            },
            ..Limits::NONE
        };
        plan
    }

    fn resolution(&self) -> f64 {
        if self.devices == Devices::Mark10 {
            1e-5
        } else {
            1e-6
        }
    }

    fn dialects(&self) -> (Dialect, Option<Dialect>) {
        match self.devices {
            Devices::Native => (Dialect::Native, None),
            Devices::GrblAndHx711 => (Dialect::Grbl, Some(Dialect::Hx711)),
            Devices::GrblAndIndicator => (Dialect::Grbl, Some(Dialect::Indicator)),
            Devices::GrblAndScpi => {
                let newtons_per_unit = vec![1.0];
                (Dialect::Grbl, Some(Dialect::Scpi { newtons_per_unit }))
            }
            Devices::GrblAndGauge => (Dialect::Grbl, Some(Dialect::Mark10Gauge)),
            Devices::Instron => (Dialect::Instron, None),
            Devices::Mark10 => (Dialect::Mark10, None),
            Devices::Nees => {
                let control_points = vec!["MDL-00-01".to_owned()];
                (Dialect::Nees { control_points }, None)
            }
            Devices::Modbus(registers) => (Dialect::Modbus(map(registers)), None),
        }
    }

    /// Whether the rig reports its serial number and its power-up.
    pub(super) const fn tells_identity(&self) -> bool {
        matches!(self.devices, Devices::Native)
    }

    /// Position of the rig before the run, in its own coordinate \[m\].
    pub(super) fn start(&self) -> f64 {
        self.here.unwrap_or(0.0)
    }

    /// The rig at its start, with these faults.
    pub(super) fn rig(
        &self,
        faults: &[&Fault],
        other: Option<(&str, u16)>,
        log: Log,
    ) -> RigEmulator {
        let mut plan = self.plan();
        let Link::Real(link) = &mut plan.rig.link else {
            unreachable!("a real rig")
        };
        if let Dialect::Modbus(map) = &mut link.actuator.dialect
            && matches!(
                self.devices,
                Devices::Modbus(Registers { swapped: true, .. })
            )
        {
            map.number = swapped(map.number);
        }
        let boot = other.map_or(BOOT, |(_, boot)| boot);
        link.actuator.serial_number = other.map(|(serial_number, _)| serial_number.to_owned());
        let script = Script {
            faults: faults.iter().filter_map(|fault| scripted(fault)).collect(),
            starts: vec![(0, self.start())],
        };
        of_plan(&plan, &script, log, self.seed, Some(boot)).expect("the plan has a specimen")
    }

    pub(super) fn witness(&self) -> Witness {
        let all = Obeys {
            speed: true,
            stop: true,
            coarse: 0.0,
            by_time: self.devices == Devices::Instron,
        };
        let obeys = match self.devices {
            Devices::Nees => Obeys {
                speed: false,
                ..all
            },
            Devices::Modbus(Registers {
                number,
                speed,
                command,
                ..
            }) => Obeys {
                speed,
                stop: command,
                coarse: match number {
                    ModbusNumber::Float32 { .. } => 0.5_f64.powi(7),
                    _ => 0.0,
                },
                ..all
            },
            _ => all,
        };
        let (sign, plan) = (if self.turned { -1.0 } else { 1.0 }, self.plan());
        Witness::new(
            obeys,
            (sign, self.start()),
            plan.limits.displacement,
            (self.resolution(), plan.rig.settle.band),
        )
    }
}

/// The plan with these changes.
pub(super) fn amended(plan: &Plan, amendments: &[Amendment]) -> Plan {
    let mut plan = plan.clone();
    for amendment in amendments {
        match amendment {
            Amendment::OwnSpeed(speed) => {
                if let Link::Real(link) = &mut plan.rig.link {
                    link.own_speed = *speed;
                }
            }
            Amendment::Limits(farthest) => {
                plan.limits.displacement = Interval {
                    low: -farthest,
                    high: *farthest,
                };
            }
            Amendment::Speed(leg, speed) => {
                change(&mut plan, *leg, |leg| {
                    leg.speed = Some(Formula::Constant(*speed));
                });
            }
            Amendment::Target(leg, target) => {
                change(&mut plan, *leg, |leg| leg.to = Formula::Constant(*target));
            }
        }
    }
    plan
}

fn change(plan: &mut Plan, index: usize, change: impl FnOnce(&mut Move)) {
    let mut legs = plan
        .procedures
        .iter_mut()
        .filter_map(|procedure| match &mut procedure.kind {
            ProcedureKind::Move(leg) => Some(leg),
            _ => None,
        });
    if let Some(leg) = legs.nth(index) {
        change(leg);
    }
}

fn device(dialect: Dialect) -> DeviceLink {
    DeviceLink {
        port: PortPlan::Serial {
            path: String::new(),
            baud: 115_200,
        },
        dialect,
        reply_timeout: 0.1,
        serial_number: None,
    }
}

fn map(registers: Registers) -> ModbusMap {
    let (length_unit, force_unit) = match registers.number {
        ModbusNumber::Int16 => (1e-6, 0.1),
        ModbusNumber::Int32 { .. } => (1e-8, 1e-3),
        ModbusNumber::Float32 { .. } => (1e-3, 1.0),
    };
    ModbusMap {
        unit: 1,
        number: registers.number,
        target: Some(0),
        speed: registers.speed.then_some(10),
        position: Some(20),
        force: Some(30),
        status: registers.status.then_some(40),
        moving_mask: 1,
        command: registers.command.then_some(50),
        start_word: 1,
        stop_word: 2,
        length_unit,
        speed_unit: length_unit,
        force_unit,
    }
}

const fn swapped(number: ModbusNumber) -> ModbusNumber {
    match number {
        ModbusNumber::Int16 => ModbusNumber::Int16,
        ModbusNumber::Int32 { high_word_first } => ModbusNumber::Int32 {
            high_word_first: !high_word_first,
        },
        ModbusNumber::Float32 { high_word_first } => ModbusNumber::Float32 {
            high_word_first: !high_word_first,
        },
    }
}

/// The fault as the emulator scripts it. None: it is a fault of another part.
fn scripted(fault: &Fault) -> Option<ScriptedFault> {
    let (on_load_cell, when, what) = match fault {
        Fault::Reply {
            after,
            on_load_cell,
            count,
            what,
        } => (
            *on_load_cell,
            When::AfterReplies(*after),
            What::Replies(*what, Some(*count)),
        ),
        Fault::Controller { after, what } => (false, When::AfterReplies(*after), What::Line(*what)),
        Fault::Mechanical { after, what } => {
            (false, When::AfterMoves(*after), What::Rig(what.clone()))
        }
        _ => return None,
    };
    Some(ScriptedFault {
        on_load_cell,
        own_of: None,
        actuator: 0,
        when,
        what,
    })
}
