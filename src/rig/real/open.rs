//! Opening a real rig. In: the plan's rig and its devices. Out: a rig that has the identity stated in the plan, has
//! received the limits and was read once, or the reason why not. Nothing moves.

use super::coordinate::Coordinate;
use super::halt::READINGS;
use super::median::representative;
use super::validity::ReadingValidator;
use super::{Axis, DeviceRole, RealRig, degrees_of_freedom};
use crate::controllers::{Device, DeviceFault, DeviceIdentity, metres};
use crate::transport::Clock;
use crate::{Identity, Live, Rig as _, RigFault, StopRequest, named_axis};
use psd_plan::{AxialAxis, Behind, Datum, DeviceLink, Limits, RealLink, RigPlan};

impl RealRig {
    /// Requests the identity of both devices, sends them the limits and reads once. If the plan's zero is the present
    /// position, that is read first: the median of several readings, because every later position counts from it.
    ///
    /// # Errors
    /// A device does not answer, is not the one in the plan, or is not suitable; or the reading cannot be used.
    pub fn open(
        plan: &RigPlan,
        limits: &Limits,
        actuator: Box<dyn Device>,
        load_cell: Option<Box<dyn Device>>,
        clock: Box<dyn Clock>,
        stop_request: StopRequest,
    ) -> Result<Self, RigFault> {
        let link = plan
            .link
            .as_real()
            .ok_or_else(|| RigFault::Device("the plan's rig is not a real rig".to_owned()))?
            .clone();
        let began = clock.now();
        let mut rig = Self {
            settle: plan.settle,
            axes: axes(plan, &link, limits),
            identity: unidentified(&plan.name),
            introduction: Vec::new(),
            actuator,
            load_cell,
            clock,
            stop_request,
            began,
            last_contact: began,
            proposed: None,
            settled: None,
            rested: Vec::new(),
            seen_speed: None,
            broken: None,
            seen_positions: Vec::new(),
            reread: 0,
            moved: false,
            untrusted: None,
            deaf: false,
            hold_failure: String::new(),
            live: Live::default(),
            link,
        };
        rig.identify_devices()?;
        rig.count_axes()?;
        match rig.link.datum.clone() {
            Datum::Machine => {}
            Datum::Here => {
                rig.note_contact();
                rig.verify_at_rest()?;
                let mut readings = Vec::new();
                for _ in 0..READINGS {
                    readings.push(rig.settled_reading()?.displacement);
                }
                let here = |axis: usize| {
                    let read = readings.iter().map(|positions| positions[axis]).collect();
                    rig.axes[axis].coordinate.at_device(representative(read))
                };
                let own: Vec<f64> = (0..rig.axes.len()).map(here).collect();
                rig.begin_at(&own)?;
            }
            Datum::At(positions) => rig.begin_at(&positions)?,
        }
        rig.send_limits()?;
        rig.note_contact();
        rig.verify_at_rest()?;
        Ok(rig)
    }

    /// One device was not polled while another was identified.
    pub(super) fn note_contact(&mut self) {
        self.last_contact = self.clock.now();
        let _ = self.stop_request.take_line_gap();
    }

    /// The plan's zero is at these positions of the devices \[m\], one per axis.
    fn begin_at(&mut self, positions: &[f64]) -> Result<(), RigFault> {
        if positions.len() != self.axes.len()
            || !positions.iter().all(|position| position.is_finite())
        {
            return Err(RigFault::Device(format!(
                "{} is not a datum of a rig with {}",
                metres(positions),
                degrees_of_freedom(self.axes.len())
            )));
        }
        for (axis, position) in self.axes.iter_mut().zip(positions) {
            axis.coordinate.datum = *position;
        }
        Ok(())
    }

    /// Reads once; a rig that moves without a command is held.
    fn verify_at_rest(&mut self) -> Result<(), RigFault> {
        if self.poll()?.moving == Some(true) {
            self.hold();
            return Err(RigFault::Device(
                "it was already moving before any command: rig put on hold".to_owned(),
            ));
        }
        Ok(())
    }

