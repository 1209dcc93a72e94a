//! An impact on one storey of a frame, from the text of a plan. It is compared with a yielding frame integrated by a separate method. A
//! single storey is compared with one degree of freedom. The record alone is sufficient.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use psd::check::{Options, check, no_files};
use psd::run::{Unwatched, run};
use psd_plan::formula::ResultValue;
use psd_plan::record::{History, ImpactStep, Outcome, Record, StruckFrame};
use psd_rig::virtual_rig;

fn record(text: &str) -> Record {
    let checked = check("plan.psd", text, &no_files, &Options::default());
    let plan = checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
    let record = run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched);
    assert_eq!(record.outcome, Outcome::Completed, "{:?}", record.events);
    record
}

fn steps(record: &Record) -> Vec<ImpactStep> {
    match &record.procedures[0].history {
        History::Impact(history) => history.steps.iter().collect(),
        other => panic!("{other:?}"),
    }
}

fn history(record: &Record) -> &StruckFrame {
    match &record.procedures[0].history {
        History::Impact(history) => history.frame.as_ref().expect("a frame"),
        other => panic!("{other:?}"),
    }
}

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

fn number(record: &Record, name: &str) -> Option<f64> {
    match &record.procedures[0]
        .result(name)
        .expect("a result of the schema")
        .value
    {
        ResultValue::Number { value, .. } => *value,
        other @ ResultValue::List(_) => panic!("{name} is {other:?}"),
    }
}

const MASSES: [f64; 3] = [4000.0, 4000.0, 3000.0];
const STIFFNESSES: [f64; 3] = [2e6, 2e6, 1.5e6];
const YIELD: [f64; 3] = [20e3, 16e3, 9e3];
const POST_YIELD_RATIO: f64 = 0.05;
const STRIKER: f64 = 1500.0;
const SPEED: f64 = 1.2;
const HERTZ: f64 = 4e7;

fn yielding(fields: &str) -> Record {
    yielding_by(fields, &["hit"])
}

/// The frame under this number of impacts, each of 0.4 s.
fn yielding_by(fields: &str, impacts: &[&str]) -> Record {
    let storeys: Vec<String> = (0..3)
        .map(|i| {
            format!(
                "storey(mass: {} kg, behaviour: bilinear(stiffness: {} N/m, yield_force: {} N, post_yield_ratio: {POST_YIELD_RATIO}))",
                MASSES[i], STIFFNESSES[i], YIELD[i]
            )
        })
        .collect();
    let mut text = format!(
        "specimen frame {{ storeys = [{}] }}\nstriker truck {{\n  mass = {STRIKER} kg\n  velocity = {SPEED} m/s\n}}\n",
        storeys.join(", ")
    );
    for name in impacts {
        let _ = write!(
            text,
            "impact {name} {{\n  striker = truck\n  storey = 2\n  contact = hertz(stiffness: {HERTZ} N/m^1.5)\n  duration = 0.4 s\n  until = duration\n{fields}\n}}\n"
        );
    }
    record(&text)
}

/// The same frame and striker by central differences, x₂ = 2x₁ − x₀ + h²a. The storey's shear is h·kδ + (1 − h)·kz. Here z is the drift
/// of an elastic–perfectly plastic spring in parallel with an elastic one. The result contains the displacements at `times` \[s\], in
/// order. At `again` \[s\] the frame is stopped and hit once more.
fn central_differences(times: &[f64], again: f64) -> Vec<[f64; 3]> {
    const STEP: f64 = 2e-6;
    let (mut x, mut before, mut z) = ([0.0; 3], [0.0; 3], [0.0_f64; 3]);
    let (mut striker, mut striker_before) = (0.0_f64, -SPEED * STEP);
    let mut displacements = Vec::new();
    let mut step = 0_u32;
    while displacements.len() < times.len() {
        let time = f64::from(step) * STEP;
        if time >= times[displacements.len()] - 0.5 * STEP {
            displacements.push(x);
        }
        if (time - again).abs() < 0.5 * STEP {
            (before, striker, striker_before) = (x, x[1], x[1] - SPEED * STEP);
        }
        let mut shear = [0.0; 3];
        for storey in 0..3 {
            let below = |x: &[f64; 3]| if storey == 0 { 0.0 } else { x[storey - 1] };
            let (drift, last) = (x[storey] - below(&x), before[storey] - below(&before));
            let reach = YIELD[storey] / STIFFNESSES[storey];
            z[storey] = (z[storey] + drift - last).clamp(-reach, reach);
            shear[storey] = STIFFNESSES[storey]
                * (POST_YIELD_RATIO * drift + (1.0 - POST_YIELD_RATIO) * z[storey]);
        }
        let depth = (striker - x[1]).max(0.0);
        let contact = HERTZ * depth * depth.sqrt();
        let mut next = [0.0; 3];
        for floor in 0..3 {
            let above = if floor < 2 { shear[floor + 1] } else { 0.0 };
            let push = if floor == 1 { contact } else { 0.0 };
            next[floor] = 2.0 * x[floor] - before[floor]
                + STEP * STEP * (push - shear[floor] + above) / MASSES[floor];
        }
        let after = 2.0 * striker - striker_before - STEP * STEP * contact / STRIKER;
        (before, x) = (x, next);
        (striker_before, striker) = (striker, after);
        step += 1;
    }
    displacements
}

