//! The declarations of the files: blocks, values and requirements, by name, each name once. In: the syntax trees. Out: a
//! [`Scope`]. It evaluates nothing.

use std::collections::BTreeMap;

use crate::check::wording::{meant, one_of};
use crate::codes::{E201, E208, E212};
use crate::syntax::ast::{Ast, Block, Expr, ExprKind, Ident, ItemKind};
use crate::syntax::control;
use psd_plan::formula::ProcedureId;
use psd_plan::schema::{self, BLOCKS, BlockKind, ITEM_WORDS, Kind, Naming};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{FileId, Span, Spanned};
use psd_text::suggest::with_article;
use psd_text::units::Dimension;

/// A block of a kind that this version knows.
pub struct DeclaredBlock<'a> {
    pub kind: &'static BlockKind,
    pub name: Option<&'a Ident>,
    pub block: &'a Block,
    /// The whole item.
    pub span: Span,
    /// Its index among the procedures.
    pub procedure: Option<ProcedureId>,
}

impl DeclaredBlock<'_> {
    /// Whether its required name is missing, which is reported: an unknown name may be the name of this block.
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
    /// The value that replaces it from outside the plan.
    pub setting: Option<&'a Setting>,
}

/// A value of a parameter that is given from outside the plan.
#[derive(Clone, Debug)]
pub enum Setting {
    /// An expression, as given by `--set`.
    Written(Expr),
    /// A number that is bound without any text.
    Bound(BoundInput),
}

/// An input of the plan to which numbers are bound, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct BoundInput {
    /// Its number among the inputs.
    pub number: usize,
    pub dimension: Dimension,
}

/// Values given from outside the plan for fields, by the span of the value that each replaces, with the name of the input.
pub type Overrides<'a> = BTreeMap<Span, (&'a str, &'a Setting)>;

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    Value(usize),
    Block(usize),
    /// Its declaration has an error: no other error is to follow.
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
    /// Requirements on the results of a run.
    pub requirements: Vec<DeclaredRequirement<'a>>,
    /// Requirements on a probability of a study.
    pub study_requirements: Vec<DeclaredRequirement<'a>>,
    /// Kinds with more blocks than are allowed, which is reported.
    pub twice: Vec<Kind>,
    names: BTreeMap<&'a str, (Meaning, Span)>,
    /// The blocks of each kind, in order.
    kinds: Vec<(Kind, Vec<usize>)>,
    /// The index of each block among those of its kind.
    indices: Vec<usize>,
    /// The blocks of the procedures, in order.
    procedures: Vec<usize>,
    nameless: Vec<&'static BlockKind>,
    /// Spans of syntax errors.
    unread: Vec<Span>,
    /// The span of the first requirement of each name.
    labels: BTreeMap<&'a str, Span>,
}

#[derive(Violation)]
#[violation(E212, "`{what}` is not allowed in a shared file")]
#[help(
    "move it into the plan; a shared file can have `specimen`, `striker`, `rig`, `limits`, `let`, `param` and `use`"
)]
struct NotInLibrary<'a> {
    what: &'a str,
    #[label("not a declaration")]
    span: Span,
}

/// The name of a requirement identifies its verdict.
#[derive(Violation)]
#[violation(E208, "two requirements are named \"{label}\"")]
#[help("rename one, or join their conditions with `and`")]
struct RequirementTwice<'a> {
    label: &'a str,
    #[label("named again")]
    span: Span,
    #[label("first named here")]
    first: Span,
}

#[derive(Violation)]
#[violation(E208, "name `{name}` declared twice")]
#[help("rename one of them")]
struct DeclaredTwice<'a> {
    name: &'a str,
    #[label("declared again")]
    span: Span,
    #[label("first declared here")]
    first: Span,
}

struct UnknownBlock<'a> {
    block: &'a Block,
}

impl Violation for UnknownBlock<'_> {
    const CODE: Code = E201;

    fn diagnostic(self) -> Diagnostic {
        let Self { block } = self;
        let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
        if let Some((message, help)) = words
            .first()
            .and_then(|word| control::of_another_language(word))
        {
            return Diagnostic::new(Self::CODE, message)
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
                meant(&written, known()).map(|near| (count, near))
            });
        let turned = words.len() == 2 && keywords.iter().any(|keyword| keyword == words[1]);
        if turned {
            let help = format!("write the kind first: `{} {}`", words[1], words[0]);
            return Diagnostic::new(Self::CODE, format!("unknown block `{}`", words[0]))
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
        Diagnostic::new(Self::CODE, format!("unknown block `{written}`"))
            .at(span, "unknown block")
            .help(help)
    }
}

