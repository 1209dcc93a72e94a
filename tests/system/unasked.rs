//! A rig moves after a stop, and before a run is resumed, only with the operator's confirmation. In: operators who stop, leave
//! and come back; rigs that are moved by hand meanwhile or receive nothing. Out: the moves of a rig emulator and the messages
//! to the operator.

use std::fs;
use std::process::Command;

use rustix::process::Signal;

use crate::stage::{Ended, Stage, code, finish, signal, start, until, wait};
use crate::terminal::{GO_ON, LEAVE, RELEASE, TO_UNLOAD, Terminal, UNLOAD};

/// Inspected at its loaded position.
fn unloading(plan: &str) -> String {
    let plan = plan.replace("safe_state = hold", "safe_state = unload");
    let plan = plan.replace(
        "inspect look {",
        "move out { to = 0.2 mm }\n\ninspect look {",
    );
    plan.replace("impact hit {", "move back { to = 0 mm }\n\nimpact hit {")
}

/// A move takes ten seconds and more: the test does not wait for its end.
fn slow(plan: &str) -> String {
    plan.replace(
        "speed      = 20 mm/s",
        "speed      = 0.05 mm/s\n  resolution = 1 um",
    )
    .replace("probe(0.1 mm", "probe(0.02 mm")
}

/// At the inspection of the specimen, with the rig at the loaded position.
fn at_the_look(stage: &Stage, with_screen: bool) -> Terminal {
    let command = &mut stage.run_with(&[]);
    let mut terminal = if with_screen {
        Terminal::with_screen(command)
    } else {
        Terminal::start(command)
    };
    if with_screen {
        terminal.drawn("type RELEASE");
        terminal.press("RELEASE\r");
        until("the way to the look", || {
            stage
                .moves()
                .last()
                .is_some_and(|last| last.ends_with(" to 0.0002"))
        });
        terminal.drawn("type RELEASE");
    } else {
        terminal.answer(RELEASE, "RELEASE\n");
        terminal.answer(GO_ON, "");
    }
    terminal
}

/// It is at its hold position, the run log is valid, and the run is resumed from there.
fn held_and_goes_on(stage: &Stage, moves: &[String], ran: &Ended) {
    assert_eq!(
        stage.moves(),
        moves,
        "nothing moved unasked: {}",
        ran.output
    );
    stage.held_and_sound(ran);
    assert!(
        !fs::read_to_string(stage.journal())
            .unwrap()
            .contains("unloading to where the run began")
    );
    stage.goes_on(&[]);
}

