//! `golden { … }`: required agreement of a rerun with the accepted results. Its tolerances are fixed before the run; `%` is relative to
//! the absolute value of the number, as in `require … within`.

use crate::codes::{E617, E618, W710};
use crate::procedures;
use psd_language::check::checker::{Checker, Context, Reads};
use psd_language::check::declarations::tolerance::tolerance;
use psd_language::check::expressions::choice::Chosen;
use psd_language::check::scope::Meaning;
use psd_language::check::violations::UnknownProcedure;
use psd_language::check::wording::{shown, suggestion};
use psd_language::codes::E304;
use psd_language::syntax::ast::{Expr, ExprKind};
use psd_plan::formula::{ProcedureId, ResultPart};
use psd_plan::schema::{BlockKind, Column, Kind, golden as schema};
use psd_plan::{ColumnTolerance, Golden, ResultTolerance, Tolerance};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

/// A tolerance of 0.1 or more has little effect.
const WIDE: f64 = 0.1;

const RESULTS: Context = Context {
    entry: None,
    reads: Reads::All,
    critical: false,
};

#[derive(Violation)]
#[violation(
    W710,
    "a tolerance of {percent} % would hide real changes",
    percent = shown(100.0 * tolerance, Dimension::NUMBER)
)]
#[help(
    "write a smaller tolerance: results on a virtual rig differ between machines by rounding only"
)]
struct WideAcceptance {
    tolerance: f64,
    #[label("more than 10 %")]
    span: Span,
}

pub fn golden(checker: &mut Checker) -> Option<Golden> {
    let Some(block) = checker
        .scope
        .of_kind(Kind::Golden)
        .map(|(index, _)| index)
        .next()
    else {
        return Some(Golden::default());
    };
    let tolerance = checker.constant(block, schema::TOLERANCE.name);
    if let (Some(tolerance), Some((_, entry))) =
        (tolerance, checker.field(block, schema::TOLERANCE.name))
        && tolerance > WIDE
    {
        checker.report(WideAcceptance {
            tolerance,
            span: entry.value.span,
        });
    }
    let mut named = Vec::new();
    let results = each(checker, block, schema::RESULTS.name, |checker, chosen| {
        result_tolerance(checker, chosen, &mut named)
    });
    let mut named = Vec::new();
    let columns = each(checker, block, schema::COLUMNS.name, |checker, chosen| {
        column_tolerance(checker, chosen, &mut named)
    });
    Some(Golden {
        tolerance: tolerance?,
        results: results?,
        columns: columns?,
    })
}

/// Checks every entry of a list, so that all errors are reported; an absent list is empty.
fn each<'a, T>(
    checker: &mut Checker<'a>,
    block: usize,
    field: &str,
    mut read: impl FnMut(&mut Checker<'a>, &Chosen<'a>) -> Option<T>,
) -> Option<Vec<T>> {
    if checker.field(block, field).is_none() {
        return Some(Vec::new());
    }
    let chosen = checker.choices(block, field)?;
    let read: Vec<Option<T>> = chosen.iter().map(|chosen| read(checker, chosen)).collect();
    read.into_iter().collect()
}

type Named<T> = Vec<(T, Span)>;

#[derive(Violation)]
#[violation(E304, "a result is required")]
#[help(
    "name a result, such as `hit.max_displacement`; the tolerance applies to its uncertainty too"
)]
struct AcceptedResultWanted<'a> {
    #[label("`{text}` is not a result of a procedure")]
    span: Span,
    text: &'a str,
}

/// `tolerance(hit.stop_time, 1 us)`
fn result_tolerance<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    named: &mut Named<(ProcedureId, &'static str)>,
) -> Option<ResultTolerance> {
    let of = chosen.find(schema::RESULT.name)?.1?;
    let typed = checker.value(of, RESULTS)?;
    let Some(reference) = typed
        .formula
        .as_result()
        .filter(|reference| reference.part == ResultPart::Value)
    else {
        return checker.fail(AcceptedResultWanted {
            span: of.span,
            text: checker.text(of.span),
        });
    };
    once(
        checker,
        named,
        (reference.procedure, reference.name),
        of.span,
    )?;
    let tolerance = narrow(checker, chosen, typed.dimension)?;
    Some(ResultTolerance {
        procedure: reference.procedure,
        name: reference.name,
        dimension: typed.dimension,
        tolerance,
    })
}

