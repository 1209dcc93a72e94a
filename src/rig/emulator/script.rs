//! Parses a script of faults. In: lines such as `after 12 moves: drop replies 3`. Out: a [`Script`], or the first invalid line
//! and the reason. It starts no fault itself.
//!
//! A line is `WHEN: WHAT`; `#` begins a comment. WHEN is `at 4.5 s`, `after 12 moves`, `after 20 readings`, `after 3 replies`,
//! `each reply` or `each reading`; the last two can end with a probability, `with 0.01`. WHAT can begin with `load cell` or
//! `actuator`, the affected line. `of axis 2` follows if an axis has its own device. WHAT can also begin with `axis 2`, the
//! actuator of a fault of one actuator. WHAT is one of
//!
//! ```text
//! drop REPLIES                     split REPLIES at 5 bytes        split REPLIES every 1 bytes
//! cut REPLIES at 5 bytes           repeat REPLIES                  replay REPLIES (the one before in its place)
//! delay REPLIES 0.4 s              flip a bit [of REPLIES]         flip bit 17 [of REPLIES]
//! garbage 20 bytes before [REPLIES]      (or inside, or after)     fill 1048576 bytes of 41 before [REPLIES]
//! hang up                          hang up before reply            hang up after reply
//! reboot                           stop reading                    freeze firmware 5 s
//! freeze force                     freeze displacement             scale force by -1
//! scale displacement by 25.4       clip force at 900 N             drift force 2 N/s
//! spike 500 N                      number 9.91E37                  number ""
//! reach 40 %                       stick                           lag 0.2 s
//! drift displacement 0.001 mm/s    fracture at 3 mm to 10 %        coast 2 s
//! ```
//!
//! A line without WHEN, `stands at 3 mm` or `axis 2 stands at 3 mm`, sets the initial position of an actuator in the
//! coordinates of its controller. The specimen is undeformed there.
//!
//! Above, REPLIES is `reply`, `replies 3` or `replies for ever`. A fault after a number of moves or readings affects the reply
//! to the last of them; `after 3 replies` affects the fourth.

mod fault_words;
#[cfg(test)]
mod tests;
mod words;

use super::emulated_rig::fault::MechanicalFault;
use words::Words;

/// The faults, in the order of their lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    pub faults: Vec<ScriptedFault>,
    /// Indices of actuators and their initial positions \[m\].
    pub starts: Vec<(usize, f64)>,
}

/// One line of a script.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptedFault {
    /// On the line of the load cell, and not of the actuator.
    pub on_load_cell: bool,
    /// Index of the axis whose own device has the faulty line.
    pub own_of: Option<usize>,
    /// Index of the affected actuator, for a fault of one actuator; 0: the first.
    pub actuator: usize,
    pub when: When,
    pub what: What,
}

/// The start of a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// Time since power-up \[s\].
    At(f64),
    AfterMoves(u64),
    AfterReadings(u64),
    AfterReplies(u64),
    /// With a probability, 0 to 1.
    EachReply(f64),
    EachReading(f64),
}

#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// Affects this number of replies, or all from then on.
    Replies(ReplyFault, Option<u64>),
    Line(LineFault),
    Rig(MechanicalFault),
}

/// A fault of a reply on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplyFault {
    Drop,
    /// In two parts, the first of this many bytes.
    SplitAt(usize),
    SplitEvery(usize),
    /// Only its first bytes arrive.
    CutAt(usize),
    /// The bit, counted from the first of the reply; None: any.
    FlipBit(Option<usize>),
    /// Adds this number of bytes, of this value or random.
    Garbage {
        count: usize,
        byte: Option<u8>,
        position: GarbagePosition,
    },
    Repeat,
    Replay,
    /// ms
    Delay(u64),
    HangUpBefore,
    HangUpAfter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GarbagePosition {
    Before,
    Inside,
    After,
}

/// A fault of a line or of its controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineFault {
    HangUp,
    Reboot,
    /// Reads no more bytes.
    StopReading,
    /// Does nothing for this time \[s\]; bytes received meanwhile are handled afterwards.
    FreezeFirmware(f64),
}

