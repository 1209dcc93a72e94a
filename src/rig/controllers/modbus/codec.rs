//! Modbus RTU frames (Modbus Serial Line guide V1.02). In: registers and words. Out: bytes with their CRC, and back. The
//! length of an answer follows from its question, so no answer is cut or merged with another. It knows no units and no
//! device.

use psd_plan::ModbusNumber;

/// Length of an exception answer: unit, function, code, CRC.
const EXCEPTION_LENGTH: usize = 5;
/// Length of an answer to a write.
const ECHO_LENGTH: usize = 8;
const REFUSED: u8 = 0x80;
const WRITE_ONE: u8 = 0x06;
const WRITE_SEVERAL: u8 = 0x10;

/// The two tables of readable registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Function 03.
    Holding,
    /// Function 04.
    Input,
}

/// Why an answer cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FrameFault {
    /// It is not a complete and correct answer to the question.
    Broken(&'static str),
    /// The unit refused.
    Exception(u8),
}

/// CRC-16 of Modbus: start FFFF, polynomial A001 reflected.
#[must_use]
pub fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte), |crc, _| {
            if crc & 1 == 1 {
                (crc >> 1) ^ 0xA001
            } else {
                crc >> 1
            }
        })
    })
}

/// The question for `count` registers from `start`.
#[must_use]
pub fn read(unit: u8, table: Table, start: u16, count: u16) -> Vec<u8> {
    let function = match table {
        Table::Holding => 0x03,
        Table::Input => 0x04,
    };
    let mut frame = vec![unit, function];
    frame.extend(start.to_be_bytes());
    frame.extend(count.to_be_bytes());
    sealed(frame)
}

/// The command to write `words` from register `start` on: function 06 for one, 10h for more.
#[must_use]
pub fn write(unit: u8, start: u16, words: &[u16]) -> Vec<u8> {
    let mut frame = vec![
        unit,
        if words.len() == 1 {
            WRITE_ONE
        } else {
            WRITE_SEVERAL
        },
    ];
    frame.extend(start.to_be_bytes());
    if words.len() != 1 {
        let count = u8::try_from(words.len()).expect("a number has one or two words");
        frame.extend(u16::from(count).to_be_bytes());
        frame.push(2 * count);
    }
    frame.extend(words.iter().flat_map(|word| word.to_be_bytes()));
    sealed(frame)
}

/// The length of the answer to `question`, when enough of it has been received. None: not yet.
///
/// # Errors
/// The received bytes do not answer it.
pub fn answer_length(question: &[u8], received: &[u8]) -> Result<Option<usize>, FrameFault> {
    let (unit, function) = (question[0], question[1]);
    match received {
        [from, ..] if *from != unit => Err(FrameFault::Broken("another unit answered")),
        [] | [_] => Ok(None),
        [_, found, ..] if *found == function | REFUSED => Ok(Some(EXCEPTION_LENGTH)),
        [_, found, ..] if *found != function => {
            Err(FrameFault::Broken("another function was answered"))
        }
        _ if writes(question) => Ok(Some(ECHO_LENGTH)),
        [_, _] => Ok(None),
        [_, _, bytes, ..] if usize::from(*bytes) != asked_bytes(question) => Err(
            FrameFault::Broken("the answer has a different number of registers"),
        ),
        _ => Ok(Some(EXCEPTION_LENGTH + asked_bytes(question))),
    }
}

/// The words of an answer; none for the answer to a write.
///
/// # Errors
/// It is broken, does not answer the question, or is an exception.
pub fn answer(question: &[u8], received: &[u8]) -> Result<Vec<u16>, FrameFault> {
    if answer_length(question, received)? != Some(received.len()) {
        return Err(FrameFault::Broken("wrong length"));
    }
    let (body, check) = received.split_at(received.len() - 2);
    if crc(body).to_le_bytes() != check {
        return Err(FrameFault::Broken("wrong CRC"));
    }
    if body[1] & REFUSED != 0 {
        return Err(FrameFault::Exception(body[2]));
    }
    if writes(question) {
        // Register and value, or register and count, are echoed.
        return if body[..6] == question[..6] {
            Ok(Vec::new())
        } else {
            Err(FrameFault::Broken("the echo differs"))
        };
    }
    Ok(words(&body[3..]))
}

/// The meaning of an exception code.
#[must_use]
pub const fn exception(code: u8) -> &'static str {
    match code {
        1 => "it has no such function",
        2 => "it has no such register",
        3 => "the value is not allowed",
        4 => "the device failed",
        5 => "it needs more time",
        6 => "it is busy",
        8 => "its memory has a parity error",
        _ => "an unknown exception",
    }
}

/// Number of registers of a number.
#[must_use]
pub const fn width(number: ModbusNumber) -> u16 {
    match number {
        ModbusNumber::Int16 => 1,
        ModbusNumber::Int32 { .. } | ModbusNumber::Float32 { .. } => 2,
    }
}

