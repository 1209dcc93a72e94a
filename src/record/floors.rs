//! What a frame did, floor by floor: the storeys of a step whatever moved them, and the impact on one of them. In: numbers
//! of a run, SI. It computes no motion.

use super::{ImpactHistory, Modes};
use crate::mechanics::frame::{drifts, shears};
use crate::mechanics::monitor::Tracking;

/// A step of a frame, its floors from the ground up.
pub trait Floors {
    /// Virtual time, s.
    fn time(&self) -> f64;

    /// Computed displacement of each floor, m.
    fn computed(&self) -> &[f64];

    /// Measured restoring force of each floor, N.
    fn restoring_force(&self) -> &[f64];

    /// Target of each floor, m.
    fn command(&self) -> &[f64];

    /// Measured displacement of each floor, m.
    fn measured(&self) -> &[f64];

    /// What following each floor has come to.
    fn tracking(&self) -> &[Tracking];

    /// Drift of each storey, m, of the computed displacements.
    #[must_use]
    fn drift(&self) -> Vec<f64> {
        let mut drift = vec![0.0; self.computed().len()];
        drifts(self.computed(), &mut drift);
        drift
    }

    /// Shear of each storey, N: the forces of the floors it carries; the first is the base shear.
    #[must_use]
    fn shear(&self) -> Vec<f64> {
        let mut shear = vec![0.0; self.restoring_force().len()];
        shears(self.restoring_force(), &mut shear);
        shear
    }
}

impl<F: Floors> Floors for &F {
    fn time(&self) -> f64 {
        F::time(self)
    }

    fn computed(&self) -> &[f64] {
        F::computed(self)
    }

    fn restoring_force(&self) -> &[f64] {
        F::restoring_force(self)
    }

    fn command(&self) -> &[f64] {
        F::command(self)
    }

    fn measured(&self) -> &[f64] {
        F::measured(self)
    }

    fn tracking(&self) -> &[Tracking] {
        F::tracking(self)
    }
}

/// All floors of one step of an impact on a storey; step, striker and contact stand beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorStep {
    /// Virtual time, s.
    pub time: f64,
    /// Targets, m.
    pub command: Vec<f64>,
    /// Measured, m.
    pub displacement: Vec<f64>,
    /// Computed X, m: the target, but under α-OS.
    pub computed: Vec<f64>,
    /// m/s
    pub velocity: Vec<f64>,
    /// m/s²
    pub acceleration: Vec<f64>,
    /// Measured, of each floor, N.
    pub restoring_force: Vec<f64>,
    /// ∫ shear d(drift) of each storey so far, J: together the energy of the restoring forces.
    pub storey_energy: Vec<f64>,
    /// Of each axis.
    pub tracking: Vec<Tracking>,
}

impl Floors for FloorStep {
    fn time(&self) -> f64 {
        self.time
    }

    fn computed(&self) -> &[f64] {
        &self.computed
    }

    fn restoring_force(&self) -> &[f64] {
        &self.restoring_force
    }

    fn command(&self) -> &[f64] {
        &self.command
    }

    fn measured(&self) -> &[f64] {
        &self.displacement
    }

    fn tracking(&self) -> &[Tracking] {
        &self.tracking
    }
}

/// An impact on one floor of a frame.
#[derive(Clone, Debug)]
pub struct StoreyImpactHistory {
    /// The striker and the floor that it strikes, step by step; the energies are those of the whole frame, the tracking of
    /// all axes together, the tangent that of the struck storey.
    pub blow: ImpactHistory,
    /// Every floor, a row for each step of the blow.
    pub floors: Vec<FloorStep>,
    /// The struck floor, from 0.
    pub struck: usize,
    /// None where it did not begin.
    pub modes: Option<Modes>,
    /// Fraction of critical damping of each mode.
    pub damping_ratios: Vec<f64>,
}
