//! The operator's permission to move the rig when a run is resumed. In: the reading of the rig, and the first command. Out: who permits
//! the motion, or no permission. Nothing has moved yet, and the run log has not changed.

use super::watch::Watcher;
use crate::exit::Failure;
use psd::run::replay::{Assurance, ResumeDecision, TargetStatus};
use psd::run::{Inspection, Motion, Observer as _};
use psd_plan::Plan;
use psd_rig::{Reading, Rig, RigFault, position_and_force};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Time between two checks for the operator's decision \[s\]. The rig is not polled in between.
const BREATH: f64 = 0.05;

/// Asks whether the rig may move again; returns who permitted it, and the text of the answer.
pub fn ask(
    plan: &Plan,
    assured: &[Assurance],
    found: &Reading,
    decision: &ResumeDecision,
    rig: &mut dyn Rig,
    watcher: &mut Watcher,
) -> Result<String, Failure> {
    let axial = plan.rig.axial_axes(&plan.limits).count();
    let next = next(assured, found, decision, axial);
    let question = format!("resume on rig {}: {next}", plan.rig.name);
    let motion = Motion::of(plan, rig.identity(), next);
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

/// The present and the last logged reading, and the next motion. Its speed is in the list of the motion, once. The last `axial` targets are
/// forces.
fn next(assured: &[Assurance], found: &Reading, decision: &ResumeDecision, axial: usize) -> String {
    let joined = |targets: &[f64]| {
        let lateral = targets.len().saturating_sub(axial);
        let text = |(axis, target): (usize, &f64)| {
            if axis < lateral {
                readable(*target, Dimension::LENGTH)
            } else {
                format!("AXIAL {}", readable(*target, Dimension::FORCE))
            }
        };
        let texts: Vec<String> = targets.iter().enumerate().map(text).collect();
        texts.join(", ")
    };
    let next = match (&decision.sends, &decision.target_status) {
        (Some((to, _)), TargetStatus::NotExecuted) => {
            format!(
                "the last target did not arrive: it MOVES to {}, then as the plan specifies",
                joined(to)
            )
        }
        (Some((to, _)), _) => {
            format!(
                "the last target was not reached: it MOVES to {}, then as the plan specifies",
                joined(to)
            )
        }
        (None, TargetStatus::Stroke { back_to, others }) => {
            let to: Vec<f64> = std::iter::once(*back_to)
                .chain(others.iter().copied())
                .collect();
            format!(
                "a motion was interrupted: it MOVES back to {}, then as the plan specifies",
                joined(&to)
            )
        }
        (None, TargetStatus::RemainingMotion { .. }) => {
            "a motion was interrupted: it MOVES on to its target from here, then as the plan specifies"
                .to_owned()
        }
        (None, TargetStatus::Executed) => {
            "it reached its last target, and MOVES as the plan specifies".to_owned()
        }
        (None, _) => {
            "it is at its last logged position, and MOVES as the plan specifies".to_owned()
        }
    };
    let faster = if assured.contains(&Assurance::AcceptedSpeed) {
        ", FASTER than before"
    } else {
        ""
    };
    let recorded = decision.held.as_ref().or(decision.recorded.as_ref());
    let recorded = recorded.map_or_else(String::new, |(positions, forces)| {
        format!("; last logged at {}", position_and_force(positions, forces))
    });
    let loads = found.force.iter().rev().take(axial).rev();
    let loads = loads.map(|force| {
        format!(
            "; AXIAL holds {} in FORCE CONTROL",
            readable(*force, Dimension::FORCE)
        )
    });
    format!(
        "found at {}{}{recorded}; {next}{faster}",
        position_and_force(&found.displacement, &found.force),
        loads.collect::<String>()
    )
}
