//! The files of a run folder, in the order in which they are made. In: a run. Out: files, put into the sink of the caller;
//! path and SHA-256 of each. It opens no file itself.

pub(super) mod file;
mod manifest;
pub(super) mod paths;
pub(super) mod sink;

pub use file::{OutputError, OutputFile, PAGE, PAPER, SUMMARY};
pub use sink::{FileDigest, NullSink, OutputPart, OutputPiece, OutputSink};

use super::run::Run;
use super::{document, figures, sections, summary, tables};
use figures::{Drawn, Undrawn};
use file::wants;
use paths::{UsedPaths, plan_files};
use psd_plan::Format;
use psd_text::sanitize;

/// Writes every file of the run folder except the manifest, each immediately after it is made. The order is: summary and tables, the
/// figures one by one, the report, which states the digests of the tables, and the files of the plan.
///
/// # Errors
/// A table or figure that cannot be encoded, or a file that cannot be kept.
pub fn put_everything(
    run: &Run<'_>,
    sink: &mut dyn OutputSink,
) -> Result<Vec<FileDigest>, OutputError> {
    let tables = tables::of_run(run);
    let (html, pdf) = (wants(run.plan, Format::Html), wants(run.plan, Format::Pdf));
    let figures = run.plan.report.figures.len();
    let mut progress = Progress {
        done: 0,
        total: 1 + tables.len() + figures + usize::from(html) + usize::from(pdf),
    };
    progress.begin(OutputPart::Tables, sink);
    let mut digests = vec![put_file(sink, &summary_file(run))?];
    if let Some(prediction) = &run.provenance.prediction {
        digests.push(put_file(sink, &summary::prediction_file(prediction))?);
    }
    let mut table_digests = Vec::with_capacity(tables.len());
    for table in tables {
        progress.begin(OutputPart::Tables, sink);
        table_digests.push(table.put(sink)?);
    }
    let figures = put_figures(run, &mut progress, &mut digests, sink)?;
    if html || pdf {
        let report = sections::document(run, &figures, &table_digests);
        if html {
            progress.begin(OutputPart::Report, sink);
            let page = sanitize::page(&document::html::html(&report));
            let page = OutputFile {
                path: PAGE.to_owned(),
                bytes: page.into_bytes(),
            };
            digests.push(put_file(sink, &page)?);
        }
        if pdf {
            progress.begin(OutputPart::Report, sink);
            let pages = OutputFile {
                path: PAPER.to_owned(),
                bytes: document::pdf::pdf(&report).map_err(OutputError::Pdf)?,
            };
            digests.push(put_file(sink, &pages)?);
        }
    }
    digests.extend(table_digests);
    for file in plan_files(run.plan) {
        digests.push(put_file(sink, &file)?);
    }
    Ok(digests)
}

/// Draws each figure and writes it before the next one is drawn. The vector drawings are kept for the report.
fn put_figures(
    run: &Run<'_>,
    progress: &mut Progress,
    digests: &mut Vec<FileDigest>,
    sink: &mut dyn OutputSink,
) -> Result<Vec<Drawn>, OutputError> {
    let mut used = UsedPaths::default();
    let mut drawn = Vec::new();
    for figure in &run.plan.report.figures {
        progress.begin(OutputPart::Figures, sink);
        let Some(mut figure) = Undrawn::of(run, figure) else {
            continue;
        };
        used.make_unique(&mut figure.path);
        let path = figure.path.clone();
        let figure = figure.in_vectors();
        let png = OutputFile {
            path: format!("{path}.png"),
            bytes: figure.png()?,
        };
        digests.push(put_file(sink, &png)?);
        let svg = OutputFile {
            path: format!("{path}.svg"),
            bytes: figure.svg.clone().into_bytes(),
        };
        digests.push(put_file(sink, &svg)?);
        drawn.push(figure);
    }
    Ok(drawn)
}

/// Pieces made so far.
struct Progress {
    done: usize,
    total: usize,
}

impl Progress {
    /// Announces the next piece.
    fn begin(&mut self, part: OutputPart, sink: &mut dyn OutputSink) {
        self.done += 1;
        sink.begin(&OutputPiece {
            part,
            number: self.done,
            total: self.total,
        });
    }
}

fn put_file(sink: &mut dyn OutputSink, file: &OutputFile) -> Result<FileDigest, OutputError> {
    sink::put(sink, file).map_err(|error| OutputError::Kept {
        path: file.path.clone(),
        reason: error.to_string(),
    })
}

/// Summary and tables: the files without figures and report.
///
/// # Errors
/// A table that cannot be encoded.
pub fn numbers(run: &Run<'_>) -> Result<Vec<OutputFile>, OutputError> {
    let mut files = vec![summary_file(run)];
    for table in tables::of_run(run) {
        table.put(&mut files)?;
    }
    Ok(files)
}

fn summary_file(run: &Run<'_>) -> OutputFile {
    OutputFile {
        path: SUMMARY.to_owned(),
        bytes: sanitize::json_file(&summary::Summary::of(run)).into_bytes(),
    }
}

/// The curves of the figures as data, for a comparison with another run.
#[must_use]
pub fn figure_data(run: &Run<'_>) -> OutputFile {
    OutputFile {
        path: figures::FIGURE_DATA.to_owned(),
        bytes: figures::data(run).to_json().into_bytes(),
    }
}

/// The figures of a run as vector drawings, for a page: `figures/NAME_FIGURE.svg`.
#[must_use]
pub fn vectors(run: &Run<'_>) -> Vec<OutputFile> {
    let undrawn = run
        .plan
        .report
        .figures
        .iter()
        .filter_map(|figure| Undrawn::of(run, figure));
    undrawn
        .map(|figure| OutputFile {
            path: format!("{}.svg", figure.path),
            bytes: figure.in_vectors().svg.into_bytes(),
        })
        .collect()
}

/// The manifest of these files and of others whose digests (path, SHA-256 in hex) are known.
#[must_use]
pub fn manifest_with(files: &[OutputFile], others: &[FileDigest]) -> OutputFile {
    manifest::with_digests(
        files.iter().filter(|file| file.path != manifest::NAME),
        others,
    )
}
