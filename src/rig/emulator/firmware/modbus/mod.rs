//! A Modbus RTU drive or transmitter with the register map of a plan. In: frames, whole or in parts. Out: an answer or an
//! exception; no answer to an invalid frame or to a frame for another unit.
//!
//! Functions 3 and 4 read the same registers, 6 and 16 write. Choices where the vendors differ: a number of 32 bits must be
//! written whole, else exception 3. A target that is not a number also gives exception 3. The move starts with the start
//! command, or, without a command register, with the target. A start without a target, or with a speed not above 0, gives
//! exception 4. Without a speed register the maximum speed applies.

mod frame;
mod registers;

use crate::emulator::{EmulatedRig, Firmware};
use frame::{Assembler, Exception, Frame, reply};
use psd_plan::ModbusMap;
use registers::{decode, encode, width};

#[derive(Debug)]
pub struct Modbus {
    map: ModbusMap,
    assembler: Assembler,
    /// m, as written.
    target: Option<f64>,
    /// m/s, as written.
    speed: Option<f64>,
    command: u16,
}

impl Modbus {
    #[must_use]
    pub fn new(map: ModbusMap) -> Self {
        Self {
            map,
            assembler: Assembler::default(),
            target: None,
            speed: None,
            command: 0,
        }
    }

    /// All registers, in any order: address and value.
    fn registers(&self, rig: &mut EmulatedRig) -> Vec<(u16, u16)> {
        let map = self.map;
        let mut words = Vec::new();
        let mut number = |at: Option<u16>, value: f64| {
            let encoded = encode(value, map.number);
            words.extend(at.into_iter().flat_map(|at| (at..).zip(encoded.clone())));
        };
        number(map.target, self.target.unwrap_or(0.0) / map.length_unit);
        number(map.speed, self.speed.unwrap_or(0.0) / map.speed_unit);
        number(map.position, rig.displacement() / map.length_unit);
        if map.force.is_some() {
            let force = rig.force() / map.force_unit;
            // A fault can replace the ordinary number. A string that is not a number becomes NaN.
            let shown = rig.shown(force.to_string()).parse().unwrap_or(f64::NAN);
            number(map.force, shown);
        }
        words.extend(
            map.status
                .map(|at| (at, if rig.moving() { map.moving_mask } else { 0 })),
        );
        words.extend(map.command.map(|at| (at, self.command)));
        words
    }

    fn answer(&mut self, frame: &Frame, rig: &mut EmulatedRig) -> Result<Vec<u8>, Exception> {
        match *frame {
            Frame::Read { start, count, .. } => {
                if !(1..=125).contains(&count) {
                    return Err(Exception::Value);
                }
                let registers = self.registers(rig);
                let word = |at: u32| {
                    registers
                        .iter()
                        .find(|(address, _)| u32::from(*address) == at)
                        .map(|(_, word)| *word)
                };
                let addresses = u32::from(start)..u32::from(start) + u32::from(count);
                let words: Vec<u16> = addresses
                    .map(word)
                    .collect::<Option<_>>()
                    .ok_or(Exception::Address)?;
                let bytes = u8::try_from(2 * words.len()).map_err(|_| Exception::Value)?;
                Ok(std::iter::once(bytes)
                    .chain(words.into_iter().flat_map(u16::to_be_bytes))
                    .collect())
            }
            Frame::Write {
                start,
                ref words,
                single,
            } => {
                self.write(start, words, rig)?;
                let second = if single {
                    words[0]
                } else {
                    u16::try_from(words.len()).unwrap_or(u16::MAX)
                };
                Ok([start.to_be_bytes(), second.to_be_bytes()].concat())
            }
            Frame::Bad(exception) => Err(exception),
        }
    }

