//! The plan changes before a run is resumed: psd refuses it with both digests, or logs it as a deviation.

use std::fs;

use rustix::process::Signal;

use crate::stage::{Stage, finish, signal, start, wait};

/// A run that the operator stopped after some moves.
fn stopped() -> Stage {
    let stage = Stage::new();
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(8);
    signal(&run, Signal::INT);
    let run = finish(run);
    assert_eq!(run.code, Some(4), "{}", run.output);
    stage
}

#[test]
fn one_byte_of_the_plan_is_refused_and_amended_only_by_name() {
    let stage = stopped();
    let plan = stage.path("plan.psd");
    let same = plan.to_str().unwrap().to_owned();
    let text = fs::read_to_string(&plan).unwrap();
    fs::write(&plan, text.replace("A short run", "a short run")).unwrap();
    let greetings = stage.greetings();
    let refused = wait(&mut stage.resume_with(&["--plan", &same]));
    assert_eq!(refused.code, Some(2), "{}", refused.output);
    let digests = refused
        .output
        .split(|letter: char| !letter.is_ascii_hexdigit())
        .filter(|word| word.len() == 64)
        .count();
    assert_eq!(digests, 2, "{}", refused.output);
    assert_eq!(stage.greetings(), greetings, "not even the first word");

    let amended = wait(&mut stage.resume_with(&["--plan", &same, "--amend"]));
    assert_eq!(amended.code, Some(0), "{}", amended.output);
    assert_eq!(stage.verify().code, Some(0), "{}", stage.verify().output);
    for file in ["report.html", "summary.json"] {
        let text = fs::read_to_string(stage.path("run").join(file)).unwrap();
        assert!(
            text.contains("B. Tester") && text.contains("it was interrupted"),
            "{file} names who and why"
        );
        assert!(text.contains("became"), "{file} names what changed");
    }
}

#[test]
fn the_same_plan_needs_no_amendment() {
    let stage = stopped();
    let plan = stage.path("plan.psd");
    stage.goes_on(&["--plan", plan.to_str().unwrap()]);
}
