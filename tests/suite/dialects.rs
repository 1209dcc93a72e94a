//! The paper's beam over real pseudo-terminals and TCP. The rig emulator of each protocol driver and `psd run` are two processes. In: the
//! rigs of `rigs`. Out: the results of the virtual run, within the resolution of the rig. No time is measured.

mod probe;
pub mod rigs;

use std::fs::{self, File};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use rigs::{CASES, Case, VELOCITY_DIFFERENCE};
use serde_json::Value;

/// Longest wait for any output: far longer than a machine under load requires.
const PATIENCE: Duration = Duration::from_mins(4);
/// `reply_timeout` of a rig that answers \[s\]: longer than the reply time of an emulator on a loaded machine.
const ANSWERS: f64 = 30.0;
/// `reply_timeout` of a rig that stays silent \[s\].
const SILENT: f64 = 0.2;
/// \[N/m\]
const STIFFNESS: f64 = 3e5;
/// Angular frequency of the beam's free vibration \[1/s\], √(K/M) with M = 0.73038 kg.
const FREQUENCY: f64 = 641.0;
/// Stop time of the striker \[s\], and the largest velocity of the beam until then \[m/s\].
const STOP: f64 = 0.0135;
const VELOCITY: f64 = 2.2;
/// Largest displacement of the paper's beam \[m\].
const LARGEST: f64 = 7.9e-3;
/// Largest increment of one step of 0.5 ms \[m\].
const INCREMENT: f64 = 1.1e-3;

#[test]
fn every_dialect_gives_the_virtual_runs_results_within_its_resolution() {
    let faults = std::thread::scope(|scope| {
        let running: Vec<_> = CASES
            .iter()
            .map(|case| (case, scope.spawn(|| run(case))))
            .collect();
        let ended = running
            .into_iter()
            .map(|(case, thread)| (case, thread.join()));
        let faults = ended.filter_map(|(case, ended)| match ended {
            Ok(Ok(())) => None,
            Ok(Err(fault)) => Some(format!("{}: {fault}", case.name)),
            Err(_) => Some(format!("{}: panicked", case.name)),
        });
        faults.collect::<Vec<_>>()
    });
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

/// A process that ends with the test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn psd(folder: &Path, output: &str, arguments: &[&str]) -> Process {
    let file = || File::create(folder.join(output)).expect("a log can be made");
    let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
    command
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(file());
    Process(command.spawn().expect("psd starts"))
}

