//! A stepper frame with Grbl 1.1, axis X. In: moves in SI. Out: jogs in absolute machine millimetres, and where the
//! controller counts the axis to be. It measures nothing: without a transducer the loop is open.

use std::collections::BTreeMap;

use crate::rig::controllers::grbl;
use crate::rig::controllers::grbl::codec::{State, Status, Word};
use crate::rig::controllers::request_reply::Asking;
use crate::rig::controllers::{
    Answer, Device, DeviceFault, DeviceIdentity, Move, Sample, Talk, one_axis,
};
use crate::rig::{JUST_STARTED, Tally};

/// Settings without which a specimen is not safe: number, value, why.
const REQUIRED: [(u64, &str, &str); 6] = [
    (1, "255", "the motor must keep holding"),
    (10, "1", "it must report machine positions"),
    (13, "0", "it must report millimetres"),
    (20, "1", "targets outside its travel must be refused"),
    (21, "1", "end switches must stop it"),
    (22, "1", "it must know where it is"),
];

/// Fastest X may go, mm/min.
const TOP_SPEED: u64 = 110;
/// Steps per mm of X.
const STEPS: u64 = 100;

/// The frame at the other end of a line.
pub struct GrblDevice {
    talk: Talk,
    asking: Asking,
    settings: BTreeMap<u64, f64>,
    /// Has said who it is: a start from now on loses the position.
    known: bool,
    /// A jog was sent and not answered: it may wait in the controller.
    unanswered: bool,
    /// Held by this driver.
    held: bool,
}

impl GrblDevice {
    #[must_use]
    pub fn new(talk: Talk) -> Self {
        let asking = Asking::default();
        Self {
            talk,
            asking,
            settings: BTreeMap::new(),
            known: false,
            unanswered: false,
            held: false,
        }
    }

    /// Where it is, with the bytes that say so. A status asked for earlier agrees with one asked for now where both say
    /// the same, or that it moves.
    fn status(&mut self) -> Result<(Status, Vec<u8>), DeviceFault> {
        let known = self.known;
        let accept = |line: &[u8]| {
            find(line, known, |word| {
                if let Word::Status(status) = word {
                    Some(*status)
                } else {
                    None
                }
            })
        };
        let same = |a: &(Status, Vec<u8>), b: &(Status, Vec<u8>)| {
            a.0 == b.0 || a.0.state.is_moving() && b.0.state.is_moving()
        };
        self.asking
            .ask(&mut self.talk, grbl::codec::ASK, accept, same)
    }

    /// Its status, where it can move or is moving.
    fn fit_status(&mut self) -> Result<(Status, Vec<u8>), DeviceFault> {
        let (status, raw) = self.status()?;
        let reason = match status.state {
            State::Alarm => "it is in alarm and does not know where it is: home it (`$H`)",
            State::Door => "its safety door is open",
            State::Check => "it only checks what it is told (`$C`)",
            State::Sleep => "it is asleep and its motor holds nothing",
            _ => return Ok((status, raw)),
        };
        Err(DeviceFault::Refused {
            reason: reason.to_owned(),
        })
    }

    /// Sends a line that acts once however often it is heard, and collects what comes before its `ok`: settings, versions and
    /// messages are parts of the answer, all else is none of it.
    fn command(
        &mut self,
        line: &[u8],
        mut each: impl FnMut(&Word, &[u8]),
        enough: impl Fn(&[Word]) -> bool,
    ) -> Result<(), DeviceFault> {
        let known = self.known;
        let (mut seen, mut lines) = (Vec::new(), Vec::new());
        self.talk.exchange(line, b"\n", |line| {
            let words = grbl::codec::words(line);
            let is_part = !words.is_empty() && words.iter().all(Word::is_part);
            for word in words {
                if let Some(fault) = fault(&word, known) {
                    return Answer::Fault(fault);
                }
                if word == Word::Ok && enough(&seen) {
                    seen.iter()
                        .zip(&lines)
                        .for_each(|(word, line): (&Word, &Vec<u8>)| each(word, line));
                    return Answer::Take(());
                }
                seen.push(word);
                lines.push(line.to_vec());
            }
            if is_part {
                Answer::Part
            } else {
                Answer::Ignore
            }
        })
    }

