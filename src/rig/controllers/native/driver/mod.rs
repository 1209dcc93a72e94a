//! Driver for psd's own protocol. In: moves and requests in SI. Out: replies that are complete, in order and from the same
//! power-up. `codec` knows the bytes. It does not validate a reading.

use crate::controllers::native;
use crate::controllers::native::codec::{
    AxisBounds, Bounds, Hello, Reply, ReplyKind, ReportedState, Request,
};
use crate::controllers::{
    Answer, Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Force, LineClient, Sample,
};
use crate::controllers::{metres, number};
use crate::safety::failpoint::{Guarding, on};
use crate::{LastMove, LineStatistics};
use psd_physics::tracking::trajectory::Path;
use psd_plan::{AxialAxis, Interval, Limits};

mod path;

/// Start of the model name of a simulator.
pub const SIMULATED: &str = "PSD-SIM";

/// The firmware at the other end of a line.
pub struct NativeDevice {
    client: LineClient,
    /// Sequence number of the last request.
    sequence: u32,
    boot: Option<String>,
    hello: Option<Hello>,
    /// The reply with its identity.
    introduction: Vec<u8>,
    /// The limits of this run, as they were sent.
    narrowed: Option<Bounds>,
    /// The axes in force control, one entry per axis; empty if there is none.
    force_control: Vec<Option<AxialAxis>>,
    /// A request was not answered: rig and program may disagree on its number.
    out_of_step: bool,
    /// Held by this driver: the hold is latched.
    held: bool,
    /// Number of the next move, if none is proposed.
    next_id: u64,
    proposed: Option<RequestedMove>,
}

/// A move that has not been accepted.
struct RequestedMove {
    id: u64,
    /// The targets as they are sent.
    targets: String,
    sent: bool,
}

impl NativeDevice {
    #[must_use]
    pub const fn new(client: LineClient) -> Self {
        Self {
            client,
            sequence: 0,
            boot: None,
            hello: None,
            introduction: Vec::new(),
            narrowed: None,
            force_control: Vec::new(),
            out_of_step: false,
            held: false,
            next_id: 1,
            proposed: None,
        }
    }

    fn hello(&self) -> Result<&Hello, DeviceFault> {
        self.hello
            .as_ref()
            .ok_or_else(|| DeviceFault::Unfit("the rig has not been identified yet".to_owned()))
    }

    /// Sends a request and waits for the reply of this kind, after resynchronising an interrupted conversation.
    fn request(&mut self, request: &Request<'_>, kind: ReplyKind) -> Result<Reply, DeviceFault> {
        if self.out_of_step {
            self.send_hello()?;
            if let Some(bounds) = self.narrowed.clone() {
                self.request(&Request::Limits(&bounds), ReplyKind::Ack)?;
            }
            self.send_force_control()?;
        }
        let frame = framed(self.sequence.wrapping_add(1), request)?;
        self.exchange(&frame, kind)
    }

    /// Sends the frame of the next sequence number.
    fn exchange(&mut self, frame: &[u8], kind: ReplyKind) -> Result<Reply, DeviceFault> {
        self.sequence = self.sequence.wrapping_add(1);
        self.out_of_step = true;
        let (sequence, boot) = (self.sequence, self.boot.as_deref());
        let answered = self
            .client
            .exchange(frame, b"\n", |line| classify(line, sequence, kind, boot))?;
        let refused = answered.kind == ReplyKind::Err;
        self.out_of_step = refused && answered.words().first() == Some(&"SEQ");
        if refused {
            return Err(DeviceFault::Refused {
                reason: native::codec::refusal(&answered.words()),
            });
        }
        Ok(answered)
    }

    /// The last target of an axis, as it was written: mm, or N in force control. In SI.
    fn meaning(&self, axis: usize, written: f64) -> f64 {
        if self.is_in_force_control(axis) {
            written
        } else {
            written / 1e3
        }
    }

    fn is_in_force_control(&self, axis: usize) -> bool {
        self.force_control.get(axis).is_some_and(Option::is_some)
    }

    /// Sends rates and tolerances, if an axis is in force control.
    fn send_force_control(&mut self) -> Result<(), DeviceFault> {
        if self.force_control.is_empty() {
            return Ok(());
        }
        let axes = self.force_control.clone();
        self.request(&Request::Force(&axes), ReplyKind::Ack)?;
        Ok(())
    }