    /// Writes consecutive registers. First it checks all values, then it writes all.
    fn write(&mut self, start: u16, words: &[u16], rig: &mut EmulatedRig) -> Result<(), Exception> {
        let map = self.map;
        let (mut target, mut speed, mut command) = (None, None, None);
        let mut left = words;
        let mut at = start;
        while let Some(first) = left.first() {
            let consumed = if map.command == Some(at) {
                command = Some(*first);
                1
            } else if map.target == Some(at) || map.speed == Some(at) {
                let width = width(map.number);
                let value = decode(left.get(..width).ok_or(Exception::Value)?, map.number);
                if map.target == Some(at) {
                    target = Some(value * map.length_unit);
                } else {
                    speed = Some(value * map.speed_unit);
                }
                width
            } else {
                let upper_half = |number: Option<u16>| {
                    width(map.number) == 2 && number.is_some_and(|number| number + 1 == at)
                };
                let halved = upper_half(map.target) || upper_half(map.speed);
                return Err(if halved {
                    Exception::Value
                } else {
                    Exception::Address
                });
            };
            left = &left[consumed..];
            at = at.wrapping_add(u16::try_from(consumed).unwrap_or(1));
        }
        if let Some(target) = target.filter(|target| !target.is_finite()) {
            rig.refuse(target);
            return Err(Exception::Value);
        }
        if speed.is_some_and(|speed| !speed.is_finite()) {
            return Err(Exception::Value);
        }
        self.target = target.or(self.target);
        self.speed = speed.or(self.speed);
        match (command, map.command) {
            (Some(word), _) => {
                self.command = word;
                self.obey(word, rig)
            }
            (None, None) if target.is_some() => self.start(rig),
            _ => Ok(()),
        }
    }

    fn obey(&self, word: u16, rig: &mut EmulatedRig) -> Result<(), Exception> {
        if word == self.map.stop_word {
            rig.hold();
        } else if word == self.map.start_word {
            return self.start(rig);
        }
        Ok(())
    }

    fn start(&self, rig: &mut EmulatedRig) -> Result<(), Exception> {
        let speed = if self.map.speed.is_some() {
            self.speed
        } else {
            Some(rig.settings().top_speed)
        };
        match (self.target, speed) {
            (Some(target), Some(speed)) if speed > 0.0 => {
                rig.go(target, speed);
                Ok(())
            }
            _ => Err(Exception::Failure),
        }
    }

    fn answers(&mut self, frames: Vec<(u8, u8, Frame)>, rig: &mut EmulatedRig) -> Vec<u8> {
        let mut answer = Vec::new();
        let mine = self.map.unit;
        for (unit, function, frame) in frames.into_iter().filter(|(unit, ..)| *unit == mine) {
            let body = self.answer(&frame, rig);
            answer.extend(reply(unit, function, body));
        }
        answer
    }
}

