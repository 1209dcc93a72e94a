//! The driver of a dialect. In: how a device of the plan is reached, and an open port. Out: the device. Nothing is said
//! on the port.

use super::grbl::GrblDevice;
use super::hx711::Hx711Device;
use super::indicator::IndicatorDevice;
use super::native::NativeDevice;
use super::scpi::ScpiDevice;
use super::{Device, Instron, Mark10, Mark10Gauge, Modbus, Nees, Talk};
use crate::plan::{DeviceLink, Dialect};
use crate::rig::Wish;
use crate::rig::port::{Clock, Port};

/// The device at a port. `settling` is the longest that the rig may take to settle, s; `baud` that of a serial port. Its waits end when `wish` is to hold.
#[must_use]
pub fn open(
    link: &DeviceLink,
    settling: f64,
    baud: Option<u32>,
    port: Box<dyn Port>,
    clock: Box<dyn Clock>,
    wish: Wish,
) -> Box<dyn Device> {
    let talk = Talk::new(port, clock, link.reply_timeout).heeding(wish);
    match link.dialect.clone() {
        Dialect::Native => Box::new(NativeDevice::new(talk)),
        Dialect::Grbl => Box::new(GrblDevice::new(talk)),
        Dialect::Hx711 => Box::new(Hx711Device::new(talk)),
        Dialect::Indicator => Box::new(IndicatorDevice::new(talk)),
        Dialect::Scpi { newtons_per_unit } => Box::new(ScpiDevice::new(talk, newtons_per_unit)),
        Dialect::Instron => Box::new(Instron::new(talk)),
        Dialect::Mark10 => Box::new(Mark10::new(talk)),
        Dialect::Mark10Gauge => Box::new(Mark10Gauge::new(talk)),
        Dialect::Modbus(map) => Box::new(Modbus::new(talk, map, baud)),
        Dialect::Nees { control_point } => Box::new(Nees::new(talk, control_point, settling)),
    }
}
