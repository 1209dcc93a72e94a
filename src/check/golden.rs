//! `golden { … }`: required agreement of a rerun with the accepted results. Its tolerances are fixed before the run; `%` is relative to
//! the absolute value of the number, as in `require … within`.

use crate::language::check::checker::{Checker, Context, Reads};
use crate::language::check::declarations::tolerance::tolerance;
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::{golden as message, names};
use crate::language::check::scope::Meaning;
use crate::language::syntax::ast::{Expr, ExprKind};
use crate::plan::formula::{Part, ProcedureId};
use crate::plan::{ColumnTolerance, Golden, ResultTolerance, Tolerance};
use crate::procedures;
use crate::schema::golden as schema;
use crate::schema::{BlockKind, Column, Kind};
use crate::text::source::Span;
use crate::units::Dimension;

/// A tolerance of 0.1 or more has little effect.
const WIDE: f64 = 0.1;

const RESULTS: Context = Context {
    entry: None,
    reads: Reads::All,
    critical: false,
};

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
        checker
            .diagnostics
            .push(message::wide(tolerance, entry.value.span));
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
        .filter(|reference| reference.part == Part::Value)
    else {
        return checker.fail(message::result_wanted(of.span, checker.text(of.span)));
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
                return checker.fail(message::column_wanted(of.span, checker.text(of.span)));
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
                    return checker.fail(names::unknown_procedure(owner, base.span, &known));
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
        _ => return checker.fail(message::column_wanted(of.span, checker.text(of.span))),
    };
    let known: Vec<Column> = kinds.into_iter().flat_map(procedures::columns).collect();
    match known.iter().find(|column| column.name == name) {
        Some(column) => Some((procedure, *column)),
        None => checker.fail(message::unknown_column(
            name,
            span,
            known.iter().map(|column| column.name),
        )),
    }
}

/// A name has only one tolerance.
fn once<T: PartialEq>(
    checker: &mut Checker,
    named: &mut Named<T>,
    name: T,
    span: Span,
) -> Option<()> {
    if let Some((_, first)) = named.iter().find(|(before, _)| *before == name) {
        let diagnostic = message::tolerance_twice(checker.text(span), span, *first);
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
        checker.diagnostics.push(message::wide(value, written.span));
    }
    Some(tolerance)
}
