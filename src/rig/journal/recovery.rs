//! Reading back: the bytes of a run log, perhaps of a run that was killed. In: bytes. Out: the whole entries and the torn
//! part at the end, or the damage. It does not know the meaning of an entry.

use std::io;
use std::ops::Range;

use serde_json::Value;

use super::chain::Chain;
use super::line::{self, LINE_BYTES, Unsound};
use super::{Damage, EntryKind, FORMAT, Line, LogText, Plain, Wrong};

/// The part of a run log that can be trusted.
#[derive(Clone, Debug)]
pub struct Recovered {
    pub lines: Vec<Line>,
    /// Number of bytes in complete entries, from the first byte of the file.
    pub whole: u64,
    /// The bytes after them: an entry that was being written at the loss of power.
    pub torn: Option<Range<u64>>,
    /// Whether the last entry is END; an interrupted run has none.
    pub ended: bool,
    pub(super) chain: Chain,
}

impl Recovered {
    /// The chain after the last whole entry: 64 hexadecimal digits.
    #[must_use]
    pub fn head(&self) -> &str {
        self.chain.as_str()
    }

    /// The last field `step` of an entry.
    #[must_use]
    pub fn last_step(&self) -> Option<u64> {
        self.lines
            .iter()
            .rev()
            .find_map(|line| line.body().get("step")?.as_u64())
    }

    fn take(&mut self, line: Line, chain: Chain, next: u64) {
        self.ended = line.kind == EntryKind::End;
        self.lines.push(line);
        self.chain = chain;
        self.whole = next;
    }
}

