//! `amendment.json`: what a report says otherwise than the one it takes the place of. In: the particulars to change, by
//! whom and why. Out: the file, its report's id, and plan and provenance as amended. Particulars of the `plan` block
//! alone: the record lies in the amended folder as it was, and every number comes from it.

use serde::{Deserialize, Serialize};

use crate::digest::sha256;
use crate::inert::{self, one_line};
use crate::output::{Amendment, Amends, Change, Provenance};
use crate::plan::Plan;
use crate::schema::{self, FieldType, Kind};
use crate::suggest::nearest;
use crate::syntax::limits::TEXT_BYTES;

/// Its name in the amended folder.
pub const AMENDMENT: &str = "amendment.json";

/// Name and version of the format.
const SCHEMA: &str = "psd.amendment/1";

/// Particulars that say when the test was and how its numbers are judged: nobody tells them otherwise later.
const FIXED: &[&str] = &["date", "receipt_date"];

/// The file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AmendmentFile {
    pub schema: String,
    /// In order: each takes the place of the report before it.
    pub amendments: Vec<One>,
}

/// One amendment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct One {
    /// Id of the report that it takes the place of.
    pub replaces: String,
    /// SHA-256 of that report's manifest, hex: which it was, to the last byte.
    pub manifest_sha256: String,
    pub by: String,
    pub reason: String,
    /// Field and text; an empty text: not given any more.
    pub particulars: Vec<(String, String)>,
}

impl AmendmentFile {
    /// The amendments before, and one more.
    pub fn after(before: Option<&Self>, one: One) -> Self {
        let before = before.map_or_else(Vec::new, |file| file.amendments.clone());
        Self { schema: SCHEMA.to_owned(), amendments: [before, vec![one]].concat() }
    }

    /// Reads the file. It has one way to be written.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let file: Self = serde_json::from_slice(bytes).map_err(|error| format!("`{AMENDMENT}` cannot be read: {error}"))?;
        if file.schema != SCHEMA || file.amendments.is_empty() || file.json().as_bytes() != bytes {
            return Err(format!("`{AMENDMENT}` is none that this version of psd writes"));
        }
        Ok(file)
    }

    /// Its bytes.
    pub fn json(&self) -> String {
        inert::json(&serde_json::to_string_pretty(self).unwrap_or_default()) + "\n"
    }

    /// The id of the report that is called `own` as it was made, with the first `count` amendments.
    fn id(&self, own: &str, count: usize) -> String {
        if count == 0 {
            return own.to_owned();
        }
        let until = Self { schema: self.schema.clone(), amendments: self.amendments[..count].to_vec() };
        sha256(format!("{own}\n{}", until.json()).as_bytes())[..16].to_owned()
    }
}

/// The plan's own name of a particular that may be amended.
pub fn may_be_amended(field: &str) -> Result<&'static str, String> {
    let texts = || {
        let texts = schema::block(Kind::Plan).fields.iter().filter(|known| matches!(known.ty, FieldType::Text));
        texts.map(|known| known.name)
    };
    if FIXED.contains(&field) {
        return Err(format!("`{field}` is when something was, and stays as it is on record"));
    }
    texts().find(|name| *name == field).ok_or_else(|| {
        let near = nearest(field, texts().filter(|name| !FIXED.contains(name)));
        let near = near.map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
        format!("`{field}` is no particular that can be amended{near}")
    })
}

/// Plan and provenance as the amendments say.
pub fn amended(plan: &mut Plan, provenance: &mut Provenance, file: &AmendmentFile) -> Result<(), String> {
    let mut amendments = Vec::new();
    // Older versions called the first report as its run.
    let by_run = file.amendments.first().is_some_and(|first| first.replaces == provenance.run_id);
    let own = if by_run { provenance.run_id.clone() } else { provenance.report_id().to_owned() };
    for (before, one) in file.amendments.iter().enumerate() {
        if one.replaces != file.id(&own, before) {
            return Err(format!(
                "`{AMENDMENT}` takes the place of report {}, which is none of this run",
                one_line(&one.replaces)
            ));
        }
        let mut changes = Vec::new();
        for (field, text) in &one.particulars {
            let field = may_be_amended(field)?;
            if text.len() > TEXT_BYTES {
                return Err(format!("`{field}` is longer than {TEXT_BYTES} bytes"));
            }
            changes.push(change(plan, provenance, field, text));
        }
        let (replaces, by, reason) = (one.replaces.clone(), one.by.clone(), one.reason.clone());
        amendments.push(Amendment { replaces, by, reason, changes });
    }
    provenance.amends = Some(Amends { report_id: file.id(&own, file.amendments.len()), amendments });
    Ok(())
}

fn change(plan: &mut Plan, provenance: &mut Provenance, field: &'static str, text: &str) -> Change {
    let place = |name: &str| schema::block(Kind::Plan).fields.iter().position(|known| known.name == name);
    let stated = plan.particulars.iter().position(|(name, _)| *name == field);
    let stated = stated.map(|at| plan.particulars.remove(at).1);
    let mut was = stated.unwrap_or_default();
    // Of a real rig the record says who stood by, whoever the plan names.
    if field == "operator"
        && let Some(real) = &mut provenance.real
    {
        was = real.operator.take().unwrap_or(was);
        real.operator = Some(text.to_owned()).filter(|text| !text.is_empty());
    }
    if !text.is_empty() {
        let after = plan.particulars.iter().position(|(name, _)| place(name) > place(field));
        plan.particulars.insert(after.unwrap_or(plan.particulars.len()), (field, text.to_owned()));
    }
    Change { field, was, is: text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_particulars_can_be_amended() {
        assert_eq!(may_be_amended("customer"), Ok("customer"));
        assert!(may_be_amended("date").unwrap_err().contains("on record"));
        assert!(may_be_amended("decision_rule").is_err() && may_be_amended("edition").is_err());
        assert!(may_be_amended("custumer").unwrap_err().contains("`customer`"));
    }

    #[test]
    fn the_file_has_one_way_to_be_written_and_an_id_that_hangs_on_all_of_it() {
        let one = One {
            replaces: "0123456789abcdef".to_owned(),
            manifest_sha256: "00".to_owned(),
            by: "A. Engineer".to_owned(),
            reason: "a wrong name".to_owned(),
            particulars: vec![("customer".to_owned(), "Other Ltd".to_owned())],
        };
        let file = AmendmentFile::after(None, one.clone());
        assert_eq!(AmendmentFile::read(file.json().as_bytes()), Ok(file.clone()));
        assert!(AmendmentFile::read(file.json().trim_end().as_bytes()).is_err());
        assert!(AmendmentFile::read(file.json().replace("\"by\"", "\"bye\"").as_bytes()).is_err());
        let other = AmendmentFile::after(None, One { reason: "another".to_owned(), ..one });
        assert_eq!(file.id("run", 0), "run");
        assert!(file.id("run", 1) != other.id("run", 1) && file.id("run", 1) != file.id("other", 1));
    }
}
