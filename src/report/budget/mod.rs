//! Uncertainty budgets: the contribution of each input to the uncertainty of a result. In: a run. Out: lines, the largest
//! contribution first. Report and summary print them.

pub(super) mod coverage_factor;
mod line;

pub(super) use line::{BudgetLine, Origin};

use super::run::Run;
use psd_plan::formula::{ProcedureId, ResultValue};
use psd_plan::record::{NamedResult, ProcedureRecord};
use psd_plan::uncertainty::{
    Contribution, MeasurementUncertainty, Source, StepInterval, measurement_uncertainty,
};

/// The budget of one result.
#[derive(Clone, Debug)]
pub(super) struct Budget<'a> {
    pub result: &'a NamedResult,
    /// Index of the entry, for a list.
    pub entry: Option<usize>,
    pub value: f64,
    /// Combined standard uncertainty u of all lines.
    pub uncertainty: f64,
    /// The same with its effective degrees of freedom.
    pub known: MeasurementUncertainty,
    pub lines: Vec<BudgetLine>,
    /// The effect of the time step, beside U.
    pub time_step: Option<StepInterval>,
}

impl Budget<'_> {
    /// Fraction of u² that a line contributes.
    pub fn fraction(&self, line: &BudgetLine) -> f64 {
        (line.contribution / self.uncertainty).powi(2)
    }

    /// Whether an input or the time step has an effect on the result.
    fn exists(&self) -> bool {
        self.uncertainty > 0.0 || self.time_step.is_some()
    }
}

/// Budgets of the results of a procedure. Results whose only contribution is their own fit have none.
pub(super) fn budgets<'a>(
    run: &Run<'a>,
    index: usize,
    procedure: &'a ProcedureRecord,
) -> Vec<Budget<'a>> {
    let is_own_fit = |part: &Contribution| matches!(part.source, Source::Fit { procedure, .. } | Source::FitEntry { procedure, .. } if procedure == ProcedureId(index));
    let results = procedure
        .results
        .iter()
        .filter(|result| !result.contributions.iter().all(is_own_fit));
    results
        .flat_map(|result| match &result.value {
            ResultValue::Number {
                value: Some(value),
                uncertainty: Some(uncertainty),
            } => {
                let lines = lines(run, result.contributions.iter());
                let known = combined(run, &result.contributions, *uncertainty);
                let budget = Budget {
                    result,
                    entry: None,
                    value: *value,
                    uncertainty: *uncertainty,
                    known,
                    lines,
                    time_step: StepInterval::of(&result.contributions),
                };
                budget.exists().then_some(budget).into_iter().collect()
            }
            ResultValue::Number { .. } => Vec::new(),
            ResultValue::List(values) => entry_budgets(run, result, values),
        })
        .collect()
}

/// A budget for each number of a list whose uncertainty is known.
fn entry_budgets<'a>(run: &Run<'_>, result: &'a NamedResult, values: &[f64]) -> Vec<Budget<'a>> {
    let uncertainties = result.entry_uncertainties();
    let budget = |entry: usize, value: f64, uncertainty: Option<f64>| {
        let own: Vec<Contribution> = result
            .contributions
            .iter()
            .filter(|part| part.entry == entry)
            .copied()
            .collect();
        let uncertainty = uncertainty?;
        let budget = Budget {
            result,
            entry: Some(entry),
            value,
            uncertainty,
            known: combined(run, &own, uncertainty),
            lines: lines(run, own.iter()),
            time_step: StepInterval::of(&own),
        };
        budget.exists().then_some(budget)
    };
    let entries = values.iter().zip(uncertainties).enumerate();
    entries
        .filter_map(|(entry, (value, uncertainty))| budget(entry, *value, uncertainty))
        .collect()
}

/// u with its effective degrees of freedom.
fn combined(run: &Run<'_>, parts: &[Contribution], uncertainty: f64) -> MeasurementUncertainty {
    measurement_uncertainty(parts, run.record).unwrap_or(MeasurementUncertainty::exact(uncertainty))
}

/// One line per source. All Monte Carlo trials are one line, and so are all readings at rest.
fn lines<'a>(
    run: &Run<'_>,
    contributions: impl Iterator<Item = &'a Contribution>,
) -> Vec<BudgetLine> {
    let is_trial = |part: &&Contribution| {
        matches!(part.source, Source::Readings { .. } | Source::Drawn { .. })
    };
    let (trials, others): (Vec<&Contribution>, Vec<&Contribution>) = contributions
        .filter(|part| part.source.is_of_uncertainty())
        .partition(is_trial);
    let (readings, others): (Vec<&Contribution>, Vec<&Contribution>) = others
        .into_iter()
        .partition(|part| matches!(part.source, Source::RestReading { .. }));
    let mut lines: Vec<BudgetLine> = others
        .into_iter()
        .map(|part| BudgetLine::of(run, part))
        .collect();
    for (parts, sampled) in [(trials, true), (readings, false)] {
        if let Some(first) = parts.first() {
            let together = parts
                .iter()
                .map(|part| part.amount * part.amount)
                .sum::<f64>()
                .sqrt();
            let one = BudgetLine::of(run, first);
            #[expect(clippy::cast_precision_loss, reason = "a few")]
            let degrees = if sampled {
                parts.len() as f64
            } else {
                one.degrees
            };
            let draws = sampled.then_some(parts.len());
            lines.push(BudgetLine {
                contribution: together,
                draws,
                degrees,
                sensitivity: None,
                ..one
            });
        }
    }
    lines.sort_by(|a, b| b.contribution.abs().total_cmp(&a.contribution.abs()));
    lines
}
