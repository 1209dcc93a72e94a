//! A comparison for a terminal. Out: aligned tables; runs are listed by number, so that long names fit.

use std::fmt::Write as _;

use super::{ComparedRow, Comparison, table};
use psd_text::columns::columns;

/// Largest number of runs that have separate columns.
const COLUMNS: usize = 6;

/// The whole comparison.
#[must_use]
pub fn comparison_text(comparison: &Comparison) -> String {
    let mut text = String::new();
    let numbered = comparison
        .names
        .iter()
        .zip(&comparison.verdicts)
        .enumerate();
    let runs: Vec<Vec<String>> = numbered
        .map(|(index, (name, verdict))| {
            vec![format!("{}", index + 1), name.clone(), verdict.clone()]
        })
        .collect();
    let _ = writeln!(text, "Runs\n{}", columns(&runs));
    for (title, rows) in table::TITLES
        .into_iter()
        .zip([&comparison.shared, &comparison.partial])
    {
        results(&mut text, title, rows, comparison.names.len());
    }
    if !comparison.requirements.is_empty() {
        let rows = comparison.requirements.iter().map(|(name, verdicts)| {
            [
                vec![name.clone()],
                verdicts
                    .iter()
                    .map(|verdict| verdict.clone().unwrap_or_else(|| "—".to_owned()))
                    .collect(),
            ]
            .concat()
        });
        let _ = writeln!(
            text,
            "Requirements\n{}",
            columns(&[vec![head(comparison.names.len())], rows.collect()].concat())
        );
    }
    if !comparison.facts.is_empty() {
        let rows = comparison.facts.iter().map(|(what, texts)| {
            [
                vec![what.clone()],
                texts
                    .iter()
                    .map(|text| text.chars().take(24).collect())
                    .collect(),
            ]
            .concat()
        });
        let _ = writeln!(
            text,
            "Differences\n{}",
            columns(&[vec![head(comparison.names.len())], rows.collect()].concat())
        );
    }
    for (name, lines) in &comparison.plans {
        let _ = writeln!(
            text,
            "Plan of {name} compared with the plan of {}",
            comparison.names[0]
        );
        for line in lines {
            let _ = writeln!(text, "  {line}");
        }
        text.push('\n');
    }
    text
}

/// An empty cell and the numbers of the runs.
fn head(runs: usize) -> Vec<String> {
    std::iter::once(String::new())
        .chain((1..=runs).map(|run| run.to_string()))
        .collect()
}

fn results(text: &mut String, title: &str, rows: &[ComparedRow], runs: usize) {
    if rows.is_empty() {
        return;
    }
    let heads = table::heads(runs).iter().map(|head| (*head).to_owned());
    let mut lines = vec![head(runs).into_iter().chain(heads).collect::<Vec<_>>()];
    lines.extend(
        rows.iter()
            .map(|row| [vec![row.name.clone()], table::cells(row)].concat()),
    );
    if runs > COLUMNS {
        // The CSV has their values; this table shows their spread.
        for line in &mut lines {
            line.drain(1..=runs);
        }
    }
    let _ = writeln!(text, "{title}\n{}", columns(&lines));
}
