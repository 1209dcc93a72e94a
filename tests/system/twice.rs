//! Two programs on one run folder, or on one port: the second is refused before it sends anything to the rig.

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
        .args([
            "--rig",
            "bench",
            "--yes",
            "--operator",
            "A. Tester",
            "--out",
        ])
        .arg(stage.path("second"));
    let second = wait(&mut second);
    assert_eq!(second.code, Some(3), "{}", second.output);
    assert!(
        second.output.contains("error:") && second.output.contains("rig"),
        "{}",
        second.output
    );
    assert_eq!(stage.greetings(), greetings, "not even the first word");
    assert!(!stage.path("second").exists(), "nothing is left behind");
    signal(&first, Signal::CONT);
    let first = finish(first);
    assert_eq!(first.code, Some(0), "{}", first.output);
}

#[test]
fn on_one_record() {
    let stage = Stage::new();
    let first = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(8);
    signal(&first, Signal::INT);
    assert_eq!(finish(first).code, Some(4));
    let resumed = start(&mut stage.resume_with(&[]));
    until("the run goes on", || {
        fs::read_to_string(stage.journal())
            .unwrap()
            .contains(" RESUME ")
    });
    signal(&resumed, Signal::STOP);
    let greetings = stage.greetings();
    let second = wait(&mut stage.resume_with(&[]));
    assert_eq!(second.code, Some(3), "{}", second.output);
    assert!(second.output.contains("another psd"), "{}", second.output);
    assert_eq!(stage.greetings(), greetings, "not even the first word");
    signal(&resumed, Signal::CONT);
    let resumed = finish(resumed);
    assert_eq!(resumed.code, Some(0), "{}", resumed.output);
    assert_eq!(stage.verify().code, Some(0));
}

#[test]
fn a_report_and_a_proof_of_a_run_that_is_going_on_are_refused_and_spoil_nothing() {
    let stage = Stage::new();
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(8);
    signal(&run, Signal::STOP);
    for more in [&[][..], &["--out", "elsewhere"]] {
        let report = wait(
            Command::new(PSD)
                .arg("report")
                .arg(stage.path("run"))
                .args(more)
                .current_dir(stage.path("")),
        );
        assert!(
            report.code == Some(3) && report.output.contains("another psd uses"),
            "{}",
            report.output
        );
    }
    let verified = stage.verify();
    assert!(
        verified.code == Some(3) && verified.output.contains("another psd uses"),
        "{}",
        verified.output
    );
    signal(&run, Signal::CONT);
    let ran = finish(run);
    assert_eq!(ran.code, Some(0), "{}", ran.output);
    assert!(!stage.proven().contains("INCOMPLETE") && !stage.path("elsewhere").exists());
}

#[test]
fn foreign_results_are_not_overwritten_and_the_remedy_is_reported() {
    let stage = Stage::new();
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(8);
    fs::write(stage.path("run").join("summary.json"), "{}").unwrap();
    let ran = finish(run);
    assert!(
        ran.code == Some(3) && ran.output.contains("`psd report RUN --out FOLDER`"),
        "{}",
        ran.output
    );
    assert_eq!(
        fs::read(stage.path("run").join("summary.json")).unwrap(),
        b"{}"
    );
    let report = wait(
        Command::new(PSD)
            .arg("report")
            .arg(stage.path("run"))
            .arg("--out")
            .arg(stage.path("anew")),
    );
    assert_eq!(report.code, Some(0), "{}", report.output);
}
