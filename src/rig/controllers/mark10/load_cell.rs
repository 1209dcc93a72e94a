//! A Mark-10 gauge alone on its port. In: nothing. Out: a force, on request. It moves nothing: the actuator is `mark10` or
//! another device.

use super::driver::newtons;
use crate::LineStatistics;
use crate::controllers::mark10;
use crate::controllers::unsequenced::ask_line;
use crate::controllers::{DeviceFault, DeviceIdentity, Flags, LineClient, LoadCell, Sample};

/// The gauge at the other end of a line.
pub struct Mark10Gauge {
    client: LineClient,
}

impl Mark10Gauge {
    #[must_use]
    pub const fn new(client: LineClient) -> Self {
        Self { client }
    }
}

impl LoadCell for Mark10Gauge {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.sample()?;
        Ok(introduced())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        decoded(ask_line(
            &mut self.client,
            mark10::codec::ASK_FORCE,
            mark10::codec::ENDING,
        )?)
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

/// The identity of a gauge.
pub fn introduced() -> DeviceIdentity {
    DeviceIdentity {
        model: "Mark-10 gauge".to_owned(),
        ..DeviceIdentity::default()
    }
}

/// The force of its answer.
///
/// # Errors
/// The reply is no reading of this device, or its status forbids one.
pub fn decoded(reply: Vec<u8>) -> Result<Sample, DeviceFault> {
    let force = newtons(&reply)?;
    Ok(Sample::of_force(force, Flags::default(), reply))
}
