//! A Modbus RTU drive, transmitter or both, by its register map. In: \[m\] and \[m/s\]. Out: register writes, and readings
//! of the mapped registers. It keeps the silences of the line, and never accepts a late answer. Over a TCP port the same
//! RTU bytes are sent. A stop can also be a frame without an awaited answer; sent into the middle of another frame it may
//! not be received, so it does not replace a wired emergency stop.

use super::word_order::{IMPLAUSIBLY_SMALL, Measured, Registers, WordOrder};
use crate::LineStatistics;
use crate::controllers::modbus;
use crate::controllers::modbus::codec::{FrameFault, Table};
use crate::controllers::unsequenced::{clear, fault, fresh, order};
use crate::controllers::{
    Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Force, LineClient, Sample, one_axis,
};
use psd_plan::{Limits, ModbusMap, ModbusNumber};

/// Silence before a question: 3.5 characters of 11 bits, and never less than this \[s\].
const SHORTEST_GAP: f64 = 0.001_75;
const GAP_BITS: f64 = 3.5 * 11.0;
/// Farther than the travel of any actuator \[m\].
const IMPLAUSIBLE_POSITION: f64 = 1e3;
/// More than the range of any load cell \[N\].
const IMPLAUSIBLE_FORCE: f64 = 1e12;

/// The drive, or the transmitter, at the other end of a line.
pub struct Modbus {
    client: LineClient,
    map: ModbusMap,
    /// \[s\]
    gap: f64,
    position: Option<Register>,
    force: Option<Register>,
    status: Option<Register>,
    order: WordOrder,
}

/// A register to read, and the table that contains it.
#[derive(Clone, Copy, Debug)]
struct Register {
    address: u16,
    table: Table,
}

/// A number as it was read.
struct RegisterReading {
    /// \[m\] or \[N\]
    value: f64,
    raw: Vec<u8>,
}

impl Modbus {
    /// `baud` of a serial line gives the silence between frames. None: over TCP.
    #[must_use]
    pub fn new(client: LineClient, map: ModbusMap, baud: Option<u32>) -> Self {
        let gap = baud.map_or(SHORTEST_GAP, |baud| {
            (GAP_BITS / f64::from(baud)).max(SHORTEST_GAP)
        });
        let register = |address: Option<u16>| {
            address.map(|address| Register {
                address,
                table: Table::Holding,
            })
        };
        let (position, force, status) = (
            register(map.position),
            register(map.force),
            register(map.status),
        );
        Self {
            client,
            map,
            gap,
            position,
            force,
            status,
            order: WordOrder::of(map.number),
        }
    }

    /// Finds the table of a register: if there is no such holding register, the input registers are tried.
    fn find(
        &mut self,
        register: Option<Register>,
        count: u16,
    ) -> Result<Option<Register>, DeviceFault> {
        let Some(Register { address, .. }) = register else {
            return Ok(None);
        };
        let asked = |table| modbus::codec::read(self.map.unit, table, address, count);
        let (holding, input) = (asked(Table::Holding), asked(Table::Input));
        let table = match self.words(&holding) {
            Err(DeviceFault::Refused { .. }) => self.words(&input).map(|_| Table::Input)?,
            answer => answer.map(|_| Table::Holding)?,
        };
        Ok(Some(Register { address, table }))
    }

    fn read(
        &mut self,
        measured: Measured,
        register: Register,
    ) -> Result<RegisterReading, DeviceFault> {
        let (unit, bound) = unit_and_bound(&self.map, measured);
        let question = modbus::codec::read(
            self.map.unit,
            register.table,
            register.address,
            modbus::codec::width(self.map.number),
        );
        let (words, raw) = self.words(&question)?;
        match value_of(self.map.number, &words, unit, bound) {
            Some(value) => {
                let words = Registers {
                    words: &words,
                    unit,
                };
                self.order
                    .read(measured, words, |other| plausible(other, bound));
                Ok(RegisterReading { value, raw })
            }
            None => Err(DeviceFault::Impossible {
                raw,
                reason: no_number(self.map.number).to_owned(),
            }),
        }
    }

    /// The words of the answer to a question, and its bytes.
    fn words(&mut self, question: &[u8]) -> Result<(Vec<u16>, Vec<u8>), DeviceFault> {
        let gap = self.gap;
        fresh(&mut self.client, |client| exchange(client, question, gap))
    }

    fn write(&mut self, frame: &[u8]) -> Result<(), DeviceFault> {
        let gap = self.gap;
        order(&mut self.client, |client| exchange(client, frame, gap)).map(|_| ())
    }

    fn stop_frame(&self) -> Option<Vec<u8>> {
        self.map
            .command
            .map(|command| modbus::codec::write(self.map.unit, command, &[self.map.stop_word]))
    }
}

