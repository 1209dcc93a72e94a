//! The entries of a block compared with the fields of its kind: unknown, repeated, missing; and their values, typed according to the
//! schema. In: a declared block. Out: formulas and numbers in SI; an omitted field has its default.

use crate::check::checker::{Checker, Context, Node, Reads, Typed};
use crate::check::violations::{MissingField, NeedsTheRun, OutOfRange, UnknownBlockName};
use crate::check::wording::{self, owner, suggestion};
use crate::codes::{E202, E208, E209, E304, E401};
use crate::syntax::ast::{Entry, Expr, ExprKind, Ident};
use psd_plan::ProcedureBlock;
use psd_plan::formula::Formula;
use psd_plan::schema::methods::TIME_STEP;
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::schema::{BlockKind, Field, FieldType, Kind, Presence, RigKind, rig, specimen};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

struct UnknownField<'a> {
    kind: &'a BlockKind,
    key: &'a Ident,
}

impl Violation for UnknownField<'_> {
    const CODE: Code = E202;

    fn diagnostic(self) -> Diagnostic {
        let Self { kind, key } = self;
        let known = kind.fields.iter().map(|field| field.name);
        Diagnostic::new(
            Self::CODE,
            format!("`{}` has no field `{}`", kind.words(), key.node),
        )
        .at(key.span, "unknown field")
        .help(suggestion(&key.node, known))
    }
}

struct FieldTwice<'a> {
    key: &'a Ident,
    first: Span,
}

impl Violation for FieldTwice<'_> {
    const CODE: Code = E208;

    fn diagnostic(self) -> Diagnostic {
        let Self { key, first } = self;
        Diagnostic::new(Self::CODE, format!("field `{}` given twice", key.node))
            .at(key.span, "given again")
            .at(first, "first given here")
            .help("remove one of them")
    }
}

/// A field that only a rig of this kind needs.
#[derive(Violation)]
#[violation(
    E209,
    "{} requires the field `{}` on a {} rig",
    owner(kind, name),
    field.name,
    rig.name()
)]
#[help("add a line such as `{}`", field.example)]
struct MissingFieldOn<'a> {
    rig: RigKind,
    kind: &'a BlockKind,
    name: Option<&'a Ident>,
    #[label("`{}` is missing", field.name)]
    head: Span,
    field: &'a Field,
}

#[derive(Violation)]
#[violation(E401, "`{field}` must be a whole number")]
#[help("write it without decimals")]
struct NotWhole<'a> {
    field: &'a str,
    #[label("`{text}` is not whole")]
    span: Span,
    text: &'a str,
}

#[derive(Violation)]
#[violation(E304, "`{field}` requires a string in quotes")]
#[help("write `\"{text}\"`")]
struct TextWanted<'a> {
    field: &'a str,
    #[label("not a string")]
    span: Span,
    text: &'a str,
}

struct BlockWanted<'a> {
    kind: Kind,
    span: Span,
    text: &'a str,
}

impl Violation for BlockWanted<'_> {
    const CODE: Code = E304;

    fn diagnostic(self) -> Diagnostic {
        let Self { kind, span, text } = self;
        let words = psd_plan::schema::block(kind).words();
        Diagnostic::new(
            Self::CODE,
            format!("expected the name of a {words}, found `{text}`"),
        )
        .at(span, format!("not a {words}"))
        .help(format!("write the name of a `{words}` block"))
    }
}

