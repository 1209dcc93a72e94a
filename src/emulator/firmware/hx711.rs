//! The sketch for an HX711 load cell: one raw count per line, at its own rate. In: ignored. Out: counts.

use crate::emulator::{Bench, Firmware};

/// The firmware.
#[derive(Debug)]
pub struct Hx711 {
    /// Time between two counts \[s\].
    period: f64,
    /// Time of the next count \[s\].
    next: f64,
}

impl Hx711 {
    /// `rate` counts a second; the converter knows 10 and 80.
    #[must_use]
    pub const fn new(rate: f64) -> Self {
        Self {
            period: 1.0 / rate,
            next: 0.0,
        }
    }
}

impl Firmware for Hx711 {
    fn receive(&mut self, _: &[u8], _: &mut Bench) -> Vec<u8> {
        Vec::new()
    }

    fn tick(&mut self, bench: &mut Bench) -> Vec<u8> {
        let now = bench.time();
        if now < self.next {
            return Vec::new();
        }
        // After a pause the next count comes one period later. Missed conversions are not sent.
        self.next = if now < self.next + self.period {
            self.next + self.period
        } else {
            now + self.period
        };
        let count = bench.counts().to_string();
        format!("{}\r\n", bench.shown(count)).into_bytes()
    }

    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8> {
        self.next = bench.time() + self.period;
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::bench;
    use super::*;

    #[test]
    fn counts_come_at_the_rate_of_the_converter() {
        let (mut cell, mut bench) = (Hx711::new(80.0), bench());
        bench.go(0.002, 0.01);
        let mut lines = Vec::new();
        for slice in 0..1000 {
            bench.advance(f64::from(slice) * 0.001);
            let said = cell.tick(&mut bench);
            lines.extend(
                String::from_utf8(said)
                    .expect("text")
                    .lines()
                    .map(str::to_owned),
            );
        }
        assert_eq!(lines.len(), 80);
        assert_eq!(
            (lines[0].as_str(), lines[79].as_str()),
            ("1000", "-19000"),
            "0 N and 200 N at −0.01 N a count"
        );
        bench.advance(100.0);
        assert!(
            !cell.tick(&mut bench).is_empty() && cell.tick(&mut bench).is_empty(),
            "no burst after a pause"
        );
    }
}
