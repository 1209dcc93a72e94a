//! When a study may stop. In: a goal, a level of confidence, outcomes so far. Out: go on to the next look, or stop with a decision.
//!
//! A study that looks at its interval after every run and stops when the limit is outside decides wrongly far more often than α: it has many
//! chances. Here it looks at 128, 256, 512 … runs only, and look m may err with α/(m(m + 1)). Their sum is at most α, so the decision and
//! the interval hold however long the study runs, and also if `at_most` is raised later.

use super::{Confidence, Decision, Interval, Outcomes};
use crate::study::number;

/// Runs at the first look.
pub const FIRST_LOOK: u64 = 128;

/// What a study runs for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// To decide whether the probability of failure is below this limit.
    Decide { limit: f64 },
    /// Until half of the width of its interval is at most this.
    HalfWidth(f64),
}

/// A goal, and at most so many runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoppingRule {
    pub goal: Goal,
    pub confidence: Confidence,
    pub at_most: u64,
}

/// A planned look at the outcomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// From 1.
    pub number: u32,
    /// Runs at which it is taken.
    pub runs: u64,
    /// Confidence of its interval.
    pub confidence: Confidence,
}

/// The end of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conclusion {
    pub look: Look,
    /// Valid although the study chose its own end.
    pub interval: Interval,
    /// Met or not met if the goal was to decide and the study could; undecided otherwise.
    pub decision: Decision,
    /// The goal was reached, not only `at_most`.
    pub reached: bool,
}

impl StoppingRule {
    /// All looks: the last one is at `at_most`.
    pub fn looks(&self) -> impl Iterator<Item = Look> + use<> {
        let at_most = self.at_most;
        let confidence = self.confidence;
        let look = move |number: u32| {
            let m = f64::from(number);
            let spent = confidence.error() / (m * (m + 1.0));
            Look {
                number,
                runs: (FIRST_LOOK << (number - 1)).min(at_most),
                confidence: Confidence(1.0 - spent),
            }
        };
        // A look is planned while the one before it is below `at_most`.
        (1..=57_u32)
            .take_while(move |number| *number == 1 || FIRST_LOOK << (number - 2) < at_most)
            .map(look)
    }

    /// The conclusion of a study at a look, or None if it goes on to the next one.
    ///
    /// # Panics
    /// If the outcomes are not those of all runs of this look.
    #[must_use]
    pub fn conclude(&self, look: Look, outcomes: &Outcomes) -> Option<Conclusion> {
        assert_eq!(outcomes.runs(), look.runs, "runs at look {}", look.number);
        let interval = outcomes.interval(look.confidence);
        let decision = match self.goal {
            Goal::Decide { limit } => Decision::of(interval, limit),
            Goal::HalfWidth(_) => Decision::Undecided,
        };
        let reached = match self.goal {
            Goal::Decide { .. } => decision != Decision::Undecided,
            Goal::HalfWidth(most) => interval.half_width() <= most,
        };
        (reached || look.runs >= self.at_most).then_some(Conclusion {
            look,
            interval,
            decision,
            reached,
        })
    }

    /// The half-width below which no study of this length comes: a goal below it is never reached.
    #[must_use]
    pub fn least_half_width(&self) -> f64 {
        let last = self.looks().last();
        last.map_or(f64::INFINITY, |look| {
            -0.5 * ((0.5 * look.confidence.error()).ln() / number(look.runs)).exp_m1()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::sampling::philox::{Philox, Purpose};
    use super::*;

    fn rule(goal: Goal, at_most: u64) -> StoppingRule {
        StoppingRule {
            goal,
            confidence: Confidence::new(0.95).unwrap(),
            at_most,
        }
    }

    /// A study of runs that fail with this probability.
    fn study(rule: &StoppingRule, seed: u64, probability: f64) -> Conclusion {
        let stream = Philox::new(seed);
        let mut outcomes = Outcomes::default();
        for look in rule.looks() {
            for run in outcomes.runs()..look.runs {
                if stream.uniform(Purpose::Value, run, 0) < probability {
                    outcomes.failed += 1;
                } else {
                    outcomes.passed += 1;
                }
            }
            if let Some(conclusion) = rule.conclude(look, &outcomes) {
                return conclusion;
            }
        }
        panic!("the last look concludes");
    }

    #[test]
    fn looks_double_and_end_at_the_last_run() {
        let runs = |at_most| {
            let looks = rule(Goal::HalfWidth(0.1), at_most).looks();
            looks.map(|look| look.runs).collect::<Vec<u64>>()
        };
        assert_eq!(runs(1000), [128, 256, 512, 1000]);
        assert_eq!(runs(512), [128, 256, 512]);
        assert_eq!(runs(50), [50]);
        assert_eq!(runs(1 << 40).len(), 34);
        let spent: f64 = rule(Goal::HalfWidth(0.1), 1 << 40)
            .looks()
            .map(|look| look.confidence.error())
            .sum();
        assert!((spent - 0.05 * (1.0 - 1.0 / 35.0)).abs() < 1e-12);
    }

    /// At the limit itself, any decision is wrong: of 1000 studies of up to 8192 runs at most 5 % decide. The intervals at the chosen end
    /// contain the truth in at least 95 %.
    #[test]
    fn a_study_at_its_limit_decides_wrongly_at_most_with_alpha() {
        let rule = rule(Goal::Decide { limit: 0.02 }, 8192);
        let (mut decided, mut covered) = (0, 0);
        for seed in 0..1000 {
            let conclusion = study(&rule, seed, 0.02);
            decided += u32::from(conclusion.decision != Decision::Undecided);
            covered += u32::from(conclusion.interval.contains(0.02));
        }
        assert!(decided <= 50, "{decided} of 1000");
        assert!(covered >= 950, "{covered} of 1000");
    }

    /// Far from the limit, studies decide rightly and early.
    #[test]
    fn a_study_far_from_its_limit_decides_soon() {
        let rule = rule(Goal::Decide { limit: 0.05 }, 1 << 20);
        for seed in 0..50 {
            let low = study(&rule, seed, 0.005);
            assert_eq!((low.decision, low.reached), (Decision::Met, true));
            let high = study(&rule, seed, 0.2);
            assert_eq!(high.decision, Decision::NotMet);
            assert!(low.look.runs <= 1024 && high.look.runs <= 512);
        }
    }

    #[test]
    fn a_half_width_is_reached_or_the_study_reports_that_it_is_not() {
        let wide = study(&rule(Goal::HalfWidth(0.02), 100_000), 1, 0.1);
        assert!(wide.reached && wide.interval.half_width() <= 0.02);
        let narrow = rule(Goal::HalfWidth(1e-6), 1000);
        assert!(!study(&narrow, 1, 0.1).reached);
        assert!(narrow.least_half_width() > 1e-3);
    }
}
