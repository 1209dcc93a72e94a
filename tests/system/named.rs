//! A test on a real rig requires the operator's name. Without a name nothing is opened: the rig receives no byte.

use std::process::Command;

use crate::stage::{Stage, wait};
use crate::terminal::{RELEASE, Terminal};

/// The commands that can move a real rig, started without a name.
fn unnamed(stage: &Stage, more: &[&str]) -> Vec<Command> {
    let mut run = Command::new(crate::stage::PSD);
    run.arg("run")
        .arg(stage.path("plan.psd"))
        .args(["--rig", "bench", "--out"])
        .arg(stage.path("run"))
        .args(more);
    let mut check_run = Command::new(crate::stage::PSD);
    check_run
        .arg("run")
        .arg(stage.path("plan.psd"))
        .args(["--rig", "bench", "--check-run"])
        .args(more);
    let serve = stage.tool(
        "serve",
        &[&["--protocol", "nees", "--listen", "127.0.0.1:0"], more].concat(),
    );
    let jog = stage.tool("jog", &[&["--to", "0.1 mm"], more].concat());
    vec![run, check_run, serve, jog]
}

#[test]
fn where_nobody_can_be_asked_the_name_must_be_given() {
    let stage = Stage::new();
    for more in [&["--yes"][..], &[]] {
        for mut command in unnamed(&stage, more) {
            let ended = wait(&mut command);
            assert_eq!(ended.code, Some(2), "{command:?}: {}", ended.output);
            assert!(
                ended.output.contains("E619") && ended.output.contains("--operator"),
                "{}",
                ended.output
            );
        }
    }
    assert!(
        stage.requests().is_empty() && !stage.path("run").exists(),
        "nothing was opened"
    );
}

#[test]
fn a_blank_name_is_none() {
    let stage = Stage::new();
    for mut command in unnamed(&stage, &["--yes", "--operator", "  "]) {
        let ended = wait(&mut command);
        assert_eq!(ended.code, Some(2), "{}", ended.output);
    }
    assert!(stage.requests().is_empty());
}

#[test]
fn the_plan_may_name_who_it_always_is() {
    let stage = Stage::of(
        |plan| {
            plan.replace(
                "edition     = 1",
                "edition     = 1\n  operator    = \"C. Tester\"",
            )
        },
        "",
    );
    let mut command = Command::new(crate::stage::PSD);
    command
        .arg("run")
        .arg(stage.path("plan.psd"))
        .args(["--rig", "bench", "--yes", "--out"])
        .arg(stage.path("run"));
    let ended = wait(&mut command);
    assert_eq!(ended.code, Some(0), "{}", ended.output);
    let header = std::fs::read_to_string(stage.journal()).unwrap();
    assert!(
        header
            .lines()
            .next()
            .unwrap()
            .contains("\"operator\":\"C. Tester\""),
        "{header}"
    );
}

#[test]
fn at_a_terminal_the_name_is_asked_for_before_anything_is_opened() {
    let stage = Stage::new();
    for mut command in unnamed(&stage, &[]) {
        let mut terminal = Terminal::start(&mut command);
        terminal.answer("name of the operator?", "  \n");
        terminal.answer("at most 200 characters", "\u{4}");
        assert_eq!(terminal.code(), Some(2), "{}", terminal.shown());
    }
    assert!(stage.requests().is_empty() && !stage.path("run").exists());
    let [mut run, ..] = <[Command; 4]>::try_from(unnamed(&stage, &[])).unwrap();
    let mut terminal = Terminal::start(&mut run);
    terminal.answer("name of the operator?", "D. Tester\n");
    terminal.answer(RELEASE, "n\n");
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    let record = std::fs::read_to_string(stage.journal()).unwrap();
    let named = record
        .lines()
        .filter(|line| line.contains("D. Tester"))
        .count();
    assert!(
        named >= 2 && record.lines().next().unwrap().contains("D. Tester"),
        "in the header and at the answer: {record}"
    );
}
