//! Impacts of restitution on one floor of a frame, each at its own instant inside the step, as `law::RestitutionContact`
//! does it with one degree of freedom; where bounces die out the striker goes on with the floor until the contact would
//! have to pull. In: a frame at a step's start. Out: frame and striker at its end.
//!
//! An impulse p on the floor s changes the velocities by M⁻¹e_s p, so that a blow meets the mass 1/(e_sᵀM⁻¹e_s) of that
//! floor, whatever is below and above it.

use super::passage::{Passage, Passed, Start, Striker};
use super::schemes::Course;
use crate::mechanics::contact::StepState;
use crate::mechanics::law::{Collision, MOST_BOUNCES, locate};

/// Separation speed = `coefficient` × closing speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Restitution {
    pub coefficient: f64,
    /// Striker and floor move as one.
    pub joined: bool,
}

/// Frame and striker while a step is under way.
struct Way<'a, 'b> {
    passage: &'a mut Passage<'b>,
    striker: Striker,
    structure: Course,
    ahead: Course,
    striker_displacement: f64,
    striker_velocity: f64,
    /// Xs − X, at most 0; the very 0 after an impact.
    overlap: f64,
    left: f64,
    impulse: f64,
    loss: f64,
    damping_work: f64,
}

impl Way<'_, '_> {
    fn time_step(&self) -> f64 {
        self.passage.frame.time_step
    }

    /// The part of the step that is over `duration` from here.
    fn part_after(&self, duration: f64) -> f64 {
        1.0 - (self.left - duration) / self.time_step()
    }

    /// Looks `duration` ahead, with the striker on the floor or without.
    fn look(&mut self, duration: f64, joined: bool) {
        let part = self.part_after(duration);
        let Striker { struck, mass, gravity } = self.striker;
        let with = joined.then_some((struck, mass, mass * gravity));
        self.passage.follow(&self.structure, duration, part, with, &mut self.ahead);
    }

    /// Goes on for `duration` to where it looked.
    fn go(&mut self, striker_velocity: f64, duration: f64) {
        let struck = self.striker.struck;
        let moved = self.ahead.displacement[struck] - self.structure.displacement[struck];
        let striker_moved = 0.5 * duration * (self.striker_velocity + striker_velocity);
        let velocities = self.structure.velocity.iter().zip(&self.ahead.velocity);
        let mean: Vec<f64> = velocities.map(|(from, to)| 0.5 * (from + to)).collect();
        self.damping_work += self.passage.damped(&mean, duration);
        std::mem::swap(&mut self.structure, &mut self.ahead);
        self.striker_displacement += striker_moved;
        self.striker_velocity = striker_velocity;
        self.overlap = (self.overlap + striker_moved - moved).min(0.0);
        self.left -= duration;
    }

    /// Momentum p passes from striker to floor; what the dampers add to M Ẍ comes with it.
    fn strike(&mut self, impulse: f64) {
        let change: Vec<f64> = self.passage.push.iter().map(|push| impulse * push).collect();
        for (velocity, change) in self.structure.velocity.iter_mut().zip(&change) {
            *velocity += change;
        }
        if self.passage.frame.is_damped() {
            let mut braked = vec![0.0; change.len()];
            self.passage.frame.matrices.damping.mul_add(-1.0, &change, &mut braked);
            self.passage.accelerate(&mut braked);
            for (acceleration, braked) in self.structure.acceleration.iter_mut().zip(&braked) {
                *acceleration += braked;
            }
        }
        self.striker_velocity -= impulse / self.striker.mass;
        self.impulse += impulse;
    }

    /// A contact force comes or goes: M Ẍ changes by it on the struck floor.
    fn press(&mut self, force: f64) {
        for (acceleration, push) in self.structure.acceleration.iter_mut().zip(&self.passage.push) {
            *acceleration += force * push;
        }
    }
}

