//! Grbl 1.1, axis X in machine coordinates. In: a target and a speed; a received line, with anything glued to it. Out: the
//! bytes of a jog; the meaning of the line. It keeps no conversation. `ok` means that a line was parsed, never that the
//! axis has arrived; the position is counted steps, not a measurement.

use crate::controllers::number;

pub const ASK: &[u8] = b"?";
pub const HOLD: &[u8] = b"!";
pub const RESUME: &[u8] = b"~";
/// Discards all pending commands. At rest it keeps its position; in motion it loses it.
pub const RESET: &[u8] = b"\x18";
pub const BUILD: &[u8] = b"$I\n";
pub const SETTINGS: &[u8] = b"$$\n";

/// Lowest speed of Grbl, whatever is commanded \[mm/min\].
pub const SLOWEST: f64 = 1.0;

/// Largest number of digits that Grbl reads.
const DIGITS: usize = 8;

/// The meaning of a line, or of a part of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Word {
    Ok,
    Error(u64),
    Alarm(u64),
    Status(Status),
    /// `$` number and the text of its value.
    Setting(u64, String),
    /// `[VER:…]`: version and the owner's own text.
    Version(String, String),
    /// It has restarted.
    Banner(String),
    /// `[…]` and echoes: no answer to a request.
    Message,
    Unknown,
}

impl Word {
    /// Whether it can be received before the `ok` of a question, as a part of the answer.
    #[must_use]
    pub const fn is_part(&self) -> bool {
        matches!(self, Self::Setting(..) | Self::Version(..) | Self::Message)
    }
}

/// A status report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    pub state: MachineState,
    /// X in machine coordinates \[m\].
    pub position: f64,
}

/// The state in a status report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MachineState {
    Idle,
    Run,
    Jog,
    /// Held, and at rest.
    Held,
    /// Still coming to rest.
    Holding,
    Alarm,
    Door,
    Check,
    Home,
    Sleep,
}

impl std::fmt::Display for MachineState {
    /// The words of the status report.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Idle => "Idle",
            Self::Run => "Run",
            Self::Jog => "Jog",
            Self::Held => "Hold:0",
            Self::Holding => "Hold:1",
            Self::Alarm => "Alarm",
            Self::Door => "Door",
            Self::Check => "Check",
            Self::Home => "Home",
            Self::Sleep => "Sleep",
        })
    }
}

impl MachineState {
    #[must_use]
    pub const fn is_moving(self) -> bool {
        matches!(self, Self::Run | Self::Jog | Self::Holding | Self::Home)
    }
}

/// A jog as it is sent, and its decoded values.
#[derive(Clone, Debug, PartialEq)]
pub struct Jog {
    pub line: Vec<u8>,
    /// \[m\]
    pub target: f64,
    /// \[m/s\]
    pub speed: f64,
}

/// The jog to `target` \[m\] at `speed` \[m/s\].
///
/// # Errors
/// Grbl cannot parse it, or would execute something else.
pub fn jog(target: f64, speed: f64) -> Result<Jog, String> {
    // Numbers have no exponent; 0.1 µm is far finer than a step.
    let target_text = written(target * 1e3, 4)
        .ok_or_else(|| format!("{target} m is not a valid position for Grbl"))?;
    let feed = written(speed * 6e4, 3)
        .ok_or_else(|| format!("{speed} m/s is not a valid speed for Grbl"))?;
    let encoded = |text: &str, scale, meant| {
        number::read_back(text, scale, meant).ok_or_else(|| format!("`{text}` is not a number"))
    };
    let (target, speed) = (
        encoded(&target_text, 1e3, target)?,
        encoded(&feed, 6e4, speed)?,
    );
    if speed.is_nan() || speed * 6e4 < SLOWEST * (1.0 - 1e-12) {
        return Err(format!(
            "{SLOWEST} mm/min is the lowest speed of Grbl; requested: {feed} mm/min"
        ));
    }
    Ok(Jog {
        line: format!("$J=G21G90G53X{target_text}F{feed}\n").into_bytes(),
        target,
        speed,
    })
}

fn written(value: f64, decimals: usize) -> Option<String> {
    number::write(value, decimals)
        .filter(|text| text.bytes().filter(u8::is_ascii_digit).count() <= DIGITS)
}

/// The meaning of a line, part by part: on some clones a status is glued to an `ok`, and a start banner comes in the middle
/// of a line.
#[must_use]
pub fn words(line: &[u8]) -> Vec<Word> {
    if let Some(at) = line.windows(5).position(|window| window == b"Grbl ") {
        return vec![Word::Banner(printable(&line[at..]))];
    }
    let mut words = Vec::new();
    let mut rest = line.trim_ascii();
    while !rest.is_empty() {
        let (word, length) = first(rest);
        words.push(word);
        rest = rest[length..].trim_ascii_start();
    }
    words
}

