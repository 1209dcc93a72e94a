//! `psd rig jog`: moves the rig by hand, inside the plan's limits, through the guard and never without a yes. In: places as
//! the language writes them. Out: where the rig went; of a real rig also a run folder with the record.

use std::path::Path;

use super::typed::{number, places};
use crate::cli::args::JogArguments;
use crate::cli::exit::{Exit, Failure};
use crate::cli::files::finish_run::write_made;
use crate::cli::files::record_file;
use crate::cli::files::record_file::Circumstances;
use crate::cli::files::run_folder::{FolderShelf, RunFolder};
use crate::cli::files::{plan_file, provenance};
use crate::cli::operator::question::{Kind, Question};
use crate::cli::operator::real_rig;
use crate::cli::operator::watch::{Attendance, Signals, Typed, agrees, next_line};
use crate::cli::output::{give, tell};
use crate::cli::settings::Settings;
use crate::evidence::Folder;
use crate::plan::{Datum, Interval, Link, Plan};
use crate::record::Outcome;
use crate::report;
use crate::rig::{
    Connected, Identity, LimitedQuantity, OWN_SPEED, Rig, RigFault, Wish, connect, virtual_rig,
};
use crate::run::remote_control::{Driver, Specimen};
use crate::run::replay;
use crate::run::replay::BY_HAND;
use crate::run::{Extent, Motion, Parting, Unwatched};
use crate::units::Dimension;
use crate::units::display::{plain, readable};

/// Moves, asking first on every move.
pub fn jog(arguments: &JogArguments, settings: Settings) -> Result<Exit, Failure> {
    let attendance = Attendance {
        yes: arguments.yes,
        operator: arguments.operator.clone(),
    };
    let unattended = real_rig::unattended(&attendance, settings);
    let checked = plan_file::open_to_run(&arguments.plan, &arguments.plan_settings, unattended)?;
    plan_file::show(&checked, &arguments.plan, settings);
    let Some(plan) = &checked.plan else {
        return Ok(Exit::Wrong);
    };
    if !settings.can_ask && (!arguments.yes || arguments.to.is_none()) {
        return Err(
            Failure::command_line("a move needs a yes, and nobody can be asked")
                .help("give `--to` and `--yes`, or start it from a terminal"),
        );
    }
    let wanted = Wanted {
        to: arguments
            .to
            .as_deref()
            .map(|to| places(to, plan.degrees_of_freedom(), "--to"))
            .transpose()?,
        speed: arguments
            .speed
            .as_deref()
            .map(|speed| number(speed, Dimension::VELOCITY, "--speed", "0.5 mm/s"))
            .transpose()?,
    };
    let attendance = real_rig::named(attendance, plan)?;
    let wish = Wish::default().letting_go(arguments.let_go);
    let _signals = Signals::holding(&wish).map_err(Failure::Signals)?;
    let by = real_rig::operator(plan, &attendance).unwrap_or_else(|| "somebody".to_owned());
    let person = Person {
        typed: None,
        wish: &wish,
        yes: arguments.yes,
        by,
    };
    match plan.rig.link {
        Link::Virtual(_) => on_a_virtual_rig(arguments, plan, &wanted, person, settings),
        Link::Real(_) => {
            let recorded = arguments
                .datum
                .as_deref()
                .map(|run| datum_of(run, plan))
                .transpose()?;
            let rig = plan.rig.with_recorded_datum(recorded.as_deref());
            let connected = connect(&rig, &plan.limits, &wish).map_err(Failure::Rig);
            let place = |fault: &str| plan_file::place_of_link(&checked, &arguments.plan, fault);
            let mut connected = connected.map_err(|failure| failure.in_the_plan(place))?;
            if !settings.can_ask && !connected.rig.identity().simulated {
                return Err(Failure::command_line(
                    "a real rig is not moved by hand without a person at a terminal",
                )
                .help("start it from a terminal"));
            }
            if recorded.is_none() {
                without_load(plan, &mut connected.rig)?;
            }
            on_a_real_rig(
                arguments,
                plan,
                &attendance,
                connected,
                &wanted,
                person,
                settings,
            )
        }
    }
}

