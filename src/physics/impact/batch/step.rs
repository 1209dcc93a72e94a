//! One step of an impact in tangent form under a law of impulses, on an elastic or bilinear specimen with exact readings; of one impact or
//! of several side by side. In: the state before it. Out: the state after it. It knows nothing of impacts that begin and end.
//!
//! A step has four parts, and each part is done for all lanes before the next one: a division takes long, and those of several lanes
//! overlap only if little is between them. So a step ends with the divisions of the next one.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use super::reach::RunningReach;
use crate::contact::{ImpulseContact, Start, Touching};
use crate::impact::summary::{RunningResults, StepEnd};
use crate::integrator::tangent::secant;
use crate::number::{Number, numbers};
use crate::specimen::BilinearLines;
use crate::structure::matrix::one_degree::{effective_mass, travel, unbalanced_force};

numbers! {
    /// The structure.
    pub(super) struct Structure {
        /// M, C
        mass,
        damping,
        /// Δt
        time_step,
        /// The largest `K_t`.
        largest_tangent,
    }
}

numbers! {
    /// What the striker brings: its weight Ms·g and ½MsV0².
    pub(super) struct StrikerInput {
        weight,
        energy,
    }
}

numbers! {
    /// Structure and striker at the end of a step, beside δp.
    pub(super) struct Motion {
        displacement,
        velocity,
        acceleration,
        /// R
        force,
        striker_displacement,
        striker_velocity,
        contact_force,
    }
}

numbers! {
    /// What the next step needs.
    pub(super) struct Ahead {
        /// K_t
        tangent,
        /// Ẍ₁ without its contact.
        free_acceleration,
        /// 1/M̂
        response,
        /// The contact force that stops the closing.
        needed,
    }
}

numbers! {
    /// The work so far.
    pub(super) struct Work {
        restoring,
        contact_loss,
    }
}

numbers! {
    /// Of a limit force.
    pub(super) struct Indented {
        /// δp \[m\]
        depth,
        work,
    }
}

numbers! {
    /// Of a damper.
    pub(super) struct Damped {
        work,
    }
}

numbers! {
    /// Of a falling striker: the work of its weight, and the energy put in.
    pub(super) struct Fallen {
        work,
        input,
    }
}

/// Declares groups of numbers that belong together.
macro_rules! groups {
    ($(#[$about:meta])* $name:ident { $($(#[$doc:meta])* $field:ident: $group:ident,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name<N = f64> { $($(#[$doc])* pub $field: $group<N>,)* }

        impl<N> $name<N> {
            /// Each number by itself.
            #[inline(always)]
            pub fn map<M>(&self, mut each: impl FnMut(&N) -> M) -> $name<M> {
                $name { $($field: self.$field.map(&mut each),)* }
            }

            /// Each number with the same one of `others`.
            #[inline(always)]
            pub fn each<M>(&mut self, others: $name<M>, mut each: impl FnMut(&mut N, M)) {
                $(self.$field.each(others.$field, &mut each);)*
            }
        }
    };
}

groups! {
    /// What does not change.
    StepInputs {
        structure: Structure,
        specimen: BilinearLines,
        contact: ImpulseContact,
        striker: StrikerInput,
    }
}

groups! {
    /// The end of a step, where the next one begins.
    BetweenSteps {
        motion: Motion,
        ahead: Ahead,
        work: Work,
        indented: Indented,
        damped: Damped,
        fallen: Fallen,
        results: RunningResults,
        reach: RunningReach,
    }
}

/// What an impact has, or the impact of some lane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Also {
    /// A damper.
    pub damped: bool,
    /// A falling striker.
    pub falls: bool,
}

/// What is so at the end of a step.
pub(super) struct Marks<N: Touching> {
    /// Of the contact.
    pub state: N::State,
    /// The striker does not move forward.
    pub stopped: N::Answer,
    /// Nor does the structure.
    pub over: N::Answer,
}

impl BetweenSteps {
    /// From rest at X = 0, with the striker at `striker_displacement`; `instant` is the start.
    pub fn at_rest(inputs: &StepInputs, [xs, vs]: [f64; 2], tangent: f64, instant: f64) -> Self {
        let end = StepEnd {
            instant,
            displacement: 0.0,
            velocity: 0.0,
            restoring_force: 0.0,
            contact_force: 0.0,
            restoring_energy: 0.0,
        };
        let mut results = RunningResults::START;
        results.add(inputs.structure.time_step, &end);
        let mut state = Self {
            motion: Motion {
                displacement: 0.0,
                velocity: 0.0,
                acceleration: 0.0,
                force: 0.0,
                striker_displacement: xs,
                striker_velocity: vs,
                contact_force: 0.0,
            },
            ahead: Ahead {
                tangent,
                free_acceleration: 0.0,
                response: 0.0,
                needed: 0.0,
            },
            work: Work {
                restoring: 0.0,
                contact_loss: 0.0,
            },
            indented: Indented {
                depth: 0.0,
                work: 0.0,
            },
            damped: Damped { work: 0.0 },
            fallen: Fallen {
                work: 0.0,
                input: inputs.striker.energy,
            },
            results,
            reach: RunningReach::START,
        };
        [state.ahead.free_acceleration, state.ahead.response] = without_contact(inputs, &state);
        state.ahead.needed = needed(inputs, &state);
        state
    }
}

