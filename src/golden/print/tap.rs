//! A test report in the Test Anything Protocol, version 13, as `prove` reads it: differences are in a YAML block.

use std::fmt::Write as _;

use super::words::Words;
use crate::golden::tested::{Outcome, Report};
use psd_text::sanitize;

/// The report, with one line per plan.
#[must_use]
pub fn tap(report: &Report) -> String {
    let mut text = format!("TAP version 13\n1..{}\n", report.tested.len());
    for (index, tested) in report.tested.iter().enumerate() {
        let result = if tested.outcome.is_good() || tested.outcome == Outcome::NotRun {
            "ok"
        } else {
            "not ok"
        };
        let skip = if tested.outcome == Outcome::NotRun {
            " # SKIP the test ended at the first failure"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "{result} {} - {}{skip}",
            index + 1,
            plain(&tested.name)
        );
        if result == "ok" {
            continue;
        }
        let complaint = tested.complaint().unwrap_or_default();
        let _ = writeln!(
            text,
            "  ---\n  message: {}\n  severity: fail",
            quoted(&complaint)
        );
        if !tested.outcome.findings().is_empty() {
            text.push_str("  differences:\n");
            for finding in tested.outcome.findings() {
                let _ = writeln!(text, "    - {}", quoted(&Words::of(finding).line()));
            }
        }
        text.push_str("  ...\n");
    }
    for folder in &report.unused {
        let _ = writeln!(text, "# unused: {}", plain(folder));
    }
    text
}

/// A description without control characters of the protocol: `#` begins a directive.
fn plain(text: &str) -> String {
    sanitize::one_line(text).replace('#', "＃")
}

/// A JSON string is a YAML string.
fn quoted(text: &str) -> String {
    sanitize::json(&serde_json::Value::from(text).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::finding::{Change, Finding, FindingPart};
    use crate::golden::tested::Tested;

    #[test]
    fn a_failure_carries_its_differences_and_a_name_steers_nothing() {
        let tested = |name: &str, outcome| Tested {
            name: name.to_owned(),
            folder: "reports".to_owned(),
            outcome,
        };
        let found = vec![
            Finding::text(FindingPart::Verdict, "verdict", "pass", "fail"),
            Finding::new(FindingPart::Table, "table of k0", Change::Missing),
        ];
        let report = Report {
            tested: vec![
                tested(
                    "plans/a",
                    Outcome::Same {
                        verdict: Some("pass"),
                    },
                ),
                tested("plans/b # SKIP", Outcome::Differs(found)),
                tested("plans/c", Outcome::NotRun),
            ],
            unused: vec!["reports/old".to_owned()],
        };
        assert_eq!(
            tap(&report),
            "TAP version 13\n1..3\nok 1 - plans/a\nnot ok 2 - plans/b ＃ SKIP\n  ---\n  message: \"2 differences from the \
             accepted results\"\n  severity: fail\n  differences:\n    - \"verdict  \\\"pass\\\" → \\\"fail\\\"\"\n    - \"table of \
             k0  accepted, but missing now\"\n  ...\nok 3 - plans/c # SKIP the test ended at the first failure\n\
             # unused: reports/old\n"
        );
    }
}
