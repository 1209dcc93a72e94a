//! A device that measures force and does not move. In: its identity and its readings. Out: a [`Device`] that refuses every
//! move and has nothing to hold or stop. It knows no protocol.

use super::{Device, DeviceFault, DeviceIdentity, DeviceMove, Sample};
use crate::LineStatistics;

/// A load cell on a separate port. All calls end within a bounded time.
pub trait LoadCell: Send {
    /// As [`Device::identify`].
    ///
    /// # Errors
    /// It does not answer, or is not suitable.
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault>;

    /// Number of channels, one per axis of the rig.
    fn axes(&self) -> usize {
        1
    }

    /// As [`Device::sample`]: the force of every channel, in newtons or counts.
    ///
    /// # Errors
    /// As every call.
    fn sample(&mut self) -> Result<Sample, DeviceFault>;

    /// Communication errors recovered so far.
    fn line_statistics(&self) -> LineStatistics;
}

impl<G: LoadCell> Device for G {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        G::identify(self)
    }

    fn axes(&self) -> usize {
        G::axes(self)
    }

    fn encode(&mut self, _: &[f64], _: f64) -> Result<DeviceMove, DeviceFault> {
        Err(unmoved())
    }

    fn start(&mut self, _: &DeviceMove) -> Result<(), DeviceFault> {
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

    fn line_statistics(&self) -> LineStatistics {
        G::line_statistics(self)
    }
}

fn unmoved() -> DeviceFault {
    DeviceFault::Unfit("a load cell cannot move".to_owned())
}
