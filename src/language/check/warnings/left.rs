//! The state of a specimen after a run: `final_…` at its last step, `residual_…` after unloading. In: the name that a plan
//! reads. Out: the result, or E206. It knows no run.

use psd_plan::procedures::escalate::block as series;

use crate::check::checker::Checker;
use crate::syntax::ast::ExprKind;
use psd_plan::ProcedureBlock;
use psd_plan::schema::{self, Kind, ResultKind};

/// Results after unloading, and the same at the last step.
pub const LEFT: [(&str, &str); 3] = [
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
    /// The correct name of a result, if the plan reads it under the name that applies to a run with or without unloading.
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
