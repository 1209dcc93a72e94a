//! The certificate: one self-contained HTML page, structured after ISO/IEC 17025 clause 7.8. In: a run and its drawn
//! figures. Out: HTML without scripts and without anything to load; every text of the plan is escaped by the template.

mod appendix;
mod conditions;
mod contact_log;
mod cycles;
mod equipment;
mod head;
mod marks;
mod results;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::Run;
use super::figures::Drawn;

/// Only inline style and embedded pictures: a label that smuggled markup in would still load and run nothing.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The whole page.
pub(super) fn html(run: &Run<'_>, figures: &[Drawn]) -> String {
    // Of a real rig the first page says what went otherwise than planned.
    let is_real = run.plan.rig.link.as_real().is_some();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title(run)) " · " (run.provenance.run_id) }
                style { (PreEscaped(style(run))) }
            }
            body {
                (marks::watermark(run))
                (head::title_and_verdict(run))
                @if is_real {
                    (head::deviations(run))
                    (head::requirements(run))
                } @else {
                    (head::requirements(run))
                    (head::deviations(run))
                }
                (results::procedures(run))
                (results::figures(figures))
                (conditions::all(run))
                (appendix::all(run))
            }
        }
    };
    page.into_string()
}

/// The style with the run's name at the foot of every printed page. The run id is hexadecimal; anything else is left out.
fn style(run: &Run<'_>) -> String {
    let id: String = run.provenance.run_id.chars().filter(char::is_ascii_alphanumeric).collect();
    let foot =
        format!("@page {{ @bottom-left {{ content: \"run {id}\"; font: 8pt \"DejaVu Sans\", sans-serif; color: #5d6870; }} }}\n");
    include_str!("style.css").to_owned() + marks::style(run) + &foot
}

fn title<'a>(run: &Run<'a>) -> &'a str {
    run.plan.report.title.as_deref().unwrap_or(&run.plan.title)
}

/// A table of names and values.
fn pairs(rows: &[(String, Markup)]) -> Markup {
    html! {
        table.pairs {
            tbody {
                @for (name, value) in rows {
                    tr { th scope="row" { (name) } td { (value) } }
                }
            }
        }
    }
}

/// A text of the plan, or that it was not given.
fn given(text: Option<&str>) -> Markup {
    match text {
        Some(text) if !text.is_empty() => html! { (text) },
        _ => html! { span.missing { "not given" } },
    }
}

/// `max_displacement` → `max displacement`.
fn words(name: &str) -> String {
    name.replace('_', " ")
}
