//! Faults of names: E2xx, and rings of names.

use std::sync::LazyLock;

use super::{one_of, suggestion};
use crate::language::syntax::ast::{Block, Ident};
use crate::language::syntax::control;
use crate::schema::{
    BLOCKS, BlockKind, FUNCTIONS, Field, FunctionKind, ITEM_WORDS, Kind, Naming, Need, RigKind,
    Variant,
};
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::{FileId, Span};
use crate::units::unit::{PREFIXES, UNITS};

fn owner(kind: &BlockKind, name: Option<&Ident>) -> String {
    name.map_or_else(
        || format!("`{}`", kind.words()),
        |name| format!("{} `{}`", kind.words(), name.node),
    )
}

pub fn unknown_block(block: &Block) -> Diagnostic {
    let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
    if let Some((message, help)) = words
        .first()
        .and_then(|word| control::of_another_language(word))
    {
        return Diagnostic::new(Code::UnknownBlock, message)
            .at(block.words[0].span, "begins no item")
            .help(help);
    }
    let keywords: Vec<String> = BLOCKS
        .iter()
        .filter(|block| block.kind != Kind::Later)
        .map(|block| block.words())
        .collect();
    let known = || {
        keywords
            .iter()
            .map(String::as_str)
            .chain(ITEM_WORDS.iter().copied())
    };
    // All words but the name, two of them, or the first alone: whichever is nearest to a keyword.
    let near = [words.len().saturating_sub(1).max(1), 2, 1]
        .into_iter()
        .filter(|count| *count <= words.len())
        .find_map(|count| {
            let written = words[..count].join(" ");
            crate::text::suggest::nearest(&written, known()).map(|near| (count, near))
        });
    let turned = words.len() == 2 && keywords.iter().any(|keyword| keyword == words[1]);
    if turned {
        let help = format!("its kind stands first: write `{} {}`", words[1], words[0]);
        return Diagnostic::new(
            Code::UnknownBlock,
            format!("no block is called `{}`", words[0]),
        )
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
    Diagnostic::new(
        Code::UnknownBlock,
        format!("no block is called `{written}`"),
    )
    .at(span, "unknown block")
    .help(help)
}

pub fn block_of_later_version(kind: &BlockKind, block: &Block) -> Diagnostic {
    let last = kind.keyword.len().clamp(1, block.words.len()) - 1;
    let span = block.words[0].span.to(block.words[last].span);
    Diagnostic::new(
        Code::NotInThisVersion,
        format!("`{}` is not in this version", kind.words()),
    )
    .at(span, "a block of a later version")
    .help(format!("remove this `{}` block", kind.words()))
}

pub fn field_of_later_version(kind: &BlockKind, field: &Field, key: &Ident) -> Diagnostic {
    Diagnostic::new(
        Code::NotInThisVersion,
        format!(
            "the field `{}` of `{}` is not in this version",
            field.name,
            kind.words()
        ),
    )
    .at(key.span, "a field of a later version")
    .help(format!("remove `{}`", field.name))
}

/// What is wrong with the words after the keyword, if something is.
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
            format!("a `{words}` block has no title"),
            title.span,
            "a text in quotes",
        ));
    }
    match (kind.naming, rest) {
        (Naming::Named, []) => Some(wrong(
            format!("this `{words}` block has no name"),
            block.head,
            "a name is missing",
        )),
        (Naming::Unnamed | Naming::Titled, [name, ..]) => Some(wrong(
            format!("a `{words}` block takes no name"),
            name.span,
            "one word too many",
        )),
        (_, [_, second, ..]) => Some(wrong(
            format!("a `{words}` block has one name of one word"),
            second.span,
            "one word too many",
        )),
        _ => None,
    }
}

pub fn not_in_library(what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BlockName,
        format!("`{what}` stands in a used file, where only declarations may stand"),
    )
    .at(span, "belongs into the plan itself")
    .help("a used file holds `specimen`, `striker`, `rig`, `limits`, `let`, `param` and `use`")
}

pub fn declared_twice(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("the name `{name}` is declared twice"),
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("give one of them another name")
}

