//! Errors of results and of other members of a block.

use crate::check::messages::{owner, suggestion};
use crate::syntax::ast::Ident;
use psd_plan::ProcedureBlock;
use psd_plan::schema::{BlockKind, Kind};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

/// A result without its procedure.
pub fn result_without_procedure(name: &str, procedure: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownName, format!("unknown name `{name}`"))
        .at(span, "unknown name")
        .help(format!(
            "write the procedure before the result: did you mean `{procedure}.{name}`?"
        ))
}

/// A result of a run that does not unload, with the name that belongs to a run that does, or the reverse.
pub fn left_under_another_name(kind: &BlockKind, name: &str, now: &str, span: Span) -> Diagnostic {
    let unloads = now.starts_with("residual");
    let message = if unloads {
        "unloads the specimen"
    } else {
        "ends under load"
    };
    let help = match (unloads, kind.kind) {
        (true, _) => format!("read `{now}`"),
        (false, Kind::Procedure(ProcedureBlock::Escalate)) => {
            format!("read `{now}`, or write `between = unload`")
        }
        (false, _) => {
            format!("read `{now}`, or unload first: `unload rest {{ }}`, then `rest.{name}`")
        }
    };
    Diagnostic::new(
        Code::UnknownResult,
        format!("`{name}` is `{now}` here: the `{}` {message}", kind.words()),
    )
    .at(span, format!("the `{}` has `{now}`", kind.words()))
    .help(help)
}

pub fn unknown_result(
    kind: &BlockKind,
    name: Option<&Ident>,
    member: &str,
    span: Span,
) -> Diagnostic {
    let known: Vec<&str> = kind
        .results
        .iter()
        .chain(kind.exports)
        .map(|result| result.name)
        .collect();
    let what = if kind.is_procedure() {
        "result"
    } else {
        "value"
    };
    Diagnostic::new(
        Code::UnknownResult,
        format!("{} has no {what} `{member}`", owner(kind, name)),
    )
    .at(span, format!("unknown {what}"))
    .help(suggestion(member, known))
}

pub fn minus_in_name(written: &str, meant: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownResult,
        format!("`{written}` is a difference: `-` is a minus sign"),
    )
    .at(span, "`-` is not allowed in names")
    .help(format!("did you mean `{meant}`?"))
}

pub fn field_not_given(
    kind: &BlockKind,
    name: Option<&Ident>,
    field: &str,
    span: Span,
) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownResult,
        format!("{} has no `{field}`", owner(kind, name)),
    )
    .at(span, "field not given")
    .help(format!("add the field `{field}` to it"))
}

pub fn property_without_behaviour(name: Option<&Ident>, property: &str, span: Span) -> Diagnostic {
    let name = name.map_or("", |name| name.node.as_str());
    Diagnostic::new(Code::UnknownResult, format!("specimen `{name}` has no `{property}` without a `behaviour`"))
        .at(span, "unknown before the run")
        .help("read the result of a `stiffness ramp`, such as `k0.stiffness`, or add the expected `behaviour`")
}

pub fn no_uncertainty(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownResult, format!("`{text}` has no uncertainty"))
        .at(span, "not a measured result")
        .help("write `.u` only after a measured result, such as `k0.stiffness.u`")
}

pub fn no_member_of_number(member: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownResult, format!("a number has no `{member}`"))
        .at(span, "unknown here")
        .help("write only `.u`, the standard uncertainty, after a result")
}
