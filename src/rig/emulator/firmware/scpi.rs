//! A meter with the SCPI protocol: `*IDN?` and `READ?`. In: lines. Out: its identity; a number in its own unit.

use crate::emulator::{EmulatedRig, Firmware};

/// The firmware.
#[derive(Debug)]
pub struct Scpi {
    serial_number: String,
    /// The index of the actuator and the force of one unit \[N\], for each channel.
    channels: Vec<(usize, f64)>,
    line: Vec<u8>,
}

impl Scpi {
    /// A meter with a channel for each of these actuators and the force of one unit \[N\].
    #[must_use]
    pub const fn new(serial_number: String, channels: Vec<(usize, f64)>) -> Self {
        Self {
            serial_number,
            channels,
            line: Vec::new(),
        }
    }

    fn answer(&self, line: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        match line.trim_ascii().to_ascii_uppercase().as_slice() {
            b"*IDN?" => format!("PSD,PSD-SIM,{},1.3\n", self.serial_number).into_bytes(),
            b"READ?" => {
                let channel = |(actuator, newtons): &(usize, f64)| {
                    let shown = scientific(rig.force_of(*actuator) / newtons);
                    rig.shown_force(*actuator, shown)
                };
                let words: Vec<String> = self.channels.iter().map(channel).collect();
                format!("{}\n", words.join(",")).into_bytes()
            }
            _ => Vec::new(),
        }
    }
}

/// `+5.12375000E+02`
fn scientific(value: f64) -> String {
    let text = format!("{value:+.8E}");
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, exponent) = exponent
        .strip_prefix('-')
        .map_or(('+', exponent), |exponent| ('-', exponent));
    format!("{digits}E{sign}{exponent:0>2}")
}

impl Firmware for Scpi {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let mut reply = Vec::new();
        for byte in bytes {
            if *byte == b'\n' {
                let line = std::mem::take(&mut self.line);
                reply.extend(self.answer(&line, rig));
            } else if self.line.len() < 256 {
                self.line.push(*byte);
            }
        }
        reply
    }

    fn tick(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
        Vec::new()
    }

    fn reboot(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
        self.line.clear();
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::emulator::elastic_rig;

    #[test]
    fn it_answers_with_its_own_unit() {
        let (mut meter, mut rig) = (Scpi::new("77".to_owned(), vec![(0, 2.0)]), elastic_rig());
        assert_eq!(
            meter.receive(b"*IDN?\nREAD", &mut rig),
            b"PSD,PSD-SIM,77,1.3\n"
        );
        rig.go(0.005, 0.01);
        rig.advance(1.0);
        assert_eq!(meter.receive(b"?\r\n", &mut rig), b"+2.50000000E+02\n");
        assert!(meter.receive(b"*RST\n", &mut rig).is_empty());
        assert_eq!(scientific(-0.00125), "-1.25000000E-03");
        rig.strike(
            0,
            crate::emulator::MechanicalFault::Number("9.91E37".to_owned()),
        );
        assert_eq!(meter.receive(b"READ?\n", &mut rig), b"9.91E37\n");
    }
}
