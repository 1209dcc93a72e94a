//! Rig emulators for tests: a plain emulated rig, and the lines and the clock of an emulator in the same thread.

mod attached;
mod in_process;

use std::io::{self, Write};
use std::sync::{Arc, Mutex};

pub use attached::{emulator, open, open_through};
pub use in_process::{InProcess, SimulatedPort};

use psd_plan::{Behaviour, Interval};
use psd_rig::emulator::{EmulatedRig, EmulatedRigSettings};

/// 100 kN/m without noise, −1 … 10 mm, 10 mm/s; 0.01 N per count, zero offset 1000 counts.
pub fn elastic_rig() -> EmulatedRig {
    EmulatedRig::new(EmulatedRigSettings {
        behaviour: Behaviour::Elastic { stiffness: 1e5 },
        damping: 0.0,
        noise: 0.0,
        resolution: 1e-6,
        newtons_per_count: -0.01,
        zero_offset: 1000.0,
        seed: 1,
        limits: Interval {
            low: -0.001,
            high: 0.01,
        },
        top_speed: 0.01,
    })
}

/// A text shared between a writer and a reader.
#[derive(Clone, Default)]
pub struct SharedText(Arc<Mutex<Vec<u8>>>);

impl SharedText {
    pub fn text(&self) -> String {
        String::from_utf8(self.0.lock().expect("no writer panicked").clone()).expect("text")
    }
}

impl Write for SharedText {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("no writer panicked").write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
