//! The program as started from a shell: exit codes, output streams, files on disk.

use std::process::{Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use super::workspace::{Ended, Workspace, every_file};

/// A small plan that passes.
const SOUND: &str = r#"plan "A small impact" {
  edition = 1
}

param speed = 1 m/s between 0.5 m/s .. 2 m/s

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 327.65 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = speed
}

limits {
  displacement = -0.1 m .. 0.2 m
}

impact hit {
  striker   = hammer
  time_step = 10 ms
  duration  = 1 s
}

require "stays in travel" hit.max_displacement < 0.16 m

report {
  figures = []
  formats = [html, csv]
}
"#;

/// The same plan with all outputs: all figures, in every format.
fn with_every_output() -> String {
    SOUND.split("\nreport {").next().unwrap().to_owned()
}

fn changed(from: &str, to: &str) -> String {
    assert!(SOUND.contains(from));
    SOUND.replace(from, to)
}

#[test]
fn a_run_gives_its_folder_on_stdout_and_the_verdict_on_stderr() {
    let workspace = Workspace::new(&[("plans/small.psd", &with_every_output())]);
    let run = ["run", "plans/small.psd", "--date", "2026-05-31"];
    let first = workspace.psd(&run).with(0);
    assert_eq!(first.stdout, "runs/small-1\n");
    assert!(
        first.stderr.contains("PASS") && first.stderr.contains("stays in travel"),
        "{}",
        first.stderr
    );
    assert!(
        !first.stderr.contains('\u{1b}'),
        "no colour and no bar in a pipe"
    );
    assert_eq!(workspace.psd(&run).with(0).stdout, "runs/small-2\n");
    // The run log has the start of the run, and the manifest its digest.
    let results = |folder| {
        let mut files = every_file(&workspace.path(folder));
        files.retain(|(path, _)| {
            !path.ends_with("journal.psdj") && !path.ends_with("manifest.sha256")
        });
        files
    };
    let (one, two) = (results("runs/small-1"), results("runs/small-2"));
    assert!(one.iter().any(|(path, _)| path.ends_with("summary.json")));
    assert!(one == two, "the same plan gives the same bytes");
}

/// Without a stated date a simulated run has the day of its start: in the summary, in the report, and again when it is verified.
#[test]
fn a_simulated_run_has_a_date() {
    let workspace = Workspace::new(&[("small.psd", SOUND)]);
    workspace
        .psd(&["run", "small.psd", "--out", "here"])
        .with(0);
    let summary: Value = serde_json::from_str(&workspace.read("here/summary.json")).unwrap();
    let date = summary["date"].as_str().expect("a date");
    assert!(date.parse::<jiff::civil::Date>().is_ok(), "{date}");
    assert!(
        workspace
            .read("here/journal.psdj")
            .contains(&format!("\"began\":\"{date}T")),
        "the day is that of the run log"
    );
    assert!(
        workspace
            .read("here/report.html")
            .contains(&format!("Simulated {date}"))
    );
    workspace.psd(&["verify", "here"]).with(0);
}

#[test]
fn the_summary_is_the_result_where_json_is_asked() {
    let workspace = Workspace::new(&[("small.psd", SOUND)]);
    let ended = workspace
        .psd(&[
            "run",
            "small.psd",
            "--format",
            "json",
            "--out",
            "here",
            "--date",
            "2026-05-31",
        ])
        .with(0);
    assert_eq!(
        (&ended.json()["schema"], &ended.json()["verdict"]),
        (&"psd.summary/2".into(), &"pass".into())
    );
    assert_eq!(ended.json()["date"], "2026-05-31");
    assert_eq!(workspace.read("here/summary.json"), ended.stdout);
}

#[test]
fn a_missed_requirement_ends_with_one() {
    let workspace = Workspace::new(&[("small.psd", &changed("< 0.16 m", "< 0.1 m"))]);
    assert!(
        workspace
            .psd(&["run", "small.psd"])
            .with(1)
            .stderr
            .contains("FAIL")
    );
}

