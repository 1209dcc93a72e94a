//! What follows from the parameters of a model: its stiffnesses, its capacity, its masses. In: a [`Behaviour`]. Out: numbers in SI. It
//! has no state.

use super::{Behaviour, Breaks, Pinching};
use crate::relaxation::logarithmic::LogarithmicRelaxation;
use crate::structure::beam::{self, EquivalentMasses};
use crate::structure::portal::Portal;
use crate::structure::portal::mass;

impl Behaviour {
    /// Whether the force is the stiffness times the displacement at any displacement.
    #[must_use]
    pub const fn is_elastic(&self) -> bool {
        matches!(self, Self::Elastic { .. } | Self::Beam(_))
    }

    /// Initial stiffness without relaxation \[N/m\]; for a joint with clearance and no friction, that in bearing.
    #[must_use]
    pub fn initial_stiffness(&self) -> f64 {
        match self {
            Self::Elastic { stiffness }
            | Self::Bilinear { stiffness, .. }
            | Self::DeterioratingBilinear { stiffness, .. }
            | Self::BoucWen { stiffness, .. }
            | Self::Degrading { stiffness, .. } => *stiffness,
            Self::Beam(beam) => beam.stiffness,
            Self::Multilinear { corners } => corners.first().map_or(0.0, |[x, force]| force / x),
            Self::Pinching(pinching) => pinching.stiffness,
            Self::Bolted(bolted) if bolted.clearance == 0.0 && bolted.slip_force > 0.0 => {
                2.0 * bolted.stiffness
            }
            Self::Bolted(bolted) => bolted.stiffness,
            Self::Table(table) => table.initial_stiffness(),
            Self::Portal(portal) => portal.stiffness,
            Self::Fracture { .. }
            | Self::Rate { .. }
            | Self::Logarithmic { .. }
            | Self::Maxwell { .. }
            | Self::Series(_)
            | Self::Parallel(_) => self.stiffness_of_parts(Self::initial_stiffness),
        }
    }

    /// Largest slope dR/dX on any path \[N/m\], which determines stability. Most behaviours are stiffest at first; a joint that bears
    /// before its faces slip is twice as stiff, a Bouc–Wen spring unloads at up to 2β of its hysteretic part, and measured points have the
    /// slope of their steepest segment. None for a slope without a bound, which states no stability limit.
    #[must_use]
    pub fn largest_stiffness(&self) -> Option<f64> {
        Some(self.steepest_slope()).filter(|slope| slope.is_finite())
    }

    /// Largest slope dR/dX on any path \[N/m\]; infinite without a bound.
    fn steepest_slope(&self) -> f64 {
        match self {
            Self::BoucWen {
                stiffness,
                post_yield_ratio,
                beta,
                ..
            } => stiffness * (post_yield_ratio + (1.0 - post_yield_ratio) * (2.0 * beta).max(1.0)),
            Self::Bolted(bolted) if bolted.slip_force > 0.0 => 2.0 * bolted.stiffness,
            Self::Table(table) => table.steepest(|_| true),
            Self::Fracture { .. }
            | Self::Rate { .. }
            | Self::Logarithmic { .. }
            | Self::Maxwell { .. }
            | Self::Series(_)
            | Self::Parallel(_) => self.stiffness_of_parts(Self::steepest_slope),
            Self::Elastic { .. }
            | Self::Bilinear { .. }
            | Self::DeterioratingBilinear { .. }
            | Self::Beam(_)
            | Self::Multilinear { .. }
            | Self::Pinching(_)
            | Self::Degrading { .. }
            | Self::Bolted(_)
            | Self::Portal(_) => self.initial_stiffness(),
        }
    }

    /// Stiffness of a combination \[N/m\], from `of` each part: in series the flexibilities add, in parallel the stiffnesses, with that of
    /// a Maxwell branch.
    fn stiffness_of_parts(&self, of: fn(&Self) -> f64) -> f64 {
        let parts = self.parts().iter().map(of);
        match self {
            Self::Series(_) => 1.0 / parts.map(|stiffness| 1.0 / stiffness).sum::<f64>(),
            Self::Maxwell { stiffness, .. } => parts.sum::<f64>() + stiffness,
            _ => parts.sum(),
        }
    }

