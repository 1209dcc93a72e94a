//! Inputs of a procedure: formulas of the plan, evaluated once every result before it is known. In: formulas. Out:
//! numbers in SI, inside their domain, and the list of them for the record.

use super::stop::Stop;
use crate::formula::{Estimate, Formula, ProcedureId, Results};
use crate::quantity::Dimension;

/// Evaluates, and remembers what came out.
pub(super) struct Inputs<'record> {
    results: &'record dyn Results,
    procedure: ProcedureId,
    recorded: Vec<(&'static str, Estimate, Dimension)>,
}

impl<'record> Inputs<'record> {
    /// Of the procedure at this place of the plan.
    pub(super) fn new(results: &'record dyn Results, procedure: ProcedureId) -> Self {
        Self { results, procedure, recorded: Vec::new() }
    }

    /// Whose inputs they are.
    pub(super) const fn procedure(&self) -> ProcedureId {
        self.procedure
    }

    /// A stated uncertainty, of the field evaluated last, beside what its formula brings.
    pub(super) fn also_uncertain(&mut self, stated: f64) {
        if let Some((_, estimate, _)) = self.recorded.last_mut().filter(|_| stated > 0.0) {
            estimate.uncertainty = Some(estimate.uncertainty.unwrap_or(0.0).hypot(stated));
        }
    }

    /// Where its formulas find results.
    pub(super) fn results(&self) -> &'record dyn Results {
        self.results
    }

    pub(super) fn into_recorded(self) -> Vec<(&'static str, Estimate, Dimension)> {
        self.recorded
    }

    /// Any number.
    pub(super) fn number(&mut self, field: &'static str, formula: &Formula, dimension: Dimension) -> Result<f64, Stop> {
        self.estimate(field, formula, dimension, None).map(|estimate| estimate.value)
    }

    /// A number above 0.
    pub(super) fn positive(&mut self, field: &'static str, formula: &Formula, dimension: Dimension) -> Result<f64, Stop> {
        self.positive_estimate(field, formula, dimension, None).map(|estimate| estimate.value)
    }

    /// A number of at least 0.
    pub(super) fn not_negative(&mut self, field: &'static str, formula: &Formula, dimension: Dimension) -> Result<f64, Stop> {
        match self.number(field, formula, dimension)? {
            value if value >= 0.0 => Ok(value),
            value => Err(Stop::BadInput { field, value, dimension, wanted: "at least 0".into() }),
        }
    }

    /// A number above 0 with its uncertainty; `critical` (s) is for `time_step`.
    pub(super) fn positive_estimate(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
        critical: Option<f64>,
    ) -> Result<Estimate, Stop> {
        let estimate = self.estimate(field, formula, dimension, critical)?;
        if estimate.value > 0.0 {
            Ok(estimate)
        } else {
            Err(Stop::BadInput { field, value: estimate.value, dimension, wanted: "greater than 0".into() })
        }
    }

    /// Actuator speed where one is asked for, above 0.
    pub(super) fn speed(&mut self, formula: Option<&Formula>) -> Result<Option<f64>, Stop> {
        formula.map(|formula| self.positive("speed", formula, Dimension::VELOCITY)).transpose()
    }

    /// Every entry of a list. The record has them as the commands of its steps.
    pub(super) fn list(&self, field: &'static str, formulas: &[Formula]) -> Result<Vec<f64>, Stop> {
        let value = |formula: &Formula| formula.evaluate(self.results, None).map(|estimate| estimate.value);
        formulas.iter().map(value).collect::<Result<_, _>>().map_err(|error| Stop::NoInput { field, error })
    }

    fn estimate(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
        critical: Option<f64>,
    ) -> Result<Estimate, Stop> {
        let estimate = formula.evaluate(self.results, critical).map_err(|error| Stop::NoInput { field, error })?;
        self.recorded.push((field, estimate, dimension));
        Ok(estimate)
    }
}
