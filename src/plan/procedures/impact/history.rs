//! The history of an impact, on one degree of freedom or on a floor of a frame: one row per step.

use crate::record::{StepState, StruckFrame};
use psd_physics::impact::energy::Energies;
use psd_physics::impact::summary::ImpactEnding;
use psd_physics::reintegration::recorded_path::Reading;
use psd_physics::tracking::monitor::Tracking;
use std::ops::Range;

/// One row of an impact's table; step 0 is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactStep {
    pub step: u64,
    /// Simulated time \[s\].
    pub time: f64,
    /// Rig time \[s\].
    pub wall_time: f64,
    pub state: StepState,
    /// Commanded to the actuator \[m\].
    pub command: f64,
    /// Computed displacement X \[m\]: the command; under α-OS the command corrected by the force read there.
    pub computed: f64,
    /// Measured \[m\].
    pub displacement: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub restoring_force: f64,
    /// Mean over the step \[N\]; zero at step 0.
    pub contact_force: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub tangent_stiffness: f64,
    /// Permanent \[m\].
    pub indentation: f64,
    pub energies: Energies,
    /// The tracking errors.
    pub tracking: Tracking,
}

/// An impact, step by step: on one degree of freedom, or on one floor of a frame.
#[derive(Clone, Debug)]
pub struct ImpactHistory {
    /// The striker and the struck point. For a frame: the struck floor and storey, with the energies of the whole frame and
    /// the tracking of all axes together.
    pub steps: ImpactSteps,
    pub ending: ImpactEnding,
    /// None for one degree of freedom.
    pub frame: Option<StruckFrame>,
    /// \[s\]
    pub time_step: f64,
    /// \[s\]
    pub critical_time_step: f64,
}

/// The steps of an impact, number by number. A number that never changes takes no memory: a run of a million steps has many.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactSteps {
    /// Number of the first one; the next ones follow it.
    first: u64,
    states: Vec<StepState>,
    /// Commands, measured displacements and restoring forces.
    readings: Vec<Reading>,
    /// Computed displacements; None while each is the command.
    computed: Option<Vec<f64>>,
    /// Empty without steps.
    numbers: Vec<Numbers>,
}

/// One number of every step.
#[derive(Clone, Debug, PartialEq)]
enum Numbers {
    Constant(f64),
    Each(Vec<f64>),
}

/// How many numbers of a step are in [`ImpactSteps::numbers`].
const NUMBERS: usize = 22;

impl Default for Numbers {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl Numbers {
    /// Adds the number of the step at `index`.
    #[inline]
    fn push(&mut self, index: usize, number: f64, capacity: usize) {
        match self {
            Self::Each(numbers) => numbers.push(number),
            Self::Constant(constant) if constant.to_bits() == number.to_bits() => {}
            Self::Constant(constant) if index == 0 => *constant = number,
            Self::Constant(constant) => {
                let mut numbers = Vec::with_capacity(capacity);
                numbers.resize(index, *constant);
                numbers.push(number);
                *self = Self::Each(numbers);
            }
        }
    }

