//! Hostile input: every reader of foreign bytes, on mutations of good ones. In: good inputs of a reader. Out: the first input at which it
//! panics, computes for a second or takes 256 MiB, reduced. The same cases in every run, unless the environment asks for others:
//! `PSD_HOSTILE_SECONDS` per target, `PSD_HOSTILE_SEED`, and `PSD_HOSTILE_CASE` for a single case.

mod journals;
mod languages;
mod lines;
mod messages;
mod mutation;
mod tables;

use std::cell::Cell;
use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;
use rustix::time::{ClockId, clock_gettime};

use mutation::mutated;

/// Executions of a target in the test command.
const EXECUTIONS: u64 = 100;
/// Longest computation of one execution, in the unoptimised build, whatever else the machine does.
const MOST_TIME: Duration = Duration::from_secs(1);
/// Most memory of one execution at a time.
const MOST_BYTES: u64 = 256 << 20;
/// Longest time of an execution that does not end, on a loaded machine: the process then ends with its seed and its case.
const ENDLESS: Duration = Duration::from_mins(2);
/// Most executions that reduce an input.
const REDUCTIONS: usize = 400;

fn number(variable: &str) -> Option<u64> {
    env::var(variable).ok()?.parse().ok()
}

/// The processor time of this thread.
fn computed() -> Duration {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    Duration::try_from(now).expect("time since the start")
}

/// The reason why an input is a find; None if the target endures it.
fn fault(input: &[u8], target: &impl Fn(&[u8])) -> Option<String> {
    let start = computed();
    let ended = Cell::new(None);
    let memory = allocation_counter::measure(|| {
        let caught = catch_unwind(AssertUnwindSafe(|| target(input)));
        ended.set(Some(caught.map_err(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
                .unwrap_or_default()
        })));
    });
    let time = computed().saturating_sub(start);
    match ended.take()? {
        Err(text) => Some(format!("panic: {text}")),
        Ok(()) if time > MOST_TIME => Some(format!("{time:.1?} of computation")),
        Ok(()) if memory.bytes_max > MOST_BYTES => Some(format!("{} bytes", memory.bytes_max)),
        Ok(()) => None,
    }
}

/// A smaller input that is a find as well: parts of it are removed.
fn reduced(mut input: Vec<u8>, target: &impl Fn(&[u8])) -> Vec<u8> {
    let mut left = REDUCTIONS;
    let mut part = input.len() / 2;
    while part > 0 {
        let mut at = 0;
        while at < input.len() && left > 0 {
            let mut shorter = input.clone();
            shorter.drain(at..(at + part).min(input.len()));
            left -= 1;
            if fault(&shorter, target).is_some() {
                input = shorter;
            } else {
                at += part;
            }
        }
        part /= 2;
    }
    input
}

/// Ends the process if the same case is executed for too long: an endless one gives no other answer. It watches as long as the case exists.
fn watch(name: &str, seed: u64, case: &Arc<Mutex<(u64, Instant)>>) {
    let (name, case) = (name.to_owned(), Arc::downgrade(case));
    thread::spawn(move || {
        while let Some(case) = case.upgrade() {
            let (number, since) = *case.lock().expect("no panic with it");
            drop(case);
            if since.elapsed() > ENDLESS {
                eprintln!("{name}: no end\nPSD_HOSTILE_SEED={seed} PSD_HOSTILE_CASE={number}");
                std::process::exit(101);
            }
            thread::sleep(Duration::from_millis(100));
        }
    });
}

/// Executes the target on mutations of the seeds.
#[track_caller]
fn attack(name: &str, seeds: &[Vec<u8>], target: impl Fn(&[u8])) {
    for seed in seeds {
        assert_eq!(fault(seed, &target), None, "{name}: an input as it was");
    }
    let seed = number("PSD_HOSTILE_SEED").unwrap_or(1);
    let only = number("PSD_HOSTILE_CASE");
    let seconds = number("PSD_HOSTILE_SECONDS").map(Duration::from_secs);
    let start = Instant::now();
    let mut case = only.unwrap_or(0);
    let watched = Arc::new(Mutex::new((case, start)));
    watch(name, seed, &watched);
    loop {
        *watched.lock().expect("no panic with it") = (case, Instant::now());
        let name_sum = name.bytes().map(u64::from).sum::<u64>();
        let mut random = Pcg64Mcg::seed_from_u64(seed ^ name_sum << 32 ^ case.rotate_left(44));
        let input = mutated(&mut random, seeds);
        if let Some(found) = fault(&input, &target) {
            let smallest = reduced(input, &target);
            panic!(
                "{name}: {found}\nPSD_HOSTILE_SEED={seed} PSD_HOSTILE_CASE={case}, reduced: {}",
                smallest.escape_ascii()
            );
        }
        case += 1;
        let is_done = match seconds {
            _ if only.is_some() => true,
            Some(seconds) => start.elapsed() >= seconds,
            None => case >= EXECUTIONS,
        };
        if is_done {
            println!("{name}: {case} executions");
            return;
        }
    }
}

#[test]
fn a_reader_that_fails_is_found() {
    let seed = b"let a = 1 mm\n".to_vec();
    let panics = |bytes: &[u8]| assert!(!bytes.starts_with(b"{"), "no block");
    assert_eq!(fault(b"{ }", &panics).as_deref(), Some("panic: no block"));
    assert_eq!(reduced(b"{ mm }".to_vec(), &panics), b"{");
    let takes = |_: &[u8]| drop(std::hint::black_box(Vec::<u8>::with_capacity(300 << 20)));
    assert!(fault(&seed, &takes).is_some_and(|found| found.ends_with("bytes")));
    let computes = |_: &[u8]| {
        let start = computed();
        while computed().saturating_sub(start) <= MOST_TIME {}
    };
    assert!(fault(&seed, &computes).is_some_and(|found| found.ends_with("computation")));
    // Mutations reach what a good input has not.
    let small = |bytes: &[u8]| assert!(bytes.len() < 20);
    let caught = catch_unwind(|| attack("a planted fault", &[seed], small));
    let text = *caught
        .expect_err("a find")
        .downcast::<String>()
        .expect("a message");
    assert!(text.contains("PSD_HOSTILE_CASE="), "{text}");
}
