//! The meaning of a name in its context: a sibling field, then a `let`, a `param`, a block; and members of a block,
//! `pendulum.energy`, or of a procedure, `k0.stiffness.u`.

use crate::check::checker::{Checker, Context, Node, Reads, Shape, Typed};
use crate::check::declarations::specimen::{self, frame};
use crate::check::declarations::striker;
use crate::check::scope::Meaning;
use crate::check::violations::{EventWanted, NeedsTheRun};
use crate::check::wording::{owner, suggestion};
use crate::codes::{E203, E206, E304, E403, E641};
use crate::syntax::ast::{Expr, ExprKind, Ident};
use psd_plan::ProcedureBlock;
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference};
use psd_plan::procedures::unload::block as unload;
use psd_plan::schema::study::PROBABILITY;
use psd_plan::schema::{self, BlockKind, Kind};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::suggest::with_article;
use psd_text::units::Dimension;

/// A result of a run that does not unload, with the name that belongs to a run that does, or the reverse.
struct LeftUnderAnotherName<'a> {
    kind: &'a BlockKind,
    name: &'a str,
    now: &'a str,
    span: Span,
}

impl Violation for LeftUnderAnotherName<'_> {
    const CODE: Code = E206;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            kind,
            name,
            now,
            span,
        } = self;
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
            Self::CODE,
            format!("`{name}` is `{now}` here: the `{}` {message}", kind.words()),
        )
        .at(span, format!("the `{}` has `{now}`", kind.words()))
        .help(help)
    }
}

struct BlockForNumber<'a> {
    name: &'a str,
    kind: &'a BlockKind,
    span: Span,
}

impl Violation for BlockForNumber<'_> {
    const CODE: Code = E304;

    fn diagnostic(self) -> Diagnostic {
        let Self { name, kind, span } = self;
        let member = kind.results.iter().chain(kind.exports).next().map_or_else(
            || "a number".to_owned(),
            |result| format!("`{name}.{}`", result.name),
        );
        let block = with_article(&kind.words());
        Diagnostic::new(Self::CODE, format!("`{name}` is {block}, not a number"))
            .at(span, block)
            .help(format!("read one of its values, such as {member}"))
    }
}

/// A result without its procedure.
#[derive(Violation)]
#[violation(E203, "unknown name `{name}`")]
#[help("write the procedure before the result: did you mean `{procedure}.{name}`?")]
struct ResultWithoutProcedure<'a> {
    name: &'a str,
    procedure: &'a str,
    #[label("unknown name")]
    span: Span,
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

/// Words of other languages for a value that is not given.
const NOTHING: [&str; 6] = ["None", "none", "null", "NULL", "nil", "NaN"];

/// `before`: the text before the name on its line. The name of a unit may be separated from its number.
struct UnknownName<'a, I: Iterator<Item = &'a str>> {
    name: &'a str,
    span: Span,
    before: &'a str,
    known: I,
}

impl<'a, I: Iterator<Item = &'a str>> Violation for UnknownName<'a, I> {
    const CODE: Code = E203;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            span,
            before,
            known,
        } = self;
        let help = if name == "g" {
            "write `1 gn` for gravity, as in `sqrt(2 * 1 gn * height)`; `g` is the gram".to_owned()
        } else if let Some(quantity) = quantity_apart(name, before) {
            format!(
                "write `{quantity}`: `{name}` is a unit, and a unit follows its number without spaces inside"
            )
        } else if name == "critical" {
            "write `critical` in `time_step` only; after the run, read `critical_time_step`"
                .to_owned()
        } else if NOTHING.contains(&name) {
            "remove the field: without it, its default applies".to_owned()
        } else if let Some(near) = psd_text::suggest::nearest(name, known) {
            format!("did you mean `{near}`?")
        } else {
            format!("declare it, as in `let {name} = …`, or correct the name")
        };
        Diagnostic::new(Self::CODE, format!("unknown name `{name}`"))
            .at(span, "unknown name")
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E206, "a number has no `{member}`")]
#[help("write only `.u`, the standard uncertainty, after a result")]
struct NoMemberOfNumber<'a> {
    member: &'a str,
    #[label("unknown here")]
    span: Span,
}

