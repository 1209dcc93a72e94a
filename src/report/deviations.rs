//! Deviations from the plan as written, found in the record itself: what a reader of the certificate must know before
//! the numbers. In: a run. Out: one sentence each, in the order they happened.

use super::{ClockJump, Run, number};
use crate::procedures::reached::reached;
use crate::record::equipment::Channel;
use crate::record::{Drift, EventKind, Outcome};
use crate::run::rehearsal;
use crate::units::Dimension;
use crate::units::display::trimmed;

/// Every deviation and interruption of the run.
pub(super) fn of(run: &Run<'_>) -> Vec<String> {
    let stated = run
        .plan
        .particulars
        .iter()
        .filter(|(field, _)| *field == "deviations");
    let mut found: Vec<String> = stated
        .map(|(_, text)| format!("{}.", text.trim_end_matches('.')))
        .collect();
    let set = |(name, value): &(String, String)| {
        format!("Parameter {name} was set to {value} for this run.")
    };
    found.extend(run.plan.settings.iter().map(set));
    if let Some(told) = rehearsal::told(run.plan) {
        found.insert(0, format!("Rehearsal: {told}."));
    }
    match &run.record.outcome {
        Outcome::Completed => {}
        Outcome::Aborted { reason } => found.push(format!("The run was stopped: {reason}.")),
        Outcome::NotReleased { reason } => {
            found.push(format!("The rig was not released: {reason}."));
        }
        Outcome::Blocked { reason } => found.push(format!("The run could not go on: {reason}.")),
        Outcome::Faulted { reason } => found.push(format!("The rig failed: {reason}.")),
    }
    // The event that ended the run says what the outcome has said already.
    let ending = match &run.record.outcome {
        Outcome::Completed => "",
        Outcome::Aborted { reason }
        | Outcome::NotReleased { reason }
        | Outcome::Blocked { reason }
        | Outcome::Faulted { reason } => reason,
    };
    for event in run
        .record
        .events
        .iter()
        .filter(|event| event.text != ending)
    {
        let what = match event.kind {
            EventKind::LimitBreach => "Limit reached",
            EventKind::Hold => "Hold",
            EventKind::Held => "After the stop",
            EventKind::NotHeld => "The rig",
            EventKind::Fault => "Rig fault",
            EventKind::Mended => "Mended on the lines of the rig",
            EventKind::Resume => "Interruption",
            EventKind::Amendment => "Amendment",
            EventKind::Note if is_of_the_line(&event.text) => "Line",
            EventKind::Note | EventKind::Inspection | EventKind::Remark => continue,
        };
        let text = event.text.strip_prefix(LINE).unwrap_or(&event.text).trim();
        found.push(format!(
            "{what}{}: {}.",
            place(event.procedure.as_deref(), event.step),
            text.trim_end_matches('.')
        ));
    }
    let drifted = run.record.drift.iter().flat_map(Drift::all_beyond);
    found.extend(drifted.map(|beyond| {
        format!(
            "Drift: {}; what its readings enter is not decided.",
            beyond.reason
        )
    }));
    found.extend(beyond_calibration(run));
    found.extend(
        run.provenance
            .real
            .iter()
            .flat_map(|real| &real.jumps)
            .map(jump),
    );
    for (index, procedure) in run.plan.procedures.iter().enumerate() {
        match run.record.procedures.get(index) {
            None => found.push(format!("Procedure {} was not run.", procedure.name)),
            Some(record) if !record.complete => found.push(format!(
                "Procedure {} did not run to its end.",
                procedure.name
            )),
            Some(_) => {}
        }
    }
    found
}

/// Channels whose largest reading lies outside the sizes over which their calibration holds. Every test begins near 0: what
/// lies below the range for a time is no deviation.
fn beyond_calibration(run: &Run<'_>) -> Vec<String> {
    let equipment = run.equipment();
    let several = equipment.channels.iter().any(|channel| channel.axis > 1);
    let outside = |channel: &Channel| {
        let ([low, high], dimension) = (channel.calibrated?, channel.measures.dimension());
        let reached = reached(run.record, channel.measures, channel.axis.checked_sub(1)?)?;
        let side = if reached > high {
            "beyond"
        } else if reached < low {
            "below"
        } else {
            return None;
        };
        let axis = if several {
            format!(" of axis {}", channel.axis)
        } else {
            String::new()
        };
        let (reached, [low, high]) = (
            number::text(reached, dimension),
            [low, high].map(|size| number::stated(size, dimension)),
        );
        let what = channel.measures.name();
        Some(format!(
            "The largest {what}{axis}, {reached}, is {side} the range over which it is calibrated, {low} to {high}."
        ))
    };
    equipment.channels.iter().filter_map(outside).collect()
}

/// `The wall clock jumped by −365 d …`
fn jump(jump: &ClockJump) -> String {
    let units = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s")];
    let size = jump.seconds.abs();
    let (unit, name) = units
        .into_iter()
        .find(|(unit, _)| size >= *unit)
        .unwrap_or((1.0, "s"));
    let sign = if jump.seconds < 0.0 { '−' } else { '+' };
    let by = trimmed(&format!("{:.1}", size / unit));
    let at = number::text(jump.time, Dimension::TIME);
    format!(
        "The wall clock jumped by {sign}{by}\u{a0}{name} at {at} of rig time: durations are of a clock that does not."
    )
}

/// How a note begins that tells of frames sent again and readings taken again.
const LINE: &str = "line:";

/// Whether a note tells of what went wrong on the line and was mended: a departure from a run without fault.
pub(super) fn is_of_the_line(text: &str) -> bool {
    text.starts_with(LINE)
        || ["sent again", "taken again", "read again"]
            .iter()
            .any(|words| text.contains(words))
}

/// ` in hit, step 12`, as far as it is known.
pub(super) fn place(procedure: Option<&str>, step: Option<u64>) -> String {
    match (procedure, step) {
        (Some(name), Some(step)) => format!(" in {name}, step {step}"),
        (Some(name), None) => format!(" in {name}"),
        (None, _) => String::new(),
    }
}
