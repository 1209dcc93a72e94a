//! Protocol drivers, one folder per controller. A [`Device`] turns SI into bytes and back. It knows
//! no settling, limit, median or record: those are in `rig/real` and `rig/guard`.

mod composite;
mod line_client;
mod load_cell;
mod open;
mod request_reply;
mod stream;
mod unsequenced;

use crate::physics::tracking::trajectory::Path;
use crate::plan::Limits;

use super::{LastMove, Tally};

pub use composite::{Member, together};
pub use grbl::driver::GrblDevice;
pub use hx711::driver::Hx711Device;
pub use indicator::driver::IndicatorDevice;
pub use instron::driver::Instron;
pub use line_client::{Answer, LONGEST_LINE, Missed, SLICE, Talk};
pub use load_cell::Gauge;
pub use mark10::driver::Mark10;
pub use mark10::load_cell::Mark10Gauge;
pub use modbus::driver::Modbus;
pub use native::driver::{NativeDevice, SIMULATED, native_identity};
pub use nees::driver::Nees;
pub use open::open;
pub use scpi::driver::ScpiDevice;

/// Who a device says it is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceIdentity {
    pub model: String,
    pub serial: String,
    pub firmware: String,
    /// Random word of this power-up.
    pub boot: Option<String>,
    /// It says itself that it is a stand-in.
    pub simulated: bool,
    /// The replies in which it said all this; empty where its dialect has none.
    pub raw: Vec<Vec<u8>>,
}

/// A move in the device's own words.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// What is sent, in this order; each waits for its answer.
    pub frames: Vec<Vec<u8>>,
    /// One an axis, m, read back from the bytes.
    pub targets: Vec<f64>,
    /// m/s, of the axis with the farthest way; read back from the bytes, or as asked where they carry none.
    pub speed: f64,
    /// Where the device remembers it.
    pub id: Option<u64>,
}

/// One answer to "where are you and what do you feel": what a device does not know is None.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// The device's own clock, s.
    pub time: Option<f64>,
    /// Of its first axis, m.
    pub displacement: Option<f64>,
    /// Of its first axis.
    pub force: Option<Force>,
    /// Whether it says that any axis still moves.
    pub moving: Option<bool>,
    /// Of its first axis, and of itself.
    pub flags: Flags,
    /// Its other axes, in order; most devices have none.
    pub others: Vec<Channel>,
    /// The bytes of the answer, one entry a reply.
    pub raw: Vec<Vec<u8>>,
}

impl Sample {
    /// How many axes it speaks of.
    pub fn axis_count(&self) -> usize {
        1 + self.others.len()
    }

    /// Every axis, in order.
    pub fn axes(&self) -> impl Iterator<Item = Channel> + '_ {
        std::iter::once(self.first()).chain(self.others.iter().copied())
    }

    /// The axis at this place, which is one of them.
    #[must_use]
    pub fn axis(&self, place: usize) -> Channel {
        place
            .checked_sub(1)
            .map_or_else(|| self.first(), |other| self.others[other])
    }

    const fn first(&self) -> Channel {
        Channel {
            displacement: self.displacement,
            force: self.force,
            flags: self.flags,
        }
    }
}

/// What one axis of a device says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel {
    /// m
    pub displacement: Option<f64>,
    pub force: Option<Force>,
    pub flags: Flags,
}

/// Force as the device gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    Newtons(f64),
    /// Raw counts, with the lowest and highest the converter knows.
    Counts {
        count: i64,
        low: i64,
        high: i64,
    },
}

/// What a device says of itself beside its reading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a bit of a status word of its own"
)]
pub struct Flags {
    pub saturated: bool,
    pub stale: bool,
    pub limit_high: bool,
    pub limit_low: bool,
    pub emergency_stop: bool,
    pub unreferenced: bool,
    /// The device itself says its reading has not settled.
    pub unsettled: bool,
    pub watchdog_tripped: bool,
}

/// What the record of a run says where a device has lost its position.
pub const NOT_TRUSTED: &str = "its position is not to be trusted";

/// Why a device did not do what it was asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeviceFault {
    /// The same frame was sent again and again, and nothing usable came.
    #[error("no usable answer within {} s", (.seconds * 100.0).round() / 100.0)]
    Silent { seconds: f64 },
    #[error("the line is gone: {reason}")]
    Lost { reason: String },
    /// The device said no.
    #[error("refused: {reason}")]
    Refused { reason: String },
    /// It started anew, so that its position is not to be trusted.
    #[error("the device started anew ({was} became {is}): {NOT_TRUSTED}")]
    Rebooted { was: String, is: String },
    /// An answer came that is no reading: not to be used, may be asked again.
    #[error("`{}` is no reading: {reason}", raw.escape_ascii())]
    NoReading { raw: Vec<u8>, reason: String },
    /// A reply that came whole holds no number that can be: no fault of the line.
    #[error("`{}` is no reading: {reason}", raw.escape_ascii())]
    Impossible { raw: Vec<u8>, reason: String },
    /// The device is not set up as it must be, or cannot do this.
    #[error("{0}")]
    Unfit(String),
    /// A person wants the rig held now.
    #[error("held on request")]
    Interrupted,
}

