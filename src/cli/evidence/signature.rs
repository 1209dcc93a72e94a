//! Signatures over the manifest of a run folder, in minisign's format: Ed25519 over the BLAKE2b digest of the file. A trusted comment
//! states the run, the role and the signatory. In: bytes and keys. Out: a signature, or the error in one. `minisign -Vm manifest.sha256
//! -p KEY.pub` verifies the same.

use std::collections::BTreeMap;
use std::io::Cursor;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use minisign::{PublicKey, SecretKey, SignatureBox};

use super::finding::Finding;
use super::folder::Folder;
use super::keys::{self, KnownKey};
use super::names::{MANIFEST, SUFFIX};
use super::rebuilt::Report;
use psd_text::diagnostic::excerpt::one_line;

/// The line that no signature covers is one of these, so that a change to it is also detected.
const UNTRUSTED: &[&str] = &[
    "signature by psd over manifest.sha256",
    "signature from minisign secret key",
    "signature from rsign secret key",
];

/// Largest number of printed characters of a role or a name.
const SHOWN_CHARACTERS: usize = 200;

/// The content of a signature: its trusted comment, fields separated by tabs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statement {
    pub run: String,
    pub report: String,
    /// Status of the report, such as `issued`.
    pub status: String,
    /// Its day of issue, as stated.
    pub issued: Option<String>,
    pub role: Option<String>,
    pub name: Option<String>,
    /// The public key, so that the signature can be checked against the key that it names.
    pub key: Option<String>,
}

impl Statement {
    fn comment(&self) -> String {
        let cut = |text: &String| {
            one_line(text)
                .chars()
                .take(SHOWN_CHARACTERS)
                .collect::<String>()
        };
        let parts = [
            ("run", Some(self.run.clone())),
            (
                "report",
                Some(self.report.clone()).filter(|report| *report != self.run),
            ),
            ("status", Some(self.status.clone())),
            ("issued", self.issued.as_ref().map(cut)),
            ("role", self.role.as_ref().map(cut)),
            ("name", self.name.as_ref().map(cut)),
            ("key", self.key.clone()),
        ];
        let parts = parts
            .into_iter()
            .filter_map(|(word, text)| text.map(|text| format!("{word}:{text}")));
        parts.collect::<Vec<_>>().join("\t")
    }

    /// None if psd did not write it.
    fn read(comment: &str) -> Option<Self> {
        let fields: BTreeMap<&str, &str> = comment
            .split('\t')
            .filter_map(|part| part.split_once(':'))
            .collect();
        let of = |word: &str| fields.get(word).map(|text| (*text).to_owned());
        let run = of("run")?;
        let report = of("report").unwrap_or_else(|| run.clone());
        let read = Self {
            run,
            report,
            status: of("status")?,
            issued: of("issued"),
            role: of("role"),
            name: of("name"),
            key: of("key"),
        };
        (read.comment() == comment).then_some(read)
    }
}

/// The name of a signature file: without a role `manifest.sha256.minisig`, otherwise with the letters and digits of the role in it. Roles
/// that give the same name are distinguished by their index in the plan.
pub fn file_name(role: Option<&str>, roles: &[String]) -> String {
    let Some(role) = role else {
        return format!("{MANIFEST}{SUFFIX}");
    };
    let own = plain(role);
    let index = roles
        .iter()
        .position(|other| one_line(other) == one_line(role));
    let twin = roles
        .iter()
        .enumerate()
        .any(|(at, other)| Some(at) != index && plain(other) == own);
    let middle = match index {
        _ if own.is_empty() => format!("role-{}", index.unwrap_or(0) + 1),
        Some(index) if twin => format!("{own}-{}", index + 1),
        _ => own,
    };
    format!("{MANIFEST}.{middle}{SUFFIX}")
}

/// `Test engineer` → `test-engineer`, at most 60 letters.
fn plain(role: &str) -> String {
    let letters = role.chars().map(|c| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    });
    let parts: String = letters.take(60).collect();
    parts
        .split('-')
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("-")
}

