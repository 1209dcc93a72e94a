//! `psd rig serve`: a coordinator or a finite-element program drives the plan's rig, inside the plan's limits. The one
//! file that opens the port.

use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::cli::args::{ServeArguments, ServedProtocol};
use crate::cli::exit::{Exit, Failure};
use crate::cli::output::{give, tell};
use crate::cli::plan_file;
use crate::cli::settings::Settings;
use crate::diagnostic::excerpt::escape;
use crate::plan::Plan;
use crate::quantity::Dimension;
use crate::quantity::display::readable;
use crate::quantity::unit;
use crate::rig::{Guard, RigFault, VirtualRig};
use crate::serve::{self, Ended, Event, Protocol, Session};

/// Serves until a client or a person ends it.
pub fn serve(arguments: &ServeArguments, settings: Settings) -> Result<Exit, Failure> {
    let checked = plan_file::open(&arguments.plan, &arguments.plan_settings)?;
    plan_file::show(&checked, &arguments.plan, settings);
    let Some(plan) = &checked.plan else { return Ok(Exit::Wrong) };
    let protocol = protocol(arguments, plan)?;
    let mut rig = virtual_rig(plan)?;
    let mut guard = Guard::new(&mut rig, plan.limits).map_err(|fault| failed(plan, &fault))?;
    let stop = stop_signals().map_err(Failure::Signals)?;

    let listening = |error: std::io::Error| Failure::file(arguments.listen.to_string(), error.to_string());
    let listener = TcpListener::bind(arguments.listen).map_err(listening)?;
    let address = listener.local_addr().map_err(listening)?;
    if !address.ip().is_loopback() {
        tell(&open_door(address, settings));
    }
    // Who started this program waits for the line.
    give(&format!("ready: {} on {address}\n", arguments.protocol.name()))?;

    let mut exit = Exit::Met;
    let mut told = Ok(());
    let mut tell_event = |event: Event<'_>| match event {
        Event::Connected(client) => tell(&format!("  {client} is connected\n")),
        Event::Ended(session) => {
            exit = exit.max(exit_of(session));
            let given = give(&summary(session));
            told = std::mem::replace(&mut told, Ok(())).and(given);
        }
    };
    let wanted = || stop.load(Ordering::Acquire);
    serve::serve(&listener, protocol, &mut guard, arguments.once, &wanted, &mut tell_event).map_err(listening)?;
    told?;
    Ok(exit)
}

/// What the client speaks, with the stiffness that it may ask for.
fn protocol(arguments: &ServeArguments, plan: &Plan) -> Result<Protocol, Failure> {
    let given = arguments.stiffness.as_deref().map(stiffness).transpose()?;
    match arguments.protocol {
        ServedProtocol::Nees if given.is_some() => {
            Err(Failure::command_line("NEES has no question for a stiffness: `--stiffness` is for generic-client"))
        }
        ServedProtocol::Nees => Ok(Protocol::Nees),
        ServedProtocol::GenericClient => {
            let behaviour = VirtualRig::specimen_of(plan).and_then(|specimen| specimen.behaviour);
            let known = given.or_else(|| behaviour.map(|behaviour| behaviour.initial_stiffness()));
            let stiffness = known.ok_or_else(|| {
                Failure::command_line(
                    "the stiffness that a generic client may ask for is not known: the specimen has no behaviour",
                )
                .help("give it: --stiffness \"300 kN/m\"")
            })?;
            Ok(Protocol::GenericClient { stiffness })
        }
    }
}

