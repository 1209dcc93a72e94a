//! `psd run`: check → run → verdict → files. Nothing moves while the plan has an error, and nothing moves before the record
//! is open.

use super::rehearse::rehearse;
use crate::cli::args::{Format, RunArguments};
use crate::cli::exit::{Exit, Failure};
use crate::cli::files::accepted::BlessedFolder;
use crate::cli::files::finish_run::{finish_run, summary};
use crate::cli::files::golden_run;
use crate::cli::files::golden_run::Extent;
use crate::cli::files::record_file;
use crate::cli::files::record_file::Circumstances;
use crate::cli::files::run_folder::RunFolder;
use crate::cli::files::{plan_file, provenance};
use crate::cli::operator::watch::{Attendance, Signals, Watcher};
use crate::cli::operator::{expected, held, real_rig};
use crate::cli::output::{print_message, print_result};
use crate::cli::settings::Settings;
use crate::golden::{Outcome, Tested, console};
use crate::plan::{Link, Plan};
use crate::report::Provenance;
use crate::rig::{StopRequest, virtual_rig};
use crate::run::replay;
use crate::run::replay::Recorded;
use crate::text::diagnostic::json;

/// Runs one plan.
pub fn run(arguments: &RunArguments, settings: Settings) -> Result<Exit, Failure> {
    let attendance = Attendance {
        yes: arguments.yes,
        operator: arguments.operator.clone(),
    };
    let unattended = real_rig::unattended(&attendance, settings);
    let checked = plan_file::open_to_run(&arguments.plan, &arguments.plan_settings, unattended)?;
    plan_file::show(&checked, &arguments.plan, settings);
    let Some(plan) = &checked.plan else {
        if arguments.format == Format::Json {
            print_result(&json::text(&plan_file::diagnostics(
                &checked,
                &arguments.plan,
            )))?;
        }
        return Ok(Exit::Wrong);
    };
    if plan.procedures.is_empty() {
        return Err(Failure::command_line(
            "the plan has no procedure: nothing would run, and nothing be shown",
        )
        .help("declarations that other plans `use` are checked with `psd check`"));
    }
    let attendance = real_rig::named(attendance, plan)?;
    let in_the_plan = |failure: Failure| {
        failure.in_the_plan(|fault| plan_file::place_of_link(&checked, &arguments.plan, fault))
    };
    if arguments.rehearse {
        return rehearse(plan, arguments, &attendance, settings).map_err(in_the_plan);
    }
    let blessed = arguments
        .bless
        .then(|| BlessedFolder::of(&arguments.plan))
        .transpose()?;
    if blessed.is_some() && !golden_run::is_as_written(plan, &arguments.plan_settings) {
        return Err(Failure::command_line(
            "`--bless` is of the plan as it is written, on its virtual rig",
        )
        .help("leave out `--set`, `--rig` and `--date`, or write them into the plan"));
    }
    let ran = on_its_rig(plan, arguments, &attendance, settings).map_err(in_the_plan)?;
    if let Some(exit) = ran.goes_on(plan, &attendance, settings)? {
        return Ok(exit);
    }
    let Ran {
        folder,
        provenance,
        recorded,
        ..
    } = ran;
    let exit = finish_run(folder.path(), plan, &provenance, &recorded, settings)?;
    if let Some(blessed) = blessed {
        let trial = golden_run::of(&arguments.plan, Extent::All)?;
        if trial.ended.as_ref() == Some(&recorded.record.outcome) {
            let outcome =
                Outcome::Blessed(blessed.bless(&trial.files, &trial.tolerances, false, false)?);
            print_message(&console::told(
                &Tested {
                    name: blessed.path().display().to_string(),
                    outcome,
                },
                settings.color,
            ));
        } else {
            print_message(
                "  not blessed: the run was stopped, and the plan as it is written goes on\n",
            );
        }
    }
    match arguments.format {
        Format::Human => print_result(&format!("{}\n", folder.path().display()))?,
        Format::Json => print_result(&summary(folder.path(), &recorded.record)?)?,
    }
    Ok(exit)
}

