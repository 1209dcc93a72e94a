//! A stand: one bench and its controllers, each on a separate line. In: bytes of a line, time. Out: bytes of a line. It knows
//! neither whether its time is real nor the transport of the bytes.

use super::script::{Fault, Script};
use super::{Bench, Faulty, Firmware, Log};

/// Everything behind the ports of an emulated rig.
pub struct Stand {
    bench: Bench,
    lines: Vec<Line>,
    log: Log,
}

struct Line {
    name: String,
    controller: Faulty,
    /// Whether its hang-up is in the log.
    told: bool,
}

impl Stand {
    /// A stand without lines.
    #[must_use]
    pub const fn new(bench: Bench, log: Log) -> Self {
        Self {
            bench,
            lines: Vec::new(),
            log,
        }
    }

    /// A stand with its controllers, each with its name, the actuators first. A fault affects the controller that its line
    /// names. For a load cell without an axis this is the first load cell, otherwise the first controller.
    #[must_use]
    pub fn of(
        bench: Bench,
        log: Log,
        script: &Script,
        controllers: Vec<(String, Box<dyn Firmware>)>,
    ) -> Self {
        let mut stand = Self::new(bench, log);
        let names: Vec<String> = controllers.iter().map(|(name, _)| name.clone()).collect();
        for (at, (name, firmware)) in controllers.into_iter().enumerate() {
            let befalls = |fault: &&Fault| at == fault.place_among(&names).unwrap_or(0);
            let faults = script.faults.iter().filter(befalls).cloned().collect();
            let controller = Faulty::new(
                firmware,
                faults,
                stand.bench.settings().seed.wrapping_add(at as u64),
            );
            stand.lines.push(Line {
                name,
                controller,
                told: false,
            });
        }
        stand
    }

    #[must_use]
    pub const fn bench(&self) -> &Bench {
        &self.bench
    }

    /// For a test that starts a fault by hand.
    pub const fn bench_mut(&mut self) -> &mut Bench {
        &mut self.bench
    }

    /// The number of lines, which are numbered from 0.
    #[must_use]
    pub fn lines(&self) -> usize {
        self.lines.len()
    }

    /// Advances everything to a later time since power-up \[s\].
    pub fn advance(&mut self, to: f64) {
        self.bench.advance(to);
        for line in &mut self.lines {
            line.controller.tick(&mut self.bench);
        }
        self.follow();
    }

    /// Receives bytes from the host of a line. They are lost if the line is hung up.
    pub fn give(&mut self, line: usize, bytes: &[u8]) {
        let line = &mut self.lines[line];
        if line.controller.hung_up() || bytes.is_empty() {
            return;
        }
        self.log.from_host(self.bench.time(), &line.name, bytes);
        line.controller.receive(bytes, &mut self.bench);
        self.follow();
    }

    /// Returns one block of bytes that a line has for its host now.
    pub fn take(&mut self, line: usize) -> Option<Vec<u8>> {
        let time = self.bench.time();
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

    #[must_use]
    pub fn hung_up(&self, line: usize) -> bool {
        self.lines[line].controller.hung_up()
    }

    /// A host opened the line.
    pub fn connect(&mut self, line: usize) {
        let line = &mut self.lines[line];
        line.controller.reconnect();
        line.told = false;
        self.log.happened(self.bench.time(), &line.name, "opened");
    }

    /// The host of a line disconnected.
    pub fn host_left(&mut self, line: usize) {
        self.log
            .happened(self.bench.time(), &self.lines[line].name, "host left");
    }

    /// Writes the end of the log. Returns whether every target was within the limits.
    pub fn end(&mut self) -> bool {
        self.log.end(&self.bench)
    }

    /// Returns the write error of the log, if there was one.
    pub const fn log_failure(&mut self) -> Option<std::io::Error> {
        self.log.failure()
    }

    fn follow(&mut self) {
        self.log.follow(&self.bench);
        for line in &mut self.lines {
            if line.controller.hung_up() && !line.told {
                line.told = true;
                self.log.happened(self.bench.time(), &line.name, "hung up");
            }
        }
    }
}
