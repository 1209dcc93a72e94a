//! Marks that say what a report must not be taken for: boxed words under the verdict, and a word across every page. In: a
//! run. Out: markup and its style. Dark on white and outlined, so that they outlive a grey print and a copy of it.

use maud::{Markup, html};

use super::super::Run;
use super::super::standing::{self, Standing};

/// Style of the word across the page; a page without one has none.
pub(super) fn style(run: &Run<'_>) -> &'static str {
    if across(run).is_empty() { "" } else { include_str!("marks.css") }
}

/// The boxed words, each ground on a line of its own.
pub(super) fn boxed(run: &Run<'_>) -> Markup {
    html! {
        @for ground in standing::grounds(run) {
            div.marks {
                @match ground {
                    Standing::Certifiable => {}
                    Standing::Rehearsal => {
                        span.mark { "REHEARSAL" }
                        span.mark { "NOT CERTIFIABLE" }
                        @if run.record.rig.simulated {
                            span { "Simulated rig: rehearsal, not a test of a specimen." }
                        } @else {
                            span { "Only the gate and the leading stiffness ramps ran on the rig: not the test of the plan." }
                        }
                    }
                    Standing::Incomplete => {
                        span.mark { "INCOMPLETE" }
                        span { "The run did not come to its end." }
                    }
                    Standing::NotCertifiable { missing } => {
                        span.mark { "NOT CERTIFIABLE" }
                        span { "This report lacks " (missing.join("; ")) "." }
                    }
                }
            }
        }
    }
}

/// The words across every page, printed or not. Of a virtual rig that came to its end there is none: nobody takes it for
/// a test.
pub(super) fn watermark(run: &Run<'_>) -> Markup {
    let words = across(run);
    html! {
        @if !words.is_empty() {
            div.watermark aria-hidden="true" { @for word in &words { div { (word) } } }
        }
    }
}

fn across(run: &Run<'_>) -> Vec<&'static str> {
    let real_line = run.plan.rig.link.as_real().is_some();
    let words = standing::grounds(run).into_iter().filter_map(|ground| match ground {
        Standing::Rehearsal if !run.record.rig.simulated => Some("REHEARSAL"),
        Standing::Rehearsal => real_line.then_some("REHEARSAL ON A SIMULATED RIG"),
        Standing::Incomplete => Some("INCOMPLETE"),
        Standing::NotCertifiable { .. } => Some("NOT CERTIFIABLE"),
        Standing::Certifiable => None,
    });
    words.collect()
}
