//! A move that is read while the actuators travel.

use crate::physics::tracking::trajectory::Path;

/// A move as it was requested.
pub(super) enum ContinuousMove<'a> {
    /// m, m/s
    Stroke(&'a [f64], f64),
    Paths(&'a [Path]),
}
