//! Issued reports: what may be stated, in which order, and how it is read back.

use super::*;
use psd::report::RealRun;
use psd_testing::plans::empty_plan;

const TESTED: &str = "2026-11-22";

/// A run on a real rig that ended on that day.
fn provenance() -> Provenance {
    let real = RealRun {
        operator: Some("A. Engineer".to_owned()),
        ended: Some(format!("{TESTED}T10:00:00.000Z")),
        ..RealRun::default()
    };
    Provenance {
        run_id: "run".to_owned(),
        real: Some(real),
        ..Provenance::default()
    }
}

fn one(kind: OneKind, replaces: &str, date: &str, more: &[(&str, &str)]) -> One {
    let own = [("issued", date), ("authorised_by", "Q. Head")];
    let particulars = own
        .iter()
        .chain(more)
        .map(|(field, text)| ((*field).to_owned(), (*text).to_owned()));
    One {
        kind,
        replaces: replaces.to_owned(),
        manifest_sha256: format!("manifest of {replaces}"),
        date: date.to_owned(),
        by: "Q. Head".to_owned(),
        reason: (kind == OneKind::Amendment).then(|| "a wrong name".to_owned()),
        particulars: particulars.collect(),
    }
}

fn applied(file: &IssueFile) -> Result<(Plan, Provenance), String> {
    let (mut plan, mut provenance) = (empty_plan(), provenance());
    apply(&mut plan, &mut provenance, file).map(|()| (plan, provenance))
}

/// Kind, date and particulars of an issue.
type Stated<'a> = (OneKind, &'a str, &'a [(&'a str, &'a str)]);

/// Issues in a chain, each made from the one before it.
fn chain(all: &[Stated<'_>]) -> IssueFile {
    let mut file: Option<IssueFile> = None;
    for (kind, date, more) in all {
        let replaces = file
            .as_ref()
            .map_or("run".to_owned(), |file| file.id("run", file.issues.len()));
        file = Some(IssueFile::after(
            file.as_ref(),
            one(*kind, &replaces, date, more),
        ));
    }
    file.unwrap()
}

#[test]
fn only_particulars_can_be_stated_after_the_test() {
    assert_eq!(may_be_stated("customer"), Ok("customer"));
    assert_eq!(may_be_stated("temperature"), Ok("temperature"));
    assert!(may_be_stated("date").unwrap_err().contains("logged date"));
    assert!(may_be_stated("decision_rule").is_err() && may_be_stated("edition").is_err());
    assert!(
        may_be_stated("custumer")
            .unwrap_err()
            .contains("`customer`")
    );
}

#[test]
fn an_issue_states_and_an_amendment_replaces_it_and_the_record_stays_what_it_is() {
    let file = chain(&[
        (OneKind::Issue, "2026-11-23", &[("temperature", "21 °C")]),
        (
            OneKind::Amendment,
            "2026-12-01",
            &[("operator", "A. Enginer")],
        ),
        (
            OneKind::Amendment,
            "2026-12-01",
            &[("operator", "A. B. Engineer")],
        ),
    ]);
    let (plan, provenance) = applied(&file).unwrap();
    let stated = |field| stated(&plan, field);
    assert_eq!(
        (
            stated("temperature").as_deref(),
            stated("issued").as_deref()
        ),
        (Some("21 °C"), Some("2026-12-01"))
    );
    assert_eq!(stated("operator").as_deref(), Some("A. B. Engineer"));
    assert_eq!(
        provenance.operator(),
        Some("A. Engineer"),
        "the record names the operator"
    );
    let issues = provenance.issues.as_ref().unwrap();
    assert_eq!(
        issues
            .all
            .iter()
            .map(|issue| issue.kind.name())
            .collect::<Vec<_>>(),
        ["issue", "amendment", "amendment"]
    );
    let was: Vec<&str> = issues.all[1..]
        .iter()
        .map(|issue| issue.changes[2].was.as_str())
        .collect();
    assert_eq!(was, ["A. Engineer", "A. Enginer"]);
    assert!(issues.report_id.len() == 16 && provenance.report_id() == issues.report_id);
}

#[test]
fn days_must_be_in_order_and_a_report_is_issued_once() {
    let fault = |all: &[Stated<'_>]| applied(&chain(all)).unwrap_err();
    let issue = |date| (OneKind::Issue, date, &[][..]);
    let amend = |date| (OneKind::Amendment, date, &[][..]);
    assert!(fault(&[issue("2026-11-20")]).contains("the test ended on 2026-11-22"));
    assert!(
        applied(&chain(&[issue("2026-11-21")])).is_ok(),
        "a laboratory's day may be the one before that of UTC"
    );
    assert!(fault(&[issue("2026-11-24"), amend("2026-11-23")]).contains("issued on 2026-11-24"));
    assert!(fault(&[issue("2026-11-24"), issue("2026-11-25")]).contains("issued on 2026-11-24"));
    assert!(fault(&[issue("2026-11-31")]).contains("is not the date of issue"));
    assert!(
        fault(&[(
            OneKind::Issue,
            "2026-11-24",
            &[("receipt_date", "last week")]
        )])
        .contains("is not a date")
    );
    let mut other = chain(&[issue("2026-11-24")]);
    other.issues[0].date = "2026-11-25".to_owned();
    assert!(
        applied(&other)
            .unwrap_err()
            .contains("is not the date of issue")
    );
}

#[test]
fn the_file_has_one_form_and_an_id_that_depends_on_all_of_it() {
    let file = chain(&[(OneKind::Issue, "2026-11-23", &[])]);
    assert_eq!(IssueFile::read(file.json().as_bytes()), Ok(file.clone()));
    assert!(IssueFile::read(file.json().trim_end().as_bytes()).is_err());
    assert!(IssueFile::read(file.json().replace("\"by\"", "\"bye\"").as_bytes()).is_err());
    let other = chain(&[(OneKind::Issue, "2026-11-24", &[])]);
    assert_eq!(file.id("run", 0), "run");
    assert!(file.id("run", 1) != other.id("run", 1) && file.id("run", 1) != file.id("other", 1));
    assert!(file.replaces("manifest of run") && !file.replaces("manifest of another"));
}
