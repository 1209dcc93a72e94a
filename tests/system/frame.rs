//! A frame of two storeys on a rig of two axes: whole runs as processes over a pseudo-terminal. In: a separate plan. Out: the
//! results of the simulated run and a verified run log. After a kill: the same end, and no target twice.

use std::fs;
use std::path::Path;

use rustix::process::Signal;

use crate::stage::{Ended, PSD, Stage, code, finish, signal, start, wait};

/// Elastic, so that the force depends on the position only, even if timing divides the path differently.
const PLAN: &str = r#"plan "Two storeys on two axes" {
  edition     = 1
  specimen_id = "SYS-2"
}

limits {
  displacement = -50 mm .. 50 mm
  force        = -20 kN .. 20 kN
  speed        = 500 mm/s
}

rig bench {
  link        = serial(port: "PORT", dialect: native, reply_timeout: 2 s)
  settle      = within(0.01 mm, 5 kN/s, for: 0.01 s, timeout: 20 s)
  safe_state  = hold
  watchdog    = 30 s
  rate        = 500 Hz
  samples     = 1
  speed       = 200 mm/s
  resolution  = 1 nm
  calibration = "UKAS 4711"
  calibration_due = "2027-03-01"
  axes        = [
    axis(pretest_check: probe(0.1 mm, stiffness: 450 kN/m .. 550 kN/m, zero: 20 N)),
    axis(
      polarity: negative,
      pretest_check: probe(0.1 mm, stiffness: 180 kN/m .. 220 kN/m, zero: 20 N),
      calibration: "UKAS 4712",
      displacement_calibration: "UKAS 4810",
      displacement_calibration_due: "2027-05-01",
      force_uncertainty: 0.4 %,
      zero_uncertainty: 1.5 N,
    ),
  ]
}

specimen frame {
  storeys = [
    storey(mass: 2 t, stiffness: 300 kN/m),
    storey(mass: 1.5 t, stiffness: 200 kN/m),
  ]
}

ground motion { file = "ground.csv" }

shake quake {
  ground        = motion
  damping_ratio = 2 %
  time_step     = 10 ms
  duration      = 0.4 s
}

require "drift" max(quake.max_drift) < 30 mm

report {
  figures = []
  formats = [html, csv]
}
"#;

const GROUND: &str = "time_s,acceleration_m_per_s2\n0,0\n0.1,2\n0.2,-3\n0.3,2\n0.4,0\n";

/// The stage of a plan, with its ground-motion file.
fn stage_of(plan: &str, ground: &str) -> Stage {
    scripted(plan, ground, "")
}

/// The same with a script of faults.
fn scripted(plan: &str, ground: &str, script: &str) -> Stage {
    let with_its_port = |text: &str| {
        let port = text
            .split("port: \"")
            .nth(1)
            .and_then(|rest| rest.split('"').next())
            .expect("the port of the stage");
        fs::write(Path::new(port).with_file_name("ground.csv"), ground).expect("ground");
        plan.replace("PORT", port)
    };
    Stage::of(with_its_port, script)
}

/// The plan with some of its words replaced.
fn plan_with(changes: &[(&str, &str)]) -> String {
    changes
        .iter()
        .fold(PLAN.to_owned(), |plan, (words, others)| {
            assert!(plan.contains(words), "no `{words}` in the plan");
            plan.replace(words, others)
        })
}

/// All numbers in the results of the ground-motion test, with the names of their results.
fn results(folder: &Path) -> Vec<(String, f64)> {
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap();
    let results = summary["procedures"]["quake"]["results"]
        .as_object()
        .expect("results");
    let numbers = |value: &serde_json::Value| match value {
        serde_json::Value::Array(values) => values
            .iter()
            .filter_map(serde_json::Value::as_f64)
            .collect(),
        one => one.as_f64().into_iter().collect::<Vec<_>>(),
    };
    let named = results.iter().flat_map(|(name, result)| {
        numbers(&result["value"])
            .into_iter()
            .map(|value| (name.clone(), value))
    });
    named.collect()
}

/// Duration of a step of [`continuous`] \[s\].
const CONTINUOUS_STEP: u64 = 15;

/// The same plan with continuous motion: three steps. The rig waits a fifth of a step, 3 s, for a late target: a busy machine has been
/// late by 2 s. In a larger part of a step it would move beyond its last commanded move, and psd does not go on from there.
fn continuous() -> Stage {
    let mode = format!(
        "  time_step     = 10 ms\n  mode          = continuous(time_scale: {})",
        100 * CONTINUOUS_STEP
    );
    let short = ("0.4 s\n}", "0.03 s\n}");
    let plan = plan_with(&[("  time_step     = 10 ms", &mode), short]);
    scripted(
        &plan,
        "time_s,acceleration_m_per_s2\n0,0\n0.05,2\n0.1,-3\n0.2,2\n",
        "at 0 s: coast 3 s",
    )
}

