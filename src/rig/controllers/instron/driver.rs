//! An Instron 8800-style console: absolute ramps in position mode, position and load as fractions of full scale. In: \[m\]
//! and \[m/s\]. Out: ramps that are read back before they start, and readings in which an exact zero is requested again.
//! Commands are not answered, so their effect is queried.

use crate::LineStatistics;
use crate::controllers;
use crate::controllers::instron;
use crate::controllers::instron::codec::{Channel, Movement, Question, Trouble};
use crate::controllers::unsequenced::ask_line;
use crate::controllers::{
    Device, DeviceFault, DeviceIdentity, DeviceMove, Flags, Force, LineClient, Sample, one_axis,
};

/// Shortest time between polls \[s\]: the console does not accept more.
const BETWEEN_POLLS: f64 = 0.1;
/// Number of times a command is sent before it counts as not received.
const TRIES: u32 = 3;
/// A target (fraction of full scale) and a time \[s\] that differ by less are the same.
const SAME_TARGET: f64 = 1e-7;
const SAME_TIME: f64 = 1e-3;
/// Number of positions from which a travel is measured.
const LAST: usize = 3;

/// The console at the other end of a line.
pub struct Instron {
    client: LineClient,
    position: Reader,
    load: Reader,
    /// Its last positions \[m\], the newest at the end.
    last: Vec<f64>,
    movement: Movement,
    /// Time of the last poll \[s\], by the clock.
    polled: Option<f64>,
}

/// The known properties of a channel.
#[derive(Default)]
struct Reader {
    /// \[m\] or \[N\]
    full_scale: f64,
    /// The last reading was zero, and was requested twice.
    at_zero: bool,
}

impl Instron {
    #[must_use]
    pub fn new(client: LineClient) -> Self {
        let (position, load) = (Reader::default(), Reader::default());
        Self {
            client,
            position,
            load,
            last: Vec::new(),
            movement: Movement::Stopped,
            polled: None,
        }
    }

    /// Sends a question and keeps the reply.
    fn ask(&mut self, question: Question, raw: &mut Vec<Vec<u8>>) -> Result<Vec<u8>, DeviceFault> {
        let answer = ask_line(&mut self.client, &question.line(), instron::codec::ENDING)?;
        raw.push(answer.clone());
        Ok(answer)
    }

    fn number(&mut self, question: Question, raw: &mut Vec<Vec<u8>>) -> Result<f64, DeviceFault> {
        let answer = self.ask(question, raw)?;
        instron::codec::number(&answer).ok_or_else(|| no_reading(answer, "not a number"))
    }

    /// Readings sometimes drop to zero: an exact zero is requested again.
    fn number_twice_if_zero(
        &mut self,
        question: Question,
        raw: &mut Vec<Vec<u8>>,
    ) -> Result<f64, DeviceFault> {
        let first = self.number(question, raw)?;
        if first != 0.0 {
            return Ok(first);
        }
        self.wait_for_poll()?;
        let second = self.number(question, raw)?;
        self.count_glitch(second != 0.0);
        Ok(second)
    }

    /// A second reading is routine; it corrects a reading only if it gives a different value.
    const fn count_glitch(&mut self, glitch: bool) {
        self.client.line_statistics_mut().reread += glitch as u64;
    }

    fn feedback(&mut self, channel: Channel, raw: &mut Vec<Vec<u8>>) -> Result<f64, DeviceFault> {
        let question = Question::Feedback(channel);
        let at_zero = self.reader(channel).at_zero;
        let fraction = if at_zero {
            self.number(question, raw)?
        } else {
            self.number_twice_if_zero(question, raw)?
        };
        let reader = self.reader(channel);
        reader.at_zero = fraction == 0.0;
        Ok(fraction * reader.full_scale)
    }

    const fn reader(&mut self, channel: Channel) -> &mut Reader {
        match channel {
            Channel::Position => &mut self.position,
            Channel::Load => &mut self.load,
        }
    }

    /// A stop that appears because of a false zero is also requested again.
    fn ask_movement(&mut self, raw: &mut Vec<Vec<u8>>) -> Result<Movement, DeviceFault> {
        let mut movement = self.ask_movement_once(raw)?;
        if movement == Movement::Stopped && self.movement != Movement::Stopped {
            self.wait_for_poll()?;
            movement = self.ask_movement_once(raw)?;
            self.count_glitch(movement != Movement::Stopped);
        }
        self.movement = movement;
        Ok(movement)
    }

