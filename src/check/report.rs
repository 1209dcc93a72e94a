//! `report { … }`: results, annexes, figures, formats, signatories. Without it: the headline results, every table and figure.

use crate::codes::E651;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use psd_language::check::checker::{Checker, Context, Reads};
use psd_language::check::scope::Meaning;
use psd_language::check::violations::UnknownProcedure;
use psd_language::check::wording::{one_of, suggestion};
use psd_language::codes::{E205, E304, E501, E502, E504};
use psd_language::syntax::ast::{Argument, Expr, ExprKind};
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference};
use psd_plan::schema::{BlockKind, Kind, report as schema};
use psd_plan::{
    Annex, Figure, FigureKind, Format, MOST_PHOTOS, MOST_TOGETHER, Picture, PictureKind, Procedure,
    Report,
};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{Span, Spanned};

const EVERY_FORMAT: [Format; 4] = [Format::Html, Format::Pdf, Format::Csv, Format::Parquet];

/// `procedures`, with their blocks, are in the order of the plan, None for each with an error.
pub fn report(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)]) -> Option<Report> {
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

#[derive(Violation)]
#[violation(E504, "too many photographs (at most {most})")]
#[help("remove photographs")]
struct TooManyPhotos {
    most: usize,
    #[label("one too many")]
    span: Span,
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
        return checker.fail(TooManyPhotos {
            most: MOST_PHOTOS,
            span: one_too_many.span,
        });
    }
    let read: Vec<Option<Picture>> = items
        .iter()
        .map(|item| picture(checker, schema::PHOTOS.name, item))
        .collect();
    read.into_iter().collect()
}

#[derive(Violation)]
#[violation(E502, "`{path}` is not a picture file")]
#[help("name a file that ends in `.png`, `.jpg`, `.jpeg` or `.svg`")]
struct NotAPicture<'a> {
    path: &'a str,
    #[label("not a picture file")]
    span: Span,
}

#[derive(Violation)]
#[violation(E501, "`{path}` cannot be used: {reason}")]
#[help("save it as PNG, JPEG or SVG of up to 2 MiB")]
struct BadPicture<'a> {
    path: &'a str,
    reason: &'a str,
    #[label("not a usable picture")]
    span: Span,
}

/// A picture file of the plan, with its format verified.
fn picture(checker: &mut Checker, field: &str, written: &Expr) -> Option<Picture> {
    let path = checker.text_value(field, written)?;
    let Some(kind) = PictureKind::of(&path) else {
        return checker.fail(NotAPicture {
            path: &path,
            span: written.span,
        });
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
        Err(reason) => checker.fail(BadPicture {
            path: &file.name,
            reason: &reason,
            span: written.span,
        }),
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

#[derive(Violation)]
#[violation(E304, "`{text}` is not a result of a procedure")]
#[help("name a procedure and its result, as in `hit.max_displacement`")]
struct ResultWanted<'a> {
    #[label("not a result")]
    span: Span,
    text: &'a str,
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
        .filter(|reference| reference.part == ResultPart::Value);
    match reference {
        Some(reference) => Some(reference),
        None => checker.fail(ResultWanted {
            span: written.span,
            text: checker.text(written.span),
        }),
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

fn every_figure(procedures: &[(usize, Option<Procedure>)]) -> Vec<Figure> {
    let of = |(index, (_, procedure)): (usize, &(usize, Option<Procedure>))| {
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
    procedures: &[(usize, Option<Procedure>)],
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

#[derive(Violation)]
#[violation(E304, "`{text}` is not a figure of a procedure")]
#[help(
    "write a figure with its procedure, as in `energy(hit)`, or several, as in `displacement(first, second)`"
)]
struct FigureWanted<'a> {
    #[label("not a figure")]
    span: Span,
    text: &'a str,
}

#[derive(Violation)]
#[violation(E205, "unknown figure `{name}`")]
#[help("{}", suggestion(name, known))]
struct UnknownFigure<'a, I: IntoIterator<Item = &'static str>> {
    name: &'a str,
    #[label("unknown figure")]
    span: Span,
    known: I,
}

/// `energy(hit)`, or `displacement(paused, moving)`: several on one chart.
fn figure(
    checker: &mut Checker,
    written: &Expr,
    procedures: &[(usize, Option<Procedure>)],
) -> Option<Figure> {
    let ExprKind::Call { name, arguments } = &written.kind else {
        return match written.kind {
            ExprKind::Faulty => None,
            _ => checker.fail(FigureWanted {
                span: written.span,
                text: checker.text(written.span),
            }),
        };
    };
    let Some(kind) = FigureKind::ALL
        .into_iter()
        .find(|kind| kind.name() == name.node)
    else {
        return checker.fail(UnknownFigure {
            name: &name.node,
            span: name.span,
            known: FigureKind::ALL.map(FigureKind::name),
        });
    };
    if arguments.is_empty() {
        return checker.fail(FigureWanted {
            span: written.span,
            text: checker.text(written.span),
        });
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

#[derive(Violation)]
#[violation(E304, "`{name}` is not a procedure")]
#[help("write the name of a procedure, as in `energy(hit)`")]
struct ProcedureWanted<'a> {
    name: &'a str,
    #[label("has no figures")]
    span: Span,
}

struct FigureOfOtherProcedure<'a, I: Iterator<Item = &'a str>> {
    figure: &'a str,
    procedure: &'a str,
    span: Span,
    drawn: I,
}

impl<'a, I: Iterator<Item = &'a str>> Violation for FigureOfOtherProcedure<'a, I> {
    const CODE: Code = E205;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            figure,
            procedure,
            span,
            drawn,
        } = self;
        let drawn: Vec<&str> = drawn.collect();
        let help = if drawn.is_empty() {
            "remove it; such a procedure has no figures".to_owned()
        } else {
            format!("known figures: {}", one_of(drawn))
        };
        Diagnostic::new(
            Self::CODE,
            format!("`{procedure}` has no figure `{figure}`"),
        )
        .at(span, "unknown for this procedure")
        .help(help)
    }
}

