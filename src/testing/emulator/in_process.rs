//! A rig emulator in the same thread, without a line and without real time: ports and a clock for tests of drivers. In: bytes with a
//! time-out. Out: bytes. The rig emulator's time passes while the host waits.

use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use psd_rig::emulator::RigEmulator;
use psd_rig::transport::{Clock, Emergency, Port};

/// Interval between two checks of the controllers while time passes \[s\].
const SLICE: f64 = 0.001;
/// Bits on the line per byte: a start bit, eight data bits, a stop bit.
const BITS: f64 = 10.0;
/// Default bit rate \[bit/s\].
const BAUD: f64 = 115_200.0;
/// Bytes that a line stores while its controller does not read.
const LINE_BUFFER: usize = 4096;

/// A rig emulator whose ports and clock advance its time.
#[derive(Clone)]
pub struct InProcess {
    emulator: Arc<Mutex<RigEmulator>>,
    /// Time of one byte \[s\]. Every byte takes time, so that time passes in a polling loop.
    byte: f64,
}

impl InProcess {
    pub fn new(emulator: RigEmulator) -> Self {
        Self {
            emulator: Arc::new(Mutex::new(emulator)),
            byte: BITS / BAUD,
        }
    }

    /// The same rig emulator with lines of `baud` bits per second.
    pub fn at_baud(self, baud: f64) -> Self {
        Self {
            byte: BITS / baud,
            ..self
        }
    }

    /// Opens a line; 0 is the actuator's.
    pub fn port(&self, line: usize) -> SimulatedPort {
        self.lock().connect(line);
        SimulatedPort {
            shared: self.clone(),
            line,
            come: Vec::new(),
            unread: 0,
        }
    }

    pub fn clock(&self) -> SimulatedClock {
        SimulatedClock(self.clone())
    }

    /// The rig emulator itself, between two calls of its ports. Do not keep the guard.
    pub fn lock(&self) -> MutexGuard<'_, RigEmulator> {
        self.emulator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets time pass.
    fn pass(&self, seconds: f64) {
        let mut emulator = self.lock();
        let until = emulator.rig().time() + seconds;
        loop {
            let next = emulator.rig().time() + SLICE;
            if next >= until {
                return emulator.advance(until);
            }
            emulator.advance(next);
        }
    }

    fn now(&self) -> f64 {
        self.lock().rig().time()
    }
}

/// The host's end of a line.
pub struct SimulatedPort {
    shared: InProcess,
    line: usize,
    /// Bytes received from the rig emulator and not yet read.
    come: Vec<u8>,
    /// Number of bytes that the controller has not read.
    unread: usize,
}

impl SimulatedPort {
    /// Gets the bytes that the controller has for the host now. Returns whether there are any.
    fn fetch(&mut self) -> bool {
        if self.come.is_empty() {
            self.come = self.shared.lock().take(self.line).unwrap_or_default();
        }
        !self.come.is_empty()
    }

    fn gone(&self) -> bool {
        self.shared.lock().hung_up(self.line)
    }
}

#[expect(clippy::cast_precision_loss, reason = "lengths of buffers")]
impl Port for SimulatedPort {
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()> {
        if self.gone() {
            return Err(ErrorKind::BrokenPipe.into());
        }
        if !self.shared.lock().reads(self.line) {
            self.unread += bytes.len();
            if self.unread > LINE_BUFFER {
                self.shared.pass(timeout.as_secs_f64());
                return Err(ErrorKind::TimedOut.into());
            }
            return Ok(());
        }
        self.shared.pass(bytes.len() as f64 * self.shared.byte);
        self.shared.lock().give(self.line, bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = self.shared.now() + timeout.as_secs_f64();
        while !self.fetch() {
            if self.gone() {
                return Err(ErrorKind::BrokenPipe.into());
            }
            let left = until - self.shared.now();
            if left <= 0.0 {
                return Err(ErrorKind::TimedOut.into());
            }
            self.shared.pass(left.min(SLICE));
        }
        let count = self.come.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.come[..count]);
        self.come.drain(..count);
        self.shared.pass(count as f64 * self.shared.byte);
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
        Ok(Box::new(SimulatedEmergency {
            shared: self.shared.clone(),
            line: self.line,
        }))
    }
}

struct SimulatedEmergency {
    shared: InProcess,
    line: usize,
}

impl Emergency for SimulatedEmergency {
    fn send(&mut self, bytes: &[u8]) {
        let mut emulator = self.shared.lock();
        if emulator.reads(self.line) {
            emulator.give(self.line, bytes);
        }
    }
}

/// The rig emulator's time.
pub struct SimulatedClock(InProcess);

