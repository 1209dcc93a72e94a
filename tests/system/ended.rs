//! The program ends in the middle of what it does: an abort, or a panic where the system gives it no thread. Of an abort nobody can
//! tell the rig, which holds by its own watchdog; the run goes on, and no target is carried out twice. A run starts its threads before
//! its first move and after its last; that a panic between the two sends the word to hold is shown in `src/rig/safety/mod.rs`.

use std::process::Command;

use rustix::process::Signal;

use crate::needs;
use crate::stage::{Ended, PSD, Stage, finish, let_it_trip, signal, start, wait, watched};

#[test]
fn by_an_abort_in_any_phase() {
    // In the ramp, after it, in the blow, beside each other: each has its own rig, whose watchdog is waited for.
    let phases = [(Signal::ABORT, 3), (Signal::ILL, 18), (Signal::ABORT, 30)];
    std::thread::scope(|scope| {
        phases
            .map(|(word, moves)| scope.spawn(move || aborted(word, moves)))
            .map(|one| one.join().unwrap())
    });
}

/// The run of a watched rig ends by this signal after so many moves; the rig holds itself, and the run goes on.
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
        run.told.lines().last()
    );
    let (done, asked) = (stage.moves().len(), stage.requests().len());
    // What is on the line after the end of the program is nothing; the rig trips its watchdog alone.
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

/// How many threads a run starts.
fn threads_of_a_run() -> usize {
    let stage = Stage::new();
    let told = stage.path("threads");
    let mut command = Command::new("strace");
    command
        .args(["-f", "-e", "trace=clone3", "-o"])
        .arg(&told)
        .arg(PSD);
    stage.run_arguments(&mut command, &["--yes"]);
    assert_eq!(wait(&mut command).code, Some(0));
    std::fs::read_to_string(told)
        .expect("what strace saw")
        .matches("clone3(")
        .count()
}

/// The run, where the n-th thread cannot be started: the standard library panics, but what can do without goes on.
fn without_thread(stage: &Stage, number: usize) -> Ended {
    let mut command = Command::new("strace");
    command.args(["-f", "-o", "/dev/null", "-e", "trace=clone3,clone"]);
    command.args([
        "-e",
        &format!("inject=clone3:error=EAGAIN:when={number}"),
        PSD,
    ]);
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
            ran.code == Some(101) && ran.told.contains("panicked"),
            "{number}: {:?}",
            ran.told.lines().last()
        );
        if stage.moves().is_empty() {
            before += 1;
            continue;
        }
        // The run had ended, and its record was whole.
        after += 1;
        assert_eq!(stage.moves().len(), 42, "{number}");
        // What the panic cost is made again from the record.
        let again = wait(
            Command::new(PSD)
                .arg("report")
                .arg(stage.path("run"))
                .arg("--out")
                .arg(stage.path("again")),
        );
        assert_eq!(again.code, Some(0), "{number}: {}", again.told);
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
