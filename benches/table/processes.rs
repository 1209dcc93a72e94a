//! Whole processes of psd: runs, studies, verifications, checks.

use std::cell::Cell;
use std::fmt::Write as _;
use std::process::{Command, Stdio};

use super::Row;
use super::peer::Peer;

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

/// Two storeys of scattered mass on a moving ground.
const STUDY_OF_FRAMES: &str = "specimen frame { storeys = [storey(mass: 1.5 t, stiffness: 2 MN/m), storey(mass: 1.5 t, stiffness: 2 MN/m)] }\n\
    ground sine { file = \"sine.csv\" }\n\
    param ratio = 5 %\n\
    shake steady { ground = sine\ndamping_ratio = ratio\ntime_step = 10 ms }\n\
    study scatter { vary = [ratio ~ uniform(4 % .. 6 %)]\nruns = 1000 }\n\
    require \"stays in travel\" steady.max_displacement[1] < 1 m\n";

/// Time that a turn measures at least \[s\], because that of children is given in hundredths.
const LEAST: f64 = 0.5;

/// Time of ended children on all processors \[s\], in hundredths.
pub fn time_of_children() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    let after_name = text.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(13).take(2);
    ticks
        .filter_map(|text| text.parse::<f64>().ok())
        .sum::<f64>()
        * 0.01
}

#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
pub const fn size_of(count: usize) -> f64 {
    count as f64
}

/// A folder for plans and what is made of them.
pub struct Processes {
    folder: tempfile::TempDir,
    runs: Cell<u32>,
}

