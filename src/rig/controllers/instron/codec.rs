//! The console of an Instron 8800-style controller: ASCII lines ended by CR LF. In: channels, fractions of full scale,
//! seconds. Out: the bytes of questions and commands, and the meaning of answers and status words. Only questions (`Q`) are
//! answered; every command is sent between taking and releasing control, otherwise the hydraulics trip. It knows no device.

use crate::controllers::number;

/// Ends every line, in both directions.
pub const ENDING: &[u8] = b"\r\n";

/// Takes control from the front panel and switches off the watchdog of the link.
const TAKE: [&str; 2] = ["P909,1", "C904,0"];
const GIVE_BACK: &str = "P909,0";

/// Decimals of a target: 1e-8 of full scale.
const TARGET_DECIMALS: usize = 8;
/// Shortest ramp \[ms\]: a move of zero length also takes this time.
const SHORTEST_RAMP: u64 = 100;

/// The questions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// Full scale of a channel, m or N.
    FullScale(Channel),
    /// Position of a channel, as a fraction of full scale.
    Feedback(Channel),
    /// Target of the position ramp, as a fraction of full scale.
    Target,
    /// Time of the position ramp \[s\].
    RampTime,
    Movement,
    Status,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    Position,
    Load,
}

impl std::fmt::Display for Channel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Position => "position",
            Self::Load => "load",
        })
    }
}

/// The motion of the actuator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Movement {
    Stopped,
    Running,
    Holding,
}

/// The meaning of the status word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    pub actuator_off: bool,
    /// None: no trouble.
    pub trouble: Option<Trouble>,
}

/// The reason of a trip: bits 9 to 12 of the status word, read as one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    TravelLimit,
    EmergencyStop,
    /// Described in text.
    Hydraulics(&'static str),
}

impl Channel {
    const fn number(self) -> u8 {
        match self {
            Self::Position => 1,
            Self::Load => 2,
        }
    }
}

impl Question {
    /// The line with this question.
    #[must_use]
    pub fn line(self) -> Vec<u8> {
        line(&match self {
            Self::FullScale(channel) => format!("Q308,{}", channel.number()),
            Self::Feedback(channel) => format!("Q134,{},0", channel.number()),
            Self::Target => "Q4,1".to_owned(),
            Self::RampTime => "Q86,1".to_owned(),
            Self::Movement => "Q1".to_owned(),
            Self::Status => "Q22".to_owned(),
        })
    }
}

/// The lines that prepare a ramp and do not start it: stop, position mode, absolute ramp, its time \[s\], its target
/// (fraction of full scale). The time is rounded up to the next millisecond, so nothing moves faster than requested. None
/// for a number that cannot be written.
#[must_use]
pub fn ramp(target: f64, seconds: f64) -> Option<Vec<Vec<u8>>> {
    let milliseconds = (seconds * 1000.0 * (1.0 - 1e-12)).ceil();
    if !((-1.0..=1.0).contains(&target) && 0.0 <= seconds && milliseconds <= 1e9) {
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and between 0 and 1e9"
    )]
    let milliseconds = (milliseconds as u64).max(SHORTEST_RAMP);
    let time = format!("C86,1,{}.{:03}", milliseconds / 1000, milliseconds % 1000);
    Some(orders(&[
        "C1,0",
        "C300,1",
        "C2,1,3",
        &time,
        &format!("C4,1,{target:.TARGET_DECIMALS$}"),
    ]))
}

/// The lines that start the ramp that is ready.
#[must_use]
pub fn start() -> Vec<Vec<u8>> {
    orders(&["C1,1"])
}

/// The lines that hold the actuator at its position, in position control.
#[must_use]
pub fn hold() -> Vec<Vec<u8>> {
    orders(&["C1,2"])
}

/// Target (fraction of full scale) and time \[s\] of a ramp, read back from the lines that make it ready.
#[must_use]
pub fn decoded_ramp(frames: &[Vec<u8>]) -> Option<(f64, f64)> {
    let number = |start: &[u8]| {
        frames
            .iter()
            .find_map(|frame| number::fixed(frame.strip_prefix(start)?.strip_suffix(ENDING)?))
    };
    Some((number(b"C4,1,")?, number(b"C86,1,")?))
}

/// The number of an answer.
#[must_use]
pub fn number(answer: &[u8]) -> Option<f64> {
    number::scientific(answer)
}

#[must_use]
pub fn movement(answer: &[u8]) -> Option<Movement> {
    match answer {
        b"0" => Some(Movement::Stopped),
        b"1" => Some(Movement::Running),
        b"2" => Some(Movement::Holding),
        _ => None,
    }
}

