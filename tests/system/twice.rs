//! Two programs on one record, or on one port: the second is refused before it has said anything to the rig.

use std::fs;
use std::process::Command;

use rustix::process::Signal;

use crate::stage::{PSD, Stage, finish, signal, start, until, wait};

#[test]
fn on_one_port() {
    let stage = Stage::new();
    let first = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(5);
    signal(&first, Signal::STOP);
    let greetings = stage.greetings();
    let mut second = Command::new(PSD);
    second
        .arg("run")
        .arg(stage.path("plan.psd"))
        .args(["--rig", "bench", "--yes", "--operator", "A. Tester", "--out"])
        .arg(stage.path("second"));
    let second = wait(&mut second);
    assert_eq!(second.code, Some(3), "{}", second.told);
    assert!(second.told.contains("error:") && second.told.contains("rig"), "{}", second.told);
    assert_eq!(stage.greetings(), greetings, "not even the first word");
    assert!(!stage.path("second").exists(), "nothing is left behind");
    signal(&first, Signal::CONT);
    let first = finish(first);
    assert_eq!(first.code, Some(0), "{}", first.told);
}

#[test]
fn on_one_record() {
    let stage = Stage::new();
    let first = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(8);
    signal(&first, Signal::INT);
    assert_eq!(finish(first).code, Some(4));
    let resumed = start(&mut stage.resume_with(&[]));
    until("the run goes on", || fs::read_to_string(stage.journal()).unwrap().contains(" RESUME "));
    signal(&resumed, Signal::STOP);
    let greetings = stage.greetings();
    let second = wait(&mut stage.resume_with(&[]));
    assert_eq!(second.code, Some(3), "{}", second.told);
    assert!(second.told.contains("another psd"), "{}", second.told);
    assert_eq!(stage.greetings(), greetings, "not even the first word");
    signal(&resumed, Signal::CONT);
    let resumed = finish(resumed);
    assert_eq!(resumed.code, Some(0), "{}", resumed.told);
    assert_eq!(stage.verify().code, Some(0));
}