    /// Waits until it is in this state, a few time-outs long.
    fn until(&mut self, wanted: impl Fn(State) -> bool) -> Result<Status, DeviceFault> {
        let give_up = self.talk.now() + 8.0 * self.talk.reply_timeout();
        loop {
            let (status, _) = self.status()?;
            if wanted(status.state) {
                return Ok(status);
            }
            if self.talk.now() >= give_up {
                return Err(DeviceFault::Unfit(format!(
                    "it stays in the state {:?}",
                    status.state
                )));
            }
            self.talk.sleep(self.talk.reply_timeout() / 4.0)?;
        }
    }

    /// Makes sure that a jog begins at once: a line sent to a held axis waits, and moves it when somebody lets go of it.
    fn make_ready(&mut self) -> Result<(), DeviceFault> {
        let refused = |reason: &str| {
            Err(DeviceFault::Refused {
                reason: reason.to_owned(),
            })
        };
        match self.fit_status()?.0.state {
            State::Idle => Ok(()),
            State::Held if self.unanswered => refused(
                "a move that was never answered may wait in it: look at it, then begin again with `--let-go`",
            ),
            State::Held if self.held => self.resume_at_rest(),
            State::Held => refused("it is held by somebody else"),
            _ => refused("it is still moving"),
        }
    }

    /// Nothing waits in it, so that nothing moves when it is let go of.
    fn resume_at_rest(&mut self) -> Result<(), DeviceFault> {
        self.talk.send(grbl::codec::RESUME)?;
        self.until(|state| state == State::Idle)?;
        self.held = false;
        Ok(())
    }

    /// Lets go of an axis that stands held at this place, as a person wants: it forgets what was interrupted, and moves nothing.
    /// To resume (`~`) would finish the move that was held.
    fn let_go(&mut self, held: Status) -> Result<(), DeviceFault> {
        let unfit = |reason: &str| Err(DeviceFault::Unfit(reason.to_owned()));
        // Asked once more: a reset in motion would lose the position.
        if self.status()?.0 != held {
            return unfit("it is held and does not rest: it is not let go of");
        }
        self.talk.drain()?;
        self.talk.exchange_once(grbl::codec::RESET, b"\n", |line| {
            let words = grbl::codec::words(line);
            let alarm = words.iter().find(|word| matches!(word, Word::Alarm(_)));
            match alarm.and_then(|word| fault(word, false)) {
                Some(fault) => Answer::Fault(fault),
                None if words.iter().any(|word| matches!(word, Word::Banner(_))) => {
                    Answer::Take(())
                }
                None => Answer::Part,
            }
        })?;
        self.asking.doubt();
        let (now, _) = self.fit_status()?;
        if now
            == (Status {
                state: State::Idle,
                ..held
            })
        {
            return Ok(());
        }
        unfit("let go of, it is not idle where it was held: home it (`$H`)")
    }

    /// One step, m.
    fn quantum(&self) -> f64 {
        let steps = self
            .settings
            .get(&STEPS)
            .copied()
            .filter(|steps| *steps > 0.0);
        // Its report has 3 decimals.
        steps.map_or(0.0, |steps| 1e-3 / steps) + 0.5e-6
    }
}

/// Who a controller is that says its version in this line; the line before it, if there is one, is what it said of its start.
pub(crate) fn introduced(said: &[u8]) -> Option<DeviceIdentity> {
    let words: Vec<Word> = said
        .split(|byte| *byte == b'\n')
        .flat_map(grbl::codec::words)
        .collect();
    let (firmware, serial) = words.iter().find_map(|word| match word {
        Word::Version(version, text) => Some((version.clone(), text.clone())),
        _ => None,
    })?;
    let boot = words
        .iter()
        .any(|word| matches!(word, Word::Banner(_)))
        .then(|| JUST_STARTED.to_owned());
    let simulated = serial.starts_with(crate::rig::controllers::SIMULATED);
    Some(DeviceIdentity {
        model: "Grbl".to_owned(),
        serial,
        firmware,
        boot,
        simulated,
        raw: vec![said.to_vec()],
    })
}

