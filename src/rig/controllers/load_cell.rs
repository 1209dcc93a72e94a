//! A device that weighs and does not move. In: who it is and what it reads. Out: a [`Device`] that refuses every move, has nothing to
//! hold and nothing to stop. It knows no dialect.

use super::{Device, DeviceFault, DeviceIdentity, Move, Sample};
use crate::rig::Tally;

/// A load cell on a port of its own. All calls end within a bounded time.
pub trait Gauge: Send {
    /// As [`Device::identify`].
    ///
    /// # Errors
    /// It does not answer, or is not fit.
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault>;

    /// How many channels it has, one an axis of the rig.
    fn axes(&self) -> usize {
        1
    }

    /// As [`Device::sample`]: the force of every channel, in N or counts.
    ///
    /// # Errors
    /// As every call.
    fn sample(&mut self) -> Result<Sample, DeviceFault>;

    /// What was mended on the line so far.
    fn tally(&self) -> Tally;
}

impl<G: Gauge> Device for G {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        G::identify(self)
    }

    fn axes(&self) -> usize {
        G::axes(self)
    }

    fn encode(&mut self, _: &[f64], _: f64) -> Result<Move, DeviceFault> {
        Err(unmoved())
    }

    fn start(&mut self, _: &Move) -> Result<(), DeviceFault> {
        Err(unmoved())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        G::sample(self)
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        Ok(())
    }

    fn emergency(&self) -> Vec<u8> {
        Vec::new()
    }

    fn tally(&self) -> Tally {
        G::tally(self)
    }
}

fn unmoved() -> DeviceFault {
    DeviceFault::Unfit("a load cell cannot move".to_owned())
}
