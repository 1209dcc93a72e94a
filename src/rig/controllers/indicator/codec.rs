//! Weighing indicators: `ST,GS,+0001234,kg`. In: a line without its ending. Out: a force with the status of the indicator.
//! The unit is in the line, so a wrong setting of the indicator cannot give a wrong force.

use crate::controllers::number;

/// Requests one line, for an indicator that does not send automatically.
pub const READ: &[u8] = b"READ\r\n";

/// Characters of every value, including its sign and leading spaces.
const DIGITS: usize = 8;
/// Standard gravity \[m/s²\].
const GRAVITY: f64 = 9.806_65;

/// One line of an indicator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    pub status: Status,
    /// \[N\]; None if it is out of range and shows no number.
    pub force: Option<f64>,
}

/// The status of the weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Stable,
    Unstable,
    Overload,
    Underload,
}

impl Status {
    #[must_use]
    pub const fn is_out_of_range(self) -> bool {
        matches!(self, Self::Overload | Self::Underload)
    }
}

/// The weight of a line: status, gross or net, 8 characters with leading spaces, unit.
///
/// # Errors
/// The reason why the line is invalid.
pub fn weight(line: &[u8]) -> Result<Weight, &'static str> {
    let fields: Vec<&[u8]> = line.split(|byte| *byte == b',').collect();
    let &[status, what, value, unit] = fields.as_slice() else {
        return Err("not the four fields of a weight");
    };
    let status = match status {
        b"ST" => Status::Stable,
        b"US" => Status::Unstable,
        b"OL" => Status::Overload,
        b"UL" => Status::Underload,
        b"TL" => return Err("the scale is not level"),
        _ => return Err("unknown weight status"),
    };
    if !matches!(what, b"GS" | b"NT") {
        return Err("neither gross nor net");
    }
    let newtons = newtons_per(trimmed(unit)).ok_or("not in kg, g, t, lb, N or kN")?;
    // A line that has lost a digit has the wrong length for a weight.
    if value.len() != DIGITS && !status.is_out_of_range() {
        return Err("its value does not have the 8 characters of a weight");
    }
    let force = number::fixed(without_blanks_before(value)).map(|value| value * newtons);
    if force.is_none() && !status.is_out_of_range() {
        return Err("its value is not a number");
    }
    Ok(Weight { status, force })
}

fn newtons_per(unit: &[u8]) -> Option<f64> {
    Some(match unit {
        b"kg" | b"Kg" | b"KG" => GRAVITY,
        b"g" => GRAVITY / 1e3,
        b"t" => GRAVITY * 1e3,
        b"lb" => GRAVITY * 0.453_592_37,
        b"N" => 1.0,
        b"kN" | b"KN" => 1e3,
        _ => return None,
    })
}

fn without_blanks_before(field: &[u8]) -> &[u8] {
    let blanks = field.iter().take_while(|byte| **byte == b' ').count();
    &field[blanks..]
}

fn trimmed(field: &[u8]) -> &[u8] {
    let field = without_blanks_before(field);
    let blanks = field.iter().rev().take_while(|byte| **byte == b' ').count();
    &field[..field.len() - blanks]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(line: &str) -> Option<f64> {
        weight(line.as_bytes()).unwrap().force
    }

    #[test]
    fn a_weight_is_a_force_by_the_unit_of_its_line() {
        for (line, newtons) in [
            ("ST,GS,+0001234,kg", 1234.0 * GRAVITY),
            ("ST,NT,-0001234,kg", -1234.0 * GRAVITY),
            ("ST,GS,   512.5, N", 512.5),
            ("ST,GS,   0.512,kN", 512.0),
            ("ST,GS,  1000.0,g ", GRAVITY),
            ("ST,GS,       2,t", 2000.0 * GRAVITY),
        ] {
            assert_eq!(force(line), Some(newtons), "{line}");
        }
        // One pound-force is 4.4482216152605 N by definition.
        assert!((force("ST,GS,       1,lb").unwrap() - 4.448_221_615_260_5).abs() < 1e-12);
    }

    #[test]
    fn the_flags_of_the_indicator_are_kept() {
        let status = |line: &[u8]| weight(line).unwrap().status;
        assert_eq!(status(b"US,GS,+0001234,kg"), Status::Unstable);
        assert_eq!(
            weight(b"OL,GS,--------,kg"),
            Ok(Weight {
                status: Status::Overload,
                force: None
            })
        );
        assert_eq!(
            weight(b"UL,GS,        ,kg"),
            Ok(Weight {
                status: Status::Underload,
                force: None
            })
        );
        assert!(
            status(b"OL,GS,+0001234,kg").is_out_of_range()
                && !status(b"ST,GS,       1,kg").is_out_of_range()
        );
    }

    #[test]
    fn anything_else_is_no_weight() {
        for line in [
            "",
            "ST,GS,1",
            "ST,GS,1,kg,",
            "ST,GS,1,5,kg",
            "ST,GS,     nan,kg",
            "ST,GS,+003.49,kg",
            "ST,GS,+00001234,kg",
            "ST,GS,OVL,kg",
            "ST,GS,,kg",
            "ST,GS,+ 12,kg",
            "ST,GS,+-12,kg",
            "ST,GS,12 ,kg",
            "ST,GS,1 2,kg",
            "ST,GS,1e3,kg",
            "ST,GS,1,oz",
            "ST,GS,1,",
            "ST,VL,1,kg",
            "TL,GS,1,kg",
            "st,GS,1,kg",
            "T,GS,1,kg",
            "01ST,GS,1,kg",
            "ST,GS,1\0,kg",
            "ok",
            "ST,GS,.5,kg",
        ] {
            assert!(weight(line.as_bytes()).is_err(), "{line}");
        }
    }
}