fn sample_of(status: Status, raw: Vec<u8>) -> Sample {
    let moving = Some(status.state.is_moving());
    Sample {
        displacement: Some(status.position),
        moving,
        raw: vec![raw],
        ..Sample::default()
    }
}

/// The first word of a line that `pick` takes, with the line.
fn find<T>(line: &[u8], known: bool, pick: impl Fn(&Word) -> Option<T>) -> Answer<(T, Vec<u8>)> {
    let words = grbl::codec::words(line);
    // An `ok`, `error:` or `ALARM:` that comes here answers something older; only a start concerns every question.
    let begun = words.iter().find(|word| matches!(word, Word::Banner(_)));
    if let Some(fault) = begun.and_then(|word| fault(word, known)) {
        return Answer::Fault(fault);
    }
    words
        .iter()
        .find_map(pick)
        .map_or(Answer::Ignore, |found| Answer::Take((found, line.to_vec())))
}

/// What a word that is bad news means.
fn fault(word: &Word, known: bool) -> Option<DeviceFault> {
    let refused = |reason: String| Some(DeviceFault::Refused { reason });
    match word {
        Word::Error(code) => refused(format!("{} (`error:{code}`)", grbl::codec::error(*code))),
        Word::Alarm(code) => refused(format!("{} (`ALARM:{code}`)", grbl::codec::alarm(*code))),
        Word::Banner(banner) if known => Some(DeviceFault::Rebooted {
            was: "running".to_owned(),
            is: banner.clone(),
        }),
        _ => None,
    }
}

/// It is told no limits of a run: its travel is a setting of the machine, written to memory that wears.
impl Device for GrblDevice {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.known = false;
        // It may start anew when its port is opened, and then hears nothing for a while: the question is sent again.
        self.talk.drain()?;
        // What it says of its start is not asked for, and is no fault of the line.
        let of_the_start = |line: &[u8]| {
            grbl::codec::words(line)
                .iter()
                .all(|word| matches!(word, Word::Banner(_) | Word::Message))
        };
        let mut before = Vec::new();
        let accept = |line: &[u8]| {
            if grbl::codec::words(line)
                .iter()
                .any(|word| matches!(word, Word::Banner(_)))
            {
                before = [line, b"\n"].concat();
            }
            match find(line, false, |word| {
                matches!(word, Word::Status(_)).then_some(())
            }) {
                Answer::Ignore if of_the_start(line) => Answer::Part,
                answer => answer,
            }
        };
        self.talk.exchange(grbl::codec::ASK, b"\n", accept)?;
        self.asking.doubt();
        let status = self.fit_status()?.0;
        match status.state {
            State::Idle => {}
            State::Held if self.talk.lets_go() => self.let_go(status)?,
            State::Held => {
                let help = "it is held: look at it, then let go of it with `--let-go` (of `psd resume`, or of `psd rig jog` before a \
                            new run); it stays where it is, and forgets what was interrupted";
                return Err(DeviceFault::Unfit(help.to_owned()));
            }
            state if state.is_moving() => {
                // Nobody watches it: whoever sent it off is gone, or another program has the line.
                self.talk.send(grbl::codec::HOLD)?;
                self.until(|state| !state.is_moving())?;
                return Err(DeviceFault::Unfit(
                    "it was moving before it was told to: held".to_owned(),
                ));
            }
            state => {
                return Err(DeviceFault::Unfit(format!(
                    "it is in the state {state:?}, and not ready to be moved"
                )));
            }
        }
        let mut who = None;
        let keep = |word: &Word, line: &[u8]| {
            if let Word::Version(..) = word {
                who = introduced(&[&before, line].concat());
            }
        };
        self.command(grbl::codec::BUILD, keep, |seen| {
            seen.iter().any(|word| matches!(word, Word::Version(..)))
        })?;
        let mut settings = BTreeMap::new();
        let keep = |word: &Word, _: &[u8]| {
            if let Word::Setting(number, value) = word {
                settings.extend(value.parse::<f64>().map(|value| (*number, value)));
            }
        };
        self.command(grbl::codec::SETTINGS, keep, |seen| {
            seen.iter().any(|word| matches!(word, Word::Setting(..)))
        })?;
        check(&settings)?;
        self.settings = settings;
        (self.known, self.unanswered, self.held) = (true, false, false);
        who.ok_or_else(|| DeviceFault::Unfit("it does not say what version it is".to_owned()))
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<Move, DeviceFault> {
        let target = one_axis(targets)?;
        let jog = grbl::codec::jog(target, speed).map_err(DeviceFault::Unfit)?;
        let top = self
            .settings
            .get(&TOP_SPEED)
            .copied()
            .unwrap_or(f64::INFINITY);
        // Grbl would go slower and say nothing.
        if jog.speed * 6e4 <= top * (1.0 + 1e-12) {
            return Ok(Move {
                frames: vec![jog.line],
                targets: vec![jog.target],
                speed: jog.speed,
                id: None,
            });
        }
        Err(DeviceFault::Refused {
            reason: format!(
                "{:.3} mm/min is faster than its `${TOP_SPEED}={top}`",
                jog.speed * 6e4
            ),
        })
    }

