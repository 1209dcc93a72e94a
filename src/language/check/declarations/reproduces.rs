//! `reproduces NAME { … }`: a number of the run beside a published one. In: its blocks. Out: the numbers with their tolerances, in the
//! order of the plan.

use super::tolerance::tolerance;
use crate::check::checker::{Checker, Context, Reads, Typed};
use psd_plan::formula::Formula;
use psd_plan::schema::Kind;
use psd_plan::schema::reproduces as schema;
use psd_plan::{Condition, Reproduction, Test, Tolerance};

const OF_THE_RUN: Context = Context {
    entry: None,
    reads: Reads::All,
    critical: false,
};
const FIXED: Context = Context {
    entry: None,
    reads: Reads::Nothing("a published number"),
    critical: false,
};

/// Every comparison with a published number; None if one has an error.
pub fn reproductions(checker: &mut Checker) -> Option<Vec<Reproduction>> {
    let blocks = checker.scope.of_kind(Kind::Reproduces);
    let blocks: Vec<usize> = blocks.map(|(block, _)| block).collect();
    let read: Vec<Option<Reproduction>> = blocks
        .into_iter()
        .map(|block| reproduction(checker, block))
        .collect();
    read.into_iter().collect()
}

fn reproduction(checker: &mut Checker, block: usize) -> Option<Reproduction> {
    let source = checker.text_field(block, schema::SOURCE.name);
    let value = number(checker, block, schema::VALUE.name, OF_THE_RUN)?;
    let dimension = value.dimension;
    let published = number(checker, block, schema::PUBLISHED.name, FIXED).and_then(|typed| {
        let (_, entry) = checker.field(block, schema::PUBLISHED.name)?;
        checker.expect(typed, dimension, schema::PUBLISHED.name, &entry.value)
    });
    let tolerance = checker
        .field(block, schema::TOLERANCE.name)
        .and_then(|(_, entry)| tolerance(checker, schema::TOLERANCE.name, &entry.value, dimension));
    let (width, relative) = match tolerance? {
        Tolerance::Relative(width) => (width, true),
        Tolerance::Absolute(width) => (width, false),
    };
    let text = checker.text(value.span).split_whitespace();
    Some(Reproduction {
        name: checker.scope.blocks[block].name?.node.clone(),
        source: source?,
        condition: Condition {
            text: text.collect::<Vec<_>>().join(" "),
            value: value.formula,
            test: Test::Within {
                target: published?.formula,
                tolerance: Formula::Constant(width),
                relative,
            },
            dimension,
        },
    })
}

fn number(checker: &mut Checker, block: usize, field: &str, context: Context) -> Option<Typed> {
    let (_, entry) = checker.field(block, field)?;
    checker.single(&entry.value, context)
}
