//! What takes structure and striker over a step in two halves: a place to impose before the force is known, the end of
//! the step after it. A contact law in tangent form knows all but the force beforehand; explicit Newmark and α-OS decide
//! on the contact once the force is read.

use super::contact::ContactLaw;
use super::impact::ImpactInput;
use super::law::{Advance, AnyContact, Bodies, Law, Start};
use super::split::Split;
use crate::plan::Integrator;

/// One way to integrate an impact.
pub trait Scheme {
    /// What is known of a step before its force is read.
    type Prediction: Clone + std::fmt::Debug;

    fn predict(&mut self, bodies: &Bodies, start: &Start) -> Self::Prediction;

    /// The place to impose, m.
    fn target(&self, prediction: &Self::Prediction) -> f64;

    /// Velocity foretold for the end of the step, m/s.
    fn velocity(&self, bodies: &Bodies, start: &Start, prediction: &Self::Prediction) -> f64;

    /// Whether a contact force has its share in that velocity: its change since the step before is then no trend to go by.
    fn struck(&self, start: &Start, prediction: &Self::Prediction) -> bool;

    /// The end of the step; `force` (N) is what the recursion takes for the one at the target. The structure's restoring
    /// force at its end is that at the computed displacement.
    fn complete(&mut self, bodies: &Bodies, start: &Start, prediction: &Self::Prediction, force: f64) -> Advance;
}

impl<L: Law> Scheme for L {
    type Prediction = Advance;

    #[inline]
    fn predict(&mut self, bodies: &Bodies, start: &Start) -> Advance {
        self.advance(bodies, start)
    }

    #[inline]
    fn target(&self, prediction: &Advance) -> f64 {
        prediction.structure.displacement
    }

    fn velocity(&self, _: &Bodies, _: &Start, prediction: &Advance) -> f64 {
        prediction.structure.velocity
    }

    fn struck(&self, start: &Start, prediction: &Advance) -> bool {
        start.contact_force > 0.0 || prediction.contact_force > 0.0
    }

    #[inline]
    fn complete(&mut self, _: &Bodies, _: &Start, prediction: &Advance, force: f64) -> Advance {
        at_the_force(*prediction, force)
    }
}

impl Scheme for Split {
    type Prediction = f64;

    #[inline]
    fn predict(&mut self, bodies: &Bodies, start: &Start) -> f64 {
        Self::predict(self, bodies, start)
    }

    #[inline]
    fn target(&self, prediction: &f64) -> f64 {
        *prediction
    }

    fn velocity(&self, bodies: &Bodies, start: &Start, _: &f64) -> f64 {
        self.foretold_velocity(bodies, start)
    }

    fn struck(&self, start: &Start, _: &f64) -> bool {
        start.contact_force > 0.0
    }

    #[inline]
    fn complete(&mut self, bodies: &Bodies, start: &Start, prediction: &f64, force: f64) -> Advance {
        Self::complete(self, bodies, start, *prediction, force)
    }
}

/// The scheme of a plan, chosen once a step.
#[derive(Clone, Debug)]
pub enum AnyScheme {
    Tangent(AnyContact),
    Split(Split),
}

/// What is known beforehand under either.
#[derive(Clone, Copy, Debug)]
pub enum AnyPrediction {
    Tangent(Advance),
    /// Who goes on with it, and the place, m.
    Split(Split, f64),
}

impl AnyScheme {
    /// `check` lets only laws of impulses, rigid and limit, meet an integrator that imposes before it solves.
    #[must_use]
    pub fn new(input: &ImpactInput) -> Self {
        match (input.integrator, input.law) {
            (Integrator::Tangent, law) => Self::Tangent(AnyContact::new(law, &input.bodies(), input.striker_velocity)),
            (integrator, ContactLaw::Limit { force }) => Self::Split(Split::new(integrator, input.operator_stiffness, force)),
            (integrator, _) => Self::Split(Split::new(integrator, input.operator_stiffness, f64::INFINITY)),
        }
    }
}

impl Scheme for AnyScheme {
    type Prediction = AnyPrediction;

    fn predict(&mut self, bodies: &Bodies, start: &Start) -> AnyPrediction {
        match self {
            Self::Tangent(law) => AnyPrediction::Tangent(law.advance(bodies, start)),
            Self::Split(split) => AnyPrediction::Split(*split, split.predict(bodies, start)),
        }
    }

    fn target(&self, prediction: &AnyPrediction) -> f64 {
        match prediction {
            AnyPrediction::Tangent(advance) => advance.structure.displacement,
            AnyPrediction::Split(_, target) => *target,
        }
    }

    fn velocity(&self, bodies: &Bodies, start: &Start, prediction: &AnyPrediction) -> f64 {
        match prediction {
            AnyPrediction::Tangent(advance) => advance.structure.velocity,
            AnyPrediction::Split(split, target) => split.velocity(bodies, start, target),
        }
    }

    fn struck(&self, start: &Start, prediction: &AnyPrediction) -> bool {
        match prediction {
            AnyPrediction::Tangent(advance) => start.contact_force > 0.0 || advance.contact_force > 0.0,
            AnyPrediction::Split(split, target) => split.struck(start, target),
        }
    }

    fn complete(&mut self, bodies: &Bodies, start: &Start, prediction: &AnyPrediction, force: f64) -> Advance {
        match prediction {
            AnyPrediction::Tangent(advance) => at_the_force(*advance, force),
            AnyPrediction::Split(split, target) => split.complete(bodies, start, *target, force),
        }
    }
}

/// A step in tangent form is what it was foretold to be, but for the force that it ends with.
#[inline]
const fn at_the_force(mut advance: Advance, force: f64) -> Advance {
    advance.structure.restoring_force = force;
    advance
}
