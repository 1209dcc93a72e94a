//! `psd resume RUN`: resumes a run on a real rig. In: the folder of a run that was stopped or interrupted, and the operator who is
//! responsible. Out: the same run, complete. The run log is replayed before a port is opened. Nothing moves until run log, plan, program
//! and rig are confirmed as those of the run. The rig must also have reported whether it reached the last target.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use clap::Args;

use super::recorded_folder::{changed_files, put_results_aside};
use crate::args::{ScreenForm, name, reason};
use crate::evidence::MANIFEST;
use crate::exit::{Exit, Failure};
use crate::files::finish_run::finish_run;
use crate::files::provenance::{BUILD, TOOLCHAIN};
use crate::files::record_file;
use crate::files::record_file::{ReadRecord, journal_of};
use crate::files::{plan_file, provenance};
use crate::operator::watch::{Attendance, Signals, Watcher};
use crate::operator::{confirm_release, expected, held, real_rig};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::report::Provenance;
use psd::run::Shared;
use psd::run::replay;
use psd::run::replay::{
    AmendBody, Assurance, Bands, Continuation, Header, LoggedRun, Recorded, RecoverBody,
    ResumeBody, RigBody,
};
use psd_plan::Plan;
use psd_plan::record::equipment::Equipment;
use psd_rig::journal::{Durability, EntryKind, FileStorage, Journal};
use psd_rig::real::RealRig;
use psd_rig::{Rig as _, StopRequest, connect};

#[derive(Clone, Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own")]
#[command(
    after_help = "A REAL RIG MOVES after its release. Before that, psd checks that run log, plan, program and rig belong to the run, and reads the \
    state of the last target from the rig. See docs/how-to/resume.md.\n\n\
    Exit codes:\n\
    \x20 as for `psd run`; 3 also if the run must not continue"
)]
pub struct ResumeArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Person authorising the resumption (logged) [default: asked]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
    /// Why it stopped, and why it may continue (logged) [default: asked]
    #[arg(long, value_name = "TEXT", value_parser = reason)]
    pub reason: Option<String>,
    /// Plan to compare, or with --amend to use instead
    #[arg(long, value_name = "PLAN")]
    pub plan: Option<PathBuf>,
    /// Accept a different plan or program (logged)
    #[arg(long)]
    pub amend: bool,
    /// Confirm that the restarted rig was referenced (logged)
    #[arg(long)]
    pub re_referenced: bool,
    /// Confirm that the rig was not power-cycled (logged)
    #[arg(long)]
    pub same_power_up: bool,
    /// Clear the hold of an axis without moving it (logged)
    #[arg(long)]
    pub let_go: bool,
    /// Confirm a force change after inspecting the specimen (logged)
    #[arg(long)]
    pub accept_relaxation: bool,
    /// Confirm that the rig may move faster than before (logged)
    #[arg(long)]
    pub accept_speed: bool,
    /// Answer every prompt with yes, including the motion release
    #[arg(long)]
    pub yes: bool,
    /// Progress of the run [default: full on a terminal, else plain]
    #[arg(long, value_enum, value_name = "FORM")]
    pub screen: Option<ScreenForm>,
}

impl ResumeArguments {
    /// The same with the operator and the reason, which are asked for at the terminal if the command line has none.
    fn complete(&self, settings: Settings) -> Result<Self, Failure> {
        let answer = |given: &Option<String>, flag: &str, question: &str, read| {
            let asked = || settings.can_ask.then(|| real_rig::asked(question, read))?;
            let missing = || {
                Failure::command_line(format!("`--{flag}` is missing: nothing was opened"))
                    .help("resume with --operator \"your name\" --reason \"why it stopped, and why it may continue\"")
            };
            given.clone().or_else(asked).ok_or_else(missing)
        };
        let operator = answer(&self.operator, "operator", "name of the operator?", name)?;
        let reason = answer(
            &self.reason,
            "reason",
            "why did it stop, and why may it continue?",
            reason,
        )?;
        Ok(Self {
            operator: Some(operator),
            reason: Some(reason),
            ..self.clone()
        })
    }

    fn operator(&self) -> &str {
        self.operator.as_deref().unwrap_or_default()
    }

