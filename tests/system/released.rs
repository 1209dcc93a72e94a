//! A rig moves only after its release word, typed after the question was visible. The operator who held a rig can still see it.
//! In: early input, keys at a held rig, a lost line. Out: the moves of a rig emulator and the files of the run folder.

use std::fs;

use rustix::process::Signal;

use crate::stage::{Stage, signal, start, until, wait};
use crate::terminal::{LEAVE, RELEASE, TO_RESUME, TO_UNLOAD, Terminal};

/// All strings that could be read as a yes, and the release word.
const TYPED_AHEAD: &str = "y\nyes\nxyz\nRELEASE\nRELEASE\n";

/// A move takes ten seconds and more: the test does not wait for its end.
fn slow(plan: &str) -> String {
    plan.replace(
        "speed      = 20 mm/s",
        "speed      = 0.05 mm/s\n  resolution = 1 um",
    )
    .replace("probe(0.1 mm", "probe(0.02 mm")
}

#[test]
fn what_was_typed_ahead_releases_nothing_and_a_refusal_leaves_no_report() {
    for with_screen in [false, true] {
        let stage = Stage::new();
        let command = &mut stage.run_with(&[]);
        let mut terminal = if with_screen {
            Terminal::with_screen(command)
        } else {
            Terminal::start(command)
        };
        terminal.press(TYPED_AHEAD);
        until("the question", || terminal.shown().contains("RELEASE:"));
        terminal.press(TYPED_AHEAD);
        if with_screen {
            terminal.drawn("type RELEASE");
            terminal.press("n\r");
        } else {
            terminal.answer(RELEASE, "n\n");
        }
        assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
        assert!(
            stage.moves().is_empty() && stage.is_held(),
            "{}",
            stage.log()
        );
        let shown = terminal.shown();
        for expected in [
            "rig       bench (",
            "travel    ",
            "limits −5 mm .. 10 mm",
            "force     ",
            "speed     ",
            "duration  about ",
        ] {
            assert!(
                with_screen || shown.contains(expected),
                "{expected}: {shown}"
            );
        }
        assert!(
            shown.contains("NOT RELEASED") && !shown.contains("inconclusive"),
            "{shown}"
        );
        let mut left: Vec<String> = fs::read_dir(stage.path("run"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        left.retain(|name| !name.starts_with("journal."));
        assert_eq!(
            left,
            ["manifest.sha256"],
            "the record is kept, and there is nothing to report"
        );
        assert!(
            stage
                .proven()
                .contains("INCOMPLETE: declined by the operator")
        );
        // The release can be given later.
        stage.goes_on(&[]);
    }
}

#[test]
fn a_held_rig_is_stayed_with_in_lines_and_goes_on_from_there() {
    let stage = Stage::of(|plan| slow(plan).replace("0.8 mm step", "0.3 mm step"), "");
    let mut terminal = Terminal::start(&mut stage.run_with(&[]));
    terminal.answer(RELEASE, "RELEASE\n");
    stage.after_moves(3);
    signal(&terminal.child, Signal::QUIT);
    terminal.answer(LEAVE, "");
    let shown = terminal.shown();
    let held = &shown[shown.rfind("  HELD").expect("why it stays")..];
    assert!(
        held.contains("X ")
            && held.contains("R ")
            && held.contains(TO_RESUME)
            && held.contains(TO_UNLOAD),
        "{shown}"
    );
    let heard = stage.requests().len();
    until("the rig is heard from", || {
        stage.requests().len() > heard + 5
    });
    assert_eq!(stage.moves().len(), 3);
    terminal.press("r\n");
    terminal.answer("type the reason", "somebody stood too near\n");
    // The lines of the resumed run come after it.
    terminal.answer(RELEASE, "");
    assert_eq!(stage.moves().len(), 3, "a reason is no release");
    terminal.press("RELEASE\n");
    stage.after_moves(4);
    signal(&terminal.child, Signal::QUIT);
    terminal.answer(LEAVE, "x\n");
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    let record = fs::read_to_string(stage.journal()).unwrap();
    assert!(
        record.contains("somebody stood too near") && record.contains(r#""released":"A. Tester""#),
        "{record}"
    );
    assert!(stage.is_held());
    stage.proven();
}

#[test]
fn a_held_rig_stays_on_the_screen_and_goes_on_from_there() {
    let stage = Stage::of(|plan| slow(plan).replace("0.8 mm step", "0.3 mm step"), "");
    let mut terminal = Terminal::with_screen(&mut stage.run_with(&[]));
    terminal.drawn("type RELEASE");
    terminal.press("RELEASE\r");
    stage.after_moves(3);
    terminal.press("h");
    terminal.drawn("r resume   u unload   x leave");
    let heard = stage.requests().len();
    until("the rig is heard from", || {
        stage.requests().len() > heard + 5
    });
    assert_eq!(stage.moves().len(), 3);
    terminal.press("r");
    terminal.drawn("Enter resume");
    terminal.press("somebody stood too near\r");
    terminal.drawn("type RELEASE");
    assert_eq!(stage.moves().len(), 3, "a reason is no release");
    terminal.press("RELEASE\r");
    stage.after_moves(4);
    terminal.press("h");
    terminal.drawn("r resume   u unload   x leave");
    terminal.press("x");
    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
    let record = fs::read_to_string(stage.journal()).unwrap();
    assert!(
        record.contains("somebody stood too near") && record.contains(r#""released":"A. Tester""#),
        "{record}"
    );
    assert!(stage.is_held());
    stage.proven();
}

#[test]
fn nothing_is_shown_before_or_beside_an_unconfirmed_hold() {
    let stage = Stage::of(str::to_owned, "after 8 moves: hang up before reply");
    let mut terminal = Terminal::with_screen(&mut stage.run_with(&["--yes"]));
    terminal.drawn("I have seen this");
    for expected in ["NOT CONFIRMED HELD", "PRESS THE EMERGENCY STOP"] {
        terminal.drawn(expected);
    }
    terminal.press("xrq\r");
    terminal.drawn("I have seen this");
    terminal.press("a");
    assert_eq!(terminal.code(), Some(3), "{}", terminal.shown());
    let shown = terminal.shown();
    let after = shown.rsplit("\u{1b}[?1049l").next().unwrap();
    assert!(
        after.find("NOT CONFIRMED HELD") < after.find("ERROR"),
        "{after}"
    );
    assert!(
        after.contains("ERROR") && !after.contains("psd resume"),
        "{after}"
    );
    let ran = wait(
        &mut Stage::of(str::to_owned, "after 8 moves: hang up before reply").run_with(&["--yes"]),
    );
    assert!(!ran.output.contains("psd resume"), "{}", ran.output);
}

#[test]
fn reports_of_records_that_differ_have_numbers_that_differ() {
    let stage = Stage::new();
    let number = || {
        let page = fs::read_to_string(stage.path("run").join("report.html")).unwrap();
        let (_, after) = page.split_once("End of report").unwrap();
        after
            .split(['<', '>'])
            .find(|text| text.contains('-') && text.len() > 20)
            .unwrap()
            .to_owned()
    };
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(10);
    crate::stage::signal(&run, rustix::process::Signal::INT);
    assert_eq!(crate::stage::finish(run).code, Some(4));
    let stopped = number();
    stage.goes_on(&[]);
    let ended = number();
    assert_ne!(stopped, ended, "the same run, and another record of it");
    assert_eq!(stopped.split('-').next(), ended.split('-').next());
}

#[test]
fn the_release_prompt_names_an_overdue_calibration() {
    for (due, line) in [
        (
            "2020-03-01",
            Some("report    NOT ISSUABLE: the calibration was due on 2020-03-01"),
        ),
        ("2999-12-31", None),
    ] {
        let calibrated = |plan: &str| {
            plan.replace(
                "safe_state = hold",
                &format!("safe_state = hold\n  calibration_due = \"{due}\""),
            )
        };
        let stage = Stage::of(calibrated, "");
        let mut terminal = Terminal::start(&mut stage.run_with(&[]));
        terminal.answer(RELEASE, "n\n");
        assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
        let shown = terminal.shown();
        let (_, prompt) = shown.split_once("rig       bench (").expect("the prompt");
        let (prompt, _) = prompt.split_once(RELEASE).expect("its question");
        assert!(
            match line {
                Some(line) => prompt.contains(line),
                None => !prompt.contains("NOT ISSUABLE"),
            },
            "{due}: {shown}"
        );
    }
}

/// The limits that the rig itself reports are −5 mm .. 10 mm, and the plan moves to 0.8 mm.
#[test]
fn a_zero_near_the_limits_of_the_rig_is_refused_before_the_release() {
    let here = |plan: &str| {
        plan.replace(
            "safe_state = hold",
            "safe_state = hold\n  datum      = here",
        )
    };
    let stage = Stage::of(str::to_owned, "stands at 9.5 mm");
    let plan = stage.path("plan.psd");
    fs::write(&plan, here(&fs::read_to_string(&plan).unwrap())).unwrap();
    let refused = wait(&mut stage.run_with(&["--yes"]));
    assert!(
        refused.code == Some(3)
            && refused
                .output
                .contains("from the plan's zero the rig itself allows -14.5 mm .. 0.5 mm"),
        "{}",
        refused.output
    );
    assert!(stage.moves().is_empty() && !stage.path("run").exists());
}
