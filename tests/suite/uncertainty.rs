//! The uncertainty of an impact in the outputs for the user: in `summary.json`, on the test report, in a verdict, and reproduced from the
//! record.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const PLAN: &str = r#"plan "Uncertain" { decision_rule = guarded }

param speed = 1 m/s between 0.5 m/s .. 2 m/s

specimen beam {
  mass             = 1 kg
  mass_uncertainty = 20 g
  behaviour        = bilinear(stiffness: 300 kN/m, yield_force: 2 kN, post_yield_ratio: 0.1)
}

rig simulated {
  link              = virtual(noise: 2 N, seed: 3)
  force_uncertainty = 1 %
  zero_uncertainty  = 1 N
}

striker hammer {
  mass                 = 20 kg
  velocity             = speed
  velocity_uncertainty = 1 % * velocity
}

stiffness ramp k0 { displacements = 0.2 mm .. 1 mm step 0.2 mm }

impact hit {
  striker   = hammer
  stiffness = k0.stiffness
  contact   = restitution(0.2)
  time_step = 0.2 ms
  duration  = 60 ms
}

require "stays in travel" hit.max_displacement <= 8.5 mm

report {
  figures = []
  formats = [html, csv]
}
"#;

fn psd(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// u is the root of the sum of squares of the lines of the budget. Each line is the uncertainty of its input times its sensitivity.
#[test]
fn a_budget_adds_up_and_comes_out_of_the_record_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("plan.psd"), PLAN).unwrap();
    let ran = psd(folder.path(), &["run", "plan.psd", "--out", "run"]);
    assert_eq!(
        ran.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&ran.stdout)
    );
    let summary = summary(&at("run"));
    let hit = &summary["procedures"]["hit"];
    let budgets = hit["uncertainty_budgets"].as_object().unwrap();
    assert!(budgets.len() >= 8);
    for (name, budget) in budgets {
        let (u, contributions) = (
            number(&budget["u"]),
            budget["contributions"].as_array().unwrap(),
        );
        assert_eq!(hit["results"][name]["u"], budget["u"], "{name}");
        let squares: f64 = contributions
            .iter()
            .map(|line| number(&line["contribution"]).powi(2))
            .sum();
        assert!((squares.sqrt() / u - 1.0).abs() < 1e-9, "{name}");
        for line in contributions
            .iter()
            .filter(|line| !line["sensitivity"].is_null())
        {
            let product = number(&line["sensitivity"]).abs() * number(&line["input_u"]);
            assert!(
                (product / number(&line["contribution"]).abs() - 1.0).abs() < 1e-9,
                "{name}: {line}"
            );
        }
    }
    let inputs: Vec<&str> = budgets["max_displacement"]["contributions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|line| line["input"].as_str().unwrap())
        .collect();
    for input in [
        "hammer.velocity",
        "force calibration",
        "zero offset of the load cell",
        "beam.mass",
        "noise and resolution of the readings",
    ] {
        assert!(inputs.contains(&input), "{input} is not among {inputs:?}");
    }
    let page = fs::read_to_string(at("run/report.html")).unwrap();
    assert!(
        page.contains("ncertainty budget of max displacement")
            && page.contains("First-order propagation")
    );
    assert!(
        !page.contains("ncertainty budget of impulse"),
        "no requirement reads it"
    );

    assert_eq!(
        psd(folder.path(), &["verify", "run"]).status.code(),
        Some(0)
    );
    assert_eq!(
        psd(folder.path(), &["report", "run", "--out", "again"])
            .status
            .code(),
        Some(0)
    );
    for name in ["summary.json", "report.html"] {
        assert_eq!(
            fs::read(at("run").join(name)).unwrap(),
            fs::read(at("again").join(name)).unwrap(),
            "{name}"
        );
    }
}

/// A limit inside the guard band: the verdict is inconclusive.
#[test]
fn a_limit_within_the_uncertainty_is_inconclusive() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("plan.psd"),
        PLAN.replace("<= 8.5 mm", "<= 0.1 mm"),
    )
    .unwrap();
    psd(folder.path(), &["run", "plan.psd", "--out", "first"]);
    let first = summary(&folder.path().join("first"));
    assert_eq!(first["verdict"], "fail");
    let found = &first["procedures"]["hit"]["results"]["max_displacement"];
    let (value, u) = (number(&found["value"]), number(&found["u"]));
    for (margin, verdict, code) in [
        (1.0, "inconclusive", 1),
        (-1.0, "inconclusive", 1),
        (3.0, "pass", 0),
        (-3.0, "fail", 1),
    ] {
        let limit = format!("<= {} m", value + margin * u);
        fs::write(
            folder.path().join("plan.psd"),
            PLAN.replace("<= 8.5 mm", &limit),
        )
        .unwrap();
        let out = format!("at {margin}");
        let ran = psd(folder.path(), &["run", "plan.psd", "--out", &out]);
        assert_eq!(ran.status.code(), Some(code), "{limit}");
        assert_eq!(
            summary(&folder.path().join(&out))["verdict"],
            verdict,
            "{limit}"
        );
    }
}
