//! The uncertainty budgets of a procedure: input by input, what it contributes to the uncertainty of the results that the
//! requirements read. In: a run. Out: tables, and which results are marked †. Every result has its budget in `summary.json`.

use super::super::budget::{Budget, From, Line, budgets};
use super::super::document::{Block, Column, Table, Text};
use super::super::{Run, number};
use super::words;
use crate::plan::formula::{Formula, ProcedureId, ResultReference, ResultValue};
use crate::procedures;
use crate::record::{History, NamedResult, ProcedureRecord};
use crate::report::coverage_factor;
use crate::report::number::percent;
use crate::uncertainty::MOST_DRAWS;
use crate::units::Dimension;
use crate::units::display::{minus, significant, typeset, unit};

/// A share of u² below which lines are told together.
const SMALL: f64 = 1e-3;

/// Beside what is not sure.
pub(crate) const MARK: &str = " †";

/// What the mark says.
const MARKED: &str = "† The result does not follow an input smoothly (the differences to either side, or at half the size, \
                      disagree), or the record leaves open what the specimen would have done with it: the largest change seen stands \
                      for it, and the uncertainty is an estimate.";

pub(super) fn table(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    body: &mut Vec<Block>,
) {
    let mut budgets = budgets(run, index, procedure);
    let asked = asked(run, index, &procedure.history);
    budgets.retain(|budget| is_told(budget, &asked));
    if !budgets.is_empty() {
        let partial = Partial::of(run);
        body.extend(budgets.iter().map(|budget| one(budget, procedure, partial)));
        body.push(Block::note(note(
            run,
            (index, &procedure.history),
            &budgets,
        )));
    }
}

/// Whether the plan declares the calibrations that every reading enters by.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Partial {
    Whole,
    /// It does not, and the rig is simulated.
    Simulated,
    /// It does not, and no expanded uncertainty follows.
    Real,
}

impl Partial {
    pub fn of(run: &Run<'_>) -> Self {
        match (
            run.plan
                .rig
                .undeclared_calibrations(run.plan.degrees_of_freedom())
                .is_empty(),
            run.plan.rig.link.as_real(),
        ) {
            (true, _) => Self::Whole,
            (false, None) => Self::Simulated,
            (false, Some(_)) => Self::Real,
        }
    }
}

/// What the mark says, of a procedure that has one.
pub(super) fn marked(procedure: &ProcedureRecord) -> Option<Block> {
    let any = |result: &NamedResult| match &result.value {
        ResultValue::Number { .. } => !is_sure(result, 0),
        ResultValue::List(values) => (0..values.len()).any(|entry| !is_sure(result, entry)),
    };
    procedure
        .results
        .iter()
        .any(any)
        .then(|| Block::note(MARKED))
}

/// Whether all that makes much of the uncertainty of a result, or of an entry of a list, is sure.
pub(crate) fn is_sure(result: &NamedResult, entry: usize) -> bool {
    let mine = || {
        result
            .contributions
            .iter()
            .filter(|part| part.entry == entry)
    };
    let all: f64 = mine().map(|part| part.amount.powi(2)).sum();
    let unsure: f64 = mine()
        .filter(|part| !part.smooth)
        .map(|part| part.amount.powi(2))
        .sum();
    unsure <= SMALL * all
}

/// The results of this procedure that a requirement reads, and which entry of a list where it names one; where it reads none
/// of a procedure that was integrated, those that are always worth it.
fn asked(run: &Run<'_>, index: usize, history: &History) -> Vec<(&'static str, Option<usize>)> {
    let mut read: Vec<(ResultReference, Option<usize>)> = Vec::new();
    let conditions = run
        .plan
        .requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions);
    conditions
        .flat_map(crate::plan::Condition::formulas)
        .for_each(|formula| collect(formula, None, &mut read));
    let mine: Vec<(&str, Option<usize>)> = read
        .into_iter()
        .filter(|(reference, _)| reference.procedure == ProcedureId(index))
        .map(|(reference, entry)| (reference.name, entry))
        .collect();
    if !mine.is_empty() {
        return mine;
    }
    procedures::recorded(history)
        .budgeted
        .iter()
        .map(|name| (*name, None))
        .collect()
}

