//! Remote control: a coordinator or a finite-element program drives the specimen through the guard.
//! In: a listener, a specimen, a protocol. Out: how each session ended and what it requested. It
//! reads no plan, opens no port and keeps no record.

mod connection;
#[cfg(test)]
mod frame_tests;
mod generic_client;
mod nees;
#[cfg(test)]
mod tests;

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use crate::run::Disconnect;
pub use crate::run::remote_control::Driven;
use crate::run::remote_control::Specimen;
use connection::{Broken, Connection};
pub use nees::usual_names;
use psd_rig::{RigFault, StopRequest};

/// Interval at which a wait checks whether it must end.
const LOOK: Duration = Duration::from_millis(100);

/// The protocol of the client.
#[derive(Clone, Debug, PartialEq)]
pub enum Protocol {
    /// With the names of its control points, one per axis; none: one axis, and any name is accepted.
    Nees { control_points: Vec<String> },
    /// With the constant stiffness that it receives \[N/m\]: for n axes n·n numbers, row by row.
    GenericClient { stiffness: Vec<f64> },
}

/// How a session ended. The rig holds in every case.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// The client closed the session.
    Closed,
    /// The client disconnected without closing the session.
    HungUp,
    /// The operator requested the end.
    Stopped,
    /// The client does not follow the protocol, or requests something that cannot be served.
    Misspoken(String),
    Lost(String),
    Limit(RigFault),
    Rig(RigFault),
}

impl Ended {
    /// For the run log.
    const fn disconnect(&self) -> Disconnect {
        match self {
            Self::Closed => Disconnect::Closed,
            Self::Stopped | Self::Limit(_) => Disconnect::Stopped,
            Self::HungUp | Self::Misspoken(_) | Self::Lost(_) | Self::Rig(_) => Disconnect::Failed,
        }
    }

    /// Whether another client can connect: not after a stop by a limit or a fault of the rig.
    const fn allows_another(&self) -> bool {
        matches!(
            self,
            Self::Closed | Self::HungUp | Self::Misspoken(_) | Self::Lost(_)
        )
    }
}

impl std::fmt::Display for Ended {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Closed => f.write_str("closed by the client"),
            Self::HungUp => f.write_str("the client left without closing"),
            Self::Stopped => f.write_str("stopped by the operator"),
            Self::Misspoken(reason) => write!(f, "the client cannot be served: {reason}"),
            Self::Lost(reason) => write!(f, "the connection was lost: {reason}"),
            Self::Limit(fault) | Self::Rig(fault) => write!(f, "{fault}"),
        }
    }
}

impl From<RigFault> for Ended {
    fn from(fault: RigFault) -> Self {
        match fault {
            RigFault::LimitBreached { .. } => Self::Limit(fault),
            RigFault::Interrupted => Self::Stopped,
            RigFault::NotSettled { .. } | RigFault::Following { .. } | RigFault::Device(_) => {
                Self::Rig(fault)
            }
        }
    }
}

impl From<Broken> for Ended {
    fn from(broken: Broken) -> Self {
        match broken {
            Broken::HungUp => Self::HungUp,
            Broken::Stopped => Self::Stopped,
            Broken::Silent => {
                Self::Misspoken("the client is silent, and its next message is missing".to_owned())
            }
            Broken::Lost(error) => Self::Lost(error.to_string()),
            Broken::Rig(fault) => fault.into(),
        }
    }
}

/// One client, from its connection to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    pub ended: Ended,
    pub driven: Driven,
}

/// Events while serving, for display.
#[derive(Debug)]
pub enum Event<'a> {
    Connected(SocketAddr),
    Ended(&'a Session),
}

