//! The line protocol of psd. In: a request and its sequence number; a received line. Out: the frame; the reply in the line. It has no
//! state: the driver matches replies with requests.
//!
//! # The protocol
//! ASCII, 115200 baud 8N1 or TCP, one request in flight. A request has at most 96 bytes with its ending, or 512 for a rig with several
//! axes. A reply has at most 512 bytes.
//!
//! ```text
//! request = ">" VERB  SP SEQ          *(SP word) "*" CRC LF
//! reply   = "<" KIND  SP SEQ SP BOOT  *(SP word) "*" CRC LF
//! ```
//! CRC is CRC-16/CCITT-FALSE (polynomial 1021, start FFFF; `123456789` gives 29B1) of the bytes between the lead character and `*`, as 4
//! upper-case hexadecimal digits. SEQ is a decimal of 32 bits, increased by one with every new request. BOOT is a random boot identifier
//! of this power-up, 4 upper-case hexadecimal digits. Words are printable ASCII without spaces. Units are fixed: mm, N, mm/s, ms. Lengths
//! and speeds have 6 decimals, forces 3.
//!
//! A broken frame is not answered. The rig keeps its last reply: a repeated SEQ receives that reply again and has no other effect. Any
//! SEQ except this one and the next is answered by `ERR SEQ`. HELLO is accepted with every SEQ, is executed each time, and sets SEQ.
//!
//! A rig has 1 to 6 axes. Words in braces are repeated for each axis in turn, so for a rig of one axis they appear once. The number of
//! axes follows from the number of words in the reply to HELLO.
//!
//! | Request | Reply |
//! |---|---|
//! | `HELLO` | `ACK model serial firmware {d_low d_high f_low f_high} v_high last_id {last_target}`: the rig's own limits and the last move that it began (id 0: none since power-up). It deletes the limits of a run, except those of an axis that holds a force. |
//! | `LIM {d_low d_high f_low f_high} v_high` | `ACK state`: the limits of this run. Limits wider than the rig's own: `ERR LIMIT`. |
//! | `FORCE {rate tolerance}` | `ACK state`: an axis with a rate, N/s, is one in force control from its next `MOVE` on, whose target is a force, N. A rate of 0: it holds displacements. For an axis that holds a force, a rate of 0 is `ERR ARG`. |
//! | `MOVE id {target} rate` | `ACK state`: all axes move to their absolute targets and arrive simultaneously; the axis with the longest travel moves at the rate. An axis in force control goes to its force at its own rate. An id is greater than all earlier ones. The last id with the same targets again: `ACK` without motion; with other targets, or an older id: `ERR ID`. |
//! | `GLIDE id {target velocity} ms` | `ACK state left`: every axis follows a cubic path from its present position and velocity to its target. It passes the target with the given velocity, ms milliseconds after the end of the last `GLIDE`, or after now if none is in progress. `left` is the time until that end, ms. The axis does not stop there: it continues at that velocity, and holds if no `GLIDE` follows. With an axis in force control: `ERR VERB`. |
//! | `MEAS n` | `DATA t {disp force raw flags} state`: the median of n readings of each channel. |
//! | `STAT` | `ACK state flags`: a bit is set if it is set for any axis. |
//! | `STOP` | `ACK HELD`: stops all axes, keeps the load, and stays held until `CLR`. |
//! | `CLR` | `ACK state`: clears a latched hold. Nothing moves. |
//! | `REF token` | `ACK state`: the position of all axes is trusted from now on; the token identifies who declared this. |
//!
//! `state` is `IDLE`, `MOVING` or `HELD`. `flags` is `0x` and 4 digits: bit 0 saturated, 1 stale, 2 upper limit, 3 lower
//! limit, 4 emergency stop, 5 not referenced, 6 not settled, 7 watchdog tripped, 8 in force control, 9 left force control at the band,
//! 10 left force control without load cell; the others are 0. `ERR` has one word:
//! `SEQ`, `VERB`, `ARG`, `LIMIT`, `RATE`, `ID`, `BUSY`, `LATE`, `HELD`, `STOP`, `REF`, `FAULT`.
//!
//! An axis in force control keeps its force within the tolerance while the others move, and is `MOVING` until its force is reached. Any
//! hold stops the other axes and the change of the force, and keeps the force: so do `HELLO` and the silence of the host. The axis leaves
//! force control when its displacement leaves `d_low .. d_high`, when its load cell fails, or when its force differs from its course by
//! more than the tolerance. It then holds its displacement, all other axes hold, and bit 9 or 10 is set until `CLR`.
//!
//! The byte `!` anywhere holds immediately, as `STOP` does, and is not part of a frame. No valid frame for W ms (default 3000) also
//! holds, and sets bit 7 until `CLR`. A rig never clamps: it refuses a command that it cannot execute exactly. A hold keeps the load;
//! only the operator unloads. This protocol does not replace a wired emergency stop and limit switches.

