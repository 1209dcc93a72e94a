//! A Mark-10 test frame with its gauge. In: \[m\] and \[m/s\]. Out: travel limits as targets, read back before the test frame moves;
//! readings in newtons. The resolution of travel and targets is 0.01 mm. Lines have no checksum: unsolicited bytes are discarded, and
//! after a silence every question is asked twice.

use crate::LineStatistics;
use crate::controllers::mark10;
use crate::controllers::mark10::codec::{Side, Status};
use crate::controllers::unsequenced::ask_line;
use crate::controllers::{
    Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Flags, Force, LineClient, Sample,
    one_axis,
};

/// Number of times a setting or a command is sent before it counts as not received.
const TRIES: u32 = 3;
/// Half the resolution of the travel \[m\]: a nearer position is at the target.
const THERE: f64 = 0.5e-5 * 1.01;
/// Largest travel beyond its limit before the test frame is stopped \[m\].
const OVERRUN: f64 = 5e-5;
/// Sent twice, because one may be interpreted as a digit of an incomplete setting.
const EMERGENCY: &[u8] = b"ss";

/// The test frame on a line.
pub struct Mark10 {
    client: LineClient,
    /// Travel as last read \[m\].
    last: Option<f64>,
    /// The target of the present move \[m\].
    going: Option<(Side, f64)>,
}

impl Mark10 {
    #[must_use]
    pub const fn new(client: LineClient) -> Self {
        Self {
            client,
            last: None,
            going: None,
        }
    }

    fn ask(&mut self, question: &[u8]) -> Result<Vec<u8>, DeviceFault> {
        ask_line(&mut self.client, question, mark10::codec::ENDING)
    }

    fn ask_travel(&mut self, question: &[u8]) -> Result<(f64, Vec<u8>), DeviceFault> {
        let answer = self.ask(question)?;
        match mark10::codec::travel(&answer) {
            Some(travel) => Ok((travel, answer)),
            None => Err(no_reading(answer, "no travel in mm")),
        }
    }

    fn ask_status(&mut self) -> Result<(Status, Vec<u8>), DeviceFault> {
        let answer = self.ask(mark10::codec::ASK_STATUS)?;
        match mark10::codec::status(&answer) {
            Some(status) => Ok((status, answer)),
            None => Err(no_reading(answer, "no status")),
        }
    }

    /// Asks again if the answer was garbled: no caller repeats a question that is not a reading.
    fn patiently<T>(
        &mut self,
        mut ask: impl FnMut(&mut Self) -> Result<T, DeviceFault>,
    ) -> Result<T, DeviceFault> {
        for _ in 1..TRIES {
            match ask(self) {
                Err(DeviceFault::NoReading { .. }) => self.client.line_statistics_mut().reread += 1,
                answer => return answer,
            }
        }
        ask(self)
    }

    fn status(&mut self) -> Result<Status, DeviceFault> {
        self.patiently(Self::ask_status).map(|(status, _)| status)
    }

    /// Outside limit mode the test frame does not stop at its target. It leaves that mode when it is switched on again or operated by
    /// hand.
    fn in_limit_mode(&mut self, status: Status) -> Result<(), DeviceFault> {
        if status.limit_mode {
            return Ok(());
        }
        self.stop()?;
        Err(DeviceFault::Rebooted {
            was: "limit mode".to_owned(),
            is: "another mode, in which it does not stop at a target".to_owned(),
        })
    }

    /// Sends the settings until the limit is read back as it was sent. Nothing moves yet.
    fn set_limit(
        &mut self,
        settings: &[Vec<u8>],
        side: Side,
        limit: f64,
    ) -> Result<(), DeviceFault> {
        for _ in 0..TRIES {
            self.client.send(&settings.concat())?;
            match self.ask_travel(ask_limit(side)) {
                Ok((read_back, _)) if (read_back - limit).abs() <= THERE => return Ok(()),
                Ok(_) | Err(DeviceFault::NoReading { .. }) => {
                    self.client.line_statistics_mut().resent += 1;
                }
                Err(fault) => return Err(fault),
            }
        }
        Err(DeviceFault::Refused {
            reason: "its travel limit differs from the limit that was sent".to_owned(),
        })
    }

    fn stop(&mut self) -> Result<(), DeviceFault> {
        for _ in 0..TRIES {
            self.client.send(mark10::codec::STOP)?;
            if !self.status()?.moving {
                self.going = None;
                return Ok(());
            }
            self.client.line_statistics_mut().resent += 1;
        }
        Err(DeviceFault::Refused {
            reason: "it does not stop".to_owned(),
        })
    }
}

