//! Tables, figures, summary, report and console text: pure functions of plan, record and
//! assessment. Out: bytes; the caller writes them to files. It knows no clock, no file and no
//! environment: the same run gives the same bytes.

mod budget;
pub mod comparison;
pub mod console;
pub(crate) mod content;
mod coverage_factor;
pub(crate) mod days;
mod deviations;
pub(crate) mod document;
pub(crate) mod figures;
mod issue;
mod manifest;
pub(crate) mod number;
mod particulars;
mod prediction;
pub mod report_status;
mod sink;
pub mod specimen_text;
pub mod summary;
pub(crate) mod tables;

pub use figures::{
    Curve, Curves, FIGURE_DATA, FigureAxis, FigureBand, FigureCurve, FigureData, Figures, PlainAxis,
};

use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::plan::{Format, Link, Plan, PlanFile};
use crate::record::equipment::{Device, Equipment};
use crate::record::remote::DrivenStep;
use crate::record::{Drift, Record};
use crate::rig::DeclaredNoise;
use crate::text::sanitize;
use crate::verdict::Assessment;
use figures::{Drawn, Undrawn};

pub use prediction::{
    PredictedLimit, PredictedProcedure, PredictedRequirement, PredictedZeros, Prediction,
    REHEARSAL_FILE,
};

pub use issue::{Change, Issue, IssueKind, Issues};

pub use sink::{Listed, Nowhere, Part, Piece, Shelf};

/// Name of the summary.
pub const SUMMARY: &str = "summary.json";

/// Everything an output is made from.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    pub plan: &'a Plan,
    pub record: &'a Record,
    pub assessment: &'a Assessment,
    pub provenance: &'a Provenance,
}

impl Run<'_> {
    /// What was measured with and held to: as the record tells it, else as plan and rig give it.
    fn equipment(&self) -> Cow<'_, Equipment> {
        let planned = || {
            let noise = match &self.plan.rig.link {
                Link::Virtual(link) => DeclaredNoise {
                    force: link.noise,
                    resolution: link.resolution,
                },
                Link::Real(link) => DeclaredNoise {
                    force: link.readings.noise,
                    resolution: link.readings.resolution,
                },
            };
            Cow::Owned(Equipment::of(
                self.plan,
                Device::of(&self.record.rig, noise),
            ))
        };
        self.provenance
            .equipment
            .as_ref()
            .map_or_else(planned, Cow::Borrowed)
    }
}

/// Where the numbers come from. Nothing here is read from the machine on a virtual rig.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// First 16 hex digits of SHA-256 over plan, used files, `--set` values, seed and version.
    pub run_id: String,
    /// Of its report, where that is not the run's id: another record of the run has another one.
    pub number: Option<String>,
    pub psd_version: String,
    /// Which program of that version.
    pub build: Build,
    /// SHA-256 of the plan's text, hex.
    pub plan_sha256: String,
    /// From the plan or `--date`; of a real run else the day it began.
    pub date: Option<String>,
    /// Of a run on a real rig.
    pub real: Option<RealRun>,
    /// As the record's first line tells it; None where it does not, or where there is none.
    pub equipment: Option<Equipment>,
    /// Of a rehearsal that came to its end: how the whole run would go.
    pub prediction: Option<Prediction>,
    /// Of a report that was issued or amended after the test.
    pub issues: Option<Issues>,
}

impl Provenance {
    /// The id of the report: of its run or its record, but of one that was issued or amended its own.
    #[must_use]
    pub fn report_id(&self) -> &str {
        let own = self.number.as_ref().unwrap_or(&self.run_id);
        self.issues.as_ref().map_or(own, |issues| &issues.report_id)
    }

    /// What an issue of the report states of a particular; the last one counts.
    fn restated(&self, field: &str) -> Option<&str> {
        let mut changes = self
            .issues
            .iter()
            .flat_map(|issues| &issues.all)
            .flat_map(|issue| &issue.changes);
        changes
            .rfind(|change| change.field == field)
            .map(|change| change.is.as_str())
    }

    /// Who stood by, as the record says.
    #[must_use]
    pub fn operator(&self) -> Option<&str> {
        self.real.as_ref().and_then(|real| real.operator.as_deref())
    }
}

/// What a program was made from and with. Of the program that made the run: a report made anew says the same.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Build {
    /// SHA-256 over the digests of its sources, hex.
    pub sources: String,
    /// Target, profile, compiler; empty where the record is older than that.
    pub toolchain: String,
}

/// What the record of a real run says of people and place, and of itself. Times are UTC, ISO 8601.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RealRun {
    pub operator: Option<String>,
    /// The machine that drove the rig.
    pub host: Option<String>,
    pub began: Option<String>,
    /// When the last reading, target or fault was recorded.
    pub ended: Option<String>,
    /// Where the wall clock and the rig's time parted.
    pub jumps: Vec<ClockJump>,
    /// Records, and the hash of the last, which all others lead to; None where the record could not be kept.
    pub sealed: Option<(u64, String)>,
}