pub fn block_twice(kind: &BlockKind, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("there are two `{}` blocks", kind.words()),
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("put their fields into one block")
}

pub fn field_twice(key: &Ident, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("the field `{}` is given twice", key.node),
    )
    .at(key.span, "again here")
    .at(first, "first here")
    .help("remove one of them")
}

pub fn argument_twice(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("the argument `{name}` is given twice"),
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("remove one of them")
}

/// Both by the fields that give it, as they were written.
pub fn velocity_twice(again: &str, span: Span, first_field: &str, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("the velocity is given twice: by `{first_field}` and by `{again}`"),
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("remove one of them")
}

pub fn unknown_field(kind: &BlockKind, key: &Ident) -> Diagnostic {
    let known = kind
        .fields
        .iter()
        .filter(|field| field.available)
        .map(|field| field.name);
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
        format!("{} lacks the field `{field}`", owner(kind, name)),
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
            "{} lacks the field `{}`, which a {} rig needs",
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
        format!("specimen `{name}` lacks `{missing}` to work out its mass"),
    )
    .at(head, format!("`{missing}` is missing"))
    .help(format!(
        "give `{missing}`, or the `mass` itself: density * area * length / 2 is the mass"
    ))
}

pub fn missing_block(kind: &BlockKind, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::MissingBlock,
        format!("the plan has no `{}` block", kind.words()),
    )
    .at(span, format!("this needs a `{}`", kind.words()))
    .help(format!("add one such as\n{}", kind.example))
}

/// `before`: what stands before the name on its line. A name that is a unit was written apart from its number.
pub fn unknown_name<'n>(
    name: &str,
    span: Span,
    before: &str,
    known: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    let help = if name == "g" {
        "`g` is the gram; gravity is `1 gn`, as in `sqrt(2 * 1 gn * height)`".to_owned()
    } else if let Some(quantity) = quantity_apart(name, before) {
        format!(
            "`{name}` is a unit, and a unit is one word without blanks behind its number: write `{quantity}`"
        )
    } else if name == "critical" {
        "`critical` stands only in `time_step`; after the run it is the result `critical_time_step`"
            .to_owned()
    } else if let Some(near) = crate::text::suggest::nearest(name, known) {
        format!("did you mean `{near}`?")
    } else {
        format!("declare it, as in `let {name} = …`, or correct the name")
    };
    Diagnostic::new(Code::UnknownName, format!("nothing is called `{name}`"))
        .at(span, "unknown name")
        .help(help)
}

/// A result without the procedure that it is of.
pub fn result_without_procedure(name: &str, procedure: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownName, format!("nothing is called `{name}`"))
        .at(span, "unknown name")
        .help(format!(
            "a result is read from its procedure: did you mean `{procedure}.{name}`?"
        ))
}

/// A result of a run that does not unload by the name of one that does, or the other way round.
pub fn left_under_another_name(kind: &BlockKind, name: &str, now: &str, span: Span) -> Diagnostic {
    let unloads = now.starts_with("residual");
    let message = if unloads {
        "takes the load off"
    } else {
        "ends under load"
    };
    let help = match (unloads, kind.kind) {
        (true, _) => format!("read `{now}`"),
        (false, Kind::Escalate) => format!("read `{now}`, or write `between = unload`"),
        (false, _) => {
            format!("read `{now}`, or unload first: `unload rest {{ }}`, then `rest.{name}`")
        }
    };
    Diagnostic::new(
        Code::UnknownResult,
        format!(
            "`{name}` is called `{now}` here, where the `{}` {message}",
            kind.words()
        ),
    )
    .at(span, format!("the `{}` has `{now}`", kind.words()))
    .help(help)
}

/// `1 m/s` of `1 m / s`, and `10 mm` of `10 * mm`, where the last word is a unit.
fn quantity_apart(name: &str, before: &str) -> Option<String> {
    crate::units::unit::lookup(name)?;
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
    let unit = crate::units::unit::parse(last).is_ok() && is_number(number);
    unit.then(|| format!("{number} {last}{sign}{name}"))
}

/// A requirement's name is what its verdict is found by.
pub fn requirement_twice(label: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("two requirements are called \"{label}\""),
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("give each a name of its own, or join their conditions with `and`")
}