    fn reason(&self) -> &str {
        self.reason.as_deref().unwrap_or_default()
    }
}

/// Resumes one run.
pub fn resume(arguments: &ResumeArguments, settings: Settings) -> Result<Exit, Failure> {
    let path = journal_of(&arguments.run);
    if !path.exists() {
        return Err(Failure::file(
            &arguments.run,
            "is not a run folder: it has no run log",
        ));
    }
    let arguments = &arguments.complete(settings)?;
    let mut storage = FileStorage::open_existing(&path)?;
    let read = record_file::of_text(&path, &storage.text()?)?;
    if read.logged.ended {
        let run = arguments.run.display();
        let failure = Failure::file(&arguments.run, replay::ResumeRefusal::Ended.to_string());
        // The manifest is written last.
        return Err(if arguments.run.join(MANIFEST).exists() {
            failure
        } else {
            failure.help(format!(
                "its results are incomplete: `psd report {run}` creates them from the run log"
            ))
        });
    }
    if read.logged.header.served.as_deref() == Some(replay::BY_HAND) {
        return Err(Failure::command_line(
            "the rig was driven by hand: there is nothing to resume",
        )
        .help("`psd rig jog` starts at the present position of the rig"));
    }
    if read.logged.header.served.is_some() {
        return Err(
            Failure::command_line("a client drove this run: psd cannot continue it")
                .help("start a new run with `psd rig serve`"),
        );
    }
    if read.plan.rig.link.as_real().is_none() {
        return Err(Failure::command_line(
            "a run on a virtual rig moved nothing: there is nothing to resume",
        )
        .help("start a new run with `psd run`"));
    }
    let (plan, provenance, amendment) = what_holds(arguments, &read)?;

    replay::same_measure(&read.plan.rig, &plan.rig)?;
    replay::not_restarted(&read.logged, &assured(arguments))?;
    record_file::check_disk_space(&arguments.run, &storage)?;

    let steps = read
        .logged
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Step)
        .count() as u64;
    let whole = expected::expectation(&plan);
    let before = expected::expectation(&read.plan).extent.speed;
    let planned_speed = ("highest speed in the plan", before, whole.extent.speed);
    let expected = expected::rest(whole.extent, whole.steps, steps);
    let attendance = Attendance {
        yes: arguments.yes,
        operator: arguments.operator.clone(),
        screen: arguments.screen,
    };
    let stop_request = StopRequest::default().with_release_allowed(arguments.let_go);
    // The zero is that of the start of the run; the present position of the rig does not change it.
    let first = read.logged.rigs.first();
    let datum = first.and_then(|rig| rig.datum.as_deref());
    let at_its_datum = plan.rig.with_recorded_datum(datum);
    let signals = Signals::caught(&stop_request).map_err(Failure::Signals)?;
    let simulated = read
        .logged
        .rigs
        .last()
        .is_some_and(|last| last.rig.identity.simulated);
    let watcher = RefCell::new(Watcher::new(
        settings,
        &attendance,
        &plan,
        simulated,
        signals,
        true,
    ));
    watcher.borrow_mut().pace(whole.parts());
    watcher.borrow_mut().predict(whole.procedures);
    let (mut connected, mut torn) = (None, None);
    let (opened, put_aside) = (&mut connected, &mut torn);
    let begin = || {
        if stop_request.end_requested() {
            return Err(Failure::NotReleased {
                reason: "stopped on request".to_owned(),
            });
        }
        let rig = &mut opened
            .insert(connect(&at_its_datum, &plan.limits, &stop_request)?)
            .rig;
        watcher.borrow_mut().watch(rig.live());
        watcher.borrow_mut().resumed();
        watcher.borrow_mut().expect(expected);
        let resumption = settle(
            arguments,
            &plan,
            planned_speed,
            &read.logged,
            rig,
            &mut watcher.borrow_mut(),
        )?;

        // The run resumes here: until now the run log has not changed.
        *put_aside = storage.truncate_to(read.recovered.whole)?;
        let mut journal = Journal::reopen(
            Box::new(storage),
            Durability::EverySyncPoint,
            &read.recovered,
        );
        let mut logged = read.logged.clone();
        if let Some(torn) = put_aside {
            let name = torn
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            journal.append(
                EntryKind::Recover,
                &RecoverBody {
                    t: logged.time,
                    put_aside: name,
                },
            )?;
            logged.recovered();
        }
        if let Some((amendment, texts)) = amendment {
            replay::amend(&mut journal, &amendment, &texts)?;
            logged.amended(amendment);
        }
        let answered = RigBody {
            t: logged.time,
            ..RigBody::of(rig)
        };
        journal.append(EntryKind::Rig, &answered)?;
        logged.answered(answered);
        journal.append(EntryKind::Resume, &resumption)?;
        journal.sync()?;
        logged.resumed(resumption);
        put_results_aside(&arguments.run)?;
        Ok(Continuation {
            rig,
            journal,
            logged,
        })
    };
    let recorded = replay::resume(
        &plan,
        &read.logged,
        &mut Shared(&watcher),
        real_rig::wall_clock(),
        begin,
    );
    let mut watcher = watcher.into_inner();
    let wanted = match (&recorded, &mut connected) {
        (Ok(recorded), Some(connected)) => {
            held::stay(&mut connected.rig, &mut watcher, &recorded.record)
        }
        _ => None,
    };
    watcher.finish();
    // psd does not communicate with the rig while it writes the results: the rig keeps its state.
    drop((connected, watcher));
    let recorded = recorded?;
    if let Some(torn) = torn {
        print_message(&format!(
            "  an incomplete last entry was moved aside: {}\n",
            torn.display()
        ));
    }
    if let Some(reason) = wanted
        && let Some(exit) = go_on(
            &arguments.run,
            arguments.operator(),
            reason,
            &recorded,
            settings,
        )?
    {
        return Ok(exit);
    }
    let exit = finish_run(&arguments.run, &plan, &provenance, &recorded, settings)?;
    print_result(&format!("{}\n", arguments.run.display()))?;
    Ok(exit)
}

