//! Requirements on the state of a specimen at the last step of a run that does not unload it (W730). In: the procedures, the requirements.
//! Out: warnings. It knows no run.

use std::collections::{BTreeMap, BTreeSet};

use crate::codes::W730;
use psd_language::check::checker::Checker;
use psd_language::check::warnings::left::LEFT;
use psd_plan::formula::{Formula, ResultPart, ResultReference};
use psd_plan::{Condition, Procedure, Requirement};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

/// `read` is a position at the last step of a run; `row`: of an impact series.
struct FinalIsNotResidual<'a> {
    read: &'a str,
    row: bool,
    required: Span,
    head: Span,
}

impl Violation for FinalIsNotResidual<'_> {
    const CODE: Code = W730;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            read,
            row,
            required,
            head,
        } = self;
        let or_row = if row {
            ", or write `between = unload`"
        } else {
            ""
        };
        Diagnostic::new(
            Self::CODE,
            format!("`{read}` is read under load: it is not a residual value"),
        )
        .at(required, "value at the last step")
        .at(head, "not unloaded afterwards")
        .help(format!(
            "add `unload rest {{ }}`, and require its `residual_…`{or_row}"
        ))
    }
}

/// Requirements on the position at the last step of a run, after which the specimen is not unloaded.
pub fn warn(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    requirements: &[Requirement],
) {
    // The last unloading of each specimen: a search through the later procedures for every requirement would be quadratic.
    let unloadings: BTreeMap<Option<usize>, usize> = procedures
        .iter()
        .enumerate()
        .filter_map(|(index, (_, procedure))| Some((index, &procedure.as_ref()?.kind)))
        .filter(|(_, kind)| crate::procedures::facts_of(kind).unloads)
        .map(|(index, kind)| (kind.specimen(), index))
        .collect();
    let mut reported = BTreeSet::new();
    for (index, requirement) in requirements.iter().enumerate() {
        let formulas = requirement.conditions.iter().flat_map(Condition::formulas);
        for reference in formulas.filter_map(compared) {
            let Some((block, Some(procedure))) = procedures.get(reference.procedure.0) else {
                continue;
            };
            let final_value = LEFT.iter().any(|(_, last)| reference.name == *last);
            let unloaded = unloadings
                .get(&procedure.kind.specimen())
                .is_some_and(|unloading| *unloading > reference.procedure.0);
            if final_value && !unloaded && reported.insert((*block, reference.name)) {
                let (required, head) = (
                    checker.scope.requirements[index].condition.span,
                    checker.scope.blocks[*block].block.head,
                );
                let row = crate::procedures::facts_of(&procedure.kind)
                    .conditions
                    .is_some();
                let read = format!("{}.{}", procedure.name, reference.name);
                checker.report(FinalIsNotResidual {
                    read: &read,
                    row,
                    required,
                    head,
                });
            }
        }
    }
}

/// The result that one side of a condition reads: the result itself, its absolute value, or an entry. An energy that is calculated from
/// it does not count.
fn compared(side: &Formula) -> Option<ResultReference> {
    match side {
        Formula::Result(reference) => {
            Some(*reference).filter(|reference| reference.part == ResultPart::Value)
        }
        Formula::Index(inner, _) | Formula::Negate(inner) => compared(inner),
        Formula::Call(_, arguments) => match arguments.as_slice() {
            [inner] => compared(inner),
            _ => None,
        },
        _ => None,
    }
}