    /// Requests the identity of every device.
    fn identify_devices(&mut self) -> Result<(), RigFault> {
        let actuator = self
            .actuator
            .identify()
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        // Several devices of one role each check their own serial number.
        let alone = |behind: Vec<Behind<'_>>| match behind.as_slice() {
            [one] => Some(one.link.clone()),
            _ => None,
        };
        let fit = alone(self.link.actuators()).map_or(Ok(()), |link| pinned(&link, &actuator));
        fit.map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        let mut identities = vec![actuator];
        let cell_link = alone(self.link.load_cells());
        if let Some(cell) = &mut self.load_cell {
            let fit = |identity: &DeviceIdentity| {
                cell_link.map_or(Ok(()), |link| pinned(&link, identity))
            };
            let met = cell
                .identify()
                .and_then(|identity| fit(&identity).map(|()| identity));
            identities.push(met.map_err(|fault| self.device_fault(DeviceRole::LoadCell, &fault))?);
        }
        self.identity = identity_of(&self.identity.name, &self.link, &identities);
        self.introduction = identities
            .into_iter()
            .flat_map(|identity| identity.raw)
            .collect();
        Ok(())
    }

    /// Whether the devices have exactly as many axes as the plan.
    fn count_axes(&mut self) -> Result<(), RigFault> {
        let wanted = self.axes.len();
        let cell = self
            .load_cell
            .as_ref()
            .map(|cell| (DeviceRole::LoadCell, cell.axes()));
        let other = [Some((DeviceRole::Actuator, self.actuator.axes())), cell]
            .into_iter()
            .flatten()
            .find(|(_, axes)| *axes != wanted);
        other.map_or(Ok(()), |(part, axes)| {
            let wanted = degrees_of_freedom(wanted);
            Err(self.device_fault(
                part,
                &DeviceFault::Unfit(format!("it has {axes}, but the plan's rig has {wanted}")),
            ))
        })
    }

    /// Sends the limits to the devices, in their own polarity, and which axes are in force control.
    pub(super) fn send_limits(&mut self) -> Result<(), RigFault> {
        let own: Vec<Limits> = self
            .axes
            .iter()
            .map(|axis| axis.coordinate.limits_at_device(&axis.limits))
            .collect();
        self.actuator
            .narrow_limits(&own)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        if let Some(cell) = &mut self.load_cell {
            cell.narrow_limits(&own)
                .map_err(|fault| self.device_fault(DeviceRole::LoadCell, &fault))?;
        }
        let axial: Vec<Option<AxialAxis>> = self.axes.iter().map(|axis| axis.axial).collect();
        self.actuator
            .control_force(&axial)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))
    }
}

/// The identity of a rig with this name and these devices, the actuators first.
pub(super) fn identity_of(name: &str, link: &RealLink, identities: &[DeviceIdentity]) -> Identity {
    let all = |field: fn(&DeviceIdentity) -> &str| {
        identities
            .iter()
            .map(field)
            .filter(|text| !text.is_empty())
            .collect::<Vec<_>>()
            .join(" + ")
    };
    let loop_open = if commands_only(link) {
        " (open loop: displacement as commanded)"
    } else {
        ""
    };
    let moves = &identities[..identities.len().min(link.actuators().len())];
    let boots: Vec<&str> = moves
        .iter()
        .filter_map(|identity| identity.boot.as_deref())
        .collect();
    Identity {
        name: name.to_owned(),
        model: all(|identity| &identity.model) + loop_open,
        serial: all(|identity| &identity.serial),
        firmware: all(|identity| &identity.firmware),
        boot: (!boots.is_empty()).then(|| boots.join(" + ")),
        simulated: identities.iter().any(|identity| identity.simulated),
    }
}

/// The settings of each axis in the plan.
fn axes(plan: &RigPlan, link: &RealLink, limits: &Limits) -> Vec<Axis> {
    let count = plan.axes().unwrap_or(1);
    let axial_of = |index: usize| link.axes.get(index).and_then(|axis| axis.axial);
    let axis = |index| Axis {
        coordinate: Coordinate::of_sign(plan.polarity_of(index)),
        limits: plan.limits_of(index, limits),
        rules: link.readings_of(index),
        calibration: plan.calibration_of(index),
        has_own_load_cell: link
            .load_cells()
            .iter()
            .any(|cell| cell.axes.contains(&index)),
        validator: ReadingValidator::of_axis(named_axis(index, count), axial_of(index).is_some()),
        axial: axial_of(index),
        outside: false,
        span: 0.0,
        allowed_range: None,
        off: false,
    };
    (0..count).map(axis).collect()
}

/// Whether the position of the actuator is not measured.
#[must_use]
pub const fn commands_only(link: &RealLink) -> bool {
    !link.actuator.dialect.abilities().measures_position
}

fn unidentified(name: &str) -> Identity {
    let unknown = String::new;
    let name = name.to_owned();
    Identity {
        name,
        model: unknown(),
        serial: unknown(),
        firmware: unknown(),
        boot: None,
        simulated: false,
    }
}

/// Compares the serial number of the device with that of the plan, if the plan states one.
fn pinned(link: &DeviceLink, identity: &DeviceIdentity) -> Result<(), DeviceFault> {
    match &link.serial_number {
        Some(wanted) if *wanted != identity.serial => Err(DeviceFault::Unfit(format!(
            "the plan requires serial number `{wanted}`; this device has `{}`",
            identity.serial
        ))),
        _ => Ok(()),
    }
}