#[test]
fn a_rig_that_may_unload_is_held_without_a_yes() {
    // `--yes` releases a rig; it does not unload after a stop.
    let stage = Stage::of(unloading, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(6);
    signal(&run, Signal::INT);
    let ran = finish(run);
    let moves = stage.moves();
    assert!(
        ran.output.contains("HELD at ") && ran.output.contains("to resume: psd resume "),
        "{}",
        ran.output
    );
    held_and_goes_on(&stage, &moves, &ran);
    let all: [(&str, &[(&str, &str)]); 6] = [
        (
            "n\n",
            &[(TO_UNLOAD, "u\n"), (UNLOAD, "n\n"), (LEAVE, "x\n")],
        ),
        ("n\n", &[(TO_UNLOAD, "u\n"), (UNLOAD, "\u{4}")]),
        ("n\n", &[(LEAVE, "UNLOAD\n"), (LEAVE, "\u{4}")]),
        (
            "\u{3}",
            &[(TO_UNLOAD, "u\n"), (UNLOAD, "n\n"), (LEAVE, "x\n")],
        ),
        ("\u{3}", &[(LEAVE, "\u{3}")]),
        ("\u{4}", &[]),
    ];
    for (looked, then) in all {
        let stage = Stage::of(unloading, "");
        let mut terminal = at_the_look(&stage, false);
        let moves = stage.moves();
        if looked == "\u{3}" {
            signal(&terminal.child, Signal::INT);
        } else {
            terminal.press(looked);
        }
        for (question, keys) in then {
            if *keys == "\u{3}" {
                terminal.answer(question, "");
                signal(&terminal.child, Signal::INT);
            } else {
                terminal.answer(question, keys);
            }
        }
        let code = terminal.code();
        held_and_goes_on(
            &stage,
            &moves,
            &Ended {
                code,
                output: terminal.shown(),
            },
        );
    }
}

#[test]
fn a_terminal_that_dies_at_a_look_leaves_the_rig_where_it_is() {
    for with_screen in [true, false] {
        let stage = Stage::of(unloading, "");
        let terminal = at_the_look(&stage, with_screen);
        let moves = stage.moves();
        let (mut child, output) = terminal.dies();
        signal(&child, Signal::HUP);
        let code = code(&mut child);
        held_and_goes_on(&stage, &moves, &Ended { code, output });
    }
}

#[test]
fn a_yes_unloads_and_the_screen_states_that_the_rig_moves() {
    let stage = Stage::of(
        |plan| slow(&unloading(plan)).replace("0.8 mm step 0.1 mm", "0.3 mm step 0.1 mm"),
        "",
    );
    let mut terminal = at_the_look(&stage, true);
    let moves = stage.moves().len();
    terminal.press("n\r");
    terminal.drawn("u unload");
    terminal.press("uy\ryes\rRELEASE\r");
    terminal.drawn("type UNLOAD");
    terminal.press("y\ryes\rRELEASE\r");
    terminal.drawn("type UNLOAD");
    assert_eq!(stage.moves().len(), moves);
    terminal.press("UNLOAD\r");
    terminal.drawn("UNLOADING: THE RIG MOVES");
    terminal.drawn(" x leave");
    terminal.press("x");
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    assert!(
        stage.moves().last().unwrap().ends_with(" to 0"),
        "{:?}",
        stage.moves()
    );
    stage.proven();
}

#[test]
fn a_limit_during_the_motion_unloads_as_planned() {
    let hard = |plan: &str| {
        unloading(plan)
            .replace("velocity = 0.1 m/s", "velocity = 0.4 m/s")
            .replace("-5 mm .. 10 mm", "-5 mm .. 0.9 mm")
    };
    let stage = Stage::of(hard, "");
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert!(
        ran.code == Some(4) && ran.output.contains("is outside its limit"),
        "{}",
        ran.output
    );
    assert!(
        stage.moves().last().unwrap().ends_with(" to 0"),
        "{:?}",
        stage.moves()
    );
    assert!(
        ran.output.contains("unloading to where the run began"),
        "{}",
        ran.output
    );
    stage.proven();
}

#[test]
fn a_rig_that_was_moved_by_hand_is_not_gone_on_with() {
    let stage = Stage::of(slow, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    std::thread::sleep(std::time::Duration::from_millis(500));
    signal(&run, Signal::INT);
    std::thread::sleep(std::time::Duration::from_millis(100));
    signal(&run, Signal::INT);
    let ran = finish(run);
    assert!(
        ran.code == Some(4) && ran.output.contains("HELD at "),
        "{}",
        ran.output
    );
    let journal = fs::read(stage.journal()).unwrap();
    assert_eq!(
        String::from_utf8_lossy(&journal).matches(" HELD {").count(),
        1
    );
    let folder = stage.path("jogged");
    let jogged = [
        "--operator",
        "A. Tester",
        "--to",
        "0 mm",
        "--yes",
        "--out",
        folder.to_str().unwrap(),
    ];
    assert_eq!(wait(&mut stage.tool("jog", &jogged)).code, Some(0));
    let moves = stage.moves();
    let refused = wait(&mut stage.resume_with(&[]));
    assert!(
        refused.code == Some(3) && refused.output.contains("its last logged position is"),
        "{}",
        refused.output
    );
    assert_eq!(
        stage.moves(),
        moves,
        "it is between where the way began and where it led, and not where it was held"
    );
    assert!(fs::read(stage.journal()).unwrap() == journal);
}

/// `psd resume` with an operator at the terminal.
fn resumed(stage: &Stage) -> Terminal {
    let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
    command.arg("resume").arg(stage.path("run")).args([
        "--operator",
        "B. Tester",
        "--reason",
        "it was interrupted",
    ]);
    Terminal::start(&mut command)
}

#[test]
fn a_resumed_rig_moves_for_somebody_who_lets_it() {
    let stage = Stage::of(slow, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    signal(&run, Signal::INT);
    std::thread::sleep(std::time::Duration::from_millis(100));
    signal(&run, Signal::INT);
    assert_eq!(finish(run).code, Some(4));
    let (moves, journal) = (stage.moves(), fs::read(stage.journal()).unwrap());
    for no in ["n\n", "\u{4}"] {
        let mut terminal = resumed(&stage);
        terminal.answer(RELEASE, "");
        let shown = terminal.shown();
        assert!(
            shown.contains("found at ")
                && shown.contains("last logged at ")
                && shown.contains("it MOVES to 0.1000 mm, then as the plan specifies")
                && shown.contains("speed     up to 0.05000 mm/s; limit"),
            "{shown}"
        );
        assert!(!shown.contains("mm at "), "one speed: {shown}");
        terminal.press(no);
        assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
        until("its last words", || {
            terminal.shown().contains("nothing moved")
        });
        assert_eq!(stage.moves(), moves);
        assert!(
            fs::read(stage.journal()).unwrap() == journal,
            "the record is as it was"
        );
    }
    let mut terminal = resumed(&stage);
    terminal.answer(RELEASE, "i it looks well\n");
    terminal.answer(RELEASE, "RELEASE\n");
    stage.after_moves(moves.len() + 1);
    signal(&terminal.child, Signal::TERM);
    signal(&terminal.child, Signal::TERM);
    let _ = terminal.code();
    let record = fs::read_to_string(stage.journal()).unwrap();
    assert!(
        record.contains(r#""released":"B. Tester: it looks well""#),
        "{record}"
    );
    let verified = stage.verify();
    assert!(verified.code == Some(0), "{}", verified.output);
    let summary = fs::read_to_string(stage.path("run").join("summary.json")).unwrap();
    assert!(
        summary.contains("had been held, and the target was sent again, from "),
        "{summary}"
    );
}

#[test]
fn without_communication_the_operator_is_asked_to_press_the_emergency_stop() {
    let stage = Stage::of(str::to_owned, "after 8 moves: hang up before reply");
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    assert!(
        ran.output.contains("NOT CONFIRMED HELD")
            && ran.output.contains("Press the emergency stop"),
        "{}",
        ran.output
    );
    let verified = stage.verify();
    assert!(verified.code == Some(0), "{}", verified.output);
    let report = fs::read_to_string(stage.path("run").join("report.html")).unwrap();
    assert!(report.contains("NOT CONFIRMED HELD"));
}

#[test]
fn the_help_does_not_swallow_a_hold_and_a_pause_is_one_when_the_rig_rests() {
    let stage = Stage::of(slow, "");
    let mut terminal = Terminal::with_screen(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    terminal.press("p");
    terminal.drawn("PAUSING");
    assert!(!terminal.shown().contains("PAUSED"), "the rig still moves");
    terminal.press("?");
    terminal.drawn("closes");
    terminal.press("h");
    terminal.drawn("x leave");
    terminal.press("x");
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    assert_eq!(stage.moves().len(), 3, "{}", stage.log());
}

#[test]
fn ctrl_c_is_answered_at_once_where_there_is_no_screen() {
    let stage = Stage::of(slow, "");
    let mut terminal = Terminal::start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    signal(&terminal.child, Signal::INT);
    until("a word", || {
        terminal
            .shown()
            .contains("stopping at the end of this step")
    });
    signal(&terminal.child, Signal::INT);
    until("a word", || terminal.shown().contains("holding now"));
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
}