    fn ask_movement_once(&mut self, raw: &mut Vec<Vec<u8>>) -> Result<Movement, DeviceFault> {
        let answer = self.ask(Question::Movement, raw)?;
        instron::codec::movement(&answer).ok_or_else(|| no_reading(answer, "no movement status"))
    }

    /// The emergency stop is a flag; any other trip makes the rig unsuitable.
    fn ask_status(&mut self, raw: &mut Vec<Vec<u8>>) -> Result<Flags, DeviceFault> {
        let answer = self.ask(Question::Status, raw)?;
        let status =
            instron::codec::status(&answer).ok_or_else(|| no_reading(answer, "no status"))?;
        match status.trouble {
            Some(Trouble::EmergencyStop) => {
                return Ok(Flags {
                    emergency_stop: true,
                    ..Flags::default()
                });
            }
            // The device does not report which of the two it is.
            Some(Trouble::TravelLimit) => {
                return Ok(Flags {
                    limit_high: true,
                    limit_low: true,
                    ..Flags::default()
                });
            }
            Some(trouble) => return Err(DeviceFault::Unfit(trouble.to_string())),
            None => {}
        }
        if status.actuator_off {
            Err(DeviceFault::Unfit("the actuator is off".to_owned()))
        } else {
            Ok(Flags::default())
        }
    }

    fn wait_for_poll(&mut self) -> Result<(), DeviceFault> {
        if let Some(polled) = self.polled {
            let wait = polled + BETWEEN_POLLS - self.client.now();
            if wait > 0.0 {
                self.client.sleep(wait)?;
            }
        }
        self.polled = Some(self.client.now());
        Ok(())
    }

    /// Prepares the ramp until it is read back as it was sent. Nothing moves yet.
    fn make_ready(&mut self, frames: &[Vec<u8>]) -> Result<(), DeviceFault> {
        let (target, seconds) = instron::codec::decoded_ramp(frames)
            .ok_or_else(|| DeviceFault::Unfit("this is not a ramp".to_owned()))?;
        let mut raw = Vec::new();
        for _ in 0..TRIES {
            self.client.send(&frames.concat())?;
            let read_back = [
                self.number(Question::Target, &mut raw),
                self.number(Question::RampTime, &mut raw),
            ];
            match read_back {
                [Ok(to), Ok(within)]
                    if (to - target).abs() <= SAME_TARGET
                        && (within - seconds).abs() <= SAME_TIME =>
                {
                    return Ok(());
                }
                [
                    Err(fault @ (DeviceFault::Lost { .. } | DeviceFault::Interrupted)),
                    _,
                ]
                | [
                    _,
                    Err(fault @ (DeviceFault::Lost { .. } | DeviceFault::Interrupted)),
                ] => return Err(fault),
                _ => self.client.line_statistics_mut().resent += 1,
            }
        }
        Err(DeviceFault::Refused {
            reason: "its ramp differs from the ramp that was sent".to_owned(),
        })
    }

    /// The travel to a target \[m\]. The line has no checksum, and the time of the ramp follows from the travel: a position that jumped is
    /// replaced by the median of the last three. Of two, the longer travel is the slower one.
    fn travel(&self, target: f64) -> Option<f64> {
        let travel = |position: f64| (target - position).abs();
        match *self.last {
            [] => None,
            [before, last] => Some(travel(before).max(travel(last))),
            [.., first, before, last] => {
                let mut sorted = [first, before, last];
                sorted.sort_by(f64::total_cmp);
                let jumped = (last - before).abs() > (before - first).abs();
                Some(travel(if jumped { sorted[1] } else { last }))
            }
            [last] => Some(travel(last)),
        }
    }

    /// The full scale of a channel, as two answers in turn give it: every reading is multiplied by it, and the line has no checksum.
    fn ask_full_scale(&mut self, channel: Channel) -> Result<(f64, Vec<u8>), DeviceFault> {
        let mut before = None;
        for _ in 0..=TRIES {
            self.wait_for_poll()?;
            let mut raw = Vec::new();
            let full_scale = self.number_twice_if_zero(Question::FullScale(channel), &mut raw)?;
            if before == Some(full_scale) {
                // If one of the two readings was a false zero, the other number is kept.
                return Ok((full_scale, raw.pop().unwrap_or_default()));
            }
            before = Some(full_scale);
        }
        Err(DeviceFault::Unfit(format!(
            "the full scale of its {channel} channel differs between two questions"
        )))
    }