/// The reason why a script is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct ScriptError {
    /// From 1.
    pub line: usize,
    pub reason: String,
}

impl Script {
    /// Parses a script.
    ///
    /// # Errors
    /// The first invalid line.
    pub fn parse(text: &str) -> Result<Self, ScriptError> {
        let mut script = Self::default();
        for (at, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if !line.is_empty() {
                script.add(line).map_err(|reason| ScriptError {
                    line: at + 1,
                    reason,
                })?;
            }
        }
        Ok(script)
    }

    fn add(&mut self, line: &str) -> Result<(), String> {
        let mut words = Words::split(line);
        let actuator = if words.take(&["axis"]) {
            words.axis()?
        } else {
            0
        };
        if words.take(&["stands", "at"]) {
            self.starts.push((actuator, words.amount("mm")? * 1e-3));
            return words.end();
        }
        self.faults.push(fault(line)?);
        Ok(())
    }
}

fn fault(line: &str) -> Result<ScriptedFault, String> {
    let (when, what) = line
        .split_once(':')
        .ok_or("`:` is missing between the time and the fault")?;
    let mut words = Words::split(what);
    let probability = words.probability()?;
    let when = self::when(when, probability)?;
    let on_load_cell = words.take(&["load", "cell"]);
    let on_a_line = on_load_cell || words.take(&["actuator"]);
    let own_of = if on_a_line && words.take(&["of", "axis"]) {
        Some(words.axis()?)
    } else {
        None
    };
    let actuator = if words.take(&["axis"]) {
        words.axis()?
    } else {
        0
    };
    let what = fault_words::what(&mut words)?;
    words.end()?;
    if actuator > 0 && !matches!(what, What::Rig(_)) {
        return Err(
            "only a fault of an actuator, its specimen or its sensors can have an axis".to_owned(),
        );
    }
    match (&when, &what) {
        (
            When::EachReading(_),
            What::Rig(MechanicalFault::Spike(_) | MechanicalFault::Number(_)),
        )
        | (When::EachReply(_), What::Replies(..)) => {}
        (When::EachReading(_), _) => {
            return Err("`each reading` allows only a spike or a bad number".to_owned());
        }
        (When::EachReply(_), _) => {
            return Err("`each reply` allows only faults of a reply".to_owned());
        }
        _ => {}
    }
    Ok(ScriptedFault {
        on_load_cell,
        own_of,
        actuator,
        when,
        what,
    })
}

impl ScriptedFault {
    /// Returns the index of the affected controller; None if there is no such controller.
    #[must_use]
    pub fn line_index(&self, names: &[String]) -> Option<usize> {
        let role = if self.on_load_cell {
            "load cell"
        } else {
            "actuator"
        };
        match self.own_of {
            Some(axis) => names
                .iter()
                .position(|name| *name == format!("{role} of axis {}", axis + 1)),
            None => names.iter().position(|name| name.starts_with(role)),
        }
    }
}

fn when(text: &str, probability: Option<f64>) -> Result<When, String> {
    let mut words = Words::split(text);
    let when = if words.take(&["at"]) {
        When::At(words.amount("s")?)
    } else if words.take(&["after"]) {
        let count = words.count()?;
        match words.next()? {
            "move" | "moves" => When::AfterMoves(count),
            "reading" | "readings" => When::AfterReadings(count),
            "reply" | "replies" => When::AfterReplies(count),
            other => {
                return Err(format!(
                    "`{other}` cannot be counted: write moves, readings or replies"
                ));
            }
        }
    } else if words.take(&["each", "reply"]) {
        When::EachReply(probability.unwrap_or(1.0))
    } else if words.take(&["each", "reading"]) {
        When::EachReading(probability.unwrap_or(1.0))
    } else {
        return Err(format!(
            "`{}` is not a time: write `at`, `after`, `each reply` or `each reading`",
            text.trim()
        ));
    };
    words.end()?;
    if probability.is_some() && !matches!(when, When::EachReply(_) | When::EachReading(_)) {
        return Err("a probability requires `each reply` or `each reading`".to_owned());
    }
    Ok(when)
}
