//! Failures of studies as the program reports them: the message, and the action that corrects it.

use crate::exit::Failure;
use psd::study::cluster::shard::ShardError;
use psd::study::collection::CollectionFault;
use psd::study::collection::merge::MergeFault;
use psd::study::collection::same::Difference;
use psd::study::data_set::DataSetFault;
use psd::study::definition::DefinitionError;
use psd::study::definition::measured::MeasuredError;

pub fn of_definition(error: &DefinitionError) -> Failure {
    let failure = Failure::command_line(error.to_string());
    match error {
        DefinitionError::NoStudy => failure.help("add a `study` block; see docs/how-to/studies.md"),
        DefinitionError::Several(_) => failure.help("name one with `--study`"),
        DefinitionError::Unknown { .. } => failure.help("name one of these with `--study`"),
        DefinitionError::LimitVaries => failure.help("write `sampling = random`"),
        DefinitionError::RunsOfSubset => {
            failure.help("omit `--runs`; `subset(points: …, replicates: …)` states the size")
        }
        DefinitionError::NoRuns | DefinitionError::TooManyRuns | DefinitionError::Inputs(_) => {
            failure
        }
    }
}

pub fn of_measured(error: &MeasuredError) -> Failure {
    let failure = Failure::command_line(error.to_string());
    match error {
        MeasuredError::NoValue(_) => failure.help("`psd run` of the plan shows why"),
        MeasuredError::NoUncertainty(name) => {
            failure.help(format!("state it: `{name} ~ normal(mean: …, sd: …)`"))
        }
    }
}

pub fn of_data_set(fault: &DataSetFault) -> Failure {
    Failure::file(&fault.path, &fault.reason)
}

pub fn of_collection(fault: CollectionFault) -> Failure {
    match fault {
        CollectionFault::DataSet(fault) => of_data_set(&fault),
        CollectionFault::Other { path, difference } => {
            let help = match difference {
                Difference::LatinHypercube | Difference::Runs => {
                    "name a new folder with `--out`, or write `sampling = random`"
                }
                _ => "name a new folder with `--out`, or remove the file",
            };
            Failure::file(path, difference.to_string()).help(help)
        }
        CollectionFault::OtherRuns { path, first, end } => Failure::file(
            path,
            format!("it contains runs {first} to {end}, which belong to another shard"),
        )
        .help("name a new folder with `--out`: only a study in one file can grow"),
        CollectionFault::Locked { path } => {
            Failure::file(path, "another process adds runs to this study")
                .help("wait for it, or stop it")
        }
        fault @ CollectionFault::UntilInShards => Failure::command_line(fault.to_string())
            .help("omit the shards, or write a fixed number of runs, `runs = 100000`"),
        CollectionFault::OtherShards {
            folder,
            found,
            wanted,
        } => Failure::file(
            folder,
            format!("shards of {found} are here, not of {wanted}"),
        )
        .help(format!(
            "write `--shard I/{found}`, or name a new folder with `--out`"
        )),
    }
}

pub fn of_merge(fault: &MergeFault) -> Failure {
    let failure = match fault {
        MergeFault::DataSet(fault) => return of_data_set(fault),
        fault @ MergeFault::Missing { .. } => Failure::file("shards", fault.to_string()),
        MergeFault::NoShards { folder } => Failure::file(folder, "no shards are here"),
        MergeFault::SeveralDivisions { folder, of } => Failure::file(
            folder,
            format!("shards of {} and of {} are here", of[0], of[1]),
        ),
        MergeFault::Other { path, difference } => Failure::file(path, difference.to_string()),
        MergeFault::OtherRuns {
            path,
            found,
            wanted,
            ..
        } => Failure::file(
            path,
            format!(
                "it contains runs {} to {}, its shard has {} to {}",
                found[0], found[1], wanted[0], wanted[1]
            ),
        ),
    };
    match fault.help() {
        Some(help) => failure.help(help),
        None => failure,
    }
}

pub fn of_shard(error: &ShardError) -> Failure {
    let failure = Failure::command_line(error.to_string());
    match error {
        ShardError::NoIndex(_) => failure.help("write the shard itself, `--shard 3/8`"),
        ShardError::OutOfRange => {
            failure.help("number the tasks of the array from 1 to the number of shards")
        }
        ShardError::Form | ShardError::NoNumber { .. } | ShardError::NoCount(_) => failure,
    }
}
