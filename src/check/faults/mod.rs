//! The wording of every diagnostic of the check, by what it is about. In: names, texts and places. Out: diagnostics.

use crate::quantity::{Dimension, display};

pub mod axes;
pub mod cyclic;
pub mod files;
pub mod frames;
pub mod golden;
pub mod methods;
pub mod names;
pub mod rigs;
pub mod specimens;
pub mod types;
pub mod values;
pub mod whole;

/// A value as a person writes it: `16 mm`, not `16.00 mm`.
pub fn shown(value: f64, dimension: Dimension) -> String {
    display::plain(value, dimension, 4)
}

/// `a`, `b` or `c`
pub fn one_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "or")
}

/// `a`, `b` and `c`
pub fn all_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "and")
}

fn joined<'a>(words: impl IntoIterator<Item = &'a str>, by: &str) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [] => "none".to_owned(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} {by} {last}", most.join(", ")),
    }
}

/// "did you mean `x`?", or what is known.
pub fn suggestion<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    match crate::suggest::nearest(written, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "remove it".to_owned(),
        None => format!("known here: {}", one_of(known)),
    }
}
