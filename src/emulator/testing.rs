//! What the tests of this folder share: one plain bench.

use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use super::{Bench, BenchSettings};
use crate::plan::{Behaviour, Interval};

/// 100 kN/m without noise, −1 … 10 mm, 10 mm/s; 0.01 N a count, 1000 counts at no force.
pub fn bench() -> Bench {
    Bench::new(BenchSettings {
        behaviour: Behaviour::Elastic { stiffness: 1e5 },
        damping: 0.0,
        noise: 0.0,
        resolution: 1e-6,
        newtons_per_count: -0.01,
        zero_count: 1000.0,
        seed: 1,
        limits: Interval {
            low: -0.001,
            high: 0.01,
        },
        top_speed: 0.01,
    })
}

/// Text that is written in one place and read in another.
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
