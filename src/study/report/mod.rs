//! The files of a study beside its data set: summary, figures, and a report as HTML and PDF. In: the data set. Out: files, the same for the
//! same data set. It reads neither the plan nor a clock.

mod document;
mod figures;
mod fragility;
mod numbers;
mod provenance;
mod results;
mod runs;
mod source;
mod subset;
mod summary;
#[cfg(test)]
mod tests;

use crate::report::document::{html, pdf};
use crate::report::figures as drawing;
use crate::report::wording::study as wording;
use crate::report::{OutputError, OutputPart, OutputPiece, OutputSink, PAGE, PAPER, SUMMARY};
use crate::study::answers::Answers;
use crate::study::data_set::Metadata;
use figures::StudyFigure;
use psd_text::digest::sha256;
use psd_text::sanitize;
use source::{DrawnFigure, Source};

pub use summary::{SCHEMA, summary};

/// Digits of the report's identifier.
const ID_DIGITS: usize = 16;

/// Puts summary, figures and report, each as soon as it is made, with paths relative to the folder of the study.
///
/// # Errors
/// A figure or the report cannot be made, or a file cannot be kept.
pub fn put(
    metadata: &Metadata,
    answers: &Answers,
    sink: &mut dyn OutputSink,
) -> Result<(), OutputError> {
    let undrawn = figures::figures(metadata, answers);
    // The summary, the figures, and two formats of the report.
    let total = undrawn.len() + 3;
    let begin = |sink: &mut dyn OutputSink, part, number| {
        sink.begin(&OutputPiece {
            part,
            number,
            total,
        });
    };
    begin(sink, OutputPart::Tables, 1);
    keep(sink, SUMMARY, summary(metadata, answers).as_bytes())?;
    let mut drawn = Vec::with_capacity(undrawn.len());
    for (index, figure) in undrawn.into_iter().enumerate() {
        begin(sink, OutputPart::Figures, index + 2);
        let failed = |reason: String| OutputError::Figure {
            figure: "study",
            procedure: figure.name.clone(),
            reason,
        };
        let svg = drawing::svg(&figure.chart);
        let png = drawing::png(&svg).map_err(failed)?;
        let path = format!("figures/{}", sanitize::file_part(&figure.name));
        keep(sink, &format!("{path}.png"), &png)?;
        keep(sink, &format!("{path}.svg"), svg.as_bytes())?;
        drawn.push(drawn_figure(figure, svg));
    }
    let id = id(metadata);
    let report = document::document(&Source {
        metadata,
        answers,
        figures: &drawn,
        id: &id,
    });
    begin(sink, OutputPart::Report, total - 1);
    let page = sanitize::page(&html::html(&report));
    keep(sink, PAGE, page.as_bytes())?;
    begin(sink, OutputPart::Report, total);
    let pages = pdf::pdf(&report).map_err(OutputError::Pdf)?;
    keep(sink, PAPER, &pages)
}

fn keep(sink: &mut dyn OutputSink, path: &str, bytes: &[u8]) -> Result<(), OutputError> {
    let kept = sink.put(path, &mut |out| out.write_all(bytes));
    kept.map_err(|error| OutputError::Kept {
        path: path.to_owned(),
        reason: error.to_string(),
    })
}

fn drawn_figure(figure: StudyFigure, svg: String) -> DrawnFigure {
    let StudyFigure {
        chart,
        caption,
        result,
        kind,
        ..
    } = figure;
    DrawnFigure {
        description: wording::described(&caption, &chart.x.name, &chart.y.name),
        kind,
        result,
        caption,
        svg,
    }
}

/// First digits of the SHA-256 of the metadata: plan, study, seed, build and runs.
fn id(metadata: &Metadata) -> String {
    let text = serde_json::to_string(metadata).expect("plain numbers and texts");
    let mut id = sha256(text.as_bytes());
    id.truncate(ID_DIGITS);
    id
}
