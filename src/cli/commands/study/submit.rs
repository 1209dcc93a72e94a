//! `psd study submit --slurm`: the scripts of a job array. In: a plan, a number of shards. Out: the scripts on standard output, or two
//! submitted jobs. The plan is checked here, so that no array fails on its error.

use std::path::{Path, PathBuf};

use clap::Args;

use super::slurm::{self, NodeView};
use super::{StudyChoice, failure, open};
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::study::cluster::shard;
use psd::study::cluster::slurm::{ARRAY_SCRIPT, Job, MERGE_SCRIPT};
use psd::study::collection::CollectionFault;
use psd_plan::study::Runs;

#[derive(Debug, Args)]
#[command(
    after_help = "psd prints two scripts: the job array, and the job that merges its shards. With `--submit` it writes them into the folder of the \
    study and calls `sbatch`. See docs/how-to/clusters.md."
)]
pub struct SubmitArguments {
    /// The plan, a `.psd` file
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    /// Write scripts for Slurm
    #[arg(long, required = true)]
    pub slurm: bool,
    /// Number of shards, the tasks of the array
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(shard::MOST_SHARDS)))]
    pub shards: u32,
    #[command(flatten)]
    pub choice: StudyChoice,
    /// Most tasks at a time
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub throttle: Option<u32>,
    /// Processors of each task
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub processors: u32,
    /// Time limit of each task, as Slurm writes it
    #[arg(long, value_name = "TIME", default_value = "01:00:00")]
    pub time: String,
    /// Another option of sbatch, such as `--partition=short`; repeat
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    pub option: Vec<String>,
    /// Submit the jobs
    #[arg(long)]
    pub submit: bool,
}

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
        merge: words(&["study", "merge", &folder, "--plan", &plan]),
        shards: folded(arguments.shards),
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

/// At most as many shards as an array of this cluster has tasks. Fewer shards have more runs each; the study is the same.
fn folded(shards: u32) -> u32 {
    match slurm::largest_array() {
        Some(most) if shards > most => {
            print_message(&format!(
                "  an array of this cluster has at most {most} tasks: {most} shards instead of {shards}\n"
            ));
            most
        }
        _ => shards,
    }
}

/// Writes the scripts into the folder, and submits both jobs.
fn submitted(job: &Job, folder: &Path) -> Result<Exit, Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::file(folder, plain(&error)))?;
    let write = |name: &str, text: &str| -> Result<PathBuf, Failure> {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| Failure::file(&path, plain(&error)))?;
        Ok(path)
    };
    let array = write(ARRAY_SCRIPT, &job.array())?;
    let merging = write(MERGE_SCRIPT, &job.merging())?;
    match slurm::node_view(job, &array) {
        NodeView::Sees => {}
        NodeView::NoFolder => {
            return Err(Failure::file(folder, "a node does not see this folder")
                .help("name a folder that all nodes share, with `--out`"));
        }
        NodeView::NoProgram => {
            return Err(
                Failure::file(&job.command[0], "a node does not see this program")
                    .help("install psd where all nodes see it"),
            );
        }
        NodeView::Unknown(reason) => print_message(&format!(
            "  not checked: whether a node sees {}: {reason}\n",
            job.folder
        )),
    }
    let first = slurm::sbatch(&[], &array)?;
    let second = slurm::sbatch(&[format!("--dependency=afterany:{first}")], &merging)?;
    print_message(&format!(
        "  {} shards are job {first}; job {second} merges them\n  look with: psd study status {}\n",
        job.shards,
        folder.display()
    ));
    print_result(&format!("{first}\n"))?;
    Ok(Exit::Met)
}
