//! `psd rig jog`: moves the rig manually, inside the limits of the plan, through the guard, and only with the operator's consent. In:
//! positions as the language writes them. Out: the readings at each end; for a real rig also a run folder with the run log.

mod session;

use std::path::{Path, PathBuf};

use clap::Args;

use super::typed::{number, positions};
use crate::args::{PlanSettings, name};
use crate::evidence::Folder;
use crate::exit::{Exit, Failure};
use crate::files::finish_run::write_made;
use crate::files::record_file;
use crate::files::record_file::Circumstances;
use crate::files::run_folder::{FolderSink, RunFolder};
use crate::files::{plan_file, provenance};
use crate::operator::dialogue::by_lines;
use crate::operator::real_rig;
use crate::operator::watch::{Attendance, Signals};
use crate::output::print_message;
use crate::settings::Settings;
use psd::report;
use psd::report::Provenance;
use psd::run::Unwatched;
use psd::run::client_run::{Driver, Requests};
use psd::run::remote_control::Specimen;
use psd::run::replay;
use psd::run::replay::{BY_HAND, Header, OpenLog, Recorded};
use psd_plan::record::remote::DrivenStep;
use psd_plan::{Datum, Link, Plan};
use psd_rig::transport::{Clock as _, MonotonicClock};
use psd_rig::{Connected, Rig, StopRequest, connect, virtual_rig};
use psd_text::units::Dimension;
use psd_text::units::display::readable;
use session::{JogSession, Person};

#[derive(Debug, Args)]
#[command(
    after_help = "THE RIG MOVES. On a real rig every question, answer and move is logged in a run folder for `psd verify`.\n\n\
    Exit codes:\n\
    \x20 0  all targets reached\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the rig\n\
    \x20 4  stopped by a limit or by the operator"
)]
pub struct JogArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Target, such as "1 mm" or "1 mm, 2 mm" [default: typed]
    #[arg(long, value_name = "POSITION", allow_hyphen_values = true)]
    pub to: Option<String>,
    /// Speed, such as "0.5 mm/s" [default: the rig's own speed]
    #[arg(long, value_name = "SPEED")]
    pub speed: Option<String>,
    /// Answer every prompt with yes: the rig MOVES immediately
    #[arg(long)]
    pub yes: bool,
    /// Clear the hold of an axis without moving it (logged)
    #[arg(long)]
    pub let_go: bool,
    /// Count positions from the zero of this run (`datum = here`)
    #[arg(long, value_name = "RUN")]
    pub datum: Option<PathBuf>,
    /// Operator name [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
    /// Run folder on a real rig, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Moves the rig; each move needs the consent of the operator.
pub fn jog(arguments: &JogArguments, settings: Settings) -> Result<Exit, Failure> {
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
    if !settings.can_ask && (!arguments.yes || arguments.to.is_none()) {
        return Err(Failure::command_line(
            "a move requires a confirmation, and no operator can be asked",
        )
        .help("give `--to` and `--yes`, or start it from a terminal"));
    }
    let wanted = Wanted {
        to: arguments
            .to
            .as_deref()
            .map(|to| positions(to, plan.degrees_of_freedom(), "--to"))
            .transpose()?,
        speed: arguments
            .speed
            .as_deref()
            .map(|speed| number(speed, Dimension::VELOCITY, "--speed", "0.5 mm/s"))
            .transpose()?,
    };
    let attendance = real_rig::named(attendance, plan)?;
    let stop_request = StopRequest::default().with_release_allowed(arguments.let_go);
    let _signals = Signals::holding(&stop_request).map_err(Failure::Signals)?;
    let by = attendance
        .operator_of(plan)
        .unwrap_or_else(|| "an unnamed operator".to_owned());
    let person = Person {
        lines: by_lines::Person::new(Some(by.clone())),
        stop_request: &stop_request,
        yes: arguments.yes,
        by,
    };
    let jog = Jog {
        arguments,
        plan,
        wanted: &wanted,
        person,
        settings,
    };
    match plan.rig.link {
        Link::Virtual(_) => jog.on_a_virtual_rig(),
        Link::Real(_) => {
            let recorded = arguments
                .datum
                .as_deref()
                .map(|run| datum_of(run, plan))
                .transpose()?;
            let rig = plan.rig.with_recorded_datum(recorded.as_deref());
            let connected = connect(&rig, &plan.limits, &stop_request).map_err(Failure::Rig);
            let location =
                |fault: &str| plan_file::location_of_link(&checked, &arguments.plan, fault);
            let mut connected = connected.map_err(|failure| failure.in_the_plan(location))?;
            if !settings.can_ask && !connected.rig.identity().simulated {
                return Err(Failure::command_line(
                    "a real rig is not moved by hand without an operator at a terminal",
                )
                .help("start it from a terminal"));
            }
            if recorded.is_none() {
                without_load(plan, &mut connected.rig)?;
            }
            jog.on_a_real_rig(&attendance, connected)
        }
    }
}

