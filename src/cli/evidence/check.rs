//! Checks of a run folder against the results of its run log, its manifest and its signatures. In: the folder, the replayed run log, the
//! required keys. Out: findings, one per part.

use std::collections::{BTreeMap, BTreeSet};

use super::finding::Finding;
use super::folder::Folder;
use super::keys::KnownKey;
use super::names::MANIFEST;
use super::rebuilt::{Rebuilt, Report};
use super::sidecar;
use super::signature;
use psd::report::manifest_with;

/// Largest number of names listed for one finding.
const NAMED: usize = 6;

/// All findings of a run folder. With keys, each of them must have signed, and no other key.
pub fn examine(folder: &Folder, rebuilt: &Rebuilt, keys: &[KnownKey]) -> Vec<Finding> {
    let mut findings = rebuilt.findings.clone();
    let sidecars = sidecars(folder, rebuilt.report.as_ref());
    let own = folder
        .listed()
        .filter(|(name, _)| !sidecars.contains(name.as_str()));
    let has_results = folder.files.contains_key(MANIFEST) || own.count() > folder.kept().len();
    if let Some(report) = rebuilt.report.as_ref().filter(|_| has_results) {
        results(folder, report, &sidecars, &mut findings);
    }
    let ended = rebuilt.report.as_ref().is_some_and(|report| report.ended);
    findings.push(if has_results {
        manifest(folder, rebuilt.report.as_ref(), &sidecars)
    } else if ended {
        Finding::wrong(
            "results",
            "the run is complete, but its results are missing: `psd report` creates them again",
        )
    } else if let Some(fault) = foreign(folder).first() {
        Finding::wrong("manifest", fault)
    } else {
        Finding::sound("manifest", "there are no results yet")
    });
    findings.extend(
        sidecars
            .iter()
            .filter_map(|name| sidecar::examine(folder, name)),
    );
    findings.extend(signature::examine(folder, rebuilt.report.as_ref(), keys));
    findings
}

/// The sidecars of files of the run: files that neither run log nor manifest lists.
fn sidecars<'a>(folder: &'a Folder, report: Option<&Report>) -> BTreeSet<&'a str> {
    let listed = folder.bytes(MANIFEST).and_then(lines).unwrap_or_default();
    let is_of_the_run = |name: &str| {
        listed.contains_key(name)
            || report.is_some_and(|report| report.files.iter().any(|(path, _)| path == name))
    };
    let named = folder.files.keys().map(String::as_str);
    named
        .filter(|name| sidecar::is_one(folder, name) && !is_of_the_run(name))
        .collect()
}

/// The parts of the results, each with its paths.
const PARTS: &[(&str, &str)] = &[
    ("figures", "figures/"),
    ("report", "report."),
    ("plan", "plan/"),
    ("results", ""),
];

fn part_of(path: &str) -> &'static str {
    PARTS
        .iter()
        .find(|(_, prefix)| path.starts_with(prefix))
        .map_or("results", |(part, _)| part)
}

