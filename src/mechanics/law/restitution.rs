//! Impacts with a coefficient of restitution, each at its own instant inside the step; where bounces die out the two
//! bodies go on together until the contact would have to pull. Between events the step is eq. (5) over a part of Δt.

use super::{Advance, Bodies, Law, Start};
use crate::mechanics::contact::StepState;
use crate::mechanics::integrator::Motion;

/// Flights shorter than this part of Δt are not followed: the bodies stay together. Larger, and bouncing ends too
/// early; smaller, and a step near e = 1 takes more bounces than it is worth. Its error shrinks with Δt.
const SHORTEST_FLIGHT: f64 = 1e-3;
/// Halvings of an interval of time: past the resolution of a double.
const HALVINGS: u32 = 60;
/// Impacts of one step that bounce. `SHORTEST_FLIGHT` lets no more into a step whose structure slows down steadily; past
/// them the next impact is taken as the one with which the bounces die out.
pub(crate) const MOST_BOUNCES: u32 = 2000;

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
        Self { coefficient, joined: false }
    }
}

/// Two bodies meet: what passes between them, whatever else moves.
pub(crate) struct Collision {
    coefficient: f64,
    /// M Ms/(M + Ms), kg.
    pub reduced_mass: f64,
    /// m/s
    closing: f64,
}

impl Collision {
    /// Of two masses, kg, that close at this speed, m/s.
    pub const fn new(coefficient: f64, mass: f64, striker_mass: f64, closing: f64) -> Self {
        Self { coefficient, reduced_mass: mass * striker_mass / (mass + striker_mass), closing }
    }

    /// N·s
    pub const fn impulse(&self) -> f64 {
        self.reduced_mass * (1.0 + self.coefficient) * self.closing
    }

    /// J
    pub const fn loss(&self) -> f64 {
        0.5 * self.reduced_mass * (1.0 - self.coefficient * self.coefficient) * self.closing * self.closing
    }

    /// Speed at which they part, m/s.
    const fn separation(&self) -> f64 {
        self.coefficient * self.closing
    }

    /// Whether they are together again, slowing towards each other at `deceleration` (m/s²), after a flight that is not followed.
    pub const fn dies_out(&self, deceleration: f64, time_step: f64) -> bool {
        2.0 * self.separation() <= deceleration * SHORTEST_FLIGHT * time_step
    }

    /// The impulse (N·s) that takes their separation back, and what it loses (J): from then on they move as one.
    pub const fn joining(&self) -> (f64, f64) {
        let separation = self.separation();
        (-self.reduced_mass * separation, 0.5 * self.reduced_mass * separation * separation)
    }
}

/// The two bodies while a step is under way.
struct Course {
    structure: Motion,
    striker_displacement: f64,
    striker_velocity: f64,
    /// Xs − X, at most 0; the very 0 after an impact.
    overlap: f64,
    left: f64,
    impulse: f64,
    loss: f64,
    damping_work: f64,
}

impl Course {
    /// Goes on for `duration` to where the structure is then.
    fn go(&mut self, bodies: &Bodies, to: Motion, striker_velocity: f64, duration: f64) {
        let moved = to.displacement - self.structure.displacement;
        let striker_moved = 0.5 * duration * (self.striker_velocity + striker_velocity);
        self.damping_work += 0.5 * bodies.damping * (self.structure.velocity + to.velocity) * moved;
        self.structure = to;
        self.striker_displacement += striker_moved;
        self.striker_velocity = striker_velocity;
        self.overlap = (self.overlap + striker_moved - moved).min(0.0);
        self.left -= duration;
    }

    /// Momentum p passes from striker to structure; what the damper adds to M Ẍ comes with it.
    fn strike(&mut self, bodies: &Bodies, impulse: f64) {
        let change = impulse / bodies.mass;
        self.structure.velocity += change;
        self.structure.acceleration -= bodies.damping * change / bodies.mass;
        self.striker_velocity -= impulse / bodies.striker_mass;
        self.impulse += impulse;
    }
}

