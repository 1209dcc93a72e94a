//! Many impacts side by side, one step at a time. In: impacts that begin in a lane. Out: their results when they end. The step is in
//! [`super::step`].

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use fearless_simd::Simd;

use super::reach::RunningReach;
use super::rows::{LANES, LanePart, LaneRow};
use super::{Batched, Impact, LaneSpecimen};
use crate::contact::ImpulseContact;
use crate::impact::ImpactInput;
use crate::impact::energy::{Energies, kinetic_energy};
use crate::impact::step::{
    Also, BetweenSteps, Marks, StepInputs, StrikerInput, Structure, end_step,
};
use crate::impact::summary::{Events, ImpactSummary, LastEnd, Next, RunningResults, Wanted};
use crate::specimen::BilinearLines;
use crate::structure::matrix::one_degree::{Body, Secant};

/// The lanes, as bits, in which something is so at the end of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Bits {
    touching: u64,
    stopped: u64,
    over: u64,
}

/// An impact in its lane.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// Steps of all lanes before its first one, and at its last one.
    begun: u64,
    last: u64,
    events: Events,
}

/// The impacts of all lanes.
#[derive(Clone, Debug)]
pub struct Lanes {
    inputs: StepInputs<LaneRow>,
    specimen: BilinearLines<LaneRow>,
    /// A step reads one of them and writes the other, because a selected number that overwrites itself becomes a masked store. Masked
    /// stores are slow on some processors. Numbers that a step does not change are equal in both.
    states: [BetweenSteps<LaneRow>; 2],
    results: [RunningResults<LaneRow>; 2],
    reach: RunningReach<LaneRow>,
    wanted: Wanted,
    /// Index of the state after the last step.
    now: usize,
    /// Steps so far.
    clock: u64,
    /// The last step of the lane that ends first.
    next_end: u64,
    also: Also,
    ends_at_stop: bool,
    bits: Bits,
    /// What [`Self::follow`] has followed of them.
    touching: u64,
    stopped: u64,
    courses: [Course; LANES],
}

/// A lane at its start.
struct LaneStart {
    inputs: StepInputs,
    specimen: BilinearLines,
    state: BetweenSteps,
}

impl LaneStart {
    fn of(input: &ImpactInput, specimen: LaneSpecimen) -> Self {
        let inputs = input.step_inputs();
        let striker = [0.0 - input.gap, input.striker_velocity];
        let secant = Secant::of(input.stiffness);
        Self {
            state: BetweenSteps::at_rest([0.0; 3], striker, secant, inputs.striker.energy),
            specimen: match specimen {
                LaneSpecimen::Elastic(model) => BilinearLines {
                    stiffness: model.stiffness,
                    hardened: 0.0,
                    half_band: 0.0,
                },
                LaneSpecimen::Bilinear(model) => model.lines(),
            },
            inputs,
        }
    }

    /// A mass at rest, and a striker that is apart for ever and moves: nothing ever happens.
    fn resting() -> Self {
        let inputs = StepInputs {
            body: Body::new([1.0, 0.0], 0.0),
            structure: Structure {
                time_step: 0.0,
                largest_tangent: 0.0,
            },
            contact: ImpulseContact {
                force_limit: 0.0,
                fall: 0.0,
                striker_compliance: 1.0,
                striker_inertia: 1.0,
                half_striker: 0.5,
            },
            striker: StrikerInput {
                weight: 0.0,
                energy: 0.0,
            },
        };
        let specimen = BilinearLines {
            stiffness: 0.0,
            hardened: 0.0,
            half_band: 0.0,
        };
        let striker = [-1.0, f64::MIN_POSITIVE];
        Self {
            inputs,
            specimen,
            state: BetweenSteps::at_rest([0.0; 3], striker, Secant::of(0.0), 0.0),
        }
    }
}

/// The one that a step reads, and the one that it writes.
#[inline(always)]
fn turn<T, const NOW: usize>(both: &mut [T; 2]) -> (&T, &mut T) {
    let [first, second] = both;
    if NOW == 0 {
        (first, second)
    } else {
        (second, first)
    }
}