/// Where the zero of a recorded run lies in the coordinate of its rig, m, one an axis.
fn datum_of(run: &Path, plan: &Plan) -> Result<Vec<f64>, Failure> {
    let read = record_file::read(run)?;
    let of_this_rig = read.plan.rig.name == plan.rig.name;
    let datum = read
        .played
        .rig
        .filter(|_| of_this_rig)
        .and_then(|rig| rig.datum);
    datum.ok_or_else(|| {
        Failure::command_line(format!(
            "{}: its record says of no datum of rig `{}`",
            run.display(),
            plan.rig.name
        ))
    })
}

/// A rig whose zero is where it stands does not count from where its specimen carries load: its limits would go with it.
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
    let loaded = found
        .force
        .iter()
        .enumerate()
        .find(|(axis, force)| force.is_nan() || force.abs() > link.gate_of(*axis).zero);
    let Some((_, force)) = loaded else {
        return Ok(());
    };
    Err(Failure::command_line(format!(
        "the specimen carries {}: where it stands is no zero to count from, and nothing moved",
        readable(*force, Dimension::FORCE)
    ))
    .help("`--datum RUN` counts from the zero of the run that loaded it"))
}

/// What the command line asks for, SI.
struct Wanted {
    /// None: places are typed.
    to: Option<Vec<f64>>,
    speed: Option<f64>,
}

/// Nothing real moves: nothing is kept.
fn on_a_virtual_rig(
    arguments: &JogArguments,
    plan: &Plan,
    wanted: &Wanted,
    person: Person<'_>,
    settings: Settings,
) -> Result<Exit, Failure> {
    let circumstances = Circumstances {
        served: Some(BY_HAND.to_owned()),
        ..Circumstances::default()
    };
    let mut rig = virtual_rig(plan);
    let device = record_file::device(rig.as_ref());
    let header = record_file::header(
        plan,
        device,
        &arguments.plan_settings,
        &provenance::of(plan, arguments.plan_settings.date.as_deref()),
        circumstances,
    );
    let journal = record_file::begin_nowhere(plan, &header)?;
    let mut hand = Hand {
        wanted,
        plan,
        identity: rig.identity(),
        own_speed: rig.own_speed(),
        person,
        settings,
        ended: None,
    };
    let mut drive = |specimen: &mut Specimen<'_, '_>| hand.drive(specimen);
    let wall = Box::new(|| None);
    let (recorded, _) = replay::record_driven(
        plan,
        rig.as_mut(),
        &mut Unwatched,
        journal,
        wall,
        Driver::ByHand,
        &mut drive,
    );
    hand.end(&recorded.record.outcome)
}

/// What was done to a specimen before its test is evidence too.
fn on_a_real_rig(
    arguments: &JogArguments,
    plan: &Plan,
    attendance: &Attendance,
    mut connected: Connected,
    wanted: &Wanted,
    person: Person<'_>,
    settings: Settings,
) -> Result<Exit, Failure> {
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
    let header = record_file::header(
        plan,
        record_file::device(rig),
        &arguments.plan_settings,
        &provenance,
        circumstances,
    );
    let journal = record_file::begin(folder.path(), plan, &header)?;
    let mut hand = Hand {
        wanted,
        plan,
        identity: rig.identity(),
        own_speed: rig.own_speed(),
        person,
        settings,
        ended: None,
    };
    let mut drive = |specimen: &mut Specimen<'_, '_>| hand.drive(specimen);
    let wall = real_rig::wall_clock();
    let (recorded, steps) = replay::record_driven(
        plan,
        rig,
        &mut Unwatched,
        journal,
        wall,
        Driver::ByHand,
        &mut drive,
    );
    drop(connected);
    let kept = Folder::digests(folder.path())?.kept();
    write_made(FolderShelf::new(folder.path()), &kept, |shelf| {
        report::put_driven(&steps, None, shelf)
    })?;
    tell(&format!("  on record: {}\n", folder.path().display()));
    if let Some(fault) = &recorded.fault {
        tell(&format!(
            "  the record could not be kept to its end: {fault}\n"
        ));
    }
    let exit = hand.end(&recorded.record.outcome)?;
    Ok(if recorded.fault.is_some() {
        exit.max(Exit::Fault)
    } else {
        exit
    })
}

