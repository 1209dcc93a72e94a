//! The controller of one of several actuators. In: the bytes of its line, time. Out: the answers of a controller of one
//! actuator, with the bench seen from that actuator. It knows no protocol.

use super::{Bench, Firmware};

/// A firmware that knows one actuator, and the index of this actuator.
pub(super) struct OfRam {
    pub(super) ram: usize,
    pub(super) firmware: Box<dyn Firmware>,
}

impl OfRam {
    fn seen<T>(
        &mut self,
        bench: &mut Bench,
        call: impl FnOnce(&mut dyn Firmware, &mut Bench) -> T,
    ) -> T {
        let before = bench.look_from(self.ram);
        let made = call(self.firmware.as_mut(), bench);
        bench.look_from(before);
        made
    }
}

impl Firmware for OfRam {
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8> {
        self.seen(bench, |firmware, bench| firmware.receive(bytes, bench))
    }

    fn tick(&mut self, bench: &mut Bench) -> Vec<u8> {
        self.seen(bench, |firmware, bench| firmware.tick(bench))
    }

    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8> {
        self.seen(bench, |firmware, bench| firmware.reboot(bench))
    }
}
