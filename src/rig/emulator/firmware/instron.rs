//! An Instron 8800-style console: channel 1 is position, channel 2 load, each as a fraction of its full scale. In: lines
//! of `Q`, `C` and `P` words. Out: an answer to every query, none to a write.
//!
//! Choices where the published commands are not specific: `Q308,n` is in m and N; a reading has eight digits after the point;
//! an unknown query has no answer; status bit 12 is the watchdog's trip. A write that is not wrapped in `P909,1` and `C904,0`
//! trips the hydraulics: the actuator is off and keeps its position. Every write is then ignored until `C23,1` comes wrapped.
//! Only `P909` and the panic `C23,0` need no wrapping.

use super::line_buffer::LineBuffer;
use crate::emulator::{EmulatedRig, Firmware};

/// Bits of `Q22`.
const ACTUATOR_OFF: u32 = 1 << 3;
const TRIPPED: u32 = 1 << 12;

/// `C2,1,3`
const ABSOLUTE_RAMP: &str = "3";

#[derive(Debug)]
pub struct Instron {
    /// m and N.
    full_scale: [f64; 2],
    lines: LineBuffer,
    console: Console,
}

/// The state that is lost at power-off.
#[derive(Debug, Default)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of its own on the console"
)]
struct Console {
    /// `P909,1`: the computer has control.
    computer: bool,
    /// `C904,0` since then.
    watchdog_off: bool,
    tripped: bool,
    actuator_off: bool,
    /// `C300,1`
    position_mode: bool,
    absolute_ramp: bool,
    /// s, `C86,1,s`
    ramp_time: Option<f64>,
    /// Fraction of full scale, `C4,1,raw`.
    ramp_target: Option<f64>,
    /// Target of a started ramp \[m\] and its speed \[m/s\].
    ramp: Option<(f64, f64)>,
    held: bool,
}

impl Instron {
    /// A console with a full scale of ±`position` \[m\] and ±`load` \[N\].
    #[must_use]
    pub fn new(position: f64, load: f64) -> Self {
        Self {
            full_scale: [position, load],
            lines: LineBuffer::default(),
            console: Console::default(),
        }
    }

    fn answer(&self, words: &[&str], rig: &mut EmulatedRig) -> Option<String> {
        match *words {
            ["Q1"] => Some(self.movement(rig).to_owned()),
            ["Q22"] => {
                let off = if self.console.actuator_off {
                    ACTUATOR_OFF
                } else {
                    0
                };
                let tripped = if self.console.tripped { TRIPPED } else { 0 };
                Some((off | tripped).to_string())
            }
            ["Q23"] => Some(u8::from(!self.console.actuator_off).to_string()),
            ["Q300"] => Some(u8::from(self.console.position_mode).to_string()),
            ["Q909"] => Some(u8::from(self.console.computer).to_string()),
            ["Q308", "1"] => Some(self.full_scale[0].to_string()),
            ["Q308", "2"] => Some(self.full_scale[1].to_string()),
            ["Q134", "1", "0"] => Some(format!("{:.8}", rig.displacement() / self.full_scale[0])),
            ["Q134", "2", "0"] => {
                let raw = format!("{:.8}", rig.force() / self.full_scale[1]);
                Some(rig.shown_force(0, raw))
            }
            ["Q86", "1"] => self.console.ramp_time.map(|seconds| seconds.to_string()),
            ["Q4", "1"] => self.console.ramp_target.map(|raw| raw.to_string()),
            _ => None,
        }
    }

