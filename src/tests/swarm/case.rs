//! One drawn life of a test: a plan, a rig, and what befalls them, session by session. In: a seed. Out: plain data, which can be printed
//! and reduced. It runs nothing.

use super::draw::Draw;
use super::fault::{Change, CommandFault, DiskFault, Fault, Kill};
use psd_plan::ModbusNumber;
use psd_rig::emulator::MechanicalFault;
use psd_rig::emulator::script::{GarbagePosition, LineFault, ReplyFault};

/// The devices of the rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Devices {
    Native,
    GrblAndHx711,
    GrblAndIndicator,
    GrblAndScpi,
    GrblAndGauge,
    Instron,
    Mark10,
    Nees,
    Modbus(Registers),
}

/// What the register map of a Modbus drive contains.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a register of its own"
)]
pub(super) struct Registers {
    pub(super) number: ModbusNumber,
    pub(super) speed: bool,
    pub(super) status: bool,
    pub(super) command: bool,
    /// The drive has the other word order than the plan.
    pub(super) swapped: bool,
}

/// A move of the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leg {
    /// \[m\]
    pub(super) to: f64,
    /// \[m/s\]; None: the own speed of the rig.
    pub(super) speed: Option<f64>,
    /// The operator inspects the specimen after it.
    pub(super) inspected: bool,
}

/// A change of the plan before a resumption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Amendment {
    OwnSpeed(f64),
    /// The limits of the displacement become ± this \[m\].
    Limits(f64),
    /// Speed of the leg with this index.
    Speed(usize, f64),
    /// Target of the leg with this index.
    Target(usize, f64),
}

/// What the operator answers in a session.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is an answer of its own"
)]
pub(super) struct Operator {
    /// Number of waits before each answer.
    pub(super) waits: u8,
    pub(super) releases: bool,
    pub(super) goes_on: bool,
    pub(super) unloads: bool,
    pub(super) notes: bool,
    pub(super) same_power_up: bool,
    pub(super) re_referenced: bool,
    pub(super) let_go: bool,
    pub(super) accept_relaxation: bool,
    pub(super) accept_speed: bool,
}

/// One start of psd: the run, or a resumption.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Session {
    /// What happened to the rig since the session before.
    pub(super) before: Vec<Change>,
    pub(super) amended: Vec<Amendment>,
    pub(super) faults: Vec<Fault>,
    pub(super) operator: Operator,
}

/// A life.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case {
    pub(super) seed: u64,
    pub(super) devices: Devices,
    /// Position of the rig before the run \[m\], which is the zero of the plan. None: the zero of the rig.
    pub(super) here: Option<f64>,
    pub(super) turned: bool,
    pub(super) noise: f64,
    pub(super) samples: u32,
    pub(super) unloads: bool,
    /// \[m/s\]
    pub(super) own_speed: f64,
    pub(super) legs: Vec<Leg>,
    pub(super) sessions: Vec<Session>,
}

/// Own speeds of a rig, and speeds of a leg \[m/s\]. No speed is in both.
const OWN_SPEEDS: [f64; 4] = [1e-3, 3e-3, 6e-3, 9e-3];
const SPEEDS: [f64; 3] = [2e-3, 4e-3, 8e-3];

impl Case {
    pub(super) fn of_seed(seed: u64) -> Self {
        let mut draw = Draw::of_seed(seed);
        let devices = devices(&mut draw);
        let homed = matches!(
            devices,
            Devices::GrblAndHx711
                | Devices::GrblAndIndicator
                | Devices::GrblAndScpi
                | Devices::GrblAndGauge
        );
        // A homed Grbl has left its switch by 1 mm.
        let here = if homed {
            Some(-1e-3)
        } else {
            draw.chance(0.25)
                .then(|| f64::from(draw.between(1, 30)) * 1e-4)
        };
        let legs = legs(&mut draw);
        let first = session(&mut draw, devices, legs.len(), true);
        let later = draw.between(0, 3);
        let sessions = std::iter::once(first)
            .chain((0..later).map(|_| session(&mut draw, devices, legs.len(), false)))
            .collect();
        Self {
            seed,
            devices,
            here,
            turned: draw.chance(0.2),
            noise: if draw.chance(0.3) { 0.05 } else { 0.0 },
            samples: if draw.chance(0.3) { 3 } else { 1 },
            unloads: draw.chance(0.2),
            own_speed: draw.one_of(&OWN_SPEEDS),
            legs,
            sessions,
        }
    }
}

