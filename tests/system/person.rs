//! The operator stops the run: Ctrl-C once and twice, a closed terminal, no operator to answer. The rig is held, the run log is
//! valid, and the run is resumed later.

use std::fs;

use rustix::process::Signal;

use crate::stage::{Ended, Stage, finish, signal, start, until, wait};
use crate::terminal::{GO_ON, RELEASE, Terminal};

/// Held, logged, and resumed.
fn held_and_sound(stage: &Stage, ran: &Ended) {
    stage.held_and_sound(ran);
    stage.goes_on(&[]);
}

#[test]
fn the_second_holds_at_once() {
    // A step takes ten seconds at this speed: the test does not wait for its end.
    let slow = |plan: &str| {
        plan.replace(
            "speed      = 20 mm/s",
            "speed      = 0.01 mm/s\n  resolution = 1 um",
        )
        .replace("probe(0.1 mm", "probe(0.02 mm")
    };
    let stage = Stage::of(slow, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    signal(&run, Signal::INT);
    // Two simultaneous signals can count as one.
    std::thread::sleep(std::time::Duration::from_millis(100));
    signal(&run, Signal::INT);
    let ran = finish(run);
    assert_eq!(ran.code, Some(4), "{}", ran.output);
    assert_eq!(stage.moves().len(), 3, "{}", stage.log());
    assert!(
        stage
            .requests()
            .iter()
            .any(|request| request.contains('!') || request.contains(">STOP"))
    );
    let journal = fs::read_to_string(stage.journal()).unwrap();
    assert_eq!(
        journal.matches(" STEP ").count(),
        0,
        "held on its way, not at its end"
    );
}

#[test]
fn the_end_of_the_input_is_no_yes() {
    let stage = Stage::new();
    let mut terminal = Terminal::start(&mut stage.run_with(&[]));
    // The rig is released; the question about the specimen is not answered.
    terminal.answer(RELEASE, "RELEASE\n");
    terminal.answer(GO_ON, "\u{4}");
    let code = terminal.code();
    held_and_sound(
        &stage,
        &Ended {
            code,
            output: terminal.shown(),
        },
    );
}

#[test]
fn a_terminal_that_goes_away_is_no_yes() {
    let stage = Stage::new();
    let mut terminal = Terminal::start(&mut stage.run_with(&[]));
    terminal.answer(RELEASE, "RELEASE\n");
    terminal.answer(GO_ON, "");
    signal(&terminal.child, Signal::HUP);
    let code = terminal.code();
    held_and_sound(
        &stage,
        &Ended {
            code,
            output: terminal.shown(),
        },
    );
}

#[test]
fn a_truncated_record_is_reported() {
    let stage = Stage::new();
    assert_eq!(wait(&mut stage.run_with(&["--yes"])).code, Some(0));
    let whole = fs::read_to_string(stage.journal()).unwrap();
    assert!(!stage.verify().output.contains("INCOMPLETE"));
    let mut cut: Vec<&str> = whole.lines().collect();
    cut.pop();
    fs::write(stage.journal(), cut.join("\n") + "\n").unwrap();
    // Only the run log: the manifest would show the change anyway.
    fs::remove_file(stage.path("run").join("manifest.sha256")).unwrap();
    let verified = stage.verify();
    assert!(
        verified.output.contains("INCOMPLETE") || verified.output.contains("WRONG"),
        "{}",
        verified.output
    );
    cut.truncate(60);
    fs::write(stage.journal(), cut.join("\n") + "\n").unwrap();
    let verified = stage.verify();
    assert!(
        verified.output.contains("INCOMPLETE"),
        "{}",
        verified.output
    );
}

/// Waits until the run pauses for longer than a step takes on a busy machine.
fn standing(stage: &Stage) -> usize {
    loop {
        let before = stage.moves().len();
        std::thread::sleep(std::time::Duration::from_secs(2));
        if stage.moves().len() == before {
            return before;
        }
    }
}

#[test]
fn the_first_key_after_the_window_got_another_size_holds_the_rig() {
    // A step takes ten seconds at this speed: the test does not wait for its end.
    let slow = |plan: &str| {
        plan.replace(
            "speed      = 20 mm/s",
            "speed      = 0.01 mm/s\n  resolution = 1 um",
        )
        .replace("probe(0.1 mm", "probe(0.02 mm")
    };
    for (keys, resized) in [("h", true), ("\u{3}\u{3}", true), ("h", false)] {
        let stage = Stage::of(slow, "");
        let mut terminal = Terminal::with_screen(&mut stage.run_with(&["--yes"]));
        stage.after_moves(3);
        if resized {
            terminal.resize(110);
            terminal.redrawn("hold now");
        }
        terminal.press(keys);
        terminal.drawn("x leave");
        terminal.press("x");
        let code = terminal.code();
        assert_eq!(code, Some(4), "{}", terminal.shown());
        assert_eq!(stage.moves().len(), 3, "{}", stage.log());
        let journal = fs::read_to_string(stage.journal()).unwrap();
        assert_eq!(
            journal.matches(" STEP ").count(),
            0,
            "held on its way, not at its end"
        );
    }
}

#[test]
fn a_key_ends_a_monitor_whose_window_got_another_size() {
    let stage = Stage::new();
    for key in ["q", "\u{3}"] {
        let mut terminal = Terminal::with_screen(&mut stage.tool("monitor", &["--every", "20 ms"]));
        until("the screen", || terminal.shown().contains("MONITOR"));
        terminal.resize(110);
        terminal.redrawn("MONITOR");
        terminal.press(key);
        assert_eq!(terminal.code(), Some(0), "{}", terminal.shown());
    }
}

#[test]
fn a_run_is_paused_stepped_noted_and_resumed_by_keys() {
    let stage = Stage::new();
    let mut terminal = Terminal::with_screen(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    terminal.press("p");
    terminal.drawn("PAUSED");
    let paused = standing(&stage);
    terminal.press("s");
    until("one step", || stage.moves().len() > paused);
    assert_eq!(standing(&stage), paused + 1, "one step, and no more");
    terminal.press("ino crack\r");
    terminal.press("p");
    assert_eq!(terminal.code(), Some(0), "{}", terminal.shown());
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(stage.path("run").join("summary.json")).unwrap()).unwrap();
    let events: Vec<&str> = summary["events"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|event| event["text"].as_str())
        .collect();
    let position = |text: &str| events.iter().position(|event| *event == text);
    let positions = [
        "paused (A. Tester)",
        "no crack (A. Tester)",
        "went on (A. Tester)",
    ]
    .map(position);
    assert!(
        positions.is_sorted() && positions.iter().all(Option::is_some),
        "{events:#?}"
    );
    assert!(!stage.proven().contains("INCOMPLETE"));
}