    fn movement(&self, rig: &EmulatedRig) -> &'static str {
        match self.console.ramp {
            Some(_) if self.console.held => "2",
            Some(_) if rig.moving() => "1",
            _ => "0",
        }
    }

    fn write(&mut self, words: &[&str], rig: &mut EmulatedRig) {
        let console = &mut self.console;
        match *words {
            ["P909", "1"] => {
                console.computer = true;
                return;
            }
            ["P909", "0"] => {
                console.computer = false;
                console.watchdog_off = false;
                return;
            }
            ["C23", "0"] => {
                console.actuator_off = true;
                stop(console, rig);
                return;
            }
            ["C904", "0", ..] if console.computer => {
                console.watchdog_off = true;
                return;
            }
            _ => {}
        }
        if !(console.computer && console.watchdog_off) {
            console.tripped = true;
            console.actuator_off = true;
            stop(console, rig);
        } else if console.actuator_off {
            if words == ["C23", "1"] {
                console.actuator_off = false;
                console.tripped = false;
            }
        } else {
            self.command(words, rig);
        }
    }

    /// Executes a correctly wrapped write on a console whose actuator is on.
    fn command(&mut self, words: &[&str], rig: &mut EmulatedRig) {
        let console = &mut self.console;
        match *words {
            ["C300", channel] => console.position_mode = channel == "1",
            ["C2", "1", waveform] => console.absolute_ramp = waveform == ABSOLUTE_RAMP,
            ["C86", "1", seconds] => {
                if let Some(seconds) = number(seconds).filter(|seconds| *seconds > 0.0) {
                    console.ramp_time = Some(seconds);
                }
            }
            ["C4", "1", raw] => {
                let raw = number(raw).unwrap_or(f64::NAN);
                if (-1.0..=1.0).contains(&raw) {
                    console.ramp_target = Some(raw);
                } else {
                    rig.refuse(raw * self.full_scale[0]);
                }
            }
            ["C1", "0"] => stop(console, rig),
            ["C1", "1"] => {
                if let (true, true, Some(raw), Some(seconds)) = (
                    console.position_mode,
                    console.absolute_ramp,
                    console.ramp_target,
                    console.ramp_time,
                ) {
                    let target = raw * self.full_scale[0];
                    let speed = (target - rig.commanded()).abs() / seconds;
                    console.ramp = Some((target, speed));
                    console.held = false;
                    rig.go(target, speed);
                }
            }
            ["C1", "2"] => {
                console.held = console.ramp.is_some();
                rig.hold();
            }
            ["C1", "3"] => {
                if let Some((target, speed)) = console.ramp.filter(|_| console.held) {
                    console.held = false;
                    rig.go(target, speed);
                }
            }
            _ => {}
        }
    }
}

fn stop(console: &mut Console, rig: &mut EmulatedRig) {
    console.ramp = None;
    console.held = false;
    rig.hold();
}

/// A finite decimal number.
fn number(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|value| value.is_finite())
}

