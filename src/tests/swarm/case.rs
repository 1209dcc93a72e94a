//! One drawn life of a test: a plan, a rig, and what befalls them, session by session. In: a seed. Out: plain data, which can be printed
//! and reduced. It runs nothing.

use super::draw::Draw;
use super::fault::{Change, CommandFault, DiskFault, Fault, Kill, Part};
use super::frame::FrameTest;
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
    /// A controller of all axes, and a meter with a channel for each.
    NativeAndMeter,
    /// A controller of all axes, and a load cell for each.
    NativeAndCells,
    /// A NEES site for each axis.
    Sites,
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

/// An axis of the rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Its position before the run \[m\].
    pub(super) start: f64,
    pub(super) turned: bool,
    /// Its own limits are ± this \[m\]. None: those of the run.
    pub(super) farthest: Option<f64>,
}

/// What the test does.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Test {
    /// Moves of one axis.
    Moves(Vec<Leg>),
    Frame(FrameTest),
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
    /// The own limits of an axis become ± this \[m\], if that is narrower.
    AxisLimits(usize, f64),
    /// Steps of the procedure with this index, if it is a ground motion.
    Steps(usize, u32),
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
    /// Whether the zero of the plan is the position before the run. Otherwise it is the zero of the rig.
    pub(super) here: bool,
    pub(super) axes: Vec<Axis>,
    pub(super) noise: f64,
    pub(super) samples: u32,
    pub(super) unloads: bool,
    /// \[m/s\]
    pub(super) own_speed: f64,
    pub(super) test: Test,
    pub(super) sessions: Vec<Session>,
}

/// Own speeds of a rig, and speeds of a leg \[m/s\]. No speed is in both.
const OWN_SPEEDS: [f64; 4] = [1e-3, 3e-3, 6e-3, 9e-3];
const SPEEDS: [f64; 3] = [2e-3, 4e-3, 8e-3];

/// Fraction of the lives with a frame.
const FRAMES: f64 = 0.2;

impl Case {
    pub(super) fn of_seed(seed: u64) -> Self {
        let mut draw = Draw::of_seed(seed);
        let test = if draw.chance(FRAMES) {
            Test::Frame(FrameTest::drawn(&mut draw))
        } else {
            Test::Moves(legs(&mut draw))
        };
        let devices = match &test {
            Test::Moves(_) => of_one_axis(&mut draw),
            // No other protocol has force control.
            Test::Frame(test) if test.axial.is_some() => Devices::Native,
            Test::Frame(_) => of_a_frame(&mut draw),
        };
        let homed = matches!(
            devices,
            Devices::GrblAndHx711
                | Devices::GrblAndIndicator
                | Devices::GrblAndScpi
                | Devices::GrblAndGauge
        );
        let here = homed || draw.chance(0.25);
        let lateral = test.lateral_axes();
        let axes = (0..test.axes()).map(|axis| Axis {
            start: match (homed, here) {
                // A homed Grbl has left its switch by 1 mm.
                (true, _) => -1e-3,
                (_, true) if axis < lateral => f64::from(draw.between(1, 30)) * 1e-4,
                _ => 0.0,
            },
            turned: draw.chance(0.2),
            farthest: (matches!(test, Test::Frame(_)) && axis < lateral && draw.chance(0.3))
                .then(|| f64::from(draw.between(2, 9)) * 1e-4),
        });
        let axes = axes.collect();
        let first = session(&mut draw, devices, &test, true);
        let later = draw.between(0, 3);
        let sessions = std::iter::once(first)
            .chain((0..later).map(|_| session(&mut draw, devices, &test, false)))
            .collect();
        Self {
            seed,
            devices,
            here,
            axes,
            noise: if draw.chance(0.3) { 0.05 } else { 0.0 },
            samples: if draw.chance(0.3) { 3 } else { 1 },
            unloads: draw.chance(0.2),
            own_speed: draw.one_of(&OWN_SPEEDS),
            test,
            sessions,
        }
    }
}

