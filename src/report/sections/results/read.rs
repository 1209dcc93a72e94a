//! The results that the requirements of a plan read, and those that it compares with published numbers. In: a plan. Out: results, each with the entry of a list that is read.

use psd_plan::formula::{Formula, ResultPart, ResultReference, ResultValue};
use psd_plan::record::{NamedResult, Record};
use psd_plan::{Condition, Plan};

/// A result, and the entry of a list if one is named.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReadResult {
    pub reference: ResultReference,
    pub entry: Option<usize>,
}

impl ReadResult {
    /// The entry of a list; if none is named, that of its largest number.
    pub fn entry_in(self, values: &[f64]) -> Option<usize> {
        let largest = values
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
            .map(|(index, _)| index);
        self.entry.or(largest)
    }

    /// Whether both are the same number of a record.
    pub fn is_same_entry(self, other: Self, record: &Record) -> bool {
        if self.reference != other.reference {
            return false;
        }
        let result = record
            .procedures
            .get(self.reference.procedure.0)
            .and_then(|procedure| procedure.result(self.reference.name));
        match result.map(|result| &result.value) {
            Some(ResultValue::List(values)) => self.entry_in(values) == other.entry_in(values),
            _ => true,
        }
    }
}

/// Every result that a requirement or a comparison with a published number reads, in order.
pub(crate) fn read_by_requirements(plan: &Plan) -> Vec<ReadResult> {
    let reproductions = plan.reproductions.iter();
    plan.requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions)
        .chain(reproductions.map(|reproduction| &reproduction.condition))
        .flat_map(read_by)
        .collect()
}

/// Every result that a condition reads, in order.
pub(crate) fn read_by(condition: &Condition) -> Vec<ReadResult> {
    let mut read = Vec::new();
    condition
        .formulas()
        .for_each(|formula| collect(formula, None, &mut read));
    read
}

/// Whether a result has a value in this run.
pub(crate) fn exists(result: &NamedResult) -> bool {
    match &result.value {
        ResultValue::Number { value, .. } => value.is_some(),
        ResultValue::List(values) => !values.is_empty(),
    }
}

fn collect(formula: &Formula, entry: Option<usize>, into: &mut Vec<ReadResult>) {
    match formula {
        Formula::Result(reference) if reference.part == ResultPart::Value => {
            into.push(ReadResult {
                reference: *reference,
                entry,
            });
        }
        Formula::Constant(_)
        | Formula::Stated(_)
        | Formula::CriticalTimeStep
        | Formula::Result(_) => {}
        Formula::Index(inner, index) => collect(inner, Some(*index), into),
        Formula::Negate(inner) => collect(inner, entry, into),
        Formula::Binary(_, left, right) => [left, right]
            .into_iter()
            .for_each(|side| collect(side, entry, into)),
        Formula::List(parts) | Formula::Call(_, parts) => {
            for part in parts {
                collect(part, None, into);
            }
        }
    }
}
