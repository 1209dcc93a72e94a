//! The uncertainty budgets of a procedure: the contribution of each input to the uncertainty of the results that the
//! requirements read. In: a run. Out: tables, and the results that are marked †. `summary.json` has the budget of every result.

use super::super::entry_name;
use super::read::{ReadResult, read_by_requirements};
use super::with_spaces;
use crate::procedures;
use crate::report::budget::{Budget, BudgetLine, Origin, budgets, coverage_factor};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number::{self, percent};
use crate::report::run::Run;
use crate::report::wording::budget as wording;
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference, ResultValue};
use psd_plan::procedures::impact::block as impact;
use psd_plan::procedures::unload::block as unload;
use psd_plan::record::{History, NamedResult, ProcedureRecord};
use psd_plan::uncertainty::{Contribution, MOST_DRAWS, StepInterval};
use psd_text::units::Dimension;
use psd_text::units::display::{is_rounding, minus, significant, typeset, unit};

/// Lines with a smaller fraction of u² are printed together.
const SMALL: f64 = 1e-3;

/// The mark of an uncertainty that is an estimate.
pub(crate) const MARK: &str = " †";

/// The budgets of the results that a requirement reads, procedure by procedure, then their method.
pub(super) fn section(run: &Run<'_>, body: &mut Vec<Block>) {
    let mut methods_used = Vec::new();
    for (index, procedure) in run.record.procedures.iter().enumerate() {
        let mut budgets = budgets(run, index, procedure);
        let requested = requested(run, index, &procedure.history);
        budgets.retain(|budget| {
            let effect = budget
                .time_step
                .map_or(0.0, |step| step.ends[1] - step.ends[0]);
            is_printed(budget, &requested)
                && !is_rounding(budget.uncertainty.max(effect), budget.result.dimension)
        });
        if budgets.is_empty() {
            continue;
        }
        let scope = Scope::of(run);
        body.push(Block::part(
            Text::from(procedure.name.as_str()).soft(format!(" · {}", procedure.kind)),
        ));
        body.extend(budgets.iter().map(|budget| table(budget, procedure, scope)));
        let sentences = sentences(run, index, &procedure.history, &budgets);
        methods_used.push((procedure.name.clone(), sentences));
    }
    if !methods_used.is_empty() {
        body.push(Block::part(wording::METHOD));
        body.extend(methods(&methods_used));
    }
}

/// Whether the plan declares the uncertainty of the calibrations of force and displacement.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::report::sections) enum Scope {
    Complete,
    /// Not declared, on a simulated rig.
    PartialSimulated,
    /// Not declared, on a real rig: the budget gives no expanded uncertainty.
    PartialReal,
}

impl Scope {
    pub fn of(run: &Run<'_>) -> Self {
        match (
            run.plan
                .rig
                .undeclared_calibrations(run.plan.degrees_of_freedom())
                .is_empty(),
            run.plan.rig.link.as_real(),
        ) {
            (true, _) => Self::Complete,
            (false, None) => Self::PartialSimulated,
            (false, Some(_)) => Self::PartialReal,
        }
    }
}

/// Whether a result of the procedure has the mark.
pub(crate) fn is_marked(procedure: &ProcedureRecord) -> bool {
    let is_marked = |result: &NamedResult| match &result.value {
        ResultValue::Number { .. } => !is_reliable(result, 0),
        ResultValue::List(values) => (0..values.len()).any(|entry| !is_reliable(result, entry)),
    };
    procedure.results.iter().any(is_marked)
}

/// Whether nearly all of the uncertainty of a result, or of an entry of a list, comes from contributions that are smooth.
pub(crate) fn is_reliable(result: &NamedResult, entry: usize) -> bool {
    let contributions = || {
        result
            .contributions
            .iter()
            .filter(|part| part.entry == entry)
    };
    let all: f64 = contributions().map(Contribution::variance).sum();
    let estimated: f64 = contributions()
        .filter(|part| !part.smooth)
        .map(Contribution::variance)
        .sum();
    estimated <= SMALL * all
}

/// The results of this procedure that a requirement reads. If no requirement reads a result of the procedure: the results that its
/// slice names for a budget.
fn requested(run: &Run<'_>, index: usize, history: &History) -> Vec<ReadResult> {
    let mut own = read_by_requirements(run.plan);
    own.retain(|read| read.reference.procedure == ProcedureId(index));
    if !own.is_empty() {
        return own;
    }
    let named = procedures::recorded(history).budgeted.iter();
    named
        .map(|&name| ReadResult {
            reference: ResultReference {
                procedure: ProcedureId(index),
                name,
                part: ResultPart::Value,
            },
            entry: None,
        })
        .collect()
}

/// Whether the budget of a result is printed. If no entry of a list is named, that of its largest number is printed.
pub(in crate::report::sections) fn is_printed(
    budget: &Budget<'_>,
    requested: &[ReadResult],
) -> bool {
    let mut requested = requested
        .iter()
        .filter(|read| read.reference.name == budget.result.name);
    match (budget.entry, &budget.result.value) {
        (Some(entry), ResultValue::List(values)) => {
            requested.any(|read| read.entry_in(values) == Some(entry))
        }
        _ => requested.next().is_some(),
    }
}

