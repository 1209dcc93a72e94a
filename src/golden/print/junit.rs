//! A test report as JUnit XML: a suite for each folder, a case for each plan, a failure with the differences. It contains no time and no
//! host name, so that the same results give the same file.

use quick_junit::{NonSuccessKind, Report as Junit, TestCase, TestCaseStatus, TestSuite};

use super::words::Words;
use crate::golden::tested::{Outcome, Report, Tested};
use psd_text::sanitize::one_line;

/// The report.
///
/// # Errors
/// Never in practice: the report is written to memory.
pub fn junit(report: &Report) -> Result<String, quick_junit::SerializeError> {
    // A suite is counted when it is added: it is complete by then.
    let mut suites: Vec<TestSuite> = Vec::new();
    for tested in &report.tested {
        let plain = one_line(&tested.name);
        let (folder, name) = plain.rsplit_once('/').unwrap_or((".", &plain));
        if suites
            .last()
            .is_none_or(|suite| suite.name.as_str() != folder)
        {
            suites.push(TestSuite::new(folder));
        }
        if let Some(suite) = suites.last_mut() {
            let mut case = TestCase::new(name, status(tested));
            case.set_classname(folder);
            suite.add_test_case(case);
        }
    }
    let mut junit = Junit::new("psd test");
    junit.add_test_suites(suites);
    junit.to_string()
}

fn status(tested: &Tested) -> TestCaseStatus {
    if tested.outcome.is_good() {
        return TestCaseStatus::success();
    }
    let complaint = one_line(&tested.complaint().unwrap_or_default());
    if tested.outcome == Outcome::NotRun {
        let mut status = TestCaseStatus::skipped();
        status.set_message(complaint);
        return status;
    }
    let kind = if matches!(tested.outcome, Outcome::Failed(_)) {
        NonSuccessKind::Error
    } else {
        NonSuccessKind::Failure
    };
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(tested.outcome.name());
    status.set_message(complaint);
    let lines: Vec<String> = tested
        .outcome
        .findings()
        .iter()
        .map(|finding| one_line(&Words::of(finding).line()))
        .collect();
    status.set_description(lines.join("\n"));
    status
}