mod checksum;
mod request;

use crate::controllers::Flags;
use crate::controllers::number;
use crate::safety::failpoint::{Guarding, on};
use psd_plan::Interval;

pub use checksum::checksum;
pub use request::{
    End, LONGEST_FRAME, LONGEST_FRAME_OF_SEVERAL, Request, force, frame, length, lengths, sequence,
};
pub use request::{in_turn, time};

/// Largest number of axes of a rig: the reply to HELLO has a maximum length.
pub const MOST_AXES: usize = 6;

/// The limits that a rig enforces.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// One entry an axis.
    pub axes: Vec<AxisBounds>,
    /// Speed of the fastest axis \[m/s\].
    pub top_speed: f64,
}

/// The limits of one axis: \[m\], \[N\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBounds {
    pub displacement: Interval,
    pub force: Interval,
}

impl Bounds {
    /// Whether every axis has a possible position, and a possible speed.
    #[must_use]
    pub fn allow_something(&self) -> bool {
        let some = |bounds: Interval| bounds.low <= bounds.high;
        self.top_speed > 0.0
            && self
                .axes
                .iter()
                .all(|axis| some(axis.displacement) && some(axis.force))
    }
}

/// The first word of a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplyKind {
    Ack,
    Data,
    Err,
}

/// A complete reply.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    pub kind: ReplyKind,
    pub sequence: u32,
    /// As received, without its ending.
    pub line: Vec<u8>,
    /// Index of the boot identifier in it.
    boot: usize,
}

impl Reply {
    /// The boot identifier, 4 hexadecimal digits.
    #[must_use]
    pub fn boot(&self) -> &str {
        ascii_text(&self.line[self.boot..self.boot + BOOT_DIGITS])
    }

    /// The words of the reply. A complete reply in order may still have an empty or unknown field. The rig repeats the same reply to
    /// every repeated request, so this is an invalid reading, not a broken line. A missing word is empty, and not a number.
    #[must_use]
    pub fn words(&self) -> Vec<&str> {
        let body = &self.line[self.boot + BOOT_DIGITS..self.line.len() - CHECK_LENGTH];
        let mut words = Vec::with_capacity(USUAL_WORDS);
        words.extend(body.split(|byte| *byte == b' ').skip(1).map(ascii_text));
        words
    }
}

/// Length of a boot identifier, and of `*` with the checksum.
const BOOT_DIGITS: usize = 4;
const CHECK_LENGTH: usize = 5;

/// Words of a reading of one axis, with reserve.
const USUAL_WORDS: usize = 8;

/// Why a line is not a valid reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Broken {
    Shape,
    Checksum,
}

/// The identity and limits that a rig reports.
#[derive(Clone, Debug, PartialEq)]
pub struct Hello {
    pub model: String,
    pub serial: String,
    pub firmware: String,
    pub bounds: Bounds,
    /// Number and targets of the last move, as written: mm, or N in force control.
    pub last: Option<(u64, Vec<f64>)>,
}

