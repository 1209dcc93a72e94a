//! Sixteen impacts, one step at a time. In: impacts that begin in a lane. Out: their results when they end. The arithmetic is that of
//! [`super::super::ImpactSolver`], in the same order, and of the summary of its steps.

#![allow(
    clippy::needless_range_loop,
    clippy::needless_bitwise_bool,
    reason = "loops without branches over many rows become vector instructions"
)]

use super::{Impact, LaneSpecimen, Reach};
use crate::contact::ContactLaw;
use crate::impact::ImpactInput;
use crate::impact::summary::{ImpactSummary, still_rising};

/// Impacts side by side: with fewer, vector units wait for the divisions before them.
pub const LANES: usize = 16;

type Row = [f64; LANES];

/// 1 for true: a number is selected without a branch.
const YES: f64 = 1.0;
const NO: f64 = 0.0;

/// Declares rows of all lanes.
macro_rules! rows {
    ($(#[$about:meta])* $rows:ident { $($(#[$doc:meta])* $name:ident),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Debug)]
        struct $rows {
            $($(#[$doc])* $name: Row,)*
        }

        impl $rows {
            const fn new() -> Self {
                Self { $($name: [0.0; LANES],)* }
            }

            fn clear(&mut self, lane: usize) {
                $(self.$name[lane] = 0.0;)*
            }
        }
    };
}

rows! {
    /// What does not change.
    Inputs {
        /// M, C
        mass, damping,
        /// Δt
        time_step,
        /// The largest `K_t`.
        largest_tangent,
        /// K0, and the lines of a bilinear specimen.
        stiffness, hardened, half_band,
        /// Ms, g, Δt/Ms, the limit force.
        striker_mass, gravity, striker_compliance, force_limit,
        /// ½MsV0²
        striker_energy,
    }
}

rows! {
    /// The end of a step, and the results so far.
    States {
        step,
        /// `K_t` and M̂ of the next step.
        tangent, effective,
        displacement, velocity, acceleration, force,
        striker_displacement, striker_velocity, contact_force, touching, indentation,
        restoring_energy, damping_energy, contact_loss, indentation_energy, weight, input,
        max_displacement, time_of_max_displacement, absorbed_energy, max_velocity, max_contact_force, impulse,
        /// Infinite before the striker stops.
        stop_time,
        /// The reach, beside the largest displacement.
        least_displacement, least_force, largest_force, largest_increment,
    }
}

rows! {
    /// The number of contacts, and of the first one: begun, ended, closing speed before it, closing speed after it.
    Contacts { contacts, begun, ended, closing, separating }
}

/// The impacts of all lanes.
#[derive(Clone, Debug)]
pub struct Lanes {
    inputs: Inputs,
    /// A step reads one of them and writes the other, each at its own address. A number that is selected and written where it was read would
    /// become a masked store, which is slow on some processors.
    states: [States; 2],
    contacts: Contacts,
    /// Index of the state after the last step.
    now: usize,
}

/// A part of its callers, which are compiled for several vector units: a function of its own would have those of the portable build.
#[allow(clippy::inline_always, reason = "see above")]
#[inline(always)]
fn select(condition: bool, yes: f64, no: f64) -> f64 {
    std::hint::select_unpredictable(condition, yes, no)
}

impl Lanes {
    /// All at rest.
    pub const fn new() -> Self {
        Self {
            inputs: Inputs::new(),
            states: [States::new(), States::new()],
            contacts: Contacts::new(),
            now: 0,
        }
    }

    fn clear(&mut self, lane: usize) {
        self.inputs.clear(lane);
        self.contacts.clear(lane);
        self.states[self.now].clear(lane);
    }

    /// An impact at its start.
    pub fn begin(&mut self, lane: usize, impact: &Impact) {
        self.clear(lane);
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
        set(&mut inputs.gravity, input.gravity);
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

        let state = &mut self.states[self.now];
        set(&mut state.tangent, input.stiffness);
        set(
            &mut state.effective,
            structure.effective_mass(input.time_step),
        );
        set(&mut state.input, input.striker_energy());
        set(&mut state.striker_displacement, 0.0 - input.gap);
        set(&mut state.striker_velocity, input.striker_velocity);
        set(&mut state.stop_time, f64::INFINITY);
        set(&mut self.contacts.closing, input.striker_velocity);
    }

    /// A lane without an impact: a mass that stands still.
    pub fn rest(&mut self, lane: usize) {
        self.clear(lane);
        self.inputs.mass[lane] = 1.0;
        self.inputs.striker_compliance[lane] = 1.0;
        self.inputs.striker_mass[lane] = 1.0;
        let state = &mut self.states[self.now];
        state.effective[lane] = 1.0;
        // Apart for ever, and moving: it never ends.
        state.striker_displacement[lane] = -1.0;
        state.striker_velocity[lane] = f64::MIN_POSITIVE;
        self.contacts.begun[lane] = YES;
    }

    /// One step of every lane, from state `NOW` to the other one; the first step is from state 0. Whether some lane has ended with it.
    #[allow(clippy::inline_always, reason = "as `select`")]
    #[inline(always)]
    pub fn step<const YIELDS: bool, const LIMITED: bool, const NOW: usize>(
        &mut self,
        end: End,
    ) -> bool {
        let [first, second] = &mut self.states;
        let (from, to) = if NOW == 0 {
            (&*first, second)
        } else {
            (&*second, first)
        };
        self.now = 1 - NOW;
        step::<YIELDS, LIMITED>(&self.inputs, from, to, &mut self.contacts, end)
    }

    /// Whether the impact of a lane has ended.
    pub fn is_over(&self, lane: usize, end: End) -> bool {
        let state = &self.states[self.now];
        let stopped = state.striker_velocity[lane] <= 0.0 && state.velocity[lane] <= 0.0;
        state.step[lane] >= end.last || end.ends_at_stop && stopped
    }

    /// How far the impact of a lane reached.
    pub fn reach(&self, lane: usize) -> Reach {
        let state = &self.states[self.now];
        Reach {
            displacement: [state.least_displacement[lane], state.max_displacement[lane]],
            restoring_force: [state.least_force[lane], state.largest_force[lane]],
            increment: state.largest_increment[lane],
            last_velocity: state.velocity[lane],
            last_contact_force: state.contact_force[lane],
        }
    }

    /// The energy that is missing at the end of the last step \[J\].
    fn energy_error(&self, lane: usize) -> f64 {
        let (state, inputs) = (&self.states[self.now], &self.inputs);
        let (v1, vs1) = (state.velocity[lane], state.striker_velocity[lane]);
        let structure = 0.5 * (inputs.mass[lane] * v1 * v1);
        let striker = 0.5 * inputs.striker_mass[lane] * vs1 * vs1;
        let kept = striker
            + structure
            + state.restoring_energy[lane]
            + state.damping_energy[lane]
            + state.contact_loss[lane];
        inputs.striker_energy[lane] + state.weight[lane] - kept
    }

    /// The results of the impact of a lane.
    pub fn summary(&self, lane: usize, input: &ImpactInput) -> ImpactSummary {
        let state = &self.states[self.now];
        let energy_error = if state.input[lane] > 0.0 {
            self.energy_error(lane) / state.input[lane]
        } else {
            0.0
        };
        let stop_time = Some(state.stop_time[lane]).filter(|time| time.is_finite());
        let closing = self.contacts.closing[lane];
        let rebounded = self.contacts.ended[lane] == YES && closing > 0.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count below 2^53"
        )]
        let contacts = self.contacts.contacts[lane] as u64;
        ImpactSummary {
            max_displacement: state.max_displacement[lane],
            time_of_max_displacement: state.time_of_max_displacement[lane],
            stop_time,
            final_displacement: state.displacement[lane],
            max_velocity: state.max_velocity[lane],
            max_contact_force: state.max_contact_force[lane],
            impulse: state.impulse[lane],
            contacts,
            restitution: rebounded.then(|| -self.contacts.separating[lane] / closing),
            indentation: state.indentation[lane],
            indentation_energy: state.indentation_energy[lane],
            absorbed_energy: state.absorbed_energy[lane],
            striker_energy: input.striker_energy(),
            energy_error,
            still_rising: still_rising(
                state.velocity[lane],
                state.displacement[lane] >= state.max_displacement[lane],
            ),
            last_contact_cut: stop_time.is_some() && state.contact_force[lane] > 0.0,
        }
    }
}

/// When an impact ends.
#[derive(Clone, Copy)]
pub struct End {
    /// As soon as structure and striker move back.
    pub ends_at_stop: bool,
    /// Its last step.
    pub last: f64,
}

/// One step from one state to another. It is several short loops: the divisions of a lane take long, and those of several lanes overlap only
/// if little is between them.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn step<const YIELDS: bool, const LIMITED: bool>(
    inputs: &Inputs,
    from: &States,
    to: &mut States,
    contacts: &mut Contacts,
    end: End,
) -> bool {
    let mut response = [0.0; LANES];
    without_contact(inputs, from, to, &mut response);
    with_contact::<YIELDS, LIMITED>(inputs, from, to, &response);
    follow_tangent(inputs, from, to);
    add_energies(inputs, from, to);
    if contact_changes(from, to, contacts) {
        follow_first_contact(from, to, contacts);
    }
    take_results(inputs, from, to, end)
}

