//! Validation of the program: the cases of its self-test that go through what this run went through, and what no case goes
//! through. In: a run. Out: blocks.

use super::super::Run;
use super::super::document::{Block, Column, Style, Table, Text};
use super::super::number;
use super::super::particulars::stated;
use crate::physics::self_test;
use crate::physics::self_test::{Part, Quantity, SelfTest};
use crate::procedures;
use crate::units::Dimension;

/// The cases of this run, with what they cover and what they do not; and where the laboratory's own validation is.
pub(super) fn all(run: &Run<'_>, body: &mut Vec<Block>) {
    let used = used(run);
    let (covered, others): (Vec<Together>, Vec<Together>) =
        used.into_iter().partition(|parts| self_test::covers(parts));
    // A case that fails stands on every report.
    let concerns = |case: &&SelfTest| {
        !case.passed()
            || covered
                .iter()
                .any(|parts| case.parts.iter().all(|part| parts.contains(part)))
    };
    let shown: Vec<&SelfTest> = self_test::all().iter().filter(concerns).collect();
    if !shown.is_empty() {
        let columns = vec![
            Column::words("Self-test", 1),
            Column::numbers("Computed"),
            Column::numbers("Reference"),
            Column::short("Verdict"),
        ];
        body.push(Block::Table(Table {
            columns,
            rows: shown.iter().map(|case| row(case)).collect(),
        }));
    }
    body.push(Block::paragraph(coverage(&covered, &others)));
    body.push(Block::note(match stated(run, "validation") {
        Some(text) => Text::from(format!("Validation by the laboratory: {text}")),
        None => Text::from(
            "The program that set this report passes or fails these cases by the code that reckoned the run. The references are those \
             of Melo et al. 2006, closed forms, and solutions made apart from the program. ",
        )
        .code("psd test")
        .and(" holds whole plans against their blessed results."),
    }));
}

fn row(case: &SelfTest) -> Vec<Text> {
    let verdict = if case.passed() {
        Text::new().with(Style::Pass, "pass")
    } else {
        Text::new().with(Style::Fail, "fail")
    };
    vec![
        Text::from(format!("{}: {}", case.case, case.result))
            .line()
            .soft(names(case.parts)),
        number::stated(case.computed, dimension(case.quantity)).into(),
        number::stated(case.expected, dimension(case.quantity)).into(),
        verdict,
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

/// What of this run the self-test goes through, and what not.
fn coverage(covered: &[Together], others: &[Together]) -> String {
    let failed = self_test::all()
        .iter()
        .filter(|case| !case.passed())
        .count();
    let mut sentences = Vec::new();
    if !covered.is_empty() {
        sentences.push(format!(
            "The self-test covers of this run: {}.",
            listed(covered)
        ));
    }
    if !others.is_empty() {
        sentences.push(format!("It does not cover: {}.", listed(others)));
    }
    if covered.is_empty() && others.is_empty() {
        sentences.push(
            "The self-test covers no part of this run: nothing was integrated or fitted."
                .to_owned(),
        );
    }
    let count = self_test::all().len();
    sentences.push(match failed {
        0 => format!("All of its {count} cases pass, also those of other parts."),
        _ => format!("Of its {count} cases {failed} fail."),
    });
    sentences.join(" ")
}

fn listed(all: &[Together]) -> String {
    all.iter()
        .map(|parts| names(parts))
        .collect::<Vec<_>>()
        .join("; ")
}

fn names(parts: &[Part]) -> String {
    parts
        .iter()
        .map(|part| part.name())
        .collect::<Vec<_>>()
        .join(" with ")
}

/// Parts of the program that work together in a procedure.
type Together = Vec<Part>;

/// The parts of the program that the procedures of a run went through, each once.
fn used(run: &Run<'_>) -> Vec<Together> {
    let ran = run.plan.procedures.iter().take(run.record.procedures.len());
    let mut found = Vec::new();
    for parts in ran.flat_map(|procedure| procedures::self_tested(&procedure.kind)) {
        if !found.contains(&parts) {
            found.push(parts);
        }
    }
    found
}