/// The zero of a recorded run in the coordinate of its rig, one value per axis \[m\].
fn datum_of(run: &Path, plan: &Plan) -> Result<Vec<f64>, Failure> {
    let read = record_file::read(run)?;
    let of_this_rig = read.plan.rig.name == plan.rig.name;
    let first = read.logged.rigs.first().filter(|_| of_this_rig);
    let datum = first.and_then(|rig| rig.datum.clone());
    datum.ok_or_else(|| {
        Failure::command_line(format!(
            "{}: its run log has no datum of rig `{}`",
            run.display(),
            plan.rig.name
        ))
    })
}

/// Refuses a rig whose zero is its present position while the specimen carries load: the limits would be shifted.
fn without_load(plan: &Plan, rig: &mut dyn Rig) -> Result<(), Failure> {
    let Some(link) = plan
        .rig
        .link
        .as_real()
        .filter(|link| link.datum == Datum::Here)
    else {
        return Ok(());
    };
    let found = rig.read().map_err(Failure::Rig)?;
    let loaded =
        found.force.iter().enumerate().find(|(axis, force)| {
            force.is_nan() || force.abs() > link.pretest_check_of(*axis).zero
        });
    let Some((_, force)) = loaded else {
        return Ok(());
    };
    Err(Failure::command_line(format!(
        "the specimen carries {}: the present position cannot be the zero. Nothing moved",
        readable(*force, Dimension::FORCE)
    ))
    .help("`--datum RUN` counts from the zero of the run that loaded it"))
}

/// The move of the command line, SI.
struct Wanted {
    /// Target position per axis; None if the operator types positions.
    to: Option<Vec<f64>>,
    speed: Option<f64>,
}

/// Moves of a plan's rig by hand.
struct Jog<'a> {
    arguments: &'a JogArguments,
    plan: &'a Plan,
    wanted: &'a Wanted,
    person: Person<'a>,
    settings: Settings,
}

impl<'a> Jog<'a> {
    /// On a simulated rig no run log is kept.
    fn on_a_virtual_rig(self) -> Result<Exit, Failure> {
        let plan = self.plan;
        let mut rig = virtual_rig(plan);
        let provenance =
            provenance::of_this_run(plan, self.arguments.plan_settings.date.as_deref());
        let circumstances = Circumstances {
            served: Some(BY_HAND.to_owned()),
            ..Circumstances::default()
        };
        let header = self.header(rig.as_ref(), &provenance, circumstances);
        let log = OpenLog {
            journal: record_file::begin_nowhere(plan, &header)?,
            wall: Box::new(|| None),
        };
        let (recorded, _, session) = self.drive(rig.as_mut(), log);
        session.end(&recorded.record.outcome)
    }

    /// On a real rig the moves are recorded: the history of a specimen before its test is evidence.
    fn on_a_real_rig(
        self,
        attendance: &Attendance,
        mut connected: Connected,
    ) -> Result<Exit, Failure> {
        let (plan, arguments) = (self.plan, self.arguments);
        let rig = &mut connected.rig;
        let folder = RunFolder::create(arguments.out.as_deref(), &arguments.plan)?;
        let circumstances = Circumstances {
            served: Some(BY_HAND.to_owned()),
            ..real_rig::circumstances(plan, attendance)
        };
        let provenance = provenance::of_real_run(
            plan,
            arguments.plan_settings.date.as_deref(),
            &circumstances,
        );
        let header = self.header(rig, &provenance, circumstances);
        let log = OpenLog {
            journal: record_file::begin(folder.path(), plan, &header)?,
            wall: real_rig::wall_clock(),
        };
        let (recorded, steps, session) = self.drive(rig, log);
        drop(connected);
        let kept = Folder::digests(folder.path())?.kept();
        write_made(FolderSink::new(folder.path()), &kept, |sink| {
            report::put_driven(&steps, None, sink)
        })?;
        print_message(&format!("  logged in: {}\n", folder.path().display()));
        if let Some(fault) = &recorded.fault {
            print_message(&format!(
                "  the run log could not be written to its end: {fault}\n"
            ));
        }
        let exit = session.end(&recorded.record.outcome)?;
        Ok(if recorded.fault.is_some() {
            exit.max(Exit::Fault)
        } else {
            exit
        })
    }

    /// The header of the run log.
    fn header(
        &self,
        rig: &dyn Rig,
        provenance: &Provenance,
        circumstances: Circumstances,
    ) -> Header {
        record_file::header(
            self.plan,
            record_file::device(rig),
            &self.arguments.plan_settings,
            provenance,
            circumstances,
        )
    }

    /// Lets the operator move the rig.
    fn drive(self, rig: &mut dyn Rig, log: OpenLog) -> (Recorded, Vec<DrivenStep>, JogSession<'a>) {
        let mut session = JogSession {
            wanted: self.wanted,
            plan: self.plan,
            identity: rig.identity(),
            own_speed: rig.own_speed(),
            person: self.person,
            settings: self.settings,
            ended: None,
        };
        let clock = MonotonicClock::start();
        let mut drive = |specimen: &mut Specimen<'_, '_>| session.drive(specimen);
        let (recorded, steps) = replay::record_driven(
            self.plan,
            rig,
            &mut Unwatched,
            log,
            Requests {
                driver: Driver::ByHand,
                clock: &|| clock.now(),
                client: &mut drive,
            },
        );
        (recorded, steps, session)
    }
}
