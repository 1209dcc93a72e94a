//! The page of a word of the language: a block, field, option, result, function, cross-section or unit. In: a word, alone or behind that of its block or
//! of a procedure, such as `impact.contact` or `hit.max_displacement`. Out: text. The words are those of the schema.

use std::fmt::Write as _;

use crate::settings::Settings;
use psd_lsp::{describe, units_of};
use psd_plan::schema::sections::{SECTIONS, VALUES};
use psd_plan::schema::{BLOCKS, BlockKind, FUNCTIONS, Field, Variant};
use psd_text::units::display::{self, significant, trimmed};
use psd_text::units::{Dimension, unit};

/// One meaning of a word: where it is written, and its description as Markdown.
struct Meaning {
    places: Vec<String>,
    text: String,
}

/// The page of a word; None: the language has no such word.
pub fn page(word: &str, settings: Settings) -> Option<String> {
    let (of, name) = word.rsplit_once('.').unwrap_or(("", word));
    // What precedes the point is a keyword, or a name that a plan gives.
    let named: Vec<&BlockKind> = BLOCKS
        .iter()
        .copied()
        .filter(|block| block.words() == of || block.keyword.last() == Some(&of))
        .collect();
    let blocks = if named.is_empty() { BLOCKS } else { &named };
    let mut meanings = Vec::new();
    for block in blocks {
        if of.is_empty() && (block.words() == name || block.keyword.last() == Some(&name)) {
            add(&mut meanings, "a block".to_owned(), block_page(block));
        }
        of_block(block, name, &mut meanings);
    }
    if of.is_empty() {
        for function in FUNCTIONS.iter().filter(|function| function.name == name) {
            let text = format!("**{}**\n\n{}", function.name, function.doc);
            add(&mut meanings, "a function".to_owned(), text);
        }
        for section in SECTIONS.iter().filter(|section| section.name == name) {
            let text = section_page(section);
            add(&mut meanings, "a cross-section".to_owned(), text);
        }
    }
    if let Ok(unit) = unit::parse(word) {
        add(&mut meanings, "a unit".to_owned(), unit_page(word, unit));
    }
    let pages: Vec<String> = meanings
        .iter()
        .map(|meaning| shown(meaning, settings))
        .collect();
    (!pages.is_empty()).then(|| pages.join("\n"))
}

/// Every word, for suggestions.
pub fn all() -> Vec<&'static str> {
    fn add(fields: &'static [Field], words: &mut Vec<&'static str>) {
        for field in fields {
            words.push(field.name);
            for variant in field.ty.variants() {
                words.push(variant.name);
                add(variant.arguments, words);
            }
        }
    }
    let mut words = Vec::new();
    for block in BLOCKS {
        words.extend(block.keyword.last());
        let values = block.results.iter().chain(block.exports);
        words.extend(values.map(|result| result.name));
        add(block.fields, &mut words);
    }
    words.extend(FUNCTIONS.iter().map(|function| function.name));
    words.extend(SECTIONS.iter().map(|section| section.name));
    words
}

/// Adds a meaning, or its place to the same meaning elsewhere.
fn add(meanings: &mut Vec<Meaning>, place: String, text: String) {
    match meanings.iter_mut().find(|known| known.text == text) {
        Some(known) if known.places.contains(&place) => {}
        Some(known) => known.places.push(place),
        None => meanings.push(Meaning {
            places: vec![place],
            text,
        }),
    }
}

