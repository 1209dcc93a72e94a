//! Statements of the outputs about a run on a real rig: its status, its equipment, its record.

use psd::report::{Change, Issue, IssueKind, Issues, RealRun, console};
use psd::report::{ReportStatus, report_status};
use psd_plan::record::{Event, EventKind, Outcome};
use psd_plan::{
    Calibration, Datum, DeviceLink, Dialect, Format, Interval, Link, PortPlan, PretestCheck,
    ReadingRules, RealLink, SafeState,
};

use super::fixture::{Finished, finished};
use super::{files, text};

/// A test of a specimen with complete data.
fn real() -> Finished {
    let mut finished = finished();
    // The tests here do not read a figure, a table or a PDF.
    finished.plan.report.figures.clear();
    finished.plan.report.formats = vec![Format::Html];
    finished.plan.rig.link = Link::Real(RealLink {
        actuator: DeviceLink {
            port: PortPlan::Serial {
                path: "/dev/ttyUSB7".into(),
                baud: 115_200,
            },
            dialect: Dialect::Native,
            reply_timeout: 0.1,
            serial_number: Some("PSD-0001".into()),
        },
        load_cell: Some(DeviceLink {
            port: PortPlan::Tcp {
                address: "10.0.0.7:5025".into(),
            },
            dialect: Dialect::Indicator,
            reply_timeout: 0.1,
            serial_number: None,
        }),
        safe_state: SafeState::Hold,
        datum: Datum::Machine,
        pretest_check: PretestCheck {
            zero: 20.0,
            probe: 20e-6,
            stiffness: Interval {
                low: 250e3,
                high: 350e3,
            },
        },
        readings: ReadingRules {
            samples: 5,
            rate: 100.0,
            resolution: 1e-6,
            noise: 2.0,
            force_range: Interval {
                low: -15e3,
                high: 15e3,
            },
            frozen_after: 50,
        },
        watchdog: 2.0,
        own_speed: 1e-3,
        axes: Vec::new(),
    });
    finished.plan.particulars = [
        ("standard", "SOP 17"),
        ("specimen_id", "B-17"),
        ("laboratory", "Test House"),
        ("address", "1 Mill Lane"),
        ("customer", "Somebody Ltd"),
        ("contact", "test@example.org"),
        ("issued", "2027-03-02"),
        ("authorised_by", "Q. Head"),
        ("receipt_date", "2027-02-20"),
    ]
    .map(|(field, text)| (field, text.to_owned()))
    .to_vec();
    finished.plan.rig.calibration = Calibration {
        reference: Some("UKAS 4711".into()),
        due: Some("2027-03-01".into()),
        force_calibrated: Some(Interval {
            low: 10.0,
            high: 12e3,
        }),
        displacement_calibrated: Some(Interval {
            low: 0.0,
            high: 0.2,
        }),
        ..Calibration::default()
    };
    finished.provenance.date = Some("2027-02-28".into());
    finished.record.rig.simulated = false;
    finished.record.rig.boot = Some("7F3A".into());
    finished.provenance.real = Some(RealRun {
        operator: Some("A. Tester".into()),
        host: Some("rig-pc".into()),
        began: Some("2027-02-28T23:58:00.000Z".into()),
        ended: Some("2027-03-01T00:04:00.000Z".into()),
        jumps: Vec::new(),
        sealed: Some((1234, "c0ffee".repeat(10) + "abcd")),
    });
    finished
}

