//! The contact log of an impact: every blow with its time, impulse and largest force. In: the steps. Out: a table.

use crate::record::{ImpactHistory, ImpactStep, StepState};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::units::Dimension;

/// Blows printed; the tables hold every step.
const PRINTED: usize = 24;

/// A run of steps in contact or at the limit force.
#[derive(Debug, PartialEq)]
struct Blow {
    start: f64,
    end: f64,
    impulse: f64,
    largest_force: f64,
    /// Whether the limit force acted.
    limited: bool,
}

/// The log, shortened where it is long.
pub(crate) fn table(history: &ImpactHistory, body: &mut Vec<Block>) {
    let blows = blows(&history.steps);
    if blows.is_empty() {
        body.push(Block::paragraph("Striker and structure did not touch."));
        return;
    }
    let end = history.steps.last().map_or(0.0, |step| step.time);
    let row = |(index, blow): (usize, &Blow)| -> Vec<Text> {
        let limited = if blow.limited { " (limit force)" } else { "" };
        vec![
            format!(
                "blow {} at {}{limited}",
                index + 1,
                number::text_beside(blow.start, end, Dimension::TIME)
            )
            .into(),
            number::text(blow.end - blow.start, Dimension::TIME).into(),
            number::text(blow.impulse, Dimension::IMPULSE).into(),
            number::text(blow.largest_force, Dimension::FORCE).into(),
        ]
    };
    let columns = vec![
        Column::words("Contact log", 1),
        Column::numbers("Duration"),
        Column::numbers("Impulse"),
        Column::numbers("Largest force"),
    ];
    body.push(Block::Table(Table {
        columns,
        rows: blows.iter().take(PRINTED).enumerate().map(row).collect(),
    }));
    if blows.len() > PRINTED {
        body.push(Block::note(format!(
            "{} more blows are in the table of this procedure.",
            blows.len() - PRINTED
        )));
    }
}

/// A step's force is its mean over the time since the step before; step 0 has none.
fn blows(steps: &[ImpactStep]) -> Vec<Blow> {
    let mut blows: Vec<Blow> = Vec::new();
    let mut touching = false;
    for pair in steps.windows(2) {
        let (before, step) = (&pair[0], &pair[1]);
        let touched = std::mem::replace(&mut touching, step.state != StepState::Free);
        if !touching {
            continue;
        }
        let impulse = step.contact_force * (step.time - before.time);
        let limited = step.state == StepState::Limit;
        match blows.last_mut().filter(|_| touched) {
            Some(blow) => {
                blow.end = step.time;
                blow.impulse += impulse;
                blow.largest_force = blow.largest_force.max(step.contact_force);
                blow.limited |= limited;
            }
            None => blows.push(Blow {
                start: before.time,
                end: step.time,
                impulse,
                largest_force: step.contact_force,
                limited,
            }),
        }
    }
    blows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::impact::energy::Energies;
    use crate::physics::tracking::monitor::Tracking;

    #[test]
    fn neighbouring_steps_of_contact_are_one_blow() {
        let step = |index: u32, state, contact_force| ImpactStep {
            step: u64::from(index),
            time: f64::from(index),
            wall_time: 0.0,
            state,
            command: 0.0,
            computed: 0.0,
            displacement: 0.0,
            velocity: 0.0,
            acceleration: 0.0,
            restoring_force: 0.0,
            contact_force,
            striker_displacement: 0.0,
            striker_velocity: 0.0,
            tangent_stiffness: 0.0,
            indentation: 0.0,
            energies: Energies::default(),
            tracking: Tracking::default(),
        };
        let steps = [
            step(0, StepState::Free, 0.0),
            step(1, StepState::Limit, 9.0),
            step(2, StepState::Contact, 3.0),
            step(3, StepState::Free, 0.0),
            step(4, StepState::Contact, 5.0),
        ];
        let found = blows(&steps);
        assert_eq!(
            found,
            [
                Blow {
                    start: 0.0,
                    end: 2.0,
                    impulse: 12.0,
                    largest_force: 9.0,
                    limited: true
                },
                Blow {
                    start: 3.0,
                    end: 4.0,
                    impulse: 5.0,
                    largest_force: 5.0,
                    limited: false
                },
            ]
        );
    }
}