fn devices(draw: &mut Draw) -> Devices {
    match draw.between(0, 16) {
        0..=5 => Devices::Native,
        6 => Devices::GrblAndHx711,
        7 => Devices::GrblAndIndicator,
        8 => Devices::GrblAndScpi,
        9 => Devices::GrblAndGauge,
        10 => Devices::Instron,
        11 => Devices::Mark10,
        12 => Devices::Nees,
        _ => {
            let high_word_first = draw.chance(0.5);
            let number = match draw.between(0, 4) {
                0 => ModbusNumber::Int16,
                1 => ModbusNumber::Int32 { high_word_first },
                _ => ModbusNumber::Float32 { high_word_first },
            };
            Devices::Modbus(Registers {
                number,
                speed: draw.chance(0.5),
                status: draw.chance(0.7),
                command: draw.chance(0.5),
                swapped: draw.chance(0.3),
            })
        }
    }
}

/// One to three moves of at least 0.1 mm, to targets that are all different.
fn legs(draw: &mut Draw) -> Vec<Leg> {
    let mut targets: Vec<u32> = vec![1, 2, 3, 4, 5, 6];
    (0..draw.between(1, 4))
        .map(|_| {
            let at = draw.below(targets.len());
            let target = f64::from(targets.remove(at)) * 1e-4;
            Leg {
                to: if draw.chance(0.3) { -target } else { target },
                speed: draw.chance(0.4).then(|| draw.one_of(&SPEEDS)),
                inspected: draw.chance(0.15),
            }
        })
        .collect()
}

fn session(draw: &mut Draw, devices: Devices, legs: usize, first: bool) -> Session {
    let mut faults = Vec::new();
    for _ in 0..draw.few() {
        faults.push(of_the_rig(draw, devices));
    }
    if draw.chance(if first { 0.6 } else { 0.3 }) {
        faults.push(Fault::Killed(killed(draw)));
    }
    if draw.chance(0.15) {
        faults.push(of_the_disk(draw));
    }
    if draw.chance(0.1) {
        let at = draw.between(0, 100);
        faults.push(if draw.chance(0.5) {
            Fault::HoldNow { at }
        } else {
            Fault::StopAfterStep { at }
        });
    }
    if draw.chance(0.1) {
        let mut faults_of_a_command = vec![CommandFault::Lost, CommandFault::Twice];
        // Without a checksum, the rest of a command is another command: no program can prevent that.
        if matches!(devices, Devices::Native | Devices::Modbus(_)) {
            faults_of_a_command.push(CommandFault::Torn);
        }
        let what = draw.one_of(&faults_of_a_command);
        faults.push(Fault::Command {
            at: draw.between(0, 100),
            what,
        });
    }
    let (mut before, mut amended) = (Vec::new(), Vec::new());
    if !first {
        for _ in 0..draw.few() {
            before.push(change(draw));
        }
        if draw.chance(0.35) {
            amended.push(amendment(draw, legs));
        }
    }
    Session {
        before,
        amended,
        faults,
        operator: Operator {
            waits: if draw.chance(0.2) { 2 } else { 0 },
            releases: !draw.chance(0.04),
            goes_on: !draw.chance(0.1),
            unloads: draw.chance(0.5),
            notes: draw.chance(0.1),
            same_power_up: draw.chance(0.7),
            re_referenced: draw.chance(0.3),
            let_go: draw.chance(0.8),
            accept_relaxation: draw.chance(0.15),
            accept_speed: draw.chance(0.5),
        },
    }
}

