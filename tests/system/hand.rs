//! Manual operation of a rig: `psd rig monitor` and `jog` with a rig emulator behind a pseudo-terminal. The emulator's log of
//! all bytes shows the motion, and `psd verify` verifies the run log.

use std::io::{BufRead as _, BufReader};
use std::process::Stdio;

use rustix::process::Signal;

use crate::stage::{Stage, code, finish, signal, start, until, wait, watched};
use crate::terminal::{MOVE, Terminal};

#[test]
fn a_monitor_ends_with_its_reader_and_with_each_signal() {
    let stage = Stage::new();
    let mut monitor = stage
        .tool("monitor", &["--every", "20 ms"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(monitor.stdout.take().unwrap()).lines();
    let three: Vec<String> = lines.by_ref().take(3).map(Result::unwrap).collect();
    assert_eq!(three[0], "time_s,displacement_m,force_n");
    // As with `| head -n 3`.
    drop(lines);
    assert_eq!(code(&mut monitor), Some(0));
    for sent in [Signal::INT, Signal::TERM, Signal::HUP] {
        let heard = stage.requests().len();
        let monitor = start(&mut stage.tool("monitor", &[]));
        until("readings are asked for", || {
            stage.requests().len() > heard + 5
        });
        signal(&monitor, sent);
        let ended = finish(monitor);
        assert_eq!(ended.code, Some(0), "{}", ended.output);
    }
    assert!(stage.moves().is_empty());
}

#[test]
fn a_rig_that_falls_silent_ends_the_monitor_and_is_reported() {
    let stage = Stage::of(watched, "after 12 replies: drop replies for ever");
    let ended = wait(&mut stage.tool("monitor", &["--every", "20 ms"]));
    assert_eq!(ended.code, Some(3), "{}", ended.output);
    assert!(
        ended.output.contains("no usable answer within"),
        "{}",
        ended.output
    );
    assert!(
        ended.output.contains("time_s,displacement_m,force_n\n0."),
        "what was read before is given: {}",
        ended.output
    );
}

#[test]
fn a_target_beyond_a_limit_is_refused_before_any_byte_is_sent() {
    // Ten increments would be inside the limit and the eleventh beyond it: none is executed.
    let stage = Stage::of(
        |plan| {
            plan.replace(
                "speed        = 200 mm/s",
                "speed        = 200 mm/s\n  increment    = 1 mm",
            )
        },
        "",
    );
    for (more, expected) in [
        (
            &["--to", "10.001 mm"][..],
            "target displacement 10.001 mm is outside its limit -5 mm .. 10 mm",
        ),
        (
            &["--to", "-5.001 mm"],
            "target displacement -5.001 mm is outside its limit",
        ),
        (
            &["--to", "0.1 mm", "--speed", "0.201 m/s"],
            "speed 0.201 m/s is outside its limit",
        ),
    ] {
        let ended = wait(&mut stage.recorded_tool("jog", &[more, &["--yes"]].concat()));
        assert!(
            ended.code == Some(4) && ended.output.contains(expected),
            "{}",
            ended.output
        );
        assert!(
            stage.proven().contains("all 0 recomputed"),
            "the refusal is on record"
        );
        std::fs::remove_dir_all(stage.path("run")).unwrap();
    }
    assert!(
        stage.moves().is_empty()
            && !stage
                .requests()
                .iter()
                .any(|request| request.contains(">MOVE"))
    );
}

#[test]
fn a_jog_goes_to_its_target_and_is_logged() {
    let stage = Stage::of(
        |plan| {
            plan.replace(
                "speed        = 200 mm/s",
                "speed        = 200 mm/s\n  increment    = 1 mm",
            )
        },
        "",
    );
    let ended =
        wait(&mut stage.recorded_tool("jog", &["--to", "2.5 mm", "--speed", "25 mm/s", "--yes"]));
    assert_eq!(ended.code, Some(0), "{}", ended.output);
    assert!(
        ended.output.contains("X 2.500 mm   R 250.0 N"),
        "{}",
        ended.output
    );
    assert_eq!(stage.moves().len(), 3, "increments of at most 1 mm");
    assert!(
        stage
            .proven()
            .contains("all 3 recomputed, bit-identical, and 3 steps")
    );
    let record = std::fs::read_to_string(stage.journal()).unwrap();
    for expected in [
        "\"served\":\"by hand\"",
        "MOVE from 0 mm to 2.5 mm at 25 mm/s? answered by --yes (A. Tester)",
    ] {
        assert!(record.contains(expected), "{expected} in {record}");
    }
    let table = std::fs::read_to_string(stage.path("run").join("tables/served.csv")).unwrap();
    assert_eq!(table.lines().count(), 4, "{table}");
    assert!(
        stage
            .requests()
            .iter()
            .any(|request| request.contains(" 25.000000*")),
        "at the speed that was asked for"
    );
}

#[test]
fn a_jog_counts_from_the_zero_of_the_run_that_loaded_the_specimen() {
    let here = |plan: &str| {
        plan.replace(
            "safe_state = hold",
            "safe_state = hold\n  datum      = here",
        )
    };
    let stage = Stage::of(here, "stands at 3 mm");
    let out = wait(&mut stage.recorded_tool("jog", &["--to", "0.5 mm", "--yes"]));
    assert!(
        out.code == Some(0) && out.output.contains("R 50.00 N"),
        "{}",
        out.output
    );
    let loaded = stage.path("loaded");
    std::fs::rename(stage.path("run"), &loaded).unwrap();
    // The zero reading under load would shift its limits.
    let refused = wait(&mut stage.recorded_tool("jog", &["--to", "0 mm", "--yes"]));
    assert!(
        refused.code == Some(2) && refused.output.contains("the specimen carries 50.00 N"),
        "{}",
        refused.output
    );
    assert_eq!(stage.moves().len(), 1);
    let back = wait(&mut stage.recorded_tool(
        "jog",
        &["--datum", loaded.to_str().unwrap(), "--to", "0 mm", "--yes"],
    ));
    assert_eq!(back.code, Some(0), "{}", back.output);
    let moves: Vec<String> = stage
        .requests()
        .into_iter()
        .filter(|request| request.contains(">MOVE"))
        .collect();
    assert!(
        moves.len() == 2 && moves[0].contains(" 3.500000 ") && moves[1].contains(" 3.000000 "),
        "{moves:?}"
    );
    assert!(stage.proven().contains("all 1 recomputed"));
}

#[test]
fn only_the_word_moves_and_the_end_of_the_input_is_none() {
    let stage = Stage::new();
    for keys in ["n\n", "\u{4}", "y\nyes\nmove\nRELEASE\n\nn\n"] {
        let mut terminal = Terminal::start(&mut stage.recorded_tool("jog", &["--to", "1 mm"]));
        terminal.answer(MOVE, keys);
        assert_eq!(terminal.code(), Some(4), "{keys:?}: {}", terminal.shown());
        assert!(
            terminal.shown().contains("nothing moved"),
            "{}",
            terminal.shown()
        );
        assert!(stage.proven().contains("all 0 recomputed"));
        // Manual operation is not a run that can be resumed.
        let resumed = wait(&mut stage.resume_with(&[]));
        assert!(
            resumed.code == Some(2) && resumed.output.contains("driven by hand"),
            "{}",
            resumed.output
        );
        std::fs::remove_dir_all(stage.path("run")).unwrap();
    }
    assert!(stage.moves().is_empty());
    let piped = wait(&mut stage.recorded_tool("jog", &["--to", "1 mm"]));
    assert!(
        piped.code == Some(2) && piped.output.contains("no operator can be asked"),
        "{}",
        piped.output
    );
}

#[test]
fn a_jog_session_goes_from_position_to_position() {
    let stage = Stage::new();
    let mut terminal = Terminal::start(&mut stage.recorded_tool("jog", &[]));
    terminal.answer("at 0 mm; target?", "0.5\n");
    terminal.answer("write it as 1 mm", "0.5 mm\n");
    terminal.answer("it MOVES from 0 mm to 0.5 mm", "MOVE\n");
    terminal.answer(MOVE, "MOVE\n");
    terminal.answer("at 0.5 mm; target?", "11 mm\n");
    terminal.answer("refused: target displacement 11 mm", "0 mm\n");
    terminal.answer("it MOVES from 0.5 mm to 0 mm", "");
    terminal.answer(MOVE, "MOVE\n");
    terminal.answer("at 0 mm; target?", "q\n");
    assert_eq!(
        terminal.code(),
        Some(4),
        "one place was refused: {}",
        terminal.shown()
    );
    assert_eq!(stage.moves().len(), 2);
    assert!(stage.proven().contains("all 2 recomputed"));
}

#[test]
fn a_rig_that_falls_silent_ends_the_sitting_and_the_record_is_sound() {
    let stage = Stage::of(watched, "after 1 moves: drop replies for ever");
    let ended = wait(&mut stage.recorded_tool("jog", &["--to", "1 mm", "--yes"]));
    assert!(
        ended.code == Some(3) && ended.output.contains("no usable answer within"),
        "{}",
        ended.output
    );
    assert!(stage.proven().contains("INCOMPLETE"));
}

#[test]
fn ctrl_c_holds_a_jog_whose_move_may_be_over_first() {
    // A tenth of a second. `signals` tests the hold of a jog during its motion.
    let stage = Stage::of(
        |plan| plan.replace("samples    = 1", "samples    = 1\n  resolution = 1 um"),
        "",
    );
    let jog =
        start(&mut stage.recorded_tool("jog", &["--to", "1 mm", "--speed", "10 mm/s", "--yes"]));
    stage.after_moves(1);
    signal(&jog, Signal::INT);
    let ended = finish(jog);
    assert_eq!(ended.code, Some(4), "{}", ended.output);
    assert!(
        ended.output.contains("on request") && stage.is_held(),
        "{}",
        ended.output
    );
    stage.proven();
}
