//! `issue.json`: the data stated for a report after the test. In: the particulars, the day, the issuer and, for an amendment, the reason.
//! Out: the file, its report id, and plan and provenance with the stated data. It changes only particulars of the `plan` block: the run
//! log in the issued folder is unchanged, and every number comes from it.

use psd_plan::schema::plan_block;
use serde::{Deserialize, Serialize};

use super::folder::Folder;
use super::names::ISSUE;
use psd::report::status::days::{day, days_after, last_day};
use psd::report::{Change, Issue, IssueKind, Issues, Provenance};
use psd_language::syntax::limits::TEXT_BYTES;
use psd_plan::Plan;
use psd_plan::schema::{self, FieldType, Kind};
use psd_text::digest::sha256;
use psd_text::sanitize;
use psd_text::sanitize::one_line;
use psd_text::suggest::nearest;

/// Name and version of the format.
const SCHEMA: &str = "psd.issue/1";

/// The day of the test stays as recorded.
const FIXED: &[&str] = &[plan_block::DATE.name];

/// The file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IssueFile {
    schema: String,
    /// In order: each is made from the report before it.
    issues: Vec<One>,
}

/// One issue.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct One {
    pub kind: OneKind,
    /// Id of the report that it is made from.
    pub replaces: String,
    /// SHA-256 of the manifest of that report, hex: it identifies the report exactly.
    pub manifest_sha256: String,
    /// `YYYY-MM-DD`
    pub date: String,
    pub by: String,
    /// The reason of an amendment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Field and text; an empty text removes the field.
    pub particulars: Vec<(String, String)>,
}

/// The kind of an issue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OneKind {
    Issue,
    Amendment,
}

impl IssueFile {
    /// The earlier issues, and one more.
    pub fn after(before: Option<&Self>, one: One) -> Self {
        let before = before.map_or_else(Vec::new, |file| file.issues.clone());
        Self {
            schema: SCHEMA.to_owned(),
            issues: [before, vec![one]].concat(),
        }
    }

    /// The file of a folder, if it has one.
    pub fn of(folder: &Folder) -> Result<Option<Self>, String> {
        let Some(held) = folder.files.get(ISSUE) else {
            return Ok(None);
        };
        let read = Self::read(held.bytes().unwrap_or_default());
        read.map(Some).map_err(|fault| format!("`{ISSUE}` {fault}"))
    }

    /// Reads the file. Only its canonical form is accepted.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let file: Self =
            serde_json::from_slice(bytes).map_err(|error| format!("cannot be read: {error}"))?;
        if file.schema != SCHEMA || file.issues.is_empty() || file.json().as_bytes() != bytes {
            return Err("was not written by this version of psd".to_owned());
        }
        Ok(file)
    }

    /// Its bytes.
    pub fn json(&self) -> String {
        sanitize::json_file(self)
    }

    /// Whether one of its issues is made from the report with this manifest.
    pub fn replaces(&self, manifest_sha256: &str) -> bool {
        self.issues
            .iter()
            .any(|one| one.manifest_sha256 == manifest_sha256)
    }

    /// The id of the report with the first `count` issues; `own` is its original id.
    fn id(&self, own: &str, count: usize) -> String {
        if count == 0 {
            return own.to_owned();
        }
        let first = Self {
            schema: self.schema.clone(),
            issues: self.issues[..count].to_vec(),
        };
        let text = first.json();
        sha256(format!("{own}\n{text}").as_bytes())[..16].to_owned()
    }
}

/// The plan's name of a particular that can be stated after the test.
pub fn may_be_stated(field: &str) -> Result<&'static str, String> {
    let texts = || {
        let texts = schema::block(Kind::Plan)
            .fields
            .iter()
            .filter(|known| matches!(known.ty, FieldType::Text));
        texts.map(|known| known.name)
    };
    if FIXED.contains(&field) {
        return Err(format!("`{field}` is a logged date, and cannot be changed"));
    }
    texts().find(|name| *name == field).ok_or_else(|| {
        let near = nearest(field, texts().filter(|name| !FIXED.contains(name)));
        let near = near.map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
        format!("`{field}` is not a particular that can be amended{near}")
    })
}

