//! The program is killed at each of its writes to the run log, its syncs, and its commands to the rig. The run is resumed to
//! the same end, and no target is executed twice.

use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::needs;
use crate::stage::{PSD, Stage, strace, wait};

/// Number of concurrent runs: nearly all of their time is waiting.
const AT_ONCE: usize = 8;

/// The event at which the program is killed.
#[derive(Clone, Copy, Debug)]
enum At {
    Write,
    Sync,
    Word,
}

/// An uninterrupted run: its results, its moves, and the number of events of each kind.
struct Whole {
    results: String,
    moves: Vec<String>,
}

fn whole() -> Whole {
    let stage = Stage::new();
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(0), "{}", ran.output);
    Whole {
        results: stage.results(),
        moves: stage.moves(),
    }
}

/// Runs under strace, killed at the `count`-th event of a kind. False: it ended before.
fn killed(stage: &Stage, at: At, count: usize) -> bool {
    let (call, path) = match at {
        At::Write => ("write", stage.journal()),
        At::Sync => ("fdatasync", stage.journal()),
        At::Word => ("write", stage.path("rig").canonicalize().unwrap()),
    };
    let mut command = strace(call, &format!("signal=KILL:when={count}"));
    command.args(["-o", "/dev/null", "-P"]).arg(path).arg(PSD);
    stage.run_arguments(&mut command, &["--yes"]);
    let ended = wait(&mut command);
    match ended.code {
        // strace ends as the program does, or with the exit code of a shell.
        None | Some(137) => true,
        Some(0) => false,
        _ => panic!("{at:?} {count}: {}", ended.output),
    }
}

/// One kill, and the resumed run. False: the run had already ended.
fn one(whole: &Whole, at: At, count: usize) -> bool {
    let stage = Stage::new();
    if !killed(&stage, at, count) {
        return false;
    }
    stage.after_hosts();
    let resumed = wait(&mut stage.resume_with(&[]));
    if stage.moves().is_empty() {
        // Before the run log contains the rig, the run cannot be resumed, and a message says so.
        assert_eq!(resumed.code, Some(3), "{at:?} {count}: {}", resumed.output);
        assert!(
            resumed.output.contains("error:"),
            "{at:?} {count}: {}",
            resumed.output
        );
        return true;
    }
    // Only the final records of a finished run can be cut off without any work left.
    let over = resumed.output.contains("nothing is left to resume");
    assert!(
        resumed.code == Some(0) || over,
        "{at:?} {count}: {}",
        resumed.output
    );
    if over && !stage.path("run").join("manifest.sha256").exists() {
        let gone = stage.verify();
        assert!(
            gone.code == Some(3) && gone.output.contains("its results are missing"),
            "{at:?} {count}: {}",
            gone.output
        );
        wait(Command::new(PSD).arg("report").arg(stage.path("run")));
    }
    let verified = stage.verify();
    assert!(
        verified.code == Some(0) && !verified.output.contains("INCOMPLETE"),
        "{at:?} {count}: {}",
        verified.output
    );
    assert_eq!(
        stage.moves(),
        whole.moves,
        "{at:?} {count}: each target once, in order"
    );
    if !over {
        assert_eq!(stage.results(), whole.results, "{at:?} {count}");
    }
    true
}

/// Kills at every `step`-th event until the run ends without a kill. Returns the number of kills.
fn everywhere(at: At, step: usize) -> usize {
    let whole = whole();
    let (next, kills) = (AtomicUsize::new(1), AtomicUsize::new(0));
    let failures = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..AT_ONCE {
            scope.spawn(|| {
                loop {
                    let count = next.fetch_add(step, Ordering::SeqCst);
                    match std::panic::catch_unwind(|| one(&whole, at, count)) {
                        Ok(true) => kills.fetch_add(1, Ordering::SeqCst),
                        Ok(false) => return,
                        Err(why) => {
                            failures
                                .lock()
                                .unwrap()
                                .push(why.downcast_ref::<String>().cloned().unwrap_or_default());
                            return;
                        }
                    };
                }
            });
        }
    });
    let failures = failures.into_inner().unwrap();
    assert!(
        failures.is_empty(),
        "{} of {at:?} failed:\n{}",
        failures.len(),
        failures.join("\n\n")
    );
    kills.into_inner()
}

#[test]
fn at_every_write_of_the_record() {
    if needs::strace() {
        let kills = everywhere(At::Write, 1);
        assert!(kills > 150, "{kills}");
    }
}

#[test]
fn at_syncs_of_the_record() {
    if needs::strace() {
        let kills = everywhere(At::Sync, 3);
        assert!(kills > 30, "{kills}");
    }
}

#[test]
fn at_words_to_the_rig() {
    if needs::strace() {
        // The number of readings of a settling rig depends on the machine's speed: a busy one sends fewer commands.
        let kills = everywhere(At::Word, 7);
        assert!(kills > 30, "{kills}");
    }
}