/// Largest difference of any floor at any step, over the largest displacement.
fn difference(record: &Record) -> f64 {
    let floors = &history(record).floors;
    let times: Vec<f64> = floors.iter().map(|step| step.floors.time).collect();
    let reference = central_differences(&times, f64::INFINITY);
    let largest = reference
        .iter()
        .flatten()
        .fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let pairs = floors
        .iter()
        .zip(&reference)
        .flat_map(|(found, exact)| found.floors.computed.iter().zip(exact));
    pairs
        .map(|(found, exact)| (found - exact).abs())
        .fold(0.0, f64::max)
        / largest
}

/// Every storey yields, and the test converges to that frame with decreasing step.
#[test]
fn a_frame_that_yields_is_the_one_of_central_differences() {
    let record = yielding("  time_step = 0.25 ms");
    for (storey, drift) in list(&record, "max_drift").into_iter().enumerate() {
        assert!(
            drift > 1.2 * YIELD[storey] / STIFFNESSES[storey],
            "storey {storey} yields: {drift} m"
        );
    }
    let (coarse, fine) = (
        difference(&yielding("  time_step = 1 ms")),
        difference(&record),
    );
    assert!(fine < 2e-3, "{fine}");
    assert!(
        coarse > 3.0 * fine,
        "{coarse} at 1 ms, {fine} at a quarter of it"
    );
}

/// A run that ends before its reversal has no peak, and one that ends in contact has truncated the impact; both are reported.
#[test]
fn a_truncated_run_names_what_is_missing() {
    let cut = |duration: &str, contact: &str| {
        let plan = format!(
            "specimen post {{ storeys = [storey(mass: 1 kg, stiffness: 300 N/m)] }}\nstriker s {{\n  mass = 10 kg\n  velocity = 1 m/s\n}}\nimpact hit {{\n  striker = s\n  storey = 1\n  contact = {contact}\n  time_step = 1 ms\n  duration = {duration}\n}}\n"
        );
        record(&plan)
            .events
            .into_iter()
            .map(|event| event.text)
            .collect::<Vec<_>>()
            .join("; ")
    };
    // Joined, the two bodies reverse after a quarter of 2π√((M + Ms)/K) = 1.2032 s.
    let early = cut("0.2 s", "restitution(0)");
    assert!(
        early.contains("not reached within the run")
            && early.contains("did not stop")
            && !early.contains("contact still active"),
        "{early}"
    );
    // They stop together, in contact.
    let still = cut("0.5 s", "restitution(0)");
    assert!(
        still.contains("contact still active") && !still.contains("not reached within the run"),
        "{still}"
    );
}

/// A second impact hits the frame in its state after the first one: deformed, and with the memory of its storeys.
#[test]
fn a_second_impact_meets_the_damage_of_the_first() {
    let record = yielding_by("  time_step = 0.25 ms", &["first", "second"]);
    let of = |procedure: usize| match &record.procedures[procedure].history {
        History::Impact(history) => &history.frame.as_ref().expect("a frame").floors,
        other => panic!("{other:?}"),
    };
    let (first, second) = (of(0), of(1));
    assert_eq!(
        second[0].floors.computed,
        first.last().expect("steps").floors.command
    );
    let times: Vec<f64> = second.iter().map(|step| 0.4 + step.floors.time).collect();
    let reference = central_differences(&times, 0.4);
    let largest = reference
        .iter()
        .flatten()
        .fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for (found, exact) in second.iter().zip(&reference) {
        for (found, exact) in found.floors.computed.iter().zip(exact) {
            assert!(
                (found - exact).abs() < 5e-3 * largest,
                "{found} and {exact} at {} s",
                0.4 + second[0].floors.time
            );
        }
    }
}