/// Ten steps of forty.
const SHORT: (&str, &str) = ("0.4 s\n}", "0.1 s\n}");

/// The same plan with a meter of two channels on its own port.
fn metered() -> Stage {
    let link = "  link        = serial(port: \"PORT\", dialect: native, reply_timeout: 2 s)\n";
    let meter = "  load_cell   = serial(port: \"PORT-meter\", dialect: scpi([25 kN, -12.5 kN]), reply_timeout: 2 s)\n";
    let devices = link.replace("link     ", "actuator ") + meter;
    stage_of(&plan_with(&[(link, &devices), SHORT]), GROUND)
}

/// Results of the plan on an ideal rig, for comparison with the run of the stage.
fn ideal_of(stage: &Stage) -> Vec<(String, f64)> {
    virtual_of(stage, "ideal")
}

/// The same on this virtual rig.
fn virtual_of(stage: &Stage, rig: &str) -> Vec<(String, f64)> {
    let mut virtual_run = std::process::Command::new(PSD);
    virtual_run
        .arg("run")
        .arg(stage.path("plan.psd"))
        .args(["--rig", rig, "--out"])
        .arg(stage.path("ideal"));
    succeeded(&wait(&mut virtual_run));
    results(&stage.path("ideal"))
}

/// All results of a run equal those of the ideal rig, within `far` of the name and size of the result.
fn same_but_for(real: &[(String, f64)], ideal: &[(String, f64)], far: impl Fn(&str, f64) -> f64) {
    assert!(real.len() == ideal.len() && real.len() > 8);
    for ((name, real), (_, ideal)) in real.iter().zip(ideal) {
        assert!(
            (real - ideal).abs() <= far(name, ideal.abs()),
            "{name}: {real} is not {ideal}"
        );
    }
}

/// The run of a stage is killed after this number of moves.
fn killed(stage: &Stage, moves: usize) {
    let mut running = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(moves);
    signal(&running, Signal::KILL);
    assert_eq!(code(&mut running), None);
    finish(running);
}

/// A run that is killed after this number of moves is resumed. It has the same end as an uninterrupted run.
fn killed_it_goes_on(cut_off: &Stage, moves: usize, whole: &Stage) {
    killed(cut_off, moves);
    cut_off.goes_on(&[]);
    assert_eq!(
        cut_off.moves(),
        whole.moves(),
        "each of all targets once, in order"
    );
    assert_eq!(results(&cut_off.path("run")), results(&whole.path("run")));
}

#[test]
fn a_meter_apart_gives_the_virtual_runs_results_and_killed_it_goes_on() {
    let whole = metered();
    succeeded(&wait(&mut whole.run_with(&["--yes"])));
    let report = fs::read_to_string(whole.path("run").join("report.html"))
        .unwrap()
        .replace('\u{a0}', " ");
    for expected in ["scpi", "25 kN per count", "12.5 kN per count"] {
        assert!(report.contains(expected), "no {expected}");
    }
    // Nine digits of 25 kN are 0.1 mN.
    same_but_for(
        &results(&whole.path("run")),
        &ideal_of(&whole),
        |name, size| {
            if name.contains("energy") || name.contains("error") {
                1e-5
            } else {
                2e-8 + 1e-6 * size
            }
        },
    );
    killed_it_goes_on(&metered(), 9, &whole);
}

/// Continuous in real time over a pseudo-terminal. A reading is slightly behind its target, and the force of an elastic frame
/// is corrected to it. The motion equals that of the simulated run, within the resolution of forces and positions on the line.
#[test]
fn two_axes_that_do_not_stop_give_the_virtual_runs_motion_and_killed_they_go_on() {
    let (whole, cut_off) = (continuous(), continuous());
    std::thread::scope(|scope| {
        scope.spawn(|| succeeded(&wait(&mut whole.run_with(&["--yes"]))));
        // Four moves of the pre-test check, two of the beginning, two of each step: in the second of three.
        killed(&cut_off, 9);
        // It receives no next target: it holds automatically after the end of its path.
        std::thread::sleep(std::time::Duration::from_secs(CONTINUOUS_STEP + 4));
        cut_off.goes_on(&[]);
    });
    let proven = whole.proven();
    assert!(
        proven.contains("recomputed from the run log, byte for byte"),
        "{proven}"
    );
    let ideal = ideal_of(&whole);
    for stage in [&whole, &cut_off] {
        same_but_for(
            &results(&stage.path("run")),
            &ideal,
            |name, size| match name {
                "max_displacement" | "max_drift" | "periods" => 1e-7 + 1e-5 * size,
                _ => f64::INFINITY,
            },
        );
    }
}

