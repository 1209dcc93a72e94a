//! The bytes of one device on record, read back for who proves that record. In: replies as they came, in order; the bytes of a
//! move. Out: every reading that the replies can be, with the very numbers that the driver made of them; whether the bytes say
//! the move. It asks nothing, and knows no rig and no record.

use super::mark10::load_cell;
use super::{DeviceFault, DeviceIdentity, Sample};
use crate::plan::Dialect;
use crate::rig::controllers::grbl::codec::jog;
use crate::rig::controllers::instron::codec::{Movement, movement, number, status};
use crate::rig::controllers::mark10::codec as stand;
use crate::rig::controllers::native::codec::{Kind, hello, reply};
use crate::rig::controllers::native::sent::SentMove;
use crate::rig::controllers::{
    grbl, hx711, indicator, instron, mark10, modbus, native, nees, scpi,
};
use crate::rig::safety::failpoint::{Guarding, on};

/// What some of the next replies can be.
#[derive(Clone, Debug, PartialEq)]
pub enum Heard {
    /// So many of them are a reading.
    Reading { replies: usize, sample: Sample },
    /// The next one is none, and all is asked again. What was heard before it in the same reading is not on record.
    NoReading,
}

/// What is known of a device from what it was asked when the conversation began.
#[derive(Clone, Debug)]
pub struct Teller<'a> {
    dialect: &'a Dialect,
    /// Axes behind it.
    axes: usize,
    /// Word of the power-up.
    boot: Option<String>,
    /// Of position (m) and load (N), where the replies are fractions of it.
    full_scales: Option<[f64; 2]>,
}

impl<'a> Teller<'a> {
    /// A device behind which are so many axes, of which nothing is known yet.
    #[must_use]
    pub const fn new(dialect: &'a Dialect, axes: usize) -> Self {
        Self {
            dialect,
            axes,
            boot: None,
            full_scales: None,
        }
    }

    /// Replies in which it says who it is.
    #[must_use]
    pub const fn introductions(&self) -> usize {
        match self.dialect {
            Dialect::Native | Dialect::Scpi { .. } | Dialect::Grbl | Dialect::Nees { .. } => 1,
            Dialect::Instron => 2,
            Dialect::Hx711
            | Dialect::Indicator
            | Dialect::Mark10
            | Dialect::Mark10Gauge
            | Dialect::Modbus(_) => 0,
        }
    }

    /// Who it is that said this of itself; None: it said nothing of the kind.
    pub fn introduced(&mut self, replies: &[Vec<u8>]) -> Option<DeviceIdentity> {
        let first = replies.first().map(Vec::as_slice).unwrap_or_default();
        match self.dialect {
            Dialect::Native => {
                let reply = reply(first).ok()?;
                let hello =
                    hello(&reply.words()).filter(|hello| hello.bounds.axes.len() == self.axes)?;
                self.boot = Some(reply.boot().to_owned());
                Some(native::driver::native_identity(&hello, self.boot.clone()))
            }
            Dialect::Scpi { .. } => scpi::driver::introduced(first),
            Dialect::Grbl => grbl::driver::introduced(first),
            Dialect::Nees { control_points } => nees::driver::introduced(control_points, first),
            Dialect::Instron => {
                let [position, load] = replies else {
                    return None;
                };
                self.full_scales = Some([number(position)?, number(load)?]);
                Some(instron::driver::introduced(replies.to_vec()))
            }
            Dialect::Hx711 => Some(hx711::driver::introduced()),
            Dialect::Indicator => Some(indicator::driver::introduced()),
            Dialect::Mark10 => Some(mark10::driver::stand_introduced()),
            Dialect::Mark10Gauge => Some(load_cell::introduced()),
            Dialect::Modbus(map) => Some(modbus::driver::introduced(map)),
        }
    }

