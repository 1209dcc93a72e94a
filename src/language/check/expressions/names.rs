//! The meaning of a name in its context: a sibling field, then a `let`, a `param`, a block; and members of a block,
//! `pendulum.energy`, or of a procedure, `k0.stiffness.u`.

use crate::check::checker::{Checker, Context, Node, Reads, Shape, Typed};
use crate::check::declarations::specimen::{self, frame};
use crate::check::declarations::striker;
use crate::check::messages::{frames, names as message, studies, types, values};
use crate::check::scope::Meaning;
use crate::syntax::ast::{Expr, ExprKind, Ident};
use psd_plan::ProcedureBlock;
use psd_plan::formula::{Formula, Part, ProcedureId, ResultReference};
use psd_plan::schema::study::PROBABILITY;
use psd_plan::schema::{self, BlockKind, Kind};
use psd_text::source::Span;
use psd_text::units::Dimension;

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
                return self.fail(message::left_under_another_name(
                    self.scope.blocks[block].kind,
                    name,
                    result.name,
                    span,
                ));
            }
            let formula = Formula::Result(ResultReference {
                procedure,
                name: result.name,
                part: Part::Value,
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
        match self.scope.meaning(name) {
            Some(Meaning::Poisoned) => None,
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
                self.fail(types::block_for_number(name, block.kind, span))
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
                    return self.fail(message::result_without_procedure(name, &owner.node, span));
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
                let diagnostic = message::unknown_name(
                    name,
                    span,
                    self.before(span),
                    known.into_iter().chain(results),
                );
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
        if let ExprKind::Name(owner) = &base.kind
            && let Some(meaning) = self.scope.meaning(owner)
        {
            return match meaning {
                Meaning::Poisoned => None,
                Meaning::Block(block) => self.member(block, name, span, context),
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
                let diagnostic = message::unknown_name(
                    owner,
                    base.span,
                    self.before(base.span),
                    self.names_to_suggest(),
                );
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
            return self.fail(message::no_member_of_number(&name.node, name.span));
        }
        let measured = typed
            .formula
            .as_result()
            .filter(|reference| reference.part == Part::Value)
            .filter(|reference| {
                let kind = self
                    .procedure(reference.procedure)
                    .and_then(|block| self.scope.blocks[block].kind.result(reference.name));
                kind.is_some_and(|kind| kind.measured)
            });
        let Some(reference) = measured else {
            let text = self.text(base.span);
            return self.fail(message::no_uncertainty(text, name.span));
        };
        let formula = Formula::Result(ResultReference {
            part: Part::Uncertainty,
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
            return self.fail(message::left_under_another_name(
                declared.kind,
                &name.node,
                now.name,
                name.span,
            ));
        }
        let known = declared.kind.result(&name.node);
        if let (Some(result), Some(procedure)) = (known, declared.procedure) {
            let unloads = declared.kind.kind == Kind::Procedure(ProcedureBlock::Unload);
            if result.of_storey && !unloads && frame::struck_frame(self, block).is_none() {
                let diagnostic =
                    frames::result_of_a_storey(result.name, name.span, declared.block.head);
                return self.fail(diagnostic);
            }
            if result.of_storey && unloads && !self.tests_a_frame(block) {
                let diagnostic =
                    frames::result_of_a_frame(result.name, name.span, declared.block.head);
                return self.fail(diagnostic);
            }
            let reference = ResultReference {
                procedure,
                name: result.name,
                part: Part::Value,
            };
            let outside = self.results.iter().find(|(of, _)| *of == reference);
            if let Some((_, outside)) = outside {
                return Some(Typed {
                    span,
                    ..outside.clone()
                });
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
                return self.fail(message::field_not_given(
                    declared.kind,
                    declared.name,
                    &name.node,
                    name.span,
                ));
            };
            let typed = self.entry(block, entry, span)?;
            if typed.formula.reads_critical_time_step() {
                return self.fail(values::needs_the_run(
                    span,
                    "a time step that depends on `critical`",
                ));
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
            return self.fail(message::minus_in_name(&written, &joined, whole));
        }
        if kind.kind == Kind::Study && name.node == PROBABILITY.name {
            return self.fail(studies::event_wanted(name.span));
        }
        let diagnostic = message::unknown_result(kind, owner, &name.node, name.span);
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
                    return self.fail(values::result_before_the_run(text, span, what, head));
                }
                Reads::Before(procedure) | Reads::Impact(procedure)
                    if reference.procedure == procedure =>
                {
                    return self.fail(values::own_result(text, span, head));
                }
                Reads::Before(procedure) | Reads::Impact(procedure)
                    if reference.procedure > procedure =>
                {
                    return self.fail(values::result_of_later_procedure(text, span, head));
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
