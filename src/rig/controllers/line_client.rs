//! Talking with one device: whole lines out of bytes in pieces, frames sent again into silence. In: frames, and who says
//! which line answers them. Out: the answer, or why there is none, within a bounded time. It knows no dialect.

use std::io::ErrorKind;
use std::time::Duration;

use super::DeviceFault;
use crate::rig::safety::failpoint::{Guarding, on};
use crate::rig::transport::{Clock, Emergency, Port};
use crate::rig::{Tally, Wish, safety};

/// Longest line with its ending, and all that is kept of what comes, bytes.
pub const LONGEST_LINE: usize = 512;

/// Longest wait in one piece, s: how soon a wish to hold is seen.
pub const SLICE: f64 = 0.05;

/// A wait that is over, s: a time-out in whole nanoseconds could not get nearer for ever.
const SHORTEST: f64 = 1e-6;

/// A port, and what has come over it that nobody has used.
pub struct Talk {
    port: Box<dyn Port>,
    clock: Box<dyn Clock>,
    /// s
    reply_timeout: f64,
    wish: Wish,
    /// What came and was not used, at most [`LONGEST_LINE`].
    waiting: Vec<u8>,
    /// In the middle of a line that is too long.
    overlong: bool,
    /// When somebody last looked after the line, s by the clock; None: nobody did yet.
    looked: Option<f64>,
    tally: Tally,
}

/// Why there is no line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missed {
    TimedOut,
    /// A line was too long and is thrown away with its ending; what follows it is good.
    TooLong,
    Gone(String),
    /// A person wants the rig held now.
    Interrupted,
}

/// What a line is to the request that is open.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer<T> {
    Take(T),
    /// A line of the answer that is not its last: the wait goes on.
    Part,
    /// Broken, late, doubled or not asked for: it is counted, and the wait goes on.
    Ignore,
    Fault(DeviceFault),
}

impl Talk {
    /// A frame is sent again after T, 2T and 4T of silence, and given up after 8T; T is `reply_timeout`, s.
    #[must_use]
    pub fn new(port: Box<dyn Port>, clock: Box<dyn Clock>, reply_timeout: f64) -> Self {
        let (wish, waiting, tally) = (
            Wish::default(),
            Vec::with_capacity(LONGEST_LINE),
            Tally::default(),
        );
        Self {
            port,
            clock,
            reply_timeout,
            wish,
            waiting,
            overlong: false,
            looked: None,
            tally,
        }
    }

    /// Waits end when this wish is to hold.
    #[must_use]
    pub fn heeding(mut self, wish: Wish) -> Self {
        self.wish = wish;
        self
    }

    /// s
    #[must_use]
    pub const fn reply_timeout(&self) -> f64 {
        self.reply_timeout
    }

    #[must_use]
    pub const fn tally(&self) -> Tally {
        self.tally
    }

    pub const fn tally_mut(&mut self) -> &mut Tally {
        &mut self.tally
    }

    pub fn clock(&mut self) -> &mut dyn Clock {
        &mut *self.clock
    }

    /// s, by the clock.
    #[must_use]
    pub fn now(&self) -> f64 {
        self.clock.now()
    }

    /// Whether a person wants the rig held now.
    #[must_use]
    pub fn interrupted(&self) -> bool {
        self.wish.wants_hold()
    }

    /// Whether a person wants an axis that is found held let go of.
    #[must_use]
    pub fn lets_go(&self) -> bool {
        self.wish.lets_go()
    }

    /// A second hold on the line that can only send.
    ///
    /// # Errors
    /// The line is gone.
    pub fn emergency(&self) -> Result<Box<dyn Emergency>, DeviceFault> {
        self.port.emergency().map_err(|error| lost(&error))
    }

    /// Somebody looks after the line. The time since the last look is told: one that waits for an answer looks every [`SLICE`], and a
    /// program that was stopped meanwhile does not. Gives the moment, s by the clock.
    fn look(&mut self) -> f64 {
        let now = self.clock.now();
        if let Some(before) = self.looked.replace(now) {
            self.wish.was_away(now - before);
        }
        safety::beat();
        now
    }