    /// Whether enough is known to read its bytes back.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        !matches!(self.dialect, Dialect::Instron) || self.full_scales.is_some()
    }

    /// What the first of these replies can be: nothing, where they are none of this device's.
    #[must_use]
    pub fn hears(&self, replies: &[Vec<u8>]) -> Vec<Heard> {
        let Some(first) = replies.first() else {
            return Vec::new();
        };
        match self.dialect {
            Dialect::Native => {
                let data = reply(first).ok().filter(|reply| {
                    reply.kind == Kind::Data && self.is_of_this_power_up(reply.boot())
                });
                data.map_or_else(Vec::new, |reply| {
                    alone(native::driver::decoded(reply, self.axes))
                })
            }
            Dialect::Grbl => grbl::driver::decoded(first.clone())
                .into_iter()
                .map(|sample| Heard::Reading { replies: 1, sample })
                .collect(),
            Dialect::Hx711 => alone(hx711::driver::decoded(first.clone())),
            Dialect::Indicator => alone(indicator::driver::decoded(first.clone())),
            Dialect::Scpi { newtons_per_unit } => {
                alone(scpi::driver::decoded(first.clone(), newtons_per_unit))
            }
            Dialect::Mark10Gauge => alone(load_cell::weighed(first.clone())),
            Dialect::Mark10 => of_stand(replies),
            Dialect::Instron => self
                .full_scales
                .map_or_else(Vec::new, |full_scales| of_console(replies, full_scales)),
            Dialect::Modbus(map) => of_registers(replies, map),
            Dialect::Nees { control_points } => of_control_points(replies, control_points),
        }
    }

    fn is_of_this_power_up(&self, boot: &str) -> bool {
        self.boot.as_ref().is_none_or(|own| own == boot) || !on(Guarding::Reboot)
    }

    /// Whether some bytes say a move to these places (m, one an axis, in the device's own directions) at this speed (m/s), by
    /// this number.
    #[must_use]
    pub fn sent(&self, wire: &[u8], targets: &[f64], speed: f64, id: Option<u64>) -> bool {
        let [first, ..] = targets else { return false };
        let numbered = matches!(self.dialect, Dialect::Native);
        let sent = match self.dialect {
            Dialect::Native => SentMove::of(wire)
                .is_some_and(|sent| sent.says(targets, speed) && Some(sent.id) == id),
            Dialect::Grbl => jog(*first, speed).is_ok_and(|jog| {
                let said =
                    [jog.target, jog.speed].map(f64::to_bits) == [*first, speed].map(f64::to_bits);
                said && jog.line == wire
            }),
            Dialect::Instron => self
                .full_scales
                .is_none_or(|[full_scale, _]| instron::driver::sends(wire, *first, full_scale)),
            Dialect::Mark10 => mark10::driver::sends(wire, *first, speed),
            Dialect::Modbus(map) => modbus::driver::sends(wire, map, *first, speed),
            Dialect::Nees { control_points } => nees::driver::sends(wire, control_points, targets),
            Dialect::Hx711 | Dialect::Indicator | Dialect::Scpi { .. } | Dialect::Mark10Gauge => {
                false
            }
        };
        sent && (numbered || id.is_none())
    }
}

/// Of one reply.
fn alone(decoded: Result<Sample, DeviceFault>) -> Vec<Heard> {
    match decoded {
        Ok(sample) => vec![Heard::Reading { replies: 1, sample }],
        Err(DeviceFault::NoReading { .. } | DeviceFault::Impossible { .. }) => {
            vec![Heard::NoReading]
        }
        Err(_) => Vec::new(),
    }
}

/// Status, travel and force of a stand.
fn of_stand(replies: &[Vec<u8>]) -> Vec<Heard> {
    let mut heard = Vec::new();
    if let [said_status, said_travel, said_force, ..] = replies
        && let (Some(status), Some(travel), Ok(force)) = (
            stand::status(said_status),
            stand::travel(said_travel),
            mark10::driver::newtons(said_force),
        )
    {
        let (displacement, force, moving) = (Some(travel), Some(force), Some(status.moving));
        heard.push(Heard::Reading {
            replies: 3,
            sample: Sample {
                displacement,
                force,
                moving,
                ..Sample::default()
            },
        });
    }
    // Any of the three may have been none.
    if replies.first().is_some_and(|first| {
        stand::status(first).is_none()
            || stand::travel(first).is_none()
            || mark10::driver::newtons(first).is_err()
    }) {
        heard.push(Heard::NoReading);
    }
    heard
}