pub fn unknown_block_name(kind: Kind, name: &str, span: Span, known: &[&str]) -> Diagnostic {
    let block = crate::schema::block(kind);
    let help = if known.is_empty() {
        format!("declare one, as in\n{}", block.example)
    } else {
        suggestion(name, known.iter().copied())
    };
    Diagnostic::new(
        Code::UnknownName,
        format!("no {} is called `{name}`", block.words()),
    )
    .at(span, "unknown name")
    .help(help)
}

pub fn unknown_procedure(name: &str, span: Span, known: &[&str]) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownName,
        format!("no procedure is called `{name}`"),
    )
    .at(span, "unknown name")
    .help(suggestion(name, known.iter().copied()))
}

/// Units as a sentence names them.
const SPELT_OUT: &[(&str, &str)] = &[
    ("percent pct", "%"),
    ("meter metre meters metres", "m"),
    ("millimeter millimetre millimeters millimetres", "mm"),
    ("micron microns", "um"),
    ("gram grams", "g"),
    ("kilogram kilograms kgs", "kg"),
    ("tonne tonnes ton tons", "t"),
    ("sec secs second seconds", "s"),
    ("msec millisecond milliseconds", "ms"),
    ("minute minutes mins", "min"),
    ("hour hours hr hrs", "h"),
    ("newton newtons", "N"),
    ("kilonewton kilonewtons", "kN"),
    ("pascal pascals", "Pa"),
    ("joule joules", "J"),
    ("hertz cps", "Hz"),
    ("inch inches", "in"),
    ("foot feet", "ft"),
    ("lbs pound pounds", "lb"),
    ("degree degrees", "deg"),
    ("mps", "m/s"),
];

/// `kN*m` of `kNm`.
fn unit_product(name: &str) -> Option<String> {
    let dimension = |part: &str| crate::units::unit::lookup(part).map(|unit| unit.dimension);
    // `mmm` is a slip, and no area.
    let product = |(one, other): &(&str, &str)| {
        dimension(one)
            .zip(dimension(other))
            .is_some_and(|(one, other)| one != other)
    };
    let (first, second) = (1..name.len())
        .filter_map(|at| name.split_at_checked(at))
        .find(product)?;
    Some(format!("{first}*{second}"))
}

pub fn unknown_unit(name: &str, span: Span) -> Diagnostic {
    static KNOWN: LazyLock<Vec<String>> = LazyLock::new(|| {
        let plain = UNITS.iter().map(|unit| unit.symbol.to_owned());
        let prefixed = UNITS.iter().filter(|unit| unit.prefixes);
        let prefixed = prefixed.flat_map(|unit| {
            PREFIXES
                .iter()
                .map(move |(prefix, _)| format!("{prefix}{}", unit.symbol))
        });
        plain.chain(prefixed).collect()
    });
    let same_letters = KNOWN
        .iter()
        .find(|unit| unit.eq_ignore_ascii_case(name))
        .map(String::as_str);
    let spelt_out = SPELT_OUT
        .iter()
        .find(|(words, _)| words.split(' ').any(|word| word.eq_ignore_ascii_case(name)))
        .map(|(_, unit)| *unit);
    let product = unit_product(name);
    let near = same_letters.or(spelt_out).or(product.as_deref());
    let near =
        near.or_else(|| crate::text::suggest::nearest(name, KNOWN.iter().map(String::as_str)));
    let help = near.map_or_else(
        || {
            format!(
                "known units: {}; SI prefixes may stand before the SI ones",
                one_of(UNITS.iter().map(|unit| unit.symbol))
            )
        },
        |near| format!("did you mean `{near}`?"),
    );
    Diagnostic::new(Code::UnknownUnit, format!("no unit is called `{name}`"))
        .at(span, "unknown unit")
        .help(help)
}

pub fn name_glued_to_unit(name: &str, span: Span, mended: &str) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownUnit,
        format!("`{name}` is a name of the plan, not a unit"),
    )
    .at(span, "read as part of the unit")
    .help(format!("put blanks around the operator: `{mended}`"))
}

