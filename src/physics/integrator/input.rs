//! Initial state and parameters of a test, and their checks. In: values of a caller. Out: the checked values. It integrates nothing.

use thiserror::Error;

use super::Integrator;
use super::tangents::Tangents;
use crate::structure::assemblies::StoreyReadings;
use crate::structure::elements::{ElementReading, Elements};
use crate::structure::matrix::{Matrix as _, Vector};
use crate::structure::{Matrices, NotPositiveDefinite};

/// Initial state and parameters; the structure is at rest.
#[derive(Clone, Copy, Debug)]
pub struct SolverInput<'a, V: Vector> {
    pub matrices: &'a Matrices<V>,
    /// `K_I` of α-OS and of the I-modification \[N/m\]: the initial stiffness, or a larger one.
    pub operator_stiffness: &'a V::Matrix,
    pub integrator: Integrator,
    /// Whether the recursion uses the effective force r* = `r_m` − `K_I`(`d_m` − d̃) instead of the reading.
    pub i_modification: bool,
    pub tangents: Tangents,
    /// Δt \[s\]
    pub time_step: f64,
    /// X₀ \[m\]
    pub initial_displacement: V::View<'a>,
    /// R₀, read once before the first step \[N\].
    pub initial_restoring_force: V::View<'a>,
    /// F(0) \[N\]
    pub initial_load: V::View<'a>,
    /// The readings of each storey or element; empty for exact ones.
    pub readings: &'a [StoreyReadings],
    /// The elements of a frame of matrices, and their first reading.
    pub elements: Option<(&'a Elements, &'a [ElementReading])>,
}

/// The input of a frame.
pub type FrameInput<'a> = SolverInput<'a, Vec<f64>>;

/// The reason why a structure cannot be integrated.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameError {
    #[error("a frame has at least one degree of freedom")]
    Empty,
    #[error("{what} is of order {found}, not {expected}")]
    Order {
        what: &'static str,
        found: usize,
        expected: usize,
    },
    #[error("the mass matrix is {0}")]
    Mass(NotPositiveDefinite),
    #[error("mass, damping and stiffness over a step are {0}")]
    Step(NotPositiveDefinite),
    #[error("the tangents of storeys require the stiffness matrix of a shear building")]
    NoStoreys,
    #[error("invalid time step of {0} s")]
    TimeStep(f64),
}

impl<V: Vector> SolverInput<'_, V> {
    /// All matrices and vectors are of `order`, and the time step is positive.
    pub(super) fn check(&self, order: usize) -> Result<(), FrameError> {
        if order == 0 {
            return Err(FrameError::Empty);
        }
        if !(self.time_step > 0.0 && self.time_step.is_finite()) {
            return Err(FrameError::TimeStep(self.time_step));
        }
        let orders = [
            ("damping", self.matrices.damping.rows()),
            ("stiffness", self.matrices.stiffness.rows()),
            ("the operator's stiffness", self.operator_stiffness.rows()),
            (
                "the initial displacement",
                V::order_of(self.initial_displacement),
            ),
            (
                "the initial restoring force",
                V::order_of(self.initial_restoring_force),
            ),
            ("the initial load", V::order_of(self.initial_load)),
        ];
        let other = orders.into_iter().find(|(_, found)| *found != order);
        other.map_or(Ok(()), |(what, found)| {
            Err(FrameError::Order {
                what,
                found,
                expected: order,
            })
        })
    }
}