/// Signs a manifest.
pub fn sign(
    manifest: &[u8],
    key: &SecretKey,
    statement: &Statement,
) -> Result<String, minisign::PError> {
    let public = PublicKey::from_secret_key(key)?;
    let statement = Statement {
        key: Some(public.to_base64()),
        ..statement.clone()
    };
    let signed = minisign::sign(
        Some(&public),
        key,
        Cursor::new(manifest),
        Some(&statement.comment()),
        Some(UNTRUSTED[0]),
    )?;
    Ok(signed.into_string())
}

/// Every signature of a folder, and the roles of the plan without a signature. With keys, each of them must have signed, in every role
/// that the plan names, and no other key.
pub fn examine(folder: &Folder, report: Option<&Report>, keys: &[KnownKey]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut signed: Vec<Vec<u8>> = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    for (name, bytes) in folder.signatures() {
        findings.push(match one(folder, name, bytes, report, keys) {
            Ok((statement, keynum)) => {
                signed.push(keynum);
                names.push(name);
                Finding::sound("signature", statement)
            }
            Err(fault) => Finding::wrong("signature", format!("`{name}`: {fault}")),
        });
    }
    for key in keys
        .iter()
        .filter(|key| !signed.iter().any(|signed| signed == key.key.keynum()))
    {
        findings.push(Finding::wrong(
            "signature",
            format!(
                "no signature by key {} of `{}`",
                keys::number(key.key.keynum()),
                key.name
            ),
        ));
    }
    // Without any signature, only that is reported.
    let roles = report
        .filter(|_| !signed.is_empty())
        .map_or(&[][..], |report| &report.roles);
    for role in roles
        .iter()
        .filter(|role| !names.contains(&file_name(Some(role), roles).as_str()))
    {
        let statement = format!("{} has not signed", one_line(role));
        findings.push(if keys.is_empty() {
            Finding::sound("signature", statement)
        } else {
            Finding::wrong("signature", statement)
        });
    }
    if findings.is_empty() {
        findings.push(Finding::sound("signature", "unsigned"));
    }
    findings
}

/// The content of one signature, and the number of its key.
fn one(
    folder: &Folder,
    name: &str,
    bytes: &[u8],
    report: Option<&Report>,
    keys: &[KnownKey],
) -> Result<(String, Vec<u8>), String> {
    let signature = strict(bytes)?;
    let comment = signature
        .trusted_comment()
        .map_err(|error| error.to_string())?;
    let statement = Statement::read(&comment);
    let is_ours = signature
        .untrusted_comment()
        .is_ok_and(|untrusted| untrusted == UNTRUSTED[0]);
    if is_ours
        && statement
            .as_ref()
            .is_none_or(|statement| statement.key.is_none())
    {
        return Err("its comment was not written by psd".to_owned());
    }
    let number = keys::number(signature.keynum());
    let known = keys
        .iter()
        .find(|known| known.key.keynum() == signature.keynum());
    if known.is_none() && !keys.is_empty() {
        return Err(format!(
            "by key {number}, which is not one of the named keys"
        ));
    }
    let named = statement.as_ref().and_then(|stated| stated.key.as_ref());
    let named = named
        .map(|key| PublicKey::from_base64(key).map_err(|_| "its key cannot be read".to_owned()))
        .transpose()?;
    let manifest = folder
        .bytes(MANIFEST)
        .ok_or("there is no manifest for it")?;
    let key = known.map(|known| &known.key).or(named.as_ref());
    if let Some(key) = key {
        minisign::verify(key, &signature, Cursor::new(manifest), true, false, false)
            .map_err(|_| format!("it does not match this manifest, or not key {number}"))?;
    }
    if let Some(statement) = &statement {
        check_statement(statement, name, report)?;
    }
    let who = statement.map_or_else(
        || one_line(&comment),
        |stated| {
            [stated.name, stated.role]
                .map(Option::unwrap_or_default)
                .join(", ")
        },
    );
    let who = who.trim_matches([',', ' ']);
    let who = if who.is_empty() {
        String::new()
    } else {
        format!(" by {who}")
    };
    let checked = match (known, key) {
        (Some(known), _) => format!("good{who}, key {number} of `{}`", known.name),
        (None, Some(_)) => {
            format!("good{who}, by key {number}; only `--key` verifies the owner of the key")
        }
        (None, None) => format!("not checked{who}, key {number}: name the key with `--key`"),
    };
    Ok((checked, signature.keynum().to_vec()))
}