    /// Whether it runs, or has already arrived.
    fn is_moving_to(&mut self, target: f64) -> Result<bool, DeviceFault> {
        let mut raw = Vec::new();
        if self.ask_movement(&mut raw)? == Movement::Running {
            return Ok(true);
        }
        let here = self.feedback(Channel::Position, &mut raw)?;
        let travel = self.travel(target).unwrap_or(0.0);
        Ok((target - here).abs() <= (travel / 2.0).max(SAME_TARGET * self.position.full_scale))
    }
}

impl Device for Instron {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        let mut raw = Vec::new();
        for channel in [Channel::Position, Channel::Load] {
            let (full_scale, answer) = self.ask_full_scale(channel)?;
            raw.push(answer);
            if !(0.0 < full_scale && full_scale.is_finite()) {
                return Err(DeviceFault::Unfit(format!(
                    "the full scale of its {channel} channel is {full_scale}"
                )));
            }
            self.reader(channel).full_scale = full_scale;
        }
        let flags = self.sample()?.channels[0].flags;
        if flags != Flags::default() {
            let trouble = if flags.emergency_stop {
                Trouble::EmergencyStop
            } else {
                Trouble::TravelLimit
            };
            return Err(DeviceFault::Unfit(trouble.to_string()));
        }
        Ok(introduced(raw))
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        let target = one_axis(targets)?;
        let unsayable = || {
            DeviceFault::Unfit(format!(
                "the console cannot express {target} m at {speed} m/s"
            ))
        };
        let full_scale = self.position.full_scale;
        let rounded = instron::codec::ramp(target / full_scale, 0.0).ok_or_else(unsayable)?;
        let (fraction, _) = instron::codec::decoded_ramp(&rounded).ok_or_else(unsayable)?;
        let travel = self.travel(fraction * full_scale).ok_or_else(|| {
            DeviceFault::Unfit("its position is not known: read it first".to_owned())
        })?;
        let mut frames = instron::codec::ramp(fraction, travel / speed).ok_or_else(unsayable)?;
        let (fraction, seconds) = instron::codec::decoded_ramp(&frames).ok_or_else(unsayable)?;
        frames.extend(instron::codec::start());
        // The time was rounded up.
        let speed = if travel > 0.0 {
            (travel / seconds).min(speed)
        } else {
            speed
        };
        Ok(DeviceMove {
            frames,
            targets: vec![meant_by(fraction * full_scale, target)],
            speed,
            id: None,
        })
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let start = instron::codec::start();
        let ready = going.frames.len().saturating_sub(start.len());
        self.make_ready(&going.frames[..ready])?;
        for _ in 0..TRIES {
            self.client.send(&start.concat())?;
            if self.is_moving_to(going.targets[0])? {
                return Ok(());
            }
            self.client.line_statistics_mut().resent += 1;
        }
        Err(DeviceFault::Refused {
            reason: "it does not start to move".to_owned(),
        })
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        self.wait_for_poll()?;
        let mut raw = Vec::new();
        let flags = self.ask_status(&mut raw)?;
        let moving = self.ask_movement(&mut raw)? == Movement::Running;
        let displacement = self.feedback(Channel::Position, &mut raw)?;
        let force = self.feedback(Channel::Load, &mut raw)?;
        if self.last.len() == LAST {
            self.last.remove(0);
        }
        self.last.push(displacement);
        let axis = controllers::Channel {
            displacement: Some(displacement),
            force: Some(Force::Newtons(force)),
            flags,
        };
        Ok(Sample {
            time: None,
            moving: Some(moving),
            channels: vec![axis],
            raw,
        })
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        for _ in 0..TRIES {
            self.client.send(&instron::codec::hold().concat())?;
            if self.ask_movement(&mut Vec::new())? != Movement::Running {
                return Ok(());
            }
            self.client.line_statistics_mut().resent += 1;
        }
        Err(DeviceFault::Refused {
            reason: "it does not hold".to_owned(),
        })
    }

    fn emergency(&self) -> Vec<u8> {
        instron::codec::hold().concat()
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

/// The identity of a console, from these replies: the full scales of position and load.
pub fn introduced(raw: Vec<Vec<u8>>) -> DeviceIdentity {
    DeviceIdentity {
        model: "Instron 8800-style console".to_owned(),
        raw,
        ..DeviceIdentity::default()
    }
}

/// The target \[m\] of a ramp from its bytes: a difference in the last bit of the float is ignored.
fn meant_by(decoded: f64, target: f64) -> f64 {
    if (decoded - target).abs() <= 4.0 * f64::EPSILON * target.abs() {
        target
    } else {
        decoded
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
