//! The content of a test report, structured after ISO/IEC 17025, 7.8. In: a run, its drawn figures, the digests of its tables.
//! Out: a [`Document`], built once for every output format. It knows no HTML and no PDF.

mod amendment;
mod conditions;
mod deviations;
mod equipment;
mod figures;
mod frame;
mod opinions;
mod plan;
mod prediction;
mod provenance;
mod requirements;
pub(crate) mod results;
mod statements;
mod title_page;
mod validation;

use super::document::{Block, Document, Text};
use super::figures::Drawn;
use super::output::sink::FileDigest;
use super::run::Run;
use super::wording;

/// The sections of a report, in order. A section without content writes nothing.
const SECTIONS: &[Section] = &[
    amendment::section,
    deviations::before_requirements,
    requirements::section,
    deviations::after_requirements,
    prediction::section,
    results::section,
    figures::section,
    opinions::section,
    equipment::section,
    conditions::section,
    statements::section,
    plan::section,
    provenance::section,
    validation::section,
    statements::signatures,
];

/// Writes one section.
type Section = fn(&Source<'_>, &mut Vec<Block>);

/// The input of a section.
struct Source<'a> {
    run: &'a Run<'a>,
    figures: &'a [Drawn],
    /// The files of the tables with their digests.
    tables: &'a [FileDigest],
}

/// The whole report; `tables` are the files whose digests it prints.
pub(super) fn document(run: &Run<'_>, figures: &[Drawn], tables: &[FileDigest]) -> Document {
    let source = Source {
        run,
        figures,
        tables,
    };
    let mut body = Vec::new();
    for section in SECTIONS {
        section(&source, &mut body);
    }
    Document {
        kind: wording::title_page::KIND,
        title: title_page::title(run).into(),
        replaces: amendment::replaced_report(run),
        id: run.provenance.report_id().to_owned(),
        date: title_page::date(run),
        front: title_page::particulars(run),
        missing_fields: title_page::missing_particulars(run),
        verdict: title_page::verdict(run),
        notices: title_page::notices(run),
        watermarks: title_page::watermarks(run),
        body,
        end: Text::from(wording::title_page::END)
            .id(run.provenance.report_id())
            .and(" —"),
        labels: wording::LABELS,
        attachments: plan::attachments(run),
    }
}

/// A table of names and values.
fn pairs(rows: Vec<(&str, Text)>) -> Block {
    Block::Pairs {
        rows: rows
            .into_iter()
            .map(|(name, value)| (name.into(), value))
            .collect(),
    }
}

/// A table of names and plain strings.
pub(crate) fn described(rows: Vec<(&str, String)>) -> Block {
    pairs(
        rows.into_iter()
            .map(|(name, text)| (name, text.into()))
            .collect(),
    )
}

/// `max_displacement` → `max displacement`.
fn with_spaces(name: &str) -> String {
    name.replace('_', " ")
}

/// The string with a capital first letter.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