impl<'a> Checker<'a> {
    /// Reports errors of the set of entries. Each block reads their values itself.
    pub fn entries_of(&mut self, block: usize) {
        let declared = &self.scope.blocks[block];
        let kind = declared.kind;
        let mut meant: Vec<&str> = Vec::new();
        for (index, entry) in declared.block.fields.iter().enumerate() {
            let key = entry.key.node.as_str();
            match kind.field(key) {
                None => {
                    meant.extend(wording::meant(
                        key,
                        kind.fields.iter().map(|field| field.name),
                    ));
                    self.report(UnknownField {
                        kind,
                        key: &entry.key,
                    });
                }
                Some(_) => {
                    if let Some(first) = declared.block.fields[..index]
                        .iter()
                        .find(|other| other.key.node == key)
                    {
                        self.report(FieldTwice {
                            key: &entry.key,
                            first: first.key.span,
                        });
                    }
                }
            }
        }
        let unreadable = self.unreadable(block);
        let rig = if self.real_rig.is_some() {
            RigKind::Real
        } else {
            RigKind::Virtual
        };
        let required = |field: &&Field| match field.presence {
            Presence::Required => true,
            // The missing entries of a rig are reported together.
            Presence::RequiredOn(on, _) => on == rig && kind.kind != Kind::Rig,
            _ => false,
        };
        for field in kind.fields.iter().filter(required) {
            if !meant.contains(&field.name)
                && !unreadable
                && self.field(block, field.name).is_none()
                && !self.replaced(block, field.name)
            {
                let example = self.example_of(block, field);
                self.diagnostics.push(match field.presence {
                    Presence::RequiredOn(rig, _) => MissingFieldOn {
                        rig,
                        kind,
                        name: declared.name,
                        head: declared.block.head,
                        field,
                    }
                    .diagnostic(),
                    _ => MissingField {
                        kind,
                        name: declared.name,
                        head: declared.block.head,
                        field: field.name,
                        example,
                    }
                    .diagnostic(),
                });
            }
        }
    }

