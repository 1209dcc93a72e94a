//! Ground-motion records: a table with the header `time_s,acceleration_m_per_s2`, or a file of the PEER database (`.AT2`,
//! header with NPTS and DT). In: the text. Out: times and numbers as they are in the file, with the scale factor of the numbers;
//! or the line of an error, and the reason. It knows no plan.

use psd_text::units::unit::STANDARD_GRAVITY;

/// Most samples of one record.
pub const MOST_SAMPLES: usize = 100_000;

/// Header lines of an AT2 file, one of which contains NPTS and DT.
const AT2_HEAD: usize = 6;

/// A ground-motion record as read.
#[derive(Debug, PartialEq)]
pub struct GroundRecord {
    /// \[s\]
    pub times: Vec<f64>,
    pub values: Vec<f64>,
    /// Scale factor of `values` \[m/s²\], if the header states it.
    pub unit: Option<f64>,
}

/// Reads a record according to its file extension.
///
/// # Errors
/// The reason why the text is not read.
pub fn read(name: &str, text: &str) -> Result<GroundRecord, String> {
    let ending = name.rsplit('.').next().unwrap_or_default();
    let record = if ending.eq_ignore_ascii_case("at2") {
        peer(text)?
    } else {
        table(text)?
    };
    match record.times.len() {
        0 | 1 => Err("fewer than two samples".to_owned()),
        _ => Ok(record),
    }
}

/// `time_s,acceleration_m_per_s2`, or `time_s,acceleration` with a unit that the plan states.
fn table(text: &str) -> Result<GroundRecord, String> {
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let header = lines.next().map_or("", |(_, line)| line);
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let unit = match names.as_slice() {
        ["time_s", "acceleration_m_per_s2"] => Some(1.0),
        ["time_s", "acceleration"] => None,
        _ => {
            return Err(format!(
                "line 1 is `{}`, expected `time_s,acceleration_m_per_s2`",
                shortened(header)
            ));
        }
    };
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for (line, row) in lines {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        let [time, value] = cells.as_slice() else {
            return Err(format!(
                "line {line} has {} columns, expected 2",
                cells.len()
            ));
        };
        let (time, value) = (finite(line, time)?, finite(line, value)?);
        match times.last() {
            None if time != 0.0 => {
                return Err(format!("line {line}: first time is {time} s, expected 0"));
            }
            Some(before) if time <= *before => {
                return Err(format!(
                    "line {line}: time {time} s does not increase (previous: {before} s)"
                ));
            }
            _ => {}
        }
        times.push(time);
        values.push(value);
        not_too_long(values.len())?;
    }
    Ok(GroundRecord {
        times,
        values,
        unit,
    })
}

/// NPTS samples at intervals of DT, several on each line; in units of g, as every file of the database states.
fn peer(text: &str) -> Result<GroundRecord, String> {
    let head = || (1..).zip(text.lines()).take(AT2_HEAD);
    let upper = |line: &str| line.to_ascii_uppercase();
    let Some((at, counts)) = head().find(|(_, line)| upper(line).contains("NPTS")) else {
        return Err(format!("NPTS and DT missing in the first {AT2_HEAD} lines"));
    };
    if let Some((line, what)) = head()
        .take_while(|(line, _)| *line <= at)
        .find(|(_, line)| is_no_acceleration(&upper(line)))
    {
        return Err(format!(
            "line {line}: quantity is `{}`, expected accelerations",
            shortened(what)
        ));
    }
    let (points, step) = counts_of(&upper(counts))
        .ok_or_else(|| format!("line {at}: NPTS and DT are not numbers"))?;
    not_too_long(points)?;
    let unit = head()
        .take_while(|(line, _)| *line <= at)
        .find_map(|(_, line)| stated_unit(&upper(line)));
    let mut values = Vec::new();
    for (line, row) in (1..).zip(text.lines()).skip(at) {
        for cell in row.split_whitespace() {
            values.push(finite(line, cell)?);
            if values.len() > points {
                return Err(format!(
                    "line {line}: more samples than the {points} stated in the header"
                ));
            }
        }
    }
    if values.len() < points {
        return Err(format!(
            "{} samples, but the header states {points}",
            values.len()
        ));
    }
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_SAMPLES")]
    let times = (0..points).map(|sample| sample as f64 * step).collect();
    Ok(GroundRecord {
        times,
        values,
        unit,
    })
}

/// The scale factor \[m/s²\] from a line that ends `UNITS OF G`, or `… GAL`; None if it states no unit, or a different one.
fn stated_unit(line: &str) -> Option<f64> {
    let (_, unit) = line.split_once("UNITS OF ")?;
    match unit
        .split([' ', ',', ';', '\t'])
        .find(|word| !word.is_empty())?
        .trim_end_matches('.')
    {
        "G" => Some(STANDARD_GRAVITY),
        "GAL" | "GALS" => Some(0.01),
        _ => None,
    }
}

/// Whether a header line states that the samples are velocities or displacements, as in `.VT2` and `.DT2` files.
fn is_no_acceleration(line: &str) -> bool {
    let series =
        line.contains("TIME SERIES") || line.contains("TIME HISTORY") || line.contains("UNITS OF");
    series
        && (line.contains("VELOCITY") || line.contains("DISPLACEMENT"))
        && !line.contains("ACCEL")
}

