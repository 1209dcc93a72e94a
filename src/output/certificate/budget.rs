//! The uncertainty budget of an impact: input by input, what it contributes to the uncertainty of the results that the
//! requirements read. In: a run. Out: a table. Every result has its budget in `summary.json`.

use super::super::budget::{Budget, From, Line, budgets};
use super::super::document::{Block, Column, Table, Text};
use super::super::{Run, expansion, number};
use super::{results::percent, words};
use crate::formula::{ProcedureId, ResultReference, ResultValue};
use crate::quantity::Dimension;
use crate::quantity::display::{minus, significant, typeset, unit};
use crate::record::ProcedureRecord;
use crate::run::MOST_DRAWS;

/// Told where no requirement reads a result of the procedure.
const UNASKED: [&str; 3] = ["max_displacement", "absorbed_energy", "max_base_shear"];

/// A share of u² below which lines are told together.
const SMALL: f64 = 1e-3;

pub(super) fn table(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let mut budgets = budgets(run, index, procedure);
    let asked = asked(run, index);
    budgets.retain(|budget| asked.contains(&budget.result.name) && is_told(budget));
    if !budgets.is_empty() {
        body.extend(budgets.iter().map(one));
        body.push(Block::note(note(run, &budgets)));
    }
}

/// The results of this procedure that a requirement reads, else those that are always worth it.
fn asked(run: &Run<'_>, index: usize) -> Vec<&'static str> {
    let mut references: Vec<ResultReference> = Vec::new();
    run.plan.requirements.iter().flat_map(|requirement| &requirement.conditions).for_each(|condition| {
        condition.collect_references(&mut references);
    });
    let mine: Vec<&str> =
        references.iter().filter(|reference| reference.procedure == ProcedureId(index)).map(|reference| reference.name).collect();
    if mine.is_empty() { UNASKED.to_vec() } else { mine }
}

/// Of a list, the budget of its largest number stands for all.
fn is_told(budget: &Budget<'_>) -> bool {
    let (Some(entry), ResultValue::List(values)) = (budget.entry, &budget.result.value) else { return true };
    let largest = values.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    largest.is_some_and(|(place, _)| place == entry)
}

fn one(budget: &Budget<'_>) -> Block {
    let which = budget.entry.map_or_else(String::new, |entry| match budget.result.name {
        "periods" => format!(", mode {}", entry + 1),
        _ => format!(", storey {}", entry + 1),
    });
    let columns = vec![
        Column::words(format!("Uncertainty budget of {}{which}", words(budget.result.name)), 3),
        Column::words("Input ± u", 2),
        Column::numbers("Sensitivity"),
        Column::numbers("Contribution"),
        Column::numbers("Of u²"),
    ];
    Block::Table(Table { columns, rows: rows(budget) })
}

fn rows(budget: &Budget<'_>) -> Vec<Vec<Text>> {
    let Budget { result, value, uncertainty, known, lines, .. } = budget;
    let amount = |amount: f64| -> Text { number::part_of(amount, *uncertainty, 3, result.dimension).into() };
    let (told, small): (Vec<&Line>, Vec<&Line>) = lines.iter().partition(|line| budget.share(line) >= SMALL);
    let mut rows: Vec<Vec<Text>> = told
        .into_iter()
        .map(|line| {
            let sensitivity = line.sensitivity.map_or_else(|| "—".to_owned(), |each| sensitivity(each, result.dimension, line));
            let share = percent(budget.share(line));
            vec![named(line), input(line).into(), sensitivity.into(), amount(line.contribution.abs()), share.into()]
        })
        .collect();
    if !small.is_empty() {
        let together = small.iter().map(|line| line.contribution.powi(2)).sum::<f64>().sqrt();
        let names: Vec<&str> = small.iter().map(|line| line.input.as_str()).collect();
        let names = Text::new().soft(format!("under 0.1\u{a0}% each: {}", names.join(", ")));
        let share = percent((together / uncertainty).powi(2));
        rows.push(vec![names, "".into(), "—".into(), amount(together), share.into()]);
    }
    let parts = number::parts(*value, Some(*known), result.dimension);
    let expanded = parts.expanded.unwrap_or_default();
    let factor = expansion::factor(*known);
    let of_degrees =
        if expansion::is_more(*known) { format!(", ν = {}", expansion::degrees_text(*known)) } else { String::new() };
    let whole =
        format!("combined: {}\u{a0}{}, U = {factor}\u{a0}u{of_degrees}", number::plus_minus(&parts.value, &expanded), parts.unit);
    rows.push(vec![whole.into(), "".into(), "".into(), amount(*uncertainty), "100\u{a0}%".into()]);
    rows
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
    if line.smooth { name } else { name.and(" †") }
}

fn input(line: &Line) -> String {
    match (line.value, line.uncertainty, line.dimension) {
        (Some(value), Some(u), Dimension::NUMBER) if line.from == From::Rig => {
            format!("{value} ± {}\u{a0}%", minus(&significant(100.0 * u, 2)))
        }
        (Some(0.0), Some(u), dimension) => format!("0 ± {}", number::stated(u, dimension)),
        (Some(value), Some(u), dimension) => number::with_uncertainty(value, Some(u.abs()), dimension),
        _ => "—".to_owned(),
    }
}

/// ∂y/∂x in readable units of both: `−13.2 µm per kN/m`; of a factor, for all of it.
fn sensitivity(each: f64, result: Dimension, line: &Line) -> String {
    let size = line.value.filter(|value| *value != 0.0).or(line.uncertainty).unwrap_or(1.0);
    let (unit, factor) = unit(size, line.dimension);
    let change = number::text(each * factor, result);
    if unit.is_empty() { change } else { format!("{change} per {}", typeset(&unit)) }
}

fn note(run: &Run<'_>, budgets: &[Budget<'_>]) -> String {
    let told: Vec<&Line> =
        budgets.iter().flat_map(|budget| budget.lines.iter().filter(|line| budget.share(line) >= SMALL)).collect();
    let more = budgets.iter().any(|budget| expansion::is_more(budget.known));
    let factor = if more { "k by Student's t" } else { "k = 2" };
    let mut text = format!(
        "Linearised, {factor}: each input in turn was moved by ± its standard uncertainty and the run integrated again along \
         its own recorded force–displacement path; half the difference of the results is the contribution, the root sum of squares is u \
         (JCGM 100:2008). The scheme of integration, the contact law and the slowness of the test are not among the inputs."
    );
    let undeclared = run.plan.rig.undeclared(run.plan.degrees_of_freedom());
    if !undeclared.is_empty() {
        text += " Nor is what the plan does not declare: ";
        text += &undeclared.join(", ");
        text += ".";
    }
    if more {
        text += " U = k·u holds 95.45\u{a0}% of the cases: k is Student's t of ν effective degrees of freedom, ν = u⁴/Σ uᵢ⁴/νᵢ (Welch and \
                 Satterthwaite; JCGM 100:2008, G.4), of a fit its readings less its numbers, of draws their number, of all else infinite.";
    }
    if budgets.iter().any(|budget| budget.lines.iter().any(|line| line.draws.is_some())) {
        text += " Errors of the readings were drawn, and what they do is sampled.";
    }
    let draws = budgets.iter().flat_map(|budget| &budget.lines).filter_map(|line| line.draws).min();
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
        text += " † The result does not follow this input smoothly: the differences to either side, or at half the size, disagree; \
                 the largest change stands for it.";
    }
    text
}