impl Lanes {
    /// All at rest.
    pub fn new(wanted: Wanted) -> Self {
        let LaneStart {
            inputs,
            specimen,
            state,
        } = LaneStart::resting();
        Self {
            inputs: inputs.map(|_| LaneRow::ZERO),
            specimen: specimen.map(|_| LaneRow::ZERO),
            states: [state.map(|_| LaneRow::ZERO), state.map(|_| LaneRow::ZERO)],
            results: [RunningResults::START.map(|_| LaneRow::ZERO); 2],
            reach: RunningReach::START.map(|_| LaneRow::ZERO),
            wanted,
            now: 0,
            clock: 0,
            next_end: 0,
            also: Also::default(),
            ends_at_stop: false,
            bits: Bits::default(),
            touching: 0,
            stopped: 0,
            courses: [Course::default(); LANES],
        }
    }

    fn set(&mut self, lane: usize, start: &LaneStart, last: u64) {
        let LaneStart {
            inputs,
            specimen,
            state,
        } = *start;
        let mut results = RunningResults::START;
        results.push(inputs.structure.time_step, &state.step_end(self.instant()));
        let set = |row: &mut LaneRow, number: f64| row.set_lane(lane, number);
        self.inputs.each(inputs, set);
        self.specimen.each(specimen, set);
        for states in &mut self.states {
            states.each(state, set);
        }
        for rows in &mut self.results {
            rows.each(results, set);
        }
        self.reach.each(RunningReach::START, set);
        self.touching &= !(1 << lane);
        self.stopped &= !(1 << lane);
        self.courses[lane] = Course {
            begun: self.clock,
            last,
            events: Events::default(),
        };
    }

    /// The number of the last step, counted for all lanes together.
    #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
    const fn instant(&self) -> f64 {
        self.clock as f64
    }

    /// An impact at its start, which takes so many steps at most.
    pub fn begin(&mut self, lane: usize, impact: &Impact, steps: u64) {
        let specimen = impact.lane_specimen(None).expect("batched");
        let start = LaneStart::of(&impact.input, specimen);
        self.set(lane, &start, self.clock.saturating_add(steps));
    }

    /// A lane without an impact.
    pub fn rest(&mut self, lane: usize) {
        self.set(lane, &LaneStart::resting(), u64::MAX);
    }

    /// One step of every lane, from state `NOW` to the other one; the first step is from state 0. Whether [`Self::follow`] has something to
    /// follow.
    #[inline(always)]
    pub fn step<S: Simd, const YIELDS: bool, const LIMITED: bool, const NOW: usize>(
        &mut self,
        simd: S,
    ) -> bool {
        self.now = 1 - NOW;
        self.clock += 1;
        let instant = self.instant();
        let (from, to) = turn::<_, NOW>(&mut self.states);
        let (known, found) = turn::<_, NOW>(&mut self.results);
        let (inputs, specimen, also) = (&self.inputs, &self.specimen, self.also);
        let mut bits = Bits::default();
        for part in LanePart::all(simd) {
            let get = |row: &LaneRow| part.get(row);
            let set = |row: &mut LaneRow, numbers| part.set(row, numbers);
            let before = from.map(get);
            let read = |start: [_; 2], [displacement, _]: [_; 2]| {
                let force = if YIELDS {
                    specimen.map(get).force(start, displacement)
                } else {
                    get(&specimen.stiffness) * displacement
                };
                [force, displacement - start[0]]
            };
            let (
                state,
                Marks {
                    state: contact,
                    stopped,
                    over,
                },
            ) = end_step::<_, LIMITED>(&inputs.map(get), &before, also, read);
            to.motion.each(state.motion, set);
            to.secant.each(state.secant, set);
            to.work.each(state.work, set);
            if LIMITED {
                to.indented.each(state.indented, set);
            }
            if also.damped {
                to.damped.each(state.damped, set);
            }
            if also.falls {
                to.fallen.each(state.fallen, set);
            }
            let end = state.step_end(part.number(instant));
            let next = Next {
                wanted: self.wanted,
                time_step: get(&inputs.structure.time_step),
                end: &end,
            };
            found.add(known, &next, get, set);
            if self.wanted.reach {
                let mut reach = self.reach.map(get);
                reach.add(before.motion.displacement, &end);
                self.reach.each(reach, set);
            }
            bits.touching |= part.bits(contact.at_limit | contact.in_contact);
            bits.stopped |= part.bits(stopped);
            if self.ends_at_stop {
                bits.over |= part.bits(over);
            }
        }
        self.bits = bits;
        let stops = bits.stopped & !self.stopped;
        let ended = bits.over != 0 || self.clock >= self.next_end;
        bits.touching != self.touching || stops != 0 || ended
    }

