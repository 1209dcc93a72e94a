//! Many impacts side by side, one step at a time. In: impacts that begin in a lane. Out: their results when they end. The arithmetic is
//! that of [`super::super::ImpactSolver`], in the same order, and of the summary of its steps.

use fearless_simd::Simd;

use super::rows::{Inputs, LANES, Row, States, Structure, Sums};
use super::step::{Also, Bits, Setting, step};
use super::{Impact, LaneSpecimen, Reach};
use crate::contact::ContactLaw;
use crate::impact::ImpactInput;
use crate::impact::summary::{ImpactSummary, still_rising};

/// The contacts of an impact, and its stop.
#[derive(Clone, Copy, Debug, Default)]
struct Events {
    /// Steps of all lanes before its first one, and at its last one.
    begun: u64,
    last: u64,
    /// The first step at whose end the striker does not move forward.
    stop: Option<f64>,
    contacts: u64,
    /// Speed at which the striker approaches before the first contact.
    closing: f64,
    /// The same when the first contact has ended.
    separating: Option<f64>,
}

/// The impacts of all lanes.
#[derive(Clone, Debug)]
pub struct Lanes {
    inputs: Inputs,
    /// A step reads one of them and writes the other, each at its own address. A number that is selected and written where it was read would
    /// become a masked store, which is slow on some processors.
    states: [States; 2],
    sums: Sums,
    /// Index of the state after the last step.
    now: usize,
    /// Steps so far.
    clock: u64,
    /// The last step of the lane that ends first.
    next_end: u64,
    also: Also,
    bits: Bits,
    /// What [`Self::follow`] has followed of them.
    touching: u64,
    stopped: u64,
    events: [Events; LANES],
}

impl Lanes {
    /// All at rest.
    pub fn new() -> Self {
        Self {
            inputs: Inputs::new(),
            states: [States::new(), States::new()],
            sums: Sums::new(),
            now: 0,
            clock: 0,
            next_end: 0,
            also: Also::default(),
            bits: Bits::default(),
            touching: 0,
            stopped: 0,
            events: [Events::default(); LANES],
        }
    }

    fn clear(&mut self, lane: usize) {
        self.inputs.clear(lane);
        self.sums.clear(lane);
        self.states[self.now].clear(lane);
        self.touching &= !(1 << lane);
        self.stopped &= !(1 << lane);
        self.events[lane] = Events {
            begun: self.clock,
            last: u64::MAX,
            ..Events::default()
        };
    }

    /// An impact at its start, which takes so many steps at most.
    pub fn begin(&mut self, lane: usize, impact: &Impact, steps: u64) {
        self.clear(lane);
        self.events[lane].last = self.clock.saturating_add(steps);
        let input = &impact.input;
        let specimen = impact.lane_specimen(None).expect("batched");
        let set = |row: &mut Row, value: f64| row[lane] = value;
        let structure = Structure {
            mass: input.mass,
            damping: input.damping,
            tangent: input.stiffness,
        };

        let inputs = &mut self.inputs;
        set(&mut inputs.mass, input.mass);
        set(&mut inputs.damping, input.damping);
        set(&mut inputs.time_step, input.time_step);
        set(
            &mut inputs.largest_tangent,
            input.max_tangent_ratio * input.stiffness,
        );
        match specimen {
            LaneSpecimen::Elastic(model) => set(&mut inputs.stiffness, model.stiffness),
            LaneSpecimen::Bilinear(model) => {
                let [stiffness, hardened, half_band] = model.lines();
                set(&mut inputs.stiffness, stiffness);
                set(&mut inputs.hardened, hardened);
                set(&mut inputs.half_band, half_band);
            }
        }
        set(&mut inputs.striker_mass, input.striker_mass);
        set(&mut inputs.weight, input.striker_mass * input.gravity);
        set(&mut inputs.fall, input.gravity * input.time_step);
        set(
            &mut inputs.striker_compliance,
            input.time_step / input.striker_mass,
        );
        let force_limit = match input.law {
            ContactLaw::Limit { force } => force,
            _ => f64::INFINITY,
        };
        set(&mut inputs.force_limit, force_limit);
        set(&mut inputs.striker_energy, input.striker_energy());

        set(&mut self.sums.input, input.striker_energy());
        let state = &mut self.states[self.now];
        set(&mut state.tangent, input.stiffness);
        let response = 1.0 / structure.effective_mass(input.time_step);
        set(&mut state.response, response);
        let compliance = input.time_step / input.striker_mass + 0.5 * input.time_step * response;
        let falling = input.striker_velocity + input.gravity * input.time_step;
        set(&mut state.needed, falling / compliance);
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        set(&mut state.step_of_max_displacement, self.clock as f64);
        set(&mut state.striker_displacement, 0.0 - input.gap);
        set(&mut state.striker_velocity, input.striker_velocity);
    }

    /// A lane without an impact: a mass at rest.
    pub fn rest(&mut self, lane: usize) {
        self.clear(lane);
        self.inputs.mass[lane] = 1.0;
        self.inputs.striker_compliance[lane] = 1.0;
        self.inputs.striker_mass[lane] = 1.0;
        let state = &mut self.states[self.now];
        state.response[lane] = 1.0;
        // Apart for ever, and moving: nothing ever happens.
        state.striker_displacement[lane] = -1.0;
        state.striker_velocity[lane] = f64::MIN_POSITIVE;
    }