/// The wall clock was set, or stood still, between two readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockJump {
    /// Rig time of the reading after it, s.
    pub time: f64,
    /// By which it is ahead of what passed on the rig, s; negative: behind.
    pub seconds: f64,
}

/// A file of the run folder: path with `/`, relative to the folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: String,
    pub bytes: Vec<u8>,
}

/// Why an output could not be made. None of these is the run's fault: its record is whole.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("the table `{table}` could not be written: {reason}")]
    Table { table: String, reason: String },
    #[error("`{path}` could not be kept: {reason}")]
    Kept { path: String, reason: String },
    #[error("the figure `{figure}` of `{procedure}` could not be drawn: {reason}")]
    Figure {
        figure: &'static str,
        procedure: String,
        reason: String,
    },
    #[error("the report could not be set on paper: {0}")]
    Pdf(String),
    #[error("the summary could not be written: {0}")]
    Summary(#[from] serde_json::Error),
}

/// Every file a run leaves, the manifest last.
///
/// # Errors
/// A table, figure or summary that cannot be encoded.
pub fn everything(run: &Run<'_>) -> Result<Vec<OutputFile>, OutputError> {
    let mut files = Vec::new();
    put_everything(run, &mut files)?;
    files.push(manifest::of(&files));
    Ok(files)
}

/// Puts every file a run leaves but the manifest, each as soon as it is made: the numbers first, then the figures one by one, and
/// the report last, for it tells the digests of the tables.
///
/// # Errors
/// A table, figure or summary that cannot be encoded or kept.
pub fn put_everything(run: &Run<'_>, shelf: &mut dyn Shelf) -> Result<Vec<Listed>, OutputError> {
    let tables = tables::of(run);
    let (html, pdf) = (wants(run.plan, Format::Html), wants(run.plan, Format::Pdf));
    let mut work = Work {
        done: 0,
        of: 1 + tables.len() + run.plan.report.figures.len() + usize::from(html) + usize::from(pdf),
    };
    work.begin(Part::Tables, shelf);
    let summary = summary_file(run)?;
    let foretold = run
        .provenance
        .prediction
        .as_ref()
        .map(prediction::file)
        .transpose()?;
    let first = std::iter::once(summary).chain(foretold);
    let mut listed = first
        .map(|file| put_whole(shelf, &file))
        .collect::<Result<Vec<_>, _>>()?;
    let mut of_tables = Vec::with_capacity(tables.len());
    for table in tables {
        work.begin(Part::Tables, shelf);
        of_tables.push(table.put(shelf)?);
    }
    let figures = put_figures(run, &mut work, &mut listed, shelf)?;
    if html || pdf {
        let report = content::document(run, &figures, &of_tables);
        if html {
            work.begin(Part::Report, shelf);
            let page = sanitize::page(&document::html::html(&report));
            let page = OutputFile {
                path: "certificate.html".to_owned(),
                bytes: page.into_bytes(),
            };
            listed.push(put_whole(shelf, &page)?);
        }
        if pdf {
            work.begin(Part::Report, shelf);
            let bytes = document::pdf::pdf(&report).map_err(OutputError::Pdf)?;
            listed.push(put_whole(
                shelf,
                &OutputFile {
                    path: "certificate.pdf".to_owned(),
                    bytes,
                },
            )?);
        }
    }
    listed.extend(of_tables);
    for file in plan_files(run.plan) {
        listed.push(put_whole(shelf, &file)?);
    }
    Ok(listed)
}

/// Draws each figure and puts it before the next is drawn; what the report shows of them stays.
fn put_figures(
    run: &Run<'_>,
    work: &mut Work,
    listed: &mut Vec<Listed>,
    shelf: &mut dyn Shelf,
) -> Result<Vec<Drawn>, OutputError> {
    let mut taken = Taken::default();
    let mut drawn = Vec::new();
    for figure in &run.plan.report.figures {
        work.begin(Part::Figures, shelf);
        let Some(mut figure) = Undrawn::of(run, figure) else {
            continue;
        };
        taken.tell_apart(&mut figure.path);
        let path = figure.path.clone();
        listed.push(put_whole(
            shelf,
            &OutputFile {
                path: format!("{path}.png"),
                bytes: figure.png()?,
            },
        )?);
        let figure = figure.in_vectors()?;
        let svg = OutputFile {
            path: format!("{path}.svg"),
            bytes: figure.svg.clone().into_bytes(),
        };
        listed.push(put_whole(shelf, &svg)?);
        drawn.push(figure);
    }
    Ok(drawn)
}

/// How much of what a run leaves is made.
struct Work {
    done: usize,
    of: usize,
}

impl Work {
    /// The next piece is begun.
    fn begin(&mut self, part: Part, shelf: &mut dyn Shelf) {
        self.done += 1;
        shelf.begin(&Piece {
            part,
            number: self.done,
            of: self.of,
        });
    }
}

fn put_whole(shelf: &mut dyn Shelf, file: &OutputFile) -> Result<Listed, OutputError> {
    sink::put(shelf, file).map_err(|error| OutputError::Kept {
        path: file.path.clone(),
        reason: error.to_string(),
    })
}