/// Compares every file of the results with the file from the replay.
fn results(
    folder: &Folder,
    report: &Report,
    sidecars: &BTreeSet<&str>,
    findings: &mut Vec<Finding>,
) {
    let mut faults: BTreeMap<&'static str, Vec<String>> = BTreeMap::new();
    let mut counts: BTreeMap<&'static str, usize> = BTreeMap::new();
    for (path, digest) in &report.files {
        *counts.entry(part_of(path)).or_default() += 1;
        let fault = match folder.files.get(path) {
            Some(held) if held.digest == *digest => continue,
            Some(_) => format!("`{path}` differs from the run log"),
            None => format!("`{path}` is missing"),
        };
        faults.entry(part_of(path)).or_default().push(fault);
    }
    let expected: BTreeSet<&String> = report.files.iter().map(|(path, _)| path).collect();
    let kept: BTreeSet<String> = folder.kept().into_iter().map(|(name, _)| name).collect();
    let foreign = |name: &String| {
        !expected.contains(name) && !kept.contains(name) && !sidecars.contains(name.as_str())
    };
    for (name, _) in folder.listed().filter(|(name, _)| foreign(name)) {
        faults
            .entry(part_of(name))
            .or_default()
            .push(format!("`{name}` is not a file of the run"));
    }
    for (part, _) in PARTS.iter().rev() {
        if let Some(faults) = faults.get(part) {
            let other = report
                .other_build
                .as_ref()
                .map_or_else(String::new, |other| {
                    format!("; the run was made by {other}")
                });
            let cut_off = if report.ended {
                ""
            } else {
                "; the run log has no end"
            };
            let statement = format!("{}{cut_off}{other}", some_of(faults));
            findings.push(if report.is_of_another_build() {
                Finding::not_verifiable(part, statement)
            } else {
                Finding::wrong(part, statement)
            });
        } else if let Some(count) = counts.get(part) {
            let files = if *count == 1 {
                "the file"
            } else {
                &format!("all {count} files")
            };
            findings.push(Finding::sound(
                part,
                format!("{files} recomputed from the run log, byte for byte"),
            ));
        }
    }
}

/// Files that are not allowed in a run folder, even if a manifest lists them.
fn foreign(folder: &Folder) -> Vec<String> {
    let odd = folder
        .odd
        .iter()
        .map(|(name, reason)| format!("`{name}` {reason}"));
    let reserve = (folder.reserve_is_ours() == Some(false))
        .then(|| "the reserve file has other content than psd writes".to_owned());
    odd.chain(reserve).collect()
}

/// Compares every file of the folder with its manifest, and the manifest with the one from the replay.
fn manifest(folder: &Folder, report: Option<&Report>, sidecars: &BTreeSet<&str>) -> Finding {
    let Some(bytes) = folder.bytes(MANIFEST) else {
        return Finding::wrong("manifest", "there are results, but no manifest");
    };
    let mut faults = foreign(folder);
    let Some(lines) = lines(bytes) else {
        return Finding::wrong("manifest", "it is not a list of digests");
    };
    for (name, digest) in &lines {
        match folder.files.get(*name) {
            Some(held) if held.digest == *digest => {}
            Some(_) => faults.push(format!("`{name}` differs from the manifest")),
            None => faults.push(format!("`{name}` is missing")),
        }
    }
    let known = |name: &str| lines.contains_key(name) || sidecars.contains(name);
    let unlisted = folder.listed().filter(|(name, _)| !known(name));
    faults.extend(unlisted.map(|(name, _)| format!("`{name}` is not in the manifest")));
    if faults.is_empty()
        && let Some(report) = report.filter(|report| !report.is_of_another_build())
    {
        let all: Vec<(String, String)> =
            report.files.iter().cloned().chain(folder.kept()).collect();
        if manifest_with(&[], &all).bytes != bytes {
            faults.push("it differs from the run log".to_owned());
        }
    }
    if faults.is_empty() {
        Finding::sound("manifest", {
            let other = if sidecars.is_empty() {
                "there is no other file"
            } else {
                "there are no other files except sidecars"
            };
            format!("all {} files match it, and {other}", lines.len())
        })
    } else {
        Finding::wrong("manifest", some_of(&faults))
    }
}

/// Name and digest of every line; None if it is not a manifest, or if it lists a file twice.
fn lines(bytes: &[u8]) -> Option<BTreeMap<&str, &str>> {
    let mut lines = BTreeMap::new();
    for line in str::from_utf8(bytes).ok()?.lines() {
        let (digest, name) = line.split_once("  ")?;
        if lines.insert(name, digest).is_some() {
            return None;
        }
    }
    Some(lines)
}

fn some_of(faults: &[String]) -> String {
    let listed = faults[..faults.len().min(NAMED)].join("; ");
    if faults.len() > NAMED {
        format!("{listed}; and {} more", faults.len() - NAMED)
    } else {
        listed
    }
}
