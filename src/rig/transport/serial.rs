//! A serial line: 8 data bits, no parity, 1 stop bit, no flow control, for this program alone. In: a device path and a baud
//! rate. Out: a [`Port`]. It knows no protocol.

use std::io;
use std::os::fd::{AsFd as _, OwnedFd};
use std::os::unix::fs::FileTypeExt as _;
use std::time::Duration;

use rustix::fs::{Mode, OFlags};
use rustix::termios::QueueSelector;
use serialport::TTYPort;

use super::descriptor::{self, Sender};
use super::{Emergency, Port};

/// An open serial line.
pub struct SerialPort {
    /// The program's own descriptor, which never blocks. The write of the crate can block beyond its time-out, and its read
    /// refuses the bytes before a hang-up.
    descriptor: OwnedFd,
    /// Configures the line and keeps other programs out during its lifetime.
    _line: TTYPort,
}

impl SerialPort {
    /// Opens `path` at `baud` \[bit/s\]. A path that is not a serial line is not opened.
    ///
    /// # Errors
    /// It is not a serial line, is in use, or cannot be set up.
    pub fn open(path: &str, baud: u32) -> io::Result<Self> {
        let kind = std::fs::metadata(path)
            .map_err(|error| readable_error(&error))?
            .file_type();
        let refuse = |what: &str| {
            Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                format!("it is {what}, not a serial port"),
            ))
        };
        if kind.is_dir() {
            return refuse("a folder");
        }
        if kind.is_file() {
            return refuse("a file");
        }
        if !kind.is_char_device() {
            return refuse("not a character device");
        }
        // Opened before the line is made exclusive, which keeps out all later openers, this program too.
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let descriptor = rustix::fs::open(path, flags, Mode::empty())
            .map_err(|errno| readable_error(&errno.into()))?;
        if !rustix::termios::isatty(&descriptor) {
            return refuse("a device");
        }
        let line = TTYPort::open(&serialport::new(path, baud))
            .map_err(|error| readable_error(&error.into()))?;
        Ok(Self {
            descriptor,
            _line: line,
        })
    }
}

/// An error message for a reader who may have only a cable at hand.
fn readable_error(error: &io::Error) -> io::Error {
    use rustix::io::Errno;
    let busy = [Errno::BUSY, Errno::AGAIN]
        .iter()
        .any(|errno| error.raw_os_error() == Some(errno.raw_os_error()));
    let text = error.to_string();
    if busy || text.contains("lock") || text.contains("busy") {
        let cause =
            "another program uses it: end that program, because two programs cannot drive one rig";
        return io::Error::new(io::ErrorKind::ResourceBusy, cause);
    }
    let cause = match error.kind() {
        io::ErrorKind::NotFound => {
            "there is no such port: is it plugged in and switched on? `psd rig list` lists the ports"
        }
        io::ErrorKind::PermissionDenied => {
            "permission denied: on most systems the group `dialout` may open it"
        }
        _ => return io::Error::new(error.kind(), format!("it cannot be opened: {text}")),
    };
    io::Error::new(error.kind(), cause)
}

impl Port for SerialPort {
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()> {
        descriptor::write(self.descriptor.as_fd(), bytes, timeout)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        descriptor::read(self.descriptor.as_fd(), buffer, timeout)
    }

    fn discard(&mut self) -> io::Result<()> {
        match rustix::termios::tcflush(&self.descriptor, QueueSelector::IFlush) {
            Err(rustix::io::Errno::IO) => Err(io::ErrorKind::BrokenPipe.into()),
            other => Ok(other?),
        }
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Sender::to_same_line(&self.descriptor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serialport::SerialPort as _;
    use std::io::{ErrorKind, Read as _, Write as _};

    const LONG: Duration = Duration::from_secs(5);
    const SHORT: Duration = Duration::from_millis(30);

    /// The far side, and its line opened by path.
    fn pair() -> (TTYPort, String) {
        let (mut master, mut slave) = TTYPort::pair().unwrap();
        master.set_timeout(LONG).unwrap();
        slave.set_exclusive(false).unwrap();
        let path = slave.name().unwrap();
        drop(slave);
        (master, path)
    }

    #[test]
    fn bytes_go_in_both_directions_and_unread_ones_can_be_discarded() {
        let (mut master, path) = pair();
        let mut port = SerialPort::open(&path, 115_200).unwrap();
        port.write(b">HELLO\n", LONG).unwrap();
        port.emergency().unwrap().send(b"!");
        let mut received = [0; 8];
        master.read_exact(&mut received).unwrap();
        assert_eq!(&received, b">HELLO\n!", "unchanged");
        let mut buffer = [0; 64];
        assert_eq!(
            port.read(&mut buffer, SHORT).unwrap_err().kind(),
            ErrorKind::TimedOut
        );
        master.write_all(b"\x00\xff\r\n\x03").unwrap();
        assert_eq!(port.read(&mut buffer, LONG).unwrap(), 5);
        assert_eq!(&buffer[..5], b"\x00\xff\r\n\x03", "raw");
        master.write_all(b"late").unwrap();
        // The flush must find the bytes in the buffer.
        while rustix::io::ioctl_fionread(&port.descriptor).unwrap() < 4 {
            std::thread::yield_now();
        }
        port.discard().unwrap();
        assert_eq!(
            port.read(&mut buffer, SHORT).unwrap_err().kind(),
            ErrorKind::TimedOut
        );
    }

    /// If the other side of this kind of pair closes, the kernel loses its last bytes, and the line is lost permanently.
    #[test]
    fn a_hangup_is_a_broken_pipe_for_ever() {
        let (master, path) = pair();
        let mut port = SerialPort::open(&path, 115_200).unwrap();
        drop(master);
        let mut buffer = [0; 64];
        for _ in 0..2 {
            assert_eq!(
                port.read(&mut buffer, LONG).unwrap_err().kind(),
                ErrorKind::BrokenPipe
            );
            assert_eq!(
                port.write(b"x", LONG).unwrap_err().kind(),
                ErrorKind::BrokenPipe
            );
            assert_eq!(port.discard().unwrap_err().kind(), ErrorKind::BrokenPipe);
        }
    }

    #[test]
    fn a_peer_that_never_reads_makes_a_write_end_in_time() {
        let (_master, path) = pair();
        let mut port = SerialPort::open(&path, 115_200).unwrap();
        let end = (0..10_000).find_map(|_| port.write(&[b'x'; 96], SHORT).err());
        assert_eq!(end.unwrap().kind(), ErrorKind::TimedOut);
        let mut emergency = port.emergency().unwrap();
        emergency.send(b"!");
    }

    #[test]
    fn a_line_is_for_one_and_what_is_no_line_is_refused() {
        let (_master, path) = pair();
        let port = SerialPort::open(&path, 115_200).unwrap();
        let second = SerialPort::open(&path, 115_200).err().unwrap();
        assert!(
            second.to_string().starts_with("another program uses it"),
            "{second}"
        );
        drop(port);
        assert!(SerialPort::open(&path, 115_200).is_ok(), "free again");
        let file = tempfile::NamedTempFile::new().unwrap();
        for (path, what) in [
            (file.path().to_str().unwrap(), "a file"),
            ("/tmp", "a folder"),
            ("/dev/null", "a device"),
        ] {
            let refused = SerialPort::open(path, 115_200).err().unwrap();
            assert_eq!(
                refused.to_string(),
                format!("it is {what}, not a serial port")
            );
        }
        let refused = SerialPort::open("/dev/no-such-line", 115_200)
            .err()
            .unwrap();
        assert!(refused.to_string().contains("`psd rig list`"), "{refused}");
    }
}
