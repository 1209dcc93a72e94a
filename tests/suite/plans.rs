//! The plans of `plans/`, run like a user would: through the program, to a run folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{LazyLock, OnceLock};

use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every plan of `plans/`, by name, in order.
fn plans() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(root().join("plans"))
        .expect("plans/ is there")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| {
            let ending = path.extension().unwrap_or_default();
            ending == "psd" || ending == "md" && !path.ends_with("README.md")
        })
        .collect();
    found.sort();
    found
}

/// The date of every run here: runs of two days have the same results and differ in their dates.
const DATE: &str = "2026-05-31";

fn psd_run(plan: &Path, out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_psd"))
        .args([
            "run",
            plan.to_str().expect("UTF-8"),
            "--yes",
            "--date",
            DATE,
            "--out",
            out.to_str().expect("UTF-8"),
        ])
        .output()
        .expect("psd starts")
}

/// A plan of `plans/`, run.
struct Run {
    folder: PathBuf,
    output: Output,
}

/// Runs a plan of `plans/` once for all tests that require it.
fn ran(plan: &str) -> &'static Run {
    static RUNS: LazyLock<BTreeMap<String, OnceLock<Run>>> = LazyLock::new(|| {
        let name = |plan: PathBuf| {
            plan.file_stem()
                .expect("named")
                .to_string_lossy()
                .into_owned()
        };
        plans()
            .into_iter()
            .map(|plan| (name(plan), OnceLock::new()))
            .collect()
    });
    RUNS[plan].get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join("plans")
            .join(plan);
        if folder.exists() {
            fs::remove_dir_all(&folder).expect("what an earlier test left can go");
        }
        let path = plans()
            .into_iter()
            .find(|path| path.file_stem().is_some_and(|stem| stem == plan))
            .expect("a plan of that name");
        let output = psd_run(&path, &folder);
        Run { folder, output }
    })
}

fn summary(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("summary.json")).expect("a run leaves summary.json");
    serde_json::from_str(&text).expect("summary.json is JSON")
}

fn result(summary: &Value, procedure: &str, name: &str) -> f64 {
    summary["procedures"][procedure]["results"][name]["value"]
        .as_f64()
        .unwrap_or_else(|| panic!("{procedure}.{name} is a number"))
}

/// Every file under a folder with its bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(current) = folders.pop() {
        for entry in fs::read_dir(&current).expect("readable") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path
                    .strip_prefix(folder)
                    .expect("inside")
                    .to_string_lossy()
                    .into_owned();
                found.insert(name, fs::read(&path).expect("readable"));
            }
        }
    }
    found
}

#[test]
fn every_plan_runs_to_a_pass() {
    /// Number of concurrent runs: this test begins late, and its runs would be the last, one after the other.
    const AT_ONCE: usize = 4;
    let plans = plans();
    assert!(plans.len() >= 11, "five tutorials and six of the paper");
    let passes = |plan: &PathBuf| {
        let Run { folder, output } = ran(&plan.file_stem().expect("named").to_string_lossy());
        assert!(
            output.status.success(),
            "{}: {}",
            plan.display(),
            String::from_utf8_lossy(&output.stderr)
        );
        assert_eq!(summary(folder)["verdict"], "pass", "{}", plan.display());
    };
    std::thread::scope(|scope| {
        for part in plans.chunks(plans.len().div_ceil(AT_ONCE)) {
            scope.spawn(move || part.iter().for_each(passes));
        }
    });
}

/// The paper's cases to the digits of the derivation: value and half a unit of its last digit.
#[test]
fn the_papers_figures_come_out_of_the_program() {
    let cases: &[(&str, &str, f64, f64)] = &[
        ("example_1", "max_displacement", 0.157_864, 5e-7),
        ("example_1", "stop_time", 0.29, 1e-9),
        ("example_1", "max_contact_force", 252.0, 0.5),
        ("example_1", "critical_time_step", 0.0347, 5e-5),
        ("example_1_converged", "max_displacement", 0.157_70, 5e-6),
        ("example_1_converged", "stop_time", 0.2805, 5e-5),
        ("example_2", "max_displacement", 0.168_965, 5e-7),
        ("example_2", "stop_time", 0.28, 1e-9),
        ("example_2", "max_contact_force", 97.7, 0.05),
        ("limit_5000", "max_displacement", 0.164_429, 5e-7),
        ("limit_5000", "stop_time", 0.297, 1e-9),
        ("limit_5000", "max_contact_force", 2301.0, 0.5),
        ("limit_1500", "max_displacement", 0.165_524, 5e-7),
        ("limit_1500", "stop_time", 0.3, 1e-9),
        ("limit_1500", "max_contact_force", 1500.0, 1e-9),
        ("limit_1500", "indentation_energy", 3.35, 5e-3),
    ];
    for (plan, name, expected, tolerance) in cases {
        let value = result(&summary(&ran(plan).folder), "hit", name);
        assert!(
            (value - expected).abs() <= *tolerance,
            "{plan}: {name} is {value}, expected {expected} ± {tolerance}"
        );
    }
}

/// A derived figure and half a unit of its last digit.
type Derived = (f64, f64);

