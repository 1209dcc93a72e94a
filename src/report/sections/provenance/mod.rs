//! Provenance: identifiers, program and clocks, and the digests of plan and tables. In: a run. Out: blocks.

mod validation;

pub(super) use validation::{self_test, validation};

use super::{Source, pairs};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::output::paths::plan_files;
use crate::report::output::sink::FileDigest;
use crate::report::run::{RealRun, Run};
use crate::report::status::issue;
use crate::report::wording::provenance as wording;
use psd_text::digest::sha256;

/// The section.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    body.push(origin(run));
    body.push(Block::part(wording::FILES));
    body.push(files(run, source.tables));
    body.push(Block::note(if run.plan.rig.link.as_real().is_some() {
        Text::from(wording::MANIFEST_REAL)
            .code("psd verify")
            .and(wording::VERIFIES)
    } else {
        Text::from(wording::MANIFEST_SIMULATED)
    }));
}

/// Identifiers, program, settings, seed; of a real run operator, machine and times. The rig is in the annex of the equipment.
fn origin(run: &Run<'_>) -> Block {
    let provenance = run.provenance;
    let run_id = Text::new().id(&provenance.run_id);
    let mut rows = if provenance.report_id() == provenance.run_id {
        vec![(wording::REPORT_AND_RUN, run_id)]
    } else {
        vec![
            (wording::REPORT, Text::new().id(provenance.report_id())),
            (wording::RUN, run_id),
        ]
    };
    rows.extend(
        issue::first(provenance.issues.as_ref()).map(|issued| (wording::ISSUED, issued.into())),
    );
    rows.extend([
        (
            wording::PROGRAM,
            format!("psd {}", provenance.psd_version).into(),
        ),
        (wording::SOURCES, id_or_unknown(&provenance.build.sources)),
        (wording::BUILT_FOR, recorded(&provenance.build.toolchain)),
    ]);
    let settings = run.plan.settings.iter();
    let settings: Vec<String> = settings
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    if !settings.is_empty() {
        rows.push((wording::SETTINGS, settings.join("; ").into()));
    }
    match (&provenance.real, run.plan.rig.link.as_virtual()) {
        (Some(real), _) => rows.extend(record(real)),
        (None, Some(link)) => rows.push((wording::SEED, link.seed.to_string().into())),
        (None, None) => {}
    }
    pairs(rows)
}

fn recorded(text: &str) -> Text {
    if text.is_empty() {
        Text::missing(wording::NOT_RECORDED)
    } else {
        text.into()
    }
}

fn id_or_unknown(digits: &str) -> Text {
    if digits.is_empty() {
        Text::missing(wording::NOT_RECORDED)
    } else {
        Text::new().id(digits)
    }
}

/// The ending of a table as text.
const TEXT: &str = ".csv";

/// Digests of the files of the plan and of the tables. With them the paper alone is enough to verify the files.
fn files(run: &Run<'_>, tables: &[FileDigest]) -> Block {
    let row = |(path, digest): FileDigest| vec![Text::from(path), Text::new().id(digest)];
    let plan = plan_files(run.plan)
        .into_iter()
        .map(|file| (file.path, sha256(&file.bytes)));
    // The two formats of a table hold the same numbers.
    let is_text = |(path, _): &&FileDigest| path.ends_with(TEXT);
    let tables: Vec<&FileDigest> = if tables.iter().any(|table| is_text(&table)) {
        tables.iter().filter(is_text).collect()
    } else {
        tables.iter().collect()
    };
    let [path, digest] = wording::FILE_COLUMNS;
    Block::Table(Table {
        columns: vec![Column::words(path, 1), Column::short(digest)],
        rows: plan.chain(tables.into_iter().cloned()).map(row).collect(),
    })
}

/// Operator, machine, times and the run log of a real run.
fn record(real: &RealRun) -> Vec<(&'static str, Text)> {
    let (records, head) = real
        .sealed
        .as_ref()
        .map_or((None, None), |(records, head)| (Some(records), Some(head)));
    vec![
        (wording::OPERATOR, Text::given(real.operator.as_deref())),
        (wording::MACHINE, Text::given(real.host.as_deref())),
        (wording::BEGAN, Text::given(real.began.as_deref())),
        (wording::LAST_RECORDED, Text::given(real.ended.as_deref())),
        (wording::CLOCKS, wording::REAL_CLOCKS.into()),
        (
            wording::RECORDS,
            records.map_or_else(|| Text::given(None), |records| records.to_string().into()),
        ),
        (
            wording::HEAD,
            head.map_or_else(|| Text::given(None), |head| Text::new().id(head)),
        ),
    ]
}
