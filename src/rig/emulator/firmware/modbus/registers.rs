//! Converts between numbers and 16-bit registers. It knows no frame and no address.

use psd_plan::ModbusNumber;

/// Registers of one number.
pub const fn width(number: ModbusNumber) -> usize {
    match number {
        ModbusNumber::Int16 => 1,
        ModbusNumber::Int32 { .. } | ModbusNumber::Float32 { .. } => 2,
    }
}

/// Returns the registers of a value. Integer registers get a rounded value, limited to their range. NaN becomes the lowest
/// value.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the cast of a float stays inside the range of its type"
)]
pub fn encode(value: f64, number: ModbusNumber) -> Vec<u16> {
    let or_lowest = |lowest: f64| {
        if value.is_nan() {
            lowest
        } else {
            value.round()
        }
    };
    match number {
        ModbusNumber::Int16 => vec![(or_lowest(f64::from(i16::MIN)) as i16).cast_unsigned()],
        ModbusNumber::Int32 { high_word_first } => pair(
            (or_lowest(f64::from(i32::MIN)) as i32).cast_unsigned(),
            high_word_first,
        ),
        ModbusNumber::Float32 { high_word_first } => {
            let float = value as f32;
            // As most controllers, it has no subnormal numbers.
            let float = if float.is_subnormal() { 0.0 } else { float };
            pair(float.to_bits(), high_word_first)
        }
    }
}

/// Returns the value of these registers; NaN if their count does not match the number.
pub fn decode(words: &[u16], number: ModbusNumber) -> f64 {
    match (number, words) {
        (ModbusNumber::Int16, [word]) => f64::from(word.cast_signed()),
        (ModbusNumber::Int32 { high_word_first }, [first, second]) => {
            f64::from(joined(*first, *second, high_word_first).cast_signed())
        }
        (ModbusNumber::Float32 { high_word_first }, [first, second]) => {
            f64::from(f32::from_bits(joined(*first, *second, high_word_first)))
        }
        _ => f64::NAN,
    }
}

#[expect(clippy::cast_possible_truncation, reason = "each half is meant")]
fn pair(bits: u32, high_word_first: bool) -> Vec<u16> {
    let (high, low) = ((bits >> 16) as u16, bits as u16);
    if high_word_first {
        vec![high, low]
    } else {
        vec![low, high]
    }
}

fn joined(first: u16, second: u16, high_word_first: bool) -> u32 {
    let (high, low) = if high_word_first {
        (first, second)
    } else {
        (second, first)
    };
    u32::from(high) << 16 | u32::from(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_by_hand() {
        let (whole, reversed) = (
            ModbusNumber::Int32 {
                high_word_first: true,
            },
            ModbusNumber::Int32 {
                high_word_first: false,
            },
        );
        let float = ModbusNumber::Float32 {
            high_word_first: true,
        };
        assert_eq!(encode(-2.0, ModbusNumber::Int16), [0xFFFE]);
        assert_eq!(encode(70_000.4, whole), [0x0001, 0x1170]);
        assert_eq!(encode(70_000.0, reversed), [0x1170, 0x0001]);
        // −12.5 = −1.1001b × 2³
        assert_eq!(encode(-12.5, float), [0xC148, 0x0000]);
        assert_eq!(encode(1e-40, float), [0, 0]);
        for (words, number, value) in [
            (&[0xFFFE][..], ModbusNumber::Int16, -2.0),
            (&[0xFFFF, 0xFFFF], whole, -1.0),
            (&[0x1170, 0x0001], reversed, 70_000.0),
            (&[0xC148, 0x0000], float, -12.5),
        ] {
            assert_eq!(decode(words, number), value);
        }
    }

    #[test]
    fn what_does_not_fit_stays_at_the_end_of_the_range() {
        assert_eq!(encode(1e9, ModbusNumber::Int16), [0x7FFF]);
        assert_eq!(encode(f64::NAN, ModbusNumber::Int16), [0x8000]);
        assert!(
            decode(
                &[1],
                ModbusNumber::Float32 {
                    high_word_first: true
                }
            )
            .is_nan()
        );
    }
}
