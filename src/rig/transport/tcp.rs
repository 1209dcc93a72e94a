//! A line over the network. In: `host:port`. Out: a [`Port`]. The other side is not authenticated: a rig must use loopback, a tunnel or a
//! separate cable. Only one program of this machine may use it. It knows no protocol.

use std::io::{self, ErrorKind};
use std::net::{TcpStream, ToSocketAddrs as _};
use std::os::fd::{AsFd as _, OwnedFd};
use std::time::Duration;

use super::descriptor::{self, Sender};
use super::port_lock::{PortLock, lock};
use super::{Emergency, Port};

/// Largest number of bytes that one discard removes, so that a continuous flow does not block it permanently.
const MOST_DISCARDED: usize = 1 << 20;

/// An open connection.
pub struct TcpPort {
    descriptor: OwnedFd,
    /// Keeps other programs of this machine out during its lifetime.
    _lock: Option<PortLock>,
}

impl TcpPort {
    /// Connects to `address`; each of its addresses is tried for `timeout`, unless another program of this machine uses it.
    ///
    /// # Errors
    /// There is no answer, or another program uses the address.
    pub fn connect(address: &str, timeout: Duration) -> io::Result<Self> {
        let unreachable = |error: &io::Error| {
            io::Error::new(
                error.kind(),
                format!("`{address}` cannot be reached: {error}"),
            )
        };
        let mut last = io::Error::new(ErrorKind::NotFound, format!("invalid address: `{address}`"));
        for socket_address in address
            .to_socket_addrs()
            .map_err(|error| unreachable(&error))?
        {
            // Before the first packet: some controllers end one conversation when another begins.
            let port_lock = lock(socket_address)?;
            match TcpStream::connect_timeout(&socket_address, timeout) {
                Ok(stream) => {
                    stream.set_nodelay(true)?;
                    stream.set_nonblocking(true)?;
                    return Ok(Self {
                        descriptor: stream.into(),
                        _lock: port_lock,
                    });
                }
                Err(error) => last = unreachable(&error),
            }
        }
        Err(last)
    }
}

impl Port for TcpPort {
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()> {
        descriptor::write(self.descriptor.as_fd(), bytes, timeout)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        descriptor::read(self.descriptor.as_fd(), buffer, timeout)
    }

    fn discard(&mut self) -> io::Result<()> {
        let (mut buffer, mut discarded) = ([0; 4096], 0);
        while discarded < MOST_DISCARDED {
            match descriptor::read(self.descriptor.as_fd(), &mut buffer, Duration::ZERO) {
                Ok(count) => discarded += count,
                Err(error) if error.kind() == ErrorKind::TimedOut => return Ok(()),
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Sender::to_same_line(&self.descriptor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::failpoint::{Guarding, without};
    use std::io::{Read as _, Write as _};
    use std::net::TcpListener;

    const LONG: Duration = Duration::from_secs(5);
    const SHORT: Duration = Duration::from_millis(30);

    fn pair() -> (TcpStream, TcpPort) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = TcpPort::connect(&listener.local_addr().unwrap().to_string(), LONG).unwrap();
        (listener.accept().unwrap().0, port)
    }

    #[test]
    fn bytes_go_in_both_directions_and_a_hangup_gives_what_came_first() {
        let (mut peer, mut port) = pair();
        port.write(b"open-session\tpsd\n", LONG).unwrap();
        port.emergency().unwrap().send(b"!");
        let mut received = [0; 18];
        peer.read_exact(&mut received).unwrap();
        assert_eq!(&received, b"open-session\tpsd\n!");
        let mut buffer = [0; 64];
        assert_eq!(
            port.read(&mut buffer, SHORT).unwrap_err().kind(),
            ErrorKind::TimedOut
        );
        peer.write_all(b"OK\t0\n").unwrap();
        drop(peer);
        let mut got = Vec::new();
        let end = loop {
            match port.read(&mut buffer, LONG) {
                Ok(count) => got.extend_from_slice(&buffer[..count]),
                Err(error) => break error.kind(),
            }
        };
        assert_eq!(
            (got.as_slice(), end),
            (&b"OK\t0\n"[..], ErrorKind::BrokenPipe)
        );
        assert_eq!(port.discard().unwrap_err().kind(), ErrorKind::BrokenPipe);
    }

    #[test]
    fn a_write_to_a_peer_that_never_reads_ends_in_time_and_an_absent_peer_is_reported() {
        let (_peer, mut port) = pair();
        let end = (0..100_000).find_map(|_| port.write(&[b'x'; 4096], SHORT).err());
        assert_eq!(end.unwrap().kind(), ErrorKind::TimedOut);
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        drop(listener);
        let refused = TcpPort::connect(&address, LONG).err().unwrap();
        assert!(
            refused
                .to_string()
                .starts_with(&format!("`{address}` cannot be reached")),
            "{refused}"
        );
    }

    #[test]
    fn an_address_is_for_one_and_the_second_is_refused_before_it_is_heard() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        listener.set_nonblocking(true).unwrap();
        let address = listener.local_addr().unwrap();
        let port = TcpPort::connect(&address.to_string(), LONG).unwrap();
        let first = listener.accept().unwrap();
        let others = [
            "localhost",
            "[::ffff:127.0.0.1]",
            "0.0.0.0",
            "127.0.0.2",
            "[::1]",
        ];
        let others = others.map(|host| format!("{host}:{}", address.port()));
        for same in std::iter::once(address.to_string()).chain(others) {
            let second = TcpPort::connect(&same, LONG).err().unwrap();
            assert!(
                second
                    .to_string()
                    .starts_with("another program on this machine uses it"),
                "{same}: {second}"
            );
        }
        assert_eq!(
            listener.accept().unwrap_err().kind(),
            ErrorKind::WouldBlock,
            "not even a connection"
        );
        let unguarded = without(Guarding::Lock, || {
            TcpPort::connect(&address.to_string(), LONG)
        });
        assert!(unguarded.is_ok(), "nothing else keeps it out");
        drop((port, first));
        assert!(
            TcpPort::connect(&address.to_string(), LONG).is_ok(),
            "free again"
        );
    }
}
