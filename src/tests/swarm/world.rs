//! The world of a life: the rig with its controllers, the lines, the clock, the signals. All in one thread and in simulated time, which
//! passes while psd waits. In: the bytes that psd sends. Out: those that it receives. It stops psd where a kill is due.

use std::io::{self, ErrorKind};
use std::panic::{panic_any, resume_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::disk::{Disk, Killed};
use super::fault::{CommandFault, Fault, Kill};
use super::laws::{Before, READ_WITHIN, Witness};
use psd_rig::StopRequest;
use psd_rig::emulator::{EmulatedRig, RigEmulator};
use psd_rig::transport::{Clock, Emergency, Port};

/// Interval between two checks of the controllers while time passes \[s\].
const SLICE: f64 = 0.02;
/// Time that a command takes \[s\]: time passes in a polling loop.
const COMMAND: f64 = 0.001;
/// Time in which a rig that moves is seen to move \[s\].
const LOOK: f64 = 0.1;
/// Longest session \[s\].
const LONGEST: f64 = 3600.0;

/// A session took longer than any session takes.
pub(super) struct Endless;

/// A world; its clones are the same.
#[derive(Clone)]
pub(super) struct World(Arc<Mutex<State>>);

pub(super) struct State {
    pub(super) bench: RigEmulator,
    pub(super) disk: Disk,
    pub(super) witness: Witness,
    pub(super) stop_request: StopRequest,
    /// Time before the power-up of the present rig \[s\].
    earlier: f64,
    /// Start of the session \[s\].
    began: f64,
    /// When the rig was last seen to move \[s\].
    moved: f64,
    commands: u32,
    faults: Vec<Fault>,
    kill: Option<Kill>,
    dead: bool,
    struck: Vec<&'static str>,
    /// Blocks of bytes that each line has received from the rig since its power-up.
    pub(super) replies: Vec<u64>,
}

impl World {
    pub(super) fn new(bench: RigEmulator, witness: Witness) -> Self {
        Self(Arc::new(Mutex::new(State {
            bench,
            disk: Disk::default(),
            witness,
            stop_request: StopRequest::default(),
            earlier: 0.0,
            began: 0.0,
            moved: f64::NEG_INFINITY,
            commands: 0,
            faults: Vec::new(),
            kill: None,
            dead: false,
            struck: Vec::new(),
            replies: Vec::new(),
        })))
    }

    /// Do not keep the guard.
    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// psd starts.
    pub(super) fn begin(&self, disk: Disk, faults: &[Fault], stop_request: StopRequest) {
        let mut state = self.lock();
        let now = state.now();
        (state.disk, state.stop_request, state.began) = (disk, stop_request, now);
        (state.commands, state.dead, state.kill) = (0, false, None);
        state.faults.clear();
        for fault in faults {
            match fault {
                Fault::Killed(kill) if !kill.at_the_disk => state.kill = Some(*kill),
                Fault::Command { .. } | Fault::HoldNow { .. } | Fault::StopAfterStep { .. } => {
                    state.faults.push(fault.clone());
                }
                _ => {}
            }
        }
        let obeys_late = state.bench.obeys_later();
        state.witness.begin(obeys_late);
    }

    /// psd is gone: its lines are dead.
    pub(super) fn die(&self) {
        let mut state = self.lock();
        state.dead = true;
        state.disk.die();
    }

    /// Another rig is at the lines from now on.
    pub(super) fn exchange(&self, bench: RigEmulator) {
        let mut state = self.lock();
        state.earlier = state.now();
        state.bench = bench;
        state.replies.clear();
        let State { bench, witness, .. } = &mut *state;
        witness.look_away(bench.rig());
    }

    /// Someone moves the rig by hand to a position of each lateral axis in its own coordinate \[m\]. An actuator that sticks stays, and
    /// its controller with it.
    pub(super) fn move_by_hand(&self, to: &[f64]) {
        let mut state = self.lock();
        let State { bench, witness, .. } = &mut *state;
        let axes: Vec<usize> = (0..to.len()).collect();
        let mut go = |to: &[f64]| {
            let rig = bench.rig_mut();
            let (speed, time) = (rig.settings().top_speed, rig.time());
            rig.go_those(None, &axes, to, speed);
            bench.advance(time + 1.0);
            let rig = bench.rig_mut();
            let reached = axes.iter().map(|axis| rig.displacement_of(*axis));
            reached.collect::<Vec<f64>>()
        };
        let reached = go(to);
        if reached != to {
            go(&reached);
        }
        witness.look_away(bench.rig());
    }

    pub(super) fn line(&self, line: usize) -> Line {
        self.lock().bench.connect(line);
        Line {
            world: self.clone(),
            index: line,
            come: Vec::new(),
        }
    }

    pub(super) fn clock(&self) -> WorldClock {
        WorldClock(self.clone())
    }

    /// Lets time pass \[s\].
    pub(super) fn pass(&self, seconds: f64) {
        let mut state = self.lock();
        state.pass(seconds);
        let endless = state.now() - state.began > LONGEST;
        drop(state);
        if endless {
            panic_any(Endless);
        }
    }

    /// Whether no axis of the rig moves, whatever its controller wants.
    pub(super) fn at_rest(&self) -> bool {
        let mut state = self.lock();
        if !state.bench.rig().moving() {
            return true;
        }
        let before = (
            displacements(state.bench.rig_mut()),
            loads(state.bench.rig()),
        );
        state.pass(LOOK);
        let now = (
            displacements(state.bench.rig_mut()),
            loads(state.bench.rig()),
        );
        let mut axes = now.0.iter().zip(&before.0);
        axes.all(|(now, before)| (now - before).abs() < 1e-9) && now.1 == before.1
    }

    /// Seconds that the life has taken so far.
    pub(super) fn now(&self) -> f64 {
        self.lock().now()
    }

    pub(super) fn take_struck(&self) -> Vec<&'static str> {
        let mut state = self.lock();
        let mut struck = std::mem::take(&mut state.struck);
        struck.extend(state.disk.struck());
        struck
    }
}

