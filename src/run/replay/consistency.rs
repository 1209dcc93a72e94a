//! The internal consistency of a run log. Each entry is exactly one that psd writes, times increase, and targets are numbered without
//! gaps. The datum is that of the plan, and a virtual rig has no raw bytes. In: the lines of a run log, those that count, the plan. Out:
//! the first entry that contradicts another. Replay finds the other differences.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::entry::{
    AmendBody, EndBody, FaultBody, Header, HeldBody, IntentBody, OperatorEntry, PlanBody,
    RecoverBody, ResumeBody, RigBody, SampleBody, StepBody, StrokeBody,
};
use super::logged_run::{LoggedRun, body};
use crate::plan::{Datum, Plan};
use crate::record::Event;
use crate::record::journal::{EntryKind, Line, Recovered, is_written_as};
use crate::rig::LineStatistics;
use crate::rig::controllers::metres;

/// In a resumed run the time is a sum of two clocks.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An entry that contradicts another.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("entry {seq} contradicts itself: {reason}")]
pub struct Contradiction {
    pub seq: u64,
    pub reason: String,
}

/// Checks a run log for internal consistency.
///
/// # Errors
/// The first line that contradicts itself or an earlier line.
pub fn check_consistency(
    recovered: &Recovered,
    logged: &LoggedRun,
    plan: &Plan,
) -> Result<(), Contradiction> {
    recovered.lines.iter().try_for_each(is_ours)?;
    let parts = recovered.lines.split(|line| line.kind == EntryKind::Resume);
    parts
        .into_iter()
        .try_for_each(|part| runs_on(part.iter()))?;
    counts_on(logged)?;
    let mut datum = None;
    recovered.lines.iter().try_for_each(|line| {
        is_of_the_plans_rig(line, plan, &mut datum).map_err(|reason| at(line, reason))
    })
}

/// Whether an entry can belong to the plan's rig: one datum throughout, which is zero if the plan specifies this, and no raw bytes for a
/// virtual rig. `first_datum`: that of the first RIG entry \[m\], one per axis.
fn is_of_the_plans_rig(
    line: &Line,
    plan: &Plan,
    first_datum: &mut Option<Vec<f64>>,
) -> Result<(), String> {
    let unread = |fault: super::UnreadableLog| fault.to_string();
    let link = plan.rig.link.as_real();
    match (line.kind, link) {
        (EntryKind::Rig, Some(link)) => {
            let rig: RigBody = body(line).map_err(unread)?;
            // Run logs of older versions do not have it: their datum is the zero of the rig.
            let datum = rig.datum.unwrap_or_else(|| vec![0.0; rig.axes]);
            let at_zero = datum.iter().all(|position| *position == 0.0);
            if datum.len() != rig.axes || link.datum == Datum::Machine && !at_zero {
                return Err(format!("a datum at {} is not the plan's", metres(&datum)));
            }
            if first_datum.get_or_insert_with(|| datum.clone()) != &datum {
                return Err(format!(
                    "a datum at {} differs from the datum at the start of the run",
                    metres(&datum)
                ));
            }
            Ok(())
        }
        (EntryKind::Rig, None) => {
            let rig: RigBody = body(line).map_err(unread)?;
            without_bytes(rig.replies.is_empty(), "a virtual rig sends no bytes")
        }
        (EntryKind::Intent, None) => {
            let intent: IntentBody = body(line).map_err(unread)?;
            without_bytes(intent.wire.is_none(), "nothing is sent to a virtual rig")
        }
        (EntryKind::Sample, None) => {
            let sample: SampleBody = body(line).map_err(unread)?;
            without_bytes(sample.raw.is_empty(), "a virtual rig answers without bytes")
        }
        (EntryKind::Held, None) => Err("a virtual rig has no final hold".to_owned()),
        _ => Ok(()),
    }
}

fn without_bytes(silent: bool, reason: &str) -> Result<(), String> {
    if silent {
        Ok(())
    } else {
        Err(reason.to_owned())
    }
}

