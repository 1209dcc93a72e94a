//! The state that every part of the check shares: the files, the scope, the diagnostics so far, and values that are already evaluated.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use crate::codes::{E404, E405};
use crate::syntax::ast::Expr;
use psd_physics::structure::section::Section;
use psd_plan::formula::{Formula, ProcedureId, ResultReference};
use psd_plan::{Behaviour, Frame, Interval};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{Sources, Span};
use psd_text::units::{Dimension, Quantity};

use super::Loader;
use super::expressions::data_file::DataFile;
use super::scope::{BoundInput, Overrides, Scope};

/// A value that is evaluated once: a `let` or `param`, or an entry of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Node {
    Value(usize),
    Entry { block: usize, entry: usize },
}

/// What was checked, and whether a value that is bound from outside the plan reaches it.
#[derive(Clone, Debug)]
pub struct Traced<T> {
    pub value: T,
    pub is_bound: bool,
}

/// What is read again and again.
pub type Reread<T> = Traced<Option<Rc<T>>>;

/// Values that no bound value reaches and whose evaluation left nothing else behind, so that a check with other bound values begins
/// with them.
#[derive(Default)]
pub struct FixedValues {
    /// Those of other nodes are there too, and are evaluated again.
    known: BTreeMap<Node, Known>,
    checks: u64,
    own_values: BTreeMap<usize, Traced<Option<OwnValue>>>,
    frames: BTreeMap<usize, Reread<Frame>>,
    behaviours: BTreeMap<usize, Reread<Behaviour>>,
}

/// The value that the plan itself gives a parameter, and its bounds.
#[derive(Clone)]
pub struct OwnValue {
    pub typed: Typed,
    pub bounds: Interval,
}

/// A node that is evaluated.
struct Known {
    traced: Traced<Option<Typed>>,
    /// Whether it has a value that no bound value reaches, and its evaluation reported nothing and read no result.
    is_fixed: bool,
    /// Number of the check that evaluated it.
    check: u64,
}

/// One number or a list.
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
    /// A number written without a unit (or a list of such), whose unit may have been forgotten.
    pub bare: bool,
    /// Written with `%`.
    pub percent: bool,
    /// A temperature with `degC`, whose zero is not that of the kelvin: it has a difference and no sum or product.
    pub absolute: bool,
}

/// The results that an expression may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// None: it is fixed before the run. The string names its owner: "a specimen".
    Nothing(&'static str),
    /// Those of procedures that run before this one.
    Before(ProcedureId),
    /// Those of the impact that has just ended, by their own names, and those of procedures that run before this one.
    Impact(ProcedureId),
    All,
}

/// A smallest or largest value of an input of a study.
#[derive(Clone, Debug)]
pub struct End {
    /// As in `--set`.
    pub name: String,
    pub value: Quantity,
    /// The distribution.
    pub span: Span,
    /// For a plan that is invalid there.
    pub help: &'static str,
}

/// The context of an expression.
#[derive(Clone, Copy, Debug)]
pub struct Context {
    /// The block and its entry.
    pub entry: Option<(usize, usize)>,
    pub reads: Reads,
    /// Whether `critical` has a meaning here.
    pub critical: bool,
}