#[derive(Violation)]
#[violation(E206, "`{text}` has no uncertainty")]
#[help("write `.u` only after a measured result, such as `k0.stiffness.u`")]
struct NoUncertainty<'a> {
    text: &'a str,
    #[label("not a measured result")]
    span: Span,
}

#[derive(Violation)]
#[violation(E641, "`{result}` exists only for an impact on a frame")]
#[help("write `storeys` in the specimen and `storey = 1` in the impact")]
struct ResultOfAStorey<'a> {
    result: &'a str,
    #[label("not a result here")]
    at: Span,
    #[label("strikes one degree of freedom")]
    head: Span,
}

#[derive(Violation)]
#[violation(E641, "`{result}` does not exist for the unloading of elements")]
#[help("read `residual_drift`: the deformation of each element")]
struct ResultOfFloors<'a> {
    result: &'a str,
    #[label("not a result here")]
    at: Span,
    #[label("unloads elements")]
    head: Span,
}

#[derive(Violation)]
#[violation(E641, "`{result}` exists only for a frame of matrices with `elements`")]
#[help("read `max_base_shear`, or add `elements` to the specimen")]
struct ResultOfElements<'a> {
    result: &'a str,
    #[label("not a result here")]
    at: Span,
    #[label("its frame has no elements")]
    head: Span,
}

#[derive(Violation)]
#[violation(E641, "`{result}` exists only for the unloading of a frame")]
#[help("read `residual_displacement` and `residual_force`")]
struct ResultOfAFrame<'a> {
    result: &'a str,
    #[label("not a result here")]
    at: Span,
    #[label("unloads one degree of freedom")]
    head: Span,
}

#[derive(Violation)]
#[violation(E206, "{} has no `{field}`", owner(kind, name))]
#[help("add the field `{field}` to it")]
struct FieldNotGiven<'a> {
    kind: &'a BlockKind,
    name: Option<&'a Ident>,
    field: &'a str,
    #[label("field not given")]
    span: Span,
}

#[derive(Violation)]
#[violation(E206, "`{written}` is a difference: `-` is a minus sign")]
#[help("did you mean `{meant}`?")]
struct MinusInName<'a> {
    written: &'a str,
    meant: &'a str,
    #[label("`-` is not allowed in names")]
    span: Span,
}

struct UnknownResult<'a> {
    kind: &'a BlockKind,
    name: Option<&'a Ident>,
    member: &'a str,
    span: Span,
}

impl Violation for UnknownResult<'_> {
    const CODE: Code = E206;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            kind,
            name,
            member,
            span,
        } = self;
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
            Self::CODE,
            format!("{} has no {what} `{member}`", owner(kind, name)),
        )
        .at(span, format!("unknown {what}"))
        .help(suggestion(member, known))
    }
}

#[derive(Violation)]
#[violation(E403, "`{text}` is a result, but {what} is fixed before the run")]
#[help("read results only in fields of later procedures and in `require`")]
struct ResultBeforeTheRun<'a> {
    text: &'a str,
    #[label("known only after the run")]
    span: Span,
    what: &'a str,
    #[label("its procedure")]
    procedure: Span,
}

#[derive(Violation)]
#[violation(E403, "`{text}` is a result of the procedure that uses it")]
#[help("read a result of an earlier procedure")]
struct OwnResult<'a> {
    text: &'a str,
    #[label("known only after this procedure")]
    span: Span,
    #[label("this procedure")]
    procedure: Span,
}

#[derive(Violation)]
#[violation(E403, "`{text}` is used before its procedure runs")]
#[help("move that procedure up: procedures run in the order written")]
struct ResultOfLaterProcedure<'a> {
    text: &'a str,
    #[label("used here")]
    span: Span,
    #[label("runs later")]
    procedure: Span,
}