/// The first part and its length.
fn first(rest: &[u8]) -> (Word, usize) {
    let all = rest.len();
    match rest {
        [b'<', ..] => match rest.iter().position(|byte| *byte == b'>') {
            Some(end) => (
                status(&rest[1..end]).map_or(Word::Unknown, Word::Status),
                end + 1,
            ),
            None => (Word::Unknown, all),
        },
        b"ok" | [b'o', b'k', b'<', ..] | [b'o', b'k', b'o', b'k', ..] => (Word::Ok, 2),
        [b'e', b'r', b'r', b'o', b'r', b':', code @ ..] => {
            numbered(code, b"error:".len(), Word::Error)
        }
        [b'A', b'L', b'A', b'R', b'M', b':', code @ ..] => {
            numbered(code, b"ALARM:".len(), Word::Alarm)
        }
        [b'$', setting @ ..] => (self::setting(setting).unwrap_or(Word::Unknown), all),
        [b'[', b'V', b'E', b'R', b':', text @ .., b']'] => {
            let mut fields = text.splitn(2, |byte| *byte == b':').map(printable);
            let mut field = || fields.next().unwrap_or_default();
            (Word::Version(field(), field()), all)
        }
        [b'[', .., b']'] | [b'>', ..] => (Word::Message, all),
        _ => (Word::Unknown, all),
    }
}

/// A code of 1 to 3 digits, at the end or with a status glued to it.
fn numbered(code: &[u8], before: usize, word: fn(u64) -> Word) -> (Word, usize) {
    let digits = code
        .iter()
        .position(|byte| *byte == b'<')
        .unwrap_or(code.len());
    let known = (digits <= 3)
        .then(|| number::count(&code[..digits]))
        .flatten();
    (known.map_or(Word::Unknown, word), before + digits)
}

fn setting(text: &[u8]) -> Option<Word> {
    let at = text.iter().position(|byte| *byte == b'=')?;
    number::fixed(&text[at + 1..])?;
    Some(Word::Setting(
        number::count(&text[..at])?,
        printable(&text[at + 1..]),
    ))
}

fn status(report: &[u8]) -> Option<Status> {
    let mut fields = report.split(|byte| *byte == b'|');
    let state = match fields.next()? {
        b"Idle" => MachineState::Idle,
        b"Run" => MachineState::Run,
        b"Jog" => MachineState::Jog,
        b"Hold:0" => MachineState::Held,
        b"Hold:1" => MachineState::Holding,
        b"Alarm" => MachineState::Alarm,
        b"Door" | b"Door:0" | b"Door:1" | b"Door:2" | b"Door:3" => MachineState::Door,
        b"Check" => MachineState::Check,
        b"Home" => MachineState::Home,
        b"Sleep" => MachineState::Sleep,
        _ => return None,
    };
    let axes: Option<Vec<f64>> = fields
        .next()?
        .strip_prefix(b"MPos:")?
        .split(|byte| *byte == b',')
        .map(number::fixed)
        .collect();
    Some(Status {
        state,
        position: axes?.first()? / 1e3,
    })
}

fn printable(bytes: &[u8]) -> String {
    bytes.escape_ascii().to_string()
}

/// The meaning of an `error:` code that a jog or a question can cause.
#[must_use]
pub const fn error(code: u64) -> &'static str {
    match code {
        3 | 33 => "it does not understand the line",
        8 => "it is not at rest",
        9 => "it is locked by an alarm or still moving",
        11 | 14 => "the line is too long",
        15 => "the target is outside its travel",
        16 => "it does not understand the jog",
        22 => "the speed is missing",
        _ => "see Grbl's list of error codes",
    }
}