    /// That of the step at `index`, which exists.
    #[inline]
    fn at(&self, index: usize) -> f64 {
        match self {
            Self::Constant(constant) => *constant,
            Self::Each(numbers) => numbers.get(index).copied().unwrap_or(f64::NAN),
        }
    }
}

impl ImpactSteps {
    /// No steps, with space for so many.
    #[must_use]
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            states: Vec::with_capacity(capacity),
            readings: Vec::with_capacity(capacity),
            ..Self::default()
        }
    }

    /// Adds the next step.
    #[inline]
    pub fn push(&mut self, step: &ImpactStep) {
        let index = self.states.len();
        if index == 0 {
            self.first = step.step;
            self.numbers.resize_with(NUMBERS, Numbers::default);
        }
        let capacity = self.states.capacity();
        if self.computed.is_none() && step.computed.to_bits() != step.command.to_bits() {
            let mut computed = Vec::with_capacity(capacity);
            computed.extend(self.readings.iter().map(|reading| reading.target));
            self.computed = Some(computed);
        }
        if let Some(computed) = &mut self.computed {
            computed.push(step.computed);
        }
        self.states.push(step.state);
        self.readings.push(Reading {
            target: step.command,
            displacement: step.displacement,
            force: step.restoring_force,
        });
        for (numbers, number) in self.numbers.iter_mut().zip(step.numbers()) {
            numbers.push(index, number, capacity);
        }
    }

    #[must_use]
    pub const fn len(&self) -> usize {
        self.states.len()
    }

    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// The step at `index`, from 0.
    #[inline]
    #[must_use]
    pub fn get(&self, index: usize) -> Option<ImpactStep> {
        (index < self.len()).then(|| self.at(index))
    }

    /// Numbers that the caller does not use are not read: it is a part of each of them.
    #[expect(clippy::inline_always, reason = "a call would read all numbers")]
    #[inline(always)]
    fn at(&self, index: usize) -> ImpactStep {
        let (state, reading) = (self.states[index], self.readings[index]);
        let computed = match &self.computed {
            None => reading.target,
            Some(computed) => computed.get(index).copied().unwrap_or(f64::NAN),
        };
        let number = |column: usize| {
            let numbers = self.numbers.get(column);
            numbers.map_or(f64::NAN, |numbers| numbers.at(index))
        };
        ImpactStep {
            step: self.first + index as u64,
            time: number(0),
            wall_time: number(1),
            state,
            command: reading.target,
            computed,
            displacement: reading.displacement,
            velocity: number(2),
            acceleration: number(3),
            restoring_force: reading.force,
            contact_force: number(4),
            striker_displacement: number(5),
            striker_velocity: number(6),
            tangent_stiffness: number(7),
            indentation: number(8),
            energies: Energies {
                striker: number(9),
                structure: number(10),
                restoring: number(11),
                damping: number(12),
                contact_loss: number(13),
                indentation: number(14),
                weight: number(15),
                gravity: number(16),
                error: number(17),
            },
            tracking: Tracking {
                energy_error: number(18),
                indicator: number(19),
                nrms_error: number(20),
                peak_error: number(21),
            },
        }
    }

    #[must_use]
    pub fn first(&self) -> Option<ImpactStep> {
        self.get(0)
    }

    #[must_use]
    pub fn last(&self) -> Option<ImpactStep> {
        self.get(self.len().checked_sub(1)?)
    }

    /// All steps, in order.
    #[must_use]
    pub const fn iter(&self) -> StepsInOrder<'_> {
        self.range(0..self.len())
    }

    /// Those at these indices, all of which exist.
    #[must_use]
    pub const fn range(&self, range: Range<usize>) -> StepsInOrder<'_> {
        StepsInOrder { steps: self, range }
    }

    /// Each step with the next one.
    pub fn pairs(&self) -> impl Iterator<Item = (ImpactStep, ImpactStep)> {
        self.iter().zip(self.range(1..self.len()))
    }

    #[must_use]
    pub fn states(&self) -> &[StepState] {
        &self.states
    }

    /// What was commanded and read, step by step.
    #[must_use]
    pub fn readings(&self) -> &[Reading] {
        &self.readings
    }
}

/// Steps in order.
#[derive(Clone, Debug)]
pub struct StepsInOrder<'a> {
    steps: &'a ImpactSteps,
    /// Their indices.
    range: Range<usize>,
}

impl Iterator for StepsInOrder<'_> {
    type Item = ImpactStep;

    #[expect(clippy::inline_always, reason = "as `ImpactSteps::at`")]
    #[inline(always)]
    fn next(&mut self) -> Option<ImpactStep> {
        let index = self.range.next()?;
        Some(self.steps.at(index))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.range.size_hint()
    }
}

