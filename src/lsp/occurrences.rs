//! The meaning of every word of a plan. In: its syntax trees. Out: its symbols, and each place where a word of the language or a symbol
//! stands. Hover, definition, references, rename and colours are look-ups in it.

use std::collections::BTreeMap;

use psd_language::check::imports;
use psd_language::syntax::ast::{
    Argument, Ast, Block, Entry, Expr, ExprKind, Ident, Item, ItemKind,
};
use psd_plan::schema::sections::SECTIONS;
use psd_plan::schema::{
    self, BlockKind, FUNCTIONS, Field, FieldType, FunctionKind, ITEM_WORDS, Kind, ResultKind,
    Variant,
};
use psd_plan::{FigureKind, ProcedureBlock};
use psd_text::source::{FileId, Span};

/// What a plan declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymbolKind {
    Let,
    Param,
    Requirement,
    Block(Kind),
}

/// A declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Symbol {
    pub name: String,
    pub kind: SymbolKind,
    /// The name; of a requirement its label with its quotes.
    pub span: Span,
    /// The whole item.
    pub item: Span,
}

/// The meaning of a word.
#[derive(Clone, Copy, Debug)]
pub enum Meaning {
    /// `let`, `param`, `require`, `use`
    ItemWord(&'static str),
    /// The words before the name of a block.
    Keyword(&'static BlockKind),
    /// The index of a symbol.
    Symbol(usize),
    /// A field with its value in this plan; `key` is where it is written.
    Entry {
        field: &'static Field,
        key: Span,
    },
    /// A field that the block does not state, read from outside.
    FieldOf(&'static Field),
    /// The name of an argument of a model.
    Argument(&'static Field),
    /// A word of a choice.
    Variant(&'static Variant),
    Function(&'static FunctionKind),
    Figure(FigureKind),
    /// A result of a procedure, or another value of a block, with the index of the block's symbol.
    Result {
        owner: Option<usize>,
        result: &'static ResultKind,
    },
    /// `.u`
    Uncertainty,
    /// `critical`
    CriticalTimeStep,
    /// A number with its unit.
    Number,
    /// The path of a used file.
    File,
}

/// A word and its meaning.
#[derive(Clone, Copy, Debug)]
pub struct Occurrence {
    pub span: Span,
    pub meaning: Meaning,
    /// Whether it declares the symbol.
    pub declares: bool,
}

/// All of them, in order of their spans.
#[derive(Default)]
pub struct Occurrences {
    pub symbols: Vec<Symbol>,
    pub list: Vec<Occurrence>,
}

impl Occurrences {
    pub fn of(trees: &[Ast]) -> Self {
        let mut reader = Reader::default();
        for tree in trees {
            for item in &tree.items {
                reader.declare(item);
            }
        }
        for tree in trees {
            for item in &tree.items {
                reader.item(item);
            }
        }
        let mut list = reader.found;
        list.sort_by_key(|one| {
            (
                one.span.file,
                one.span.start,
                std::cmp::Reverse(one.span.end),
            )
        });
        Self {
            symbols: reader.symbols,
            list,
        }
    }

    /// Those of one file.
    pub fn of_file(&self, file: FileId) -> &[Occurrence] {
        let start = self.list.partition_point(|one| one.span.file < file);
        let end = self.list.partition_point(|one| one.span.file <= file);
        &self.list[start..end]
    }

    /// The innermost one at an offset, its end included.
    pub fn at(&self, file: FileId, offset: usize) -> Option<&Occurrence> {
        let own = self.of_file(file);
        let before = own.partition_point(|one| one.span.range().start <= offset);
        let holds = |one: &&Occurrence| one.span.range().end >= offset;
        // The last one that begins here or before and reaches the offset; at the border of two, the one that begins there.
        own[..before].iter().rev().take(64).find(holds)
    }

    /// Every place of a symbol.
    pub fn of_symbol(&self, symbol: usize) -> impl Iterator<Item = &Occurrence> {
        self.list
            .iter()
            .filter(move |one| matches!(one.meaning, Meaning::Symbol(own) if own == symbol))
    }
}

/// The parts of an expression, in the order of the text.
pub fn parts(expr: &Expr) -> Vec<&Expr> {
    match &expr.kind {
        ExprKind::List { items, .. } => items.iter().collect(),
        ExprKind::Range { start, end, step } => [start, end]
            .into_iter()
            .chain(step)
            .map(Box::as_ref)
            .collect(),
        ExprKind::Call { arguments, .. } => {
            arguments.iter().map(|argument| &argument.value).collect()
        }
        ExprKind::Member {
            base, arguments, ..
        } => std::iter::once(base.as_ref())
            .chain(arguments.iter().map(|argument| &argument.value))
            .collect(),
        ExprKind::Field { base, .. } => vec![base],
        ExprKind::Index { base, index } => vec![base, index],
        ExprKind::Stepped { input, values } => vec![input, values],
        ExprKind::Number { .. } | ExprKind::Text(_) | ExprKind::Name(_) | ExprKind::Faulty => {
            Vec::new()
        }
        ExprKind::Negate(_)
        | ExprKind::Binary { .. }
        | ExprKind::Within { .. }
        | ExprKind::Parenthesised(_) => expr.operands().unwrap_or_default(),
    }
}

/// The context of a value.
#[derive(Clone, Copy, Default)]
struct Where<'a> {
    block: Option<(&'static BlockKind, &'a Block)>,
    /// The key of its entry.
    key: Option<Span>,
    ty: Option<FieldType>,
    /// The variants of the innermost choice, which an inner model takes again.
    variants: &'static [Variant],
}

#[derive(Default)]
struct Reader<'a> {
    symbols: Vec<Symbol>,
    found: Vec<Occurrence>,
    names: BTreeMap<&'a str, usize>,
    labels: BTreeMap<&'a str, usize>,
    /// The blocks of the symbols.
    blocks: BTreeMap<usize, (&'static BlockKind, &'a Block)>,
}

/// The kind of a block, and the words after its keyword.
fn kind_of(block: &Block) -> Option<(&'static BlockKind, &[Ident])> {
    let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
    let kind = schema::block_of_words(&words)?;
    Some((kind, &block.words[kind.keyword.len()..]))
}

impl<'a> Reader<'a> {
    fn add(&mut self, span: Span, meaning: Meaning) {
        self.found.push(Occurrence {
            span,
            meaning,
            declares: false,
        });
    }

    fn declare(&mut self, item: &'a Item) {
        let (name, span, kind) = match &item.kind {
            ItemKind::Use { .. } => return,
            ItemKind::Let { name, .. } => (&name.node, name.span, SymbolKind::Let),
            ItemKind::Param { name, .. } => (&name.node, name.span, SymbolKind::Param),
            ItemKind::Require { label, .. } => (&label.node, label.span, SymbolKind::Requirement),
            ItemKind::Block(block) => {
                let Some((kind, [name, ..])) = kind_of(block) else {
                    return;
                };
                self.blocks.insert(self.symbols.len(), (kind, block));
                (&name.node, name.span, SymbolKind::Block(kind.kind))
            }
        };
        let index = self.symbols.len();
        let names = if kind == SymbolKind::Requirement {
            &mut self.labels
        } else {
            &mut self.names
        };
        names.entry(name).or_insert(index);
        self.symbols.push(Symbol {
            name: name.clone(),
            kind,
            span,
            item: item.span,
        });
        self.found.push(Occurrence {
            span,
            meaning: Meaning::Symbol(index),
            declares: true,
        });
    }

    fn item(&mut self, item: &'a Item) {
        let word = |reader: &mut Self, word: &'static str| {
            let start = item.span.range().start;
            let span = Span::new(item.span.file, start, start + word.len());
            reader.add(span, Meaning::ItemWord(word));
        };
        match &item.kind {
            ItemKind::Use { path } => {
                word(self, ITEM_WORDS[0]);
                self.add(path.span, Meaning::File);
            }
            ItemKind::Param { value, bounds, .. } => {
                word(self, ITEM_WORDS[1]);
                self.value(value, Where::default());
                if let Some(bounds) = bounds {
                    self.value(bounds, Where::default());
                }
            }
            ItemKind::Let { value, .. } => {
                word(self, ITEM_WORDS[2]);
                self.value(value, Where::default());
            }
            ItemKind::Require { condition, .. } => {
                word(self, ITEM_WORDS[3]);
                self.value(condition, Where::default());
            }
            ItemKind::Block(block) => self.block(block),
        }
    }

    fn block(&mut self, block: &'a Block) {
        let Some((kind, rest)) = kind_of(block) else {
            return;
        };
        let words = &block.words[..block.words.len() - rest.len()];
        if let (Some(first), Some(last)) = (words.first(), words.last()) {
            self.add(first.span.to(last.span), Meaning::Keyword(kind));
        }
        for entry in &block.fields {
            self.entry(kind, block, entry);
        }
    }

    fn entry(&mut self, kind: &'static BlockKind, block: &'a Block, entry: &'a Entry) {
        let field = kind.field(&entry.key.node);
        if let Some(field) = field {
            let key = entry.key.span;
            self.add(key, Meaning::Entry { field, key });
        }
        let place = Where {
            block: Some((kind, block)),
            key: Some(entry.key.span),
            ty: field.map(|field| field.ty),
            variants: &[],
        };
        self.value(&entry.value, place);
    }

    fn value(&mut self, expr: &'a Expr, place: Where<'a>) {
        let place = match place.ty {
            Some(
                FieldType::Choice(variants)
                | FieldType::Choices(variants)
                | FieldType::Inputs(variants)
                | FieldType::QuantityOr(_, variants),
            ) => Where { variants, ..place },
            _ => place,
        };
        match &expr.kind {
            ExprKind::Number { .. } => self.add(expr.span, Meaning::Number),
            ExprKind::Name(name) => self.name(name, expr.span, place),
            ExprKind::Text(text) => {
                if matches!(place.ty, Some(FieldType::RequirementName))
                    && let Some(symbol) = self.labels.get(text.as_str())
                {
                    self.add(expr.span, Meaning::Symbol(*symbol));
                }
            }
            ExprKind::Call { name, arguments } => self.call(name, arguments, place),
            ExprKind::Field { base, name } => self.member(base, name, place),
            ExprKind::Member {
                base, arguments, ..
            } => {
                self.value(base, place);
                // A probability of a study names a requirement.
                let of_requirement = Where {
                    ty: Some(FieldType::RequirementName),
                    ..place
                };
                for argument in arguments {
                    self.value(&argument.value, of_requirement);
                }
            }
            _ => {
                for part in parts(expr) {
                    self.value(part, place);
                }
            }
        }
    }

    fn name(&mut self, name: &'a str, span: Span, place: Where<'a>) {
        let is_choice = matches!(
            place.ty,
            Some(
                FieldType::Choice(_)
                    | FieldType::Choices(_)
                    | FieldType::Inputs(_)
                    | FieldType::QuantityOr(..)
                    | FieldType::Inner
                    | FieldType::Inners
            )
        );
        let variant = place.variants.iter().find(|variant| variant.name == name);
        if let Some(variant) = variant.filter(|_| is_choice) {
            return self.add(span, Meaning::Variant(variant));
        }
        if matches!(place.ty, Some(FieldType::Condition))
            && let Some(result) =
                schema::block(Kind::Procedure(ProcedureBlock::Impact)).result(name)
        {
            let owner = None;
            return self.add(span, Meaning::Result { owner, result });
        }
        if let Some((kind, block)) = place.block
            && let Some(field) = kind.field(name).filter(|field| field.ty.is_numeric())
            && let Some(entry) = block.fields.iter().find(|entry| entry.key.node == name)
            && Some(entry.key.span) != place.key
        {
            let key = entry.key.span;
            return self.add(span, Meaning::Entry { field, key });
        }
        if let Some(symbol) = self.names.get(name) {
            return self.add(span, Meaning::Symbol(*symbol));
        }
        if name == "critical" {
            self.add(span, Meaning::CriticalTimeStep);
        }
    }

    fn call(&mut self, name: &'a Ident, arguments: &'a [Argument], place: Where<'a>) {
        let variant = place
            .variants
            .iter()
            .chain(SECTIONS)
            .find(|variant| variant.name == name.node);
        if let Some(variant) = variant {
            self.add(name.span, Meaning::Variant(variant));
            for (at, argument) in arguments.iter().enumerate() {
                let field = match &argument.name {
                    Some(name) => variant.argument(&name.node),
                    None => variant
                        .arguments
                        .get(at.min(variant.arguments.len().saturating_sub(1))),
                };
                if let (Some(name), Some(field)) = (&argument.name, field) {
                    self.add(name.span, Meaning::Argument(field));
                }
                let ty = field.map(|field| field.ty);
                self.value(&argument.value, Where { ty, ..place });
            }
            return;
        }
        if matches!(place.ty, Some(FieldType::Figures)) {
            let figure = FigureKind::ALL
                .into_iter()
                .find(|kind| kind.name() == name.node);
            if let Some(figure) = figure {
                self.add(name.span, Meaning::Figure(figure));
            }
        } else if let Some(function) = FUNCTIONS.iter().find(|one| one.name == name.node) {
            self.add(name.span, Meaning::Function(function));
        }
        for argument in arguments {
            self.value(&argument.value, Where { ty: None, ..place });
        }
    }

    /// `base.name`
    fn member(&mut self, base: &'a Expr, name: &'a Ident, place: Where<'a>) {
        self.value(base, Where { ty: None, ..place });
        let owner = match &base.kind {
            ExprKind::Name(owner) => self.names.get(owner.as_str()).copied(),
            _ => None,
        };
        let block = owner.and_then(|owner| self.blocks.get(&owner).copied());
        if let Some((kind, block)) = block {
            let is_stated = block.fields.iter().any(|entry| entry.key.node == name.node);
            let result = kind.result(&name.node).or_else(|| kind.export(&name.node));
            if let Some(result) = result.filter(|_| !is_stated) {
                return self.add(name.span, Meaning::Result { owner, result });
            }
            if let Some(field) = kind.field(&name.node) {
                let entry = block
                    .fields
                    .iter()
                    .find(|entry| entry.key.node == name.node);
                let key = entry.map(|entry| entry.key.span);
                let meaning =
                    key.map_or(Meaning::FieldOf(field), |key| Meaning::Entry { field, key });
                return self.add(name.span, meaning);
            }
        }
        if name.node == "u" {
            self.add(name.span, Meaning::Uncertainty);
        }
    }
}

/// The path, from the plan's folder, of the file that a `use` names.
pub fn used_path(from: &str, written: &str) -> Option<String> {
    imports::refused(written)
        .is_none()
        .then(|| imports::resolved(from, written))
}
