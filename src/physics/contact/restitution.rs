//! Impacts with a coefficient of restitution, each at its own instant inside the step. When bounces die out the two bodies move together
//! until the contact would be in tension. Between events the step is eq. (5) over a part of Δt.
//!
//! An impulse p on the degree of freedom s changes the velocities by M⁻¹e_s p, so that an impact meets the mass 1/(e_sᵀM⁻¹e_s).

use super::{Advance, Start, reduced_mass};
use crate::contact::state::StepState;
use crate::integrator::step_form::Motion;
use crate::integrator::substep::{Scratch, Striker, Substep};
use crate::structure::matrix::Vector;

/// Flights shorter than this part of Δt are not followed: the bodies stay together. With more, bouncing ends too early. With less, a step
/// near e = 1 takes more bounces than necessary. The error falls with Δt.
const SHORTEST_FLIGHT: f64 = 1e-3;
/// Bisections of a time interval: past the resolution of a double.
const HALVINGS: u32 = 60;
/// Largest number of bounces in one step. `SHORTEST_FLIGHT` allows no more in a step whose structure slows down steadily; past them the
/// next impact is treated as the last of the series.
const MOST_BOUNCES: u32 = 2000;

/// Separation speed = `coefficient` × closing speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestitutionContact {
    coefficient: f64,
    /// The bodies move as one.
    joined: bool,
}

impl RestitutionContact {
    /// e, from 0 (they stick) to 1 (nothing is lost); the bodies begin apart.
    #[must_use]
    pub const fn new(coefficient: f64) -> Self {
        Self {
            coefficient,
            joined: false,
        }
    }
}

/// A collision of two bodies: the impulse between them.
struct Collision {
    coefficient: f64,
    /// M Ms/(M + Ms) \[kg\].
    reduced_mass: f64,
    /// \[m/s\]
    closing: f64,
}

impl Collision {
    /// \[N·s\]
    const fn impulse(&self) -> f64 {
        self.reduced_mass * (1.0 + self.coefficient) * self.closing
    }

    /// \[J\]
    const fn loss(&self) -> f64 {
        0.5 * self.reduced_mass
            * (1.0 - self.coefficient * self.coefficient)
            * self.closing
            * self.closing
    }

    /// Speed at which they separate \[m/s\].
    const fn separation(&self) -> f64 {
        self.coefficient * self.closing
    }

    /// Whether they are together again after a flight that is not followed; they approach each other with `deceleration` \[m/s²\].
    const fn dies_out(&self, deceleration: f64, time_step: f64) -> bool {
        2.0 * self.separation() <= deceleration * SHORTEST_FLIGHT * time_step
    }

    /// The impulse \[N·s\] that cancels their separation velocity, and its energy loss \[J\]: from then on they move as one.
    const fn joining(&self) -> (f64, f64) {
        let separation = self.separation();
        (
            -self.reduced_mass * separation,
            0.5 * self.reduced_mass * separation * separation,
        )
    }
}

/// Structure and striker inside a step; `ahead` is the motion under examination.
struct Course<'a, 'b, V: Vector> {
    substep: &'a mut Substep<'b, V>,
    striker: Striker,
    now: &'a mut Motion<V>,
    ahead: &'a mut Motion<V>,
    /// Whether `now` and `ahead` have exchanged their memory.
    swapped: bool,
    striker_displacement: f64,
    striker_velocity: f64,
    /// Xs − X, at most 0; exactly 0 after an impact.
    overlap: f64,
    left: f64,
    impulse: f64,
    loss: f64,
    damping_work: f64,
}

impl<V: Vector> Course<'_, '_, V> {
    /// Evaluates the motion `duration` ahead, with the striker on the structure or without: the struck displacement, velocity and
    /// acceleration.
    #[inline]
    fn look(&mut self, duration: f64, joined: bool) -> [f64; 3] {
        let Striker {
            struck,
            mass,
            gravity,
            time_step,
        } = self.striker;
        let part = if duration == self.left {
            1.0
        } else {
            1.0 - (self.left - duration) / time_step
        };
        let joined = joined.then_some([mass, mass * gravity]);
        self.substep
            .follow(self.now, [duration, part], joined, self.ahead);
        [
            &self.ahead.displacement,
            &self.ahead.velocity,
            &self.ahead.acceleration,
        ]
        .map(|vector| vector.as_slice()[struck])
    }

    /// Continues for `duration` to the evaluated motion.
    #[inline]
    fn go(&mut self, striker_velocity: f64, duration: f64) {
        let moved = self.substep.of_struck(self.ahead).0 - self.substep.of_struck(self.now).0;
        let striker_moved = 0.5 * duration * (self.striker_velocity + striker_velocity);
        self.damping_work += self.substep.damped_between(self.now, self.ahead, duration);
        std::mem::swap(&mut self.now, &mut self.ahead);
        self.swapped = !self.swapped;
        self.striker_displacement += striker_moved;
        self.striker_velocity = striker_velocity;
        self.overlap = (self.overlap + striker_moved - moved).min(0.0);
        self.left -= duration;
    }

    /// Momentum p passes from striker to structure.
    #[inline]
    fn strike(&mut self, impulse: f64) {
        self.substep.strike(impulse, self.now);
        self.striker_velocity -= impulse / self.striker.mass;
        self.impulse += impulse;
    }

    /// Ẋ and Ẍ of the struck degree of freedom.
    #[inline]
    fn struck(&self) -> [f64; 2] {
        [&self.now.velocity, &self.now.acceleration]
            .map(|vector| vector.as_slice()[self.striker.struck])
    }
}

