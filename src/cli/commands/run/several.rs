//! Several plans in one `psd run`: one after the other, or with `--jobs` each in a process of its own. In: plans. Out: their run folders,
//! a table of their outcomes, and the worst exit code. After a stop by the operator, or by anything on a real rig, no other plan begins.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use rayon::prelude::*;
use serde_json::Value;

use super::{Done, Job, RunArguments, run_one};
use crate::args::RunLog;
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::operator::watch::Signals;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::report::SUMMARY;
use psd_rig::StopRequest;
use psd_text::columns::columns;
use psd_text::diagnostic::excerpt::one_line;

/// Runs `plans`, and prints their outcomes.
pub fn run(
    plans: &[PathBuf],
    arguments: &RunArguments,
    stop_request: &StopRequest,
    settings: Settings,
) -> Result<Exit, Failure> {
    if arguments.out.is_some() {
        return Err(Failure::command_line(
            "`--out` is one run folder, and several plans are named",
        )
        .help("run them one by one, or remove `--out`: each gets its folder in `runs`"));
    }
    let outcomes = match arguments.jobs {
        Some(jobs) if jobs.get() > 1 => in_parallel(plans, arguments, jobs.get(), stop_request)?,
        _ => one_by_one(plans, arguments, stop_request, settings),
    };
    print_message(&table(plans, &outcomes));
    let exits = outcomes.iter().flatten().map(|done| done.exit);
    Ok(exits.max().unwrap_or(Exit::Met))
}

/// The outcome of each plan; None: it did not begin.
fn one_by_one(
    plans: &[PathBuf],
    arguments: &RunArguments,
    stop_request: &StopRequest,
    settings: Settings,
) -> Vec<Option<Done>> {
    let mut outcomes = Vec::new();
    for path in plans {
        print_message(&format!(
            "{}\n",
            settings.paint_note(&one_line(&path.display().to_string()))
        ));
        let job = Job {
            path,
            arguments,
            stop_request,
        };
        let done = run_one(&job, settings).unwrap_or_else(|failure| {
            print_message(&failure.report(settings));
            failure.exit().into()
        });
        let real = arguments.plan_settings.rig.is_some() && done.exit > Exit::Missed;
        outcomes.push(Some(done));
        if real || stop_request.end_requested() {
            break;
        }
    }
    outcomes.resize_with(plans.len(), || None);
    outcomes
}

/// The same, `jobs` at a time. Each is a `psd run` of its own, whose output is printed when it has ended.
fn in_parallel(
    plans: &[PathBuf],
    arguments: &RunArguments,
    jobs: usize,
    stop_request: &StopRequest,
) -> Result<Vec<Option<Done>>, Failure> {
    let program = std::env::current_exe().map_err(|error| Failure::file("psd", plain(&error)))?;
    // The terminal sends Ctrl-C to the processes too: each ends its run, and no other begins.
    let _signals = Signals::caught(stop_request).map_err(Failure::Signals)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|error| Failure::command_line(format!("no threads to run plans on: {error}")))?;
    let one = |path: &PathBuf| {
        if stop_request.end_requested() {
            return Ok(None);
        }
        let ended = Command::new(&program)
            .arg("run")
            .args(options(arguments))
            .arg("--")
            .arg(path)
            .stdin(Stdio::inherit())
            .output()
            .map_err(|error| Failure::file(path, plain(&error)))?;
        printed(path, &ended).map(Some)
    };
    // A plan whose output is awaited does not delay the next one.
    pool.install(|| plans.par_iter().with_max_len(1).map(one).collect())
}

/// The options of the command line, for a process that runs one plan.
fn options(arguments: &RunArguments) -> Vec<String> {
    let mut options = vec!["--color=never".to_owned()];
    let settings = &arguments.plan_settings;
    let set = settings.set.iter();
    options.extend(set.map(|(name, value)| format!("--set={name}={value}")));
    options.extend(settings.date.iter().map(|date| format!("--date={date}")));
    let operator = arguments.operator.iter();
    options.extend(operator.map(|name| format!("--operator={name}")));
    options.extend(arguments.log.map(|log| match log {
        RunLog::Compact => "--log=compact".to_owned(),
        RunLog::Full => "--log=full".to_owned(),
    }));
    let flags = [
        (arguments.yes, "--yes"),
        (arguments.accept, "--accept"),
        (arguments.check_run, "--check-run"),
    ];
    let flags = flags.into_iter().filter(|(given, _)| *given);
    options.extend(flags.map(|(_, flag)| flag.to_owned()));
    options
}

/// Prints the output of a process, and reads its outcome.
fn printed(path: &Path, ended: &Output) -> Result<Done, Failure> {
    let (result, messages) = (
        String::from_utf8_lossy(&ended.stdout),
        String::from_utf8_lossy(&ended.stderr),
    );
    print_message(&format!(
        "{}\n{messages}",
        one_line(&path.display().to_string())
    ));
    print_result(&result)?;
    let code = ended.status.code();
    let known = code.and_then(|code| Exit::all().find(|exit| i32::from(exit.code()) == code));
    Ok(Done {
        exit: known.unwrap_or(Exit::Fault),
        folder: result.lines().last().map(PathBuf::from),
    })
}

/// One row per plan: its outcome, its path, its run folder.
fn table(plans: &[PathBuf], outcomes: &[Option<Done>]) -> String {
    let row = |(path, done): (&PathBuf, &Option<Done>)| {
        let folder = done.as_ref().and_then(|done| done.folder.as_ref());
        vec![
            done.as_ref().map_or("not run".to_owned(), outcome),
            one_line(&path.display().to_string()),
            folder.map_or_else(String::new, |folder| {
                one_line(&folder.display().to_string())
            }),
        ]
    };
    let rows: Vec<Vec<String>> = plans.iter().zip(outcomes).map(row).collect();
    let met = outcomes.iter().flatten();
    let met = met.filter(|done| done.exit == Exit::Met).count();
    format!(
        "\n{}{met} of {} plans meet all requirements\n",
        columns(&rows),
        plans.len()
    )
}

/// The verdict of the summary; without one, the meaning of the exit code.
fn outcome(done: &Done) -> String {
    let summary = done.folder.as_ref().and_then(|folder| {
        let text = std::fs::read_to_string(folder.join(SUMMARY)).ok()?;
        let summary: Value = serde_json::from_str(&text).ok()?;
        Some(summary["verdict"].as_str()?.to_uppercase())
    });
    summary.unwrap_or_else(|| {
        match done.exit {
            Exit::Met | Exit::Missed | Exit::Differs | Exit::Unfinished => "ended",
            Exit::Wrong => "not run: error in the plan",
            Exit::Fault => "failed",
            Exit::Stopped => "stopped",
        }
        .to_owned()
    })
}