#[expect(
    clippy::struct_excessive_bools,
    reason = "each is true of another time of the check"
)]
pub struct Checker<'a> {
    pub sources: &'a Sources,
    pub scope: &'a Scope<'a>,
    pub loader: &'a Loader<'a>,
    /// Data files that the plan names, each once.
    pub data: Vec<DataFile>,
    /// The plan's own values of its parameters, by their index among the values; None of one with an error.
    pub own_values: BTreeMap<usize, Traced<Option<OwnValue>>>,
    /// Frames of the specimens that have storeys, by their blocks; None of one with an error.
    pub frames: BTreeMap<usize, Reread<Frame>>,
    /// Restoring-force models of the other specimens, likewise.
    pub behaviours: BTreeMap<usize, Reread<Behaviour>>,
    pub diagnostics: Vec<Diagnostic>,
    /// Whether names may be missing because a used file could not be read.
    pub names_lost: bool,
    /// Cross-sections by the span of their shapes; None of one with an error.
    pub sections: BTreeMap<Span, Traced<Option<Section>>>,
    /// Lines that could not be parsed: unknown names may be declared there.
    pub unread: Vec<Span>,
    /// Every word of those lines.
    unread_words: BTreeSet<&'a str>,
    /// Spans that one diagnostic explains in full.
    pub explained: Vec<Span>,
    known: BTreeMap<Node, Known>,
    /// Number of checks before this one that began with each other's values.
    checks: u64,
    pub used: BTreeSet<usize>,
    /// The blocks that a field or an expression names.
    pub used_blocks: BTreeSet<usize>,
    /// Results of procedures that an expression reads, with their spans.
    pub read: Vec<(ResultReference, Span)>,
    /// Entries that are read from lists of results, by their index from 0, with their spans.
    pub list_entries_read: Vec<(ResultReference, usize, Span)>,
    /// The rig of the run, if it moves a real specimen.
    pub real_rig: Option<usize>,
    /// Values of fields that are given from outside the plan.
    pub overrides: Overrides<'a>,
    /// The values that are bound from outside, by their inputs, SI.
    pub bound: &'a [f64],
    /// Whether one of them was read since [`Self::traced`] began.
    reads_bound: bool,
    /// Results that the plan reads as these numbers.
    pub results: Vec<(ResultReference, Traced<Typed>)>,
    /// Whether the studies of the plan are about to be run.
    pub for_studies: bool,
    /// Ends of the inputs of studies, at which the plan must be valid.
    pub ends: Vec<End>,
    /// Values of the inputs of studies that one draw in 1000 exceeds.
    pub tails: Vec<End>,
    stack: Vec<Node>,
    /// Whether it was reported that values depend on one another too deeply.
    too_deep: bool,
}

/// Longest chain of dependent values before they are evaluated: each needs a part of the stack.
pub const DEEPEST_VALUES: usize = 100;
/// Largest number of results and operators of one value that is known only after the run, including those of the values that it names.
/// Such a value is copied at every use of its name, so that `let b = a + a` doubles it.
pub const MOST_TERMS: usize = 1_000;

/// Number of diagnostics after which no similar name is suggested for an unknown one.
const SUGGESTED: usize = 50;

/// A value that is copied wherever it is named.
#[derive(Violation)]
#[violation(
    E405,
    "a value can use at most {most} results and operators, including those of the values it names"
)]
#[help("name each result once, or simplify the calculation")]
struct TooManyTerms {
    #[label("too many")]
    span: Span,
    most: usize,
}

/// `requested_at` closes the cycle.
struct CircularDefinition<'a> {
    cycle: &'a [(String, Span)],
    requested_at: Span,
}

impl Violation for CircularDefinition<'_> {
    const CODE: Code = E404;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            cycle,
            requested_at,
        } = self;
        let first = cycle.first().map_or("", |(name, _)| name.as_str());
        let names = cycle
            .iter()
            .map(|(name, _)| name.as_str())
            .chain([first])
            .collect::<Vec<_>>()
            .join(" → ");
        let diagnostic = Diagnostic::new(Self::CODE, format!("circular definition: {names}"))
            .at(requested_at, "closes the circle");
        cycle
            .iter()
            .fold(diagnostic, |diagnostic, (name, span)| {
                diagnostic.at(*span, format!("`{name}` is part of it"))
            })
            .help("write a value for one of them")
    }
}

/// Values that depend on one another too deeply.
#[derive(Violation)]
#[violation(E405, "values are nested more than {most} deep")]
#[help("declare a value before the values that use it, or use fewer intermediate values")]
struct ValuesTooDeep {
    #[label("too deep")]
    span: Span,
    most: usize,
}

