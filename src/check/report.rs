//! `report { … }`: results, annexes, figures, formats, signatories. Without it: the headline results, every table and figure.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::language::check::checker::{Checker, Context, Reads};
use crate::language::check::messages::{files, names, types};
use crate::language::check::scope::Meaning;
use crate::language::syntax::ast::{Argument, Expr, ExprKind};
use crate::plan::formula::{Part, ProcedureId, ResultReference};
use crate::plan::{
    Annex, Figure, FigureKind, Format, MOST_PHOTOS, MOST_TOGETHER, Picture, PictureKind, Procedure,
    Report,
};
use crate::schema::report as schema;
use crate::schema::{BlockKind, Kind};
use crate::text::source::{Span, Spanned};

const EVERY_FORMAT: [Format; 4] = [Format::Html, Format::Pdf, Format::Csv, Format::Parquet];

/// `procedures` are in the order of the plan, None for each with an error.
pub fn report(checker: &mut Checker, procedures: &[Option<Procedure>]) -> Option<Report> {
    let Some(block) = checker
        .scope
        .of_kind(Kind::Report)
        .map(|(index, _)| index)
        .next()
    else {
        return Some(Report {
            title: None,
            figures: every_figure(procedures),
            figures_named: false,
            formats: EVERY_FORMAT.to_vec(),
            sign: Vec::new(),
            annexes: Annex::DEFAULT.to_vec(),
            results: None,
            logo: None,
            photos: Vec::new(),
        });
    };
    let title = match checker.field(block, schema::TITLE.name) {
        Some(_) => checker.text_field(block, schema::TITLE.name).map(Some),
        None => Some(None),
    };
    let figures = figures(checker, block, procedures);
    let formats = match checker.field(block, schema::FORMATS.name) {
        Some(_) => checker.choices(block, schema::FORMATS.name).map(|chosen| {
            chosen
                .iter()
                .map(|chosen| format(chosen.variant.name))
                .collect()
        }),
        None => Some(EVERY_FORMAT.to_vec()),
    };
    let sign = match checker.field(block, schema::SIGN.name) {
        Some(_) => checker.texts(block, schema::SIGN.name),
        None => Some(Vec::new()),
    };
    let logo = match checker.field(block, schema::LOGO.name) {
        Some((_, written)) => picture(checker, schema::LOGO.name, &written.value).map(Some),
        None => Some(None),
    };
    let photos = photos(checker, block);
    let annexes = annexes(checker, block);
    let results = match checker.field(block, schema::RESULTS.name) {
        Some((_, written)) => results(checker, &written.value).map(Some),
        None => Some(None),
    };
    Some(Report {
        title: title?,
        figures: figures?,
        figures_named: checker.field(block, schema::FIGURES.name).is_some(),
        formats: formats?,
        sign: sign?,
        annexes: annexes?,
        results: results?,
        logo: logo?,
        photos: photos?,
    })
}

fn photos(checker: &mut Checker, block: usize) -> Option<Vec<Picture>> {
    let Some((_, written)) = checker.field(block, schema::PHOTOS.name) else {
        return Some(Vec::new());
    };
    let items = match &written.value.kind {
        ExprKind::List { items, unit: None } => items.as_slice(),
        _ => std::slice::from_ref(&written.value),
    };
    if let Some(one_too_many) = items.get(MOST_PHOTOS) {
        return checker.fail(files::too_many_photos(MOST_PHOTOS, one_too_many.span));
    }
    let read: Vec<Option<Picture>> = items
        .iter()
        .map(|item| picture(checker, schema::PHOTOS.name, item))
        .collect();
    read.into_iter().collect()
}

