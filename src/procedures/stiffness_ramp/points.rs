//! Points of a force–displacement curve.

use psd_plan::record::RampStep;

/// A displacement \[m\] and the force there \[N\].
pub(crate) type Point = (f64, f64);

pub(crate) const fn point(step: &RampStep) -> Point {
    (step.displacement, step.restoring_force)
}

/// Stiffness from one point to the next \[N/m\]; None without motion.
pub(crate) fn secant(from: Point, to: Point) -> Option<f64> {
    let motion = to.0 - from.0;
    (motion != 0.0).then(|| (to.1 - from.1) / motion)
}