#[test]
fn a_wrong_plan_ends_with_two_and_leaves_nothing() {
    let workspace = Workspace::new(&[("small.psd", &changed("velocity =", "velocty ="))]);
    let ended = workspace.psd(&["run", "small.psd"]).with(2);
    assert!(
        ended.stdout.is_empty()
            && ended.stderr.contains("E202")
            && ended.stderr.contains("small.psd:14:"),
        "{}",
        ended.stderr
    );
    assert!(ended.stderr.contains("did you mean `velocity`?"));
    assert!(!workspace.path("runs").exists());
}

#[test]
fn a_wrong_command_line_ends_with_two() {
    let workspace = Workspace::new(&[("small.psd", SOUND)]);
    for wrong in [
        &["run"][..],
        &["walk"],
        &["run", "small.psd", "--date", "yesterday"],
        &["run", "small.psd", "--set", "speed"],
        &["run", "small.psd", "--set", "speed=9 m/s"],
        &["run", "small.psd", "--set", "spee=1 m/s"],
        &[
            "run",
            "small.psd",
            "--set",
            "speed=1 m/s",
            "--set",
            "speed=0.9 m/s",
        ],
        &["run", "small.psd", "--rig", "none"],
        &["explain", "E999"],
    ] {
        let ended = workspace.psd(wrong).with(2);
        assert!(
            ended.stdout.is_empty() && !ended.stderr.is_empty(),
            "{wrong:?}"
        );
    }
    assert!(workspace.psd(&["--help"]).with(0).stdout.contains("Usage"));
}

#[test]
fn a_setting_changes_the_run_and_its_id() {
    let workspace = Workspace::new(&[("small.psd", SOUND)]);
    let id = |arguments: &[&str]| {
        workspace
            .psd(&[&["run", "small.psd", "--format", "json"], arguments].concat())
            .json()["run_id"]
            .clone()
    };
    assert_ne!(id(&[]), id(&["--set", "speed=0.9 m/s"]));
}

#[test]
fn files_that_cannot_be_used_end_with_three() {
    let workspace = Workspace::new(&[("small.psd", SOUND), ("full/precious.txt", "mine")]);
    assert!(
        workspace
            .psd(&["run", "none.psd"])
            .with(3)
            .stderr
            .contains("none.psd")
    );
    let refused = workspace
        .psd(&["run", "small.psd", "--out", "full"])
        .with(3);
    assert!(
        refused.stderr.contains("new or empty"),
        "{}",
        refused.stderr
    );
    assert_eq!(every_file(&workspace.path("full")).len(), 1);
}

#[test]
fn a_limit_ends_the_run_with_four_and_keeps_what_was_recorded() {
    let workspace = Workspace::new(&[("small.psd", &changed(".. 0.2 m", ".. 0.1 m"))]);
    let ended = workspace
        .psd(&["run", "small.psd", "--out", "here"])
        .with(4);
    assert!(ended.stderr.contains("ABORTED"), "{}", ended.stderr);
    let summary: Value = serde_json::from_str(&workspace.read("here/summary.json")).unwrap();
    assert_eq!(summary["verdict"], "aborted");
    assert!(workspace.read("here/tables/hit.csv").lines().count() > 5);
}

#[test]
fn check_draws_on_stderr_and_gives_json_on_stdout() {
    let wrong = changed("1 kg", "3 mm");
    let workspace = Workspace::new(&[("good.psd", SOUND), ("plans/wrong.psd", &wrong)]);
    let human = workspace
        .psd(&["check", "good.psd", "plans/wrong.psd"])
        .with(2);
    assert!(
        human.stdout.is_empty() && human.stderr.contains("plans/wrong.psd:8:"),
        "{}",
        human.stderr
    );
    let json = workspace
        .psd(&["check", "good.psd", "plans/wrong.psd", "--format", "json"])
        .with(2);
    let document = json.json();
    let first = &document["diagnostics"][0];
    assert!(json.stderr.is_empty(), "{}", json.stderr);
    assert_eq!(
        (&document["schema"], &first["file"]),
        (&"psd.diagnostics/1".into(), &"plans/wrong.psd".into())
    );
    assert_eq!(
        (&first["line"], &first["code"], &first["severity"]),
        (&8.into(), &"E301".into(), &"error".into())
    );
    let span = |end: &str| usize::try_from(first["span"][end].as_u64().unwrap()).unwrap();
    assert_eq!(&wrong[span("start")..span("end")], "3 mm");
}