impl Processes {
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a folder"),
            runs: Cell::new(0),
        }
    }

    fn plan(&self, name: &str, text: &str) -> String {
        let path = self.folder.path().join(name);
        std::fs::write(&path, text).expect("a plan");
        path.display().to_string()
    }

    /// A folder that is not there yet.
    fn out(&self) -> String {
        self.runs.set(self.runs.get() + 1);
        let path = self.folder.path().join(format!("run {}", self.runs.get()));
        path.display().to_string()
    }

    /// A command that writes a folder, which is then removed \[s\].
    fn run(&self, arguments: &[&str]) -> f64 {
        mean(|| {
            let out = self.out();
            process(&[arguments, &["--out", &out]].concat());
            std::fs::remove_dir_all(out).expect("its folder");
        })
    }

    pub fn rows(&self) -> Vec<Row<'_>> {
        let steps = |time_step: &str, formats: &str| {
            TABLE_AND_FIGURE
                .replace("0.1 ms", time_step)
                .replace("csv", formats)
        };
        let mut rows = self.runs(&steps);
        rows.extend(self.verifications(&steps));
        rows.extend(self.studies());
        rows.extend(self.checks());
        rows
    }

    fn runs(&self, steps: &dyn Fn(&str, &str) -> String) -> Vec<Row<'_>> {
        let folder = self.folder.path().display().to_string();
        let few = self.plan("few.psd", &steps("0.1 ms", "csv"));
        let long = self.plan("long.psd", &steps("3 us", "csv"));
        let csv = self.plan("longer.psd", &steps("1 us", "csv"));
        let parquet = self.plan("parquet.psd", &steps("1 us", "parquet"));
        let figure = "`psd run`, table as CSV and one figure";
        let both = "OpenSees and Polars";
        let all = "OpenSees, pandas and Matplotlib";
        let full = |name| {
            Row::new(
                format!("`psd run plans/{name}.psd`, full report"),
                if name == "beam" {
                    "≤ 150 ms"
                } else {
                    "≤ 120 ms"
                },
                5,
                move || self.run(&["run", &format!("plans/{name}.psd")]),
            )
        };
        vec![
            Row::new(
                format!("{figure}, 3000 steps"),
                "≥ 42 times as fast",
                9,
                move || (0..5).map(|_| self.run(&["run", &few])).sum::<f64>() / 5.0,
            )
            .beside(Peer::process(all, &["report", &folder])),
            Row::new(format!("{figure}, 10⁵ steps"), "≤ 2 s", 5, move || {
                self.run(&["run", &long])
            }),
            Row::new(
                format!("{figure}, 3 · 10⁵ steps"),
                "≥ 5 times as fast",
                5,
                move || self.run(&["run", &csv]),
            )
            .beside(Peer::process(both, &["long_run", &folder, "csv"])),
            Row::new(
                "`psd run`, table as Parquet and one figure, 3 · 10⁵ steps",
                "≥ 10 times as fast",
                5,
                move || self.run(&["run", &parquet]),
            )
            .beside(Peer::process(both, &["long_run", &folder, "parquet"])),
            full("example_1"),
            full("beam"),
        ]
    }

    fn verifications(&self, steps: &dyn Fn(&str, &str) -> String) -> Vec<Row<'_>> {
        let cases = [
            ("10⁵ steps", "3 us", "summary", "≤ 0.3 s"),
            ("10⁶ steps", "0.3 us", "summary", "≤ 3 s"),
            ("10⁵ steps with a full run log", "3 us", "full", "≤ 0.8 s"),
        ];
        let row = |(name, time_step, log, goal): (&str, &str, &'static str, &'static str)| {
            let plan = self.plan(&format!("{name}.psd"), &steps(time_step, "csv"));
            // Made when the row is measured.
            let mut made = None;
            Row::new(format!("`psd verify` of {name}"), goal, 3, move || {
                let folder = made.get_or_insert_with(|| {
                    let out = self.out();
                    let log: &[&str] = if log == "full" { &["--log", log] } else { &[] };
                    process(&[&["run", &plan, "--out", &out], log].concat());
                    out
                });
                mean(|| process(&["verify", folder]))
            })
        };
        cases.into_iter().map(row).collect()
    }

    fn studies(&self) -> Vec<Row<'_>> {
        let of_149 = self.plan("study.psd", STUDY);
        let of_3000 = STUDY
            .replace("300 N/m", "327.65 N/m")
            .replace("duration = 1 s", "duration = 0.3 s\nuntil = duration")
            .replace("time_step = 2 ms", "time_step = 0.1 ms");
        let scattered = |runs: &str| of_3000.replace("runs = 100000", runs);
        let batched = self.plan("batched.psd", &scattered("runs = 10000"));
        // A limit of the energy error is watched step by step.
        let alone = scattered("runs = 2000") + "limits { energy_error = 50 % }\n";
        let alone = self.plan("alone.psd", &alone);
        let frames = self.plan("frames.psd", STUDY_OF_FRAMES);
        let sine = concat!(env!("CARGO_MANIFEST_DIR"), "/plans/ground/sine.csv");
        std::fs::copy(sine, self.folder.path().join("sine.csv")).expect("a ground motion");
        vec![
            Row::new(
                "study of 10⁴ runs of 3000 steps",
                "≥ 5 times as fast, ≤ 0.125 s",
                5,
                move || self.run(&["study", "run", &batched]),
            )
            .beside(Peer::process("NumPy", &["study"])),
            Row::new(
                "study of 10⁵ runs of 149 steps",
                "≤ 0.6 s",
                5,
                move || self.run(&["study", "run", &of_149]),
            ),
            Row::new(
                "study of frames of two storeys, one step",
                "≥ 10 times as fast, ≤ 0.3 µs",
                5,
                move || self.run(&["study", "run", &frames]) / (1000.0 * 800.0),
            )
            .beside(Peer::steps("OpenSees", &["building", "2", "elastic"])),
            Row::new(
                "study of an impact, outside of a batch, one step",
                "≤ 0.06 µs",
                5,
                move || self.run(&["study", "run", &alone]) / (2000.0 * 3000.0),
            ),
        ]
    }

    fn checks(&self) -> Vec<Row<'_>> {
        let small = include_str!("../../plans/01_first_blow.psd");
        let mut text = small.to_owned();
        for index in 0..222 {
            let _ = write!(
                text,
                "\nimpact hit_{index} {{\n  striker = hammer\n  mass = 1 kg * (1 + 0.5)\n  time_step = critical / 20\n  duration = 1 s\n}}\n\n\
                 require \"stays {index}\" abs(hit_{index}.max_displacement) < 20 cm\n"
            );
        }
        let long = self.plan("lines.psd", &text);
        let lines = text.lines().count();
        vec![
            Row::new("`psd check`, small plan", "≤ 2 ms", 5, || {
                mean(|| process(&["check", "plans/01_first_blow.psd"]))
            }),
            Row::new(
                format!("`psd check`, {lines} lines"),
                "≤ 8 ms",
                5,
                move || mean(|| process(&["check", &long])),
            ),
            Row::new("`psd check plans/beam.psd`", "", 5, || {
                mean(|| process(&["check", "plans/beam.psd"]))
            }),
        ]
    }
}

/// Processor time of the processes of a call \[s\], the mean of as many calls as a turn takes.
fn mean(mut call: impl FnMut()) -> f64 {
    let before = time_of_children();
    for calls in 1.. {
        call();
        let time = time_of_children() - before;
        if time >= LEAST {
            return time / size_of(calls);
        }
    }
    f64::NAN
}

/// Runs psd to its end.
fn process(arguments: &[&str]) {
    let status = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    assert!(status.is_ok_and(|status| status.success()), "{arguments:?}");
}
