//! `psd study status` and `psd study merge`. In: the folder of a study. Out: how far it is, or its shards in one file.

use std::fmt::Write as _;
use std::path::Path;

use super::slurm::Queue;
use super::{answers, failure, slurm};
use crate::args::Format;
use crate::exit::{Exit, Failure};
use crate::output::{print_message, print_result};
use psd::study::cluster::slurm::ARRAY_SCRIPT;
use psd::study::collection::merge::{self, listed, resubmission};
use psd::study::collection::status::{self, StudyPart};

fn without_study(folder: &Path, found: &str) -> Failure {
    Failure::file(folder, found).help("name the folder of `psd study run`")
}

/// A plan or a data set is not the folder of a study.
fn refuse_file(folder: &Path) -> Result<(), Failure> {
    if folder.is_file() {
        Err(without_study(
            folder,
            "is a file, not the folder of a study",
        ))
    } else {
        Ok(())
    }
}

/// Shows the runs that are there, and the shards that are not finished.
pub fn status(folder: &Path) -> Result<Exit, Failure> {
    refuse_file(folder)?;
    let status = status::status(folder).map_err(|fault| failure::of_data_set(&fault))?;
    let queue = slurm::queue(folder);
    let Some(metadata) = &status.metadata else {
        if folder.join(ARRAY_SCRIPT).exists() {
            print_result(&format!("no runs are durable yet\n{}", queued(&queue)))?;
            return Ok(Exit::Unfinished);
        }
        return Err(without_study(folder, "contains no runs of a study yet"));
    };
    let mut text = format!(
        "study {} of {}, {} runs\n",
        metadata.study, metadata.plan, metadata.at_most
    );
    let finished = |part: &&StudyPart| part.shard.is_some() && part.finished;
    let shards = status.parts.iter().filter(|part| part.shard.is_some());
    let of = shards.clone().count();
    if of > 0 {
        let done: u64 = shards.clone().map(|part| part.runs).sum();
        let _ = writeln!(
            text,
            "  {} of {of} shards are finished, {done} of {} runs are durable",
            shards.clone().filter(finished).count(),
            metadata.at_most
        );
        for part in shards.filter(|part| !part.finished && part.runs > 0) {
            text += &unfinished(part);
        }
        text += &queued(&queue);
        let mut missing = status.unfinished();
        missing.retain(|number| !queue.contains(*number));
        if !missing.is_empty() {
            let durable = |number: &u32| {
                let mut parts = status.parts.iter();
                parts.any(|part| part.runs > 0 && part.shard.is_some_and(|it| it.number == *number))
            };
            let lost: Vec<u32> = missing.iter().copied().filter(|it| !durable(it)).collect();
            if !lost.is_empty() {
                let _ = writeln!(text, "  shards without runs: {}", listed(&lost));
            }
            let again = resubmission(folder, &missing);
            let _ = writeln!(text, "  submit again: {again}");
        }
    }
    for part in status.parts.iter().filter(|part| part.shard.is_none()) {
        if part.finished {
            let _ = writeln!(text, "  study.parquet is finished, {} runs", part.runs);
        } else {
            text += &unfinished(part);
        }
    }
    print_result(&text)?;
    let whole = |part: &StudyPart| part.shard.is_none() && part.finished;
    let complete = status.parts.iter().any(whole) || status.parts.iter().all(|part| part.finished);
    Ok(if complete {
        Exit::Met
    } else {
        Exit::Unfinished
    })
}

/// The tasks in the queue of Slurm, in a line; nothing without tasks.
fn queued(queue: &Queue) -> String {
    if queue.is_empty() {
        return String::new();
    }
    format!("  in the queue of Slurm: {}\n", queue.states())
}

fn unfinished(part: &StudyPart) -> String {
    let name = part.shard.map_or_else(
        || "the study".to_owned(),
        |shard| format!("shard {}", shard.number),
    );
    format!("  {name}: {} of {} runs\n", part.runs, part.of)
}

/// Puts shards together, and answers as `psd study run` does. `plan`: the plan for the lines that reproduce a run, with its folder.
pub fn merge(folder: &Path, plan: Option<&Path>) -> Result<Exit, Failure> {
    refuse_file(folder)?;
    let (path, metadata) = merge::merge(folder).map_err(|fault| failure::of_merge(&fault))?;
    let (runs, path_shown) = (metadata.runs(), path.display());
    print_message(&format!("  {runs} runs are in {path_shown}\n"));
    let plan = plan.map(|plan| plan.display().to_string());
    answers::give(&path, plan.as_deref(), Format::Human)
}
