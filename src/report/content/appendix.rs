//! The end of the report: the plan as it was run, where the numbers come from, what may be done with them, signatures. In: a
//! run. Out: blocks, and the plan's files to go with them.

use super::super::document::{Attachment, Block, Column, Table, Text};
use super::super::{Listed, RealRun, Run, issue, plan_files};
use super::{pairs, validation};
use crate::plan::PlanFile;
use crate::text::digest::sha256;
use crate::text::sanitize;

/// Statements, plan, provenance, signatures.
pub(super) fn all(run: &Run<'_>, tables: &[Listed], body: &mut Vec<Block>) {
    // Ahead of what is long, so that no page bears nothing else.
    body.push(Block::section("Statements"));
    body.push(Block::paragraph(format!(
        "These results relate only to the items tested{}. This report is not to be reproduced except in full without the approval \
         of the issuer. Data marked as the plan's were supplied with it and not measured; the issuer answers for what was measured. \
         The report is structured after ISO/IEC 17025:2017, clause 7.8; that is a statement about its form and no claim of \
         accreditation.",
        if run.record.rig.simulated { ", here a virtual specimen on a simulated rig" } else { "" }
    )));
    body.push(Block::section("Plan as run"));
    for (file, kept) in run.plan.files.iter().zip(plan_files(run.plan)) {
        body.push(Block::part(file.name.as_str()));
        printed(file, &kept.path, body);
    }
    body.push(Block::section("Provenance"));
    body.push(provenance(run));
    body.push(Block::part("Files"));
    body.push(files(run, tables));
    body.push(Block::note(if run.plan.rig.link.as_real().is_some() {
        Text::from(
            "The file manifest.sha256 beside this report holds the SHA-256 of every file of the run. The record journal.psdj holds \
             every target, reading and answer; ",
        )
        .code("psd verify")
        .and(" does the run again from it and asks for the same targets, bit for bit.")
    } else {
        Text::from(
            "The file manifest.sha256 beside this report holds the SHA-256 of every file of the run. On a simulated rig the same \
             plan, seed, settings and version give the same bytes.",
        )
    }));
    body.push(Block::part("Validation of the program"));
    validation::all(run, body);
    if !run.plan.report.sign.is_empty() {
        let name = |name: &String| Text::from(format!("{name}: name, date and signature"));
        body.push(Block::Signatures {
            names: run.plan.report.sign.iter().map(name).collect(),
        });
    }
}

/// A file of the language whole; of data the first lines, for a record has thousands.
fn printed(file: &PlanFile, kept: &str, body: &mut Vec<Block>) {
    const FIRST: usize = 8;
    // A tab is seen as the blanks that it stands for.
    let lines: Vec<String> = file
        .text
        .lines()
        .map(|line| sanitize::printed(&line.replace('\t', "    ")))
        .collect();
    let left = lines.len().saturating_sub(FIRST);
    let is_plan = file
        .name
        .rsplit('.')
        .next()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("psd"));
    if is_plan || left <= FIRST {
        body.push(Block::Code { lines });
        return;
    }
    body.push(Block::Code {
        lines: lines.into_iter().take(FIRST).collect(),
    });
    let text = Text::from(format!("and {left} more lines; the whole file is "));
    body.push(Block::note(
        text.code(kept).and(" in the folder of the run."),
    ));
}

/// The plan and every file it used, under the names that they have in the run folder.
pub(super) fn attachments(run: &Run<'_>) -> Vec<Attachment> {
    let named = plan_files(run.plan).into_iter().zip(&run.plan.files);
    named
        .map(|(named, file)| Attachment {
            name: named.path,
            text: file.text.clone(),
        })
        .collect()
}

fn provenance(run: &Run<'_>) -> Block {
    let settings: Vec<String> = run
        .plan
        .settings
        .iter()
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    let settings = if settings.is_empty() {
        "none".to_owned()
    } else {
        settings.join("; ")
    };
    let simulated = if run.record.rig.simulated {
        " (simulated)"
    } else {
        ""
    };
    let mut rows = vec![("Report", Text::new().id(run.provenance.report_id()))];
    rows.extend(issue::first(run).map(|issued| ("Issued", issued.into())));
    rows.extend([
        ("Run", Text::new().id(&run.provenance.run_id)),
        (
            "Program",
            format!("psd {}", run.provenance.psd_version).into(),
        ),
        (
            "Its sources, SHA-256",
            id_or_unknown(&run.provenance.build.sources),
        ),
        ("Built for", known(&run.provenance.build.toolchain)),
        (
            "SHA-256 of the plan",
            Text::new().id(&run.provenance.plan_sha256),
        ),
        ("Settings on the command line", settings.into()),
        ("Rig", format!("{}{simulated}", run.record.rig.name).into()),
        ("Firmware of the rig", known(&run.record.rig.firmware)),
    ]);
    match (&run.provenance.real, run.plan.rig.link.as_virtual()) {
        (Some(real), _) => rows.extend(record(real)),
        (None, Some(link)) => {
            rows.push(("Seed", link.seed.to_string().into()));
            rows.push((
                "Clocks",
                "none: virtual time, and the time a rig would have taken".into(),
            ));
        }
        (None, None) => {}
    }
    pairs(rows)
}

fn known(text: &str) -> Text {
    if text.is_empty() {
        Text::missing("not recorded")
    } else {
        text.into()
    }
}

fn id_or_unknown(digits: &str) -> Text {
    if digits.is_empty() {
        Text::missing("not recorded")
    } else {
        Text::new().id(digits)
    }
}

/// Digests of what went in and of the numbers that came out: with this paper alone the files can be proven.
fn files(run: &Run<'_>, tables: &[Listed]) -> Block {
    let row = |(path, digest): (String, String)| vec![Text::from(path), Text::new().id(digest)];
    let plan = plan_files(run.plan)
        .into_iter()
        .map(|file| (file.path, sha256(&file.bytes)));
    let rows = plan.chain(tables.iter().cloned()).map(row).collect();
    Block::Table(Table {
        columns: vec![
            Column::words("File in the folder of the run", 1),
            Column::short("SHA-256"),
        ],
        rows,
    })
}

/// Who, where and when, and the record that everything here is made from.
fn record(real: &RealRun) -> Vec<(&'static str, Text)> {
    let (records, head) = real
        .sealed
        .as_ref()
        .map_or((None, None), |(records, head)| (Some(records), Some(head)));
    vec![
        ("Operator", Text::given(real.operator.as_deref())),
        ("Machine", Text::given(real.host.as_deref())),
        ("Began, UTC", Text::given(real.began.as_deref())),
        ("Last recorded, UTC", Text::given(real.ended.as_deref())),
        (
            "Clocks",
            "UTC of the machine's clock, as it was set; time on the rig from a clock that only goes forward, begun with the run"
                .into(),
        ),
        ("Records", records.map_or_else(|| Text::given(None), |records| records.to_string().into())),
        ("Head of the record", head.map_or_else(|| Text::given(None), |head| Text::new().id(head))),
    ]
}
