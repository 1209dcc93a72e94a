//! A conversation, line by line. In: expected requests, each with its answer. Out: whether exactly those were sent.

use super::{Say, ScriptedPort};

/// Frames as they are to be sent, each with the line that answers it.
pub struct Transcript {
    pub port: ScriptedPort,
    /// From a frame to its answer, s.
    delay: f64,
    /// How a frame is written here.
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
            vec![Say::After(self.delay, bytes)]
        });
        self
    }

    /// All that was expected was sent, and nothing else.
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
