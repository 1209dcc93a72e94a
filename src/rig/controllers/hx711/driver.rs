//! A load cell that sends raw counts unsolicited, one a line. In: nothing. Out: a count whose conversion began after the
//! request. It moves nothing and does not know its calibration.

use crate::LineStatistics;
use crate::controllers::hx711;
use crate::controllers::hx711::codec::RAILS;
use crate::controllers::{
    DeviceFault, DeviceIdentity, Flags, Force, LineClient, LoadCell, Sample, stream,
};

/// The converter at the other end of a line.
pub struct Hx711Device {
    client: LineClient,
}

impl Hx711Device {
    #[must_use]
    pub const fn new(client: LineClient) -> Self {
        Self { client }
    }
}

/// The identity of a device that sends counts.
pub fn introduced() -> DeviceIdentity {
    DeviceIdentity {
        model: "HX711".to_owned(),
        ..DeviceIdentity::default()
    }
}

/// The count of a line.
///
/// # Errors
/// The reply is no reading of this device, or its status forbids one.
pub fn decoded(line: Vec<u8>) -> Result<Sample, DeviceFault> {
    let Some(count) = hx711::codec::count(&line) else {
        return Err(DeviceFault::NoReading {
            raw: line,
            reason: "it is not a 24-bit count".to_owned(),
        });
    };
    let (low, high) = RAILS;
    let flags = Flags {
        saturated: hx711::codec::is_saturated(count),
        ..Flags::default()
    };
    let force = Force::Counts { count, low, high };
    Ok(Sample::of_force(force, flags, line))
}

impl LoadCell for Hx711Device {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.sample()?;
        Ok(introduced())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        decoded(stream::fresh_line(&mut self.client)?)
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};

    fn device() -> (Hx711Device, ScriptedPort, VirtualClock) {
        let clock = VirtualClock::default();
        let port = ScriptedPort::new(&clock);
        (
            Hx711Device::new(LineClient::new(
                Box::new(port.clone()),
                Box::new(clock.clone()),
                0.5,
            )),
            port,
            clock,
        )
    }

    fn script_reply(port: &ScriptedPort, seconds: f64, bytes: &str) {
        port.send_unasked(&[Scripted::After(seconds, bytes.as_bytes().to_vec())]);
    }

    fn count(sample: &Sample) -> i64 {
        match sample.channels[0].force {
            Some(Force::Counts {
                count,
                low: -8_388_608,
                high: 8_388_607,
            }) => count,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn only_a_count_that_began_after_the_request_is_used() {
        let (mut device, port, clock) = device();
        for second in 0..20 {
            script_reply(&port, 0.1, &format!("{second}\r\n"));
        }
        clock.advance(1.05);
        let sample = device.sample().unwrap();
        assert_eq!(
            count(&sample),
            11,
            "the one under way may have been begun before"
        );
        assert_eq!((sample.raw, port.sent().len()), (vec![b"11".to_vec()], 0));
    }

    #[test]
    fn half_a_count_is_never_a_count() {
        let (mut device, port, clock) = device();
        script_reply(&port, 0.0, "-81");
        clock.advance(0.05);
        script_reply(&port, 0.01, "2344\r\n");
        script_reply(&port, 0.1, "-8123");
        script_reply(&port, 0.1, "45\r\n");
        assert_eq!(count(&device.sample().unwrap()), -812_345);
        script_reply(&port, 0.1, "7\r\n81");
        assert_eq!(
            device.sample(),
            Err(DeviceFault::Silent { seconds: 0.5 }),
            "a line that does not end"
        );
    }

    #[test]
    fn the_rails_are_saturated_and_anything_else_is_no_reading() {
        for (line, saturated) in [("8388607", true), ("-8388608", true), ("8388606", false)] {
            let (mut device, port, _) = device();
            script_reply(&port, 0.1, &format!("\n{line}\r\n"));
            assert_eq!(
                device.sample().unwrap().channels[0].flags.saturated,
                saturated
            );
        }
        for line in ["8388608", "nan", "12.5", "", "HX711 ready"] {
            let (mut device, port, _) = device();
            script_reply(&port, 0.1, &format!("\n{line}\r\n"));
            assert!(
                matches!(device.sample(), Err(DeviceFault::NoReading { .. })),
                "{line}"
            );
        }
        let (mut device, _, _) = device();
        assert_eq!(device.identify(), Err(DeviceFault::Silent { seconds: 0.5 }));
    }
}
