//! The bench table: every case with its peer, its goal and what is measured here, `cargo bench --bench table`. Times are of the processor,
//! the fastest of several: other work on the machine makes them longer, not shorter. The other benches have the details of one case each.

mod common;

use std::hint::black_box;
use std::process::{Command, Stdio};

use common::{SPECIMEN, STEPS, example_1};
use psd_physics::contact::ContactLaw;
use psd_physics::impact::batch::{self, Impact};
use psd_physics::impact::{ImpactInput, StepRow, Until, simulate};
use psd_physics::specimen::{Bilinear, BilinearCurve, SpecimenModel};
use rustix::time::{ClockId, clock_gettime};

const RUNS: u32 = 10_000;

/// Example 1 with 3000 steps; a report that is one table and one figure.
const TABLE_AND_FIGURE: &str = "specimen cantilever { mass = 1 kg\nbehaviour = elastic(stiffness: 327.65 N/m) }\n\
    striker hammer { mass = 10 kg\nvelocity = 1 m/s }\n\
    impact hit { striker = hammer\ncontact = rigid\nduration = 0.3 s\ntime_step = 0.1 ms\nuntil = duration }\n\
    report { formats = [csv]\nfigures = [displacement(hit)] }\n";

/// Impacts of 149 steps with scattered inputs.
const STUDY: &str = "param speed = 1 m/s\n\
    specimen beam { mass = 1 kg\nbehaviour = elastic(stiffness: 300 N/m) }\n\
    striker hammer { mass = 10 kg\nvelocity = speed }\n\
    impact hit { striker = hammer\nduration = 1 s\ntime_step = 2 ms }\n\
    study scatter { vary = [speed ~ normal(sd: 0.05 m/s), beam.mass ~ lognormal(cv: 2 %)]\nruns = 100000 }\n\
    require \"stays in travel\" hit.max_displacement < 0.2 m\n";

/// Time of this thread on a processor \[s\].
fn own_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    #[expect(clippy::cast_precision_loss, reason = "less than 2^53 ns")]
    let [whole, nanoseconds] = [time.tv_sec, time.tv_nsec].map(|part| part as f64);
    whole + nanoseconds * 1e-9
}

/// Time of ended children on all processors \[s\], in hundredths.
fn time_of_children() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    let after_name = text.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(13).take(2);
    ticks
        .filter_map(|text| text.parse::<f64>().ok())
        .sum::<f64>()
        * 0.01
}

/// The shortest of some times of a piece of work \[s\].
fn fastest(times: usize, mut work: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..times {
        let before = own_time();
        work();
        least = least.min(own_time() - before);
    }
    least
}

/// Mean time of a psd process \[s\].
fn process(times: u32, arguments: &[&str]) -> f64 {
    let before = time_of_children();
    for _ in 0..times {
        let status = Command::new(env!("CARGO_BIN_EXE_psd"))
            .args(arguments)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        assert!(status.is_ok_and(|status| status.success()), "{arguments:?}");
    }
    (time_of_children() - before) / f64::from(times)
}

/// Impacts with scattered speeds, all in lanes.
fn impacts(law: ContactLaw, specimen: &SpecimenModel) -> Vec<Impact> {
    let impact = |run: u32| Impact {
        input: ImpactInput {
            striker_velocity: 1.0 + 1e-5 * f64::from(run),
            time_step: 1e-4,
            law,
            ..example_1()
        },
        specimen: specimen.clone(),
    };
    (0..RUNS).map(impact).collect()
}

fn line(case: &str, peer: &str, goal: &str, today: f64, unit: &str) {
    println!("| {case} | {peer} | {goal} | {today:.1} {unit} |");
}

fn main() {
    println!("| case | peer | goal | here |\n|---|---|---|---|");
    #[expect(clippy::cast_precision_loss, reason = "a number of steps")]
    let per_step = 1e9 / STEPS as f64;
    let input = example_1();
    let bare = fastest(100, || {
        black_box(simulate(&input, &mut { SPECIMEN }, None, STEPS, &mut ())).expect("an impact");
    });
    line(
        "impact step, bare",
        "Numba 11 ns",
        "",
        bare * per_step,
        "ns",
    );
    let mut rows: Vec<StepRow> = Vec::new();
    let recorded = fastest(100, || {
        rows.clear();
        simulate(&input, &mut { SPECIMEN }, None, STEPS, &mut rows).expect("an impact");
    });
    let peer = "OpenSees 2.6–3.3 µs";
    line(
        "impact step, 8 numbers recorded",
        peer,
        "≤ 13 ns",
        recorded * per_step,
        "ns",
    );

    let elastic = SpecimenModel::Elastic(SPECIMEN);
    let yielding = SpecimenModel::Bilinear(Bilinear::new(BilinearCurve {
        stiffness: SPECIMEN.stiffness,
        yield_force: 20.0,
        post_yield_ratio: 0.1,
    }));
    let limited = ContactLaw::Limit { force: 100.0 };
    for (name, law, specimen, goal) in [
        ("elastic", ContactLaw::Rigid, &elastic, "≤ 70 ms with AVX2"),
        ("bilinear", ContactLaw::Rigid, &yielding, ""),
        ("elastic, limit force", limited, &elastic, ""),
    ] {
        let impacts = impacts(law, specimen);
        let study = fastest(5, || {
            black_box(batch::run(&impacts, Some(Until::Duration), 3000));
        });
        let case = format!("study of 10⁴ × 3000 steps, {name}");
        line(
            &case,
            "NumPy 0.39 s, OpenSees 104 s",
            goal,
            study * 1e3,
            "ms",
        );
    }

    let check = process(50, &["check", "plans/01_first_blow.psd"]);
    line(
        "`psd check`, small plan, process",
        "",
        "≤ 5 ms",
        check * 1e3,
        "ms",
    );
    let folder = tempfile::tempdir().expect("a folder");
    let plan = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a plan");
        path.display().to_string()
    };
    let few = plan("few.psd", TABLE_AND_FIGURE);
    let long = plan("long.psd", &TABLE_AND_FIGURE.replace("0.1 ms", "3 us"));
    let study = plan("study.psd", STUDY);
    let (run, of_a_study) = (&["run"][..], &["study", "run"][..]);
    let figure = "`psd run`, table as CSV and one figure";
    for (name, command, plan, goal, times) in [
        (
            &format!("{figure}, 3000 steps")[..],
            run,
            &few[..],
            "≤ 30 ms",
            10,
        ),
        (
            &format!("{figure}, 10⁵ steps"),
            run,
            &long,
            "≤ 2 s to write",
            2,
        ),
        (
            "`psd run`, full report",
            run,
            "plans/example_1.psd",
            "≤ 250 ms",
            10,
        ),
        (
            "`psd study run`, 10⁵ runs of 149 steps",
            of_a_study,
            &study,
            "",
            2,
        ),
    ] {
        let runs = (0..times).map(|number| {
            let out = folder.path().join(format!("{name} {number}"));
            let out = out.display().to_string();
            process(1, &[command, &[plan, "--out", &out]].concat())
        });
        let time = runs.sum::<f64>() / f64::from(times);
        line(&format!("{name}, process"), "", goal, time * 1e3, "ms");
    }
}