/// One sitting: who drives, and how it ended.
struct Hand<'a> {
    wanted: &'a Wanted,
    plan: &'a Plan,
    /// Who the rig says it is.
    identity: Identity,
    /// m/s
    own_speed: Option<f64>,
    person: Person<'a>,
    settings: Settings,
    ended: Option<Result<Exit, Failure>>,
}

impl Hand<'_> {
    fn drive(&mut self, specimen: &mut Specimen<'_, '_>) {
        let come = specimen
            .come(format!("{}, by hand", self.person.by))
            .map_err(Failure::Rig);
        let ended = come.and_then(|()| {
            if self.person.wish.lets_go() {
                specimen.remark(format!(
                    "what was found held was let go of where it stands ({})",
                    self.person.by
                ));
            }
            self.moves(specimen)
        });
        let (parting, reason) = match &ended {
            Ok(Exit::Met) => (Parting::Closed, "done".to_owned()),
            Ok(_) => (
                Parting::Stopped,
                "a limit or a person stood in the way".to_owned(),
            ),
            Err(failure) if failure.exit() == Exit::Stopped => {
                (Parting::Stopped, failure.to_string())
            }
            Err(failure) => (Parting::Failed, failure.to_string()),
        };
        specimen.leave(parting, reason);
        specimen.close();
        self.ended = Some(ended);
    }

    /// How it ended; where it did not begin, why the rig was not fit for it.
    fn end(self, outcome: &Outcome) -> Result<Exit, Failure> {
        self.ended.unwrap_or_else(|| {
            let (exit, reason) = match outcome {
                Outcome::Completed => (Exit::Met, ""),
                Outcome::Aborted { reason } | Outcome::NotReleased { reason } => {
                    (Exit::Stopped, reason.as_str())
                }
                Outcome::Blocked { reason } => (Exit::Missed, reason.as_str()),
                Outcome::Faulted { reason } => (Exit::Fault, reason.as_str()),
            };
            tell(&format!("  nothing moved: {reason}\n"));
            Ok(exit)
        })
    }

    fn moves(&mut self, specimen: &mut Specimen<'_, '_>) -> Result<Exit, Failure> {
        if let Some(to) = &self.wanted.to {
            return self.move_to(to, specimen);
        }
        let mut refused = false;
        loop {
            tell(&format!(
                "  at {}; where to? [a place such as 1 mm, or q] ",
                told(specimen.commanded())
            ));
            let Some(line) = self.person.line(specimen)? else {
                tell("\n");
                return Ok(if refused || self.person.wish.wants_end() {
                    Exit::Stopped
                } else {
                    Exit::Met
                });
            };
            match line.trim() {
                "" => {}
                "q" | "quit" => return Ok(if refused { Exit::Stopped } else { Exit::Met }),
                typed => match places(typed, specimen.degrees_of_freedom(), "the place") {
                    Ok(to) => refused |= self.move_to(&to, specimen)? != Exit::Met,
                    Err(failure) => tell(&failure.report(self.settings)),
                },
            }
            if self.person.wish.wants_end() {
                return Ok(Exit::Stopped);
            }
        }
    }

    /// What the move takes.
    fn motion(&self, to: &[f64], specimen: &Specimen<'_, '_>) -> Motion {
        let from = specimen.commanded();
        let (low, high) = from
            .iter()
            .chain(to)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
                (low.min(*place), high.max(*place))
            });
        let way = from
            .iter()
            .zip(to)
            .map(|(from, to)| (to - from).abs())
            .fold(0.0, f64::max);
        let speed = self.wanted.speed.or(self.own_speed).unwrap_or(OWN_SPEED);
        let expected = Extent {
            travel: Some(Interval { low, high }),
            force: None,
            speed: Some(speed),
            duration: Some(way / speed),
        };
        let does = format!("it moves from {} to {}", told(from), told(to));
        Motion {
            expected,
            ..Motion::of(self.plan, self.identity.clone(), does)
        }
    }

    /// One move, in increments where the plan limits them; Ctrl-C holds the rig on its way.
    fn move_to(&mut self, to: &[f64], specimen: &mut Specimen<'_, '_>) -> Result<Exit, Failure> {
        let speed = self.wanted.speed;
        let at = speed.map_or_else(String::new, |speed| {
            format!(" at {}", plain(speed, Dimension::VELOCITY, 4))
        });
        let question = format!(
            "move from {} to {}{at}?",
            told(specimen.commanded()),
            told(to)
        );
        // What no answer allows is not asked, and no part of the way is gone.
        if let Some(fault) = beyond(self.plan, to, speed) {
            specimen.remark(format!("{question} refused: {fault}"));
            tell(&format!("  refused: {fault}\n"));
            return Ok(Exit::Stopped);
        }
        let motion = self.motion(to, specimen);
        if !self.person.agrees(&question, &motion, specimen)? {
            specimen.hold();
            tell("  nothing moved\n");
            return Ok(Exit::Stopped);
        }
        for target in specimen.way_to(to) {
            if self.person.wish.wants_end() {
                specimen.hold();
                tell("  held\n");
                return Ok(Exit::Stopped);
            }
            if let Err(fault) = specimen
                .propose_at(&target, speed)
                .and_then(|()| specimen.execute())
            {
                return refused(fault);
            }
            specimen.commit();
        }
        let stopped = self.person.wish.wants_end();
        let felt = specimen.felt();
        let words = felt
            .displacement
            .iter()
            .zip(&felt.force)
            .map(|(displacement, force)| {
                format!(
                    "X {}   R {}\n",
                    readable(*displacement, Dimension::LENGTH),
                    readable(*force, Dimension::FORCE)
                )
            });
        give(&words.collect::<String>())?;
        if stopped {
            specimen.hold();
            tell("  stopped on request, at its end\n");
        }
        Ok(if stopped { Exit::Stopped } else { Exit::Met })
    }
}

