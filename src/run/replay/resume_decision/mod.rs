//! The decision how an interrupted run is resumed. In: its run log, and the answers of the rig before any motion. Out: the
//! entry from which it is repeated, or the reason why it must not be. A target is sent again only if it never arrived.

mod position;
mod refusal;
mod same_rig;

use super::entry::{
    HeldBody, IntentBody, OperatorBody, ResumeBody, RigBody, SampleBody, TargetStatus,
};
use super::logged_run::{LoggedRun, UnreadableLog, body};
use super::state::Undecided;
use crate::run::Inspection;
use psd_plan::record::UNLOADING;
use psd_plan::record::{Event, EventKind};
use psd_rig::Reading;
use psd_rig::journal::{EntryKind, Line};

pub use position::Bands;
use position::{FoundPosition, InterruptedMotion, Measured, Place, may_move, mostly_lost};
pub use refusal::ResumeRefusal;
pub use same_rig::{no_faster, not_restarted, same_measure, same_resolution, same_rig};

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
    let lines = lines.as_slice();
    let recorded = last_reading(lines)?;
    let held = last_final_hold(logged, last.seq)?;
    let controlled = bands.controlled(&found.displacement, &found.force);
    let found_position = FoundPosition {
        positions: &controlled,
        bands,
    };
    let LastTarget {
        from,
        target_status,
        place,
        sends,
    } = last_target(logged, lines, rig, found_position)?;
    let resumed = logged.resumption.as_ref().map(|resume| &resume.found);
    let reference = held.as_ref().or(resumed).or(recorded.as_ref());
    if let Some((held_at, force)) = &held {
        // A later motion is not logged: the specimen has a different history.
        found_position.expect_at(&bands.controlled(held_at, force))?;
    }
    may_move(
        &place,
        reference,
        found,
        &bands.softened_by(lines),
        accept_relaxation,
    )?;
    Ok(ResumeDecision {
        from,
        target_status,
        recorded,
        held,
        sends,
    })
}

/// What became of the last target, and where the rig must then be.
struct LastTarget {
    /// Entries from this one on no longer count.
    from: u64,
    target_status: TargetStatus,
    place: Place,
    sends: Option<(Vec<f64>, f64)>,
}

/// What became of the last target of these lines, by the memory and the position of the rig.
fn last_target(
    logged: &LoggedRun,
    lines: &[Line],
    rig: &RigBody,
    found: FoundPosition<'_>,
) -> Result<LastTarget, ResumeRefusal> {
    let after = lines.last().map_or(0, |last| last.seq) + 1;
    let decided = |from, target_status, place| LastTarget {
        from,
        target_status,
        place,
        sends: None,
    };
    let controlled = |(x, r): &Measured| found.bands.controlled(x, r);
    let recorded = last_reading(lines)?.as_ref().map(controlled);
    let axes = found.positions.len();
    if let Some(ResumeBody {
        target_status: again @ TargetStatus::Stroke { back_to, others },
        found: resumed_at,
        ..
    }) = &logged.resumption
    {
        // It was on its way back to the start of the stroke.
        let start = std::iter::once(*back_to).chain(others.iter().copied());
        let place = Place::Between(controlled(resumed_at), start.collect());
        return Ok(decided(after, again.clone(), place));
    }
    let last_intent = lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent);
    let Some(at) = last_intent else {
        // No target was sent: there are only readings at rest.
        let start = recorded.unwrap_or_else(|| vec![0.0; axes]);
        return Ok(decided(after, TargetStatus::None, Place::At(start)));
    };
    let intent: IntentBody = body(&lines[at])?;
    let before = position_before(&lines[..at], axes, found.bands)?;
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
        let reached = recorded.filter(|_| readings_done > 0);
        let motion = InterruptedMotion {
            reached: reached.unwrap_or_else(|| before.clone()),
            target,
            paths: intent.path.as_deref(),
            samples: intent.samples.unwrap_or(0),
            readings_done,
        };
        let (target_status, place) = motion.target_status(found, &before);
        let from = match target_status {
            TargetStatus::Stroke { .. } => lines[at].seq,
            _ => after,
        };
        return Ok(decided(from, target_status, place));
    }
    if at + 1 < lines.len() {
        return Ok(match intent.path {
            // It passed its target at the velocity of the path, and held. After it is moved back, it continues from rest.
            Some(paths) if !found.is_at(&target) => decided(
                after,
                TargetStatus::Stroke {
                    back_to: target[0],
                    others: target[1..].to_vec(),
                },
                Place::past(&paths),
            ),
            _ => decided(after, TargetStatus::None, Place::At(target)),
        });
    }
    // If it was sent again, it began where the rig was found then.
    let resumed = logged.resumption.as_ref();
    let before = resumed.map_or(before, |resume| controlled(&resume.found));
    let on_the_way = || Place::Between(before.clone(), target.clone());
    let (target_status, place) = match (&rig.last_move, intent.id) {
        (Some(moved), Some(id))
            if moved.id >= id && found.is_at(&moved.targets) && found.is_at(&target) =>
        {
            (TargetStatus::Executed, Place::At(target.clone()))
        }
        (Some(moved), Some(id)) if moved.id < id => {
            (TargetStatus::NotExecuted, Place::At(before.clone()))
        }
        (Some(_), Some(_)) => (TargetStatus::HeldDuringMotion, on_the_way()),
        // Without a memory of moves only the position decides; if both are equally near, the same target is requested
        // again.
        _ if found.is_at(&before) => (TargetStatus::NotExecuted, Place::At(before.clone())),
        _ if found.is_at(&target) => (TargetStatus::Executed, Place::At(target.clone())),
        _ => (TargetStatus::HeldDuringMotion, on_the_way()),
    };
    Ok(if target_status.sends_again() {
        LastTarget {
            sends: Some((target, intent.rate)),
            ..decided(lines[at].seq, target_status, place)
        }
    } else {
        decided(after, target_status, place)
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
    let entries = logged.lines.iter().chain(&logged.set_aside);
    let mut lines: Vec<Line> = entries.cloned().collect();
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

/// The entry from which an interrupted run may be repeated, by the state of the rig: the target at its end without a reading, or the
/// stroke at its end, if most of its readings are missing.
pub(super) fn undecided(lines: &[Line]) -> Result<Option<Undecided>, UnreadableLog> {
    let Some(at) = lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent)
    else {
        return Ok(None);
    };
    let intent: IntentBody = body(&lines[at])?;
    let seq = lines[at].seq;
    if intent.samples.is_none() && at + 1 == lines.len() {
        return Ok(Some(Undecided::Target(seq)));
    }
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
    Ok((is_cut && lost).then_some(Undecided::Stroke(seq)))
}

fn last_reading(lines: &[Line]) -> Result<Option<Measured>, UnreadableLog> {
    let last = lines
        .iter()
        .rev()
        .find(|line| line.kind == EntryKind::Sample);
    last.map(|line| body::<SampleBody>(line).map(|sample| (sample.x, sample.r)))
        .transpose()
}

/// The position of the rig before an INTENT: the targets before it, or the first reading.
fn position_before(lines: &[Line], axes: usize, bands: &Bands) -> Result<Vec<f64>, UnreadableLog> {
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
        |line| body::<SampleBody>(line).map(|sample| bands.controlled(&sample.x, &sample.r)),
    )
}
