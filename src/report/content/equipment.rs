//! Equipment and calibration: who answered, how it was reached, what its numbers are traced to, what it was held to. In: a
//! run. Out: blocks. Where a port lies on the machine is no part of it.

use super::super::days::last_day;
use super::super::document::{Block, Column, Style, Table, Text};
use super::super::{Run, number, particulars};
use super::conditions::{range, settling};
use super::{pairs, zero_drift};
use crate::plan::{
    Behind, Calibration, DeviceLink, Gate, Interval, PortPlan, ReadingRules, RealLink, VirtualLink,
};
use crate::record::EventKind;
use crate::record::equipment::{Channel, GivenIn};
use crate::units::Dimension;
use crate::units::display::significant;

const UNCERTAINTY: &str = "Standard uncertainty of its calibration";

/// The rig of the run.
pub(super) fn all(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section("Equipment and calibration"));
    match run.plan.rig.link.as_real() {
        Some(link) => {
            body.push(calibration(run));
            body.push(real(run, link));
            body.extend((link.axes.len() > 1).then(|| axes(run, link)));
        }
        None => body.push(simulated(run)),
    }
    zero_drift::all(run, body);
}

/// What is measured, over which range and how well, what that is traced to, and whether it still held on the day of the
/// test: a row a channel.
fn calibration(run: &Run<'_>) -> Block {
    let equipment = run.equipment();
    let several = equipment.channels.iter().any(|channel| channel.axis > 1);
    let row = |channel: &Channel| {
        let axis = if several {
            format!(" {}", channel.axis)
        } else {
            String::new()
        };
        let (certificate, due) = (channel.certificate.as_deref(), channel.due.as_deref());
        vec![
            format!("{}{axis}", channel.measures.name()).into(),
            channel.range.map_or_else(
                || Text::given(None),
                |[low, high]| range(Interval { low, high }, channel.measures.dimension()).into(),
            ),
            Text::given(channel.class.as_deref()),
            factor(channel).into(),
            Text::given(certificate),
            channel.calibrated.map_or_else(
                || Text::given(None),
                |[low, high]| range(Interval { low, high }, channel.measures.dimension()).into(),
            ),
            Text::given(due),
            state(run, due),
        ]
    };
    let columns = vec![
        Column::short("Channel"),
        Column::short("Range"),
        Column::words("Class", 2),
        Column::short("Factor"),
        Column::words("Calibration certificate", 3),
        Column::short("Calibrated over, by size"),
        Column::short("Holds until"),
        Column::short("State"),
    ];
    Block::Table(Table {
        columns,
        rows: equipment.channels.iter().map(row).collect(),
    })
}

/// Whether a calibration held on the last day of the test.
fn state(run: &Run<'_>, due: Option<&str>) -> Text {
    match (due, last_day(run.provenance)) {
        (None, _) => Text::missing("no due date"),
        (Some(due), Some(day)) if due < day => Text::new()
            .with(Style::Fail, "OVERDUE")
            .and(format!(" on {day}")),
        (Some(_), Some(day)) => Text::new()
            .with(Style::Pass, "valid")
            .and(format!(" on {day}")),
        (Some(_), None) => Text::missing("day of the test not known"),
    }
}

/// How the number of a channel becomes a quantity.
fn factor(channel: &Channel) -> String {
    match channel.given_in {
        GivenIn::Units => number::stated(channel.factor, Dimension::NUMBER),
        GivenIn::Counts => format!(
            "{} a count",
            number::stated(channel.factor, channel.measures.dimension())
        ),
    }
}

