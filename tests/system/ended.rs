//! The program ends during its work: an abort, or a panic because the system starts no thread for it. The rig cannot be
//! informed of an abort, and holds by its own watchdog. The run is resumed, and no target is executed twice. A run starts its
//! threads before its first move and after its last. `src/rig/safety/mod.rs` tests the hold command of a panic between the two.

use std::process::Command;

use rustix::process::Signal;

use crate::needs;
use crate::stage::{Ended, PSD, Stage, finish, let_it_trip, signal, start, strace, wait, watched};

#[test]
fn by_an_abort_in_any_phase() {
    // In the ramp, after it, in the impact, in parallel: each has its own rig, and waits for its watchdog.
    let phases = [(Signal::ABORT, 3), (Signal::ILL, 18), (Signal::ABORT, 30)];
    std::thread::scope(|scope| {
        phases
            .map(|(word, moves)| scope.spawn(move || aborted(word, moves)))
            .map(|one| one.join().unwrap())
    });
}

/// A signal ends the run of a watched rig after this number of moves. The rig holds itself, and the run is resumed.
fn aborted(word: Signal, moves: usize) {
    let stage = Stage::of(watched, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(moves);
    signal(&run, word);
    let run = finish(run);
    assert_eq!(
        run.code,
        None,
        "ended by the signal at move {moves}: {:?}",
        run.output.lines().last()
    );
    let (done, asked) = (stage.moves().len(), stage.requests().len());
    // The line is silent after the end of the program; the watchdog of the rig trips.
    let_it_trip();
    assert_eq!((stage.moves().len(), stage.requests().len()), (done, asked));
    stage.goes_on(&[]);
    assert!(
        stage.requests()[asked..]
            .iter()
            .any(|request| request.contains(">CLR")),
        "it had tripped"
    );
    let (mut moves, count) = (stage.moves(), stage.moves().len());
    moves.dedup();
    assert_eq!(moves.len(), count, "{moves:?}");
}

/// The number of threads that a run starts.
fn threads_of_a_run() -> usize {
    let stage = Stage::new();
    let trace = stage.path("threads");
    let mut command = strace("clone3", "");
    command.arg("-o").arg(&trace).arg(PSD);
    stage.run_arguments(&mut command, &["--yes"]);
    assert_eq!(wait(&mut command).code, Some(0));
    std::fs::read_to_string(trace)
        .expect("what strace saw")
        .matches("clone3(")
        .count()
}

/// The run without its n-th thread: the standard library panics, but a run that does not need the thread continues.
fn without_thread(stage: &Stage, number: usize) -> Ended {
    let mut command = strace("clone3", &format!("error=EAGAIN:when={number}"));
    command.args(["-o", "/dev/null", PSD]);
    stage.run_arguments(&mut command, &["--yes"]);
    wait(&mut command)
}

#[test]
fn by_a_panic_where_a_thread_cannot_be_started() {
    if !needs::strace() {
        return;
    }
    let (mut before, mut after, mut without) = (0, 0, 0);
    for number in 1..=threads_of_a_run() {
        let stage = Stage::new();
        let ran = without_thread(&stage, number);
        if ran.code == Some(0) {
            without += 1;
            continue;
        }
        assert!(
            ran.code == Some(101) && ran.output.contains("panicked"),
            "{number}: {:?}",
            ran.output.lines().last()
        );
        if stage.moves().is_empty() {
            before += 1;
            continue;
        }
        // The run had ended, and its run log was complete.
        after += 1;
        assert_eq!(stage.moves().len(), 42, "{number}");
        // The output lost in the panic is regenerated from the run log.
        let again = wait(
            Command::new(PSD)
                .arg("report")
                .arg(stage.path("run"))
                .arg("--out")
                .arg(stage.path("again")),
        );
        assert_eq!(again.code, Some(0), "{number}: {}", again.output);
    }
    assert!(
        before > 0 && after > 0,
        "{before} panics before the first move, {after} after the last"
    );
    assert!(
        without > 0,
        "the study of the uncertainties does without threads"
    );
}