impl Case {
    /// Whether every reading is that of the specimen of the plan: nothing befalls the rig itself, the motion of the plan stays, and no line
    /// can give another number.
    pub(super) fn reads_the_truth(&self) -> bool {
        let is_checked = self.devices == Devices::Native;
        let faults = self.sessions.iter().flat_map(|session| &session.faults);
        let changes = self.sessions.iter().flat_map(|session| &session.before);
        let amended = self.sessions.iter().flat_map(|session| &session.amended);
        // The readings of a drive can show the order of its words to the second session alone: the first is then refused.
        let is_shown = !matches!(self.devices, Devices::Modbus(_));
        self.noise == 0.0
            && is_shown
            && { amended }.all(|amendment| {
                matches!(
                    amendment,
                    Amendment::OwnSpeed(_) | Amendment::Limits(_) | Amendment::AxisLimits(..)
                )
            })
            && { changes }.all(|change| match change {
                Change::Waits(_) => true,
                // The emulated specimen is a new one.
                Change::Restarted => !matches!(&self.test, Test::Frame(test) if test.yields()),
                _ => false,
            })
            && { faults }.all(|fault| match fault {
                Fault::Mechanical { .. } => false,
                Fault::Reply { what, .. } => {
                    is_checked || matches!(what, ReplyFault::Drop | ReplyFault::SplitAt(_))
                }
                _ => true,
            })
    }

    /// By how much the floors of two runs of this test can differ in position \[m\] and force \[N\]; not at all if both are 0.
    pub(super) fn differs_within(&self) -> [f64; 2] {
        let mut faults = self.sessions.iter().flat_map(|session| &session.faults);
        let is_held = !faults.all(|fault| matches!(fault, Fault::Killed(_)));
        match &self.test {
            // A rig that was held within the settling band of its target is read where it stands.
            Test::Frame(_) if is_held || self.is_restarted() => [2e-5, 8.0],
            // The emulated specimen rounds its force by the instants at which it is read: the last digit on the line can differ. The native
            // line resolves 1 nm and 1 mN of a rig.
            Test::Frame(test) if test.yields() => [1e-8, 0.1],
            _ => [0.0; 2],
        }
    }

    fn is_restarted(&self) -> bool {
        let mut changes = self.sessions.iter().flat_map(|session| &session.before);
        changes.any(|change| *change == Change::Restarted)
    }

    /// The same test in one session, in which nothing happens.
    pub(super) fn undisturbed(&self) -> Self {
        let operator = Operator {
            releases: true,
            goes_on: true,
            notes: false,
            waits: 0,
            ..self.sessions[0].operator
        };
        Self {
            sessions: vec![Session {
                before: Vec::new(),
                amended: Vec::new(),
                faults: Vec::new(),
                operator,
            }],
            ..self.clone()
        }
    }
}

impl Test {
    /// Axes of the rig, the axial one behind the others.
    pub(super) fn axes(&self) -> usize {
        match self {
            Self::Moves(_) => 1,
            Self::Frame(test) => self.lateral_axes() + usize::from(test.axial.is_some()),
        }
    }

    /// Axes of the rig that move a storey sideways, or an element.
    fn lateral_axes(&self) -> usize {
        match self {
            Self::Moves(_) => 1,
            Self::Frame(test) => test.stiffness_at_axes().len(),
        }
    }

    /// How much longer it takes than some moves of one axis.
    fn length(&self) -> u32 {
        match self {
            Self::Moves(_) => 1,
            Self::Frame(_) => 2,
        }
    }
}

fn of_a_frame(draw: &mut Draw) -> Devices {
    draw.one_of(&[
        Devices::Native,
        Devices::Native,
        Devices::NativeAndMeter,
        Devices::NativeAndCells,
        Devices::Nees,
        Devices::Sites,
    ])
}

