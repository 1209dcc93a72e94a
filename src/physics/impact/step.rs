//! One step of an impact in tangent form under a law of impulses, on a specimen with exact readings; of one impact or of several side by
//! side. In: the state before it. Out: the state after it. It knows nothing of impacts that begin and end.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use super::summary::StepEnd;
use crate::contact::{Decided, ImpulseContact, Start, Touching};
use crate::number::numbers;
use crate::structure::matrix::one_degree::{Body, LEAST_CHANGE, Secant};

numbers! {
    /// What the body does not say of the structure.
    pub(super) struct Structure {
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
        body: Body,
        structure: Structure,
        contact: ImpulseContact,
        striker: StrikerInput,
    }
}

groups! {
    /// The end of a step, where the next one begins.
    BetweenSteps {
        motion: Motion,
        secant: Secant,
        work: Work,
        indented: Indented,
        damped: Damped,
        fallen: Fallen,
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
    /// At rest at X \[m\] under the force R of the specimen \[N\], with Ẍ \[m/s²\], K_t, and the input energy \[J\].
    pub fn at_rest(
        [displacement, force, acceleration]: [f64; 3],
        [xs, vs]: [f64; 2],
        secant: Secant,
        input: f64,
    ) -> Self {
        Self {
            motion: Motion {
                displacement,
                velocity: 0.0,
                acceleration,
                force,
                striker_displacement: xs,
                striker_velocity: vs,
                contact_force: 0.0,
            },
            secant,
            work: Work {
                restoring: 0.0,
                contact_loss: 0.0,
            },
            indented: Indented {
                depth: 0.0,
                work: 0.0,
            },
            damped: Damped { work: 0.0 },
            fallen: Fallen { work: 0.0, input },
        }
    }
}

impl<N: Touching> BetweenSteps<N> {
    /// As far as the results follow it.
    #[inline(always)]
    pub fn step_end(&self, instant: N) -> StepEnd<N> {
        StepEnd {
            instant,
            displacement: self.motion.displacement,
            velocity: self.motion.velocity,
            restoring_force: self.motion.force,
            contact_force: self.motion.contact_force,
            restoring_energy: self.work.restoring,
        }
    }
}

/// The contact; eqs. (2c) and (2d), and the reading there: `read` gives R₁ and the measured change of X, from X, R and X₁, Ẋ₁; the
/// striker; the work of all forces; K_t.
#[inline(always)]
pub(super) fn end_step<N: Touching, const LIMITED: bool>(
    inputs: &StepInputs<N>,
    from: &BetweenSteps<N>,
    also: Also,
    read: impl FnOnce([N; 2], [N; 2]) -> [N; 2],
) -> (BetweenSteps<N>, Marks<N>) {
    let StepInputs {
        body,
        structure,
        contact,
        striker,
    } = inputs;
    let zero = body.half.same(0.0);
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
    let unforced = body.unforced(also.damped, [v0, a0], zero - r0, &from.secant);
    let (state, [top, bottom]) = contact.join::<LIMITED>(&start, &unforced, body.half);
    let a1 = top / bottom;
    let [x1, v1] = body.travel(x0, &unforced, a1);
    let decided = Decided {
        state,
        force: contact.settled(&start, state, v1),
    };
    let [r1, measured_change] = read([x0, r0], [x1, v1]);
    let change = x1 - x0;
    let end = contact.advance(body.half, &start, &decided, [x1, v1, change]);
    let secant = from.secant.after(
        r1 - r0,
        measured_change,
        structure.largest_tangent,
        LEAST_CHANGE,
    );
    let BetweenSteps {
        mut work,
        mut indented,
        mut damped,
        mut fallen,
        ..
    } = *from;
    work.contact_loss = work.contact_loss + end.contact_loss;
    indented.depth = end.indentation;
    indented.work = indented.work + end.indentation_work;
    work.restoring = work.restoring + (r0 + r1) * (change * 0.5);
    if also.damped {
        let mean_velocity = (v0 + v1) * 0.5;
        let damping = body.damping * mean_velocity;
        damped.work = damped.work + structure.time_step * (mean_velocity * damping);
    }
    if also.falls {
        let height = end.displacement - start.striker_displacement;
        fallen.work = fallen.work + striker.weight * height;
        fallen.input = fallen.input.larger(striker.energy + fallen.work);
    }
    let stopped = end.velocity.le(zero);
    let marks = Marks {
        state,
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
        secant,
        work,
        indented,
        damped,
        fallen,
    };
    (state, marks)
}
