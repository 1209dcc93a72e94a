//! Messages on subset simulations. In: what the plan writes. Out: diagnostics.

use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

/// `stated`: `runs` or `until`.
pub fn runs_of_subset(sampling: Span, stated: Span) -> Diagnostic {
    Diagnostic::new(
        Code::CannotGrow,
        "a subset simulation ends by its levels and has no number of runs",
    )
    .at(stated, "number of runs")
    .at(sampling, "ends once its levels reach the limit")
    .help("remove `runs` or `until`; `points` and `replicates` of `subset` state the size")
}

pub fn points_of_a_level(points: u32, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("a level has a multiple of ten points, here {points}"),
    )
    .at(span, "a tenth of the points begins the next level")
    .help("write `points: 1000`")
}

pub fn one_rare_failure(study: &str, found: usize, span: Span) -> Diagnostic {
    let message = if found == 0 {
        "no requirement is about a probability of this study".to_owned()
    } else {
        format!("a subset simulation is about one requirement of the plan, here {found}")
    };
    let help = if found == 0 {
        format!(
            "add one, such as `require \"rarely fails\" {study}.probability(fails: \"…\") < 0.001 %`"
        )
    } else {
        "write a study for each requirement".to_owned()
    };
    Diagnostic::new(Code::NothingToDecide, message)
        .at(span, "no distance from a limit")
        .help(help)
}

/// A requirement without a distance from its limit.
pub fn no_distance(label: &str, condition: Span, sampling: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NothingToDecide,
        format!("\"{label}\" does not compare one result with a constant"),
    )
    .at(condition, "no single limit")
    .at(sampling, "its levels approach one limit")
    .help("write one comparison, such as `hit.max_displacement < 50 mm`, or `sampling = random`")
}
