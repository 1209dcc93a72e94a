//! Request and reply on the line of one device: whole lines from bytes in pieces, frames sent again after silence. In:
//! frames, and a function that recognises their answer. Out: the answer, or the reason why there is none, within a bounded
//! time. It knows no protocol.

use std::io::ErrorKind;
use std::time::Duration;

use crate::controllers::DeviceFault;
use crate::safety::failpoint::{Guarding, on};
use crate::transport::{Clock, Port};
use crate::{LineStatistics, StopRequest, safety};

/// Longest line with its ending, and the size of the receive buffer, bytes.
pub const LONGEST_LINE: usize = 512;

/// Longest single wait \[s\]: the delay until a stop request is seen.
pub const SLICE: f64 = 0.05;

/// A wait shorter than this has ended \[s\]: a time-out in whole nanoseconds could otherwise never reach the end.
const SHORTEST: f64 = 1e-6;

/// A port, and the bytes received that have not been used.
pub struct LineClient {
    port: Box<dyn Port>,
    clock: Box<dyn Clock>,
    /// \[s\]
    reply_timeout: f64,
    stop_request: StopRequest,
    /// Bytes received and not used, at most [`LONGEST_LINE`].
    waiting: Vec<u8>,
    /// In the middle of a line that is too long.
    overlong: bool,
    /// Time of the last check of the line \[s\], by the clock. None: it has not been checked yet.
    looked: Option<f64>,
    line_statistics: LineStatistics,
    /// A question without a sequence number was given up: its answer may still arrive.
    pub(super) owes_an_answer: bool,
}

/// Why no line was received.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missed {
    TimedOut,
    /// A line was too long and is discarded with its ending. The next line is usable.
    TooLong,
    Lost(String),
    /// The operator requests a hold now.
    Interrupted,
}

/// The meaning of a received line for the open request.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer<T> {
    Take(T),
    /// A line of the answer, but not its last: the wait continues.
    Part,
    /// Broken, late, duplicated or unsolicited: it is counted, and the wait continues.
    Ignore,
    Fault(DeviceFault),
}

impl LineClient {
    /// A frame is sent again after T, 2T and 4T of silence, and abandoned after 8T; T is `reply_timeout` \[s\].
    #[must_use]
    pub fn new(port: Box<dyn Port>, clock: Box<dyn Clock>, reply_timeout: f64) -> Self {
        let (stop_request, waiting, line_statistics) = (
            StopRequest::default(),
            Vec::with_capacity(LONGEST_LINE),
            LineStatistics::default(),
        );
        Self {
            port,
            clock,
            reply_timeout,
            stop_request,
            waiting,
            overlong: false,
            looked: None,
            line_statistics,
            owes_an_answer: false,
        }
    }

    /// Waits end when this request demands a hold.
    #[must_use]
    pub fn observing(mut self, stop_request: StopRequest) -> Self {
        self.stop_request = stop_request;
        self
    }

    /// \[s\]
    #[must_use]
    pub const fn reply_timeout(&self) -> f64 {
        self.reply_timeout
    }

    #[must_use]
    pub const fn line_statistics(&self) -> LineStatistics {
        self.line_statistics
    }

    pub const fn line_statistics_mut(&mut self) -> &mut LineStatistics {
        &mut self.line_statistics
    }

    pub fn clock(&mut self) -> &mut dyn Clock {
        &mut *self.clock
    }

    /// \[s\], by the clock.
    #[must_use]
    pub fn now(&self) -> f64 {
        self.clock.now()
    }

    /// Whether the operator requests a hold now.
    #[must_use]
    pub fn interrupted(&self) -> bool {
        self.stop_request.hold_requested()
    }

    /// Whether the operator allows an axis that is found on hold to be released.
    #[must_use]
    pub fn release_allowed(&self) -> bool {
        self.stop_request.release_allowed()
    }

    /// Notes a check of the line and reports the time since the last one. A wait for an answer checks the line every [`SLICE`]; a program
    /// that was suspended does not. Gives the present time \[s\], by the clock.
    fn look(&mut self) -> f64 {
        let now = self.clock.now();
        if let Some(before) = self.looked.replace(now) {
            self.stop_request.note_line_gap(now - before);
        }
        safety::beat();
        now
    }

