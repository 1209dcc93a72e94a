//! A move with readings during the motion.

use psd_physics::tracking::trajectory::Path;

/// A move as requested.
pub(super) enum ContinuousMove<'a> {
    /// \[m\], \[m/s\]
    Stroke(&'a [f64], f64),
    Paths(&'a [Path]),
}
