//! What a run leaves of a specimen: `final_…` where its last step was, `residual_…` where it was unloaded. In: the name that a plan
//! reads, the procedures, the requirements. Out: the result, E206, or a warning (W730). It knows no run.

use std::collections::BTreeSet;

use crate::language::check::checker::Checker;
use crate::language::check::messages::values;
use crate::language::syntax::ast::ExprKind;
use crate::plan::formula::{Formula, Part, ResultReference};
use crate::plan::{Condition, Procedure, Requirement};
use crate::schema::{self, Kind, ResultKind};

/// What is left where a specimen was unloaded, and the same at the last step.
const LEFT: [(&str, &str); 3] = [
    ("residual_displacement", "final_displacement"),
    ("residual_displacements", "final_displacements"),
    ("residual_drift", "final_drift"),
];

impl Checker<'_> {
    /// What a result is called that a plan names as if the run unloaded, or did not. Recorded plans call it so.
    pub fn left_under_another_name(&self, block: usize, name: &str) -> Option<&'static ResultKind> {
        let unloads = self.unloads(block);
        let other = |(residual, last): &(&'static str, &'static str)| match unloads {
            true if name == *last => Some(*residual),
            false if name == *residual => Some(*last),
            _ => None,
        };
        LEFT.iter()
            .find_map(other)
            .and_then(|other| self.scope.blocks[block].kind.result(other))
    }

    /// A result of the blow that is just over, as `while` reads it: its own, and where it rests if it is unloaded.
    pub fn result_of_blow(&self, block: usize, name: &str) -> Option<&'static ResultKind> {
        let of_unload = || {
            schema::block(Kind::Unload)
                .result(name)
                .filter(|_| LEFT.iter().any(|(residual, _)| name == *residual))
        };
        schema::block(Kind::Impact)
            .result(name)
            .or_else(|| of_unload().filter(|_| self.unloads(block)))
    }

    /// Whether a procedure ends where the specimen carries no load.
    fn unloads(&self, block: usize) -> bool {
        let between = || {
            self.given(block, "between")
                .map(|(_, entry)| &entry.value.kind)
        };
        match self.scope.blocks[block].kind.kind {
            Kind::Unload => true,
            Kind::Escalate => between()
                .is_none_or(|between| matches!(between, ExprKind::Name(word) if word == "unload")),
            _ => false,
        }
    }
}

/// Requirements on where the last step of a run was, after which nothing unloads the specimen.
pub fn warn(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    requirements: &[Requirement],
) {
    let mut told = BTreeSet::new();
    for (index, requirement) in requirements.iter().enumerate() {
        let formulas = requirement.conditions.iter().flat_map(Condition::formulas);
        for reference in formulas.filter_map(compared) {
            let Some((block, Some(procedure))) = procedures.get(reference.procedure.0) else {
                continue;
            };
            let final_value = LEFT.iter().any(|(_, last)| reference.name == *last);
            let later = procedures[reference.procedure.0 + 1..]
                .iter()
                .filter_map(|(_, later)| later.as_ref());
            let unloaded = later.map(|later| &later.kind).any(|later| {
                crate::procedures::facts_of(later).unloads
                    && later.specimen() == procedure.kind.specimen()
            });
            if final_value && !unloaded && told.insert((*block, reference.name)) {
                let (required, head) = (
                    checker.scope.requirements[index].condition.span,
                    checker.scope.blocks[*block].block.head,
                );
                let row = crate::procedures::facts_of(&procedure.kind)
                    .conditions
                    .is_some();
                let read = format!("{}.{}", procedure.name, reference.name);
                checker
                    .faults
                    .push(values::final_is_not_residual(&read, row, required, head));
            }
        }
    }
}

/// The result that one side of a condition is, or the size of it, or an entry: an energy that is computed of it is none.
fn compared(side: &Formula) -> Option<ResultReference> {
    match side {
        Formula::Result(reference) => {
            Some(*reference).filter(|reference| reference.part == Part::Value)
        }
        Formula::Index(inner, _) | Formula::Negate(inner) => compared(inner),
        Formula::Call(_, arguments) => match arguments.as_slice() {
            [inner] => compared(inner),
            _ => None,
        },
        _ => None,
    }
}