    fn start(&mut self, going: &Move) -> Result<(), DeviceFault> {
        self.make_ready()?;
        for frame in &going.frames {
            self.unanswered = true;
            self.talk.drain()?;
            let answered = self.command(frame, |_, _| (), |_| true);
            self.unanswered = !matches!(
                answered,
                Ok(()) | Err(DeviceFault::Refused { .. } | DeviceFault::Rebooted { .. })
            );
            answered?;
        }
        // An `ok` may answer something older: only the axis itself shows that the move was taken.
        let (status, _) = self.fit_status()?;
        let arrived = (status.position - going.targets[0]).abs() <= self.quantum();
        if status.state == State::Jog || status.state == State::Idle && arrived {
            return Ok(());
        }
        self.unanswered = true;
        Err(DeviceFault::Refused {
            reason: format!(
                "it said `ok` and did not move: it is in the state {:?}",
                status.state
            ),
        })
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let (status, raw) = self.fit_status()?;
        Ok(sample_of(status, raw))
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        // While it jogs this ends the jog and leaves it idle; at rest it leaves it held. A reset would lose the position.
        self.talk.send(grbl::codec::HOLD)?;
        self.held = true;
        let rest = self.until(|state| !state.is_moving())?;
        // It was at rest, and nothing waits in it: it keeps its load without being held, and whoever comes next finds it idle.
        if rest.state == State::Held && !self.unanswered {
            self.resume_at_rest()
        } else {
            Ok(())
        }
    }

    fn emergency(&self) -> Vec<u8> {
        grbl::codec::HOLD.to_vec()
    }

    fn tally(&self) -> Tally {
        self.talk.tally()
    }
}

/// Every setting that is not as it must be, with the line that mends it.
fn check(settings: &BTreeMap<u64, f64>) -> Result<(), DeviceFault> {
    let mut wrong = Vec::new();
    for (number, required, why) in REQUIRED {
        let value = settings.get(&number);
        // Of the report mask only the bit of machine positions matters.
        let right = value.is_some_and(|value| {
            if number == 10 {
                value % 2.0 == 1.0
            } else {
                Ok(*value) == required.parse()
            }
        });
        if !right {
            let is = value.map_or("missing".to_owned(), |value| format!("{value}"));
            wrong.push(format!(
                "${number} is {is}, but {why}: send `${number}={required}`"
            ));
        }
    }
    if wrong.is_empty() {
        Ok(())
    } else {
        Err(DeviceFault::Unfit(wrong.join("; ")))
    }
}

#[cfg(test)]
mod tests;
