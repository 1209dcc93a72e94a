//! `psd rig serve`: a coordinator or a finite-element program drives the plan's rig, inside the plan's limits. In: a plan, a port. Out: a
//! run folder with the run log, which `psd verify` replays, and a table of targets and readings. Only this file opens the port; it
//! implements no protocol.

use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;

use clap::Args;

use super::client_protocol::{ClientArguments, protocol};
use crate::args::{PlanSettings, name};
use crate::evidence::Folder;
use crate::exit::{Exit, Failure};
use crate::files::finish_run::write_made;
use crate::files::record_file;
use crate::files::record_file::Circumstances;
use crate::files::run_folder::{FolderSink, RunFolder};
use crate::files::{plan_file, provenance};
use crate::operator::real_rig;
use crate::operator::watch::{Attendance, Signals, Watcher};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::remote;
use psd::remote::{Ended, Event, Protocol, Session};
use psd::report;
use psd::report::Provenance;
use psd::run::client_run::{Driver, Requests};
use psd::run::remote_control::Specimen;
use psd::run::replay;
use psd::run::replay::{OpenLog, Recorded, Wall};
use psd_plan::record::Outcome;
use psd_plan::record::remote::DrivenStep;
use psd_plan::{Link, Plan};
use psd_rig::transport::{Clock as _, MonotonicClock};
use psd_rig::{Rig, StopRequest, virtual_rig};
use psd_text::diagnostic::excerpt::escape;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

#[derive(Debug, Args)]
#[command(
    after_help = "THE RIG MOVES as the client requests. psd prints `ready` when it listens, and a summary after each session.\n\n\
    Exit codes:\n\
    \x20 0  closed by the client\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the client or the rig\n\
    \x20 4  stopped by a limit or by the operator\n\
    The worst session determines the code."
)]
pub struct ServeArguments {
    /// The plan: its rig, specimen and limits apply
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    #[command(flatten)]
    pub client: ClientArguments,
    /// Address to listen at; port 0 is any free port
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8090")]
    pub listen: std::net::SocketAddr,
    /// End after the first session
    #[arg(long)]
    pub once: bool,
    /// Run folder, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Answer every prompt with yes: a real rig MOVES immediately
    #[arg(long)]
    pub yes: bool,
    /// Operator at the rig [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
}

/// Serves until a client or the operator ends it.
pub fn serve(arguments: &ServeArguments, settings: Settings) -> Result<Exit, Failure> {
    let attendance = Attendance {
        yes: arguments.yes,
        operator: arguments.operator.clone(),
        screen: None,
    };
    let checked = real_rig::open_plan(
        &arguments.plan,
        &arguments.plan_settings,
        &attendance,
        settings,
    )?;
    let Some(plan) = &checked.plan else {
        return Ok(Exit::Wrong);
    };
    let protocol = protocol(&arguments.client, plan)?;
    named(arguments, plan)?;
    without_axial_axes(plan)?;
    let attendance = real_rig::named(attendance, plan)?;
    let clients = ClientListener::open(arguments)?;
    let stop_request = StopRequest::default();
    let service = Service {
        arguments,
        clients,
        protocol,
        stop_request: &stop_request,
        settings,
    };
    // The connection to the rig ends with this arm: psd does not communicate with the rig while it writes the results.
    let served = match plan.rig.link {
        Link::Virtual(_) => {
            let signals = Signals::caught(&stop_request).map_err(Failure::Signals)?;
            let mut watcher = Watcher::new(settings, &attendance, plan, true, signals, false);
            let circumstances = Circumstances {
                served: Some(arguments.client.protocol.name().to_owned()),
                ..real_rig::start_alone()
            };
            let provenance = provenance::of_simulated_run(
                plan,
                arguments.plan_settings.date.as_deref(),
                circumstances.began.as_deref(),
            );
            let mut rig = virtual_rig(plan);
            let stage = Stage {
                plan,
                provenance,
                circumstances,
                wall: Box::new(|| None),
            };
            on_record(&service, stage, rig.as_mut(), &mut watcher)?
        }
        Link::Real(_) => {
            let mut opened = real_rig::open(plan, &attendance, &stop_request, settings, false)
                .map_err(|failure| {
                    failure.in_the_plan(|fault| {
                        plan_file::location_of_link(&checked, &arguments.plan, fault)
                    })
                })?;
            let circumstances = real_rig::circumstances(plan, &attendance);
            let circumstances = Circumstances {
                served: Some(arguments.client.protocol.name().to_owned()),
                ..circumstances
            };
            let provenance = provenance::of_real_run(
                plan,
                arguments.plan_settings.date.as_deref(),
                &circumstances,
            );
            let stage = Stage {
                plan,
                provenance,
                circumstances,
                wall: real_rig::wall_clock(),
            };
            on_record(
                &service,
                stage,
                &mut opened.connected.rig,
                &mut opened.watcher,
            )?
        }
    };
    served.conclude(arguments, settings)
}

