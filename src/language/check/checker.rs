//! What every part of the check shares: the files, the scope, the faults so far, and values already worked out.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::Loader;
use super::expressions::data::DataFile;
use super::messages::{names as fault, values};
use super::scope::Scope;
use crate::language::syntax::ast::Expr;
use crate::plan::Frame;
use crate::plan::formula::{Formula, ProcedureId, ResultReference};
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{Sources, Span};
use crate::units::Dimension;

/// A place that has a value: a `let` or `param`, or an entry of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Node {
    Value(usize),
    Entry { block: usize, entry: usize },
}

/// One number or several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Number,
    List,
}

/// A checked expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Typed {
    pub formula: Formula,
    pub shape: Shape,
    pub dimension: Dimension,
    pub span: Span,
    /// A number written without a unit (or a list of such), which may be a forgotten one.
    pub bare: bool,
    /// Written with `%`.
    pub percent: bool,
}

/// Which results an expression may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// None: it is fixed before the run. The text says what it is: "a specimen".
    Nothing(&'static str),
    /// Those of procedures that ran before this one.
    Before(ProcedureId),
    /// Those of the blow that is just over, by their own names, and those of procedures that ran before this one.
    Blow(ProcedureId),
    All,
}

/// Where an expression stands.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The block and its entry.
    pub entry: Option<(usize, usize)>,
    pub reads: Reads,
    /// Whether `critical` has a meaning here.
    pub critical: bool,
}

pub struct Checker<'a> {
    pub sources: &'a Sources,
    pub scope: &'a Scope<'a>,
    pub loader: &'a dyn Loader,
    /// Data files that the plan names, each once.
    pub data: Vec<DataFile>,
    /// Frames of the specimens that have storeys, by their blocks; None of one with a fault.
    pub frames: BTreeMap<usize, Option<Rc<Frame>>>,
    pub faults: Vec<Diagnostic>,
    /// Whether names may be missing because a used file could not be read.
    pub names_lost: bool,
    /// Lines that could not be read: names on them may be declared there.
    pub unread: Vec<Span>,
    /// Every word of those lines.
    lost: BTreeSet<&'a str>,
    /// What was reported of the behaviour of each block.
    reported: BTreeMap<usize, Vec<Diagnostic>>,
    /// Places of which all is said.
    pub explained: Vec<Span>,
    pub known: BTreeMap<Node, Option<Typed>>,
    pub used: BTreeSet<usize>,
    /// Results of procedures that something reads, and where.
    pub read: Vec<(ResultReference, Span)>,
    /// Entries taken of lists that the run gives, as they are counted from 0, and where.
    pub taken: Vec<(ResultReference, usize, Span)>,
    /// Whether the plan is of a record, and may call things as older versions did.
    pub recorded: bool,
    /// The rig of the run, where it is one that moves a specimen.
    pub real_rig: Option<usize>,
    stack: Vec<Node>,
    /// Whether it was said that values need one another too deep.
    too_deep: bool,
}

/// Values that need one another, one inside another, before they are worked out: each takes of the stack.
pub const DEEPEST_VALUES: usize = 100;
/// Results and operators of one value that is known after the run only, those of the values it names counted in: such a value
/// is copied wherever it is named, and `let b = a + a` doubles it.
pub const MOST_TERMS: usize = 1_000;

/// Faults after which no other name is suggested for an unknown one.
const SUGGESTED: usize = 50;

impl<'a> Checker<'a> {
    pub fn new(
        sources: &'a Sources,
        scope: &'a Scope<'a>,
        loader: &'a dyn Loader,
        faults: Vec<Diagnostic>,
        unread: Vec<Span>,
        names_lost: bool,
    ) -> Self {
        let (known, used, stack) = (BTreeMap::new(), BTreeSet::new(), Vec::new());
        let (data, frames) = (Vec::new(), BTreeMap::new());
        let words = |span: &Span| {
            sources
                .text(*span)
                .split(|c: char| !c.is_alphanumeric() && c != '_')
        };
        let lost = unread.iter().flat_map(words).collect();
        Self {
            sources,
            scope,
            loader,
            data,
            frames,
            faults,
            names_lost,
            unread,
            lost,
            reported: BTreeMap::new(),
            explained: Vec::new(),
            known,
            used,
            read: Vec::new(),
            taken: Vec::new(),
            recorded: false,
            real_rig: None,
            stack,
            too_deep: false,
        }
    }

    /// Notes a fault; returns None, so that a caller can leave with it.
    pub fn fail<T>(&mut self, fault: Diagnostic) -> Option<T> {
        self.faults.push(fault);
        None
    }

