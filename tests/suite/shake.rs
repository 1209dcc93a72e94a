//! Frames on moving ground, from the text of a plan: compared with the closed form of a steady motion, with every integrator. The record
//! alone is sufficient without its source files.

use std::fs;
use std::path::Path;
use std::process::Command;

use psd::check::{LoadError, Options, check};
use psd::run::{Unwatched, run};
use psd_plan::formula::ResultValue;
use psd_plan::record::{Outcome, Record};
use psd_rig::virtual_rig;

/// Largest acceleration of the ground \[m/s²\], its angular frequency \[rad/s\], and the damping ratio of both modes.
const GROUND: f64 = 0.5;
const FREQUENCY: f64 = 4.0 * std::f64::consts::PI;
const RATIO: f64 = 0.1;

/// A sine sampled every millisecond for sixteen periods, and matrices of a plan.
fn files(path: &str) -> Result<String, LoadError> {
    // Two floors of 1 t on storeys of k: ω² = (3 − √5)/2 · k/m equals that of the ground.
    let k = 1000.0 * FREQUENCY * FREQUENCY * (3.0 + 5.0_f64.sqrt()) / 2.0;
    match path {
        "sine.csv" => {
            let row = |step: u32| {
                let time = f64::from(step) * 1e-3;
                format!("{time},{}\n", GROUND * (FREQUENCY * time).sin())
            };
            Ok(format!(
                "time_s,acceleration_m_per_s2\n{}",
                (0..=8000).map(row).collect::<String>()
            ))
        }
        "m.csv" => Ok("1000, 0\n0, 1000\n".to_owned()),
        "k.csv" => Ok(format!("{}, {}\n{}, {k}\n", 2.0 * k, -k, -k)),
        _ => Err(LoadError::NotFound),
    }
}

fn record(specimen: &str, shake: &str) -> Record {
    let text = format!(
        "{specimen}\nground sine {{ file = \"sine.csv\" }}\nshake steady {{\n  ground = sine\n  damping_ratio = 10 %\n{shake}\n}}\n"
    );
    let checked = check("plan.psd", &text, &files, &Options::default());
    let plan = checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
    assert_eq!(
        plan.files.len(),
        if specimen.contains("matrix") { 4 } else { 2 },
        "the plan and its data"
    );
    let record = run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched);
    assert_eq!(record.outcome, Outcome::Completed);
    record
}

const STOREYS: &str = "let k = 1 t * (4 * 3.141592653589793 / 1 s)^2 * (3 + sqrt(5)) / 2
specimen frame { storeys = [storey(mass: 1 t, stiffness: k), storey(mass: 1 t, column_stiffness: k / 2)] }";

const MATRICES: &str =
    "specimen frame {\n  mass_matrix = \"m.csv\"\n  stiffness_matrix = \"k.csv\"\n}";

fn list(record: &Record, name: &str) -> Vec<f64> {
    match &record.procedures[0]
        .result(name)
        .expect("a result of the schema")
        .value
    {
        ResultValue::List(values) => values.clone(),
        other @ ResultValue::Number { .. } => panic!("{name} is {other:?}"),
    }
}

/// Steady amplitude of both floors, m: each mode is a degree of freedom a = Γφ·a_g/(ω_n² − ω² + 2iζω_nω), added as complex
/// numbers. The modes move the floors as 1 : g and g : −1, g the golden ratio, and ω₂ = g²ω.
fn closed_form() -> [f64; 2] {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mode = |shape: [f64; 2], own: f64| {
        let participation = (shape[0] + shape[1]) / (shape[0] * shape[0] + shape[1] * shape[1]);
        let (real, imaginary) = (
            own * own - FREQUENCY * FREQUENCY,
            2.0 * RATIO * own * FREQUENCY,
        );
        let size = participation * GROUND / (real * real + imaginary * imaginary);
        shape.map(|entry| (entry * size * real, -entry * size * imaginary))
    };
    let (first, second) = (
        mode([1.0, golden], FREQUENCY),
        mode([golden, -1.0], golden * golden * FREQUENCY),
    );
    [0, 1].map(|floor| (first[floor].0 + second[floor].0).hypot(first[floor].1 + second[floor].1))
}

/// Largest error of the two floors, as a fraction of the closed form.
fn error(record: &Record) -> f64 {
    let found = list(record, "max_displacement");
    found
        .iter()
        .zip(closed_form())
        .map(|(found, exact)| (found / exact - 1.0).abs())
        .fold(0.0, f64::max)
}

/// At resonance the motion grows to its steady amplitude, e⁻¹⁰ from it after sixteen periods. The peak of the run is thus that of the
/// steady motion. The error decreases with the square of the step until the limit of sixteen periods dominates.
#[test]
fn a_steady_motion_is_the_closed_form_and_converges_with_the_square_of_the_step() {
    for integrator in ["tangent", "alpha_os(alpha: 0)", "explicit"] {
        let of = |step: &str| {
            error(&record(
                STOREYS,
                &format!("  integrator = {integrator}\n  time_step = {step}"),
            ))
        };
        let (coarse, fine) = (of("10 ms"), of("5 ms"));
        assert!(coarse < 3e-3, "{integrator}: {coarse}");
        assert!(
            (3.0..5.0).contains(&(coarse / fine)),
            "{integrator}: {coarse} and {fine}"
        );
    }
}