/// A plan with its provenance, and the amendment that is required if plan or program differ from those of the run log.
type Continued = (Plan, Provenance, Option<(AmendBody, Vec<String>)>);

/// The plan and the program that apply from here on.
fn what_holds(arguments: &ResumeArguments, read: &ReadRecord) -> Result<Continued, Failure> {
    let recorded = &read.logged.header;
    let mut differences = Vec::new();
    if recorded.build != BUILD {
        differences.push(format!(
            "program: {} build {} became {} build {BUILD}",
            recorded.psd,
            recorded.build,
            env!("CARGO_PKG_VERSION")
        ));
    }
    let was = &recorded.equipment;
    let (mut plan, mut header, mut texts) = (
        read.plan.clone(),
        recorded.clone(),
        read.logged.texts.clone(),
    );
    if let Some(path) = &arguments.plan {
        let options = real_rig::settings_of(recorded);
        let checked = plan_file::open(path, &options)?;
        let Some(given) = checked.plan else {
            return Err(Failure::command_line(format!(
                "{} has errors: see `psd check`",
                path.display()
            )));
        };
        let none_known = record_file::Circumstances::default();
        let now = record_file::header(
            &given,
            was.device.clone(),
            &options,
            &provenance::of_this_run(&given, options.date.as_deref()),
            none_known,
        );
        differences.extend(changed_files(recorded, &now));
        header = Header {
            files: now.files,
            ..header
        };
        texts = record_file::texts(&given);
        plan = given;
    }
    let now = Equipment::of(&plan, was.device.clone());
    if let Some(what) = was.measures_otherwise(&now) {
        return Err(replay::ResumeRefusal::OtherMeasure { what }.into());
    }
    differences.extend(was.changes(&now));
    header.equipment = now;
    if differences.is_empty() {
        return Ok((plan, read.provenance.clone(), None));
    }
    if !arguments.amend {
        let listed = differences.join("\n  ");
        return Err(Failure::command_line(format!(
            "differs from the start of the run:\n  {listed}"
        ))
        .help("`--amend` accepts it; name and reason are logged and appear in the test report"));
    }
    header = Header {
        psd: env!("CARGO_PKG_VERSION").to_owned(),
        build: BUILD.to_owned(),
        toolchain: TOOLCHAIN.to_owned(),
        ..header
    };
    let plan_sha256 = header
        .files
        .first()
        .map_or_else(String::new, |file| file.sha256.clone());
    let (equipment, build) = (Some(header.equipment.clone()), provenance::this_build());
    let provenance = Provenance {
        plan_sha256,
        psd_version: header.psd.clone(),
        build,
        equipment,
        ..read.provenance.clone()
    };
    let (by, reason) = (
        arguments.operator().to_owned(),
        arguments.reason().to_owned(),
    );
    Ok((
        plan,
        provenance,
        Some((
            AmendBody {
                by,
                reason,
                differences,
                header,
            },
            texts,
        )),
    ))
}

