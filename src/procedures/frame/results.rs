//! What the results of frames share: the drift that ends a run, and the forces of elements. In: the ends of steps. Out: numbers and words.

use crate::run::session::Session;
use psd_physics::statistics::noisy_largest::NoisyLargest;
use psd_physics::structure::assemblies::Assemblies;
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// The lowest storey, or the first element, from 0, whose drift or deformation \[m\] ended a run at `limit` \[m\].
pub(crate) fn drifted_to(drifts: &[f64], limit: f64) -> Option<usize> {
    drifts.iter().position(|drift| drift.abs() >= limit)
}

/// Records that the drift of a storey, or the deformation of an element, from 0, ended the run of this frame.
pub(crate) fn observe_drift(member: usize, limit: f64, session: &mut Session<'_>) {
    let elements = session.assemblies().and_then(Assemblies::elements);
    let reached = reached(elements.is_some(), member, limit);
    session.remark(format!("the run ended when {reached}"));
}

/// For example `storey 1 reached a drift of 20 mm`; `member` is from 0.
pub(crate) fn reached(is_element: bool, member: usize, limit: f64) -> String {
    let [of, what] = if is_element {
        ["element", "deformation"]
    } else {
        ["storey", "drift"]
    };
    let limit = stated(limit, Dimension::LENGTH);
    format!("{of} {} reached a {what} of {limit}", member + 1)
}

/// The largest force of each element \[N\]; None without elements, or before the first step.
pub(crate) fn largest_forces(elements: &[NoisyLargest]) -> Option<Vec<f64>> {
    let forces: Option<Vec<f64>> = elements.iter().map(NoisyLargest::value).collect();
    forces.filter(|forces| !forces.is_empty())
}