/// The reason why a run log gives no entries.
#[derive(Debug, thiserror::Error)]
pub enum Unreadable {
    #[error(transparent)]
    Damaged(#[from] Damage),
    /// Its file.
    #[error("the run log cannot be read: {0}")]
    File(#[from] io::Error),
}

/// Reads a run log. Without END the run was not completed; without any entry it did not begin. The end of the file is torn under two
/// conditions. The first bad line is followed by no line with a valid checksum. From there on there is no LF, or there is a NUL (a block
/// that was never written). Only positions and times of the entries are kept in memory.
///
/// # Errors
/// Any other bad line: the run log was altered. Or its file cannot be read.
pub fn recover(text: &LogText) -> Result<Recovered, Unreadable> {
    let mut found = Recovered {
        lines: Vec::new(),
        whole: 0,
        torn: None,
        ended: false,
        chain: Chain::START,
    };
    while found.whole < text.length() {
        let read = text.read(reach(found.whole), |bytes| {
            let line = whole_line(bytes)?;
            let (entry, chain) = read_line(line, &found, text)?;
            Ok((entry, chain, line.len() as u64 + 1))
        })?;
        let wrong = match read {
            Ok((entry, chain, length)) => {
                let next = found.whole + length;
                found.take(entry, chain, next);
                continue;
            }
            Err(wrong) => wrong,
        };
        if matches!(wrong, Wrong::Shape | Wrong::Checksum | Wrong::TooLong)
            && is_torn(text, found.whole, &wrong)?
        {
            found.torn = Some(found.whole..text.length());
            break;
        }
        let (line, step) = (found.lines.len() as u64 + 1, found.last_step());
        return Err(Unreadable::Damaged(Damage {
            offset: found.whole,
            line,
            step,
            reason: wrong,
        }));
    }
    Ok(found)
}

/// The longest line from `start` on, and the byte after it.
const fn reach(start: u64) -> Range<u64> {
    start..start + LINE_BYTES as u64 + 1
}

/// The first line without its LF. `bytes` are one more than the longest line, or all that remain.
fn whole_line(bytes: &[u8]) -> Result<&[u8], Wrong> {
    let line = &bytes[..bytes.len().min(LINE_BYTES)];
    match line.iter().position(|byte| *byte == b'\n') {
        Some(end) => Ok(&line[..end]),
        None if bytes.len() > LINE_BYTES => Err(Wrong::TooLong),
        None => Err(Wrong::Shape),
    }
}

/// Whether the bytes from the first bad line on, at `start`, can be the result of a loss of power. A line that is too long is read no
/// further, unless it has a NUL.
fn is_torn(text: &LogText, start: u64, wrong: &Wrong) -> io::Result<bool> {
    let has_nul = |bytes: &[u8]| bytes.contains(&0);
    if *wrong == Wrong::TooLong && !text.read(start..start + LINE_BYTES as u64, has_nul)? {
        return Ok(false);
    }
    let (mut one_line, mut nul, mut first, mut at) = (true, false, true, start);
    while at < text.length() {
        // A part is a line with its LF, the end of the file, or a part of a line that is too long.
        let (length, ended, zero, valid) = text.read(reach(at), |bytes| {
            let end = bytes.iter().position(|byte| *byte == b'\n');
            let line = &bytes[..end.unwrap_or(bytes.len())];
            let valid = !first && line.len() < LINE_BYTES && line::parse(line).is_ok();
            let length = end.map_or(bytes.len(), |end| end + 1);
            (length as u64, end.is_some(), has_nul(line), valid)
        })?;
        if valid {
            return Ok(false);
        }
        // The rest of a line that is too long is no line of its own.
        first = !ended;
        one_line &= !ended;
        nul |= zero;
        at += length;
    }
    Ok(one_line || nul)
}

/// Reads a line as the entry after those found.
fn read_line(bytes: &[u8], found: &Recovered, text: &LogText) -> Result<(Line, Chain), Wrong> {
    let parts = line::parse(bytes).map_err(|unsound| match unsound {
        Unsound::Shape => Wrong::Shape,
        Unsound::Checksum => Wrong::Checksum,
    })?;
    let expected = found.lines.len() as u64 + 1;
    if parts.seq != expected {
        return Err(Wrong::Sequence {
            expected,
            found: parts.seq,
        });
    }
    let chain = found.chain.after(parts.chained);
    if parts.chain != chain.as_str() {
        return Err(Wrong::Chain);
    }
    let kind =
        EntryKind::of_word(parts.word).ok_or_else(|| Wrong::UnknownKind(short(parts.word)))?;
    let time = match Plain::of(parts.json).time_of_object() {
        // Its position depends on its kind alone.
        Some(time) if !matches!(kind, EntryKind::Header | EntryKind::End) => {
            check_position(kind, &Value::Null, found)?;
            time
        }
        _ => {
            let body: Value = serde_json::from_str(parts.json).map_err(|_| Wrong::NotAnObject)?;
            if !body.is_object() {
                return Err(Wrong::NotAnObject);
            }
            check_position(kind, &body, found)?;
            body.get("t").and_then(Value::as_f64)
        }
    };
    let end = found.whole + parts.chained.len() as u64;
    let place = end - parts.json.len() as u64..end;
    let entry = Line::written(parts.seq, kind, time, place, text.clone());
    Ok((entry, chain))
}

/// Whether an entry may be at this position.
fn check_position(kind: EntryKind, body: &Value, found: &Recovered) -> Result<(), Wrong> {
    let string_of = |name: &str| {
        body.get(name)
            .map_or_else(|| "missing".to_owned(), |value| short(&value.to_string()))
    };
    match kind {
        _ if found.ended => Err(Wrong::AfterEnd),
        EntryKind::Header if !found.lines.is_empty() => Err(Wrong::SecondHeader),
        EntryKind::Header if body["format"] != FORMAT => Err(Wrong::Format {
            found: string_of("format"),
        }),
        EntryKind::Header => Ok(()),
        _ if found.lines.is_empty() => Err(Wrong::NoHeader),
        EntryKind::End
            if body["count"] != found.lines.len() as u64 || body["head"] != found.head() =>
        {
            Err(Wrong::EndOfAnother {
                count: string_of("count"),
                head: string_of("head"),
            })
        }
        _ => Ok(()),
    }
}

/// The beginning of the content of a line, for a message.
fn short(text: &str) -> String {
    text.chars()
        .take(80)
        .flat_map(char::escape_default)
        .collect()
}
