//! A run on the rig that the plan names, with its run log. In: a checked plan. Out: the recorded run.

use super::Job;
use super::resume;
use crate::args::{Format, RunLog};
use crate::exit::{Exit, Failure};
use crate::files::finish_run::{finish_run, summary};
use crate::files::provenance;
use crate::files::record_file;
use crate::files::run_folder::RunFolder;
use crate::operator::watch::{Attendance, Signals, Watcher};
use crate::operator::{expected, held, real_rig};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::report::Provenance;
use psd::run::replay;
use psd::run::replay::{Header, LogForm, Recorded};
use psd_plan::{Link, Plan};
use psd_rig::virtual_rig;

/// A run that has ended, with any outcome.
pub(crate) struct Ran {
    pub(crate) folder: RunFolder,
    pub(crate) provenance: Provenance,
    pub(crate) recorded: Recorded,
    /// The operator's reason to resume the held run.
    pub(crate) resume: Option<String>,
}

/// The end of a run.
pub(crate) enum End {
    /// The operator resumed the held run, which has ended with this exit.
    Resumed(Exit),
    /// The results are in the run folder.
    Finished(Box<Finished>),
}

/// A run with its results.
pub(crate) struct Finished {
    pub(crate) folder: RunFolder,
    pub(crate) recorded: Recorded,
    pub(crate) exit: Exit,
}

impl Ran {
    /// Resumes a held run if the operator wants it; else prints the verdict and writes the results.
    pub(crate) fn finish(
        self,
        plan: &Plan,
        attendance: &Attendance,
        settings: Settings,
    ) -> Result<End, Failure> {
        if let Some(exit) = self.goes_on(plan, attendance, settings)? {
            return Ok(End::Resumed(exit));
        }
        let Self {
            folder,
            provenance,
            recorded,
            ..
        } = self;
        let exit = finish_run(folder.path(), plan, &provenance, &recorded, settings)?;
        Ok(End::Finished(Box::new(Finished {
            folder,
            recorded,
            exit,
        })))
    }

    /// Resumes a held run if the operator wants it; None: the run ends here.
    fn goes_on(
        &self,
        plan: &Plan,
        attendance: &Attendance,
        settings: Settings,
    ) -> Result<Option<Exit>, Failure> {
        let Some(reason) = self.resume.clone() else {
            return Ok(None);
        };
        let operator = attendance.operator_of(plan).unwrap_or_default();
        resume::go_on(
            self.folder.path(),
            &operator,
            reason,
            &self.recorded,
            settings,
        )
    }
}

impl Finished {
    /// Prints the result of the command: the run folder, or its summary.
    pub(crate) fn print(&self, format: Format) -> Result<(), Failure> {
        let folder = self.folder.path();
        match format {
            Format::Human => print_result(&format!("{}\n", folder.display()))?,
            Format::Json => print_result(&summary(folder, &self.recorded.record)?)?,
        }
        Ok(())
    }
}

/// Runs the plan on the rig that it names, and keeps the run log.
pub(crate) fn on_its_rig(
    plan: &Plan,
    job: &Job<'_>,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Ran, Failure> {
    match plan.rig.link {
        Link::Virtual(_) => on_a_virtual_rig(plan, job, attendance, settings),
        Link::Real(_) if job.arguments.log == Some(RunLog::Compact) => Err(Failure::command_line(
            "the run log of a real rig is always full: no reading can be made again",
        )
        .help("remove `--log compact`")),
        Link::Real(_) => on_a_real_rig(plan, job, attendance, settings),
    }
}

/// The clock is read once, for the date of the run. Nothing else of the machine is read, and no real time passes.
fn on_a_virtual_rig(
    plan: &Plan,
    job: &Job<'_>,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Ran, Failure> {
    let signals = Signals::caught(job.stop_request).map_err(Failure::Signals)?;
    let mut watcher = Watcher::new(settings, attendance, plan, true, signals, true);
    watcher.pace(expected::parts_by_steps(plan));
    let folder = RunFolder::create(job.arguments.out.as_deref(), job.path)?;
    let circumstances = real_rig::start_alone();
    let provenance = provenance::of_simulated_run(
        plan,
        job.arguments.plan_settings.date.as_deref(),
        circumstances.began.as_deref(),
    );
    let mut rig = virtual_rig(plan);
    let device = record_file::device(rig.as_ref());
    let header = record_file::header(
        plan,
        device,
        &job.arguments.plan_settings,
        &provenance,
        circumstances,
    );
    let log = match job.arguments.log {
        Some(RunLog::Full) => LogForm::Full,
        Some(RunLog::Compact) | None => LogForm::Compact,
    };
    let header = Header { log, ..header };
    let provenance = Provenance {
        equipment: Some(header.equipment.clone()),
        ..provenance
    };
    let journal = record_file::begin(folder.path(), plan, &header)?;
    let recorded = match log {
        LogForm::Full => {
            replay::record(plan, rig.as_mut(), &mut watcher, journal, Box::new(|| None))
        }
        LogForm::Compact => replay::record_compactly(plan, rig.as_mut(), &mut watcher, journal),
    };
    watcher.finish();
    Ok(Ran {
        folder,
        provenance,
        recorded,
        resume: None,
    })
}

/// The rig identifies itself before the folder is created. A rig that does not answer leaves no folder.
fn on_a_real_rig(
    plan: &Plan,
    job: &Job<'_>,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Ran, Failure> {
    let expected = expected::expectation(plan);
    let mut opened = real_rig::open(plan, attendance, job.stop_request, settings, true)?;
    opened.watcher.expect(expected.extent);
    opened.watcher.pace(expected.parts());
    expected::within_reach(plan, expected.extent, &opened.connected.rig)?;
    opened.watcher.predict(expected.procedures);
    let folder = RunFolder::create(job.arguments.out.as_deref(), job.path)?;
    let circumstances = real_rig::circumstances(plan, attendance);
    print_message(&provenance::reported_another_day(
        plan,
        circumstances.began.as_deref(),
    ));
    let provenance = provenance::of_real_run(
        plan,
        job.arguments.plan_settings.date.as_deref(),
        &circumstances,
    );
    let device = record_file::device(&opened.connected.rig);
    let header = record_file::header(
        plan,
        device,
        &job.arguments.plan_settings,
        &provenance,
        circumstances,
    );
    let provenance = Provenance {
        equipment: Some(header.equipment.clone()),
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