impl Firmware for Modbus {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let frames = self.assembler.take(bytes, rig.time());
        self.answers(frames, rig)
    }

    fn tick(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
        Vec::new()
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        rig.hold();
        *self = Self::new(self.map);
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::frame::checksum;
    use super::*;
    use crate::emulator::firmware::testing::spring;
    use psd_plan::ModbusNumber;

    /// µm and 0.1 N in 16 bits; the speed in mm/s × 100.
    fn map() -> ModbusMap {
        ModbusMap {
            unit: 1,
            number: ModbusNumber::Int16,
            target: Some(0x10),
            speed: Some(0x11),
            position: Some(0),
            force: Some(1),
            status: Some(2),
            moving_mask: 0x0004,
            command: Some(0x12),
            start_word: 1,
            stop_word: 2,
            length_unit: 1e-6,
            speed_unit: 1e-5,
            force_unit: 0.1,
        }
    }

    /// Adds the checksum to a frame and sends it. Checks the checksum of the answer and returns the rest.
    fn asked(drive: &mut Modbus, rig: &mut EmulatedRig, frame: &[u8]) -> Vec<u8> {
        let mut sent = frame.to_vec();
        sent.extend(checksum(frame).to_le_bytes());
        let mut answer = drive.receive(&sent, rig);
        if !answer.is_empty() {
            let sum = answer.split_off(answer.len() - 2);
            assert_eq!(sum, checksum(&answer).to_le_bytes());
        }
        answer
    }

    #[test]
    fn a_move_is_written_started_watched_and_stopped() {
        let (mut drive, mut rig) = (Modbus::new(map()), spring());
        // 5000 µm, 250 × 10 µm/s, start: registers 10h to 12h in one write.
        let answer = asked(
            &mut drive,
            &mut rig,
            &[1, 16, 0, 0x10, 0, 3, 6, 0x13, 0x88, 0, 0xFA, 0, 1],
        );
        assert_eq!(answer, [1, 16, 0, 0x10, 0, 3]);
        rig.advance(1.0);
        // 2500 µm, 250 N in tenths, moving.
        assert_eq!(
            asked(&mut drive, &mut rig, &[1, 3, 0, 0, 0, 3]),
            [1, 3, 6, 0x09, 0xC4, 0x09, 0xC4, 0, 4]
        );
        assert_eq!(
            asked(&mut drive, &mut rig, &[1, 6, 0, 0x12, 0, 2]),
            [1, 6, 0, 0x12, 0, 2]
        );
        rig.advance(5.0);
        assert_eq!(
            asked(&mut drive, &mut rig, &[1, 4, 0, 0, 0, 3]),
            [1, 4, 6, 0x09, 0xC4, 0x09, 0xC4, 0, 0]
        );
        // −1000 µm.
        asked(&mut drive, &mut rig, &[1, 6, 0, 0x10, 0xFC, 0x18]);
        asked(&mut drive, &mut rig, &[1, 6, 0, 0x12, 0, 1]);
        rig.advance(9.0);
        assert_eq!(
            asked(&mut drive, &mut rig, &[1, 4, 0, 0, 0, 1]),
            [1, 4, 2, 0xFC, 0x18]
        );
        assert!(rig.violations().is_empty());
    }

    #[test]
    fn numbers_of_32_bits_are_written_whole_in_the_vendors_order() {
        let number = ModbusNumber::Float32 {
            high_word_first: false,
        };
        let map = ModbusMap {
            number,
            target: Some(0x10),
            speed: None,
            position: Some(0),
            force: None,
            length_unit: 1e-3,
            ..map()
        };
        let (mut drive, mut rig) = (
            Modbus::new(ModbusMap {
                command: None,
                ..map
            }),
            spring(),
        );
        // 2.5 is 4020 0000: low word first.
        assert_eq!(
            asked(
                &mut drive,
                &mut rig,
                &[1, 16, 0, 0x10, 0, 2, 4, 0, 0, 0x40, 0x20]
            ),
            [1, 16, 0, 0x10, 0, 2]
        );
        rig.advance(1.0);
        assert_eq!(
            asked(&mut drive, &mut rig, &[1, 3, 0, 0, 0, 2]),
            [1, 3, 4, 0, 0, 0x40, 0x20]
        );
        // Half a number, its other half, and NaN (7FC0 0000).
        for bad in [
            &[1, 6, 0, 0x10, 0, 1][..],
            &[1, 6, 0, 0x11, 0, 1],
            &[1, 16, 0, 0x10, 0, 2, 4, 0, 0, 0x7F, 0xC0],
        ] {
            assert_eq!(asked(&mut drive, &mut rig, bad), [1, bad[1] | 0x80, 3]);
        }
        assert_eq!(rig.targets(), [0.0025]);
    }

    #[test]
    fn exceptions_state_the_error() {
        let (mut drive, mut rig) = (Modbus::new(map()), spring());
        let cases: [(&[u8], u8, u8); 8] = [
            (&[1, 7], 0x87, 1),
            (&[1, 3, 0, 2, 0, 2], 0x83, 2),
            (&[1, 4, 0xFF, 0xFF, 0, 2], 0x84, 2),
            (&[1, 6, 0, 0, 0, 1], 0x86, 2),
            (&[1, 3, 0, 0, 0, 0], 0x83, 3),
            (&[1, 3, 0, 0, 0, 126], 0x83, 3),
            (&[1, 16, 0, 0x10, 0, 1, 4, 0, 1, 0, 1], 0x90, 3),
            // Start without a target.
            (&[1, 6, 0, 0x12, 0, 1], 0x86, 4),
        ];
        for (frame, function, code) in cases {
            assert_eq!(
                asked(&mut drive, &mut rig, frame),
                [1, function, code],
                "{frame:02X?}"
            );
        }
        assert!(rig.targets().is_empty());
    }

    #[test]
    fn it_is_silent_on_a_broken_frame_and_on_one_for_another_unit() {
        let (mut drive, mut rig) = (Modbus::new(map()), spring());
        assert!(asked(&mut drive, &mut rig, &[2, 3, 0, 0, 0, 1]).is_empty());
        let whole = [1, 3, 0, 0, 0, 2, 0xC4, 0x0B];
        for bit in 0..64 {
            let mut flipped = whole;
            flipped[bit / 8] ^= 1 << (bit % 8);
            rig.advance(rig.time() + 1.0);
            assert!(drive.receive(&flipped, &mut rig).is_empty(), "bit {bit}");
        }
        rig.advance(rig.time() + 1.0);
        assert_eq!(
            drive.receive(&whole, &mut rig).len(),
            9,
            "and heard again after a gap"
        );
    }
}