/// The contact; eqs. (2c) and (2d), and the force there; the striker; the work of all forces, and the results so far.
#[inline(always)]
pub(super) fn end_step<N: Touching, const YIELDS: bool, const LIMITED: bool>(
    inputs: &StepInputs<N>,
    from: &BetweenSteps<N>,
    also: Also,
    instant: N,
) -> (BetweenSteps<N>, Marks<N>) {
    let StepInputs {
        structure,
        specimen,
        contact,
        striker,
    } = inputs;
    let zero = instant.same(0.0);
    let time_step = structure.time_step;
    let Motion {
        displacement: x0,
        velocity: v0,
        acceleration: a0,
        force: r0,
        ..
    } = from.motion;
    let start = Start {
        displacement: x0,
        velocity: v0,
        striker_displacement: from.motion.striker_displacement,
        striker_velocity: from.motion.striker_velocity,
        contact_force: from.motion.contact_force,
        indentation: if LIMITED { from.indented.depth } else { zero },
    };
    let decided = contact.decide::<LIMITED>(&start, || from.ahead.needed);

    let a1 = from.ahead.free_acceleration + decided.force * from.ahead.response;
    let [x1, v1] = travel(time_step, [x0, v0, a0], a1);
    let r1 = if YIELDS {
        specimen.force([x0, r0], x1)
    } else {
        specimen.stiffness * x1
    };
    let end = contact.advance(time_step, &start, &decided, [x1, v1]);

    let BetweenSteps {
        mut work,
        mut indented,
        mut damped,
        mut fallen,
        mut results,
        mut reach,
        ..
    } = *from;
    work.contact_loss = work.contact_loss + end.contact_loss;
    indented.depth = end.indentation;
    indented.work = indented.work + end.indentation_work;
    work.restoring = work.restoring + (r0 + r1) * (x1 - x0) * 0.5;
    if also.damped {
        let mean_velocity = (v0 + v1) * 0.5;
        let damping = structure.damping * mean_velocity;
        damped.work = damped.work + time_step * (mean_velocity * damping);
    }
    if also.falls {
        let height = end.displacement - start.striker_displacement;
        fallen.work = fallen.work + striker.weight * height;
        fallen.input = fallen.input.larger(striker.energy + fallen.work);
    }

    let step_end = StepEnd {
        instant,
        displacement: x1,
        velocity: v1,
        restoring_force: r1,
        contact_force: decided.force,
        restoring_energy: work.restoring,
    };
    results.add(time_step, &step_end);
    reach.add(x0, &step_end);
    let stopped = end.velocity.le(zero);
    let marks = Marks {
        state: decided.state,
        stopped,
        over: stopped & v1.le(zero),
    };
    let state = BetweenSteps {
        motion: Motion {
            displacement: x1,
            velocity: v1,
            acceleration: a1,
            force: r1,
            striker_displacement: end.displacement,
            striker_velocity: end.velocity,
            contact_force: decided.force,
        },
        ahead: from.ahead,
        work,
        indented,
        damped,
        fallen,
        results,
        reach,
    };
    (state, marks)
}

/// K_t of the next step, eq. (6).
#[inline(always)]
pub(super) fn tangent<N: Number>(
    inputs: &StepInputs<N>,
    from: &BetweenSteps<N>,
    to: &BetweenSteps<N>,
) -> N {
    let change = to.motion.displacement - from.motion.displacement;
    let secant = || {
        secant(
            to.motion.force - from.motion.force,
            change,
            inputs.structure.largest_tangent,
        )
    };
    N::choose(
        change.equals(change.same(0.0)),
        || from.ahead.tangent,
        secant,
    )
}

/// Eqs. (4) and (5) of the next step without its contact: Ẍ₁, and 1/M̂.
#[inline(always)]
pub(super) fn without_contact<N: Number>(inputs: &StepInputs<N>, to: &BetweenSteps<N>) -> [N; 2] {
    let Structure {
        mass,
        damping,
        time_step,
        ..
    } = inputs.structure;
    let tangent = to.ahead.tangent;
    let effective = effective_mass(time_step, [mass, damping, tangent]);
    // Without damping, a zero is subtracted.
    let push = unbalanced_force(
        time_step,
        [to.motion.velocity, to.motion.acceleration],
        [mass.same(0.0), to.motion.force],
        Some(damping),
        tangent,
    );
    [push / effective, mass.same(1.0) / effective]
}

/// The contact force that stops the closing in the next step.
#[inline(always)]
pub(super) fn needed<N: Touching>(inputs: &StepInputs<N>, to: &BetweenSteps<N>) -> N {
    let half = inputs.structure.time_step * 0.5;
    let accelerations = to.motion.acceleration + to.ahead.free_acceleration;
    let free = to.motion.velocity + half * accelerations;
    inputs
        .contact
        .needed(to.motion.striker_velocity, free, half * to.ahead.response)
}