    /// Initial stiffness after complete relaxation \[N/m\], as measured by a slow test.
    #[must_use]
    pub fn relaxed_stiffness(&self) -> f64 {
        match self {
            Self::Maxwell { of, .. } => of.relaxed_stiffness(),
            Self::Logarithmic { of, .. } => of.relaxed_stiffness() * (1.0 - self.lost_after_long()),
            other => other.initial_stiffness(),
        }
    }

    /// The fraction of an instantaneous force that logarithmic relaxation takes in the end.
    fn lost_after_long(&self) -> f64 {
        match self {
            Self::Logarithmic {
                share,
                reference_time,
                longest,
                ..
            } => LogarithmicRelaxation {
                share: *share,
                reference_time: *reference_time,
                longest: *longest,
            }
            .lost_after_long(),
            _ => 0.0,
        }
    }

    /// The behaviours that it combines.
    #[must_use]
    pub fn parts(&self) -> &[Behaviour] {
        match self {
            Self::Series(parts) | Self::Parallel(parts) => parts,
            Self::Fracture { of, .. }
            | Self::Rate { of, .. }
            | Self::Maxwell { of, .. }
            | Self::Logarithmic { of, .. } => std::slice::from_ref(of),
            _ => &[],
        }
    }

    /// Capacity, the largest force \[N\]; infinite where unbounded, None where only its file determines it.
    #[must_use]
    pub fn capacity(&self) -> f64 {
        let hardens = |post_yield_ratio: f64, force: f64| {
            if post_yield_ratio > 0.0 {
                f64::INFINITY
            } else {
                force
            }
        };
        match self {
            // However fast it is moved, a branch resists.
            Self::Elastic { .. } | Self::Beam(_) | Self::Maxwell { .. } => f64::INFINITY,
            Self::Bilinear {
                yield_force,
                post_yield_ratio,
                ..
            }
            | Self::DeterioratingBilinear {
                yield_force,
                post_yield_ratio,
                ..
            }
            | Self::BoucWen {
                yield_force,
                post_yield_ratio,
                ..
            } => hardens(*post_yield_ratio, *yield_force),
            Self::Pinching(Pinching {
                stiffness,
                yield_force,
                post_yield_ratio,
                capping: Some(capping),
                ..
            }) => {
                yield_force
                    + post_yield_ratio
                        * stiffness
                        * (capping.displacement - yield_force / stiffness)
            }
            Self::Pinching(pinching) => hardens(pinching.post_yield_ratio, pinching.yield_force),
            Self::Multilinear { corners } => match corners.as_slice() {
                [.., [_, before], [_, last]] if before == last => *last,
                _ => f64::INFINITY,
            },
            Self::Degrading {
                stiffness,
                half_displacement,
                residual,
            } => hardens(*residual, stiffness * half_displacement),
            Self::Bolted(bolted) => bolted.bearing_force + bolted.slip_force,
            Self::Table(table) => {
                table
                    .points
                    .iter()
                    .fold(0.0, |most: f64, [_, force]| most.max(force.abs()))
                    * table.scale
            }
            Self::Fracture {
                of,
                at: Breaks::Force(force),
            } => of.capacity().min(*force),
            Self::Fracture { of, .. } | Self::Rate { of, .. } => of.capacity(),
            // The loss in one direction increases the force in the other direction.
            Self::Logarithmic { of, .. } => of.capacity() * (1.0 + self.lost_after_long()),
            Self::Series(parts) => parts
                .iter()
                .map(Self::capacity)
                .fold(f64::INFINITY, f64::min),
            Self::Parallel(parts) => parts.iter().map(Self::capacity).sum(),
            Self::Portal(portal) => portal.capacity(),
        }
    }

