//! Fills a [`Summary`] from a run. In: a run. Out: the summary; its format is in `mod.rs`.

use super::{
    BudgetSummary, ChangeSummary, ConditionSummary, ContributionSummary, EventSummary,
    IssueSummary, IssuesSummary, Ordered, OutcomeSummary, ParameterSummary, PlanSummary,
    ProcedureSummary, Quantity, RecordSummary, ReproductionSummary, RequirementSummary, RigSummary,
    SCHEMA, StepSummary, Summary, Uncertainty, Value, ZeroDriftSummary, finite,
};
use crate::report::budget::{Budget, BudgetLine, budgets, coverage_factor};
use crate::report::run::Run;
use crate::report::status::{Change, Issues, ReportStatus, deviations, report_status};
use crate::verdict::{Bound, ConditionOutcome, ReproductionOutcome, RequirementOutcome};
use psd_plan::formula::{Estimate, ProcedureId, ResultPart, ResultReference, ResultValue};
use psd_plan::record::{NamedResult, Outcome, ProcedureRecord};
use psd_plan::schema;
use psd_plan::uncertainty::{
    MeasurementUncertainty, StepInterval, measurement_uncertainties, measurement_uncertainty,
};
use psd_text::units::Dimension;
use psd_text::units::display::si_unit;

impl Summary {
    /// The summary of a run.
    #[must_use]
    pub fn of(run: &Run<'_>) -> Self {
        let Run {
            plan,
            record,
            assessment,
            provenance,
        } = run;
        let link = plan.rig.link.as_virtual().copied().unwrap_or_default();
        let (kind, reason) = match &record.outcome {
            Outcome::Completed => ("completed", None),
            Outcome::Aborted { reason } => ("aborted", Some(reason.clone())),
            Outcome::NotReleased { reason } => ("not released", Some(reason.clone())),
            Outcome::Blocked { reason } => ("blocked", Some(reason.clone())),
            Outcome::Faulted { reason } => ("faulted", Some(reason.clone())),
        };
        Self {
            schema: SCHEMA,
            run_id: provenance.run_id.clone(),
            psd: provenance.psd_version.clone(),
            date: provenance.date.clone(),
            plan: PlanSummary {
                title: plan.title.clone(),
                sha256: provenance.plan_sha256.clone(),
            },
            rig: RigSummary {
                name: record.rig.name.clone(),
                model: record.rig.model.clone(),
                serial: record.rig.serial.clone(),
                firmware: record.rig.firmware.clone(),
                simulated: record.rig.simulated,
                seed: record.rig.simulated.then_some(link.seed),
            },
            record: provenance.real.as_ref().map(|real| RecordSummary {
                operator: real.operator.clone(),
                host: real.host.clone(),
                began: real.began.clone(),
                ended: real.ended.clone(),
                records: real.sealed.as_ref().map(|(records, _)| *records),
                head: real.sealed.as_ref().map(|(_, head)| head.clone()),
            }),
            zero_drift: record.drift.as_ref().map(ZeroDriftSummary::of),
            verdict: assessment.verdict.name(),
            decision_rule: assessment.rule.name(),
            report_status: ReportStatus::of(run).name(),
            missing: report_status::missing_fields(run)
                .into_iter()
                .chain(report_status::missing_particulars(run))
                .collect(),
            outcome: OutcomeSummary { kind, reason },
            procedures: Ordered(
                record
                    .procedures
                    .iter()
                    .enumerate()
                    .map(|(index, p)| (p.name.clone(), procedure(run, index, p)))
                    .collect(),
            ),
            requirements: assessment.requirements.iter().map(requirement).collect(),
            reproductions: assessment.reproductions.iter().map(reproduction).collect(),
            events: record
                .events
                .iter()
                .map(|event| EventSummary {
                    wall_time_s: finite(event.time),
                    procedure: event.procedure.clone(),
                    step: event.step,
                    kind: event.kind.word(),
                    text: event.text.clone(),
                })
                .collect(),
            parameters: Ordered(
                plan.parameters
                    .iter()
                    .map(|p| {
                        (
                            p.name.clone(),
                            ParameterSummary {
                                value: finite(p.value),
                                unit: si_unit(p.dimension),
                                set: p.set,
                            },
                        )
                    })
                    .collect(),
            ),
            deviations: deviations::of_run(run, true),
            issues: provenance.issues.as_ref().map(issues),
        }
    }
}