/// One device on one port. All calls end within a bounded time. One that only weighs is a [`Gauge`].
pub trait Device: Send {
    /// Opens the conversation: asks who it is, checks that it is set up as it must be. Moves nothing.
    ///
    /// # Errors
    /// It does not answer, or is not fit.
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault>;

    /// How many axes it moves or weighs, from `identify`.
    fn axes(&self) -> usize {
        1
    }

    /// The bytes of a move to `targets` (m, absolute, one an axis) at `speed` (m/s, of the axis with the farthest way; all
    /// arrive at once), and what they say when read back. Sends nothing.
    ///
    /// # Errors
    /// The device cannot move, has another number of axes, or cannot say this.
    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<Move, DeviceFault>;

    /// Sends a move and gives back once it is accepted, not when it is done.
    ///
    /// # Errors
    /// It was refused or not heard.
    fn start(&mut self, going: &Move) -> Result<(), DeviceFault>;

    /// Asks whether it would carry out this move, where it can be asked: nothing moves yet.
    ///
    /// # Errors
    /// It refuses, or was not heard.
    fn offer(&mut self, _going: &Move) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// Takes back what was offered and not begun.
    ///
    /// # Errors
    /// It was not heard.
    fn withdraw(&mut self, _going: &Move) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// Begins what was offered, without waiting for its end.
    ///
    /// # Errors
    /// As `start`.
    fn begin(&mut self, going: &Move) -> Result<(), DeviceFault> {
        self.start(going)
    }

    /// Waits for the end of what was begun, where the device tells it.
    ///
    /// # Errors
    /// As `start`.
    fn finish(&mut self, _going: &Move) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// Of a device that is several: which of them the last fault is of.
    fn culprit(&self) -> Option<usize> {
        None
    }

    /// The bytes of a way along smooth paths, one an axis and equally long, whose ends are passed and not stopped at; what
    /// they say of the ends when read back, with the fastest of the speeds. Sends nothing.
    ///
    /// # Errors
    /// As `encode`; most devices follow no path.
    fn encode_way(&mut self, _paths: &[Path]) -> Result<Move, DeviceFault> {
        Err(DeviceFault::Unfit(
            "it goes to targets, and follows no path without stopping".to_owned(),
        ))
    }

    /// Sends a way and gives back once it is accepted: how long it is to its end, s.
    ///
    /// # Errors
    /// It was refused, came too late, or was not heard.
    fn set_out(&mut self, going: &Move) -> Result<f64, DeviceFault> {
        self.start(going).map(|()| 0.0)
    }

    /// Asks once for a reading of every axis; a reply that is none is [`DeviceFault::NoReading`].
    ///
    /// # Errors
    /// As every call.
    fn sample(&mut self) -> Result<Sample, DeviceFault>;

    /// Stops and keeps the load, as soon as it can be said.
    ///
    /// # Errors
    /// It could not be said; the caller has [`Device::emergency`] left.
    fn hold(&mut self) -> Result<(), DeviceFault>;

    /// Bytes that stop the device whatever it is doing, sent without waiting for an answer. Empty: there are none.
    fn emergency(&self) -> Vec<u8>;

    /// Tells the device the limits of this run, one entry an axis, where it can hold them too: most keep none but their own. It may
    /// only narrow those.
    ///
    /// # Errors
    /// It refuses them.
    fn narrow_limits(&mut self, _limits: &[Limits]) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// The last move it remembers, from `identify`.
    fn last_move(&self) -> Option<LastMove> {
        None
    }

    /// What was mended on the line so far.
    fn tally(&self) -> Tally;
}

/// The target of a device that moves one axis.
fn one_axis(targets: &[f64]) -> Result<f64, DeviceFault> {
    match targets {
        [target] => Ok(*target),
        _ => Err(DeviceFault::Unfit(format!(
            "it moves one axis, not {}",
            targets.len()
        ))),
    }
}

pub mod codec;
pub mod grbl;
pub mod hx711;
pub mod indicator;
pub mod instron;
pub mod mark10;
#[cfg(test)]
mod meeting_tests;
pub mod modbus;
pub mod native;
pub mod nees;
pub mod number;
pub mod scpi;