#[test]
fn matrices_from_files_give_the_motion_of_the_storeys_they_were_made_of() {
    let shake = "  time_step = 10 ms\n  integrator = explicit";
    let (storeys, matrices) = (record(STOREYS, shake), record(MATRICES, shake));
    for name in ["max_displacement", "max_drift", "final_drift", "periods"] {
        for (one, other) in list(&storeys, name).iter().zip(list(&matrices, name)) {
            assert!(
                (one - other).abs() <= 1e-9 * one.abs(),
                "{name}: {one} and {other}"
            );
        }
    }
    let periods = list(&storeys, "periods");
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    assert!(
        (periods[0] - 0.5).abs() < 1e-12 && (periods[1] - 0.5 / (golden * golden)).abs() < 1e-12,
        "{periods:?}"
    );
}

fn psd(arguments: &[&str], out: &Path) {
    let ended = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(arguments)
        .arg(out)
        .output()
        .expect("psd starts");
    assert!(
        ended.status.success(),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&ended.stderr)
    );
}

/// A run, its verification and its regenerated report give the same bytes without the plan and its data. The record contains both.
#[test]
fn the_record_of_a_shake_is_enough() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let plans = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans");
    fs::create_dir(path("ground")).expect("a folder");
    fs::create_dir(path("lib")).expect("a folder");
    for file in [
        "two_storeys_yielding.psd",
        "ground/three_sines.csv",
        "lib/two_actuator_frame.psd",
    ] {
        fs::copy(plans.join(file), path(file)).expect("a copy");
    }
    let plan = path("two_storeys_yielding.psd");
    psd(
        &["run", plan.to_str().expect("UTF-8"), "--yes", "--out"],
        &path("run"),
    );
    fs::remove_file(&plan).expect("removed");
    fs::remove_dir_all(path("ground")).expect("removed");
    fs::remove_dir_all(path("lib")).expect("removed");
    psd(&["verify"], &path("run"));
    psd(
        &["report", path("run").to_str().expect("UTF-8"), "--out"],
        &path("again"),
    );
    let read = |folder: &str, name: &str| {
        fs::read(path(folder).join(name)).unwrap_or_else(|_| panic!("{folder}/{name} is there"))
    };
    for name in [
        "summary.json",
        "tables/quake.csv",
        "tables/quake.parquet",
        "figures/quake_hysteresis.png",
        "report.html",
        "report.pdf",
        "plan/ground/three_sines.csv",
    ] {
        assert!(read("run", name) == read("again", name), "{name} differs");
    }
    let table = String::from_utf8(read("run", "tables/quake.csv")).expect("UTF-8");
    assert_eq!(
        table.lines().count(),
        1 + 2 * 1201,
        "a row a step and storey"
    );
    assert!(table.starts_with(
        "step,storey,time_s,wall_time_s,ground_acceleration_m_per_s2,command_m,displacement_m"
    ));
}

/// A floor with a weight has the shear of its springs and the work of the weights in the table; net and gross shear differ by P δ/h.
#[test]
fn the_table_of_a_frame_with_weights_has_net_and_gross_shear() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("sine.csv"), files("sine.csv").unwrap()).expect("written");
    let table = |gravity: &str| -> Vec<Vec<String>> {
        let plan = folder.path().join("plan.psd");
        let text = format!(
            "specimen frame {{ storeys = [storey(mass: 1 t, stiffness: 1 MN/m, height: 3 m{gravity})] }}\n\
             ground sine {{ file = \"sine.csv\" }}\n\
             shake quake {{\n  ground = sine\n  duration = 1 s\n}}\n\
             require \"drift\" max(quake.max_drift) < 1 m\n\
             report {{ formats = [csv] }}\n"
        );
        fs::write(&plan, text).expect("written");
        let out = folder.path().join(format!("run{}", gravity.len()));
        psd(&["run", plan.to_str().expect("UTF-8"), "--out"], &out);
        let table = fs::read_to_string(out.join("tables/quake.csv")).expect("a table");
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        table.lines().map(cells).collect()
    };
    let (light, heavy) = (table(""), table(", gravity: 300 kN"));
    let own = ["spring_shear_n", "gravity_energy_j"];
    assert!(
        own.iter()
            .all(|name| !light[0].iter().any(|found| found == name))
    );
    let kept: Vec<&String> = heavy[0]
        .iter()
        .filter(|name| !own.contains(&name.as_str()))
        .collect();
    assert_eq!(kept, light[0].iter().collect::<Vec<_>>());
    let column = |name: &str| heavy[0].iter().position(|found| found == name).unwrap();
    let number = |row: &[String], name: &str| -> f64 { row[column(name)].parse().unwrap() };
    let mut largest: f64 = 0.0;
    for row in &heavy[1..] {
        let gross = number(row, "spring_shear_n");
        let drift = number(row, "drift_m");
        let net = number(row, "storey_shear_n");
        assert!((gross - 1e6 * drift).abs() < 1e-9 * gross.abs().max(1.0));
        assert!((net - (1e6 - 1e5) * drift).abs() < 1e-9 * gross.abs().max(1.0));
        let work = number(row, "gravity_energy_j");
        assert!((work - 0.5e5 * drift * drift).abs() < 1e-9 * work.max(1e-3));
        largest = largest.max(net.abs());
    }
    assert!(largest > 100.0);
}