impl Device for Modbus {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        if self.position.is_none() && self.force.is_none() {
            return Err(unfit(
                "its map has no register for the position or the force",
            ));
        }
        if self.map.target.is_some() && self.position.is_none() {
            return Err(unfit(
                "its map has a target, but no register for the position",
            ));
        }
        let width = modbus::codec::width(self.map.number);
        self.position = self.find(self.position, width)?;
        self.force = self.find(self.force, width)?;
        self.status = self.find(self.status, 1)?;
        self.sample()?;
        Ok(introduced(&self.map))
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        let (map, target) = (&self.map, one_axis(targets)?);
        let registers = |target| encode_quantity(map.number, target, map.length_unit, f64::round);
        let target = self.order.target(target, map.length_unit, registers)?;
        frames(map, target, speed)
    }

    fn rounds_first_target(&self) -> bool {
        self.order.is_open()
    }

    fn narrow_limits(&mut self, limits: &[Limits]) -> Result<(), DeviceFault> {
        if let [limits] = limits {
            self.order.limited(*limits);
        }
        Ok(())
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        going.frames.iter().try_for_each(|frame| self.write(frame))
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let (mut sample, mut axis) = (Sample::default(), Channel::default());
        if let Some(register) = self.position {
            let RegisterReading { value, raw } = self.read(Measured::Position, register)?;
            axis.displacement = Some(value);
            sample.raw.push(raw);
        }
        if let Some(register) = self.force {
            let RegisterReading { value, raw } = self.read(Measured::Force, register)?;
            axis.force = Some(Force::Newtons(value));
            sample.raw.push(raw);
        }
        if let Some(register) = self.status {
            let (words, raw) = self.words(&modbus::codec::read(
                self.map.unit,
                register.table,
                register.address,
                1,
            ))?;
            sample.moving = words.first().map(|word| word & self.map.moving_mask != 0);
            sample.raw.push(raw);
        }
        sample.channels = vec![axis];
        Ok(sample)
    }

    /// Sends the stop word; a drive without a command register receives its present position as target.
    fn hold(&mut self) -> Result<(), DeviceFault> {
        let frame = if let Some(frame) = self.stop_frame() {
            frame
        } else {
            let register = self
                .position
                .ok_or_else(|| unfit("its map has no register to stop it"))?;
            // A line that is one answer behind gives the answer to the question before: only the second one is the position.
            self.read(Measured::Position, register)?;
            let here = self.read(Measured::Position, register)?.value;
            target_frame(&self.map, here)?.0
        };
        self.write(&frame)
    }

    fn emergency(&self) -> Vec<u8> {
        self.stop_frame().unwrap_or_default()
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

/// The message for registers whose number is implausible.
const fn no_number(number: ModbusNumber) -> &'static str {
    match number {
        ModbusNumber::Int16 => {
            "it holds an impossible number: check the register and the kind of number"
        }
        _ => "it holds an impossible number: check the register order and the kind of number",
    }
}

/// The identity of this unit.
pub fn introduced(map: &ModbusMap) -> DeviceIdentity {
    DeviceIdentity {
        model: format!("Modbus unit {}", map.unit),
        ..DeviceIdentity::default()
    }
}

/// The frames of a move to `target` \[m\] at a speed not above `speed` \[m/s\], and their decoded values. A drive with
/// swapped words reads a speed of almost zero: the second word of the speed is 0.
fn frames(map: &ModbusMap, target: f64, speed: f64) -> Result<DeviceMove, DeviceFault> {
    let slower = if is_float(map.number) {
        modbus::codec::without_low_word(speed / map.speed_unit) * map.speed_unit
    } else {
        speed
    };
    frames_at_speed(map, target, slower)
}

/// The same at exactly this speed, within the resolution of the registers.
fn frames_at_speed(map: &ModbusMap, target: f64, speed: f64) -> Result<DeviceMove, DeviceFault> {
    let (target_frame, target) = target_frame(map, target)?;
    let mut going = DeviceMove {
        frames: Vec::new(),
        targets: vec![target],
        speed,
        id: None,
    };
    // Before the target, because some drives start as soon as they receive one.
    if let Some(register) = map.speed {
        let (words, encoded) = encode_speed(map, speed)?;
        going
            .frames
            .push(modbus::codec::write(map.unit, register, &words));
        going.speed = encoded;
    }
    going.frames.push(target_frame);
    if let Some(command) = map.command {
        going
            .frames
            .push(modbus::codec::write(map.unit, command, &[map.start_word]));
    }
    Ok(going)
}

fn target_frame(map: &ModbusMap, target: f64) -> Result<(Vec<u8>, f64), DeviceFault> {
    let register = map
        .target
        .ok_or_else(|| unfit("it has no target register: it cannot move"))?;
    let (words, encoded) = encode_quantity(map.number, target, map.length_unit, f64::round)?;
    Ok((modbus::codec::write(map.unit, register, &words), encoded))
}

