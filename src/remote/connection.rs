//! The line to a client. In: a stream, bytes to send. Out: received bytes, without delay. It knows no protocol. While it
//! waits, the rig is polled; while the rig moves, the line is watched, so that nothing moves for a client that has
//! disconnected.
//!
//! Common clients leave Nagle's algorithm on: with a delayed acknowledgement each of their messages would wait 40 ms. So
//! received bytes are acknowledged immediately, after every read, because the system forgets the option.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::net::sockopt::set_tcp_quickack;
use rustix::net::{RecvFlags, recv};

use super::{Ended, LOOK};
use crate::run::remote_control::Specimen;
use psd_rig::{RigFault, StopRequest};

/// A client that accepts no bytes for this long is disconnected.
const WRITE_TIMEOUT: Duration = Duration::from_secs(2);

/// A client with an incomplete message is disconnected after this time. The same applies to a client that connects and sends
/// nothing, because no other client is admitted meanwhile.
const PATIENCE: Duration = Duration::from_secs(10);

/// Maximum number of bytes sent ahead that are searched for the end of the session.
const SENT_AHEAD: usize = 1 << 16;

/// The reason why nothing more can be read or written.
#[derive(Debug)]
pub enum Broken {
    HungUp,
    /// The operator requests the end.
    Stopped,
    /// The rest of its message is missing.
    Silent,
    Lost(io::Error),
    /// The rig failed while the client was waited for.
    Rig(RigFault),
}

/// A client's stream, and the source of stop requests.
pub struct Connection<'a> {
    stream: TcpStream,
    stop_request: &'a StopRequest,
    pub(super) patience: Duration,
}

impl<'a> Connection<'a> {
    /// No wait on the line is longer than `wait`.
    ///
    /// # Errors
    /// The stream cannot be set up: it is lost already.
    pub fn new(
        stream: TcpStream,
        wait: Duration,
        stop_request: &'a StopRequest,
    ) -> io::Result<Self> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(wait.min(LOOK)))?;
        stream.set_write_timeout(Some(wait.min(LOOK)))?;
        set_tcp_quickack(&stream, true)?;
        Ok(Self {
            stream,
            stop_request,
            patience: PATIENCE,
        })
    }

    /// Lets the rig execute the client's proposal. If the client disconnects meanwhile, the rig holds; not if the bytes
    /// that it sent ahead announced its end.
    ///
    /// # Errors
    /// The rig fails, or was held during the motion.
    pub fn execute(
        &self,
        specimen: &mut Specimen<'_, '_>,
        takes_leave: impl Fn(&[u8]) -> bool + Send + 'static,
    ) -> Result<(), Ended> {
        let line = self
            .stream
            .try_clone()
            .map_err(|error| Ended::Lost(error.to_string()))?;
        let executed = self.stop_request.for_client(
            move || is_disconnected(&line, &takes_leave),
            || specimen.execute(),
        );
        executed.map_err(|fault| match fault {
            RigFault::Interrupted if !self.stop_request.end_requested() => Ended::HungUp,
            fault => fault.into(),
        })
    }

    /// Waits for bytes and returns their number, at least one. The time between two messages is not limited; `owed_since` is
    /// the start of an incomplete message, by the clock of the session \[s\].
    ///
    /// # Errors
    /// No more bytes will be received.
    pub fn read(
        &mut self,
        buffer: &mut [u8],
        specimen: &mut Specimen<'_, '_>,
        owed_since: Option<f64>,
    ) -> Result<usize, Broken> {
        loop {
            let owed_for = owed_since.map_or(0.0, |since| specimen.now() - since);
            if owed_for > self.patience.as_secs_f64() {
                return Err(Broken::Silent);
            }
            if self.stop_request.end_requested() {
                return Err(Broken::Stopped);
            }
            specimen.listen().map_err(Broken::Rig)?;
            match self.stream.read(buffer) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => {
                    set_tcp_quickack(&self.stream, true)
                        .map_err(|error| Broken::Lost(error.into()))?;
                    return Ok(count);
                }
                Err(error) if waits(&error) => {}
                Err(error) => return Err(disconnected(error)),
            }
        }
    }

    /// Waits until the buffer is full: the bytes that the client must send next.
    ///
    /// # Errors
    /// It will not be.
    pub fn read_all(
        &mut self,
        buffer: &mut [u8],
        specimen: &mut Specimen<'_, '_>,
    ) -> Result<(), Broken> {
        let (mut filled, since) = (0, specimen.now());
        while filled < buffer.len() {
            filled += self.read(&mut buffer[filled..], specimen, Some(since))?;
        }
        Ok(())
    }

    /// [`Self::read_all`] for a client that is not silent for long; the rig may have failed, and is polled if possible.
    ///
    /// # Errors
    /// It was silent, or has disconnected.
    pub fn read_soon(
        &mut self,
        buffer: &mut [u8],
        specimen: &mut Specimen<'_, '_>,
        silence: Duration,
    ) -> Result<(), Broken> {
        let mut filled = 0;
        let mut deadline = specimen.now() + silence.as_secs_f64();
        while filled < buffer.len() {
            let _ = specimen.listen();
            match self.stream.read(&mut buffer[filled..]) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => {
                    filled += count;
                    deadline = specimen.now() + silence.as_secs_f64();
                    set_tcp_quickack(&self.stream, true)
                        .map_err(|error| Broken::Lost(error.into()))?;
                }
                Err(error) if waits(&error) && specimen.now() < deadline => {}
                Err(error) => return Err(disconnected(error)),
            }
        }
        Ok(())
    }

    /// Sends all the bytes.
    ///
    /// # Errors
    /// They are not accepted.
    pub fn write(
        &mut self,
        mut bytes: &[u8],
        specimen: &mut Specimen<'_, '_>,
    ) -> Result<(), Broken> {
        let deadline = specimen.now() + WRITE_TIMEOUT.as_secs_f64();
        while !bytes.is_empty() {
            match self.stream.write(bytes) {
                Ok(0) => return Err(Broken::HungUp),
                Ok(count) => bytes = &bytes[count..],
                Err(error) if waits(&error) && specimen.now() < deadline => {
                    specimen.listen().map_err(Broken::Rig)?;
                }
                Err(error) => return Err(disconnected(error)),
            }
        }
        Ok(())
    }
}

/// Whether the other side will send nothing more, and did not announce this.
fn is_disconnected(line: &TcpStream, takes_leave: &dyn Fn(&[u8]) -> bool) -> bool {
    let mut watched = [PollFd::new(line, PollFlags::RDHUP)];
    let at_once = Timespec {
        tv_sec: 0,
        tv_nsec: 0,
    };
    let ended = PollFlags::RDHUP | PollFlags::HUP | PollFlags::ERR;
    if !poll(&mut watched, Some(&at_once)).is_ok_and(|_| watched[0].revents().intersects(ended)) {
        return false;
    }
    let mut ahead = vec![0; SENT_AHEAD];
    let (_, count) =
        recv(line, &mut ahead[..], RecvFlags::PEEK | RecvFlags::DONTWAIT).unwrap_or_default();
    !takes_leave(&ahead[..count])
}

/// Whether nothing happened yet.
fn waits(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}

fn disconnected(error: io::Error) -> Broken {
    match error.kind() {
        ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => Broken::HungUp,
        _ => Broken::Lost(error),
    }
}