#[test]
fn explain_predicts_the_run_on_stdout() {
    let workspace = Workspace::new(&[("small.psd", SOUND)]);
    let text = workspace
        .psd(&["check", "--explain", "small.psd"])
        .with(0)
        .stdout;
    for expected in [
        "critical time step",
        "34.71 ms",
        "10.00 ms",
        "0.1579 m",
        "Limits",
        "−0.1000 .. 0.2000 m",
        "stays in travel",
    ] {
        assert!(text.contains(expected), "{expected} in\n{text}");
    }
    assert!(!workspace.path("runs").exists());
    let workspace = Workspace::new(&[("small.psd", &changed(".. 0.2 m", ".. 0.1 m"))]);
    assert!(
        workspace
            .psd(&["check", "--explain", "small.psd"])
            .with(4)
            .stdout
            .contains("would be stopped")
    );
}

#[test]
fn fmt_shows_the_difference_or_writes_it() {
    let untidy = changed("  mass      = 1 kg", "      mass=1 kg   # equivalent");
    let workspace = Workspace::new(&[
        ("plans/untidy.psd", &untidy),
        ("plans/lib/sound.psd", SOUND),
        ("wrong.psd", "let a = (1\n"),
    ]);
    let shown = workspace.psd(&["fmt", "--check", "plans"]).with(1);
    assert!(
        shown.stdout.contains("-      mass=1 kg   # equivalent")
            && shown.stdout.contains("+++ plans/untidy.psd"),
        "{}",
        shown.stdout
    );
    assert_eq!(workspace.read("plans/untidy.psd"), untidy);
    workspace.psd(&["fmt", "plans"]).with(0);
    assert!(
        workspace
            .read("plans/untidy.psd")
            .contains("  mass      = 1 kg  # equivalent")
            || workspace.read("plans/untidy.psd").contains("= 1 kg")
    );
    assert!(
        workspace
            .psd(&["fmt", "--check", "plans"])
            .with(0)
            .stdout
            .is_empty()
    );
    assert_eq!(workspace.read("plans/lib/sound.psd"), SOUND);
    assert!(
        workspace
            .psd(&["fmt", "wrong.psd"])
            .with(2)
            .stderr
            .contains("E102")
    );
    assert_eq!(workspace.read("wrong.psd"), "let a = (1\n");
}

#[test]
fn explain_gives_a_page_the_list_and_a_guess() {
    let workspace = Workspace::new(&[]);
    assert!(
        workspace
            .psd(&["explain", "e202"])
            .with(0)
            .stdout
            .starts_with("E202: ")
    );
    let short = workspace.psd(&["explain", "E301"]).with(0).stdout;
    assert!(
        short.contains("\n  - mass = 10 mm\n  + mass = 10 kg\n"),
        "{short}"
    );
    let full = workspace.psd(&["explain", "E301", "--full"]).with(0).stdout;
    assert!(full.contains("wrong:\nspecimen beam {\n"), "{full}");
    let all = workspace.psd(&["explain"]).with(0).stdout;
    assert_eq!(all.lines().count(), psd::codes::all().len());
    assert!(
        all.lines().all(|line| line.len() > 8),
        "every page has a title:\n{all}"
    );
    assert!(
        workspace
            .psd(&["explain", "E22"])
            .with(2)
            .stderr
            .contains("did you mean `E2")
    );
}

