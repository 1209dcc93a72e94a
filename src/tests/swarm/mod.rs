//! The swarm: lives of tests that nobody wrote down. Session, guard, drivers, emulated controllers of every protocol, disk, clock and
//! operator run in one thread and in simulated time. A seed draws a plan, a rig, and what befalls them: faults of lines, controllers,
//! sensors and disk, kills, signals, answers, changes between two sessions, amended plans. In: seeds. Out: the laws hold in each life. A
//! life that breaks one is reduced, and reported in one line with the command that repeats it.
//!
//! `PSD_SWARM_SEED=4711` lives one life; `PSD_SWARM_SEEDS=1000000` lives so many.

mod bench;
mod case;
mod disk;
mod draw;
mod fault;
mod laws;
mod life;
mod operator;
mod resumption;
mod shrink;
mod tally;
mod world;

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::emulator::Log;
use case::Case;
use laws::{Breach, Law};
use life::{live, live_logged};
use shrink::shrunk;
use tally::Tally;

/// Lives of the test command.
const SEEDS: u64 = 5_000;

/// A number from the environment.
fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// What a search has found: the first life of each kind of breach.
type Found = BTreeMap<(Law, String), (u64, Breach)>;

/// Lives the cases of these seeds on all processors. A single one is shown with the bytes of its lines.
fn lived(seeds: Range<u64>, guarded: impl Fn(&dyn Fn()) + Sync) -> (Tally, Found) {
    let next = AtomicU64::new(seeds.start);
    let alone = seeds.end - seeds.start == 1;
    let found = Mutex::new((Tally::default(), Found::new()));
    let search = || {
        let mut tally = Tally::default();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end {
                break;
            }
            let case = Case::of_seed(seed);
            let lived = if alone {
                println!("{case:#?}");
                live_logged(&case, Log::to(Box::new(std::io::stdout())))
            } else {
                live(&case)
            };
            tally.plus(lived.tally);
            tally.lives += 1;
            for breach in lived.breaches.into_iter().take(1) {
                let mut found = found.lock().unwrap();
                let first = found.1.entry((breach.law, breach.kind()));
                let first = first.or_insert_with(|| (seed, breach.clone()));
                if seed < first.0 {
                    *first = (seed, breach);
                }
            }
        }
        found.lock().unwrap().0.plus(tally);
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| guarded(&search));
        }
    });
    found.into_inner().unwrap()
}

/// The one line that reports a life in which a law was broken.
fn report((seed, breach): &(u64, Breach)) -> String {
    let smallest = shrunk(&Case::of_seed(*seed), breach.law);
    format!(
        "PSD_SWARM_SEED={seed} cargo test --lib swarm::every_life -- --nocapture   # broken: {}; {}; reduced to {smallest:?}",
        breach.law.text(),
        breach.how
    )
}

#[test]
fn every_life_keeps_the_laws() {
    let began = Instant::now();
    let only = number("PSD_SWARM_SEED");
    let seeds = only.map_or(0..number("PSD_SWARM_SEEDS").unwrap_or(SEEDS), |seed| {
        seed..seed + 1
    });
    let (tally, found) = lived(seeds, |search| search());
    println!("{tally}{:.1} s", began.elapsed().as_secs_f64());
    let reports: Vec<String> = found.values().map(report).collect();
    assert!(reports.is_empty(), "\n{}", reports.join("\n"));
    if only.is_none() {
        let none: Vec<&str> = Vec::new();
        assert_eq!(tally.unmet(), none, "no life has met this");
    }
}