fn of_one_axis(draw: &mut Draw) -> Devices {
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

fn session(draw: &mut Draw, devices: Devices, test: &Test, first: bool) -> Session {
    let length = test.length();
    let mut faults = Vec::new();
    for _ in 0..draw.few() {
        faults.push(of_the_rig(draw, devices, test));
    }
    if draw.chance(if first { 0.6 } else { 0.3 }) {
        faults.push(Fault::Killed(killed(draw, length)));
    }
    if draw.chance(0.15) {
        faults.push(of_the_disk(draw, length));
    }
    if draw.chance(0.1) {
        let at = draw.between(0, 100 * length);
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
            at: draw.between(0, 100 * length),
            what,
        });
    }
    let (mut before, mut amended) = (Vec::new(), Vec::new());
    if !first {
        for _ in 0..draw.few() {
            before.push(change(draw, test));
        }
        if draw.chance(0.35) {
            amended.push(amendment(draw, test));
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

fn of_the_rig(draw: &mut Draw, devices: Devices, test: &Test) -> Fault {
    let after = u64::from(draw.between(0, 140 * test.length()));
    let axis = draw.below(test.axes());
    match draw.between(0, 10) {
        0..=5 => {
            let (on_load_cell, many) = (draw.chance(0.3), draw.chance(0.1));
            let on = Part { axis, on_load_cell };
            let what = reply(draw);
            // psd discards what it has not asked for. A drive whose every answer is the one before it would have to send each of them
            // in time, and all look alike: position for force, force for position.
            let alike = matches!(devices, Devices::Modbus(_)) && what == ReplyFault::Replay;
            Fault::Reply {
                after,
                on,
                count: if many && !alike { 40 } else { 1 },
                what,
            }
        }
        6 | 7 => Fault::Controller {
            after,
            axis,
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
            after: u64::from(draw.between(0, 6 * test.length())),
            axis,
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

fn killed(draw: &mut Draw, length: u32) -> Kill {
    let at_the_disk = draw.chance(0.7);
    Kill {
        at_the_disk,
        at: if at_the_disk {
            draw.between(2, 70 * length)
        } else {
            draw.between(0, 120 * length)
        },
        after: draw.chance(0.5),
        power: draw
            .chance(0.4)
            .then(|| (draw.below(400), u64::from(draw.between(0, 16)))),
    }
}

fn of_the_disk(draw: &mut Draw, length: u32) -> Fault {
    let at = draw.between(4, 70 * length);
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

fn change(draw: &mut Draw, test: &Test) -> Change {
    match draw.between(0, 6) {
        0 => Change::Waits(f64::from(draw.between(1, 50)) * 0.1),
        1 => Change::OtherRig {
            loaded: draw.chance(0.5),
        },
        2 => Change::Restarted,
        3 => Change::OtherPlace {
            axis: draw.below(test.lateral_axes()),
            by: f64::from(draw.between(1, 8)) * 5e-5,
        },
        _ => Change::ForceGone {
            axis: draw.below(test.axes()),
        },
    }
}

fn amendment(draw: &mut Draw, test: &Test) -> Amendment {
    let of_the_rig = |draw: &mut Draw, drawn: u32| match drawn {
        0 | 1 => Amendment::OwnSpeed(draw.one_of(&OWN_SPEEDS)),
        _ => Amendment::Limits(f64::from(draw.between(1, 8)) * 1e-4),
    };
    match (test, draw.between(0, 5)) {
        (_, drawn @ 0..=2) => of_the_rig(draw, drawn),
        (Test::Moves(legs), 3) => Amendment::Speed(draw.below(legs.len()), draw.one_of(&SPEEDS)),
        (Test::Moves(legs), _) => {
            Amendment::Target(draw.below(legs.len()), f64::from(draw.between(1, 7)) * 1e-4)
        }
        (Test::Frame(_), 3) => Amendment::AxisLimits(
            draw.below(test.lateral_axes()),
            f64::from(draw.between(1, 8)) * 1e-4,
        ),
        (Test::Frame(test), _) => Amendment::Steps(
            test.before_loads() + draw.below(test.loads.len()),
            draw.between(5, 12),
        ),
    }
}
