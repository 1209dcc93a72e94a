//! The syntax tree: the content of a plan file, each piece with its span. It has no meaning yet: block kinds, fields, units and
//! names are strings here, looked up by `check`. Comments are kept beside the items, for the formatter.

use psd_text::source::{FileId, Span, Spanned};

/// Words a top-level item starts with, other than a block.
pub const ITEM_WORDS: [&str; 4] = ["use", "param", "let", "require"];

/// One file.
#[derive(Clone, Debug, PartialEq)]
pub struct Ast {
    pub file: FileId,
    /// Whether all of its text was read without an error.
    pub sound: bool,
    pub items: Vec<Item>,
    /// Every comment of the file in order of position; text from `#` to the end of the line.
    pub comments: Vec<Spanned<String>>,
    /// Spans that are not read as they are written. Each has an error already; other errors there only follow from it.
    pub misspelt: Vec<Span>,
}

/// A name as it was written.
pub type Ident = Spanned<String>;

#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    pub span: Span,
    pub kind: ItemKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `use "lib/frame.psd"`; the text without its quotes.
    Use {
        path: Spanned<String>,
    },
    /// `param v = 1 m/s between 0.5 m/s .. 3 m/s`; `bounds` is the range after `between`.
    Param {
        name: Ident,
        value: Expr,
        bounds: Option<Expr>,
    },
    /// `let section = 564 mm^2`
    Let {
        name: Ident,
        value: Expr,
    },
    /// `require "stays in travel" hit.max_displacement <= 8.5 mm`
    Require {
        label: Spanned<String>,
        condition: Expr,
    },
    Block(Block),
}

/// `stiffness ramp k0 { … }`: the words before the brace, the title if there is one (`plan "…"`), and the fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// At least one: `["stiffness", "ramp", "k0"]`. `check` decides which are the kind and which is the name.
    pub words: Vec<Ident>,
    pub title: Option<Spanned<String>>,
    pub fields: Vec<Entry>,
    /// From the first word to the last word or title.
    pub head: Span,
}

/// `key = value`
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub span: Span,
    pub key: Ident,
    pub value: Expr,
}

/// A unit token as written, `kN/m`, not yet looked up.
pub type UnitToken = Spanned<String>;

#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    pub span: Span,
    pub kind: ExprKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `300 kN/m`. `text` is the number as written, without sign or unit; `value` is finite.
    Number {
        value: f64,
        text: String,
        unit: Option<UnitToken>,
    },
    /// The text without its quotes, escapes resolved.
    Text(String),
    Name(String),
    /// `[1, 2, 3] mm`
    List {
        items: Vec<Expr>,
        unit: Option<UnitToken>,
    },
    /// `0.1 mm .. 1 mm step 0.1 mm`; bare numbers take the last unit.
    Range {
        start: Box<Expr>,
        end: Box<Expr>,
        step: Option<Box<Expr>>,
    },
    /// `elastic(stiffness: 300 kN/m)`, `sqrt(2)`; positional arguments come before named ones.
    Call {
        name: Ident,
        arguments: Vec<Argument>,
    },
    /// `k0.stiffness`
    Field {
        base: Box<Expr>,
        name: Ident,
    },
    /// `scatter.probability(fails: "stays in travel")`
    Member {
        base: Box<Expr>,
        name: Ident,
        arguments: Vec<Argument>,
    },
    /// `quake.max_drift[0]`
    Index {
        base: Box<Expr>,
        index: Box<Expr>,
    },
    Negate(Box<Expr>),
    Binary {
        operator: Spanned<BinaryOperator>,
        left: Box<Expr>,
        right: Box<Expr>,
    },
    /// `A within TOLERANCE of TARGET`
    Within {
        value: Box<Expr>,
        tolerance: Box<Expr>,
        target: Box<Expr>,
    },
    /// `impact_speed in 0.4 .. 1.6 step 0.1 m/s`
    Stepped {
        input: Box<Expr>,
        values: Box<Expr>,
    },
    /// `( … )`, kept so that the formatter writes it as it was.
    Parenthesised(Box<Expr>),
    /// An expression that could not be parsed; its error has been reported, and no other is to follow.
    Faulty,
}

impl Expr {
    /// The position of an item of a list, from 0; of the whole expression where there is no such item.
    pub fn item_span(&self, index: usize) -> Span {
        let item = match &self.kind {
            ExprKind::List { items, .. } => items.get(index),
            _ => None,
        };
        item.map_or(self.span, |item| item.span)
    }

    /// The operands of an operator, of a comparison or of parentheses; None for every other expression.
    pub fn operands(&self) -> Option<Vec<&Self>> {
        match &self.kind {
            ExprKind::Parenthesised(inner) | ExprKind::Negate(inner) => Some(vec![inner]),
            ExprKind::Binary { left, right, .. } => Some(vec![left, right]),
            ExprKind::Within {
                value,
                tolerance,
                target,
            } => Some(vec![value, tolerance, target]),
            _ => None,
        }
    }
}

/// An argument of a variant or function.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    pub name: Option<Ident>,
    pub value: Expr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOperator {
    And,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    /// `~`: the value on the left is drawn from the distribution on the right.
    DrawnFrom,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl BinaryOperator {
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::And => "and",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::DrawnFrom => "~",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Power => "^",
        }
    }
}
