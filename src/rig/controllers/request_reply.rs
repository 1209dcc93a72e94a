//! Fresh answers of devices that number nothing, so that a late answer looks like a new one. In: a question and what
//! answers it. Out: an answer to this question. After a silence nothing is believed until the line was quiet and two
//! answers agreed.

use super::{Answer, DeviceFault, Talk};

/// How often a question is put before it is given up.
const ATTEMPTS: u32 = 3;

/// Whether a late answer may still come.
#[derive(Debug, Default)]
pub struct Asking {
    doubtful: bool,
}

impl Asking {
    /// What was asked before may be answered now.
    pub const fn doubt(&mut self) {
        self.doubtful = true;
    }

    /// Asks with `frame`, and gives an answer to it: what came before is thrown away. After a silence the line must first be
    /// quiet for a time-out, and of two answers `agree` must say that neither is an old one; the second counts.
    ///
    /// # Errors
    /// As `accept`; silence, or no two answers that agree.
    pub fn ask<T>(
        &mut self,
        talk: &mut Talk,
        frame: &[u8],
        mut accept: impl FnMut(&[u8]) -> Answer<T>,
        agree: impl Fn(&T, &T) -> bool,
    ) -> Result<T, DeviceFault> {
        let began = talk.now();
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                talk.tally_mut().resent += 1;
            }
            if self.doubtful {
                talk.until_quiet(talk.reply_timeout())?;
            }
            talk.drain()?;
            let Some(first) = self.once(talk, frame, &mut accept)? else {
                continue;
            };
            if !self.doubtful {
                return Ok(first);
            }
            let Some(second) = self.once(talk, frame, &mut accept)? else {
                continue;
            };
            if agree(&first, &second) {
                self.doubtful = false;
                return Ok(second);
            }
            talk.tally_mut().ignored += 1;
        }
        Err(DeviceFault::Silent {
            seconds: talk.now() - began,
        })
    }

    /// None: silence.
    fn once<T>(
        &mut self,
        talk: &mut Talk,
        frame: &[u8],
        accept: &mut impl FnMut(&[u8]) -> Answer<T>,
    ) -> Result<Option<T>, DeviceFault> {
        match talk.exchange_once(frame, b"\n", accept) {
            Ok(answer) => Ok(Some(answer)),
            Err(DeviceFault::Silent { .. }) => {
                self.doubtful = true;
                Ok(None)
            }
            Err(fault) => {
                // An interrupted question may be answered yet.
                self.doubtful |= fault == DeviceFault::Interrupted;
                Err(fault)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::testing::{Say, ScriptedPort, VirtualClock};

    fn talk() -> (Talk, ScriptedPort) {
        let clock = VirtualClock::default();
        let port = ScriptedPort::new(&clock);
        (
            Talk::new(Box::new(port.clone()), Box::new(clock), 0.5),
            port,
        )
    }

    fn ask(asking: &mut Asking, talk: &mut Talk) -> Result<Vec<u8>, DeviceFault> {
        asking.ask(talk, b"?", |line| Answer::Take(line.to_vec()), Vec::eq)
    }

    fn say(port: &ScriptedPort, seconds: f64, line: &[u8]) {
        port.reply(&[Say::After(seconds, line.to_vec())]);
    }

    #[test]
    fn what_came_before_the_question_is_no_answer_to_it() {
        let (mut talk, port) = talk();
        port.say(&[Say::After(0.0, b"old\n".to_vec())]);
        say(&port, 0.1, b"new\n");
        assert_eq!(ask(&mut Asking::default(), &mut talk).unwrap(), b"new");
    }

    #[test]
    fn an_answer_that_is_late_by_less_than_a_timeout_is_thrown_away() {
        let (mut talk, port) = talk();
        let mut asking = Asking::default();
        say(&port, 0.7, b"old\n");
        say(&port, 0.1, b"new\n");
        say(&port, 0.1, b"new\n");
        assert_eq!(ask(&mut asking, &mut talk).unwrap(), b"new");
        assert_eq!((port.sent().len(), talk.tally().resent), (3, 1));
        say(&port, 0.1, b"one\n");
        assert_eq!(
            ask(&mut asking, &mut talk).unwrap(),
            b"one",
            "believed again"
        );
    }

    #[test]
    fn an_answer_that_is_later_still_does_not_agree_with_the_next() {
        let (mut talk, port) = talk();
        say(&port, 1.05, b"old\n");
        say(&port, 0.1, b"new\n");
        for _ in 0..3 {
            say(&port, 0.1, b"new\n");
        }
        assert_eq!(ask(&mut Asking::default(), &mut talk).unwrap(), b"new");
        assert!(talk.tally().ignored >= 1);
    }

    #[test]
    fn silence_ends_within_a_bounded_time() {
        let (mut talk, port) = talk();
        assert!(matches!(
            ask(&mut Asking::default(), &mut talk),
            Err(DeviceFault::Silent { .. })
        ));
        assert!(talk.now() <= 8.0 * 0.5, "{}", talk.now());
        assert_eq!(port.sent().len(), 3);
    }
}