/// First instant in (0, end] at which `reached` holds, by halving; it holds at `end`.
fn locate(end: f64, mut reached: impl FnMut(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if reached(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

impl RestitutionContact {
    /// The step in tangent form from the state in `scratch`; its end is written to `to`.
    #[inline]
    pub(crate) fn pass<V: Vector>(
        &mut self,
        substep: &mut Substep<V>,
        striker: &Striker,
        start: &Start,
        scratch: &mut Scratch<V>,
        to: &mut Motion<V>,
    ) -> Advance {
        let overlap = if self.joined {
            0.0
        } else {
            (start.striker_displacement - start.displacement).min(0.0)
        };
        let mut course = Course {
            substep,
            striker: *striker,
            now: &mut *scratch.now,
            ahead: &mut *to,
            swapped: false,
            striker_displacement: start.striker_displacement,
            striker_velocity: start.striker_velocity,
            overlap,
            left: striker.time_step,
            impulse: 0.0,
            loss: 0.0,
            damping_work: 0.0,
        };
        let mut bounces = 0;
        while course.left > 0.0 {
            if self.joined {
                self.ride(&mut course);
            } else if self.fly(&mut course, bounces < MOST_BOUNCES) {
                bounces += 1;
            }
        }
        // A pair that separates as the step begins has not touched in it.
        let touched = self.joined || course.impulse > 0.0;
        let advance = Advance {
            striker_displacement: course.striker_displacement,
            striker_velocity: course.striker_velocity,
            state: if touched {
                StepState::Contact
            } else {
                StepState::Free
            },
            contact_force: course.impulse / striker.time_step,
            indentation: start.indentation,
            contact_loss: course.loss,
            damping_work: course.damping_work,
            indentation_work: 0.0,
            contacts: bounces,
        };
        if !course.swapped {
            std::mem::swap(scratch.now, to);
        }
        advance
    }

    /// Both bodies apart, to the next impact or to the end of the step. True if there was an impact.
    #[inline]
    fn fly<V: Vector>(&mut self, course: &mut Course<V>, may_bounce: bool) -> bool {
        let gravity = course.striker.gravity;
        let (overlap, striker_velocity, left) =
            (course.overlap, course.striker_velocity, course.left);
        let [velocity, _] = course.struck();
        let touching_and_closing = overlap == 0.0 && striker_velocity > velocity;
        if !touching_and_closing {
            // Xs − X > 0 divided by the flight time, so that the contact at the start of a flight is not a root.
            let mut closed = |duration: f64| {
                let [_, ahead, _] = course.look(duration, false);
                overlap / duration + (striker_velocity + 0.5 * gravity * duration)
                    - 0.5 * (velocity + ahead)
                    > 0.0
            };
            if !closed(left) {
                course.go(striker_velocity + gravity * left, left);
                return false;
            }
            let instant = locate(left, closed);
            // The last evaluation of a search is not always at the instant that it found.
            course.look(instant, false);
            course.go(striker_velocity + gravity * instant, instant);
            course.overlap = 0.0;
        }
        // The chord met the striker but the structure moves away from it: they graze, and no momentum passes.
        if course.striker_velocity < course.struck()[0] {
            return false;
        }
        self.collide(course, may_bounce);
        true
    }

    /// An impact: the bodies separate by the coefficient of restitution, or continue as one.
    fn collide<V: Vector>(&mut self, course: &mut Course<V>, may_bounce: bool) {
        let Striker {
            mass,
            gravity,
            time_step,
            ..
        } = course.striker;
        let closing = course.striker_velocity - course.struck()[0];
        let collision = Collision {
            coefficient: self.coefficient,
            reduced_mass: reduced_mass(course.substep.struck_mass(), mass),
            closing,
        };
        course.strike(collision.impulse());
        course.loss += collision.loss();

        // The striker falls with g alone: the structure's deceleration, and its own fall, bring them together again.
        let deceleration = gravity - course.struck()[1];
        if collision.dies_out(deceleration, time_step) || !may_bounce {
            let (impulse, loss) = collision.joining();
            course.strike(impulse);
            course.loss += loss;
            let [velocity, acceleration] = course.struck();
            course.striker_velocity = velocity;
            // F = Ms(g − Ẍ) with Ẍ = Ẍ_free + F/m of the struck degree of freedom.
            course.substep.press(
                collision.reduced_mass * (gravity - acceleration),
                course.now,
            );
            self.joined = true;
        }
    }

    /// Both bodies as one, to the end of the step or to the instant when the contact would be in tension.
    #[inline]
    fn ride<V: Vector>(&mut self, course: &mut Course<V>) {
        let Striker { mass, gravity, .. } = course.striker;
        let mut duration = course.left;
        let [velocity, _] = course.struck();
        let mut ahead = course.look(duration, true);
        // F = Ms(g − Ẍ): it is in tension if the pair accelerates by more than g.
        let parted = ahead[2] > gravity;
        if parted {
            duration = locate(duration, |duration| {
                course.look(duration, true)[2] > gravity
            });
            ahead = course.look(duration, true);
        }
        let [_, end_velocity, acceleration] = ahead;
        course.impulse += mass * (gravity * duration + velocity - end_velocity);
        course.go(end_velocity, duration);
        course.overlap = 0.0;
        if parted {
            course
                .substep
                .press(mass * (acceleration - gravity), course.now);
            self.joined = false;
        }
    }
}
