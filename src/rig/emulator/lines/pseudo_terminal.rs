//! A line that looks like a serial port: a pseudo-terminal, and a link to it at the port's path in the plan. In: a path for the
//! link. Out: a [`Carrier`]. It does not know the contents of the bytes.

use std::fs::{self, File};
use std::io::{self, Error, ErrorKind};
use std::os::fd::{AsFd as _, BorrowedFd, OwnedFd};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use rustix::event::{PollFd, PollFlags, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::real_time::Carrier;

/// The folder of this system for pseudo-terminals.
const ENDS: &str = "/dev/pts/";

/// A pseudo-terminal that serves one host after the other.
pub struct PseudoTerminal {
    master: OwnedFd,
    /// The end a host opens.
    end: PathBuf,
    /// The link to this end. It always points to the present end.
    link: PathBuf,
}

impl PseudoTerminal {
    /// Opens a pseudo-terminal and makes a link to it.
    ///
    /// # Errors
    /// No pseudo-terminal is available, or there is another file at the path of the link.
    pub fn linked(link: &Path) -> io::Result<Self> {
        free(link)?;
        let (master, end) = open()?;
        symlink(&end, link)?;
        Ok(Self {
            master,
            end,
            link: link.to_owned(),
        })
    }
}

impl Carrier for PseudoTerminal {
    fn host(&mut self) -> io::Result<bool> {
        let mut fds = [PollFd::new(&self.master, PollFlags::empty())];
        match poll(&mut fds, Some(&rustix::event::Timespec::default())) {
            Ok(_) => Ok(!fds[0].revents().intersects(PollFlags::HUP | PollFlags::ERR)),
            Err(Errno::INTR) => Ok(true),
            Err(error) => Err(error.into()),
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        nothing_is_none(rustix::io::read(&self.master, buffer))
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        nothing_is_none(rustix::io::write(&self.master, bytes))
    }

    /// Opens a new pseudo-terminal for each host. A killed host leaves its own marked as in use, with unread bytes in it.
    fn renew(&mut self) -> io::Result<()> {
        let (master, end) = open()?;
        let mut beside = self.link.clone().into_os_string();
        beside.push(".new");
        let beside = PathBuf::from(beside);
        free(&beside)?;
        symlink(&end, &beside)?;
        // The rename is atomic: a host finds the old end or the new one.
        fs::rename(&beside, &self.link)?;
        (self.master, self.end) = (master, end);
        Ok(())
    }

    fn descriptor(&self) -> BorrowedFd<'_> {
        self.master.as_fd()
    }
}

impl Drop for PseudoTerminal {
    fn drop(&mut self) {
        if fs::read_link(&self.link).is_ok_and(|end| end == self.end) {
            let _ = fs::remove_file(&self.link);
        }
    }
}

/// Opens both ends of a new pseudo-terminal, raw, without a host.
fn open() -> io::Result<(OwnedFd, PathBuf)> {
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
    grantpt(&master)?;
    unlockpt(&master)?;
    fcntl_setfl(&master, fcntl_getfl(&master)? | OFlags::NONBLOCK)?;
    let name = ptsname(&master, Vec::new())?
        .into_string()
        .map_err(|_| Error::from(ErrorKind::InvalidData))?;
    let host = rustix::fs::open(
        &name,
        OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC,
        rustix::fs::Mode::empty(),
    )?;
    let mut settings = tcgetattr(&host)?;
    settings.make_raw();
    tcsetattr(&host, OptionalActions::Now, &settings)?;
    drop(File::from(host));
    Ok((master, PathBuf::from(name)))
}

/// Checks that the link can be made: only a link of a killed emulator can be there.
fn free(link: &Path) -> io::Result<()> {
    let Ok(found) = fs::symlink_metadata(link) else {
        return Ok(());
    };
    let refused = |reason: &str| Err(Error::new(ErrorKind::AlreadyExists, reason));
    if !found.is_symlink() {
        return refused("a file exists there that is not a link of an emulator");
    }
    let end = fs::read_link(link)?;
    if !end.starts_with(ENDS) {
        return refused("a link exists there that does not lead to a pseudo-terminal");
    }
    if end.exists() {
        return refused(
            "a link exists there to a pseudo-terminal in use: another emulator may be running",
        );
    }
    fs::remove_file(link)
}

fn nothing_is_none(moved: rustix::io::Result<usize>) -> io::Result<usize> {
    match moved {
        Err(Errno::AGAIN | Errno::INTR) => Ok(0),
        moved => Ok(moved?),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::emulator::firmware::{Native, NativeSettings, sealed};
    use crate::emulator::lines::real_time::{Until, serve};
    use crate::emulator::{Log, RigEmulator, Script};
    use crate::testing::emulator::elastic_rig;
    use crate::transport::MonotonicClock;

    fn emulator(script: &str) -> RigEmulator {
        let rig = elastic_rig();
        let settings = NativeSettings {
            boot: Some(0x7f3a),
            watchdog: 1e9,
            ..NativeSettings::default()
        };
        let firmware = Native::new(settings, &rig);
        RigEmulator::with_controllers(
            rig,
            Log::none(),
            &Script::parse(script).expect("a script"),
            vec![("actuator".to_owned(), Box::new(firmware))],
        )
    }

    /// One line from the port; empty after a hang-up.
    fn line(port: &mut dyn serialport::SerialPort) -> Option<String> {
        let mut text = Vec::new();
        let mut byte = [0];
        while !text.ends_with(b"\n") {
            port.read_exact(&mut byte).ok()?;
            text.push(byte[0]);
        }
        String::from_utf8(text).ok()
    }

    fn opened(link: &Path) -> Box<dyn serialport::SerialPort> {
        let open = || {
            serialport::new(link.to_string_lossy(), 115_200)
                .timeout(std::time::Duration::from_secs(20))
                .open()
        };
        // The link can be missing for a moment while it moves to the next end.
        (0..1000)
            .find_map(|_| open().map_err(|_| std::thread::yield_now()).ok())
            .expect("the port opens")
    }

    /// Ends the serving thread when it is dropped.
    struct Ending<'a>(&'a AtomicBool);

    impl Drop for Ending<'_> {
        fn drop(&mut self) {
            self.0.store(true, Ordering::Relaxed);
        }
    }

    #[test]
    fn hosts_come_and_go_and_the_rig_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let link = folder.path().join("rig");
        let terminal = PseudoTerminal::linked(&link).expect("a pseudo-terminal");
        let over = AtomicBool::new(false);
        let emulator = Mutex::new(emulator("after 4 replies: hang up before reply"));
        std::thread::scope(|scope| {
            let mut carriers: Vec<Box<dyn Carrier>> = vec![Box::new(terminal)];
            let serving = scope.spawn(|| {
                let stopped = || over.load(Ordering::Relaxed);
                let mut emulator = emulator.lock().expect("ours");
                let served = serve(
                    &mut emulator,
                    &mut carriers,
                    &MonotonicClock::start(),
                    Until {
                        last_host_left: false,
                        stopped: &stopped,
                    },
                );
                drop(carriers);
                served
            });
            // Also after a failed assertion: the scope waits for its thread.
            let ending = Ending(&over);
            let first = fs::read_link(&link).expect("a link");
            let mut port = opened(&link);
            port.write_all(&sealed("HELLO 1")).expect("sent");
            assert!(
                line(&mut *port)
                    .expect("an answer")
                    .starts_with("<ACK 1 7F3A PSD-SIM ")
            );
            port.write_all(&sealed("MOVE 2 9 0.100000 10.000000"))
                .expect("sent");
            assert!(
                line(&mut *port)
                    .expect("an answer")
                    .starts_with("<ACK 2 7F3A MOVING*")
            );
            drop(port);
            while fs::read_link(&link).is_ok_and(|end| end == first) {
                std::thread::yield_now();
            }
            let mut port = opened(&link);
            port.write_all(&sealed("HELLO 1")).expect("sent");
            let hello = line(&mut *port).expect("an answer");
            assert!(
                hello.contains(" 9 0.100000*"),
                "the same controller, which remembers its move: {hello}"
            );
            port.write_all(&sealed("STAT 2")).expect("sent");
            assert!(line(&mut *port).expect("an answer").starts_with("<ACK 2 "));
            port.write_all(&sealed("STAT 3")).expect("sent");
            assert_eq!(line(&mut *port), None, "it hung up");
            drop(ending);
            serving.join().expect("no panic").expect("served");
        });
        assert!(fs::symlink_metadata(&link).is_err(), "the link is gone");
        assert_eq!(
            emulator.into_inner().expect("ours").rig().targets(),
            [0.0001]
        );
    }

    #[test]
    fn only_what_a_simulator_left_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let refusal = |link: &Path| {
            PseudoTerminal::linked(link)
                .err()
                .map(|error| error.to_string())
                .unwrap_or_default()
        };
        let file = folder.path().join("file");
        fs::write(&file, "kept").expect("written");
        assert!(refusal(&file).contains("not a link of an emulator"));
        let other = folder.path().join("other");
        symlink(&file, &other).expect("linked");
        assert!(refusal(&other).contains("does not lead to a pseudo-terminal"));
        let link = folder.path().join("rig");
        let running = PseudoTerminal::linked(&link).expect("a pseudo-terminal");
        assert!(refusal(&link).contains("in use"));
        drop(running);
        symlink("/dev/pts/4294967295", &link).expect("linked");
        assert_eq!(refusal(&link), "", "a dead link is replaced");
        assert_eq!(fs::read_to_string(&file).expect("read"), "kept");
    }
}
