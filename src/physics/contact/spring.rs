//! A contact of finite stiffness, followed inside a step. In: the force of a law against overlap and its rate, and the state at the start
//! of a step. Out: the contact force of the step. An impact is much shorter than a step and is integrated in parts of its own duration. It
//! knows no law.

use super::{Advance, Approaching, Start};
use crate::contact::state::StepState;
use crate::integrator::step_form::Motion;
use crate::integrator::substep::{Scratch, Striker, Substep};
use crate::structure::matrix::Vector;

/// Parts of an impact. The relative error of the peak force is then about 1e-4; fewer parts change its fourth digit.
const PARTS_OF_AN_IMPACT: f64 = 200.0;
/// Largest number of parts of a step; a step much longer than the impact is then resolved more coarsely.
const MOST_PARTS: f64 = 1e6;
/// Gauss–Legendre on [0, 1], three points: (node, weight).
pub(super) const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Counts how often two surfaces close, part by part.
#[derive(Clone, Copy, Debug)]
struct Closing {
    touching: bool,
    contacts: u32,
}

impl Closing {
    /// From an overlap \[m\].
    const fn new(depth: f64) -> Self {
        Self {
            touching: depth > 0.0,
            contacts: 0,
        }
    }

    /// Adds a part with its mean force \[N\] and the overlap at its end \[m\].
    fn take(&mut self, force: f64, depth: f64) {
        let closed = force > 0.0 || depth > 0.0;
        self.contacts += u32::from(closed && !self.touching);
        // A contact that opened again inside the part has ended.
        self.touching = depth > 0.0;
    }
}

/// A part of a step.
pub struct ContactPart {
    /// Depth at its start \[m\].
    pub from: f64,
    /// Change of the depth without a contact force \[m\].
    travel: f64,
    /// Change of the depth by 1 N \[m/N\].
    yielding: f64,
    /// \[s\]
    pub duration: f64,
}

/// The force of a contact of finite stiffness, never in tension.
pub trait SpringForce {
    /// Force at rest at an overlap \[N\].
    fn elastic(&self, depth: f64) -> f64;

    /// Mean force of a part that ends at the depth `to` \[N\], and its derivative by that \[N/m\]. Neither falls as `to` grows.
    fn mean(&self, part: &ContactPart, to: f64) -> (f64, f64);

    /// Force at an instant \[N\], without the limit.
    fn instant(&self, depth: f64, rate: f64) -> f64;

    /// Duration of an impact of free bodies of this reduced mass \[kg\] and closing speed \[m/s\], in \[s\].
    fn duration(&self, reduced_mass: f64, speed: f64) -> f64;

    /// The force above which the surface is indented \[N\].
    fn force_limit(&self) -> f64 {
        f64::INFINITY
    }

    /// The elastic overlap under the limit force \[m\].
    fn overlap_at_limit(&self) -> f64 {
        f64::INFINITY
    }
}

/// A law of finite stiffness, followed in parts of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringContact<F> {
    law: F,
    /// Duration of a part of a step \[s\].
    part: f64,
}

impl<F: SpringForce> SpringContact<F> {
    /// Resolves the impact of free bodies.
    pub(super) fn new(law: F, impact: Approaching) -> Self {
        let Approaching {
            velocity,
            time_step,
            ..
        } = impact;
        let (reduced_mass, speed) = (impact.reduced_mass(), velocity.abs());
        let duration_of_impact = if speed > 0.0 {
            law.duration(reduced_mass, speed)
        } else {
            time_step
        };
        let part = (duration_of_impact / PARTS_OF_AN_IMPACT).max(time_step / MOST_PARTS);
        Self { law, part }
    }

    /// Mean force of a part: `to = from + travel − yielding·F` and F = mean(to), by Newton's method between bounds.
    /// Both sides are monotone, so that there is one answer.
    fn solve(&self, part: &ContactPart) -> f64 {
        let ContactPart {
            from,
            travel,
            yielding,
            ..
        } = *part;
        let (mut low, mut high) = (0.0, self.law.mean(part, from + travel).0);
        let mut force = high.min(self.law.elastic(from));
        for _ in 0..60 {
            let (mean, slope) = self.law.mean(part, from + travel - yielding * force);
            let residual = force - mean;
            if residual > 0.0 {
                high = force;
            } else {
                low = force;
            }
            let next = force - residual / (1.0 + yielding * slope);
            let next = if next >= low && next <= high {
                next
            } else {
                0.5 * (low + high)
            };
            let change = (next - force).abs();
            force = next;
            if change <= 1e-15 * high {
                break;
            }
        }
        force
    }

    /// Number of parts of a step.
    fn parts(&self, time_step: f64) -> f64 {
        (time_step / self.part).ceil().max(1.0)
    }

    /// Mean force of a part (see `solve`) \[N\], and whether the limit bounds it.
    fn force(&self, part: &ContactPart) -> (f64, bool) {
        let force = self.solve(part);
        if force > self.law.force_limit() {
            (self.law.force_limit(), true)
        } else {
            (force, false)
        }
    }

    /// Permanent indentation by the limit force at an overlap \[m\]: the inelastic part of the overlap.
    fn dent(&self, overlap: f64) -> f64 {
        overlap - self.law.overlap_at_limit()
    }

