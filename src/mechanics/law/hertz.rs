//! Contact of finite stiffness: Hunt–Crossley's F = k δ^1.5 (1 + loss·δ̇), never pulling, with an optional limit force
//! past which the surface is dented. A blow is much shorter than a step and is followed in parts of its own length.

use super::{Advance, Bodies, Law, Start};
use crate::mechanics::contact::StepState;
use crate::mechanics::integrator::Motion;

/// Parts of a blow. The peak force is then good to about 1e-4; fewer, and it shows in the fourth digit.
const PARTS_OF_A_BLOW: f64 = 200.0;
/// Parts of a step at most; a step of many blows' length is then resolved more coarsely.
const MOST_PARTS: f64 = 1e6;
/// Gauss–Legendre on [0, 1], three points: (place, weight).
const GAUSS: [(f64, f64); 3] = [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Counts how often two surfaces close, part by part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closing {
    touching: bool,
    pub contacts: u32,
}

impl Closing {
    /// From an overlap, m.
    pub const fn new(depth: f64) -> Self {
        Self { touching: depth > 0.0, contacts: 0 }
    }

    /// Takes a part with its mean force (N) and the overlap at its end (m).
    pub fn take(&mut self, force: f64, depth: f64) {
        let closed = force > 0.0 || depth > 0.0;
        self.contacts += u32::from(closed && !self.touching);
        // One that opened again inside the part is over.
        self.touching = depth > 0.0;
    }
}

/// A blow that takes time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzContact {
    /// k, N/m^1.5
    stiffness: f64,
    /// s/m
    loss: f64,
    /// N; infinite if none.
    force_limit: f64,
    /// Length of a part of a step, s.
    part: f64,
}

impl HertzContact {
    /// Resolves the blow that `approach_velocity` makes between the free bodies (duration 2.943 `δ_max/u`).
    #[must_use]
    pub fn new(stiffness: f64, loss: f64, force_limit: Option<f64>, bodies: &Bodies, approach_velocity: f64) -> Self {
        let reduced_mass = bodies.mass * bodies.striker_mass / (bodies.mass + bodies.striker_mass);
        let speed = approach_velocity.abs();
        let deepest = (1.25 * reduced_mass * speed * speed / stiffness).powf(0.4);
        let blow = if speed > 0.0 { 2.943 * deepest / speed } else { bodies.time_step };
        let part = (blow / PARTS_OF_A_BLOW).max(bodies.time_step / MOST_PARTS);
        Self { stiffness, loss, force_limit: force_limit.unwrap_or(f64::INFINITY), part }
    }

    fn elastic(&self, depth: f64) -> f64 {
        if depth > 0.0 { self.stiffness * depth * depth.sqrt() } else { 0.0 }
    }

    /// Mean force over a way from one depth to another, and its slope against the second.
    fn mean(&self, from: f64, to: f64, duration: f64) -> (f64, f64) {
        let (mut force, mut slope) = (0.0, 0.0);
        for (place, weight) in GAUSS {
            let depth = from + place * (to - from);
            if depth > 0.0 {
                force += weight * self.elastic(depth);
                slope += weight * place * 1.5 * self.stiffness * depth.sqrt();
            }
        }
        let factor = 1.0 + self.loss * (to - from) / duration;
        if factor <= 0.0 { (0.0, 0.0) } else { (force * factor, slope * factor + force * self.loss / duration) }
    }

