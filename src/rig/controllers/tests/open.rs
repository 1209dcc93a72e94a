//! Opening a device: nothing is sent, and the device can be moved if its protocol in the plan includes motion.

use crate::controllers::DeviceMove;
use crate::controllers::*;
use crate::testing::rig::{ScriptedPort, VirtualClock};
use psd_plan::PortPlan;

#[test]
fn actuators_of_the_plan_accept_moves_and_opening_sends_nothing() {
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
        let moves = dialect.abilities().moves;
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
            StopRequest::default(),
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
            let going = DeviceMove {
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