    /// Sends all the bytes.
    ///
    /// # Errors
    /// The line is lost, or the other side accepts no bytes.
    pub fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceFault> {
        self.look();
        self.port
            .write(bytes, Duration::from_secs_f64(self.reply_timeout))
            .map_err(|error| match error.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock => DeviceFault::Lost {
                    reason: format!("it accepted no bytes for {} s", self.reply_timeout),
                },
                _ => lost(&error),
            })
    }

    /// Waits `seconds`, or until the operator requests a hold.
    ///
    /// # Errors
    /// The operator requests a hold.
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

    /// One whole line, without its ending, before the time `deadline` (\[s\], by the clock). A partial line is kept for the
    /// next call.
    ///
    /// # Errors
    /// No line was received.
    pub fn line(&mut self, ending: &[u8], deadline: f64) -> Result<Vec<u8>, Missed> {
        loop {
            if let Some(at) = find(&self.waiting, ending) {
                let line = self.waiting[..at].to_vec();
                self.waiting.drain(..at + ending.len());
                if std::mem::take(&mut self.overlong) {
                    self.line_statistics.ignored += 1;
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

    /// Exactly `count` bytes before the time `deadline`; fewer bytes are kept for the next call.
    ///
    /// # Errors
    /// They were not received, or are more than [`LONGEST_LINE`].
    pub fn exactly(&mut self, count: usize, deadline: f64) -> Result<Vec<u8>, Missed> {
        if count > LONGEST_LINE {
            return Err(Missed::TooLong);
        }
        while self.waiting.len() < count {
            self.more(deadline)?;
        }
        Ok(self.waiting.drain(..count).collect())
    }

    /// Discards the bytes that were received and not used.
    ///
    /// # Errors
    /// The line is lost.
    pub fn drain(&mut self) -> Result<(), DeviceFault> {
        self.waiting.clear();
        self.overlong = false;
        self.port.discard().map_err(|error| lost(&error))
    }

    /// Discards all bytes until none has come for `quiet` \[s\], at most for 8 T.
    ///
    /// # Errors
    /// The line is lost, is never quiet, or the operator requests a hold.
    pub fn until_quiet(&mut self, quiet: f64) -> Result<(), DeviceFault> {
        let give_up = self.clock.now() + 8.0 * self.reply_timeout;
        loop {
            self.drain()?;
            let now = self.clock.now();
            match self.more(now + quiet) {
                Ok(()) if now < give_up => {}
                Ok(()) => return Err(DeviceFault::Unfit("the line is never idle".to_owned())),
                Err(Missed::TimedOut | Missed::TooLong) => return Ok(()),
                Err(Missed::Lost(reason)) => return Err(DeviceFault::Lost { reason }),
                Err(Missed::Interrupted) => return Err(DeviceFault::Interrupted),
            }
        }
    }

    /// Sends a frame and waits for the line that answers it. After silence the same frame is sent again. Only for protocols
    /// in which a frame that is received twice acts once.
    ///
    /// # Errors
    /// Those of `accept`; or no usable answer was received, the line is lost, or the operator requests a hold.
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
                self.line_statistics.resent += 1;
                self.send(frame)?;
            }
        }
        let last = if on(Guarding::Resend) { 8.0 } else { 1.0 } * self.reply_timeout;
        self.answer(ending, began + last, &mut accept)?
            .ok_or(DeviceFault::Silent { seconds: last })
    }

    /// Sends a frame once and waits T for the line that answers it: for protocols in which an answer cannot be
    /// distinguished from the answer to an earlier request, and for commands that must not act twice.
    ///
    /// # Errors
    /// As [`LineClient::exchange`].
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

    /// Waits for a line that `accept` accepts, without sending anything. None if there is none before the time `deadline`.
    ///
    /// # Errors
    /// As [`LineClient::exchange`].
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
                    Answer::Ignore => self.line_statistics.ignored += 1,
                    Answer::Fault(fault) => return Err(fault),
                },
                Err(Missed::TooLong) => {}
                Err(Missed::TimedOut) => return Ok(None),
                Err(Missed::Lost(reason)) => return Err(DeviceFault::Lost { reason }),
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
                Ok(0) => return Err(Missed::Lost("the other side closed it".to_owned())),
                Ok(count) => {
                    self.waiting.extend_from_slice(&buffer[..count]);
                    return Ok(());
                }
                Err(error) => match error.kind() {
                    ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => {}
                    _ => return Err(Missed::Lost(reason(&error))),
                },
            }
        }
    }
}

/// The position at which `ending` begins.
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
        "the other side closed it".to_owned()
    } else {
        error.to_string()
    }
}

#[cfg(test)]
mod tests;