/// The registers of a number; None if they cannot hold it.
#[must_use]
pub fn to_words(number: ModbusNumber, value: f64) -> Option<Vec<u16>> {
    let rounded = value.round();
    let whole = |low: f64, high: f64| (low <= rounded && rounded <= high).then_some(rounded);
    match number {
        ModbusNumber::Int16 => {
            #[expect(clippy::cast_possible_truncation, reason = "whole and within i16")]
            let count = whole(f64::from(i16::MIN), f64::from(i16::MAX))? as i16;
            Some(vec![count.cast_unsigned()])
        }
        ModbusNumber::Int32 { high_word_first } => {
            #[expect(clippy::cast_possible_truncation, reason = "whole and within i32")]
            let count = whole(f64::from(i32::MIN), f64::from(i32::MAX))? as i32;
            Some(two_words(count.cast_unsigned(), high_word_first))
        }
        ModbusNumber::Float32 { high_word_first } => {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "what it becomes is read back before it is used"
            )]
            let short = value as f32;
            short
                .is_finite()
                .then(|| two_words(short.to_bits(), high_word_first))
        }
    }
}

/// The number in registers. None for a wrong number of registers, or if the number is not finite.
#[must_use]
pub fn from_words(number: ModbusNumber, words: &[u16]) -> Option<f64> {
    match (number, words) {
        (ModbusNumber::Int16, [word]) => Some(f64::from(word.cast_signed())),
        (ModbusNumber::Int32 { high_word_first }, [first, second]) => Some(f64::from(
            joined(*first, *second, high_word_first).cast_signed(),
        )),
        (ModbusNumber::Float32 { high_word_first }, [first, second]) => {
            let value = f32::from_bits(joined(*first, *second, high_word_first));
            value.is_finite().then_some(f64::from(value))
        }
        _ => None,
    }
}

/// The largest short float up to a value above 0 whose low word is 0; its 8 binary digits are within 1 % of the value.
#[must_use]
pub fn without_low_word(value: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "what it becomes is judged")]
    let short = value as f32;
    let short = if f64::from(short) > value {
        short.next_down()
    } else {
        short
    };
    f64::from(f32::from_bits(short.to_bits() & 0xFFFF_0000))
}

/// The short float nearest to a value among those whose low word is 0; at most 0.4 % from the value.
#[must_use]
pub fn nearest_without_low_word(value: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "what it becomes is judged")]
    let bits = (value as f32).to_bits();
    f64::from(f32::from_bits(bits.saturating_add(0x8000) & 0xFFFF_0000))
}

/// The same number with its two words in the other order. None: it has one word.
#[must_use]
pub const fn other_order(number: ModbusNumber) -> Option<ModbusNumber> {
    match number {
        ModbusNumber::Int16 => None,
        ModbusNumber::Int32 { high_word_first } => Some(ModbusNumber::Int32 {
            high_word_first: !high_word_first,
        }),
        ModbusNumber::Float32 { high_word_first } => Some(ModbusNumber::Float32 {
            high_word_first: !high_word_first,
        }),
    }
}

fn sealed(mut frame: Vec<u8>) -> Vec<u8> {
    let check = crc(&frame);
    frame.extend(check.to_le_bytes());
    frame
}

fn writes(question: &[u8]) -> bool {
    matches!(question[1], WRITE_ONE | WRITE_SEVERAL)
}

fn asked_bytes(question: &[u8]) -> usize {
    2 * usize::from(u16::from_be_bytes([question[4], question[5]]))
}

fn words(data: &[u8]) -> Vec<u16> {
    data.chunks_exact(2)
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
        .collect()
}

