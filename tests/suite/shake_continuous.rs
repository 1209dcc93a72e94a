//! Frames in continuous mode, from the text of a plan. The effects of dampers and friction of the storeys are compared with closed forms
//! and with ramp-and-hold. Readings are corrected axis by axis, and the record alone is sufficient.

use std::fs;
use std::path::Path;

use psd::check::{LoadError, Options, check};
use psd::run::{Unwatched, run};
use psd_plan::Plan;
use psd_plan::formula::ResultValue;
use psd_plan::record::{Floors as _, History, Outcome, Record, ShakeStep};
use psd_rig::virtual_rig;

/// Largest acceleration of the ground \[m/s²\], its angular frequency \[rad/s\], and a stiffness \[N/m\]. With this stiffness the
/// frequency is the first of two equal storeys of 1 t.
const GROUND: f64 = 0.5;
const FREQUENCY: f64 = 4.0 * std::f64::consts::PI;
const STIFFNESS: f64 = 1000.0 * FREQUENCY * FREQUENCY * 2.618_033_988_749_895;
/// Damping ratio of the first mode, and the corresponding dampers of the storeys \[N·s/m\]: C = c/k · K.
const RATIO: f64 = 0.1;
const DAMPER: f64 = 2.0 * RATIO / FREQUENCY * STIFFNESS;
const SCALE: f64 = 50.0;

fn files(path: &str) -> Result<String, LoadError> {
    let rows = |acceleration: &dyn Fn(f64) -> f64| -> String {
        let row = |step: u32| {
            format!(
                "{},{}\n",
                f64::from(step) * 1e-3,
                acceleration(f64::from(step) * 1e-3)
            )
        };
        (0..=8000).map(row).collect()
    };
    let rows = match path {
        "sine.csv" => rows(&|time| GROUND * (FREQUENCY * time).sin()),
        "push.csv" => rows(&|time| if time <= 0.25 { GROUND } else { 0.0 }),
        _ => return Err(LoadError::NotFound),
    };
    Ok(format!("time_s,acceleration_m_per_s2\n{rows}"))
}

/// Two storeys with `damped` in each, on `ground`, moved with the options `shake` by a rig with the errors `errs`.
fn plan(ground: &str, damped: &str, shake: &str, errs: &str) -> Plan {
    let storey = format!("storey(mass: 1 t, stiffness: {STIFFNESS} N/m{damped})");
    let text = format!(
        "specimen frame {{ storeys = [{storey}, {storey}] }}\nground motion {{ file = \"{ground}.csv\" }}\n\
         rig bench {{ link = virtual({errs}) }}\nshake test {{\n  ground = motion\n{shake}\n}}\n"
    );
    let checked = check("plan.psd", &text, &files, &Options::default());
    checked
        .plan
        .unwrap_or_else(|| panic!("{text}\n{:?}", checked.diagnostics))
}

fn done(plan: &Plan) -> Record {
    let record = run(plan, virtual_rig(plan).as_mut(), &mut Unwatched);
    assert_eq!(record.outcome, Outcome::Completed);
    record
}

fn steps(record: &Record) -> &[ShakeStep] {
    match &record.procedures[0].history {
        History::Shake(history) => &history.steps,
        other => panic!("{other:?}"),
    }
}

fn continuous(step: &str) -> String {
    format!("  mode = continuous(time_scale: {SCALE})\n  time_step = {step}")
}

fn viscous() -> String {
    format!(", damping: {} N*s/m", SCALE * DAMPER)
}

/// Largest displacement of each floor \[m\].
fn peaks(steps: &[ShakeStep]) -> [f64; 2] {
    [0, 1].map(|floor| {
        steps
            .iter()
            .map(|step| step.floors.computed[floor].abs())
            .fold(0.0, f64::max)
    })
}

