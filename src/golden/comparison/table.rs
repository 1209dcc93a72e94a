//! Results as rows of text, for the terminal and as CSV. In: a comparison. Out: cells; readable units on the terminal, SI in the CSV.

use super::{Cell, ComparedRow, Comparison, Difference, Spread};
use psd_plan::schema::{printed_unit, readable_result};
use psd_text::sanitize::cell;
use psd_text::units::Dimension;
use psd_text::units::display::{digits, is_rounding, join, minus, si_unit, significant};

/// The titles of the results that all runs have, and of those that only some have.
pub const TITLES: [&str; 2] = [
    "Results, u in brackets",
    "Results of some runs only, u in brackets",
];

/// The headings of the columns after the name and the runs.
#[must_use]
pub fn heads(runs: usize) -> &'static [&'static str] {
    if runs == 2 {
        &["difference", "relative", "of combined u"]
    } else {
        &["n", "mean", "deviation", "of the mean"]
    }
}

/// Cells of a row: the runs, then their difference or their spread. The unit is that of the largest value.
#[must_use]
pub fn cells(row: &ComparedRow) -> Vec<String> {
    let values = || row.cells.iter().flatten().filter_map(|cell| cell.value);
    let largest = values().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let (unit, factor) = printed_unit(&row.name, largest, row.dimension);
    let mut cells: Vec<String> = row
        .cells
        .iter()
        .map(|cell| value(*cell, &unit, factor, row.dimension))
        .collect();
    if row.cells.len() == 2 {
        cells.extend(Difference::of(row).map_or_else(
            || vec![String::new(); 3],
            |difference| differs(difference, &unit, factor, row),
        ));
    } else {
        cells.extend(Spread::of(row).map_or_else(
            || vec![String::new(); 4],
            |spread| spreads(spread, &unit, factor, row),
        ));
    }
    cells
}

fn value(cell: Option<Cell>, unit: &str, factor: f64, dimension: Dimension) -> String {
    match cell {
        None => String::new(),
        Some(Cell { value: None, .. }) => "no value".to_owned(),
        Some(Cell {
            value: Some(value),
            u,
        }) => {
            let Some(u) = u.filter(|u| !is_rounding(*u, dimension)) else {
                return join(&digits(value, factor, dimension), unit);
            };
            // Both have the decimals of the second digit of the uncertainty; ± is used for U only.
            let decimals = (1.0 - (u / factor).log10().floor()).clamp(0.0, 9.0);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between 0 and 9"
            )]
            let decimals = decimals as usize;
            join(
                &minus(&format!(
                    "{:.decimals$}({:.decimals$})",
                    value / factor,
                    u / factor
                )),
                unit,
            )
        }
    }
}

/// In the unit of the values; if that gives only zeros, in a separate unit.
fn differs(difference: Difference, unit: &str, factor: f64, row: &ComparedRow) -> Vec<String> {
    let absolute = if difference.absolute == 0.0 {
        "0".to_owned()
    } else {
        let (unit, factor) = if (difference.absolute / factor).abs() >= 1e-3 {
            (unit.to_owned(), factor)
        } else {
            printed_unit(&row.name, difference.absolute, row.dimension)
        };
        join(&signed(difference.absolute / factor), &unit)
    };
    let relative = difference.relative.map_or_else(String::new, percent);
    vec![
        absolute,
        relative,
        difference
            .in_uncertainties
            .map_or_else(String::new, |times| format!("{} u", signed(times))),
    ]
}

fn spreads(spread: Spread, unit: &str, factor: f64, row: &ComparedRow) -> Vec<String> {
    let deviation = spread.deviation.map_or_else(String::new, |deviation| {
        if deviation == 0.0 {
            "0".to_owned()
        } else {
            readable_result(&row.name, deviation, row.dimension)
        }
    });
    let share = spread
        .deviation
        .filter(|_| spread.mean != 0.0)
        .map(|deviation| deviation / spread.mean.abs());
    let share = share.map_or_else(String::new, |share| {
        percent(share).trim_start_matches('+').to_owned()
    });
    vec![
        spread.count.to_string(),
        join(&digits(spread.mean, factor, row.dimension), unit),
        deviation,
        share,
    ]
}

fn percent(share: f64) -> String {
    if share == 0.0 {
        "0 %".to_owned()
    } else {
        format!("{} %", signed(100.0 * share))
    }
}

fn signed(value: f64) -> String {
    let text = significant(value, 3);
    minus(&if value > 0.0 {
        format!("+{text}")
    } else {
        text
    })
}

/// Every result as CSV, SI: one row per result, value and uncertainty of each run, then mean, deviation and difference.
#[must_use]
pub fn csv(comparison: &Comparison) -> String {
    let mut text = String::from("result,unit");
    for name in &comparison.names {
        let name = cell(name);
        text = text + "," + &quoted(&name) + "," + &quoted(&format!("{name} u"));
    }
    text.push_str(",n,mean,standard_deviation,difference\n");
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    for row in comparison.shared.iter().chain(&comparison.partial) {
        let mut cells = vec![quoted(&cell(&row.name)), quoted(&si_unit(row.dimension))];
        for run in &row.cells {
            cells.push(number(run.and_then(|run| run.value)));
            cells.push(number(run.and_then(|run| run.u)));
        }
        let spread = Spread::of(row);
        cells.push(spread.map_or_else(|| "0".to_owned(), |spread| spread.count.to_string()));
        cells.push(number(spread.map(|spread| spread.mean)));
        cells.push(number(spread.and_then(|spread| spread.deviation)));
        cells.push(number(
            Difference::of(row).map(|difference| difference.absolute),
        ));
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: &[(f64, Option<f64>)]) -> ComparedRow {
        let cells = values
            .iter()
            .map(|(value, u)| {
                Some(Cell {
                    value: Some(*value),
                    u: *u,
                })
            })
            .collect();
        ComparedRow {
            name: "hit.x".to_owned(),
            dimension: Dimension::LENGTH,
            cells,
        }
    }

    #[test]
    fn two_runs_have_a_difference_and_more_a_spread() {
        let two = cells(&row(&[(0.008, Some(3e-5)), (0.0081, Some(4e-5))]));
        assert_eq!(
            two,
            [
                "8.000(0.030) mm",
                "8.100(0.040) mm",
                "+0.1000 mm",
                "+1.25 %",
                "+2.00 u"
            ]
        );
        let three = cells(&row(&[(0.001, None), (0.002, None), (0.003, None)]));
        assert_eq!(three[3..], ["3", "2.000 mm", "1.000 mm", "50.0 %"]);
        assert_eq!(
            cells(&row(&[(1.0, None), (1.0, None)]))[2..],
            ["0", "0 %", ""]
        );
    }
}