/// Rows of the reference results through `psd run`: (contact, [M, K, Δt, Ms]) → largest displacement and stop time, to their last
/// derived digit. One row for Δt → 0 is run at a step that resolves it; `physics::reference` has all of them.
#[test]
fn the_reference_rows_come_out_of_the_program() {
    let rows: &[(&str, [&str; 4], Derived, Derived)] = &[
        (
            "rigid",
            ["1 kg", "327.65 N/m", "10 ms", "10 kg"],
            (0.157_864, 5e-7),
            (0.29, 1e-9),
        ),
        (
            "rigid",
            ["1 kg", "327.65 N/m", "1 ms", "10 kg"],
            (0.157_353, 5e-7),
            (0.284, 1e-9),
        ),
        (
            "rigid",
            ["0.25 kg", "327.65 N/m", "10 ms", "10 kg"],
            (0.168_965, 5e-7),
            (0.28, 1e-9),
        ),
        (
            "limit(5000 N)",
            ["1 kg", "300 N/m", "1 ms", "10 kg"],
            (0.164_429, 5e-7),
            (0.297, 1e-9),
        ),
        (
            "limit(1500 N)",
            ["1 kg", "300 N/m", "1 ms", "10 kg"],
            (0.165_524, 5e-7),
            (0.3, 1e-9),
        ),
        (
            "limit(1500 N)",
            ["1 kg", "300 N/m", "2 us", "10 kg"],
            (0.174_078, 1.5e-6),
            (0.301_09, 1.5e-5),
        ),
        (
            "rigid",
            ["0.5 kg", "300 kN/m", "0.5 ms", "20 kg"],
            (7.922e-3, 5e-7),
            (13.5e-3, 1e-9),
        ),
        (
            "rigid",
            ["0.75 kg", "300 kN/m", "0.5 ms", "20 kg"],
            (7.855e-3, 5e-7),
            (13.5e-3, 1e-9),
        ),
    ];
    let scratch = tempfile::tempdir().expect("a folder");
    for (number, (contact, [mass, stiffness, time_step, striker], displacement, stop)) in
        rows.iter().enumerate()
    {
        let plan = scratch.path().join(format!("row_{number}.psd"));
        let text = format!(
            "specimen s {{\n  mass = {mass}\n  behaviour = elastic(stiffness: {stiffness})\n}}\n\
             striker m {{\n  mass = {striker}\n  velocity = 1 m/s\n}}\n\
             impact hit {{\n  striker = m\n  contact = {contact}\n  time_step = {time_step}\n  duration = 1 s\n}}\n\
             report {{\n  figures = []\n  formats = [html]\n}}\n"
        );
        fs::write(&plan, text).expect("a plan");
        let out = scratch.path().join(format!("out_{number}"));
        let output = psd_run(&plan, &out);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let run = summary(&out);
        for (name, (expected, tolerance)) in
            [("max_displacement", displacement), ("stop_time", stop)]
        {
            let value = result(&run, "hit", name);
            assert!(
                (value - expected).abs() <= *tolerance,
                "row {number}: {name} is {value}, expected {expected} ± {tolerance}"
            );
        }
    }
}

#[test]
fn the_beam_is_near_its_converged_value_and_the_papers_energy() {
    let run = summary(&ran("beam").folder);
    let displacement = result(&run, "hit", "max_displacement");
    assert!(
        (displacement / 7.735e-3 - 1.0).abs() < 0.003,
        "converged 7.735 mm, here {displacement} m"
    );
    let absorbed = result(&run, "hit", "absorbed_energy");
    assert!(
        (absorbed / 9.48 - 1.0).abs() < 0.10,
        "the paper reckons 9.48 J, here {absorbed} J"
    );
    assert!(
        run["procedures"]["k0"]["results"]["stiffness"]["u"]
            .as_f64()
            .is_some_and(|u| u > 0.0),
        "a measured stiffness has u"
    );
}

/// `20 J` says nothing without the condition that an impact passes.
#[test]
fn the_report_of_a_series_states_its_criterion() {
    let folder = &ran("rising_blows").folder;
    let page = fs::read_to_string(folder.join("report.html")).expect("a report");
    for expected in [
        "an impact passes while max displacement &lt; 15 mm",
        "next impact while max displacement &lt; 15 mm",
        "impact 5 of 80.00 J ends the series: max_displacement &lt; 15 mm is false, the value is ",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
    // Of its five requirements, one reads `last_passed_energy`, and one reads `passed`.
    assert_eq!(page.matches("an impact passes while").count(), 2);
    let figures = fs::read_dir(folder.join("figures")).expect("figures");
    let lines = figures
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "svg"))
        .filter(|path| {
            let text = fs::read_to_string(path).expect("a picture");
            text.contains("while max displacement")
        })
        .count();
    assert_eq!(lines, 2, "the series, and its motion in time");
}

#[test]
fn the_same_plan_and_date_give_the_same_bytes_of_every_result() {
    let scratch = tempfile::tempdir().expect("a folder");
    for plan in ["beam", "limit_1500"] {
        let second = scratch.path().join(plan);
        psd_run(&root().join(format!("plans/{plan}.psd")), &second);
        let (first, second) = (files(&ran(plan).folder), files(&second));
        assert!(first.contains_key("report.html") && first.contains_key("summary.json"));
        assert_eq!(
            first.keys().collect::<Vec<_>>(),
            second.keys().collect::<Vec<_>>()
        );
        // The run log has the start of the run, and the manifest its digest.
        let of_this_run = ["journal.psdj", "manifest.sha256"];
        for (name, bytes) in &first {
            assert!(
                of_this_run.contains(&name.as_str()) != (bytes == &second[name]),
                "{plan}: {name}"
            );
        }
    }
}

/// The accepted results equal the present results of the program, by the program's own test.
#[test]
fn the_accepted_reports_are_true() {
    let scratch = tempfile::tempdir().expect("a folder");
    let failures = scratch.path().join("failures");
    let output = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(["test", "plans", "--out", failures.to_str().expect("UTF-8")])
        .current_dir(root())
        .output()
        .expect("psd starts");
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{messages}");
    assert!(
        messages.contains(&format!("{} plans as accepted", plans().len()))
            && !messages.contains("unused"),
        "{messages}"
    );
}
