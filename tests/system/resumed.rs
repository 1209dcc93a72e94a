//! Resuming on a rig that cannot verify its state: it has no boot identifier, or it is in hold. In: rigs with such protocols.
//! Out: a run that is resumed after the operator's confirmation, which is logged. A refusal leaves the run log unchanged.

use std::fs;
use std::io::Write as _;
use std::process::Command;

use rustix::process::Signal;

use crate::stage::{Ended, PSD, Stage, finish, signal, start, until, wait};
use crate::terminal::{LEAVE, RELEASE, TO_UNLOAD, Terminal, UNLOAD};

/// A stepper frame with an indicator beside it.
fn stepper(plan: &str) -> String {
    let (before, port) = plan.split_once("  link       = serial(port: \"").unwrap();
    let (port, after) = port
        .split_once("\", dialect: native, reply_timeout: 2 s)")
        .unwrap();
    let devices = format!(
        "  actuator   = serial(port: \"{port}\", dialect: grbl, reply_timeout: 3 s)\n  \
           load_cell  = serial(port: \"{port}-cell\", dialect: indicator, reply_timeout: 3 s)\n  \
           polarity       = negative\n  \
           datum      = here"
    );
    let plan = format!("{before}{devices}{after}").replace("duration  = 24 ms", "duration  = 3 ms");
    let plan = plan.replace("samples    = 1", "samples    = 1\n  resolution = 2.5 um");
    // Every step of the ramp takes a second: a signal comes before its end.
    plan.replace("0.8 mm step 0.1 mm", "0.3 mm step 0.1 mm")
        .replace("pause         = 0 s", "pause         = 1 s")
        .replace("probe(0.1 mm", "probe(0.4 mm")
}

/// A hold as sent by a dying program, or by another program at the port.
fn hold(stage: &Stage) {
    // Open until it was received: at a close the kernel discards the last bytes.
    let mut port = fs::OpenOptions::new()
        .write(true)
        .open(stage.path("rig"))
        .unwrap();
    port.write_all(b"!").unwrap();
    until("it is held", || {
        stage
            .requests()
            .last()
            .is_some_and(|request| request.contains('!'))
    });
}

/// Refused for this reason, and the run log is unchanged.
fn refused(stage: &Stage, more: &[&str], reason: &str) {
    let before = fs::read(stage.journal()).unwrap();
    let refused = wait(&mut stage.resume_with(more));
    assert!(
        refused.code == Some(3) && refused.output.contains(reason),
        "{}",
        refused.output
    );
    assert!(
        fs::read(stage.journal()).unwrap() == before,
        "the record is as it was: {more:?}"
    );
}

fn report(stage: &Stage) -> String {
    fs::read_to_string(stage.path("run").join("report.html")).unwrap()
}