impl Firmware for Instron {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let mut answers = Vec::new();
        for line in self.lines.take(bytes) {
            let words: Vec<&str> = line.split(',').map(str::trim).collect();
            if line.starts_with('Q') {
                if let Some(answer) = self.answer(&words, rig) {
                    answers.extend(answer.bytes().chain(*b"\r\n"));
                }
            } else {
                self.write(&words, rig);
            }
        }
        answers
    }

    fn tick(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
        Vec::new()
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.lines.clear();
        self.console = Console::default();
        rig.hold();
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::firmware::testing::spring;

    const WRAPPED: &[u8] = b"P909,1\r\nC904,0\r\n";

    /// 100 mm and 50 kN of full scale, on a spring of 100 kN/m.
    fn console() -> (Instron, EmulatedRig) {
        (Instron::new(0.1, 5e4), spring())
    }

    fn reply_to(console: &mut Instron, rig: &mut EmulatedRig, bytes: &[u8]) -> String {
        String::from_utf8(console.receive(bytes, rig)).unwrap()
    }

    /// Sets up an absolute ramp to 5 mm within 2 s and starts it.
    fn started() -> (Instron, EmulatedRig) {
        let (mut console, mut rig) = console();
        assert_eq!(reply_to(&mut console, &mut rig, WRAPPED), "");
        let ramp = b"C300,1\r\nC2,1,3\r\nC86,1,2.0\r\nC4,1,0.05\r\nC1,1\r\nP909,0\r\n";
        assert_eq!(reply_to(&mut console, &mut rig, ramp), "");
        (console, rig)
    }

    #[test]
    fn a_ramp_arrives_in_its_time_and_the_readings_are_fractions_of_full_scale() {
        let (mut console, mut rig) = started();
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q308,1\r\nQ308,2\r\nQ1\r\nQ22\r\n"),
            "0.1\r\n50000\r\n1\r\n0\r\n"
        );
        rig.advance(1.0);
        // 2.5 mm of 100 mm; 250 N of 50 kN.
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q134,1,0\r\nQ134,2,0\r\n"),
            "0.02500000\r\n0.00500000\r\n"
        );
        rig.advance(2.0);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q1\r\nQ134,1,0\r\n"),
            "0\r\n0.05000000\r\n"
        );
        assert!(rig.violations().is_empty());
    }

    #[test]
    fn a_ramp_is_held_goes_on_and_stops() {
        let (mut console, mut rig) = started();
        rig.advance(1.0);
        assert_eq!(
            reply_to(
                &mut console,
                &mut rig,
                b"P909,1\r\nC904,0\r\nC1,2\r\nQ1\r\n"
            ),
            "2\r\n"
        );
        rig.advance(5.0);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q134,1,0\r\nC1,3\r\nQ1\r\n"),
            "0.02500000\r\n1\r\n"
        );
        rig.advance(5.4);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"C1,0\r\nQ1\r\nP909,0\r\n"),
            "0\r\n"
        );
        rig.advance(9.0);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q134,1,0\r\n"),
            "0.03500000\r\n"
        );
    }

    #[test]
    fn a_write_that_is_not_wrapped_trips_the_hydraulics() {
        for bare in [
            &b"C1,1\r\n"[..],
            b"C904,0\r\n",
            b"P909,1\r\nC1,1\r\n",
            b"P909,1\r\nC904,0\r\nP909,0\r\nC86,1,1\r\n",
        ] {
            let (mut console, mut rig) = started();
            rig.advance(1.0);
            // Bit 12, the trip, and bit 3, the actuator that is off: 4096 + 8.
            reply_to(&mut console, &mut rig, bare);
            assert_eq!(
                reply_to(&mut console, &mut rig, b"Q22\r\nQ1\r\n"),
                "4104\r\n0\r\n",
                "{}",
                bare.escape_ascii()
            );
            rig.advance(3.0);
            reply_to(&mut console, &mut rig, WRAPPED);
            reply_to(&mut console, &mut rig, b"C1,1\r\n");
            assert!(!rig.moving(), "ignored until the actuator is on again");
            assert_eq!(
                reply_to(&mut console, &mut rig, b"C23,1\r\nQ22\r\nC1,1\r\nQ1\r\n"),
                "0\r\n1\r\n"
            );
        }
    }

    #[test]
    fn the_panic_word_needs_no_wrapping_and_is_no_trip() {
        let (mut console, mut rig) = started();
        rig.advance(1.0);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"C23,0\r\nQ22\r\nQ23\r\n"),
            "8\r\n0\r\n"
        );
        rig.advance(3.0);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q134,1,0\r\n"),
            "0.02500000\r\n"
        );
    }

    #[test]
    fn it_refuses_what_is_no_number_or_beyond_full_scale_and_starts_only_an_absolute_ramp_of_position()
     {
        for missing in ["C300,2", "C2,1,1", "C4,1,nan", "C4,1,1.5", "C86,1,0"] {
            let (mut console, mut rig) = console();
            reply_to(&mut console, &mut rig, WRAPPED);
            let words = ["C300,1", "C2,1,3", "C86,1,2", "C4,1,0.05"];
            let letter = missing.split(',').next().unwrap();
            for word in words {
                let word = if word.split(',').next() == Some(letter) {
                    missing
                } else {
                    word
                };
                reply_to(&mut console, &mut rig, format!("{word}\r\n").as_bytes());
            }
            reply_to(&mut console, &mut rig, b"C1,1\r\n");
            assert!(!rig.moving() && rig.targets().is_empty(), "{missing}");
        }
        let (mut console, mut rig) = console();
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q999\r\n\xff\xfe\r\n"),
            ""
        );
    }

    #[test]
    fn a_reboot_forgets_the_ramp_and_stays_where_it_is() {
        let (mut console, mut rig) = started();
        rig.advance(1.0);
        assert!(console.reboot(&mut rig).is_empty());
        rig.advance(3.0);
        assert_eq!(
            reply_to(&mut console, &mut rig, b"Q1\r\nQ300\r\nQ134,1,0\r\n"),
            "0\r\n0\r\n0.02500000\r\n"
        );
    }
}
