//! A Grbl 1.1 board with one axis in use, X. In: lines and real-time bytes. Out: `ok`, errors, status reports. `ok` confirms
//! that a line was understood. The machine coordinates are 0 to −`$130`, with the limit switch at 0. A target beyond them gives
//! `error:15` and no motion.

mod jog;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::fmt::Write as _;

use crate::emulator::{EmulatedRig, Firmware};
use jog::{Jog, number};

/// Longest line, bytes.
const LONGEST: usize = 80;
/// Travel below 0 \[m\]: the factory value of `$130`.
const TRAVEL: f64 = 0.2;
/// Number of jogs that the planner accepts before the host must wait.
const PLANNER: usize = 15;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BoardState {
    Idle,
    Jog,
    Hold,
    Alarm,
}

/// The firmware.
#[derive(Debug)]
pub struct Grbl {
    /// Build information of the owner, which `$I` shows.
    owner: String,
    line: Vec<u8>,
    state: BoardState,
    planned: VecDeque<Jog>,
    /// End of the last planned move \[m\].
    end: f64,
    /// A dwell that is answered once all is at rest: remaining time \[s\] and start time \[s\].
    dwell: Option<(f64, Option<f64>)>,
}

impl Grbl {
    /// A board whose `$I` shows `owner`.
    #[must_use]
    pub fn new(owner: &str) -> Self {
        Self {
            owner: owner.to_owned(),
            line: Vec::new(),
            state: BoardState::Idle,
            planned: VecDeque::new(),
            end: 0.0,
            dwell: None,
        }
    }

    /// Stops and clears the planned moves.
    fn cancel(&mut self, rig: &mut EmulatedRig) {
        rig.hold();
        self.planned.clear();
        self.end = rig.commanded();
        if self.state == BoardState::Jog {
            self.state = BoardState::Idle;
        }
    }

    fn real_time(&mut self, byte: u8, rig: &mut EmulatedRig) -> Option<String> {
        match byte {
            b'?' => Some(self.status(rig)),
            b'!' => {
                // A hold cancels a jog. The board has no other motion.
                let at_rest = self.state == BoardState::Idle;
                self.cancel(rig);
                if at_rest {
                    self.state = BoardState::Hold;
                }
                Some(String::new())
            }
            b'~' => {
                if self.state == BoardState::Hold {
                    self.state = BoardState::Idle;
                }
                Some(String::new())
            }
            0x18 => Some(self.reset(rig)),
            0x85 => {
                self.cancel(rig);
                Some(String::new())
            }
            _ => None,
        }
    }

    fn reset(&mut self, rig: &mut EmulatedRig) -> String {
        let in_motion = rig.moving();
        self.cancel(rig);
        let owner = std::mem::take(&mut self.owner);
        *self = Self {
            end: rig.commanded(),
            ..Self::new(&owner)
        };
        let banner = "\r\nGrbl 1.1h ['$' for help]\r\n";
        if in_motion {
            self.state = BoardState::Alarm;
            format!("ALARM:3\r\n{banner}[MSG:'$H'|'$X' to unlock]\r\n")
        } else {
            banner.to_owned()
        }
    }

    fn status(&self, rig: &EmulatedRig) -> String {
        let state = match self.state {
            BoardState::Idle => "Idle",
            BoardState::Jog => "Jog",
            BoardState::Hold => "Hold:0",
            BoardState::Alarm => "Alarm",
        };
        let feed = if rig.moving() { Self::feed(rig) } else { 0.0 };
        format!(
            "<{state}|MPos:{:.3},0.000,0.000|FS:{feed:.0},0>\r\n",
            rig.commanded() * 1e3
        )
    }

    /// Feed rate of the current move \[mm/min\].
    fn feed(rig: &EmulatedRig) -> f64 {
        rig.moves().last().map_or(0.0, |sent| sent.speed * 6e4)
    }

    fn settings(rig: &EmulatedRig) -> String {
        let settings = rig.settings();
        let numbers = [
            (0, "10".to_owned()),
            (1, "255".to_owned()),
            (10, "1".to_owned()),
            (13, "0".to_owned()),
            (20, "1".to_owned()),
            (21, "1".to_owned()),
            (22, "1".to_owned()),
            (100, "1250.000".to_owned()),
            (110, format!("{:.3}", known(settings.top_speed * 6e4))),
            (120, "100.000".to_owned()),
            (130, format!("{:.3}", TRAVEL * 1e3)),
        ];
        let mut text = String::new();
        for (number, value) in numbers {
            let _ = write!(text, "${number}={value}\r\n");
        }
        text
    }

