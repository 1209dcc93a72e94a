//! One line: `SEQ TYPE JSON CHAIN CRC`. In: the parts. Out: the bytes; and back, the parts of a line whose own checksum
//! holds. It knows no other line.

use std::ops::Range;

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::chain::{CHAIN_DIGITS, Chain};
use super::{EntryKind, LogText, Plain};

/// Maximum length of a line, including its LF \[bytes\].
pub const LINE_BYTES: usize = 64 * 1024;

/// Digits of the CRC.
const CRC_DIGITS: usize = 8;

/// Both check values, with a space before each.
pub const CHECK_BYTES: usize = 1 + CHAIN_DIGITS + 1 + CRC_DIGITS;

/// One entry, as read back. Its body stays in the text of the run log: a parsed object is large, and a long run has millions.
#[derive(Clone, Debug)]
pub struct Line {
    /// From 1.
    pub seq: u64,
    pub kind: EntryKind,
    /// Length of its body, an object \[bytes\].
    length: u32,
    /// Offset of its body in `text`.
    start: u64,
    /// Its field `t`: rig time \[s\]; not a number without it.
    time: f64,
    text: LogText,
}

impl PartialEq for Line {
    fn eq(&self, other: &Self) -> bool {
        (self.seq, self.kind) == (other.seq, other.kind) && self.body() == other.body()
    }
}

impl Line {
    /// An entry with `body`, an object, outside a run log.
    #[must_use]
    pub fn new(seq: u64, kind: EntryKind, body: &Value) -> Self {
        let json = LogText::from(body.to_string().into_bytes());
        let time = body.get("t").and_then(Value::as_f64);
        Self::written(seq, kind, time, 0..json.length(), json)
    }

    /// The entry whose body is at this place in `text`, with its field `t`.
    pub(super) fn written(
        seq: u64,
        kind: EntryKind,
        time: Option<f64>,
        place: Range<u64>,
        text: LogText,
    ) -> Self {
        Self {
            seq,
            kind,
            length: u32::try_from(place.end - place.start).expect("an entry is short"),
            start: place.start,
            time: time.unwrap_or(f64::NAN),
            text,
        }
    }

    /// Rig time \[s\], if it is stated.
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        Some(self.time).filter(|time| !time.is_nan())
    }

    /// Its body.
    #[must_use]
    pub fn body(&self) -> Value {
        self.read().unwrap_or_default()
    }

    /// Its body, typed.
    ///
    /// # Errors
    /// The body has a different type, or the file can no longer be read.
    pub fn read<T: DeserializeOwned>(&self) -> serde_json::Result<T> {
        self.read_by(|_| None)
    }

    /// The same, by this reader of its plain form if it reads it.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_by<T: DeserializeOwned>(
        &self,
        reader: impl FnOnce(Plain<'_>) -> Option<T>,
    ) -> serde_json::Result<T> {
        let read = self.text.read(self.place(), |json| {
            let plain = str::from_utf8(json).map(Plain::of).ok().and_then(reader);
            plain.map_or_else(|| serde_json::from_slice(json), Ok)
        });
        read.unwrap_or_else(|error| Err(serde_json::Error::io(error)))
    }

    /// Whether the bytes of its body meet this; false if they can no longer be read.
    pub(super) fn with_json(&self, meets: impl FnOnce(&[u8]) -> bool) -> bool {
        matches!(self.text.read(self.place(), meets), Ok(true))
    }

    /// Where its body is in the text.
    fn place(&self) -> Range<u64> {
        self.start..self.start + u64::from(self.length)
    }
}

/// The start of a line, up to its JSON.
pub fn open(out: &mut Vec<u8>, seq: u64, kind: EntryKind) {
    let mut digits = [0; 20];
    let mut first = digits.len();
    let mut rest = seq;
    loop {
        first -= 1;
        digits[first] = b'0' + u8::try_from(rest % 10).expect("a digit");
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[first..]);
    out.push(b' ');
    out.extend_from_slice(kind.word().as_bytes());
    out.push(b' ');
}

/// The end of the line that begins at `start`: chain, checksum, LF. Gives the chain after it.
pub fn close(out: &mut Vec<u8>, start: usize, before: &Chain) -> Chain {
    let chain = before.after(&out[start..]);
    out.push(b' ');
    out.extend_from_slice(chain.digits());
    out.push(b' ');
    let crc = crc32c::crc32c(&out[start..]);
    out.extend_from_slice(&crc_digits(crc));
    out.push(b'\n');
    chain
}

fn crc_digits(crc: u32) -> [u8; CRC_DIGITS] {
    let mut shift = 32;
    [(); CRC_DIGITS].map(|()| {
        shift -= 4;
        b"0123456789abcdef"[(crc >> shift & 15) as usize]
    })
}

/// The parts of a line whose checksum is correct, in their order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts<'a> {
    pub seq: u64,
    pub word: &'a str,
    pub json: &'a str,
    pub chain: &'a str,
    /// `SEQ TYPE JSON`: the input of the chain.
    pub chained: &'a [u8],
}

