//! `psd rig probe`, `monitor` and `jog` as started from a shell.

use std::path::Path;
use std::process::{Command, Stdio};

const PLAN: &str = r#"plan "By hand" {
  edition = 1
}

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 10 kN/m)
}

rig bench {
  link = virtual(noise: 0.2 N, seed: 3)
}

limits {
  displacement = -5 mm .. 10 mm
  force        = -60 N .. 60 N
  increment    = 1 mm
}

move there {
  to = 1 mm
}
"#;

/// Exit code, standard output and standard error of `psd rig …` without an operator at a terminal.
fn rig(arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let plan: &Path = &folder.path().join("plan.psd");
    std::fs::write(plan, PLAN).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
    command
        .args(["rig", arguments[0]])
        .arg(plan)
        .args(&arguments[1..])
        .stdin(Stdio::null());
    let ended = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (ended.status.code(), text(ended.stdout), text(ended.stderr))
}

#[test]
fn probe_reports_the_identity_and_the_margin_to_each_limit() {
    let (code, report, messages) = rig(&["probe"]);
    assert_eq!(code, Some(0), "{messages}");
    for expected in [
        "bench (simulated)",
        "virtual rig",
        "noise 0.",
        "-5 mm",
        "margin 5.000 mm",
        "10 mm",
        "margin 10.00 mm",
        "60 N",
    ] {
        assert!(report.contains(expected), "{expected} in\n{report}");
    }
}

#[test]
fn monitor_gives_one_line_a_reading_in_a_pipe() {
    let (code, lines, messages) = rig(&["monitor", "--count", "3"]);
    assert_eq!(code, Some(0), "{messages}");
    let rows: Vec<&str> = lines.lines().collect();
    assert_eq!((rows.len(), rows[0]), (4, "time_s,displacement_m,force_n"));
    assert!(
        rows[1..]
            .iter()
            .all(|row| row.split(',').all(|value| value.parse::<f64>().is_ok())),
        "{lines}"
    );
}

#[test]
fn jog_moves_inside_the_limits_and_only_with_a_yes() {
    let (code, position_line, messages) =
        rig(&["jog", "--to", "2.5 mm", "--speed", "1 mm/s", "--yes"]);
    assert_eq!(
        code,
        Some(0),
        "three increments of at most 1 mm: {messages}"
    );
    assert!(
        position_line.starts_with("X 2.500 mm   R 2"),
        "{position_line}"
    );
    let (code, position_line, messages) = rig(&["jog", "--to", "11 mm", "--yes"]);
    assert_eq!((code, position_line.as_str()), (Some(4), ""));
    assert!(
        messages.contains("target displacement 11 mm is outside its limit -5 mm .. 10 mm"),
        "{messages}"
    );
    for refused in [
        &["jog", "--to", "1 mm"][..],
        &["jog", "--yes"],
        &["jog", "--to", "1", "--yes"],
        &["jog", "--to", "1 N", "--yes"],
    ] {
        let (code, position_line, messages) = rig(refused);
        assert_eq!(
            (code, position_line.as_str()),
            (Some(2), ""),
            "{refused:?}: {messages}"
        );
    }
}