    /// Mean force of a part: `to = from + way − yielding·F` and F = mean(from, to), by Newton's method between bounds.
    /// Both sides are monotone, so that there is one answer.
    fn solve(&self, from: f64, way: f64, yielding: f64, duration: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.mean(from, from + way, duration).0);
        let mut force = high.min(self.elastic(from));
        for _ in 0..60 {
            let (mean, slope) = self.mean(from, from + way - yielding * force, duration);
            let residual = force - mean;
            if residual > 0.0 {
                high = force;
            } else {
                low = force;
            }
            let next = force - residual / (1.0 + yielding * slope);
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            let change = (next - force).abs();
            force = next;
            if change <= 1e-15 * high {
                break;
            }
        }
        force
    }

    /// Parts of a step in which the blow is followed.
    pub(crate) fn parts(&self, time_step: f64) -> f64 {
        (time_step / self.part).ceil().max(1.0)
    }

    /// Mean force of a part (as `solve` has it), N, and whether it is the limit that bounds it.
    pub(crate) fn force(&self, from: f64, way: f64, yielding: f64, duration: f64) -> (f64, bool) {
        let force = self.solve(from, way, yielding, duration);
        if force > self.force_limit { (self.force_limit, true) } else { (force, false) }
    }

    /// The dent that the limit force leaves of an overlap, m: what the surface cannot hold elastically.
    pub(crate) fn dent(&self, overlap: f64) -> f64 {
        overlap - (self.force_limit / self.stiffness).powf(2.0 / 3.0)
    }

    /// Force of an instant, N.
    pub(crate) fn instant(&self, depth: f64, rate: f64) -> f64 {
        (self.elastic(depth) * (1.0 + self.loss * rate)).clamp(0.0, self.force_limit)
    }

    /// A mean of forces up to the limit is not above it by a rounding either, N.
    pub(crate) const fn bounded(&self, mean: f64) -> f64 {
        mean.min(self.force_limit)
    }

    /// The midpoint rule over parts of the step: it keeps the energy balance to rounding whatever the force is.
    fn follow(&self, bodies: &Bodies, start: &Start) -> Advance {
        let Bodies { mass, damping, striker_mass, gravity, time_step } = *bodies;
        let tangent = start.tangent_stiffness;
        let parts = self.parts(time_step);
        let duration = time_step / parts;
        let half = 0.5 * duration;
        let inertia = mass + half * (damping + half * tangent);
        let yielding = duration * half * (1.0 / striker_mass + 1.0 / inertia);
        let mut structure = start.structure;
        let (mut xs, mut vs) = (start.striker_displacement, start.striker_velocity);
        let mut indentation = start.indentation;
        let (mut impulse, mut contact_loss, mut damping_work, mut limited) = (0.0, 0.0, 0.0, false);
        let mut done = 0.0;
        let mut closing = Closing::new(xs - structure.displacement - indentation);
        while done < parts {
            done += 1.0;
            let depth = xs - structure.displacement - indentation;
            let unpushed = (mass * structure.velocity - half * structure.restoring_force) / inertia;
            let falling = vs + half * gravity;
            let way = duration * (falling - unpushed);
            let (force, over) = self.force(depth, way, yielding, duration);
            limited |= over;
            let mean_velocity = unpushed + half * force / inertia;
            let mean_striker = falling - half * force / striker_mass;
            let (moved, striker_moved) = (duration * mean_velocity, duration * mean_striker);
            structure.displacement += moved;
            structure.velocity = 2.0 * mean_velocity - structure.velocity;
            structure.restoring_force += tangent * moved;
            xs += striker_moved;
            vs = 2.0 * mean_striker - vs;
            impulse += force * duration;
            contact_loss += force * (striker_moved - moved);
            damping_work += damping * mean_velocity * moved;
            if over {
                indentation = indentation.max(self.dent(xs - structure.displacement));
            }
            closing.take(force, xs - structure.displacement - indentation);
        }
        let depth = xs - structure.displacement - indentation;
        let rate = vs - structure.velocity;
        let force = self.instant(depth, rate);
        structure.acceleration = (force - damping * structure.velocity - structure.restoring_force) / mass;
        let state = match (limited, impulse > 0.0) {
            (true, _) => StepState::Limit,
            (false, true) => StepState::Contact,
            (false, false) => StepState::Free,
        };
        Advance {
            structure,
            striker_displacement: xs,
            striker_velocity: vs,
            state,
            contact_force: self.bounded(impulse / time_step),
            indentation,
            contact_loss,
            damping_work,
            indentation_work: if limited { self.force_limit * (indentation - start.indentation) } else { 0.0 },
            contacts: closing.contacts,
        }
    }

    /// Eq. (5), if the surfaces stay apart.
    fn apart(bodies: &Bodies, start: &Start) -> Option<Advance> {
        let gap = |structure: &Motion, striker: f64| structure.displacement + start.indentation - striker;
        let from = start.structure;
        if gap(&from, start.striker_displacement) < 0.0 {
            return None;
        }
        let to = from.free(bodies.mass, bodies.damping, start.tangent_stiffness, bodies.time_step);
        let striker_velocity = start.striker_velocity + bodies.gravity * bodies.time_step;
        let striker = start.striker_displacement + 0.5 * bodies.time_step * (start.striker_velocity + striker_velocity);
        if gap(&to, striker) < 0.0 {
            return None;
        }
        let moved = to.displacement - from.displacement;
        Some(Advance {
            structure: to,
            striker_displacement: striker,
            striker_velocity,
            state: StepState::Free,
            contact_force: 0.0,
            indentation: start.indentation,
            contact_loss: 0.0,
            damping_work: 0.5 * bodies.damping * (from.velocity + to.velocity) * moved,
            indentation_work: 0.0,
            contacts: 0,
        })
    }
}

impl Law for HertzContact {
    fn advance(&mut self, bodies: &Bodies, start: &Start) -> Advance {
        Self::apart(bodies, start).unwrap_or_else(|| self.follow(bodies, start))
    }
}
