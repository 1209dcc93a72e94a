//! The decision how an interrupted run is resumed. In: its run log, and the answers of the rig before any motion. Out: the
//! entry from which it is repeated, or the reason why it must not be. A target is sent again only if it never arrived.

mod position;
mod refusal;
mod same_rig;

use super::entry::{
    HeldBody, IntentBody, OperatorBody, ResumeBody, RigBody, SampleBody, TargetStatus,
};
use super::logged_run::{LoggedRun, UnreadableLog, body};
use crate::record::journal::{EntryKind, Line};
use crate::record::{Event, EventKind};
use crate::rig::Reading;
use crate::run::{Inspection, UNLOADING};

pub use position::Bands;
use position::{FoundPosition, InterruptedMotion, check_relaxation, mostly_lost};
pub use refusal::ResumeRefusal;
pub use same_rig::{not_restarted, same_measure, same_resolution, same_rig};

/// The point from which the run log is continued.
#[derive(Clone, Debug, PartialEq)]
pub struct ResumeDecision {
    /// Entries from this one on no longer count.
    pub from: u64,
    pub target_status: TargetStatus,
    /// The last reading that counts: \[m\], \[N\].
    pub recorded: Option<(Vec<f64>, Vec<f64>)>,
    /// The position and force of the final hold, if they were read: \[m\], \[N\].
    pub held: Option<(Vec<f64>, Vec<f64>)>,
    /// The command that is sent before any of the plan: targets \[m\], and the speed of the axis with the longest travel
    /// \[m/s\].
    pub sends: Option<(Vec<f64>, f64)>,
}

impl ResumeDecision {
    /// The RESUME entry for a rig in this state: the operator and the reason, and the rig time at which it continues \[s\].
    #[must_use]
    pub fn resumption(self, by: &str, reason: &str, found: &Reading, time: f64) -> ResumeBody {
        ResumeBody {
            from: self.from,
            by: by.to_owned(),
            reason: reason.to_owned(),
            target_status: self.target_status,
            assured: Vec::new(),
            found: (found.displacement.clone(), found.force.clone()),
            recorded: self.recorded,
            held: self.held,
            released: None,
            t: time,
            wall: None,
        }
    }
}

/// Decides from the run log, the memory of the rig and one reading.
///
/// # Errors
/// The rig is not at a position that the run log allows.
pub fn decide(
    logged: &LoggedRun,
    rig: &RigBody,
    found: &Reading,
    bands: &Bands,
    accept_relaxation: bool,
) -> Result<ResumeDecision, ResumeRefusal> {
    if logged.ended {
        return Err(ResumeRefusal::Ended);
    }
    let lines = without_stop_entries(logged)?;
    let Some(last) = lines.last() else {
        return Err(ResumeRefusal::NothingRecorded);
    };
    let found_position = FoundPosition {
        positions: &found.displacement,
        bands: &bands.displacement,
    };
    let recorded = last_reading(&lines)?;
    let last_intent = lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent);
    let held = last_final_hold(logged, last.seq)?;
    let decision = |from, target_status| ResumeDecision {
        from,
        target_status,
        recorded: recorded.clone(),
        held: held.clone(),
        sends: None,
    };
    if let Some((held_at, _)) = &held {
        // A later motion is not logged: the specimen has a different history.
        found_position.expect_at(held_at)?;
        check_relaxation(held.as_ref(), found, bands, accept_relaxation)?;
    }

    let Some(at) = last_intent else {
        // No target was sent: there are only readings at rest.
        let start = recorded
            .as_ref()
            .map_or_else(|| vec![0.0; found.displacement.len()], |(x, _)| x.clone());
        found_position.expect_at(&start)?;
        check_relaxation(recorded.as_ref(), found, bands, accept_relaxation)?;
        return Ok(decision(last.seq + 1, TargetStatus::None));
    };
    let intent: IntentBody = body(&lines[at])?;
    let before = position_before(&lines[..at], found.displacement.len())?;
    let target = intent.to;
    if intent.samples.is_some()
        && lines[at..]
            .iter()
            .all(|line| line.kind != EntryKind::Stroke)
    {
        let readings_done = lines[at..]
            .iter()
            .filter(|line| line.kind == EntryKind::Sample)
            .count();
        let reached = if readings_done > 0 {
            recorded.as_ref().map_or(&before, |(x, _)| x)
        } else {
            &before
        };
        let samples = intent.samples.unwrap_or(0);
        let motion = InterruptedMotion {
            reached,
            target: &target,
            paths: intent.path.as_deref(),
            samples,
            readings_done,
        };
        return Ok(match motion.target_status(found_position, &before)? {
            target_status @ TargetStatus::Stroke { .. } => decision(lines[at].seq, target_status),
            target_status => decision(last.seq + 1, target_status),
        });
    }
    if at + 1 < lines.len()
        && let Some(paths) = intent
            .path
            .as_ref()
            .filter(|_| !found_position.is_at(&target))
    {
        // It passed its target at the velocity of the path, and held. After it is moved back, it continues from rest.
        found_position.expect_past(paths)?;
        return Ok(decision(
            last.seq + 1,
            TargetStatus::Stroke {
                back_to: target[0],
                others: target[1..].to_vec(),
            },
        ));
    }
    if at + 1 < lines.len() {
        found_position.expect_at(&target)?;
        check_relaxation(recorded.as_ref(), found, bands, accept_relaxation)?;
        return Ok(decision(last.seq + 1, TargetStatus::None));
    }
    if let Some(TargetStatus::Stroke { .. }) = logged.target_status {
        return Ok(decision(
            last.seq + 1,
            logged.target_status.clone().unwrap_or(TargetStatus::None),
        ));
    }
    let target_status = match (&rig.last_move, intent.id) {
        (Some(moved), Some(id))
            if moved.id >= id
                && found_position.is_at(&moved.targets)
                && found_position.is_at(&target) =>
        {
            TargetStatus::Executed
        }
        (Some(moved), Some(id)) if moved.id < id => {
            found_position.expect_at(&before)?;
            TargetStatus::NotExecuted
        }
        (Some(_), Some(_)) => found_position.expect_between(&before, &target)?,
        // Without a memory of moves only the position decides; if both are equally near, the same target is requested
        // again.
        _ if found_position.is_at(&before) => TargetStatus::NotExecuted,
        _ if found_position.is_at(&target) => TargetStatus::Executed,
        _ => found_position.expect_between(&before, &target)?,
    };
    let sends = matches!(
        target_status,
        TargetStatus::NotExecuted | TargetStatus::HeldDuringMotion
    )
    .then_some((target, intent.rate));
    Ok(ResumeDecision {
        sends,
        ..decision(last.seq + 1, target_status)
    })
}