/// The state that a rig reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportedState {
    Idle,
    Moving,
    Held,
}

/// A reading of every axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// \[s\]
    pub time: f64,
    pub axes: Vec<AxisData>,
    pub state: ReportedState,
}

/// The reading of one axis: \[m\], \[N\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisData {
    pub displacement: f64,
    pub force: f64,
    pub raw: i64,
    pub flags: Flags,
}

/// Time until the end of a path \[s\], from the reply to `GLIDE`.
#[must_use]
pub fn left(words: &[&str]) -> Option<f64> {
    let [_, left] = words else { return None };
    number::fixed(left.as_bytes())
        .filter(|left| *left >= 0.0)
        .map(|left| left / 1e3)
}

/// The reply in a line without its ending.
///
/// # Errors
/// It is not a valid reply.
pub fn reply(line: &[u8]) -> Result<Reply, Broken> {
    let [b'<', body @ .., b'*', a, b, c, d] = line else {
        return Err(Broken::Shape);
    };
    let stated = number::hexadecimal(&[*a, *b, *c, *d], 4).ok_or(Broken::Shape)?;
    if stated != checksum(body) && on(Guarding::Checksum) {
        return Err(Broken::Checksum);
    }
    let mut words = body.split(|byte| *byte == b' ');
    let mut next = || words.next().ok_or(Broken::Shape);
    let kind = next()?;
    let (kind_length, kind) = match kind {
        b"ACK" => (kind.len(), ReplyKind::Ack),
        b"DATA" => (kind.len(), ReplyKind::Data),
        b"ERR" => (kind.len(), ReplyKind::Err),
        _ => return Err(Broken::Shape),
    };
    let counted = next()?;
    let sequence = number::count(counted)
        .and_then(|count| u32::try_from(count).ok())
        .ok_or(Broken::Shape)?;
    number::hexadecimal(next()?, BOOT_DIGITS).ok_or(Broken::Shape)?;
    // After `<`: the kind, the number, and a space after each.
    let boot = 1 + kind_length + 1 + counted.len() + 1;
    Ok(Reply {
        kind,
        sequence,
        line: line.to_vec(),
        boot,
    })
}

/// A word of a line; empty for invalid bytes.
fn ascii_text(bytes: &[u8]) -> &str {
    let printable = bytes.iter().all(u8::is_ascii_graphic);
    str::from_utf8(bytes)
        .ok()
        .filter(|_| printable)
        .unwrap_or_default()
}

/// The identity and limits that a rig reports.
#[must_use]
pub fn hello(words: &[&str]) -> Option<Hello> {
    let [model, serial, firmware, numbers @ ..] = words else {
        return None;
    };
    if words.iter().any(|word| word.is_empty()) {
        return None;
    }
    // Four limits and a target for each axis, and two further words.
    let axes = numbers
        .len()
        .checked_sub(2)
        .filter(|words| words.is_multiple_of(5))
        .map(|words| words / 5)?;
    if !(1..=MOST_AXES).contains(&axes) {
        return None;
    }
    let (limits, rest) = numbers.split_at(4 * axes);
    let [top_speed, id, targets @ ..] = rest else {
        return None;
    };
    let axis = |words: &[&str]| {
        let [low, high, least, most] = words else {
            return None;
        };
        Some(AxisBounds {
            displacement: Interval {
                low: millimetres(low)?,
                high: millimetres(high)?,
            },
            force: Interval {
                low: number::fixed(least.as_bytes())?,
                high: number::fixed(most.as_bytes())?,
            },
        })
    };
    let axes = limits.chunks_exact(4).map(axis).collect::<Option<_>>()?;
    let bounds = Bounds {
        axes,
        top_speed: millimetres(top_speed)?,
    };
    let id = number::count(id.as_bytes())?;
    let targets = targets
        .iter()
        .map(|target| number::fixed(target.as_bytes()))
        .collect::<Option<_>>()?;
    let last = (id > 0).then_some((id, targets));
    let [model, serial, firmware] = [model, serial, firmware].map(|word| (*word).to_owned());
    Some(Hello {
        model,
        serial,
        firmware,
        bounds,
        last,
    })
}