/// The error of the words after the keyword, if any.
fn block_name(kind: &BlockKind, block: &Block, rest: &[Ident]) -> Option<Diagnostic> {
    let words = kind.words();
    let example = kind.example.lines().next().unwrap_or_default();
    let wrong = |message: String, span, label: &str| {
        Diagnostic::new(E212, message)
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
        (_, [_, second, ..]) => {
            let name: Vec<&str> = rest.iter().map(|word| word.node.as_str()).collect();
            let message = format!("the name of {} is one word", with_article(&words));
            let name = name.join("_");
            Some(
                Diagnostic::new(E212, message)
                    .at(second.span, "extra word")
                    .help(format!("write the name as one word, `{words} {name} {{`")),
            )
        }
        _ => None,
    }
}

#[derive(Violation)]
#[violation(E208, "two `{}` blocks", kind.words())]
#[help("combine their fields in one block")]
struct BlockTwice<'a> {
    kind: &'a BlockKind,
    #[label("second block")]
    span: Span,
    #[label("first block")]
    first: Span,
}

impl<'a> Scope<'a> {
    /// Collects all declarations of the files; `settings` are the values given from outside, by name.
    pub fn collect(
        asts: &'a [Ast],
        settings: &'a BTreeMap<String, Setting>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut scope = Self {
            unread: diagnostics.iter().filter_map(Diagnostic::span).collect(),
            ..Self::default()
        };
        for ast in asts {
            let library = ast.file != FileId(0);
            for item in &ast.items {
                match &item.kind {
                    ItemKind::Use { .. } => {}
                    ItemKind::Let { name, value } => {
                        let declared = DeclaredValue {
                            keyword: "let",
                            name,
                            value,
                            bounds: None,
                            setting: None,
                        };
                        scope.declare_value(declared, diagnostics);
                    }
                    ItemKind::Param {
                        name,
                        value,
                        bounds,
                    } => {
                        let declared = DeclaredValue {
                            keyword: "param",
                            name,
                            value,
                            bounds: bounds.as_ref(),
                            setting: settings.get(&name.node),
                        };
                        scope.declare_value(declared, diagnostics);
                    }
                    ItemKind::Require { label, .. } if library => {
                        diagnostics.push(
                            NotInLibrary {
                                what: "require",
                                span: label.span,
                            }
                            .diagnostic(),
                        );
                    }
                    ItemKind::Require { label, condition } => {
                        scope.require(label, condition, diagnostics);
                    }
                    ItemKind::Block(block) => {
                        scope.declare_block(block, item.span, library, diagnostics);
                    }
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

    pub fn of_kind(
        &self,
        kind: Kind,
    ) -> impl ExactSizeIterator<Item = (usize, &DeclaredBlock<'a>)> {
        let found = self
            .kinds
            .iter()
            .find(|(of, _)| *of == kind)
            .map_or(&[][..], |(_, blocks)| blocks);
        found.iter().map(|index| (*index, &self.blocks[*index]))
    }

    /// Index of a block among those of its own kind.
    pub fn index_in_kind(&self, block: usize) -> usize {
        self.indices[block]
    }

    /// Kinds of blocks whose required name is missing, which is reported: an unknown name may be one of theirs.
    pub fn nameless(&self) -> impl Iterator<Item = &'static BlockKind> {
        self.nameless.iter().copied()
    }

    pub fn procedures(&self) -> impl Iterator<Item = (usize, &DeclaredBlock<'a>)> {
        self.procedures
            .iter()
            .map(|index| (*index, &self.blocks[*index]))
    }

    /// The block of a procedure.
    pub fn procedure(&self, id: ProcedureId) -> Option<usize> {
        self.procedures.get(id.0).copied()
    }

    fn require(
        &mut self,
        label: &'a Spanned<String>,
        condition: &'a Expr,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let first = *self.labels.entry(&label.node).or_insert(label.span);
        if first != label.span {
            diagnostics.push(
                RequirementTwice {
                    label: &label.node,
                    span: label.span,
                    first,
                }
                .diagnostic(),
            );
        }
        let declared = DeclaredRequirement { label, condition };
        if reads_a_study(condition) {
            self.study_requirements.push(declared);
        } else {
            self.requirements.push(declared);
        }
    }

    fn declare(&mut self, name: &'a Ident, meaning: Meaning, diagnostics: &mut Vec<Diagnostic>) {
        match self.names.get(name.node.as_str()) {
            Some((before, first)) => {
                diagnostics.push(
                    DeclaredTwice {
                        name: &name.node,
                        span: name.span,
                        first: *first,
                    }
                    .diagnostic(),
                );
                // It is unknown which of two declarations of different sorts is meant.
                if std::mem::discriminant(before) != std::mem::discriminant(&meaning) {
                    self.names.insert(&name.node, (Meaning::Poisoned, *first));
                }
            }
            None => {
                self.names.insert(&name.node, (meaning, name.span));
            }
        }
    }

    fn declare_value(&mut self, declared: DeclaredValue<'a>, diagnostics: &mut Vec<Diagnostic>) {
        let meaning = Meaning::Value(self.values.len());
        self.declare(declared.name, meaning, diagnostics);
        self.values.push(declared);
    }

    fn declare_block(
        &mut self,
        block: &'a Block,
        span: Span,
        library: bool,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
        let Some(kind) = schema::block_of_words(&words) else {
            diagnostics.push(UnknownBlock { block }.diagnostic());
            // `if heavy {` declares nothing.
            if words
                .first()
                .is_some_and(|word| control::of_another_language(word).is_some())
            {
                return;
            }
            // Kind and name may be in the wrong order.
            let turned = block.words.len() == 2
                && schema::block_of_words(&[block.words[1].node.as_str(), "_"]).is_some();
            self.poison(
                if turned {
                    &block.words[..1]
                } else {
                    &block.words[1..]
                },
                diagnostics,
            );
            return;
        };
        let rest = &block.words[kind.keyword.len()..];
        if library
            && !matches!(
                kind.kind,
                Kind::Specimen | Kind::Striker | Kind::Ground | Kind::Rig | Kind::Limits
            )
        {
            diagnostics.push(
                NotInLibrary {
                    what: &kind.words(),
                    span: block.head,
                }
                .diagnostic(),
            );
            self.poison(rest, diagnostics);
            return;
        }
        // A head that could not be parsed to its end has more words than are known.
        let cut_short = self.unread.iter().any(|at| {
            at.file == block.head.file
                && (block.head.start..=block.head.end + 1).contains(&at.start)
        });
        if let Some(wrong) = block_name(kind, block, rest).filter(|_| !cut_short) {
            diagnostics.push(wrong);
        } else if let (Naming::Unnamed | Naming::Titled | Naming::MaybeNamed, []) =
            (kind.naming, rest)
            && let Some(first) = self.unnamed(kind, span)
        {
            diagnostics.push(
                BlockTwice {
                    kind,
                    span: block.head,
                    first,
                }
                .diagnostic(),
            );
            if !self.twice.contains(&kind.kind) {
                self.twice.push(kind.kind);
            }
            return;
        }
        if let Some(name) = rest.first() {
            self.declare(name, Meaning::Block(self.blocks.len()), diagnostics);
        }
        // Each of several words may be used as the name.
        for word in rest.iter().skip(1) {
            let poisoned = (Meaning::Poisoned, word.span);
            self.names.entry(&word.node).or_insert(poisoned);
        }
        if rest.is_empty()
            && kind.naming == Naming::Named
            && !self.nameless.iter().any(|other| other.kind == kind.kind)
        {
            self.nameless.push(kind);
        }
        let procedure = kind
            .is_procedure()
            .then_some(ProcedureId(self.procedures.len()));
        self.procedures.extend(procedure.map(|_| self.blocks.len()));
        self.count_kind(kind.kind);
        self.blocks.push(DeclaredBlock {
            kind,
            name: rest.first(),
            block,
            span,
            procedure,
        });
    }

    /// Counts the next block among those of its kind.
    fn count_kind(&mut self, kind: Kind) {
        let block = self.blocks.len();
        if let Some((_, blocks)) = self.kinds.iter_mut().find(|(of, _)| *of == kind) {
            self.indices.push(blocks.len());
            blocks.push(block);
        } else {
            self.indices.push(0);
            self.kinds.push((kind, vec![block]));
        }
    }

    /// The earlier block without a name of this kind in the same file.
    fn unnamed(&self, kind: &BlockKind, span: Span) -> Option<Span> {
        let same = |(_, other): &(usize, &DeclaredBlock)| {
            other.name.is_none() && other.span.file == span.file
        };
        self.of_kind(kind.kind)
            .find(same)
            .map(|(_, other)| other.block.head)
    }

    fn poison(&mut self, words: &'a [Ident], diagnostics: &mut Vec<Diagnostic>) {
        if let Some(name) = words.last() {
            self.declare(name, Meaning::Poisoned, diagnostics);
        }
    }
}

/// Whether a condition reads a member with arguments, which only a study has.
fn reads_a_study(condition: &Expr) -> bool {
    let own = || match &condition.kind {
        ExprKind::Member { .. } => true,
        ExprKind::Call { arguments, .. } => arguments
            .iter()
            .any(|argument| reads_a_study(&argument.value)),
        _ => false,
    };
    condition
        .operands()
        .map_or_else(own, |operands| operands.into_iter().any(reads_a_study))
}
