//! A comparison as one self-contained HTML file. In: the comparison, and its drawn figures. Out: text.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::html::POLICY;
use psd_text::sanitize;

const STYLE: &str = "body{font:15px/1.45 'DejaVu Sans',Verdana,sans-serif;color:#222;max-width:1100px;margin:2em auto;padding:0 1em}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}table{border-collapse:collapse;font-variant-numeric:tabular-nums}\
th,td{border-bottom:1px solid #ddd;padding:.25em .8em .25em 0;text-align:left;vertical-align:top}td.n{text-align:right;white-space:nowrap}\
th.n{text-align:right}.pass{color:#046b3a}.fail,.error,.aborted{color:#a11}.inconclusive{color:#8a5a00}\
figure{margin:1.5em 0}img{max-width:100%;height:auto}figcaption{color:#555}pre{background:#f5f5f5;padding:.8em;overflow-x:auto}\
.wide{overflow-x:auto}@media print{body{margin:0;max-width:none}}";

/// The data of the page of a comparison: inner lists have one entry per run.
pub struct ComparisonPage<'a> {
    pub names: &'a [String],
    pub verdicts: &'a [String],
    pub results: Vec<ResultTable>,
    /// By requirement.
    pub requirements: &'a [(String, Vec<Option<String>>)],
    pub facts: &'a [(String, Vec<String>)],
    /// The lines of each plan that differ from the first plan.
    pub plans: &'a [(String, Vec<String>)],
}

/// Results of the runs in columns.
pub struct ResultTable {
    pub title: &'static str,
    /// Heads of the columns after the runs.
    pub heads: &'static [&'static str],
    /// Name and cells of each row.
    pub rows: Vec<(String, Vec<String>)>,
}

/// The page; `figures` are captions with PNG bytes.
#[must_use]
pub fn page(comparison: &ComparisonPage<'_>, figures: &[(String, Vec<u8>)]) -> String {
    let runs = comparison.names.len();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head { meta charset="utf-8"; meta http-equiv="Content-Security-Policy" content=(POLICY); meta name="viewport" content="width=device-width, initial-scale=1"; title { "Comparison of runs" } style { (PreEscaped(STYLE)) } }
            body {
                h1 { "Comparison of " (runs) " runs" }
                table {
                    tr { th { "" } th { "run" } th { "verdict" } }
                    @for (index, (name, verdict)) in comparison.names.iter().zip(comparison.verdicts).enumerate() {
                        tr { td { (index + 1) } td { (name) } td class=(verdict) { (verdict) } }
                    }
                }
                @for table in &comparison.results { (results(table, runs)) }
                @if !comparison.requirements.is_empty() {
                    h2 { "Requirements" }
                    div class="wide" { table {
                        (head(runs, &[]))
                        @for (name, verdicts) in comparison.requirements {
                            tr { td { (name) } @for verdict in verdicts { @let word = verdict.as_deref().unwrap_or("—"); td class={ "n " (word) } { (word) } } }
                        }
                    } }
                }
                @if !comparison.facts.is_empty() {
                    h2 { "Differences in plan, settings and rig" }
                    div class="wide" { table {
                        (head(runs, &[]))
                        @for (what, texts) in comparison.facts { tr { td { (what) } @for text in texts { td class="n" { (short(text)) } } } }
                    } }
                }
                @for (name, lines) in comparison.plans { h2 { "Plan of " (name) " against the plan of " (comparison.names[0]) } pre { (lines.join("\n")) } }
                @if !figures.is_empty() {
                    h2 { "Figures" }
                    @for (caption, png) in figures {
                        figure { img alt=(caption) src={ "data:image/png;base64," (STANDARD.encode(png)) }; figcaption { (caption) } }
                    }
                }
            }
        }
    };
    sanitize::page(&page.into_string())
}

fn head(runs: usize, more: &[&str]) -> Markup {
    html! { tr { th { "" } @for run in 1..=runs { th class="n" { (run) } } @for head in more { th class="n" { (head) } } } }
}

fn results(table: &ResultTable, runs: usize) -> Markup {
    html! {
        @if !table.rows.is_empty() {
            h2 { (table.title) }
            div class="wide" { table {
                (head(runs, table.heads))
                @for (name, cells) in &table.rows { tr { td { (name) } @for cell in cells { td class="n" { (cell) } } } }
            } }
        }
    }
}

/// The first digits of a hash, and any other text in full.
fn short(text: &str) -> String {
    if text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        format!("{}…", &text[..12])
    } else {
        text.to_owned()
    }
}
