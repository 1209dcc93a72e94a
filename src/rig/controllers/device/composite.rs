//! Several devices of one role as one device: each drives or measures some of the rig's axes, on its own line. In: targets
//! of all axes. Out: one move, one reading. A move is proposed to every device before any of them begins; if one refuses,
//! none begins. It knows no protocol.

use super::{Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Sample};
use crate::{LineStatistics, NO_POWER_UP};
use psd_plan::{Interval, Limits};

/// One of these devices.
pub struct Member {
    pub device: Box<dyn Device>,
    /// Indices of the rig axes that it drives or measures, in the order of its own axes.
    pub axes: Vec<usize>,
    /// Serial number that the device must report.
    pub serial_number: Option<String>,
}

/// All these devices.
pub struct Several {
    members: Vec<Member>,
    /// Axes of the rig.
    axes: usize,
    /// The last encoded move, one entry per device.
    proposed: Vec<DeviceMove>,
    faulty_member: Option<usize>,
}

/// The devices of one role as one device, for a rig with this number of axes. A single device with all axes is returned unchanged.
#[must_use]
pub fn together(mut members: Vec<Member>, axes: usize) -> Option<Box<dyn Device>> {
    if members.len() == 1 && members[0].axes.iter().copied().eq(0..axes) {
        return members.pop().map(|member| member.device);
    }
    if members.is_empty() {
        return None;
    }
    Some(Box::new(Several {
        members,
        axes,
        proposed: Vec::new(),
        faulty_member: None,
    }))
}

impl Several {
    /// Calls each device in turn; the first one that fails is remembered.
    fn each<T>(
        &mut self,
        mut call: impl FnMut(usize, &mut Member) -> Result<T, DeviceFault>,
    ) -> Result<Vec<T>, DeviceFault> {
        let mut made = Vec::with_capacity(self.members.len());
        for (index, member) in self.members.iter_mut().enumerate() {
            match call(index, member) {
                Ok(value) => made.push(value),
                Err(fault) => {
                    self.faulty_member = Some(index);
                    return Err(fault);
                }
            }
        }
        Ok(made)
    }

    /// Proposes the move to every device. If one refuses, the move is cancelled on those that have accepted.
    fn propose_to_all(&mut self, moves: &[DeviceMove]) -> Result<(), DeviceFault> {
        let offered = self.each(|index, member| member.device.propose(&moves[index]));
        if offered.is_err() {
            let accepted = self.faulty_member.unwrap_or(0);
            for (member, going) in self.members.iter_mut().zip(moves).take(accepted) {
                // A device that did not receive this executes nothing either, because it receives no command to execute.
                member.device.cancel(going).ok();
            }
        }
        offered.map(drop)
    }
}

