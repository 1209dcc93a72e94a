//! Equipment and calibration of a real rig: who answered, how it was reached, what its numbers are traced to, what it was
//! held to. In: a run on a real rig. Out: a table. Where a port lies on the machine is no part of it.

use maud::{Markup, html};

use super::super::{Run, number, standing};
use super::conditions::{range, settling};
use super::{given, pairs};
use crate::plan::{Calibration, DeviceLink, Gate, PortPlan, ReadingRules, RealLink};
use crate::quantity::Dimension;
use crate::record::EventKind;

/// The table of a real rig.
pub(super) fn table(run: &Run<'_>, link: &RealLink) -> Markup {
    let identity = &run.record.rig;
    let calibration = &run.plan.rig.calibration;
    let kind = if identity.simulated { "a simulated controller on a real line: nothing real moved" } else { "real" };
    let mut rows = vec![
        ("Kind".to_owned(), html! { (kind) }),
        ("Model".to_owned(), given(Some(&identity.model))),
        ("Serial number".to_owned(), given(Some(&identity.serial))),
        ("Firmware".to_owned(), given(Some(&identity.firmware))),
    ];
    if let Some(boot) = &identity.boot {
        rows.push(("Power-up of the controller".to_owned(), html! { span.id { (boot) } }));
    }
    rows.push(("Actuator".to_owned(), device(&link.actuator)));
    rows.push((
        "Load cell".to_owned(),
        link.load_cell.as_ref().map_or_else(|| html! { "read by the actuator's controller" }, device),
    ));
    rows.push(("Calibration".to_owned(), given(calibration.reference.as_deref())));
    rows.push(("Calibration holds until".to_owned(), due(run, calibration)));
    if let Some(factor) = calibration.newtons_per_count {
        let zero = number::stated(calibration.zero_count, Dimension::NUMBER);
        rows.push(("Force of a count".to_owned(), html! { (number::stated(factor, Dimension::FORCE)) ", zero at " (zero) }));
    }
    rows.push(("Declared of its readings".to_owned(), html! { (declared(&link.readings)) }));
    rows.push(("Taking a reading".to_owned(), html! { (taking(&link.readings)) }));
    rows.push(("Settling".to_owned(), html! { (settling(run.plan.rig.settle)) }));
    let watchdog = number::stated(link.watchdog, Dimension::TIME);
    rows.push(("Watchdog".to_owned(), html! { "the rig holds by itself after " (watchdog) " without a sign of life" }));
    rows.push(("Safe state".to_owned(), html! { (link.safe_state.name()) }));
    rows.push(("Gate, demanded".to_owned(), html! { (demanded(&link.gate)) }));
    rows.push(("Gate, found".to_owned(), given(found(run))));
    pairs(&rows)
}

/// How a device is reached and what it speaks.
fn device(link: &DeviceLink) -> Markup {
    let port = match &link.port {
        PortPlan::Serial { baud, .. } => format!("serial, {baud} baud"),
        PortPlan::Tcp { .. } => "TCP".to_owned(),
    };
    html! {
        (port) ", dialect " code { (link.dialect.name()) }
        @if let Some(serial) = &link.serial_number { ", only serial number " (serial) }
    }
}

/// The day until which the calibration holds, beside the test's own.
fn due(run: &Run<'_>, calibration: &Calibration) -> Markup {
    let Some(due) = calibration.due.as_deref() else { return given(None) };
    html! {
        (due)
        @match standing::last_day(run) {
            Some(day) if due < day => { " " strong { "EXPIRED" } " when the test ended, on " (day) }
            Some(day) => { "; the test ended on " (day) }
            None => { "; the day of the test is not known" }
        }
    }
}

fn declared(readings: &ReadingRules) -> String {
    let ReadingRules { resolution, noise, force_range, .. } = *readings;
    let mut told = vec![
        format!("displacement to {}", number::stated(resolution, Dimension::LENGTH)),
        format!("noise of one force reading {}", number::stated(noise, Dimension::FORCE)),
    ];
    if force_range.is_bounded() {
        told.push(format!("cell from {}", range(force_range, Dimension::FORCE)));
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
    format!("{median}, read at {rate}; frozen after {} equal forces in motion", readings.frozen_after)
}

fn demanded(gate: &Gate) -> String {
    format!(
        "at most {} at rest; {} in a move of {}",
        number::stated(gate.zero, Dimension::FORCE),
        range(gate.stiffness, Dimension::STIFFNESS),
        number::stated(gate.probe, Dimension::LENGTH)
    )
}

/// What the gate said, passed or not.
fn found<'a>(run: &Run<'a>) -> Option<&'a str> {
    let told = run.record.events.iter().filter(|event| matches!(event.kind, EventKind::Note | EventKind::Fault));
    told.filter(|event| event.procedure.is_none())
        .find_map(|event| event.text.strip_prefix("gate passed: ").or_else(|| refused(&event.text)))
}

fn refused(text: &str) -> Option<&str> {
    text.strip_prefix("the rig did not pass the gate: ")
}