fn table(budget: &Budget<'_>, procedure: &ProcedureRecord, scope: Scope) -> Block {
    let kind = if scope == Scope::Complete {
        wording::BUDGET
    } else {
        wording::PARTIAL_BUDGET
    };
    let entry = budget.entry.map_or_else(String::new, |entry| {
        format!(
            ", {} {}",
            entry_kind(budget.result.name, procedure),
            entry + 1
        )
    });
    let result = match budget.entry {
        Some(_) => entry_name(budget.result.name),
        None => with_spaces(budget.result.name),
    };
    let [input, sensitivity, contribution, fraction] = wording::COLUMNS;
    let columns = vec![
        Column::words(wording::budget_of(kind, result, entry), 3),
        Column::words(input, 2),
        Column::numbers(sensitivity),
        Column::numbers(contribution),
        Column::numbers(fraction),
    ];
    Block::Table(Table {
        columns,
        rows: rows(budget, procedure, scope),
    })
}

/// The noun for one entry of the list of this name.
pub(crate) fn entry_kind(result: &str, procedure: &ProcedureRecord) -> &'static str {
    let recorded = procedures::recorded(&procedure.history);
    let of_member = [unload::RESIDUAL_SHEAR, impact::MAX_ELEMENT_FORCE];
    match result {
        name if name == impact::PERIODS.name => "mode",
        name if name.contains("drift") || name.starts_with("storey") => recorded.members,
        name if of_member.iter().any(|kind| kind.name == name) => recorded.members,
        _ => recorded.entries,
    }
}

fn rows(budget: &Budget<'_>, procedure: &ProcedureRecord, scope: Scope) -> Vec<Vec<Text>> {
    let Budget {
        result,
        value,
        uncertainty,
        known,
        lines,
        time_step,
        ..
    } = budget;
    let amount =
        |amount: f64| -> Text { number::part_of(amount, *uncertainty, 3, result.dimension).into() };
    let (large, small): (Vec<&BudgetLine>, Vec<&BudgetLine>) = lines
        .iter()
        .partition(|line| budget.fraction(line) >= SMALL);
    let mut rows: Vec<Vec<Text>> = large
        .into_iter()
        .map(|line| {
            let sensitivity = line.sensitivity.map_or_else(
                || "—".to_owned(),
                |each| sensitivity(each, result.dimension, line),
            );
            let is_own =
                line.origin == Origin::Result && line.input == own_input(budget, procedure);
            let name = if is_own {
                wording::OWN_SCATTER.into()
            } else {
                named(line)
            };
            vec![
                name,
                input(line).into(),
                sensitivity.into(),
                amount(line.contribution.abs()),
                percent(budget.fraction(line)).into(),
            ]
        })
        .collect();
    if !small.is_empty() {
        let together = small
            .iter()
            .map(|line| line.contribution.powi(2))
            .sum::<f64>()
            .sqrt();
        let names: Vec<&str> = small.iter().map(|line| line.input.as_str()).collect();
        rows.push(vec![
            Text::new().soft(wording::small(names.join(", "))),
            "".into(),
            "—".into(),
            amount(together),
            percent((together / uncertainty).powi(2)).into(),
        ]);
    }
    let combined = if scope == Scope::PartialReal {
        wording::combined_without_calibrations(number::with_uncertainty(
            *value,
            Some(*uncertainty),
            result.dimension,
        ))
    } else {
        let parts = number::parts_of_result(result.name, *value, Some(*known), result.dimension);
        let expanded = parts.expanded.unwrap_or_default();
        let degrees = if coverage_factor::differs_from_two(*known) {
            format!(", ν = {}", coverage_factor::degrees_text(*known))
        } else {
            String::new()
        };
        wording::combined(
            number::plus_minus(&parts.value, &expanded),
            parts.unit,
            coverage_factor::factor(*known),
            degrees,
        )
    };
    if *uncertainty > 0.0 {
        rows.push(vec![
            combined.into(),
            "".into(),
            "".into(),
            amount(*uncertainty),
            "100\u{a0}%".into(),
        ]);
    }
    rows.extend(time_step.map(|step| finer_steps(step, result.dimension)));
    rows
}

/// The effect of the time step in a row of its own: it has a sign, and is not in U.
fn finer_steps(step: StepInterval, dimension: Dimension) -> Vec<Text> {
    let [low, high] = step.ends;
    let size = high.max(-low);
    let signed = |amount: f64| {
        let text = number::part_of(amount, size, 2, dimension);
        if amount > 0.0 {
            format!("+{text}")
        } else {
            text
        }
    };
    let ends = format!("{} … {}", signed(low), signed(high));
    let text = Text::from(wording::finer_steps(
        ends,
        signed(step.half),
        signed(step.quarter),
    ));
    let text = if step.smooth { text } else { text.and(MARK) };
    vec![text, "".into(), "".into(), "".into(), "".into()]
}

