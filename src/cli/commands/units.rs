//! `psd units`: a value in other units, or the list of units. In: an expression of the language, and a unit. Out: numbers. It reads no plan.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use clap::Args;

use crate::exit::{Exit, Failure};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::check::no_files;
use psd_language::check::checker::{Checker, Context, Reads};
use psd_language::check::scope::Scope;
use psd_language::syntax;
use psd_lsp::units_of;
use psd_text::columns::columns;
use psd_text::diagnostic::render::render_all;
use psd_text::source::Sources;
use psd_text::units::unit::{self, PREFIXES, UNITS};
use psd_text::units::{Quantity, display};

/// Between a value and the unit in which it is wanted.
const TO: &str = " to ";
/// Digits of a converted value.
const DIGITS: usize = 10;

#[derive(Debug, Args)]
pub struct UnitsArguments {
    /// A value, or a value `to` a unit [default: list the units]
    #[arg(value_name = "VALUE", allow_negative_numbers = true)]
    pub words: Vec<String>,
}

/// Converts a value, or lists the units.
pub fn units(arguments: &UnitsArguments, settings: Settings) -> Result<Exit, Failure> {
    let text = arguments.words.join(" ");
    let text = text.trim();
    if text.is_empty() {
        print_result(&list())?;
        return Ok(Exit::Met);
    }
    let (written, wanted) = match text.rsplit_once(TO) {
        Some((written, wanted)) => (written.trim(), Some(wanted.trim())),
        None => (text, None),
    };
    let Some(value) = value_of(written, settings) else {
        return Ok(Exit::Wrong);
    };
    let Some(wanted) = wanted else {
        print_result(&in_every_unit(value))?;
        return Ok(Exit::Met);
    };
    let unit = unit::parse(wanted).map_err(|error| {
        Failure::command_line(error.to_string()).help("`psd units` lists the units")
    })?;
    if unit.dimension != value.dimension {
        return Err(Failure::command_line(format!(
            "`{written}` has the dimension {}, and `{wanted}` the dimension {}",
            value.dimension.describe(),
            unit.dimension.describe()
        ))
        .help(format!(
            "write one of {}",
            units_of(value.dimension).join(", ")
        )));
    }
    print_result(&format!("{} {wanted}\n", digits(unit.of_si(value.value))))?;
    Ok(Exit::Met)
}

fn digits(value: f64) -> String {
    display::trimmed(&display::significant(value, DIGITS))
}

/// The value of an expression. None: it has none, and the reason is printed.
fn value_of(written: &str, settings: Settings) -> Option<Quantity> {
    let mut sources = Sources::default();
    let file = sources.add("value", format!("let value = {written}"));
    let (tree, mut found) = syntax::parse(&sources, file);
    let trees = [tree];
    let none = BTreeMap::new();
    let scope = Scope::collect(&trees, &none, &mut found);
    let mut checker = Checker::new(&sources, &scope, &no_files, found, Vec::new(), false);
    let context = Context {
        entry: None,
        reads: Reads::All,
        critical: false,
    };
    let value = scope.values.first().and_then(|declared| {
        let typed = checker.value(declared.value, context)?;
        Some(Quantity {
            value: typed.constant()?,
            dimension: typed.dimension,
        })
    });
    if checker.diagnostics.is_empty() && value.is_some() {
        return value;
    }
    let appearance = settings.appearance(Path::new(""));
    print_message(&render_all(&checker.diagnostics, &sources, &appearance));
    None
}

/// The value in each unit of its dimension, one per line.
fn in_every_unit(value: Quantity) -> String {
    let rows = units_of(value.dimension).into_iter().filter_map(|name| {
        let unit = unit::parse(&name).ok()?;
        Some(vec![digits(unit.of_si(value.value)), name])
    });
    let rows: Vec<Vec<String>> = rows.collect();
    format!("{}\n{}", value.dimension.describe(), columns(&rows))
}

/// Every unit, and the prefixes.
fn list() -> String {
    let rows = UNITS.iter().map(|unit| {
        let prefixes = if unit.prefixes { "with prefixes" } else { "" };
        vec![
            unit.symbol.to_owned(),
            unit.doc.to_owned(),
            unit.dimension.describe(),
            prefixes.to_owned(),
        ]
    });
    let mut text = columns(&rows.collect::<Vec<_>>());
    let prefixes: Vec<&str> = PREFIXES.iter().map(|(prefix, _)| *prefix).collect();
    let _ = writeln!(
        text,
        "prefixes: {}; products and powers: kN/m, N*s/m, mm^2",
        prefixes.join(", ")
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_converted_by_exact_factors() {
        let value = value_of("3 kip/in", Settings::PLAIN).unwrap();
        let unit = unit::parse("N/mm").unwrap();
        // 3 · 1000 · 0.45359237 · 9.80665 N / 25.4 mm
        assert_eq!(digits(value.value / unit.factor), "525.3805057");
        let kelvin = value_of("300 K", Settings::PLAIN).unwrap();
        let celsius = unit::parse("degC").unwrap();
        assert_eq!(digits(celsius.of_si(kelvin.value)), "26.85");
        let product = value_of("2 * 300 N/m * 3 mm", Settings::PLAIN).unwrap();
        let listed = in_every_unit(product);
        assert!(
            listed.contains("  1.8 ") && listed.contains(" N\n"),
            "{listed}"
        );
        assert!(value_of("3 kipp", Settings::PLAIN).is_none());
        assert!(value_of("hit.max_displacement", Settings::PLAIN).is_none());
    }
}
