//! A Mark-10 ESM303 stand with its gauge. In: single letters, some with digits after them, no line ends. Out: status, travel
//! and answers of the gauge. It has no "go to" command: in limit mode it stops exactly at the limit that is set.
//!
//! Choices where the published commands are not specific: every answer ends with CR LF; `p` answers as `SM`, `UL` or `SLUL`,
//! the parts written together; `x`, `v` and `w` answer a number without its unit, as `-12.34`; `n`, whose layout is not
//! published, is not answered; a speed given with `e` applies from `o` on, until then the panel's speed applies; letters
//! between `/` and `\` go to the gauge, whose command ends with CR or with `\`; a speed of zero is ignored.

mod load_cell;

use crate::emulator::{EmulatedRig, Firmware};
pub use load_cell::Mark10Gauge;

/// Travel limits of the stand itself \[m\], in both directions: `u` and `d` end there in manual mode.
const END_OF_TRAVEL: f64 = 0.3;
/// Speed of the panel's knob, mm/min.
const PANEL_SPEED: f64 = 10.0;
const MILLIMETRES_PER_INCH: f64 = 25.4;

#[derive(Debug)]
pub struct Mark10 {
    polarity: f64,
    gauge: Mark10Gauge,
    emulator: Stand,
}

/// The state that is lost at power-off. Lengths are in m.
#[derive(Debug)]
struct Stand {
    /// A command with missing digits.
    begun: Vec<u8>,
    /// The unfinished command to the gauge.
    to_gauge: Option<String>,
    limit_mode: bool,
    inch: bool,
    /// m/s
    set_speed: f64,
    use_set_speed: bool,
    /// Travel limits \[m\], as set with `g` and `h`.
    limits: [Option<f64>; 2],
    /// The emulated rig position of zero travel \[m\].
    zero: f64,
}

impl Default for Stand {
    fn default() -> Self {
        Self {
            begun: Vec::new(),
            to_gauge: None,
            limit_mode: false,
            inch: false,
            set_speed: PANEL_SPEED * 1e-3 / 60.0,
            use_set_speed: false,
            limits: [None; 2],
            zero: 0.0,
        }
    }
}

/// Lower and upper.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Down,
    Up,
}

impl Mark10 {
    /// A stand whose gauge shows the emulated rig's force with this polarity, +1 or −1.
    #[must_use]
    pub fn new(polarity: f64) -> Self {
        Self {
            polarity,
            gauge: Mark10Gauge::new(polarity),
            emulator: Stand::default(),
        }
    }

    fn byte(&mut self, byte: u8, rig: &mut EmulatedRig) -> String {
        if let Some(command) = &mut self.emulator.to_gauge {
            let ended = matches!(byte, b'\r' | b'\n' | b'\\');
            if !ended && command.len() < 16 {
                command.push(char::from(byte));
            }
            let command = if ended {
                std::mem::take(command)
            } else {
                String::new()
            };
            if byte == b'\\' {
                self.emulator.to_gauge = None;
            }
            return if command.is_empty() {
                String::new()
            } else {
                self.gauge.command(&command, rig)
            };
        }
        if self.emulator.begun.is_empty() {
            match byte {
                b'/' => self.emulator.to_gauge = Some(String::new()),
                b'e' | b'g' | b'h' => self.emulator.begun.push(byte),
                _ => return self.emulator.letter(byte, rig),
            }
        } else {
            self.emulator.digit(byte);
        }
        String::new()
    }
}

impl Stand {
    fn letter(&mut self, letter: u8, rig: &mut EmulatedRig) -> String {
        match letter {
            b'u' => self.go(Side::Up, rig),
            b'd' => self.go(Side::Down, rig),
            b's' => rig.hold(),
            b'l' => self.limit_mode = true,
            b'm' => self.limit_mode = false,
            b'b' => self.inch = true,
            b'i' => self.inch = false,
            b'o' => self.use_set_speed = true,
            b'z' => self.zero = rig.commanded(),
            b'p' => return format!("{}\r\n", self.status(rig)),
            b'v' => return self.limit_text(self.limits[1].unwrap_or(END_OF_TRAVEL)),
            b'w' => return self.limit_text(self.limits[0].unwrap_or(-END_OF_TRAVEL)),
            b'x' => return format!("{:.2}\r\n", self.travel(rig) / self.unit() * 1e3),
            _ => {}
        }
        String::new()
    }

