//! The history of an impact, on one degree of freedom or on a floor of a frame: one row per step.

use crate::record::{StepState, StruckFrame};
use psd_physics::impact::energy::{Energies, kinetic_energy};
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

/// The steps of an impact, number by number. A time or a kinetic energy is expected to follow from [`ImpactConstants`], a computed or
/// measured displacement from the command, and any other number to be the same as at the first step. While a number is as expected in
/// every step, it takes no memory: a run of a million steps has many such numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactSteps {
    constants: ImpactConstants,
    /// Number of the first one; the next ones follow it.
    first: u64,
    states: Vec<StepState>,
    /// None without steps.
    numbers: Option<Box<[Numbers; NUMBERS]>>,
}

/// Constants of an impact, from which times and kinetic energies follow with the number of the step and the velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpactConstants {
    /// \[s\]
    pub time_step: f64,
    /// \[kg\]
    pub mass: f64,
    /// \[kg\]
    pub striker_mass: f64,
}

/// One number of every step.
#[derive(Clone, Debug, Default, PartialEq)]
struct Numbers {
    first: f64,
    /// Empty while each is as expected.
    each: Vec<f64>,
}

/// How many numbers a step has.
const NUMBERS: usize = 26;

/// The numbers without steps.
static NO_NUMBERS: [Numbers; NUMBERS] = [const {
    Numbers {
        first: f64::NAN,
        each: Vec::new(),
    }
}; NUMBERS];

/// The numbers from which others follow, by their index in [`ImpactStep::numbers`].
const COMMAND: usize = 2;
/// See [`COMMAND`].
const VELOCITY: usize = 5;
/// See [`COMMAND`].
const STRIKER_VELOCITY: usize = 10;

impl ImpactSteps {
    /// No steps, with space for so many.
    #[must_use]
    pub fn with_capacity(capacity: usize, constants: ImpactConstants) -> Self {
        Self {
            constants,
            states: Vec::with_capacity(capacity),
            ..Self::default()
        }
    }

    /// Adds the next step.
    #[inline]
    pub fn push(&mut self, step: &ImpactStep) {
        let numbers = step.numbers();
        if self.is_empty() {
            self.first = step.step;
            let kept = self.numbers.insert(Box::default());
            for (kept, number) in kept.iter_mut().zip(numbers) {
                kept.first = number;
            }
        }
        let firsts = self.numbers();
        let others_follow = [COMMAND, VELOCITY, STRIKER_VELOCITY];
        let mut expected = self
            .step(self.len(), step.state, |index, expected| {
                if others_follow.contains(&index) {
                    numbers[index]
                } else {
                    expected
                }
            })
            .numbers();
        for index in others_follow {
            expected[index] = firsts[index].first;
        }
        let mut unexpected = 0_u32;
        for (index, (number, expected)) in numbers.iter().zip(&expected).enumerate() {
            unexpected |= u32::from(number.to_bits() != expected.to_bits()) << index;
        }
        if let Some(kept) = &mut self.numbers {
            for (index, kept) in kept.iter_mut().enumerate() {
                if !kept.each.is_empty() {
                    kept.each.push(numbers[index]);
                    unexpected &= !(1 << index);
                }
            }
        }
        if unexpected != 0 {
            self.keep_from_now_on(unexpected, &numbers);
        }
        self.states.push(step.state);
    }

    /// Keeps the numbers with these indices, one bit each: those of the steps so far, and of the next one.
    #[cold]
    fn keep_from_now_on(&mut self, indices: u32, next: &[f64; NUMBERS]) {
        for index in (0..NUMBERS).filter(|index| indices >> index & 1 == 1) {
            let mut each = Vec::with_capacity(self.states.capacity());
            each.extend(self.iter().map(|step| step.numbers()[index]));
            each.push(next[index]);
            if let Some(numbers) = &mut self.numbers {
                numbers[index].each = each;
            }
        }
    }