impl Restitution {
    /// The step from `from`, whose end goes into `to`.
    pub fn pass(&mut self, passage: &mut Passage, striker: Striker, start: &Start, from: Course, to: &mut Course) -> Passed {
        let time_step = passage.frame.time_step;
        let overlap = if self.joined { 0.0 } else { (start.striker_displacement - start.displacement).min(0.0) };
        let mut way = Way {
            passage,
            striker,
            ahead: from.clone(),
            structure: from,
            striker_displacement: start.striker_displacement,
            striker_velocity: start.striker_velocity,
            overlap,
            left: time_step,
            impulse: 0.0,
            loss: 0.0,
            damping_work: 0.0,
        };
        let mut bounces = 0;
        while way.left > 0.0 {
            if self.joined {
                self.ride(&mut way);
            } else if self.fly(&mut way, bounces < MOST_BOUNCES) {
                bounces += 1;
            }
        }
        // A pair that parts as the step begins has not touched in it.
        let touched = self.joined || way.impulse > 0.0;
        let passed = Passed {
            structure: (),
            striker_displacement: way.striker_displacement,
            striker_velocity: way.striker_velocity,
            state: if touched { StepState::Contact } else { StepState::Free },
            contact_force: way.impulse / time_step,
            indentation: start.indentation,
            contact_loss: way.loss,
            damping_work: way.damping_work,
            indentation_work: 0.0,
            contacts: bounces,
        };
        *to = way.structure;
        passed
    }

    /// Both apart, to the next impact or to the end of the step. True if there was an impact.
    fn fly(&mut self, way: &mut Way, may_bounce: bool) -> bool {
        let Striker { struck, gravity, .. } = way.striker;
        let (overlap, striker_velocity, left) = (way.overlap, way.striker_velocity, way.left);
        let velocity = way.structure.velocity[struck];
        if overlap != 0.0 || striker_velocity <= velocity {
            // Xs − X > 0 divided by the time flown, so that the touch at the start of a flight is no root of it.
            let mut closed = |duration: f64| {
                way.look(duration, false);
                let flown = striker_velocity + 0.5 * gravity * duration;
                overlap / duration + flown - 0.5 * (velocity + way.ahead.velocity[struck]) > 0.0
            };
            let hit = closed(left);
            let duration = if hit { locate(left, closed) } else { left };
            // The last look of a search is not always at the place that it found.
            way.look(duration, false);
            way.go(striker_velocity + gravity * duration, duration);
            if !hit {
                return false;
            }
            way.overlap = 0.0;
        }
        // The chord met the striker but the floor speeds away from it: they graze, and nothing passes.
        if way.striker_velocity < way.structure.velocity[struck] {
            return false;
        }
        self.collide(way, may_bounce);
        true
    }

    /// An impact: striker and floor part with what restitution leaves them, or go on as one.
    fn collide(&mut self, way: &mut Way, may_bounce: bool) {
        let Striker { struck, mass, gravity } = way.striker;
        let floor = way.passage.struck_mass(struck);
        let closing = way.striker_velocity - way.structure.velocity[struck];
        let collision = Collision::new(self.coefficient, floor, mass, closing);
        way.strike(collision.impulse());
        way.loss += collision.loss();

        // The striker falls with g alone: the floor's deceleration, and its own fall, bring them together again.
        let deceleration = gravity - way.structure.acceleration[struck];
        if collision.dies_out(deceleration, way.time_step()) || !may_bounce {
            let (impulse, loss) = collision.joining();
            way.strike(impulse);
            way.loss += loss;
            way.striker_velocity = way.structure.velocity[struck];
            // F = Ms(g − Ẍ) with Ẍ = Ẍ_free + F/m of the struck floor.
            let free = way.structure.acceleration[struck];
            way.press(collision.reduced_mass * (gravity - free));
            self.joined = true;
        }
    }

    /// Striker and floor as one, to the end of the step or to the instant the contact would pull.
    fn ride(&mut self, way: &mut Way) {
        let Striker { struck, mass, gravity } = way.striker;
        let (left, velocity) = (way.left, way.structure.velocity[struck]);
        // F = Ms(g − Ẍ): it pulls where the pair speeds up by more than g.
        let mut pulls = |duration: f64| {
            way.look(duration, true);
            way.ahead.acceleration[struck] > gravity
        };
        let parted = pulls(left);
        let duration = if parted { locate(left, pulls) } else { left };
        way.look(duration, true);
        let to = way.ahead.velocity[struck];
        way.impulse += mass * (gravity * duration + velocity - to);
        way.go(to, duration);
        way.overlap = 0.0;
        if parted {
            let pull = mass * (way.structure.acceleration[struck] - gravity);
            way.press(pull);
            self.joined = false;
        }
    }
}