/// Steady amplitude of both floors \[m\] by modes: φ = (1, g) and (g, −1), ω₂ = g²ω. Dampers in proportion to the storeys give the modes
/// ζ and g²ζ.
fn closed_form() -> [f64; 2] {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mode = |shape: [f64; 2], own: f64| {
        let participation = (shape[0] + shape[1]) / (shape[0] * shape[0] + shape[1] * shape[1]);
        let ratio = RATIO * own / FREQUENCY;
        let (real, imaginary) = (
            own * own - FREQUENCY * FREQUENCY,
            2.0 * ratio * own * FREQUENCY,
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

/// Dampers of the storeys that act at 1/50 of the speed: the amplitude of a steady motion at resonance depends on the damping only. The
/// error decreases with the square of the step. At rest they have no effect, and the motion grows without bound.
#[test]
fn dampers_of_the_storeys_give_the_steady_motion_of_the_closed_form() {
    let error = |step: &str| {
        let found = peaks(steps(&done(&plan(
            "sine",
            &viscous(),
            &continuous(step),
            "",
        ))));
        found
            .iter()
            .zip(closed_form())
            .map(|(found, exact)| (found / exact - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (error("10 ms"), error("5 ms"));
    assert!(fine < 3e-3, "{fine}");
    assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} and {fine}");
    let paused = peaks(steps(&done(&plan(
        "sine",
        &viscous(),
        "  integrator = explicit\n  time_step = 10 ms",
        "",
    ))));
    assert!(paused[1] > 5.0 * closed_form()[1], "{paused:?}");
}

/// The reading is K·X plus C·Ẋ / `time_scale`, with the velocity of the floors at the target. The error has the order of the step
/// squared.
#[test]
fn the_damping_of_the_material_is_in_the_force() {
    let largest = |step: &str| {
        let record = done(&plan("sine", &viscous(), &continuous(step), ""));
        let steps = steps(&record);
        let (mut beside, mut missed) = (0.0_f64, 0.0_f64);
        for three in steps.windows(3) {
            let command_change =
                |floor: usize| three[2].floors.command[floor] - three[0].floors.command[floor];
            let velocity = [0, 1].map(|floor: usize| {
                command_change(floor) / (three[2].floors.time - three[0].floors.time)
            });
            let now = &three[1];
            let shear = |storey: usize, of: &dyn Fn(usize) -> f64| {
                of(storey) - if storey > 0 { of(storey - 1) } else { 0.0 }
            };
            let storey = [0, 1].map(|storey: usize| {
                STIFFNESS * shear(storey, &|floor| now.floors.command[floor])
                    + DAMPER * shear(storey, &|floor| velocity[floor])
            });
            let expected = [storey[0] - storey[1], storey[1]];
            for (floor, expected) in expected.iter().enumerate() {
                missed = missed.max((now.floors.restoring_force[floor] - expected).abs());
            }
            beside = beside.max((DAMPER * (velocity[1] - velocity[0])).abs());
        }
        assert!(beside > 100.0, "enough to be seen: {beside} N");
        missed
    };
    let (coarse, fine) = (largest("10 ms"), largest("5 ms"));
    assert!(fine < 10.0 && coarse / fine > 3.0, "{coarse} N, {fine} N");
}

/// Friction dissipates its force times the path of the drifts, in either mode: the cells keep its sign through a pause.
#[test]
fn friction_of_the_storeys_dissipates_its_force_times_the_travel_of_the_drifts() {
    let friction = 20.0;
    for mode in [
        continuous("2 ms"),
        "  integrator = explicit\n  time_step = 2 ms".to_owned(),
    ] {
        let record = done(&plan(
            "push",
            &format!(", coulomb: {friction} N"),
            &format!("{mode}\n  duration = 2 s"),
            "",
        ));
        let steps = steps(&record);
        let pairs = || {
            steps
                .windows(2)
                .map(|pair| (pair[0].drift(), pair[1].drift()))
        };
        let travel: f64 = pairs()
            .map(|(from, to)| {
                from.iter()
                    .zip(to)
                    .map(|(from, to)| (to - from).abs())
                    .sum::<f64>()
            })
            .sum();
        let last = steps.last().unwrap();
        let elastic: f64 = last
            .drift()
            .iter()
            .map(|drift| 0.5 * STIFFNESS * drift * drift)
            .sum();
        let (dissipated, found) = (friction * travel, last.energies.restoring - elastic);
        assert!(
            dissipated > 0.3 * last.energies.input,
            "enough to be seen: {dissipated} J of {} J",
            last.energies.input
        );
        assert!(
            (found - dissipated).abs() < 0.02 * dissipated,
            "{mode}: {found} J of {dissipated} J"
        );
    }
}

/// Without damping an ideal rig reads the same forces at the same targets in either mode.
#[test]
fn without_damping_both_modes_are_the_same_run() {
    let (one, other) = (
        done(&plan("sine", "", &continuous("10 ms"), "")),
        done(&plan(
            "sine",
            "",
            "  integrator = explicit\n  time_step = 10 ms",
            "",
        )),
    );
    let (one, other) = (steps(&one), steps(&other));
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().zip(other) {
        for floor in 0..2 {
            assert!((one.floors.command[floor] - other.floors.command[floor]).abs() < 1e-12);
            assert!(
                (one.floors.restoring_force[floor] - other.floors.restoring_force[floor]).abs()
                    < 1e-7
            );
        }
    }
    assert!(
        one.windows(2)
            .all(|pair| (pair[1].wall_time - pair[0].wall_time - SCALE * 0.01).abs() < 1e-9)
    );
}

/// Pistons with a lag of 0.2 s, 4 ms of simulated time, add energy. Each floor's force is corrected to its target by K(d_m − d). It then
/// equals the force at the target, including coupling.
#[test]
fn readings_of_lagging_axes_are_corrected_to_their_targets() {
    let peak = |errs: &str, more: &str| {
        let shake = format!("{}\n{more}", continuous("5 ms"));
        let mut plan = plan("push", "", &shake, errs);
        plan.limits.tracking_energy_error.high = 1e6;
        peaks(steps(&done(&plan)))
    };
    let lag = "lag: 200 ms";
    let (ideal, corrected, raw) = (
        peak("", ""),
        peak(lag, ""),
        peak(lag, "  i_modification = false"),
    );
    for floor in 0..2 {
        assert!(
            (corrected[floor] / ideal[floor] - 1.0).abs() < 1e-9,
            "{corrected:?} and {ideal:?}"
        );
        // The amplitude grows by exp(½ω²·lag/scale·t) in the first mode, 12 times in eight seconds.
        assert!(raw[floor] / ideal[floor] > 8.0, "{raw:?} and {ideal:?}");
    }
}

/// A ground-motion test with lagging axes without correction, or with undershoot at every step, is put on hold. This happens when the
/// added energy exceeds the limit of the plan. The results contain the value of each floor, and the total is their sum.
#[test]
fn tracking_holds_a_shake_in_both_modes() {
    let raw = format!("{}\n  i_modification = false", continuous("5 ms"));
    let stepping = "  integrator = explicit\n  time_step = 5 ms".to_owned();
    for (shake, errs) in [(raw, "lag: 200 ms"), (stepping, "tracking: 0.3")] {
        let mut plan = plan("sine", "", &shake, errs);
        let record = run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched);
        let held = |record: &Record, what: &str| matches!(&record.outcome, Outcome::Aborted { reason } if reason.contains(what));
        assert!(
            held(&record, "tracking energy"),
            "{errs}: {:?}",
            record.outcome
        );
        let result = |name: &str| {
            record.procedures[0]
                .result(name)
                .map(|result| &result.value)
        };
        let number = |name: &str| match result(name) {
            Some(ResultValue::Number {
                value: Some(value), ..
            }) => *value,
            other => panic!("{name}: {other:?}"),
        };
        let list = |name: &str| match result(name) {
            Some(ResultValue::List(values)) => values.clone(),
            other => panic!("{name}: {other:?}"),
        };
        assert!(
            (-0.06..-0.05).contains(&number("tracking_energy_error")),
            "{errs}: {}",
            number("tracking_energy_error")
        );
        let sum: f64 = list("floor_tracking_energy_error").iter().sum();
        assert!(
            (sum / number("tracking_energy_error") - 1.0).abs() < 0.05,
            "{errs}: {sum}"
        );
        let sum: f64 = list("floor_tracking_indicator").iter().sum();
        assert!(
            sum < 0.0 && (sum / number("tracking_indicator") - 1.0).abs() < 1e-12,
            "{errs}: {sum}"
        );
        for name in ["nrms_error", "peak_error"] {
            assert_eq!(
                list(&format!("floor_{name}"))
                    .into_iter()
                    .fold(0.0, f64::max),
                number(name),
                "{errs}: {name}"
            );
        }
        plan.limits.tracking_energy_error.high = 1e6;
        plan.limits.nrms_error.high = 1e-3;
        assert!(
            held(
                &run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched),
                "NRMS"
            ),
            "{errs}"
        );
    }
}

/// Recorded, verified and regenerated from the record: the same bytes.
#[test]
fn the_record_of_a_continuous_shake_is_enough() {
    let psd = |arguments: &[&str]| {
        let ended = std::process::Command::new(env!("CARGO_BIN_EXE_psd"))
            .args(arguments)
            .output()
            .expect("psd starts");
        assert!(
            ended.status.success(),
            "{arguments:?}: {}",
            String::from_utf8_lossy(&ended.stderr)
        );
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans/two_storeys_continuous.psd");
    psd(&[
        "run",
        plan.to_str().expect("UTF-8"),
        "--yes",
        "--out",
        &path("run"),
    ]);
    psd(&["verify", &path("run")]);
    psd(&["report", &path("run"), "--out", &path("again")]);
    for name in [
        "summary.json",
        "tables/moving.csv",
        "report.html",
        "report.pdf",
    ] {
        let read =
            |of: &str| fs::read(folder.path().join(of).join(name)).expect("a file of the run");
        assert!(read("run") == read("again"), "{name} differs");
    }
}
