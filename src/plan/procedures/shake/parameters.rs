//! The parameters of a `shake`, in SI. They are data: they compute no motion.

use crate::formula::Formula;
use crate::{ShakeDamping, Stepping};

/// A frame on moving ground.
#[derive(Clone, Debug)]
pub struct Shake {
    /// Index into `Plan::specimens`; it has a frame.
    pub specimen: usize,
    /// Index into `Plan::grounds`.
    pub ground: usize,
    pub damping: ShakeDamping,
    /// Standard uncertainty of each damping ratio; 0 where none is stated.
    pub damping_uncertainty: f64,
    pub stepping: Stepping,
    /// Factor on the record.
    pub scale: Formula,
    /// Simulated time \[s\]. None: until the end of the record.
    pub duration: Option<Formula>,
    /// The run ends when the drift of a storey reaches this \[m\].
    pub until: Option<f64>,
}