    /// Executes one line and returns all answers.
    fn carry_out(&mut self, line: &str, rig: &mut EmulatedRig) -> String {
        let bare: String = line
            .chars()
            .filter(|letter| !letter.is_whitespace())
            .collect::<String>()
            .to_ascii_uppercase();
        let answer = match bare.as_str() {
            "" => Ok(String::new()),
            "$$" => Ok(Self::settings(rig)),
            "$I" => Ok(format!(
                "[VER:1.1h.20190825:{}]\r\n[OPT:V,15,128]\r\n",
                self.owner
            )),
            "$X" => {
                let locked = self.state == BoardState::Alarm;
                if locked {
                    self.state = BoardState::Idle;
                }
                Ok(if locked {
                    "[MSG:Caution: Unlocked]\r\n".to_owned()
                } else {
                    String::new()
                })
            }
            bare => match bare.strip_prefix("$J=") {
                Some(words) => self.jog(words, rig).map(|()| String::new()),
                None if bare.starts_with('$') => Err(3),
                None if self.state == BoardState::Alarm
                    || self.state == BoardState::Jog && !bare.starts_with("G4P") =>
                {
                    Err(9)
                }
                None => match bare.strip_prefix("G4P").and_then(number) {
                    Some(seconds) => {
                        self.dwell = Some((seconds, None));
                        return String::new();
                    }
                    None => Err(20),
                },
            },
        };
        match answer {
            Ok(text) => text + "ok\r\n",
            Err(code) => format!("error:{code}\r\n"),
        }
    }

    fn jog(&mut self, words: &str, rig: &mut EmulatedRig) -> Result<(), u32> {
        if !matches!(self.state, BoardState::Idle | BoardState::Jog) {
            return Err(8);
        }
        let Jog { target, speed } = Jog::read(words, self.end)?;
        // The board's numbers have 24 bits: a target on a limit is within it after rounding.
        let rounding = 2e-7 * target.abs();
        if !(-TRAVEL - rounding <= target && target <= 0.0) {
            rig.refuse(target);
            return Err(15);
        }
        if self.planned.len() >= PLANNER {
            return Err(13);
        }
        let limits = rig.settings().limits;
        let on_the_limit = target.clamp(limits.low, limits.high);
        self.end = if (target - on_the_limit).abs() <= rounding {
            on_the_limit
        } else {
            target
        };
        self.planned.push_back(Jog {
            target: self.end,
            speed,
        });
        self.state = BoardState::Jog;
        self.proceed(rig);
        Ok(())
    }

    /// Starts the next planned move once the last one is done.
    fn proceed(&mut self, rig: &mut EmulatedRig) {
        while self.state == BoardState::Jog && !rig.moving() {
            match self.planned.pop_front() {
                Some(Jog { target, speed }) => rig.go(target, speed),
                None => self.state = BoardState::Idle,
            }
        }
    }
}

impl Firmware for Grbl {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let mut reply = Vec::new();
        for byte in bytes {
            self.proceed(rig);
            if let Some(text) = self.real_time(*byte, rig) {
                reply.extend(text.into_bytes());
            } else if matches!(byte, b'\n' | b'\r') {
                let line = std::mem::take(&mut self.line);
                // The second byte of a line ending does not start a new line.
                if !(line.is_empty() && *byte == b'\n') {
                    let text = String::from_utf8_lossy(&line).into_owned();
                    let answer = if line.len() >= LONGEST {
                        "error:11\r\n".to_owned()
                    } else {
                        self.carry_out(&text, rig)
                    };
                    reply.extend(answer.into_bytes());
                }
            } else if self.line.len() < LONGEST {
                self.line.push(*byte);
            }
        }
        reply
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.proceed(rig);
        let now = rig.time();
        match &mut self.dwell {
            Some((seconds, since)) if self.state != BoardState::Jog => {
                let over = now - *since.get_or_insert(now) >= *seconds;
                if over {
                    self.dwell = None;
                    return b"ok\r\n".to_vec();
                }
            }
            _ => {}
        }
        Vec::new()
    }

    /// With `$22=1` it is locked after power-up until it has been homed.
    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        rig.hold();
        let banner = self.reset(rig);
        self.state = BoardState::Alarm;
        format!("{banner}[MSG:'$H'|'$X' to unlock]\r\n").into_bytes()
    }
}

/// Checks that a setting is a number.
const fn known(value: f64) -> f64 {
    if value.is_finite() { value } else { 99_999.0 }
}