#[must_use]
pub fn status(answer: &[u8]) -> Option<Status> {
    if answer.is_empty() || answer.len() > 9 || !answer.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let word = answer
        .iter()
        .fold(0_u32, |word, digit| 10 * word + u32::from(digit - b'0'));
    let trouble = match word >> 9 & 0xF {
        0 | 15 => None,
        1 => Some(Trouble::TravelLimit),
        6 => Some(Trouble::EmergencyStop),
        2 => Some(Trouble::Hydraulics("power amplifier too hot")),
        7 => Some(Trouble::Hydraulics("oil too hot")),
        8 => Some(Trouble::Hydraulics("oil level too low")),
        9 => Some(Trouble::Hydraulics("motor too hot")),
        10 => Some(Trouble::Hydraulics("oil pressure too high")),
        11 => Some(Trouble::Hydraulics("oil pressure too low")),
        12 => Some(Trouble::Hydraulics("manifold or pump blocked")),
        13 => Some(Trouble::Hydraulics("oil level falling too low")),
        14 => Some(Trouble::Hydraulics("manifold pressure low")),
        _ => Some(Trouble::Hydraulics("an unknown status")),
    };
    Some(Status {
        actuator_off: word >> 3 & 1 == 1,
        trouble,
    })
}

impl std::fmt::Display for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::TravelLimit => "travel limit exceeded",
            Self::EmergencyStop => "emergency stop pushed",
            Self::Hydraulics(words) => words,
        })
    }
}

fn orders(orders: &[&str]) -> Vec<Vec<u8>> {
    TAKE.iter()
        .chain(orders)
        .chain(&[GIVE_BACK])
        .map(|order| line(order))
        .collect()
}

fn line(text: &str) -> Vec<u8> {
    [text.as_bytes(), ENDING].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(frames: &[Vec<u8>]) -> String {
        frames
            .iter()
            .map(|frame| {
                String::from_utf8(frame.clone())
                    .unwrap()
                    .replace("\r\n", " ")
            })
            .collect()
    }

    #[test]
    fn every_command_is_between_taking_control_and_returning_it() {
        let ramp = ramp(-0.123_456_789, 2.0).unwrap();
        assert_eq!(
            text(&ramp),
            "P909,1 C904,0 C1,0 C300,1 C2,1,3 C86,1,2.000 C4,1,-0.12345679 P909,0 "
        );
        assert_eq!(text(&start()), "P909,1 C904,0 C1,1 P909,0 ");
        assert_eq!(text(&hold()), "P909,1 C904,0 C1,2 P909,0 ");
        assert!(ramp.iter().all(|frame| frame.ends_with(b"\r\n")));
    }

    #[test]
    fn the_values_of_a_ramp_are_decoded_from_its_bytes() {
        assert_eq!(
            decoded_ramp(&ramp(0.5, 0.250_1).unwrap()),
            Some((0.5, 0.251))
        );
        assert_eq!(
            decoded_ramp(&ramp(1e-9, 0.0).unwrap()),
            Some((0.0, 0.1)),
            "a move of nothing takes the shortest ramp"
        );
        assert_eq!(
            decoded_ramp(&ramp(0.1, 0.3).unwrap()),
            Some((0.1, 0.3)),
            "no millisecond for the last bit of a float"
        );
        for (target, seconds) in [
            (1.01, 1.0),
            (f64::NAN, 1.0),
            (0.0, f64::NAN),
            (0.0, f64::INFINITY),
            (0.0, -1e-4),
        ] {
            assert_eq!(ramp(target, seconds), None, "{target} {seconds}");
        }
        assert_eq!(decoded_ramp(&start()), None);
    }

    #[test]
    fn questions_are_those_of_the_console() {
        let lines: Vec<Vec<u8>> = [
            Question::FullScale(Channel::Load),
            Question::Feedback(Channel::Position),
            Question::Target,
            Question::RampTime,
            Question::Movement,
            Question::Status,
        ]
        .map(Question::line)
        .to_vec();
        assert_eq!(text(&lines), "Q308,2 Q134,1,0 Q4,1 Q86,1 Q1 Q22 ");
    }

    #[test]
    fn status_words_state_what_tripped() {
        let status_of = |word: u32| status(word.to_string().as_bytes()).unwrap();
        for fine in [0, 0x1E00] {
            assert_eq!(
                status_of(fine),
                Status {
                    actuator_off: false,
                    trouble: None
                }
            );
        }
        assert!(status_of(0x8).actuator_off);
        assert_eq!(status_of(1 << 9).trouble, Some(Trouble::TravelLimit));
        assert_eq!(status_of(6 << 9).trouble, Some(Trouble::EmergencyStop));
        assert_eq!(
            status_of(11 << 9).trouble.unwrap().to_string(),
            "oil pressure too low"
        );
        for code in 1..15 {
            assert!(status_of(code << 9).trouble.is_some(), "{code}");
        }
        for none in [&b""[..], b"-1", b"1.0", b"OVL", b"1234567890"] {
            assert_eq!(status(none), None);
        }
        assert_eq!(movement(b"2"), Some(Movement::Holding));
        assert_eq!(movement(b"3"), None);
        assert_eq!(number(b"-0.25"), Some(-0.25));
        assert_eq!(number(b"0,25"), None);
    }
}
