//! From a plan to a rig that answers: ports opened, drivers chosen, the last resort armed. In: the plan's real rig. Out: a
//! [`Connected`]. Nothing moves. The one place where ports are opened to drive a rig.

use std::time::Duration;

use super::device::{self, Device};
use super::port::{Clock, Emergency, MonotonicClock, Port, SerialPort, TcpPort};
use super::real::RealRig;
use super::safety::{self, Armed};
use super::{RigFault, Wish};
use crate::plan::{DeviceLink, Limits, PortPlan, RigPlan};

/// Longest wait for a network rig to take the connection.
const CONNECTING: Duration = Duration::from_secs(5);

/// A rig that is open. As long as this lives, a panic and a program that no longer drives hold it.
pub struct Connected {
    pub rig: RealRig,
    _armed: Armed,
}

/// Opens the plan's rig: asks every device who it is, tells it the limits, reads once.
///
/// # Errors
/// A port cannot be opened, or a device is not the plan's or not fit.
pub fn connect(plan: &RigPlan, limits: &Limits, wish: &Wish) -> Result<Connected, RigFault> {
    let link = plan.link.as_real().ok_or_else(|| RigFault::Device(format!("{} is a virtual rig", plan.name)))?;
    let (actuator, mut lines) = attach(&link.actuator, plan, wish)?;
    let load_cell = match &link.load_cell {
        None => None,
        Some(cell) => {
            let (device, more) = attach(cell, plan, wish)?;
            lines.extend(more);
            Some(device)
        }
    };
    // Armed before the first word: whatever becomes of the conversation, the rig holds.
    let armed = safety::arm(lines).watched(link.watchdog);
    let rig = RealRig::open(plan, limits, actuator, load_cell, Box::new(MonotonicClock::start()), wish.clone())?;
    Ok(Connected { rig, _armed: armed })
}

type Attached = (Box<dyn Device>, Vec<(Box<dyn Emergency>, Vec<u8>)>);

/// One device on its port, with the line and the bytes that stop it.
fn attach(link: &DeviceLink, plan: &RigPlan, wish: &Wish) -> Result<Attached, RigFault> {
    let failed = |error: std::io::Error| RigFault::Device(format!("{}: {error}", link.port));
    let port: Box<dyn Port> = match &link.port {
        PortPlan::Serial { path, baud } => Box::new(SerialPort::open(path, *baud).map_err(failed)?),
        PortPlan::Tcp { address } => Box::new(TcpPort::connect(address, CONNECTING).map_err(failed)?),
    };
    let emergency = port.emergency().map_err(failed)?;
    let clock: Box<dyn Clock> = Box::new(MonotonicClock::start());
    let device = device::open(link, port, clock, wish.clone(), plan.settle.timeout);
    let bytes = device.emergency();
    Ok((device, vec![(emergency, bytes)]))
}