    pub fn text(&self, span: Span) -> &'a str {
        self.sources.text(span)
    }

    /// Works a node out once. A node that needs itself is a fault that names the ring.
    pub fn once(
        &mut self,
        node: Node,
        asked_at: Span,
        work: impl FnOnce(&mut Self) -> Option<Typed>,
    ) -> Option<Typed> {
        if let Some(known) = self.known.get(&node) {
            return known.clone();
        }
        self.guarded(node, asked_at, |checker| {
            let value = work(checker).and_then(|typed| checker.of_bounded_size(typed));
            checker.known.insert(node, value.clone());
            value
        })
    }

    fn of_bounded_size(&mut self, typed: Typed) -> Option<Typed> {
        if typed.formula.terms() <= MOST_TERMS {
            return Some(typed);
        }
        self.fail(values::too_many_terms(typed.span, MOST_TERMS))
    }

    /// Does `work` for a node, unless it is being done already further up.
    pub fn guarded<T>(
        &mut self,
        node: Node,
        asked_at: Span,
        work: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if let Some(start) = self.stack.iter().position(|open| *open == node) {
            let ring: Vec<(String, Span)> = self.stack[start..]
                .iter()
                .map(|node| self.describe(*node))
                .collect();
            for node in self.stack[start..].iter().copied() {
                self.known.insert(node, None);
            }
            return self.fail(fault::cycle(&ring, asked_at));
        }
        if self.stack.len() >= DEEPEST_VALUES {
            // Once: where one chain is too deep, each of its pieces is.
            if !std::mem::replace(&mut self.too_deep, true) {
                self.faults.push(values::too_deep(asked_at, DEEPEST_VALUES));
            }
            self.known.insert(node, None);
            return None;
        }
        self.stack.push(node);
        let value = work(self);
        self.stack.pop();
        value
    }

    /// Whether a name may have been declared where the text could not be read.
    pub fn may_be_lost(&self, name: &str) -> bool {
        self.names_lost || self.lost.contains(name)
    }

    /// Names of which one that is unknown may be a slip; none where many faults were found, for each name is looked at each time.
    pub fn names_to_suggest(&self) -> impl Iterator<Item = &'a str> {
        self.scope.names().take(self.most_to_suggest())
    }

    /// Of how many names one is suggested for one that is unknown.
    pub const fn most_to_suggest(&self) -> usize {
        if self.faults.len() <= SUGGESTED {
            usize::MAX
        } else {
            0
        }
    }

    /// Drops faults from `start` on that were reported of this block before.
    pub fn drop_repeated(&mut self, start: usize, block: usize) {
        let before = self.reported.entry(block).or_default();
        for fault in self.faults.split_off(start) {
            if !before.contains(&fault) {
                before.push(fault.clone());
                self.faults.push(fault);
            }
        }
    }

    fn describe(&self, node: Node) -> (String, Span) {
        match node {
            Node::Value(index) => {
                let value = &self.scope.values[index];
                (value.name.node.clone(), value.name.span)
            }
            Node::Entry { block, entry } => {
                let declared = &self.scope.blocks[block];
                let key = &declared.block.fields[entry].key;
                let owner = declared
                    .name
                    .map_or_else(|| declared.kind.words(), |name| name.node.clone());
                (format!("{owner}.{}", key.node), key.span)
            }
        }
    }
}

impl Typed {
    pub fn number(formula: Formula, dimension: Dimension, span: Span) -> Self {
        Self {
            formula,
            shape: Shape::Number,
            dimension,
            span,
            bare: false,
            percent: false,
        }
    }

    /// The value, if it is known before the run.
    pub fn constant(&self) -> Option<f64> {
        self.formula.constant()
    }

    /// Whether it needs the run.
    pub fn is_late(&self) -> bool {
        let mut references = Vec::new();
        self.formula.collect_references(&mut references);
        !references.is_empty() || self.formula.reads_critical_time_step()
    }

    /// The formulas of a list, or the one formula.
    pub fn parts(&self) -> Vec<Formula> {
        match &self.formula {
            Formula::List(parts) => parts.clone(),
            other => vec![other.clone()],
        }
    }
}

/// The number as it was written, without sign, and where: `3 mm`, `-3 mm` and `(3 mm)` are literals.
pub fn literal(expr: &Expr) -> Option<&Expr> {
    use crate::language::syntax::ast::ExprKind;
    match &expr.kind {
        ExprKind::Number { .. } => Some(expr),
        ExprKind::Negate(inner) | ExprKind::Parenthesised(inner) => literal(inner),
        _ => None,
    }
}
