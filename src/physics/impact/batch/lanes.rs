//! Sixteen impacts, one step at a time. In: impacts that begin in a lane. Out: their results when they end. The arithmetic is that of
//! [`super::super::ImpactSolver`], in the same order, and of the summary of its steps.

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

/// Declares the rows of all lanes.
macro_rules! rows {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {
        /// The inputs, states and results of all lanes.
        #[derive(Clone, Debug)]
        pub struct Lanes {
            $($(#[$doc])* $name: Row,)*
        }

        impl Lanes {
            /// All at rest.
            pub fn new() -> Self {
                Self { $($name: [0.0; LANES],)* }
            }

            fn clear(&mut self, lane: usize) {
                $(self.$name[lane] = 0.0;)*
            }
        }
    };
}

rows! {
    /// M, C
    mass, damping, damped,
    /// Δt
    time_step,
    /// `K_t`, and its largest value.
    tangent, largest_tangent,
    /// M̂, and 1/M̂.
    effective, response,
    /// K0, and the lines of a bilinear specimen.
    stiffness, hardened, half_band,
    /// Ms, g, Δt/Ms, the limit force.
    striker_mass, gravity, striker_compliance, force_limit,
    /// ½MsV0²
    striker_energy,
    step,
    displacement, velocity, acceleration, force,
    striker_displacement, striker_velocity, contact_force, touching, indentation, contacts,
    restoring_energy, damping_energy, contact_loss, indentation_energy, weight, error, input,
    max_displacement, time_of_max_displacement, absorbed_energy, max_velocity, max_contact_force, impulse,
    stopped, stop_time,
    /// The reach, beside the largest displacement.
    least_displacement, least_force, largest_force, largest_increment,
    /// The first contact: begun, ended, closing speed before it, closing speed after it.
    begun, ended, closing, separating,
}

#[inline]
fn select(condition: bool, yes: f64, no: f64) -> f64 {
    if condition { yes } else { no }
}

impl Lanes {
    /// An impact at its start.
    pub fn begin(&mut self, lane: usize, impact: &Impact) {
        self.clear(lane);
        let input = &impact.input;
        let specimen = impact.lane_specimen(None).expect("batched");
        let set = |row: &mut Row, value: f64| row[lane] = value;
        set(&mut self.mass, input.mass);
        set(&mut self.damping, input.damping);
        set(&mut self.damped, select(input.damping == 0.0, NO, YES));
        set(&mut self.time_step, input.time_step);
        set(&mut self.tangent, input.stiffness);
        set(
            &mut self.largest_tangent,
            input.max_tangent_ratio * input.stiffness,
        );
        let structure = Structure {
            mass: input.mass,
            damping: input.damping,
            tangent: input.stiffness,
        };
        let effective = structure.effective_mass(input.time_step);
        set(&mut self.effective, effective);
        set(&mut self.response, 1.0 / effective);
        match specimen {
            LaneSpecimen::Elastic(model) => set(&mut self.stiffness, model.stiffness),
            LaneSpecimen::Bilinear(model) => {
                let [stiffness, hardened, half_band] = model.lines();
                set(&mut self.stiffness, stiffness);
                set(&mut self.hardened, hardened);
                set(&mut self.half_band, half_band);
            }
        }
        set(&mut self.striker_mass, input.striker_mass);
        set(&mut self.gravity, input.gravity);
        set(
            &mut self.striker_compliance,
            input.time_step / input.striker_mass,
        );
        let force_limit = match input.law {
            ContactLaw::Limit { force } => force,
            _ => f64::INFINITY,
        };
        set(&mut self.force_limit, force_limit);
        set(&mut self.striker_energy, input.striker_energy());
        set(&mut self.input, input.striker_energy());
        set(&mut self.striker_displacement, 0.0 - input.gap);
        set(&mut self.striker_velocity, input.striker_velocity);
        set(&mut self.closing, input.striker_velocity);
    }

    /// A lane without an impact: a mass at rest.
    pub fn rest(&mut self, lane: usize) {
        self.clear(lane);
        self.mass[lane] = 1.0;
        self.effective[lane] = 1.0;
        self.response[lane] = 1.0;
        self.striker_compliance[lane] = 1.0;
        self.striker_mass[lane] = 1.0;
        // Apart for ever, and moving: it never ends.
        self.striker_displacement[lane] = -1.0;
        self.striker_velocity[lane] = f64::MIN_POSITIVE;
    }

    /// One step of every lane. Whether some lane has ended with it.
    #[inline]
    #[allow(
        clippy::needless_range_loop,
        clippy::needless_bitwise_bool,
        reason = "one loop without branches over many rows becomes vector instructions"
    )]
    pub fn step<const YIELDS: bool, const LIMITED: bool>(
        &mut self,
        ends_at_stop: bool,
        last: f64,
    ) -> bool {
        let mut ended = [false; LANES];
        for lane in 0..LANES {
            let time_step = self.time_step[lane];
            let half = 0.5 * time_step;
            let [x0, v0, a0, r0] = [
                self.displacement[lane],
                self.velocity[lane],
                self.acceleration[lane],
                self.force[lane],
            ];
            let (damping, damped) = (self.damping[lane], self.damped[lane] == YES);

            // Eqs. (4) and (5), without contact.
            let unloaded = 0.0 - r0;
            let braked = unloaded - damping * (v0 + half * a0);
            let push = select(damped, braked, unloaded);
            let drift = time_step * (v0 + 0.5 * half * a0);
            let tangent = self.tangent[lane];
            let push = push - tangent * drift;
            let free_acceleration = push / self.effective[lane];

            // The contact.
            let free = v0 + half * (a0 + free_acceleration);
            let response = self.response[lane];
            let (xs0, vs0) = (self.striker_displacement[lane], self.striker_velocity[lane]);
            let indentation = self.indentation[lane];
            let falling = vs0 + self.gravity[lane] * time_step;
            let needed = (falling - free) / (self.striker_compliance[lane] + half * response);
            let apart = xs0 - x0 < indentation;
            let limit = self.force_limit[lane];
            let at_limit = LIMITED & !apart & (needed > limit);
            let in_contact = !apart & !at_limit & (needed >= 0.0);
            let contact_force = select(at_limit, limit, select(in_contact, needed, 0.0));

            // Eqs. (2c) and (2d), and the force there.
            let a1 = free_acceleration + contact_force * response;
            let v1 = v0 + half * (a0 + a1);
            let x1 = x0 + half * (v0 + v1);
            let stiffness = self.stiffness[lane];
            let r1 = if YIELDS {
                let trial = r0 + stiffness * (x1 - x0);
                let middle = self.hardened[lane] * x1;
                let half_band = self.half_band[lane];
                let [low, high] = [middle - half_band, middle + half_band];
                let above = select(trial < low, low, trial);
                select(above > high, high, above)
            } else {
                stiffness * x1
            };

            // Eq. (6), and the next step's M̂.
            let change = x1 - x0;
            let secant = (r1 - r0) / change;
            let largest = self.largest_tangent[lane];
            let secant = select(secant < 0.0, 0.0, secant);
            let secant = select(secant > largest, largest, secant);
            let tangent = select(change.abs() > 0.0, secant, tangent);
            let structure = Structure {
                mass: self.mass[lane],
                damping,
                tangent,
            };
            let next = structure.effective_mass(time_step);
            self.tangent[lane] = tangent;
            self.effective[lane] = next;
            self.response[lane] = 1.0 / next;

            // The striker.
            let limited_velocity = if LIMITED {
                falling - contact_force * time_step / self.striker_mass[lane]
            } else {
                falling
            };
            let vs1 = select(at_limit, limited_velocity, select(in_contact, v1, falling));
            let striker_moved = 0.5 * time_step * (vs0 + vs1);
            let xs1 = xs0 + striker_moved;
            let dent = xs1 - x1;
            let deeper = select(dent > indentation, dent, indentation);
            let indented = if LIMITED {
                select(at_limit, deeper, indentation)
            } else {
                indentation
            };
            let moved = 0.5 * time_step * (v0 + v1);
            let loss = contact_force * striker_moved
                - 0.5 * (self.contact_force[lane] + contact_force) * moved;

            // Energies.
            let restoring = self.restoring_energy[lane] + 0.5 * ((r0 + r1) * (x1 - x0));
            let mean_velocity = 0.5 * (v0 + v1);
            let damping_work = time_step * (mean_velocity * (damping * mean_velocity));
            let damping_energy = self.damping_energy[lane] + select(damped, damping_work, 0.0);
            let structure = 0.5 * (self.mass[lane] * v1 * v1);
            let striker_mass = self.striker_mass[lane];
            let striker = 0.5 * striker_mass * vs1 * vs1;
            let contact_loss = self.contact_loss[lane] + loss;
            let weight = self.weight[lane] + striker_mass * self.gravity[lane] * (xs1 - xs0);
            let first = self.striker_energy[lane];
            self.error[lane] =
                first + weight - (striker + structure + restoring + damping_energy + contact_loss);
            let input = first + weight;
            self.input[lane] = select(input > self.input[lane], input, self.input[lane]);
            if LIMITED {
                let work = select(at_limit, contact_force * (indented - indentation), 0.0);
                self.indentation_energy[lane] += work;
            }

            // The results.
            let step = self.step[lane] + 1.0;
            let time = step * time_step;
            let farther = x1 > self.max_displacement[lane];
            self.max_displacement[lane] = select(farther, x1, self.max_displacement[lane]);
            self.time_of_max_displacement[lane] =
                select(farther, time, self.time_of_max_displacement[lane]);
            self.absorbed_energy[lane] = select(farther, restoring, self.absorbed_energy[lane]);
            let [speed, fastest] = [v1.abs(), self.max_velocity[lane]];
            self.max_velocity[lane] = select(speed > fastest, speed, fastest);
            let most = self.max_contact_force[lane];
            self.max_contact_force[lane] = select(contact_force > most, contact_force, most);
            self.impulse[lane] += contact_force * time_step;
            let least = self.least_displacement[lane];
            self.least_displacement[lane] = select(x1 < least, x1, least);
            let [least, most] = [self.least_force[lane], self.largest_force[lane]];
            self.least_force[lane] = select(r1 < least, r1, least);
            self.largest_force[lane] = select(r1 > most, r1, most);
            let [increment, longest] = [change.abs(), self.largest_increment[lane]];
            self.largest_increment[lane] = select(increment > longest, increment, longest);
            let stops = (vs1 <= 0.0) & (self.stopped[lane] == NO);
            self.stop_time[lane] = select(stops, time, self.stop_time[lane]);
            self.stopped[lane] = select(stops, YES, self.stopped[lane]);

            // The first contact.
            let touching = at_limit | in_contact;
            let (begun, over) = (self.begun[lane], self.ended[lane]);
            let closing_now = vs1 - v1;
            let still_to_come = (begun == NO) & !touching;
            let ends_now = (begun == YES) & (over == NO) & !touching;
            self.closing[lane] = select(still_to_come, closing_now, self.closing[lane]);
            self.separating[lane] = select(ends_now, closing_now, self.separating[lane]);
            self.ended[lane] = select(ends_now, YES, over);
            self.begun[lane] = select(touching, YES, begun);
            let begins = touching & (self.touching[lane] == NO);
            self.contacts[lane] += select(begins, 1.0, 0.0);
            self.touching[lane] = select(touching, YES, NO);

            self.step[lane] = step;
            self.displacement[lane] = x1;
            self.velocity[lane] = v1;
            self.acceleration[lane] = a1;
            self.force[lane] = r1;
            self.striker_displacement[lane] = xs1;
            self.striker_velocity[lane] = vs1;
            self.contact_force[lane] = contact_force;
            self.indentation[lane] = indented;
            self.restoring_energy[lane] = restoring;
            self.damping_energy[lane] = damping_energy;
            self.contact_loss[lane] = contact_loss;
            self.weight[lane] = weight;
            ended[lane] = (step >= last) | (ends_at_stop & (vs1 <= 0.0) & (v1 <= 0.0));
        }
        ended.iter().fold(false, |some, lane| some | lane)
    }

    /// Whether the impact of a lane has ended.
    pub fn is_over(&self, lane: usize, ends_at_stop: bool, last: f64) -> bool {
        let stopped = self.striker_velocity[lane] <= 0.0 && self.velocity[lane] <= 0.0;
        self.step[lane] >= last || ends_at_stop && stopped
    }

    /// How far the impact of a lane reached.
    pub fn reach(&self, lane: usize) -> Reach {
        Reach {
            displacement: [self.least_displacement[lane], self.max_displacement[lane]],
            restoring_force: [self.least_force[lane], self.largest_force[lane]],
            increment: self.largest_increment[lane],
            last_velocity: self.velocity[lane],
            last_contact_force: self.contact_force[lane],
        }
    }

    /// The results of the impact of a lane.
    pub fn summary(&self, lane: usize, input: &ImpactInput) -> ImpactSummary {
        let energy_error = if self.input[lane] > 0.0 {
            self.error[lane] / self.input[lane]
        } else {
            0.0
        };
        let stop_time = (self.stopped[lane] == YES).then_some(self.stop_time[lane]);
        let closing = self.closing[lane];
        let rebounded = self.ended[lane] == YES && closing > 0.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count below 2^53"
        )]
        let contacts = self.contacts[lane] as u64;
        ImpactSummary {
            max_displacement: self.max_displacement[lane],
            time_of_max_displacement: self.time_of_max_displacement[lane],
            stop_time,
            final_displacement: self.displacement[lane],
            max_velocity: self.max_velocity[lane],
            max_contact_force: self.max_contact_force[lane],
            impulse: self.impulse[lane],
            contacts,
            restitution: rebounded.then(|| -self.separating[lane] / closing),
            indentation: self.indentation[lane],
            indentation_energy: self.indentation_energy[lane],
            absorbed_energy: self.absorbed_energy[lane],
            striker_energy: input.striker_energy(),
            energy_error,
            still_rising: still_rising(
                self.velocity[lane],
                self.displacement[lane] >= self.max_displacement[lane],
            ),
            last_contact_cut: stop_time.is_some() && self.contact_force[lane] > 0.0,
        }
    }
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
