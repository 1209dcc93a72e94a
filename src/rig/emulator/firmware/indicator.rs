//! A weighing indicator that sends its weight periodically and on request: `ST,GS,+0001234,kg`. In: `READ`. Out: weights.

use crate::emulator::{EmulatedRig, Firmware};

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
    fn weight(rig: &mut EmulatedRig) -> Vec<u8> {
        let kilograms = rig.force() / GRAVITY;
        let within = kilograms.abs() <= CAPACITY;
        let status = match (within, rig.moving()) {
            (false, _) => "OL",
            (true, true) => "US",
            (true, false) => "ST",
        };
        let shown = if within {
            format!("{kilograms:+08.2}")
        } else {
            "^^^^^^^^".to_owned()
        };
        format!("{status},GS,{},kg\r\n", rig.shown(shown)).into_bytes()
    }
}

impl Firmware for Indicator {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let mut reply = Vec::new();
        for byte in bytes {
            if matches!(byte, b'\r' | b'\n') {
                if std::mem::take(&mut self.line) == b"READ" {
                    reply.extend(Self::weight(rig));
                }
            } else if self.line.len() < 80 {
                self.line.push(*byte);
            }
        }
        reply
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        let now = rig.time();
        if now < self.next {
            return Vec::new();
        }
        self.next = if now < self.next + PERIOD {
            self.next + PERIOD
        } else {
            now + PERIOD
        };
        Self::weight(rig)
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        *self = Self {
            line: Vec::new(),
            next: rig.time() + PERIOD,
        };
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::emulator::elastic_rig;

    #[test]
    fn a_weight_has_eight_digits_and_states_whether_it_is_stable() {
        let (mut indicator, mut rig) = (Indicator::default(), elastic_rig());
        assert_eq!(indicator.tick(&mut rig), b"ST,GS,+0000.00,kg\r\n");
        assert!(indicator.tick(&mut rig).is_empty());
        rig.go(0.000_980_665, 0.000_980_665);
        rig.advance(0.5);
        assert_eq!(
            indicator.receive(b"READ\r\n", &mut rig),
            b"US,GS,+0005.00,kg\r\n",
            "49.03 N on the way"
        );
        rig.advance(1.5);
        assert_eq!(
            indicator.tick(&mut rig),
            b"ST,GS,+0010.00,kg\r\n",
            "98.0665 N"
        );
        rig.strike(0, crate::emulator::MechanicalFault::Spike(-1e6));
        assert_eq!(
            indicator.receive(b"READ\r\n", &mut rig),
            b"OL,GS,^^^^^^^^,kg\r\n"
        );
        assert!(indicator.receive(b"WRITE\r\n", &mut rig).is_empty());
    }
}