/// Eqs. (4) and (5), without contact; 1/M̂.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn without_contact(inputs: &Inputs, from: &States, to: &mut States, response: &mut Row) {
    for lane in 0..LANES {
        let time_step = inputs.time_step[lane];
        let half = 0.5 * time_step;
        let [v0, a0] = [from.velocity[lane], from.acceleration[lane]];
        // Without damping, a zero is subtracted.
        let push = (0.0 - from.force[lane]) - inputs.damping[lane] * (v0 + half * a0);
        let drift = time_step * (v0 + 0.5 * half * a0);
        let push = push - from.tangent[lane] * drift;
        to.acceleration[lane] = push / from.effective[lane];
        response[lane] = 1.0 / from.effective[lane];
    }
}

/// The contact; eqs. (2c) and (2d), and the force there; the striker.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn with_contact<const YIELDS: bool, const LIMITED: bool>(
    inputs: &Inputs,
    from: &States,
    to: &mut States,
    response: &Row,
) {
    for lane in 0..LANES {
        let time_step = inputs.time_step[lane];
        let half = 0.5 * time_step;
        let [x0, v0, a0] = [
            from.displacement[lane],
            from.velocity[lane],
            from.acceleration[lane],
        ];
        let free_acceleration = to.acceleration[lane];
        let free = v0 + half * (a0 + free_acceleration);
        let response = response[lane];
        let (xs0, vs0) = (from.striker_displacement[lane], from.striker_velocity[lane]);
        let indentation = from.indentation[lane];
        let falling = vs0 + inputs.gravity[lane] * time_step;
        let needed = (falling - free) / (inputs.striker_compliance[lane] + half * response);
        let apart = xs0 - x0 < indentation;
        let limit = inputs.force_limit[lane];
        let at_limit = LIMITED & !apart & (needed > limit);
        let in_contact = !apart & !at_limit & (needed >= 0.0);
        let contact_force = select(at_limit, limit, select(in_contact, needed, 0.0));

        let a1 = free_acceleration + contact_force * response;
        let v1 = v0 + half * (a0 + a1);
        let x1 = x0 + half * (v0 + v1);
        let stiffness = inputs.stiffness[lane];
        to.force[lane] = if YIELDS {
            let trial = from.force[lane] + stiffness * (x1 - x0);
            let middle = inputs.hardened[lane] * x1;
            let half_band = inputs.half_band[lane];
            let [low, high] = [middle - half_band, middle + half_band];
            let above = select(trial < low, low, trial);
            select(above > high, high, above)
        } else {
            stiffness * x1
        };

        let limited_velocity = if LIMITED {
            falling - contact_force * time_step / inputs.striker_mass[lane]
        } else {
            falling
        };
        let vs1 = select(at_limit, limited_velocity, select(in_contact, v1, falling));
        let xs1 = xs0 + 0.5 * time_step * (vs0 + vs1);
        if LIMITED {
            let dent = xs1 - x1;
            let deeper = select(dent > indentation, dent, indentation);
            let indented = select(at_limit, deeper, indentation);
            let work = select(at_limit, contact_force * (indented - indentation), 0.0);
            to.indentation_energy[lane] = from.indentation_energy[lane] + work;
            to.indentation[lane] = indented;
        }
        to.acceleration[lane] = a1;
        to.velocity[lane] = v1;
        to.displacement[lane] = x1;
        to.striker_velocity[lane] = vs1;
        to.striker_displacement[lane] = xs1;
        to.contact_force[lane] = contact_force;
        to.touching[lane] = select(at_limit | in_contact, YES, NO);
    }
}

