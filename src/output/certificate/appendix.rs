//! The end of the certificate: the plan as it was run, where the numbers come from, signatures, and the explicit end.

use maud::{Markup, html};

use super::super::{RealRun, Run};
use super::{given, pairs};

/// Plan, provenance, signatures, end.
pub(super) fn all(run: &Run<'_>) -> Markup {
    html! {
        section {
            h2 { "Plan as run" }
            @for file in &run.plan.files {
                h3 { (file.name) }
                pre {
                    @for (index, line) in file.text.lines().enumerate() {
                        span.n { (index + 1) } (line) "\n"
                    }
                }
            }
        }
        section {
            h2 { "Provenance" }
            (provenance(run))
            p.note {
                "The file manifest.sha256 beside this report holds the SHA-256 of every file of the run. "
                @if run.plan.rig.link.as_real().is_some() {
                    "The record journal.psdj holds every target, reading and answer; " code { "psd verify" } " does the run again from it "
                    "and asks for the same targets, bit for bit."
                } @else { "On a simulated rig the same plan, seed, settings and version give the same bytes." }
            }
        }
        (signatures(&run.plan.report.sign))
        footer {
            p {
                "These results relate only to the items tested" @if run.record.rig.simulated { ", here a virtual specimen on a simulated rig" }
                ". This report is not to be reproduced except in full without the approval of the issuer. It is structured after "
                "ISO/IEC 17025:2017, clause 7.8; that is a statement about its form and no claim of accreditation."
            }
            p.end { "— End of report, run " (run.provenance.run_id) " —" }
        }
    }
}

fn provenance(run: &Run<'_>) -> Markup {
    let link = run.plan.rig.link.as_virtual().copied().unwrap_or_default();
    let settings: Vec<String> = run.plan.settings.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let settings = if settings.is_empty() { "none".to_owned() } else { settings.join("; ") };
    let mut rows = vec![
        ("Run id".to_owned(), html! { span.id { (run.provenance.run_id) } }),
        ("Program".to_owned(), html! { "psd " (run.provenance.psd_version) }),
        ("SHA-256 of the plan".to_owned(), html! { span.id { (run.provenance.plan_sha256) } }),
        ("Settings on the command line".to_owned(), html! { (settings) }),
        ("Rig".to_owned(), html! { (run.record.rig.name) @if run.record.rig.simulated { " (simulated)" } }),
    ];
    match &run.provenance.real {
        Some(real) => rows.extend(record(real)),
        None if run.record.rig.simulated => rows.push(("Seed".to_owned(), html! { (link.seed) })),
        None => {}
    }
    pairs(&rows)
}

/// Who, where and when, and the record that everything here is made from.
fn record(real: &RealRun) -> Vec<(String, Markup)> {
    let (records, head) = real.sealed.as_ref().map_or((None, None), |(records, head)| (Some(records), Some(head)));
    vec![
        ("Operator".to_owned(), given(real.operator.as_deref())),
        ("Machine".to_owned(), given(real.host.as_deref())),
        ("Began, UTC".to_owned(), given(real.began.as_deref())),
        ("Last recorded, UTC".to_owned(), given(real.ended.as_deref())),
        ("Records".to_owned(), records.map_or_else(|| given(None), |records| html! { (records) })),
        ("Head of the record".to_owned(), head.map_or_else(|| given(None), |head| html! { span.id { (head) } })),
    ]
}

/// A line for each who signs; a report that names nobody has none.
fn signatures(names: &[String]) -> Markup {
    html! {
        @if !names.is_empty() {
            div.signatures { @for name in names { div { (name) ", date and signature" } } }
        }
    }
}
