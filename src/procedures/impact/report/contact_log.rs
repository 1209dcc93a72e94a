//! The contact log of an impact: every contact with its time, impulse and largest force. In: the steps. Out: a table.

use crate::record::{ImpactHistory, ImpactStep, StepState};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::units::Dimension;

/// Contacts printed; the tables hold every step.
const PRINTED: usize = 24;

/// Consecutive steps in contact or at the limit force.
#[derive(Debug, PartialEq)]
struct Contact {
    start: f64,
    end: f64,
    impulse: f64,
    largest_force: f64,
    /// Whether the limit force acted.
    limited: bool,
}

/// The log, shortened if it is long.
pub(crate) fn table(history: &ImpactHistory, body: &mut Vec<Block>) {
    let contacts = contacts(&history.steps);
    if contacts.is_empty() {
        body.push(Block::paragraph("Striker and structure did not touch."));
        return;
    }
    let end = history.steps.last().map_or(0.0, |step| step.time);
    let row = |(index, contact): (usize, &Contact)| -> Vec<Text> {
        let limited = if contact.limited {
            " (limit force)"
        } else {
            ""
        };
        vec![
            format!(
                "contact {} at {}{limited}",
                index + 1,
                number::text_beside(contact.start, end, Dimension::TIME)
            )
            .into(),
            number::text(contact.end - contact.start, Dimension::TIME).into(),
            number::text(contact.impulse, Dimension::IMPULSE).into(),
            number::text(contact.largest_force, Dimension::FORCE).into(),
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
        rows: contacts.iter().take(PRINTED).enumerate().map(row).collect(),
    }));
    if contacts.len() > PRINTED {
        body.push(Block::note(format!(
            "{} more contact events are in the table of this procedure.",
            contacts.len() - PRINTED
        )));
    }
}

/// A step's force is its mean over the time since the step before; step 0 has none.
fn contacts(steps: &[ImpactStep]) -> Vec<Contact> {
    let mut contacts: Vec<Contact> = Vec::new();
    let mut touching = false;
    for pair in steps.windows(2) {
        let (before, step) = (&pair[0], &pair[1]);
        let touched = std::mem::replace(&mut touching, step.state != StepState::Free);
        if !touching {
            continue;
        }
        let impulse = step.contact_force * (step.time - before.time);
        let limited = step.state == StepState::Limit;
        match contacts.last_mut().filter(|_| touched) {
            Some(contact) => {
                contact.end = step.time;
                contact.impulse += impulse;
                contact.largest_force = contact.largest_force.max(step.contact_force);
                contact.limited |= limited;
            }
            None => contacts.push(Contact {
                start: before.time,
                end: step.time,
                impulse,
                largest_force: step.contact_force,
                limited,
            }),
        }
    }
    contacts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::impact::energy::Energies;
    use crate::physics::tracking::monitor::Tracking;

    #[test]
    fn consecutive_steps_in_contact_are_one_contact() {
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
        let found = contacts(&steps);
        assert_eq!(
            found,
            [
                Contact {
                    start: 0.0,
                    end: 2.0,
                    impulse: 12.0,
                    largest_force: 9.0,
                    limited: true
                },
                Contact {
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
