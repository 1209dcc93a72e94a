//! Drivers against the emulators of their controllers, which share no parsing code with them. The emulator moves to the commanded
//! position, and the driver reads the force of the emulator.

use std::io;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::StopRequest;
use crate::controllers::instron::driver::Instron;
use crate::controllers::mark10::driver::Mark10;
use crate::controllers::mark10::load_cell::Mark10Gauge;
use crate::controllers::modbus::driver::Modbus;
use crate::controllers::nees::driver::Nees;
use crate::controllers::{Device, DeviceFault, Force, LineClient};
use crate::emulator::firmware::testing::spring;
use crate::emulator::{EmulatedRig, Firmware, firmware};
use crate::testing::rig::VirtualClock;
use crate::transport::{Clock as _, Emergency, Port};
use psd_plan::{Interval, Limits, ModbusMap, ModbusNumber};

/// Stiffness of the spring of the emulator \[N/m\].
const STIFFNESS: f64 = 1e5;

/// A controller of the rig emulator, at the other end of a line without delay.
#[derive(Clone)]
struct Controller {
    clock: VirtualClock,
    shared: Arc<Mutex<Shared>>,
}

struct Shared {
    firmware: Box<dyn Firmware>,
    rig: EmulatedRig,
    /// Bytes that were sent and not yet read.
    coming: Vec<u8>,
}

impl Controller {
    fn new(firmware: Box<dyn Firmware>) -> Self {
        let rig = spring();
        Self {
            clock: VirtualClock::default(),
            shared: Arc::new(Mutex::new(Shared {
                firmware,
                rig,
                coming: Vec::new(),
            })),
        }
    }

    fn client(&self) -> LineClient {
        LineClient::new(Box::new(self.clone()), Box::new(self.clock.clone()), 0.5)
            .observing(StopRequest::default())
    }

    fn targets(&self) -> Vec<f64> {
        let shared = self.shared.lock().unwrap();
        assert!(shared.rig.violations().is_empty());
        shared.rig.targets()
    }
}

impl Port for Controller {
    fn write(&mut self, bytes: &[u8], _: Duration) -> io::Result<()> {
        let Shared {
            firmware,
            rig,
            coming,
        } = &mut *self.shared.lock().unwrap();
        rig.advance(self.clock.now());
        coming.extend(firmware.tick(rig));
        coming.extend(firmware.receive(bytes, rig));
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let Shared {
            firmware,
            rig,
            coming,
        } = &mut *self.shared.lock().unwrap();
        if coming.is_empty() {
            self.clock.advance(timeout.as_secs_f64());
            rig.advance(self.clock.now());
            coming.extend(firmware.tick(rig));
        }
        let count = coming.len().min(buffer.len());
        buffer[..count].copy_from_slice(&coming[..count]);
        coming.drain(..count);
        if count == 0 {
            Err(io::ErrorKind::TimedOut.into())
        } else {
            Ok(count)
        }
    }

    fn discard(&mut self) -> io::Result<()> {
        self.shared.lock().unwrap().coming.clear();
        Ok(())
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Ok(Box::new(self.clone()))
    }
}

impl Emergency for Controller {
    fn send(&mut self, bytes: &[u8]) {
        self.write(bytes, Duration::ZERO).ok();
    }
}

fn read(device: &mut dyn Device) -> (f64, f64, Option<bool>) {
    let sample = device.sample().unwrap();
    let Some(Force::Newtons(force)) = sample.channels[0].force else {
        panic!("{sample:?}")
    };
    (
        sample.channels[0].displacement.unwrap(),
        force,
        sample.moving,
    )
}

/// Moves to 2.5 mm and back to −1 mm at 1 mm/s.
fn goes_there_and_back(device: &mut dyn Device, controller: &Controller, resolution: f64) {
    let before = controller.targets().len();
    device.identify().unwrap();
    for target in [0.002_5, -0.001] {
        let going = device.encode(&[target], 0.001).unwrap();
        assert!(
            (going.targets[0] - target).abs() < 1e-9 && going.speed <= 0.001,
            "{going:?}"
        );
        device.start(&going).unwrap();
        let mut polls = 0;
        while read(device).2 == Some(true) {
            controller.clock.advance(0.1);
            polls += 1;
            assert!(polls < 100, "it never arrives");
        }
        let (displacement, force, _) = read(device);
        assert!(
            (displacement - target).abs() <= resolution,
            "{displacement}"
        );
        assert!((force - STIFFNESS * target).abs() <= 0.02, "{force}");
        assert!((controller.targets().last().unwrap() - going.targets[0]).abs() < 1e-12);
    }
    assert_eq!(controller.targets().len(), before + 2);
    assert_eq!(
        (
            device.line_statistics().ignored,
            device.line_statistics().resent
        ),
        (0, 0)
    );
}