    /// An example of the field: for a rig with fields of real rigs only, a real link.
    fn example_of(&self, block: usize, field: &Field) -> &'static str {
        const REAL: &str = "link = serial(port: \"/dev/ttyUSB0\", dialect: native)";
        let is_link =
            self.scope.blocks[block].kind.kind == Kind::Rig && field.name == rig::LINK.name;
        let real = is_link && crate::check::rig::has_fields_of_real_rigs(self, block);
        if real { REAL } else { field.example }
    }

    /// Whether something replaces a field that is required otherwise: storeys or matrices replace a model.
    fn replaced(&self, block: usize, field: &str) -> bool {
        let declared = &self.scope.blocks[block];
        let has = |name: &str| {
            declared
                .block
                .fields
                .iter()
                .any(|entry| entry.key.node == name)
        };
        match declared.kind.kind {
            Kind::Specimen => {
                field == specimen::BEHAVIOUR.name
                    && crate::check::declarations::specimen::frame::FIELDS
                        .iter()
                        .any(|frame| has(frame))
            }
            // The missing parts of a separate load cell are reported instead.
            Kind::Rig => {
                field == rig::LINK.name && (has(rig::ACTUATOR.name) || has(rig::LOAD_CELL.name))
            }
            // Storeys have their own stiffnesses.
            Kind::Procedure(ProcedureBlock::Unload) => {
                field == STIFFNESS.name
                    && self.tested(block).is_some_and(|tested| {
                        crate::check::declarations::specimen::frame::is_frame(self, tested)
                    })
            }
            _ => false,
        }
    }

    /// The entry of a field, with its index among the entries; None if the field is omitted.
    pub fn field(&self, block: usize, field: &str) -> Option<(usize, &'a Entry)> {
        self.scope.blocks[block]
            .block
            .fields
            .iter()
            .enumerate()
            .find(|(_, entry)| entry.key.node == field)
    }

    /// The value of the field, or the head of the block if it is not given.
    pub fn value_or_head(&self, block: usize, field: &str) -> Span {
        self.field(block, field)
            .map_or(self.scope.blocks[block].block.head, |(_, entry)| {
                entry.value.span
            })
    }

    /// Whether an entry of the block is a misspelling of one of these fields, which is reported already.
    pub fn misspelt(&self, block: usize, fields: &[&str]) -> bool {
        let declared = &self.scope.blocks[block];
        let unknown = declared
            .block
            .fields
            .iter()
            .map(|entry| entry.key.node.as_str())
            .filter(|key| declared.kind.field(key).is_none());
        let known = || declared.kind.fields.iter().map(|field| field.name);
        unknown
            .filter_map(|key| wording::meant(key, known()))
            .any(|meant| fields.contains(&meant))
            || self.unreadable(block)
    }

    /// Whether a line of the block could not be parsed, so that fields may only seem to be missing.
    fn unreadable(&self, block: usize) -> bool {
        let span = self.scope.blocks[block].span;
        self.unread
            .iter()
            .any(|line| line.file == span.file && line.start < span.end && span.start < line.end)
    }

    /// The context of an entry of a block: the results that it may read, and whether `critical` has a meaning.
    pub fn context_of(&self, block: usize, entry: usize) -> Context {
        let declared = &self.scope.blocks[block];
        let reads = match (declared.procedure, declared.kind.kind) {
            (Some(procedure), _) => Reads::Before(procedure),
            (None, Kind::Specimen) => Reads::Nothing("a specimen"),
            (None, Kind::Striker) => Reads::Nothing("a striker"),
            (None, Kind::Ground) => Reads::Nothing("a ground motion"),
            (None, Kind::Rig) => Reads::Nothing("a rig"),
            (None, Kind::Limits) => Reads::Nothing("a limit"),
            (None, _) => Reads::Nothing("this field"),
        };
        let critical = matches!(
            declared.kind.kind,
            Kind::Procedure(
                ProcedureBlock::Impact | ProcedureBlock::Escalate | ProcedureBlock::Shake
            )
        ) && declared.block.fields[entry].key.node == TIME_STEP.name;
        Context {
            entry: Some((block, entry)),
            reads,
            critical,
        }
    }

    /// The value of a numeric entry, checked against its field.
    pub fn entry_value(&mut self, block: usize, entry: usize) -> Option<Typed> {
        let declared = &self.scope.blocks[block];
        let written = &declared.block.fields[entry];
        let field = declared.kind.field(&written.key.node)?;
        let context = self.context_of(block, entry);
        self.typed_field(field, &written.value, context)
    }

    /// A number or a list, checked against a field or argument.
    pub fn typed_field(
        &mut self,
        field: &'static Field,
        written: &'a Expr,
        context: Context,
    ) -> Option<Typed> {
        let dimension = field.dimension()?;
        let many = matches!(field.ty, FieldType::Quantities(_));
        let own = if many {
            self.value(written, context)
        } else {
            self.single(written, context)
        };
        let (typed, written) = match self.overridden(field, written) {
            Some(outside) => outside?,
            None => (self.expect(own?, dimension, field.name, written)?, written),
        };
        let parts = typed.parts();
        for (index, part) in parts.iter().enumerate() {
            if let Some(value) = part.constant()
                && !field.range.contains(value)
            {
                let at = entry_span(written, index, parts.len());
                let text = self.text(at);
                return self.fail(OutOfRange {
                    field,
                    dimension,
                    value,
                    text,
                    span: at,
                });
            }
        }
        if matches!(field.ty, FieldType::Count) {
            let Some(value) = typed.constant() else {
                return self.fail(NeedsTheRun {
                    span: written.span,
                    text: self.text(written.span),
                });
            };
            if value.fract() != 0.0 {
                return self.fail(NotWhole {
                    field: field.name,
                    span: written.span,
                    text: self.text(written.span),
                });
            }
        }
        Some(typed)
    }

    /// One number: the entry, else the default. None if it has an error, or if both are missing.
    pub fn quantity(&mut self, block: usize, field: &str) -> Option<Formula> {
        match self.field(block, field) {
            Some((entry, written)) => self
                .entry(block, entry, written.value.span)
                .map(|typed| typed.formula),
            None => self.scope.blocks[block]
                .kind
                .field(field)?
                .default_number()
                .map(Formula::Constant),
        }
    }

    /// A number known before the run.
    pub fn constant(&mut self, block: usize, field: &str) -> Option<f64> {
        let formula = self.quantity(block, field)?;
        let value = formula.constant();
        if value.is_none()
            && let Some((_, written)) = self.field(block, field)
        {
            self.report(NeedsTheRun {
                span: written.value.span,
                text: self.text(written.value.span),
            });
        }
        value
    }

    /// A whole number; its range is the schema's.
    pub fn count(&mut self, block: usize, field: &str) -> Option<u32> {
        self.constant(block, field).and_then(whole)
    }

    /// Some(None) if the field is omitted, None if it has an error.
    pub fn optional(&mut self, block: usize, field: &str) -> Option<Option<Formula>> {
        match self.field(block, field) {
            Some(_) => self.quantity(block, field).map(Some),
            None => Some(None),
        }
    }

    /// The numbers of a list or range.
    pub fn quantities(&mut self, block: usize, field: &str) -> Option<Vec<Formula>> {
        let (entry, written) = self.field(block, field)?;
        self.entry(block, entry, written.value.span)
            .map(|typed| typed.parts())
    }

    /// A string.
    pub fn text_field(&mut self, block: usize, field: &str) -> Option<String> {
        let (_, written) = self.field(block, field)?;
        self.text_value(field, &written.value)
    }

    pub fn text_value(&mut self, field: &str, written: &Expr) -> Option<String> {
        match &written.kind {
            ExprKind::Text(text) => Some(text.clone()),
            ExprKind::Faulty => None,
            _ => self.fail(TextWanted {
                field,
                span: written.span,
                text: self.text(written.span),
            }),
        }
    }

    /// A list of strings; a single string is a list of one.
    pub fn texts(&mut self, block: usize, field: &str) -> Option<Vec<String>> {
        let (_, written) = self.field(block, field)?;
        match &written.value.kind {
            ExprKind::List { items, unit: None } => {
                let texts: Vec<Option<String>> = items
                    .iter()
                    .map(|item| self.text_value(field, item))
                    .collect();
                texts.into_iter().collect()
            }
            _ => self
                .text_value(field, &written.value)
                .map(|text| vec![text]),
        }
    }

    /// The block that a field names.
    pub fn reference(&mut self, block: usize, field: &str, kind: Kind) -> Option<usize> {
        let (_, written) = self.field(block, field)?;
        let span = written.value.span;
        let ExprKind::Name(name) = &written.value.kind else {
            return match written.value.kind {
                ExprKind::Faulty => None,
                _ => self.fail(BlockWanted {
                    kind,
                    span,
                    text: self.text(span),
                }),
            };
        };
        match self.scope.meaning(name) {
            Some(crate::check::scope::Meaning::Block(index))
                if self.scope.blocks[index].kind.kind == kind =>
            {
                Some(index)
            }
            Some(crate::check::scope::Meaning::Poisoned) => None,
            Some(_) => self.fail(BlockWanted {
                kind,
                span,
                text: name,
            }),
            None if self.may_be_lost(name)
                || self
                    .scope
                    .of_kind(kind)
                    .any(|(_, block)| block.lacks_its_name()) =>
            {
                None
            }
            None => {
                let declared = self
                    .scope
                    .of_kind(kind)
                    .filter_map(|(_, block)| block.name)
                    .map(|name| name.node.as_str());
                let known: Vec<&str> = declared.take(self.most_to_suggest()).collect();
                self.fail(UnknownBlockName {
                    kind,
                    name,
                    span,
                    known: &known,
                })
            }
        }
    }

    /// Calls `work` for the entry of a field whose value is not a number, so that a dependency cycle through it is found.
    pub fn within_entry<T>(
        &mut self,
        block: usize,
        field: &str,
        requested_at: Span,
        work: impl FnOnce(&mut Self, &'a Expr, Context) -> Option<T>,
    ) -> Option<T> {
        let (entry, written) = self.field(block, field)?;
        let context = self.context_of(block, entry);
        self.guarded(Node::Entry { block, entry }, requested_at, |checker| {
            work(checker, &written.value, context)
        })
    }
}

/// The span of entry `index` of a list, if its entries are written one by one.
fn entry_span(written: &Expr, index: usize, count: usize) -> Span {
    match &written.kind {
        ExprKind::List { items, .. } if items.len() == count => items[index].span,
        _ => written.span,
    }
}

/// A whole number of at least 0, if it is in range.
pub fn whole(value: f64) -> Option<u32> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked on the left"
    )]
    ((0.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}