pub fn unknown_variant(field: &str, name: &str, span: Span, variants: &[Variant]) -> Diagnostic {
    let known = variants.iter().map(|variant| variant.name);
    Diagnostic::new(Code::UnknownVariant, format!("`{field}` knows no `{name}`"))
        .at(span, "unknown word")
        .help(suggestion(name, known))
}

pub fn unknown_figure(
    name: &str,
    span: Span,
    known: impl IntoIterator<Item = &'static str>,
) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownVariant,
        format!("no figure is called `{name}`"),
    )
    .at(span, "unknown figure")
    .help(suggestion(name, known))
}

/// E651 from here on: procedures that cannot stand on one chart.
pub fn figure_of_one<'n>(
    figure: &str,
    procedure: &str,
    span: Span,
    shared: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    let shared: Vec<&str> = shared.collect();
    let message = format!(
        "`{figure}` draws several curves of one `{procedure}`: it is a figure of one procedure"
    );
    let help = if shared.is_empty() {
        format!("write a figure for each: `{figure}(one), {figure}(other)`")
    } else {
        format!(
            "write a figure for each; on one chart can stand {}",
            one_of(shared)
        )
    };
    Diagnostic::new(Code::NotTogether, message)
        .at(span, "a second procedure")
        .help(help)
}

pub fn figure_of_two_kinds(figure: &str, first: (&str, Span), other: (&str, Span)) -> Diagnostic {
    let message = format!(
        "`{figure}` shows another thing of `{}` than of `{}`",
        other.0, first.0
    );
    Diagnostic::new(Code::NotTogether, message)
        .at(other.1, format!("`{}`", other.0))
        .at(first.1, format!("`{}`", first.0))
        .help("one chart shows procedures of one kind: write a figure for each kind")
}

pub fn figure_drawn_twice(first: Span, again: Span) -> Diagnostic {
    Diagnostic::new(Code::NotTogether, "the same procedure twice on one chart")
        .at(again, "drawn a second time")
        .at(first, "drawn here already")
        .help("name each procedure once")
}

pub fn too_many_together(found: usize, most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NotTogether,
        format!("{found} procedures on one chart; more than {most} cannot be told apart"),
    )
    .at(span, "one too many")
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
        format!("it draws {}", one_of(drawn))
    };
    Diagnostic::new(
        Code::UnknownVariant,
        format!("a `{procedure}` has no figure `{figure}`"),
    )
    .at(span, "not drawn by this procedure")
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
    let what = if kind.procedure { "result" } else { "value" };
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
        format!("`{written}` is read as a difference: a `-` is a minus sign"),
    )
    .at(span, "no name has a `-`")
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
        format!("{} does not give `{field}`", owner(kind, name)),
    )
    .at(span, "not given there")
    .help(format!("add the field `{field}` to it"))
}

pub fn property_without_behaviour(name: Option<&Ident>, property: &str, span: Span) -> Diagnostic {
    let name = name.map_or("", |name| name.node.as_str());
    Diagnostic::new(Code::UnknownResult, format!("specimen `{name}` has no `{property}`: no `behaviour` gives it"))
        .at(span, "not known before it is measured")
        .help("read the result of a `stiffness ramp`, as in `k0.stiffness`, or give the `behaviour` that is expected")
}

pub fn no_uncertainty(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownResult, format!("`{text}` has no uncertainty"))
        .at(span, "only a measured result has `.u`")
        .help("`.u` follows a result that was fitted, such as `k0.stiffness.u`")
}

pub fn no_member_of_number(member: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownResult, format!("a number has no `{member}`"))
        .at(span, "unknown here")
        .help("only `.u`, the standard uncertainty, may follow a result")
}

pub fn unknown_function(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownFunction,
        format!("no function is called `{name}`"),
    )
    .at(span, "unknown function")
    .help(suggestion(
        name,
        FUNCTIONS.iter().map(|function| function.name),
    ))
}

pub fn function_argument_with_name(function: &str, name: &Ident) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        format!("the arguments of `{function}` have no names"),
    )
    .at(name.span, "a name")
    .help(format!("remove `{}:`", name.node))
}

