//! A real OpenSees drives a real rig: its `genericClient` with `psd rig serve` and a rig emulator behind a pseudo-terminal. It also moves
//! frames with weights and a column under axial load by itself. In: the scripts beside this file, and an OpenSees for Python. Out: the
//! closed-form motion of its integrator; the motion of the same structure in psd, tested whole or in part.

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

/// Displacements of the floors after every tenth step \[m\], from a script beside this file.
fn theirs(python: &Path, script: &str, arguments: &[String]) -> Vec<Vec<f64>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/system")
        .join(script);
    let ended = wait(Command::new(python).arg(script).args(arguments));
    assert_eq!(ended.code, Some(0), "{}", ended.output);
    let line = ended.output.lines().find(|line| line.starts_with('['));
    serde_json::from_str(line.unwrap()).unwrap()
}

/// A plan without its ground motion, of 9 rad/s and this amplitude \[m/s²\].
struct Shaken<'a> {
    /// Everything before the `shake`.
    plan: String,
    integrator: &'a str,
    amplitude: f64,
}

impl Shaken<'_> {
    /// The same displacements, by a run of the plan.
    fn ours(&self) -> Vec<Vec<f64>> {
        let folder = tempfile::tempdir().unwrap();
        let sample = |sample: u32| {
            let time = f64::from(sample) * 1e-3;
            format!("{time},{}\n", self.amplitude * (9.0 * time).sin())
        };
        let record: String = (0..=3000).map(sample).collect();
        let record = format!("time_s,acceleration_m_per_s2\n{record}");
        std::fs::write(folder.path().join("ground.csv"), record).unwrap();
        let plan = format!(
            "{}\nground motion {{ file = \"ground.csv\" }}\nshake quake {{\n  ground = motion\n  integrator = {}\n  time_step = 1 ms\n}}\n\
             require \"drift\" max(quake.max_drift) < 1 m\nreport {{ formats = [csv] }}\n",
            self.plan, self.integrator
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
        let table = std::fs::read_to_string(folder.path().join("run/tables/quake.csv")).unwrap();
        let mut lines = table
            .lines()
            .map(|line| line.split(',').collect::<Vec<_>>());
        let header = lines.next().unwrap();
        let column = |name: &str| header.iter().position(|found| *found == name).unwrap();
        let [step, computed] = ["step", "computed_m"].map(column);
        let mut found: Vec<Vec<f64>> = Vec::new();
        for row in lines {
            let step: usize = row[step].parse().unwrap();
            if step == 0 || !step.is_multiple_of(10) {
                continue;
            }
            found.resize(step / 10, Vec::new());
            found[step / 10 - 1].push(row[computed].parse().unwrap());
        }
        found
    }

    /// Every displacement is within this part of the largest, which is more than `least` \[m\].
    fn moves_as(&self, theirs: &[Vec<f64>], within: f64, least: f64) {
        let ours = self.ours();
        assert_eq!(ours.len(), theirs.len());
        let pairs = ours.iter().flatten().zip(theirs.iter().flatten());
        let off = pairs.fold(0.0, |off: f64, (ours, theirs)| {
            off.max((ours - theirs).abs())
        });
        let each = theirs.iter().flatten();
        let largest = each.fold(0.0, |largest: f64, by| largest.max(by.abs()));
        assert!(
            largest > least && off < within * largest,
            "{}\n{}: off by {off} of {largest}",
            self.plan,
            self.integrator
        );
    }
}

const MASSES: [f64; 3] = [2000.0, 1500.0, 1000.0];
const STIFFNESSES: [f64; 3] = [6e5, 4.5e5, 3.5e5];
const YIELD_FORCES: [f64; 3] = [6e3, 5e3, 4e3];

/// The frame of `opensees_p_delta.py`. `on_the_rig`: the part of the lowest storey, and the factors on its stiffness and yield force there.
/// The others are then computed.
fn three_storeys(ratio: &str, weights: [f64; 3], on_the_rig: Option<(&str, [f64; 2])>) -> String {
    let storey = |storey: usize| {
        let (part, [stiffer, stronger]) = match on_the_rig {
            Some(tested) if storey == 0 => tested,
            Some(_) => ("computed", [1.0; 2]),
            None => ("tested", [1.0; 2]),
        };
        let [mass, weight] = [MASSES[storey], weights[storey]];
        let [stiffness, force] = [STIFFNESSES[storey], YIELD_FORCES[storey]];
        format!(
            "storey(mass: {mass} kg, height: 6 m, gravity: {weight} N, stiffness: {stiffness} N/m, part: {part}, \
             behaviour: bilinear(stiffness: {} N/m, yield_force: {} N, post_yield_ratio: {ratio})),",
            stiffer * stiffness,
            stronger * force
        )
    };
    let storeys: String = (0..3).map(storey).collect();
    format!("specimen frame {{ storeys = [{storeys}] }}")
}

