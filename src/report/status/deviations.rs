//! Deviations from the plan as written, found in the record: a reader must know them before the numbers. In: a run. Out: one sentence
//! each, in the order of their occurrence.

use crate::procedures;
use crate::report::number;
use crate::report::run::{ClockJump, Run};
use crate::report::wording::deviations as wording;
use psd_plan::record::equipment::{Channel, Measures};
use psd_plan::record::{Drift, EventKind, Outcome, UNLOADING};
use psd_plan::schema::plan_block::DEVIATIONS;
use psd_text::units::Dimension;
use psd_text::units::display::trimmed;

/// Every deviation and interruption of the run. The first page of a report has the reason why the run ended above its deviations.
pub(in crate::report) fn of_run(run: &Run<'_>, with_reason: bool) -> Vec<String> {
    let stated = run
        .plan
        .particulars
        .iter()
        .filter(|(field, _)| *field == DEVIATIONS.name);
    let mut found: Vec<String> = stated
        .map(|(_, text)| format!("{}.", text.trim_end_matches('.')))
        .collect();
    let set = |(name, value): &(String, String)| wording::parameter_set(name, value);
    found.extend(run.plan.settings.iter().map(set));
    if let Some(text) = run.plan.performed_part() {
        found.insert(0, wording::check_run(text));
    }
    let colon = |reason: &str| {
        if with_reason {
            format!(": {reason}")
        } else {
            String::new()
        }
    };
    match &run.record.outcome {
        Outcome::Completed => {}
        Outcome::Aborted { reason } => found.push(wording::stopped(colon(reason))),
        Outcome::NotReleased { reason } => {
            found.push(wording::not_released(colon(reason)));
        }
        Outcome::Blocked { reason } => found.push(wording::blocked(colon(reason))),
        Outcome::Faulted { reason } => found.push(wording::rig_failed(colon(reason))),
    }
    // The event that ended the run repeats the reason of the outcome.
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
        if event.text == UNLOADING {
            found.push(wording::UNLOADED.to_owned());
            continue;
        }
        let kind = match event.kind {
            EventKind::LimitBreach => wording::LIMIT_BREACH,
            EventKind::Hold => wording::HOLD,
            EventKind::Held => wording::AFTER_THE_STOP,
            EventKind::NotHeld => wording::NOT_HELD,
            EventKind::Fault => wording::RIG_FAULT,
            EventKind::Recovered => wording::RECOVERED,
            EventKind::Resume => wording::INTERRUPTION,
            EventKind::Amendment => wording::AMENDMENT,
            EventKind::Note if is_of_the_line(&event.text) => wording::LINE,
            EventKind::Note | EventKind::Inspection | EventKind::Remark => continue,
        };
        let text = event.text.strip_prefix(LINE).unwrap_or(&event.text).trim();
        found.push(format!(
            "{kind}{}: {}.",
            position(event.procedure.as_deref(), event.step),
            text.trim_end_matches('.')
        ));
    }
    let drifted = run.record.drift.iter().flat_map(Drift::beyond);
    found.extend(drifted.map(|beyond| wording::zero_drift(beyond.reason)));
    found.extend(beyond_calibration(run));
    found.extend(
        run.provenance
            .real
            .iter()
            .flat_map(|real| &real.jumps)
            .map(clock_jump),
    );
    for (index, procedure) in run.plan.procedures.iter().enumerate() {
        match run.record.procedures.get(index) {
            None => found.push(wording::not_run(&procedure.name)),
            Some(record) if !record.complete => {
                found.push(wording::not_to_its_end(&procedure.name));
            }
            Some(_) => {}
        }
    }
    found
}

/// Channels whose largest reading is outside their calibrated range. Every test begins near 0, so only the largest reading is
/// compared with the lower end.
fn beyond_calibration(run: &Run<'_>) -> Vec<String> {
    let equipment = run.equipment();
    let several = equipment.channels.iter().any(|channel| channel.axis > 1);
    let outside = |channel: &Channel| {
        let ([low, high], dimension) = (channel.calibrated?, channel.measures.dimension());
        let reached = reached(run, channel.measures, channel.axis.checked_sub(1)?)?;
        let side = if reached > high {
            wording::BEYOND
        } else if reached < low {
            wording::BELOW
        } else {
            return None;
        };
        let axis = if several {
            wording::of_axis(channel.axis)
        } else {
            String::new()
        };
        let (reached, [low, high]) = (
            number::text(reached, dimension),
            [low, high].map(|size| number::stated(size, dimension)),
        );
        let name = format!("{}{axis}", channel.measures.name());
        Some(wording::outside_calibration(name, reached, side, low, high))
    };
    equipment.channels.iter().filter_map(outside).collect()
}

/// `The wall clock jumped by −365 d …`
fn clock_jump(jump: &ClockJump) -> String {
    let units = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s")];
    let size = jump.seconds.abs();
    let (unit, name) = units
        .into_iter()
        .find(|(unit, _)| size >= *unit)
        .unwrap_or((1.0, "s"));
    let sign = if jump.seconds < 0.0 { '−' } else { '+' };
    let by = trimmed(&format!("{:.1}", size / unit));
    wording::clock_jump(
        format!("{sign}{by}\u{a0}{name}"),
        number::text(jump.time, Dimension::TIME),
    )
}

/// The beginning of a note on frames sent again and readings repeated.
const LINE: &str = "line:";

/// Whether a note reports a communication error that was recovered.
pub(in crate::report) fn is_of_the_line(text: &str) -> bool {
    text.starts_with(LINE)
        || ["sent again", "reading repeated", "readings repeated"]
            .iter()
            .any(|words| text.contains(words))
}

/// ` in hit, step 12`, as far as it is known.
pub(in crate::report) fn position(procedure: Option<&str>, step: Option<u64>) -> String {
    match (procedure, step) {
        (Some(name), Some(step)) => wording::in_step(name, step),
        (Some(name), None) => wording::in_procedure(name),
        (None, _) => String::new(),
    }
}

/// The largest absolute reading of a channel \[m\] or \[N\], for an axis counted from 0. None if nothing was recorded.
fn reached(run: &Run<'_>, measures: Measures, axis: usize) -> Option<f64> {
    let mut largest: Option<f64> = None;
    let mut give = |displacement: &[f64], force: &[f64]| {
        let read = match measures {
            Measures::Displacement => displacement.get(axis),
            Measures::Force => force.get(axis),
        };
        if let Some(read) = read.filter(|read| read.is_finite()) {
            largest = Some(largest.map_or(read.abs(), |largest| largest.max(read.abs())));
        }
    };
    run.record
        .procedures
        .iter()
        .for_each(|procedure| procedures::readings(run.plan, &procedure.history, &mut give));
    largest
}
