//! Validation of the program: the parts of this run that its self-test covers, and those that no case covers. In: a run. Out:
//! blocks.

use super::Source;
use crate::procedures;
use crate::report::document::{Block, Column, Style, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::status::particulars::stated;
use crate::report::wording::validation as wording;
use psd_physics::self_test;
use psd_physics::self_test::{Quantity, SelfTest, SelfTestPart};
use psd_plan::schema::plan_block::VALIDATION;
use psd_text::units::Dimension;

/// Parts of the program that one procedure uses together.
type Combination = Vec<SelfTestPart>;

/// The parts of this run that the self-test does and does not cover, its failed cases, and the laboratory's own validation.
pub(in super::super) fn validation(source: &Source<'_>, body: &mut Vec<Block>) {
    body.push(Block::part(wording::TITLE));
    let (covered, others): (Vec<Combination>, Vec<Combination>) = used_parts(source.run)
        .into_iter()
        .partition(|parts| self_test::covers(parts));
    let failed: Vec<&SelfTest> = self_test::all()
        .iter()
        .filter(|case| !case.passed())
        .collect();
    if !failed.is_empty() {
        let [case, computed, reference, verdict] = wording::COLUMNS;
        body.push(Block::Table(Table {
            columns: vec![
                Column::words(case, 1),
                Column::numbers(computed),
                Column::numbers(reference),
                Column::short(verdict),
            ],
            rows: failed.iter().map(|case| row(case)).collect(),
        }));
    }
    body.push(Block::paragraph(coverage(&covered, &others)));
    body.push(Block::note(match stated(source.run, VALIDATION.name) {
        Some(text) => Text::from(wording::by_the_laboratory(text)),
        None => Text::from(wording::BY_THE_PROGRAM)
            .code("psd test")
            .and(wording::WHOLE_PLANS),
    }));
}

fn row(case: &SelfTest) -> Vec<Text> {
    vec![
        Text::from(format!("{}: {}", case.case, case.result))
            .line()
            .soft(names(case.parts)),
        number::stated(case.computed, dimension(case.quantity)).into(),
        number::stated(case.expected, dimension(case.quantity)).into(),
        Text::new().with(Style::Fail, wording::FAIL),
    ]
}

const fn dimension(quantity: Quantity) -> Dimension {
    match quantity {
        Quantity::Number => Dimension::NUMBER,
        Quantity::Length => Dimension::LENGTH,
        Quantity::Time => Dimension::TIME,
        Quantity::Force => Dimension::FORCE,
    }
}

/// The combinations that the self-test covers, those that it does not, and the number of failed cases.
fn coverage(covered: &[Combination], others: &[Combination]) -> String {
    let mut sentences = Vec::new();
    if !covered.is_empty() {
        sentences.push(wording::covers(listed(covered)));
    }
    if !others.is_empty() {
        sentences.push(wording::does_not_cover(listed(others)));
    }
    if covered.is_empty() && others.is_empty() {
        sentences.push(wording::COVERS_NOTHING.to_owned());
    }
    sentences.push(self_test());
    sentences.join(" ")
}

/// The number of self-test cases, and of those that fail.
pub(in super::super) fn self_test() -> String {
    let cases = self_test::all();
    match cases.iter().filter(|case| !case.passed()).count() {
        0 => wording::all_pass(cases.len()),
        failed => wording::some_fail(cases.len(), failed),
    }
}

fn listed(combinations: &[Combination]) -> String {
    combinations
        .iter()
        .map(|parts| names(parts))
        .collect::<Vec<_>>()
        .join("; ")
}

fn names(parts: &[SelfTestPart]) -> String {
    parts
        .iter()
        .map(|part| part.name())
        .collect::<Vec<_>>()
        .join(wording::TOGETHER_WITH)
}

/// The combinations of parts that the procedures of a run used, each once.
fn used_parts(run: &Run<'_>) -> Vec<Combination> {
    let ran = run.plan.procedures.iter().take(run.record.procedures.len());
    let mut found = Vec::new();
    for parts in ran.flat_map(|procedure| procedures::self_tested(&procedure.kind)) {
        if !found.contains(&parts) {
            found.push(parts);
        }
    }
    found
}
