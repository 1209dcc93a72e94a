//! Equipment and calibration: the rig, its controllers and load cells, their calibrations and the pre-test check. In: a run.
//! Out: blocks. The path of a port on the machine is not printed.

mod pretest_check;
mod zero_drift;

use super::conditions::{range, settling};
use super::{Source, pairs};
use crate::report::document::{Block, Column, Style, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::status::days::last_day;
use crate::report::status::particulars;
use crate::report::wording::equipment as wording;
use crate::report::wording::specimen as specimen_text;
use psd_plan::record::equipment::{Channel, GivenIn};
use psd_plan::schema::plan_block::EQUIPMENT;
use psd_plan::{
    AxialAxis, Behind, Calibration, DeviceLink, Interval, Limits, PortPlan, ReadingRules, RealLink,
    VirtualLink,
};
use psd_text::units::Dimension;
use psd_text::units::display::significant;

/// The rig of the run.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    body.push(Block::part(wording::TITLE));
    match run.plan.rig.link.as_real() {
        Some(link) => {
            body.push(calibration(run));
            body.push(real(run, link));
            body.extend((link.axes.len() > 1).then(|| axes(run, link)));
        }
        None => body.push(simulated(run)),
    }
    zero_drift::append(run, body);
}

/// One row per measuring channel: range, class, scale factor, calibration, due date, and its state on the day of the test.
fn calibration(run: &Run<'_>) -> Block {
    let equipment = run.equipment();
    let several = equipment.channels.iter().any(|channel| channel.axis > 1);
    let row = |channel: &Channel| {
        let axis = if several {
            format!(" {}", channel.axis)
        } else {
            String::new()
        };
        let interval = |ends: Option<[f64; 2]>| {
            ends.map_or_else(
                || Text::given(None),
                |[low, high]| range(Interval { low, high }, channel.measures.dimension()).into(),
            )
        };
        let due = channel.due.as_deref();
        vec![
            format!("{}{axis}", channel.measures.name()).into(),
            interval(channel.range),
            Text::given(channel.class.as_deref()),
            scale_factor(channel).into(),
            Text::given(channel.certificate.as_deref()),
            interval(channel.calibrated),
            Text::given(due),
            calibration_state(run, due),
        ]
    };
    let [
        channel,
        measures,
        class,
        factor,
        certificate,
        calibrated,
        due,
        state,
    ] = wording::CALIBRATION_COLUMNS;
    let columns = vec![
        Column::short(channel),
        Column::short(measures),
        Column::words(class, 2),
        Column::short(factor),
        Column::words(certificate, 3),
        Column::short(calibrated),
        Column::short(due),
        Column::short(state),
    ];
    // A column without an entry is omitted; the first page names the particulars that a test report lacks.
    let given = |pick: fn(&Channel) -> bool| equipment.channels.iter().any(pick);
    let mut is_printed = [true; 8];
    is_printed[1] = given(|channel| channel.range.is_some());
    is_printed[2] = given(|channel| channel.class.is_some());
    is_printed[5] = given(|channel| channel.calibrated.is_some());
    let rows = equipment.channels.iter().map(row);
    Block::Table(Table {
        columns: kept(columns, is_printed),
        rows: rows.map(|row| kept(row, is_printed)).collect(),
    })
}

/// The entries whose column is printed.
fn kept<T>(entries: Vec<T>, is_printed: [bool; 8]) -> Vec<T> {
    let entries = entries.into_iter().zip(is_printed);
    entries
        .filter(|(_, is)| *is)
        .map(|(entry, _)| entry)
        .collect()
}

/// Whether a calibration was valid on the last day of the test.
fn calibration_state(run: &Run<'_>, due: Option<&str>) -> Text {
    match (due, last_day(run.provenance)) {
        (None, _) => Text::missing(wording::NO_DUE_DATE),
        (Some(due), Some(day)) if due < day => Text::new()
            .with(Style::Fail, wording::OVERDUE)
            .and(wording::on_day(day)),
        (Some(_), Some(day)) => Text::new()
            .with(Style::Pass, wording::VALID)
            .and(wording::on_day(day)),
        (Some(_), None) => Text::missing(wording::DAY_NOT_KNOWN),
    }
}

/// The scale factor from the number of a channel to its quantity.
fn scale_factor(channel: &Channel) -> String {
    match channel.given_in {
        GivenIn::Units => number::stated(channel.factor, Dimension::NUMBER),
        GivenIn::Counts => {
            wording::per_count(number::stated(channel.factor, channel.measures.dimension()))
        }
    }
}

