//! One step of all lanes. In: the state before it. Out: the state after it. It knows nothing of impacts that begin and end.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use fearless_simd::prelude::*;

use super::rows::{Inputs, LANES, Row, States, Sums};

// `a.max(b)` is `if a > b { a } else { b }` and `a.min(b)` is `if a < b { a } else { b }` here: a lane that is not a number runs again alone.

/// The lanes, as bits, in which something is so at the end of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bits {
    /// The striker touches the structure.
    pub touching: u64,
    /// The striker does not move forward.
    pub stopped: u64,
    /// Nor does the structure, if that is an end.
    pub over: u64,
}

/// What the impact of some lane has.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Also {
    /// A damper.
    pub damped: bool,
    /// A falling striker.
    pub falls: bool,
    /// An end as soon as structure and striker move back.
    pub ends_at_stop: bool,
}

/// What a step is made with.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub inputs: &'a Inputs,
    pub also: Also,
    /// The number of the step, counted for all lanes together.
    pub clock: f64,
}

/// One step from one state to another. It is several short loops: a division takes long, and those of several lanes
/// overlap only if little is between them. So a step ends with the divisions of the next one.
#[inline(always)]
pub(super) fn step<S: Simd, const YIELDS: bool, const LIMITED: bool>(
    simd: S,
    setting: Setting<'_>,
    from: &States,
    to: &mut States,
    sums: &mut Sums,
) -> Bits {
    let mut bits = Bits::default();
    let inputs = setting.inputs;
    for part in Part::all(simd) {
        let Bits {
            touching,
            stopped,
            over,
        } = end_step::<S, YIELDS, LIMITED>(part, setting, from, to, sums);
        bits.touching |= touching;
        bits.stopped |= stopped;
        bits.over |= over;
    }
    for part in Part::all(simd) {
        follow_tangent(part, inputs, from, to);
    }
    for part in Part::all(simd) {
        without_contact(part, inputs, to);
    }
    for part in Part::all(simd) {
        force_of_contact(part, inputs, to);
    }
    bits
}

/// Some lanes, as many as a vector of the processor has.
#[derive(Clone, Copy)]
struct Part<S> {
    simd: S,
    first: usize,
}

impl<S: Simd> Part<S> {
    #[inline(always)]
    fn all(simd: S) -> impl Iterator<Item = Self> {
        (0..LANES)
            .step_by(S::f64s::LEN)
            .map(move |first| Self { simd, first })
    }

    #[inline(always)]
    fn get(self, row: &Row) -> S::f64s {
        S::f64s::from_slice(self.simd, &row[self.first..self.first + S::f64s::LEN])
    }

    #[inline(always)]
    fn set(self, row: &mut Row, numbers: S::f64s) {
        numbers.store_slice(&mut row[self.first..self.first + S::f64s::LEN]);
    }

    #[inline(always)]
    fn number(self, number: f64) -> S::f64s {
        S::f64s::splat(self.simd, number)
    }

    /// Lanes of this part as lanes of all.
    #[inline(always)]
    fn bits(self, lanes: S::mask64s) -> u64 {
        lanes.to_bitmask() << self.first
    }
}