/// The registers of a quantity, and their decoded value; `whole` rounds for integer registers.
fn encode_quantity(
    number: ModbusNumber,
    quantity: f64,
    unit: f64,
    whole: fn(f64) -> f64,
) -> Result<(Vec<u16>, f64), DeviceFault> {
    let value = quantity / unit;
    let value = if is_float(number) || same(value.round(), value) {
        value
    } else {
        whole(value)
    };
    let words = modbus::codec::to_words(number, value)
        .ok_or_else(|| unfit("its registers cannot hold the number"))?;
    let encoded = modbus::codec::from_words(number, &words)
        .ok_or_else(|| unfit("its registers cannot hold the number"))?
        * unit;
    // A difference in the last bit by the unit conversion is ignored.
    Ok((
        words,
        if same(encoded, quantity) {
            quantity
        } else {
            encoded
        },
    ))
}

/// Registers of a speed that does not exceed the requested one.
fn encode_speed(map: &ModbusMap, speed: f64) -> Result<(Vec<u16>, f64), DeviceFault> {
    let (words, encoded) = encode_quantity(map.number, speed, map.speed_unit, f64::floor)?;
    if encoded <= speed {
        return if encoded > 0.0 {
            Ok((words, encoded))
        } else {
            Err(unfit("its registers cannot hold a speed so low"))
        };
    }
    // A short float may exceed it by half its last bit.
    encode_quantity(
        map.number,
        speed * (1.0 - f64::from(f32::EPSILON)),
        map.speed_unit,
        f64::floor,
    )
}

/// \[m\] or \[N\], if the registers hold a plausible number.
fn value_of(number: ModbusNumber, words: &[u16], unit: f64, bound: f64) -> Option<f64> {
    modbus::codec::from_words(number, words)
        .map(|value| value * unit)
        .filter(|value| plausible(*value, bound))
}

/// The unit of a quantity, and the bound of its plausible values \[m\] or \[N\].
const fn unit_and_bound(map: &ModbusMap, measured: Measured) -> (f64, f64) {
    match measured {
        Measured::Position => (map.length_unit, IMPLAUSIBLE_POSITION),
        Measured::Force => (map.force_unit, IMPLAUSIBLE_FORCE),
    }
}

/// The reading of one answer for each register of the map: position, force, status.
pub fn decoded(map: &ModbusMap, answers: &[Vec<u8>]) -> Option<Sample> {
    let mut answers = answers.iter();
    let mut next = |register: Option<u16>, measured: Measured| -> Option<Option<f64>> {
        let Some(address) = register else {
            return Some(None);
        };
        let answer = answers.next()?;
        let width = modbus::codec::width(map.number);
        let (unit, bound) = unit_and_bound(map, measured);
        let tables = [Table::Holding, Table::Input].into_iter();
        let mut questions =
            tables.map(|table| modbus::codec::read(map.unit, table, address, width));
        let words = questions.find_map(|question| modbus::codec::answer(&question, answer).ok())?;
        value_of(map.number, &words, unit, bound).map(Some)
    };
    let axis = Channel {
        displacement: next(map.position, Measured::Position)?,
        force: next(map.force, Measured::Force)?.map(Force::Newtons),
        ..Channel::default()
    };
    Some(Sample {
        channels: vec![axis],
        ..Sample::default()
    })
}

/// One question or command and its answer, after the silence that ends earlier traffic.
fn exchange(
    client: &mut LineClient,
    question: &[u8],
    gap: f64,
) -> Result<(Vec<u16>, Vec<u8>), DeviceFault> {
    clear(client, gap)?;
    client.send(question)?;
    let deadline = client.now() + client.reply_timeout();
    let mut received = Vec::new();
    let answer = loop {
        let missing = match modbus::codec::answer_length(question, &received) {
            Ok(Some(length)) if length == received.len() => {
                break modbus::codec::answer(question, &received);
            }
            Ok(Some(length)) => length - received.len(),
            Ok(None) => 1,
            Err(fault) => break Err(fault),
        };
        match client.exactly(missing, deadline) {
            Ok(bytes) => received.extend(bytes),
            Err(missed) => {
                client.line_statistics_mut().ignored += u64::from(!received.is_empty());
                return Err(fault(missed, client));
            }
        }
    };
    match answer {
        Ok(words) => Ok((words, received)),
        Err(FrameFault::Exception(code)) => Err(DeviceFault::Refused {
            reason: format!("{} (exception {code})", modbus::codec::exception(code)),
        }),
        Err(FrameFault::Broken(_)) => {
            client.line_statistics_mut().ignored += 1;
            Err(DeviceFault::Silent {
                seconds: client.reply_timeout(),
            })
        }
    }
}

fn plausible(value: f64, bound: f64) -> bool {
    value == 0.0 || (IMPLAUSIBLY_SMALL <= value.abs() && value.abs() <= bound)
}

/// Equal except for the last bits of a unit conversion.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 4.0 * f64::EPSILON * b.abs()
}

const fn is_float(number: ModbusNumber) -> bool {
    matches!(number, ModbusNumber::Float32 { .. })
}

fn unfit(reason: &str) -> DeviceFault {
    DeviceFault::Unfit(reason.to_owned())
}

#[cfg(test)]
mod tests;