/// Applies the stated data of the issues to plan and provenance.
pub fn apply(plan: &mut Plan, provenance: &mut Provenance, file: &IssueFile) -> Result<(), String> {
    let mut all = Vec::new();
    let own = provenance.report_id().to_owned();
    for (before, one) in file.issues.iter().enumerate() {
        if one.replaces != file.id(&own, before) {
            return Err(format!(
                "an issue replaces report {}, which does not belong to this run",
                one_line(&one.replaces)
            ));
        }
        let issued = stated(plan, plan_block::ISSUED.name);
        if let (OneKind::Issue, Some(day)) = (one.kind, &issued) {
            return Err(format!(
                "report {} states that it was issued on {}",
                one_line(&one.replaces),
                one_line(day)
            ));
        }
        let latest = [issued.as_deref(), last_day(provenance)];
        in_order(one, latest)?;
        let mut changes = Vec::new();
        for (field, text) in &one.particulars {
            let field = may_be_stated(field)?;
            if text.len() > TEXT_BYTES {
                return Err(format!("`{field}` is longer than {TEXT_BYTES} bytes"));
            }
            if field == plan_block::RECEIPT_DATE.name && !text.is_empty() && day(text).is_none() {
                return Err(format!(
                    "`{}` is not a date; write it as 2026-05-31",
                    one_line(text)
                ));
            }
            let restated = all
                .iter()
                .flat_map(|issue: &Issue| &issue.changes)
                .any(|change| change.field == field);
            // For a real rig the run log states the operator, whoever the plan names; and the run log is not rewritten.
            let recorded = provenance
                .operator()
                .filter(|_| field == plan_block::OPERATOR.name && !restated);
            changes.push(change(plan, recorded, field, text));
        }
        if one.kind == OneKind::Issue && stated(plan, plan_block::AUTHORISED_BY.name).is_none() {
            return Err("the report has no issuer: `--authorised-by NAME`".to_owned());
        }
        all.push(Issue {
            kind: if one.kind == OneKind::Issue {
                IssueKind::First
            } else {
                IssueKind::Amendment
            },
            replaces: one.replaces.clone(),
            date: one.date.clone(),
            by: one.by.clone(),
            reason: one.reason.clone(),
            changes,
        });
    }
    provenance.issues = Some(Issues {
        report_id: file.id(&own, file.issues.len()),
        all,
    });
    Ok(())
}

/// The day of an issue is a calendar day and the day of issue on the report. It is not before the end of the test or the issue before.
fn in_order(one: &One, [issued, tested]: [Option<&str>; 2]) -> Result<(), String> {
    let date = &one.date;
    let as_stated = one
        .particulars
        .iter()
        .any(|(field, text)| field == plan_block::ISSUED.name && text == date);
    if day(date).is_none() || !as_stated {
        return Err(format!("`{}` is not the date of issue", one_line(date)));
    }
    let late = |day: &str, slack: i64| days_after(date, day).is_some_and(|days| days > slack);
    if let Some(issued) = issued.filter(|issued| late(issued, 0)) {
        return Err(format!(
            "a report of {date} cannot replace one that was issued on {}",
            one_line(issued)
        ));
    }
    // The run log has UTC days.
    if let Some(tested) = tested.filter(|tested| late(tested, 1)) {
        return Err(format!(
            "a report cannot be issued on {date}: the test ended on {}",
            one_line(tested)
        ));
    }
    Ok(())
}

/// The text of a particular; None if it is blank.
pub(super) fn stated(plan: &Plan, field: &str) -> Option<String> {
    let found = plan
        .particulars
        .iter()
        .find(|(name, text)| *name == field && !text.trim().is_empty());
    found.map(|(_, text)| text.clone())
}

fn change(plan: &mut Plan, recorded: Option<&str>, field: &'static str, text: &str) -> Change {
    let index = |name: &str| {
        schema::block(Kind::Plan)
            .fields
            .iter()
            .position(|known| known.name == name)
    };
    let planned = plan.particulars.iter().position(|(name, _)| *name == field);
    let planned = planned.map(|at| plan.particulars.remove(at).1);
    let was = recorded.map(str::to_owned).or(planned).unwrap_or_default();
    if !text.is_empty() {
        let after = plan
            .particulars
            .iter()
            .position(|(name, _)| index(name) > index(field));
        plan.particulars.insert(
            after.unwrap_or(plan.particulars.len()),
            (field, text.to_owned()),
        );
    }
    Change {
        field,
        was,
        is: text.to_owned(),
    }
}

#[cfg(test)]
mod tests;
