//! The state of a specimen after a run: `final_…` at its last step, `residual_…` after unloading. In: the name that a plan
//! reads, the procedures, the requirements. Out: the result, E206, or a warning (W730). It knows no run.

use crate::plan::procedures::escalate::block as series;
use std::collections::{BTreeMap, BTreeSet};

use crate::language::check::checker::Checker;
use crate::language::check::messages::values;
use crate::language::syntax::ast::ExprKind;
use crate::plan::formula::{Formula, Part, ResultReference};
use crate::plan::{Condition, Procedure, ProcedureBlock, Requirement};
use crate::schema::{self, Kind, ResultKind};

/// Results after unloading, and the same at the last step.
const LEFT: [(&str, &str); 3] = [
    (
        series::RESIDUAL_DISPLACEMENT.name,
        series::FINAL_DISPLACEMENT.name,
    ),
    (
        series::RESIDUAL_DISPLACEMENTS.name,
        series::FINAL_DISPLACEMENTS.name,
    ),
    (series::RESIDUAL_DRIFT.name, series::FINAL_DRIFT.name),
];

impl Checker<'_> {
    /// The correct name of a result, if the plan reads it under the name that applies to a run with or without unloading. Plans of older
    /// run logs use the other name.
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

    /// A result of the impact that has just ended, as `while` reads it: its own result, and the residual one if it is unloaded.
    pub fn result_of_impact(&self, block: usize, name: &str) -> Option<&'static ResultKind> {
        let of_unload = || {
            schema::block(Kind::Procedure(ProcedureBlock::Unload))
                .result(name)
                .filter(|_| LEFT.iter().any(|(residual, _)| name == *residual))
        };
        schema::block(Kind::Procedure(ProcedureBlock::Impact))
            .result(name)
            .or_else(|| of_unload().filter(|_| self.unloads(block)))
    }

    /// Whether a procedure ends with the specimen unloaded.
    fn unloads(&self, block: usize) -> bool {
        let between = || {
            self.field(block, series::BETWEEN.name)
                .map(|(_, entry)| &entry.value.kind)
        };
        match self.scope.blocks[block].kind.kind {
            Kind::Procedure(ProcedureBlock::Unload) => true,
            Kind::Procedure(ProcedureBlock::Escalate) => between()
                .is_none_or(|between| matches!(between, ExprKind::Name(word) if word == "unload")),
            _ => false,
        }
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
                checker
                    .diagnostics
                    .push(values::final_is_not_residual(&read, row, required, head));
            }
        }
    }
}

/// The result that one side of a condition reads: the result itself, its absolute value, or an entry. An energy that is calculated from
/// it does not count.
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