#[test]
fn limits_lists_the_bounds_of_every_stage() {
    let listed = Workspace::new(&[]).psd(&["limits"]).with(0).stdout;
    let has = |bound: String, of: &str| {
        listed
            .lines()
            .any(|line| line.trim().starts_with(&bound) && line.contains(of))
    };
    assert!(
        has(
            psd_language::syntax::limits::FILE_BYTES.to_string(),
            "one file"
        ),
        "{listed}"
    );
    assert!(
        has(
            psd_language::check::MOST_FILES.to_string(),
            "files of one plan"
        ),
        "{listed}"
    );
    assert!(
        has(psd_language::check::DEEPEST.to_string(), "use files"),
        "{listed}"
    );
    assert!(
        has(
            psd_language::check::MOST_ENTRIES.to_string(),
            "one list or range"
        ),
        "{listed}"
    );
    assert!(
        has(
            format!("{:.0}", psd::procedures::stiffness_ramp::MOST_READINGS),
            "stiffness ramp"
        ),
        "{listed}"
    );
    assert!(
        has(
            format!("{:.0}", psd::procedures::damping_sweep::MOST_SAMPLES),
            "damping sweep"
        ),
        "{listed}"
    );
    assert!(
        has(format!("{:.0}", psd_plan::MOST_STEPS), "one impact"),
        "{listed}"
    );
    assert!(
        has(
            psd_plan::MOST_RECORDED_STEPS.to_string(),
            "steps of all procedures of one run"
        ),
        "{listed}"
    );
    assert!(
        has(
            psd_rig::journal::MOST_BYTES.to_string(),
            "the run log of one run"
        ),
        "{listed}"
    );
}

#[test]
fn a_run_of_too_many_steps_does_not_begin() {
    let workspace = Workspace::new(&[(
        "long.psd",
        &changed("time_step = 10 ms", "time_step = 0.1 us"),
    )]);
    let output = workspace.psd(&["check", "long.psd"]).with(2).stderr;
    assert!(
        output.contains("E653") && output.contains("10000000 steps"),
        "{output}"
    );
    let output = workspace
        .psd(&["run", "long.psd", "--out", "long"])
        .with(2)
        .stderr;
    assert!(
        output.contains("(at most 2000000)") && output.contains("increase `time_step`"),
        "{output}"
    );
    assert!(
        !workspace.folder().join("long").exists(),
        "nothing is left of it"
    );
}

#[test]
fn colour_is_used_only_on_request() {
    let workspace = Workspace::new(&[("small.psd", &changed("velocity =", "velocty ="))]);
    let colored = |arguments: &[&str]| {
        workspace
            .psd(&[arguments, &["check", "small.psd"]].concat())
            .with(2)
            .stderr
            .contains('\u{1b}')
    };
    assert!(colored(&["--color", "always"]));
    assert!(!colored(&[]) && !colored(&["--color", "never"]));
    let output = workspace
        .command(&["--color", "auto", "check", "small.psd"])
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    assert!(!Ended::from(output).stderr.contains('\u{1b}'));
}

#[test]
fn accept_writes_beside_the_plans_folder() {
    let workspace = Workspace::new(&[
        ("plans/small.psd", SOUND),
        ("reports/small/stale.txt", "old"),
        ("reports/other/kept.txt", "kept"),
    ]);
    workspace
        .psd(&["run", "plans/small.psd", "--accept", "--out", "here"])
        .with(0);
    assert_eq!(
        workspace.undated_summary("reports/small"),
        workspace.undated_summary("here")
    );
    assert!(
        workspace
            .read("reports/small/summary.json")
            .contains("\"date\": null")
    );
    assert!(
        workspace.path("here/report.html").exists()
            && !workspace.path("reports/small/report.html").exists()
            && workspace.path("reports/small/tables/hit.csv").exists()
    );
    assert!(
        !workspace.path("reports/small/stale.txt").exists()
            && workspace.path("reports/other/kept.txt").exists()
    );
}

