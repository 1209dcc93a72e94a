//! Errors of names: E2xx, and dependency cycles.

mod arguments;
mod figures;
mod results;
mod units;

pub use arguments::*;
pub use figures::*;
pub use results::*;
pub use units::*;

use super::{one_of, owner, suggestion};
use crate::syntax::ast::{Block, Ident};
use crate::syntax::control;
use psd_plan::schema::{BLOCKS, BlockKind, Field, ITEM_WORDS, Kind, Naming, RigKind};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::{FileId, Span};

pub fn unknown_block(block: &Block) -> Diagnostic {
    let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
    if let Some((message, help)) = words
        .first()
        .and_then(|word| control::of_another_language(word))
    {
        return Diagnostic::new(Code::UnknownBlock, message)
            .at(block.words[0].span, "not an item")
            .help(help);
    }
    let keywords: Vec<String> = BLOCKS.iter().map(|block| block.words()).collect();
    let known = || {
        keywords
            .iter()
            .map(String::as_str)
            .chain(ITEM_WORDS.iter().copied())
    };
    // All words but the name, two of them, or the first alone: whichever is most similar to a keyword.
    let near = [words.len().saturating_sub(1).max(1), 2, 1]
        .into_iter()
        .filter(|count| *count <= words.len())
        .find_map(|count| {
            let written = words[..count].join(" ");
            psd_text::suggest::nearest(&written, known()).map(|near| (count, near))
        });
    let turned = words.len() == 2 && keywords.iter().any(|keyword| keyword == words[1]);
    if turned {
        let help = format!("write the kind first: `{} {}`", words[1], words[0]);
        return Diagnostic::new(Code::UnknownBlock, format!("unknown block `{}`", words[0]))
            .at(block.head, "unknown block")
            .help(help);
    }
    let begun = keywords
        .iter()
        .find(|keyword| keyword.split(' ').next() == words.first().copied());
    let (count, help) = match (near, begun) {
        (Some((count, near)), _) => (count, format!("did you mean `{near}`?")),
        (None, Some(keyword)) => (1, format!("did you mean `{keyword}`?")),
        (None, None) => (
            1,
            format!(
                "known blocks: {}",
                one_of(keywords.iter().map(String::as_str))
            ),
        ),
    };
    let written = words[..count].join(" ");
    let span = block.words[0].span.to(block.words[count - 1].span);
    Diagnostic::new(Code::UnknownBlock, format!("unknown block `{written}`"))
        .at(span, "unknown block")
        .help(help)
}

/// The error of the words after the keyword, if any.
pub fn block_name(kind: &BlockKind, block: &Block, rest: &[Ident]) -> Option<Diagnostic> {
    let words = kind.words();
    let example = kind.example.lines().next().unwrap_or_default();
    let wrong = |message: String, span, label: &str| {
        Diagnostic::new(Code::BlockName, message)
            .at(span, label)
            .help(format!("write it as in `{example}`"))
    };
    if let (Some(title), true) = (&block.title, kind.naming != Naming::Titled) {
        return Some(wrong(
            format!("`{words}` requires a title"),
            title.span,
            "title in quotes",
        ));
    }
    match (kind.naming, rest) {
        (Naming::Named, []) => Some(wrong(
            format!("`{words}` requires a name"),
            block.head,
            "name missing",
        )),
        (Naming::Unnamed | Naming::Titled, [name, ..]) => Some(wrong(
            format!("`{words}` takes no name"),
            name.span,
            "extra word",
        )),
        (_, [_, second, ..]) => Some(wrong(
            format!("the name of a `{words}` block is one word"),
            second.span,
            "extra word",
        )),
        _ => None,
    }
}

pub fn not_in_library(what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BlockName,
        format!("`{what}` is not allowed in a shared file"),
    )
    .at(span, "not a declaration")
    .help("move it into the plan; a shared file can have `specimen`, `striker`, `rig`, `limits`, `let`, `param` and `use`")
}

pub fn declared_twice(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::Duplicate, format!("name `{name}` declared twice"))
        .at(span, "declared again")
        .at(first, "first declared here")
        .help("rename one of them")
}

pub fn block_twice(kind: &BlockKind, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::Duplicate, format!("two `{}` blocks", kind.words()))
        .at(span, "second block")
        .at(first, "first block")
        .help("combine their fields in one block")
}

pub fn field_twice(key: &Ident, first: Span) -> Diagnostic {
    Diagnostic::new(Code::Duplicate, format!("field `{}` given twice", key.node))
        .at(key.span, "given again")
        .at(first, "first given here")
        .help("remove one of them")
}

pub fn argument_twice(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::Duplicate, format!("argument `{name}` given twice"))
        .at(span, "given again")
        .at(first, "first given here")
        .help("remove one of them")
}

/// Both, by the fields that give them, as written.
pub fn velocity_twice(again: &str, span: Span, first_field: &str, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("velocity given twice: by `{first_field}` and by `{again}`"),
    )
    .at(span, "given again")
    .at(first, "first given here")
    .help("remove one of them")
}

pub fn unknown_field(kind: &BlockKind, key: &Ident) -> Diagnostic {
    let known = kind.fields.iter().map(|field| field.name);
    Diagnostic::new(
        Code::UnknownField,
        format!("`{}` has no field `{}`", kind.words(), key.node),
    )
    .at(key.span, "unknown field")
    .help(suggestion(&key.node, known))
}

pub fn missing_field(
    kind: &BlockKind,
    name: Option<&Ident>,
    head: Span,
    field: &str,
    example: &str,
) -> Diagnostic {
    Diagnostic::new(
        Code::MissingField,
        format!("{} requires the field `{field}`", owner(kind, name)),
    )
    .at(head, format!("`{field}` is missing"))
    .help(format!("add a line such as `{example}`"))
}