fn real(run: &Run<'_>, link: &RealLink) -> Block {
    let equipment = run.equipment();
    let identity = &equipment.device.identity;
    let kind = if identity.simulated {
        "a simulated controller on a real line: nothing real moved"
    } else {
        "real"
    };
    let stated = |text: &str| Text::given(Some(text));
    let mut rows = vec![
        ("Rig", run.plan.rig.name.as_str().into()),
        ("Kind", kind.into()),
        ("Model", stated(&identity.model)),
        ("Serial number", stated(&identity.serial)),
        ("Firmware", stated(&identity.firmware)),
    ];
    if let Some(text) = particulars::stated(run, "equipment") {
        rows.push(("Other equipment", text.into()));
    }
    if let Some(boot) = &identity.boot {
        rows.push(("Power-up of the controller", Text::new().id(boot)));
    }
    rows.extend(devices("Actuator", &link.actuators(), link));
    let cells = link.load_cells();
    if cells.is_empty() {
        rows.push(("Load cell", "read by the actuator's controller".into()));
    }
    rows.extend(devices("Load cell", &cells, link));
    for channel in equipment
        .channels
        .iter()
        .filter(|channel| channel.zero != 0.0)
    {
        rows.push((
            "Count at no force",
            number::stated(channel.zero, Dimension::NUMBER).into(),
        ));
    }
    if link.axes.len() < 2 {
        rows.push((
            "Declared of its readings",
            declared(
                equipment.device.resolution,
                equipment.device.noise,
                &link.readings,
            )
            .into(),
        ));
    }
    if link.axes.len() < 2 {
        rows.extend(
            uncertainty(&run.plan.rig.calibration_of(0)).map(|text| (UNCERTAINTY, text.into())),
        );
    }
    rows.push(("Taking a reading", taking(&link.readings).into()));
    rows.push(("Settling", settling(run.plan.rig.settle).into()));
    let watchdog = number::stated(link.watchdog, Dimension::TIME);
    rows.push((
        "Watchdog",
        format!("the rig holds by itself after {watchdog} without a sign of life").into(),
    ));
    rows.push(("Safe state", link.safe_state.name().into()));
    if link.axes.len() < 2 {
        rows.push(("Gate, demanded", demanded(&link.gate_of(0)).into()));
        rows.push(("Gate, found", Text::given(found(run, "gate passed: "))));
    } else if let Some(refused) = told_outside_procedures(run).find_map(refused) {
        rows.push(("Gate, found", refused.into()));
    }
    pairs(rows)
}

/// What each axis of several declares, and how it proved itself.
fn axes(run: &Run<'_>, link: &RealLink) -> Block {
    let axes = 0..link.axes.len();
    let doubts: Vec<Option<String>> = axes
        .clone()
        .map(|axis| uncertainty(&run.plan.rig.calibration_of(axis)))
        .collect();
    let doubted = doubts.iter().any(Option::is_some);
    let row = |axis: usize| {
        let (readings, number) = (link.readings_of(axis), axis + 1);
        let sign = if run.plan.rig.sign_of(axis) < 0.0 {
            "negative"
        } else {
            "positive"
        };
        let mut cells = vec![
            Text::from(number.to_string()),
            sign.into(),
            declared(readings.resolution, readings.noise, &readings).into(),
            demanded(&link.gate_of(axis)).into(),
            Text::given(passed(run, number)),
        ];
        if doubted {
            cells.insert(3, Text::given(doubts[axis].as_deref()));
        }
        cells
    };
    let mut columns = vec![
        Column::short("Axis"),
        Column::short("Sign"),
        Column::words("Declared of its readings", 3),
        Column::words("Gate, demanded", 3),
        Column::words("Gate, found", 4),
    ];
    if doubted {
        columns.insert(3, Column::words(UNCERTAINTY, 2));
    }
    Block::Table(Table {
        columns,
        rows: axes.map(row).collect(),
    })
}

fn simulated(run: &Run<'_>) -> Block {
    let link = run.plan.rig.link.as_virtual().copied().unwrap_or_default();
    let equipment = run.equipment();
    let identity = &equipment.device.identity;
    let mut rows = vec![
        ("Rig", run.plan.rig.name.as_str().into()),
        (
            "Kind",
            "simulated: nothing real moved, nothing was measured".into(),
        ),
        (
            "Model, firmware",
            format!("{} {}", identity.model, identity.firmware).into(),
        ),
        ("Simulated errors", errors(&link).into()),
        ("Settling", settling(run.plan.rig.settle).into()),
    ];
    if let Some(text) = particulars::stated(run, "equipment") {
        rows.push(("Other equipment", text.into()));
    }
    rows.extend(uncertainty(&run.plan.rig.calibration).map(|text| (UNCERTAINTY, text.into())));
    pairs(rows)
}

/// What is stated of the calibration's uncertainty, where anything is.
fn uncertainty(calibration: &Calibration) -> Option<String> {
    let percent = |share: f64| format!("{}\u{a0}%", significant(100.0 * share, 2));
    let terms = [
        (
            "force",
            calibration.force_uncertainty,
            percent(calibration.force_uncertainty),
        ),
        (
            "displacement",
            calibration.displacement_uncertainty,
            percent(calibration.displacement_uncertainty),
        ),
        (
            "zero of the force",
            calibration.zero_uncertainty,
            number::stated(calibration.zero_uncertainty, Dimension::FORCE),
        ),
        (
            "its drift, as far as it is allowed",
            calibration.zero_drift,
            number::text(calibration.zero_drift, Dimension::FORCE),
        ),
    ];
    let stated = terms
        .into_iter()
        .filter(|(_, size, _)| *size > 0.0)
        .map(|(name, _, size)| format!("{name} {size}"));
    let stated: Vec<String> = stated.collect();
    (!stated.is_empty()).then(|| stated.join("; "))
}

