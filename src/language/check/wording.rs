//! Parts of messages that several violations have in common: names, lists and values in words.

use crate::syntax::ast::Ident;
use psd_plan::schema::{BlockKind, SYNONYMS};
use psd_text::count::counted_in_words;
use psd_text::suggest::with_article;
use psd_text::units::{Dimension, display};

/// `one axis`, `3 axes`
pub fn axes_of(count: usize) -> String {
    counted_in_words(count, "axis", "axes")
}

/// The name of a block in a message: ``specimen `beam` ``.
pub fn owner(kind: &BlockKind, name: Option<&Ident>) -> String {
    name.map_or_else(
        || format!("`{}`", kind.words()),
        |name| format!("{} `{}`", kind.words(), name.node),
    )
}

/// A value as it is usually written: `16 mm`, not `16.00 mm`.
pub fn shown(value: f64, dimension: Dimension) -> String {
    display::plain(value, dimension, 4)
}

/// Most names of one list: a plan may declare any number.
const NAMED: usize = 40;

fn joined<'a>(words: impl IntoIterator<Item = &'a str>, by: &str) -> String {
    let mut words = words.into_iter();
    let quoted: Vec<String> = words
        .by_ref()
        .take(NAMED)
        .map(|word| format!("`{word}`"))
        .collect();
    let more = words.count();
    if more > 0 {
        return format!("{} {by} {more} more", quoted.join(", "));
    }
    match quoted.as_slice() {
        [] => "none".to_owned(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} {by} {last}", most.join(", ")),
    }
}

/// `a`, `b` or `c`
pub fn one_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "or")
}

/// `a`, `b` and `c`
pub fn all_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "and")
}

/// The known name that was probably meant: the word of the language for a synonym, else the nearest one.
pub fn meant<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let known: Vec<&str> = known.into_iter().collect();
    let synonym = SYNONYMS.iter().find(|(term, _)| *term == written);
    let synonym = synonym.and_then(|(_, name)| known.iter().find(|known| *known == name));
    synonym
        .copied()
        .or_else(|| psd_text::suggest::nearest(written, known))
}

/// "did you mean `x`?", or a list of the known names.
pub fn suggestion<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    match meant(written, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "remove it".to_owned(),
        None => format!("known here: {}", one_of(known)),
    }
}

/// "a length", "an energy", "a value in kg/m"
pub fn article(dimension: Dimension) -> String {
    let name = dimension.describe();
    if dimension.name().is_none() {
        return format!("a value in {name}");
    }
    with_article(&name)
}

/// `3 kg`: the number as it is written, in a suitable unit.
pub fn example(number: Option<&str>, dimension: Dimension) -> String {
    let number = number.unwrap_or("1");
    match dimension {
        Dimension::NUMBER => number.to_owned(),
        Dimension::ANGLE => format!("{number} deg"),
        Dimension::TEMPERATURE => format!("{number} degC"),
        _ => format!("{number} {}", dimension.usual_unit()),
    }
}

pub fn time(value: f64) -> String {
    shown(value, Dimension::TIME)
}