    /// Sends all the bytes.
    ///
    /// # Errors
    /// The line is gone, or the other side takes nothing.
    pub fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceFault> {
        self.look();
        self.port
            .write(bytes, Duration::from_secs_f64(self.reply_timeout))
            .map_err(|error| match error.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock => DeviceFault::Lost {
                    reason: format!("it took nothing for {} s", self.reply_timeout),
                },
                _ => lost(&error),
            })
    }

    /// Waits `seconds`, or until a person wants the rig held.
    ///
    /// # Errors
    /// A person does.
    pub fn sleep(&mut self, seconds: f64) -> Result<(), DeviceFault> {
        let until = self.clock.now() + seconds;
        loop {
            if self.interrupted() {
                return Err(DeviceFault::Interrupted);
            }
            let left = until - self.look();
            if left.is_nan() || left < SHORTEST {
                return Ok(());
            }
            self.clock.sleep(left.min(SLICE));
        }
    }

    /// One whole line, without its ending, by the moment `deadline` (s, by the clock). Never a part of a line: what came
    /// of it stays for the next call.
    ///
    /// # Errors
    /// There is none.
    pub fn line(&mut self, ending: &[u8], deadline: f64) -> Result<Vec<u8>, Missed> {
        loop {
            if let Some(at) = find(&self.waiting, ending) {
                let line = self.waiting[..at].to_vec();
                self.waiting.drain(..at + ending.len());
                if std::mem::take(&mut self.overlong) {
                    self.tally.ignored += 1;
                    return Err(Missed::TooLong);
                }
                return Ok(line);
            }
            if self.waiting.len() >= LONGEST_LINE {
                self.overlong = true;
            }
            if self.overlong {
                // An ending may have begun.
                let keep = ending.len().saturating_sub(1).min(self.waiting.len());
                self.waiting.drain(..self.waiting.len() - keep);
            }
            self.more(deadline)?;
        }
    }

    /// Exactly `count` bytes by the moment `deadline`; fewer stay for the next call.
    ///
    /// # Errors
    /// They did not come, or are more than [`LONGEST_LINE`].
    pub fn exactly(&mut self, count: usize, deadline: f64) -> Result<Vec<u8>, Missed> {
        if count > LONGEST_LINE {
            return Err(Missed::TooLong);
        }
        while self.waiting.len() < count {
            self.more(deadline)?;
        }
        Ok(self.waiting.drain(..count).collect())
    }

    /// Throws away what has come and was not used.
    ///
    /// # Errors
    /// The line is gone.
    pub fn drain(&mut self) -> Result<(), DeviceFault> {
        self.waiting.clear();
        self.overlong = false;
        self.port.discard().map_err(|error| lost(&error))
    }

    /// Throws away all that comes until nothing has come for `quiet` s; within 8 T in any case.
    ///
    /// # Errors
    /// The line is gone, is never quiet, or a person wants the rig held.
    pub fn until_quiet(&mut self, quiet: f64) -> Result<(), DeviceFault> {
        let give_up = self.clock.now() + 8.0 * self.reply_timeout;
        loop {
            self.drain()?;
            let now = self.clock.now();
            match self.more(now + quiet) {
                Ok(()) if now < give_up => {}
                Ok(()) => return Err(DeviceFault::Unfit("the line is never quiet".to_owned())),
                Err(Missed::TimedOut | Missed::TooLong) => return Ok(()),
                Err(Missed::Gone(reason)) => return Err(DeviceFault::Lost { reason }),
                Err(Missed::Interrupted) => return Err(DeviceFault::Interrupted),
            }
        }
    }

    /// Sends a frame and waits for the line that answers it; into silence the same frame is sent again. Only for
    /// dialects in which a frame that is heard twice acts once.
    ///
    /// # Errors
    /// As `accept` says; or nothing usable came, or the line is gone, or a person wants the rig held.
    pub fn exchange<T>(
        &mut self,
        frame: &[u8],
        ending: &[u8],
        mut accept: impl FnMut(&[u8]) -> Answer<T>,
    ) -> Result<T, DeviceFault> {
        let began = self.clock.now();
        self.send(frame)?;
        if on(Guarding::Resend) {
            for silence in [1.0, 2.0, 4.0] {
                if let Some(answer) =
                    self.answer(ending, began + silence * self.reply_timeout, &mut accept)?
                {
                    return Ok(answer);
                }
                self.tally.resent += 1;
                self.send(frame)?;
            }
        }
        let last = if on(Guarding::Resend) { 8.0 } else { 1.0 } * self.reply_timeout;
        self.answer(ending, began + last, &mut accept)?
            .ok_or(DeviceFault::Silent { seconds: last })
    }

    /// Sends a frame once and waits T for the line that answers it: for dialects in which an answer cannot be told from
    /// that to an earlier request, and for what must not act twice.
    ///
    /// # Errors
    /// As [`Talk::exchange`].
    pub fn exchange_once<T>(
        &mut self,
        frame: &[u8],
        ending: &[u8],
        mut accept: impl FnMut(&[u8]) -> Answer<T>,
    ) -> Result<T, DeviceFault> {
        let deadline = self.clock.now() + self.reply_timeout;
        self.send(frame)?;
        self.answer(ending, deadline, &mut accept)?
            .ok_or(DeviceFault::Silent {
                seconds: self.reply_timeout,
            })
    }

    /// Waits for a line that `accept` takes, without sending anything; None where none has come by the moment
    /// `deadline`.
    ///
    /// # Errors
    /// As [`Talk::exchange`].
    pub fn answer<T>(
        &mut self,
        ending: &[u8],
        deadline: f64,
        accept: &mut impl FnMut(&[u8]) -> Answer<T>,
    ) -> Result<Option<T>, DeviceFault> {
        loop {
            match self.line(ending, deadline) {
                Ok(line) => match accept(&line) {
                    Answer::Take(answer) => return Ok(Some(answer)),
                    Answer::Part => {}
                    Answer::Ignore => self.tally.ignored += 1,
                    Answer::Fault(fault) => return Err(fault),
                },
                Err(Missed::TooLong) => {}
                Err(Missed::TimedOut) => return Ok(None),
                Err(Missed::Gone(reason)) => return Err(DeviceFault::Lost { reason }),
                Err(Missed::Interrupted) => return Err(DeviceFault::Interrupted),
            }
        }
    }

    /// Waits for at least one more byte.
    fn more(&mut self, deadline: f64) -> Result<(), Missed> {
        let mut buffer = [0; LONGEST_LINE];
        loop {
            if self.interrupted() {
                return Err(Missed::Interrupted);
            }
            let left = deadline - self.look();
            if left.is_nan() || left < SHORTEST {
                return Err(Missed::TimedOut);
            }
            let room = LONGEST_LINE - self.waiting.len();
            match self.port.read(
                &mut buffer[..room],
                Duration::from_secs_f64(left.min(SLICE)),
            ) {
                Ok(0) => return Err(Missed::Gone("the other side hung up".to_owned())),
                Ok(count) => {
                    self.waiting.extend_from_slice(&buffer[..count]);
                    return Ok(());
                }
                Err(error) => match error.kind() {
                    ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => {}
                    _ => return Err(Missed::Gone(reason(&error))),
                },
            }
        }
    }
}

/// Where `ending` begins.
fn find(bytes: &[u8], ending: &[u8]) -> Option<usize> {
    match ending {
        [only] => bytes.iter().position(|byte| byte == only),
        _ => bytes
            .windows(ending.len().max(1))
            .position(|window| window == ending),
    }
}

fn lost(error: &std::io::Error) -> DeviceFault {
    DeviceFault::Lost {
        reason: reason(error),
    }
}

fn reason(error: &std::io::Error) -> String {
    if error.kind() == ErrorKind::BrokenPipe {
        "the other side hung up".to_owned()
    } else {
        error.to_string()
    }
}

#[cfg(test)]
mod tests;
