//! The low-level check run `psd run --check-run`: on a virtual rig, and on a real one over a pseudo-terminal against `psd rig simulate`.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// The rig is stiffer than the specimen of the plan only if the simulator's plan states this.
const PLAN: &str = r#"plan "A blow" {
  edition = 1
}

param bench_stiffness = 300 kN/m between 100 kN/m .. 500 kN/m

specimen beam {
  mass      = 2.6 kg
  behaviour = elastic(stiffness: bench_stiffness)
}

striker pendulum {
  mass     = 20 kg
  velocity = 1 m/s
}

limits {
  displacement = -5 mm .. 30 mm
  force        = -15 kN .. FORCE kN
  speed        = 150 mm/s
}

rig simulated {
  link = virtual(noise: 2 N, resolution: 1 um, seed: 7)
}

rig bench {
  link        = serial(port: "PORT", dialect: native)
  settle      = within(0.005 mm, 200 N/s, for: 0.02 s, timeout: 10 s)
  safe_state  = hold
  pretest_check        = probe(0.1 mm, stiffness: 150 kN/m .. 450 kN/m, zero: 20 N)
  resolution  = 1 um
  noise       = 2 N
  force_range = 15 kN
  speed       = 10 mm/s
}

stiffness ramp k0 {
  displacements = 0.2 mm .. 1 mm step 0.2 mm
  pause         = 0 s
}

impact hit {
  striker   = pendulum
  stiffness = k0.stiffness
  contact   = restitution(0.93)
  time_step = 0.5 ms
  duration  = 50 ms
}

require "stays in travel" hit.max_displacement <= 8.5 mm

report {
  figures = []
  formats = [html, csv]
}
"#;

struct Workspace(tempfile::TempDir);

impl Workspace {
    /// A folder with the plan, with `force` (kN) as the highest allowed force.
    fn new(force: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let port = folder.path().join("port");
        let text = PLAN
            .replace("FORCE", force)
            .replace("PORT", port.to_str().unwrap());
        fs::write(folder.path().join("plan.psd"), text).unwrap();
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// Exit code, standard output and standard error of psd in the folder.
    fn psd(&self, arguments: &[&str]) -> (Option<i32>, String, String) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
        let ended = command
            .current_dir(self.path())
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (ended.status.code(), text(ended.stdout), text(ended.stderr))
    }

    fn summary(&self) -> Value {
        serde_json::from_str(&fs::read_to_string(self.path().join("out/summary.json")).unwrap())
            .unwrap()
    }
}

/// The emulator, which ends with the test.
struct Simulator(Child);