fn issues(issues: &Issues) -> IssuesSummary {
    let change = |change: &Change| ChangeSummary {
        field: change.field,
        was: change.was.clone(),
        is: change.is.clone(),
    };
    let all = issues.all.iter().map(|issue| IssueSummary {
        kind: issue.kind.name(),
        replaces: issue.replaces.clone(),
        date: issue.date.clone(),
        by: issue.by.clone(),
        reason: issue.reason.clone(),
        changes: issue.changes.iter().map(change).collect(),
    });
    IssuesSummary {
        report_id: issues.report_id.clone(),
        issues: all.collect(),
    }
}

/// The condition that governs the verdict of a requirement: the first of the worst ones.
pub(crate) fn governing(requirement: &RequirementOutcome) -> Option<&ConditionOutcome> {
    let worst = requirement
        .conditions
        .iter()
        .map(|condition| condition.verdict)
        .max()?;
    requirement
        .conditions
        .iter()
        .find(|condition| condition.verdict == worst)
}

fn procedure(run: &Run<'_>, index: usize, procedure: &ProcedureRecord) -> ProcedureSummary {
    let input = |(name, estimate, dimension): &(&'static str, Estimate, Dimension)| {
        let value = ResultValue::Number {
            value: Some(estimate.value),
            uncertainty: estimate.uncertainty,
        };
        ((*name).to_owned(), quantity(&value, &[], *dimension))
    };
    ProcedureSummary {
        kind: procedure.kind,
        complete: procedure.complete,
        inputs: Ordered(procedure.inputs.iter().map(input).collect()),
        results: Ordered(
            procedure
                .results
                .iter()
                .map(|r| (r.name.to_owned(), result(run, index, procedure.kind, r)))
                .collect(),
        ),
        uncertainty_budgets: Ordered(budgets(run, index, procedure).iter().map(budget).collect()),
    }
}

/// The name of a result, or of a number of its list, and its budget.
fn budget(budget: &Budget<'_>) -> (String, BudgetSummary) {
    let contribution = |line: &BudgetLine| ContributionSummary {
        input: line.input.clone(),
        method: if line.draws.is_some() {
            "sampled"
        } else {
            "linearised"
        },
        value: line.value.and_then(finite),
        input_unit: si_unit(line.dimension),
        input_u: line.uncertainty.map(f64::abs).and_then(finite),
        sensitivity: line.sensitivity.and_then(finite),
        contribution: finite(line.contribution),
        degrees_of_freedom: finite(line.degrees),
        smooth: line.smooth,
    };
    let name = budget.result.name;
    let key = budget
        .entry
        .map_or_else(|| name.to_owned(), |entry| format!("{name}[{entry}]"));
    let summary = BudgetSummary {
        unit: si_unit(budget.result.dimension),
        u: finite(budget.uncertainty),
        degrees_of_freedom: coverage_factor::degrees(budget.known),
        contributions: budget.lines.iter().map(contribution).collect(),
        time_step: budget.time_step.map(time_step),
    };
    (key, summary)
}

fn time_step(step: StepInterval) -> StepSummary {
    let [lowest, highest] = step.ends;
    StepSummary {
        half: finite(step.half),
        quarter: finite(step.quarter),
        lowest: finite(lowest),
        highest: finite(highest),
        smooth: step.smooth,
    }
}

/// A result; a count is a whole number.
fn result(run: &Run<'_>, index: usize, kind: &str, result: &NamedResult) -> Quantity {
    let words: Vec<&str> = kind.split(' ').collect();
    let known = schema::block_of_words(&words).and_then(|block| block.result(result.name));
    let quantity = expanded(
        quantity(
            &result.value,
            &result.entry_uncertainties(),
            result.dimension,
        ),
        run,
        index,
        result,
    );
    match quantity.value {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number that a f64 holds"
        )]
        Value::Number(Some(count))
            if known.is_some_and(|known| known.count) && count >= 0.0 && count.fract() == 0.0 =>
        {
            Quantity {
                value: Value::Count(count as u64),
                ..quantity
            }
        }
        _ => quantity,
    }
}

/// Reads degrees of freedom or k of an uncertainty.
type Read = fn(MeasurementUncertainty) -> f64;