#[test]
fn a_stepper_frame_that_was_stopped_is_let_go_of_and_goes_on() {
    let stage = Stage::of(stepper, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(6);
    signal(&run, Signal::INT);
    let ran = finish(run);
    assert_eq!(ran.code, Some(4), "{}", ran.output);
    let moves = stage.moves();
    refused(&stage, &[], "--same-power-up");
    hold(&stage);
    refused(&stage, &["--same-power-up"], "`--let-go`");
    refused(&stage, &["--let-go"], "--same-power-up");
    assert_eq!(stage.moves(), moves, "to be let go of moves nothing");
    let ran = stage.goes_on(&["--same-power-up", "--let-go"]);
    assert!(
        !ran.output.contains("ignored"),
        "no answer of several lines is a fault of the line: {}",
        ran.output
    );
    let mut all = stage.moves();
    let count = all.len();
    all.dedup();
    assert!(count > moves.len() && all.len() == count, "{all:?}");
    for word in [
        "it was not power-cycled since",
        "its hold was cleared, and it did not move",
    ] {
        assert!(report(&stage).contains(word), "{word}");
    }
}

#[test]
fn a_jog_lets_go_too_and_a_new_run_begins() {
    let stage = Stage::of(stepper, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(6);
    signal(&run, Signal::INT);
    assert_eq!(finish(run).code, Some(4));
    hold(&stage);
    fs::rename(stage.path("run"), stage.path("first")).unwrap();
    let held = wait(&mut stage.run_with(&["--yes"]));
    assert!(
        held.code == Some(3) && held.output.contains("`--let-go`"),
        "{}",
        held.output
    );
    let _ = fs::remove_dir_all(stage.path("run"));
    // Its specimen is loaded: the zero offset is that of the run that loaded it.
    let first = stage.path("first");
    let back = [
        "--datum",
        first.to_str().unwrap(),
        "--to",
        "0 mm",
        "--yes",
        "--let-go",
    ];
    let jog = wait(&mut stage.recorded_tool("jog", &back));
    assert_eq!(jog.code, Some(0), "{}", jog.output);
    let record = fs::read_to_string(stage.journal()).unwrap();
    assert!(
        record.contains("the hold was cleared, and the rig did not move (A. Tester)"),
        "{record}"
    );
    stage.proven();
    fs::rename(stage.path("run"), stage.path("second")).unwrap();
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(0), "{}", ran.output);
    assert!(!ran.output.contains("ignored"), "{}", ran.output);
}

/// Stopped at rest and at zero, the position of a console after a power cycle too.
fn stopped_at_zero() -> Stage {
    let console = |plan: &str| {
        let plan = plan.replace(
            "dialect: native, reply_timeout: 2 s",
            "dialect: instron, reply_timeout: 3 s",
        );
        plan.replace("samples    = 1", "samples    = 1\n  resolution = 1 um")
            .replace("0.8 mm step", "0.3 mm step")
    };
    let stage = Stage::of(console, "");
    let mut terminal = Terminal::start(&mut stage.run_with(&[]));
    terminal.answer(RELEASE, "n\n");
    let code = terminal.code();
    assert_eq!(code, Some(4), "{}", terminal.shown());
    stage
}

#[test]
fn a_console_that_was_switched_off_meanwhile_does_not_go_on_unsaid() {
    let said = |word: &str, expected: &str| {
        let mut stage = stopped_at_zero();
        stage.power_up("");
        refused(&stage, &[], "cannot report whether it was power-cycled");
        assert!(stage.moves().is_empty(), "nothing moved");
        let resumed: Ended = stage.goes_on(&[word]);
        assert!(report(&stage).contains(expected), "{}", resumed.output);
    };
    std::thread::scope(|scope| {
        scope.spawn(|| said("--re-referenced", "it was referenced again"));
        said("--same-power-up", "it was not power-cycled since");
    });
}

#[test]
fn a_rig_that_is_not_there_leaves_the_record_as_it_was() {
    let mut stage = Stage::new();
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(10);
    signal(&run, Signal::INT);
    assert_eq!(finish(run).code, Some(4));
    stage.power_down();
    let other = stage.path("other.psd");
    let plan = fs::read_to_string(stage.path("plan.psd"))
        .unwrap()
        .replace("inspect the specimen", "inspect it");
    fs::write(&other, plan).unwrap();
    refused(
        &stage,
        &["--plan", other.to_str().unwrap(), "--amend"],
        "rig",
    );
    refused(&stage, &[], "rig");
    assert_eq!(stage.verify().code, Some(0));
}

#[test]
fn a_rig_whose_safe_state_is_unload_goes_back_and_its_run_is_over() {
    let stage = Stage::of(
        |plan| plan.replace("safe_state = hold", "safe_state = unload"),
        "",
    );
    let mut terminal = Terminal::start(&mut stage.run_with(&[]));
    terminal.answer(RELEASE, "RELEASE\n");
    stage.after_moves(6);
    signal(&terminal.child, Signal::INT);
    terminal.answer(TO_UNLOAD, "u\n");
    terminal.answer(UNLOAD, "UNLOAD\n");
    // After unloading it is neither unloaded again nor resumed.
    terminal.answer(LEAVE, "x\n");
    assert_eq!(
        terminal.shown().matches(TO_UNLOAD).count(),
        1,
        "{}",
        terminal.shown()
    );
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    let summary = fs::read_to_string(stage.path("run").join("summary.json")).unwrap();
    assert!(
        summary.contains("unloading to where the run began"),
        "{summary}"
    );
    let moves = stage.moves();
    assert!(
        moves.len() > 6 && moves.last().unwrap().ends_with(" to 0"),
        "{moves:?}"
    );
    assert!(stage.proven().contains("INCOMPLETE"));
    refused(
        &stage,
        &[],
        "the specimen was unloaded when the run stopped",
    );
    assert_eq!(stage.moves(), moves);
}

#[test]
fn a_run_that_came_to_its_end_without_its_results_has_them_made_of_its_record() {
    let stage = Stage::new();
    let ran = wait(&mut stage.run_with(&["--yes"]));
    assert_eq!(ran.code, Some(0), "{}", ran.output);
    refused(&stage, &[], "the run is complete");
    let run = stage.path("run");
    let whole = fs::read(run.join("summary.json")).unwrap();
    // The files of a program that was killed while it wrote them: some are missing, and the last one is incomplete.
    for file in ["manifest.sha256", "report.html"] {
        fs::remove_file(run.join(file)).unwrap();
    }
    fs::write(run.join("summary.json"), &whole[..whole.len() / 2]).unwrap();
    refused(&stage, &[], "`psd report");
    let report = || wait(Command::new(PSD).arg("report").arg(&run));
    let made = report();
    assert_eq!(made.code, Some(0), "{}", made.output);
    assert!(
        fs::read(run.join("summary.json")).unwrap() == whole
            && !stage.proven().contains("INCOMPLETE")
    );
    let again = report();
    assert!(
        again.code == Some(3) && again.output.contains("has results already"),
        "{}",
        again.output
    );
}

#[test]
fn a_restart_on_record_is_outweighed_by_nobodys_word_that_there_was_none() {
    let stage = Stage::of(stepper, "after 5 moves: reboot");
    let run = wait(&mut stage.run_with(&["--yes"]));
    assert!(
        run.code == Some(3) && run.output.contains("restarted"),
        "{}",
        run.output
    );
    refused(
        &stage,
        &["--same-power-up"],
        "the run log shows that the rig restarted",
    );
    refused(
        &stage,
        &["--same-power-up", "--let-go"],
        "the run log shows that the rig restarted",
    );
}