/// The end of a process, or None if it does not end.
fn end(process: &mut Process) -> Option<ExitStatus> {
    let until = Instant::now() + PATIENCE;
    while Instant::now() < until {
        if let Some(status) = process.0.try_wait().expect("it is ours") {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    None
}

/// Whether the emulator reports that it is ready.
fn ready(folder: &Path) -> bool {
    let until = Instant::now() + PATIENCE;
    while Instant::now() < until {
        if fs::read_to_string(folder.join("simulator.txt"))
            .is_ok_and(|text| text.contains("emulates the rig until"))
        {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

/// The plan of a case and its libraries, with separate ports.
fn write_plan(case: &Case, folder: &Path, reply_timeout: f64) {
    let beam = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans/lib/gfrp_beam.psd");
    fs::copy(beam, folder.join("gfrp_beam.psd")).expect("the beam");
    let free = TcpListener::bind("127.0.0.1:0")
        .and_then(|listener| listener.local_addr())
        .expect("a free port");
    fs::write(
        folder.join("plan.psd"),
        case.plan(folder, &free.to_string(), reply_timeout),
    )
    .expect("the plan");
}

/// Runs a case on both rigs. The error contains the difference and the output of both processes.
fn run(case: &Case) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_plan(case, folder, ANSWERS);
    let with_output = |what: &str| {
        let log = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
        let bytes = log("bytes.txt");
        let last = bytes
            .lines()
            .rev()
            .take(30)
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
            .collect::<Vec<_>>()
            .join("\n");
        format!(
            "{what}\n{}\n{}\n{}\n{last}",
            log("virtual.txt"),
            log("real.txt"),
            log("simulator.txt")
        )
    };

    let mut ideal = psd(
        folder,
        "virtual.txt",
        &["run", "plan.psd", "--rig", "ideal", "--out", "virtual"],
    );
    let simulate = [
        "rig",
        "simulate",
        "plan.psd",
        "--rig",
        "real",
        "--once",
        "--log",
        "bytes.txt",
    ];
    let mut simulator = psd(folder, "simulator.txt", &simulate);
    if !ready(folder) {
        return Err(with_output("the stand-in does not begin"));
    }
    let mut real = psd(
        folder,
        "real.txt",
        &[
            "run",
            "plan.psd",
            "--rig",
            "real",
            "--yes",
            "--operator",
            "A. Tester",
            "--out",
            "real",
        ],
    );
    for (process, what) in [
        (&mut ideal, "virtual run"),
        (&mut real, "real run"),
        (&mut simulator, "stand-in"),
    ] {
        match end(process) {
            Some(status) if status.success() => {}
            Some(status) => return Err(with_output(&format!("the {what} ended with {status}"))),
            None => return Err(with_output(&format!("the {what} does not end"))),
        }
    }
    let summary = |name: &str| -> Value {
        let text = fs::read(folder.join(name).join("summary.json")).expect("a summary");
        serde_json::from_slice(&text).expect("JSON")
    };
    compare(case, &summary("virtual"), &summary("real")).map_err(|fault| with_output(&fault))
}

fn result(summary: &Value, procedure: &str, name: &str) -> Option<f64> {
    summary["procedures"][procedure]["results"][name]["value"].as_f64()
}

/// Compares the results of the real run with those of the virtual run.
///
/// A target is rounded by at most half the resolution r. The reading of the end position has the same error. The force read thus differs
/// from that of the ideal rig by at most e = K·r/2 + q. Here q is half the force resolution.
/// - K of the ramp's line: Σ|x − m|/Σ(x − m)² of 0.25, 0.5, 0.75, 1 mm is 3200/m, and the displacements err by r/2 too.
/// - c of two velocities: each mean errs by at most e, so that the slope errs by 2e/Δv.
/// - The impact: K predicts one increment and c adds c·v, so that e increases by the errors of both. A beam that vibrates freely answers
///   a force error with ∫ e·sin ω(t − s)/(Mω) ds. This is at most (2/π)·ωt·e/K, its mean over whole half waves. The work of e is done
///   along the path, which is at most v·t. The work of the spring is K·X times the error of X.
/// - The striker stops one step earlier or later.
fn compare(case: &Case, ideal: &Value, real: &Value) -> Result<(), String> {
    let mut error = STIFFNESS * case.resolution / 2.0 + case.force_error;
    let stiffness = (error + STIFFNESS * case.resolution / 2.0) * 3200.0;
    error += near(ideal, real, ("k0", "stiffness"), stiffness)? * INCREMENT;
    if case.sweep {
        error += near(
            ideal,
            real,
            ("c", "damping"),
            2.0 * error / VELOCITY_DIFFERENCE,
        )? * VELOCITY;
    }
    let displacement =
        std::f64::consts::FRAC_2_PI * FREQUENCY * STOP * error / STIFFNESS + case.resolution;
    near(ideal, real, ("hit", "max_displacement"), displacement)?;
    near(
        ideal,
        real,
        ("hit", "absorbed_energy"),
        error * VELOCITY * STOP + STIFFNESS * LARGEST * displacement,
    )?;
    let stops = |summary| result(summary, "hit", "stop_time").is_some();
    let whole = case.duration > 1e3 * STOP;
    if stops(ideal) != whole || stops(real) != whole {
        return Err("the striker stops in one of the runs only".to_owned());
    }
    if whole {
        near(ideal, real, ("hit", "stop_time"), 0.5e-3 * 1.001)?;
        let found = result(real, "hit", "max_displacement").unwrap_or(f64::NAN);
        if found.is_nan() || (found - LARGEST).abs() >= 0.1e-3 {
            return Err(format!("{found} m is not the paper's 7.9 mm"));
        }
    }
    Ok(())
}

/// Difference of a result between the two runs, if it is at most `allowed`.
fn near(
    ideal: &Value,
    real: &Value,
    (procedure, name): (&str, &str),
    allowed: f64,
) -> Result<f64, String> {
    let (expected, found) = (
        result(ideal, procedure, name),
        result(real, procedure, name),
    );
    match expected
        .zip(found)
        .map(|(expected, found)| (found - expected).abs())
    {
        Some(difference) if difference <= allowed => Ok(difference),
        _ => Err(format!(
            "{procedure}.{name}: {found:?} is not within {allowed} of {expected:?}"
        )),
    }
}
