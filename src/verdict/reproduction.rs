//! Numbers of a run beside published ones. In: the comparisons of a plan, and a record. Out: the difference of each, and whether the run
//! reproduces it. It is no verdict: nothing is said about a specimen.

use super::undecided::unless_undecided;
use super::{Bound, ConditionOutcome, Verdict, assess_condition};
use psd_plan::formula::Results;
use psd_plan::record::Record;
use psd_plan::{DecisionRule, Reproduction};

/// A number of the run beside a published one.
#[derive(Clone, Debug)]
pub struct ReproductionOutcome {
    pub name: String,
    /// The publication.
    pub source: String,
    /// The value alone, within the tolerance of the published number.
    pub compared: ConditionOutcome,
}

impl ReproductionOutcome {
    /// Whether the value differs from the published number by no more than the tolerance.
    #[must_use]
    pub fn reproduces(&self) -> bool {
        self.compared.verdict == Verdict::Pass
    }

    /// As in `summary.json` and on a terminal.
    #[must_use]
    pub fn statement(&self) -> &'static str {
        if self.reproduces() {
            "reproduces"
        } else {
            "does not reproduce"
        }
    }

    /// Published number and tolerance, SI.
    #[must_use]
    pub const fn published(&self) -> Option<(f64, f64)> {
        match self.compared.bound {
            Some(Bound::Within { target, tolerance }) => Some((target, tolerance)),
            _ => None,
        }
    }

    /// The value minus the published number, SI.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        let (published, _) = self.published()?;
        Some(self.compared.value? - published)
    }

    /// The difference over the size of the published number; None if that is 0.
    #[must_use]
    pub fn relative_difference(&self) -> Option<f64> {
        let (published, _) = self.published()?;
        let relative = self.difference()? / published.abs();
        relative.is_finite().then_some(relative)
    }
}

/// Compares a number of the run with a published one.
pub(super) fn compare(
    reproduction: &Reproduction,
    record: &Record,
    results: &dyn Results,
) -> ReproductionOutcome {
    let Reproduction {
        name,
        source,
        condition,
    } = reproduction;
    let rule = DecisionRule::ValueAlone;
    let compared = assess_condition(condition, rule, results);
    ReproductionOutcome {
        name: name.clone(),
        source: source.clone(),
        compared: unless_undecided(condition, rule, compared, record, results),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{condition, record, result};
    use super::super::{Verdict, assess};
    use psd_plan::formula::Formula;
    use psd_plan::record::Outcome;
    use psd_plan::{DecisionRule, Reproduction, Test};

    fn reproduction(value: &'static str, published: f64, tolerance: f64) -> Reproduction {
        Reproduction {
            name: "peak".to_owned(),
            source: "paper".to_owned(),
            condition: condition(
                result(value),
                Test::Within {
                    target: Formula::Constant(published),
                    tolerance: Formula::Constant(tolerance),
                    relative: false,
                },
            ),
        }
    }

    /// The result is 8 with u = 0.1. Neither a large nor a withheld uncertainty changes a difference of two numbers, and a difference does
    /// not change the verdict of the run.
    #[test]
    fn a_published_number_is_compared_with_the_value_alone_and_decides_nothing() {
        let mut plan = crate::tests::testing::empty_plan();
        plan.decision_rule = DecisionRule::Guarded;
        plan.reproductions = vec![
            reproduction("max_displacement", 8.05, 0.05),
            reproduction("max_displacement", -10.0, 0.05),
            reproduction("stop_time", 1.0, 0.5),
        ];
        let mut record = record(Outcome::Completed);
        let assessment = assess(&plan, &record);
        assert_eq!(assessment.verdict, Verdict::Completed);
        let [near, far, missing] = &assessment.reproductions[..] else {
            panic!("{:?}", assessment.reproductions)
        };
        assert!(near.reproduces() && !far.reproduces() && !missing.reproduces());
        assert_eq!(near.published(), Some((8.05, 0.05)));
        assert!((near.difference().unwrap() + 0.05).abs() < 1e-12);
        assert!((near.relative_difference().unwrap() + 0.05 / 8.05).abs() < 1e-12);
        // The sign of the difference is that of value minus published number; its fraction is of the size.
        assert_eq!(far.difference(), Some(18.0));
        assert_eq!(far.relative_difference(), Some(1.8));
        assert_eq!(missing.difference(), None);
        assert!(missing.compared.reason.is_some());
        record.procedures[0].results[0].withhold("errors grow");
        assert!(assess(&plan, &record).reproductions[0].reproduces());
        record.procedures[0].complete = false;
        let cut = &assess(&plan, &record).reproductions[0];
        assert!(!cut.reproduces());
        assert_eq!(
            cut.compared.reason.as_deref(),
            Some("hit was not completed")
        );
    }
}
