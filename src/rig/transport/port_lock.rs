//! One psd of this machine speaks with one address. In: the address. Out: the right to it, for as long as it is kept, or that
//! another has it. The right is a name in the kernel: it goes with the program, however that ends, and leaves no file behind.
//! It does not know who else on the network speaks with the same device.

use std::io;
use std::net::SocketAddr;
#[cfg(target_os = "linux")]
use std::os::{linux::net::SocketAddrExt as _, unix::net};

use crate::rig::safety::failpoint::{Guarding, on};

/// The right to one address.
#[derive(Debug)]
pub(super) struct Taken {
    #[cfg(target_os = "linux")]
    _name: net::UnixListener,
}

/// Takes an address; nothing is sent to it.
///
/// # Errors
/// Another program has it.
#[cfg(target_os = "linux")]
pub(super) fn take(place: SocketAddr) -> io::Result<Option<Taken>> {
    if !on(Guarding::Lock) {
        return Ok(None);
    }
    let ip = place.ip().to_canonical();
    // Linux takes `0.0.0.0` for this machine; which of its own addresses a listener has cannot be told from outside.
    let host = if ip.is_loopback() || ip.is_unspecified() {
        "this machine".to_owned()
    } else {
        ip.to_string()
    };
    let name = format!("psd rig at {host}:{}", place.port());
    let taken = net::SocketAddr::from_abstract_name(name)
        .and_then(|name| net::UnixListener::bind_addr(&name));
    taken.map(|name| Some(Taken { _name: name })).map_err(|error| match error.kind() {
        io::ErrorKind::AddrInUse => io::Error::new(
            io::ErrorKind::ResourceBusy,
            "another program on this machine speaks with it: end that one, for two cannot drive one rig",
        ),
        _ => error,
    })
}

/// Other systems have no such names.
#[cfg(not(target_os = "linux"))]
pub(super) fn take(_: SocketAddr) -> io::Result<Option<Taken>> {
    Ok(on(Guarding::Lock).then_some(Taken {}))
}
