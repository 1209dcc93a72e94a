//! The bench table of whole processes: every case with its peer, its goal and what is measured here, `cargo bench --bench table`. Times are
//! of the processor. `cargo bench -p psd-physics` measures a step; the other benches have the details of one case each.

use std::process::{Command, Stdio};

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

fn line(case: &str, peer: &str, goal: &str, today: f64, unit: &str) {
    println!("| {case} | {peer} | {goal} | {today:.1} {unit} |");
}

fn main() {
    println!("| case | peer | goal | here |\n|---|---|---|---|");
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
