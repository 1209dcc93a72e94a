//! A line over TCP: listens on this machine only, for one host after the other. In: an address. Out: a [`Carrier`]. It does not
//! know the contents of the bytes.

use std::io::{self, Error, ErrorKind, Read as _, Write as _};
use std::net::{TcpListener, TcpStream, ToSocketAddrs as _};
use std::os::fd::{AsFd as _, BorrowedFd};

use super::real_time::Carrier;

/// A listener and its connected host.
pub struct TcpLine {
    listener: TcpListener,
    stream: Option<TcpStream>,
}

impl TcpLine {
    /// Listens at `host:port`. Only a loopback address of this machine is accepted, because the emulator has no access control.
    ///
    /// # Errors
    /// The address is not a loopback address, or it is in use.
    pub fn at(address: &str) -> io::Result<Self> {
        let loopback = address
            .to_socket_addrs()?
            .find(|address| address.ip().is_loopback());
        let address = loopback.ok_or_else(|| {
            Error::new(
                ErrorKind::AddrNotAvailable,
                "a rig emulator listens on 127.0.0.1 or ::1 only",
            )
        })?;
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            stream: None,
        })
    }
}

impl Carrier for TcpLine {
    fn host(&mut self) -> io::Result<bool> {
        if let Some(stream) = &self.stream {
            return match stream.peek(&mut [0]) {
                Ok(count) => Ok(count > 0),
                Err(error) => Ok(matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::Interrupted
                )),
            };
        }
        match self.listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(true)?;
                stream.set_nodelay(true)?;
                self.stream = Some(stream);
                Ok(true)
            }
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::Interrupted | ErrorKind::ConnectionAborted
                ) =>
            {
                Ok(false)
            }
            Err(error) => Err(error),
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let Some(stream) = &mut self.stream else {
            return Err(ErrorKind::NotConnected.into());
        };
        match stream.read(buffer) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            moved => nothing_is_none(moved),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(stream) = &mut self.stream else {
            return Err(ErrorKind::NotConnected.into());
        };
        nothing_is_none(stream.write(bytes))
    }

    fn renew(&mut self) -> io::Result<()> {
        self.stream = None;
        Ok(())
    }

    fn descriptor(&self) -> BorrowedFd<'_> {
        match &self.stream {
            Some(stream) => stream.as_fd(),
            None => self.listener.as_fd(),
        }
    }
}

fn nothing_is_none(moved: io::Result<usize>) -> io::Result<usize> {
    match moved {
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
            Ok(0)
        }
        moved => moved,
    }
}

#[cfg(test)]
mod tests {
    use std::io::BufRead as _;

    use super::*;
    use crate::emulator::firmware::{Native, NativeSettings, sealed};
    use crate::emulator::lines::real_time::{Until, serve};
    use crate::emulator::{Log, RigEmulator, Script};
    use crate::testing::emulator::elastic_rig;
    use crate::transport::MonotonicClock;

    #[test]
    fn it_serves_until_its_only_host_leaves() {
        let rig = elastic_rig();
        let firmware = Native::new(NativeSettings::default(), &rig);
        let mut emulator = RigEmulator::with_controllers(
            rig,
            Log::none(),
            &Script::default(),
            vec![("actuator".to_owned(), Box::new(firmware))],
        );
        let line = TcpLine::at("127.0.0.1:0").expect("a free port");
        let address = line.listener.local_addr().expect("an address");
        let mut carriers: Vec<Box<dyn Carrier>> = vec![Box::new(line)];
        let host = std::thread::spawn(move || {
            let mut stream = TcpStream::connect(address).expect("it listens");
            stream.write_all(&sealed("HELLO 5")).expect("sent");
            let mut answer = String::new();
            io::BufReader::new(stream)
                .read_line(&mut answer)
                .expect("an answer");
            answer
        });
        serve(
            &mut emulator,
            &mut carriers,
            &MonotonicClock::start(),
            Until {
                last_host_left: true,
                stopped: &|| false,
            },
        )
        .expect("served");
        let answer = host.join().expect("no panic");
        assert!(
            answer.starts_with("<ACK 5 ") && answer.contains(" PSD-SIM "),
            "{answer}"
        );
    }

    #[test]
    fn it_listens_to_this_machine_only() {
        let refusal = TcpLine::at("0.0.0.0:0").err().expect("refused");
        assert!(refusal.to_string().contains("127.0.0.1"));
    }
}
