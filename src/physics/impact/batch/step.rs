//! One step of all lanes. In: the state before it. Out: the state after it. It knows nothing of impacts that begin and end.

#![allow(
    clippy::needless_range_loop,
    clippy::needless_bitwise_bool,
    reason = "loops without branches over many rows become vector instructions"
)]

use super::rows::{Contacts, End, Inputs, LANES, NO, Row, States, Structure, YES};

/// A part of its callers, which are compiled for several vector units: a function of its own would have those of the portable build.
#[allow(clippy::inline_always, reason = "see above")]
#[inline(always)]
fn select(condition: bool, yes: f64, no: f64) -> f64 {
    std::hint::select_unpredictable(condition, yes, no)
}

/// One step from one state to another. It is several short loops: the divisions of a lane take long, and those of several lanes overlap only
/// if little is between them.
#[allow(clippy::inline_always, reason = "as `select`")]
#[inline(always)]
pub(super) fn step<const YIELDS: bool, const LIMITED: bool>(
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
        contacts.count[lane] += select(begins, 1.0, 0.0);
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
