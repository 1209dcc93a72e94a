//! A transducer that answers `READ?`. In: nothing. Out: a force, by the plan's N per reading unit. After a silence its
//! identity is requested until it answers: all late answers have then been received. It moves nothing.

use crate::LineStatistics;
use crate::controllers::scpi;
use crate::controllers::{
    Answer, Channel, DeviceFault, DeviceIdentity, Flags, Force, LineClient, LoadCell, Sample,
};

/// Number of times a question is sent before it is abandoned.
const ATTEMPTS: u32 = 3;

/// The meter at the other end of a line.
pub struct ScpiDevice {
    client: LineClient,
    /// One a channel.
    newtons_per_unit: Vec<f64>,
    /// The reply with its identity.
    name: Vec<u8>,
    /// An earlier answer is still possible.
    late_answer_possible: bool,
}

impl ScpiDevice {
    #[must_use]
    pub const fn new(client: LineClient, newtons_per_unit: Vec<f64>) -> Self {
        Self {
            client,
            newtons_per_unit,
            name: Vec::new(),
            late_answer_possible: false,
        }
    }

    /// Requests its identity; every other line is discarded.
    fn send_identification(&mut self) -> Result<Vec<u8>, DeviceFault> {
        let expected = std::mem::take(&mut self.name);
        let named = self.client.exchange(scpi::codec::IDENTIFY, b"\n", |line| {
            let line = stripped(line);
            let fits = scpi::codec::identification(line).is_some()
                && (expected.is_empty() || line == expected);
            if fits {
                Answer::Take(line.to_vec())
            } else {
                Answer::Ignore
            }
        });
        self.name = named.as_ref().map_or(expected, Clone::clone);
        named
    }

    /// One answer was received to several questions: the driver waits for the others, at most one time-out.
    fn catch_up(&mut self) -> Result<(), DeviceFault> {
        self.client.drain()?;
        let before = self.client.line_statistics().resent;
        self.send_identification()?;
        if self.client.line_statistics().resent > before {
            self.client.until_quiet(self.client.reply_timeout())?;
        }
        self.late_answer_possible = false;
        Ok(())
    }

    /// The answer to a question that is sent now.
    fn read(&mut self) -> Result<Vec<u8>, DeviceFault> {
        let began = self.client.now();
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                self.client.line_statistics_mut().resent += 1;
            }
            if self.late_answer_possible {
                self.catch_up()?;
            }
            self.client.drain()?;
            let name = &self.name;
            let accept = |line: &[u8]| {
                let line = stripped(line);
                if line == name {
                    Answer::Ignore
                } else {
                    Answer::Take(line.to_vec())
                }
            };
            match self.client.exchange_once(scpi::codec::READ, b"\n", accept) {
                Ok(line) => return Ok(line),
                Err(DeviceFault::Silent { .. }) => self.late_answer_possible = true,
                Err(fault) => {
                    // The answer to an interrupted question may still arrive.
                    self.late_answer_possible = true;
                    return Err(fault);
                }
            }
        }
        Err(DeviceFault::Silent {
            seconds: self.client.now() - began,
        })
    }
}

