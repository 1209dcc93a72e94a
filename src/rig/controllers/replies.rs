//! The replies of a device in a run log. In: its protocol, and the replies to one reading. Out: the numbers that its driver made of
//! them. It asks nothing.

use super::{Channel, Sample, grbl, hx711, indicator, mark10, modbus, native, nees, scpi};
use psd_plan::Dialect;

/// Number of replies to one reading of a device. None: its replies are not decoded again.
#[must_use]
pub fn replies_to_reading(dialect: &Dialect) -> Option<usize> {
    match dialect {
        Dialect::Native
        | Dialect::Grbl
        | Dialect::Hx711
        | Dialect::Indicator
        | Dialect::Scpi { .. }
        | Dialect::Mark10Gauge => Some(1),
        Dialect::Mark10 => Some(3),
        Dialect::Modbus(map) => {
            let registers = [map.position, map.force, map.status];
            Some(registers.iter().flatten().count())
        }
        Dialect::Nees { control_points } => Some(control_points.len()),
        // The number of its replies depends on earlier ones: it repeats a question after an unexpected zero or stop.
        Dialect::Instron => None,
    }
}

/// The channels of one reading of a device with this number of axes. None: the replies are not a reading.
#[must_use]
pub fn decoded(dialect: &Dialect, axes: usize, replies: &[Vec<u8>]) -> Option<Vec<Channel>> {
    let first = replies.first()?.clone();
    let sample: Option<Sample> = match dialect {
        Dialect::Native => native::codec::reply(&first)
            .ok()
            .and_then(|reply| native::driver::decoded(reply, axes).ok()),
        Dialect::Grbl => grbl::driver::decoded(first),
        Dialect::Hx711 => hx711::driver::decoded(first).ok(),
        Dialect::Indicator => indicator::driver::decoded(first).ok(),
        Dialect::Scpi { newtons_per_unit } => scpi::driver::decoded(first, newtons_per_unit).ok(),
        Dialect::Mark10Gauge => mark10::load_cell::decoded(first).ok(),
        Dialect::Mark10 => mark10::driver::decoded(replies),
        Dialect::Modbus(map) => modbus::driver::decoded(map, replies),
        Dialect::Nees { control_points } => nees::driver::decoded(control_points, replies),
        Dialect::Instron => None,
    };
    sample.map(|sample| sample.channels)
}
