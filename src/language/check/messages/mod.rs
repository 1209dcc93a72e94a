//! The wording of the diagnostics of the check, one file per subject. In: names, values and spans.
//! Out: diagnostics. They make no decision.

use crate::syntax::ast::Ident;
use crate::syntax::limits::ERRORS;
use psd_plan::procedures::stiffness_ramp::block as stiffness_ramp;
use psd_plan::schema::BlockKind;
use psd_text::diagnostic::{Code, Diagnostic, Severity};
use psd_text::units::{Dimension, display};

pub mod axes;
pub mod cyclic;
pub mod files;
pub mod frames;
pub mod golden;
pub mod inputs;
pub mod methods;
pub mod names;
pub mod rigs;
pub mod specimens;
pub mod studies;
pub mod types;
pub mod values;
pub mod whole;

/// Keeps the first diagnostics of many, errors before warnings, and counts the others.
pub fn cap(diagnostics: &mut Vec<Diagnostic>) {
    let errors = diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.is_error())
        .count();
    let mut left = [ERRORS, ERRORS.saturating_sub(errors)];
    let mut out: Vec<Diagnostic> = Vec::new();
    for diagnostic in std::mem::take(diagnostics) {
        let left = &mut left[usize::from(!diagnostic.is_error())];
        if *left > 0 {
            *left -= 1;
            diagnostics.push(diagnostic);
        } else {
            out.push(diagnostic);
        }
    }
    let Some(first) = out
        .iter()
        .find(|diagnostic| diagnostic.is_error())
        .or(out.first())
    else {
        return;
    };
    let one = if first.is_error() {
        Severity::Error
    } else {
        Severity::Warning
    };
    let message = format!(
        "{} more errors are not listed (at most {ERRORS})",
        out.len()
    );
    let more = Diagnostic {
        severity: one,
        ..Diagnostic::new(Code::TooLarge, message)
    };
    let more = first
        .span()
        .into_iter()
        .fold(more, |more, span| more.at(span, "first unlisted error"));
    diagnostics.push(more.help("correct the listed errors first"));
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

/// `a`, `b` or `c`
pub fn one_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "or")
}

/// `a`, `b` and `c`
pub fn all_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "and")
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

/// Terms of the field for which psd has another name, and that name.
const SYNONYMS: &[(&str, &str)] = &[("hardening", stiffness_ramp::POST_YIELD_RATIO.name)];

/// "did you mean `x`?", or a list of the known names.
pub fn suggestion<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let synonym = SYNONYMS
        .iter()
        .find(|(term, name)| *term == written && known.contains(name));
    let near = synonym.map(|(_, name)| *name);
    match near.or_else(|| psd_text::suggest::nearest(written, known.iter().copied())) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "remove it".to_owned(),
        None => format!("known here: {}", one_of(known)),
    }
}