fn real(run: &Run<'_>, link: &RealLink) -> Block {
    let equipment = run.equipment();
    let identity = &equipment.device.identity;
    let kind = if identity.simulated {
        wording::SIMULATED_CONTROLLER
    } else {
        wording::REAL
    };
    let stated = |text: &str| Text::given(Some(text));
    let one_axis = link.axes.len() < 2;
    let mut rows = vec![
        (wording::RIG, run.plan.rig.name.as_str().into()),
        (wording::KIND, kind.into()),
        (wording::MODEL, stated(&identity.model)),
        (wording::SERIAL_NUMBER, stated(&identity.serial)),
        (wording::FIRMWARE, stated(&identity.firmware)),
    ];
    rows.extend(other_equipment(run));
    if let Some(boot) = &identity.boot {
        rows.push((wording::BOOT, Text::new().id(boot)));
    }
    rows.extend(devices(wording::ACTUATOR, &link.actuators(), link));
    let cells = link.load_cells();
    if cells.is_empty() {
        rows.push((wording::LOAD_CELL, wording::READ_BY_THE_CONTROLLER.into()));
    }
    rows.extend(devices(wording::LOAD_CELL, &cells, link));
    for channel in equipment
        .channels
        .iter()
        .filter(|channel| channel.zero != 0.0)
    {
        rows.push((
            wording::ZERO_OFFSET,
            number::stated(channel.zero, Dimension::NUMBER).into(),
        ));
    }
    if one_axis {
        let (resolution, noise) = (equipment.device.resolution, equipment.device.noise);
        rows.push((
            wording::DECLARED,
            declared(resolution, noise, &link.readings).into(),
        ));
        rows.extend(calibration_uncertainty(&run.plan.rig.calibration_of(0)));
    }
    rows.push((wording::READING, reading_rule(&link.readings).into()));
    rows.push((wording::SETTLING, settling(run.plan.rig.settle).into()));
    let watchdog = number::stated(link.watchdog, Dimension::TIME);
    rows.push((wording::WATCHDOG, wording::watchdog(watchdog).into()));
    rows.push((wording::SAFE_STATE, link.safe_state.name().into()));
    rows.extend(axial_axes(run));
    if one_axis {
        rows.push((
            wording::PRETEST_CHECK_LIMITS,
            pretest_check::required(&link.pretest_check_of(0)).into(),
        ));
        rows.push((
            wording::PRETEST_CHECK_RESULT,
            Text::given(pretest_check::outcome(run)),
        ));
    } else if let Some(reason) = pretest_check::refusal(run) {
        rows.push((wording::PRETEST_CHECK_RESULT, reason.into()));
    }
    pairs(rows)
}

/// One row per axis of a rig of several: polarity, declared errors, and the pre-test check.
fn axes(run: &Run<'_>, link: &RealLink) -> Block {
    let axes = 0..link.axes.len();
    let uncertainties: Vec<Option<String>> = axes
        .clone()
        .map(|axis| calibration_terms(&run.plan.rig.calibration_of(axis)))
        .collect();
    let any_uncertainty = uncertainties.iter().any(Option::is_some);
    let required = |axis: usize| match link.axes[axis].axial {
        Some(_) => wording::AXIAL_AXIS.into(),
        None => pretest_check::required(&link.pretest_check_of(axis)).into(),
    };
    let row = |axis: usize| {
        let (readings, number) = (link.readings_of(axis), axis + 1);
        let polarity = if run.plan.rig.polarity_of(axis) < 0.0 {
            wording::NEGATIVE
        } else {
            wording::POSITIVE
        };
        let mut cells = vec![
            Text::from(number.to_string()),
            polarity.into(),
            declared(readings.resolution, readings.noise, &readings).into(),
            required(axis),
            Text::given(pretest_check::passed_by_axis(run, number)),
        ];
        if any_uncertainty {
            cells.insert(3, Text::given(uncertainties[axis].as_deref()));
        }
        cells
    };
    let mut columns = vec![
        Column::short(wording::AXIS),
        Column::short(wording::POLARITY),
        Column::words(wording::DECLARED, 3),
        Column::words(wording::PRETEST_CHECK_LIMITS, 3),
        Column::words(wording::PRETEST_CHECK_RESULT, 4),
    ];
    if any_uncertainty {
        columns.insert(3, Column::words(wording::CALIBRATION_UNCERTAINTY, 2));
    }
    Block::Table(Table {
        columns,
        rows: axes.map(row).collect(),
    })
}

/// One row per axial axis.
fn axial_axes(run: &Run<'_>) -> Vec<(&'static str, Text)> {
    let axes = run.plan.rig.axial_axes(&run.plan.limits);
    let row = |(axis, limits): (AxialAxis, Limits)| {
        let text = specimen_text::axial_axis(run.plan, &axis, limits.displacement, &number::stated);
        (wording::AXIAL_AXIS, text.into())
    };
    axes.map(row).collect()
}