/// On an ideal rig, floors in continuous mode are read as if they had stopped: the same motion with every integrator.
#[test]
fn floors_that_never_stop_are_struck_as_those_that_do() {
    let plan = |mode: &str, integrator: &str| {
        record(&format!(
            "specimen frame {{ storeys = [storey(mass: 2 t, stiffness: 3 MN/m), storey(mass: 1.5 t, stiffness: 2 MN/m)] }}\nstriker s {{\n  mass = 100 kg\n  velocity = 1 m/s\n}}\nimpact hit {{\n  striker = s\n  storey = 1\n  mode = {mode}\n  integrator = {integrator}\n  time_step = 1 ms\n  duration = 0.3 s\n  until = duration\n}}\n"
        ))
    };
    for integrator in ["tangent", "explicit", "alpha_os(alpha: -0.05)"] {
        let (stepped, continuous) = (
            plan("ramp_and_hold", integrator),
            plan("continuous(time_scale: 50)", integrator),
        );
        let largest = list(&stepped, "floor_displacement")
            .into_iter()
            .fold(0.0, f64::max);
        assert_eq!(
            history(&stepped).floors.len(),
            history(&continuous).floors.len()
        );
        for (one, other) in history(&stepped)
            .floors
            .iter()
            .zip(&history(&continuous).floors)
        {
            for (one, other) in one.floors.computed.iter().zip(&other.floors.computed) {
                assert!(
                    (one - other).abs() < 1e-9 * largest,
                    "{integrator} at {} s: {one} and {other}",
                    history(&stepped).floors[0].floors.time
                );
            }
        }
    }
}

/// The energies of the storeys sum to that of the frame, and the balance closes. A rebound that the plan assumes occurs.
#[test]
fn results_per_storey_add_up_to_the_balance() {
    let record = yielding("  time_step = 0.5 ms\n  damping_ratio = 2 %");
    let last = steps(&record).last().expect("steps").energies;
    // It continued past its peaks and past its impact: neither is truncated.
    assert!(record.events.is_empty(), "{:?}", record.events);
    let storeys: f64 = list(&record, "storey_energy").iter().sum();
    assert!(
        (storeys - last.restoring).abs() < 1e-9 * last.restoring,
        "{storeys} and {}",
        last.restoring
    );
    let sum = last.striker
        + last.structure
        + last.restoring
        + last.damping
        + last.contact_loss
        + last.error;
    assert!(
        (sum - 0.5 * STRIKER * SPEED * SPEED).abs() < 1e-9,
        "{sum} J"
    );
    assert!(number(&record, "energy_error").expect("a number").abs() < 2e-3);
    let back = number(&record, "rebound_velocity").expect("it bounced");
    assert!((0.5 * STRIKER * back * back - last.striker).abs() < 1e-9 * last.striker);
    // An impact of finite stiffness lasts 2.943 δ/u between free masses; the flexibility of the storeys has little effect.
    let reduced = STRIKER * MASSES[1] / (STRIKER + MASSES[1]);
    let contact_time = 2.943 * (1.25 * reduced * SPEED * SPEED / HERTZ).powf(0.4) / SPEED;
    let lasted = number(&record, "contact_duration").expect("it touched");
    assert!(
        (lasted / contact_time - 1.0).abs() < 0.1,
        "{lasted} s, free masses {contact_time} s"
    );
    let shear = history(&record)
        .floors
        .iter()
        .map(|step| step.floors.restoring_force.iter().sum::<f64>().abs());
    assert_eq!(number(&record, "max_base_shear"), shear.reduce(f64::max));
}

