//! The model of a report, and its two renderers. `sections` builds one document; `html` and `pdf`
//! print that same document, so that both state the same. All text is data: no renderer interprets
//! markup in it.

pub mod comparison;
pub(super) mod fonts;
pub(crate) mod html;
pub(crate) mod pdf;
mod text;
mod world;

use serde::Serialize;

use super::wording::Labels;
use psd_plan::Picture;

pub(crate) use text::{Style, Text, printable};

/// A whole report.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Document {
    /// The kind of report, above the title.
    pub kind: &'static str,
    /// The report that this one replaces.
    pub replaces: Option<String>,
    pub title: Text,
    /// The logo of the laboratory, with its name.
    pub logo: Option<Photo>,
    /// Identifies the report on every page.
    pub id: String,
    /// Date of the test, `YYYY-MM-DD` or as given.
    pub date: Option<String>,
    /// The same in words; None if there is nothing to print.
    pub dated: Option<String>,
    /// Particulars below the title: names and values.
    pub front: Vec<(Text, Text)>,
    /// Names of particulars that are missing there.
    pub missing_fields: Vec<&'static str>,
    pub verdict: Verdict,
    pub notices: Vec<Notice>,
    /// Words across every page.
    pub watermarks: Vec<&'static str>,
    pub body: Vec<Block>,
    /// The last line, which marks the end of the report.
    pub end: Text,
    /// Words that the layout adds.
    pub labels: Labels,
    /// Files attached to the PDF.
    #[serde(skip)]
    pub attachments: Vec<Attachment>,
}

/// The statement on the whole run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Verdict {
    pub tone: Tone,
    pub heading: String,
    pub text: Text,
}

/// The colour of a statement. The words alone are enough: a report may be printed in grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Tone {
    /// No statement of conformity, or a simulation.
    Neutral,
    Pass,
    Inconclusive,
    Fail,
}

impl Tone {
    /// The name in the style of a page.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Neutral => "neutral",
            Self::Pass => "pass",
            Self::Inconclusive => "inconclusive",
            Self::Fail => "fail",
        }
    }
}

/// A notice against an incorrect use of the report: text in a box, and the reason.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Notice {
    pub words: Vec<&'static str>,
    pub text: Text,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Attachment {
    pub name: String,
    pub text: String,
}

/// A block of the report; the body is a list of them.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "block", rename_all = "snake_case")]
pub(crate) enum Block {
    Section {
        title: Text,
    },
    /// A heading inside a section.
    Part {
        title: Text,
    },
    /// The next block begins a page.
    NewPage,
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
    /// Photographs beside each other.
    Photos {
        photos: Vec<Photo>,
    },
    /// Lines of a file with their numbers.
    Code {
        /// The number of the first line, from 1.
        first: usize,
        lines: Vec<String>,
    },
    /// A line for each signatory.
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
    /// Fraction of the width that columns with 0 leave; 0: as wide as its widest cell.
    pub share: u8,
}

impl Column {
    /// A column of text with a fraction of the width.
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
    /// From 1, given when the report is complete.
    pub number: usize,
    pub caption: Text,
    /// Its content in words, for a reader who cannot see it.
    pub description: Text,
    #[serde(skip)]
    pub svg: String,
}

/// A picture of the plan.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Photo {
    /// Its name among the files of the layout.
    pub name: String,
    pub caption: Text,
    #[serde(skip)]
    pub picture: Picture,
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
    /// Its pictures: the logo, then the photographs.
    pub fn photos(&self) -> impl Iterator<Item = &Photo> {
        let photos = self.body.iter().filter_map(|block| match block {
            Block::Photos { photos } => Some(photos),
            _ => None,
        });
        self.logo.iter().chain(photos.flatten())
    }

    /// Its figures, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.body.iter().filter_map(|block| match block {
            Block::Figure(figure) => Some(figure),
            _ => None,
        })
    }
}