impl Device for Mark10 {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.client.send(mark10::codec::READY)?;
        if !self.status()?.limit_mode {
            return Err(DeviceFault::Unfit(
                "the stand does not enter limit mode: does it have PC control?".to_owned(),
            ));
        }
        self.patiently(Self::sample)?;
        Ok(stand_introduced())
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        let target = one_axis(targets)?;
        let from = self.last.ok_or_else(|| {
            DeviceFault::Unfit("its position is not known: read it first".to_owned())
        })?;
        let unsayable = || {
            DeviceFault::Unfit(format!(
                "the stand cannot express {target} m at {speed} m/s"
            ))
        };
        let side = if target < from {
            Side::Lower
        } else {
            Side::Upper
        };
        let mut going = settings(target, speed, side).ok_or_else(unsayable)?;
        // A target that rounds to the present position is not commanded.
        if (going.targets[0] - from).abs() > THERE {
            going.frames.push(direction(side).to_vec());
        }
        Ok(going)
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let [speed, limit, direction @ ..] = going.frames.as_slice() else {
            return Err(DeviceFault::Unfit(
                "this is not a move of the stand".to_owned(),
            ));
        };
        let side = if limit.starts_with(b"g") {
            Side::Lower
        } else {
            Side::Upper
        };
        self.set_limit(&[speed.clone(), limit.clone()], side, going.targets[0])?;
        let Some(direction) = direction.first() else {
            return Ok(());
        };
        let status = self.status()?;
        self.in_limit_mode(status)?;
        let there = |travel: f64| (travel - going.targets[0]).abs() <= THERE;
        self.going = Some((side, going.targets[0]));
        for _ in 0..TRIES {
            self.client.send(direction)?;
            let status = self.status()?;
            self.in_limit_mode(status)?;
            if status.moving
                || there(
                    self.patiently(|stand| stand.ask_travel(mark10::codec::ASK_TRAVEL))?
                        .0,
                )
            {
                return Ok(());
            }
            // It is not started again before its limit is confirmed.
            if !there(self.patiently(|stand| stand.ask_travel(ask_limit(side)))?.0) {
                self.stop()?;
                return Err(DeviceFault::Refused {
                    reason: "its travel limit differs from the limit that was read back".to_owned(),
                });
            }
            self.client.line_statistics_mut().resent += 1;
        }
        Err(DeviceFault::Refused {
            reason: "it does not start to move".to_owned(),
        })
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let (status, status_bytes) = self.ask_status()?;
        self.in_limit_mode(status)?;
        let (travel, travel_bytes) = self.ask_travel(mark10::codec::ASK_TRAVEL)?;
        self.last = Some(travel);
        let past = self.going.is_some_and(|(side, target)| match side {
            Side::Lower => travel < target - OVERRUN,
            Side::Upper => travel > target + OVERRUN,
        });
        if past {
            self.stop()?;
            return Err(DeviceFault::Unfit(
                "the stand passed its travel limit".to_owned(),
            ));
        }
        let force_bytes = self.ask(mark10::codec::ASK_FORCE_THROUGH_STAND)?;
        let force = newtons(&force_bytes)?;
        Ok(Sample {
            raw: vec![status_bytes, travel_bytes, force_bytes],
            ..sample_of(status, travel, force)
        })
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        self.stop()
    }

    fn emergency(&self) -> Vec<u8> {
        EMERGENCY.to_vec()
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

/// The reading of a status, a travel and a force.
pub fn decoded(replies: &[Vec<u8>]) -> Option<Sample> {
    let [status, travel, force] = replies else {
        return None;
    };
    Some(sample_of(
        mark10::codec::status(status)?,
        mark10::codec::travel(travel)?,
        newtons(force).ok()?,
    ))
}

fn sample_of(status: Status, travel: f64, force: Force) -> Sample {
    let axis = Channel {
        displacement: Some(travel),
        force: Some(force),
        // Its limits are its targets: a reached limit means that it has arrived.
        flags: Flags::default(),
    };
    Sample {
        time: None,
        moving: Some(status.moving),
        channels: vec![axis],
        raw: Vec::new(),
    }
}

/// The identity of a test frame.
pub fn stand_introduced() -> DeviceIdentity {
    DeviceIdentity {
        model: "Mark-10 stand".to_owned(),
        ..DeviceIdentity::default()
    }
}

/// Speed and travel limit of a move to `target` \[m\] at a speed of at most `speed` \[m/s\], in the direction of this side.
fn settings(target: f64, speed: f64, side: Side) -> Option<DeviceMove> {
    let (speed_setting, speed) = mark10::codec::speed(speed)?;
    let (limit_setting, target) = mark10::codec::limit(side, target)?;
    Some(DeviceMove {
        frames: vec![speed_setting, limit_setting],
        targets: vec![target],
        speed,
        id: None,
    })
}

const fn ask_limit(side: Side) -> &'static [u8] {
    match side {
        Side::Lower => mark10::codec::ASK_LOWER_LIMIT,
        Side::Upper => mark10::codec::ASK_UPPER_LIMIT,
    }
}

const fn direction(side: Side) -> &'static [u8] {
    match side {
        Side::Lower => mark10::codec::DOWN,
        Side::Upper => mark10::codec::UP,
    }
}

/// # Errors
/// The answer is no force.
pub fn newtons(answer: &[u8]) -> Result<Force, DeviceFault> {
    match mark10::codec::force(answer) {
        Some(mark10::codec::Force::Newtons(newtons)) => Ok(Force::Newtons(newtons)),
        Some(mark10::codec::Force::Unknown) => {
            Err(no_reading(answer.to_vec(), "the gauge did not understand"))
        }
        None => Err(no_reading(answer.to_vec(), "no force with a known unit")),
    }
}

fn no_reading(raw: Vec<u8>, reason: &str) -> DeviceFault {
    DeviceFault::NoReading {
        raw,
        reason: reason.to_owned(),
    }
}

#[cfg(test)]
mod tests;
