//! A load cell on a weighing indicator, which sends unsolicited or on request. In: nothing. Out: a force whose line began
//! after the request, with the status of the indicator. It moves nothing.

use crate::LineStatistics;
use crate::controllers::indicator;
use crate::controllers::indicator::codec::Status;
use crate::controllers::request_reply::RequestReply;
use crate::controllers::{
    Answer, DeviceFault, DeviceIdentity, Flags, Force, LineClient, LoadCell, Sample, stream,
};

/// The indicator at the other end of a line.
pub struct IndicatorDevice {
    client: LineClient,
    request_reply: RequestReply,
    sends_by_itself: bool,
}

impl IndicatorDevice {
    #[must_use]
    pub fn new(client: LineClient) -> Self {
        Self {
            client,
            request_reply: RequestReply::default(),
            sends_by_itself: false,
        }
    }

    /// A line that is newer than this call.
    fn line(&mut self) -> Result<Vec<u8>, DeviceFault> {
        if self.sends_by_itself {
            return stream::fresh_line(&mut self.client);
        }
        let any = |line: &[u8]| Answer::Take(line.strip_suffix(b"\r").unwrap_or(line).to_vec());
        self.request_reply
            .ask(&mut self.client, indicator::codec::READ, any, Vec::eq)
    }
}

/// The identity of a device that sends weights.
pub fn introduced() -> DeviceIdentity {
    DeviceIdentity {
        model: "weighing indicator".to_owned(),
        ..DeviceIdentity::default()
    }
}

/// The force of a line.
///
/// # Errors
/// The reply is no reading of this device, or its status forbids one.
pub fn decoded(line: Vec<u8>) -> Result<Sample, DeviceFault> {
    let weight = match indicator::codec::weight(&line) {
        Ok(weight) => weight,
        Err(reason) => {
            return Err(DeviceFault::NoReading {
                raw: line,
                reason: reason.to_owned(),
            });
        }
    };
    // Out of range it may show no number: the value is then infinite with this sign, outside every limit.
    let beyond = if weight.status == Status::Underload {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    let flags = Flags {
        saturated: weight.status.is_out_of_range(),
        unsettled: weight.status == Status::Unstable,
        ..Flags::default()
    };
    let force = Force::Newtons(weight.force.unwrap_or(beyond));
    Ok(Sample::of_force(force, flags, line))
}

impl LoadCell for IndicatorDevice {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.sends_by_itself = match stream::fresh_line(&mut self.client) {
            Ok(_) => true,
            Err(DeviceFault::Silent { .. }) => false,
            Err(fault) => return Err(fault),
        };
        self.sample()?;
        Ok(introduced())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        decoded(self.line()?)
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};

    fn device() -> (IndicatorDevice, ScriptedPort) {
        let clock = VirtualClock::default();
        let port = ScriptedPort::new(&clock);
        (
            IndicatorDevice::new(LineClient::new(
                Box::new(port.clone()),
                Box::new(clock),
                0.5,
            )),
            port,
        )
    }

    fn reply(port: &ScriptedPort, seconds: f64, line: &str) {
        port.reply(&[Scripted::After(seconds, format!("{line}\r\n").into_bytes())]);
    }

    fn newtons(sample: &Sample) -> f64 {
        match sample.channels[0].force {
            Some(Force::Newtons(force)) => force,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn an_indicator_that_is_asked_answers_with_a_force() {
        let (mut device, port) = device();
        reply(&port, 0.1, "ST,GS,+0001234,kg");
        device.identify().unwrap();
        port.send_unasked(&[Scripted::After(0.0, b"ST,GS,   666.0, N\r\n".to_vec())]);
        reply(&port, 0.1, "US,GS,   512.5, N");
        let sample = device.sample().unwrap();
        assert_eq!(
            (
                newtons(&sample),
                sample.channels[0].flags.unsettled,
                sample.channels[0].flags.saturated
            ),
            (512.5, true, false)
        );
        assert_eq!(sample.raw, [b"US,GS,   512.5, N"]);
        assert_eq!(
            port.sent()
                .iter()
                .map(|(_, bytes)| bytes.as_slice())
                .collect::<Vec<_>>(),
            [b"READ\r\n"; 2]
        );
    }

    #[test]
    fn an_indicator_that_sends_by_itself_is_never_asked() {
        let (mut device, port) = device();
        for value in 0..8 {
            port.send_unasked(&[Scripted::After(
                0.1,
                format!("ST,GS,{value:>8},kg\r\n").into_bytes(),
            )]);
        }
        device.identify().unwrap();
        let sample = device.sample().unwrap();
        assert!(
            (newtons(&sample) - 5.0 * 9.806_65).abs() < 1e-12,
            "{sample:?}"
        );
        assert!(port.sent().is_empty());
    }

    #[test]
    fn out_of_range_is_saturated_and_beyond_every_limit() {
        for (line, force) in [
            ("OL,GS,--------,kg", f64::INFINITY),
            ("UL,GS,        ,kg", f64::NEG_INFINITY),
            ("OL,GS,  5.0,N", 5.0),
        ] {
            let (mut device, port) = device();
            reply(&port, 0.1, line);
            let sample = device.sample().unwrap();
            assert_eq!(
                (newtons(&sample), sample.channels[0].flags.saturated),
                (force, true),
                "{line}"
            );
        }
    }

    #[test]
    fn a_late_answer_is_not_accepted_as_a_fresh_one() {
        let (mut device, port) = device();
        reply(&port, 0.8, "ST,GS,   666.0,N");
        reply(&port, 0.1, "ST,GS,   512.5,N");
        reply(&port, 0.1, "ST,GS,   512.5,N");
        assert_eq!(newtons(&device.sample().unwrap()), 512.5);
        assert_eq!(device.line_statistics().resent, 1);
    }

    #[test]
    fn what_is_no_weight_is_no_reading() {
        for line in [
            "ST,GS,OVL,kg",
            "ST,GS,12,5,kg",
            "ST,GS,   512.5,oz",
            "ERR01",
            "",
        ] {
            let (mut device, port) = device();
            reply(&port, 0.1, line);
            assert!(
                matches!(device.sample(), Err(DeviceFault::NoReading { .. })),
                "{line}"
            );
        }
        let (mut device, _) = device();
        assert!(matches!(device.identify(), Err(DeviceFault::Silent { .. })));
    }
}
