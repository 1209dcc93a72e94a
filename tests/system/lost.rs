//! The rig disappears: it hangs up, restarts, or reads no more bytes. The program ends soon without using processor time. The
//! target of unknown state is in the run log, and the run is resumed when the rig is back.

use rustix::process::{Signal, WaitOptions, waitpid};

use crate::stage::{Stage, finish, let_it_trip, signal, start, wait, watched};
use crate::terminal::{RELEASE, Terminal};

#[test]
fn it_hangs_up() {
    for script in [
        "after 3 moves: hang up",
        "after 12 moves: hang up before reply",
        "after 25 moves: hang up after reply",
    ] {
        let stage = Stage::of(str::to_owned, script);
        let ran = wait(&mut stage.run_with(&["--yes"]));
        assert_eq!(ran.code, Some(3), "{script}: {}", ran.output);
        // psd neither waits for it nor polls it again.
        assert!(
            ran.output.contains("connection lost") && !ran.output.contains("no usable answer"),
            "{script}: {}",
            ran.output
        );
        // The same rig, not power-cycled: only its line was closed.
        stage.goes_on(&[]);
        let mut moves = stage.moves();
        let count = moves.len();
        moves.dedup();
        assert_eq!(moves.len(), count, "{script}: {moves:?}");
    }
}

#[test]
fn one_that_was_restarted_since_must_be_referenced_first() {
    let mut stage = Stage::of(str::to_owned, "after 1 moves: hang up");
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    stage.power_up("");
    let refused = wait(&mut stage.resume_with(&[]));
    assert_eq!(refused.code, Some(3), "{}", refused.output);
    assert!(
        refused.output.contains("restarted") && refused.output.contains("--re-referenced"),
        "{}",
        refused.output
    );
    assert!(stage.moves().is_empty());
}

#[test]
fn a_rig_that_was_referenced_again_resumes_at_its_position() {
    // Without motion enable: at rest and at zero, the position after a restart of the rig too.
    let mut stage = Stage::new();
    let mut terminal = Terminal::start(&mut stage.run_with(&[]));
    terminal.answer(RELEASE, "n\n");
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    stage.power_up("");
    let refused = wait(&mut stage.resume_with(&[]));
    assert!(
        refused.code == Some(3) && refused.output.contains("--re-referenced"),
        "{}",
        refused.output
    );
    stage.goes_on(&["--re-referenced"]);
}

#[test]
fn it_restarts_in_the_middle() {
    let stage = Stage::of(str::to_owned, "after 10 moves: reboot");
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    assert!(ran.output.contains("restarted"), "{}", ran.output);
    let moves = stage.moves().len();
    for (given, expected) in [
        (&[][..], "--re-referenced"),
        (&["--re-referenced"][..], "not referenced"),
    ] {
        let refused = wait(&mut stage.resume_with(given));
        assert_eq!(refused.code, Some(3), "{}", refused.output);
        assert!(refused.output.contains(expected), "{}", refused.output);
        assert_eq!(stage.moves().len(), moves, "nothing moved");
    }
}

#[test]
fn it_takes_no_byte_any_more() {
    let stage = Stage::of(str::to_owned, "after 10 moves: stop reading");
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(3), "{}", ran.output);
}

#[test]
fn the_program_was_away_for_longer_than_the_watchdog() {
    let stage = Stage::of(watched, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(10);
    signal(&run, Signal::STOP);
    waitpid(
        Some(rustix::process::Pid::from_child(&run)),
        WaitOptions::UNTRACED,
    )
    .unwrap();
    let_it_trip();
    let moves = stage.moves().len();
    signal(&run, Signal::CONT);
    let run = finish(run);
    assert_eq!(run.code, Some(3), "{}", run.output);
    assert_eq!(stage.moves().len(), moves, "it did not go on by itself");
    stage.goes_on(&[]);
}