fn missing(finished: &Finished) -> Vec<String> {
    match ReportStatus::of(&finished.run()) {
        ReportStatus::NotIssuable { missing } => missing,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_report_of_a_real_run_with_every_particular_is_issued_and_names_its_equipment() {
    let finished = real();
    assert_eq!(ReportStatus::of(&finished.run()), ReportStatus::Issued);
    let files = files(&finished);
    let html = text(&files, "report.html").replace('\u{a0}', " ");
    for expected in [
        "serial, 115200 baud",
        "TCP",
        "only serial number PSD-0001",
        "7F3A",
        "UKAS 4711",
        "valid</span> on 2027-03-01",
        "0.01 kN to 12 kN",
        "displacement to 1 µm",
        "median of 5 settled readings",
        "at most 20 N at rest; 250 kN/m to 350 kN/m in a move of 20 µm",
        "A. Tester",
        "rig-pc",
        "<td>1234</td>",
        "c0ffee",
    ] {
        assert!(html.contains(expected), "{expected}");
    }
    for secret in [
        "ttyUSB7",
        "10.0.0.7",
        "class=\"watermark\"",
        "SIMULATION",
        "NOT ISSUABLE",
        "Seed",
    ] {
        assert!(!html.contains(secret), "{secret}");
    }
    let summary: serde_json::Value = serde_json::from_str(text(&files, "summary.json")).unwrap();
    assert_eq!(
        (&summary["report_status"], &summary["record"]["records"]),
        (&"issued".into(), &1234.into())
    );
    assert_eq!(
        summary["procedures"]["hit"]["results"]["contacts"]["value"].to_string(),
        "6"
    );
    assert!(!console::verdict_text(&finished.run(), false).contains("ISSUABLE"));
}

#[test]
fn what_a_report_must_state_and_lacks_is_named() {
    let mut anonymous = real();
    anonymous.provenance.real.as_mut().unwrap().operator = Some("  ".into());
    assert_eq!(missing(&anonymous), ["the operator's name"]);
    let mut uncalibrated = real();
    uncalibrated.plan.rig.calibration = Calibration::default();
    let ranges =
        ["displacement", "force"].map(|channel| format!("the calibrated range of the {channel}"));
    let lacks = [
        "the reference of the calibration",
        &ranges[0],
        &ranges[1],
        "the due date of the calibration",
    ];
    assert_eq!(missing(&uncalibrated), lacks);
    // It was valid when the run began, and not when it ended, a day later.
    let mut expired = real();
    expired.plan.rig.calibration.due = Some("2027-02-28".into());
    assert_eq!(
        missing(&expired),
        ["a valid calibration (due 2027-02-28, test ended 2027-03-01)"]
    );
    let files = files(&expired);
    let html = text(&files, "report.html");
    assert!(
        html.contains("class=\"watermark\"")
            && html.contains("NOT ISSUABLE")
            && html.contains("OVERDUE</span> on 2027-03-01")
    );
    // The requirements are met, and nothing is green.
    assert!(html.contains("NOT ISSUABLE: all ") && !html.contains("class=\"verdict pass\""));
    assert_eq!(
        report_status::overdue(&expired.plan, "2027-03-01"),
        ["the calibration was due on 2027-02-28"]
    );
    assert_eq!(report_status::overdue(&expired.plan, "2027-02-28"), [""; 0]);
    assert!(
        console::verdict_text(&expired.run(), false)
            .contains("(NOT ISSUABLE: lacks a valid calibration")
    );
    // Without times in the record, the plan's own date is used. An invalid date counts as missing.
    let mut undated = real();
    undated.provenance.real = Some(RealRun {
        operator: Some("A. Tester".into()),
        ..RealRun::default()
    });
    undated.provenance.date = Some("next week, perhaps".into());
    assert_eq!(missing(&undated), ["the day of the test"]);
    undated.provenance.date = Some("2027-02-28".into());
    assert_eq!(ReportStatus::of(&undated.run()), ReportStatus::Issued);
}

#[test]
fn a_test_that_was_stopped_is_reported_as_what_it_is() {
    let mut aborted = real();
    aborted.record.outcome = Outcome::Aborted {
        reason: "stopped on request".into(),
    };
    assert_eq!(ReportStatus::of(&aborted.run()), ReportStatus::Issued);
    let html = files(&aborted);
    assert!(text(&html, "report.html").contains("<div>INCOMPLETE</div>"));
    // Without a release nothing was tested.
    aborted.record.outcome = Outcome::NotReleased {
        reason: "declined".into(),
    };
    assert_eq!(missing(&aborted), ["a test: the motion was not released"]);
}

#[test]
fn readings_outside_the_calibrated_range_are_reported() {
    let deviations_of = |force: [f64; 2], displacement: [f64; 2]| -> Vec<String> {
        let mut finished = real();
        let range = |[low, high]: [f64; 2]| Some(Interval { low, high });
        finished.plan.rig.calibration.force_calibrated = range(force);
        finished.plan.rig.calibration.displacement_calibrated = range(displacement);
        let summary: serde_json::Value =
            serde_json::from_str(text(&files(&finished), "summary.json")).unwrap();
        let deviations = summary["deviations"]
            .as_array()
            .unwrap()
            .iter()
            .map(|text| text.as_str().unwrap().to_owned());
        deviations
            .filter(|text| text.contains("calibrated"))
            .collect()
    };
    // At most 157 mm and 51.6 N.
    assert_eq!(deviations_of([10.0, 100.0], [0.0, 0.2]), [""; 0]);
    let (weak, far) = (
        deviations_of([300.0, 15e3], [0.0, 0.2]),
        deviations_of([0.0, 100.0], [0.0, 0.1]),
    );
    assert!(
        weak.len() == 1
            && weak[0].starts_with("The largest force, ")
            && weak[0].contains("is below its calibrated range"),
        "{weak:?}"
    );
    assert!(
        far.len() == 1
            && far[0].starts_with("The largest displacement, ")
            && far[0].contains("is above"),
        "{far:?}"
    );
}

fn particulars_missing(change: impl FnOnce(&mut Vec<(&'static str, String)>)) -> Vec<String> {
    let mut finished = real();
    change(&mut finished.plan.particulars);
    match ReportStatus::of(&finished.run()) {
        ReportStatus::Draft { missing } => missing,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_report_without_what_every_report_states_is_a_draft_and_names_it() {
    for (field, name) in [
        ("standard", "method"),
        ("specimen_id", "item tested"),
        ("laboratory", "laboratory"),
        ("address", "address"),
        ("customer", "customer"),
        ("contact", "contact"),
        ("issued", "date of issue"),
        ("authorised_by", "authorised by"),
    ] {
        assert_eq!(
            particulars_missing(|all| all.retain(|(own, _)| *own != field)),
            [name]
        );
        let blank = |all: &mut Vec<(&'static str, String)>| {
            all.iter_mut().find(|(own, _)| *own == field).unwrap().1 = " ".into();
        };
        assert_eq!(particulars_missing(blank), [name]);
    }
    // Particulars that concern only some tests are listed as missing, and block nothing.
    let mut bare = real();
    bare.plan
        .particulars
        .retain(|(field, _)| *field != "receipt_date");
    assert_eq!(ReportStatus::of(&bare.run()), ReportStatus::Issued);
    assert!(text(&files(&bare), "report.html").contains("Not given: Condition, Item received."));

    bare.plan.particulars.clear();
    let files = files(&bare);
    let html = text(&files, "report.html");
    for expected in [
        "<div>DRAFT</div>",
        "7.8.2.1. Missing: laboratory; address; ",
    ] {
        assert!(html.contains(expected), "{expected}");
    }
    assert!(
        html.contains("Not given: Condition, Item received."),
        "what the mark names is not told twice"
    );
    let summary: serde_json::Value = serde_json::from_str(text(&files, "summary.json")).unwrap();
    assert_eq!(
        (
            &summary["report_status"],
            summary["missing"].as_array().unwrap().len()
        ),
        (&"draft".into(), 8)
    );
    let line = console::verdict_text(&bare.run(), false);
    assert!(
        line.contains("(DRAFT: `psd issue` adds laboratory, address, "),
        "{line}"
    );
    // A simulation is not issuable.
    bare.record.rig.simulated = true;
    assert_eq!(
        ReportStatus::reasons(&bare.run()),
        [ReportStatus::Simulation]
    );
}

#[test]
fn dates_out_of_order_are_reported() {
    let dated = |field: &'static str, day: &str| {
        let day = day.to_owned();
        particulars_missing(|all| {
            all.retain(|(own, _)| *own != field);
            all.push((field, day));
        })
    };
    // Tested from 2027-02-28 to 2027-03-01 (UTC).
    assert_eq!(
        dated("issued", "2020-01-01"),
        ["days in their order (tested 2027-03-01, issued 2020-01-01)"]
    );
    assert_eq!(
        dated("issued", "2027-02-27"),
        ["days in their order (tested 2027-03-01, issued 2027-02-27)"]
    );
    assert_eq!(
        dated("receipt_date", "2027-03-02"),
        ["days in their order (received 2027-03-02, tested 2027-02-28)"]
    );
    assert_eq!(
        dated("receipt_date", "in spring"),
        ["a valid day of receipt (found “in spring”)"]
    );
    let mut near = real();
    for (field, day) in [("issued", "2027-02-28"), ("receipt_date", "2027-03-01")] {
        near.plan.particulars.retain(|(own, _)| *own != field);
        near.plan.particulars.push((field, day.into()));
    }
    assert_eq!(
        ReportStatus::of(&near.run()),
        ReportStatus::Issued,
        "the days of a laboratory may be one off those of UTC"
    );
}

#[test]
fn an_amended_name_of_the_operator_is_on_the_first_page_and_not_in_the_provenance() {
    let mut amended = real();
    let change = Change {
        field: "operator",
        was: "A. Tester".into(),
        is: "A. B. Tester".into(),
    };
    let issue = Issue {
        kind: IssueKind::Amendment,
        replaces: "0123".into(),
        date: "2027-03-09".into(),
        by: "B. Editor".into(),
        reason: Some("a letter".into()),
        changes: vec![change],
    };
    amended
        .plan
        .particulars
        .push(("operator", "A. B. Tester".into()));
    amended.provenance.issues = Some(Issues {
        report_id: "4567".into(),
        all: vec![issue],
    });
    let files = files(&amended);
    let html = text(&files, "report.html");
    assert!(html.contains("Operator</dt><dd>A. B. Tester</dd>"));
    assert!(
        html.contains("Operator</th><td>A. Tester</td>"),
        "the record says who stood by"
    );
    let summary: serde_json::Value = serde_json::from_str(text(&files, "summary.json")).unwrap();
    assert_eq!(summary["record"]["operator"], "A. Tester");
}

#[test]
fn a_simulated_rig_on_a_real_line_is_marked_across_the_page_whatever_else_is_wrong() {
    let mut emulated = real();
    emulated.record.rig.simulated = true;
    assert_eq!(ReportStatus::of(&emulated.run()), ReportStatus::Simulation);
    emulated.record.outcome = Outcome::Aborted {
        reason: "stopped on request".into(),
    };
    assert_eq!(
        ReportStatus::reasons(&emulated.run()),
        [ReportStatus::Simulation]
    );
    let files = files(&emulated);
    let html = text(&files, "report.html");
    assert!(html.contains("<div>SIMULATION</div><div>INCOMPLETE</div>"));
    // A virtual rig states this too, because any single page may be copied without the others.
    assert!(text(super::made(), "report.html").contains("<div>SIMULATION</div>"));
}

#[test]
fn deviations_are_on_the_first_page_and_inspections_in_an_annex() {
    let mut finished = real();
    let event = |kind, text: &str| Event {
        time: 1.0,
        procedure: None,
        step: None,
        kind,
        text: text.into(),
    };
    finished
        .plan
        .particulars
        .push(("deviations", "The supports were greased".into()));
    finished.record.events = vec![
        event(EventKind::Note, "pre-test check passed: 0.1 N at rest"),
        event(EventKind::Note, "line: 3 frames sent again"),
        event(EventKind::Resume, "resumed by B. Second: power came back"),
        event(EventKind::Inspection, "look: no crack (A. Tester)"),
    ];
    let files = files(&finished);
    let html = text(&files, "report.html");
    let at = |words: &str| html.find(words).unwrap_or_else(|| panic!("{words}"));
    let order = [
        "The supports were greased.",
        "Line: 3 frames sent again.",
        "resumed by B. Second",
        ">Results</h2>",
        "Pre-test check: results</th><td>0.1 N at rest",
        "no crack (A. Tester)",
    ];
    assert!(order.map(at).is_sorted(), "{:?}", order.map(at));
}
