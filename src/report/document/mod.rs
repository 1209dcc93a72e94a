//! The model of a report, and its two renderers. `content` builds one document; `html` and `pdf`
//! print that same document, so that both state the same. All text is data: no renderer interprets
//! markup in it.

pub(super) mod fonts;
pub(super) mod html;
pub(super) mod pdf;
mod text;
mod world;

use serde::Serialize;

pub(super) use html::POLICY;
pub(crate) use text::{Style, Text, printable};

/// A whole report.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Document {
    /// What kind of paper this is, above the title.
    pub kind: &'static str,
    /// The report that this one takes the place of.
    pub replaces: Option<String>,
    pub title: Text,
    /// Identifies the report on every page.
    pub id: String,
    /// Of the test, `YYYY-MM-DD` or as it was given.
    pub date: Option<String>,
    /// Who and what, beside the title: short names and values.
    pub front: Vec<(Text, Text)>,
    /// Names of what should stand there and is not known.
    pub lacking: Vec<&'static str>,
    pub verdict: Verdict,
    pub marks: Vec<Mark>,
    /// Words across every page.
    pub across: Vec<&'static str>,
    pub body: Vec<Block>,
    /// The last line, so that nobody takes a part for the whole.
    pub end: Text,
    /// Files that go with a paged report: name, what it is, its bytes.
    #[serde(skip)]
    pub attachments: Vec<Attachment>,
}

/// The verdict on the whole run.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Verdict {
    /// As in `summary.json`.
    pub name: &'static str,
    pub text: Text,
}

/// What the report must not be taken for: words in a box, and why.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Mark {
    pub words: Vec<&'static str>,
    pub text: Text,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Attachment {
    pub name: String,
    pub text: String,
}

/// A piece of the report, from the top of it to its end.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "block", rename_all = "snake_case")]
pub(crate) enum Block {
    Section {
        title: Text,
    },
    /// A heading below a section's.
    Part {
        title: Text,
    },
    Paragraph {
        text: Text,
    },
    /// Smaller print.
    Note {
        text: Text,
    },
    List {
        items: Vec<Text>,
    },
    /// Names and values.
    Pairs {
        rows: Vec<(Text, Text)>,
    },
    Table(Table),
    Figure(Figure),
    /// A file, line by line, numbered.
    Code {
        lines: Vec<String>,
    },
    /// A line for each who signs.
    Signatures {
        names: Vec<Text>,
    },
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct Table {
    pub columns: Vec<Column>,
    pub rows: Vec<Vec<Text>>,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct Column {
    pub title: Text,
    /// Set flush right, never broken.
    pub numeric: bool,
    /// Share of what the other columns leave; 0: as wide as its widest cell.
    pub share: u8,
}

impl Column {
    /// A column of words that takes a share of the width.
    pub fn words(title: impl Into<Text>, share: u8) -> Self {
        Self {
            title: title.into(),
            numeric: false,
            share,
        }
    }

    /// A column of short words, as wide as they are.
    pub fn short(title: impl Into<Text>) -> Self {
        Self {
            title: title.into(),
            numeric: false,
            share: 0,
        }
    }

    /// A column of numbers.
    pub fn numbers(title: impl Into<Text>) -> Self {
        Self {
            title: title.into(),
            numeric: true,
            share: 0,
        }
    }
}

/// A picture with its caption, numbered from 1.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    pub number: usize,
    pub caption: Text,
    #[serde(skip)]
    pub svg: String,
}

impl Block {
    pub fn section(title: impl Into<Text>) -> Self {
        Self::Section {
            title: title.into(),
        }
    }

    pub fn part(title: impl Into<Text>) -> Self {
        Self::Part {
            title: title.into(),
        }
    }

    pub fn paragraph(text: impl Into<Text>) -> Self {
        Self::Paragraph { text: text.into() }
    }

    pub fn note(text: impl Into<Text>) -> Self {
        Self::Note { text: text.into() }
    }
}

impl Document {
    /// Its figures, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.body.iter().filter_map(|block| match block {
            Block::Figure(figure) => Some(figure),
            _ => None,
        })
    }
}