/// Every result that a formula reads, with the entry that it takes of it.
fn collect(
    formula: &Formula,
    entry: Option<usize>,
    into: &mut Vec<(ResultReference, Option<usize>)>,
) {
    match formula {
        Formula::Constant(_) | Formula::Stated(_) | Formula::CriticalTimeStep => {}
        Formula::Result(reference) => into.push((*reference, entry)),
        Formula::Index(inner, place) => collect(inner, Some(*place), into),
        Formula::Negate(inner) => collect(inner, entry, into),
        Formula::Binary(_, left, right) => [left, right]
            .into_iter()
            .for_each(|side| collect(side, entry, into)),
        Formula::List(parts) | Formula::Call(_, parts) => {
            for part in parts {
                collect(part, None, into);
            }
        }
    }
}

/// Of a list of which no entry is named, the budget of its largest number stands for all.
fn is_told(budget: &Budget<'_>, asked: &[(&'static str, Option<usize>)]) -> bool {
    let mut asked = asked
        .iter()
        .filter(|(name, _)| *name == budget.result.name)
        .map(|(_, entry)| *entry);
    let (Some(entry), ResultValue::List(values)) = (budget.entry, &budget.result.value) else {
        return asked.next().is_some();
    };
    let largest = values
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .map(|(place, _)| place);
    asked.any(|named| named.or(largest) == Some(entry))
}

fn one(budget: &Budget<'_>, procedure: &ProcedureRecord, partial: Partial) -> Block {
    let kind = if partial == Partial::Whole {
        "Uncertainty budget"
    } else {
        "Partial uncertainty budget"
    };
    let which = budget.entry.map_or_else(String::new, |entry| {
        format!(", {} {}", entries_of(budget, procedure), entry + 1)
    });
    let columns = vec![
        Column::words(format!("{kind} of {}{which}", words(budget.result.name)), 3),
        Column::words("Input (u)", 2),
        Column::numbers("Sensitivity"),
        Column::numbers("Contribution"),
        Column::numbers("Of u²"),
    ];
    Block::Table(Table {
        columns,
        rows: rows(budget, procedure, partial),
    })
}