fn of_the_rig(draw: &mut Draw, devices: Devices) -> Fault {
    let after = u64::from(draw.between(0, 140));
    match draw.between(0, 10) {
        0..=5 => {
            let (on_load_cell, many) = (draw.chance(0.3), draw.chance(0.1));
            let what = reply(draw);
            // psd discards what it has not asked for. A drive whose every answer is the one before it would have to send each of them
            // in time, and all look alike: position for force, force for position.
            let alike = matches!(devices, Devices::Modbus(_)) && what == ReplyFault::Replay;
            Fault::Reply {
                after,
                on_load_cell,
                count: if many && !alike { 40 } else { 1 },
                what,
            }
        }
        6 | 7 => Fault::Controller {
            after,
            what: match draw.between(0, 5) {
                0 => LineFault::HangUp,
                1 => LineFault::StopReading,
                2 => LineFault::FreezeFirmware(f64::from(draw.between(1, 40)) * 0.1),
                // This stand then has another zero and another mode, and a letter that is on its way has another meaning.
                _ if devices == Devices::Mark10 => LineFault::HangUp,
                _ => LineFault::Reboot,
            },
        },
        _ => Fault::Mechanical {
            after: u64::from(draw.between(0, 6)),
            what: match draw.between(0, 6) {
                0 => MechanicalFault::Reach(0.0),
                1 => MechanicalFault::Lag(0.2),
                2 => MechanicalFault::FreezeForce,
                3 => MechanicalFault::Spike(500.0),
                4 => MechanicalFault::ScaleForce(-1.0),
                _ => MechanicalFault::Fracture {
                    displacement: 2e-4,
                    left: 0.1,
                },
            },
        },
    }
}

fn reply(draw: &mut Draw) -> ReplyFault {
    match draw.between(0, 8) {
        0 => ReplyFault::Drop,
        1 => ReplyFault::Delay(u64::from(draw.between(20, 500))),
        2 => ReplyFault::Repeat,
        3 => ReplyFault::CutAt(draw.below(12)),
        4 => ReplyFault::Replay,
        5 => ReplyFault::FlipBit(None),
        6 => ReplyFault::SplitAt(1 + draw.below(10)),
        _ => ReplyFault::Garbage {
            count: 1 + draw.below(30),
            byte: None,
            position: draw.one_of(&[
                GarbagePosition::Before,
                GarbagePosition::Inside,
                GarbagePosition::After,
            ]),
        },
    }
}

fn killed(draw: &mut Draw) -> Kill {
    let at_the_disk = draw.chance(0.7);
    Kill {
        at_the_disk,
        at: if at_the_disk {
            draw.between(2, 70)
        } else {
            draw.between(0, 120)
        },
        after: draw.chance(0.5),
        power: draw
            .chance(0.4)
            .then(|| (draw.below(400), u64::from(draw.between(0, 16)))),
    }
}

fn of_the_disk(draw: &mut Draw) -> Fault {
    let at = draw.between(4, 70);
    Fault::Disk {
        at,
        what: match draw.between(0, 4) {
            0 => DiskFault::Full {
                reserve: draw.chance(0.7),
            },
            1 => DiskFault::TornWrite,
            2 => DiskFault::FailedFlush,
            _ => DiskFault::LostFlushes(draw.between(1, 12)),
        },
    }
}

fn change(draw: &mut Draw) -> Change {
    match draw.between(0, 6) {
        0 => Change::Waits(f64::from(draw.between(1, 50)) * 0.1),
        1 => Change::OtherRig {
            loaded: draw.chance(0.5),
        },
        2 => Change::Restarted,
        3 => Change::OtherPlace(f64::from(draw.between(1, 8)) * 5e-5),
        _ => Change::ForceGone,
    }
}

fn amendment(draw: &mut Draw, legs: usize) -> Amendment {
    match draw.between(0, 5) {
        0 | 1 => Amendment::OwnSpeed(draw.one_of(&OWN_SPEEDS)),
        2 => Amendment::Limits(f64::from(draw.between(1, 8)) * 1e-4),
        3 => Amendment::Speed(draw.below(legs), draw.one_of(&SPEEDS)),
        _ => Amendment::Target(draw.below(legs), f64::from(draw.between(1, 7)) * 1e-4),
    }
}
