//! What the files declare: blocks, values and requirements, by name, each name once. In: the syntax trees. Out: a
//! [`Scope`]. It evaluates nothing.

use std::collections::BTreeMap;

use super::faults::names as fault;
use crate::diagnostic::Diagnostic;
use crate::formula::ProcedureId;
use crate::schema::{self, BlockKind, Kind, Naming};
use crate::source::{FileId, Span, Spanned};
use crate::syntax::ast::{Ast, Block, Expr, Ident, ItemKind};

/// A block of a kind that this version knows.
pub struct DeclaredBlock<'a> {
    pub kind: &'static BlockKind,
    pub name: Option<&'a Ident>,
    pub block: &'a Block,
    /// The whole item.
    pub span: Span,
    /// Its place among the procedures.
    pub procedure: Option<ProcedureId>,
}

impl DeclaredBlock<'_> {
    /// Whether it should have a name and has none, which is told: what is called by a name may be this one.
    pub fn lacks_its_name(&self) -> bool {
        self.name.is_none() && self.kind.naming == Naming::Named
    }
}

/// A `let` or a `param`.
pub struct DeclaredValue<'a> {
    pub keyword: &'static str,
    pub name: &'a Ident,
    pub value: &'a Expr,
    pub bounds: Option<&'a Expr>,
    /// The value `--set` gives in its place.
    pub setting: Option<&'a Expr>,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    Value(usize),
    Block(usize),
    /// Declared by something that is faulty in itself: say no more of it.
    Poisoned,
}

pub struct DeclaredRequirement<'a> {
    pub label: &'a Spanned<String>,
    pub condition: &'a Expr,
}

#[derive(Default)]
pub struct Scope<'a> {
    pub blocks: Vec<DeclaredBlock<'a>>,
    pub values: Vec<DeclaredValue<'a>>,
    pub requirements: Vec<DeclaredRequirement<'a>>,
    names: BTreeMap<&'a str, (Meaning, Span)>,
    procedures: usize,
}

impl<'a> Scope<'a> {
    /// Declares all that the files say; `settings` are the values given by `--set`, by name.
    pub fn collect(asts: &'a [Ast], settings: &'a BTreeMap<String, Expr>, faults: &mut Vec<Diagnostic>) -> Self {
        let mut scope = Self::default();
        for ast in asts {
            let library = ast.file != FileId(0);
            for item in &ast.items {
                match &item.kind {
                    ItemKind::Use { .. } => {}
                    ItemKind::Let { name, value } => scope.declare_value("let", name, value, None, None, faults),
                    ItemKind::Param { name, value, bounds } => {
                        scope.declare_value("param", name, value, bounds.as_ref(), settings.get(&name.node), faults);
                    }
                    ItemKind::Require { label, .. } if library => faults.push(fault::not_in_library("require", label.span)),
                    ItemKind::Require { label, condition } => scope.require(label, condition, faults),
                    ItemKind::Block(block) => scope.declare_block(block, item.span, library, faults),
                }
            }
        }
        scope
    }

    pub fn meaning(&self, name: &str) -> Option<Meaning> {
        self.names.get(name).map(|(meaning, _)| *meaning)
    }

