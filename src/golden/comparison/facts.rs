//! Differences between the runs: program, plan, parameters, rig, requirements.

use serde_json::Value;
use similar::{ChangeTag, TextDiff};

use super::{Side, unquoted};

/// Largest number of different plan lines shown.
const LINES: usize = 40;

/// Verdicts of every requirement in each run, and statements of every comparison with a published number.
pub(super) fn requirements(sides: &[Side]) -> Vec<(String, Vec<Option<String>>)> {
    let mut found: Vec<(String, Vec<Option<String>>)> = Vec::new();
    for (column, side) in sides.iter().enumerate() {
        let entries = |list: &str| side.summary[list].as_array().into_iter().flatten();
        let required =
            entries("requirements").map(|it| (unquoted(&it["name"]), unquoted(&it["verdict"])));
        let compared = entries("reproductions").map(|it| {
            (
                format!("reproduces {}", unquoted(&it["name"])),
                unquoted(&it["statement"]),
            )
        });
        for (name, verdict) in required.chain(compared) {
            let known = found.iter().position(|(known, _)| *known == name);
            let index = known.unwrap_or_else(|| {
                found.push((name, vec![None; sides.len()]));
                found.len() - 1
            });
            found[index].1[column] = Some(verdict);
        }
    }
    found
}

/// The differences: name, and text in each run.
pub(super) fn facts(sides: &[Side]) -> Vec<(String, Vec<String>)> {
    let mut names: Vec<Vec<String>> = ["psd", "date", "report_status"]
        .map(|name| vec![name.to_owned()])
        .to_vec();
    for block in ["plan", "rig", "parameters"] {
        for side in sides {
            for key in side.summary[block]
                .as_object()
                .into_iter()
                .flatten()
                .map(|(key, _)| key.clone())
            {
                let name = vec![block.to_owned(), key];
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
    }
    let of = |side: &Side, path: &[String]| {
        let value = path
            .iter()
            .fold(&side.summary, |value, key| &value[key.as_str()]);
        quantity(value).unwrap_or_else(|| unquoted(value))
    };
    let stated = names.into_iter().map(|path| {
        (
            path.join("."),
            sides.iter().map(|side| of(side, &path)).collect::<Vec<_>>(),
        )
    });
    stated
        .filter(|(_, texts)| texts.windows(2).any(|pair| pair[0] != pair[1]))
        .collect()
}

/// A parameter such as `1.5 m/s`.
fn quantity(value: &Value) -> Option<String> {
    let unit = value.get("unit")?.as_str()?;
    Some(
        format!("{} {unit}", unquoted(&value["value"]))
            .trim_end_matches(" 1")
            .to_owned(),
    )
}

/// The plan lines that differ, each run against the first.
pub(super) fn plans(sides: &[Side]) -> Vec<(String, Vec<String>)> {
    let Some((first, others)) = sides.split_first() else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for side in others {
        let (Some(was), Some(is)) = (&first.plan, &side.plan) else {
            continue;
        };
        let diff = TextDiff::from_lines(was, is);
        let changed = diff
            .iter_all_changes()
            .filter(|change| change.tag() != ChangeTag::Equal);
        let line = |change: similar::Change<&str>| {
            format!("{}{}", change.tag(), change.value().trim_end())
        };
        let mut lines: Vec<String> = changed.map(line).collect();
        if lines.len() > LINES {
            let more = lines.len() - LINES;
            lines.truncate(LINES);
            lines.push(format!("and {more} lines more"));
        }
        if !lines.is_empty() {
            found.push((side.name.clone(), lines));
        }
    }
    found
}
