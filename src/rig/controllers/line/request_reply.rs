//! Fresh answers of devices without sequence numbers, for which a late answer cannot be distinguished from a new one. In: a question and
//! a function that recognises its answer. Out: an answer to this question. After a silence no answer is accepted until the line was quiet
//! and two answers agreed.

use crate::controllers::{Answer, DeviceFault, LineClient};

/// Number of times a question is sent before it is abandoned.
const ATTEMPTS: u32 = 3;

/// Whether a late answer is still possible.
#[derive(Debug, Default)]
pub struct RequestReply {
    late_answer_possible: bool,
}

impl RequestReply {
    /// An earlier request may still be answered.
    pub const fn expect_late_answer(&mut self) {
        self.late_answer_possible = true;
    }

    /// Sends `frame` and gives its answer. Bytes received earlier are discarded. After a silence the line must first be
    /// quiet for a time-out, and `agree` must accept two answers as answers to the same question; the second counts.
    ///
    /// # Errors
    /// As `accept`; silence, or no two answers that agree.
    pub fn ask<T>(
        &mut self,
        client: &mut LineClient,
        frame: &[u8],
        mut accept: impl FnMut(&[u8]) -> Answer<T>,
        agree: impl Fn(&T, &T) -> bool,
    ) -> Result<T, DeviceFault> {
        let began = client.now();
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                client.line_statistics_mut().resent += 1;
            }
            if self.late_answer_possible {
                client.until_quiet(client.reply_timeout())?;
            }
            client.drain()?;
            let Some(first) = self.once(client, frame, &mut accept)? else {
                continue;
            };
            if !self.late_answer_possible {
                return Ok(first);
            }
            let Some(second) = self.once(client, frame, &mut accept)? else {
                continue;
            };
            if agree(&first, &second) {
                self.late_answer_possible = false;
                return Ok(second);
            }
            client.line_statistics_mut().ignored += 1;
        }
        Err(DeviceFault::Silent {
            seconds: client.now() - began,
        })
    }

    /// None if no answer was received.
    fn once<T>(
        &mut self,
        client: &mut LineClient,
        frame: &[u8],
        accept: &mut impl FnMut(&[u8]) -> Answer<T>,
    ) -> Result<Option<T>, DeviceFault> {
        match client.exchange_once(frame, b"\n", accept) {
            Ok(answer) => Ok(Some(answer)),
            Err(DeviceFault::Silent { .. }) => {
                self.late_answer_possible = true;
                Ok(None)
            }
            Err(fault) => {
                // The answer to an interrupted question may still arrive.
                self.late_answer_possible |= fault == DeviceFault::Interrupted;
                Err(fault)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};

    fn client() -> (LineClient, ScriptedPort) {
        let clock = VirtualClock::default();
        let port = ScriptedPort::new(&clock);
        (
            LineClient::new(Box::new(port.clone()), Box::new(clock), 0.5),
            port,
        )
    }

    fn ask(
        request_reply: &mut RequestReply,
        client: &mut LineClient,
    ) -> Result<Vec<u8>, DeviceFault> {
        request_reply.ask(client, b"?", |line| Answer::Take(line.to_vec()), Vec::eq)
    }

    fn script_reply(port: &ScriptedPort, seconds: f64, line: &[u8]) {
        port.reply(&[Scripted::After(seconds, line.to_vec())]);
    }

    #[test]
    fn what_came_before_the_question_is_no_answer_to_it() {
        let (mut client, port) = client();
        port.send_unasked(&[Scripted::After(0.0, b"old\n".to_vec())]);
        script_reply(&port, 0.1, b"new\n");
        assert_eq!(
            ask(&mut RequestReply::default(), &mut client).unwrap(),
            b"new"
        );
    }

    #[test]
    fn an_answer_that_is_late_by_less_than_a_timeout_is_thrown_away() {
        let (mut client, port) = client();
        let mut request_reply = RequestReply::default();
        script_reply(&port, 0.7, b"old\n");
        script_reply(&port, 0.1, b"new\n");
        script_reply(&port, 0.1, b"new\n");
        assert_eq!(ask(&mut request_reply, &mut client).unwrap(), b"new");
        assert_eq!((port.sent().len(), client.line_statistics().resent), (3, 1));
        script_reply(&port, 0.1, b"one\n");
        assert_eq!(
            ask(&mut request_reply, &mut client).unwrap(),
            b"one",
            "believed again"
        );
    }

    #[test]
    fn an_answer_that_is_later_still_does_not_agree_with_the_next() {
        let (mut client, port) = client();
        script_reply(&port, 1.05, b"old\n");
        script_reply(&port, 0.1, b"new\n");
        for _ in 0..3 {
            script_reply(&port, 0.1, b"new\n");
        }
        assert_eq!(
            ask(&mut RequestReply::default(), &mut client).unwrap(),
            b"new"
        );
        assert!(client.line_statistics().ignored >= 1);
    }

    #[test]
    fn silence_ends_within_a_bounded_time() {
        let (mut client, port) = client();
        assert!(matches!(
            ask(&mut RequestReply::default(), &mut client),
            Err(DeviceFault::Silent { .. })
        ));
        assert!(client.now() <= 8.0 * 0.5, "{}", client.now());
        assert_eq!(port.sent().len(), 3);
    }
}