    /// Adds a byte to `e`, `g` or `h`: four digits, a point and one; a sign, three digits, a point and two.
    fn digit(&mut self, byte: u8) {
        let signed = self.begun[0] != b'e';
        let (whole, decimals) = if signed { (3, 2) } else { (4, 1) };
        if signed && self.begun.len() == 1 && matches!(byte, b'-' | b'+') {
            self.begun.push(byte);
            return;
        }
        let sign = usize::from(matches!(self.begun.get(1), Some(b'-' | b'+')));
        let at = self.begun.len() - 1 - sign;
        let fits = if at == whole {
            byte == b'.'
        } else {
            byte.is_ascii_digit()
        };
        if !fits {
            self.begun.clear();
            return;
        }
        self.begun.push(byte);
        if at == whole + decimals {
            let begun = std::mem::take(&mut self.begun);
            let text: String = begun[1..].iter().map(|byte| char::from(*byte)).collect();
            if let Ok(value) = text.parse::<f64>() {
                self.set(begun[0], value * 1e-3 * self.unit());
            }
        }
    }

    fn set(&mut self, letter: u8, metres: f64) {
        match letter {
            b'g' => self.limits[0] = Some(metres),
            b'h' => self.limits[1] = Some(metres),
            _ if metres > 0.0 => self.set_speed = metres / 60.0,
            _ => {}
        }
    }

    /// A limit \[m\] in the selected unit.
    fn limit_text(&self, limit: f64) -> String {
        format!("{:.2}\r\n", limit / self.unit() * 1e3)
    }

    /// mm per unit of length.
    fn unit(&self) -> f64 {
        if self.inch { MILLIMETRES_PER_INCH } else { 1.0 }
    }

    fn go(&self, side: Side, rig: &mut EmulatedRig) {
        let speed = if self.use_set_speed {
            self.set_speed
        } else {
            PANEL_SPEED * 1e-3 / 60.0
        };
        let (limit, end) = match side {
            Side::Down => (self.limits[0], -END_OF_TRAVEL),
            Side::Up => (self.limits[1], END_OF_TRAVEL),
        };
        let target = limit
            .filter(|_| self.limit_mode)
            .map_or(end, |limit| limit + self.zero);
        let here = rig.commanded();
        let ahead = if side == Side::Up {
            target > here
        } else {
            target < here
        };
        if ahead {
            rig.go(target, speed);
        } else {
            rig.hold();
        }
    }

    /// m
    fn travel(&self, rig: &mut EmulatedRig) -> f64 {
        let hundredth = 1e-5;
        ((rig.displacement() - self.zero) / hundredth).round() * hundredth + 0.0
    }

    fn status(&self, rig: &EmulatedRig) -> String {
        let here = rig.commanded() - self.zero;
        let left = rig
            .moves()
            .last()
            .filter(|_| rig.moving())
            .map_or(0.0, |sent| sent.targets[0] - rig.commanded());
        let moving = if left > 0.0 {
            "U"
        } else if left < 0.0 {
            "D"
        } else {
            "S"
        };
        // The tolerance is a tenth of the resolution of the travel.
        let at = |limit: Option<f64>| limit.is_some_and(|limit| (here - limit).abs() < 1e-6);
        let limit = match self.limits {
            [_, upper] if self.limit_mode && at(upper) => "UL",
            [lower, _] if self.limit_mode && at(lower) => "DL",
            _ => "",
        };
        format!("{moving}{}{limit}", if self.limit_mode { "L" } else { "M" })
    }
}

impl Firmware for Mark10 {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        bytes
            .iter()
            .flat_map(|byte| self.byte(*byte, rig).into_bytes())
            .collect()
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.gauge.tick(rig)
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        rig.hold();
        *self = Self::new(self.polarity);
        // Travel is zero at the position of power-up.
        self.emulator.zero = rig.commanded();
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::firmware::testing::spring;

    fn reply_to(emulator: &mut Mark10, rig: &mut EmulatedRig, bytes: &[u8]) -> String {
        String::from_utf8(emulator.receive(bytes, rig)).unwrap()
    }