impl<'a> Checker<'a> {
    pub fn new(
        sources: &'a Sources,
        scope: &'a Scope<'a>,
        loader: &'a Loader<'a>,
        diagnostics: Vec<Diagnostic>,
        unread: Vec<Span>,
        names_lost: bool,
    ) -> Self {
        let (known, used, stack) = (BTreeMap::new(), BTreeSet::new(), Vec::new());
        let (data, frames, behaviours) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        let words = |span: &Span| {
            sources
                .text(*span)
                .split(|c: char| !c.is_alphanumeric() && c != '_')
        };
        let unread_words = unread.iter().flat_map(words).collect();
        Self {
            sources,
            scope,
            loader,
            data,
            own_values: BTreeMap::new(),
            frames,
            behaviours,
            sections: BTreeMap::new(),
            diagnostics,
            names_lost,
            unread,
            unread_words,
            explained: Vec::new(),
            known,
            checks: 0,
            used,
            used_blocks: BTreeSet::new(),
            read: Vec::new(),
            list_entries_read: Vec::new(),
            real_rig: None,
            overrides: Overrides::new(),
            bound: &[],
            reads_bound: false,
            results: Vec::new(),
            for_studies: false,
            ends: Vec::new(),
            tails: Vec::new(),
            stack,
            too_deep: false,
        }
    }

    /// Adds a diagnostic; returns None, so that the caller can return it.
    pub fn fail<T>(&mut self, found: impl Into<Diagnostic>) -> Option<T> {
        self.diagnostics.push(found.into());
        None
    }

    pub fn report(&mut self, found: impl Into<Diagnostic>) {
        self.diagnostics.push(found.into());
    }

