//! A plan with other numbers of its inputs, again and again. In: a parsed plan and the names of inputs, then a number for each of them.
//! Out: checked plans. No text is parsed, no file is read, and a part of the plan that none of the inputs reaches is checked once.

use std::collections::BTreeMap;

use psd_language::check::expressions::overrides::LocatedSetting;
use psd_language::check::expressions::parameters::{has_let, names_of_parameters};
use psd_language::check::scope::{BoundInput, Scope, Setting};
use psd_language::check::violations::UnknownParameter;
use psd_plan::Plan;
use psd_text::diagnostic::{Diagnostic, Violation as _};
use psd_text::units::{Dimension, Quantity};

use super::driver::{Findings, PlanParts};
use super::no_files;
use super::parsed_plan::{Given, ParsedPlan};

/// Inputs of a plan, named as by `--set`: a `param`, or a field such as `beam.mass`.
pub struct BoundInputs {
    /// Those of `--set`, and the inputs.
    settings: BTreeMap<String, Setting>,
    /// The texts of `--set`.
    written: Vec<(String, String)>,
    /// Names that the plan does not have.
    unknown: Vec<Diagnostic>,
}

/// Binds numbers to the inputs of a plan.
pub struct Binder<'a> {
    parsed: &'a ParsedPlan,
    inputs: &'a BoundInputs,
    scope: Scope<'a>,
    settings: Vec<LocatedSetting<'a>>,
    /// Errors that do not depend on any number.
    errors: Vec<Diagnostic>,
    findings: Findings,
    /// Those of the last plan that was valid, and the plan.
    parts: PlanParts,
    plan: Option<Plan>,
}

impl BoundInputs {
    /// The inputs with these names and dimensions; a value of `--set` for one of them is replaced.
    #[must_use]
    pub fn new<'n>(
        parsed: &ParsedPlan,
        inputs: impl Iterator<Item = (&'n str, Dimension)>,
    ) -> Self {
        let known = names_of_parameters(&parsed.trees);
        let mut unknown = Vec::new();
        let mut settings = parsed.settings.clone();
        for (number, (name, dimension)) in inputs.enumerate() {
            if !known.contains(&name) && !name.contains('.') {
                let calculated = has_let(&parsed.trees, name);
                let known = &known;
                let found = UnknownParameter {
                    name,
                    known,
                    calculated,
                };
                unknown.push(found.diagnostic());
            }
            let input = BoundInput { number, dimension };
            settings.insert(name.to_owned(), Setting::Bound(input));
        }
        Self {
            settings,
            written: parsed.written_settings(),
            unknown,
        }
    }
}

impl<'a> Binder<'a> {
    /// Of plans without their studies. To be made after [`ParsedPlan::check`] found no error.
    #[must_use]
    pub fn new(parsed: &'a ParsedPlan, inputs: &'a BoundInputs) -> Self {
        let mut errors = parsed.errors.clone();
        let scope = Scope::collect(&parsed.trees, &inputs.settings, &mut errors);
        Self {
            parsed,
            inputs,
            settings: LocatedSetting::all(&scope, &inputs.settings),
            scope,
            errors,
            findings: Findings::ErrorsAlone,
            parts: PlanParts::default(),
            plan: None,
        }
    }

    /// Of plans with their studies, whose formulas may contain the numbers.
    #[must_use]
    pub fn with_studies(self) -> Self {
        Self {
            findings: Findings::OfStudies,
            ..self
        }
    }

    /// The plan with these numbers of its inputs, in the order of their names, SI. Its `settings` are those of `--set` alone.
    ///
    /// # Errors
    /// The errors of the plan with these numbers: an unknown input, a number with a wrong dimension or outside its bounds, and any
    /// other error of the plan.
    pub fn bind(&mut self, numbers: &[f64]) -> Result<&mut Plan, Vec<Diagnostic>> {
        if !self.inputs.unknown.is_empty() {
            return Err(self.inputs.unknown.clone());
        }
        let given = Given {
            scope: &self.scope,
            errors: self.errors.clone(),
            settings: &self.settings,
            bound: numbers,
            written: &self.inputs.written,
            loader: &no_files,
            data: self.parsed.data.clone(),
            findings: self.findings,
        };
        let before = self.plan.take();
        let outcome = self.parsed.evaluate(given, &mut self.parts, before, |_| ());
        match outcome.plan {
            Some(plan) => Ok(self.plan.insert(plan)),
            None => Err(outcome.diagnostics),
        }
    }
}

impl Binder<'_> {
    /// Whether no number reaches what decides a run: requirements, studies and the rig. Known once a plan is valid.
    #[must_use]
    pub fn decide_alike(&self) -> bool {
        self.parts.decide_alike()
    }
}

impl ParsedPlan {
    /// The plan with other values of its inputs, named as by `--set`: a `param`, or a field such as `beam.mass`. Its expressions are
    /// evaluated and checked again, but no text is parsed. An input without a value here keeps the one of `--set`, else its own. The
    /// plan has no studies. To be called after [`Self::check`] found no error.
    ///
    /// # Errors
    /// As [`Binder::bind`].
    pub fn bind(&self, values: &BTreeMap<String, Quantity>) -> Result<Plan, Vec<Diagnostic>> {
        let named = values.iter();
        let named = named.map(|(name, value)| (name.as_str(), value.dimension));
        let inputs = BoundInputs::new(self, named);
        let numbers: Vec<f64> = values.values().map(|value| value.value).collect();
        let mut binder = Binder::new(self, &inputs);
        let mut plan = binder.bind(&numbers)?.clone();
        let mut written: BTreeMap<String, String> = plan.settings.into_iter().collect();
        for (name, value) in values {
            written.insert(name.clone(), value.in_plan_syntax());
        }
        plan.settings = written.into_iter().collect();
        Ok(plan)
    }
}