impl State {
    fn now(&self) -> f64 {
        self.earlier + self.bench.rig().time()
    }

    fn pass(&mut self, seconds: f64) {
        let until = self.bench.rig().time() + seconds;
        loop {
            let next = (self.bench.rig().time() + SLICE).min(until);
            self.observed(|bench| bench.advance(next));
            if next >= until {
                return;
            }
        }
    }

    /// Whatever the rig receives, the witness looks at it.
    fn observed(&mut self, act: impl FnOnce(&mut RigEmulator)) {
        let now = self.now();
        let rig = self.bench.rig_mut();
        let moving = rig.moving() || now - self.moved <= READ_WITHIN;
        let before = Before {
            positions: commanded(rig).into_iter().zip(displacements(rig)).collect(),
            forces: commanded_forces(rig),
            moving,
        };
        act(&mut self.bench);
        if self.bench.rig().moving() {
            self.moved = self.now();
        }
        self.witness.look(self.bench.rig(), &before, &self.disk);
        if self.witness.obeys_late && !self.bench.obeys_later() {
            self.witness.begin(false);
        }
    }

    /// The fault of this command, and the signals that arrive with it.
    fn due(&mut self) -> Option<CommandFault> {
        let now = self.commands;
        self.commands += 1;
        let mut found = None;
        let (struck, stop_request) = (&mut self.struck, &self.stop_request);
        self.faults.retain(|fault| {
            let at = match fault {
                Fault::Command { at, .. } | Fault::HoldNow { at } | Fault::StopAfterStep { at } => {
                    *at
                }
                _ => return false,
            };
            if at > now {
                return true;
            }
            struck.push(fault.name());
            match fault {
                Fault::HoldNow { .. } => stop_request.hold_now(),
                Fault::StopAfterStep { .. } => stop_request.stop_after_step(),
                Fault::Command { what, .. } => found = Some(*what),
                _ => {}
            }
            false
        });
        found
    }
}