impl<'a> Checker<'a> {
    /// The value of a bare name.
    pub fn name(&mut self, name: &str, span: Span, context: Context) -> Option<Typed> {
        if let Reads::Impact(procedure) = context.reads
            && let Some(block) = self.procedure(procedure)
            && let other = self
                .left_under_another_name(block, name)
                .filter(|last| self.result_of_impact(block, last.name).is_some())
            && let Some(result) = self.result_of_impact(block, name).or(other)
            && (!result.of_storey || self.strikes_a_storey(procedure))
        {
            if result.name != name {
                return self.fail(LeftUnderAnotherName {
                    kind: self.scope.blocks[block].kind,
                    name,
                    now: result.name,
                    span,
                });
            }
            let formula = Formula::Result(ResultReference {
                procedure,
                name: result.name,
                part: ResultPart::Value,
            });
            let shape = if result.list {
                Shape::List
            } else {
                Shape::Number
            };
            return Some(Typed {
                shape,
                ..Typed::number(formula, result.dimension, span)
            });
        }
        if let Some((block, own)) = context.entry
            && let Some(entry) = self.sibling(block, own, name)
        {
            let typed = self.entry(block, entry, span)?;
            return self.reads_allowed(typed, span, context);
        }
        if name == "critical" && context.critical {
            return Some(Typed::number(
                Formula::CriticalTimeStep,
                Dimension::TIME,
                span,
            ));
        }
        let meaning = self.scope.meaning(name);
        if let Some(value) = schema::constant(name).filter(|_| meaning.is_none()) {
            return Some(Typed {
                bare: true,
                ..Typed::number(Formula::Constant(value), Dimension::NUMBER, span)
            });
        }
        match meaning {
            Some(Meaning::Poisoned) => None,
            Some(Meaning::Value(index)) if self.is_section(index) => {
                self.used.insert(index);
                self.section_for_number(span)
            }
            Some(Meaning::Value(index)) => {
                let typed = self.declared_value(index, span)?;
                self.reads_allowed(
                    Typed {
                        span,
                        bare: false,
                        ..typed
                    },
                    span,
                    context,
                )
            }
            Some(Meaning::Block(index)) => {
                let block = &self.scope.blocks[index];
                self.fail(BlockForNumber {
                    name,
                    kind: block.kind,
                    span,
                })
            }
            None if self.may_be_lost(name) => None,
            None => {
                let owner = self
                    .scope
                    .procedures()
                    .find(|(_, block)| block.kind.result(name).is_some());
                if let Some(owner) = owner
                    .and_then(|(_, block)| block.name)
                    .filter(|_| matches!(context.reads, Reads::All))
                {
                    return self.fail(ResultWithoutProcedure {
                        name,
                        procedure: &owner.node,
                        span,
                    });
                }
                let siblings = context
                    .entry
                    .map_or(&[][..], |(block, _)| &self.scope.blocks[block].block.fields);
                let known = siblings
                    .iter()
                    .map(|entry| entry.key.node.as_str())
                    .filter(|key| *key != name)
                    .chain(self.names_to_suggest());
                // After an impact its results have separate names.
                let known: Vec<&str> = known.collect();
                let (results, storey) = match context.reads {
                    Reads::Impact(procedure) => (
                        schema::block(Kind::Procedure(ProcedureBlock::Impact)).results,
                        self.strikes_a_storey(procedure),
                    ),
                    _ => (&[][..], false),
                };
                let results = results
                    .iter()
                    .filter(|result| !result.of_storey || storey)
                    .map(|result| result.name);
                let diagnostic = UnknownName {
                    name,
                    span,
                    before: self.before(span),
                    known: known.into_iter().chain(results),
                }
                .diagnostic();
                self.fail(diagnostic)
            }
        }
    }

