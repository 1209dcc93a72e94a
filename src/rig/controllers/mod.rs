//! Protocol drivers, one folder per controller: `codec` turns bytes into meaning, `driver` leads the conversation. A [`Device`] turns SI
//! into bytes and back. It knows no settling, limit, median or run log: those are in `rig/real` and `rig/guard`.
//!
//! A new controller is a folder here with its entry in the list below, an arm of [`open`], and its arms in `replies`.

mod device;
mod line;
mod replies;
#[cfg(test)]
mod tests;

/// Grbl 1.1 stepper frames.
pub mod grbl {
    pub mod codec;
    pub mod driver;
}
/// Load cells on an HX711 converter. They command no motion.
pub mod hx711 {
    pub mod codec;
    pub mod driver;
}
/// Load cells on a weighing indicator. They command no motion.
pub mod indicator {
    pub mod codec;
    pub mod driver;
}
/// Instron 8800-style consoles.
pub mod instron {
    pub mod codec;
    pub mod driver;
}
/// Mark-10 test frames and force gauges.
pub mod mark10 {
    pub mod codec;
    pub mod driver;
    pub mod load_cell;
}
/// Modbus RTU drives. `word_order` allows a target.
pub mod modbus {
    pub mod codec;
    pub mod driver;
    mod word_order;
}
/// psd's own line protocol.
pub mod native {
    pub mod codec;
    pub mod driver;
}
/// NEES sites.
pub mod nees {
    pub mod codec;
    pub mod driver;
}
/// SCPI transducers. They command no motion.
pub mod scpi {
    pub mod codec;
    pub mod driver;
}

use crate::StopRequest;
use crate::transport::{Clock, Port};
use psd_plan::{DeviceLink, Dialect, PortPlan};

use device::one_axis;
pub use device::{
    Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Flags, Force, LoadCell, Member,
    NOT_TRUSTED, Sample, metres, together,
};
pub use line::client::{Answer, LONGEST_LINE, LineClient, Missed, SLICE};
pub use line::number;
use line::{request_reply, stream, unsequenced};
pub use native::driver::{NativeDevice, SIMULATED};
pub use replies::{decoded, replies_to_reading};

/// The device at a port. Its waits end when `stop_request` demands a hold. `settling` \[s\] is the longest settling time of a rig that
/// answers only after it has settled.
#[must_use]
pub fn open(
    link: &DeviceLink,
    port: Box<dyn Port>,
    clock: Box<dyn Clock>,
    stop_request: StopRequest,
    settling: f64,
) -> Box<dyn Device> {
    let client = LineClient::new(port, clock, link.reply_timeout).observing(stop_request);
    let baud = match link.port {
        PortPlan::Serial { baud, .. } => Some(baud),
        PortPlan::Tcp { .. } => None,
    };
    match link.dialect.clone() {
        Dialect::Native => Box::new(native::driver::NativeDevice::new(client)),
        Dialect::Grbl => Box::new(grbl::driver::GrblDevice::new(client)),
        Dialect::Hx711 => Box::new(hx711::driver::Hx711Device::new(client)),
        Dialect::Indicator => Box::new(indicator::driver::IndicatorDevice::new(client)),
        Dialect::Scpi { newtons_per_unit } => {
            Box::new(scpi::driver::ScpiDevice::new(client, newtons_per_unit))
        }
        Dialect::Instron => Box::new(instron::driver::Instron::new(client)),
        Dialect::Mark10 => Box::new(mark10::driver::Mark10::new(client)),
        Dialect::Mark10Gauge => Box::new(mark10::load_cell::Mark10Gauge::new(client)),
        Dialect::Modbus(map) => Box::new(modbus::driver::Modbus::new(client, map, baud)),
        Dialect::Nees { control_points } => {
            Box::new(nees::driver::Nees::new(client, control_points, settling))
        }
    }
}