/// The statement must be true for this folder, and for the name of its own file.
fn check_statement(
    statement: &Statement,
    name: &str,
    report: Option<&Report>,
) -> Result<(), String> {
    let Some(report) = report else { return Ok(()) };
    if (&statement.run, &statement.report) != (&report.run_id, &report.id) {
        return Err(format!(
            "it belongs to report {}",
            one_line(&statement.report)
        ));
    }
    let issued = report.issued.as_deref().map(one_line);
    if statement.status != report.status || statement.issued != issued {
        return Err(format!(
            "it states a report with the status `{}`, but the status is `{}`",
            one_line(&statement.status),
            report.status
        ));
    }
    if file_name(statement.role.as_deref(), &report.roles) != name {
        return Err("its file has the name of another role".to_owned());
    }
    Ok(())
}

/// A signature in its canonical form. The parser of the library accepts more forms.
fn strict(bytes: &[u8]) -> Result<SignatureBox, String> {
    let shape = || -> Option<SignatureBox> {
        let text = str::from_utf8(bytes).ok()?;
        let lines: Vec<&str> = text.split('\n').collect();
        let [untrusted, signature, _, global, ""] = lines.as_slice() else {
            return None;
        };
        let length = |text: &str| STANDARD.decode(text).map_or(0, |bytes| bytes.len());
        let known = UNTRUSTED
            .iter()
            .any(|known| untrusted.strip_prefix("untrusted comment: ") == Some(*known));
        // Algorithm, key number, signature; signature of signature and comment.
        if !known || length(signature) != 2 + 8 + 64 || length(global) != 64 {
            return None;
        }
        let read = SignatureBox::from_string(text).ok()?;
        (read.is_prehashed() && read.to_string() == text).then_some(read)
    };
    shape().ok_or_else(|| "it does not have the format of psd or minisign".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::names::is_signature;

    #[test]
    fn the_file_of_a_role_has_a_name_that_every_system_takes() {
        let roles: Vec<String> = ["Test engineer", "../../CON", "A b", "a-B", "é", "質"]
            .map(str::to_owned)
            .to_vec();
        let names: Vec<String> = roles
            .iter()
            .map(|role| file_name(Some(role), &roles))
            .collect();
        let middles = ["test-engineer", "con", "a-b-3", "a-b-4", "role-5", "role-6"];
        assert_eq!(
            names,
            middles.map(|middle| format!("manifest.sha256.{middle}.minisig"))
        );
        assert!(
            names.iter().all(|name| is_signature(name)) && is_signature(&file_name(None, &roles))
        );
        for other in [
            "manifest.sha256",
            "manifest.sha256.A.minisig",
            "manifest.sha256..minisig",
            "x/manifest.sha256.minisig",
        ] {
            assert!(!is_signature(other), "{other}");
        }
    }

    #[test]
    fn a_statement_reads_back_and_nothing_in_it_makes_another_field() {
        let statement = Statement {
            run: "0123456789abcdef".to_owned(),
            report: "0123456789abcdef".to_owned(),
            status: "issued".to_owned(),
            issued: Some("2026-06-02".to_owned()),
            role: Some("Quality\tkey:x\n\u{202e}".to_owned()),
            name: None,
            key: Some("RWQ".to_owned()),
        };
        let read = Statement::read(&statement.comment()).unwrap();
        assert_eq!(
            read.role.as_deref(),
            Some("Quality\\u{9}key:x\\u{a}\\u{202e}")
        );
        assert_eq!((read.name, read.key.as_deref()), (None, Some("RWQ")));
        assert_eq!(
            (read.status.as_str(), read.issued.as_deref()),
            ("issued", Some("2026-06-02"))
        );
        assert_eq!(
            Statement::read("timestamp:1\tfile:manifest.sha256\thashed"),
            None
        );
    }
}
