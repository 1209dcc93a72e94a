//! An address is used by only one psd on this machine. In: the address. Out: the lock on it, for its lifetime, or that another program
//! has it. The lock is a name in the kernel. It disappears with the program, however that ends, and no file remains. Other machines on
//! the network are not known here.

use std::io;
use std::net::SocketAddr;
#[cfg(target_os = "linux")]
use std::os::{linux::net::SocketAddrExt as _, unix::net};

use crate::safety::failpoint::{Guarding, on};

/// The lock on one address.
#[derive(Debug)]
pub(super) struct PortLock {
    #[cfg(target_os = "linux")]
    _name: net::UnixListener,
}

/// Locks an address; nothing is sent to it.
///
/// # Errors
/// Another program has it.
#[cfg(target_os = "linux")]
pub(super) fn lock(socket_address: SocketAddr) -> io::Result<Option<PortLock>> {
    if !on(Guarding::Lock) {
        return Ok(None);
    }
    let ip = socket_address.ip().to_canonical();
    // Linux treats `0.0.0.0` as this machine; the address of a listener cannot be determined from outside.
    let host = if ip.is_loopback() || ip.is_unspecified() {
        "this machine".to_owned()
    } else {
        ip.to_string()
    };
    let name = format!("psd rig at {host}:{}", socket_address.port());
    let port_lock = net::SocketAddr::from_abstract_name(name)
        .and_then(|name| net::UnixListener::bind_addr(&name));
    port_lock.map(|name| Some(PortLock { _name: name })).map_err(|error| match error.kind() {
        io::ErrorKind::AddrInUse => io::Error::new(
            io::ErrorKind::ResourceBusy,
            "another program on this machine uses it: end that program, because two programs cannot drive one rig",
        ),
        _ => error,
    })
}

/// Other operating systems have no such names.
#[cfg(not(target_os = "linux"))]
pub(super) fn lock(_: SocketAddr) -> io::Result<Option<PortLock>> {
    Ok(on(Guarding::Lock).then_some(PortLock {}))
}