/// `tolerance(hit.restoring_force_n, 0.1 N)`, `tolerance(wall_time_s, 1 ms)`
fn column_tolerance<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    named: &mut Named<(Option<ProcedureId>, &'static str)>,
) -> Option<ColumnTolerance> {
    let of = chosen.find(schema::COLUMN.name)?.1?;
    let (procedure, column) = column(checker, of)?;
    once(checker, named, (procedure, column.name), of.span)?;
    let tolerance = narrow(checker, chosen, column.dimension)?;
    Some(ColumnTolerance {
        procedure,
        name: column.name,
        dimension: column.dimension,
        tolerance,
    })
}

#[derive(Violation)]
#[violation(E304, "a column is required")]
#[help(
    "name a column of one procedure, such as `hit.displacement_m`, or of all, such as `wall_time_s`"
)]
struct AcceptedColumnWanted<'a> {
    #[label("`{text}` is not a column")]
    span: Span,
    text: &'a str,
}

#[derive(Violation)]
#[violation(E617, "no table has a numeric column `{name}`")]
#[help("{}", suggestion(name, known))]
struct UnknownColumn<'a, I: Iterator<Item = &'a str>> {
    name: &'a str,
    #[label("unknown column")]
    span: Span,
    known: I,
}

/// The named column, of one procedure or of all.
fn column(checker: &mut Checker, of: &Expr) -> Option<(Option<ProcedureId>, Column)> {
    let (procedure, kinds, name, span) = match &of.kind {
        ExprKind::Name(name) => {
            let kinds: Vec<Kind> = checker
                .scope
                .procedures()
                .map(|(_, block)| block.kind.kind)
                .collect();
            (None, kinds, name, of.span)
        }
        ExprKind::Field { base, name } => {
            let ExprKind::Name(owner) = &base.kind else {
                return checker.fail(AcceptedColumnWanted {
                    span: of.span,
                    text: checker.text(of.span),
                });
            };
            let block = match checker.scope.meaning(owner) {
                Some(Meaning::Poisoned) => return None,
                Some(Meaning::Block(block)) if checker.scope.blocks[block].procedure.is_some() => {
                    block
                }
                None if checker.may_be_lost(owner)
                    || checker.scope.nameless().any(BlockKind::is_procedure) =>
                {
                    return None;
                }
                _ => {
                    let known: Vec<&str> = checker
                        .scope
                        .procedures()
                        .filter_map(|(_, block)| block.name)
                        .map(|n| &*n.node)
                        .collect();
                    return checker.fail(UnknownProcedure {
                        name: owner,
                        span: base.span,
                        known: &known,
                    });
                }
            };
            let declared = &checker.scope.blocks[block];
            (
                declared.procedure,
                vec![declared.kind.kind],
                &name.node,
                name.span,
            )
        }
        ExprKind::Faulty => return None,
        _ => {
            return checker.fail(AcceptedColumnWanted {
                span: of.span,
                text: checker.text(of.span),
            });
        }
    };
    let known: Vec<Column> = kinds.into_iter().flat_map(procedures::columns).collect();
    match known.iter().find(|column| column.name == name) {
        Some(column) => Some((procedure, *column)),
        None => checker.fail(UnknownColumn {
            name,
            span,
            known: known.iter().map(|column| column.name),
        }),
    }
}

#[derive(Violation)]
#[violation(E618, "`{text}` has two tolerances")]
#[help("remove one of the tolerances")]
struct ToleranceTwice<'a> {
    text: &'a str,
    #[label("second tolerance")]
    span: Span,
    #[label("first tolerance")]
    first: Span,
}

/// A name has only one tolerance.
fn once<T: PartialEq>(
    checker: &mut Checker,
    named: &mut Named<T>,
    name: T,
    span: Span,
) -> Option<()> {
    if let Some((_, first)) = named.iter().find(|(before, _)| *before == name) {
        let diagnostic = ToleranceTwice {
            text: checker.text(span),
            span,
            first: *first,
        }
        .diagnostic();
        return checker.fail(diagnostic);
    }
    named.push((name, span));
    Some(())
}

/// The tolerance of an accepted number, with a warning of one that would hide changes.
fn narrow<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    dimension: Dimension,
) -> Option<Tolerance> {
    let written = chosen.find(schema::WITHIN.name)?.1?;
    let tolerance = tolerance(checker, schema::WITHIN.name, written, dimension)?;
    if let Tolerance::Relative(value) = tolerance
        && value > WIDE
    {
        checker.report(WideAcceptance {
            tolerance: value,
            span: written.span,
        });
    }
    Some(tolerance)
}
