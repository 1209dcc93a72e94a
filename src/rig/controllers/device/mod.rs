//! A device on one port: the trait that every driver implements, and the types that it exchanges with the rig. It knows no
//! protocol.

mod composite;
mod load_cell;

use crate::{LastMove, LineStatistics};
use psd_physics::tracking::trajectory::Path;
use psd_plan::{AxialAxis, Interval, Limits};

pub use composite::{Member, together};
pub use load_cell::LoadCell;

/// The identity that a device reports.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceIdentity {
    pub model: String,
    pub serial: String,
    pub firmware: String,
    /// Random boot identifier of this power-up.
    pub boot: Option<String>,
    /// The device reports that it is an emulator.
    pub simulated: bool,
    /// The replies with its identity. Empty if its protocol has none.
    pub raw: Vec<Vec<u8>>,
}

/// A move encoded for the device.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceMove {
    /// The frames to be sent, in this order. Each waits for its answer.
    pub frames: Vec<Vec<u8>>,
    /// One per axis \[m\], decoded from the bytes.
    pub targets: Vec<f64>,
    /// \[m/s\], of the axis with the longest travel. Decoded from the bytes, or as requested if they carry no speed.
    pub speed: f64,
    /// The number of the move, if the device remembers it.
    pub id: Option<u64>,
}

/// One reading of a device. A quantity that the device does not report is None.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// The device's own clock \[s\].
    pub time: Option<f64>,
    /// Whether it reports that any axis still moves.
    pub moving: Option<bool>,
    /// Its axes, in order.
    pub channels: Vec<Channel>,
    /// The bytes of the answer, one entry a reply.
    pub raw: Vec<Vec<u8>>,
}

impl Sample {
    /// The force of a device that measures one axis, from one reply.
    pub fn of_force(force: Force, flags: Flags, reply: Vec<u8>) -> Self {
        let channel = Channel {
            displacement: None,
            force: Some(force),
            flags,
        };
        Self {
            channels: vec![channel],
            raw: vec![reply],
            ..Self::default()
        }
    }
}

/// The reading of one axis of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel {
    /// \[m\]
    pub displacement: Option<f64>,
    pub force: Option<Force>,
    /// Those of the first axis include the flags of the device itself.
    pub flags: Flags,
}

/// Force in the unit of the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    Newtons(f64),
    /// Raw counts, with the lowest and the highest count of the converter.
    Counts {
        count: i64,
        low: i64,
        high: i64,
    },
}

/// Status flags that a device reports with its reading.
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
    /// The device reports that its reading has not settled.
    pub unsettled: bool,
    pub watchdog_tripped: bool,
    /// The axis holds a force, and not a displacement.
    pub in_force_control: bool,
    /// It left force control because its displacement left its band.
    pub left_at_band: bool,
    /// It left force control because its load cell failed, or its force did not follow.
    pub left_without_cell: bool,
}

impl Flags {
    /// Why an axis does not hold its force any more.
    #[must_use]
    pub const fn left_force_control(self) -> Option<&'static str> {
        if self.left_at_band {
            Some(
                "it left force control because its displacement left its band, and holds its displacement",
            )
        } else if self.left_without_cell {
            Some(
                "it left force control because its force did not follow, and holds its displacement",
            )
        } else {
            None
        }
    }
}

/// The text in the run log if a device has lost its position.
pub const NOT_TRUSTED: &str = "its position is not reliable";

/// The reason why a device did not do a request.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeviceFault {
    /// The same frame was sent several times, and no usable answer was received.
    #[error("no usable answer within {} s", (.seconds * 100.0).round() / 100.0)]
    Silent { seconds: f64 },
    #[error("connection lost: {reason}")]
    Lost { reason: String },
    /// The device refused.
    #[error("refused: {reason}")]
    Refused { reason: String },
    /// It restarted, so that its position is not to be trusted.
    #[error("the device restarted ({was} became {is}): {NOT_TRUSTED}")]
    Rebooted { was: String, is: String },
    /// An answer that is not a valid reading: it is not used, and the reading may be requested again.
    #[error("`{}` is not a reading: {reason}", raw.escape_ascii())]
    NoReading { raw: Vec<u8>, reason: String },
    /// A complete reply with an impossible number: not a fault of the line.
    #[error("`{}` is not a reading: {reason}", raw.escape_ascii())]
    Impossible { raw: Vec<u8>, reason: String },
    /// The device is not configured as required, or lacks this function.
    #[error("{0}")]
    Unfit(String),
    /// The operator requests a hold now.
    #[error("held on request")]
    Interrupted,
}

/// One device on one port. All calls end within a bounded time. A device that only measures force is a [`LoadCell`](super::LoadCell).
pub trait Device: Send {
    /// Opens the conversation: requests the identity and checks the configuration. Nothing moves.
    ///
    /// # Errors
    /// It does not answer, or is not suitable.
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault>;

