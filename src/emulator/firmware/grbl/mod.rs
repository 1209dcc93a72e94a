//! A Grbl 1.1 board with one axis in use, X. In: lines and real-time bytes. Out: `ok`, errors, status reports. `ok` confirms
//! that a line was understood. The machine coordinates are 0 to −`$130`, with the limit switch at 0. A target beyond them gives
//! `error:15` and no motion.

mod jog;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::fmt::Write as _;

use crate::emulator::{Bench, Firmware};
use jog::{Jog, number};

/// Longest line, bytes.
const LONGEST: usize = 80;
/// Travel below 0 \[m\]: the factory value of `$130`.
const TRAVEL: f64 = 0.2;
/// Number of jogs that the planner accepts before the host must wait.
const PLANNER: usize = 15;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
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
    state: State,
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
            state: State::Idle,
            planned: VecDeque::new(),
            end: 0.0,
            dwell: None,
        }
    }

    /// Stops and clears the planned moves.
    fn cancel(&mut self, bench: &mut Bench) {
        bench.hold();
        self.planned.clear();
        self.end = bench.commanded();
        if self.state == State::Jog {
            self.state = State::Idle;
        }
    }

    fn real_time(&mut self, byte: u8, bench: &mut Bench) -> Option<String> {
        match byte {
            b'?' => Some(self.status(bench)),
            b'!' => {
                // A hold cancels a jog. The board has no other motion.
                let at_rest = self.state == State::Idle;
                self.cancel(bench);
                if at_rest {
                    self.state = State::Hold;
                }
                Some(String::new())
            }
            b'~' => {
                if self.state == State::Hold {
                    self.state = State::Idle;
                }
                Some(String::new())
            }
            0x18 => Some(self.reset(bench)),
            0x85 => {
                self.cancel(bench);
                Some(String::new())
            }
            _ => None,
        }
    }

    fn reset(&mut self, bench: &mut Bench) -> String {
        let in_motion = bench.moving();
        self.cancel(bench);
        let owner = std::mem::take(&mut self.owner);
        *self = Self {
            end: bench.commanded(),
            ..Self::new(&owner)
        };
        let banner = "\r\nGrbl 1.1h ['$' for help]\r\n";
        if in_motion {
            self.state = State::Alarm;
            format!("ALARM:3\r\n{banner}[MSG:'$H'|'$X' to unlock]\r\n")
        } else {
            banner.to_owned()
        }
    }

    fn status(&self, bench: &Bench) -> String {
        let state = match self.state {
            State::Idle => "Idle",
            State::Jog => "Jog",
            State::Hold => "Hold:0",
            State::Alarm => "Alarm",
        };
        let feed = if bench.moving() {
            Self::feed(bench)
        } else {
            0.0
        };
        format!(
            "<{state}|MPos:{:.3},0.000,0.000|FS:{feed:.0},0>\r\n",
            bench.commanded() * 1e3
        )
    }

    /// Feed rate of the current move \[mm/min\].
    fn feed(bench: &Bench) -> f64 {
        bench.moves().last().map_or(0.0, |sent| sent.speed * 6e4)
    }

    fn settings(bench: &Bench) -> String {
        let settings = bench.settings();
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
    fn carry_out(&mut self, line: &str, bench: &mut Bench) -> String {
        let bare: String = line
            .chars()
            .filter(|letter| !letter.is_whitespace())
            .collect::<String>()
            .to_ascii_uppercase();
        let said = match bare.as_str() {
            "" => Ok(String::new()),
            "$$" => Ok(Self::settings(bench)),
            "$I" => Ok(format!(
                "[VER:1.1h.20190825:{}]\r\n[OPT:V,15,128]\r\n",
                self.owner
            )),
            "$X" => {
                let locked = self.state == State::Alarm;
                if locked {
                    self.state = State::Idle;
                }
                Ok(if locked {
                    "[MSG:Caution: Unlocked]\r\n".to_owned()
                } else {
                    String::new()
                })
            }
            bare => match bare.strip_prefix("$J=") {
                Some(words) => self.jog(words, bench).map(|()| String::new()),
                None if bare.starts_with('$') => Err(3),
                None if self.state == State::Alarm
                    || self.state == State::Jog && !bare.starts_with("G4P") =>
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
        match said {
            Ok(text) => text + "ok\r\n",
            Err(code) => format!("error:{code}\r\n"),
        }
    }

    fn jog(&mut self, words: &str, bench: &mut Bench) -> Result<(), u32> {
        if !matches!(self.state, State::Idle | State::Jog) {
            return Err(8);
        }
        let Jog { target, speed } = Jog::read(words, self.end)?;
        // The board's numbers have 24 bits: a target on a limit is within it after rounding.
        let rounding = 2e-7 * target.abs();
        if !(-TRAVEL - rounding <= target && target <= 0.0) {
            bench.refuse(target);
            return Err(15);
        }
        if self.planned.len() >= PLANNER {
            return Err(13);
        }
        let limits = bench.settings().limits;
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
        self.state = State::Jog;
        self.proceed(bench);
        Ok(())
    }

    /// Starts the next planned move once the last one is done.
    fn proceed(&mut self, bench: &mut Bench) {
        while self.state == State::Jog && !bench.moving() {
            match self.planned.pop_front() {
                Some(Jog { target, speed }) => bench.go(target, speed),
                None => self.state = State::Idle,
            }
        }
    }
}

impl Firmware for Grbl {
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8> {
        let mut said = Vec::new();
        for byte in bytes {
            self.proceed(bench);
            if let Some(text) = self.real_time(*byte, bench) {
                said.extend(text.into_bytes());
            } else if matches!(byte, b'\n' | b'\r') {
                let line = std::mem::take(&mut self.line);
                // The second byte of a line ending does not start a new line.
                if !(line.is_empty() && *byte == b'\n') {
                    let text = String::from_utf8_lossy(&line).into_owned();
                    let answer = if line.len() >= LONGEST {
                        "error:11\r\n".to_owned()
                    } else {
                        self.carry_out(&text, bench)
                    };
                    said.extend(answer.into_bytes());
                }
            } else if self.line.len() < LONGEST {
                self.line.push(*byte);
            }
        }
        said
    }

    fn tick(&mut self, bench: &mut Bench) -> Vec<u8> {
        self.proceed(bench);
        let now = bench.time();
        match &mut self.dwell {
            Some((seconds, since)) if self.state != State::Jog => {
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
    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8> {
        bench.hold();
        let banner = self.reset(bench);
        self.state = State::Alarm;
        format!("{banner}[MSG:'$H'|'$X' to unlock]\r\n").into_bytes()
    }
}

/// Checks that a setting is a number.
const fn known(value: f64) -> f64 {
    if value.is_finite() { value } else { 99_999.0 }
}
