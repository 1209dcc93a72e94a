//! The specimen that a procedure tests: the one that it names, else the only one declared. In: a block. Out: its specimen, or an error.

use crate::check::wording::one_of;
use crate::codes::{E201, E210, E601};
use crate::syntax::ast::ExprKind;
use psd_plan::formula::Formula;
use psd_plan::schema::procedures::{SPECIMEN, STIFFNESS};
use psd_plan::schema::{self, BlockKind, Kind};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

use super::checker::Checker;
use super::declarations::specimen::export as specimen_export;
use super::scope::{DeclaredBlock, Meaning};

/// Most spans of repeated declarations that are shown.
const SHOWN: usize = 20;

/// `declared`: the first [`SHOWN`] of `several`.
struct SeveralSpecimens<'a> {
    head: Span,
    declared: &'a [(String, Span)],
    several: usize,
}

impl Violation for SeveralSpecimens<'_> {
    const CODE: Code = E601;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            head,
            declared,
            several,
        } = self;
        let diagnostic = Diagnostic::new(
            Self::CODE,
            "specimen not specified: the plan declares several",
        )
        .at(head, "specimen missing");
        let lines: Vec<String> = declared
            .iter()
            .map(|(name, _)| format!("specimen = {name}"))
            .collect();
        let more = if several > SHOWN {
            format!(", or one of {} more", several - SHOWN)
        } else {
            String::new()
        };
        let help = format!(
            "add a line {}{more}",
            one_of(lines.iter().map(String::as_str))
        );
        declared
            .iter()
            .fold(diagnostic, |diagnostic, (name, span)| {
                diagnostic.at(*span, format!("`{name}` is one"))
            })
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E210, "the plan has no `{}` block", kind.words())]
#[help("add one, such as\n{}", kind.example)]
struct MissingBlock<'a> {
    kind: &'a BlockKind,
    #[label("requires a `{}`", kind.words())]
    span: Span,
}

impl Checker<'_> {
    /// `stiffness`, or on a simulated rig the initial one of the `specimen` block. On a real rig it is required; its absence is an error
    /// already.
    pub fn stiffness_or_specimens(
        &mut self,
        block: usize,
        specimen: Option<usize>,
    ) -> Option<Formula> {
        if self.field(block, STIFFNESS.name).is_some() {
            return self.quantity(block, STIFFNESS.name);
        }
        if self.real_rig.is_some() {
            return None;
        }
        let head = self.scope.blocks[block].block.head;
        specimen_export(self, specimen?, STIFFNESS.name, head).map(Formula::Constant)
    }

    /// The specimen of a procedure, as its index in the plan.
    pub fn specimen_of(&mut self, block: usize) -> Option<usize> {
        self.specimen_block(block)
            .map(|specimen| self.scope.index_in_kind(specimen))
    }

    /// The specimen a procedure names, else the only one declared.
    pub fn specimen_block(&mut self, block: usize) -> Option<usize> {
        if self.field(block, SPECIMEN.name).is_some() {
            return self.reference(block, SPECIMEN.name, Kind::Specimen);
        }
        let mut declared = self.scope.of_kind(Kind::Specimen);
        match (declared.len(), declared.next()) {
            (1, Some((only, _))) => Some(only),
            (_, None) => {
                self.specimen_needed(block);
                None
            }
            (several, _) => {
                let head = self.scope.blocks[block].block.head;
                let named = |(_, specimen): (usize, &DeclaredBlock<'_>)| {
                    (
                        specimen.name.map(|name| name.node.clone()),
                        specimen.block.head,
                    )
                };
                let declared = self
                    .scope
                    .of_kind(Kind::Specimen)
                    .map(named)
                    .filter_map(|(name, head)| Some((name?, head)));
                let shown: Vec<_> = declared.take(SHOWN).collect();
                self.fail(SeveralSpecimens {
                    head,
                    declared: &shown,
                    several,
                })
            }
        }
    }

    /// The same without diagnostics, which the check of the block itself makes.
    pub fn tested(&self, block: usize) -> Option<usize> {
        let mut declared = self.scope.of_kind(Kind::Specimen);
        let Some((_, written)) = self.field(block, SPECIMEN.name) else {
            return declared
                .next()
                .filter(|_| declared.len() == 0)
                .map(|(only, _)| only);
        };
        let ExprKind::Name(name) = &written.value.kind else {
            return None;
        };
        match self.scope.meaning(name) {
            Some(Meaning::Block(index)) if self.scope.blocks[index].kind.kind == Kind::Specimen => {
                Some(index)
            }
            _ => None,
        }
    }

    /// Reports once that there is no specimen.
    pub fn specimen_needed(&mut self, block: usize) {
        let none = self.scope.of_kind(Kind::Specimen).next().is_none();
        // A block with an unknown keyword may be the missing one.
        let is_reported = self
            .diagnostics
            .iter()
            .any(|diagnostic| matches!(diagnostic.code, E210 | E201));
        if none && !is_reported && !self.names_lost && self.unread.is_empty() {
            let head = self.scope.blocks[block].block.head;
            self.report(MissingBlock {
                kind: schema::block(Kind::Specimen),
                span: head,
            });
        }
    }
}
