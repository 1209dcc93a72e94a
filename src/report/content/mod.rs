//! The content of a test report, structured after ISO/IEC 17025, 7.8. In: a run and its drawn
//! figures. Out: a [`Document`], built once for every output format. It knows no HTML and no PDF.

mod appendix;
pub(crate) mod budget;
mod conditions;
mod equipment;
mod head;
pub(crate) mod line_fit;
pub(crate) mod method;
mod particulars;
mod prediction;
mod results;
pub(crate) mod tracking;
mod validation;
mod watermarks;
mod zero_drift;

use super::document::{Block, Document, Figure, Text};
use super::figures::Drawn;
use super::{Listed, Run};
use crate::text::sanitize;

/// The whole report; `tables` are the files whose digests it prints.
pub(super) fn document(run: &Run<'_>, figures: &[Drawn], tables: &[Listed]) -> Document {
    let mut body = Vec::new();
    head::amendments(run, &mut body);
    if head::deviations_come_first(run) {
        head::deviations(run, &mut body);
        head::requirements(run, &mut body);
    } else {
        head::requirements(run, &mut body);
        head::deviations(run, &mut body);
    }
    prediction::all(run, &mut body);
    results::all(run, &mut body);
    if !figures.is_empty() {
        body.push(Block::section("Figures"));
        let drawn = figures.iter().enumerate();
        body.extend(drawn.map(|(index, figure)| {
            Block::Figure(Figure {
                number: index + 1,
                caption: figure.caption.as_str().into(),
                svg: figure.svg.clone(),
            })
        }));
    }
    particulars::opinions(run, &mut body);
    equipment::all(run, &mut body);
    conditions::all(run, &mut body);
    appendix::all(run, tables, &mut body);
    Document {
        kind: "Report of a pseudo-dynamic test",
        title: title(run).into(),
        replaces: head::replaced(run),
        id: run.provenance.report_id().to_owned(),
        date: run.provenance.date.as_deref().map(sanitize::printed),
        front: particulars::front(run),
        lacking: particulars::lacking(run),
        verdict: head::verdict(run),
        marks: watermarks::boxed(run),
        across: watermarks::across(run),
        body,
        end: Text::from("— End of report ")
            .id(run.provenance.report_id())
            .and(" —"),
        attachments: appendix::attachments(run),
    }
}

fn title<'a>(run: &Run<'a>) -> &'a str {
    run.plan.report.title.as_deref().unwrap_or(&run.plan.title)
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

/// A table of names and plain texts.
pub(crate) fn described(rows: Vec<(&str, String)>) -> Block {
    pairs(
        rows.into_iter()
            .map(|(name, text)| (name, text.into()))
            .collect(),
    )
}

/// `max_displacement` → `max displacement`.
fn words(name: &str) -> String {
    name.replace('_', " ")
}
