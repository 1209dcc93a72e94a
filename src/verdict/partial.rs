//! Results with the uncertainty that the plan declares. On a real rig a budget without the calibration of force and displacement is
//! partial. It gives no expanded uncertainty, and therefore no guard band. In: a plan and its results. Out: the same results, each with
//! what is known of its uncertainty.

use psd_plan::Plan;
use psd_plan::formula::{ResultReference, ResultValue, Results, UncertaintyStatus};

/// Results of a run on the rig of a plan.
pub struct Declared<'a> {
    results: &'a dyn Results,
    /// The calibrations of a real rig that the plan does not declare.
    undeclared: Vec<&'static str>,
}

impl<'a> Declared<'a> {
    pub fn of(plan: &Plan, results: &'a dyn Results) -> Self {
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
    fn base(&self) -> Option<&dyn Results> {
        Some(self.results)
    }

    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        self.results.result(reference)
    }

    fn uncertainty_status(
        &self,
        reference: ResultReference,
        entry: Option<usize>,
    ) -> UncertaintyStatus {
        let own = self.results.uncertainty_status(reference, entry);
        let partial =
            !self.undeclared.is_empty() && !self.results.contributions(reference).is_empty();
        if !partial {
            return own;
        }
        let (name, undeclared) = (reference.name, self.undeclared.join(" and "));
        own.and(UncertaintyStatus::Partial(format!(
            "the budget of `{name}` is partial (not declared in the plan: {undeclared})"
        )))
    }
}