    /// The text before a span on its line.
    fn before(&self, span: Span) -> &'a str {
        let text = &self.sources.file(span.file).text;
        let before = &text[..text.floor_char_boundary(span.range().start)];
        before.rsplit('\n').next().unwrap_or_default()
    }

    /// The entry `name` of a block, if it is numeric and not the entry that reads it.
    fn sibling(&self, block: usize, own: usize, name: &str) -> Option<usize> {
        let declared = &self.scope.blocks[block];
        declared
            .kind
            .field(name)
            .filter(|field| field.ty.is_numeric())?;
        declared
            .block
            .fields
            .iter()
            .position(|entry| entry.key.node == name)
            .filter(|entry| *entry != own)
    }

    /// `base.name`
    pub fn field_of(
        &mut self,
        base: &'a Expr,
        name: &Ident,
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        if let Some(section) = self.section_of(base) {
            if let ExprKind::Name(owner) = &base.kind
                && let Some(Meaning::Value(index)) = self.scope.meaning(owner)
            {
                // Its own context is that of a `let`.
                self.declared_value(index, span);
            }
            return self.value_of_section(section, name, span, context);
        }
        if let ExprKind::Name(owner) = &base.kind
            && let Some(meaning) = self.scope.meaning(owner)
        {
            return match meaning {
                Meaning::Poisoned => None,
                Meaning::Block(block) => {
                    self.used_blocks.insert(block);
                    self.member(block, name, span, context)
                }
                Meaning::Value(_) => self.uncertainty(base, name, span, context),
            };
        }
        if let ExprKind::Name(owner) = &base.kind {
            let is_sibling = context
                .entry
                .is_some_and(|(block, own)| self.sibling(block, own, owner).is_some());
            if !is_sibling {
                let has = |kind: &BlockKind| {
                    kind.result(&name.node).is_some()
                        || kind.export(&name.node).is_some()
                        || kind.field(&name.node).is_some()
                };
                if self.may_be_lost(owner) || self.scope.nameless().any(has) {
                    return None;
                }
                let diagnostic = UnknownName {
                    name: owner,
                    span: base.span,
                    before: self.before(base.span),
                    known: self.names_to_suggest(),
                }
                .diagnostic();
                return self.fail(diagnostic);
            }
        }
        self.uncertainty(base, name, span, context)
    }

    /// `.u` of a result, or of a name for one.
    fn uncertainty(
        &mut self,
        base: &'a Expr,
        name: &Ident,
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        let typed = self.value(base, context)?;
        if name.node != "u" {
            return self.fail(NoMemberOfNumber {
                member: &name.node,
                span: name.span,
            });
        }
        let measured = typed
            .formula
            .as_result()
            .filter(|reference| reference.part == ResultPart::Value)
            .filter(|reference| {
                let kind = self
                    .procedure(reference.procedure)
                    .and_then(|block| self.scope.blocks[block].kind.result(reference.name));
                kind.is_some_and(|kind| kind.measured)
            });
        let Some(reference) = measured else {
            let text = self.text(base.span);
            return self.fail(NoUncertainty {
                text,
                span: name.span,
            });
        };
        let formula = Formula::Result(ResultReference {
            part: ResultPart::Uncertainty,
            ..reference
        });
        Some(Typed {
            shape: typed.shape,
            ..Typed::number(formula, typed.dimension, span)
        })
    }

    /// A member of a block: a result, a derived value, or a field.
    fn member(
        &mut self,
        block: usize,
        name: &Ident,
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        let declared = &self.scope.blocks[block];
        if let Some(now) = self.left_under_another_name(block, &name.node) {
            return self.fail(LeftUnderAnotherName {
                kind: declared.kind,
                name: &name.node,
                now: now.name,
                span: name.span,
            });
        }
        let known = declared.kind.result(&name.node);
        if let (Some(result), Some(procedure)) = (known, declared.procedure) {
            let unloads = declared.kind.kind == Kind::Procedure(ProcedureBlock::Unload);
            if result.of_storey && !unloads && frame::struck_frame(self, block).is_none() {
                let diagnostic = ResultOfAStorey {
                    result: result.name,
                    at: name.span,
                    head: declared.block.head,
                }
                .diagnostic();
                return self.fail(diagnostic);
            }
            if result.of_storey && unloads && !self.tests_a_frame(block) {
                let diagnostic = ResultOfAFrame {
                    result: result.name,
                    at: name.span,
                    head: declared.block.head,
                }
                .diagnostic();
                return self.fail(diagnostic);
            }
            let has_elements = self.tests_elements(block);
            if result.of_elements && has_elements == Some(false) {
                let diagnostic = ResultOfElements {
                    result: result.name,
                    at: name.span,
                    head: declared.block.head,
                }
                .diagnostic();
                return self.fail(diagnostic);
            }
            if unloads
                && result.name == unload::FLOOR_DISPLACEMENT.name
                && has_elements == Some(true)
            {
                let diagnostic = ResultOfFloors {
                    result: result.name,
                    at: name.span,
                    head: declared.block.head,
                }
                .diagnostic();
                return self.fail(diagnostic);
            }
            let reference = ResultReference {
                procedure,
                name: result.name,
                part: ResultPart::Value,
            };
            let outside = self.results.iter().find(|(of, _)| *of == reference);
            if let Some((_, outside)) = outside.cloned() {
                let typed = self.read_again(&outside);
                return Some(Typed { span, ..typed });
            }
            self.read.push((reference, span));
            let formula = Formula::Result(reference);
            let shape = if result.list {
                Shape::List
            } else {
                Shape::Number
            };
            let typed = Typed {
                shape,
                ..Typed::number(formula, result.dimension, span)
            };
            return self.reads_allowed(typed, span, context);
        }
        if let Some(export) = declared.kind.export(&name.node) {
            let formula = match declared.kind.kind {
                Kind::Specimen => specimen::exported(self, block, export.name, span)?,
                Kind::Striker => striker::exported(self, block, export.name)?,
                _ => return None,
            };
            return Some(Typed::number(formula, export.dimension, span));
        }
        if declared
            .kind
            .field(&name.node)
            .is_some_and(|field| field.ty.is_numeric())
        {
            let Some(entry) = declared
                .block
                .fields
                .iter()
                .position(|entry| entry.key.node == name.node)
            else {
                return self.fail(FieldNotGiven {
                    kind: declared.kind,
                    name: declared.name,
                    field: &name.node,
                    span: name.span,
                });
            };
            let typed = self.entry(block, entry, span)?;
            if typed.formula.reads_critical_time_step() {
                return self.fail(NeedsTheRun {
                    span,
                    text: "a time step that depends on `critical`",
                });
            }
            return self.reads_allowed(Typed { span, ..typed }, span, context);
        }
        let (kind, owner) = (declared.kind, declared.name);
        // `hit.max-displacement` is read as a difference, and `psd fmt` writes it as one: `hit.max - displacement`.
        let text = &self.sources.file(name.span.file).text[name.span.range().start..];
        let (end, joined) = with_minus_signs(text);
        if kind.result(&joined).is_some() {
            let whole = Span {
                end: name.span.start + u32::try_from(end).unwrap_or(0),
                ..name.span
            };
            self.explained.push(whole);
            // The same however it is laid out.
            let written: String = text[..end].split_whitespace().collect();
            return self.fail(MinusInName {
                written: &written,
                meant: &joined,
                span: whole,
            });
        }
        if kind.kind == Kind::Study && name.node == PROBABILITY.name {
            return self.fail(EventWanted { span: name.span });
        }
        let diagnostic = UnknownResult {
            kind,
            name: owner,
            member: &name.node,
            span: name.span,
        }
        .diagnostic();
        self.fail(diagnostic)
    }

    /// Whether a procedure strikes one storey of a frame.
    fn strikes_a_storey(&mut self, procedure: ProcedureId) -> bool {
        self.procedure(procedure)
            .is_some_and(|block| frame::struck_frame(self, block).is_some())
    }

    /// Whether a block tests a frame.
    fn tests_a_frame(&mut self, block: usize) -> bool {
        self.tested(block)
            .is_some_and(|specimen| frame::is_frame(self, specimen))
    }

    /// Whether the frame that a block tests has elements; None without a frame.
    fn tests_elements(&mut self, block: usize) -> Option<bool> {
        let specimen = self.tested(block)?;
        let frame = frame::frame(self, specimen)?;
        Some(frame.has_elements())
    }

    /// Checks that every result that a value reads may be read in this context.
    fn reads_allowed(&mut self, typed: Typed, span: Span, context: Context) -> Option<Typed> {
        let mut references = Vec::new();
        typed.formula.collect_references(&mut references);
        for reference in references {
            let owner = self.procedure(reference.procedure)?;
            let head = self.scope.blocks[owner].block.head;
            let text = self.text(span);
            match context.reads {
                Reads::Nothing(what) => {
                    return self.fail(ResultBeforeTheRun {
                        text,
                        span,
                        what,
                        procedure: head,
                    });
                }
                Reads::Before(procedure) | Reads::Impact(procedure)
                    if reference.procedure == procedure =>
                {
                    return self.fail(OwnResult {
                        text,
                        span,
                        procedure: head,
                    });
                }
                Reads::Before(procedure) | Reads::Impact(procedure)
                    if reference.procedure > procedure =>
                {
                    return self.fail(ResultOfLaterProcedure {
                        text,
                        span,
                        procedure: head,
                    });
                }
                Reads::Before(_) | Reads::Impact(_) | Reads::All => {}
            }
        }
        Some(typed)
    }

    /// The block of a procedure.
    pub fn procedure(&self, id: ProcedureId) -> Option<usize> {
        self.scope.procedure(id)
    }

    /// The value of an entry of a block, checked against its field.
    pub fn entry(&mut self, block: usize, entry: usize, requested_at: Span) -> Option<Typed> {
        self.once(Node::Entry { block, entry }, requested_at, |checker| {
            checker.entry_value(block, entry)
        })
    }

    /// The value of a `let` or `param`.
    pub fn declared_value(&mut self, index: usize, requested_at: Span) -> Option<Typed> {
        self.used.insert(index);
        self.once(Node::Value(index), requested_at, |checker| {
            checker.value_of_declaration(index)
        })
    }
}

