//! The log of an emulated rig: the bytes on its lines and its moves. It can be compared with the run log of the
//! host. In: bytes and moves with their times. Out: text, one event per line.
//!
//! ```text
//! 0.012000 actuator > >MOVE 41 17 1.250000 0.500000*6858\n          bytes from the host
//! 0.012000 actuator < <ACK 41 7F3A MOVING*1F01\n                    bytes to the host
//! 0.012000 bench move 17 to 0.00125 m at 0.0005 m/s                 or `move -` if the protocol has no numbers
//! 0.012000 bench move 17 to 0.00125 m, -0.002 m at 0.0005 m/s       with several actuators
//! 9.000000 bench outside 0.0300000 m                                a target outside the limits
//! 9.500000 actuator (hung up)
//! 9.600000 end: 1 target outside the limits: FAILED                 or `end: 12 moves, all within the limits: ok`
//! ```

use std::io::{self, Write};

use super::EmulatedRig;
use psd_text::count::counted;

/// Writes the events of one rig emulator.
pub struct Log {
    sink: Option<Box<dyn Write + Send>>,
    /// The first write error, kept until it is read.
    failure: Option<io::Error>,
    /// Number of moves and violations of the emulated rig that are already written.
    moves: usize,
    violations: usize,
}

impl Log {
    #[must_use]
    pub fn to(sink: Box<dyn Write + Send>) -> Self {
        Self {
            sink: Some(sink),
            failure: None,
            moves: 0,
            violations: 0,
        }
    }

    /// A log without an output.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            sink: None,
            failure: None,
            moves: 0,
            violations: 0,
        }
    }

    /// Bytes from the host.
    pub fn from_host(&mut self, time: f64, line: &str, bytes: &[u8]) {
        self.event(time, format_args!("{line} > {}", bytes.escape_ascii()));
    }

    /// Bytes to the host.
    pub fn to_host(&mut self, time: f64, line: &str, bytes: &[u8]) {
        self.event(time, format_args!("{line} < {}", bytes.escape_ascii()));
    }

    /// Any other event of a line.
    pub fn happened(&mut self, time: f64, line: &str, what: &str) {
        self.event(time, format_args!("{line} ({what})"));
    }

    /// Writes the moves and violations since the last call.
    pub fn follow(&mut self, rig: &EmulatedRig) {
        for sent in &rig.moves()[self.moves..] {
            let id = sent.id.map_or_else(|| "-".to_owned(), |id| id.to_string());
            let targets: Vec<String> = sent
                .targets
                .iter()
                .map(|target| format!("{target} m"))
                .collect();
            self.event(
                sent.time,
                format_args!(
                    "bench move {id} to {} at {} m/s",
                    targets.join(", "),
                    sent.speed
                ),
            );
        }
        for target in &rig.violations()[self.violations..] {
            self.event(rig.time(), format_args!("bench outside {target} m"));
        }
        (self.moves, self.violations) = (rig.moves().len(), rig.violations().len());
    }

    /// Writes the result. Returns whether it is a pass.
    pub fn end(&mut self, rig: &EmulatedRig) -> bool {
        self.follow(rig);
        let (moves, violations) = (rig.moves().len(), rig.violations().len());
        if violations == 0 {
            self.event(
                rig.time(),
                format_args!(
                    "end: {}, all within the limits: ok",
                    counted(moves, "move", "moves")
                ),
            );
        } else {
            self.event(
                rig.time(),
                format_args!(
                    "end: {} outside the limits: FAILED",
                    counted(violations, "target", "targets")
                ),
            );
        }
        violations == 0
    }

    /// Returns the write error, if there was one.
    pub const fn failure(&mut self) -> Option<io::Error> {
        self.failure.take()
    }

    fn event(&mut self, time: f64, what: std::fmt::Arguments<'_>) {
        let Some(sink) = &mut self.sink else { return };
        // Written immediately: the log is complete even after the emulator is killed.
        if let Err(error) = writeln!(sink, "{time:.6} {what}").and_then(|()| sink.flush()) {
            self.failure = Some(error);
            self.sink = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::emulator::{SharedText, elastic_rig};

    #[test]
    fn every_event_is_one_line_with_its_time() {
        let text = SharedText::default();
        let (mut log, mut rig) = (Log::to(Box::new(text.clone())), elastic_rig());
        log.from_host(0.5, "actuator", b">HELLO 1*\xff\n");
        log.to_host(0.5, "actuator", b"<\0");
        rig.advance(1.25);
        rig.go_as(Some(17), &[0.005], 0.002);
        rig.go(0.006, 1.0);
        log.follow(&rig);
        log.happened(2.0, "load cell", "hung up");
        assert!(log.end(&rig));
        rig.refuse(0.03);
        assert!(!log.end(&rig));
        let expected = "\
            0.500000 actuator > >HELLO 1*\\xff\\n\n\
            0.500000 actuator < <\\x00\n\
            1.250000 bench move 17 to 0.005 m at 0.002 m/s\n\
            1.250000 bench move - to 0.006 m at 0.01 m/s\n\
            2.000000 load cell (hung up)\n\
            1.250000 end: 2 moves, all within the limits: ok\n\
            1.250000 bench outside 0.03 m\n\
            1.250000 end: 1 target outside the limits: FAILED\n";
        assert_eq!(text.text(), expected);
    }

    #[test]
    fn a_log_that_cannot_be_written_is_reported_once() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut log = Log::to(Box::new(Full));
        log.happened(0.0, "actuator", "opened");
        assert_eq!(
            log.failure().map(|error| error.kind()),
            Some(io::ErrorKind::StorageFull)
        );
        assert!(log.failure().is_none());
    }
}
