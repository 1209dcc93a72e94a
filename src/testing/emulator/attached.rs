//! The rig of a plan on its emulator, in the same thread. In: a plan and a script of faults. Out: a real rig.

use super::{InProcess, SimulatedPort};
use psd_plan::{Behind, DeviceLink, Plan};
use psd_rig::emulator::{Log, Script, of_plan};
use psd_rig::real::RealRig;
use psd_rig::transport::Port;
use psd_rig::{RigFault, StopRequest, controllers};

/// The emulator of the rig of a plan, with these faults.
pub fn emulator(plan: &Plan, script: &str, log: Log, seed: u64) -> InProcess {
    let script = Script::parse(script).unwrap_or_else(|error| panic!("{error}"));
    InProcess::new(of_plan(plan, &script, log, seed, Some(0x7f3a)).unwrap())
}

/// The plan's rig on an emulator.
///
/// # Errors
/// The rig refuses its emulator.
pub fn open(plan: &Plan, emulator: &InProcess) -> Result<RealRig, RigFault> {
    open_through(plan, emulator, &|port| Box::new(port))
}

/// The same, with every line wrapped by `through`.
///
/// # Errors
/// The rig refuses its emulator.
pub fn open_through(
    plan: &Plan,
    emulator: &InProcess,
    through: &dyn Fn(SimulatedPort) -> Box<dyn Port>,
) -> Result<RealRig, RigFault> {
    let link = plan.rig.link.as_real().unwrap();
    let attach = |link: &DeviceLink, line: usize| {
        controllers::open(
            link,
            through(emulator.port(line)),
            Box::new(emulator.clock()),
            StopRequest::default(),
            plan.rig.settle.timeout,
        )
    };
    let (actuators, cells) = (link.actuators(), link.load_cells());
    let first_cell = actuators.len();
    let of_role = |behind: Vec<Behind<'_>>, first: usize| {
        let member = |(at, Behind { link, axes, .. }): (usize, Behind<'_>)| controllers::Member {
            device: attach(link, first + at),
            axes,
            serial_number: link.serial_number.clone(),
        };
        controllers::together(
            behind.into_iter().enumerate().map(member).collect(),
            plan.rig.axes().unwrap_or(1),
        )
    };
    let (actuator, load_cell) = (of_role(actuators, 0).unwrap(), of_role(cells, first_cell));
    RealRig::open(
        &plan.rig,
        &plan.limits,
        actuator,
        load_cell,
        Box::new(emulator.clock()),
        StopRequest::default(),
    )
}