/// The contact; eqs. (2c) and (2d), and the force there; the striker; the work of all forces, and the results so far.
#[inline(always)]
fn end_step<S: Simd, const YIELDS: bool, const LIMITED: bool>(
    part: Part<S>,
    setting: Setting<'_>,
    from: &States,
    to: &mut States,
    sums: &mut Sums,
) -> Bits {
    let Setting {
        inputs,
        also,
        clock,
    } = setting;
    let at = |row: &Row| part.get(row);
    let zero = part.number(0.0);
    let time_step = at(&inputs.time_step);
    let half = time_step * 0.5;
    let [x0, v0, a0] = [
        at(&from.displacement),
        at(&from.velocity),
        at(&from.acceleration),
    ];
    let (xs0, vs0) = (at(&from.striker_displacement), at(&from.striker_velocity));
    let indentation = if LIMITED { at(&from.indentation) } else { zero };
    let falling = vs0 + at(&inputs.fall);
    let needed = at(&from.needed);
    let near = (xs0 - x0).simd_ge(indentation);
    let (at_limit, in_contact, contact_force);
    if LIMITED {
        let limit = at(&inputs.force_limit);
        at_limit = near & needed.simd_gt(limit);
        in_contact = near & needed.simd_ge(zero) & !at_limit;
        contact_force = at_limit.select(limit, in_contact.select(needed, zero));
    } else {
        at_limit = S::mask64s::splat(part.simd, false);
        in_contact = near & needed.simd_ge(zero);
        contact_force = in_contact.select(needed, zero);
    }

    let a1 = at(&from.free_acceleration) + contact_force * at(&from.response);
    let v1 = v0 + half * (a0 + a1);
    let moved = half * (v0 + v1);
    let x1 = x0 + moved;
    let stiffness = at(&inputs.stiffness);
    let r0 = at(&from.force);
    let r1 = if YIELDS {
        let trial = r0 + stiffness * (x1 - x0);
        let middle = at(&inputs.hardened) * x1;
        let half_band = at(&inputs.half_band);
        let [low, high] = [middle - half_band, middle + half_band];
        high.min(low.max(trial))
    } else {
        stiffness * x1
    };

    let vs1 = if LIMITED {
        let limited = falling - contact_force * time_step / at(&inputs.striker_mass);
        at_limit.select(limited, in_contact.select(v1, falling))
    } else {
        in_contact.select(v1, falling)
    };
    let striker_moved = half * (vs0 + vs1);
    let xs1 = xs0 + striker_moved;
    if LIMITED {
        let deeper = (xs1 - x1).max(indentation);
        let indented = at_limit.select(deeper, indentation);
        let work = at_limit.select(contact_force * (indented - indentation), zero);
        let energy = at(&sums.indentation_energy) + work;
        part.set(&mut sums.indentation_energy, energy);
        part.set(&mut to.indentation, indented);
    }
    let loss =
        contact_force * striker_moved - (at(&from.contact_force) + contact_force) * 0.5 * moved;
    let loss = at(&sums.contact_loss) + loss;
    part.set(&mut sums.contact_loss, loss);
    let impulse = at(&sums.impulse) + contact_force * time_step;
    part.set(&mut sums.impulse, impulse);
    part.set(&mut to.force, r1);
    part.set(&mut to.acceleration, a1);
    part.set(&mut to.velocity, v1);
    part.set(&mut to.displacement, x1);
    part.set(&mut to.striker_velocity, vs1);
    part.set(&mut to.striker_displacement, xs1);
    part.set(&mut to.contact_force, contact_force);

    let change = x1 - x0;
    let restoring = (r0 + r1) * change * 0.5;
    let restoring = at(&sums.restoring_energy) + restoring;
    part.set(&mut sums.restoring_energy, restoring);
    if also.damped {
        let mean_velocity = (v0 + v1) * 0.5;
        let damped = time_step * (mean_velocity * (at(&inputs.damping) * mean_velocity));
        let damped = at(&sums.damping_energy) + damped;
        part.set(&mut sums.damping_energy, damped);
    }
    if also.falls {
        let weight = at(&sums.weight) + at(&inputs.weight) * (xs1 - xs0);
        let input = (at(&inputs.striker_energy) + weight).max(at(&sums.input));
        part.set(&mut sums.weight, weight);
        part.set(&mut sums.input, input);
    }

    let most = at(&sums.max_displacement);
    let farther = x1.simd_gt(most);
    let step = farther.select(part.number(clock), at(&from.step_of_max_displacement));
    let absorbed = farther.select(restoring, at(&from.absorbed_energy));
    part.set(&mut to.step_of_max_displacement, step);
    part.set(&mut to.absorbed_energy, absorbed);
    part.set(&mut sums.max_displacement, x1.max(most));
    let fastest = v1.abs().max(at(&sums.max_velocity));
    part.set(&mut sums.max_velocity, fastest);
    let strongest = contact_force.max(at(&sums.max_contact_force));
    part.set(&mut sums.max_contact_force, strongest);
    let least = x1.min(at(&sums.least_displacement));
    part.set(&mut sums.least_displacement, least);
    let least = r1.min(at(&sums.least_force));
    part.set(&mut sums.least_force, least);
    let largest = r1.max(at(&sums.largest_force));
    part.set(&mut sums.largest_force, largest);
    let increment = change.abs().max(at(&sums.largest_increment));
    part.set(&mut sums.largest_increment, increment);
    let stopped = vs1.simd_le(zero);
    let over = stopped & v1.simd_le(zero);
    Bits {
        touching: part.bits(at_limit | in_contact),
        stopped: part.bits(stopped),
        over: if also.ends_at_stop {
            part.bits(over)
        } else {
            0
        },
    }
}

/// Eq. (6).
#[inline(always)]
fn follow_tangent<S: Simd>(part: Part<S>, inputs: &Inputs, from: &States, to: &mut States) {
    let at = |row: &Row| part.get(row);
    let zero = part.number(0.0);
    let change = at(&to.displacement) - at(&from.displacement);
    let force = at(&to.force);
    let secant = (force - at(&from.force)) / change;
    let secant = at(&inputs.largest_tangent).min(zero.max(secant));
    let tangent = change.simd_eq(zero).select(at(&from.tangent), secant);
    part.set(&mut to.tangent, tangent);
}

/// Eqs. (4) and (5) of the next step, without contact; 1/M̂.
#[inline(always)]
fn without_contact<S: Simd>(part: Part<S>, inputs: &Inputs, to: &mut States) {
    let at = |row: &Row| part.get(row);
    let zero = part.number(0.0);
    let time_step = at(&inputs.time_step);
    let (half, damping) = (time_step * 0.5, at(&inputs.damping));
    let (tangent, force) = (at(&to.tangent), at(&to.force));
    let effective = (tangent * half + damping) * half + at(&inputs.mass);
    let [v0, a0] = [at(&to.velocity), at(&to.acceleration)];
    // Without damping, a zero is subtracted.
    let push = (zero - force) - damping * (v0 + half * a0);
    let drift = time_step * (v0 + half * 0.5 * a0);
    let push = push - tangent * drift;
    let acceleration = push / effective;
    let response = part.number(1.0) / effective;
    part.set(&mut to.free_acceleration, acceleration);
    part.set(&mut to.response, response);
}

/// The contact force that ends the approach in the next step.
#[inline(always)]
fn force_of_contact<S: Simd>(part: Part<S>, inputs: &Inputs, to: &mut States) {
    let at = |row: &Row| part.get(row);
    let half = at(&inputs.time_step) * 0.5;
    let free = at(&to.velocity) + half * (at(&to.acceleration) + at(&to.free_acceleration));
    let response = at(&to.response);
    let falling = at(&to.striker_velocity) + at(&inputs.fall);
    let needed = (falling - free) / (at(&inputs.striker_compliance) + half * response);
    part.set(&mut to.needed, needed);
}