/// A field that only a rig of this kind needs.
pub fn missing_field_on(
    rig: RigKind,
    kind: &BlockKind,
    name: Option<&Ident>,
    head: Span,
    field: &Field,
) -> Diagnostic {
    Diagnostic::new(
        Code::MissingField,
        format!(
            "{} requires the field `{}` on a {} rig",
            owner(kind, name),
            field.name,
            rig.name()
        ),
    )
    .at(head, format!("`{}` is missing", field.name))
    .help(format!("add a line such as `{}`", field.example))
}

pub fn mass_incomplete(name: Option<&Ident>, head: Span, missing: &str) -> Diagnostic {
    let name = name.map_or("", |name| name.node.as_str());
    Diagnostic::new(
        Code::MissingField,
        format!("mass of specimen `{name}` unknown: {missing} missing"),
    )
    .at(head, format!("`{missing}` is missing"))
    .help(format!(
        "add `{missing}`, or the `mass` itself: density * area * length / 2 is the mass"
    ))
}

pub fn missing_block(kind: &BlockKind, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::MissingBlock,
        format!("the plan has no `{}` block", kind.words()),
    )
    .at(span, format!("requires a `{}`", kind.words()))
    .help(format!("add one, such as\n{}", kind.example))
}

/// `before`: the text before the name on its line. The name of a unit may be separated from its number.
pub fn unknown_name<'n>(
    name: &str,
    span: Span,
    before: &str,
    known: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    let help = if name == "g" {
        "write `1 gn` for gravity, as in `sqrt(2 * 1 gn * height)`; `g` is the gram".to_owned()
    } else if let Some(quantity) = quantity_apart(name, before) {
        format!(
            "write `{quantity}`: `{name}` is a unit, and a unit follows its number without spaces inside"
        )
    } else if name == "critical" {
        "write `critical` in `time_step` only; after the run, read `critical_time_step`".to_owned()
    } else if let Some(near) = psd_text::suggest::nearest(name, known) {
        format!("did you mean `{near}`?")
    } else {
        format!("declare it, as in `let {name} = …`, or correct the name")
    };
    Diagnostic::new(Code::UnknownName, format!("unknown name `{name}`"))
        .at(span, "unknown name")
        .help(help)
}

/// `1 m/s` for `1 m / s`, and `10 mm` for `10 * mm`, where the last word is a unit.
fn quantity_apart(name: &str, before: &str) -> Option<String> {
    psd_text::units::unit::lookup(name)?;
    let before = before.trim_end().trim_end_matches('(').trim_end();
    let sign = before
        .chars()
        .next_back()
        .filter(|sign| matches!(sign, '*' | '/'))?;
    let before = before[..before.len() - 1].trim_end();
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let first = before
        .rfind(|c: char| c.is_whitespace() || matches!(c, '(' | '[' | ',' | ':'))
        .map_or(0, |at| at + 1);
    let (head, last) = (before[..first].trim_end(), &before[first..]);
    if is_number(last) {
        return (sign == '*').then(|| format!("{last} {name}"));
    }
    let number = head
        .rsplit(|c: char| c.is_whitespace() || matches!(c, '(' | '[' | ',' | ':'))
        .next()?;
    let unit = psd_text::units::unit::parse(last).is_ok() && is_number(number);
    unit.then(|| format!("{number} {last}{sign}{name}"))
}

/// The name of a requirement identifies its verdict.
pub fn requirement_twice(label: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("two requirements are named \"{label}\""),
    )
    .at(span, "named again")
    .at(first, "first named here")
    .help("rename one, or join their conditions with `and`")
}

pub fn unknown_block_name(kind: Kind, name: &str, span: Span, known: &[&str]) -> Diagnostic {
    let block = psd_plan::schema::block(kind);
    let help = if known.is_empty() {
        format!("declare one, as in\n{}", block.example)
    } else {
        suggestion(name, known.iter().copied())
    };
    Diagnostic::new(
        Code::UnknownName,
        format!("unknown {} `{name}`", block.words()),
    )
    .at(span, "unknown name")
    .help(help)
}

pub fn unknown_procedure(name: &str, span: Span, known: &[&str]) -> Diagnostic {
    Diagnostic::new(Code::UnknownName, format!("unknown procedure `{name}`"))
        .at(span, "unknown name")
        .help(suggestion(name, known.iter().copied()))
}

pub fn unknown_parameter(name: &str, known: &[&str]) -> Diagnostic {
    let help = if known.is_empty() {
        "remove `--set`; the plan has no `param`".to_owned()
    } else {
        suggestion(name, known.iter().copied())
    };
    Diagnostic::new(
        Code::UnknownParameter,
        format!("`--set {name}`: unknown parameter `{name}`"),
    )
    .help(help)
}

pub fn setting_is_no_value(name: &str, file: FileId, length: usize) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("`--set {name}` requires one value"))
        .at(Span::new(file, 0, length), "more than a value")
        .help(format!("write it as in `--set {name}=\"1.5 m/s\"`"))
}

/// `requested_at` closes the cycle.
pub fn cycle(cycle: &[(String, Span)], requested_at: Span) -> Diagnostic {
    let first = cycle.first().map_or("", |(name, _)| name.as_str());
    let names = cycle
        .iter()
        .map(|(name, _)| name.as_str())
        .chain([first])
        .collect::<Vec<_>>()
        .join(" → ");
    let diagnostic = Diagnostic::new(Code::Cycle, format!("circular definition: {names}"))
        .at(requested_at, "closes the circle");
    cycle
        .iter()
        .fold(diagnostic, |diagnostic, (name, span)| {
            diagnostic.at(*span, format!("`{name}` is part of it"))
        })
        .help("write a value for one of them")
}