/// The meaning of an `ALARM:` code.
#[must_use]
pub const fn alarm(code: u64) -> &'static str {
    match code {
        1 => "a limit switch was hit; its position is probably lost",
        2 => "the target is outside its travel",
        3 => "it was reset during a motion; its position is probably lost",
        6..=9 => "homing failed",
        _ => "see Grbl's list of alarm codes",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(line: &str) -> Word {
        let words = words(line.as_bytes());
        assert_eq!(words.len(), 1, "{words:?}");
        words.into_iter().next().unwrap()
    }

    #[test]
    fn a_jog_is_absolute_in_machine_millimetres_and_states_its_effect() {
        let jog = jog(1.25e-3, 0.5e-3).unwrap();
        assert_eq!(jog.line, b"$J=G21G90G53X1.2500F30.000\n");
        assert_eq!((jog.target, jog.speed), (1.25e-3, 0.5e-3));
        let rounded = super::jog(-0.000_999_96, 1e-3).unwrap();
        assert!(rounded.line.starts_with(b"$J=G21G90G53X-1.0000F"));
        assert_eq!(rounded.target, -0.001);
    }

    #[test]
    fn targets_that_grbl_would_round_are_not_sent() {
        for (target, speed) in [
            (f64::NAN, 1e-3),
            (f64::INFINITY, 1e-3),
            (10.0, 1e-3),
            (0.001, f64::NAN),
            (0.001, 0.0),
            (0.001, -1e-3),
            (0.001, 0.9 / 6e4),
            (0.001, 2.0),
        ] {
            assert!(jog(target, speed).is_err(), "{target} {speed}");
        }
        assert!(jog(9.999, 1.6).is_ok() && jog(0.001, 1.0 / 6e4).is_ok());
    }

    #[test]
    fn a_line_is_understood_whole() {
        assert_eq!(one("ok\r"), Word::Ok);
        assert_eq!(one("error:15"), Word::Error(15));
        assert_eq!(one("ALARM:3"), Word::Alarm(3));
        assert_eq!(
            one("$110=500.000"),
            Word::Setting(110, "500.000".to_owned())
        );
        assert_eq!(
            one("[VER:1.1h.20190825:bench]"),
            Word::Version("1.1h.20190825".to_owned(), "bench".to_owned())
        );
        assert_eq!(one("[MSG:'$H'|'$X' to unlock]"), Word::Message);
        assert_eq!(
            one("Grbl 1.1h ['$' for help]"),
            Word::Banner("Grbl 1.1h [\\'$\\' for help]".to_owned())
        );
        let status = |state, position| Word::Status(Status { state, position });
        assert_eq!(
            one("<Idle|MPos:1.250,0.000,0.000|FS:0,0>"),
            status(MachineState::Idle, 1.25e-3)
        );
        assert_eq!(
            one("<Hold:1|MPos:-5.529,0.560,7.000|FS:0,0|Pn:X>"),
            status(MachineState::Holding, -5.529e-3)
        );
        assert!(
            MachineState::Holding.is_moving()
                && MachineState::Jog.is_moving()
                && !MachineState::Held.is_moving()
        );
    }

    #[test]
    fn joined_lines_are_split_and_a_start_in_the_middle_is_detected() {
        let idle = Word::Status(Status {
            state: MachineState::Idle,
            position: 0.0,
        });
        assert_eq!(
            words(b"ok<Idle|MPos:0.000,0.000,0.000|FS:0,0>"),
            [Word::Ok, idle.clone()]
        );
        assert_eq!(
            words(b"<Idle|MPos:0.000,0.000,0.000>ok"),
            [idle.clone(), Word::Ok]
        );
        assert_eq!(
            words(b"error:9<Idle|MPos:0.000,0.000,0.000>"),
            [Word::Error(9), idle]
        );
        assert!(matches!(
            words(b"<Idle|MPos:0.0\r\nGrbl 1.1h ['$' for help]").as_slice(),
            [Word::Banner(_)]
        ));
        assert!(matches!(
            words(b"<Idle|MPos:0.000,0.0Grbl 1.1h ['$' for help]").as_slice(),
            [Word::Banner(_)]
        ));
        assert_eq!(words(b"  \r"), []);
    }

    #[test]
    fn a_damaged_line_has_no_meaning() {
        for line in [
            "<Idle|MPos:1.250,0.000",
            "<Idle|MPos:1.2 50,0.000,0.000>",
            "<Idle|MPos:--1.250,0.000,0.000>",
            "<Idle|MPos:nan,0.000,0.000>",
            "<Idle|MPos:1.250,,0.000>",
            "<Idle|WPos:1.250,0.000,0.000>",
            "<Idle|FS:0,0>",
            "<idle|MPos:1.250,0.000,0.000>",
            "<Hold|MPos:1.250,0.000,0.000>",
            "okay",
            "error:1x",
            "error:",
            "error:1234",
            "$110=fast",
            "\0ok",
            "MPos:1.250",
        ] {
            assert!(
                words(line.as_bytes())
                    .iter()
                    .all(|word| *word == Word::Unknown),
                "{line}: {:?}",
                words(line.as_bytes())
            );
        }
        let whole = b"<Idle|MPos:1.250,0.000,0.000|FS:0,0>";
        for length in 1..whole.len() {
            assert_eq!(
                words(&whole[..length]),
                [Word::Unknown],
                "a status cut after {length} bytes"
            );
        }
    }
}
