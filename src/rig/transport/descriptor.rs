//! Bytes through a descriptor that never blocks, with a time-out on every call. In: a descriptor and bytes. Out: bytes,
//! `TimedOut`, or `BrokenPipe` after the bytes before a hang-up have been read.

use std::io::{self, ErrorKind};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use super::{Clock as _, Emergency, MonotonicClock};

/// Longest time to send an emergency command.
const EMERGENCY_TIMEOUT: Duration = Duration::from_millis(200);

/// Sends all the bytes to a descriptor that does not block.
pub(super) fn write(
    descriptor: BorrowedFd<'_>,
    mut bytes: &[u8],
    timeout: Duration,
) -> io::Result<()> {
    let deadline = Deadline::after(timeout);
    while !bytes.is_empty() {
        match rustix::io::write(descriptor, bytes) {
            Ok(0) => return Err(ErrorKind::BrokenPipe.into()),
            Ok(count) => bytes = &bytes[count..],
            Err(Errno::INTR) => {}
            Err(Errno::AGAIN) => wait(descriptor, PollFlags::OUT, &deadline)?,
            Err(errno) => return Err(hang_up(errno)),
        }
    }
    Ok(())
}

/// The available bytes, at least one. The bytes before a hang-up are still read, whatever `poll` reports.
pub(super) fn read(
    descriptor: BorrowedFd<'_>,
    buffer: &mut [u8],
    timeout: Duration,
) -> io::Result<usize> {
    let deadline = Deadline::after(timeout);
    loop {
        match rustix::io::read(descriptor, &mut *buffer) {
            Ok(0) => return Err(ErrorKind::BrokenPipe.into()),
            Ok(count) => return Ok(count),
            Err(Errno::INTR) => {}
            Err(Errno::AGAIN) => wait(descriptor, PollFlags::IN, &deadline)?,
            Err(errno) => return Err(hang_up(errno)),
        }
    }
}

/// The end of a time-out.
struct Deadline {
    clock: MonotonicClock,
    timeout: Duration,
}

impl Deadline {
    fn after(timeout: Duration) -> Self {
        let clock = MonotonicClock::start();
        Self { clock, timeout }
    }

    /// The remaining time; zero after the end.
    fn left(&self) -> Duration {
        let passed = Duration::try_from_secs_f64(self.clock.now()).unwrap_or(Duration::MAX);
        self.timeout.saturating_sub(passed)
    }
}

/// Waits until the descriptor is ready, or the line is lost.
fn wait(descriptor: BorrowedFd<'_>, flags: PollFlags, deadline: &Deadline) -> io::Result<()> {
    loop {
        let left = deadline.left();
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        let left =
            Timespec::try_from(left).map_err(|_| io::Error::from(ErrorKind::InvalidInput))?;
        match poll(&mut [PollFd::new(&descriptor, flags)], Some(&left)) {
            Ok(0) => return Err(ErrorKind::TimedOut.into()),
            Ok(_) => return Ok(()),
            Err(Errno::INTR) => {}
            Err(errno) => return Err(hang_up(errno)),
        }
    }
}

/// One error for all forms of a hang-up.
fn hang_up(errno: Errno) -> io::Error {
    match errno {
        Errno::IO | Errno::PIPE | Errno::CONNRESET | Errno::NXIO | Errno::NODEV => {
            ErrorKind::BrokenPipe.into()
        }
        other => other.into(),
    }
}

/// A separate descriptor of the same line.
pub(super) struct Sender(OwnedFd);

impl Sender {
    pub(super) fn to_same_line(descriptor: &OwnedFd) -> io::Result<Box<dyn Emergency>> {
        Ok(Box::new(Self(descriptor.try_clone()?)))
    }
}

impl Emergency for Sender {
    fn send(&mut self, bytes: &[u8]) {
        // An error cannot be reported to any receiver.
        write(self.0.as_fd(), bytes, EMERGENCY_TIMEOUT).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::OFlags;
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

    #[test]
    fn a_terminal_that_hung_up_after_a_line_gives_the_line_then_a_broken_pipe() {
        let near = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&near).unwrap();
        unlockpt(&near).unwrap();
        rustix::fs::fcntl_setfl(&near, OFlags::NONBLOCK).unwrap();
        let flags = OFlags::RDWR | OFlags::NOCTTY;
        let far = rustix::fs::open(
            ptsname(&near, Vec::new()).unwrap(),
            flags,
            rustix::fs::Mode::empty(),
        )
        .unwrap();
        write(far.as_fd(), b"last", Duration::ZERO).unwrap();
        drop(far);
        let (mut buffer, mut got) = ([0; 64], Vec::new());
        let end = loop {
            match read(near.as_fd(), &mut buffer, Duration::from_secs(5)) {
                Ok(count) => got.extend_from_slice(&buffer[..count]),
                Err(error) => break error.kind(),
            }
        };
        assert_eq!((got.as_slice(), end), (&b"last"[..], ErrorKind::BrokenPipe));
    }
}
