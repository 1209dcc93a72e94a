//! Runs the cases, several at a time, and prints each outcome as soon as all earlier ones are printed. In: cases. Out: their
//! outcomes, in order.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::TestArguments;
use super::cases::Case;
use super::failures;
use crate::exit::Failure;
use crate::files::accepted::truth_of;
use crate::files::golden_run;
use crate::files::golden_run::Extent;
use crate::output::print_message;
use crate::settings::Settings;
use psd::golden::print::console;
use psd::golden::{Outcome, Tested, compare};

/// The settings of the test run.
pub struct Trials<'a> {
    pub arguments: &'a TestArguments,
    pub settings: Settings,
    /// Whether each outcome is printed for the operator as it ends.
    pub human: bool,
}

/// Stack size for the deepest plan, also in a build without optimisation.
const STACK: usize = 32 << 20;

impl Trials<'_> {
    /// Runs all cases. With `--fail-fast` no case after the first failure counts, even if it ran.
    pub fn run(&self, cases: &[Case]) -> Result<Vec<Tested>, Failure> {
        let mut builder = rayon::ThreadPoolBuilder::new().stack_size(STACK);
        if let Some(jobs) = self.arguments.jobs {
            builder = builder.num_threads(jobs.get());
        }
        let pool = builder.build().map_err(|error| {
            Failure::command_line(format!("no threads to run plans on: {error}"))
        })?;
        let first_bad = AtomicUsize::new(usize::MAX);
        let printer = Printer {
            pending: Mutex::default(),
            trials: self,
            cases,
            first_bad: &first_bad,
        };
        let one = |(index, case): (usize, &Case)| {
            let beyond = self.arguments.fail_fast && first_bad.load(Ordering::SeqCst) < index;
            let outcome = if beyond {
                Outcome::NotRun
            } else {
                self.one(case)
            };
            if !outcome.is_good() && outcome != Outcome::NotRun {
                first_bad.fetch_min(index, Ordering::SeqCst);
            }
            let tested = Tested {
                name: case.name.clone(),
                folder: case.golden.path().display().to_string(),
                outcome,
            };
            printer.print(index, tested.clone());
            tested
        };
        let mut tested: Vec<Tested> =
            pool.install(|| cases.par_iter().enumerate().map(one).collect());
        if self.arguments.fail_fast {
            let last = first_bad.load(Ordering::SeqCst);
            for (tested, case) in tested.iter_mut().zip(cases).skip(last.saturating_add(1)) {
                tested.outcome = Outcome::NotRun;
                // It may have run in parallel with the failed one.
                failures::clear(&self.arguments.out, case)?;
            }
        }
        Ok(tested)
    }

    /// One plan; an error is its outcome.
    fn one(&self, case: &Case) -> Outcome {
        self.outcome(case)
            .unwrap_or_else(|failure| Outcome::Failed(failure.to_string()))
    }

    fn outcome(&self, case: &Case) -> Result<Outcome, Failure> {
        if self.arguments.accept {
            let trial = golden_run::trial(&case.plan, Extent::All)?;
            return Ok(Outcome::Accepted(case.golden.accept(
                &trial.files,
                &trial.tolerances,
                self.arguments.anew,
                self.arguments.pages,
            )?));
        }
        if let Some(reason) = case.golden.belongs_to_another()? {
            return Ok(Outcome::Failed(reason));
        }
        let trial = golden_run::trial(&case.plan, Extent::Compared)?;
        let accepted = case.golden.truth()?;
        failures::clear(&self.arguments.out, case)?;
        if accepted.is_empty() {
            return Ok(Outcome::NotAccepted);
        }
        let found = compare(&accepted, &truth_of(&trial.files), &trial.tolerances);
        if found.is_empty() {
            return Ok(Outcome::Same {
                verdict: trial.verdict,
            });
        }
        // Images and report are made only for a case with differences.
        let files = golden_run::trial(&case.plan, Extent::All)?.files;
        failures::write(&self.arguments.out, case, &accepted, &files, &found)?;
        Ok(Outcome::Differs(found))
    }
}

/// Prints outcomes in the order of the cases, as soon as all earlier ones are known.
struct Printer<'a, 'b> {
    pending: Mutex<Pending>,
    trials: &'a Trials<'b>,
    cases: &'a [Case],
    first_bad: &'a AtomicUsize,
}

/// Outcomes that wait for an earlier one.
#[derive(Default)]
struct Pending {
    /// Index of the next case to print.
    next: usize,
    outcomes: BTreeMap<usize, Tested>,
}

impl Printer<'_, '_> {
    fn print(&self, index: usize, tested: Tested) {
        if !self.trials.human {
            return;
        }
        let mut pending = self.pending.lock().expect("no panic while printing");
        pending.outcomes.insert(index, tested);
        loop {
            let next = pending.next;
            let Some(mut tested) = pending.outcomes.remove(&next) else {
                break;
            };
            if self.trials.arguments.fail_fast && self.first_bad.load(Ordering::SeqCst) < next {
                tested.outcome = Outcome::NotRun;
            }
            print_message(&console::summary_text(&tested, self.trials.settings.color));
            if matches!(tested.outcome, Outcome::Differs(_)) {
                let folder = failures::folder(&self.trials.arguments.out, &self.cases[next]);
                print_message(&format!("  see {}\n", folder.display()));
            }
            pending.next += 1;
        }
    }
}
