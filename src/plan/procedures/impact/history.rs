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

/// Indices in [`ImpactStep::numbers`].
const TIME: usize = 0;
const COMMAND: usize = 2;
const COMPUTED: usize = 3;
const DISPLACEMENT: usize = 4;
const VELOCITY: usize = 5;
const STRIKER_VELOCITY: usize = 10;
const STRIKER_ENERGY: usize = 13;
const STRUCTURE_ENERGY: usize = 14;

impl ImpactSteps {
    /// Keeps the number with this index, with space for so many.
    #[cold]
    fn keep_from_now_on(&mut self, number: usize, capacity: usize) {
        let mut each = Vec::with_capacity(capacity.max(self.len() + BLOCK));
        each.extend(self.iter().map(|step| step.numbers()[number]));
        if let Some(numbers) = &mut self.numbers {
            numbers[number].each = each;
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
        let kept = |number: usize| numbers[number].each.get(index).copied();
        // One that others follow from follows from none.
        let first = |number: usize| kept(number).unwrap_or(numbers[number].first);
        ImpactStep::of(self.first + index as u64, self.states[index], |number| {
            kept(number).unwrap_or_else(|| self.expected(number, index, first))
        })
    }

    /// The number with this index, as it follows from others or from that of the first step, of the step at `index`.
    #[expect(clippy::cast_precision_loss, reason = "far fewer steps than 2^53")]
    #[expect(clippy::inline_always, reason = "as `ImpactSteps::at`")]
    #[inline(always)]
    fn expected(&self, number: usize, index: usize, other: impl Fn(usize) -> f64) -> f64 {
        let ImpactConstants {
            time_step,
            mass,
            striker_mass,
        } = self.constants;
        match number {
            // A signed number is converted in one instruction.
            TIME => (self.first + index as u64).cast_signed() as f64 * time_step,
            COMPUTED | DISPLACEMENT => other(COMMAND),
            STRIKER_ENERGY => kinetic_energy(striker_mass, other(STRIKER_VELOCITY)),
            STRUCTURE_ENERGY => kinetic_energy(mass, other(VELOCITY)),
            _ => self.numbers()[number].first,
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

/// How many steps are put into the columns together.
const BLOCK: usize = 64;

/// The steps of an impact in progress. A block of steps is put into the columns number by number, which takes a third of the time of one step
/// after the other.
#[derive(Clone, Debug, Default)]
pub struct CollectedSteps {
    /// Those of all blocks that are complete.
    steps: ImpactSteps,
    capacity: usize,
    /// The steps of the present block.
    states: Vec<StepState>,
    rows: Vec<[f64; NUMBERS]>,
}

impl CollectedSteps {
    /// No steps, with space for so many.
    #[must_use]
    pub fn with_capacity(capacity: usize, constants: ImpactConstants) -> Self {
        Self {
            steps: ImpactSteps {
                constants,
                states: Vec::with_capacity(capacity),
                ..ImpactSteps::default()
            },
            capacity,
            states: Vec::with_capacity(BLOCK),
            rows: Vec::with_capacity(BLOCK),
        }
    }

    /// Adds the next step.
    #[inline]
    pub fn push(&mut self, step: &ImpactStep) {
        if self.rows.is_empty() && self.steps.is_empty() {
            self.steps.first = step.step;
        }
        self.states.push(step.state);
        self.rows.push(step.numbers());
        if self.rows.len() == BLOCK {
            self.put_into_columns();
        }
    }

    fn put_into_columns(&mut self) {
        let Self {
            steps,
            capacity,
            states,
            rows,
        } = self;
        let Some(first) = rows.first() else {
            return;
        };
        let before = steps.len();
        if steps.numbers.is_none() {
            let numbers = first.map(|first| Numbers {
                first,
                each: Vec::new(),
            });
            steps.numbers = Some(Box::new(numbers));
        }
        for number in 0..NUMBERS {
            let is_expected = |(at, row): (usize, &[f64; NUMBERS])| {
                let expected = steps.expected(number, before + at, |other| row[other]);
                row[number].to_bits() == expected.to_bits()
            };
            if steps.numbers()[number].each.is_empty() {
                if rows.iter().enumerate().all(is_expected) {
                    continue;
                }
                steps.keep_from_now_on(number, *capacity);
            }
            if let Some(numbers) = &mut steps.numbers {
                let each = &mut numbers[number].each;
                each.extend(rows.iter().map(|row| row[number]));
            }
        }
        steps.states.append(states);
        rows.clear();
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty() && self.steps.is_empty()
    }

    #[must_use]
    pub fn last(&self) -> Option<ImpactStep> {
        let Some((row, state)) = self.rows.last().zip(self.states.last()) else {
            return self.steps.last();
        };
        let before = self.steps.len() + self.rows.len() - 1;
        let step = self.steps.first + before as u64;
        Some(ImpactStep::of(step, *state, |number| row[number]))
    }

    /// All of them.
    #[must_use]
    pub fn finish(mut self) -> ImpactSteps {
        self.put_into_columns();
        self.steps
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
        let mut all = CollectedSteps::default();
        steps.into_iter().for_each(|step| all.push(&step));
        all.finish()
    }
}

impl ImpactStep {
    /// The step with these numbers, by their index in [`Self::numbers`].
    #[expect(clippy::inline_always, reason = "as `ImpactSteps::at`")]
    #[inline(always)]
    fn of(step: u64, state: StepState, number: impl Fn(usize) -> f64) -> Self {
        Self {
            step,
            time: number(TIME),
            wall_time: number(1),
            state,
            command: number(COMMAND),
            computed: number(COMPUTED),
            displacement: number(DISPLACEMENT),
            velocity: number(VELOCITY),
            acceleration: number(6),
            restoring_force: number(7),
            contact_force: number(8),
            striker_displacement: number(9),
            striker_velocity: number(STRIKER_VELOCITY),
            tangent_stiffness: number(11),
            indentation: number(12),
            energies: Energies {
                striker: number(STRIKER_ENERGY),
                structure: number(STRUCTURE_ENERGY),
                restoring: number(15),
                damping: number(16),
                contact_loss: number(17),
                indentation: number(18),
                weight: number(19),
                gravity: number(20),
                error: number(21),
            },
            tracking: Tracking {
                energy_error: number(22),
                indicator: number(23),
                nrms_error: number(24),
                peak_error: number(25),
            },
        }
    }

    /// All its numbers.
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
        ImpactStep::of(step, StepState::Contact, |number| numbers[number])
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
            indentation: if index < 100 { 0.0 } else { -0.0 },
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
        let all: ImpactSteps = (0..200).map(step).collect();
        assert_eq!((all.len(), all.is_empty()), (200, false));
        for (index, found) in (0..).zip(all.iter()) {
            assert_eq!(found, step(index));
            assert_eq!(bits(found), bits(step(index)));
        }
        assert_eq!((all.first(), all.last()), (Some(step(0)), Some(step(199))));
        assert_eq!(all.get(200), None);
        assert!(all.range(2..4).eq([step(2), step(3)]));
        assert!(all.pairs().nth(8) == Some((step(8), step(9))));
        let all_but = |constant: &[usize]| -> Vec<usize> {
            (0..NUMBERS)
                .filter(|number| !constant.contains(number))
                .collect()
        };
        assert_eq!(kept(&all), all_but(&[8]));
        let before: ImpactSteps = (0..100).map(step).collect();
        assert_eq!(kept(&before), all_but(&[8, 12]));
        let mut collected = CollectedSteps::default();
        assert!(collected.is_empty() && collected.last().is_none());
        for index in 0..200 {
            collected.push(&step(index));
            assert_eq!(collected.last(), Some(step(index)));
        }
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
        let of_steps = |count: u32| {
            let mut all = CollectedSteps::with_capacity(9, constants);
            (0..count).for_each(|index| all.push(&step(index)));
            all.finish()
        };
        assert_eq!(kept(&of_steps(6)), [COMMAND, VELOCITY, 7, STRIKER_VELOCITY]);
        let all = of_steps(9);
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
