//! From a plan to a connected rig: ports opened, drivers chosen, the emergency hold armed. In: the plan's real rig. Out: a
//! [`Connected`]. Nothing moves. Only this file opens ports to drive a rig.

use super::controllers;
use super::controllers::{Device, Member, together};
use super::real::RealRig;
use super::safety::{self, Armed};
use super::transport::{self, Clock, Emergency, MonotonicClock};
use super::{RigFault, StopRequest};
use psd_plan::{Behind, DeviceLink, Limits, RigPlan};

/// An open rig. During its lifetime, a panic or a missing heartbeat of the program holds the rig.
pub struct Connected {
    pub rig: RealRig,
    _armed: Armed,
}

/// Opens the plan's rig: requests the identity of every device, sends it the limits, reads once.
///
/// # Errors
/// A port cannot be opened, or a device is not the one in the plan or is not suitable.
pub fn connect(
    plan: &RigPlan,
    limits: &Limits,
    stop_request: &StopRequest,
) -> Result<Connected, RigFault> {
    let link = plan
        .link
        .as_real()
        .ok_or_else(|| RigFault::Device(format!("{} is a virtual rig", plan.name)))?;
    let (actuator, mut lines) = attach_all(link.actuators(), plan, stop_request)?;
    let (load_cell, more) = attach_all(link.load_cells(), plan, stop_request)?;
    lines.extend(more);
    let actuator = actuator
        .ok_or_else(|| RigFault::Device(format!("the rig {} has no actuator", plan.name)))?;
    // Armed before the first request: the rig holds whatever fault occurs in the communication.
    let armed = safety::arm(lines).watched(link.watchdog);
    let rig = RealRig::open(
        plan,
        limits,
        actuator,
        load_cell,
        Box::new(MonotonicClock::start()),
        stop_request.clone(),
    )?;
    Ok(Connected { rig, _armed: armed })
}

/// Lines, each with the bytes that stop its device.
type Lines = Vec<(Box<dyn Emergency>, Vec<u8>)>;

/// All devices of one role as one device, with their lines; None if there is none.
fn attach_all(
    behind: Vec<Behind<'_>>,
    plan: &RigPlan,
    stop_request: &StopRequest,
) -> Result<(Option<Box<dyn Device>>, Lines), RigFault> {
    let (mut members, mut lines) = (Vec::new(), Lines::new());
    for Behind { link, axes, .. } in behind {
        let (device, line) = attach(link, plan, stop_request)?;
        lines.push(line);
        members.push(Member {
            device,
            axes,
            serial_number: link.serial_number.clone(),
        });
    }
    Ok((together(members, plan.axes().unwrap_or(1)), lines))
}

type Attached = (Box<dyn Device>, (Box<dyn Emergency>, Vec<u8>));

/// One device on its port, with the line and the bytes that stop it.
fn attach(
    link: &DeviceLink,
    plan: &RigPlan,
    stop_request: &StopRequest,
) -> Result<Attached, RigFault> {
    let failed = |error: std::io::Error| RigFault::Device(format!("{}: {error}", link.port));
    let port = transport::open(&link.port).map_err(failed)?;
    let emergency = port.emergency().map_err(failed)?;
    let clock: Box<dyn Clock> = Box::new(MonotonicClock::start());
    let device = controllers::open(link, port, clock, stop_request.clone(), plan.settle.timeout);
    let bytes = device.emergency();
    Ok((device, (emergency, bytes)))
}