/// The commanded position of each lateral axis \[m\].
pub(super) fn lateral_positions(rig: &EmulatedRig) -> Vec<f64> {
    let axes = (0..rig.actuators()).filter(|axis| !rig.is_axial(*axis));
    axes.map(|axis| rig.commanded_of(axis)).collect()
}

/// The commanded position of each axis \[m\].
fn commanded(rig: &EmulatedRig) -> Vec<f64> {
    let axes = 0..rig.actuators();
    axes.map(|axis| rig.commanded_of(axis)).collect()
}

/// The force that each axis is commanded to hold \[N\]. None: it holds a displacement.
pub(super) fn commanded_forces(rig: &EmulatedRig) -> Vec<Option<f64>> {
    let axes = 0..rig.actuators();
    axes.map(|axis| rig.force_control(axis).map(|control| control.target))
        .collect()
}

/// The true force of each axial axis \[N\].
fn loads(rig: &EmulatedRig) -> Vec<Option<f64>> {
    let axes = 0..rig.actuators();
    axes.map(|axis| rig.axial_force(axis)).collect()
}

/// The true position of each axis \[m\].
fn displacements(rig: &mut EmulatedRig) -> Vec<f64> {
    let axes = 0..rig.actuators();
    axes.map(|axis| rig.displacement_of(axis)).collect()
}

/// psd's end of a line.
pub(super) struct Line {
    world: World,
    index: usize,
    /// Bytes received and not yet read.
    come: Vec<u8>,
}

impl Line {
    fn fetch(&mut self) -> bool {
        if self.come.is_empty() {
            let mut state = self.world.lock();
            if let Some(bytes) = state.bench.take(self.index) {
                let lines = state.replies.len().max(self.index + 1);
                state.replies.resize(lines, 0);
                state.replies[self.index] += 1;
                self.come = bytes;
            }
        }
        !self.come.is_empty()
    }

    fn gone(&self) -> bool {
        let state = self.world.lock();
        state.dead || state.bench.hung_up(self.index)
    }
}

impl Port for Line {
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()> {
        if self.gone() {
            return Err(ErrorKind::BrokenPipe.into());
        }
        let mut state = self.world.lock();
        let now = state.commands;
        let fault = state.due();
        let kill = state.kill.filter(|kill| kill.at == now);
        if kill.is_none_or(|kill| kill.after) {
            if !state.bench.reads(self.index) {
                drop(state);
                self.world.pass(timeout.as_secs_f64());
                return Err(ErrorKind::TimedOut.into());
            }
            let bytes = match fault {
                Some(CommandFault::Lost) => Vec::new(),
                Some(CommandFault::Twice) => bytes.repeat(2),
                Some(CommandFault::Torn) => bytes[..bytes.len() / 2].to_vec(),
                None => bytes.to_vec(),
            };
            let index = self.index;
            state.pass(COMMAND);
            state.observed(|bench| bench.give(index, &bytes));
        }
        drop(state);
        if kill.is_some() {
            self.world.die();
            resume_unwind(Box::new(Killed));
        }
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = self.world.now() + timeout.as_secs_f64();
        while !self.fetch() {
            if self.gone() {
                return Err(ErrorKind::BrokenPipe.into());
            }
            let left = until - self.world.now();
            if left <= 0.0 {
                return Err(ErrorKind::TimedOut.into());
            }
            self.world.pass(left.min(SLICE));
        }
        let count = self.come.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.come[..count]);
        self.come.drain(..count);
        Ok(count)
    }

    fn discard(&mut self) -> io::Result<()> {
        self.come.clear();
        while self.fetch() {
            self.come.clear();
        }
        if self.gone() {
            Err(ErrorKind::BrokenPipe.into())
        } else {
            Ok(())
        }
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Err(ErrorKind::Unsupported.into())
    }
}

/// The time of the world.
pub(super) struct WorldClock(World);

impl Clock for WorldClock {
    fn now(&self) -> f64 {
        self.0.now()
    }

    fn sleep(&mut self, seconds: f64) {
        if seconds > 0.0 && seconds.is_finite() {
            self.0.pass(seconds);
        }
    }

    fn wall(&self) -> Option<String> {
        None
    }
}
