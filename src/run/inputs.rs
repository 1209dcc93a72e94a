//! Inputs of a procedure: formulas of the plan, evaluated when all earlier results are known. In: formulas. Out: numbers in SI, inside
//! their domain, and the list of them for the record.

use crate::run::stop::Stop;
use psd_plan::formula::{Estimate, Formula, ProcedureId, Results};
use psd_plan::schema::Field;
use psd_plan::schema::procedures::SPEED;
use psd_plan::uncertainty::measurement_uncertainty;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Evaluates inputs and keeps their values.
pub(crate) struct Inputs<'record> {
    results: &'record dyn Results,
    procedure: ProcedureId,
    recorded: Vec<(&'static str, Estimate, Dimension)>,
    /// Whether a source is perturbed: then no value is raised to its bound automatically.
    moved: bool,
    /// The amount by which the damping was raised to zero, in its own unit.
    lift: f64,
    /// Remarks on the treatment of an input.
    observations: Vec<String>,
}

impl<'record> Inputs<'record> {
    /// For the procedure with this index in the plan.
    pub(crate) fn new(results: &'record dyn Results, procedure: ProcedureId) -> Self {
        Self {
            results,
            procedure,
            recorded: Vec::new(),
            moved: false,
            lift: 0.0,
            observations: Vec::new(),
        }
    }

    /// The same with a source perturbed, for a run whose damping was raised by `lift`.
    pub(crate) fn moved(results: &'record dyn Results, procedure: ProcedureId, lift: f64) -> Self {
        Self {
            moved: true,
            lift,
            ..Self::new(results, procedure)
        }
    }

    /// The amount by which the damping was raised to zero.
    pub(crate) const fn lift(&self) -> f64 {
        self.lift
    }

    /// Remarks on the treatment of inputs.
    pub(crate) fn take_observations(&mut self) -> Vec<String> {
        std::mem::take(&mut self.observations)
    }

    /// The procedure of these inputs.
    pub(crate) const fn procedure(&self) -> ProcedureId {
        self.procedure
    }

    /// Adds a stated uncertainty to that of the formula of the last field.
    pub(crate) fn also_uncertain(&mut self, stated: f64) {
        if let Some((_, estimate, _)) = self.recorded.last_mut().filter(|_| stated > 0.0) {
            estimate.uncertainty = Some(estimate.uncertainty.unwrap_or(0.0).hypot(stated));
        }
    }

    /// The results that its formulas read.
    pub(crate) fn results(&self) -> &'record dyn Results {
        self.results
    }

    pub(crate) fn into_recorded(self) -> Vec<(&'static str, Estimate, Dimension)> {
        self.recorded
    }

    /// Any number.
    pub(crate) fn number(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
    ) -> Result<f64, Stop> {
        self.estimate(field, formula, dimension, None)
            .map(|estimate| estimate.value)
    }

    /// A number above 0.
    pub(crate) fn positive(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
    ) -> Result<f64, Stop> {
        self.positive_estimate(field, formula, dimension, None)
            .map(|estimate| estimate.value)
    }

    /// A number of at least 0.
    pub(crate) fn not_negative(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
    ) -> Result<f64, Stop> {
        match self.number(field, formula, dimension)? {
            value if value >= 0.0 => Ok(value),
            value => Err(Stop::bad_input(field, value, dimension, "at least 0")),
        }
    }

    /// A number in the range of a field.
    pub(crate) fn in_range(
        &mut self,
        input: &'static str,
        formula: &Formula,
        field: &Field,
    ) -> Result<f64, Stop> {
        let dimension = field.dimension().unwrap_or(Dimension::NUMBER);
        let (value, range) = (self.number(input, formula, dimension)?, field.range);
        if range.contains(value) {
            return Ok(value);
        }
        let wanted = match (value > range.high, range.above) {
            (true, _) => format!("at most {}", range.high),
            (false, true) => format!("greater than {}", range.low),
            (false, false) => format!("at least {}", range.low),
        };
        Err(Stop::bad_input(input, value, dimension, wanted))
    }

    /// Damping, or its ratio: at least 0. A measured value below 0 by no more than its expanded uncertainty is set to 0,
    /// with its uncertainty.
    pub(crate) fn damping(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
    ) -> Result<f64, Stop> {
        let value = self.number(field, formula, dimension)? + self.lift;
        if value >= 0.0 {
            return Ok(value);
        }
        let bad = |wanted: &'static str| Stop::bad_input(field, value, dimension, wanted);
        let parts = formula
            .contributions(self.results, None)
            .map_err(|error| Stop::NoInput { field, error })?;
        let Some(known) = measurement_uncertainty(&parts, self.results)
            .filter(|known| !self.moved && known.standard > 0.0)
        else {
            return Err(bad("at least 0"));
        };
        if -value > known.expanded() {
            return Err(bad(
                "at least 0 (it is below 0 by more than its expanded uncertainty)",
            ));
        }
        self.lift = -value;
        if let Some((_, estimate, _)) = self.recorded.last_mut() {
            estimate.value = 0.0;
        }
        let (value, expanded) = (
            readable(value, dimension),
            readable(known.expanded(), dimension),
        );
        let text = format!(
            "`{field}` was measured as {value}, U = {expanded}. It is not significantly below 0, and is set to 0"
        );
        self.observations.push(text);
        Ok(0.0)
    }

    /// A number above 0 with its uncertainty; `critical` \[s\] is for `time_step`.
    pub(crate) fn positive_estimate(
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
            Err(Stop::bad_input(
                field,
                estimate.value,
                dimension,
                "greater than 0",
            ))
        }
    }

    /// Actuator speed above 0, if one is requested.
    pub(crate) fn speed(&mut self, formula: Option<&Formula>) -> Result<Option<f64>, Stop> {
        formula
            .map(|formula| self.positive(SPEED.name, formula, Dimension::VELOCITY))
            .transpose()
    }

    /// Every entry of a list. The record contains them as the commands of its steps.
    pub(crate) fn list(&self, field: &'static str, formulas: &[Formula]) -> Result<Vec<f64>, Stop> {
        let value = |formula: &Formula| {
            formula
                .evaluate(self.results, None)
                .map(|estimate| estimate.value)
        };
        formulas
            .iter()
            .map(value)
            .collect::<Result<_, _>>()
            .map_err(|error| Stop::NoInput { field, error })
    }

    fn estimate(
        &mut self,
        field: &'static str,
        formula: &Formula,
        dimension: Dimension,
        critical: Option<f64>,
    ) -> Result<Estimate, Stop> {
        let estimate = formula
            .evaluate(self.results, critical)
            .map_err(|error| Stop::NoInput { field, error })?;
        self.recorded.push((field, estimate, dimension));
        Ok(estimate)
    }
}
