//! The limits of a native rig, in the units of its protocol. In: the settings of bench and rig, or the words of `LIM`. Out: limits of
//! each axis. They stop nothing themselves.

use super::NativeSettings;
use super::frame::decimal;
use crate::emulator::EmulatedRig;
use psd_plan::Interval;

/// Value that stands for an absent limit: mm and mm/s, N.
const NO_LIMIT_MM: f64 = 999.0;
const NO_LIMIT_N: f64 = 99_999.0;

/// Limits in the units of the protocol.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    pub(super) axes: Vec<AxisBounds>,
    /// mm/s
    pub(super) top_speed: f64,
}

/// mm and N
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisBounds {
    pub(super) displacement: (f64, f64),
    pub(super) force: (f64, f64),
}

impl Bounds {
    /// The limits of the rig itself, as its emulated rig and its settings state them.
    pub(super) fn of_rig(
        settings: &NativeSettings,
        actuators: &[usize],
        rig: &EmulatedRig,
    ) -> Self {
        let axis = |(axis, actuator): (usize, &usize)| {
            let position = rig.limits_of(*actuator);
            let own = settings.force_limits.get(axis).copied();
            let force = own.unwrap_or(Interval::ALL);
            AxisBounds {
                displacement: (millimetres(position.low), millimetres(position.high)),
                force: (newtons(force.low), newtons(force.high)),
            }
        };
        Self {
            axes: actuators.iter().enumerate().map(axis).collect(),
            top_speed: millimetres(rig.settings().top_speed),
        }
    }
}

/// A length \[m\] or speed \[m/s\] in the unit of the protocol, rounded as it is sent.
fn millimetres(value: f64) -> f64 {
    rounded(finite(value * 1e3, NO_LIMIT_MM), 1e6)
}

/// A force \[N\], rounded as it is sent.
fn newtons(value: f64) -> f64 {
    rounded(finite(value, NO_LIMIT_N), 1e3)
}

/// A limit; `absent` with its sign if there is none.
fn finite(value: f64, absent: f64) -> f64 {
    if value.is_finite() {
        value
    } else {
        absent.copysign(value)
    }
}

/// A number to the decimals that `scale` keeps.
fn rounded(value: f64, scale: f64) -> f64 {
    (value * scale).round() / scale
}

impl AxisBounds {
    /// Parses the four words of an axis.
    pub(super) fn parse(words: &[&str]) -> Option<Self> {
        let [low, high, least, most] = words else {
            return None;
        };
        Some(Self {
            displacement: (decimal(low)?, decimal(high)?),
            force: (decimal(least)?, decimal(most)?),
        })
    }

    pub(super) fn narrower_than(&self, own: &Self) -> bool {
        let within = |(low, high): (f64, f64), (least, most): (f64, f64)| {
            least <= low && low <= high && high <= most
        };
        within(self.displacement, own.displacement) && within(self.force, own.force)
    }
}