/// Eq. (6), and the next step's M̂.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn follow_tangent(inputs: &Inputs, from: &States, to: &mut States) {
    for lane in 0..LANES {
        let change = to.displacement[lane] - from.displacement[lane];
        let secant = (to.force[lane] - from.force[lane]) / change;
        let largest = inputs.largest_tangent[lane];
        let secant = select(secant < 0.0, 0.0, secant);
        let secant = select(secant > largest, largest, secant);
        let tangent = select(change.abs() > 0.0, secant, from.tangent[lane]);
        let structure = Structure {
            mass: inputs.mass[lane],
            damping: inputs.damping[lane],
            tangent,
        };
        to.tangent[lane] = tangent;
        to.effective[lane] = structure.effective_mass(inputs.time_step[lane]);
    }
}

/// The work of all forces.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn add_energies(inputs: &Inputs, from: &States, to: &mut States) {
    for lane in 0..LANES {
        let time_step = inputs.time_step[lane];
        let half = 0.5 * time_step;
        let [v0, v1] = [from.velocity[lane], to.velocity[lane]];
        let [vs0, vs1] = [from.striker_velocity[lane], to.striker_velocity[lane]];
        let contact_force = to.contact_force[lane];
        let loss = contact_force * (half * (vs0 + vs1))
            - 0.5 * (from.contact_force[lane] + contact_force) * (half * (v0 + v1));
        to.contact_loss[lane] = from.contact_loss[lane] + loss;
        let change = to.displacement[lane] - from.displacement[lane];
        let restoring = 0.5 * ((from.force[lane] + to.force[lane]) * change);
        to.restoring_energy[lane] = from.restoring_energy[lane] + restoring;
        to.impulse[lane] = from.impulse[lane] + contact_force * time_step;
        let mean_velocity = 0.5 * (v0 + v1);
        let damped = time_step * (mean_velocity * (inputs.damping[lane] * mean_velocity));
        to.damping_energy[lane] = from.damping_energy[lane] + damped;
        let fallen = to.striker_displacement[lane] - from.striker_displacement[lane];
        let weight = from.weight[lane] + inputs.striker_mass[lane] * inputs.gravity[lane] * fallen;
        to.weight[lane] = weight;
        let input = inputs.striker_energy[lane] + weight;
        to.input[lane] = select(input > from.input[lane], input, from.input[lane]);
    }
}