/// The reason why a line is invalid on its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsound {
    /// It does not have the parts of a line.
    Shape,
    /// Its CRC does not match its bytes.
    Checksum,
}

/// Splits a line without its LF into its parts.
///
/// # Errors
/// It is not a line, or differs from the line that was written.
pub fn parse(line: &[u8]) -> Result<Parts<'_>, Unsound> {
    let text = str::from_utf8(line).map_err(|_| Unsound::Shape)?;
    if !all(line, |byte| (b' '..=b'~').contains(&byte)) {
        return Err(Unsound::Shape);
    }
    let shape = || {
        let (before, crc) = text.rsplit_once(' ')?;
        let (chained, chain) = before.rsplit_once(' ')?;
        let (seq, rest) = chained.split_once(' ')?;
        let (word, json) = rest.split_once(' ')?;
        let sound = is_hexadecimal(crc, CRC_DIGITS)
            && is_hexadecimal(chain, CHAIN_DIGITS)
            && is_number(seq);
        sound.then_some((
            crc,
            Parts {
                seq: seq.parse().ok()?,
                word,
                json,
                chain,
                chained: chained.as_bytes(),
            },
        ))
    };
    let (crc, parts) = shape().ok_or(Unsound::Shape)?;
    if crc.as_bytes() == crc_digits(crc32c::crc32c(&line[..line.len() - CRC_DIGITS])) {
        Ok(parts)
    } else {
        Err(Unsound::Checksum)
    }
}

fn is_hexadecimal(word: &str, digits: usize) -> bool {
    word.len() == digits
        && all(
            word.as_bytes(),
            |byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'),
        )
}

/// Whether all bytes are so. It looks at every one, so that it can look at several together.
fn all(bytes: &[u8], is_so: impl Fn(u8) -> bool) -> bool {
    bytes.iter().fold(true, |all, byte| all & is_so(*byte))
}

/// Decimal digits as the writer writes them: no sign, no leading zero.
fn is_number(word: &str) -> bool {
    !word.starts_with('0') && word.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::super::EntryKind;
    use super::super::chain::Chain;
    use super::{Parts, Unsound, close, open, parse};

    fn line(seq: u64, json: &str) -> Vec<u8> {
        let mut out = Vec::new();
        open(&mut out, seq, EntryKind::Event);
        out.extend_from_slice(json.as_bytes());
        close(&mut out, 0, &Chain::START);
        out
    }

    /// Bit by bit, from the definition.
    fn castagnoli(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(u32::MAX, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
                if crc & 1 == 1 {
                    crc >> 1 ^ 0x82f6_3b78
                } else {
                    crc >> 1
                }
            })
        })
    }

    #[test]
    fn a_line_is_as_the_format_specifies() {
        let written = String::from_utf8(line(17, r#"{"text":"a b"}"#)).unwrap();
        let chained = r#"17 EVENT {"text":"a b"}"#;
        let (before, end) = written.split_at(chained.len() + 66);
        assert_eq!(
            before,
            format!(
                "{chained} {} ",
                Chain::START.after(chained.as_bytes()).as_str()
            )
        );
        assert_eq!(
            castagnoli(b"123456789"),
            0xe306_9283,
            "the check value of CRC-32C"
        );
        assert_eq!(end, format!("{:08x}\n", castagnoli(before.as_bytes())));
    }

    #[test]
    fn it_reads_back_and_only_as_it_was_written() {
        for seq in [1, 9, 10, u64::MAX] {
            let written = line(seq, r#"{"text":"a b"}"#);
            let whole = parse(written.strip_suffix(b"\n").unwrap()).unwrap();
            let chained = format!(r#"{seq} EVENT {{"text":"a b"}}"#);
            let chain = Chain::START.after(chained.as_bytes());
            assert_eq!(
                whole,
                Parts {
                    seq,
                    word: "EVENT",
                    json: r#"{"text":"a b"}"#,
                    chain: chain.as_str(),
                    chained: chained.as_bytes()
                }
            );
        }
        assert_eq!(
            parse(&line(1, "{}")),
            Err(Unsound::Shape),
            "the LF is cut off before"
        );
        for bad in ["", " ", "1 EVENT {}", "1 EVENT {} 0 0"] {
            assert_eq!(parse(bad.as_bytes()), Err(Unsound::Shape), "{bad}");
        }
    }

    #[test]
    fn a_number_has_one_written_form() {
        for seq in ["0", "01", "+1", "18446744073709551616", "", "1a"] {
            let mut bad = format!("{seq} EVENT {{}}").into_bytes();
            close(&mut bad, 0, &Chain::START);
            assert_eq!(
                parse(bad.strip_suffix(b"\n").unwrap()),
                Err(Unsound::Shape),
                "{seq}"
            );
        }
        let upper = String::from_utf8(line(1, "{}"))
            .unwrap()
            .trim_end()
            .to_uppercase();
        assert_eq!(
            parse(upper.as_bytes()),
            Err(Unsound::Shape),
            "digits are lower case"
        );
    }
}