/// A run that has ended, complete or not.
pub(crate) struct Ran {
    pub(crate) folder: RunFolder,
    pub(crate) provenance: Provenance,
    pub(crate) recorded: Recorded,
    /// The reason of the operator to resume the run from hold.
    pub(crate) resume: Option<String>,
}

impl Ran {
    /// Resumes a run on hold where the operator asks for it; None where it ends here.
    pub(crate) fn goes_on(
        &self,
        plan: &Plan,
        attendance: &Attendance,
        settings: Settings,
    ) -> Result<Option<Exit>, Failure> {
        let Some(reason) = self.resume.clone() else {
            return Ok(None);
        };
        let operator = real_rig::operator(plan, attendance).unwrap_or_default();
        held::go_on(
            self.folder.path(),
            &operator,
            reason,
            &self.recorded,
            settings,
        )
    }
}

/// Runs the plan on its rig, and keeps the record.
pub(crate) fn on_its_rig(
    plan: &Plan,
    arguments: &RunArguments,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Ran, Failure> {
    match plan.rig.link {
        Link::Virtual(_) => on_a_virtual_rig(plan, arguments, attendance, settings),
        Link::Real(_) => on_a_real_rig(plan, arguments, attendance, settings),
    }
}

/// A run on a virtual rig: no data of the machine are read, and no time passes.
fn on_a_virtual_rig(
    plan: &Plan,
    arguments: &RunArguments,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Ran, Failure> {
    let signals = Signals::caught(&StopRequest::default()).map_err(Failure::Signals)?;
    let mut watcher = Watcher::new(settings, attendance, plan, true, signals);
    let folder = RunFolder::create(arguments.out.as_deref(), &arguments.plan)?;
    let provenance = provenance::of(plan, arguments.plan_settings.date.as_deref());
    let mut rig = virtual_rig(plan);
    let device = record_file::device(rig.as_ref());
    let header = record_file::header(
        plan,
        device,
        &arguments.plan_settings,
        &provenance,
        Circumstances::default(),
    );
    let provenance = Provenance {
        equipment: header.equipment.clone(),
        ..provenance
    };
    let journal = record_file::begin(folder.path(), plan, &header)?;
    let recorded = replay::record(plan, rig.as_mut(), &mut watcher, journal, Box::new(|| None));
    watcher.finish();
    Ok(Ran {
        folder,
        provenance,
        recorded,
        resume: None,
    })
}

/// A run on a real rig. The rig is identified before the folder is created: a rig that does not answer leaves no folder.
fn on_a_real_rig(
    plan: &Plan,
    arguments: &RunArguments,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Ran, Failure> {
    let (expected, _) = expected::of(plan);
    let mut opened = real_rig::open(plan, attendance, &StopRequest::default(), settings)?;
    opened.watcher.expect(expected);
    let folder = RunFolder::create(arguments.out.as_deref(), &arguments.plan)?;
    let circumstances = real_rig::circumstances(plan, attendance);
    print_message(&provenance::told_of_another_day(
        plan,
        circumstances.began.as_deref(),
    ));
    let provenance = provenance::of_real_run(
        plan,
        arguments.plan_settings.date.as_deref(),
        &circumstances,
    );
    let device = record_file::device(&opened.connected.rig);
    let header = record_file::header(
        plan,
        device,
        &arguments.plan_settings,
        &provenance,
        circumstances,
    );
    let provenance = Provenance {
        equipment: header.equipment.clone(),
        ..provenance
    };
    let journal = record_file::begin(folder.path(), plan, &header)?;
    let wall = real_rig::wall_clock();
    let recorded = replay::record(
        plan,
        &mut opened.connected.rig,
        &mut opened.watcher,
        journal,
        wall,
    );
    let resume = held::stay(
        &mut opened.connected.rig,
        &mut opened.watcher,
        &recorded.record,
    );
    opened.watcher.finish();
    Ok(Ran {
        folder,
        provenance,
        recorded,
        resume,
    })
}
