//! The controller of one of several actuators. In: the bytes of its line, time. Out: the answers of a controller of one
//! actuator, with the emulated rig seen from that actuator. It knows no protocol.

use super::{EmulatedRig, Firmware};

/// A firmware that knows one actuator, and the index of this actuator.
pub(super) struct OneActuator {
    pub(super) actuator: usize,
    pub(super) firmware: Box<dyn Firmware>,
}

impl OneActuator {
    fn seen<T>(
        &mut self,
        rig: &mut EmulatedRig,
        call: impl FnOnce(&mut dyn Firmware, &mut EmulatedRig) -> T,
    ) -> T {
        let before = rig.look_from(self.actuator);
        let made = call(self.firmware.as_mut(), rig);
        rig.look_from(before);
        made
    }
}

impl Firmware for OneActuator {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        self.seen(rig, |firmware, rig| firmware.receive(bytes, rig))
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.seen(rig, |firmware, rig| firmware.tick(rig))
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.seen(rig, |firmware, rig| firmware.reboot(rig))
    }
}