fn at(line: &Line, reason: impl Into<String>) -> Contradiction {
    Contradiction {
        seq: line.seq,
        reason: reason.into(),
    }
}

/// Whether psd would write exactly the same object, with the same fields.
fn is_ours(line: &Line) -> Result<(), Contradiction> {
    match line.kind {
        EntryKind::Header => written::<Header>(line, &["format"]),
        EntryKind::Plan => written::<PlanBody>(line, &[]),
        EntryKind::Rig => written::<RigBody>(line, &[]),
        EntryKind::Intent => written::<IntentBody>(line, &[]),
        EntryKind::Sample => written::<SampleBody>(line, &[]),
        EntryKind::Stroke => written::<StrokeBody>(line, &[]),
        EntryKind::Step => written::<StepBody>(line, &[]),
        EntryKind::Operator => written::<OperatorEntry>(line, &[]),
        EntryKind::Event => written::<Event>(line, &[]),
        EntryKind::Fault => written::<FaultBody>(line, &[]),
        EntryKind::Held => written::<HeldBody>(line, &[]),
        EntryKind::LineStatistics => written::<LineStatistics>(line, &[]),
        EntryKind::Recover => written::<RecoverBody>(line, &[]),
        EntryKind::Amend => written::<AmendBody>(line, &[]),
        EntryKind::Resume => written::<ResumeBody>(line, &[]),
        EntryKind::End => written::<EndBody>(line, &["count", "head"]),
    }
}

/// `own` are the fields of the run log itself.
fn written<T: DeserializeOwned + Serialize>(
    line: &Line,
    own: &[&str],
) -> Result<(), Contradiction> {
    let read: T = body(line).map_err(|fault| at(line, fault.to_string()))?;
    // This is true of nearly all, and found much faster than the fields of both.
    if is_written_as(line, &read) {
        return Ok(());
    }
    let again = serde_json::to_value(&read).unwrap_or_default();
    let logged = line.body();
    let (Some(again), Some(logged)) = (again.as_object(), logged.as_object()) else {
        return Ok(());
    };
    let mut names = logged.keys().filter(|name| !own.contains(&name.as_str()));
    if let Some(foreign) = names.find(|name| again.get(*name) != logged.get(*name)) {
        return Err(at(
            line,
            format!("psd never writes this `{}`", foreign.escape_debug()),
        ));
    }
    let missing = again.keys().find(|name| !logged.contains_key(*name));
    missing.map_or(Ok(()), |missing| {
        Err(at(line, format!("it has no `{missing}`")))
    })
}

/// Rig time only increases.
fn runs_on<'a>(lines: impl Iterator<Item = &'a Line>) -> Result<(), Contradiction> {
    let mut before = f64::NEG_INFINITY;
    for line in lines {
        let Some(time) = line.time() else { continue };
        if time < before - ROUNDING * before.abs() {
            return Err(at(
                line,
                format!("its time is {time} s, but the entry before has {before} s"),
            ));
        }
        before = time;
    }
    Ok(())
}

/// For the entries that count: a target has the next number, and the time of the entry before it.
fn counts_on(logged: &LoggedRun) -> Result<(), Contradiction> {
    let mut targets = 0;
    let mut time = logged.rigs.first().map_or(0.0, |rig| rig.t);
    for line in &logged.lines {
        if line.kind == EntryKind::Intent {
            let intent: IntentBody = body(line).map_err(|fault| at(line, fault.to_string()))?;
            targets += 1;
            if intent.n != targets {
                return Err(at(
                    line,
                    format!("it is target {}, but states {}", targets, intent.n),
                ));
            }
            if intent.t.to_bits() != time.to_bits() {
                return Err(at(
                    line,
                    format!(
                        "its time is {} s, but the entry before has {time} s",
                        intent.t
                    ),
                ));
            }
        }
        time = line.time().unwrap_or(time);
    }
    runs_on(logged.lines.iter())
}
