//! The plan of a case and its rig. In: a case. Out: the plan as psd has it, and the emulator behind its lines, which can differ from it.

use std::ops::Range;

use super::case::{Amendment, Case, Devices, Leg, Registers, Test};
use super::fault::{Fault, Part};
use super::frame::duration;
use super::laws::{Obeys, Witness};
use crate::tests::testing::elastic_plan;
use psd_plan::formula::Formula;
use psd_plan::{
    AxialAxis, AxisPlan, Calibration, Datum, DeviceLink, Dialect, Interval, Limits, Link,
    ModbusMap, ModbusNumber, Move, Plan, PortPlan, PretestCheck, Procedure, ProcedureKind,
    ReadingRules, RealLink, SafeState, Settle,
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
        match &self.test {
            Test::Moves(legs) => plan.procedures = moves(legs),
            Test::Frame(test) => {
                let (grounds, procedures) = test.procedures();
                plan = elastic_plan(STIFFNESS, procedures);
                plan.grounds = grounds;
                plan.specimens[0].behaviour = None;
                plan.specimens[0].frame = Some(test.frame());
                plan.strikers[0].mass = 100.0;
                plan.strikers[0].velocity = 5e-3;
            }
        }
        let resolution = self.resolution();
        plan.rig.name = "bench".to_owned();
        plan.rig.polarity = self.sign(0);
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
            datum: if self.here {
                Datum::Here
            } else {
                Datum::Machine
            },
            pretest_check: pretest_check(STIFFNESS),
            readings: ReadingRules {
                samples: self.samples,
                rate: 10.0,
                resolution,
                noise: self.noise,
                force_range: Interval {
                    low: -2000.0,
                    high: 2000.0,
                },
                // An upper storey that moves with the lower one has no force, and without noise its readings are equal.
                frozen_after: match self.test {
                    Test::Frame(_) if self.noise == 0.0 => 1000,
                    _ => 6,
                },
            },
            watchdog: 3.0,
            own_speed: self.own_speed,
            axes: self.listed_axes(),
        });
        plan.limits = Limits {
            displacement: within(1e-3),
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

    /// The axes as the plan lists them; it lists none for a specimen of one degree of freedom.
    fn listed_axes(&self) -> Vec<AxisPlan> {
        let Test::Frame(test) = &self.test else {
            return Vec::new();
        };
        let axes = self.axes.iter().zip(test.stiffness_at_axes()).enumerate();
        let listed = axes.map(|(index, (axis, stiffness))| {
            let mut listed = AxisPlan {
                polarity: Some(self.sign(index)),
                displacement: axis.farthest.map(within),
                pretest_check: Some(pretest_check(stiffness)),
                ..AxisPlan::default()
            };
            match self.devices {
                Devices::NativeAndCells if index % 2 == 0 => {
                    let newtons_per_unit = vec![1.0];
                    listed.load_cell = Some(device(Dialect::Scpi { newtons_per_unit }));
                }
                Devices::NativeAndCells => {
                    listed.load_cell = Some(device(Dialect::Hx711));
                    listed.calibration.newtons_per_count = Some(0.01);
                    listed.calibration.zero_offset = Some(700.0);
                }
                Devices::Sites if index > 0 => {
                    listed.actuator = Some(device(site(index..index + 1)));
                }
                _ => {}
            }
            listed
        });
        let axial = test.axial.map(|axial| AxisPlan {
            polarity: Some(self.sign(self.axes.len() - 1)),
            displacement: Some(within(2e-4)),
            axial: Some(AxialAxis {
                storey: axial.storey,
                rate: 5e3,
                tolerance: 20.0,
                p_delta: 1.0,
            }),
            ..AxisPlan::default()
        });
        listed.chain(axial).collect()
    }

    /// +1 or −1 \[-\].
    fn sign(&self, axis: usize) -> f64 {
        if self.axes[axis].turned { -1.0 } else { 1.0 }
    }

    /// Whether the controller or the load cell of an axis is a device of this axis alone.
    fn has_own(&self, part: Part) -> bool {
        match self.devices {
            Devices::NativeAndCells => part.on_load_cell,
            Devices::Sites => !part.on_load_cell && part.axis > 0,
            _ => false,
        }
    }

    /// Line of a part of the rig; that of the first controller, if there is no such line.
    pub(super) fn line_of(&self, part: Part) -> usize {
        match (self.devices, part.on_load_cell) {
            (Devices::Sites, false) => part.axis,
            (Devices::NativeAndCells, true) => 1 + part.axis,
            (_, true) if self.dialects().1.is_some() => 1,
            _ => 0,
        }
    }

    fn resolution(&self) -> f64 {
        if self.devices == Devices::Mark10 {
            1e-5
        } else {
            1e-6
        }
    }

    /// The actuator of the rig, and its load cell if that is a device apart.
    fn dialects(&self) -> (Dialect, Option<Dialect>) {
        match self.devices {
            Devices::Native | Devices::NativeAndCells => (Dialect::Native, None),
            Devices::NativeAndMeter => {
                let newtons_per_unit = vec![1.0; self.axes.len()];
                (Dialect::Native, Some(Dialect::Scpi { newtons_per_unit }))
            }
            Devices::GrblAndHx711 => (Dialect::Grbl, Some(Dialect::Hx711)),
            Devices::GrblAndIndicator => (Dialect::Grbl, Some(Dialect::Indicator)),
            Devices::GrblAndScpi => {
                let newtons_per_unit = vec![1.0];
                (Dialect::Grbl, Some(Dialect::Scpi { newtons_per_unit }))
            }
            Devices::GrblAndGauge => (Dialect::Grbl, Some(Dialect::Mark10Gauge)),
            Devices::Instron => (Dialect::Instron, None),
            Devices::Mark10 => (Dialect::Mark10, None),
            Devices::Nees => (site(0..self.axes.len()), None),
            Devices::Sites => (site(0..1), None),
            Devices::Modbus(registers) => (Dialect::Modbus(map(registers)), None),
        }
    }

    /// Whether the rig reports its serial number and its power-up.
    pub(super) const fn tells_identity(&self) -> bool {
        matches!(
            self.devices,
            Devices::Native | Devices::NativeAndMeter | Devices::NativeAndCells
        )
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
            faults: faults
                .iter()
                .filter_map(|fault| self.scripted(fault))
                .collect(),
            starts: (0..).zip(self.axes.iter().map(|axis| axis.start)).collect(),
        };
        of_plan(&plan, &script, log, self.seed, Some(boot)).expect("the plan has a specimen")
    }

    /// The fault as the emulator scripts it. None: it is a fault of another part.
    fn scripted(&self, fault: &Fault) -> Option<ScriptedFault> {
        let controller = |axis| Part {
            axis,
            on_load_cell: false,
        };
        let (part, when, what) = match fault {
            Fault::Reply {
                after,
                on,
                count,
                what,
            } => (
                *on,
                When::AfterReplies(*after),
                What::Replies(*what, Some(*count)),
            ),
            Fault::Controller { after, axis, what } => (
                controller(*axis),
                When::AfterReplies(*after),
                What::Line(*what),
            ),
            Fault::Mechanical { after, axis, what } => (
                controller(*axis),
                When::AfterMoves(*after),
                What::Rig(what.clone()),
            ),
            _ => return None,
        };
        Some(ScriptedFault {
            on_load_cell: part.on_load_cell,
            own_of: self.has_own(part).then_some(part.axis),
            actuator: part.axis,
            when,
            what,
        })
    }

    pub(super) fn witness(&self) -> Witness {
        let all = Obeys {
            speed: true,
            stop: true,
            coarse: 0.0,
            by_time: self.devices == Devices::Instron,
        };
        let obeys = match self.devices {
            Devices::Nees | Devices::Sites => Obeys {
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
        let plan = self.plan();
        let coordinates = (0..self.axes.len()).map(|axis| (self.sign(axis), self.axes[axis].start));
        let near = (self.resolution(), plan.rig.settle.band);
        let mut witness = Witness::new(obeys, coordinates.collect(), near);
        witness.limits_of(&plan);
        witness
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
            Amendment::Limits(farthest) => plan.limits.displacement = within(*farthest),
            Amendment::AxisLimits(axis, farthest) => {
                // A site does not report its limits: the plan stays within them.
                if let Link::Real(link) = &mut plan.rig.link {
                    let own = &mut link.axes[*axis].displacement;
                    let before = own.map_or(f64::INFINITY, |before| before.high);
                    *own = Some(within(farthest.min(before)));
                }
            }
            Amendment::Steps(load, steps) => {
                if let ProcedureKind::Shake(shake) = &mut plan.procedures[*load].kind {
                    shake.duration = Some(duration(*steps));
                }
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

/// The moves, each with its inspection.
fn moves(legs: &[Leg]) -> Vec<Procedure> {
    let mut procedures = Vec::new();
    for (index, leg) in legs.iter().enumerate() {
        let procedure = |name: &str, kind| Procedure {
            name: format!("{name}{index}"),
            kind,
        };
        procedures.push(procedure(
            "leg",
            ProcedureKind::Move(Move {
                to: Formula::Constant(leg.to),
                speed: leg.speed.map(Formula::Constant),
            }),
        ));
        if leg.inspected {
            let note = format!("look {index}");
            procedures.push(procedure("look", ProcedureKind::Inspect { note }));
        }
    }
    procedures
}

const fn within(farthest: f64) -> Interval {
    Interval {
        low: -farthest,
        high: farthest,
    }
}

/// The pre-test check of an axis with this stiffness \[N/m\].
const fn pretest_check(stiffness: f64) -> PretestCheck {
    PretestCheck {
        zero: 3.0,
        probe: 5e-5,
        stiffness: Interval {
            low: 0.5 * stiffness,
            high: 2.0 * stiffness,
        },
    }
}

/// A site with a control point for each of these axes.
fn site(axes: Range<usize>) -> Dialect {
    Dialect::Nees {
        control_points: axes.map(|axis| format!("MDL-00-0{}", axis + 1)).collect(),
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