/// First instant in (0, end] at which `reached` holds, by halving; it holds at `end`.
pub(crate) fn locate(end: f64, mut reached: impl FnMut(f64) -> bool) -> f64 {
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
    /// Both bodies apart, to the next impact or to the end of the step. True if there was an impact.
    fn fly(&mut self, bodies: &Bodies, tangent: f64, course: &mut Course, may_bounce: bool) -> bool {
        let Bodies { mass, damping, gravity, .. } = *bodies;
        let from = course.structure;
        let (overlap, striker_velocity, left) = (course.overlap, course.striker_velocity, course.left);
        let free = |duration: f64| from.free(mass, damping, tangent, duration);
        // Xs − X > 0 divided by the time flown, so that the touch at the start of a flight is no root of it.
        let closed = |duration: f64| {
            let flown = striker_velocity + 0.5 * gravity * duration;
            overlap / duration + flown - 0.5 * (from.velocity + free(duration).velocity) > 0.0
        };
        let touching_and_closing = overlap == 0.0 && striker_velocity > from.velocity;
        if !touching_and_closing {
            if !closed(left) {
                course.go(bodies, free(left), striker_velocity + gravity * left, left);
                return false;
            }
            let instant = locate(left, closed);
            course.go(bodies, free(instant), striker_velocity + gravity * instant, instant);
            course.overlap = 0.0;
        }
        // The chord met the striker but the structure speeds away from it: they graze, and nothing passes.
        if course.striker_velocity < course.structure.velocity {
            return false;
        }
        self.collide(bodies, course, may_bounce);
        true
    }

    /// An impact: the bodies part with what restitution leaves them, or go on as one.
    fn collide(&mut self, bodies: &Bodies, course: &mut Course, may_bounce: bool) {
        let Bodies { mass, striker_mass, gravity, time_step, .. } = *bodies;
        let closing = course.striker_velocity - course.structure.velocity;
        let collision = Collision::new(self.coefficient, mass, striker_mass, closing);
        course.strike(bodies, collision.impulse());
        course.loss += collision.loss();

        // The striker falls with g alone: the structure's deceleration, and its own fall, bring them together again.
        let deceleration = gravity - course.structure.acceleration;
        if collision.dies_out(deceleration, time_step) || !may_bounce {
            let (impulse, loss) = collision.joining();
            course.strike(bodies, impulse);
            course.loss += loss;
            course.striker_velocity = course.structure.velocity;
            course.structure.acceleration *= mass / (mass + striker_mass);
            course.structure.acceleration += striker_mass / (mass + striker_mass) * gravity;
            self.joined = true;
        }
    }

    /// Both bodies as one, to the end of the step or to the instant the contact would pull.
    fn ride(&mut self, bodies: &Bodies, tangent: f64, course: &mut Course) {
        let Bodies { mass, damping, striker_mass, gravity, .. } = *bodies;
        let from = course.structure;
        let both = mass + striker_mass;
        let weight = striker_mass * gravity;
        let together = |duration: f64| {
            let balance = from.balance(both, damping, tangent, duration);
            from.follow((balance.load + weight) / balance.inertia, tangent, duration)
        };
        let mut duration = course.left;
        let mut to = together(duration);
        // F = Ms (g − Ẍ): it pulls where the pair speeds up by more than g.
        if to.acceleration > gravity {
            duration = locate(duration, |duration| together(duration).acceleration > gravity);
            to = together(duration);
            to.acceleration *= both / mass;
            to.acceleration -= weight / mass;
            self.joined = false;
        }
        course.impulse += weight * duration + striker_mass * (from.velocity - to.velocity);
        course.go(bodies, to, to.velocity, duration);
        course.overlap = 0.0;
    }
}

impl Law for RestitutionContact {
    fn advance(&mut self, bodies: &Bodies, start: &Start) -> Advance {
        let overlap = if self.joined { 0.0 } else { (start.striker_displacement - start.structure.displacement).min(0.0) };
        let mut course = Course {
            structure: start.structure,
            striker_displacement: start.striker_displacement,
            striker_velocity: start.striker_velocity,
            overlap,
            left: bodies.time_step,
            impulse: 0.0,
            loss: 0.0,
            damping_work: 0.0,
        };
        let mut bounces = 0;
        while course.left > 0.0 {
            if self.joined {
                self.ride(bodies, start.tangent_stiffness, &mut course);
            } else if self.fly(bodies, start.tangent_stiffness, &mut course, bounces < MOST_BOUNCES) {
                bounces += 1;
            }
        }
        // A pair that parts as the step begins has not touched in it.
        let touched = self.joined || course.impulse > 0.0;
        Advance {
            structure: course.structure,
            striker_displacement: course.striker_displacement,
            striker_velocity: course.striker_velocity,
            state: if touched { StepState::Contact } else { StepState::Free },
            contact_force: course.impulse / bodies.time_step,
            indentation: start.indentation,
            contact_loss: course.loss,
            damping_work: course.damping_work,
            indentation_work: 0.0,
            contacts: bounces,
        }
    }
}