    /// Force at an instant \[N\].
    fn instant(&self, depth: f64, rate: f64) -> f64 {
        self.law
            .instant(depth, rate)
            .clamp(0.0, self.law.force_limit())
    }

    /// Bounds the mean of forces up to the limit, which rounding may exceed \[N\].
    fn bounded(&self, mean: f64) -> f64 {
        mean.min(self.law.force_limit())
    }

    /// The step in tangent form from the state in `scratch`; its end is written to `to`.
    #[inline]
    pub(crate) fn pass<V: Vector>(
        &self,
        substep: &mut Substep<V>,
        striker: &Striker,
        start: &Start,
        scratch: &mut Scratch<V>,
        to: &mut Motion<V>,
    ) -> Advance {
        match apart(substep, striker, start, scratch, to) {
            Some(advance) => advance,
            None => self.follow(substep, striker, start, scratch, to),
        }
    }

    /// The midpoint rule over parts of the step: it satisfies the energy balance to rounding for any force.
    fn follow<V: Vector>(
        &self,
        substep: &mut Substep<V>,
        striker: &Striker,
        start: &Start,
        scratch: &mut Scratch<V>,
        to: &mut Motion<V>,
    ) -> Advance {
        let Striker {
            struck,
            mass,
            gravity,
            time_step,
        } = *striker;
        let Scratch {
            now: at_start,
            mean,
            response,
        } = scratch;
        let (mut now, mut mean_velocity) = (std::mem::take(*at_start), std::mem::take(*mean));
        let parts = self.parts(time_step);
        let duration = time_step / parts;
        let half = 0.5 * duration;
        substep.prepare(duration, 0.0);
        // M̂⁻¹ e_s: the response of the structure to a force on the struck degree of freedom.
        response.update([], |_, []| 0.0);
        response.as_mut_slice()[struck] = 1.0;
        substep.solve(response);
        let yielding = duration * half * (1.0 / mass + response.as_slice()[struck]);
        let (mut xs, mut vs) = (start.striker_displacement, start.striker_velocity);
        let mut indentation = start.indentation;
        let (mut impulse, mut contact_loss, mut damping_work, mut limited) = (0.0, 0.0, 0.0, false);
        let mut done = 0.0;
        let mut closing = Closing::new(xs - substep.of_struck(&now).0 - indentation);
        while done < parts {
            let depth = xs - substep.of_struck(&now).0 - indentation;
            substep.momentum(&now, half, (done + 0.5) / parts, &mut mean_velocity);
            substep.solve(&mut mean_velocity);
            done += 1.0;
            let falling = vs + half * gravity;
            let (force, over) = self.force(&ContactPart {
                from: depth,
                travel: duration * (falling - mean_velocity.as_slice()[struck]),
                yielding,
                duration,
            });
            limited |= over;
            let mean_striker = falling - half * force / mass;
            let pushed = half * force;
            mean_velocity.update([response], |mean, [response]| mean + pushed * response);
            substep.drift(&mut now, &mean_velocity, duration);
            let striker_moved = duration * mean_striker;
            xs += striker_moved;
            vs = 2.0 * mean_striker - vs;
            impulse += force * duration;
            contact_loss += force * (striker_moved - duration * mean_velocity.as_slice()[struck]);
            damping_work += substep.damped(&mean_velocity, duration);
            let overlap = xs - substep.of_struck(&now).0;
            if over {
                indentation = indentation.max(self.dent(overlap));
            }
            closing.take(force, overlap - indentation);
        }
        let (displacement, velocity) = substep.of_struck(&now);
        let force = self.instant(xs - displacement - indentation, vs - velocity);
        substep.settle(force, &mut now);
        (**at_start, **mean) = (std::mem::replace(to, now), mean_velocity);
        let state = match (limited, impulse > 0.0) {
            (true, _) => StepState::Limit,
            (false, true) => StepState::Contact,
            (false, false) => StepState::Free,
        };
        Advance {
            striker_displacement: xs,
            striker_velocity: vs,
            state,
            contact_force: self.bounded(impulse / time_step),
            indentation,
            contact_loss,
            damping_work,
            indentation_work: if limited {
                self.law.force_limit() * (indentation - start.indentation)
            } else {
                0.0
            },
            contacts: closing.contacts,
        }
    }
}

/// Eq. (5), if the surfaces remain apart.
#[inline]
fn apart<V: Vector>(
    substep: &mut Substep<V>,
    striker: &Striker,
    start: &Start,
    scratch: &Scratch<V>,
    to: &mut Motion<V>,
) -> Option<Advance> {
    let Striker {
        gravity, time_step, ..
    } = *striker;
    if start.displacement + start.indentation - start.striker_displacement < 0.0 {
        return None;
    }
    substep.follow(scratch.now, [time_step, 1.0], None, to);
    let striker_velocity = start.striker_velocity + gravity * time_step;
    let striker_displacement =
        start.striker_displacement + 0.5 * time_step * (start.striker_velocity + striker_velocity);
    if substep.of_struck(to).0 + start.indentation - striker_displacement < 0.0 {
        return None;
    }
    Some(Advance {
        striker_displacement,
        striker_velocity,
        state: StepState::Free,
        contact_force: 0.0,
        indentation: start.indentation,
        contact_loss: 0.0,
        damping_work: substep.damped_between(scratch.now, to, time_step),
        indentation_work: 0.0,
        contacts: 0,
    })
}
