//! `psd rig …`, one file per subcommand. In: the arguments and the plan's rig. Out: an exit code.
//! Every motion stays inside the limits of the plan.

mod client_protocol;
mod jog;
mod list;
mod monitor;
mod probe;
mod serve;
mod simulate;
mod typed;

use std::path::Path;

use clap::Subcommand;

use crate::args::PlanSettings;
use crate::exit::{Exit, Failure};
use crate::files::plan_file;
use crate::settings::Settings;
use psd_plan::{Link, Plan};
use psd_rig::{Rig, StopRequest, connect, virtual_rig};

#[derive(Debug, Subcommand)]
pub enum RigCommand {
    /// List serial ports of this machine, with their stable names
    List(list::ListArguments),
    /// Identify the rig and show its readings and margins (no motion)
    Probe(probe::ProbeArguments),
    /// Show the readings continuously (no motion)
    Monitor(monitor::MonitorArguments),
    /// MOVE the rig by hand within the plan's limits
    Jog(jog::JogArguments),
    /// Emulate the rig of a plan at its own port, until Ctrl-C
    Simulate(simulate::SimulateArguments),
    /// Let a coordinator or OpenSees MOVE the rig within the plan's limits
    Serve(serve::ServeArguments),
}

/// Runs one of the commands.
pub fn rig(command: &RigCommand, settings: Settings) -> Result<Exit, Failure> {
    match command {
        RigCommand::List(arguments) => list::list(arguments.format),
        RigCommand::Probe(arguments) => with_rig(
            &arguments.plan,
            &arguments.plan_settings,
            settings,
            |rig, plan, _| probe::probe(rig, plan),
        ),
        RigCommand::Monitor(arguments) => {
            let request = monitor::MonitorRequest::of(arguments)?;
            with_rig(
                &arguments.plan,
                &arguments.plan_settings,
                settings,
                |rig, plan, stop_request| {
                    monitor::monitor(rig, plan, &request, stop_request, settings)
                },
            )
        }
        RigCommand::Jog(arguments) => jog::jog(arguments, settings),
        RigCommand::Simulate(arguments) => simulate::simulate(arguments, settings),
        RigCommand::Serve(arguments) => serve::serve(arguments, settings),
    }
}

/// Checks the plan, opens its rig and runs a command on it.
fn with_rig(
    path: &Path,
    plan_settings: &PlanSettings,
    settings: Settings,
    command: impl FnOnce(&mut dyn Rig, &Plan, &StopRequest) -> Result<Exit, Failure>,
) -> Result<Exit, Failure> {
    let checked = plan_file::open(path, plan_settings)?;
    plan_file::show(&checked, path, settings);
    let Some(plan) = &checked.plan else {
        return Ok(Exit::Wrong);
    };
    let stop_request = StopRequest::default();
    match &plan.rig.link {
        Link::Virtual(_) => command(virtual_rig(plan).as_mut(), plan, &stop_request),
        Link::Real(_) => {
            let location = |fault: &str| plan_file::location_of_link(&checked, path, fault);
            let connected = connect(&plan.rig, &plan.limits, &stop_request).map_err(Failure::Rig);
            let mut connected = connected.map_err(|failure| failure.in_the_plan(location))?;
            command(&mut connected.rig, plan, &stop_request)
        }
    }
}