    #[test]
    fn in_limit_mode_it_stops_exactly_at_the_limit() {
        let (mut emulator, mut rig) = (Mark10::new(1.0), spring());
        // 600 mm/min is 10 mm/s: 2.5 mm in a quarter of a second.
        assert_eq!(reply_to(&mut emulator, &mut rig, b"ile0600.0oh002.50u"), "");
        assert_eq!(reply_to(&mut emulator, &mut rig, b"p"), "UL\r\n");
        rig.advance(0.1);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"xp"), "1.00\r\nUL\r\n");
        rig.advance(3.0);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"xp"), "2.50\r\nSLUL\r\n");
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"ug-001.25dp"),
            "DLUL\r\n",
            "still there"
        );
        rig.advance(6.0);
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"xp"),
            "-1.25\r\nSLDL\r\n"
        );
        assert_eq!(rig.targets(), [0.0025, -0.00125]);
        assert!(rig.violations().is_empty());
    }

    #[test]
    fn the_set_speed_counts_only_when_commanded() {
        let (mut emulator, mut rig) = (Mark10::new(1.0), spring());
        reply_to(&mut emulator, &mut rig, b"le0600.0h+005.00u");
        rig.advance(6.0);
        // The panel's 10 mm/min.
        assert_eq!(reply_to(&mut emulator, &mut rig, b"xsou"), "1.00\r\n");
        rig.advance(6.2);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"xs"), "3.00\r\n");
        rig.advance(9.0);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"xp"), "3.00\r\nSL\r\n");
    }

    #[test]
    fn in_manual_mode_nothing_stops_it_before_its_end() {
        let (mut emulator, mut rig) = (Mark10::new(1.0), spring());
        reply_to(&mut emulator, &mut rig, b"h005.00up");
        assert_eq!(
            rig.violations(),
            [0.3],
            "who drives by hand must stop by hand"
        );
        rig.advance(1.0);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"psp"), "UM\r\nSM\r\n");
    }

    #[test]
    fn the_gauge_is_heard_between_the_slashes_only() {
        let (mut emulator, mut rig) = (Mark10::new(-1.0), spring());
        reply_to(&mut emulator, &mut rig, b"le0600.0oh001.00u");
        rig.advance(1.0);
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"/?\r\\x"),
            "-100.00 N\r\n1.00\r\n"
        );
        assert_eq!(reply_to(&mut emulator, &mut rig, b"/?"), "");
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"\\/u\\p"),
            "-100.00 N\r\n*10\r\nSLUL\r\n"
        );
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"?\rn"),
            "",
            "outside they are nothing to the stand"
        );
    }

    #[test]
    fn travel_is_zeroed_and_inches_are_inches() {
        let (mut emulator, mut rig) = (Mark10::new(1.0), spring());
        reply_to(&mut emulator, &mut rig, b"le0600.0oh002.00u");
        rig.advance(1.0);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"zxp"), "0.00\r\nSL\r\n");
        reply_to(&mut emulator, &mut rig, b"h001.00u");
        rig.advance(2.0);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"x"), "1.00\r\n");
        assert_eq!(rig.targets().last(), Some(&0.003));
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"bh001.00ux"),
            "0.04\r\n",
            "1 mm"
        );
        assert!((rig.targets().last().unwrap() - 0.0274).abs() < 1e-12);
    }

    #[test]
    fn its_limits_can_be_asked_for() {
        let (mut emulator, mut rig) = (Mark10::new(1.0), spring());
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"vw"),
            "300.00\r\n-300.00\r\n"
        );
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"ilh002.50g-001.25vw"),
            "2.50\r\n-1.25\r\n"
        );
    }

    #[test]
    fn a_broken_number_is_dropped_and_the_next_letter_is_heard() {
        let (mut emulator, mut rig) = (Mark10::new(1.0), spring());
        assert_eq!(reply_to(&mut emulator, &mut rig, b"lh2.50"), "");
        assert_eq!(reply_to(&mut emulator, &mut rig, b"p"), "SL\r\n");
        assert_eq!(reply_to(&mut emulator, &mut rig, b"e0000.0oh000.10"), "");
        reply_to(&mut emulator, &mut rig, b"u");
        rig.advance(1.0);
        assert_eq!(
            reply_to(&mut emulator, &mut rig, b"x"),
            "0.10\r\n",
            "a speed of nothing is not taken"
        );
        emulator.reboot(&mut rig);
        assert_eq!(reply_to(&mut emulator, &mut rig, b"xp"), "0.00\r\nSM\r\n");
    }
}