    fn send_hello(&mut self) -> Result<(), DeviceFault> {
        let frame = framed(self.sequence.wrapping_add(1), &Request::Hello)?;
        let reply = self.exchange(&frame, ReplyKind::Ack)?;
        let hello =
            native::codec::hello(&reply.words()).filter(|hello| hello.bounds.allow_something());
        let strange = || {
            DeviceFault::Unfit(format!(
                "`{}` does not identify the rig",
                reply.line.escape_ascii()
            ))
        };
        let hello = hello.ok_or_else(strange)?;
        if let Some(before) = &self.hello
            && before.bounds.axes.len() != hello.bounds.axes.len()
        {
            return Err(strange());
        }
        self.hello = Some(hello);
        self.boot = Some(reply.boot().to_owned());
        self.introduction = reply.line;
        Ok(())
    }

    /// Sends an encoded move or path. Gives the reply to its last frame.
    fn send(&mut self, going: &DeviceMove) -> Result<Option<Reply>, DeviceFault> {
        // The bytes are in the run log before they are sent: they are never encoded again with a different number.
        let next = self.sequence.wrapping_add(1);
        if self.out_of_step
            || going
                .frames
                .first()
                .and_then(|frame| native::codec::sequence(frame))
                != Some(next)
        {
            return Err(DeviceFault::Unfit(
                "the rig received another request after this move was proposed".to_owned(),
            ));
        }
        if let Some(proposed) = &mut self.proposed {
            proposed.sent = true;
        }
        let mut last = None;
        for frame in &going.frames {
            let answered = self.exchange(frame, ReplyKind::Ack)?;
            state(&answered)?;
            last = Some(answered);
        }
        self.next_id = going.id.map_or(self.next_id, |id| id + 1);
        (self.held, self.proposed) = (false, None);
        Ok(last)
    }

    /// The frames of a motion request, in order: a latched hold is cleared first.
    fn frames_of(&self, moving: Request<'_>) -> Result<Vec<Vec<u8>>, DeviceFault> {
        let requests = if self.held {
            vec![Request::Clear, moving]
        } else {
            vec![moving]
        };
        let mut sequence = self.sequence;
        let frames = requests.iter().map(|request| {
            sequence = sequence.wrapping_add(1);
            framed(sequence, request)
        });
        frames.collect()
    }

    /// A request that is answered by the state alone.
    fn command(&mut self, request: &Request<'_>) -> Result<ReportedState, DeviceFault> {
        state(&self.request(request, ReplyKind::Ack)?)
    }
}

fn framed(sequence: u32, request: &Request<'_>) -> Result<Vec<u8>, DeviceFault> {
    native::codec::frame(sequence, request).ok_or_else(|| {
        DeviceFault::Unfit("a number of the request cannot be expressed in a frame".to_owned())
    })
}

/// The identity of a rig from its reply to HELLO.
pub fn native_identity(hello: &Hello, boot: Option<String>) -> DeviceIdentity {
    let Hello {
        model,
        serial,
        firmware,
        ..
    } = hello.clone();
    let simulated = model.starts_with(SIMULATED);
    DeviceIdentity {
        model,
        serial,
        firmware,
        boot,
        simulated,
        raw: Vec::new(),
    }
}

/// The reading of a `DATA` reply with this number of axes.
///
/// # Errors
/// The reply is no reading of this device, or its status forbids one.
pub fn decoded(reply: Reply, axes: usize) -> Result<Sample, DeviceFault> {
    let words = reply.words();
    let Some(data) = native::codec::data(&words).filter(|data| data.axes.len() == axes) else {
        let reason = match native::codec::axis_without_number(&words) {
            Some(axis) => format!("axis {axis} has no number at a required position"),
            None => "a field is missing, superfluous or not a number".to_owned(),
        };
        return Err(DeviceFault::Impossible {
            raw: reply.line,
            reason,
        });
    };
    let channels = data.axes.iter().map(|axis| Channel {
        displacement: Some(axis.displacement),
        force: Some(Force::Newtons(axis.force)),
        flags: axis.flags,
    });
    Ok(Sample {
        time: Some(data.time),
        moving: Some(data.state == ReportedState::Moving),
        channels: channels.collect(),
        raw: vec![reply.line],
    })
}