impl Clock for SimulatedClock {
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

#[cfg(test)]
mod tests {
    use super::super::{SharedText, elastic_rig};
    use super::*;
    use psd_rig::emulator::firmware::{Native, NativeSettings, sealed};
    use psd_rig::emulator::{Log, Script};

    const SOON: Duration = Duration::from_millis(100);

    fn native(script: &str, log: Log) -> InProcess {
        let (rig, script) = (elastic_rig(), Script::parse(script).expect("a script"));
        let settings = NativeSettings {
            boot: Some(0x7f3a),
            ..NativeSettings::default()
        };
        let firmware = Native::new(settings, &rig);
        InProcess::new(RigEmulator::with_controllers(
            rig,
            log,
            &script,
            vec![("actuator".to_owned(), Box::new(firmware))],
        ))
    }

    /// One line from the port.
    fn line(port: &mut SimulatedPort) -> io::Result<String> {
        let mut text = Vec::new();
        let mut byte = [0];
        while !text.ends_with(b"\n") {
            port.read(&mut byte, SOON)?;
            text.push(byte[0]);
        }
        Ok(String::from_utf8(text).expect("text"))
    }

    #[test]
    fn a_move_goes_there_and_back_again_and_is_in_the_log() {
        let text = SharedText::default();
        let shared = native("", Log::to(Box::new(text.clone())));
        let (mut port, mut clock) = (shared.port(0), shared.clock());
        let mut ask = |body: &str| {
            port.write(&sealed(body), SOON).expect("sent");
            line(&mut port).expect("answered")
        };
        assert!(ask("HELLO 1").starts_with("<ACK 1 7F3A PSD-SIM "));
        assert!(ask("MOVE 2 17 5.000000 10.000000").starts_with("<ACK 2 7F3A MOVING*"));
        clock.sleep(0.6);
        assert!(ask("MEAS 3 1").contains(" 5.000000 500.000 "));
        assert!((0.6..0.7).contains(&clock.now()), "{}", clock.now());
        assert!(shared.lock().end());
        let text = text.text();
        for event in [
            " actuator (opened)\n",
            " bench move 17 to 0.005 m at 0.01 m/s\n",
            "end: 1 move, all within the limits: ok\n",
        ] {
            assert!(text.contains(event), "{event} is not in\n{text}");
        }
    }

    #[test]
    fn waiting_ends_with_its_time_out_and_a_hang_up_is_a_broken_pipe() {
        let shared = native(
            "after 1 reply: drop reply\nafter 2 replies: hang up after reply",
            Log::none(),
        );
        let mut port = shared.port(0);
        port.write(&sealed("HELLO 1"), SOON).expect("sent");
        line(&mut port).expect("answered");
        let before = shared.now();
        port.write(&sealed("STAT 2"), SOON).expect("sent");
        assert_eq!(
            line(&mut port).expect_err("no answer").kind(),
            ErrorKind::TimedOut
        );
        assert!((shared.now() - before - 0.1).abs() < 0.01);
        port.write(&sealed("STAT 2"), SOON).expect("sent");
        assert!(
            line(&mut port)
                .expect("the stored answer")
                .starts_with("<ACK 2 ")
        );
        assert_eq!(
            line(&mut port).expect_err("hung up").kind(),
            ErrorKind::BrokenPipe
        );
        assert_eq!(
            port.write(b"!", SOON).expect_err("hung up").kind(),
            ErrorKind::BrokenPipe
        );
        let mut port = shared.port(0);
        port.write(&sealed("STAT 3"), SOON)
            .expect("the controller is there as it was");
        assert!(line(&mut port).expect("answered").starts_with("<ACK 3 "));
    }

    #[test]
    fn a_controller_that_does_not_read_fills_the_line() {
        let shared = native("at 0 s: stop reading", Log::none());
        let mut port = shared.port(0);
        shared.clock().sleep(0.01);
        let accepted = (0..100)
            .take_while(|_| port.write(&[b'x'; 96], SOON).is_ok())
            .count();
        assert_eq!(accepted, LINE_BUFFER / 96);
        assert!(shared.now() >= 0.1);
    }

    #[test]
    fn an_emergency_goes_past_whoever_holds_the_port() {
        let shared = native("", Log::none());
        let mut port = shared.port(0);
        let mut emergency = port.emergency().expect("a second hold");
        port.write(&sealed("HELLO 1"), SOON).expect("sent");
        port.write(&sealed("MOVE 2 1 9.000000 1.000000"), SOON)
            .expect("sent");
        assert!(shared.lock().rig().moving());
        emergency.send(b"!");
        assert!(!shared.lock().rig().moving());
    }
}