pub fn function_arguments(kind: &FunctionKind, found: usize, span: Span) -> Diagnostic {
    let wanted = if kind.many {
        "at least one value"
    } else {
        "one value"
    };
    Diagnostic::new(
        Code::BadArgument,
        format!("`{}` takes {wanted}, found {found}", kind.name),
    )
    .at(span, format!("{found} values"))
    .help(format!("write it as in `{}(x)`", kind.name))
}

pub fn unknown_argument(variant: &Variant, name: Option<&str>, span: Span) -> Diagnostic {
    let known: Vec<&str> = variant
        .arguments
        .iter()
        .map(|argument| argument.name)
        .collect();
    let (message, help) = match name {
        Some(name) => (
            format!("`{}` has no argument `{name}`", variant.name),
            suggestion(name, known),
        ),
        None if known.is_empty() => (
            format!("`{}` takes no arguments", variant.name),
            format!("write `{}` alone", variant.name),
        ),
        None => {
            let (arguments, they) = if known.len() == 1 {
                ("one argument".to_owned(), "it is")
            } else {
                (format!("{} arguments", known.len()), "they are")
            };
            (
                format!("`{}` takes at most {arguments}", variant.name),
                format!("{they} {}", super::all_of(known)),
            )
        }
    };
    Diagnostic::new(Code::BadArgument, message)
        .at(span, "not an argument of it")
        .help(help)
}

/// How a missing argument is given: the whole call where it is short, `within(displacement: 0.01 mm, force_rate: 5 N/s)`,
/// else the argument alone.
fn argument_help(variant: &Variant, missing: &Field) -> String {
    let required: Vec<&Field> = variant
        .arguments
        .iter()
        .filter(|argument| argument.need == Need::Required)
        .collect();
    let written = |argument: &Field| {
        let named = argument.example.starts_with(&format!("{}:", argument.name));
        if named || required.len() == 1 {
            argument.example.to_owned()
        } else {
            format!("{}: {}", argument.name, argument.example)
        }
    };
    if required.len() > 2 {
        return format!("add it between the brackets, as in `{}`", written(missing));
    }
    let arguments: Vec<String> = required.iter().map(|argument| written(argument)).collect();
    format!(
        "write it as in `{}({})`",
        variant.name,
        arguments.join(", ")
    )
}

pub fn missing_argument(variant: &Variant, field: &Field, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        format!("`{}` lacks its argument `{}`", variant.name, field.name),
    )
    .at(span, format!("`{}` is missing", field.name))
    .help(argument_help(variant, field))
}

pub fn argument_needs(variant: &str, argument: &str, other: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        format!("`{argument}` of `{variant}` needs `{other}` beside it"),
    )
    .at(span, format!("`{other}` is missing"))
    .help(format!("give `{other}: …` too, or remove `{argument}`"))
}

pub fn unknown_parameter(name: &str, known: &[&str]) -> Diagnostic {
    let help = if known.is_empty() {
        "the plan has no `param`".to_owned()
    } else {
        suggestion(name, known.iter().copied())
    };
    Diagnostic::new(
        Code::UnknownParameter,
        format!("`--set {name}`: no parameter is called `{name}`"),
    )
    .help(help)
}

pub fn setting_is_no_value(name: &str, file: FileId, length: usize) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("`--set {name}` wants one value"))
        .at(Span::new(file, 0, length), "more than a value")
        .help(format!("write it as in `--set {name}=\"1.5 m/s\"`"))
}

/// `asked_at` is the place that closes the ring.
pub fn cycle(ring: &[(String, Span)], asked_at: Span) -> Diagnostic {
    let first = ring.first().map_or("", |(name, _)| name.as_str());
    let names = ring
        .iter()
        .map(|(name, _)| name.as_str())
        .chain([first])
        .collect::<Vec<_>>()
        .join(" → ");
    let fault = Diagnostic::new(
        Code::Cycle,
        format!("these values need each other in a ring: {names}"),
    )
    .at(asked_at, "closes the ring");
    ring.iter()
        .fold(fault, |fault, (name, span)| {
            fault.at(*span, format!("`{name}` is in the ring"))
        })
        .help("give one of them a value of its own")
}
