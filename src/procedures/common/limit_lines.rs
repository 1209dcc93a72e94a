//! Bounds of requirements, and of the condition of a series, as lines of a chart. In: a run, a result of a procedure. Out: reference lines
//! with their labels. It draws nothing.

use crate::procedures;
use crate::report::Run;
use crate::report::figures::chart::Reference;
use crate::report::number;
use crate::verdict::Bound;
use psd_plan::formula::{Formula, Function, ProcedureId, ResultPart};
use psd_plan::schema::ResultKind;
use psd_plan::{Condition, Test};

/// Bounds that a requirement sets on a result of one procedure, for that result's figure.
pub(crate) fn limits_on(
    run: &Run<'_>,
    procedure: ProcedureId,
    result: ResultKind,
) -> Vec<Reference> {
    let mut lines = Vec::new();
    for (requirement, outcome) in run
        .plan
        .requirements
        .iter()
        .zip(&run.assessment.requirements)
    {
        for (condition, held) in requirement.conditions.iter().zip(&outcome.conditions) {
            if !reads(&condition.value, procedure, result.name) {
                continue;
            }
            // A band is two lines with one label, so that two labels never overlap.
            let entry =
                entry(&condition.value).map_or_else(String::new, |entry| format!(" ({entry})"));
            let label = format!(
                "{}{entry}: {}",
                short(&requirement.label),
                number::bound_alone(held)
            );
            match held.bound {
                Some(Bound::Compare { limit, .. }) => lines.push(Reference { label, y: limit }),
                Some(Bound::Within { target, tolerance }) => {
                    lines.push(Reference {
                        label,
                        y: target - tolerance,
                    });
                    lines.push(Reference {
                        label: String::new(),
                        y: target + tolerance,
                    });
                }
                None => {}
            }
        }
    }
    lines.retain(|line| line.y.is_finite());
    lines
}

/// The bounds that the condition of a series sets on a result of one of its impacts, as far as the plan alone gives them.
pub(crate) fn conditions_on(
    run: &Run<'_>,
    procedure: ProcedureId,
    result: ResultKind,
) -> Vec<Reference> {
    let planned = run.plan.procedures.get(procedure.0);
    let conditions = planned
        .and_then(|planned| procedures::facts_of(&planned.kind).conditions)
        .unwrap_or_default();
    let of_result = conditions
        .iter()
        .filter(|condition| reads(&condition.value, procedure, result.name));
    let line = |condition: &Condition| {
        let label = short(&format!("while {}", condition.text.replace('_', " ")));
        match &condition.test {
            Test::Compare { limit, .. } => limit
                .constant()
                .map(|y| vec![Reference { label, y }])
                .unwrap_or_default(),
            Test::Within {
                target,
                tolerance,
                relative,
            } => match (target.constant(), tolerance.constant()) {
                (Some(target), Some(tolerance)) => {
                    let tolerance = if *relative {
                        tolerance * target.abs()
                    } else {
                        tolerance
                    };
                    // One label for both lines, so that two labels never overlap.
                    let ends = [(label, -tolerance), (String::new(), tolerance)];
                    ends.map(|(label, by)| Reference {
                        label,
                        y: target + by,
                    })
                    .into()
                }
                _ => Vec::new(),
            },
        }
    };
    of_result.flat_map(line).collect()
}

/// The entry of a list to which a condition applies, from 1; None if it applies to all of them.
fn entry(value: &Formula) -> Option<usize> {
    if let Formula::Index(_, index) = value {
        Some(index + 1)
    } else {
        None
    }
}

/// Whether a condition applies to the value of this result, or to the largest entry if it is a list. A limit of its uncertainty does not
/// apply to the chart.
fn reads(value: &Formula, procedure: ProcedureId, result: &str) -> bool {
    let is = |formula: &Formula| {
        formula.as_result().is_some_and(|r| {
            r.procedure == procedure && r.name == result && r.part == ResultPart::Value
        })
    };
    match value {
        Formula::Call(Function::Max, arguments) => arguments.iter().all(is),
        Formula::Index(list, _) => is(list),
        other => is(other),
    }
}

/// A label that fits into a picture, on one line.
fn short(label: &str) -> String {
    const LONGEST: usize = 40;
    // The width of the label is that of the text as drawn.
    let label = psd_text::glyphs::shown(label);
    let mut text: String = label
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if label.chars().count() > LONGEST {
        text.push('…');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::formula::ResultReference;

    #[test]
    fn a_bound_on_an_uncertainty_is_no_line_among_the_values() {
        let (procedure, name) = (ProcedureId(0), "max_drift");
        let result = |part| {
            Formula::Result(ResultReference {
                procedure,
                name,
                part,
            })
        };
        assert!(reads(&result(ResultPart::Value), procedure, name));
        assert!(!reads(&result(ResultPart::Uncertainty), procedure, name));
        assert!(
            !reads(&result(ResultPart::Value), ProcedureId(1), name)
                && !reads(&result(ResultPart::Value), procedure, "periods")
        );
        let second = Formula::Index(Box::new(result(ResultPart::Value)), 1);
        assert!(
            reads(&second, procedure, name)
                && entry(&second) == Some(2)
                && entry(&result(ResultPart::Value)).is_none()
        );
        assert!(!reads(
            &Formula::Index(Box::new(result(ResultPart::Uncertainty)), 1),
            procedure,
            name
        ));
    }
}
