//! The programs of Slurm: sbatch, srun, scontrol, squeue. In: a script, a folder. Out: what they answer. Without Slurm, a question has no
//! answer, and only a submission fails.

use std::path::Path;
use std::process::{Command, Output};

use crate::exit::Failure;
use crate::files::failure::plain;
use psd::study::cluster::slurm::{ARRAY_SCRIPT, Job};

/// Most tasks of an array where Slurm does not state another number.
const USUAL_ARRAY: u32 = 1000;
/// Longest wait for a node that looks at the folder \[s\].
const PATIENCE: u32 = 20;

/// Submits a script; returns the number of the job.
pub fn sbatch(options: &[String], script: &Path) -> Result<String, Failure> {
    let output = Command::new("sbatch")
        .arg("--parsable")
        .args(options)
        .arg(script)
        .output()
        .map_err(|error| {
            Failure::file("sbatch", plain(&error))
                .help("submit from a computer of the cluster, or omit `--submit`")
        })?;
    if !output.status.success() {
        return Err(Failure::file("sbatch", trimmed_text(&output.stderr)));
    }
    // `--parsable` gives JOB or JOB;CLUSTER.
    let job = trimmed_text(&output.stdout);
    Ok(job.split(';').next().unwrap_or_default().to_owned())
}

/// Most tasks of an array of this cluster: the index of a task, from 1 on, stays below `MaxArraySize`.
pub fn largest_array() -> Option<u32> {
    let answer = answer(Command::new("scontrol").args(["show", "config"]))?;
    let stated = answer.lines().find_map(|line| {
        let (name, value) = line.split_once('=')?;
        (name.trim() == "MaxArraySize").then(|| value.trim().parse::<u32>().ok())?
    });
    Some(stated.map_or(USUAL_ARRAY, |beyond| beyond.saturating_sub(1).max(1)))
}

/// What a node sees of a study.
pub enum NodeView {
    Sees,
    NoFolder,
    NoProgram,
    /// No node has looked.
    Unknown(String),
}

/// Whether a node sees the program and the script of a job: without the folder, every task of an array fails without a message.
pub fn node_view(job: &Job, script: &Path) -> NodeView {
    const LOOK: &str = "command -v \"$1\" > /dev/null || { echo program; exit; }\n\
        test -f \"$2\" && echo sees || echo folder";
    let output = Command::new("srun")
        .args(["--quiet", "--ntasks=1", "--time=1"])
        .arg(format!("--immediate={PATIENCE}"))
        .arg(format!("--job-name={}-look", job.name))
        .args(&job.options)
        .args(["sh", "-c", LOOK, "sh", &job.command[0]])
        .arg(script)
        .output();
    let Output { stdout, stderr, .. } = match output {
        Ok(output) => output,
        Err(error) => return NodeView::Unknown(format!("srun: {}", plain(&error))),
    };
    match trimmed_text(&stdout).as_str() {
        "sees" => NodeView::Sees,
        "folder" => NodeView::NoFolder,
        "program" => NodeView::NoProgram,
        _ => NodeView::Unknown(trimmed_text(&stderr)),
    }
}

/// Tasks of an array that wait or run: index and state.
pub struct Queue(Vec<(u32, String)>);

/// The tasks of the study of a folder in the queue of Slurm; none without Slurm.
pub fn queue(folder: &Path) -> Queue {
    // Slurm states a script by its absolute path.
    let script = folder.join(ARRAY_SCRIPT).canonicalize();
    let listed = script.ok().and_then(|script| {
        let format = ["--me", "--noheader", "--array", "--format=%K|%T|%o"];
        let answer = answer(Command::new("squeue").args(format))?;
        let task = |line: &str| {
            let mut parts = line.splitn(3, '|');
            let index = parts.next()?.trim().parse().ok()?;
            let state = parts.next()?.trim().to_lowercase();
            (Path::new(parts.next()?.trim()) == script).then_some((index, state))
        };
        Some(answer.lines().filter_map(task).collect())
    });
    Queue(listed.unwrap_or_default())
}

impl Queue {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn contains(&self, shard: u32) -> bool {
        self.0.iter().any(|(index, _)| *index == shard)
    }

    /// Number of tasks in each state: `3 pending, 2 running`.
    pub fn states(&self) -> String {
        let mut counts = std::collections::BTreeMap::new();
        for (_, state) in &self.0 {
            *counts.entry(state.as_str()).or_insert(0_u32) += 1;
        }
        let texts = counts
            .into_iter()
            .map(|(state, count)| format!("{count} {state}"));
        texts.collect::<Vec<_>>().join(", ")
    }
}

/// What a program prints, if it is there and ends well.
fn answer(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    output
        .status
        .success()
        .then(|| trimmed_text(&output.stdout))
}

fn trimmed_text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim().to_owned()
}
