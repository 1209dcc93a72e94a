//! A weighing indicator that sends its weight periodically and on request: `ST,GS,+0001234,kg`. In: `READ`. Out: weights.

use crate::emulator::{Bench, Firmware};

/// N per kg.
const GRAVITY: f64 = 9.806_65;
/// Time between two weights \[s\].
const PERIOD: f64 = 0.1;
/// Largest value on its eight characters \[kg\].
const CAPACITY: f64 = 9999.99;

/// The firmware.
#[derive(Debug, Default)]
pub struct Indicator {
    line: Vec<u8>,
    /// Time of the next weight \[s\].
    next: f64,
}

impl Indicator {
    fn weight(bench: &mut Bench) -> Vec<u8> {
        let kilograms = bench.force() / GRAVITY;
        let within = kilograms.abs() <= CAPACITY;
        let status = match (within, bench.moving()) {
            (false, _) => "OL",
            (true, true) => "US",
            (true, false) => "ST",
        };
        let shown = if within {
            format!("{kilograms:+08.2}")
        } else {
            "^^^^^^^^".to_owned()
        };
        format!("{status},GS,{},kg\r\n", bench.shown(shown)).into_bytes()
    }
}

impl Firmware for Indicator {
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8> {
        let mut said = Vec::new();
        for byte in bytes {
            if matches!(byte, b'\r' | b'\n') {
                if std::mem::take(&mut self.line) == b"READ" {
                    said.extend(Self::weight(bench));
                }
            } else if self.line.len() < 80 {
                self.line.push(*byte);
            }
        }
        said
    }

    fn tick(&mut self, bench: &mut Bench) -> Vec<u8> {
        let now = bench.time();
        if now < self.next {
            return Vec::new();
        }
        self.next = if now < self.next + PERIOD {
            self.next + PERIOD
        } else {
            now + PERIOD
        };
        Self::weight(bench)
    }

    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8> {
        *self = Self {
            line: Vec::new(),
            next: bench.time() + PERIOD,
        };
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::bench;
    use super::*;

    #[test]
    fn a_weight_has_eight_places_and_says_whether_it_stands() {
        let (mut indicator, mut bench) = (Indicator::default(), bench());
        assert_eq!(indicator.tick(&mut bench), b"ST,GS,+0000.00,kg\r\n");
        assert!(indicator.tick(&mut bench).is_empty());
        bench.go(0.000_980_665, 0.000_980_665);
        bench.advance(0.5);
        assert_eq!(
            indicator.receive(b"READ\r\n", &mut bench),
            b"US,GS,+0005.00,kg\r\n",
            "49.03 N on the way"
        );
        bench.advance(1.5);
        assert_eq!(
            indicator.tick(&mut bench),
            b"ST,GS,+0010.00,kg\r\n",
            "98.0665 N"
        );
        bench.strike(0, crate::emulator::BenchFault::Spike(-1e6));
        assert_eq!(
            indicator.receive(b"READ\r\n", &mut bench),
            b"OL,GS,^^^^^^^^,kg\r\n"
        );
        assert!(indicator.receive(b"WRITE\r\n", &mut bench).is_empty());
    }
}