fn simulated(run: &Run<'_>) -> Block {
    let link = run.plan.rig.link.as_virtual().copied().unwrap_or_default();
    let equipment = run.equipment();
    let identity = &equipment.device.identity;
    let mut rows = vec![
        (wording::RIG, run.plan.rig.name.as_str().into()),
        (wording::KIND, wording::SIMULATED.into()),
        (
            wording::MODEL_AND_FIRMWARE,
            format!("{} {}", identity.model, identity.firmware).into(),
        ),
        (wording::SIMULATED_ERRORS, simulated_errors(&link).into()),
        (wording::SETTLING, settling(run.plan.rig.settle).into()),
    ];
    rows.extend(axial_axes(run));
    rows.extend(other_equipment(run));
    rows.extend(calibration_uncertainty(&run.plan.rig.calibration));
    pairs(rows)
}

fn other_equipment(run: &Run<'_>) -> Option<(&'static str, Text)> {
    let text = particulars::stated(run, EQUIPMENT.name)?;
    Some((wording::OTHER_EQUIPMENT, text.into()))
}

/// The row of the standard uncertainties of a calibration, if one is declared.
fn calibration_uncertainty(calibration: &Calibration) -> Option<(&'static str, Text)> {
    let terms = calibration_terms(calibration)?;
    Some((wording::CALIBRATION_UNCERTAINTY, terms.into()))
}

fn calibration_terms(calibration: &Calibration) -> Option<String> {
    let percent = |fraction: f64| format!("{}\u{a0}%", significant(100.0 * fraction, 2));
    let [force, displacement, zero, drift] = wording::CALIBRATION_TERMS;
    let terms = [
        (
            force,
            calibration.force_uncertainty,
            percent(calibration.force_uncertainty),
        ),
        (
            displacement,
            calibration.displacement_uncertainty,
            percent(calibration.displacement_uncertainty),
        ),
        (
            zero,
            calibration.zero_uncertainty,
            number::stated(calibration.zero_uncertainty, Dimension::FORCE),
        ),
        (
            drift,
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

/// The errors that a virtual rig simulates.
fn simulated_errors(link: &VirtualLink) -> String {
    let [noise, displacement, force, lag, tracking, drift] = wording::ERROR_TERMS;
    let terms = [
        (noise, link.noise, Dimension::FORCE),
        (displacement, link.resolution, Dimension::LENGTH),
        (force, link.force_resolution, Dimension::FORCE),
        (lag, link.lag, Dimension::TIME),
        (tracking, link.tracking, Dimension::NUMBER),
        (drift, link.drift, Dimension::FORCE_RATE),
    ];
    let terms = terms.into_iter().filter(|(_, value, _)| *value != 0.0);
    let stated: Vec<String> = terms
        .map(|(name, value, dimension)| format!("{name} {}", number::stated(value, dimension)))
        .collect();
    if stated.is_empty() {
        wording::NO_ERRORS.to_owned()
    } else {
        stated.join("; ")
    }
}

/// One row per device of a role; with the axes of the device if the rig has others.
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
        match axes.as_slice() {
            axes if axes.len() == all => (role, text),
            [axis] => (role, text.and(wording::of_axis(axis))),
            axes => (role, text.and(wording::of_axes(axes.join(", ")))),
        }
    };
    behind.iter().map(row).collect()
}

/// Port and protocol of a device.
fn device(link: &DeviceLink) -> Text {
    let port = match &link.port {
        PortPlan::Serial { baud, .. } => wording::serial_port(baud),
        PortPlan::Tcp { .. } => wording::TCP.to_owned(),
    };
    let text = Text::from(wording::dialect(port)).code(link.dialect.name());
    match &link.serial_number {
        Some(serial) => text.and(wording::only_serial_number(serial)),
        None => text,
    }
}

/// Resolution and noise of the readings, and the range of the load cell if it is bounded.
fn declared(resolution: f64, noise: f64, readings: &ReadingRules) -> String {
    let force_range = readings.force_range;
    let mut terms = vec![
        wording::displacement_to(number::stated(resolution, Dimension::LENGTH)),
        wording::force_noise(number::stated(noise, Dimension::FORCE)),
    ];
    if force_range.is_bounded() {
        terms.push(wording::cell_from(range(force_range, Dimension::FORCE)));
    }
    terms.join("; ")
}

/// Samples, rate and the check for frozen forces.
fn reading_rule(readings: &ReadingRules) -> String {
    let rate = number::stated(readings.rate, Dimension::FREQUENCY);
    let reading_text = if readings.samples > 1 {
        wording::median_of(readings.samples)
    } else {
        wording::ONE_READING.to_owned()
    };
    wording::reading(reading_text, rate, readings.frozen_after)
}