/// `300 kN/m`, in N/m.
fn stiffness(text: &str) -> Result<f64, Failure> {
    let wrong = |reason: &str| Failure::command_line(format!("--stiffness {text}: {reason}; write it as \"300 kN/m\""));
    let (number, token) = text.split_once(' ').ok_or_else(|| wrong("a number and its unit"))?;
    let number: f64 = number.parse().map_err(|_| wrong("no number"))?;
    let unit = unit::parse(token.trim()).map_err(|error| wrong(&error.to_string()))?;
    if Dimension::FORCE.over(Dimension::LENGTH) != Some(unit.dimension) {
        return Err(wrong("no unit of stiffness"));
    }
    let stiffness = number * unit.factor;
    if stiffness >= 0.0 && stiffness.is_finite() { Ok(stiffness) } else { Err(wrong("a stiffness is 0 or more")) }
}

/// The plan's rig. A real one is not opened here: nobody would notice that an ideal one stands in for it.
fn virtual_rig(plan: &Plan) -> Result<VirtualRig, Failure> {
    if plan.rig.link.as_real().is_some() {
        let message = format!("the rig `{}` is a real one, and only virtual rigs are served", plan.rig.name);
        return Err(Failure::command_line(message).help("name a virtual rig of the plan: --rig NAME"));
    }
    Ok(VirtualRig::of_plan(plan))
}

fn failed(plan: &Plan, fault: &RigFault) -> Failure {
    Failure::file(plan.rig.name.clone(), fault.to_string())
}

/// Ctrl-C and its like end the serving.
fn stop_signals() -> std::io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

fn open_door(address: SocketAddr, settings: Settings) -> String {
    let note = settings.paint_note("  note:");
    format!(
        "{note} {address} can be reached from other machines, and the protocol has no password:\n        whoever reaches it moves the specimen, within the plan's limits\n"
    )
}

/// The four lines that say what a session asked of the specimen.
fn summary(session: &Session) -> String {
    let driven = session.driven;
    let refused = if driven.refused > 0 { format!(", {} refused by a limit", driven.refused) } else { String::new() };
    format!(
        "session: {}\ntargets: {}{refused}\nlargest |x|: {}\nlargest |F|: {}\n",
        escape(&session.ended.to_string()),
        driven.targets,
        readable(driven.displacement, Dimension::LENGTH),
        readable(driven.force, Dimension::FORCE),
    )
}

/// A refused target counts as a stop by a limit, whatever the client did then.
const fn exit_of(session: &Session) -> Exit {
    match session.ended {
        Ended::Limit(_) | Ended::Stopped => Exit::Stopped,
        Ended::Rig(_) | Ended::Lost(_) | Ended::HungUp | Ended::Misspoken(_) => Exit::Fault,
        Ended::Closed if session.driven.refused > 0 => Exit::Stopped,
        Ended::Closed => Exit::Met,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::Driven;

    #[test]
    fn a_stiffness_has_its_unit() {
        assert_eq!(stiffness("300 kN/m").unwrap(), 3e5);
        assert_eq!(stiffness("0.3 kN/mm").unwrap(), 3e5);
        for wrong in ["300", "300 kN", "x kN/m", "-1 N/m", "nan N/m", "1e400 N/m", "300 foo/m"] {
            assert_eq!(stiffness(wrong).unwrap_err().exit(), Exit::Wrong, "{wrong}");
        }
    }

    #[test]
    fn a_session_ends_as_the_reference_says() {
        let session = |ended, refused| Session { ended, driven: Driven { refused, ..Driven::default() } };
        for (ended, refused, code) in [
            (Ended::Closed, 0, 0),
            (Ended::Closed, 1, 4),
            (Ended::HungUp, 0, 3),
            (Ended::Stopped, 0, 4),
            (Ended::Limit(RigFault::Interrupted), 1, 4),
        ] {
            assert_eq!(exit_of(&session(ended, refused)).code(), code);
        }
        let driven = Driven { targets: 200, refused: 1, displacement: 0.008_165_08, force: 2449.5 };
        let said = summary(&Session { ended: Ended::Closed, driven });
        assert_eq!(
            said,
            "session: closed by the client\ntargets: 200, 1 refused by a limit\nlargest |x|: 8.165 mm\nlargest |F|: 2.450 kN\n"
        );
    }
}
