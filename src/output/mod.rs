//! Pure functions of (plan, record, assessment): tables, figures, summary, certificate, console text. They return
//! bytes; only `cli` writes files.

use crate::plan::Plan;
use crate::record::Record;
use crate::verdict::Assessment;

/// Everything an output is made from.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    pub plan: &'a Plan,
    pub record: &'a Record,
    pub assessment: &'a Assessment,
    pub provenance: &'a Provenance,
}

/// Where the numbers come from. Nothing here is read from the machine on a virtual rig.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// First 16 hex digits of SHA-256 over plan, used files, `--set` values, seed and version.
    pub run_id: String,
    pub psd_version: String,
    /// SHA-256 of the plan's text, hex.
    pub plan_sha256: String,
    /// From the plan or `--date`.
    pub date: Option<String>,
}

/// A file of the run folder: path with `/`, relative to the folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: String,
    pub bytes: Vec<u8>,
}