/// A name with everything that minus signs join to it, with or without spaces: the length in bytes, and the name with underscores.
fn with_minus_signs(text: &str) -> (usize, String) {
    let word = |from: usize| {
        let rest = &text[from..];
        from + rest
            .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(rest.len())
    };
    let blanks = |from: usize, blank: &[char]| {
        from + text[from..].len() - text[from..].trim_start_matches(blank).len()
    };
    let (mut end, mut joined) = (word(0), text[..word(0)].to_owned());
    while text[blanks(end, &[' ', '\t'])..].starts_with('-') {
        // An expression goes on after an operator at the end of its line.
        let begin = blanks(blanks(end, &[' ', '\t']) + 1, &[' ', '\t', '\r', '\n']);
        if word(begin) == begin {
            break;
        }
        end = word(begin);
        joined = format!("{joined}_{}", &text[begin..end]);
    }
    (end, joined)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_minus_signs_is_one_however_it_is_laid_out() {
        for text in [
            "max-displacement < 1 mm",
            "max - displacement < 1 mm",
            "max- displacement",
            "max\t-\tdisplacement",
            "max -\n    displacement",
        ] {
            let (end, joined) = with_minus_signs(text);
            assert!(
                joined == "max_displacement" && text[..end].ends_with("displacement"),
                "{text}: {joined}"
            );
        }
        assert_eq!(with_minus_signs("max - 3 mm"), (7, "max_3".to_owned()));
        assert_eq!(with_minus_signs("max - (a)"), (3, "max".to_owned()));
        assert_eq!(with_minus_signs("max"), (3, "max".to_owned()));
    }
}
