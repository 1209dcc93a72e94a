//! Every case with its peer, its goal and what is measured here, in turns: `cargo bench --bench table`; `-- PHRASE` takes the cases whose
//! names contain this phrase. Times are of the processor, medians; a ratio is the median of those of the turns, because the speed of a shared
//! machine changes within seconds. A peer runs where its modules are installed for the Python of `PSD_BENCH_PYTHON`, else of `python3`. The
//! other benches have the details of one case each.

#[path = "../steps/cases.rs"]
mod cases;
#[path = "../steps/kernel.rs"]
mod kernel;
mod peer;
mod processes;
#[path = "../rig/stand_in.rs"]
#[allow(dead_code, reason = "the bench of the rig has the other half")]
mod stand_in;

use std::cell::RefCell;
use std::rc::Rc;

use peer::{Peer, Peers};
use processes::{Processes, size_of};

/// What is measured, and beside what.
struct Row<'a> {
    case: String,
    peer: Option<Peer>,
    goal: &'static str,
    turns: usize,
    /// Time of one item, in a turn \[s\].
    psd: Box<dyn FnMut() -> f64 + 'a>,
    /// The kernel of the same formula, in the same turn \[s\].
    kernel: Option<Box<dyn FnMut() -> f64 + 'a>>,
}

impl<'a> Row<'a> {
    fn new(
        case: impl Into<String>,
        goal: &'static str,
        turns: usize,
        psd: impl FnMut() -> f64 + 'a,
    ) -> Self {
        Self {
            case: case.into(),
            peer: None,
            goal,
            turns,
            psd: Box::new(psd),
            kernel: None,
        }
    }

    fn beside(mut self, peer: Peer) -> Self {
        self.peer = Some(peer);
        self
    }
}

/// The steps of psd's numerics.
fn steps<'a>() -> Vec<Row<'a>> {
    let all = Rc::new(RefCell::new(cases::all()));
    let measured = |name: &str| {
        let index = all.borrow().iter().position(|case| case.name == name);
        let index = index.unwrap_or_else(|| panic!("no case is named {name}"));
        let all = Rc::clone(&all);
        Box::new(move || {
            let case = &mut all.borrow_mut()[index];
            let mut times: Vec<f64> = (0..40).map(|_| case.turn() / case.steps).collect();
            median(&mut times)
        })
    };
    let recorded = "impact, elastic, recorded";
    let one_step = "impact, elastic, 8 numbers recorded, one step";
    let mut rows = vec![
        Row::new(one_step, "≥ 190 times as fast", 9, measured(recorded))
            .beside(Peer::steps("OpenSees", &["impact"])),
        Row::new(one_step, "≤ 1.2 times as long", 9, measured(recorded))
            .beside(Peer::steps("Numba", &["impact_numba"])),
    ];
    for (name, goal) in [("elastic", "≤ 16 ns"), ("bilinear", "≤ 20 ns")] {
        let case = format!("impact, {name}, recorded");
        let mut row = Row::new(
            format!("impact, {name}, 8 numbers recorded, one step"),
            goal,
            9,
            measured(&case),
        );
        row.kernel = Some(measured(&format!("{case}: kernel")));
        rows.push(row);
    }
    rows.push(
        Row::new(
            "one degree of freedom, linear, one step",
            "≥ 100 times as fast",
            9,
            measured("one degree of freedom, recorded"),
        )
        .beside(Peer::steps("OpenSees", &["linear"])),
    );
    for (material, storeys, goal) in [
        ("elastic", "10", "≥ 60 times as fast"),
        ("elastic", "100", "≥ 100 times as fast"),
        ("elastic", "1000", "≥ 120 times as fast"),
        ("bilinear", "10", "≥ 60 times as fast"),
        ("bilinear", "100", "≥ 90 times as fast"),
        ("bilinear", "1000", "≥ 110 times as fast"),
    ] {
        let name = format!("{storeys} storeys, {material}");
        let case = format!("shear building, {material}, {storeys} storeys, one step");
        let peer = Peer::steps("OpenSees", &["building", storeys, material]);
        rows.push(Row::new(case, goal, 5, measured(&name)).beside(peer));
    }
    rows
}

