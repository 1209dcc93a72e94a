//! Modbus RTU frames as a slave receives them. In: bytes and their times. Out: requests with a correct checksum, and the bytes
//! of an answer. It knows no register.

/// Longest frame, bytes.
const LONGEST: usize = 256;
/// Silence after which a partial frame is dropped \[s\]. On a line it is 3.5 characters. Here it is much longer, because the
/// operating system delays the bytes.
const GAP: f64 = 0.05;

/// The reason why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exception {
    Function = 1,
    Address = 2,
    Value = 3,
    Failure = 4,
}

/// A request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Frame {
    Read {
        start: u16,
        count: u16,
    },
    Write {
        start: u16,
        words: Vec<u16>,
        single: bool,
    },
    /// A request that is understood, but invalid.
    Bad(Exception),
}

/// The received part of a frame.
#[derive(Debug, Default)]
pub struct Assembler {
    begun: Vec<u8>,
    /// Time of the last byte \[s\].
    last: f64,
}

impl Assembler {
    /// Receives bytes at the time `now` \[s\] and returns each whole frame with its unit and function. A frame with a wrong
    /// checksum is dropped with all bytes received with it.
    pub fn take(&mut self, bytes: &[u8], now: f64) -> Vec<(u8, u8, Frame)> {
        if now - self.last > GAP {
            self.begun.clear();
        }
        self.last = now;
        let mut frames = Vec::new();
        for byte in bytes {
            self.begun.push(*byte);
            let whole = match length(&self.begun) {
                Some(length) => self.begun.len() >= length,
                // The length is unknown for an unknown function. Only a correct checksum shows the end of the frame.
                None => self.begun.len() >= 4 && is_sound(&self.begun),
            };
            if whole {
                if is_sound(&self.begun) {
                    let body = &self.begun[..self.begun.len() - 2];
                    frames.push((body[0], body[1], parse(body[1], &body[2..])));
                    self.begun.clear();
                } else {
                    self.begun.clear();
                    break;
                }
            } else if self.begun.len() >= LONGEST {
                self.begun.clear();
                break;
            }
        }
        frames
    }
}

/// Length of the whole frame \[bytes\], if its first bytes determine it.
fn length(begun: &[u8]) -> Option<usize> {
    match *begun {
        [] | [_] | [_, 3 | 4 | 6, ..] => Some(8),
        [_, 16, _, _, _, _, bytes, ..] => Some(9 + usize::from(bytes)),
        [_, 16, ..] => Some(9),
        _ => None,
    }
}

fn parse(function: u8, body: &[u8]) -> Frame {
    let word = |at: usize| u16::from_be_bytes([body[at], body[at + 1]]);
    match function {
        3 | 4 => Frame::Read {
            start: word(0),
            count: word(2),
        },
        6 => Frame::Write {
            start: word(0),
            words: vec![word(2)],
            single: true,
        },
        16 => {
            let (count, bytes) = (word(2), usize::from(body[4]));
            let words: Vec<u16> = body[5..]
                .chunks_exact(2)
                .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
                .collect();
            let fits = (1..=123).contains(&count) && bytes == 2 * usize::from(count);
            if fits {
                Frame::Write {
                    start: word(0),
                    words,
                    single: false,
                }
            } else {
                Frame::Bad(Exception::Value)
            }
        }
        _ => Frame::Bad(Exception::Function),
    }
}

/// The bytes of an answer, or of the exception that replaces it.
pub fn reply(unit: u8, function: u8, body: Result<Vec<u8>, Exception>) -> Vec<u8> {
    let mut frame = match body {
        Ok(body) => [vec![unit, function], body].concat(),
        Err(exception) => vec![unit, function | 0x80, exception as u8],
    };
    frame.extend(checksum(&frame).to_le_bytes());
    frame
}

fn is_sound(frame: &[u8]) -> bool {
    let (body, sum) = frame.split_at(frame.len() - 2);
    checksum(body).to_le_bytes() == sum
}

/// CRC-16 of Modbus: from FFFF, polynomial A001, the low bit first.
pub fn checksum(bytes: &[u8]) -> u16 {
    let by_bit = |sum: u16| {
        if sum & 1 == 1 {
            sum >> 1 ^ 0xA001
        } else {
            sum >> 1
        }
    };
    bytes.iter().fold(0xFFFF, |sum, byte| {
        (0..8).fold(sum ^ u16::from(*byte), |sum, _| by_bit(sum))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_of_the_published_frames() {
        for (body, sum) in [
            (&[0x01, 0x03, 0x00, 0x00, 0x00, 0x02][..], [0xC4, 0x0B]),
            (&[0x01, 0x06, 0x00, 0x01, 0x00, 0x03], [0x98, 0x0B]),
            (&[0x01, 0x83, 0x02], [0xC0, 0xF1]),
        ] {
            assert_eq!(checksum(body).to_le_bytes(), sum);
        }
        assert_eq!(
            reply(1, 3, Err(Exception::Address)),
            [0x01, 0x83, 0x02, 0xC0, 0xF1]
        );
    }

    #[test]
    fn a_frame_is_whole_however_its_bytes_come_until_a_gap() {
        let read = Frame::Read { start: 0, count: 2 };
        let bytes = [1, 3, 0, 0, 0, 2, 0xC4, 0x0B];
        let mut assembler = Assembler::default();
        for byte in &bytes[..7] {
            assert!(assembler.take(std::slice::from_ref(byte), 0.0).is_empty());
        }
        assert_eq!(
            assembler.take(&[bytes[7], 1, 6, 0], 0.04),
            [(1, 3, read.clone())]
        );
        let written = Frame::Write {
            start: 1,
            words: vec![3],
            single: true,
        };
        assert_eq!(
            assembler.take(&[1, 0, 3, 0x98, 0x0B], 0.08),
            [(1, 6, written)]
        );
        assert!(assembler.take(&bytes[..3], 1.0).is_empty());
        assert_eq!(
            assembler.take(&bytes, 2.0),
            [(1, 3, read)],
            "what came before the gap is forgotten"
        );
    }
}