/// A picture file of the plan, with its format verified.
fn picture(checker: &mut Checker, field: &str, written: &Expr) -> Option<Picture> {
    let path = checker.text_value(field, written)?;
    let Some(kind) = PictureKind::of(&path) else {
        return checker.fail(files::not_a_picture(&path, written.span));
    };
    let file = checker.data_file(&path, written.span)?;
    let bytes = if kind.is_binary() {
        STANDARD.decode(file.text.as_bytes()).unwrap_or_default()
    } else {
        file.text.as_bytes().to_vec()
    };
    match kind.verify(&bytes) {
        Ok(()) => Some(Picture {
            file: file.name,
            kind,
            bytes,
        }),
        Err(reason) => checker.fail(files::bad_picture(&file.name, &reason, written.span)),
    }
}

/// The annexes, in the order of a report. The same annex twice is one annex.
fn annexes(checker: &mut Checker, block: usize) -> Option<Vec<Annex>> {
    if checker.field(block, schema::ANNEXES.name).is_none() {
        return Some(Annex::DEFAULT.to_vec());
    }
    let chosen = checker.choices(block, schema::ANNEXES.name)?;
    let is_chosen = |annex: &Annex| {
        chosen
            .iter()
            .any(|chosen| chosen.variant.name == annex.name())
    };
    Some(Annex::ALL.into_iter().filter(is_chosen).collect())
}

/// The results of the second page, each once, in the order of the plan.
fn results<'a>(checker: &mut Checker<'a>, written: &'a Expr) -> Option<Vec<ResultReference>> {
    let items = match &written.kind {
        ExprKind::List { items, unit: None } => items.as_slice(),
        _ => std::slice::from_ref(written),
    };
    let checked: Vec<Option<ResultReference>> =
        items.iter().map(|item| result(checker, item)).collect();
    let mut results: Vec<ResultReference> = Vec::new();
    for reference in checked.into_iter().collect::<Option<Vec<_>>>()? {
        if !results.contains(&reference) {
            results.push(reference);
        }
    }
    Some(results)
}

/// `hit.max_displacement`
fn result<'a>(checker: &mut Checker<'a>, written: &'a Expr) -> Option<ResultReference> {
    const RESULTS: Context = Context {
        entry: None,
        reads: Reads::All,
        critical: false,
    };
    let typed = checker.value(written, RESULTS)?;
    let reference = typed
        .formula
        .as_result()
        .filter(|reference| reference.part == Part::Value);
    match reference {
        Some(reference) => Some(reference),
        None => checker.fail(types::result_wanted(
            written.span,
            checker.text(written.span),
        )),
    }
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
        let kinds = procedure.as_ref().map_or(&[][..], |procedure| {
            crate::procedures::facts_of(&procedure.kind).figures
        });
        kinds.iter().map(move |kind| Figure {
            kind: *kind,
            procedure: ProcedureId(index),
            beside: Vec::new(),
        })
    };
    procedures.iter().enumerate().flat_map(of).collect()
}

fn figures(
    checker: &mut Checker,
    block: usize,
    procedures: &[Option<Procedure>],
) -> Option<Vec<Figure>> {
    let Some((_, written)) = checker.field(block, schema::FIGURES.name) else {
        return Some(every_figure(procedures));
    };
    let items = match &written.value.kind {
        ExprKind::List { items, unit: None } => items.as_slice(),
        _ => std::slice::from_ref(&written.value),
    };
    let checked: Vec<Option<Figure>> = items
        .iter()
        .map(|item| figure(checker, item, procedures))
        .collect();
    checked.into_iter().collect()
}

/// `energy(hit)`, or `displacement(paused, moving)`: several on one chart.
fn figure(
    checker: &mut Checker,
    written: &Expr,
    procedures: &[Option<Procedure>],
) -> Option<Figure> {
    let ExprKind::Call { name, arguments } = &written.kind else {
        return match written.kind {
            ExprKind::Faulty => None,
            _ => checker.fail(types::figure_wanted(
                written.span,
                checker.text(written.span),
            )),
        };
    };
    let Some(kind) = FigureKind::ALL
        .into_iter()
        .find(|kind| kind.name() == name.node)
    else {
        return checker.fail(names::unknown_figure(
            &name.node,
            name.span,
            FigureKind::ALL.map(FigureKind::name),
        ));
    };
    if arguments.is_empty() {
        return checker.fail(types::figure_wanted(
            written.span,
            checker.text(written.span),
        ));
    }
    let drawn: Vec<Option<ProcedureId>> = arguments
        .iter()
        .map(|argument| drawn_of(checker, kind, written.span, &argument.value, procedures))
        .collect();
    let drawn: Vec<ProcedureId> = drawn.into_iter().collect::<Option<_>>()?;
    if drawn.len() > 1 {
        together(checker, kind, &drawn, arguments, procedures)?;
    }
    Some(Figure {
        kind,
        procedure: drawn[0],
        beside: drawn[1..].to_vec(),
    })
}

