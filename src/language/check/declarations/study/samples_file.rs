//! A file of measured values: a header, then one row for each specimen measured; `#` begins a comment. In: its text and the name of a
//! column. Out: the numbers of the column as they are in the file; or the row of an error, and the reason.

use psd_text::suggest;
use psd_text::units::{Unit, unit};

/// Most rows of a file of measured inputs.
pub const MOST_ROWS: usize = 100_000;

/// Why a column cannot be read: number of the line from 1 and its text, if one row has the error, and the reason with a suggestion.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct BadSamples {
    pub row: Option<(usize, String)>,
    pub reason: String,
    pub help: String,
    /// Whether the name of the column is the error, not the file.
    pub of_the_column: bool,
}

/// The numbers of a column, in the order of the rows.
pub(super) fn column(text: &str, name: &str) -> Result<Vec<f64>, BadSamples> {
    let lines = (1..).zip(text.lines().map(str::trim));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let Some((_, header)) = lines.next() else {
        return Err(whole(
            "the file has no rows",
            "write a header, then one row for each specimen",
        ));
    };
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let mut same = (0..).zip(&names).filter(|(_, known)| **known == name);
    let at = match (same.next(), same.next()) {
        (Some((at, _)), None) => at,
        (Some(_), Some(_)) => {
            return Err(BadSamples {
                of_the_column: true,
                ..whole(
                    &format!("two columns are named `{name}`"),
                    "rename one of them",
                )
            });
        }
        (None, _) => return Err(no_column(name, &names)),
    };
    let mut values = Vec::new();
    for (line, row) in lines {
        let bad = |reason: String, help: &str| {
            // A row may have the length of a whole file.
            let shown: String = row.chars().take(60).collect();
            BadSamples {
                row: Some((line, shown)),
                ..whole(&reason, help)
            }
        };
        if values.len() >= MOST_ROWS {
            return Err(bad(format!("more than {MOST_ROWS} rows"), "remove rows"));
        }
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        if cells.len() != names.len() {
            let reason = format!(
                "{} cells, but the header names {}",
                cells.len(),
                names.len()
            );
            return Err(bad(
                reason,
                "write one cell for each column, separated by commas",
            ));
        }
        if cells[at].is_empty() {
            let help = "write the value, or remove the row: the columns are drawn together";
            return Err(bad(format!("no value of `{name}`"), help));
        }
        match cells[at].parse::<f64>() {
            Ok(value) if value.is_finite() => values.push(value),
            _ => {
                let help = "write a plain number, such as 0.0012 or 1.2e-3";
                return Err(bad(format!("`{}` is not a number", cells[at]), help));
            }
        }
    }
    if values.is_empty() {
        return Err(whole(
            "the file has no values below its header",
            "write one row for each specimen",
        ));
    }
    Ok(values)
}

fn whole(reason: &str, help: &str) -> BadSamples {
    BadSamples {
        row: None,
        reason: reason.to_owned(),
        help: help.to_owned(),
        of_the_column: false,
    }
}

fn no_column(name: &str, names: &[&str]) -> BadSamples {
    let help = suggest::nearest(name, names.iter().copied()).map_or_else(
        || {
            let shown: Vec<String> = names
                .iter()
                .take(20)
                .map(|name| format!("`{name}`"))
                .collect();
            format!("write one of its columns: {}", shown.join(", "))
        },
        |near| format!("did you mean `{near}`?"),
    );
    BadSamples {
        of_the_column: true,
        ..whole(&format!("there is no column `{name}`"), &help)
    }
}

/// The unit in which the name of a column ends: `speed_m_per_s`, `mass_kg`, `force_kn`. None if it ends in none.
pub(super) fn unit_of(column: &str) -> Option<Unit> {
    // The longest end is the whole unit: `m_per_s` and not `s`.
    let mut ends = column
        .match_indices('_')
        .map(|(at, _)| &column[at + 1..])
        .filter(|end| !end.is_empty());
    ends.find_map(|end| {
        let (above, below) = end.split_once("_per_").unwrap_or((end, ""));
        let factors = |part: &str| {
            let words = part.split('_').filter(|word| !word.is_empty());
            words.map(factor).collect::<Option<Vec<String>>>()
        };
        let (above, below) = (factors(above)?.join("*"), factors(below)?);
        let token = below
            .iter()
            .fold(above, |token, factor| format!("{token}/{factor}"));
        unit::parse(&token).ok()
    })
}

/// A unit in small letters with its power: `s2` is `s^2`. Those that small letters make ambiguous, such as MN and mN, are left out.
fn factor(word: &str) -> Option<String> {
    const UNITS: [&str; 21] = [
        "m", "mm", "cm", "um", "s", "ms", "us", "min", "h", "kg", "g", "t", "N", "kN", "J", "kJ",
        "Hz", "Pa", "kPa", "GPa", "rad",
    ];
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    let unit = UNITS
        .iter()
        .chain(&["deg"])
        .find(|unit| unit.eq_ignore_ascii_case(letters))?;
    Some(match &word[letters.len()..] {
        "" => (*unit).to_owned(),
        power => format!("{unit}^{power}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_text::units::Dimension;

    const TEXT: &str = "# shop floor\r\nname, mass_kg , K\r\n\r\nA,1.5,300\nB, 2 ,310e3\n";

    #[test]
    fn one_column_is_read_beside_others_of_text() {
        assert_eq!(column(TEXT, "mass_kg"), Ok(vec![1.5, 2.0]));
        assert_eq!(column(TEXT, "K"), Ok(vec![300.0, 310e3]));
    }

    #[test]
    fn a_bad_file_is_refused_with_its_line() {
        for (text, line, reason) in [
            ("a,b\n1,2\n,3\n", Some(3), "no value of `a`"),
            ("a,b\n1\n", Some(2), "1 cells, but the header names 2"),
            ("a\nx\n", Some(2), "`x` is not a number"),
            ("a\ninf\n", Some(2), "`inf` is not a number"),
            ("a,a\n1,2\n", None, "two columns are named `a`"),
            ("b\n1\n", None, "no column `a`"),
            ("a\n", None, "no values below"),
            ("", None, "no rows"),
        ] {
            let bad = column(text, "a").unwrap_err();
            assert_eq!(bad.row.as_ref().map(|(line, _)| *line), line, "{text:?}");
            assert!(bad.reason.contains(reason), "{text:?}: {}", bad.reason);
        }
        assert!(no_column("mas_kg", &["mass_kg"]).help.contains("`mass_kg`"));
    }

    #[test]
    fn the_name_of_a_column_ends_in_its_unit() {
        let unit = |name: &str| unit_of(name).map(|unit| (unit.dimension, unit.factor));
        for (name, dimension, factor) in [
            ("mass_kg", Dimension::MASS, 1.0),
            ("impact_speed_m_per_s", Dimension::VELOCITY, 1.0),
            ("stiffness_kN_per_mm", Dimension::STIFFNESS, 1e6),
            ("acceleration_m_per_s2", Dimension::ACCELERATION, 1.0),
            ("damping_n_s_per_m", Dimension::DAMPING, 1.0),
        ] {
            let (found, by) = unit(name).unwrap_or_else(|| panic!("{name} has a unit"));
            assert_eq!(found, dimension, "{name}");
            assert!((by / factor - 1.0).abs() < 1e-12, "{name}: {by}");
        }
        for name in ["K", "kg", "force_mn", "specimen_name", "k_"] {
            assert_eq!(unit(name), None, "{name}");
        }
    }
}
