//! A rig emulator in real time, for a program on the other side of a real line. It reads the bytes of the hosts and writes those of
//! the controllers until it is stopped. It knows no protocol. It accesses a line only through [`Carrier`].

use std::io;
use std::os::fd::BorrowedFd;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use crate::emulator::RigEmulator;
use crate::transport::Clock;

/// Longest interval between two checks of the lines, 4 ms. Bytes of a host end it.
const NAP: Timespec = Timespec {
    tv_sec: 0,
    tv_nsec: 4_000_000,
};
/// Bytes stored for a host that does not read. Further bytes are lost, as on a wire.
const OUTBOX: usize = 4 << 20;

/// The transport of the bytes of one line. No call waits.
pub trait Carrier: Send {
    /// Returns whether a host is connected now; accepts a waiting one.
    ///
    /// # Errors
    /// The line cannot be served any more.
    fn host(&mut self) -> io::Result<bool>;

    /// Reads received bytes; 0: none.
    ///
    /// # Errors
    /// The host disconnected.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize>;

    /// Sends the bytes that the line accepts and returns their number.
    ///
    /// # Errors
    /// The host disconnected.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize>;

    /// Closes the connection to this host and prepares for the next.
    ///
    /// # Errors
    /// The line cannot be served any more.
    fn renew(&mut self) -> io::Result<()>;

    /// The descriptor of the connected host.
    fn descriptor(&self) -> BorrowedFd<'_>;
}

/// The conditions that end the serving.
#[derive(Clone, Copy)]
pub struct Until<'a> {
    /// Hosts were connected and the last of them has disconnected.
    pub last_host_left: bool,
    /// Polled periodically.
    pub stopped: &'a dyn Fn() -> bool,
}

struct Served<'a> {
    carrier: &'a mut dyn Carrier,
    present: bool,
    outbox: Vec<u8>,
}

/// Serves a rig emulator, with one carrier per line, in the time of the clock.
///
/// # Errors
/// A line cannot be served any more.
pub fn serve(
    emulator: &mut RigEmulator,
    carriers: &mut [Box<dyn Carrier>],
    clock: &dyn Clock,
    until: Until<'_>,
) -> io::Result<()> {
    let start = clock.now();
    let mut lines: Vec<Served<'_>> = carriers
        .iter_mut()
        .map(|carrier| Served {
            carrier: &mut **carrier,
            present: false,
            outbox: Vec::new(),
        })
        .collect();
    let mut anybody = false;
    while !(until.stopped)() {
        emulator.advance(clock.now() - start);
        let mut busy = false;
        for (at, line) in lines.iter_mut().enumerate() {
            busy |= line.turn(emulator, at)?;
            anybody |= line.present;
        }
        if until.last_host_left && anybody && lines.iter().all(|line| !line.present) {
            return Ok(());
        }
        if !busy {
            wait_for_bytes(emulator, &lines)?;
        }
    }
    Ok(())
}

/// Waits until a connected host sends bytes or disconnects, at most [`NAP`].
fn wait_for_bytes(emulator: &RigEmulator, lines: &[Served<'_>]) -> io::Result<()> {
    // Unread bytes of a line that does not read would end the wait at once.
    let mut hosts: Vec<PollFd<'_>> = (lines.iter().enumerate())
        .filter(|(at, line)| line.present && emulator.reads(*at))
        .map(|(_, line)| PollFd::from_borrowed_fd(line.carrier.descriptor(), PollFlags::IN))
        .collect();
    match poll(&mut hosts, Some(&NAP)) {
        Ok(_) | Err(Errno::INTR) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

impl Served<'_> {
    /// Checks a line once. Returns whether there were any bytes.
    fn turn(&mut self, emulator: &mut RigEmulator, at: usize) -> io::Result<bool> {
        if !self.present {
            // Bytes without a host are dropped.
            while emulator.take(at).is_some() {}
            self.present = self.carrier.host()?;
            if self.present {
                emulator.connect(at);
            }
            return Ok(self.present);
        }
        let mut buffer = [0; 4096];
        let read = if emulator.reads(at) {
            self.carrier.read(&mut buffer)
        } else {
            Ok(0)
        };
        let came = *read.as_ref().unwrap_or(&0);
        emulator.give(at, &buffer[..came]);
        while self.outbox.len() < OUTBOX {
            let Some(piece) = emulator.take(at) else {
                break;
            };
            self.outbox.extend(piece);
        }
        let written = if self.outbox.is_empty() {
            Ok(0)
        } else {
            self.carrier.write(&self.outbox)
        };
        let sent = *written.as_ref().unwrap_or(&0);
        self.outbox.drain(..sent);
        let left = read.is_err() || written.is_err() || (came == 0 && !self.carrier.host()?);
        if left || (emulator.hung_up(at) && self.outbox.is_empty()) {
            self.present = false;
            self.outbox.clear();
            self.carrier.renew()?;
        }
        // Once the log states it, the line is ready for the next host.
        if left {
            emulator.host_left(at);
        }
        Ok(came > 0 || sent > 0)
    }
}
