//! `report { … }`: figures, formats, who signs. Without it: every table and figure.

use super::checker::Checker;
use super::faults::{names, types};
use super::scope::Meaning;
use crate::formula::ProcedureId;
use crate::plan::{Figure, FigureKind, Format, Procedure, Report};
use crate::schema::Kind;
use crate::syntax::ast::{Expr, ExprKind};

const EVERY_FORMAT: [Format; 4] = [Format::Html, Format::Pdf, Format::Csv, Format::Parquet];

/// `procedures` holds those without a fault, by their place in the plan.
pub fn report(checker: &mut Checker, procedures: &[Option<Procedure>]) -> Option<Report> {
    let Some(block) = checker.scope.of_kind(Kind::Report).map(|(index, _)| index).next() else {
        return Some(Report { title: None, figures: every_figure(procedures), formats: EVERY_FORMAT.to_vec(), sign: Vec::new() });
    };
    let title = match checker.given(block, "title") {
        Some(_) => checker.text_field(block, "title").map(Some),
        None => Some(None),
    };
    let figures = figures(checker, block, procedures);
    let formats = match checker.given(block, "formats") {
        Some(_) => {
            checker.choices(block, "formats").map(|chosen| chosen.iter().map(|chosen| format(chosen.variant.name)).collect())
        }
        None => Some(EVERY_FORMAT.to_vec()),
    };
    let sign = match checker.given(block, "sign") {
        Some(_) => checker.texts(block, "sign"),
        None => Some(Vec::new()),
    };
    Some(Report { title: title?, figures: figures?, formats: formats?, sign: sign? })
}

fn format(name: &str) -> Format {
    match name {
        "html" => Format::Html,
        "pdf" => Format::Pdf,
        "csv" => Format::Csv,
        _ => Format::Parquet,
    }
}

fn every_figure(procedures: &[Option<Procedure>]) -> Vec<Figure> {
    let of = |(index, procedure): (usize, &Option<Procedure>)| {
        let kinds = procedure.as_ref().map_or(&[][..], |procedure| FigureKind::of(&procedure.kind));
        kinds.iter().map(move |kind| Figure { kind: *kind, procedure: ProcedureId(index) })
    };
    procedures.iter().enumerate().flat_map(of).collect()
}

fn figures(checker: &mut Checker, block: usize, procedures: &[Option<Procedure>]) -> Option<Vec<Figure>> {
    let Some((_, written)) = checker.given(block, "figures") else { return Some(every_figure(procedures)) };
    let items = match &written.value.kind {
        ExprKind::List { items, unit: None } => items.as_slice(),
        _ => std::slice::from_ref(&written.value),
    };
    let checked: Vec<Option<Figure>> = items.iter().map(|item| figure(checker, item, procedures)).collect();
    checked.into_iter().collect()
}

/// `energy(hit)`
fn figure(checker: &mut Checker, written: &Expr, procedures: &[Option<Procedure>]) -> Option<Figure> {
    let ExprKind::Call { name, arguments } = &written.kind else {
        return match written.kind {
            ExprKind::Faulty => None,
            _ => checker.fail(types::figure_wanted(written.span, checker.text(written.span))),
        };
    };
    let Some(kind) = FigureKind::ALL.into_iter().find(|kind| kind.name() == name.node) else {
        return checker.fail(names::unknown_figure(&name.node, name.span, FigureKind::ALL.map(FigureKind::name)));
    };
    let [argument] = arguments.as_slice() else {
        return checker.fail(types::figure_wanted(written.span, checker.text(written.span)));
    };
    let ExprKind::Name(of) = &argument.value.kind else {
        return checker.fail(types::figure_wanted(written.span, checker.text(written.span)));
    };
    let span = argument.value.span;
    let block = match checker.scope.meaning(of) {
        Some(Meaning::Poisoned) => return None,
        Some(Meaning::Block(block)) => block,
        Some(Meaning::Value(_)) => return checker.fail(types::procedure_wanted(of, span)),
        None if checker.may_be_lost(of) => return None,
        None => {
            let known: Vec<&str> =
                checker.scope.procedures().filter_map(|(_, block)| block.name).map(|name| name.node.as_str()).collect();
            return checker.fail(names::unknown_procedure(of, span, &known));
        }
    };
    let Some(procedure) = checker.scope.blocks[block].procedure else { return checker.fail(types::procedure_wanted(of, span)) };
    let drawn = FigureKind::of(&procedures.get(procedure.0)?.as_ref()?.kind);
    if !drawn.contains(&kind) {
        let words = checker.scope.blocks[block].kind.words();
        return checker.fail(names::figure_of_other_procedure(
            kind.name(),
            &words,
            written.span,
            drawn.iter().map(|kind| kind.name()),
        ));
    }
    Some(Figure { kind, procedure })
}
