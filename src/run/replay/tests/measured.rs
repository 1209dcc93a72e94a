//! The measured and computed results of a run, as text that tests compare. It does not depend on the run log.

use std::fmt::Write as _;

use psd_plan::record::{History, ImpactHistory, Record};

/// The measured and computed values of a run, without their times.
pub(crate) fn measured(record: &Record) -> String {
    let mut text = String::new();
    for procedure in &record.procedures {
        writeln!(text, "{} {:?}", procedure.name, procedure.results).unwrap();
        for reading in &procedure.axial {
            writeln!(text, "{:?} {:?}", reading.target, reading.force).unwrap();
        }
        match &procedure.history {
            History::StiffnessRamp(history) => {
                for step in &history.steps {
                    writeln!(
                        text,
                        "{:?} {:?} {:?}",
                        step.command, step.displacement, step.restoring_force
                    )
                    .unwrap();
                }
            }
            History::Impact(ImpactHistory {
                frame: Some(frame),
                steps,
                ..
            }) => {
                for (step, floors) in steps.iter().zip(&frame.floors) {
                    writeln!(
                        text,
                        "{:?} {:?} {:?}",
                        step.striker_velocity, step.energies, floors
                    )
                    .unwrap();
                }
            }
            History::Impact(history) => {
                for step in &history.steps {
                    writeln!(
                        text,
                        "{:?} {:?} {:?} {:?}",
                        step.command, step.velocity, step.restoring_force, step.energies
                    )
                    .unwrap();
                }
            }
            History::DampingSweep(history) => {
                for step in &history.steps {
                    writeln!(text, "{:?} {:?}", step.displacement, step.restoring_force).unwrap();
                }
            }
            History::Move(steps) => writeln!(
                text,
                "{:?}",
                steps.iter().map(|step| step.command).collect::<Vec<_>>()
            )
            .unwrap(),
            History::Unload(history) => {
                for step in &history.steps {
                    writeln!(
                        text,
                        "{:?} {:?} {:?}",
                        step.command, step.displacement, step.restoring_force
                    )
                    .unwrap();
                }
            }
            History::Escalate(history) => {
                writeln!(
                    text,
                    "{:?}",
                    history
                        .impacts
                        .iter()
                        .map(|impact| (&impact.results, &impact.rest))
                        .collect::<Vec<_>>()
                )
                .unwrap();
            }
            History::Cycle(history) => {
                for step in &history.steps {
                    writeln!(
                        text,
                        "{:?} {:?} {:?}",
                        step.command, step.displacement, step.restoring_force
                    )
                    .unwrap();
                }
            }
            History::Shake(history) => {
                for step in &history.steps {
                    writeln!(
                        text,
                        "{:?} {:?} {:?}",
                        step.floors.command, step.floors.displacement, step.floors.restoring_force
                    )
                    .unwrap();
                }
            }
            History::Preload | History::Inspect => {}
        }
    }
    if let Some(drift) = &record.drift {
        let zeros = drift
            .axes
            .iter()
            .map(|axis| (axis.before.force, axis.after.map(|after| after.force)));
        writeln!(text, "{:?}", zeros.collect::<Vec<_>>()).unwrap();
    }
    text
}
