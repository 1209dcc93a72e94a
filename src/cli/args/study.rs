//! The command line of studies: `psd study run`, `status`, `merge`, `submit`. In: words. Out: their shapes, not their meaning.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{Format, PlanSettings};
use crate::study::cluster::shard::{self, NamedShard};

#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Run a study of a plan, or continue one (no motion)
    Run(RunStudyArguments),
    /// Show the progress of a study or of its shards
    Status {
        /// The folder of the study
        #[arg(value_name = "FOLDER")]
        folder: PathBuf,
    },
    /// Put the shards of a study together
    #[command(
        after_help = "The file is that of a study run by one process, byte for byte.\n\n\
    Exit codes:\n\
    \x20 0  all requirements on probabilities are met, or there is none\n\
    \x20 1  a requirement on a probability is not met or undecided\n\
    \x20 3  a shard is missing, damaged or of another study"
    )]
    Merge {
        /// The folder of the shards
        #[arg(value_name = "FOLDER")]
        folder: PathBuf,
    },
    /// Make summary, figures and report of a study from its data set
    #[command(
        after_help = "Needs neither the plan nor the build of psd that ran the study. Equal data sets give equal files.\n\n\
    Exit codes:\n\
    \x20 0  all requirements on probabilities are met, or there is none\n\
    \x20 1  a requirement on a probability is not met or undecided\n\
    \x20 3  the data set is missing or damaged, or a file cannot be written"
    )]
    Report(ReportStudyArguments),
    /// Print the scripts of a job array, or submit them
    Submit(SubmitArguments),
}

#[derive(Debug, Args)]
pub struct ReportStudyArguments {
    /// The folder of the study, or a data set in it
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Write into this folder [default: that of the data set]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "The same command continues a study that was stopped, and adds runs to a finished one if `--runs` is larger. Ctrl-C or TERM \
    stops it after the present runs; nothing is lost.\n\n\
    Exit codes:\n\
    \x20 0  all requirements on probabilities are met, or there is none\n\
    \x20 1  a requirement on a probability is not met or undecided\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of a file, or the folder contains another study\n\
    \x2075  stopped before all runs were done"
)]
pub struct RunStudyArguments {
    /// The plan, a `.psd` file
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub choice: StudyChoice,
    /// Run one of several shards: 3/8, `env/8` or `env`
    #[arg(long, value_name = "I/N", value_parser = named_shard)]
    pub shard: Option<NamedShard>,
    /// Number of threads [default: number of processors]
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroUsize>,
    /// Simulate each run separately, also where batches are faster
    #[arg(long)]
    pub one_by_one: bool,
    /// Standard output: the study folder, or the summary as JSON
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

/// A study of a plan, and where it is kept.
#[derive(Debug, Args)]
pub struct StudyChoice {
    /// The study or fragility, if the plan has several
    #[arg(long, value_name = "NAME")]
    pub study: Option<String>,
    /// Number of runs, or most runs, instead of the plan's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub runs: Option<u64>,
    /// Folder of the study [default: studies/PLAN-STUDY]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
}

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

fn named_shard(text: &str) -> Result<NamedShard, String> {
    shard::parse(text).map_err(|error| error.to_string())
}