/// What the entries of a list are.
fn entries_of(budget: &Budget<'_>, procedure: &ProcedureRecord) -> &'static str {
    match budget.result.name {
        "periods" => "mode",
        name if name.contains("drift") || name.starts_with("storey") => "storey",
        "residual_shear" => "storey",
        "floor_displacement" => "floor",
        _ => procedures::recorded(&procedure.history).entries,
    }
}

fn rows(budget: &Budget<'_>, procedure: &ProcedureRecord, partial: Partial) -> Vec<Vec<Text>> {
    let Budget {
        result,
        value,
        uncertainty,
        known,
        lines,
        ..
    } = budget;
    let amount =
        |amount: f64| -> Text { number::part_of(amount, *uncertainty, 3, result.dimension).into() };
    let (told, small): (Vec<&Line>, Vec<&Line>) =
        lines.iter().partition(|line| budget.share(line) >= SMALL);
    let mut rows: Vec<Vec<Text>> = told
        .into_iter()
        .map(|line| {
            let sensitivity = line.sensitivity.map_or_else(
                || "—".to_owned(),
                |each| sensitivity(each, result.dimension, line),
            );
            let share = percent(budget.share(line));
            let own = line.from == From::Result && line.input == own(budget, procedure);
            let name = if own {
                "scatter of its own readings".into()
            } else {
                named(line)
            };
            vec![
                name,
                input(line).into(),
                sensitivity.into(),
                amount(line.contribution.abs()),
                share.into(),
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
        let names = Text::new().soft(format!("under 0.1\u{a0}% each: {}", names.join(", ")));
        let share = percent((together / uncertainty).powi(2));
        rows.push(vec![
            names,
            "".into(),
            "—".into(),
            amount(together),
            share.into(),
        ]);
    }
    let parts = number::parts(*value, Some(*known), result.dimension);
    let expanded = parts.expanded.unwrap_or_default();
    let factor = coverage_factor::factor(*known);
    let of_degrees = if coverage_factor::is_more(*known) {
        format!(", ν = {}", coverage_factor::degrees_text(*known))
    } else {
        String::new()
    };
    let whole = format!(
        "combined: {}\u{a0}{}, U = {factor}\u{a0}u{of_degrees}",
        number::plus_minus(&parts.value, &expanded),
        parts.unit
    );
    let whole = if partial == Partial::Real {
        format!(
            "combined, without the calibrations: {}, u in brackets",
            number::with_uncertainty(*value, Some(*uncertainty), result.dimension)
        )
    } else {
        whole
    };
    rows.push(vec![
        whole.into(),
        "".into(),
        "".into(),
        amount(*uncertainty),
        "100\u{a0}%".into(),
    ]);
    rows
}

/// How the budget calls what the result's own fit leaves open.
fn own(budget: &Budget<'_>, procedure: &ProcedureRecord) -> String {
    let entry = budget
        .entry
        .map_or_else(String::new, |entry| format!("[{entry}]"));
    format!("{}.{}{entry}", procedure.name, budget.result.name)
}

/// What the plan has a name for is set as it is written there.
fn named(line: &Line) -> Text {
    let name = match line.from {
        From::Result | From::Plan => Text::new().code(&line.input),
        From::Rig | From::Program => Text::from(line.input.as_str()),
    };
    let name = match line.draws {
        Some(draws) => name.soft(format!(" · sampled, {draws} draws")),
        None => name,
    };
    if line.smooth { name } else { name.and(MARK) }
}

fn input(line: &Line) -> String {
    match (line.value, line.uncertainty, line.dimension) {
        (Some(value), Some(u), Dimension::NUMBER) if line.from == From::Rig => {
            format!("{value} ({}\u{a0}%)", minus(&significant(100.0 * u, 2)))
        }
        (Some(0.0), Some(u), dimension) => format!("0 ({})", number::part_of(u, u, 2, dimension)),
        (Some(value), Some(u), dimension) => {
            number::with_uncertainty(value, Some(u.abs()), dimension)
        }
        _ => "—".to_owned(),
    }
}

/// ∂y/∂x in readable units of both: `−13.2 µm per kN/m`; of a factor, for all of it.
fn sensitivity(each: f64, result: Dimension, line: &Line) -> String {
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
        format!("{change} per {}", typeset(&unit))
    }
}

fn note(run: &Run<'_>, (index, history): (usize, &History), budgets: &[Budget<'_>]) -> String {
    let told: Vec<&Line> = budgets
        .iter()
        .flat_map(|budget| {
            budget
                .lines
                .iter()
                .filter(|line| budget.share(line) >= SMALL)
        })
        .collect();
    let more = budgets
        .iter()
        .any(|budget| coverage_factor::is_more(budget.known));
    let factor = if more { "k by Student's t" } else { "k = 2" };
    let mut text = format!(
        "Linearised, {factor}: {}.",
        procedures::recorded(history).uncertainty
    );
    let undeclared = run
        .plan
        .procedures
        .get(index)
        .map_or_else(Vec::new, |planned| {
            run.plan
                .undeclared(procedures::facts_of(&planned.kind).dependence)
        });
    if !undeclared.is_empty() {
        text += " Not included in the budget (not declared in the plan): ";
        text += &undeclared.join(", ");
        text += ".";
    }
    if Partial::of(run) != Partial::Whole {
        text += " A budget without the calibrations of force and displacement is partial: it tells noise, resolution and what else is declared.";
    }
    if more {
        text += " U = k·u holds about 95\u{a0}% of the cases: k is Student's t of ν effective degrees of freedom, ν = u⁴/Σ uᵢ⁴/νᵢ (Welch and \
                 Satterthwaite; JCGM 100:2008, G.4), of a fit its readings less its numbers, of draws their number, of all else infinite.";
    }
    if budgets
        .iter()
        .any(|budget| budget.lines.iter().any(|line| line.draws.is_some()))
    {
        text += " Errors of the readings were drawn, and what they do is sampled.";
    }
    let draws = budgets
        .iter()
        .flat_map(|budget| &budget.lines)
        .filter_map(|line| line.draws)
        .min();
    if let Some(draws) = draws.filter(|draws| *draws < usize::from(MOST_DRAWS)) {
        #[expect(clippy::cast_precision_loss, reason = "a few")]
        let known = 1.0 / (2.0 * draws as f64).sqrt();
        text += " The run is long, and they were drawn ";
        text += &draws.to_string();
        text += " times only: their share of u is known to ";
        text += &percent(known);
        text += ".";
    }
    if told.iter().any(|line| !line.smooth) {
        text += " ";
        text += MARKED;
    }
    text
}