    /// Every declared name, for suggestions.
    pub fn names(&self) -> impl Iterator<Item = &'a str> {
        self.names.keys().copied()
    }

    pub fn of_kind(&self, kind: Kind) -> impl Iterator<Item = (usize, &DeclaredBlock<'a>)> {
        self.blocks.iter().enumerate().filter(move |(_, block)| block.kind.kind == kind)
    }

    /// Place of a block among those of its own kind.
    pub fn place_in_kind(&self, block: usize) -> usize {
        let kind = self.blocks[block].kind.kind;
        self.blocks[..block].iter().filter(|other| other.kind.kind == kind).count()
    }

    pub fn procedures(&self) -> impl Iterator<Item = (usize, &DeclaredBlock<'a>)> {
        self.blocks.iter().enumerate().filter(|(_, block)| block.procedure.is_some())
    }

    fn require(&mut self, label: &'a Spanned<String>, condition: &'a Expr, faults: &mut Vec<Diagnostic>) {
        if let Some(first) = self.requirements.iter().find(|first| first.label.node == label.node) {
            faults.push(fault::requirement_twice(&label.node, label.span, first.label.span));
        }
        self.requirements.push(DeclaredRequirement { label, condition });
    }

    fn declare(&mut self, name: &'a Ident, meaning: Meaning, faults: &mut Vec<Diagnostic>) {
        match self.names.get(name.node.as_str()) {
            Some((before, first)) => {
                faults.push(fault::declared_twice(&name.node, name.span, *first));
                // Which of two things of different sorts is meant, nobody knows.
                if std::mem::discriminant(before) != std::mem::discriminant(&meaning) {
                    self.names.insert(&name.node, (Meaning::Poisoned, *first));
                }
            }
            None => {
                self.names.insert(&name.node, (meaning, name.span));
            }
        }
    }

    fn declare_value(
        &mut self,
        keyword: &'static str,
        name: &'a Ident,
        value: &'a Expr,
        bounds: Option<&'a Expr>,
        setting: Option<&'a Expr>,
        faults: &mut Vec<Diagnostic>,
    ) {
        self.declare(name, Meaning::Value(self.values.len()), faults);
        self.values.push(DeclaredValue { keyword, name, value, bounds, setting });
    }

    fn declare_block(&mut self, block: &'a Block, span: Span, library: bool, faults: &mut Vec<Diagnostic>) {
        let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
        let Some(kind) = schema::block_of_words(&words) else {
            faults.push(fault::unknown_block(block));
            // Kind and name may stand in each other's place.
            let turned = block.words.len() == 2 && schema::block_of_words(&[block.words[1].node.as_str(), "_"]).is_some();
            self.poison(if turned { &block.words[..1] } else { &block.words[1..] }, faults);
            return;
        };
        let rest = &block.words[kind.keyword.len()..];
        if kind.kind == Kind::Later {
            faults.push(fault::block_of_later_version(kind, block));
            self.poison(rest, faults);
            return;
        }
        if library && !matches!(kind.kind, Kind::Specimen | Kind::Striker | Kind::Ground | Kind::Rig | Kind::Limits) {
            faults.push(fault::not_in_library(&kind.words(), block.head));
            self.poison(rest, faults);
            return;
        }
        // A head that could not be read to its end has more words than are known.
        let cut_short = faults
            .iter()
            .filter_map(Diagnostic::span)
            .any(|at| at.file == block.head.file && (block.head.start..=block.head.end + 1).contains(&at.start));
        if let Some(wrong) = fault::block_name(kind, block, rest).filter(|_| !cut_short) {
            faults.push(wrong);
        } else if let (Naming::Unnamed | Naming::Titled | Naming::MaybeNamed, []) = (kind.naming, rest)
            && let Some(first) = self.unnamed(kind, span)
        {
            faults.push(fault::block_twice(kind, block.head, first));
            return;
        }
        if let Some(name) = rest.first() {
            self.declare(name, Meaning::Block(self.blocks.len()), faults);
        }
        let procedure = kind.procedure.then_some(ProcedureId(self.procedures));
        self.procedures += usize::from(kind.procedure);
        self.blocks.push(DeclaredBlock { kind, name: rest.first(), block, span, procedure });
    }

    /// The block without a name of this kind that stands in the same file already.
    fn unnamed(&self, kind: &BlockKind, span: Span) -> Option<Span> {
        let same = |other: &&DeclaredBlock| other.kind.kind == kind.kind && other.name.is_none() && other.span.file == span.file;
        self.blocks.iter().find(same).map(|other| other.block.head)
    }

    fn poison(&mut self, words: &'a [Ident], faults: &mut Vec<Diagnostic>) {
        if let Some(name) = words.last() {
            self.declare(name, Meaning::Poisoned, faults);
        }
    }
}