/// Serves one client after the other, or only `once`; a second one at the same time is refused. Ends when the operator
/// requests the end, and after a session that a limit or the rig ended.
///
/// # Errors
/// The listener fails.
pub fn serve(
    listener: &TcpListener,
    protocol: &Protocol,
    specimen: &mut Specimen<'_, '_>,
    once: bool,
    stop_request: &StopRequest,
    on_event: &mut dyn FnMut(Event<'_>),
) -> io::Result<()> {
    listener.set_nonblocking(true)?;
    let (busy, closing) = (AtomicBool::new(false), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let (sender, clients) = channel();
        let admission = scope.spawn(|| admit_clients(listener, &busy, &closing, sender));
        loop {
            let (stream, address) = match next_client(&clients, stop_request, specimen) {
                Ok(Some(client)) => client,
                Ok(None) => break,
                Err(fault) => {
                    let ended = Ended::from(fault);
                    specimen.leave(ended.disconnect(), ended.to_string());
                    on_event(Event::Ended(&Session {
                        ended,
                        driven: Driven::default(),
                    }));
                    break;
                }
            };
            on_event(Event::Connected(address));
            let session = session(stream, address, protocol, specimen, stop_request);
            on_event(Event::Ended(&session));
            if once || !session.ended.allows_another() {
                break;
            }
            busy.store(false, Ordering::Release);
        }
        specimen.close();
        closing.store(true, Ordering::Release);
        admission
            .join()
            .unwrap_or_else(|_| Err(io::Error::other("the listener failed")))
    })
}

/// Serves one client.
pub fn session(
    stream: TcpStream,
    address: SocketAddr,
    protocol: &Protocol,
    specimen: &mut Specimen<'_, '_>,
    stop_request: &StopRequest,
) -> Session {
    let ended = match specimen.come(address.to_string()) {
        Err(fault) => fault.into(),
        Ok(()) => match Connection::new(stream, specimen.wait(LOOK), stop_request) {
            Err(error) => Ended::Lost(error.to_string()),
            Ok(mut connection) => match protocol {
                Protocol::Nees { control_points } => {
                    nees::session(&mut connection, specimen, control_points)
                }
                Protocol::GenericClient { stiffness } => {
                    generic_client::session(&mut connection, specimen, stiffness)
                }
            },
        },
    };
    specimen.leave(ended.disconnect(), ended.to_string());
    Session {
        ended,
        driven: specimen.driven(),
    }
}

/// Admits one client while there is none, and refuses the others.
#[expect(
    clippy::needless_pass_by_value,
    reason = "the receiver of the clients must see the end of the admission"
)]
fn admit_clients(
    listener: &TcpListener,
    busy: &AtomicBool,
    closing: &AtomicBool,
    clients: Sender<(TcpStream, SocketAddr)>,
) -> io::Result<()> {
    let look = Timespec {
        tv_sec: 0,
        tv_nsec: 100_000_000,
    };
    while !closing.load(Ordering::Acquire) {
        match poll(&mut [PollFd::new(listener, PollFlags::IN)], Some(&look)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => continue,
            Ok(_) => {}
            Err(error) => return Err(error.into()),
        }
        match listener.accept() {
            // A client that is not passed on is closed by being dropped.
            Ok(client) if !busy.swap(true, Ordering::AcqRel) => {
                if clients.send(client).is_err() {
                    return Ok(());
                }
            }
            Ok(_) => {}
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::ConnectionAborted
                ) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Waits for a client, and polls the rig meanwhile.
fn next_client(
    clients: &Receiver<(TcpStream, SocketAddr)>,
    stop_request: &StopRequest,
    specimen: &mut Specimen<'_, '_>,
) -> Result<Option<(TcpStream, SocketAddr)>, RigFault> {
    while !stop_request.end_requested() {
        match specimen.listen() {
            // A request to hold is a request to end, and nothing was moving.
            Err(RigFault::Interrupted) => break,
            listened => listened?,
        }
        match clients.recv_timeout(specimen.wait(LOOK)) {
            Ok(client) => return Ok(Some(client)),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
        }
    }
    Ok(None)
}