    /// Number of axes that it moves or measures, from `identify`.
    fn axes(&self) -> usize {
        1
    }

    /// The bytes of a move to `targets` (absolute \[m\], one per axis, or \[N\] in force control) at `speed` (\[m/s\], of the axis with the longest
    /// travel; all axes arrive simultaneously), and their values when decoded again. Sends nothing.
    ///
    /// # Errors
    /// The device cannot move, has a different number of axes, or cannot encode this move.
    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault>;

    /// Whether the target of the last `encode` may be rounded by more than the resolution, because no reading has confirmed yet how
    /// the device reads a number.
    fn rounds_first_target(&self) -> bool {
        false
    }

    /// Sends a move and returns when it is accepted, not when it is done.
    ///
    /// # Errors
    /// It was refused or not received.
    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault>;

    /// Asks whether it would execute this move, if the device can be asked: nothing moves yet.
    ///
    /// # Errors
    /// It refuses, or did not receive the request.
    fn propose(&mut self, _going: &DeviceMove) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// Cancels a proposed move that has not begun.
    ///
    /// # Errors
    /// The request was not received.
    fn cancel(&mut self, _going: &DeviceMove) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// Begins the proposed move, without waiting for its end.
    ///
    /// # Errors
    /// As `start`.
    fn begin(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        self.start(going)
    }

    /// Waits for the end of the move, if the device reports it.
    ///
    /// # Errors
    /// As `start`.
    fn finish(&mut self, _going: &DeviceMove) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// For several devices in one: the index of the device with the last fault.
    fn faulty_member(&self) -> Option<usize> {
        None
    }

    /// The bytes of a motion along smooth paths, one per axis and of equal duration, that does not stop at their ends; and
    /// their ends when decoded again, with the highest speed. Sends nothing.
    ///
    /// # Errors
    /// As `encode`; most devices follow no path.
    fn encode_path(&mut self, _paths: &[Path]) -> Result<DeviceMove, DeviceFault> {
        Err(DeviceFault::Unfit(
            "it moves to targets, and follows no path without a stop".to_owned(),
        ))
    }

    /// Sends a motion along paths and returns when it is accepted. Gives the time until its end \[s\].
    ///
    /// # Errors
    /// It was refused, came too late, or was not received.
    fn start_path(&mut self, going: &DeviceMove) -> Result<f64, DeviceFault> {
        self.start(going).map(|()| 0.0)
    }

    /// Requests one reading of every axis. A reply without a valid reading is [`DeviceFault::NoReading`].
    ///
    /// # Errors
    /// As every call.
    fn sample(&mut self) -> Result<Sample, DeviceFault>;

    /// Stops and keeps the load, as soon as the command can be sent.
    ///
    /// # Errors
    /// The command could not be sent; the caller still has [`Device::emergency`].
    fn hold(&mut self) -> Result<(), DeviceFault>;

    /// Bytes that stop the device whatever it is doing, sent without waiting for an answer. Empty: there are none.
    fn emergency(&self) -> Vec<u8>;

    /// Sends the limits of this run to the device, one entry per axis, if it can enforce them. Most devices have only their
    /// own limits. The device may only narrow those.
    ///
    /// # Errors
    /// It refuses them.
    fn narrow_limits(&mut self, _limits: &[Limits]) -> Result<(), DeviceFault> {
        Ok(())
    }

    /// Sends the rate and the tolerance of every axis in force control, one entry per axis. Such an axis enters force control with the
    /// next move, whose target is a force \[N\] for it. The device leaves force control by itself at the band of the axis, or without its
    /// load cell, and then holds the displacement.
    ///
    /// # Errors
    /// It has no force control, or refuses.
    fn control_force(&mut self, axes: &[Option<AxialAxis>]) -> Result<(), DeviceFault> {
        if axes.iter().any(Option::is_some) {
            return Err(DeviceFault::Unfit("it has no force control".to_owned()));
        }
        Ok(())
    }

    /// The displacements that the device itself allows, in its own coordinate \[m\], one per axis, from `identify`. None: it does not
    /// report them.
    fn reported_range(&self) -> Option<Vec<Interval>> {
        None
    }

    /// The last move it remembers, from `identify`.
    fn last_move(&self) -> Option<LastMove> {
        None
    }

    /// Communication errors recovered so far.
    fn line_statistics(&self) -> LineStatistics;
}

/// Positions \[m\] with every digit, as a list for a fault.
pub fn metres(positions: &[f64]) -> String {
    let each = positions.iter().map(|position| format!("{position} m"));
    each.collect::<Vec<_>>().join(", ")
}

/// The target of a device that moves one axis.
pub(super) fn one_axis(targets: &[f64]) -> Result<f64, DeviceFault> {
    match targets {
        [target] => Ok(*target),
        _ => Err(DeviceFault::Unfit(format!(
            "it moves one axis, not {}",
            targets.len()
        ))),
    }
}
