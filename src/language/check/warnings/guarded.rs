//! Requirements to which the guarded rule cannot apply, because they read a result that never has an uncertainty (W729). In: procedures,
//! requirements, the rule. Out: warnings. It knows no run.

use crate::schema::procedures::{impact, impact_series};
use std::collections::BTreeSet;

use crate::language::check::checker::Checker;
use crate::language::check::messages::values as message;
use crate::plan::formula::Part;
use crate::plan::{DecisionRule, Procedure, Requirement};

/// Exact results that are not measured: those from the plan, and the closure of the energy balance.
const EXACT: [&str; 3] = [
    impact::TIME_STEP.name,
    impact::ENERGY_ERROR.name,
    impact_series::ENERGY_ERRORS.name,
];

pub fn warn(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    requirements: &[Requirement],
    rule: DecisionRule,
) {
    if rule == DecisionRule::Simple {
        return;
    }
    let mut reported = BTreeSet::new();
    for (index, requirement) in requirements.iter().enumerate() {
        let mut references = Vec::new();
        requirement
            .conditions
            .iter()
            .for_each(|condition| condition.collect_references(&mut references));
        for reference in references
            .iter()
            .filter(|reference| reference.part == Part::Value && !EXACT.contains(&reference.name))
        {
            let Some((block, Some(procedure))) = procedures.get(reference.procedure.0) else {
                continue;
            };
            let result = checker.scope.blocks[*block].kind.result(reference.name);
            if result.is_some_and(|result| !result.measured && !result.count)
                && reported.insert((*block, reference.name))
            {
                let required = checker.scope.requirements[index].condition.span;
                let read = format!("{}.{}", procedure.name, reference.name);
                checker
                    .diagnostics
                    .push(message::nothing_to_guard(&read, required));
            }
        }
    }
}