fn stripped(line: &[u8]) -> &[u8] {
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// The identity of a meter from this reply.
pub fn introduced(name: &[u8]) -> Option<DeviceIdentity> {
    let who = scpi::codec::identification(name)?;
    let simulated = who.maker.starts_with(crate::controllers::SIMULATED)
        || who.model.starts_with(crate::controllers::SIMULATED);
    let model = format!("{} {}", who.maker, who.model);
    Some(DeviceIdentity {
        model,
        serial: who.serial,
        firmware: who.firmware,
        boot: None,
        simulated,
        raw: vec![name.to_vec()],
    })
}

/// The forces of an answer, one a channel, by the N of a unit of each.
///
/// # Errors
/// The reply is no reading of this device, or its status forbids one.
pub fn decoded(line: Vec<u8>, newtons_per_unit: &[f64]) -> Result<Sample, DeviceFault> {
    let words: Vec<&[u8]> = line.split(|byte| *byte == b',').collect();
    if words.len() != newtons_per_unit.len() {
        let reason = format!(
            "it has {} numbers, but the meter has {} channels",
            words.len(),
            newtons_per_unit.len()
        );
        return Err(DeviceFault::NoReading { raw: line, reason });
    }
    let mut channels = Vec::with_capacity(words.len());
    for (index, (word, newtons)) in words.iter().zip(newtons_per_unit).enumerate() {
        let (value, saturated) = match scpi::codec::answer(if words.len() > 1 {
            word.trim_ascii()
        } else {
            word
        }) {
            Ok(scpi::codec::Answer::Number(value)) => (value, false),
            // Outside every limit.
            Ok(scpi::codec::Answer::Overload { negative }) => (
                if negative {
                    f64::NEG_INFINITY
                } else {
                    f64::INFINITY
                },
                true,
            ),
            Err(reason) => {
                let of = if words.len() > 1 {
                    format!("channel {}: {reason}", index + 1)
                } else {
                    reason.to_owned()
                };
                return Err(DeviceFault::NoReading {
                    raw: line.clone(),
                    reason: of,
                });
            }
        };
        let force = Some(Force::Newtons(value * newtons));
        channels.push(Channel {
            displacement: None,
            force,
            flags: Flags {
                saturated,
                ..Flags::default()
            },
        });
    }
    Ok(Sample {
        channels,
        raw: vec![line],
        ..Sample::default()
    })
}

impl LoadCell for ScpiDevice {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.name = Vec::new();
        self.catch_up()?;
        introduced(&self.name)
            .ok_or_else(|| DeviceFault::Unfit("it does not report its identity".to_owned()))
    }

    fn axes(&self) -> usize {
        self.newtons_per_unit.len()
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        decoded(self.read()?, &self.newtons_per_unit)
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};

    const NAME: &str = "PSD-SIM,DMM 7,1234,A.02";

    fn device() -> (ScpiDevice, ScriptedPort) {
        let clock = VirtualClock::default();
        let port = ScriptedPort::new(&clock);
        (
            ScpiDevice::new(
                LineClient::new(Box::new(port.clone()), Box::new(clock), 0.5),
                vec![-100.0],
            ),
            port,
        )
    }

    fn reply(port: &ScriptedPort, seconds: f64, line: &str) {
        port.reply(&[Scripted::After(seconds, format!("{line}\r\n").into_bytes())]);
    }

    fn identified() -> (ScpiDevice, ScriptedPort) {
        let (mut device, port) = device();
        reply(&port, 0.1, NAME);
        device.identify().unwrap();
        (device, port)
    }

    fn sent(port: &ScriptedPort) -> Vec<Vec<u8>> {
        port.sent().into_iter().map(|(_, bytes)| bytes).collect()
    }

    #[test]
    fn it_states_its_identity_and_its_quantity() {
        let (mut device, port) = device();
        reply(&port, 0.1, NAME);
        let identity = device.identify().unwrap();
        assert_eq!(
            (
                identity.model.as_str(),
                identity.serial.as_str(),
                identity.simulated
            ),
            ("PSD-SIM DMM 7", "1234", true)
        );
        reply(&port, 0.1, "+5.12375E+00");
        let sample = device.sample().unwrap();
        assert_eq!(sample.channels[0].force, Some(Force::Newtons(-512.375)));
        assert_eq!(
            (sample.raw, sent(&port)),
            (
                vec![b"+5.12375E+00".to_vec()],
                vec![b"*IDN?\n".to_vec(), b"READ?\n".to_vec()]
            )
        );
    }

    #[test]
    fn overload_is_saturated_and_what_is_no_number_no_reading() {
        let (mut device, port) = identified();
        for (line, force) in [("9.9E37", f64::NEG_INFINITY), ("-9.9E37", f64::INFINITY)] {
            reply(&port, 0.1, line);
            let sample = device.sample().unwrap();
            assert_eq!(
                (sample.channels[0].force, sample.channels[0].flags.saturated),
                (Some(Force::Newtons(force)), true),
                "turned by the plan's sign"
            );
        }
        for line in ["9.91E37", "1e400", "nan", "OVL", "1,5", ""] {
            reply(&port, 0.1, line);
            assert!(
                matches!(device.sample(), Err(DeviceFault::NoReading { .. })),
                "{line}"
            );
        }
    }

    #[test]
    fn after_a_silence_what_is_late_comes_before_its_name_and_is_thrown_away() {
        let (mut device, port) = identified();
        reply(&port, 0.8, "6.66");
        // The name is requested while the old answer is still in transmission; it arrives after that answer.
        reply(&port, 0.1, NAME);
        reply(&port, 0.1, "1.5");
        assert_eq!(
            device.sample().unwrap().channels[0].force,
            Some(Force::Newtons(-150.0))
        );
        assert_eq!(sent(&port)[1..], [&b"READ?\n"[..], b"*IDN?\n", b"READ?\n"]);
        assert_eq!(
            device.line_statistics(),
            LineStatistics {
                resent: 1,
                ignored: 1,
                reread: 0
            }
        );
    }

    #[test]
    fn a_meter_of_several_channels_gives_each_its_own_force() {
        let (mut device, port) = identified();
        device.newtons_per_unit = vec![-100.0, 2.0];
        reply(&port, 0.1, "+1.5E+00, 9.9E37");
        let sample = device.sample().unwrap();
        let forces: Vec<Option<Force>> = sample
            .channels
            .iter()
            .map(|channel| channel.force)
            .collect();
        assert_eq!(
            forces,
            [
                Some(Force::Newtons(-150.0)),
                Some(Force::Newtons(f64::INFINITY))
            ]
        );
        assert_eq!(
            sample
                .channels
                .iter()
                .map(|channel| channel.flags.saturated)
                .collect::<Vec<_>>(),
            [false, true]
        );
        assert_eq!(device.axes(), 2);
        for (bytes, why) in [
            ("+1.5E+00", "it has 1 numbers, but the meter has 2 channels"),
            ("1.0,OVL", "channel 2: it is not a number"),
            ("1,5,2,5", "it has 4 numbers, but the meter has 2 channels"),
        ] {
            reply(&port, 0.1, bytes);
            assert!(
                matches!(device.sample(), Err(DeviceFault::NoReading { reason, .. }) if reason == why),
                "{why}"
            );
        }
    }

    #[test]
    fn silence_ends_within_a_bounded_time() {
        let (mut device, _) = identified();
        let began = device.client.now();
        assert!(matches!(device.sample(), Err(DeviceFault::Silent { .. })));
        assert!(device.client.now() - began < 10.0 * 0.5);
    }
}
