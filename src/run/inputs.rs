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

    /// A number in the range of its field.
    pub(crate) fn number(&mut self, field: &Field, formula: &Formula) -> Result<f64, Stop> {
        self.estimate(field, formula, None)
            .map(|estimate| estimate.value)
    }

    /// A number in the range of its field, with its uncertainty; `critical` \[s\] is for `time_step`.
    pub(crate) fn estimate(
        &mut self,
        field: &Field,
        formula: &Formula,
        critical: Option<f64>,
    ) -> Result<Estimate, Stop> {
        let estimate = self.evaluate(field.name, formula, dimension_of(field), critical)?;
        in_range(field.name, estimate.value, field)?;
        Ok(estimate)
    }

    /// A number in the range of a field that the record has under the name `input`.
    pub(crate) fn named(
        &mut self,
        input: &'static str,
        formula: &Formula,
        field: &Field,
    ) -> Result<f64, Stop> {
        let value = self
            .evaluate(input, formula, dimension_of(field), None)?
            .value;
        in_range(input, value, field)?;
        Ok(value)
    }

    /// Damping, or its ratio: at least 0. A measured value below 0 by no more than its expanded uncertainty is set to 0,
    /// with its uncertainty.
    pub(crate) fn damping(&mut self, field: &Field, formula: &Formula) -> Result<f64, Stop> {
        let (field, dimension) = (field.name, dimension_of(field));
        let value = self.evaluate(field, formula, dimension, None)?.value + self.lift;
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

    /// Actuator speed above 0, if one is requested.
    pub(crate) fn speed(&mut self, formula: Option<&Formula>) -> Result<Option<f64>, Stop> {
        formula
            .map(|formula| self.number(&SPEED, formula))
            .transpose()
    }

    /// Every entry of a list, each in the range of its field. The record contains them as the commands of its steps.
    pub(crate) fn list(&self, field: &Field, formulas: &[Formula]) -> Result<Vec<f64>, Stop> {
        let value = |formula: &Formula| {
            let evaluated = formula.evaluate(self.results, None);
            let field_name = field.name;
            let value = evaluated
                .map_err(|error| Stop::NoInput {
                    field: field_name,
                    error,
                })?
                .value;
            in_range(field_name, value, field).map(|()| value)
        };
        formulas.iter().map(value).collect()
    }

    fn evaluate(
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

/// The dimension of a field of numbers.
fn dimension_of(field: &Field) -> Dimension {
    field.dimension().unwrap_or(Dimension::NUMBER)
}

/// Refuses a value outside of the range of a field; the message has the name `input`.
pub(crate) fn in_range(input: &'static str, value: f64, field: &Field) -> Result<(), Stop> {
    if field.range.contains(value) {
        return Ok(());
    }
    let dimension = dimension_of(field);
    let wanted = field.range.in_words(dimension);
    Err(Stop::bad_input(input, value, dimension, wanted))
}
