//! `from("measured.csv", column: "mass_kg")`: measured values of an input. In: the arguments and the input. Out: the column in SI. The file
//! belongs to the plan.

use crate::check::checker::Checker;
use crate::check::expressions::choice::Chosen;
use crate::codes::E659;
use psd_plan::schema::study as schema;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::si_unit;

use super::target::Target;
use super::varied::Law;
use super::{arguments, samples_file};

/// A file of measured values: the row, if one row has the error, with its text.
struct BadSamplesFile<'a> {
    file: &'a str,
    row: Option<(usize, String)>,
    reason: &'a str,
    help: &'a str,
    span: Span,
}

impl Violation for BadSamplesFile<'_> {
    const CODE: Code = E659;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            file,
            row,
            reason,
            help,
            span,
        } = self;
        let message = match row {
            Some((line, text)) => format!("`{file}`, line {line}, `{text}`: {reason}"),
            None => format!("`{file}`: {reason}"),
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, "cannot be read as measured values")
            .help(help)
    }
}

pub(super) fn column<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    target: &Target,
) -> Option<Law> {
    let file = checker.text_argument(chosen, schema::FILE.name);
    let column = checker.text_argument(chosen, schema::COLUMN.name);
    let unit = arguments::number(checker, chosen, schema::UNIT, target.dimension);
    let ((path, at), (column, column_at), unit) = (file??, column??, unit?);
    let file = checker.data_file(&path, at)?;
    let values = match samples_file::column(&file.text, &column) {
        Ok(values) => values,
        Err(bad) => {
            let span = if bad.of_the_column { column_at } else { at };
            return checker.fail(BadSamplesFile {
                file: &file.name,
                row: bad.row,
                reason: &bad.reason,
                help: &bad.help,
                span,
            });
        }
    };
    let named = samples_file::unit_of(&column);
    let problem = |checker: &mut Checker, reason: &str, help: &str, span| {
        checker.fail(BadSamplesFile {
            file: &file.name,
            row: None,
            reason,
            help,
            span,
        })
    };
    let factor = match (unit, named) {
        (Some(unit), None) => unit,
        (Some(_), Some(_)) => {
            let reason = format!("the name of column `{column}` states its unit already");
            let span = chosen.span(schema::UNIT.name).unwrap_or(column_at);
            return problem(checker, &reason, "remove `unit:`", span);
        }
        (None, Some(unit)) if unit.dimension == target.dimension => unit.factor,
        (None, Some(unit)) => {
            let reason = format!(
                "column `{column}` is {}, and `{}` is {}",
                article(unit.dimension),
                target.name,
                article(target.dimension)
            );
            let help = "name another column, or correct the unit in its name";
            return problem(checker, &reason, help, column_at);
        }
        (None, None) if target.dimension == Dimension::NUMBER => 1.0,
        (None, None) => {
            let reason = format!("the unit of column `{column}` is not stated");
            let help = format!("add the argument `unit: 1 {}`", si_unit(target.dimension));
            return problem(checker, &reason, &help, column_at);
        }
    };
    let values: Vec<f64> = values.into_iter().map(|value| value * factor).collect();
    if values.iter().any(|value| !value.is_finite()) {
        let reason = format!("column `{column}` has a value that is not finite in SI units");
        return problem(checker, &reason, "correct the unit or the value", column_at);
    }
    Some(Law::Column {
        file: file.name,
        values,
    })
}

fn article(dimension: Dimension) -> String {
    if dimension == Dimension::NUMBER {
        return "a number".to_owned();
    }
    format!("in {}", si_unit(dimension))
}