    #[inline]
    fn numbers(&self) -> &[Numbers; NUMBERS] {
        self.numbers.as_deref().unwrap_or(&NO_NUMBERS)
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
        let numbers = self.numbers();
        self.step(index, self.states[index], |number, expected| {
            numbers[number].each.get(index).copied().unwrap_or(expected)
        })
    }

    /// The step at `index`, of which `number` gives each number, by its index, from the expected one.
    #[expect(clippy::cast_precision_loss, reason = "far fewer steps than 2^53")]
    #[expect(clippy::inline_always, reason = "as `ImpactSteps::at`")]
    #[inline(always)]
    fn step(
        &self,
        index: usize,
        state: StepState,
        number: impl Fn(usize, f64) -> f64,
    ) -> ImpactStep {
        let firsts = self.numbers();
        let as_first = |index: usize| number(index, firsts[index].first);
        let ImpactConstants {
            time_step,
            mass,
            striker_mass,
        } = self.constants;
        let step = self.first + index as u64;
        // A signed number is converted in one instruction.
        let time = step.cast_signed() as f64 * time_step;
        let command = as_first(COMMAND);
        let velocity = as_first(VELOCITY);
        let striker_velocity = as_first(STRIKER_VELOCITY);
        ImpactStep {
            step,
            time: number(0, time),
            wall_time: as_first(1),
            state,
            command,
            computed: number(3, command),
            displacement: number(4, command),
            velocity,
            acceleration: as_first(6),
            restoring_force: as_first(7),
            contact_force: as_first(8),
            striker_displacement: as_first(9),
            striker_velocity,
            tangent_stiffness: as_first(11),
            indentation: as_first(12),
            energies: Energies {
                striker: number(13, kinetic_energy(striker_mass, striker_velocity)),
                structure: number(14, kinetic_energy(mass, velocity)),
                restoring: as_first(15),
                damping: as_first(16),
                contact_loss: as_first(17),
                indentation: as_first(18),
                weight: as_first(19),
                gravity: as_first(20),
                error: as_first(21),
            },
            tracking: Tracking {
                energy_error: as_first(22),
                indicator: as_first(23),
                nrms_error: as_first(24),
                peak_error: as_first(25),
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
    pub fn readings(&self) -> Vec<Reading> {
        let reading = |step: ImpactStep| Reading {
            target: step.command,
            displacement: step.displacement,
            force: step.restoring_force,
        };
        self.iter().map(reading).collect()
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
            self.command,
            self.computed,
            self.displacement,
            self.velocity,
            self.acceleration,
            self.restoring_force,
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
#[expect(clippy::cast_precision_loss, reason = "26 numbers")]
mod tests {
    use super::*;

    /// The step with these numbers, in the order of [`ImpactStep::numbers`].
    fn step_of(step: u64, numbers: [f64; NUMBERS]) -> ImpactStep {
        let numbers = numbers.map(|first| Numbers {
            first,
            each: vec![first],
        });
        let steps = ImpactSteps {
            first: step,
            states: vec![StepState::Contact],
            numbers: Some(Box::new(numbers)),
            ..ImpactSteps::default()
        };
        steps.at(0)
    }

    /// The indices of the numbers that take memory.
    fn kept(steps: &ImpactSteps) -> Vec<usize> {
        let numbers = steps.numbers().iter().enumerate();
        numbers
            .filter(|(_, numbers)| !numbers.each.is_empty())
            .map(|(index, _)| index)
            .collect()
    }

    fn bits(step: ImpactStep) -> [u64; NUMBERS] {
        step.numbers().map(f64::to_bits)
    }

    /// All numbers differ from step to step, but the contact force, which never changes, and the indentation, which changes its sign once.
    #[test]
    fn steps_come_back_to_the_bit_and_constant_numbers_take_no_memory() {
        let step = |index: u32| ImpactStep {
            contact_force: 0.0,
            indentation: if index < 7 { 0.0 } else { -0.0 },
            state: if index == 4 {
                StepState::Free
            } else {
                StepState::Contact
            },
            ..step_of(
                3 + u64::from(index),
                std::array::from_fn(|number| (26.0 * f64::from(index) + number as f64).sin()),
            )
        };
        let all: ImpactSteps = (0..10).map(step).collect();
        assert_eq!((all.len(), all.is_empty()), (10, false));
        for (index, found) in (0..).zip(all.iter()) {
            assert_eq!(found, step(index));
            assert_eq!(bits(found), bits(step(index)));
        }
        assert_eq!((all.first(), all.last()), (Some(step(0)), Some(step(9))));
        assert_eq!(all.get(10), None);
        assert!(all.range(2..4).eq([step(2), step(3)]));
        assert!(all.pairs().nth(8) == Some((step(8), step(9))));
        let all_but = |constant: &[usize]| -> Vec<usize> {
            (0..NUMBERS)
                .filter(|number| !constant.contains(number))
                .collect()
        };
        assert_eq!(kept(&all), all_but(&[8]));
        let before: ImpactSteps = (0..7).map(step).collect();
        assert_eq!(kept(&before), all_but(&[8, 12]));
        let none = ImpactSteps::default();
        assert_eq!(
            (none.first(), none.last(), none.pairs().count()),
            (None, None, 0)
        );
    }

    /// Each number comes back in its own field: a step of the numbers 0 to 25, by name.
    #[test]
    fn each_number_has_its_field() {
        let numbers = std::array::from_fn(|number| number as f64);
        let step = step_of(7, numbers);
        assert_eq!(step.numbers(), numbers);
        let by_name = [
            step.time,
            step.command,
            step.displacement,
            step.velocity,
            step.restoring_force,
            step.contact_force,
            step.striker_velocity,
            step.energies.striker,
            step.energies.structure,
            step.energies.error,
            step.tracking.peak_error,
        ];
        assert_eq!(
            by_name,
            [0.0, 2.0, 4.0, 5.0, 7.0, 8.0, 10.0, 13.0, 14.0, 21.0, 25.0]
        );
    }

    /// Six steps on an ideal rig, on which times, kinetic energies, computed and measured displacements follow from other numbers, and
    /// three on which the displacement and the energy of the structure do not.
    #[test]
    fn numbers_that_follow_from_others_are_kept_once_they_do_not() {
        let constants = ImpactConstants {
            time_step: 1e-6,
            mass: 3.7,
            striker_mass: 12.9,
        };
        let step = |index: u32| {
            let (number, off) = (f64::from(index).sin(), if index < 6 { 0.0 } else { 1e-6 });
            let mut step = step_of(40 + u64::from(index), [0.5; NUMBERS]);
            step.time = f64::from(40 + index) * constants.time_step;
            (step.command, step.computed) = (number, number);
            step.displacement = number + off;
            step.velocity = 1.3 * number;
            step.restoring_force = 100.0 * number;
            step.striker_velocity = number - 0.2;
            step.energies.striker = kinetic_energy(constants.striker_mass, step.striker_velocity);
            step.energies.structure = kinetic_energy(constants.mass, step.velocity) + off;
            step
        };
        let mut all = ImpactSteps::with_capacity(9, constants);
        (0..6).for_each(|index| all.push(&step(index)));
        assert_eq!(kept(&all), [COMMAND, VELOCITY, 7, STRIKER_VELOCITY]);
        (6..9).for_each(|index| all.push(&step(index)));
        assert_eq!(kept(&all), [COMMAND, 4, VELOCITY, 7, STRIKER_VELOCITY, 14]);
        for (index, (found, reading)) in (0..).zip(all.iter().zip(all.readings())) {
            let step = step(index);
            assert_eq!(bits(found), bits(step));
            let read = Reading {
                target: step.command,
                displacement: step.displacement,
                force: step.restoring_force,
            };
            assert_eq!(reading, read);
        }
    }
}
