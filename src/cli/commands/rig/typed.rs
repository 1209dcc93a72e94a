//! Numbers that the operator types, with units as the language writes them. In: a string. Out: SI, or an error with an example.

use crate::exit::Failure;
use psd_text::units::Dimension;
use psd_text::units::unit;

/// A position for every axis \[m\]: `1 mm`, or `1 mm, 2 mm` for two axes.
pub fn positions(text: &str, axes: usize, what: &str) -> Result<Vec<f64>, Failure> {
    let example = vec!["1 mm"; axes].join(", ");
    let positions = text
        .split(',')
        .map(|position| number(position, Dimension::LENGTH, what, &example))
        .collect::<Result<Vec<_>, _>>()?;
    if positions.len() == axes {
        return Ok(positions);
    }
    Err(Failure::command_line(format!(
        "{what}: {} positions for {axes} axes",
        positions.len()
    ))
    .help(format!("write it as {example}")))
}

/// Time from one reading to the next \[s\].
pub fn every(text: &str) -> Result<f64, Failure> {
    let every = number(text, Dimension::TIME, "--every", "0.5 s")?;
    if (0.01..=60.0).contains(&every) {
        return Ok(every);
    }
    Err(Failure::command_line(format!(
        "--every must be 10 ms to 1 min, not {text}"
    )))
}

/// A number with its unit, as the language writes it: `1 mm`, `-2.5e-1 mm`. In SI.
pub fn number(text: &str, dimension: Dimension, what: &str, example: &str) -> Result<f64, Failure> {
    let wrong = || {
        Failure::command_line(format!("cannot read {what}: {text}"))
            .help(format!("write it as {example}"))
    };
    let (digits, symbol) = text
        .trim()
        .split_once(char::is_whitespace)
        .ok_or_else(wrong)?;
    let digits_only = digits
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E'));
    let value: f64 = digits
        .parse()
        .ok()
        .filter(|_| digits_only)
        .ok_or_else(wrong)?;
    let unit = unit::parse(symbol.trim())
        .ok()
        .filter(|unit| unit.dimension == dimension)
        .ok_or_else(wrong)?;
    Some(value * unit.factor)
        .filter(|value| value.is_finite())
        .ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_is_a_number_with_a_unit() {
        let length = |text| number(text, Dimension::LENGTH, "--to", "1 mm").ok();
        assert_eq!(length("1 mm"), Some(1e-3));
        assert_eq!(length(" -2.5e1  um "), Some(-2.5e1 * 1e-6));
        for wrong in [
            "1", "1 N", "mm", "nan mm", "inf mm", "1e400 m", "1 mm 2", "1,5 mm",
        ] {
            assert_eq!(length(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn every_axis_has_its_position() {
        assert_eq!(positions("1 mm", 1, "--to").ok(), Some(vec![1e-3]));
        assert_eq!(
            positions("1 mm, -2 mm", 2, "--to").ok(),
            Some(vec![1e-3, -2e-3])
        );
        for (text, axes) in [("1 mm", 2), ("1 mm, 2 mm", 1), ("1 mm,", 2), ("", 1)] {
            assert_eq!(
                positions(text, axes, "--to").unwrap_err().exit().code(),
                2,
                "{text}"
            );
        }
    }
}
