//! The line to a client. In: a stream, bytes to send. Out: bytes that came, without delay. It knows no protocol.
//!
//! Clients of the field leave Nagle's delay on: with a delayed acknowledgement of ours every message of theirs would wait
//! 40 ms. So what comes is acknowledged at once, after every read, for the system forgets the wish.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use rustix::net::sockopt::set_tcp_quickack;

/// How often a wait looks whether it is to end.
const LOOK: Duration = Duration::from_millis(100);
/// A client that takes nothing for so long is gone.
const WRITE_TIMEOUT: Duration = Duration::from_secs(2);

/// Why there is nothing more to read or write.
#[derive(Debug)]
pub enum Broken {
    HungUp,
    /// A person wants the end.
    Stopped,
    Lost(io::Error),
}

/// A client's stream, and who may want the end.
pub struct Connection<'a> {
    stream: TcpStream,
    stop: &'a dyn Fn() -> bool,
}

impl<'a> Connection<'a> {
    /// # Errors
    /// The stream cannot be set up: it is gone already.
    pub fn new(stream: TcpStream, stop: &'a dyn Fn() -> bool) -> io::Result<Self> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(LOOK))?;
        stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
        set_tcp_quickack(&stream, true)?;
        Ok(Self { stream, stop })
    }

    /// Waits for bytes and gives how many came, at least one.
    ///
    /// # Errors
    /// None will come.
    pub fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Broken> {
        loop {
            match self.stream.read(buffer) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => {
                    set_tcp_quickack(&self.stream, true).map_err(|error| Broken::Lost(error.into()))?;
                    return Ok(count);
                }
                Err(error) => match error.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut if (self.stop)() => return Err(Broken::Stopped),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => return Err(Broken::HungUp),
                    _ => return Err(Broken::Lost(error)),
                },
            }
        }
    }

    /// Waits until the buffer is full.
    ///
    /// # Errors
    /// It will not be.
    pub fn read_all(&mut self, buffer: &mut [u8]) -> Result<(), Broken> {
        let mut filled = 0;
        while filled < buffer.len() {
            filled += self.read(&mut buffer[filled..])?;
        }
        Ok(())
    }

    /// Sends all the bytes.
    ///
    /// # Errors
    /// They are not taken.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), Broken> {
        self.stream.write_all(bytes).map_err(|error| match error.kind() {
            ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => Broken::HungUp,
            _ => Broken::Lost(error),
        })
    }
}