/// The meaning of a received line for the open request.
fn classify(line: &[u8], sequence: u32, kind: ReplyKind, boot: Option<&str>) -> Answer<Reply> {
    let Ok(reply) = native::codec::reply(line) else {
        return Answer::Ignore;
    };
    if let Some(was) = boot.filter(|was| *was != reply.boot())
        && on(Guarding::Reboot)
    {
        return Answer::Fault(DeviceFault::Rebooted {
            was: was.to_owned(),
            is: reply.boot().to_owned(),
        });
    }
    if reply.sequence != sequence && on(Guarding::Sequence)
        || reply.kind != kind && reply.kind != ReplyKind::Err
    {
        return Answer::Ignore;
    }
    Answer::Take(reply)
}

fn state(reply: &Reply) -> Result<ReportedState, DeviceFault> {
    let word = reply
        .words()
        .first()
        .and_then(|word| native::codec::state(word));
    word.ok_or_else(|| DeviceFault::NoReading {
        raw: reply.line.clone(),
        reason: "it states no state".to_owned(),
    })
}

impl Device for NativeDevice {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.client.drain()?;
        (self.narrowed, self.force_control) = (None, Vec::new());
        self.send_hello()?;
        let reply = self.request(&Request::Status, ReplyKind::Ack)?;
        let flags = reply
            .words()
            .get(1)
            .and_then(|word| native::codec::flags(word));
        let strange = || DeviceFault::NoReading {
            raw: reply.line.clone(),
            reason: "it has no flags".to_owned(),
        };
        let flags = flags.ok_or_else(strange)?;
        if flags.emergency_stop {
            return Err(DeviceFault::Unfit(
                "the emergency stop is pressed".to_owned(),
            ));
        }
        // A force that the controller has left is not applied again without a person's decision.
        if let Some(reason) = flags.left_force_control()
            && !self.client.release_allowed()
        {
            return Err(DeviceFault::Unfit(format!(
                "{reason}. Take the axial load off at the controller, then clear the hold with `--let-go`"
            )));
        }
        // Between two runs the rig receives no frames, so its watchdog has tripped. The start of a run is the operator's
        // act that clears the hold. Within a run it is never cleared.
        if state(&reply)? == ReportedState::Held {
            self.command(&Request::Clear)?;
        }
        (self.held, self.proposed) = (false, None);
        let hello = self.hello()?.clone();
        self.next_id = hello.last.as_ref().map_or(0, |(id, _)| *id) + 1;
        Ok(DeviceIdentity {
            raw: vec![self.introduction.clone()],
            ..native_identity(&hello, self.boot.clone())
        })
    }

    fn axes(&self) -> usize {
        self.hello
            .as_ref()
            .map_or(1, |hello| hello.bounds.axes.len())
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        let bounds = &self.hello()?.bounds;
        if self.out_of_step {
            return Err(DeviceFault::Unfit(
                "an answer is missing: the rig must be read before it moves again".to_owned(),
            ));
        }
        if targets.len() != bounds.axes.len() {
            return Err(DeviceFault::Unfit(format!(
                "it has {} axes, not {}",
                bounds.axes.len(),
                targets.len()
            )));
        }
        let unsaid = || {
            DeviceFault::Unfit(format!(
                "a move to {} at {speed} m/s cannot be expressed in a frame",
                metres(targets)
            ))
        };
        // A length in mm, or a force in N: as written, and read back.
        let target = |(axis, target): (usize, &f64)| {
            let (text, per_unit) = if self.is_in_force_control(axis) {
                (native::codec::force(*target)?, 1.0)
            } else {
                (native::codec::length(*target)?, 1e3)
            };
            let encoded = number::read_back(&text, per_unit, *target)?;
            Some((text, encoded))
        };
        let each: Option<(Vec<String>, Vec<f64>)> =
            targets.iter().enumerate().map(target).collect();
        let (written, targets) = each.ok_or_else(unsaid)?;
        let written = written.join(" ");
        let rate = native::codec::length(speed).ok_or_else(unsaid)?;
        let speed = number::read_back(&rate, 1e3, speed).ok_or_else(unsaid)?;
        let is_inside = |(axis, (bounds, target)): (usize, (&AxisBounds, &f64))| {
            let allowed = if self.is_in_force_control(axis) {
                bounds.force
            } else {
                bounds.displacement
            };
            allowed.contains(*target)
        };
        if !bounds.axes.iter().zip(&targets).enumerate().all(is_inside) {
            let units = if self.force_control.is_empty() {
                "mm"
            } else {
                "mm or N"
            };
            return Err(DeviceFault::Refused {
                reason: format!("{written} {units} is outside the limits that the rig reports"),
            });
        }
        // A speed that rounds to zero would never arrive.
        if !(0.0 < speed && speed <= bounds.top_speed) {
            return Err(DeviceFault::Refused {
                reason: format!("{} mm/s is not a valid speed of this rig", speed * 1e3),
            });
        }
        let id = match &self.proposed {
            Some(proposed) if proposed.targets == written || !proposed.sent => proposed.id,
            // The rig may have received different targets under this number.
            Some(proposed) => proposed.id + 1,
            None => self.next_id,
        };
        let frames = self.frames_of(Request::Move {
            id,
            targets: &written,
            speed: &rate,
        })?;
        let sent = self
            .proposed
            .as_ref()
            .is_some_and(|proposed| proposed.sent && proposed.id == id);
        self.proposed = Some(RequestedMove {
            id,
            targets: written,
            sent,
        });
        Ok(DeviceMove {
            frames,
            targets,
            speed,
            id: Some(id),
        })
    }

    fn encode_path(&mut self, paths: &[Path]) -> Result<DeviceMove, DeviceFault> {
        self.glide_move(paths)
    }

    fn start_path(&mut self, going: &DeviceMove) -> Result<f64, DeviceFault> {
        let Some(reply) = self.send(going)? else {
            return Err(nothing_to_send());
        };
        let strange = || DeviceFault::NoReading {
            raw: reply.line.clone(),
            reason: "it does not report the length of the path".to_owned(),
        };
        native::codec::left(&reply.words()).ok_or_else(strange)
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        self.send(going)?.map(drop).ok_or_else(nothing_to_send)
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let reply = self.request(&Request::Measure { readings: 1 }, ReplyKind::Data)?;
        decoded(reply, self.axes())
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        self.client.send(&self.emergency())?;
        self.held = true;
        let reported = match self.command(&Request::Stop)? {
            ReportedState::Held => return Ok(()),
            ReportedState::Moving => "that it moves",
            ReportedState::Idle => "no hold",
        };
        Err(DeviceFault::Unfit(format!(
            "after the hold command the rig reports {reported}"
        )))
    }

    fn emergency(&self) -> Vec<u8> {
        b"!".to_vec()
    }

    fn narrow_limits(&mut self, limits: &[Limits]) -> Result<(), DeviceFault> {
        let own = &self.hello()?.bounds;
        if limits.len() != own.axes.len() {
            return Err(DeviceFault::Unfit(format!(
                "it has {} axes, not {}",
                own.axes.len(),
                limits.len()
            )));
        }
        let narrower = |(own, limits): (&AxisBounds, &Limits)| AxisBounds {
            displacement: own.displacement.intersection(limits.displacement),
            force: own.force.intersection(limits.force),
        };
        let bounds = Bounds {
            axes: own.axes.iter().zip(limits).map(narrower).collect(),
            top_speed: limits
                .iter()
                .map(|limits| limits.speed.high)
                .fold(own.top_speed, f64::min),
        };
        if !bounds.allow_something() {
            return Err(DeviceFault::Unfit(
                "the limits of the plan and the limits of the rig do not overlap".to_owned(),
            ));
        }
        self.command(&Request::Limits(&bounds))?;
        self.narrowed = Some(bounds);
        Ok(())
    }

    fn control_force(&mut self, axes: &[Option<AxialAxis>]) -> Result<(), DeviceFault> {
        if axes.iter().all(Option::is_none) {
            return Ok(());
        }
        self.force_control = axes.to_vec();
        self.send_force_control().map_err(|fault| match fault {
            DeviceFault::Refused { reason } => {
                let firmware = self.hello.as_ref().map_or("", |hello| &hello.firmware);
                DeviceFault::Unfit(format!(
                    "its firmware {firmware} cannot hold an axial force: {reason}"
                ))
            }
            fault => fault,
        })
    }

    fn reported_range(&self) -> Option<Vec<Interval>> {
        let axes = &self.hello.as_ref()?.bounds.axes;
        Some(axes.iter().map(|axis| axis.displacement).collect())
    }

    fn last_move(&self) -> Option<LastMove> {
        let (id, written) = self.hello.as_ref()?.last.as_ref()?;
        let targets = written.iter().enumerate();
        Some(LastMove {
            id: *id,
            targets: targets
                .map(|(axis, written)| self.meaning(axis, *written))
                .collect(),
        })
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

fn nothing_to_send() -> DeviceFault {
    DeviceFault::Unfit("there are no bytes to send".to_owned())
}

#[cfg(test)]
mod tests;
