//! A real OpenSees drives a real rig: its `genericClient` with `psd rig serve` and a rig emulator behind a pseudo-terminal. It also moves
//! a frame with weights by itself. In: the scripts beside this file, and an OpenSees for Python. Out: the closed-form motion of its
//! integrator; the motion of the same frame in psd.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::served::Served;
use crate::stage::{Stage, wait};

/// The constants of the script in kg, m/s, s; and the stiffness of the stage's specimen \[N/m\].
const MASS: f64 = 20.0;
const VELOCITY: f64 = 0.07;
const TIME_STEP: f64 = 1e-3;
const STEPS: usize = 30;
const STIFFNESS: f64 = 1e5;

/// A Python with OpenSees: that of `.ci/run`, otherwise that of the machine. It is not a program of the system, so a machine
/// without it is not an error.
fn python() -> Option<PathBuf> {
    let of_ci = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/opensees/bin/python3");
    let can = |python: &PathBuf| {
        let mut import = Command::new(python);
        let import = import
            .args(["-c", "import openseespy.opensees"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        import.status().is_ok_and(|status| status.success())
    };
    let found = [of_ci, PathBuf::from("python3")].into_iter().find(can);
    if found.is_none() {
        println!("SKIPPED: no Python here has OpenSees");
    }
    found
}

/// `NewmarkExplicit` with γ = ½ is the central difference: u(n) = A·sin(n·ω̄·Δt) with sin(ω̄·Δt/2) = ω·Δt/2. A is such that the
/// first step is V·Δt, because the force at rest is zero. A force is transmitted with three decimals of a newton. The n-th
/// position can deviate by the acceleration of half a unit of the last decimal over the elapsed time.
#[test]
fn a_real_opensees_gets_the_closed_form_of_its_integrator_out_of_a_real_rig() {
    let Some(python) = python() else { return };
    let mut served = Served::start_on(Stage::new(), "generic-client", &["--once"]);
    let port = served.address.rsplit(':').next().unwrap().to_owned();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/system/opensees.py");
    let ended = wait(Command::new(python).arg(script).arg(port));
    assert_eq!(ended.code, Some(0), "{}", ended.output);
    let displacements: Vec<f64> = serde_json::from_str(
        ended
            .output
            .lines()
            .find(|line| line.starts_with('['))
            .unwrap(),
    )
    .unwrap();
    assert_eq!(displacements.len(), STEPS);
    let angle = 2.0 * ((STIFFNESS / MASS).sqrt() * TIME_STEP / 2.0).asin();
    let amplitude = VELOCITY * TIME_STEP / angle.sin();
    let mut time = 0.0;
    for (step, found) in (1_u32..).zip(&displacements) {
        time += TIME_STEP;
        let expected = amplitude * (f64::from(step) * angle).sin();
        let allowed = 0.5e-3 / MASS * time * time + 1e-9;
        assert!(
            (found - expected).abs() <= allowed,
            "step {step}: {found} is not within {allowed} of {expected}"
        );
    }
    let largest = displacements.iter().copied().fold(0.0, f64::max);
    assert!(
        (largest / ((MASS / STIFFNESS).sqrt() * VELOCITY) - 1.0).abs() < 2e-3,
        "√(M/K)·V: {largest}"
    );
    let (code, printed) = served.ended();
    assert_eq!(code, Some(0), "{printed}");
    assert!(
        printed.starts_with("session: closed by the client\n"),
        "{printed}"
    );
    served.held();
    // The targets of OpenSees are the commands that the rig received.
    let table =
        std::fs::read_to_string(served.stage.path("run").join("tables/served.csv")).unwrap();
    let header: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = header
        .iter()
        .position(|name| name.starts_with("command"))
        .unwrap();
    let commands: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(column).unwrap().parse().unwrap())
        .collect();
    assert!(
        displacements.iter().all(|position| commands
            .iter()
            .any(|command| (command - position).abs() <= 1e-9)),
        "{commands:?}"
    );
}

/// A leaning column of corotational trusses carries the weights; P/h is 17 % or 7 % of the stiffness: elastic, yielding, and with a
/// negative tangent after yield.
#[test]
fn a_frame_with_weights_moves_as_that_of_opensees_beside_a_leaning_column() {
    let Some(python) = python() else { return };
    let storeys = [(2000, 6e5, 6e3), (1500, 4.5e5, 5e3), (1000, 3.5e5, 4e3)];
    for (ratio, weights, amplitude) in [
        ("0.999999", [3e5, 2e5, 1e5], 0.5),
        ("0.2", [3e5, 2e5, 1e5], 1.5),
        ("0.05", [1e5, 8e4, 6e4], 1.5),
    ] {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/system/opensees_p_delta.py");
        let listed = weights.map(|weight: f64| weight.to_string()).join(",");
        let ended = wait(Command::new(&python).arg(script).args([
            ratio,
            &listed,
            "6",
            &amplitude.to_string(),
        ]));
        assert_eq!(ended.code, Some(0), "{}", ended.output);
        let line = ended.output.lines().find(|line| line.starts_with('['));
        let theirs: Vec<[f64; 3]> = serde_json::from_str(line.unwrap()).unwrap();
        for integrator in ["tangent", "alpha_os(alpha: 0)"] {
            let folder = tempfile::tempdir().unwrap();
            let sample = |sample: u32| {
                let time = f64::from(sample) * 1e-3;
                format!("{time},{}\n", amplitude * (9.0 * time).sin())
            };
            let record: String = (0..=3000).map(sample).collect();
            let record = format!("time_s,acceleration_m_per_s2\n{record}");
            std::fs::write(folder.path().join("ground.csv"), record).unwrap();
            let storey = |((mass, stiffness, force), weight): ((i32, f64, f64), f64)| {
                format!(
                    "storey(mass: {mass} kg, height: 6 m, gravity: {weight} N, behaviour: bilinear(stiffness: \
                     {stiffness} N/m, yield_force: {force} N, post_yield_ratio: {ratio})),"
                )
            };
            let storeys: String = storeys.into_iter().zip(weights).map(storey).collect();
            let plan = format!(
                "specimen frame {{ storeys = [{storeys}] }}\nground motion {{ file = \"ground.csv\" }}\nshake quake {{\n  ground = \
                 motion\n  integrator = {integrator}\n  time_step = 1 ms\n}}\nrequire \"drift\" max(quake.max_drift) < 1 m\n\
                 report {{ formats = [csv] }}\n"
            );
            let file = folder.path().join("plan.psd");
            std::fs::write(&file, plan).unwrap();
            let run = wait(
                Command::new(env!("CARGO_BIN_EXE_psd"))
                    .arg("run")
                    .arg(&file)
                    .arg("--out")
                    .arg(folder.path().join("run")),
            );
            assert_eq!(run.code, Some(0), "{}", run.output);
            let table =
                std::fs::read_to_string(folder.path().join("run/tables/quake.csv")).unwrap();
            let mut lines = table
                .lines()
                .map(|line| line.split(',').collect::<Vec<_>>());
            let header = lines.next().unwrap();
            let column = |name: &str| header.iter().position(|found| *found == name).unwrap();
            let [step, floor, computed] = ["step", "storey", "computed_m"].map(column);
            let (mut largest, mut off) = (0.0_f64, 0.0_f64);
            for row in lines.skip(3) {
                let [step, floor] = [step, floor].map(|at| row[at].parse::<usize>().unwrap());
                if step % 10 > 0 {
                    continue;
                }
                let wanted = theirs[step / 10 - 1][floor - 1];
                largest = largest.max(wanted.abs());
                off = off.max((wanted - row[computed].parse::<f64>().unwrap()).abs());
            }
            assert!(
                largest > 0.05 && off < 2e-4 * largest,
                "{ratio}, {integrator}: off by {off} of {largest}"
            );
        }
    }
}
