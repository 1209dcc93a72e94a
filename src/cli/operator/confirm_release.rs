//! The operator's permission to move the rig when a run is resumed. In: the reading of the rig, and the first command. Out: who permits
//! the motion, or no permission. Nothing has moved yet, and the run log has not changed.

use super::watch::Watcher;
use crate::cli::exit::Failure;
use crate::plan::{Plan, RealLink};
use crate::rig::{Reading, Rig, RigFault, position_and_force};
use crate::run::replay::{ResumeDecision, TargetStatus};
use crate::run::{Inspection, Motion, Observer as _};
use crate::units::Dimension;
use crate::units::display::{plain, readable};

/// Time between two checks for the operator's decision \[s\]. The rig is not polled in between.
const BREATH: f64 = 0.05;

/// Asks whether the rig may move again; returns who permitted it, and the text of the answer.
pub fn ask(
    plan: &Plan,
    link: &RealLink,
    found: &Reading,
    decision: &ResumeDecision,
    rig: &mut dyn Rig,
    watcher: &mut Watcher,
) -> Result<String, Failure> {
    let question = question(plan, link, found, decision);
    let motion = Motion::of(plan, rig.identity(), next(link, found, decision));
    loop {
        match watcher.release(&question, &motion) {
            Inspection::Stop { reason, .. } => return Err(refused(watcher, reason)),
            // A stop request has priority over an answer.
            _ if watcher.stop_requested() => {
                return Err(refused(watcher, "stopped on request".to_owned()));
            }
            Inspection::GoOn { note, by } => {
                let by = by.unwrap_or_else(|| "the operator".to_owned());
                return Ok(note.map_or_else(|| by.clone(), |note| format!("{by}: {note}")));
            }
            Inspection::Wait => match rig.pause(BREATH) {
                // The hold request remains set: the next check refuses.
                Ok(()) | Err(RigFault::Interrupted) => {}
                Err(fault) => {
                    watcher.finish();
                    return Err(fault.into());
                }
            },
        }
    }
}

fn refused(watcher: &mut Watcher, reason: String) -> Failure {
    watcher.finish();
    Failure::NotReleased { reason }
}

/// The present reading, the next motion, and how the rig moves.
fn question(plan: &Plan, link: &RealLink, found: &Reading, decision: &ResumeDecision) -> String {
    format!(
        "resume on rig {}: {}",
        plan.rig.name,
        next(link, found, decision)
    )
}

fn next(link: &RealLink, found: &Reading, decision: &ResumeDecision) -> String {
    let joined = |positions: &[f64]| {
        positions
            .iter()
            .map(|position| readable(*position, Dimension::LENGTH))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let at = |speed: f64| plain(speed, Dimension::VELOCITY, 4);
    let own = at(link.own_speed);
    let next = match (&decision.sends, &decision.target_status) {
        (Some((to, speed)), TargetStatus::NotExecuted) => {
            format!(
                "the last target did not arrive: it MOVES to {} at {}, then as the plan specifies",
                joined(to),
                at(*speed)
            )
        }
        (Some((to, speed)), _) => {
            format!(
                "the last target was not reached: it MOVES to {} at {}, then as the plan specifies",
                joined(to),
                at(*speed)
            )
        }
        (None, TargetStatus::Stroke { back_to, others }) => {
            let to: Vec<f64> = std::iter::once(*back_to)
                .chain(others.iter().copied())
                .collect();
            format!(
                "a motion was interrupted: it MOVES back to {} at {own}, then as the plan specifies",
                joined(&to)
            )
        }
        (None, TargetStatus::RemainingMotion { .. }) => {
            "a motion was interrupted: it MOVES on to its target from here, then as the plan specifies"
                .to_owned()
        }
        (None, _) => {
            format!(
                "it is at its last logged position, and MOVES as the plan specifies, at {own} if the plan gives no speed"
            )
        }
    };
    format!(
        "found at {}; {next}",
        position_and_force(&found.displacement, &found.force)
    )
}