#[test]
fn ctrl_c_stops_at_the_end_of_a_step_and_keeps_the_record() {
    // The many steps ensure that the signal arrives during them, on a machine of any speed.
    let long = changed("time_step = 10 ms", "time_step = 1 us")
        .replace("duration  = 1 s", "duration  = 1 s\n  until     = duration");
    let workspace = Workspace::new(&[("long.psd", &long)]);
    let child = workspace
        .command(&["run", "long.psd", "--out", "here"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let started = std::time::Instant::now();
    // During the run, so that its run log contains steps.
    let recorded =
        || std::fs::metadata(workspace.path("here/journal.psdj")).map_or(0, |record| record.len());
    while recorded() < 5_000 && started.elapsed() < Duration::from_mins(4) {
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(
        Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status()
            .unwrap()
            .success()
    );
    let ended = Ended::from(child.wait_with_output().unwrap()).with(4);
    assert!(ended.stderr.contains("ABORTED"), "{}", ended.stderr);
    let summary: Value = serde_json::from_str(&workspace.read("here/summary.json")).unwrap();
    assert_eq!(
        (
            &summary["verdict"],
            &summary["procedures"]["hit"]["complete"]
        ),
        (&"aborted".into(), &false.into())
    );
}

#[test]
fn an_unreadable_plan_is_an_error_with_its_location_among_the_others() {
    let workspace = Workspace::new(&[("good.psd", SOUND)]);
    std::fs::write(
        workspace.path("latin.psd"),
        b"# a\nplan \"Pr\xfcfung\" { }\n",
    )
    .unwrap();
    let json = workspace
        .psd(&["check", "good.psd", "latin.psd", "--format", "json"])
        .with(2)
        .json();
    assert_eq!(
        (&json["errors"], &json["warnings"]),
        (&1.into(), &0.into()),
        "{json}"
    );
    let found = &json["diagnostics"][0];
    let located = ["code", "file", "line", "column"].map(|key| found[key].to_string());
    assert_eq!(located, ["\"E106\"", "\"latin.psd\"", "2", "9"], "{found}");
    assert!(
        found["message"].as_str().unwrap().contains("not UTF-8"),
        "{found}"
    );

    let json = workspace
        .psd(&["check", "nothere.psd", "good.psd", "--format", "json"])
        .with(3)
        .json();
    assert_eq!(
        (&json["errors"], &json["diagnostics"][0]["code"]),
        (&1.into(), &Value::Null),
        "{json}"
    );
    assert_eq!(json["diagnostics"][0]["file"], "nothere.psd");
}

#[test]
fn a_file_that_is_not_there_ends_every_command_alike() {
    let workspace = Workspace::new(&[]);
    for command in ["check", "run", "fmt", "test"] {
        let ended = workspace.psd(&[command, "nothere.psd"]).with(3);
        assert!(
            ended.stderr.contains("nothere.psd: no such file"),
            "{command}: {}",
            ended.stderr
        );
    }
}

#[test]
fn a_plan_without_its_ending_is_named() {
    let workspace = Workspace::new(&[("good.psd", SOUND)]);
    let ended = workspace.psd(&["run", "good"]).with(3);
    assert!(
        ended.stderr.contains("did you mean `good.psd`?"),
        "{}",
        ended.stderr
    );
}

#[test]
fn a_plan_is_not_the_folder_of_a_study() {
    let workspace = Workspace::new(&[("good.psd", SOUND)]);
    for command in ["status", "merge"] {
        let ended = workspace.psd(&["study", command, "good.psd"]).with(3);
        let expected = "good.psd: is a file, not the folder of a study";
        assert!(ended.stderr.contains(expected), "{}", ended.stderr);
    }
}

#[test]
fn a_plan_without_a_procedure_is_not_run() {
    let (specimen, _) = SOUND.split_once("striker hammer").unwrap();
    let workspace = Workspace::new(&[("idle.psd", specimen), ("empty.psd", "")]);
    for plan in ["idle.psd", "empty.psd"] {
        let ended = workspace.psd(&["run", plan, "--out", "here"]).with(2);
        assert!(
            ended.stderr.contains("no procedure: nothing would run"),
            "{}",
            ended.stderr
        );
        assert!(!workspace.path("here").exists(), "nothing is left behind");
        workspace.psd(&["check", plan]).with(0);
    }
}

/// A sweep past yield whose first pass is not read, holds during relaxation, cycles on a coarse cell. Also an impact series in which the
/// same observation applies to every impact.
const PAST_YIELD: &str = r"
specimen bracket {
  mass      = 1 kg
  behaviour = maxwell(
    of: bilinear(stiffness: 300 kN/m, yield_force: 600 N, post_yield_ratio: 0.1),
    stiffness: 20 kN/m,
    time_constant: 1 s,
  )
  damping   = 400 N*s/m
}

striker weight {
  mass     = 5 kg
  velocity = 0.5 m/s
}

rig frame {
  link = virtual(noise: 0.2 N, force_resolution: 0.5 N, resolution: 1 um, seed: 4)
}

stiffness ramp k0 {
  displacements = 0.2 mm .. 1 mm step 0.2 mm
  pause         = 3 s
  relaxation    = exponential(readings: 12, accuracy: 1 N)
}

damping sweep c {
  velocities = [5, 20] mm/s
  stroke     = 1 mm
  about      = 5 mm
  stiffness  = k0.stiffness
}

cycle loops {
  amplitudes = [0.5 mm, 1 mm]
  points     = 4
}

escalate rising {
  striker   = weight
  stiffness = k0.stiffness
  contact   = rigid
  time_step = 0.2 ms
  duration  = 40 ms
  speeds    = [0.1, 0.15, 0.2] m/s
  while     = max_displacement < 50 mm
}
";

#[test]
fn results_of_unread_strokes_and_of_coarse_cells_are_recomputed_too() {
    let workspace = Workspace::new(&[("bracket.psd", PAST_YIELD)]);
    workspace
        .psd(&["run", "bracket.psd", "--out", "run"])
        .with(0);
    workspace.psd(&["verify", "run"]).with(0);
    workspace.psd(&["report", "run", "--out", "again"]).with(0);
    let mut diff = Command::new("diff");
    let compared = diff
        .args(["-r", "run", "again"])
        .current_dir(workspace.folder())
        .output()
        .unwrap();
    assert!(
        compared.status.success(),
        "{}",
        String::from_utf8_lossy(&compared.stdout)
    );
}

#[test]
fn results_recomputed_from_the_record_are_byte_identical() {
    let workspace = Workspace::new(&[("hit.psd", &with_every_output())]);
    assert_eq!(
        workspace.psd(&["run", "hit.psd", "--out", "run"]).code,
        Some(0)
    );
    assert_eq!(
        workspace.psd(&["report", "run"]).code,
        Some(3),
        "nothing is overwritten"
    );
    let again = workspace.psd(&["report", "run", "--out", "again"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    let mut diff = Command::new("diff");
    let compared = diff
        .args(["-r", "run", "again"])
        .current_dir(workspace.folder())
        .output()
        .unwrap();
    assert!(
        compared.status.success(),
        "{}",
        String::from_utf8_lossy(&compared.stdout)
    );

    assert_eq!(
        workspace.psd(&["verify", "again"]).code,
        Some(0),
        "it is a run folder like the first"
    );

    // A run log cut off after its last step but one; this is reported first.
    let record = workspace.read("run/journal.psdj");
    let lines: Vec<&str> = record.lines().collect();
    std::fs::create_dir(workspace.path("cut")).unwrap();
    std::fs::write(
        workspace.path("cut/journal.psdj"),
        lines[..lines.len() - 4].join("\n") + "\n",
    )
    .unwrap();
    assert_eq!(workspace.psd(&["report", "cut"]).code, Some(3));
    assert!(
        workspace
            .read("cut/report.html")
            .contains("INCOMPLETE: the run log ends here")
    );
}
