//! Errors of figures: an unknown one, and procedures that cannot share a chart.

use crate::check::messages::{one_of, suggestion};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::{Span, Spanned};

pub fn unknown_figure(
    name: &str,
    span: Span,
    known: impl IntoIterator<Item = &'static str>,
) -> Diagnostic {
    Diagnostic::new(Code::UnknownVariant, format!("unknown figure `{name}`"))
        .at(span, "unknown figure")
        .help(suggestion(name, known))
}

/// E651 from here on: procedures that cannot share a chart.
pub fn figure_of_one<'n>(
    figure: &str,
    procedure: &str,
    span: Span,
    shared: impl Iterator<Item = &'n str>,
) -> Diagnostic {
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
    Diagnostic::new(Code::NotTogether, message)
        .at(span, "second procedure")
        .help(help)
}

pub fn figure_of_two_kinds(figure: &str, first: Spanned<&str>, other: Spanned<&str>) -> Diagnostic {
    let message = format!(
        "`{figure}` shows different quantities for `{}` and `{}`",
        other.node, first.node
    );
    Diagnostic::new(Code::NotTogether, message)
        .at(other.span, format!("`{}`", other.node))
        .at(first.span, format!("`{}`", first.node))
        .help("write a figure for each kind of procedure")
}

pub fn figure_drawn_twice(first: Span, again: Span) -> Diagnostic {
    Diagnostic::new(Code::NotTogether, "procedure named twice in one chart")
        .at(again, "named again")
        .at(first, "first named here")
        .help("name each procedure once")
}

pub fn too_many_together(found: usize, most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NotTogether,
        format!("too many procedures in one chart: {found} (at most {most})"),
    )
    .at(span, "too many")
    .help("write two figures")
}

pub fn figure_of_other_procedure<'n>(
    figure: &str,
    procedure: &str,
    span: Span,
    drawn: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    let drawn: Vec<&str> = drawn.collect();
    let help = if drawn.is_empty() {
        "remove it; such a procedure has no figures".to_owned()
    } else {
        format!("known figures: {}", one_of(drawn))
    };
    Diagnostic::new(
        Code::UnknownVariant,
        format!("`{procedure}` has no figure `{figure}`"),
    )
    .at(span, "unknown for this procedure")
    .help(help)
}