/// What a virtual rig adds to its specimen.
fn errors(link: &VirtualLink) -> String {
    let terms = [
        ("load-cell noise", link.noise, Dimension::FORCE),
        ("displacement quantum", link.resolution, Dimension::LENGTH),
        ("force quantum", link.force_resolution, Dimension::FORCE),
        ("actuator lag", link.lag, Dimension::TIME),
        ("increment not reached", link.tracking, Dimension::NUMBER),
        ("load-cell drift", link.drift, Dimension::FORCE_RATE),
    ];
    let terms = terms.into_iter().filter(|(_, value, _)| *value != 0.0);
    let stated: Vec<String> = terms
        .map(|(name, value, dimension)| format!("{name} {}", number::stated(value, dimension)))
        .collect();
    if stated.is_empty() {
        "none: an ideal rig".to_owned()
    } else {
        stated.join("; ")
    }
}

/// A row a device of a role; of several it is said which axes are behind it.
fn devices(
    role: &'static str,
    behind: &[Behind<'_>],
    link: &RealLink,
) -> Vec<(&'static str, Text)> {
    let all = link.axes.len().max(1);
    let row = |behind: &Behind<'_>| {
        let text = device(behind.link);
        let axes: Vec<String> = behind
            .axes
            .iter()
            .map(|axis| (axis + 1).to_string())
            .collect();
        let of = if axes.len() == 1 {
            "of axis"
        } else {
            "of axes"
        };
        (
            role,
            if axes.len() == all {
                text
            } else {
                text.and(format!(", {of} {}", axes.join(", ")))
            },
        )
    };
    behind.iter().map(row).collect()
}

/// How a device is reached and what it speaks.
fn device(link: &DeviceLink) -> Text {
    let port = match &link.port {
        PortPlan::Serial { baud, .. } => format!("serial, {baud} baud"),
        PortPlan::Tcp { .. } => "TCP".to_owned(),
    };
    let text = Text::from(format!("{port}, dialect ")).code(link.dialect.name());
    match &link.serial_number {
        Some(serial) => text.and(format!(", only serial number {serial}")),
        None => text,
    }
}

fn declared(resolution: f64, noise: f64, readings: &ReadingRules) -> String {
    let force_range = readings.force_range;
    let mut told = vec![
        format!(
            "displacement to {}",
            number::stated(resolution, Dimension::LENGTH)
        ),
        format!(
            "noise of one force reading {}",
            number::stated(noise, Dimension::FORCE)
        ),
    ];
    if force_range.is_bounded() {
        told.push(format!(
            "cell from {}",
            range(force_range, Dimension::FORCE)
        ));
    }
    told.join("; ")
}

fn taking(readings: &ReadingRules) -> String {
    let rate = number::stated(readings.rate, Dimension::FREQUENCY);
    let median = if readings.samples > 1 {
        format!("median of {} settled readings", readings.samples)
    } else {
        "one settled reading".to_owned()
    };
    format!(
        "{median}, read at {rate}; frozen after {} equal forces in motion",
        readings.frozen_after
    )
}

fn demanded(gate: &Gate) -> String {
    format!(
        "at most {} at rest; {} in a move of {}",
        number::stated(gate.zero, Dimension::FORCE),
        range(gate.stiffness, Dimension::STIFFNESS),
        number::stated(gate.probe, Dimension::LENGTH)
    )
}

/// What the gate said, passed (and then how that begins) or not.
fn found<'a>(run: &Run<'a>, passed: &str) -> Option<&'a str> {
    told_outside_procedures(run)
        .find_map(|text| text.strip_prefix(passed).or_else(|| refused(text)))
}

/// What the gate said of an axis of several that passed it.
fn passed<'a>(run: &Run<'a>, axis: usize) -> Option<&'a str> {
    let begins = format!("gate passed by axis {axis}: ");
    told_outside_procedures(run).find_map(|text| text.strip_prefix(begins.as_str()))
}

fn told_outside_procedures<'a>(run: &Run<'a>) -> impl Iterator<Item = &'a str> {
    let told = run
        .record
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Note | EventKind::Fault));
    told.filter(|event| event.procedure.is_none())
        .map(|event| event.text.as_str())
}

fn refused(text: &str) -> Option<&str> {
    text.strip_prefix("the rig did not pass the gate: ")
}
