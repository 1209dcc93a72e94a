//! Test support for real rigs: a clock that advances only during a wait, and a scripted port. In: a script. Out: bytes at their times. No
//! test of a rig sleeps.

mod device;
mod forwarded;
mod transcript;

use std::collections::VecDeque;
use std::io;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use psd_rig::transport::{Clock, Emergency, Port};

pub use device::FakeDevice;
pub use transcript::Transcript;

/// Time that all clones share \[s\].
#[derive(Clone, Debug, Default)]
pub struct VirtualClock(Arc<Mutex<f64>>);

impl VirtualClock {
    /// Advances the time \[s\].
    pub fn advance(&self, seconds: f64) {
        *self.0.lock().unwrap() += seconds;
    }
}

impl Clock for VirtualClock {
    fn now(&self) -> f64 {
        *self.0.lock().unwrap()
    }
    fn sleep(&mut self, seconds: f64) {
        self.advance(seconds);
    }
    fn wall(&self) -> Option<String> {
        None
    }
}

/// The next action of a scripted port.
#[derive(Clone, Debug)]
pub enum Scripted {
    /// These bytes arrive in one piece, this many seconds after the previous piece (or after the start of the wait).
    After(f64, Vec<u8>),
    /// The other side disconnects.
    HangUp,
}

/// A port that sends scripted bytes and records the bytes that it receives. All clones share one state.
#[derive(Clone, Debug)]
pub struct ScriptedPort {
    clock: VirtualClock,
    shared: Arc<Mutex<ScriptState>>,
}

#[derive(Debug, Default)]
struct ScriptState {
    /// Bytes and their arrival times \[s\]; None: disconnected.
    coming: VecDeque<(f64, Option<Vec<u8>>)>,
    /// Replies to the frames, in their order.
    replies: VecDeque<Vec<Scripted>>,
    sent: Vec<(f64, Vec<u8>)>,
}

impl ScriptedPort {
    #[must_use]
    pub fn new(clock: &VirtualClock) -> Self {
        Self {
            clock: clock.clone(),
            shared: Arc::default(),
        }
    }

    /// Unsolicited bytes from now on.
    pub fn send_unasked(&self, script: &[Scripted]) {
        let mut shared = self.shared.lock().unwrap();
        let mut at = shared
            .coming
            .back()
            .map_or(0.0, |(at, _)| *at)
            .max(self.clock.now());
        for action in script {
            match action {
                Scripted::After(seconds, bytes) => {
                    at += seconds;
                    shared.coming.push_back((at, Some(bytes.clone())));
                }
                Scripted::HangUp => shared.coming.push_back((at, None)),
            }
        }
    }

    /// The reply to the next frame that has no reply yet.
    pub fn reply(&self, script: &[Scripted]) {
        self.shared
            .lock()
            .unwrap()
            .replies
            .push_back(script.to_vec());
    }

    /// The frames that were sent, with their times \[s\].
    #[must_use]
    pub fn sent(&self) -> Vec<(f64, Vec<u8>)> {
        self.shared.lock().unwrap().sent.clone()
    }
}

impl Port for ScriptedPort {
    fn write(&mut self, bytes: &[u8], _: Duration) -> io::Result<()> {
        let replies = {
            let mut shared = self.shared.lock().unwrap();
            shared.sent.push((self.clock.now(), bytes.to_vec()));
            shared.replies.pop_front()
        };
        self.send_unasked(&replies.unwrap_or_default());
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let until = self.clock.now() + timeout.as_secs_f64();
        let mut shared = self.shared.lock().unwrap();
        let next = shared
            .coming
            .front()
            .map(|(at, _)| *at)
            .filter(|at| *at <= until);
        let Some(at) = next else {
            let left = until - self.clock.now();
            self.clock.advance(left);
            return Err(io::ErrorKind::TimedOut.into());
        };
        self.clock.advance((at - self.clock.now()).max(0.0));
        match &mut shared.coming[0].1 {
            None => Err(io::ErrorKind::BrokenPipe.into()),
            Some(bytes) => {
                let count = bytes.len().min(buffer.len());
                buffer[..count].copy_from_slice(&bytes[..count]);
                bytes.drain(..count);
                if bytes.is_empty() {
                    shared.coming.pop_front();
                }
                Ok(count)
            }
        }
    }

    fn discard(&mut self) -> io::Result<()> {
        let now = self.clock.now();
        self.shared
            .lock()
            .unwrap()
            .coming
            .retain(|(at, bytes)| *at > now || bytes.is_none());
        Ok(())
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Ok(Box::new(self.clone()))
    }
}

impl Emergency for ScriptedPort {
    fn send(&mut self, bytes: &[u8]) {
        self.shared
            .lock()
            .unwrap()
            .sent
            .push((self.clock.now(), bytes.to_vec()));
    }
}