/// A client on the network may move a real rig only if the command line names the rig.
fn named(arguments: &ServeArguments, plan: &Plan) -> Result<(), Failure> {
    if plan.rig.link.as_real().is_some() && arguments.plan_settings.rig.is_none() {
        let name = &plan.rig.name;
        let message = format!("the rig `{name}` is a real rig, and is served only if it is named");
        return Err(Failure::command_line(message).help(format!("name it: --rig {name}")));
    }
    Ok(())
}

/// The protocols of clients have no message for an axial load.
fn without_axial_axes(plan: &Plan) -> Result<(), Failure> {
    if plan.rig.axial_axes(&plan.limits).next().is_some() {
        let message = format!(
            "the rig `{}` has an axial axis, whose load no client applies",
            plan.rig.name
        );
        return Err(Failure::command_line(message).help("serve a rig without an axial axis"));
    }
    Ok(())
}

/// The listener for clients. It opens before the rig, so that nothing moves if the port is in use.
struct ClientListener {
    listener: TcpListener,
    address: SocketAddr,
}

impl ClientListener {
    fn open(arguments: &ServeArguments) -> Result<Self, Failure> {
        let listener =
            TcpListener::bind(arguments.listen).map_err(|error| listening(arguments, &error))?;
        let address = listener
            .local_addr()
            .map_err(|error| listening(arguments, &error))?;
        Ok(Self { listener, address })
    }
}

fn listening(arguments: &ServeArguments, error: &std::io::Error) -> Failure {
    Failure::file(arguments.listen.to_string(), error.to_string())
        .help("use another port: --listen 127.0.0.1:0 takes a free one")
}

/// What is offered to clients, and where.
struct Service<'a> {
    arguments: &'a ServeArguments,
    clients: ClientListener,
    protocol: Protocol,
    stop_request: &'a StopRequest,
    settings: Settings,
}

/// The origin of a run log.
struct Stage<'a> {
    plan: &'a Plan,
    provenance: Provenance,
    circumstances: Circumstances,
    wall: Wall,
}

/// The outcome of a served run, and its run log.
struct Served {
    folder: RunFolder,
    recorded: Recorded,
    steps: Vec<DrivenStep>,
    /// The exit of the worst session.
    exit: Exit,
    /// Whether the listener and standard output had no error.
    clients: std::io::Result<()>,
    printed: Result<(), Failure>,
}

impl Served {
    /// Writes the results.
    fn conclude(self, arguments: &ServeArguments, settings: Settings) -> Result<Exit, Failure> {
        let Self {
            folder,
            recorded,
            steps,
            mut exit,
            clients,
            printed,
        } = self;
        let drift = recorded.record.drift.as_ref();
        let kept = Folder::digests(folder.path())?.kept();
        let sink = FolderSink::new(folder.path());
        if let Outcome::NotReleased { reason } = &recorded.record.outcome {
            print_message(&format!("  NOT RELEASED: {}\n", escape(reason)));
            write_made(sink, &kept, |_| Ok(Vec::new()))?;
        } else {
            write_made(sink, &kept, |sink| report::put_driven(&steps, drift, sink))?;
        }
        for beyond in drift.iter().flat_map(|drift| drift.beyond()) {
            let note = settings.paint_note("  note:");
            print_message(&format!(
                "{note} {}: the readings are inconclusive\n",
                escape(&beyond.reason)
            ));
        }
        print_message(&format!("  {}\n", folder.path().display()));
        clients.map_err(|error| listening(arguments, &error))?;
        printed?;
        if let Some(fault) = &recorded.fault {
            print_message(&format!(
                "  the run log could not be written to its end: {fault}\n"
            ));
            exit = exit.max(Exit::Fault);
        }
        Ok(exit.max(match recorded.record.outcome {
            Outcome::Completed => Exit::Met,
            Outcome::Aborted { .. } | Outcome::NotReleased { .. } => Exit::Stopped,
            Outcome::Blocked { .. } => Exit::Missed,
            Outcome::Faulted { .. } => Exit::Fault,
        }))
    }
}

