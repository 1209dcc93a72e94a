//! What is kept of a run: one number for each column of results, one outcome for each requirement. In: the plan of a run and its record.
//! Out: numbers, outcomes, and why one is missing. It runs nothing.
//!
//! A requirement is decided on its value alone: the scatter of the runs replaces the uncertainty of one run. What a run calls inconclusive has no result
//! here: a stop by a limit, a result that does not exist, a peak that was not reached.

use std::borrow::Cow;

use crate::study::data_set::{Column, Decision, Limit, Outcome, StudyKind};
use crate::study::definition::Definition;
use crate::verdict::{self, Verdict};
use psd_plan::formula::{Formula, ResultPart, ResultReference};
use psd_plan::record::{Outcome as Ended, Record};
use psd_plan::schema::block_of_words;
use psd_plan::study::Collected;
use psd_plan::{Condition, DecisionRule, Plan, Requirement, Test};

/// The columns of results and the requirements of a study.
#[derive(Clone, Debug)]
pub struct Readout {
    columns: Vec<ResultColumn>,
    /// Index of the study among those of the plan.
    study_index: usize,
    /// The condition of a fragility, and its index among the fragilities of the plan.
    exceeds: Option<(usize, Requirement)>,
    /// Requirements of the plan whose limit differs from run to run.
    varied_limits: Vec<bool>,
}

/// A column of results and where its numbers come from.
#[derive(Clone, Debug)]
struct ResultColumn {
    column: Column,
    from: From,
}

#[derive(Clone, Debug, PartialEq)]
enum From {
    /// The value of a condition of a requirement.
    Condition {
        requirement: usize,
        condition: usize,
    },
    /// A collected number, by its index; the formula without other values.
    Collected(usize, Formula),
}

/// What is kept of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    pub results: Vec<Option<f64>>,
    pub outcomes: Vec<Outcome>,
    /// Why a result is missing or a requirement has no result.
    pub reason: Option<String>,
}

impl Readout {
    /// The columns of a study of this plan: the values that its requirements read, then the collected results.
    pub fn of(plan: &Plan, study: &Definition) -> Self {
        let exceeds = match study.kind {
            StudyKind::Study(_) => None,
            StudyKind::Fragility(_) => {
                let fragility = &plan.studies.fragilities[study.index];
                let requirement = Requirement {
                    label: fragility.name.clone(),
                    conditions: vec![fragility.exceeds.clone()],
                };
                Some((study.index, requirement))
            }
        };
        let mut readout = Self {
            columns: Vec::new(),
            study_index: study.index,
            exceeds,
            varied_limits: Vec::new(),
        };
        let requirements = readout.requirements(plan).to_vec();
        for (at, requirement) in requirements.iter().enumerate() {
            for (number, condition) in requirement.conditions.iter().enumerate() {
                let from = From::Condition {
                    requirement: at,
                    condition: number,
                };
                readout.add(of_condition(plan, condition), from);
            }
        }
        for (index, collected) in study.collect.iter().enumerate() {
            let column = of_collected(plan, collected);
            readout.add(column, From::Collected(index, collected.value.clone()));
        }
        // A result that is an input is in the data set already.
        let is_input = |name: &str| study.inputs.iter().any(|input| input.name == name);
        readout.columns.retain(|it| !is_input(&it.column.name));
        readout
    }

    /// Adds a column, unless there is one of its name.
    fn add(&mut self, column: Column, from: From) {
        if !self.columns.iter().any(|it| it.column.name == column.name) {
            self.columns.push(ResultColumn { column, from });
        }
    }

    /// The columns of results.
    pub fn columns(&self) -> Vec<Column> {
        self.columns.iter().map(|it| it.column.clone()).collect()
    }

    /// The results of procedures that it reads: those of all conditions and all columns.
    pub fn references(&self, plan: &Plan) -> Vec<ResultReference> {
        let mut references = Vec::new();
        for requirement in self.requirements(plan) {
            for condition in &requirement.conditions {
                condition.collect_references(&mut references);
            }
        }
        for column in &self.columns {
            if let From::Collected(_, formula) = &column.from {
                formula.collect_references(&mut references);
            }
        }
        references
    }