    /// Equivalent masses by its geometry; the parts around a beam or portal have its displacement.
    #[must_use]
    pub fn equivalent_masses(&self) -> Option<EquivalentMasses> {
        match self {
            Self::Beam(beam) => beam::equivalent_masses(beam),
            Self::Portal(portal) => mass::equivalent_masses(portal),
            Self::Fracture { of, .. }
            | Self::Rate { of, .. }
            | Self::Maxwell { of, .. }
            | Self::Logarithmic { of, .. } => of.equivalent_masses(),
            _ => None,
        }
    }

    /// The portal, also inside of parts with the same displacement.
    #[must_use]
    pub fn portal(&self) -> Option<&Portal> {
        match self {
            Self::Portal(portal) => Some(portal),
            Self::Fracture { of, .. }
            | Self::Rate { of, .. }
            | Self::Maxwell { of, .. }
            | Self::Logarithmic { of, .. } => of.portal(),
            _ => None,
        }
    }

    /// The same with every force times `factor`: it yields and fractures at the same displacements.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let all = |parts: &[Self]| parts.iter().map(|part| part.scaled(factor)).collect();
        let mut same = self.clone();
        match &mut same {
            Self::Elastic { stiffness } | Self::Degrading { stiffness, .. } => *stiffness *= factor,
            Self::Bilinear {
                stiffness,
                yield_force,
                ..
            }
            | Self::DeterioratingBilinear {
                stiffness,
                yield_force,
                ..
            }
            | Self::BoucWen {
                stiffness,
                yield_force,
                ..
            } => {
                *stiffness *= factor;
                *yield_force *= factor;
            }
            // No longer the beam or portal of that geometry.
            Self::Beam(beam) => {
                return Self::Elastic {
                    stiffness: beam.stiffness * factor,
                };
            }
            Self::Portal(portal) => {
                let (stiffness, yield_force) =
                    (portal.stiffness * factor, portal.capacity() * factor);
                return Self::Bilinear {
                    stiffness,
                    yield_force,
                    post_yield_ratio: 0.0,
                };
            }
            Self::Multilinear { corners } => {
                for [_, force] in corners {
                    *force *= factor;
                }
            }
            Self::Pinching(pinching) => {
                pinching.stiffness *= factor;
                pinching.yield_force *= factor;
            }
            Self::Bolted(bolted) => {
                bolted.stiffness *= factor;
                bolted.bearing_force *= factor;
                bolted.slip_force *= factor;
            }
            Self::Table(table) => table.scale *= factor,
            Self::Fracture { of, at } => {
                **of = of.scaled(factor);
                if let Breaks::Force(force) = at {
                    *force *= factor;
                }
            }
            Self::Rate { of, .. } | Self::Logarithmic { of, .. } => **of = of.scaled(factor),
            Self::Maxwell { of, stiffness, .. } => {
                **of = of.scaled(factor);
                *stiffness *= factor;
            }
            Self::Series(parts) | Self::Parallel(parts) => *parts = all(parts),
        }
        same
    }

    /// Whether its force never falls while its displacement grows, as a part in series must.
    #[must_use]
    pub fn never_falls(&self) -> bool {
        match self {
            Self::Fracture { .. }
            | Self::Pinching(Pinching {
                capping: Some(_), ..
            }) => false,
            Self::Table(table) => table.points.windows(2).all(|pair| pair[1][1] >= pair[0][1]),
            Self::Elastic { .. }
            | Self::Bilinear { .. }
            | Self::DeterioratingBilinear { .. }
            | Self::BoucWen { .. }
            | Self::Degrading { .. }
            | Self::Beam(_)
            | Self::Multilinear { .. }
            | Self::Pinching(_)
            | Self::Bolted(_)
            | Self::Portal(_) => true,
            Self::Rate { .. }
            | Self::Logarithmic { .. }
            | Self::Maxwell { .. }
            | Self::Series(_)
            | Self::Parallel(_) => self.parts().iter().all(Self::never_falls),
        }
    }
}