/// Serves. Every request and every answer of the rig is recorded in a run folder.
fn on_record(
    service: &Service<'_>,
    stage: Stage<'_>,
    rig: &mut dyn Rig,
    watcher: &mut Watcher,
) -> Result<Served, Failure> {
    let Service {
        arguments,
        clients,
        protocol,
        stop_request,
        settings,
    } = service;
    let Stage {
        plan,
        provenance,
        circumstances,
        wall,
    } = stage;
    let folder = RunFolder::create(arguments.out.as_deref(), &arguments.plan)?;
    let header = record_file::header(
        plan,
        record_file::device(rig),
        &arguments.plan_settings,
        &provenance,
        circumstances,
    );
    let journal = record_file::begin(folder.path(), plan, &header)?;
    let mut exit = Exit::Met;
    let mut printed = Ok(());
    let mut served = Ok(());
    let mut client = |specimen: &mut Specimen<'_, '_>| {
        if !clients.address.ip().is_loopback() {
            print_message(&open_listener(clients.address, *settings));
        }
        if let Some(specimens) = plan.specimens_at_scale() {
            print_message(&format!(
                "  displacements, forces and stiffness are numbers of the rig: {specimens}\n"
            ));
        }
        // The program that started this one waits for the line.
        printed = print_result(&format!(
            "ready: {} on {}\n",
            arguments.client.protocol.name(),
            clients.address
        ));
        let mut print_event = |event: Event<'_>| match event {
            Event::Connected(client) => print_message(&format!("  {client} is connected\n")),
            Event::Ended(session) => {
                exit = exit.max(exit_of(session));
                let given = print_result(&summary(session));
                printed = std::mem::replace(&mut printed, Ok(())).and(given);
            }
        };
        served = remote::serve(
            &clients.listener,
            protocol,
            specimen,
            arguments.once,
            stop_request,
            &mut print_event,
        );
    };
    let clock = MonotonicClock::start();
    let (recorded, steps) = replay::record_driven(
        plan,
        rig,
        watcher,
        OpenLog { journal, wall },
        Requests {
            driver: Driver::Client,
            clock: &|| clock.now(),
            client: &mut client,
        },
    );
    watcher.finish();
    Ok(Served {
        folder,
        recorded,
        steps,
        exit,
        clients: served,
        printed,
    })
}

fn open_listener(address: SocketAddr, settings: Settings) -> String {
    let note = settings.paint_note("  note:");
    format!(
        "{note} {address} can be reached from other machines, and the protocol has no password:\n        every client MOVES the specimen, within the plan's limits\n"
    )
}

/// The four lines that summarise the requests of a session.
fn summary(session: &Session) -> String {
    let driven = session.driven;
    let refused = if driven.refused > 0 {
        format!(", {} refused by a limit", driven.refused)
    } else {
        String::new()
    };
    format!(
        "session: {}\ntargets: {}{refused}\nlargest |x|: {}\nlargest |F|: {}\n",
        escape(&session.ended.to_string()),
        driven.targets,
        readable(driven.displacement, Dimension::LENGTH),
        readable(driven.force, Dimension::FORCE),
    )
}

/// A refused target counts as a stop by a limit, whatever the client does afterwards.
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
    use psd::remote::Driven;
    use psd_rig::RigFault;

    #[test]
    fn a_session_ends_as_the_reference_specifies() {
        let session = |ended, refused| Session {
            ended,
            driven: Driven {
                refused,
                ..Driven::default()
            },
        };
        for (ended, refused, code) in [
            (Ended::Closed, 0, 0),
            (Ended::Closed, 1, 4),
            (Ended::HungUp, 0, 3),
            (Ended::Stopped, 0, 4),
            (Ended::Limit(RigFault::Interrupted), 1, 4),
        ] {
            assert_eq!(exit_of(&session(ended, refused)).code(), code);
        }
        let driven = Driven {
            targets: 200,
            refused: 1,
            displacement: 0.008_165_08,
            force: 2449.5,
        };
        let text = summary(&Session {
            ended: Ended::Closed,
            driven,
        });
        assert_eq!(
            text,
            "session: closed by the client\ntargets: 200, 1 refused by a limit\nlargest |x|: 8.165 mm\nlargest |F|: 2.450 kN\n"
        );
    }
}
