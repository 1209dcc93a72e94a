//! Results with the uncertainty that the plan declares. On a real rig a budget without the calibration of force and displacement is
//! partial. It gives no expanded uncertainty, and therefore no guard band. In: a plan and its results. Out: the same results, and for
//! each the reason why it has no U.

use crate::plan::Plan;
use crate::plan::formula::{ResultReference, ResultValue, Results};
use crate::uncertainty::{Contribution, Source};

/// Results of a run on the rig of a plan.
pub(crate) struct Declared<'a> {
    results: &'a dyn Results,
    /// The calibrations of a real rig that the plan does not declare.
    undeclared: Vec<&'static str>,
}

impl<'a> Declared<'a> {
    pub(crate) fn of(plan: &Plan, results: &'a dyn Results) -> Self {
        let undeclared = plan.rig.link.as_real().map_or_else(Vec::new, |_| {
            plan.rig.undeclared_calibrations(plan.degrees_of_freedom())
        });
        Self {
            results,
            undeclared,
        }
    }
}

impl Results for Declared<'_> {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        self.results.result(reference)
    }

    fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
        self.results.contributions(reference)
    }

    fn degrees(&self, source: Source) -> f64 {
        self.results.degrees(source)
    }

    fn moved(&self, source: Source) -> f64 {
        self.results.moved(source)
    }

    fn no_uncertainty(&self, reference: ResultReference) -> Option<String> {
        let partial = || {
            let uncertain =
                !self.undeclared.is_empty() && !self.results.contributions(reference).is_empty();
            let name = reference.name;
            uncertain.then(|| {
                format!(
                    "the budget of `{name}` is partial (not declared in the plan: {})",
                    self.undeclared.join(" and ")
                )
            })
        };
        self.results.no_uncertainty(reference).or_else(partial)
    }
}
