//! Tables, figures, summary, report and console text: pure functions of plan, record and assessment. Out: bytes; the caller writes them
//! to files. It knows no clock, no file and no environment: the same run gives bit-identical output.
//!
//! | to change | see |
//! |---|---|
//! | the order of the report's sections | `SECTIONS` in `sections/mod.rs`, one file per section beside it |
//! | a sentence of the report | `wording/english.rs` |
//! | the description of a specimen model | `wording/specimen.rs` |
//! | the layout of the report | `document/style.css`, `document/report.typ` |
//! | a figure, a column, the text of one procedure | `procedures/NAME/{figures,tables,report}.rs` |
//! | the appearance of every figure | `figures/draw/`, `figures/chart.rs` |
//! | a number in `summary.json` | `summary/mod.rs` (format), `summary/fill.rs` (values) |
//! | digits, units and signs of numbers | `number/` |
//! | the files of a run, and their order | `output/mod.rs` |
//! | whether a report may be signed | `status/report_status.rs` |

mod budget;
pub mod console;
pub(crate) mod document;
pub mod figures;
pub(crate) mod number;
mod output;
pub mod parquet;
mod run;
pub(crate) mod sections;
pub mod status;
pub mod summary;
pub(crate) mod tables;
pub mod wording;

pub use document::comparison;
pub use figures::{
    Curve, Curves, FIGURE_DATA, FigureAxis, FigureBand, FigureCurve, FigureData, Figures, PlainAxis,
};
pub use output::{
    FileDigest, NullSink, OutputError, OutputFile, OutputPart, OutputPiece, OutputSink, PAGE,
    PAPER, SUMMARY, figure_data, manifest_with, numbers, put_everything, vectors,
};
pub use run::{Build, ClockJump, Provenance, RealRun, Run};
pub use status::{Change, Issue, IssueKind, Issues, ReportStatus, report_status};
pub use summary::{
    CHECK_RUN_FILE, PredictedLimit, PredictedProcedure, PredictedRequirement, PredictedZeros,
    Prediction,
};
pub use tables::put_driven;
