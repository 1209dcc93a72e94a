//! A stepper frame with Grbl 1.1, axis X. In: moves in SI. Out: jogs in absolute machine millimetres, and the position of the axis from
//! the step count of the controller. It measures nothing: without a transducer the loop is open.

use std::collections::BTreeMap;

use crate::controllers::grbl;
use crate::controllers::grbl::codec::{MachineState, Status, Word};
use crate::controllers::request_reply::RequestReply;
use crate::controllers::{
    Answer, Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, LineClient, Sample, one_axis,
};
use crate::{JUST_STARTED, LineStatistics};

/// Settings that are required for the safety of the specimen: number, value, reason.
const REQUIRED: [(u64, &str, &str); 6] = [
    (1, "255", "the motor must keep holding"),
    (10, "1", "it must report machine positions"),
    (13, "0", "it must report millimetres"),
    (20, "1", "targets outside its travel must be refused"),
    (21, "1", "limit switches must stop it"),
    (22, "1", "it must know its position"),
];

/// Highest speed of X \[mm/min\].
const TOP_SPEED: u64 = 110;
/// Steps per mm of X.
const STEPS: u64 = 100;

/// The frame at the other end of a line.
pub struct GrblDevice {
    client: LineClient,
    request_reply: RequestReply,
    settings: BTreeMap<u64, f64>,
    /// It has reported its identity: a restart from now on loses the position.
    known: bool,
    /// A jog was sent and not answered: it may wait in the controller.
    unanswered: bool,
    /// Held by this driver.
    held: bool,
}

impl GrblDevice {
    #[must_use]
    pub fn new(client: LineClient) -> Self {
        let request_reply = RequestReply::default();
        Self {
            client,
            request_reply,
            settings: BTreeMap::new(),
            known: false,
            unanswered: false,
            held: false,
        }
    }