impl DoubleEndedIterator for StepsInOrder<'_> {
    #[expect(clippy::inline_always, reason = "as `ImpactSteps::at`")]
    #[inline(always)]
    fn next_back(&mut self) -> Option<ImpactStep> {
        let index = self.range.next_back()?;
        Some(self.steps.at(index))
    }
}

impl ExactSizeIterator for StepsInOrder<'_> {}

impl<'a> IntoIterator for &'a ImpactSteps {
    type Item = ImpactStep;
    type IntoIter = StepsInOrder<'a>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl FromIterator<ImpactStep> for ImpactSteps {
    fn from_iter<I: IntoIterator<Item = ImpactStep>>(steps: I) -> Self {
        let mut all = Self::default();
        steps.into_iter().for_each(|step| all.push(&step));
        all
    }
}

impl ImpactStep {
    /// As [`ImpactSteps::get`] puts them back.
    #[inline]
    const fn numbers(&self) -> [f64; NUMBERS] {
        let Self {
            energies, tracking, ..
        } = self;
        [
            self.time,
            self.wall_time,
            self.velocity,
            self.acceleration,
            self.contact_force,
            self.striker_displacement,
            self.striker_velocity,
            self.tangent_stiffness,
            self.indentation,
            energies.striker,
            energies.structure,
            energies.restoring,
            energies.damping,
            energies.contact_loss,
            energies.indentation,
            energies.weight,
            energies.gravity,
            energies.error,
            tracking.energy_error,
            tracking.indicator,
            tracking.nrms_error,
            tracking.peak_error,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All numbers differ from step to step, or change late, or never: each step comes back as it was, also a negative zero.
    #[test]
    fn steps_come_back_to_the_bit_and_constant_numbers_take_no_memory() {
        let step = |index: u32| {
            let number = f64::from(index).sin();
            let late = if index < 7 { 0.0 } else { -0.0 };
            ImpactStep {
                step: 3 + u64::from(index),
                time: 1e-3 * f64::from(index),
                wall_time: 0.5 + f64::from(index),
                state: if index == 4 {
                    StepState::Contact
                } else {
                    StepState::Free
                },
                command: number,
                computed: if index < 5 { number } else { number + 1e-9 },
                displacement: 1.01 * number,
                velocity: -number,
                acceleration: number * number,
                restoring_force: 100.0 * number,
                contact_force: late,
                striker_displacement: number - 1.0,
                striker_velocity: number + 1.0,
                tangent_stiffness: 327.65,
                indentation: 0.0,
                energies: Energies {
                    striker: number,
                    error: late,
                    ..Energies::default()
                },
                tracking: Tracking {
                    indicator: number,
                    ..Tracking::default()
                },
            }
        };
        let all: ImpactSteps = (0..10).map(step).collect();
        assert_eq!((all.len(), all.is_empty()), (10, false));
        for (index, kept) in (0..).zip(all.iter()) {
            let wanted = step(index);
            assert_eq!(kept, wanted);
            assert_eq!(
                kept.numbers().map(f64::to_bits),
                wanted.numbers().map(f64::to_bits)
            );
        }
        assert_eq!((all.first(), all.last()), (Some(step(0)), Some(step(9))));
        assert_eq!(all.get(10), None);
        assert!(all.range(2..4).eq([step(2), step(3)]));
        assert!(all.pairs().nth(8) == Some((step(8), step(9))));
        let constant = |numbers: &&Numbers| matches!(numbers, Numbers::Constant(_));
        assert_eq!(all.numbers.iter().filter(constant).count(), 12);
        let before: ImpactSteps = (0..5).map(step).collect();
        assert!(before.computed.is_none() && all.computed.is_some());
        let none = ImpactSteps::default();
        assert_eq!(
            (none.first(), none.last(), none.pairs().count()),
            (None, None, 0)
        );
    }
}
