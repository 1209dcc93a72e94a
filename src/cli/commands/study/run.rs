//! `psd study run`: the runs of a study, or of one of its shards. In: a plan. Out: the data set, and its answers on the terminal and in
//! `summary.json`. A study that is there already is continued.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;

use super::progress::StudyProgress;
use super::{StudyChoice, answers, failure, open};
use crate::args::Format;
use crate::exit::{Exit, Failure};
use crate::files::provenance;
use crate::operator::watch::Signals;
use crate::output::{print_message, print_result};
use crate::settings::{Settings, variable};
use psd::study::cluster::shard::{self, NamedShard, Shard};
use psd::study::collection::{Collection, Ended};
use psd::study::data_set::Metadata;
use psd::study::definition::DefinitionError;
use psd::study::simulation::Simulation;
use psd::study::stopping::Looks;
use psd::study::stopping::rare::RareRuns;
use psd::study::{collection, metadata};
use psd_plan::study::Sampling;
use psd_rig::StopRequest;
use psd_rig::transport::MonotonicClock;

/// Stack size for the deepest plan, also in a build without optimisation.
const STACK: usize = 32 << 20;

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

fn named_shard(text: &str) -> Result<NamedShard, String> {
    shard::parse(text).map_err(|error| error.to_string())
}

pub fn run(arguments: &RunStudyArguments, settings: Settings) -> Result<Exit, Failure> {
    let shard = arguments
        .shard
        .map(|shard| shard.resolve(variable))
        .transpose()
        .map_err(|error| failure::of_shard(&error))?;
    let Some(opened) = open(&arguments.plan, &arguments.choice, settings)? else {
        return Ok(Exit::Wrong);
    };
    let simulation = Simulation::new(&opened.parsed, &opened.plan, &opened.study);
    let simulation = if arguments.one_by_one {
        simulation.one_by_one()
    } else {
        simulation
    };
    let metadata = metadata::study_metadata(
        &provenance::version(),
        &opened.plan,
        &opened.study,
        simulation.readout(),
    );
    if metadata.sampling == Sampling::Subset && RareRuns::of(&metadata).is_none() {
        return Err(failure::of_definition(&DefinitionError::LimitVaries));
    }
    print_message(&begins(&metadata, &simulation, shard));
    let collection = Collection {
        simulation: &simulation,
        metadata: &metadata,
        runs: opened.study.runs,
        folder: &opened.folder,
        shard,
    };
    let (ended, _) = collected(&collection, arguments, settings)?;
    if let Some(left) = simulation.left().text() {
        print_message(&format!("  {left}\n"));
    }
    match ended {
        Ended::Stopped { runs, of } => {
            print_message(&format!(
                "STOPPED  {runs} of {of} runs are kept; the same command continues\n"
            ));
            Ok(Exit::Unfinished)
        }
        Ended::Finished { path, simulated } => {
            if simulated == 0 {
                print_message("  all runs were there already\n");
            }
            if shard.is_none() {
                let plan = arguments.plan.display();
                let plan = match &arguments.choice.plan_settings.rig {
                    Some(rig) => format!("{plan} --rig {rig}"),
                    None => plan.to_string(),
                };
                return answers::give(&path, Some(&plan), arguments.format);
            }
            print_result(&format!("{}\n", path.display()))?;
            Ok(Exit::Met)
        }
    }
}

/// What is simulated, and how.
fn begins(metadata: &Metadata, simulation: &Simulation<'_>, shard: Option<Shard>) -> String {
    let how = if simulation.is_batched() {
        "in batches"
    } else {
        "one by one"
    };
    let part = shard.map_or_else(String::new, |shard| {
        format!(", shard {} of {}", shard.number, shard.of)
    });
    format!(
        "SIMULATION  study {}: up to {} runs {how}{part}\n",
        metadata.study, metadata.at_most
    )
}

/// Simulates on all threads until the study ends or a signal arrives.
fn collected(
    collection: &Collection<'_>,
    arguments: &RunStudyArguments,
    settings: Settings,
) -> Result<(Ended, Looks), Failure> {
    let stop = StopRequest::default();
    let _signals = Signals::ending(&stop).map_err(Failure::Signals)?;
    let mut builder = rayon::ThreadPoolBuilder::new().stack_size(STACK);
    if let Some(jobs) = arguments.jobs {
        builder = builder.num_threads(jobs.get());
    }
    let pool = builder
        .build()
        .map_err(|error| Failure::command_line(format!("no threads to simulate on: {error}")))?;
    let mut progress = StudyProgress::new(&collection.metadata.study, settings);
    let result = pool.install(|| {
        collection.run(
            &MonotonicClock::start(),
            &mut |now: &collection::Progress<'_>| {
                progress.show(now);
                !stop.end_requested()
            },
        )
    });
    progress.finish();
    result.map_err(failure::of_collection)
}