/// A speed that the plan determines, before and now \[m/s\].
type Speeds = (&'static str, Option<f64>, Option<f64>);

/// Reads from the rig, without a move, whether it reached the last target. Then asks the operator whether it may move.
fn settle(
    arguments: &ResumeArguments,
    plan: &Plan,
    planned_speed: Speeds,
    logged: &LoggedRun,
    rig: &mut RealRig,
    watcher: &mut Watcher,
) -> Result<ResumeBody, Failure> {
    let (Some(last), Some(link)) = (logged.rigs.last(), plan.rig.link.as_real()) else {
        return Err(replay::ResumeRefusal::NothingRecorded.into());
    };
    let (recorded, assured) = (&last.rig, assured(arguments));
    replay::same_rig(&recorded.identity, &rig.identity(), &assured)?;
    replay::same_resolution(recorded.noise, rig.declared_noise())?;
    let limit = Some(last.speed_limit.high);
    let speeds = [
        ("own speed", recorded.own_speed, rig.own_speed()),
        ("limit of speed", limit, Some(plan.limits.speed.high)),
        planned_speed,
    ];
    replay::no_faster(&speeds, &assured)?;
    let found = rig.read()?;
    let bands = Bands::of(&plan.rig, link);
    let decision = replay::decide(
        logged,
        &RigBody::of(rig),
        &found,
        &bands,
        arguments.accept_relaxation,
    )?;
    let released = confirm_release::ask(plan, &assured, &found, &decision, rig, watcher)?;
    let resumption = decision.resumption(
        arguments.operator(),
        arguments.reason(),
        &found,
        logged.time,
    );
    let released = Some(released);
    Ok(ResumeBody {
        assured,
        released,
        wall: real_rig::wall_clock()(),
        ..resumption
    })
}

/// The statements for which the operator who resumes the run is responsible.
fn assured(arguments: &ResumeArguments) -> Vec<Assurance> {
    let assurances = [
        (arguments.same_power_up, Assurance::SamePowerUp),
        (arguments.re_referenced, Assurance::ReReferenced),
        (arguments.accept_relaxation, Assurance::AcceptedRelaxation),
        (arguments.let_go, Assurance::LetGo),
        (arguments.accept_speed, Assurance::AcceptedSpeed),
    ];
    assurances
        .into_iter()
        .filter(|(is_given, _)| *is_given)
        .map(|(_, assured)| assured)
        .collect()
}

/// Resumes the run as `psd resume` does, for the operator who observed the rig without a break. None: the operator refused, and the run
/// log is unchanged.
pub fn go_on(
    folder: &Path,
    operator: &str,
    reason: String,
    recorded: &Recorded,
    settings: Settings,
) -> Result<Option<Exit>, Failure> {
    let arguments = ResumeArguments {
        run: folder.to_owned(),
        operator: Some(operator.to_owned()),
        reason: Some(reason),
        plan: None,
        amend: false,
        re_referenced: false,
        same_power_up: true,
        let_go: true,
        accept_relaxation: false,
        accept_speed: false,
        yes: false,
        screen: None,
    };
    match resume(&arguments, settings) {
        Ok(exit) => Ok(Some(exit)),
        Err(failure) => {
            let head = record_file::read(folder).map(|read| read.recovered.head().to_owned());
            let unchanged = recorded
                .sealed
                .as_ref()
                .is_some_and(|(_, sealed)| head.is_ok_and(|head| head == *sealed));
            if !unchanged {
                return Err(failure);
            }
            print_message(&failure.report(settings));
            Ok(None)
        }
    }
}