/// The meanings of a word inside a block.
fn of_block(block: &BlockKind, name: &str, meanings: &mut Vec<Meaning>) {
    let words = block.words();
    let results = block.results.iter().chain(block.exports);
    for result in results.filter(|result| result.name == name) {
        add(
            meanings,
            format!("a result of `{words}`"),
            describe::result(result),
        );
    }
    let mut open: Vec<(&Field, String)> = block
        .fields
        .iter()
        .map(|field| (field, format!("a field of `{words}`")))
        .collect();
    // A model inside a model has the same list of options.
    let mut lists: Vec<*const Variant> = Vec::new();
    let mut next = 0;
    while let Some((field, place)) = open.get(next).cloned() {
        next += 1;
        if field.name == name {
            add(meanings, place, describe::field(field));
        }
        let variants = field.ty.variants();
        if variants.is_empty() || lists.contains(&variants.as_ptr()) {
            continue;
        }
        lists.push(variants.as_ptr());
        for variant in variants {
            if variant.name == name {
                add(
                    meanings,
                    format!("an option of `{}`", field.name),
                    describe::variant(variant),
                );
            }
            let arguments = variant.arguments.iter();
            open.extend(
                arguments.map(|argument| (argument, format!("an argument of `{}`", variant.name))),
            );
        }
    }
}

/// A block with its fields and results.
fn block_page(block: &BlockKind) -> String {
    let mut text = describe::block(block);
    if !block.fields.is_empty() {
        text.push_str("\n\nFields:");
    }
    for field in block.fields {
        let _ = write!(
            text,
            "\n- `{}`: {}; {}",
            field.name,
            describe::short(field),
            field.doc
        );
    }
    if !block.results.is_empty() {
        text.push_str("\n\nResults:");
    }
    for result in block.results {
        let _ = write!(text, "\n- `{}`: {}", result.name, result.doc);
    }
    text
}

/// A cross-section with its arguments and its numbers.
fn section_page(section: &Variant) -> String {
    let mut text = describe::variant(section);
    text.push_str("\n\nNumbers:");
    for value in VALUES {
        let _ = write!(text, "\n- `.{}`: {}", value.name, value.doc);
    }
    text
}

fn unit_page(word: &str, unit: unit::Unit) -> String {
    let base = display::si_unit(unit.dimension);
    // A scale with a zero of its own has no factor: its zero is said.
    let number = if unit.zero == 0.0 { 1.0 } else { 0.0 };
    let value = trimmed(&significant(unit.to_si(number), 10));
    let mut text = format!("**{word}**: {}", unit.dimension.describe());
    if unit.dimension != Dimension::NUMBER && base != word {
        let _ = write!(text, "\n\n{number} {word} = {value} {base}");
    }
    let others = units_of(unit.dimension);
    if !others.is_empty() {
        let _ = write!(text, "\n\nThe same quantity: {}", others.join(", "));
    }
    text
}

/// A meaning for the terminal: headings painted, a plan indented, no empty line between the sentences about one field.
fn shown(meaning: &Meaning, settings: Settings) -> String {
    let (mut text, mut plan) = (String::new(), false);
    for line in meaning.text.lines() {
        if line.starts_with("```") {
            plan = !plan;
        } else if plan {
            let _ = writeln!(text, "    {line}");
        } else if let Some((name, rest)) = line
            .strip_prefix("**")
            .and_then(|line| line.split_once("**"))
        {
            let _ = writeln!(
                text,
                "{}{rest}  ({})",
                settings.paint_heading(name),
                meaning.places.join(", ")
            );
        } else if !line.is_empty() {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_a_page() {
        for word in all() {
            let page = page(word, Settings::PLAIN);
            assert!(
                page.is_some_and(|page| page.len() > word.len() + 10),
                "{word}"
            );
        }
    }

    #[test]
    fn a_name_of_a_plan_or_a_keyword_may_precede_a_word() {
        let shown = |word| page(word, Settings::PLAIN).unwrap_or_default();
        assert!(shown("hit.max_displacement").contains("a result of `impact`"));
        let of_impact = shown("impact.stiffness");
        assert!(
            of_impact.contains("a field of `impact`") && !of_impact.contains("a field of `storey"),
            "{of_impact}"
        );
        assert!(shown("hertz").contains("an option of `contact`"));
        assert!(shown("pipe").contains("`.second_moment`"));
        assert!(shown("kip/in").contains("N/m") && shown("kN").contains("force"));
        assert!(shown("degC").contains("0 degC = 273.15 K"));
        assert!(page("max_displacment", Settings::PLAIN).is_none());
    }
}
