//! The content of a test report, structured after ISO/IEC 17025, 7.8. In: a run, its drawn figures, the digests of its tables.
//! Out: a [`Document`], built once for every output format. It knows no HTML and no PDF.

mod conditions;
mod deviations;
mod equipment;
mod figures;
mod headline;
mod plan;
mod prediction;
mod provenance;
mod reproductions;
pub(crate) mod requirements;
pub(crate) mod results;
mod statements;
mod title_page;

use super::document::{Block, Document, Text};
use super::figures::Drawn;
use super::output::sink::FileDigest;
use super::run::Run;
use super::wording;
use psd_plan::Annex;

/// The parts of a report, in order, with their sections. A section without content writes nothing, and neither does an annex of
/// such sections. The first two pages decide; the annexes prove.
const SECTIONS: &[(Division, &[Section])] = &[
    (
        Division::FirstPage,
        &[
            title_page::amendments,
            requirements::section,
            reproductions::section,
            deviations::section,
            statements::signatures,
        ],
    ),
    (
        Division::SecondPage,
        &[
            prediction::section,
            headline::section,
            figures::headline,
            deviations::observations,
            conditions::summary,
            statements::opinions,
            statements::section,
        ],
    ),
    (
        Division::Annex(Annex::Results),
        &[results::section, headline::mark_of_the_annex],
    ),
    (Division::Annex(Annex::Budgets), &[results::budgets]),
    (
        Division::Annex(Annex::Figures),
        &[figures::section, figures::photographs],
    ),
    (
        Division::Annex(Annex::Equipment),
        &[equipment::section, conditions::section, deviations::notes],
    ),
    (
        Division::Annex(Annex::Provenance),
        &[provenance::section, provenance::validation],
    ),
    (Division::Annex(Annex::Plan), &[plan::section]),
];

/// A division of a report.
enum Division {
    /// Who, what, when; the statement of conformity.
    FirstPage,
    /// The results that the statement is based on.
    SecondPage,
    /// An annex, if the plan requests it.
    Annex(Annex),
}

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
    let body = body(&source);
    Document {
        kind: title_page::kind(run),
        title: title_page::title(run).into(),
        logo: title_page::logo(run),
        replaces: title_page::replaced_report(run),
        id: run.provenance.report_id().to_owned(),
        date: title_page::date(run),
        dated: title_page::dated(run),
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

/// The blocks of every division. The annexes have letters in their order, so that none is skipped.
fn body(source: &Source<'_>) -> Vec<Block> {
    let mut body = Vec::new();
    let mut letters = 'A'..='Z';
    for (division, sections) in SECTIONS {
        let mut blocks = Vec::new();
        for section in *sections {
            section(source, &mut blocks);
        }
        if blocks.is_empty() {
            continue;
        }
        match division {
            Division::FirstPage => {}
            Division::SecondPage => body.push(Block::NewPage),
            Division::Annex(annex) => {
                if !source.run.plan.report.annexes.contains(annex) {
                    continue;
                }
                let Some(letter) = letters.next() else {
                    continue;
                };
                if letter == 'A' {
                    body.push(Block::NewPage);
                }
                body.push(Block::section(wording::annexes::title(
                    letter,
                    name_of(*annex),
                )));
            }
        }
        body.append(&mut blocks);
    }
    number_figures(&mut body);
    body
}

/// Figures have numbers from 1 in their order.
fn number_figures(body: &mut [Block]) {
    let figures = body.iter_mut().filter_map(|block| match block {
        Block::Figure(figure) => Some(figure),
        _ => None,
    });
    for (number, figure) in (1..).zip(figures) {
        figure.number = number;
    }
}

const fn name_of(annex: Annex) -> &'static str {
    match annex {
        Annex::Results => wording::annexes::RESULTS,
        Annex::Budgets => wording::annexes::BUDGETS,
        Annex::Figures => wording::annexes::FIGURES,
        Annex::Equipment => wording::annexes::EQUIPMENT,
        Annex::Provenance => wording::annexes::PROVENANCE,
        Annex::Plan => wording::annexes::PLAN,
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

/// The name of one entry of a list: `periods` → `period`, `energies` → `energy`, `stiffnesses` → `stiffness`.
fn entry_name(list: &str) -> String {
    let words = with_spaces(list);
    let plurals = [("ies", "y"), ("sses", "ss"), ("ss", "ss"), ("s", "")];
    let one = plurals.iter().find_map(|(plural, one)| {
        words
            .strip_suffix(plural)
            .map(|stem| format!("{stem}{one}"))
    });
    one.unwrap_or(words)
}

/// The string with a capital first letter.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
