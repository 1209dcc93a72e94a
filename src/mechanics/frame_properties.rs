//! What follows from a frame's masses, stiffness and damping before anything moves: matrices, modes, the longest stable step.
//! In: a frame of the plan, damping. Out: numbers in SI. It integrates nothing.

use thiserror::Error;

use super::frame::{
    Damping, DampingError, FrameMatrices, Modes, ModesError, RowsError, SymmetricBand, damping_matrix, modes, storey_stiffness,
};
use super::method::longest_stable_step;
use crate::plan::{Frame, Integrator};

/// A frame, ready to be integrated.
#[derive(Clone, Debug)]
pub struct FrameProperties {
    pub matrices: FrameMatrices,
    pub modes: Modes,
}

/// Why a frame has no motion.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoProperties {
    #[error("{0}")]
    Rows(#[from] RowsError),
    #[error("{0}")]
    Modes(#[from] ModesError),
    #[error("{0}")]
    Damping(#[from] DampingError),
}

impl FrameProperties {
    /// # Errors
    /// A matrix is not positive definite, or no damping matrix has these ratios.
    pub fn of(frame: &Frame, damping: &Damping) -> Result<Self, NoProperties> {
        let mass = SymmetricBand::from_dense(&frame.mass)?;
        let stiffness = SymmetricBand::from_dense(&frame.stiffness)?;
        let modes = modes(&mass, &stiffness)?;
        let damping = damping_matrix(damping, &mass, &stiffness, &modes)?;
        Ok(Self { matrices: FrameMatrices { mass, damping, stiffness }, modes })
    }

    /// A tenth of the shortest period, s (Melo et al. 2006, sec. 5).
    #[must_use]
    pub fn critical_time_step(&self) -> f64 {
        self.modes.critical_time_step()
    }

    /// Fraction of critical damping of each mode: `φᵀCφ / (2ω φᵀMφ)`.
    #[must_use]
    pub fn damping_ratios(&self) -> Vec<f64> {
        let ratio = |(mode, shape): (usize, &Vec<f64>)| {
            let FrameMatrices { mass, damping, .. } = &self.matrices;
            damping.form(shape, shape) / (2.0 * self.modes.angular_frequency(mode) * mass.form(shape, shape))
        };
        self.modes.shapes.iter().enumerate().map(ratio).collect()
    }

    /// Longest stable Δt, s; infinite where there is none. Of a virtual specimen it is also known how its storeys begin to
    /// bend, which may be stiffer than what the plan integrates with.
    #[must_use]
    pub fn longest_stable_step(&self, integrator: Integrator, virtual_specimen: Option<&Frame>) -> f64 {
        let mut highest = self.highest(&self.matrices.stiffness);
        let mut shortfall = 0.0;
        if let Some(frame) = virtual_specimen.filter(|frame| !frame.storeys.is_empty()) {
            let behaves: Vec<f64> = frame.storeys.iter().map(|storey| storey.behaviour.initial_stiffness()).collect();
            highest = highest.max(self.highest(&storey_stiffness(&behaves)));
            if frame.storeys.iter().zip(&behaves).any(|(storey, behaves)| *behaves > storey.stiffness) {
                // Storeys that are softer count as a trifle: the bound is then a little low, never high.
                let trifle = |behaves: f64| 1e-12 * behaves;
                let beyond = frame.storeys.iter().zip(&behaves);
                let beyond: Vec<f64> = beyond.map(|(storey, b)| (b - storey.stiffness).max(trifle(*b))).collect();
                shortfall = self.highest(&storey_stiffness(&beyond));
            }
        }
        longest_stable_step(integrator, highest, shortfall)
    }

    /// ω² of the highest mode with another stiffness, rad²/s².
    fn highest(&self, stiffness: &SymmetricBand) -> f64 {
        modes(&self.matrices.mass, stiffness).map_or(0.0, |modes| (std::f64::consts::TAU / modes.shortest_period()).powi(2))
    }
}
