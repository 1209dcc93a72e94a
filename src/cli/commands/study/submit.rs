//! `psd study submit --slurm`: the scripts of a job array. In: a plan, a number of shards. Out: the scripts on standard output, or two
//! submitted jobs. The plan is checked here, so that no array fails on its error.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::{failure, open};
use crate::cli::args::SubmitArguments;
use crate::cli::exit::{Exit, Failure};
use crate::cli::output::{print_message, print_result};
use crate::cli::settings::Settings;
use crate::files::failure::plain;
use crate::plan::study::Runs;
use crate::study::cluster::slurm::Job;
use crate::study::collection::CollectionFault;

/// The largest index of an array where Slurm does not state another one (its default of `MaxArraySize` is 1001).
const USUAL_ARRAY: u32 = 1001;

/// Prints or submits the scripts.
pub fn submit(arguments: &SubmitArguments, settings: Settings) -> Result<Exit, Failure> {
    let choice = &arguments.choice;
    let Some(opened) = open(&arguments.plan, choice, settings)? else {
        return Ok(Exit::Wrong);
    };
    if !matches!(opened.study.runs, Runs::Fixed(_)) {
        return Err(failure::of_collection(CollectionFault::UntilInShards));
    }
    // A task starts in the folder from which it was submitted, but its program may be found elsewhere there.
    let program = std::env::current_exe().map_or_else(
        |_| "psd".to_owned(),
        |program| program.display().to_string(),
    );
    let words = |words: &[&str]| -> Vec<String> {
        std::iter::once(program.clone())
            .chain(words.iter().map(|word| (*word).to_owned()))
            .collect()
    };
    let plan = arguments.plan.display().to_string();
    let folder = opened.folder.display().to_string();
    let mut command = words(&["study", "run", &plan, "--out", &folder]);
    command.extend(["--study".to_owned(), opened.study.name.clone()]);
    if let Some(runs) = choice.runs {
        command.extend(["--runs".to_owned(), runs.to_string()]);
    }
    for (name, value) in &choice.plan_settings.set {
        command.extend(["--set".to_owned(), format!("{name}={value}")]);
    }
    if let Some(rig) = &choice.plan_settings.rig {
        command.extend(["--rig".to_owned(), rig.clone()]);
    }
    let job = Job {
        name: opened.folder.file_name().map_or_else(
            || "study".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        ),
        command,
        merge: words(&["study", "merge", &folder]),
        shards: arguments.shards,
        throttle: arguments.throttle,
        processors: arguments.processors,
        time: arguments.time.clone(),
        options: arguments.option.clone(),
        folder,
    };
    if arguments.submit {
        submitted(&job, &opened.folder)
    } else {
        print_result(&format!(
            "{}\n# The second job, submitted with --dependency=afterany:JOB\n\n{}",
            job.array(),
            job.merging()
        ))?;
        print_message(&format!(
            "  before sbatch: mkdir -p {}; a task without a folder for its log fails without a message\n",
            job.folder
        ));
        Ok(Exit::Met)
    }
}

/// Writes the scripts into the folder, and submits both jobs.
fn submitted(job: &Job, folder: &Path) -> Result<Exit, Failure> {
    if let Some(most) = largest_array().filter(|most| job.shards >= *most) {
        return Err(Failure::command_line(format!(
            "an array of this cluster has at most {} tasks",
            most - 1
        ))
        .help("use fewer shards; each takes all processors of its task"));
    }
    std::fs::create_dir_all(folder).map_err(|error| Failure::file(folder, plain(&error)))?;
    let write = |name: &str, text: &str| -> Result<PathBuf, Failure> {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| Failure::file(&path, plain(&error)))?;
        Ok(path)
    };
    let array = write("array.sbatch", &job.array())?;
    let merging = write("merge.sbatch", &job.merging())?;
    let first = sbatch(&[], &array)?;
    let second = sbatch(&[format!("--dependency=afterany:{first}")], &merging)?;
    print_message(&format!(
        "  {} shards are job {first}; job {second} merges them\n  look with: psd study status {}\n",
        job.shards,
        folder.display()
    ));
    print_result(&format!("{first}\n"))?;
    Ok(Exit::Met)
}

/// Submits a script; returns the number of the job.
fn sbatch(options: &[String], script: &Path) -> Result<String, Failure> {
    let output = Command::new("sbatch")
        .arg("--parsable")
        .args(options)
        .arg(script)
        .output()
        .map_err(|error| {
            Failure::file("sbatch", plain(&error))
                .help("submit from a computer of the cluster, or omit `--submit`")
        })?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if !output.status.success() {
        return Err(Failure::file("sbatch", text(&output.stderr)));
    }
    // `--parsable` gives JOB or JOB;CLUSTER.
    let job = text(&output.stdout);
    Ok(job.split(';').next().unwrap_or_default().to_owned())
}

/// `MaxArraySize` of the cluster, which the index of a task stays below; None if Slurm does not answer.
fn largest_array() -> Option<u32> {
    let output = Command::new("scontrol").args(["show", "config"]).output();
    let text = String::from_utf8_lossy(&output.ok()?.stdout).into_owned();
    let stated = text.lines().find_map(|line| {
        let (name, value) = line.split_once('=')?;
        (name.trim() == "MaxArraySize").then(|| value.trim().parse().ok())?
    });
    stated.or(Some(USUAL_ARRAY))
}