impl Simulator {
    /// Replaces the plan's simulated rig, with a specimen of `stiffness`.
    fn start(workspace: &Workspace, stiffness: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
        command
            .current_dir(workspace.path())
            .args(["rig", "simulate", "plan.psd", "--rig", "bench", "--set"]);
        let set = format!("bench_stiffness={stiffness}");
        let started = command
            .arg(set)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let simulator = Self(started);
        let port = workspace.path().join("port");
        let since = Instant::now();
        while !port.exists() {
            assert!(
                since.elapsed() < Duration::from_mins(1),
                "the stand-in opens its port"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
        simulator
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_check_run_measures_the_ramp_and_predicts_the_rest_with_its_margins() {
    let workspace = Workspace::new("15");
    let (code, output, log) =
        workspace.psd(&["run", "plan.psd", "--check-run", "--yes", "--out", "out"]);
    assert_eq!(code, Some(0), "{output}{log}");
    for expected in [
        "check run on rig `simulated`",
        "stiffness 29",
        "peak displacement",
        "margin",
        "Limits",
    ] {
        assert!(output.contains(expected), "{expected} in\n{output}");
    }
    assert!(log.contains("CHECK RUN"), "{log}");
    let summary = workspace.summary();
    assert!(
        summary["procedures"]["k0"]["complete"] == true && summary["procedures"]["hit"].is_null(),
        "{summary}"
    );
    assert_eq!(
        summary["deviations"][0],
        "Check run: k0 ran on the rig; hit did not run and was predicted on a virtual specimen."
    );
    assert!(
        fs::read_to_string(workspace.path().join("out/report.html"))
            .unwrap()
            .contains("CHECK RUN")
    );
    let (code, verified, log) = workspace.psd(&["verify", "out"]);
    assert_eq!(code, Some(0), "{verified}{log}");
    // The prediction is stored, also on a page, and is reproduced from the record.
    let kept = fs::read(workspace.path().join("out/check_run.json")).unwrap();
    let prediction: Value = serde_json::from_slice(&kept).unwrap();
    assert_eq!(
        (&prediction["schema"], &prediction["stopped"]),
        (&"psd.check_run/1".into(), &Value::Null)
    );
    let limits = prediction["limits"].as_array().unwrap();
    let names: Vec<&str> = limits
        .iter()
        .map(|limit| limit["quantity"].as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        ["displacement", "force", "speed", "tracking_energy_error"]
    );
    let force = &limits[1];
    let (high, reached, margin) = (
        &force["high"],
        force["reached"][1].as_f64().unwrap(),
        force["margin"].as_f64().unwrap(),
    );
    assert!(
        *high == 15e3 && (2e3..3e3).contains(&reached) && (15e3 - reached - margin).abs() < 1e-9,
        "{force}"
    );
    assert_eq!(prediction["requirements"][0]["verdict"], "pass");
    let page = fs::read_to_string(workspace.path().join("out/report.html")).unwrap();
    assert!(page.contains("Prediction of the whole run") && page.contains("tracking energy error"));
    let (code, again, log) = workspace.psd(&["report", "out", "--out", "again"]);
    assert_eq!(code, Some(0), "{again}{log}");
    assert!(fs::read(workspace.path().join("again/check_run.json")).unwrap() == kept);
    // The corresponding full run is a different run, and does not mention the check run.
    let (code, ..) = workspace.psd(&["run", "plan.psd", "--yes", "--out", "real"]);
    assert_eq!(code, Some(0));
    let real: Value = serde_json::from_str(
        &fs::read_to_string(workspace.path().join("real/summary.json")).unwrap(),
    )
    .unwrap();
    assert_ne!(real["run_id"], summary["run_id"]);
    assert!(!workspace.path().join("real/check_run.json").exists());
    assert!(
        !fs::read_to_string(workspace.path().join("real/report.html"))
            .unwrap()
            .contains("Prediction of the whole run")
    );
}

/// The check run itself reads no zeros. The run that it predicts does, and includes the time for it.
#[test]
fn a_rig_that_watches_its_zero_drift_is_predicted_to() {
    let workspace = Workspace::new("15");
    let plan = fs::read_to_string(workspace.path().join("plan.psd")).unwrap();
    let watched = plan.replace(
        "seed: 7)\n}",
        "seed: 7)\n  zero_drift = within(20 N, over: 5 s, after: start)\n}",
    );
    assert_ne!(watched, plan);
    fs::write(workspace.path().join("plan.psd"), watched).unwrap();
    let (code, output, log) =
        workspace.psd(&["run", "plan.psd", "--check-run", "--yes", "--out", "out"]);
    assert_eq!(code, Some(0), "{output}{log}");
    assert!(
        output.contains("Zeros") && output.contains("back at its start position"),
        "{output}"
    );
    let prediction: Value =
        serde_json::from_slice(&fs::read(workspace.path().join("out/check_run.json")).unwrap())
            .unwrap();
    let zeros = &prediction["zeros"];
    let expected = [("allowed_force_n", 20.0), ("over_s", 5.0)];
    assert!(
        expected.iter().all(|(name, value)| zeros[name] == *value) && zeros["after"] == "start",
        "{zeros}"
    );
    let (between, steady) = (
        zeros["between_s"].as_f64().unwrap(),
        zeros["steady_force_n_per_s"].as_f64().unwrap(),
    );
    assert!(
        between > 5.0 && (steady * between - 20.0).abs() < 1e-9,
        "{zeros}"
    );
    assert_eq!(
        workspace.summary()["zero_drift"],
        Value::Null,
        "the check run read none"
    );
    let page = fs::read_to_string(workspace.path().join("out/report.html")).unwrap();
    assert!(
        page.contains("The zeros of the rig would be read over"),
        "on the page too"
    );
}

#[test]
fn a_limit_that_the_run_would_reach_is_exit_4_with_its_procedure_and_step() {
    // √(20 kg·300 kN/m)·1 m/s is about 2.4 kN.
    let workspace = Workspace::new("2");
    let (code, output, log) =
        workspace.psd(&["run", "plan.psd", "--check-run", "--yes", "--out", "out"]);
    assert_eq!(code, Some(4), "{output}{log}");
    assert!(
        output.contains("The run would be stopped in hit, step ") && output.contains("force 2."),
        "{output}"
    );
    assert!(
        workspace
            .psd(&["run", "plan.psd", "--check-run", "--accept"])
            .0
            == Some(2)
    );
}

#[test]
fn on_a_real_rig_the_prediction_is_of_the_stiffness_that_the_rig_shows() {
    let workspace = Workspace::new("15");
    let _simulator = Simulator::start(&workspace, "400 kN/m");
    let run = [
        "run",
        "plan.psd",
        "--rig",
        "bench",
        "--check-run",
        "--yes",
        "--operator",
        "A. Tester",
        "--out",
        "out",
    ];
    let (code, output, log) = workspace.psd(&run);
    assert_eq!(code, Some(0), "{output}{log}");
    let summary = workspace.summary();
    let measured = summary["procedures"]["k0"]["results"]["stiffness"]["value"]
        .as_f64()
        .unwrap();
    assert!((measured - 4e5).abs() < 0.02 * 4e5, "{measured}");
    assert!(
        output.contains("check run on rig `bench`") && output.contains("peak displacement"),
        "{output}"
    );
    assert_eq!(
        summary["deviations"][0],
        "Check run: the pre-test check and k0 ran on the rig; hit did not run and was predicted on a virtual specimen."
    );
    let pretest_check = summary["events"].as_array().unwrap().iter().any(|event| {
        event["text"]
            .as_str()
            .unwrap()
            .starts_with("pre-test check passed")
    });
    assert!(pretest_check, "{summary}");
    // The result of the plan's own virtual rig with a specimen of that stiffness, and not with that of the plan.
    let peak = output
        .lines()
        .find(|line| line.contains("peak displacement"))
        .unwrap();
    let millimetres: f64 = peak.split_whitespace().nth(2).unwrap().parse().unwrap();
    let set = format!("bench_stiffness={measured} N/m");
    assert_eq!(
        workspace
            .psd(&[
                "run", "plan.psd", "--yes", "--set", &set, "--out", "virtual"
            ])
            .0,
        Some(0)
    );
    let summary: Value = serde_json::from_str(
        &fs::read_to_string(workspace.path().join("virtual/summary.json")).unwrap(),
    )
    .unwrap();
    let expected = 1e3
        * summary["procedures"]["hit"]["results"]["max_displacement"]["value"]
            .as_f64()
            .unwrap();
    assert!(
        (millimetres - expected).abs() < 0.01 * expected,
        "{peak}, {expected} expected"
    );
    assert_eq!(workspace.psd(&["verify", "out"]).0, Some(0));
}