/// `NPTS=  4000, DT=   .0050 SEC` in current files, or `4000 .0050 NPTS, DT` in older ones.
fn counts_of(line: &str) -> Option<(usize, f64)> {
    let after = |word: &str| {
        let rest = line[line.find(word)? + word.len()..]
            .trim_start()
            .strip_prefix('=')?
            .trim_start();
        rest.split([',', ' ']).next()
    };
    let mut leading = line.split([',', ' ']).filter(|word| !word.is_empty());
    let points = after("NPTS").or_else(|| leading.next())?.parse().ok()?;
    let step: f64 = after("DT").or_else(|| leading.next())?.parse().ok()?;
    (step > 0.0 && step.is_finite()).then_some((points, step))
}

fn finite(line: usize, cell: &str) -> Result<f64, String> {
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "line {line}: `{}` is not a finite number",
            shortened(cell)
        )),
    }
}

fn not_too_long(samples: usize) -> Result<(), String> {
    if samples > MOST_SAMPLES {
        Err(format!("more than {MOST_SAMPLES} samples"))
    } else {
        Ok(())
    }
}

fn shortened(text: &str) -> String {
    text.trim()
        .chars()
        .take(40)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_may_be_unevenly_spaced() {
        let record = read(
            "a.csv",
            "time_s,acceleration_m_per_s2\n0, 0\r\n0.01, 1.5\n\n0.05, -2\n",
        )
        .unwrap();
        assert_eq!(
            record,
            GroundRecord {
                times: vec![0.0, 0.01, 0.05],
                values: vec![0.0, 1.5, -2.0],
                unit: Some(1.0)
            }
        );
        assert_eq!(
            read("a.csv", "time_s, acceleration\n0,0\n1,1\n")
                .unwrap()
                .unit,
            None
        );
    }

    #[test]
    fn a_file_of_the_peer_database_in_its_two_headers() {
        let head = "PEER NGA STRONG MOTION DATABASE RECORD\nSOMEWHERE\nACCELERATION TIME SERIES IN UNITS OF G\n";
        for counts in [
            "NPTS=     4, DT=   .0050 SEC,",
            "    4    0.0050   NPTS, DT",
        ] {
            let record = read(
                "a.AT2",
                &format!("{head}{counts}\n  .1E-01 -.2000\n 3 4.0\n"),
            )
            .unwrap();
            assert_eq!(record.values, [0.01, -0.2, 3.0, 4.0]);
            assert_eq!(record.times, [0.0, 0.005, 0.01, 0.015]);
            assert_eq!(record.unit, Some(STANDARD_GRAVITY));
        }
        let refused = |text: &str| read("a.at2", text).unwrap_err();
        assert!(
            refused(&format!("{head}NPTS= 5, DT= .005\n1 2 3 4"))
                .contains("4 samples, but the header states 5")
        );
        assert!(
            refused(&format!("{head}NPTS= 3, DT= .005\n1 2\n3 4"))
                .contains("line 6: more samples than the 3")
        );
        assert!(refused(&format!("{head}NPTS= 3, DT= 0\n1 2 3")).contains("line 4"));
        assert!(refused(&format!("{head}NPTS= 3, DT= 1\n1 x 3")).contains("line 5: `x`"));
        assert!(refused(&format!("{head}NPTS= 900000, DT= 1\n1")).contains("more than 100000"));
        assert!(refused("1 2 3").contains("NPTS"));
        for what in [
            "VELOCITY TIME SERIES IN UNITS OF CM/S",
            "DISPLACEMENT TIME SERIES IN UNITS OF CM",
        ] {
            let other = head.replace("ACCELERATION TIME SERIES IN UNITS OF G", what);
            let reason = refused(&format!("{other}NPTS= 2, DT= .005\n1 2"));
            assert_eq!(
                reason,
                format!("line 3: quantity is `{what}`, expected accelerations")
            );
        }
    }

    /// 1 Gal is 1 cm/s²; for an unknown unit the plan must state the scale factor.
    #[test]
    fn a_header_in_gal_is_not_one_in_g() {
        let file =
            |unit: &str| format!("PEER\nACCELERATION IN UNITS OF {unit}\nNPTS= 2, DT= .005\n1 2\n");
        let unit = |unit: &str| read("a.AT2", &file(unit)).unwrap().unit;
        assert_eq!(
            (unit("GAL"), unit("gals"), unit("Gal. ")),
            (Some(0.01), Some(0.01), Some(0.01))
        );
        assert_eq!(
            (unit("G"), unit(" g, FILTERED")),
            (Some(STANDARD_GRAVITY), Some(STANDARD_GRAVITY))
        );
        assert_eq!(
            (unit("G/10"), unit("CM/S/S"), unit("GRAMS")),
            (None, None, None)
        );
    }

    #[test]
    fn a_bad_table_is_refused_with_its_line() {
        let head = "time_s,acceleration_m_per_s2\n";
        for (rows, reason) in [
            (
                "0,0\n0.02,1\n0.02,2\n",
                "line 4: time 0.02 s does not increase (previous: 0.02 s)",
            ),
            ("0,0\n0.02,1\n0.01,2\n", "line 4"),
            ("0,0\n0.02,inf\n", "line 3: `inf`"),
            ("0,0\n0.02\n", "line 3 has 1 columns"),
            ("0.1,0\n0.2,1\n", "line 2: first time is 0.1 s, expected 0"),
            ("0,0\n", "fewer than two"),
        ] {
            let refused = read("a.csv", &format!("{head}{rows}")).unwrap_err();
            assert!(refused.contains(reason), "{rows:?}: {refused}");
        }
        assert!(
            read("a.csv", "t,a\n0,0\n1,1")
                .unwrap_err()
                .contains("`t,a`")
        );
        assert!(read("a.csv", "").unwrap_err().contains("expected `time_s"));
    }
}
