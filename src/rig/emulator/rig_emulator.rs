//! A rig emulator: one emulated rig and its controllers, each on a separate line. In: bytes of a line, time. Out: bytes of a line. It knows
//! neither whether its time is real nor the transport of the bytes.

use super::script::{Script, ScriptedFault};
use super::{EmulatedRig, Faulty, Firmware, Log};

/// Everything behind the ports of an emulated rig.
pub struct RigEmulator {
    rig: EmulatedRig,
    lines: Vec<EmulatedLine>,
    log: Log,
}

struct EmulatedLine {
    name: String,
    controller: Faulty,
    /// Whether its hang-up is in the log.
    hangup_sent: bool,
}

impl RigEmulator {
    /// A rig emulator without lines.
    #[must_use]
    pub const fn new(rig: EmulatedRig, log: Log) -> Self {
        Self {
            rig,
            lines: Vec::new(),
            log,
        }
    }

    /// A rig emulator with its controllers, each with its name, the actuators first. A fault affects the controller that its line
    /// names. For a load cell without an axis this is the first load cell, otherwise the first controller.
    #[must_use]
    pub fn with_controllers(
        rig: EmulatedRig,
        log: Log,
        script: &Script,
        controllers: Vec<(String, Box<dyn Firmware>)>,
    ) -> Self {
        let mut emulator = Self::new(rig, log);
        let names: Vec<String> = controllers.iter().map(|(name, _)| name.clone()).collect();
        for (at, (name, firmware)) in controllers.into_iter().enumerate() {
            let befalls = |fault: &&ScriptedFault| at == fault.line_index(&names).unwrap_or(0);
            let faults = script.faults.iter().filter(befalls).cloned().collect();
            let controller = Faulty::new(
                firmware,
                faults,
                emulator.rig.settings().seed.wrapping_add(at as u64),
            );
            emulator.lines.push(EmulatedLine {
                name,
                controller,
                hangup_sent: false,
            });
        }
        emulator
    }

    #[must_use]
    pub const fn rig(&self) -> &EmulatedRig {
        &self.rig
    }

    /// The emulated rig, for what befalls it beside its controllers.
    pub const fn rig_mut(&mut self) -> &mut EmulatedRig {
        &mut self.rig
    }

    /// Advances everything to a later time since power-up \[s\].
    pub fn advance(&mut self, to: f64) {
        self.rig.advance(to);
        for line in &mut self.lines {
            line.controller.tick(&mut self.rig);
        }
        self.follow();
    }

    /// Receives bytes from the host of a line. They are lost if the line is hung up.
    pub fn give(&mut self, line: usize, bytes: &[u8]) {
        let line = &mut self.lines[line];
        if line.controller.hung_up() || bytes.is_empty() {
            return;
        }
        self.log.from_host(self.rig.time(), &line.name, bytes);
        line.controller.receive(bytes, &mut self.rig);
        self.follow();
    }

    /// Returns one block of bytes that a line has for its host now.
    pub fn take(&mut self, line: usize) -> Option<Vec<u8>> {
        let time = self.rig.time();
        let piece = self.lines[line].controller.take(time);
        if let Some(bytes) = &piece {
            self.log.to_host(time, &self.lines[line].name, bytes);
        }
        self.follow();
        piece
    }

    /// Whether a line reads bytes.
    #[must_use]
    pub fn reads(&self, line: usize) -> bool {
        self.lines[line].controller.reads()
    }

    /// Whether a controller has received bytes that it will obey later, because its firmware is frozen.
    #[must_use]
    pub fn obeys_later(&self) -> bool {
        self.lines.iter().any(|line| line.controller.obeys_later())
    }

    #[must_use]
    pub fn hung_up(&self, line: usize) -> bool {
        self.lines[line].controller.hung_up()
    }

    /// A host opened the line.
    pub fn connect(&mut self, line: usize) {
        let line = &mut self.lines[line];
        line.controller.reconnect();
        line.hangup_sent = false;
        self.log.happened(self.rig.time(), &line.name, "opened");
    }

    /// The host of a line disconnected.
    pub fn host_left(&mut self, line: usize) {
        self.log
            .happened(self.rig.time(), &self.lines[line].name, "host left");
    }

    /// Writes the end of the log. Returns whether every target was within the limits.
    pub fn end(&mut self) -> bool {
        self.log.end(&self.rig)
    }

    /// Returns the write error of the log, if there was one.
    pub const fn log_failure(&mut self) -> Option<std::io::Error> {
        self.log.failure()
    }

    fn follow(&mut self) {
        self.log.follow(&self.rig);
        for line in &mut self.lines {
            if line.controller.hung_up() && !line.hangup_sent {
                line.hangup_sent = true;
                self.log.happened(self.rig.time(), &line.name, "hung up");
            }
        }
    }
}