    /// Whether a formula of the study itself, with the values of a run, is another one than without: a collected number or the limit of an
    /// exceedance may contain a varied parameter.
    pub fn differs(&self, with_studies: &Plan) -> bool {
        let studies = &with_studies.studies;
        let collected = self.columns.iter().any(|column| match &column.from {
            From::Condition { .. } => false,
            From::Collected(index, formula) => {
                let study = studies.studies.get(self.study_index);
                let own = study.and_then(|study| study.collect.get(*index));
                own.is_some_and(|own| own.value != *formula)
            }
        });
        let exceeds = self
            .exceeds
            .as_ref()
            .is_some_and(|(study_index, requirement)| {
                let fragility = studies.fragilities.get(*study_index);
                let own = fragility.map(|fragility| &fragility.exceeds);
                let formulas = |condition: &Condition| -> Vec<Formula> {
                    condition.formulas().cloned().collect()
                };
                own.is_some_and(|own| formulas(own) != formulas(&requirement.conditions[0]))
            });
        collected || exceeds
    }

    /// What is decided in every run.
    pub fn decisions(&self, plan: &Plan) -> Vec<Decision> {
        let requirements = self.requirements(plan).iter().enumerate();
        requirements
            .map(|(at, requirement)| Decision {
                label: requirement.label.clone(),
                text: requirement
                    .conditions
                    .iter()
                    .map(|condition| condition.text.as_str())
                    .collect::<Vec<_>>()
                    .join(" and "),
                limit: self.limit(at, requirement),
            })
            .collect()
    }

    /// Drops the limits that are other numbers in a run: a limit may contain a varied parameter.
    pub fn keep_limits_of(&mut self, plan: &Plan, run: &Plan) {
        let limit = |requirement: &Requirement| match &requirement.conditions[..] {
            [only] => match &only.test {
                Test::Compare { limit, .. } => limit.constant().map(f64::to_bits),
                Test::Within { .. } => None,
            },
            _ => None,
        };
        let pairs = plan.requirements.iter().zip(&run.requirements);
        self.varied_limits = pairs
            .map(|(own, other)| limit(own) != limit(other))
            .collect();
    }

    /// The constant limit of a requirement of one condition.
    fn limit(&self, requirement: usize, of: &Requirement) -> Option<Limit> {
        if self.exceeds.is_none() && self.varied_limits.get(requirement) == Some(&true) {
            return None;
        }
        let [condition] = &of.conditions[..] else {
            return None;
        };
        let Test::Compare { limit, .. } = &condition.test else {
            return None;
        };
        let from = From::Condition {
            requirement,
            condition: 0,
        };
        let result = self.columns.iter().position(|it| it.from == from)?;
        let value = limit.constant()?;
        Some(Limit { result, value })
    }

    fn requirements<'a>(&'a self, plan: &'a Plan) -> &'a [Requirement] {
        match &self.exceeds {
            Some((_, requirement)) => std::slice::from_ref(requirement),
            None => &plan.requirements,
        }
    }

    /// What is decided in a run of this plan: the limit of an exceedance may be a parameter of the run.
    fn decided<'a>(&'a self, plan: &'a Plan) -> Cow<'a, [Requirement]> {
        let own = self.exceeds.as_ref().and_then(|(index, requirement)| {
            let own = plan.studies.fragilities.get(*index)?;
            Some(Requirement {
                label: requirement.label.clone(),
                conditions: vec![own.exceeds.clone()],
            })
        });
        own.map_or_else(
            || Cow::Borrowed(self.requirements(plan)),
            |own| Cow::Owned(vec![own]),
        )
    }