/// Stopped by a hold or by the emergency bytes in the middle of a move of 10 s, the device does not move further.
fn stays_where_it_is_stopped(device: &mut dyn Device, controller: &Controller) {
    for emergency in [false, true] {
        let from = read(device).0;
        let going = device
            .encode(&[if from < 0.005 { 0.01 } else { 0.0 }], 0.001)
            .unwrap();
        device.start(&going).unwrap();
        controller.clock.advance(1.0);
        if emergency {
            controller.emergency().unwrap().send(&device.emergency());
        } else {
            device.hold().unwrap();
        }
        let there = read(device).0;
        controller.clock.advance(5.0);
        let (later, _, moving) = read(device);
        assert!(
            later == there
                && (there - from).abs() > 0.000_5
                && (there - going.targets[0]).abs() > 0.000_5,
            "{there}"
        );
        assert_eq!(moving, Some(false));
    }
}

#[test]
fn the_instron_console() {
    let controller = Controller::new(Box::new(firmware::Instron::new(0.1, 5e4)));
    let mut device = Instron::new(controller.client());
    goes_there_and_back(&mut device, &controller, 1e-9);
    stays_where_it_is_stopped(&mut device, &controller);
}

#[test]
fn the_mark_10_stand_and_the_gauge_alone() {
    let controller = Controller::new(Box::new(firmware::Mark10::new(1.0)));
    let mut device = Mark10::new(controller.client());
    goes_there_and_back(&mut device, &controller, 1e-9);
    stays_where_it_is_stopped(&mut device, &controller);
    let alone = Controller::new(Box::new(firmware::Mark10Gauge::new(-1.0)));
    alone.shared.lock().unwrap().rig.go(0.001, 0.01);
    alone.clock.advance(1.0);
    let sample = Mark10Gauge::new(alone.client()).sample().unwrap();
    assert_eq!(
        (sample.channels[0].force, sample.channels[0].displacement),
        (Some(Force::Newtons(-100.0)), None)
    );
}

#[test]
fn modbus_drives_of_every_kind_of_number() {
    let map = |number, unit| ModbusMap {
        unit: 17,
        number,
        target: Some(40),
        speed: Some(50),
        position: Some(10),
        force: Some(20),
        status: Some(30),
        moving_mask: 4,
        command: Some(60),
        start_word: 1,
        stop_word: 2,
        length_unit: unit,
        speed_unit: unit,
        force_unit: 0.02,
    };
    let orders = [true, false];
    let mut maps = vec![map(ModbusNumber::Int16, 1e-6)];
    maps.extend(orders.map(|high_word_first| map(ModbusNumber::Int32 { high_word_first }, 1e-8)));
    maps.extend(orders.map(|high_word_first| map(ModbusNumber::Float32 { high_word_first }, 1e-3)));
    let displacement = Interval {
        low: -0.001,
        high: 0.01,
    };
    let limits = Limits {
        displacement,
        ..Limits::NONE
    };
    for map in maps {
        let controller = Controller::new(Box::new(firmware::Modbus::new(map)));
        // At exactly 0 no reading shows the order of the words.
        controller.shared.lock().unwrap().rig.go(1e-4, 0.01);
        controller.clock.advance(1.0);
        let mut device = Modbus::new(controller.client(), map, Some(19_200));
        device.narrow_limits(&[limits]).unwrap();
        goes_there_and_back(&mut device, &controller, 1e-9);
        stays_where_it_is_stopped(&mut device, &controller);
    }
}

#[test]
fn a_nees_rig() {
    let controller = Controller::new(Box::new(firmware::Nees::new(
        vec!["MDL-00-01".to_owned()],
        vec![0],
        0.001,
    )));
    let mut device = Nees::new(controller.client(), vec!["MDL-00-01".to_owned()], 5.0);
    goes_there_and_back(&mut device, &controller, 1e-12);
    let beyond = device.encode(&[0.07], 0.001).unwrap();
    let targets = controller.shared.lock().unwrap().rig.targets().len();
    assert!(matches!(
        device.start(&beyond),
        Err(DeviceFault::Refused { .. })
    ));
    assert_eq!(
        controller.shared.lock().unwrap().rig.targets().len(),
        targets,
        "the rig itself refuses, and nothing moves"
    );
    assert!(device.hold().is_ok());
}