fn two_words(bits: u32, high_word_first: bool) -> Vec<u16> {
    let [a, b, c, d] = bits.to_be_bytes();
    let (high, low) = (u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d]));
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

    const FLOAT: ModbusNumber = ModbusNumber::Float32 {
        high_word_first: true,
    };

    fn sound(body: &[u8]) -> Vec<u8> {
        sealed(body.to_vec())
    }

    #[test]
    fn frames_are_those_of_the_guide() {
        assert_eq!(
            read(1, Table::Holding, 0, 2),
            [0x01, 0x03, 0x00, 0x00, 0x00, 0x02, 0xC4, 0x0B]
        );
        assert_eq!(
            write(1, 1, &[3]),
            [0x01, 0x06, 0x00, 0x01, 0x00, 0x03, 0x98, 0x0B]
        );
        assert_eq!(sound(&[0x01, 0x83, 0x02]), [0x01, 0x83, 0x02, 0xC0, 0xF1]);
        assert_eq!(write(7, 9, &[5, 6]).len(), 13);
    }

    #[test]
    fn numbers_come_back_from_their_registers_in_either_word_order() {
        for high_word_first in [true, false] {
            let (whole, float) = (
                ModbusNumber::Int32 { high_word_first },
                ModbusNumber::Float32 { high_word_first },
            );
            for value in [0.0, 1.0, -1.0, 65_536.0, -2_147_483_648.0, 2_147_483_647.0] {
                assert_eq!(
                    from_words(whole, &to_words(whole, value).unwrap()),
                    Some(value)
                );
            }
            for value in [0.0, 12.5, -0.375, 1e6] {
                assert_eq!(
                    from_words(float, &to_words(float, value).unwrap()),
                    Some(value)
                );
            }
        }
        assert_eq!(to_words(FLOAT, 12.5), Some(vec![0x4148, 0]));
        assert_eq!(
            to_words(
                ModbusNumber::Float32 {
                    high_word_first: false
                },
                12.5
            ),
            Some(vec![0, 0x4148])
        );
        assert_eq!(to_words(ModbusNumber::Int16, -2.4), Some(vec![0xFFFE]));
    }

    #[test]
    fn a_float_without_its_low_word_is_almost_zero_in_the_other_word_order() {
        let turned = ModbusNumber::Float32 {
            high_word_first: false,
        };
        for value in [1.0, 1.1, 0.5, 1.999_999_9, 3e-4, 250.0] {
            let found = without_low_word(value);
            assert!(
                found <= value && found > 0.99 * value,
                "{value} became {found}"
            );
            let words = to_words(FLOAT, found).unwrap();
            assert_eq!(from_words(FLOAT, &words), Some(found));
            assert!(from_words(turned, &words).unwrap().abs() < 1e-38, "{found}");
        }
    }

    #[test]
    fn what_registers_cannot_hold_is_not_clamped() {
        for value in [32_767.6, -32_768.6, f64::NAN, f64::INFINITY] {
            assert_eq!(to_words(ModbusNumber::Int16, value), None, "{value}");
        }
        assert_eq!(
            to_words(
                ModbusNumber::Int32 {
                    high_word_first: true
                },
                2_147_483_648.0
            ),
            None
        );
        for value in [1e39, f64::NAN, f64::NEG_INFINITY] {
            assert_eq!(to_words(FLOAT, value), None, "{value}");
        }
        assert_eq!(from_words(FLOAT, &[0x7FC0, 0]), None);
        assert_eq!(from_words(FLOAT, &[0x7F80, 0]), None);
        assert_eq!(from_words(FLOAT, &[0x7F80]), None);
    }

    #[test]
    fn every_single_bit_that_flips_is_found_in_every_kind_of_answer() {
        let question = read(1, Table::Input, 40, 2);
        let order = write(1, 1, &[3]);
        let several = write(1, 1, &[3, 4]);
        let answers = [
            (&question, sound(&[1, 4, 4, 0x41, 0x48, 0, 0])),
            (&question, sound(&[1, 0x84, 2])),
            (&order, order.clone()),
            (&several, sound(&several[..6])),
        ];
        for (question, whole) in answers {
            assert!(!matches!(
                answer(question, &whole),
                Err(FrameFault::Broken(_))
            ));
            for bit in 0..8 * whole.len() {
                let mut flipped = whole.clone();
                flipped[bit / 8] ^= 1 << (bit % 8);
                assert!(
                    matches!(answer(question, &flipped), Err(FrameFault::Broken(_))),
                    "bit {bit} of {whole:?}"
                );
            }
            for short in 0..whole.len() {
                assert!(
                    matches!(
                        answer(question, &whole[..short]),
                        Err(FrameFault::Broken(_))
                    ),
                    "{short} bytes of {whole:?}"
                );
            }
        }
    }

    #[test]
    fn an_answer_to_another_question_is_none() {
        let question = read(1, Table::Holding, 0, 1);
        assert_eq!(answer(&question, &sound(&[1, 3, 2, 0, 7])), Ok(vec![7]));
        assert_eq!(
            answer(&question, &sound(&[1, 0x83, 2])),
            Err(FrameFault::Exception(2))
        );
        for other in [
            &[2, 3, 2, 0, 7][..],
            &[1, 4, 2, 0, 7],
            &[1, 3, 4, 0, 7, 0, 8],
        ] {
            assert!(
                matches!(answer(&question, &sound(other)), Err(FrameFault::Broken(_))),
                "{other:?}"
            );
        }
        let order = write(1, 1, &[3]);
        assert_eq!(answer(&order, &order), Ok(vec![]));
        assert!(matches!(
            answer(&order, &write(1, 1, &[4])),
            Err(FrameFault::Broken(_))
        ));
    }

    #[test]
    fn the_length_is_known_as_soon_as_it_can_be() {
        let question = read(1, Table::Holding, 0, 2);
        assert_eq!(answer_length(&question, &[1]), Ok(None));
        assert_eq!(answer_length(&question, &[1, 3]), Ok(None));
        assert_eq!(answer_length(&question, &[1, 3, 4]), Ok(Some(9)));
        assert_eq!(answer_length(&question, &[1, 0x83]), Ok(Some(5)));
        assert_eq!(answer_length(&write(1, 1, &[3]), &[1, 6]), Ok(Some(8)));
    }
}