/// The procedure that a figure names, if it has such a figure.
fn drawn_of(
    checker: &mut Checker,
    kind: FigureKind,
    figure: Span,
    argument: &Expr,
    procedures: &[Option<Procedure>],
) -> Option<ProcedureId> {
    let ExprKind::Name(of) = &argument.kind else {
        return checker.fail(types::figure_wanted(figure, checker.text(figure)));
    };
    let span = argument.span;
    let block = match checker.scope.meaning(of) {
        Some(Meaning::Poisoned) => return None,
        Some(Meaning::Block(block)) => block,
        Some(Meaning::Value(_)) => return checker.fail(types::procedure_wanted(of, span)),
        None if checker.may_be_lost(of)
            || checker.scope.nameless().any(BlockKind::is_procedure) =>
        {
            return None;
        }
        None => {
            let known: Vec<&str> = checker
                .scope
                .procedures()
                .filter_map(|(_, block)| block.name)
                .map(|name| name.node.as_str())
                .collect();
            return checker.fail(names::unknown_procedure(of, span, &known));
        }
    };
    let Some(procedure) = checker.scope.blocks[block].procedure else {
        return checker.fail(types::procedure_wanted(of, span));
    };
    let drawn = crate::procedures::facts_of(&procedures.get(procedure.0)?.as_ref()?.kind).figures;
    if !drawn.contains(&kind) {
        let words = checker.scope.blocks[block].kind.words();
        let drawn = drawn.iter().map(|kind| kind.name());
        return checker.fail(names::figure_of_other_procedure(
            kind.name(),
            &words,
            figure,
            drawn,
        ));
    }
    Some(procedure)
}

/// Whether these procedures fit on one chart: one curve of each, all of one kind, each once, not too many.
fn together(
    checker: &mut Checker,
    kind: FigureKind,
    drawn: &[ProcedureId],
    arguments: &[Argument],
    procedures: &[Option<Procedure>],
) -> Option<()> {
    let of = |procedure: &ProcedureId| {
        procedures
            .get(procedure.0)
            .and_then(Option::as_ref)
            .map(|procedure| &procedure.kind)
    };
    let first = of(&drawn[0])?;
    let keyword = first.keyword();
    let at = |index: usize| arguments[index].value.span;
    let shared = crate::procedures::facts_of(first).shared_figures;
    if !shared.contains(&kind) {
        let shared = crate::procedures::facts_of(first)
            .figures
            .iter()
            .filter(|kind| shared.contains(kind))
            .map(|kind| kind.name());
        return checker.fail(names::figure_of_one(kind.name(), keyword, at(1), shared));
    }
    for (index, procedure) in drawn.iter().enumerate().skip(1) {
        let kinds = of(procedure)?;
        if kinds.keyword() != keyword {
            return checker.fail(names::figure_of_two_kinds(
                kind.name(),
                Spanned::new(keyword, at(0)),
                Spanned::new(kinds.keyword(), at(index)),
            ));
        }
        if let Some(before) = drawn[..index].iter().position(|other| other == procedure) {
            return checker.fail(names::figure_drawn_twice(at(before), at(index)));
        }
    }
    if drawn.len() > MOST_TOGETHER {
        return checker.fail(names::too_many_together(
            drawn.len(),
            MOST_TOGETHER,
            at(MOST_TOGETHER),
        ));
    }
    Some(())
}
