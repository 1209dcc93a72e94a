//! The parts of the self-test that a procedure that integrates uses. In: its stepping. Out: parts.

use crate::physics::self_test::Part;
use crate::plan::{Integrator, Mode, Stepping};

/// The integrator with the contact law; the I-modification and continuous motion separately.
pub(crate) fn stepped(stepping: &Stepping, of_a_frame: bool, law: Option<Part>) -> Vec<Vec<Part>> {
    let integrator = match (stepping.integrator, of_a_frame) {
        (Integrator::Tangent, false) => Part::Tangent,
        (Integrator::Explicit, false) => Part::Explicit,
        (Integrator::AlphaOs { .. }, false) => Part::AlphaOs,
        (Integrator::Tangent, true) => Part::FrameTangent,
        (Integrator::Explicit, true) => Part::FrameExplicit,
        (Integrator::AlphaOs { .. }, true) => Part::FrameAlphaOs,
    };
    let integrated = std::iter::once(integrator).chain(law).collect();
    let modified = stepping.i_modification.then(|| vec![Part::IModification]);
    let continuous =
        matches!(stepping.mode, Mode::Continuous { .. }).then(|| vec![Part::Continuous]);
    [Some(integrated), modified, continuous]
        .into_iter()
        .flatten()
        .collect()
}
