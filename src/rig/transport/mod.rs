//! Bytes to and from a device, with their times: serial lines, TCP, clocks. In: bytes and a
//! time-out. Out: bytes, or the reason for none. It knows no protocol.

mod clock;
mod descriptor;
mod port_lock;
mod serial;
mod tcp;

use std::io;
use std::time::Duration;

use psd_plan::PortPlan;

pub use clock::MonotonicClock;
pub use serial::SerialPort;
pub use tcp::TcpPort;

/// Longest wait for a network rig to accept the connection.
const CONNECTING: Duration = Duration::from_secs(5);

/// Opens the port of a plan. Nothing is sent.
///
/// # Errors
/// The port does not exist, is not a line, or is in use.
pub fn open(port: &PortPlan) -> io::Result<Box<dyn Port>> {
    Ok(match port {
        PortPlan::Serial { path, baud } => Box::new(SerialPort::open(path, *baud)?),
        PortPlan::Tcp { address } => Box::new(TcpPort::connect(address, CONNECTING)?),
    })
}

/// A line to one device. Every call ends within its time-out; `ErrorKind::TimedOut` reports that it has expired.
pub trait Port: Send {
    /// Sends all the bytes.
    ///
    /// # Errors
    /// Not all bytes were accepted in time, or the line is lost.
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()>;

    /// Waits for bytes and gives the available ones, at least one.
    ///
    /// # Errors
    /// Nothing was received in time, or the line is lost (`BrokenPipe`, after the bytes that were received before).
    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize>;

    /// Discards the bytes that were received and not read.
    ///
    /// # Errors
    /// The line is lost.
    fn discard(&mut self) -> io::Result<()>;

    /// A second handle of the line that can only send: for the emergency hold, whatever this handle is doing.
    ///
    /// # Errors
    /// The line is lost.
    fn emergency(&self) -> io::Result<Box<dyn Emergency>>;
}

/// Sends without waiting for an answer.
pub trait Emergency: Send {
    /// Sends the bytes, within a fraction of a second or not at all.
    fn send(&mut self, bytes: &[u8]);
}

/// Monotonic time, and waiting.
pub trait Clock: Send {
    /// Seconds since a fixed moment.
    fn now(&self) -> f64;

    fn sleep(&mut self, seconds: f64);

    /// Wall clock for the run log: UTC as `2026-05-31T12:00:00.000Z`. None if a run must not read the machine's clock.
    fn wall(&self) -> Option<String>;
}