    /// Its position, with the bytes of the report. An earlier status agrees with a fresh one if both are equal, or if it
    /// reports motion.
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
        self.request_reply
            .ask(&mut self.client, grbl::codec::ASK, accept, same)
    }

    /// Its status, if it can move or is moving.
    fn fit_status(&mut self) -> Result<(Status, Vec<u8>), DeviceFault> {
        let (status, raw) = self.status()?;
        let reason = match status.state {
            MachineState::Alarm => "it is in alarm and does not know its position: home it (`$H`)",
            MachineState::Door => "its safety door is open",
            MachineState::Check => "it is in check mode and executes no command (`$C`)",
            MachineState::Sleep => "it is asleep and its motor does not hold",
            _ => return Ok((status, raw)),
        };
        Err(DeviceFault::Refused {
            reason: reason.to_owned(),
        })
    }

    /// Sends a line that acts once however often it is received, and collects the lines before its `ok`: settings, versions
    /// and messages are parts of the answer, all other lines are not.
    fn command(
        &mut self,
        line: &[u8],
        mut each: impl FnMut(&Word, &[u8]),
        enough: impl Fn(&[Word]) -> bool,
    ) -> Result<(), DeviceFault> {
        let known = self.known;
        let (mut seen, mut lines) = (Vec::new(), Vec::new());
        self.client.exchange(line, b"\n", |line| {
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

    /// Waits until it is in this state, for several time-outs.
    fn until(&mut self, wanted: impl Fn(MachineState) -> bool) -> Result<Status, DeviceFault> {
        let give_up = self.client.now() + 8.0 * self.client.reply_timeout();
        loop {
            let (status, _) = self.status()?;
            if wanted(status.state) {
                return Ok(status);
            }
            if self.client.now() >= give_up {
                return Err(DeviceFault::Unfit(format!(
                    "it stays in the state {}",
                    status.state
                )));
            }
            self.client.sleep(self.client.reply_timeout() / 4.0)?;
        }
    }

    /// Makes sure that a jog begins immediately: a line sent to an axis on hold waits, and would move it when the hold is
    /// cleared.
    fn make_ready(&mut self) -> Result<(), DeviceFault> {
        let refused = |reason: &str| {
            Err(DeviceFault::Refused {
                reason: reason.to_owned(),
            })
        };
        match self.fit_status()?.0.state {
            MachineState::Idle => Ok(()),
            MachineState::Held if self.unanswered => refused(
                "an unanswered move may be pending in it: inspect it, then start again with `--let-go`",
            ),
            MachineState::Held if self.held => self.resume_at_rest(),
            MachineState::Held => refused("it is on hold, and not by psd"),
            _ => refused("it is still moving"),
        }
    }

    /// Nothing is pending, so nothing moves when the hold is cleared.
    fn resume_at_rest(&mut self) -> Result<(), DeviceFault> {
        self.client.send(grbl::codec::RESUME)?;
        self.until(|state| state == MachineState::Idle)?;
        self.held = false;
        Ok(())
    }

    /// Clears the hold of an axis at this position, as the operator allows: pending commands are discarded and nothing
    /// moves. To resume (`~`) would finish the interrupted move.
    fn let_go(&mut self, held: Status) -> Result<(), DeviceFault> {
        let unfit = |reason: &str| Err(DeviceFault::Unfit(reason.to_owned()));
        // Queried again: a reset in motion would lose the position.
        if self.status()?.0 != held {
            return unfit("on hold, but not at rest: its hold is not cleared");
        }
        self.client.drain()?;
        self.client
            .exchange_once(grbl::codec::RESET, b"\n", |line| {
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
        self.request_reply.expect_late_answer();
        let (now, _) = self.fit_status()?;
        if now
            == (Status {
                state: MachineState::Idle,
                ..held
            })
        {
            return Ok(());
        }
        unfit("it is not idle at the held position after its hold was cleared: home it (`$H`)")
    }

    /// The length of one step \[m\].
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

/// The identity of a controller from the line with its version; the line before it, if there is one, is its start banner.
pub fn introduced(welcome: &[u8]) -> Option<DeviceIdentity> {
    let words: Vec<Word> = welcome
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
    let simulated = serial.starts_with(crate::controllers::SIMULATED);
    Some(DeviceIdentity {
        model: "Grbl".to_owned(),
        serial,
        firmware,
        boot,
        simulated,
        raw: vec![welcome.to_vec()],
    })
}

/// The position in a line with a status report.
pub fn decoded(line: Vec<u8>) -> Option<Sample> {
    let mut words = grbl::codec::words(&line).into_iter();
    let status = words.find_map(|word| match word {
        Word::Status(status) => Some(status),
        _ => None,
    })?;
    Some(sample_of(status, line))
}

fn sample_of(status: Status, raw: Vec<u8>) -> Sample {
    let axis = Channel {
        displacement: Some(status.position),
        ..Channel::default()
    };
    Sample {
        time: None,
        moving: Some(status.state.is_moving()),
        channels: vec![axis],
        raw: vec![raw],
    }
}

/// The first part of a line that `pick` accepts, with the line.
fn find<T>(line: &[u8], known: bool, pick: impl Fn(&Word) -> Option<T>) -> Answer<(T, Vec<u8>)> {
    let words = grbl::codec::words(line);
    // An `ok`, `error:` or `ALARM:` here answers an earlier request; only a restart concerns every question.
    let begun = words.iter().find(|word| matches!(word, Word::Banner(_)));
    if let Some(fault) = begun.and_then(|word| fault(word, known)) {
        return Answer::Fault(fault);
    }
    words
        .iter()
        .find_map(pick)
        .map_or(Answer::Ignore, |found| Answer::Take((found, line.to_vec())))
}

/// The fault that a part of a line reports.
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

/// It receives no limits of a run: its travel is a setting of the machine, in memory with a limited number of writes.
impl Device for GrblDevice {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.known = false;
        // It may restart when its port is opened, and then receives nothing for a while: the question is sent again.
        self.client.drain()?;
        // Its start banner is unsolicited, but is not a fault of the line.
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
        self.client.exchange(grbl::codec::ASK, b"\n", accept)?;
        self.request_reply.expect_late_answer();
        let status = self.fit_status()?.0;
        match status.state {
            MachineState::Idle => {}
            MachineState::Held if self.client.release_allowed() => self.let_go(status)?,
            MachineState::Held => {
                let help = "the rig is HELD: inspect it, then clear its hold with `--let-go` (`psd resume`, or `psd rig jog` \
                            before a new run); it does not move, and discards the interrupted move";
                return Err(DeviceFault::Unfit(help.to_owned()));
            }
            state if state.is_moving() => {
                // No program supervises it: the program that moved it has ended, or another program uses the line.
                self.client.send(grbl::codec::HOLD)?;
                self.until(|state| !state.is_moving())?;
                return Err(DeviceFault::Unfit(
                    "it was already moving before any command: rig put on hold".to_owned(),
                ));
            }
            state => {
                return Err(DeviceFault::Unfit(format!(
                    "it is in the state {state}, and not ready to move"
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
        who.ok_or_else(|| DeviceFault::Unfit("it does not report its version".to_owned()))
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        let target = one_axis(targets)?;
        let jog = grbl::codec::jog(target, speed).map_err(DeviceFault::Unfit)?;
        let top = self
            .settings
            .get(&TOP_SPEED)
            .copied()
            .unwrap_or(f64::INFINITY);
        // Grbl would move more slowly without reporting it.
        if jog.speed * 6e4 <= top * (1.0 + 1e-12) {
            return Ok(DeviceMove {
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

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        self.make_ready()?;
        for frame in &going.frames {
            self.unanswered = true;
            self.client.drain()?;
            let answered = self.command(frame, |_, _| (), |_| true);
            self.unanswered = !matches!(
                answered,
                Ok(()) | Err(DeviceFault::Refused { .. } | DeviceFault::Rebooted { .. })
            );
            answered?;
        }
        // An `ok` may answer an earlier request: only the axis itself shows that the move was accepted.
        let (status, _) = self.fit_status()?;
        let arrived = (status.position - going.targets[0]).abs() <= self.quantum();
        if status.state == MachineState::Jog || status.state == MachineState::Idle && arrived {
            return Ok(());
        }
        self.unanswered = true;
        Err(DeviceFault::Refused {
            reason: format!(
                "it answered `ok` and did not move: it is in the state {}",
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
        self.client.send(grbl::codec::HOLD)?;
        self.held = true;
        let rest = self.until(|state| !state.is_moving())?;
        // It was at rest and nothing is pending: it keeps its load without a hold, and the next program finds it idle.
        if rest.state == MachineState::Held && !self.unanswered {
            self.resume_at_rest()
        } else {
            Ok(())
        }
    }

    fn emergency(&self) -> Vec<u8> {
        grbl::codec::HOLD.to_vec()
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

/// Every setting that is not as required, with the line that corrects it.
fn check(settings: &BTreeMap<u64, f64>) -> Result<(), DeviceFault> {
    let mut wrong = Vec::new();
    for (number, required, why) in REQUIRED {
        let value = settings.get(&number);
        // In the report mask only the bit of machine positions matters.
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
