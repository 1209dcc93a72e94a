//! The contact log of an impact: every contact period with its time, impulse and largest force. In: the steps. Out: a table. A
//! period is not a contact: a law that follows the contact inside a step can have several contacts in one period, which the result
//! `contacts` counts.

use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use psd_plan::record::{ImpactHistory, ImpactSteps, StepState};
use psd_text::units::Dimension;

/// Contact periods printed; the tables hold every step.
const PRINTED: usize = 24;

/// Consecutive steps in contact or at the limit force.
#[derive(Debug, PartialEq)]
struct Period {
    start: f64,
    end: f64,
    impulse: f64,
    largest_force: f64,
    /// Whether the limit force acted.
    limited: bool,
}

/// The log, shortened if it is long; `contacts` is the number of contacts of the impact.
pub(crate) fn table(history: &ImpactHistory, contacts: Option<f64>, body: &mut Vec<Block>) {
    let periods = periods(&history.steps);
    if periods.is_empty() {
        body.push(Block::paragraph("Striker and structure did not touch."));
        return;
    }
    let end = history.steps.last().map_or(0.0, |step| step.time);
    let row = |(index, period): (usize, &Period)| -> Vec<Text> {
        let limited = if period.limited { " (limit force)" } else { "" };
        vec![
            format!(
                "period {} at {}{limited}",
                index + 1,
                number::text_beside(period.start, end, Dimension::TIME)
            )
            .into(),
            number::text(period.end - period.start, Dimension::TIME).into(),
            number::text(period.impulse, Dimension::IMPULSE).into(),
            number::text(period.largest_force, Dimension::FORCE).into(),
        ]
    };
    let columns = vec![
        Column::words("Contact period", 1),
        Column::numbers("Duration"),
        Column::numbers("Impulse"),
        Column::numbers("Largest force"),
    ];
    body.push(Block::Table(Table {
        columns,
        rows: periods.iter().take(PRINTED).enumerate().map(row).collect(),
    }));
    if periods.len() > PRINTED {
        body.push(Block::note(format!(
            "{} more contact periods are in the table of this procedure.",
            periods.len() - PRINTED
        )));
    }
    #[expect(clippy::cast_precision_loss, reason = "fewer periods than steps")]
    let differs = |contacts: &f64| *contacts != periods.len() as f64;
    if let Some(contacts) = contacts.filter(differs) {
        body.push(Block::note(format!(
            "A contact period is a sequence of steps in contact. It can have several contacts: this impact has {}.",
            number::text(contacts, Dimension::NUMBER)
        )));
    }
}

/// A step's force is its mean over the time since the step before; step 0 has none.
fn periods(steps: &ImpactSteps) -> Vec<Period> {
    let mut periods: Vec<Period> = Vec::new();
    let mut touching = false;
    for (before, step) in steps.pairs() {
        let touched = std::mem::replace(&mut touching, step.state != StepState::Free);
        if !touching {
            continue;
        }
        let impulse = step.contact_force * (step.time - before.time);
        let limited = step.state == StepState::Limit;
        match periods.last_mut().filter(|_| touched) {
            Some(period) => {
                period.end = step.time;
                period.impulse += impulse;
                period.largest_force = period.largest_force.max(step.contact_force);
                period.limited |= limited;
            }
            None => periods.push(Period {
                start: before.time,
                end: step.time,
                impulse,
                largest_force: step.contact_force,
                limited,
            }),
        }
    }
    periods
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_physics::impact::energy::Energies;
    use psd_physics::tracking::monitor::Tracking;
    use psd_plan::record::ImpactStep;

    #[test]
    fn consecutive_steps_in_contact_are_one_period() {
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
        let found = periods(&steps.into_iter().collect());
        assert_eq!(
            found,
            [
                Period {
                    start: 0.0,
                    end: 2.0,
                    impulse: 12.0,
                    largest_force: 9.0,
                    limited: true
                },
                Period {
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