    pub fn text(&self, span: Span) -> &'a str {
        self.sources.text(span)
    }

    /// Evaluates a node once. A node that depends on itself is an error that names the dependency cycle.
    pub fn once(
        &mut self,
        node: Node,
        requested_at: Span,
        work: impl FnOnce(&mut Self) -> Option<Typed>,
    ) -> Option<Typed> {
        let known = self.known.get(&node);
        if let Some(Known { traced, .. }) =
            known.filter(|known| known.is_fixed || known.check == self.checks)
        {
            self.reads_bound |= traced.is_bound;
            return traced.value.clone();
        }
        self.guarded(node, requested_at, |checker| {
            let before = checker.left_behind();
            let traced = checker
                .traced(|checker| work(checker).and_then(|typed| checker.of_bounded_size(typed)));
            let value = traced.value.clone();
            let is_fixed = !traced.is_bound && value.is_some() && checker.left_behind() == before;
            let known = Known {
                traced,
                is_fixed,
                check: checker.checks,
            };
            checker.known.insert(node, known);
            value
        })
    }

    /// Does `work` once for this key of one of its maps.
    pub fn once_in<K: Ord, T: Clone>(
        &mut self,
        known: fn(&mut Self) -> &mut BTreeMap<K, Traced<T>>,
        key: K,
        work: impl FnOnce(&mut Self) -> T,
    ) -> T {
        if let Some(traced) = known(self).get(&key).cloned() {
            return self.read_again(&traced);
        }
        let traced = self.traced(work);
        let value = traced.value.clone();
        known(self).insert(key, traced);
        value
    }

    /// Begins with the values of the check before, of the same plan without warnings.
    pub fn begin_with(&mut self, fixed: FixedValues) {
        let FixedValues {
            known,
            checks,
            own_values,
            frames,
            behaviours,
        } = fixed;
        (self.known, self.checks, self.own_values) = (known, checks, own_values);
        (self.frames, self.behaviours) = (frames, behaviours);
    }

    /// The values with which the next check may begin.
    pub fn fixed_values(&mut self) -> FixedValues {
        let mut fixed = FixedValues {
            known: std::mem::take(&mut self.known),
            checks: self.checks + 1,
            own_values: std::mem::take(&mut self.own_values),
            frames: std::mem::take(&mut self.frames),
            behaviours: std::mem::take(&mut self.behaviours),
        };
        fixed.own_values.retain(|_, own| own.is_fixed());
        fixed.frames.retain(|_, frame| frame.is_fixed());
        fixed.behaviours.retain(|_, behaviour| behaviour.is_fixed());
        fixed
    }

    /// The numbers of diagnostics, of results and of entries of their lists that were read so far.
    pub const fn left_behind(&self) -> [usize; 3] {
        [
            self.diagnostics.len(),
            self.read.len(),
            self.list_entries_read.len(),
        ]
    }

    /// Does `work`, and finds whether it reads a value that is bound from outside the plan.
    pub fn traced<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> Traced<T> {
        let before = std::mem::replace(&mut self.reads_bound, false);
        let value = work(self);
        let is_bound = self.reads_bound;
        self.reads_bound |= before;
        Traced { value, is_bound }
    }

    /// What was traced, which is now read again.
    pub fn read_again<T: Clone>(&mut self, traced: &Traced<T>) -> T {
        self.reads_bound |= traced.is_bound;
        traced.value.clone()
    }

    /// The value that is bound to an input.
    pub fn bound_value(&mut self, input: BoundInput) -> Quantity {
        self.reads_bound = true;
        Quantity::new(self.bound[input.number], input.dimension)
    }

    fn of_bounded_size(&mut self, typed: Typed) -> Option<Typed> {
        if typed.formula.terms() <= MOST_TERMS {
            return Some(typed);
        }
        self.fail(TooManyTerms {
            span: typed.span,
            most: MOST_TERMS,
        })
    }

    /// Does `work` for a node, unless it is already in progress further up.
    pub fn guarded<T>(
        &mut self,
        node: Node,
        requested_at: Span,
        work: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if let Some(start) = self.stack.iter().position(|open| *open == node) {
            let cycle: Vec<(String, Span)> = self.stack[start..]
                .iter()
                .map(|node| self.describe(*node))
                .collect();
            for node in self.stack[start..].iter().copied() {
                self.known.insert(node, Known::unknown(self.checks));
            }
            return self.fail(CircularDefinition {
                cycle: &cycle,
                requested_at,
            });
        }
        if self.stack.len() >= DEEPEST_VALUES {
            // Only once: if a chain is too deep, each of its parts is too.
            if !std::mem::replace(&mut self.too_deep, true) {
                self.report(ValuesTooDeep {
                    span: requested_at,
                    most: DEEPEST_VALUES,
                });
            }
            self.known.insert(node, Known::unknown(self.checks));
            return None;
        }
        self.stack.push(node);
        let value = work(self);
        self.stack.pop();
        value
    }

    /// Whether a name may have been declared in text that could not be parsed.
    pub fn may_be_lost(&self, name: &str) -> bool {
        self.names_lost || self.unread_words.contains(name)
    }

    /// Candidates for the suggestion of a similar name; none after many diagnostics, because each candidate is compared every time.
    pub fn names_to_suggest(&self) -> impl Iterator<Item = &'a str> {
        self.scope.names().take(self.most_to_suggest())
    }

    /// Number of candidates for the suggestion of a similar name.
    pub const fn most_to_suggest(&self) -> usize {
        if self.diagnostics.len() <= SUGGESTED {
            usize::MAX
        } else {
            0
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

impl Known {
    /// Something with an error.
    const fn unknown(check: u64) -> Self {
        Self {
            traced: Traced::unknown(),
            is_fixed: false,
            check,
        }
    }
}

impl<T> Traced<Option<T>> {
    /// Something with an error.
    pub const fn unknown() -> Self {
        Self {
            value: None,
            is_bound: false,
        }
    }

    /// Whether it is the same with other bound values.
    const fn is_fixed(&self) -> bool {
        self.value.is_some() && !self.is_bound
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
            absolute: false,
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

/// The literal without its sign and parentheses: `3 mm`, `-3 mm` and `(3 mm)` are literals.
pub fn literal(expr: &Expr) -> Option<&Expr> {
    use crate::syntax::ast::ExprKind;
    match &expr.kind {
        ExprKind::Number { .. } => Some(expr),
        ExprKind::Negate(inner) | ExprKind::Parenthesised(inner) => literal(inner),
        _ => None,
    }
}