/// The limit of its axis that a place or the speed lies beyond.
fn beyond(plan: &Plan, to: &[f64], speed: Option<f64>) -> Option<RigFault> {
    let found = to.iter().enumerate().flat_map(|(axis, place)| {
        let limits = plan.rig.limits_of(axis, &plan.limits);
        let place = Some((
            axis,
            LimitedQuantity::TargetDisplacement,
            limits.displacement,
            *place,
        ));
        [
            place,
            speed.map(|speed| (axis, LimitedQuantity::Speed, limits.speed, speed)),
        ]
    });
    let (axis, quantity, Interval { low, high }, value) = found
        .flatten()
        .find(|(_, _, limit, value)| !limit.contains(*value))?;
    let axis = (to.len() > 1).then_some(axis + 1);
    Some(RigFault::LimitBreached {
        quantity,
        value,
        low,
        high,
        axis,
    })
}

/// Nothing beyond a limit moves, and the person may name another place; whatever else it is ends the sitting.
fn refused(fault: RigFault) -> Result<Exit, Failure> {
    match fault {
        RigFault::LimitBreached { .. } => {
            tell(&format!("  held: {fault}\n"));
            Ok(Exit::Stopped)
        }
        fault => Err(Failure::Rig(fault)),
    }
}

/// Who says yes.
struct Person<'a> {
    typed: Option<Typed>,
    wish: &'a Wish,
    yes: bool,
    /// The name.
    by: String,
}

impl Person<'_> {
    /// None at the end of the input and on Ctrl-C. The rig stays where it is meanwhile, and is heard from.
    fn line(&mut self, specimen: &mut Specimen<'_, '_>) -> Result<Option<String>, Failure> {
        let typed = self.typed.get_or_insert_with(Typed::from_the_terminal);
        next_line(typed, self.wish, || specimen.listen()).map_err(Failure::Rig)
    }

    /// Only its word lets it move. Question and answer are on record.
    fn agrees(
        &mut self,
        question: &str,
        motion: &Motion,
        specimen: &mut Specimen<'_, '_>,
    ) -> Result<bool, Failure> {
        let (agreed, how) = if self.yes {
            (true, "answered by --yes")
        } else {
            let typed = self.typed.get_or_insert_with(Typed::from_the_terminal);
            let asked = Question::of(Kind::Jog, motion);
            let yes =
                agrees(typed, &asked, self.wish, || specimen.listen()).map_err(Failure::Rig)?;
            (yes, if yes { "yes" } else { "no" })
        };
        specimen.remark(format!("{question} {how} ({})", self.by));
        Ok(agreed)
    }
}

/// Places of all axes.
fn told(places: &[f64]) -> String {
    places
        .iter()
        .map(|place| plain(*place, Dimension::LENGTH, 6))
        .collect::<Vec<_>>()
        .join(", ")
}
