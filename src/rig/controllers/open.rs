//! The driver of a dialect. In: how a device of the plan is reached, and an open port. Out: the device. Nothing is said
//! on the port.

use super::{
    Device, GrblDevice, Hx711Device, IndicatorDevice, Instron, Mark10, Mark10Gauge, Modbus,
    NativeDevice, Nees, ScpiDevice, Talk,
};
use crate::plan::{DeviceLink, Dialect, PortPlan};
use crate::rig::Wish;
use crate::rig::transport::{Clock, Port};

/// The device at a port. Its waits end when `wish` is to hold; `settling` (s) is how long a rig that answers only once
/// it has settled may take to.
#[must_use]
pub fn open(
    link: &DeviceLink,
    port: Box<dyn Port>,
    clock: Box<dyn Clock>,
    wish: Wish,
    settling: f64,
) -> Box<dyn Device> {
    let talk = Talk::new(port, clock, link.reply_timeout).heeding(wish);
    let baud = match link.port {
        PortPlan::Serial { baud, .. } => Some(baud),
        PortPlan::Tcp { .. } => None,
    };
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
        Dialect::Nees { control_points } => Box::new(Nees::new(talk, control_points, settling)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::controllers::Move;
    use crate::rig::testing::{ScriptedPort, VirtualClock};

    #[test]
    fn what_the_plan_says_moves_can_be_told_to_and_nothing_is_sent_by_opening() {
        let clock = VirtualClock::default();
        let scpi = Dialect::Scpi {
            newtons_per_unit: vec![1.0],
        };
        for dialect in [
            Dialect::Grbl,
            Dialect::Hx711,
            Dialect::Indicator,
            Dialect::Mark10Gauge,
            scpi,
        ] {
            let moves = dialect.moves();
            let link = DeviceLink {
                port: PortPlan::Tcp {
                    address: "127.0.0.1:1".to_owned(),
                },
                dialect,
                reply_timeout: 0.5,
                serial_number: None,
            };
            let port = ScriptedPort::new(&clock);
            let mut device = open(
                &link,
                Box::new(port.clone()),
                Box::new(clock.clone()),
                Wish::default(),
                10.0,
            );
            assert_eq!(
                device.encode(&[0.001], 1e-3).is_ok(),
                moves,
                "{}",
                link.dialect.name()
            );
            assert_eq!(device.emergency().is_empty(), !moves);
            if !moves {
                let going = Move {
                    frames: vec![b"up".to_vec()],
                    targets: vec![0.001],
                    speed: 1e-3,
                    id: None,
                };
                assert!(
                    device.start(&going).is_err() && device.hold().is_ok(),
                    "{}",
                    link.dialect.name()
                );
            }
            assert!(port.sent().is_empty());
        }
    }
}
