//! The swarm: lives of tests that nobody wrote down. Session, guard, drivers, emulated controllers of every protocol, disk, clock and
//! operator run in one thread and in simulated time. A seed draws a plan, a rig, and what befalls them: faults of lines, controllers,
//! sensors and disk, kills, signals, answers, changes between two sessions, amended plans. A plan moves one axis, or it shakes or strikes a
//! frame of which the rig carries the whole or a part, perhaps under an axial load. In: seeds. Out: the laws hold in each life. A
//! life that breaks one is reduced, and reported in one line with the command that repeats it.
//!
//! `PSD_SWARM_SEED=4711` lives one life; `PSD_SWARM_SEEDS=1000000` lives so many.

mod bench;
mod case;
mod disk;
mod draw;
mod fault;
mod frame;
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

use case::Case;
use laws::{Breach, Law};
use life::{live, live_logged};
use psd_plan::record::failpoint::{Guarding, without};
use psd_rig::emulator::Log;
use shrink::shrunk;
use tally::Tally;

/// Lives of the test command. Half of them meet every fault, change and law, and the defect that is found last is found in 260.
const SEEDS: u64 = 1_250;

/// A number from the environment.
fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// What a search has found: the first life of each kind of breach.
type Found = BTreeMap<(Law, String), (u64, Breach)>;

/// A search through the lives of seeds.
struct Search {
    seeds: Range<u64>,
    /// A guard that is off, so that the defect that it prevents is back.
    without: Option<Guarding>,
    /// The search ends with the first life that breaks this law.
    until: Option<Law>,
}

impl Search {
    /// Lives the cases on all processors.
    fn lived(&self) -> (Tally, Found) {
        let next = AtomicU64::new(self.seeds.start);
        let found = Mutex::new((Tally::default(), Found::new()));
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| match self.without {
                    Some(guard) => without(guard, || self.search(&next, &found)),
                    None => self.search(&next, &found),
                });
            }
        });
        found.into_inner().unwrap()
    }

    fn search(&self, next: &AtomicU64, found: &Mutex<(Tally, Found)>) {
        let mut tally = Tally::default();
        let alone = self.seeds.end - self.seeds.start == 1;
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= self.seeds.end {
                break;
            }
            let case = Case::of_seed(seed);
            // A single life is shown with the bytes of its lines.
            let lived = if alone {
                println!("{case:#?}");
                live_logged(&case, Log::to(Box::new(std::io::stdout())))
            } else {
                live(&case)
            };
            tally.plus(lived.tally);
            tally.lives += 1;
            let Some(breach) = lived.breaches.into_iter().next() else {
                continue;
            };
            if self.until == Some(breach.law) {
                next.store(self.seeds.end, Ordering::Relaxed);
            }
            let mut found = found.lock().unwrap();
            let first = found.1.entry((breach.law, breach.kind()));
            let first = first.or_insert_with(|| (seed, breach.clone()));
            if seed < first.0 {
                *first = (seed, breach);
            }
        }
        found.lock().unwrap().0.plus(tally);
    }
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
    let search = Search {
        seeds,
        without: None,
        until: None,
    };
    let (tally, found) = search.lived();
    println!("{tally}{:.1} s", began.elapsed().as_secs_f64());
    let reports: Vec<String> = found.values().map(report).collect();
    assert!(reports.is_empty(), "\n{}", reports.join("\n"));
    if only.is_none() {
        let none: Vec<&str> = Vec::new();
        assert_eq!(tally.unmet(), none, "no life has met this");
    }
}

/// Each of these guards prevents a defect that a run had. Without it the swarm finds a life that breaks this law.
#[test]
fn a_defect_that_is_brought_back_is_found() {
    for (guard, law) in [
        (Guarding::NewestRig, Law::NotFaster),
        (Guarding::WordOrder, Law::InsideLimits),
        (Guarding::ForceFound, Law::SameSpecimen),
        (Guarding::IntentDurable, Law::TargetDurable),
        (Guarding::SampleDurable, Law::ReadingDurable),
    ] {
        let search = Search {
            seeds: 0..SEEDS,
            without: Some(guard),
            until: Some(law),
        };
        let (tally, found) = search.lived();
        let broken = found.iter().find(|((broken, _), _)| *broken == law);
        let (_, (seed, breach)) = broken.unwrap_or_else(|| panic!("{guard:?}: {found:?}"));
        println!(
            "{guard:?}: found in {} lives, seed {seed}: {}",
            tally.lives, breach.how
        );
    }
}
