//! Requirements to which the guarded rule cannot apply: they read a result that never has an uncertainty (W729), or the rig does not declare
//! its calibrations (W736). In: procedures, requirements, the rule, the rig. Out: warnings. It knows no run.

use std::collections::BTreeSet;

use crate::check::checker::Checker;
use crate::codes::{W729, W736};
use psd_plan::formula::ResultPart;
use psd_plan::procedures::escalate::block as escalate;
use psd_plan::procedures::impact::block as impact;
use psd_plan::report::undeclared::{DISPLACEMENT_CALIBRATION, FORCE_CALIBRATION};
use psd_plan::schema::{block_of_words, rig};
use psd_plan::{DecisionRule, Plan, Procedure, Requirement};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

/// Exact results that are not measured: those from the plan, and the closure of the energy balance.
const EXACT: [&str; 3] = [
    impact::TIME_STEP.name,
    impact::ENERGY_ERROR.name,
    escalate::ENERGY_ERRORS.name,
];

/// Under the guarded rule, and on a rig that does not declare these `fields`, no measured result is decided.
struct PartialUnderGuard<'a> {
    rig: &'a str,
    fields: &'a [&'a str],
    head: Span,
}

impl Violation for PartialUnderGuard<'_> {
    const CODE: Code = W736;

    fn diagnostic(self) -> Diagnostic {
        let Self { rig, fields, head } = self;
        let fields: Vec<String> = fields.iter().map(|field| format!("`{field}`")).collect();
        Diagnostic::new(
            Self::CODE,
            format!("under `guarded` nothing that is measured can be decided on rig `{rig}`"),
        )
        .at(head, format!("without {}", fields.join(" and ")))
        .help(format!("declare {}", fields.join(" and ")))
    }
}

/// Warns if every requirement on a measured result will be inconclusive, because the real rig of the run declares no calibration.
pub fn warn_of_partial(checker: &mut Checker, plan: &Plan, rig_block: Option<usize>) {
    let measured = |requirement: &Requirement| {
        let mut references = Vec::new();
        for condition in &requirement.conditions {
            condition.collect_references(&mut references);
        }
        references.iter().any(|reference| {
            let procedure = plan.procedures.get(reference.procedure.0);
            let words = procedure.map(|procedure| procedure.kind.keyword());
            let words: Vec<&str> = words.iter().flat_map(|words| words.split(' ')).collect();
            let kind = block_of_words(&words).and_then(|block| block.result(reference.name));
            kind.is_some_and(|kind| kind.measured)
        })
    };
    let guarded = plan.decision_rule == DecisionRule::Guarded;
    let Some(block) = rig_block.filter(|_| guarded && plan.rig.link.as_real().is_some()) else {
        return;
    };
    let undeclared = plan.rig.undeclared_calibrations(plan.degrees_of_freedom());
    let fields: Vec<&str> = [
        (FORCE_CALIBRATION, rig::FORCE_UNCERTAINTY.name),
        (DISPLACEMENT_CALIBRATION, rig::DISPLACEMENT_UNCERTAINTY.name),
    ]
    .into_iter()
    .filter_map(|(calibration, field)| undeclared.contains(&calibration).then_some(field))
    .collect();
    if !fields.is_empty() && plan.requirements.iter().any(measured) {
        let head = checker.scope.blocks[block].block.head;
        checker.report(PartialUnderGuard {
            rig: &plan.rig.name,
            fields: &fields,
            head,
        });
    }
}

/// `result` is read by a requirement under the guarded rule, and never has an uncertainty.
#[derive(Violation)]
#[violation(
    W729,
    "`{result}` never has an uncertainty: guarded acceptance has no guard band for it"
)]
#[help("write a limit that includes a margin, or require a measured result")]
struct NothingToGuard<'a> {
    result: &'a str,
    #[label("simple acceptance is used")]
    required: Span,
}

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
        for reference in references.iter().filter(|reference| {
            reference.part == ResultPart::Value && !EXACT.contains(&reference.name)
        }) {
            let Some((block, Some(procedure))) = procedures.get(reference.procedure.0) else {
                continue;
            };
            let result = checker.scope.blocks[*block].kind.result(reference.name);
            if result.is_some_and(|result| !result.measured && !result.count)
                && reported.insert((*block, reference.name))
            {
                let required = checker.scope.requirements[index].condition.span;
                let read = format!("{}.{}", procedure.name, reference.name);
                checker.report(NothingToGuard {
                    result: &read,
                    required,
                });
            }
        }
    }
}