/// Status, movement, position and load of a console. A stop and a zero may have been asked again: which were depends on what was
/// asked between the readings.
fn of_console(replies: &[Vec<u8>], [position_scale, load_scale]: [f64; 2]) -> Vec<Heard> {
    let mut heard = Vec::new();
    let is =
        |at: usize, holds: fn(&[u8]) -> bool| replies.get(at).is_some_and(|reply| holds(reply));
    if is(0, |reply| status(reply).is_some()) {
        for (at, moving) in movements(replies, 1) {
            for (at, position) in numbers(replies, at) {
                for (at, load) in numbers(replies, at) {
                    let sample = Sample {
                        displacement: Some(position * position_scale),
                        force: Some(super::Force::Newtons(load * load_scale)),
                        moving: Some(moving == Movement::Running),
                        ..Sample::default()
                    };
                    let reading = Heard::Reading {
                        replies: at,
                        sample,
                    };
                    if !heard.contains(&reading) {
                        heard.push(reading);
                    }
                }
            }
        }
    }
    if is(0, |reply| {
        status(reply).is_none() || movement(reply).is_none() || number(reply).is_none()
    }) {
        heard.push(Heard::NoReading);
    }
    heard
}

/// Movements that can begin at a place, and where what follows them does.
fn movements(replies: &[Vec<u8>], at: usize) -> Vec<(usize, Movement)> {
    let said = |at: usize| replies.get(at).and_then(|reply| movement(reply));
    let first = said(at).map(|movement| (at + 1, movement));
    let again = first
        .filter(|(_, first)| *first == Movement::Stopped)
        .and_then(|_| said(at + 1));
    first
        .into_iter()
        .chain(again.map(|movement| (at + 2, movement)))
        .collect()
}

/// The same of numbers.
fn numbers(replies: &[Vec<u8>], at: usize) -> Vec<(usize, f64)> {
    let said = |at: usize| replies.get(at).and_then(|reply| number(reply));
    let first = said(at).map(|number| (at + 1, number));
    let again = first
        .filter(|(_, first)| *first == 0.0)
        .and_then(|_| said(at + 1));
    first
        .into_iter()
        .chain(again.map(|number| (at + 2, number)))
        .collect()
}

/// Position, force and status, as far as the map has them.
fn of_registers(replies: &[Vec<u8>], map: &crate::plan::ModbusMap) -> Vec<Heard> {
    let (mut next, mut sample, mut whole, mut none) = (0, Sample::default(), true, false);
    if map.position.is_some() {
        let said = replies
            .get(next)
            .and_then(|answer| modbus::driver::position_in(map, answer));
        (next, sample.displacement, whole) =
            (next + 1, said.flatten(), whole && said.flatten().is_some());
        none |= said == Some(None);
    }
    if map.force.is_some() {
        let said = replies
            .get(next)
            .and_then(|answer| modbus::driver::force_in(map, answer));
        (next, sample.force, whole) = (
            next + 1,
            said.flatten().map(super::Force::Newtons),
            whole && said.flatten().is_some(),
        );
        none |= replies
            .first()
            .and_then(|answer| modbus::driver::force_in(map, answer))
            == Some(None);
    }
    if map.status.is_some() {
        whole &= replies
            .get(next)
            .is_some_and(|answer| modbus::driver::is_status(map, answer));
        next += 1;
    }
    let reading = whole.then_some(Heard::Reading {
        replies: next,
        sample,
    });
    reading
        .into_iter()
        .chain(none.then_some(Heard::NoReading))
        .collect()
}

/// A reply for each control point.
fn of_control_points(replies: &[Vec<u8>], control_points: &[String]) -> Vec<Heard> {
    let said: Vec<Option<(f64, f64)>> = replies
        .iter()
        .zip(control_points)
        .map(|(reply, point)| nees::driver::decoded(reply, point))
        .collect();
    let points: Option<Vec<(f64, f64)>> = said.into_iter().collect();
    let points = points.filter(|points| points.len() == control_points.len());
    let reading = points.map(|points| Heard::Reading {
        replies: points.len(),
        sample: nees::driver::sample_of(&points, Vec::new()),
    });
    // Of whichever of them the first reply was to have been.
    let first = replies.first().map(Vec::as_slice).unwrap_or_default();
    let none = control_points
        .iter()
        .any(|point| nees::driver::decoded(first, point).is_none());
    reading
        .into_iter()
        .chain(none.then_some(Heard::NoReading))
        .collect()
}