/// The procedure that a figure names, if it has such a figure.
fn drawn_of(
    checker: &mut Checker,
    kind: FigureKind,
    figure: Span,
    argument: &Expr,
    procedures: &[(usize, Option<Procedure>)],
) -> Option<ProcedureId> {
    let ExprKind::Name(of) = &argument.kind else {
        return checker.fail(FigureWanted {
            span: figure,
            text: checker.text(figure),
        });
    };
    let span = argument.span;
    let block = match checker.scope.meaning(of) {
        Some(Meaning::Poisoned) => return None,
        Some(Meaning::Block(block)) => block,
        Some(Meaning::Value(_)) => return checker.fail(ProcedureWanted { name: of, span }),
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
            return checker.fail(UnknownProcedure {
                name: of,
                span,
                known: &known,
            });
        }
    };
    let Some(procedure) = checker.scope.blocks[block].procedure else {
        return checker.fail(ProcedureWanted { name: of, span });
    };
    let drawn = crate::procedures::facts_of(&procedures.get(procedure.0)?.1.as_ref()?.kind).figures;
    if !drawn.contains(&kind) {
        let words = checker.scope.blocks[block].kind.words();
        let drawn = drawn.iter().map(|kind| kind.name());
        return checker.fail(FigureOfOtherProcedure {
            figure: kind.name(),
            procedure: &words,
            span: figure,
            drawn,
        });
    }
    Some(procedure)
}

/// A figure that procedures cannot share.
struct FigureOfOne<'a, I: Iterator<Item = &'a str>> {
    figure: &'a str,
    procedure: &'a str,
    span: Span,
    shared: I,
}

impl<'a, I: Iterator<Item = &'a str>> Violation for FigureOfOne<'a, I> {
    const CODE: Code = E651;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            figure,
            procedure,
            span,
            shared,
        } = self;
        let shared: Vec<&str> = shared.collect();
        let message = format!(
            "`{figure}` has several curves of one `{procedure}`, so it cannot combine procedures"
        );
        let help = if shared.is_empty() {
            format!("write one figure each: `{figure}(one), {figure}(other)`")
        } else {
            format!(
                "write one figure each; these can be combined: {}",
                one_of(shared)
            )
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, "second procedure")
            .help(help)
    }
}

struct FigureOfTwoKinds<'a> {
    figure: &'a str,
    first: Spanned<&'a str>,
    other: Spanned<&'a str>,
}

impl Violation for FigureOfTwoKinds<'_> {
    const CODE: Code = E651;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            figure,
            first,
            other,
        } = self;
        let message = format!(
            "`{figure}` shows different quantities for `{}` and `{}`",
            other.node, first.node
        );
        Diagnostic::new(Self::CODE, message)
            .at(other.span, format!("`{}`", other.node))
            .at(first.span, format!("`{}`", first.node))
            .help("write a figure for each kind of procedure")
    }
}

#[derive(Violation)]
#[violation(E651, "procedure named twice in one chart")]
#[help("name each procedure once")]
struct FigureDrawnTwice {
    #[label("named again")]
    again: Span,
    #[label("first named here")]
    first: Span,
}

#[derive(Violation)]
#[violation(E651, "too many procedures in one chart: {found} (at most {most})")]
#[help("write two figures")]
struct TooManyTogether {
    found: usize,
    most: usize,
    #[label("too many")]
    span: Span,
}

/// Whether these procedures fit on one chart: one curve of each, all of one kind, each once, not too many.
fn together(
    checker: &mut Checker,
    kind: FigureKind,
    drawn: &[ProcedureId],
    arguments: &[Argument],
    procedures: &[(usize, Option<Procedure>)],
) -> Option<()> {
    let of = |procedure: &ProcedureId| {
        procedures
            .get(procedure.0)
            .and_then(|(_, procedure)| procedure.as_ref())
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
        return checker.fail(FigureOfOne {
            figure: kind.name(),
            procedure: keyword,
            span: at(1),
            shared,
        });
    }
    for (index, procedure) in drawn.iter().enumerate().skip(1) {
        let kinds = of(procedure)?;
        if kinds.keyword() != keyword {
            return checker.fail(FigureOfTwoKinds {
                figure: kind.name(),
                first: Spanned::new(keyword, at(0)),
                other: Spanned::new(kinds.keyword(), at(index)),
            });
        }
        if let Some(before) = drawn[..index].iter().position(|other| other == procedure) {
            return checker.fail(FigureDrawnTwice {
                first: at(before),
                again: at(index),
            });
        }
    }
    if drawn.len() > MOST_TOGETHER {
        return checker.fail(TooManyTogether {
            found: drawn.len(),
            most: MOST_TOGETHER,
            span: at(MOST_TOGETHER),
        });
    }
    Some(())
}