/// The same plan in two forms, as a storey and as one degree of freedom: every column agrees to rounding.
#[test]
fn one_storey_is_one_degree_of_freedom() {
    const STRIKER_AND_LAWS: [&str; 4] = [
        "rigid",
        "limit(900 N)",
        "restitution(0.6)",
        "hertz(stiffness: 4e6 N/m^1.5, loss: 0.1 s/m)",
    ];
    for law in STRIKER_AND_LAWS {
        let behaviour = "bilinear(stiffness: 300 N/m, yield_force: 25 N, post_yield_ratio: 0.1)";
        let fields = |own: &str| {
            format!(
                "striker s {{\n  mass = 10 kg\n  velocity = 1 m/s\n  gap = 1 mm\n  gravity = 1 gn\n}}\nimpact hit {{\n  striker = s\n{own}  contact = {law}\n  time_step = 1 ms\n  duration = 0.6 s\n}}\n"
            )
        };
        let one = format!(
            "specimen post {{\n  mass = 1 kg\n  behaviour = {behaviour}\n}}\n{}",
            fields("  damping = 3 N*s/m\n")
        );
        // C = 2ζ√(KM).
        let ratio = 3.0 / (2.0 * 300.0_f64.sqrt());
        let storey = format!(
            "specimen post {{ storeys = [storey(mass: 1 kg, behaviour: {behaviour})] }}\n{}",
            fields(&format!("  storey = 1\n  damping_ratio = {ratio}\n"))
        );
        let (one, storey) = (record(&one), record(&storey));
        let History::Impact(of_one) = &one.procedures[0].history else {
            panic!("an impact")
        };
        let History::Impact(of_storey) = &storey.procedures[0].history else {
            panic!("an impact")
        };
        assert_eq!(of_one.steps.len(), of_storey.steps.len(), "{law}");
        assert!(
            (of_one.critical_time_step - of_storey.critical_time_step).abs() < 1e-15
                || law.starts_with("hertz")
        );
        for (one, other) in of_one.steps.iter().zip(of_storey.steps.iter()) {
            assert_eq!(one.state, other.state, "{law} at {} s", one.time);
            for (name, one, other, within) in [
                ("displacement", one.computed, other.computed, 1e-11),
                ("velocity", one.velocity, other.velocity, 1e-9),
                ("force", one.restoring_force, other.restoring_force, 1e-8),
                (
                    "striker",
                    one.striker_displacement,
                    other.striker_displacement,
                    1e-11,
                ),
                (
                    "contact",
                    one.contact_force * 1e-3,
                    other.contact_force * 1e-3,
                    1e-8,
                ),
                ("energy", one.energies.error, other.energies.error, 1e-9),
                ("weight", one.energies.weight, other.energies.weight, 1e-9),
            ] {
                assert!(
                    (one - other).abs() < within,
                    "{law} at {name}: {one} and {other}"
                );
            }
        }
    }
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

/// A run, its verification and its regenerated report give the same bytes without the plan, because the record contains it.
fn record_is_enough(name: &str, files: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let plan = path(name);
    fs::copy(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("plans")
            .join(name),
        &plan,
    )
    .expect("a copy");
    psd(
        &["run", plan.to_str().expect("UTF-8"), "--yes", "--out"],
        &path("run"),
    );
    fs::remove_file(&plan).expect("removed");
    psd(&["verify"], &path("run"));
    psd(
        &["report", path("run").to_str().expect("UTF-8"), "--out"],
        &path("again"),
    );
    let read = |folder: &str, name: &str| {
        fs::read(path(folder).join(name)).unwrap_or_else(|_| panic!("{folder}/{name} is there"))
    };
    for name in files.iter().chain(&["summary.json", "report.html"]) {
        assert_eq!(read("run", name), read("again", name), "{name}");
    }
}

#[test]
fn the_record_of_an_impact_on_a_storey_is_enough() {
    record_is_enough(
        "storey_impact.psd",
        &[
            "tables/hit.csv",
            "figures/hit_hysteresis.png",
            "figures/hit_displacement.svg",
        ],
    );
}

#[test]
fn the_record_of_an_impact_series_on_a_storey_and_of_an_unloaded_frame_is_enough() {
    let tables = [
        "tables/rest.csv",
        "tables/rising.csv",
        "tables/rising_storeys.csv",
        "tables/rising_3.csv",
    ];
    let figures = [
        "figures/rest_hysteresis.png",
        "figures/rising_drift.svg",
        "figures/rising_hysteresis.svg",
    ];
    record_is_enough(
        "rising_blows_on_a_storey.psd",
        &[&tables[..], &figures[..]].concat(),
    );
}