/// The final hold after the entry with this number.
fn last_final_hold(logged: &LoggedRun, last: u64) -> Result<Option<Measured>, UnreadableLog> {
    let held = logged
        .lines
        .iter()
        .rev()
        .take_while(|line| line.seq > last)
        .find(|line| line.kind == EntryKind::Held);
    let held: Option<HeldBody> = held.map(body).transpose()?;
    Ok(held
        .filter(|held| held.unconfirmed.is_none())
        .and_then(|held| held.found))
}

/// The entries without those that only report the stop: the run reports them again, or no longer.
pub(super) fn without_stop_entries(logged: &LoggedRun) -> Result<Vec<Line>, ResumeRefusal> {
    let mut lines: Vec<Line> = logged.lines.iter().cloned().collect();
    while let Some(last) = lines.last() {
        match last.kind {
            EntryKind::Fault | EntryKind::Held => {}
            EntryKind::Event => {
                let event: Event = body(last)?;
                if event.kind == EventKind::Hold && event.text == UNLOADING {
                    return Err(ResumeRefusal::Unloaded);
                }
            }
            EntryKind::Operator => match body(last)? {
                OperatorBody::AskedToStop
                | OperatorBody::AskedToStopInspecting
                | OperatorBody::AnsweredToUnload { .. }
                | OperatorBody::Answered {
                    answer: Inspection::Stop { .. },
                    ..
                } => {}
                OperatorBody::Answered { .. }
                | OperatorBody::Noted { .. }
                | OperatorBody::Asked { .. } => break,
            },
            _ => break,
        }
        lines.pop();
    }
    let unloading = |line: &Line| {
        line.kind == EntryKind::Event
            && line.body().get("text").and_then(|text| text.as_str()) == Some(UNLOADING)
    };
    if lines.iter().any(unloading) {
        Err(ResumeRefusal::Unloaded)
    } else {
        Ok(lines)
    }
}

/// The entry from which an interrupted run may be repeated: the stroke at its end, if most of its readings are missing. The state of the
/// rig then decides.
pub(super) fn undecided_stroke(lines: &[Line]) -> Result<Option<u64>, UnreadableLog> {
    let Some(at) = lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent)
    else {
        return Ok(None);
    };
    let intent: IntentBody = body(&lines[at])?;
    let is_cut = intent.path.is_none()
        && lines[at..]
            .iter()
            .all(|line| line.kind != EntryKind::Stroke);
    let readings_done = lines[at..]
        .iter()
        .filter(|line| line.kind == EntryKind::Sample)
        .count();
    let lost = intent
        .samples
        .is_some_and(|samples| mostly_lost(samples, readings_done));
    Ok((is_cut && lost).then_some(lines[at].seq))
}

/// \[m\] and \[N\], one entry per degree of freedom.
type Measured = (Vec<f64>, Vec<f64>);

fn last_reading(lines: &[Line]) -> Result<Option<Measured>, UnreadableLog> {
    let last = lines
        .iter()
        .rev()
        .find(|line| line.kind == EntryKind::Sample);
    last.map(|line| body::<SampleBody>(line).map(|sample| (sample.x, sample.r)))
        .transpose()
}

/// The position of the rig before an INTENT: the targets before it, or the first reading.
fn position_before(lines: &[Line], axes: usize) -> Result<Vec<f64>, UnreadableLog> {
    if let Some(line) = lines
        .iter()
        .rev()
        .find(|line| line.kind == EntryKind::Intent)
    {
        return body::<IntentBody>(line).map(|intent| intent.to);
    }
    let first = lines.iter().find(|line| line.kind == EntryKind::Sample);
    first.map_or_else(
        || Ok(vec![0.0; axes]),
        |line| body::<SampleBody>(line).map(|sample| sample.x),
    )
}
