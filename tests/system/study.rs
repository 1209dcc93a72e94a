//! Studies as processes: ended by TERM, killed, continued, divided into shards. The data set has the bytes of a study that ran undisturbed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

use crate::stage::PSD;

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_mins(5);
/// Far more runs than are done before the first signal.
const RUNS: &str = "12000";

/// An impact with scattered speed and mass.
pub const PLAN: &str = r#"plan "Scattered impacts" { edition = 1 }

param speed = 1 m/s

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 327.65 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = speed
}

impact hit {
  striker   = hammer
  time_step = 10 ms
  duration  = 1 s
}

study scatter {
  vary = [speed ~ normal(sd: 0.05 m/s), beam.mass ~ lognormal(cv: 10 %)]
  seed = 3
}

require "stays in travel" hit.max_displacement < 0.17 m
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("plan.psd"), PLAN).unwrap();
    folder
}

fn psd(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(PSD);
    command
        .args(["study", "run", "plan.psd", "--runs", RUNS])
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn ended(folder: &Path, arguments: &[&str]) -> Output {
    psd(folder, arguments).output().unwrap()
}

fn study(folder: &Path) -> PathBuf {
    folder.join("studies/plan-scatter")
}

/// A study that has begun to write runs.
fn begun(folder: &Path, arguments: &[&str]) -> Child {
    let child = psd(folder, arguments).spawn().unwrap();
    let began = Instant::now();
    let part = || {
        let entries = fs::read_dir(study(folder)).into_iter().flatten().flatten();
        let mut paths = entries.map(|entry| entry.path());
        paths.any(|path| {
            path.extension()
                .is_some_and(|extension| extension == "part")
        })
    };
    while !part() {
        assert!(began.elapsed() < PATIENCE, "no run was written");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn send(child: Child, signal: Signal) -> Output {
    // A part of the runs is simulated by then, but not all.
    std::thread::sleep(Duration::from_millis(150));
    kill_process(Pid::from_child(&child), signal).unwrap();
    child.wait_with_output().unwrap()
}

fn messages(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_study_that_was_terminated_and_killed_has_the_bytes_of_an_undisturbed_one() {
    let [whole, hurt] = [folder(), folder()];
    let output = ended(whole.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", messages(&output));
    assert!(
        messages(&output).contains("in batches"),
        "{}",
        messages(&output)
    );
    let expected = fs::read(study(whole.path()).join("study.parquet")).unwrap();

    // One by one is slower, and gives the same rows.
    let alone = ["--one-by-one", "--jobs", "1"];
    for signal in [Signal::TERM, Signal::INT] {
        let output = send(begun(hurt.path(), &alone), signal);
        assert_eq!(output.status.code(), Some(75), "{}", messages(&output));
        assert!(messages(&output).contains("the same command continues"));
    }
    let output = send(begun(hurt.path(), &alone), Signal::KILL);
    assert_eq!(output.status.code(), None);
    assert!(!study(hurt.path()).join("study.parquet").exists());
    let output = ended(hurt.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", messages(&output));
    let found = fs::read(study(hurt.path()).join("study.parquet")).unwrap();
    assert!(found == expected, "the bytes differ");
    let again = ended(hurt.path(), &[]);
    assert!(
        messages(&again).contains("all runs were there already"),
        "{}",
        messages(&again)
    );
}

#[test]
fn shards_of_processes_are_put_together() {
    let [whole, divided] = [folder(), folder()];
    let output = ended(whole.path(), &["--one-by-one"]);
    assert_eq!(output.status.code(), Some(0), "{}", messages(&output));
    let expected = fs::read(study(whole.path()).join("study.parquet")).unwrap();
    let status = || {
        Command::new(PSD)
            .args(["study", "status"])
            .arg(study(divided.path()))
            .output()
            .unwrap()
    };
    // Before the first run is durable, the folder has the scripts alone.
    assert_eq!(status().status.code(), Some(3));
    fs::create_dir_all(study(divided.path())).unwrap();
    let script = study(divided.path()).join("array.sbatch");
    fs::write(&script, "").unwrap();
    let submitted = status();
    assert_eq!(submitted.status.code(), Some(75));
    assert!(String::from_utf8_lossy(&submitted.stdout).contains("no runs are durable yet"));
    fs::remove_file(script).unwrap();
    let run = |shard: &str| ended(divided.path(), &["--shard", shard]);
    let merged = || {
        Command::new(PSD)
            .args(["study", "merge"])
            .arg(study(divided.path()))
            .output()
            .unwrap()
    };
    for shard in ["3/3", "1/3"] {
        let output = run(shard);
        assert_eq!(output.status.code(), Some(0), "{}", messages(&output));
    }
    let refused = merged();
    assert_eq!(refused.status.code(), Some(3));
    assert!(
        messages(&refused).contains("--array=2"),
        "{}",
        messages(&refused)
    );
    let missing = status();
    let missing = String::from_utf8_lossy(&missing.stdout).into_owned();
    assert!(missing.contains("shards without runs: 2"), "{missing}");
    let by_index = psd(divided.path(), &["--shard", "env/3"])
        .env("SLURM_ARRAY_TASK_ID", "2")
        .output()
        .unwrap();
    assert_eq!(by_index.status.code(), Some(0), "{}", messages(&by_index));
    let output = merged();
    assert_eq!(output.status.code(), Some(0), "{}", messages(&output));
    let found = fs::read(study(divided.path()).join("study.parquet")).unwrap();
    assert!(found == expected, "the bytes differ");
    // The access rights follow the umask.
    let mode = |name: &str| {
        use std::os::unix::fs::PermissionsExt as _;
        let path = study(divided.path()).join(name);
        fs::metadata(path).unwrap().permissions().mode()
    };
    assert_eq!(mode("study.parquet"), mode("summary.json"));
    let reproduced = Command::new(PSD)
        .args(["study", "merge", "--plan", "elsewhere/plan.psd"])
        .arg(study(divided.path()))
        .output()
        .unwrap();
    assert!(
        messages(&reproduced).contains("psd run elsewhere/plan.psd"),
        "{}",
        messages(&reproduced)
    );
}
