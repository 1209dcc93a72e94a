//! `psd limits`: the largest size of a plan. Each limit is read from the constant that defines it.

use std::fmt::Write as _;

use crate::exit::{Exit, Failure};
use crate::output::print_result;
use psd::procedures::{damping_sweep, stiffness_ramp};
use psd_language::check;
use psd_language::syntax::limits as syntax;
use psd_rig::journal;
use psd_text::diagnostic::render;

/// Prints every limit of the language.
pub fn limits() -> Result<Exit, Failure> {
    let counted = [
        (syntax::FILE_BYTES, "bytes of one file"),
        (syntax::LINE_BYTES, "bytes of one line"),
        (syntax::NAME_CHARS, "characters of one name"),
        (syntax::TEXT_BYTES, "bytes of one string"),
        (syntax::NUMBER_CHARS, "characters of one number"),
        (syntax::NESTING, "nested brackets"),
        (
            syntax::OPERATORS,
            "operators from the root of an expression to a leaf",
        ),
        (
            syntax::TOKENS,
            "words, numbers, strings and symbols of one file",
        ),
        (syntax::ERRORS, "errors reported for one file"),
        (
            render::DRAWN,
            "errors shown on a terminal (all with `--format json`)",
        ),
        (
            journal::LINE_BYTES,
            "bytes of one run log entry, its newline included",
        ),
        (check::MOST_FILES, "files of one plan, the plan included"),
        (check::DEEPEST, "files that use files, one inside another"),
        (
            check::DEEPEST_VALUES,
            "values that depend on each other, one inside another",
        ),
        (
            check::MOST_TERMS,
            "results and operators of one value, with those of the values that it names",
        ),
        (check::MOST_ENTRIES, "entries of one list or range"),
        (check::MOST_GROUND_SAMPLES, "samples of one ground motion"),
        (psd_plan::MOST_STOREYS, "storeys of one frame"),
    ]
    .map(|(bound, what)| (bound.to_string(), what));
    let calculated = [
        (
            stiffness_ramp::MOST_READINGS,
            "readings of one stiffness ramp",
        ),
        (
            damping_sweep::MOST_SAMPLES,
            "readings of one stroke of a damping sweep",
        ),
        (
            psd_plan::MOST_STEPS,
            "steps of one impact, or of a shake times its storeys",
        ),
    ]
    .map(|(bound, what)| (format!("{bound:.0}"), what));
    let record = [
        (
            psd_plan::MOST_RECORDED_STEPS.to_string(),
            "steps of all procedures of one run",
        ),
        (
            journal::MOST_BYTES.to_string(),
            "bytes of the run log of one run",
        ),
        (
            check::MOST_SAMPLE_ROWS.to_string(),
            "rows of one file of measured inputs",
        ),
        (psd_plan::study::MOST_RUNS.to_string(), "runs of one study"),
    ];
    print_result(&counted.iter().chain(&calculated).chain(&record).fold(
        String::new(),
        |mut text, (bound, what)| {
            let _ = writeln!(text, "{bound:>11}  {what}");
            text
        },
    ))?;
    Ok(Exit::Met)
}
