//! Assignment of devices to axes: the rig's own devices for every axis without a device, and those of the axes. In: devices and axes as
//! written. Out: nothing, or the reason why they do not fit together. It opens no port.

use super::axes::CheckedAxis;
use super::device::Device;
use crate::check::checker::Checker;
use crate::check::messages::{axes as message, rigs};
use psd_plan::schema::rig as schema;
use psd_plan::{Abilities, Dialect};

/// Checks that one device moves every axis and one device measures its force. No device is without an axis, and none has more axes than
/// it supports.
pub fn check(
    checker: &mut Checker,
    block: usize,
    actuator: &Device,
    load_cell: Option<&Device>,
    axes: &[CheckedAxis],
) -> Option<()> {
    let count = axes.len().max(1);
    let without = |own: fn(&CheckedAxis) -> Option<&Device>| {
        count - axes.iter().filter(|axis| own(axis).is_some()).count()
    };
    let movers = |axis: &CheckedAxis| axis.actuator.is_some();
    let (moved, measured) = (
        without(|axis| axis.actuator.as_ref()),
        without(|axis| axis.load_cell.as_ref()),
    );
    let unfit = |own: fn(&CheckedAxis) -> Option<&Device>, fit: fn(Abilities) -> bool| {
        axes.iter()
            .filter_map(own)
            .find(|device| !fit(device.link.dialect.abilities()))
    };
    if let Some(device) = unfit(|axis| axis.actuator.as_ref(), |can| can.moves) {
        return checker.fail(rigs::cannot_move(
            schema::ACTUATOR.name,
            &device.link.dialect,
            device.dialect_at,
        ));
    }
    if let Some(device) = unfit(|axis| axis.load_cell.as_ref(), |can| can.measures_force) {
        return checker.fail(rigs::cannot_measure_force(
            true,
            schema::LOAD_CELL.name,
            &device.link.dialect,
            device.dialect_at,
        ));
    }
    let idle = [(moved, Some(actuator)), (measured, load_cell)]
        .into_iter()
        .find(|(left, device)| *left == 0 && device.is_some());
    if let Some((_, Some(device))) = idle {
        return checker.fail(message::no_axis_left(device.at));
    }
    // If one device refuses a move, none may begin it: each must support a proposal before the command.
    let all =
        std::iter::once(actuator).chain(axes.iter().filter_map(|axis| axis.actuator.as_ref()));
    let rash = all
        .clone()
        .find(|device| !device.link.dialect.abilities().proposes);
    if let (true, Some(device)) = (axes.iter().any(movers), rash) {
        return checker.fail(message::not_asked(&device.link.dialect, device.dialect_at));
    }
    if let Some((_, written)) = checker
        .field(block, schema::AXES.name)
        .filter(|_| moved > actuator.link.dialect.abilities().most_axes)
    {
        return checker.fail(message::too_many(
            moved,
            actuator.link.dialect.abilities().most_axes,
            &actuator.link.dialect,
            written.value.span,
        ));
    }
    let own = |device: fn(&CheckedAxis) -> Option<&Device>| {
        axes.iter()
            .filter_map(move |axis| device(axis))
            .map(|device| (1, device))
    };
    let driving = std::iter::once((moved, actuator)).chain(own(|axis| axis.actuator.as_ref()));
    for (behind, device) in driving {
        points(checker, behind, device)?;
    }
    let load_cell_device = load_cell
        .map(|device| (measured, device))
        .into_iter()
        .chain(own(|axis| axis.load_cell.as_ref()));
    for (behind, device) in load_cell_device {
        channels(checker, behind, device)?;
    }
    let cells = axes.iter().filter_map(|axis| axis.load_cell.as_ref());
    ports(
        checker,
        &all.chain(load_cell).chain(cells).collect::<Vec<&Device>>(),
    )
}

/// Every axis has one control point, and every control point one axis.
fn points(checker: &mut Checker, axes: usize, device: &Device) -> Option<()> {
    match &device.link.dialect {
        Dialect::Nees { control_points } if control_points.len() != axes => checker.fail(
            message::control_points(control_points.len(), axes, device.at),
        ),
        _ => Some(()),
    }
}

/// One channel for each axis of the device. `native` reports the number of its channels itself, when it is identified.
fn channels(checker: &mut Checker, behind: usize, device: &Device) -> Option<()> {
    let dialect = &device.link.dialect;
    let has = match dialect {
        Dialect::Native => behind.min(dialect.abilities().most_channels),
        _ => dialect.abilities().most_channels,
    };
    match dialect {
        Dialect::Nees { .. } => points(checker, behind, device),
        _ if has == behind => Some(()),
        _ => checker.fail(message::channels(has, behind, dialect, device.dialect_at)),
    }
}

/// Each device has its own port.
fn ports(checker: &mut Checker, devices: &[&Device]) -> Option<()> {
    for (index, device) in devices.iter().enumerate() {
        let same = |other: &&&Device| other.link.port.to_string() == device.link.port.to_string();
        if let Some(first) = devices[..index].iter().find(same) {
            return checker.fail(rigs::port_twice(
                &device.link.port,
                device.port_at,
                first.port_at,
            ));
        }
    }
    Some(())
}