impl Device for Several {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        let identities = self.each(|_, member| {
            let identity = member.device.identify()?;
            let (has, wanted) = (member.device.axes(), member.axes.len());
            if has != wanted {
                return Err(DeviceFault::Unfit(format!(
                    "it has {has} channels, but {wanted} axes of the rig use it"
                )));
            }
            match &member.serial_number {
                Some(wanted) if *wanted != identity.serial => Err(DeviceFault::Unfit(format!(
                    "the plan requires serial number `{wanted}`; this device has `{}`",
                    identity.serial
                ))),
                _ => Ok(identity),
            }
        })?;
        let all = |field: fn(&DeviceIdentity) -> &str| {
            identities
                .iter()
                .map(field)
                .filter(|text| !text.is_empty())
                .collect::<Vec<_>>()
                .join(" + ")
        };
        let known = identities.iter().any(|identity| identity.boot.is_some());
        let boots: Vec<&str> = identities
            .iter()
            .map(|identity| identity.boot.as_deref().unwrap_or(NO_POWER_UP))
            .collect();
        Ok(DeviceIdentity {
            model: all(|identity| &identity.model),
            serial: all(|identity| &identity.serial),
            firmware: all(|identity| &identity.firmware),
            boot: known.then(|| boots.join(" + ")),
            simulated: identities.iter().any(|identity| identity.simulated),
            raw: identities
                .into_iter()
                .flat_map(|identity| identity.raw)
                .collect(),
        })
    }

    fn axes(&self) -> usize {
        self.axes
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        if targets.len() != self.axes {
            return Err(DeviceFault::Unfit(format!(
                "it has {} axes, not {}",
                self.axes,
                targets.len()
            )));
        }
        let moves = self.each(|_, member| {
            let own: Vec<f64> = member.axes.iter().map(|axis| targets[*axis]).collect();
            member.device.encode(&own, speed)
        })?;
        let mut commanded = targets.to_vec();
        for (member, going) in self.members.iter().zip(&moves) {
            for (axis, target) in member.axes.iter().zip(&going.targets) {
                commanded[*axis] = *target;
            }
        }
        let frames = moves
            .iter()
            .flat_map(|going| going.frames.clone())
            .collect();
        let speed = moves.iter().map(|going| going.speed).fold(0.0, f64::max);
        self.proposed = moves;
        Ok(DeviceMove {
            frames,
            targets: commanded,
            speed,
            id: None,
        })
    }

    fn rounds_first_target(&self) -> bool {
        self.members
            .iter()
            .any(|member| member.device.rounds_first_target())
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let moves = std::mem::take(&mut self.proposed);
        let ours = moves
            .iter()
            .flat_map(|going| &going.frames)
            .eq(going.frames.iter());
        if moves.len() != self.members.len() || !ours {
            return Err(DeviceFault::Unfit(
                "this move is not the last one that was proposed".to_owned(),
            ));
        }
        self.propose_to_all(&moves)?;
        self.each(|index, member| member.device.begin(&moves[index]))?;
        self.each(|index, member| member.device.finish(&moves[index]))
            .map(drop)
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let samples = self.each(|_, member| member.device.sample())?;
        let mut channels = vec![Channel::default(); self.axes];
        for (member, sample) in self.members.iter().zip(&samples) {
            for (axis, channel) in member.axes.iter().zip(&sample.channels) {
                channels[*axis] = *channel;
            }
        }
        let moving = match samples.iter().map(|sample| sample.moving) {
            mut all if all.clone().any(|moving| moving == Some(true)) => {
                all.find(|moving| *moving == Some(true)).flatten()
            }
            mut all => all.all(|moving| moving == Some(false)).then_some(false),
        };
        let raw = samples.into_iter().flat_map(|sample| sample.raw).collect();
        Ok(Sample {
            time: None,
            moving,
            channels,
            raw,
        })
    }

    /// Every device receives the command, also if one of them does not answer.
    fn hold(&mut self) -> Result<(), DeviceFault> {
        let mut held = Ok(());
        for (index, member) in self.members.iter_mut().enumerate() {
            if let Err(fault) = member.device.hold()
                && held.is_ok()
            {
                self.faulty_member = Some(index);
                held = Err(fault);
            }
        }
        held
    }

    /// Each device has a separate line, and is armed there.
    fn emergency(&self) -> Vec<u8> {
        Vec::new()
    }

    fn narrow_limits(&mut self, limits: &[Limits]) -> Result<(), DeviceFault> {
        let own = |axes: &[usize]| {
            axes.iter()
                .filter_map(|axis| limits.get(*axis).copied())
                .collect::<Vec<Limits>>()
        };
        self.each(|_, member| member.device.narrow_limits(&own(&member.axes)))
            .map(drop)
    }

    /// None if one of the devices does not report its own.
    fn reported_range(&self) -> Option<Vec<Interval>> {
        let mut ranges = vec![Interval::ALL; self.axes];
        for member in &self.members {
            for (axis, range) in member.axes.iter().zip(member.device.reported_range()?) {
                ranges[*axis] = range;
            }
        }
        Some(ranges)
    }

    fn faulty_member(&self) -> Option<usize> {
        self.faulty_member
    }

    fn line_statistics(&self) -> LineStatistics {
        self.members
            .iter()
            .map(|member| member.device.line_statistics())
            .fold(LineStatistics::default(), LineStatistics::plus)
    }
}
