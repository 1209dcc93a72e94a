//! A Mark-10 force gauge: `?` the reading, `?C` the live one, `?PT` and `?PC` the peaks, `Z` zero. In: commands that end with
//! CR. Out: a number, a space and its unit, CR LF; `*10` for an unknown command.
//!
//! Choices where the published commands are not specific: `?` and `?C` are the same; a reading has two digits after the point
//! and the unit N; a peak is the absolute value since zero; `Z` has no answer.

use crate::emulator::firmware::line_buffer::LineBuffer;
use crate::emulator::{EmulatedRig, Firmware};

/// A gauge with its own port.
#[derive(Debug)]
pub struct Mark10Gauge {
    /// The polarity of a compression, +1 or −1.
    polarity: f64,
    lines: LineBuffer,
    /// Zero offset of the emulated rig's force \[N\].
    zero: f64,
    /// Largest reading in each direction since zero \[N\].
    peaks: [f64; 2],
}

impl Mark10Gauge {
    /// A gauge that shows the emulated rig's force with this polarity.
    #[must_use]
    pub fn new(polarity: f64) -> Self {
        Self {
            polarity,
            lines: LineBuffer::default(),
            zero: 0.0,
            peaks: [0.0; 2],
        }
    }

    /// Its present reading \[N\].
    pub(super) fn reading(&mut self, rig: &mut EmulatedRig) -> f64 {
        let reading = self.polarity * (rig.force() - self.zero);
        let [compression, tension] = &mut self.peaks;
        *compression = compression.max(reading);
        *tension = tension.max(-reading);
        reading
    }

    /// Answers one command without its CR.
    pub(super) fn command(&mut self, command: &str, rig: &mut EmulatedRig) -> String {
        let reading = self.reading(rig);
        match command {
            "?" | "?C" => format!("{}\r\n", rig.shown(newtons(reading))),
            "?PC" => format!("{}\r\n", newtons(self.peaks[0])),
            "?PT" => format!("{}\r\n", newtons(-self.peaks[1])),
            "Z" => {
                self.zero = rig.force();
                self.peaks = [0.0; 2];
                String::new()
            }
            _ => "*10\r\n".to_owned(),
        }
    }
}

/// Minus zero is not shown.
fn newtons(value: f64) -> String {
    format!("{:.2} N", (value * 100.0).round() / 100.0 + 0.0)
}

impl Firmware for Mark10Gauge {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let commands = self.lines.take(bytes);
        commands
            .iter()
            .flat_map(|command| self.command(command, rig).into_bytes())
            .collect()
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.reading(rig);
        Vec::new()
    }

    fn reboot(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
        *self = Self::new(self.polarity);
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::firmware::testing::spring;

    fn reply_to(gauge: &mut Mark10Gauge, rig: &mut EmulatedRig, bytes: &[u8]) -> String {
        String::from_utf8(gauge.receive(bytes, rig)).unwrap()
    }

    #[test]
    fn it_reads_zeroes_and_keeps_its_peaks() {
        let (mut gauge, mut rig) = (Mark10Gauge::new(1.0), spring());
        assert_eq!(reply_to(&mut gauge, &mut rig, b"?\r\n?"), "0.00 N\r\n");
        rig.go(0.005_123_4, 0.01);
        rig.advance(1.0);
        // 100 N/mm × 5.1234 mm.
        assert_eq!(reply_to(&mut gauge, &mut rig, b"\r"), "512.34 N\r\n");
        rig.go(-0.002, 0.01);
        rig.advance(2.0);
        assert_eq!(
            reply_to(&mut gauge, &mut rig, b"?C\r?PC\r?PT\rZ\r?\r?PC\r"),
            { "-200.00 N\r\n512.34 N\r\n-200.00 N\r\n0.00 N\r\n0.00 N\r\n" }
        );
        assert_eq!(reply_to(&mut gauge, &mut rig, b"?Q\r"), "*10\r\n");
    }

    #[test]
    fn its_polarity_is_a_setting_and_peaks_are_seen_between_questions() {
        let (mut gauge, mut rig) = (Mark10Gauge::new(-1.0), spring());
        rig.go(0.001, 0.01);
        rig.advance(1.0);
        gauge.tick(&mut rig);
        rig.go(0.0, 0.01);
        rig.advance(2.0);
        assert_eq!(
            reply_to(&mut gauge, &mut rig, b"?\r?PT\r"),
            "0.00 N\r\n-100.00 N\r\n"
        );
        gauge.reboot(&mut rig);
        assert_eq!(reply_to(&mut gauge, &mut rig, b"?PT\r"), "0.00 N\r\n");
    }
}
