//! A whole run with every fault of a rig emulator: each run ends as the manual's table states. In: the rows of
//! `docs/reference/emulator-faults.md`. Out: the end of the run, its messages, a valid run log, a rig in hold.

use std::sync::Mutex;

use crate::stage::{Stage, wait};

/// Number of concurrent runs: each waits for its rig most of the time.
const AT_ONCE: usize = 4;

/// One row: a line of a script, the exit code of the run, and the expected messages.
struct Row {
    fault: String,
    code: i32,
    expected: Vec<String>,
}

/// The words of a cell between backticks.
fn quoted(cell: &str) -> Vec<String> {
    cell.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

fn rows() -> Vec<Row> {
    let manual = include_str!("../../docs/reference/emulator-faults.md");
    let (_, section) = manual
        .split_once("## What can be made to go wrong")
        .unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    let cells = section.lines().filter_map(|line| {
        line.strip_prefix("| `")?
            .strip_suffix(" |")?
            .split_once("` | ")
    });
    let row = |(fault, rest): (&str, &str)| {
        let (code, words) = rest.split_once(" | ").unwrap();
        // Names of options and fields are not messages of a run.
        let name = |word: &str| {
            word.starts_with("--") || ["psd resume", "force_range", "samples"].contains(&word)
        };
        let expected = quoted(words)
            .into_iter()
            .filter(|word| !name(word))
            .collect();
        Row {
            fault: fault.to_owned(),
            code: code.parse().unwrap(),
            expected,
        }
    };
    cells.map(row).collect()
}

/// Three readings per step, with a little noise.
fn plan(plan: &str) -> String {
    plan.replace(
        "samples    = 1",
        "samples    = 3\n  noise      = 0.1 N\n  resolution = 1 um",
    )
}

/// The error in the end of a row's run, if there is one.
fn fault_of(row: &Row) -> Option<String> {
    let mut stage = Stage::of(plan, &row.fault);
    let ran = wait(&mut stage.run_with(&["--yes"]));
    let verified = stage.verify();
    let requests = stage.requests();
    // Fails if a target was outside the limits.
    stage.power_down();
    let unsaid: Vec<&String> = row
        .expected
        .iter()
        .filter(|words| !ran.output.contains(*words))
        .collect();
    let last = |what: &str| requests.iter().rposition(|request| request.contains(what));
    let heard = !["stop reading", "hang up", "reboot", "freeze firmware"]
        .iter()
        .any(|deaf| row.fault.contains(deaf));
    let held = !heard || last(">STOP").max(last("!")) > last(">MOVE");
    let fault = if ran.code != Some(row.code) {
        format!("exit code {:?}, not {}", ran.code, row.code)
    } else if !unsaid.is_empty() {
        format!("not said: {unsaid:?}")
    } else if verified.code != Some(0) {
        format!("the record: {}", verified.output)
    } else if row.code > 1 && !held {
        format!("not held: {requests:#?}")
    } else {
        return None;
    };
    Some(format!("{}: {fault}\n{}", row.fault, ran.output))
}

#[test]
fn every_fault_of_the_manual_ends_as_specified_there() {
    let rows = rows();
    assert!(rows.len() >= 30, "{} rows", rows.len());
    let (next, faults) = (Mutex::new(rows.iter()), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..AT_ONCE {
            scope.spawn(|| {
                loop {
                    let Some(row) = next.lock().unwrap().next() else {
                        return;
                    };
                    let fault = fault_of(row);
                    faults.lock().unwrap().extend(fault);
                }
            });
        }
    });
    let faults = faults.into_inner().unwrap();
    assert!(
        faults.is_empty(),
        "{} of {}:\n{}",
        faults.len(),
        rows.len(),
        faults.join("\n\n")
    );
}

/// The manual's table has a row for every kind of fault: each keyword that begins a fault appears there.
#[test]
fn every_kind_of_fault_has_its_row() {
    let rows = rows();
    for verb in [
        "drop",
        "repeat",
        "replay",
        "split",
        "cut",
        "delay",
        "flip",
        "garbage",
        "fill",
        "hang up",
        "reboot",
        "stop reading",
        "freeze firmware",
        "freeze force",
        "freeze displacement",
        "scale force",
        "scale displacement",
        "clip force",
        "drift force",
        "drift displacement",
        "spike",
        "number",
        "reach",
        "stick",
        "lag",
        "coast",
        "fracture",
    ] {
        assert!(
            rows.iter()
                .any(|row| row.fault.contains(&format!(": {verb} "))
                    || row.fault.ends_with(&format!(": {verb}"))),
            "{verb}"
        );
    }
}

#[test]
fn a_script_without_known_faults_is_refused() {
    let stage = Stage::new();
    for (script, expected) in [
        (
            "after 3 moves drop reply",
            "line 1: `:` is missing between the time and the fault",
        ),
        (
            "# nothing\nat 1 s: explode",
            "line 2: unknown fault `explode`",
        ),
        ("after 3 goes: drop reply", "`goes` cannot be counted"),
    ] {
        std::fs::write(stage.path("wrong"), script).unwrap();
        let ended = wait(
            stage
                .tool("simulate", &["--script"])
                .arg(stage.path("wrong")),
        );
        assert!(
            ended.code == Some(2) && ended.output.contains(expected),
            "{}",
            ended.output
        );
    }
}
