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

/// The speeds of all targets in the run log, and how many there were before the resumption \[m/s\].
fn speeds(stage: &Stage) -> (Vec<f64>, usize) {
    let text = fs::read_to_string(stage.journal()).unwrap();
    let of = |line: &str| {
        let (_, rest) = line.split_once("\"rate\":")?;
        rest.split([',', '}']).next()?.parse::<f64>().ok()
    };
    let targets = |text: &str| {
        let intents = text.lines().filter(|line| line.contains(" INTENT "));
        intents.filter_map(of).collect::<Vec<_>>()
    };
    let (before, _) = text.split_once(" RESUME ").unwrap();
    (targets(&text), targets(before).len())
}

#[test]
fn an_amended_speed_is_the_speed_of_the_rig_and_a_higher_one_needs_its_own_word() {
    let stage = stopped();
    let plan = stage.path("plan.psd");
    let same = plan.to_str().unwrap().to_owned();
    let text = fs::read_to_string(&plan).unwrap();
    fs::write(
        &plan,
        text.replace("speed      = 20 mm/s", "speed      = 40 mm/s"),
    )
    .unwrap();
    let moves = stage.moves();
    let faster = wait(&mut stage.resume_with(&["--plan", &same, "--amend"]));
    assert!(
        faster.code == Some(3) && faster.output.contains("--accept-speed"),
        "{}",
        faster.output
    );
    assert_eq!(stage.moves(), moves, "nothing moved");

    // Also the limit of speed is lower than the speed of the first moves.
    let slow = text.replace("speed      = 20 mm/s", "speed      = 5 mm/s");
    fs::write(
        &plan,
        slow.replace("speed        = 200 mm/s", "speed        = 10 mm/s"),
    )
    .unwrap();
    let slower = wait(&mut stage.resume_with(&["--plan", &same, "--amend"]));
    assert_eq!(slower.code, Some(0), "{}", slower.output);
    let (speeds, before) = speeds(&stage);
    assert!(before >= 8 && speeds.len() > before);
    assert!(
        speeds[..before].iter().all(|speed| *speed == 0.02),
        "{speeds:?}"
    );
    assert!(
        speeds[before..].iter().all(|speed| *speed == 0.005),
        "{speeds:?}"
    );
    stage.proven();
}