    /// The contacts that begin or end with the last step, and the strikers that stop.
    pub fn follow(&mut self) {
        let changed = self.bits.touching ^ self.touching;
        let stops = self.bits.stopped & !self.stopped;
        let instant = self.instant();
        for (lane, Course { events, .. }) in self.courses.iter_mut().enumerate() {
            let is_set = |bits: u64| bits >> lane & 1 == 1;
            let closing = |state: &BetweenSteps<LaneRow>| {
                state.motion.striker_velocity.lane(lane) - state.motion.velocity.lane(lane)
            };
            if is_set(changed & self.bits.touching) {
                events.contacts += 1;
                events.contact_begins(closing(&self.states[1 - self.now]));
            } else if is_set(changed) {
                events.contact_ends(closing(&self.states[self.now]));
            }
            if is_set(stops) {
                events.stop = Some(instant);
            }
        }
        self.touching = self.bits.touching;
        self.stopped |= stops;
    }

    /// Whether the impact of a lane has ended.
    pub const fn is_over(&self, lane: usize) -> bool {
        self.clock >= self.courses[lane].last || self.bits.over >> lane & 1 == 1
    }

    /// When the next impact ends at the latest, and what a step has to do; after impacts have begun.
    pub fn look_ahead(&mut self, ends_at_stop: bool) {
        let lasts = self.courses.iter().map(|course| course.last);
        self.next_end = lasts.min().unwrap_or_default();
        let some = |row: &LaneRow| row.any(|number| number != 0.0);
        self.also = Also {
            damped: some(&self.inputs.body.damping),
            falls: some(&self.inputs.contact.fall),
        };
        self.ends_at_stop = ends_at_stop;
    }

    /// The results of the impact of a lane.
    pub fn results(&self, lane: usize, input: &ImpactInput) -> Batched {
        let Course {
            begun, mut events, ..
        } = self.courses[lane];
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = |step: f64| (step - begun as f64) * input.time_step;
        let number = |row: &LaneRow| row.lane(lane);
        let BetweenSteps {
            motion,
            work,
            indented,
            damped,
            fallen,
            ..
        } = self.states[self.now].map(number);
        let before = self.results[1 - self.now].map(number);
        let mut results = self.results[self.now].map(number);
        let reach = self.reach.map(number);
        results.instant = time(results.instant);
        events.stop = events.stop.map(time);
        let energies = Energies {
            striker: kinetic_energy(input.striker_mass, motion.striker_velocity),
            structure: 0.5 * (input.mass * motion.velocity * motion.velocity),
            restoring: work.restoring,
            damping: damped.work,
            contact_loss: work.contact_loss,
            indentation: indented.work,
            weight: fallen.work,
            gravity: 0.0,
            error: 0.0,
        };
        let last = LastEnd {
            displacement: motion.displacement,
            velocity: motion.velocity,
            contact_force: motion.contact_force,
            indentation: indented.depth,
            indentation_energy: indented.work,
            energy_error: energies.missing(input.striker_energy(), 0.0),
            input: fallen.input,
        };
        let summary = ImpactSummary::new(input, &results, &events, &last);
        let steps = self.clock - begun;
        Batched::new(summary, steps, [&before, &results], &reach, &last)
    }
}