    /// One step of every lane, from state `NOW` to the other one; the first step is from state 0. Whether [`Self::follow`] has something to
    /// follow.
    #[allow(clippy::inline_always, reason = "as `step`")]
    #[inline(always)]
    pub fn step<S: Simd, const YIELDS: bool, const LIMITED: bool, const NOW: usize>(
        &mut self,
        simd: S,
    ) -> bool {
        let [first, second] = &mut self.states;
        let (from, to) = if NOW == 0 {
            (&*first, second)
        } else {
            (&*second, first)
        };
        self.now = 1 - NOW;
        self.clock += 1;
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let setting = Setting {
            inputs: &self.inputs,
            also: self.also,
            clock: self.clock as f64,
        };
        self.bits = step::<S, YIELDS, LIMITED>(simd, setting, from, to, &mut self.sums);
        let stops = self.bits.stopped & !self.stopped;
        let ended = self.bits.over != 0 || self.clock >= self.next_end;
        self.bits.touching != self.touching || stops != 0 || ended
    }

    /// The contacts that begin or end with the last step, and the strikers that stop.
    pub fn follow(&mut self) {
        let changed = self.bits.touching ^ self.touching;
        let stops = self.bits.stopped & !self.stopped;
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let clock = self.clock as f64;
        for (lane, events) in self.events.iter_mut().enumerate() {
            let is_set = |bits: u64| bits >> lane & 1 == 1;
            let closing = |state: &States| state.striker_velocity[lane] - state.velocity[lane];
            if is_set(changed & self.bits.touching) {
                events.contacts += 1;
                if events.contacts == 1 {
                    events.closing = closing(&self.states[1 - self.now]);
                }
            } else if is_set(changed) && events.separating.is_none() {
                events.separating = Some(closing(&self.states[self.now]));
            }
            if is_set(stops) {
                events.stop = Some(clock);
            }
        }
        self.touching = self.bits.touching;
        self.stopped |= stops;
    }

    /// Whether the impact of a lane has ended.
    pub const fn is_over(&self, lane: usize) -> bool {
        self.clock >= self.events[lane].last || self.bits.over >> lane & 1 == 1
    }

    /// When the next impact ends at the latest, and what a step has to do; after impacts have begun.
    pub fn look_ahead(&mut self, ends_at_stop: bool) {
        let lasts = self.events.iter().map(|events| events.last);
        self.next_end = lasts.min().unwrap_or_default();
        let some = |row: &Row| row.iter().any(|number| *number != 0.0);
        self.also = Also {
            damped: some(&self.inputs.damping),
            falls: some(&self.inputs.fall),
            ends_at_stop,
        };
    }

    /// How far the impact of a lane reached.
    pub fn reach(&self, lane: usize) -> Reach {
        let (state, sums) = (&self.states[self.now], &self.sums);
        Reach {
            displacement: [sums.least_displacement[lane], sums.max_displacement[lane]],
            restoring_force: [sums.least_force[lane], sums.largest_force[lane]],
            increment: sums.largest_increment[lane],
            last_velocity: state.velocity[lane],
            last_contact_force: state.contact_force[lane],
        }
    }

    /// The energy that is missing at the end of the last step \[J\].
    fn energy_error(&self, lane: usize) -> f64 {
        let (state, sums, inputs) = (&self.states[self.now], &self.sums, &self.inputs);
        let (v1, vs1) = (state.velocity[lane], state.striker_velocity[lane]);
        let structure = 0.5 * (inputs.mass[lane] * v1 * v1);
        let striker = 0.5 * inputs.striker_mass[lane] * vs1 * vs1;
        let kept = striker
            + structure
            + sums.restoring_energy[lane]
            + sums.damping_energy[lane]
            + sums.contact_loss[lane];
        inputs.striker_energy[lane] + sums.weight[lane] - kept
    }

    /// The results of the impact of a lane.
    pub fn summary(&self, lane: usize, input: &ImpactInput) -> ImpactSummary {
        let (state, sums, events) = (&self.states[self.now], &self.sums, &self.events[lane]);
        let energy_error = if sums.input[lane] > 0.0 {
            self.energy_error(lane) / sums.input[lane]
        } else {
            0.0
        };
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = |step: f64| (step - events.begun as f64) * self.inputs.time_step[lane];
        let stop_time = events.stop.map(time);
        let rebound = events.separating.filter(|_| events.closing > 0.0);
        ImpactSummary {
            max_displacement: sums.max_displacement[lane],
            time_of_max_displacement: time(state.step_of_max_displacement[lane]),
            stop_time,
            final_displacement: state.displacement[lane],
            max_velocity: sums.max_velocity[lane],
            max_contact_force: sums.max_contact_force[lane],
            impulse: sums.impulse[lane],
            contacts: events.contacts,
            restitution: rebound.map(|separating| -separating / events.closing),
            indentation: state.indentation[lane],
            indentation_energy: sums.indentation_energy[lane],
            absorbed_energy: state.absorbed_energy[lane],
            striker_energy: input.striker_energy(),
            energy_error,
            still_rising: still_rising(
                state.velocity[lane],
                state.displacement[lane] >= sums.max_displacement[lane],
            ),
            last_contact_cut: stop_time.is_some() && state.contact_force[lane] > 0.0,
        }
    }
}
