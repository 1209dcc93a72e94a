//! A conversation, line by line. In: expected requests, each with its answer. Out: whether exactly those were sent.

use super::{Scripted, ScriptedPort};

/// The expected frames, each with the line that answers it.
pub struct Transcript {
    pub port: ScriptedPort,
    /// Time from a frame to its answer \[s\].
    delay: f64,
    /// Formats a frame for the transcript.
    written: fn(&[u8]) -> String,
    expected: Vec<String>,
}

impl Transcript {
    pub const fn new(port: ScriptedPort, delay: f64, written: fn(&[u8]) -> String) -> Self {
        Self {
            port,
            delay,
            written,
            expected: Vec::new(),
        }
    }

    /// This frame is answered by this line; an empty one is silence.
    pub fn on(&mut self, frame: &str, answer: &str) -> &mut Self {
        self.expected.push(frame.to_owned());
        let bytes = format!("{answer}\r\n").into_bytes();
        self.port.reply(&if answer.is_empty() {
            vec![]
        } else {
            vec![Scripted::After(self.delay, bytes)]
        });
        self
    }

    /// Checks that all expected frames were sent, and no others.
    pub fn done(&self) {
        let sent: Vec<String> = self
            .port
            .sent()
            .iter()
            .map(|(_, frame)| (self.written)(frame))
            .collect();
        assert_eq!(sent, self.expected);
    }
}