fn succeeded(ended: &Ended) {
    assert_eq!(ended.code, Some(0), "{}", ended.output);
}

#[test]
fn two_axes_give_the_virtual_runs_results_and_killed_they_go_on_to_the_same_end() {
    let whole = stage_of(PLAN, GROUND);
    let ran = wait(&mut whole.run_with(&["--yes"]));
    succeeded(&ran);
    for axis in [
        "pre-test check passed by axis 1: ",
        "pre-test check passed by axis 2: ",
    ] {
        assert!(ran.output.contains(axis), "{}", ran.output);
    }
    let proven = whole.proven();
    assert!(
        proven.contains("recomputed from the run log, byte for byte"),
        "{proven}"
    );
    let report = fs::read_to_string(whole.path("run").join("report.html")).unwrap();
    for expected in [
        "displacement 1",
        "force 2",
        "UKAS 4711",
        "UKAS 4712",
        "UKAS 4810",
        "force 0.40\u{a0}%; zero offset of the force 1.5",
    ] {
        assert!(report.contains(expected), "{expected} is not on the report");
    }
    // The resolution of the line is 1 nm and 1 mN. The energy error, zero on an ideal rig, is relative to the input energy.
    same_but_for(
        &results(&whole.path("run")),
        &ideal_of(&whole),
        |name, size| {
            if name.contains("energy_error") || name.contains("nrms_error") {
                1e-6
            } else {
                2e-8 + 1e-6 * size
            }
        },
    );
    killed_it_goes_on(&stage_of(PLAN, GROUND), 17, &whole);
}

/// The lower storey under 60 kN, which lower its stiffness by a fifteenth.
fn under_load() -> Stage {
    let axial = "      zero_uncertainty: 1.5 N,\n    ),\n    axis(\n      axial: 1,\n      control: force(rate: 2 MN/s, tolerance: 0.5 kN),\n      \
                 p_delta: 100 %,\n      displacement: -4 mm .. 4 mm,\n      calibration: \"UKAS 4713\",\n    ),\n";
    let simulated = "rig simulated {\n  link = virtual\n  axes = [\n    axis,\n    axis,\n    axis(\n      axial: 1,\n      \
                     control: force(rate: 2 MN/s, tolerance: 0.5 kN),\n      p_delta: 100 %,\n      displacement: -4 mm .. 4 mm,\n    ),\n  ]\n}\n\n\
                     specimen frame {";
    let plan = plan_with(&[
        ("specimen frame {", simulated),
        ("      zero_uncertainty: 1.5 N,\n    ),\n", axial),
        ("storey(mass: 2 t,", "storey(mass: 2 t, height: 3 m,"),
        ("-20 kN .. 20 kN", "-80 kN .. 80 kN"),
        (
            "shake quake {",
            "preload load {\n  storey = 1\n  force = 60 kN\n}\n\nshake quake {",
        ),
        ("require \"drift\"", "unload rest { }\n\nrequire \"drift\""),
        SHORT,
    ]);
    stage_of(&plan, GROUND)
}

/// The controller holds the load while nobody asks it anything.
#[test]
fn an_axial_load_is_held_by_its_controller_and_killed_the_run_goes_on_under_it() {
    let whole = under_load();
    let ran = wait(&mut whole.run_with(&["--yes"]));
    succeeded(&ran);
    for expected in [
        "AXIAL of storey 1 LOADS it to 60 kN at 2000000 N/s and holds this in FORCE CONTROL until `unload`, also if psd ends",
        "lower by 20.00 kN/m (20.00 kN/m expected)",
    ] {
        assert!(ran.output.contains(expected), "{}", ran.output);
    }
    let proven = whole.proven();
    assert!(
        proven.contains("recomputed from the run log, byte for byte"),
        "{proven}"
    );
    same_but_for(
        &results(&whole.path("run")),
        &virtual_of(&whole, "simulated"),
        |name, size| {
            if name.contains("energy_error") || name.contains("nrms_error") {
                1e-6
            } else {
                2e-8 + 1e-6 * size
            }
        },
    );
    // While the load grows, and while the floors move under it.
    for moves in [10, 24] {
        killed_it_goes_on(&under_load(), moves, &whole);
    }
}