/// Whether a contact begins or ends in some lane, or a first one is still to come.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn contact_changes(from: &States, to: &States, contacts: &Contacts) -> bool {
    let mut changes = 0_u64;
    for lane in 0..LANES {
        let differs = to.touching[lane] != from.touching[lane];
        changes |= u64::from(differs | (contacts.begun[lane] == NO));
    }
    changes != 0
}

/// The number of contacts, and the velocities before and after the first one.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn follow_first_contact(from: &States, to: &States, contacts: &mut Contacts) {
    for lane in 0..LANES {
        let touching = to.touching[lane] == YES;
        let (begun, over) = (contacts.begun[lane], contacts.ended[lane]);
        let closing_now = to.striker_velocity[lane] - to.velocity[lane];
        let still_to_come = (begun == NO) & !touching;
        let ends_now = (begun == YES) & (over == NO) & !touching;
        contacts.closing[lane] = select(still_to_come, closing_now, contacts.closing[lane]);
        contacts.separating[lane] = select(ends_now, closing_now, contacts.separating[lane]);
        contacts.ended[lane] = select(ends_now, YES, over);
        contacts.begun[lane] = select(touching, YES, begun);
        let begins = touching & (from.touching[lane] == NO);
        contacts.contacts[lane] += select(begins, 1.0, 0.0);
    }
}

/// The results so far. Whether some lane has ended.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
fn take_results(inputs: &Inputs, from: &States, to: &mut States, end: End) -> bool {
    let smaller = |one: f64, other: f64| select(one < other, one, other);
    let larger = |one: f64, other: f64| select(one > other, one, other);
    let mut ended = 0_u64;
    for lane in 0..LANES {
        let step = from.step[lane] + 1.0;
        let time = step * inputs.time_step[lane];
        to.step[lane] = step;
        let x1 = to.displacement[lane];
        let most = from.max_displacement[lane];
        let farther = x1 > most;
        to.max_displacement[lane] = larger(x1, most);
        to.time_of_max_displacement[lane] =
            select(farther, time, from.time_of_max_displacement[lane]);
        to.absorbed_energy[lane] = select(
            farther,
            to.restoring_energy[lane],
            from.absorbed_energy[lane],
        );
        let (v1, vs1) = (to.velocity[lane], to.striker_velocity[lane]);
        to.max_velocity[lane] = larger(v1.abs(), from.max_velocity[lane]);
        to.max_contact_force[lane] = larger(to.contact_force[lane], from.max_contact_force[lane]);
        to.least_displacement[lane] = smaller(x1, from.least_displacement[lane]);
        to.least_force[lane] = smaller(to.force[lane], from.least_force[lane]);
        to.largest_force[lane] = larger(to.force[lane], from.largest_force[lane]);
        let increment = (x1 - from.displacement[lane]).abs();
        to.largest_increment[lane] = larger(increment, from.largest_increment[lane]);
        let stop = select(vs1 <= 0.0, time, f64::INFINITY);
        to.stop_time[lane] = smaller(stop, from.stop_time[lane]);
        let over = (step >= end.last) | (end.ends_at_stop & (vs1 <= 0.0) & (v1 <= 0.0));
        ended |= u64::from(over);
    }
    ended != 0
}

/// What the effective mass of a step consists of.
struct Structure {
    mass: f64,
    damping: f64,
    tangent: f64,
}

impl Structure {
    /// M̂ = M + ½Δt(C + ½ΔtK_t).
    #[inline]
    fn effective_mass(&self, time_step: f64) -> f64 {
        (self.tangent * (0.5 * time_step) + self.damping) * (0.5 * time_step) + self.mass
    }
}