/// The reading of a `DATA` reply.
#[must_use]
pub fn data(words: &[&str]) -> Option<Data> {
    let [time, axes @ .., state] = words else {
        return None;
    };
    if axes.is_empty() || !axes.len().is_multiple_of(4) {
        return None;
    }
    #[expect(clippy::cast_precision_loss, reason = "ms since power-up")]
    let time = number::count(time.as_bytes())? as f64 / 1e3;
    let axes = axes.chunks_exact(4).map(axis_data).collect::<Option<_>>()?;
    Some(Data {
        time,
        axes,
        state: self::state(state)?,
    })
}

/// The first axis (from 1) in a `DATA` reply of several axes that has no number in a numeric field.
#[must_use]
pub fn axis_without_number(words: &[&str]) -> Option<usize> {
    let [_, axes @ .., _] = words else {
        return None;
    };
    let several = axes.len() > 4 && axes.len().is_multiple_of(4);
    several
        .then(|| {
            axes.chunks_exact(4)
                .position(|words| axis_data(words).is_none())
        })
        .flatten()
        .map(|axis| axis + 1)
}

fn axis_data(words: &[&str]) -> Option<AxisData> {
    let [displacement, force, raw, flags] = words else {
        return None;
    };
    Some(AxisData {
        displacement: millimetres(displacement)?,
        force: number::fixed(force.as_bytes())?,
        raw: number::whole(raw.as_bytes())?,
        flags: self::flags(flags)?,
    })
}

/// mm as m.
fn millimetres(word: &str) -> Option<f64> {
    number::fixed(word.as_bytes()).map(|value| value / 1e3)
}

/// A word of flags. One with an unknown bit is invalid.
#[must_use]
pub fn flags(word: &str) -> Option<Flags> {
    let bits =
        number::hexadecimal(word.strip_prefix("0x")?.as_bytes(), 4).filter(|bits| *bits < 0x800)?;
    let bit = |index: u16| bits >> index & 1 == 1;
    Some(Flags {
        saturated: bit(0),
        stale: bit(1),
        limit_high: bit(2),
        limit_low: bit(3),
        emergency_stop: bit(4),
        unreferenced: bit(5),
        unsettled: bit(6),
        watchdog_tripped: bit(7),
        in_force_control: bit(8),
        left_at_band: bit(9),
        left_without_cell: bit(10),
    })
}

#[must_use]
pub fn state(word: &str) -> Option<ReportedState> {
    match word {
        "IDLE" => Some(ReportedState::Idle),
        "MOVING" => Some(ReportedState::Moving),
        "HELD" => Some(ReportedState::Held),
        _ => None,
    }
}

/// The meaning of an `ERR` code.
#[must_use]
pub fn refusal(words: &[&str]) -> String {
    let code = words.first().copied().unwrap_or_default();
    let meaning = match code {
        "SEQ" => "the rig expects a different sequence number",
        "VERB" => "the rig does not know this request",
        "ARG" => "the rig rejects this argument",
        "LIMIT" => "outside the limits of the rig",
        "RATE" => "faster than the speed limit of the rig",
        "ID" => "this move number has a different target already",
        "BUSY" => "the rig is still moving",
        "LATE" => "the segment came after its own end",
        "HELD" => "the rig is held",
        "STOP" => "the emergency stop is pressed",
        "REF" => "the rig is not referenced",
        "FAULT" => "the rig reports an internal fault",
        _ => "for a reason unknown to psd",
    };
    format!("{meaning} (`ERR {}`)", words.join(" "))
}

#[cfg(test)]
mod tests;