/// The input name of the result's own fit.
fn own_input(budget: &Budget<'_>, procedure: &ProcedureRecord) -> String {
    let entry = budget
        .entry
        .map_or_else(String::new, |entry| format!("[{entry}]"));
    format!("{}.{}{entry}", procedure.name, budget.result.name)
}

/// The name of an input; a name from the plan is set as code.
fn named(line: &BudgetLine) -> Text {
    let name = match line.origin {
        Origin::Result | Origin::Plan => Text::new().code(&line.input),
        Origin::Rig | Origin::Program => Text::from(line.input.as_str()),
    };
    let name = match line.draws {
        Some(draws) => name.soft(wording::sampled(draws)),
        None => name,
    };
    if line.smooth { name } else { name.and(MARK) }
}

fn input(line: &BudgetLine) -> String {
    match (line.value, line.uncertainty, line.dimension) {
        (Some(value), Some(u), Dimension::NUMBER) if line.origin == Origin::Rig => {
            format!("{value} ({}\u{a0}%)", minus(&significant(100.0 * u, 2)))
        }
        (Some(0.0), Some(u), dimension) => format!("0 ({})", number::part_of(u, u, 2, dimension)),
        (Some(value), Some(u), dimension) => {
            number::with_uncertainty(value, Some(u.abs()), dimension)
        }
        _ => "—".to_owned(),
    }
}

/// ∂y/∂x in readable units of both: `−13.2 µm per kN/m`; for a factor, the change per unit factor.
fn sensitivity(each: f64, result: Dimension, line: &BudgetLine) -> String {
    let size = line
        .value
        .filter(|value| *value != 0.0)
        .or(line.uncertainty)
        .unwrap_or(1.0);
    let (unit, factor) = unit(size, line.dimension);
    let change = number::text(each * factor, result);
    if unit.is_empty() {
        change
    } else {
        wording::per(change, typeset(&unit))
    }
}

/// Sentences on method, inputs that the plan does not declare, coverage factor and trials.
fn sentences(
    run: &Run<'_>,
    index: usize,
    history: &History,
    budgets: &[Budget<'_>],
) -> Vec<String> {
    let few_degrees = budgets
        .iter()
        .any(|budget| coverage_factor::differs_from_two(budget.known));
    let mut sentences = vec![
        wording::LINEARISED.to_owned(),
        procedures::recorded(history).uncertainty.to_owned(),
    ];
    let planned = run.plan.procedures.get(index);
    let undeclared = planned.map_or_else(Vec::new, |planned| {
        run.plan
            .undeclared(procedures::facts_of(&planned.kind).dependence)
    });
    if !undeclared.is_empty() {
        sentences.push(wording::not_declared(undeclared.join(", ")));
    }
    if Scope::of(run) != Scope::Complete {
        sentences.push(wording::PARTIAL.to_owned());
    }
    if few_degrees {
        sentences.push(wording::STUDENT_T.to_owned());
    }
    let trials = budgets
        .iter()
        .flat_map(|budget| &budget.lines)
        .filter_map(|line| line.draws)
        .min();
    if let Some(trials) = trials {
        sentences.push(wording::SAMPLED.to_owned());
        if trials < usize::from(MOST_DRAWS) {
            #[expect(clippy::cast_precision_loss, reason = "a few")]
            let accuracy = 1.0 / (2.0 * trials as f64).sqrt();
            sentences.push(wording::few_trials(trials, percent(accuracy)));
        }
    }
    sentences
}

/// The sentences of all procedures, each once. The names of the procedures precede sentences that do not apply to all of them.
fn methods(of_procedures: &[(String, Vec<String>)]) -> Vec<Block> {
    let mut groups: Vec<(Vec<&str>, Vec<&str>)> = Vec::new();
    let mut printed: Vec<&str> = Vec::new();
    for sentence in of_procedures.iter().flat_map(|(_, sentences)| sentences) {
        if printed.contains(&sentence.as_str()) {
            continue;
        }
        printed.push(sentence);
        let named = of_procedures
            .iter()
            .filter(|(_, sentences)| sentences.contains(sentence));
        let named: Vec<&str> = named.map(|(name, _)| name.as_str()).collect();
        match groups.iter_mut().find(|(names, _)| *names == named) {
            Some((_, sentences)) => sentences.push(sentence),
            None => groups.push((named, vec![sentence])),
        }
    }
    // Sentences on all procedures come first.
    groups.sort_by_key(|(names, _)| names.len() < of_procedures.len());
    let note = |(names, sentences): (Vec<&str>, Vec<&str>)| {
        let text = sentences.join(" ");
        Block::note(if names.len() < of_procedures.len() {
            wording::only_of(names.join(", "), text)
        } else {
            text
        })
    };
    groups.into_iter().map(note).collect()
}