    /// What is kept of a run of a plan.
    pub fn read(&self, plan: &Plan, record: &Record) -> Kept {
        let decided = self.decided(plan);
        let assessed =
            verdict::assess_requirements(&decided, DecisionRule::ValueAlone, plan, record);
        let outcomes = assessed.iter();
        let outcomes = outcomes
            .map(|requirement| match requirement.verdict {
                Verdict::Completed | Verdict::Pass => Outcome::Met,
                Verdict::Fail => Outcome::NotMet,
                Verdict::Inconclusive | Verdict::Aborted | Verdict::Error => Outcome::NoResult,
            })
            .collect();
        let mut missing = None;
        let results = self.columns.iter().map(|column| {
            let found = match &column.from {
                From::Condition {
                    requirement,
                    condition,
                } => {
                    let outcome = &assessed[*requirement].conditions[*condition];
                    let of_the_run = &decided[*requirement].conditions[*condition];
                    let conclusive = outcome.verdict != Verdict::Inconclusive;
                    match outcome.value.filter(|_| conclusive) {
                        None => Err(outcome.reason.clone()),
                        // It violates a limit, whatever its peak is.
                        Some(value) => match unfinished(&of_the_run.value, record) {
                            Some(why) => Err(Some(why)),
                            None => Ok(value),
                        },
                    }
                }
                From::Collected(index, formula) => {
                    let studies = plan.studies.studies.get(self.study_index);
                    let own = studies.and_then(|study| study.collect.get(*index));
                    let formula = own.map_or(formula, |own| &own.value);
                    evaluated(formula, record).map_err(Some)
                }
            };
            found
                .inspect_err(|why| {
                    if missing.is_none() {
                        missing.clone_from(why);
                    }
                })
                .ok()
        });
        let results = results.collect();
        let inconclusive = assessed
            .iter()
            .flat_map(|requirement| &requirement.conditions)
            .find_map(|condition| condition.reason.clone());
        Kept {
            results,
            outcomes,
            reason: stopped(&record.outcome).or(inconclusive).or(missing),
        }
    }

    /// What is kept of a run that could not begin.
    pub fn nothing(&self, plan: &Plan, reason: String) -> Kept {
        Kept {
            results: vec![None; self.columns.len()],
            outcomes: vec![Outcome::NoResult; self.requirements(plan).len()],
            reason: Some(reason),
        }
    }
}

/// Why a run ended early.
fn stopped(outcome: &Ended) -> Option<String> {
    match outcome {
        Ended::Completed => None,
        Ended::Aborted { reason }
        | Ended::NotReleased { reason }
        | Ended::Blocked { reason }
        | Ended::Faulted { reason } => Some(reason.clone()),
    }
}

/// The value that a condition compares: a result by its name, else the text before the comparison.
fn of_condition(plan: &Plan, condition: &Condition) -> Column {
    let result = condition.value.as_result();
    result
        .and_then(|reference| of_result(plan, reference))
        .unwrap_or_else(|| {
            let text = &condition.text;
            let ends = ["<", ">", "==", "!=", " within "]
                .iter()
                .filter_map(|sign| text.find(sign))
                .min();
            let value = text[..ends.unwrap_or(text.len())].trim();
            Column::new(value, condition.dimension, "value of a requirement")
        })
}

fn of_collected(plan: &Plan, collected: &Collected) -> Column {
    let result = collected.value.as_result();
    result
        .and_then(|reference| of_result(plan, reference))
        .unwrap_or_else(|| Column::new(&collected.text, collected.dimension, "collected"))
}

/// The column of a result that is one number.
fn of_result(plan: &Plan, reference: ResultReference) -> Option<Column> {
    let procedure = plan.procedures.get(reference.procedure.0)?;
    let words: Vec<&str> = procedure.kind.keyword().split(' ').collect();
    let kind = block_of_words(&words)?.result(reference.name)?;
    let part = match reference.part {
        ResultPart::Value => "",
        ResultPart::Uncertainty => ".u",
    };
    let name = format!("{}.{}{part}", procedure.name, reference.name);
    (!kind.list).then(|| Column::new(&name, kind.dimension, kind.doc))
}

/// The value of a collected formula, if every result that it reads is that of a finished motion.
fn evaluated(formula: &Formula, record: &Record) -> Result<f64, String> {
    if let Some(why) = unfinished(formula, record) {
        return Err(why);
    }
    let value = formula.evaluate(record, None);
    value
        .map(|estimate| estimate.value)
        .map_err(|error| error.to_string())
}

/// Why a value is not that of a finished motion.
fn unfinished(formula: &Formula, record: &Record) -> Option<String> {
    let mut references = Vec::new();
    formula.collect_references(&mut references);
    verdict::unfinished(&references, record)
}
