//! The words of the plan language that an editor colours, from the schema. In: nothing. Out: each word once, in order.

use std::collections::BTreeSet;

use psd_plan::FigureKind;
use psd_plan::schema::{BLOCKS, FUNCTIONS, Field, study};

pub type Words = BTreeSet<&'static str>;

/// The names of fields and arguments.
pub fn fields() -> Words {
    every_field().iter().map(|field| field.name).collect()
}

/// The words of options, without `true` and `false`: of models, links, formats, distributions, figures.
pub fn options() -> Words {
    let variants = every_field()
        .into_iter()
        .flat_map(|field| field.ty.variants());
    let words = variants.map(|variant| variant.name);
    let figures = FigureKind::ALL.iter().map(|figure| figure.name());
    words
        .chain(figures)
        .filter(|word| !TRUTHS.contains(word))
        .collect()
}

pub const TRUTHS: [&str; 2] = ["true", "false"];

pub fn functions() -> Words {
    FUNCTIONS.iter().map(|function| function.name).collect()
}

/// The fields of every block, their arguments, and theirs.
fn every_field() -> Vec<&'static Field> {
    let fields = BLOCKS.iter().flat_map(|block| block.fields);
    // A result that is called has arguments too.
    let mut found: Vec<&Field> = fields.chain(study::PROBABILITY.arguments).collect();
    let mut at = 0;
    while let Some(field) = found.get(at) {
        let variants = field.ty.variants().iter();
        found.extend(variants.flat_map(|variant| variant.arguments));
        at += 1;
    }
    found
}