/// The files of numbers and words alone: the summary and the tables.
///
/// # Errors
/// A table or a summary that cannot be encoded.
pub fn numbers(run: &Run<'_>) -> Result<Vec<OutputFile>, OutputError> {
    let mut files = vec![summary_file(run)?];
    for table in tables::of(run) {
        table.put(&mut files)?;
    }
    Ok(files)
}

fn summary_file(run: &Run<'_>) -> Result<OutputFile, OutputError> {
    Ok(OutputFile {
        path: SUMMARY.to_owned(),
        bytes: summary::Summary::of(run).to_json()?.into_bytes(),
    })
}

/// What the figures of a run plot, for who holds it against another run.
#[must_use]
pub fn figure_data(run: &Run<'_>) -> OutputFile {
    OutputFile {
        path: FIGURE_DATA.to_owned(),
        bytes: figures::data(run).to_json().into_bytes(),
    }
}

/// The texts of the plan and of what it used, under the names that they have in the run folder.
fn plan_files(plan: &Plan) -> Vec<OutputFile> {
    let file = |file: &PlanFile| OutputFile {
        path: format!("plan/{}", safe_path(&file.name)),
        bytes: file.text.clone().into(),
    };
    let mut files: Vec<OutputFile> = plan.files.iter().map(file).collect();
    tell_apart(files.iter_mut().map(|file| &mut file.path));
    files
}

/// The figures of a run in vectors, for a page: `figures/NAME_FIGURE.svg`.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn vectors(run: &Run<'_>) -> Result<Vec<OutputFile>, OutputError> {
    let undrawn = run
        .plan
        .report
        .figures
        .iter()
        .filter_map(|figure| Undrawn::of(run, figure));
    undrawn
        .map(|figure| {
            let path = format!("{}.svg", figure.path);
            Ok(OutputFile {
                path,
                bytes: figure.in_vectors()?.svg.into_bytes(),
            })
        })
        .collect()
}

/// Puts the table of a client that drove the rig: all that is made of it.
///
/// # Errors
/// It cannot be encoded or kept.
pub fn put_driven(
    steps: &[DrivenStep],
    found: Option<&Drift>,
    shelf: &mut dyn Shelf,
) -> Result<Vec<Listed>, OutputError> {
    tables::put_driven(steps, found, shelf)
}

/// The manifest of files that are made and of others whose digests are known: path and SHA-256 in hex.
#[must_use]
pub fn manifest_with(files: &[OutputFile], others: &[(String, String)]) -> OutputFile {
    manifest::with(
        files.iter().filter(|file| file.path != manifest::NAME),
        others,
    )
}

/// Whether the plan's report asks for a format; a report that names none asks for all.
fn wants(plan: &Plan, format: Format) -> bool {
    plan.report.formats.is_empty() || plan.report.formats.contains(&format)
}

/// A relative path that cannot leave the run folder, each of its parts a plain name on every system.
fn safe_path(name: &str) -> String {
    let parts = name
        .split(['/', '\\'])
        .filter(|part| !matches!(*part, "" | "." | ".."));
    let parts: Vec<String> = parts.map(sanitize::file_part).collect();
    if parts.is_empty() {
        "plan.psd".to_owned()
    } else {
        parts.join("/")
    }
}

/// Paths that differ only in the size of their letters are one file on many systems: the later one gets a number.
fn tell_apart<'a>(paths: impl Iterator<Item = &'a mut String>) {
    let mut taken = Taken::default();
    paths.for_each(|path| taken.tell_apart(path));
}

/// Paths so far, in small letters.
#[derive(Default)]
struct Taken(BTreeSet<String>);

impl Taken {
    fn tell_apart(&mut self, path: &mut String) {
        let own = path.clone();
        let (stem, ending) = match own.rsplit_once('.') {
            Some((stem, ending)) if !ending.contains('/') => (stem, format!(".{ending}")),
            _ => (own.as_str(), String::new()),
        };
        let mut number = 1;
        while !self.0.insert(path.to_lowercase()) {
            number += 1;
            *path = format!("{stem}-{number}{ending}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{safe_path, tell_apart};

    #[test]
    fn a_path_never_leaves_the_run_folder() {
        assert_eq!(safe_path("lib/frame.psd"), "lib/frame.psd");
        assert_eq!(safe_path("../../etc/passwd"), "etc/passwd");
        assert_eq!(safe_path("C:\\plans\\a\n.psd"), "C_/plans/a_.psd");
        assert_eq!(safe_path(".."), "plan.psd");
    }
    #[test]
    fn no_two_files_are_one_where_the_size_of_letters_says_nothing() {
        let mut paths = [
            "tables/hit.csv",
            "tables/Hit.csv",
            "tables/HIT-2.csv",
            "plan/a",
            "plan/A",
        ]
        .map(str::to_owned);
        tell_apart(paths.iter_mut());
        assert_eq!(
            paths,
            [
                "tables/hit.csv",
                "tables/Hit-2.csv",
                "tables/HIT-2-2.csv",
                "plan/a",
                "plan/A-2"
            ]
        );
    }
}
