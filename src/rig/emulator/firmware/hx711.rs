//! The sketch for an HX711 load cell: one raw count per line, at its own rate. In: ignored. Out: counts.

use crate::emulator::{EmulatedRig, Firmware};

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
    fn receive(&mut self, _: &[u8], _: &mut EmulatedRig) -> Vec<u8> {
        Vec::new()
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        let now = rig.time();
        if now < self.next {
            return Vec::new();
        }
        // After a pause the next count comes one period later. Missed conversions are not sent.
        self.next = if now < self.next + self.period {
            self.next + self.period
        } else {
            now + self.period
        };
        let count = rig.counts().to_string();
        format!("{}\r\n", rig.shown(count)).into_bytes()
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.next = rig.time() + self.period;
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::emulator::elastic_rig;

    #[test]
    fn counts_come_at_the_rate_of_the_converter() {
        let (mut cell, mut rig) = (Hx711::new(80.0), elastic_rig());
        rig.go(0.002, 0.01);
        let mut lines = Vec::new();
        for slice in 0..1000 {
            rig.advance(f64::from(slice) * 0.001);
            let reply = cell.tick(&mut rig);
            lines.extend(
                String::from_utf8(reply)
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
        rig.advance(100.0);
        assert!(
            !cell.tick(&mut rig).is_empty() && cell.tick(&mut rig).is_empty(),
            "no burst after a pause"
        );
    }
}
