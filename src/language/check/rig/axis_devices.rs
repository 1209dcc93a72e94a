//! Assignment of devices to axes: the rig's own devices for every axis without a device, and those of the axes. In: devices and axes as
//! written. Out: nothing, or the reason why they do not fit together. It opens no port.

use crate::check::checker::Checker;
use crate::check::violations::{DeviceCannotMeasureForce, DeviceCannotMove};
use crate::check::wording::axes_of;
use crate::codes::{E611, E615, E616, E636, E637};
use psd_plan::schema::rig as schema;
use psd_plan::{Abilities, Dialect, PortPlan};
use psd_text::count::counted_in_words;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

use super::axes::CheckedAxis;
use super::device::Device;

#[derive(Violation)]
#[violation(E636, "device without an axis: every axis has a separate one")]
#[help("remove the separate device of one axis, or remove this device if it is the `load_cell`")]
struct NoAxisLeft {
    #[label("no axis left")]
    at: Span,
}

#[derive(Violation)]
#[violation(
    E637,
    "`{}` cannot confirm a move before it starts, so it cannot share a rig of several axes",
    dialect.name()
)]
#[help(
    "use one controller for all axes, such as `native`, or `nees` sites, which confirm before they move"
)]
struct CannotConfirmMove<'a> {
    dialect: &'a Dialect,
    #[label("moves immediately")]
    at: Span,
}

#[derive(Violation)]
#[violation(E616, "too many axes for `{}`: {axes} (at most {})", dialect.name(), axes_of(most))]
#[help("use one controller at one `link` that moves all axes together: `native` or `nees`")]
struct TooManyAxes<'a> {
    axes: usize,
    most: usize,
    dialect: &'a Dialect,
    #[label("{}", axes_of(axes))]
    at: Span,
}

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
        return checker.fail(DeviceCannotMove {
            field: schema::ACTUATOR.name,
            dialect: &device.link.dialect,
            at: device.dialect_at,
        });
    }
    if let Some(device) = unfit(|axis| axis.load_cell.as_ref(), |can| can.measures_force) {
        return checker.fail(DeviceCannotMeasureForce {
            own: true,
            field: schema::LOAD_CELL.name,
            dialect: &device.link.dialect,
            at: device.dialect_at,
        });
    }
    let idle = [(moved, Some(actuator)), (measured, load_cell)]
        .into_iter()
        .find(|(left, device)| *left == 0 && device.is_some());
    if let Some((_, Some(device))) = idle {
        return checker.fail(NoAxisLeft { at: device.at });
    }
    // If one device refuses a move, none may begin it: each must support a proposal before the command.
    let all =
        std::iter::once(actuator).chain(axes.iter().filter_map(|axis| axis.actuator.as_ref()));
    let rash = all
        .clone()
        .find(|device| !device.link.dialect.abilities().proposes);
    if let (true, Some(device)) = (axes.iter().any(movers), rash) {
        return checker.fail(CannotConfirmMove {
            dialect: &device.link.dialect,
            at: device.dialect_at,
        });
    }
    if let Some((_, written)) = checker
        .field(block, schema::AXES.name)
        .filter(|_| moved > actuator.link.dialect.abilities().most_axes)
    {
        return checker.fail(TooManyAxes {
            axes: moved,
            most: actuator.link.dialect.abilities().most_axes,
            dialect: &actuator.link.dialect,
            at: written.value.span,
        });
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

struct ControlPointsDiffer {
    points: usize,
    axes: usize,
    at: Span,
}

impl Violation for ControlPointsDiffer {
    const CODE: Code = E615;

    fn diagnostic(self) -> Diagnostic {
        let Self { points, axes, at } = self;
        let named = counted_in_words(points, "control point", "control points");
        let names: Vec<String> = (1..=axes.max(2))
            .map(|axis| format!("MDL-00-{axis:02}"))
            .collect();
        let help = format!(
            "write one control point per axis, the lowest storey first, separated by commas, as in `nees(\"{}\")`; list as many `axes`",
            names.join(", ")
        );
        Diagnostic::new(
            Self::CODE,
            format!(
                "{named} cannot drive {}: every axis has a separate device",
                axes_of(axes)
            ),
        )
        .at(at, named)
        .help(help)
    }
}

/// Every axis has one control point, and every control point one axis.
fn points(checker: &mut Checker, axes: usize, device: &Device) -> Option<()> {
    match &device.link.dialect {
        Dialect::Nees { control_points } if control_points.len() != axes => {
            checker.fail(ControlPointsDiffer {
                points: control_points.len(),
                axes,
                at: device.at,
            })
        }
        _ => Some(()),
    }
}

struct TooFewChannels<'a> {
    channels: usize,
    axes: usize,
    dialect: &'a Dialect,
    at: Span,
}

impl Violation for TooFewChannels<'_> {
    const CODE: Code = E636;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            channels,
            axes,
            dialect,
            at,
        } = self;
        let has = counted_in_words(channels, "channel", "channels");
        let help = match dialect {
            Dialect::Scpi { .. } => {
                "write the force per unit of each channel, the lowest axis first: `scpi([2.5 kN, 1.2 kN])`"
            }
            Dialect::Native => "use several load cells: an axis can name a separate `load_cell`",
            _ => {
                "add a `load_cell` to each axis, on a separate port, or use a device with several channels: `scpi` or `native`"
            }
        };
        let text = format!(
            "too few channels: `{}` load cell has {has} and must read {}",
            dialect.name(),
            axes_of(axes)
        );
        Diagnostic::new(Self::CODE, text).at(at, has).help(help)
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
        _ => checker.fail(TooFewChannels {
            channels: has,
            axes: behind,
            dialect,
            at: device.dialect_at,
        }),
    }
}

#[derive(Violation)]
#[violation(E611, "two devices on one port, `{}`", port.to_string().escape_debug())]
#[help("write a port for each device, or use `link` for one device that moves and measures force")]
struct PortTwice<'a> {
    port: &'a PortPlan,
    #[label("named again")]
    second: Span,
    #[label("first named here")]
    first: Span,
}

/// Each device has its own port.
fn ports(checker: &mut Checker, devices: &[&Device]) -> Option<()> {
    for (index, device) in devices.iter().enumerate() {
        let same = |other: &&&Device| other.link.port.to_string() == device.link.port.to_string();
        if let Some(first) = devices[..index].iter().find(same) {
            return checker.fail(PortTwice {
                port: &device.link.port,
                second: device.port_at,
                first: first.port_at,
            });
        }
    }
    Some(())
}