/// The quantity with degrees of freedom and coverage factor of its uncertainty.
fn expanded(quantity: Quantity, run: &Run<'_>, index: usize, result: &NamedResult) -> Quantity {
    let reference = ResultReference {
        procedure: ProcedureId(index),
        name: result.name,
        part: ResultPart::Value,
    };
    let parts = result.contributions_of(reference);
    let printed = |all: &[Option<MeasurementUncertainty>], read: Read| {
        let each = all.iter().map(|known| {
            known
                .filter(|known| coverage_factor::degrees(*known).is_some())
                .map(read)
        });
        let each: Vec<Option<f64>> = each.collect();
        each.iter().any(Option::is_some).then_some(each)
    };
    let (degrees, k): (Read, Read) = (|known| known.degrees, MeasurementUncertainty::coverage);
    let (degrees_of_freedom, k) = match &result.value {
        ResultValue::Number { .. } => {
            let one = [measurement_uncertainty(&parts, run.record)];
            let number = |read| printed(&one, read).map(|each| Uncertainty::Number(each[0]));
            (number(degrees), number(k))
        }
        ResultValue::List(values) => {
            let all = measurement_uncertainties(&parts, values.len(), run.record);
            (
                printed(&all, degrees).map(Uncertainty::List),
                printed(&all, k).map(Uncertainty::List),
            )
        }
    };
    Quantity {
        degrees_of_freedom,
        k,
        ..quantity
    }
}

/// A value with its uncertainty; `entries` are those of a list, empty where none is known.
fn quantity(value: &ResultValue, entries: &[Option<f64>], dimension: Dimension) -> Quantity {
    let known = |u: &Option<f64>| u.and_then(finite);
    let (value, u) = match value {
        ResultValue::Number { value, uncertainty } => (
            Value::Number(value.and_then(finite)),
            Uncertainty::Number(known(uncertainty)),
        ),
        ResultValue::List(values) => {
            let u = if entries.is_empty() {
                Uncertainty::Number(None)
            } else {
                Uncertainty::List(entries.iter().map(known).collect())
            };
            (
                Value::List(values.iter().map(|value| finite(*value)).collect()),
                u,
            )
        }
    };
    Quantity {
        value,
        unit: si_unit(dimension),
        u,
        degrees_of_freedom: None,
        k: None,
    }
}

fn requirement(requirement: &RequirementOutcome) -> RequirementSummary {
    let conditions: Vec<ConditionSummary> = requirement.conditions.iter().map(condition).collect();
    let governing = governing(requirement).map(condition);
    RequirementSummary {
        name: requirement.label.clone(),
        verdict: requirement.verdict.name(),
        value: governing.as_ref().and_then(|c| c.value),
        limit: governing.as_ref().and_then(|c| c.limit),
        margin: governing.as_ref().and_then(|c| c.margin),
        unit: governing.as_ref().map(|c| c.unit.clone()),
        u: governing.as_ref().and_then(|c| c.u),
        guard_band: governing.as_ref().and_then(|c| c.guard_band),
        condition: governing.map(|c| c.condition),
        conditions,
    }
}

fn reproduction(outcome: &ReproductionOutcome) -> ReproductionSummary {
    let ReproductionOutcome {
        name,
        source,
        compared,
    } = outcome;
    let (published, tolerance) = outcome.published().unzip();
    ReproductionSummary {
        name: name.clone(),
        source: source.clone(),
        statement: outcome.statement(),
        value: compared.value.and_then(finite),
        published: published.and_then(finite),
        tolerance: tolerance.and_then(finite),
        difference: outcome.difference().and_then(finite),
        relative_difference: outcome.relative_difference(),
        unit: si_unit(compared.dimension),
        u: compared.uncertainty.and_then(finite),
        reason: compared.reason.clone(),
    }
}

fn condition(outcome: &ConditionOutcome) -> ConditionSummary {
    let (limit, tolerance) = match outcome.bound {
        None => (None, None),
        Some(Bound::Compare { limit, .. }) => (finite(limit), None),
        Some(Bound::Within { target, tolerance }) => (finite(target), finite(tolerance)),
    };
    ConditionSummary {
        condition: outcome.text.clone(),
        verdict: outcome.verdict.name(),
        value: outcome.value.and_then(finite),
        limit,
        tolerance,
        margin: outcome.margin.and_then(finite),
        unit: si_unit(outcome.dimension),
        u: outcome.uncertainty.and_then(finite),
        k: outcome
            .measurement_uncertainty()
            .filter(|known| coverage_factor::degrees(*known).is_some())
            .map(MeasurementUncertainty::coverage),
        guard_band: outcome.guard_band.and_then(finite),
        conforms: outcome.conforms.and_then(finite),
        in_finer_steps: outcome
            .in_finer_steps
            .filter(|ends| ends.iter().all(|end| end.is_finite())),
        reason: outcome.reason.clone(),
    }
}
