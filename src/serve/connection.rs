//! The line to a client. In: a stream, bytes to send. Out: bytes that came, without delay. It knows no protocol. While it
//! waits, the rig is heard.
//!
//! Clients of the field leave Nagle's delay on: with a delayed acknowledgement of ours every message of theirs would wait
//! 40 ms. So what comes is acknowledged at once, after every read, for the system forgets the wish.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use rustix::net::sockopt::set_tcp_quickack;

use super::LOOK;
use crate::rig::RigFault;
use crate::run::driven::Specimen;

/// A client that takes nothing for so long is gone.
const WRITE_TIMEOUT: Duration = Duration::from_secs(2);

/// Why there is nothing more to read or write.
#[derive(Debug)]
pub enum Broken {
    HungUp,
    /// A person wants the end.
    Stopped,
    Lost(io::Error),
    /// The rig failed while the client was waited for.
    Rig(RigFault),
}

/// A client's stream, and who may want the end.
pub struct Connection<'a> {
    stream: TcpStream,
    stop: &'a dyn Fn() -> bool,
}

impl<'a> Connection<'a> {
    /// No wait on the line is longer than `wait`.
    ///
    /// # Errors
    /// The stream cannot be set up: it is gone already.
    pub fn new(stream: TcpStream, wait: Duration, stop: &'a dyn Fn() -> bool) -> io::Result<Self> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(wait.min(LOOK)))?;
        stream.set_write_timeout(Some(wait.min(LOOK)))?;
        set_tcp_quickack(&stream, true)?;
        Ok(Self { stream, stop })
    }

    /// Waits for bytes and gives how many came, at least one.
    ///
    /// # Errors
    /// None will come.
    pub fn read(&mut self, buffer: &mut [u8], specimen: &mut Specimen<'_, '_>) -> Result<usize, Broken> {
        loop {
            if (self.stop)() {
                return Err(Broken::Stopped);
            }
            specimen.listen().map_err(Broken::Rig)?;
            match self.stream.read(buffer) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => {
                    set_tcp_quickack(&self.stream, true).map_err(|error| Broken::Lost(error.into()))?;
                    return Ok(count);
                }
                Err(error) if waits(&error) => {}
                Err(error) => return Err(gone(error)),
            }
        }
    }

    /// Waits until the buffer is full.
    ///
    /// # Errors
    /// It will not be.
    pub fn read_all(&mut self, buffer: &mut [u8], specimen: &mut Specimen<'_, '_>) -> Result<(), Broken> {
        let mut filled = 0;
        while filled < buffer.len() {
            filled += self.read(&mut buffer[filled..], specimen)?;
        }
        Ok(())
    }

    /// [`Self::read_all`] from a client that is not silent for long; the rig may have failed, and is heard where it can be.
    ///
    /// # Errors
    /// It was silent, or is gone.
    pub fn read_soon(&mut self, buffer: &mut [u8], specimen: &mut Specimen<'_, '_>, silence: Duration) -> Result<(), Broken> {
        let mut filled = 0;
        let mut deadline = Instant::now() + silence;
        while filled < buffer.len() {
            let _ = specimen.listen();
            match self.stream.read(&mut buffer[filled..]) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => {
                    filled += count;
                    deadline = Instant::now() + silence;
                    set_tcp_quickack(&self.stream, true).map_err(|error| Broken::Lost(error.into()))?;
                }
                Err(error) if waits(&error) && Instant::now() < deadline => {}
                Err(error) => return Err(gone(error)),
            }
        }
        Ok(())
    }

    /// Sends all the bytes.
    ///
    /// # Errors
    /// They are not taken.
    pub fn write(&mut self, mut bytes: &[u8], specimen: &mut Specimen<'_, '_>) -> Result<(), Broken> {
        let deadline = Instant::now() + WRITE_TIMEOUT;
        while !bytes.is_empty() {
            match self.stream.write(bytes) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => bytes = &bytes[count..],
                Err(error) if waits(&error) && Instant::now() < deadline => specimen.listen().map_err(Broken::Rig)?,
                Err(error) => return Err(gone(error)),
            }
        }
        Ok(())
    }
}

/// Whether nothing happened yet.
fn waits(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

fn gone(error: io::Error) -> Broken {
    match error.kind() {
        ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => Broken::HungUp,
        _ => Broken::Lost(error),
    }
}