/// A leaning column of corotational trusses carries the weights; P/h is 17 % or 7 % of the stiffness: elastic, yielding, and with a
/// negative tangent after yield.
const WEIGHED: [(&str, [f64; 3], f64); 3] = [
    ("0.999999", [3e5, 2e5, 1e5], 0.5),
    ("0.2", [3e5, 2e5, 1e5], 1.5),
    ("0.05", [1e5, 8e4, 6e4], 1.5),
];

fn beside_a_leaning_column(
    python: &Path,
    (ratio, weights, amplitude): (&str, [f64; 3], f64),
) -> Vec<Vec<f64>> {
    let listed = weights.map(|weight| weight.to_string()).join(",");
    let arguments = [ratio.to_owned(), listed, "6".into(), amplitude.to_string()];
    theirs(python, "opensees_p_delta.py", &arguments)
}

#[test]
fn a_frame_with_weights_moves_as_that_of_opensees_beside_a_leaning_column() {
    let Some(python) = python() else { return };
    for case in WEIGHED {
        let (ratio, weights, amplitude) = case;
        let theirs = beside_a_leaning_column(&python, case);
        for integrator in ["tangent", "alpha_os(alpha: 0)"] {
            let shaken = Shaken {
                plan: three_storeys(ratio, weights, None),
                integrator,
                amplitude,
            };
            shaken.moves_as(&theirs, 2e-4, 0.05);
        }
    }
}

/// One of the two equal columns of the lowest storey at half scale, with λ = 1/2 for lengths and 1/4 for forces: it is
/// λ_f/(n λ_x) = 1/4 as stiff, and yields at λ_f/n = 1/8 of the force. The other storeys are computed. OpenSees moves the whole frame.
#[test]
fn a_hybrid_test_at_half_scale_moves_as_the_whole_frame_of_opensees() {
    let Some(python) = python() else { return };
    for case in [("0.1", [0.0; 3], 1.5)].into_iter().chain(WEIGHED) {
        let (ratio, weights, amplitude) = case;
        let theirs = beside_a_leaning_column(&python, case);
        let half = "tested(scale: 1 / 2, represents: 2)";
        for integrator in ["tangent", "alpha_os(alpha: 0)"] {
            let shaken = Shaken {
                plan: three_storeys(ratio, weights, Some((half, [0.25, 0.125]))),
                integrator,
                amplitude,
            };
            shaken.moves_as(&theirs, 2e-4, 0.05);
        }
    }
}

/// The same column carries λ_f/n of all weights above the storey, by an axial axis: their P-Δ is in its reading.
#[test]
fn a_hybrid_test_under_axial_load_moves_as_the_whole_frame_of_opensees() {
    let Some(python) = python() else { return };
    for case in WEIGHED {
        let (ratio, weights, amplitude) = case;
        let theirs = beside_a_leaning_column(&python, case);
        let half = "tested(scale: 1 / 2, represents: 2)";
        let frame = three_storeys(ratio, weights, Some((half, [0.25, 0.125])));
        let load = 0.125 * weights.iter().sum::<f64>();
        for integrator in ["tangent", "alpha_os(alpha: 0)"] {
            let shaken = Shaken {
                plan: format!("{frame}\n{}", loaded(load)),
                integrator,
                amplitude,
            };
            shaken.moves_as(&theirs, 2e-4, 0.05);
        }
    }
}

/// A rig with an axial axis that stays vertical, and the preload \[N\] of the lowest storey.
fn loaded(load: f64) -> String {
    format!(
        "rig simulated {{\n  link = virtual\n  axes = [axis(storey: 1), axis(axial: 1, control: force(rate: 50 kN/s, tolerance: 0.5 kN), p_delta: 100 %, \
         displacement: -20 mm .. 20 mm)]\n}}\npreload vertical {{\n  storey = 1\n  force = {load} N\n}}"
    )
}

/// K = 12 EI/h³ = 4 MN/m, of which the axial load takes N/h, a tenth.
#[test]
fn a_column_under_axial_load_moves_as_a_beam_column_of_opensees() {
    let Some(python) = python() else { return };
    let (mass, height, stiffness, load, amplitude) = (2e4, 3.0_f64, 4e6, 1.2e6, 2.0);
    let bending = stiffness * height.powi(3) / 12.0;
    let arguments = [mass, height, bending, load, amplitude].map(|number| number.to_string());
    let theirs = theirs(&python, "opensees_column.py", &arguments);
    for integrator in ["tangent", "alpha_os(alpha: 0)"] {
        let plan = format!(
            "specimen column {{ storeys = [storey(mass: {mass} kg, height: {height} m, gravity: {load} N, behaviour: \
             elastic({stiffness} N/m))] }}\n{}",
            loaded(load)
        );
        let shaken = Shaken {
            plan,
            integrator,
            amplitude,
        };
        shaken.moves_as(&theirs, 1e-9, 0.01);
    }
}