/// psd's own time of a step on a real rig that answers immediately, without the time of its emulator.
fn rig_step<'a>() -> Row<'a> {
    let plan = stand_in::plan();
    Row::new("psd's own time per rig step", "≤ 9 µs", 9, move || {
        let line = stand_in::AtOnce::new(stand_in::emulator(&plan));
        let before = cases::own_time();
        let record = stand_in::run(&plan, &line);
        let whole = cases::own_time() - before;
        let (sent, emulator) = (line.take_sent(), stand_in::emulator(&plan));
        let before = cases::own_time();
        std::hint::black_box(stand_in::replies(emulator, &sent));
        (whole - (cases::own_time() - before)) / size_of(stand_in::steps(&record))
    })
}

fn main() {
    let phrase: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    let phrase = phrase.join(" ");
    let (peers, processes) = (Peers::installed(), Processes::new());
    let mut rows = steps();
    rows.push(rig_step());
    rows.extend(processes.rows());
    println!("{}\n", machine());
    println!("| case | peer | goal | psd |\n|---|---|---|---|");
    for row in &mut rows {
        if row.case.contains(&phrase) {
            measure(row, &peers);
        }
    }
}

/// Measures and prints one row.
fn measure(row: &mut Row<'_>, peers: &Peers) {
    let peer = row.peer.as_ref();
    let runs = peer.is_some_and(|peer| peers.have(peer));
    let (mut own, mut others, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..row.turns {
        let time = (row.psd)();
        own.push(time);
        let other = match (&mut row.kernel, peer) {
            (Some(kernel), _) => kernel(),
            (None, Some(peer)) if runs => peers.time(peer),
            _ => continue,
        };
        others.push(other);
        ratios.push(other / time);
    }
    let name = peer.map_or("", |peer| peer.name);
    let (beside, compared) = if others.is_empty() {
        let missing = peer.map(|_| format!("{name}: not installed"));
        (missing.unwrap_or_default(), String::new())
    } else {
        let name = if row.kernel.is_some() { "kernel" } else { name };
        let ratio = median(&mut ratios);
        let compared = if ratio > 1.0 {
            format!(", {} times as fast", Rounded(ratio))
        } else {
            format!(", {} times as long", Rounded(1.0 / ratio))
        };
        (format!("{name} {}", time(median(&mut others))), compared)
    };
    println!(
        "| {} | {beside} | {} | {}{compared} |",
        row.case,
        row.goal,
        time(median(&mut own))
    );
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// With three significant digits.
struct Rounded(f64);

impl std::fmt::Display for Rounded {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let decimals = match self.0 {
            ..10.0 => 2,
            10.0..100.0 => 1,
            _ => 0,
        };
        write!(out, "{:.decimals$}", self.0)
    }
}

fn time(seconds: f64) -> String {
    let (unit, per_second) = match seconds {
        ..1e-6 => ("ns", 1e9),
        1e-6..1e-3 => ("µs", 1e6),
        1e-3..1.0 => ("ms", 1e3),
        _ => ("s", 1.0),
    };
    format!("{} {unit}", Rounded(seconds * per_second))
}

/// The processor, the vectors that it has, and how many programs wanted to run in the last minute.
fn machine() -> String {
    let read = |path| std::fs::read_to_string(path).unwrap_or_default();
    let (processors, load) = (read("/proc/cpuinfo"), read("/proc/loadavg"));
    let entry = |key: &str| {
        let line = processors.lines().find(|line| line.starts_with(key));
        line.and_then(|line| line.split_once(": "))
            .map_or("unknown", |(_, value)| value)
    };
    let flags = entry("flags");
    let has = |flag: &str| flags.split(' ').any(|other| other == flag);
    let vectors = if has("avx512f") {
        "AVX-512"
    } else if has("avx2") {
        "AVX2"
    } else {
        "no AVX2"
    };
    format!(
        "psd {}. {}, {vectors}; load {}",
        env!("CARGO_PKG_VERSION"),
        entry("model name"),
        load.split(' ').next().unwrap_or_default()
    )
}
