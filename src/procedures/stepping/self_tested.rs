//! The parts of the self-test that a procedure that integrates uses. In: its stepping. Out: parts.

use psd_physics::self_test::SelfTestPart;
use psd_plan::{Integrator, Mode, Stepping};

/// The integrator with the contact law; the I-modification and continuous motion separately.
pub(crate) fn stepped(
    stepping: &Stepping,
    of_a_frame: bool,
    law: Option<SelfTestPart>,
) -> Vec<Vec<SelfTestPart>> {
    let integrator = match (stepping.integrator, of_a_frame) {
        (Integrator::Tangent, false) => SelfTestPart::Tangent,
        (Integrator::Explicit, false) => SelfTestPart::Explicit,
        (Integrator::AlphaOs { .. }, false) => SelfTestPart::AlphaOs,
        (Integrator::Tangent, true) => SelfTestPart::FrameTangent,
        (Integrator::Explicit, true) => SelfTestPart::FrameExplicit,
        (Integrator::AlphaOs { .. }, true) => SelfTestPart::FrameAlphaOs,
    };
    let integrated = std::iter::once(integrator).chain(law).collect();
    let modified = stepping
        .i_modification
        .then(|| vec![SelfTestPart::IModification]);
    let continuous =
        matches!(stepping.mode, Mode::Continuous { .. }).then(|| vec![SelfTestPart::Continuous]);
    [Some(integrated), modified, continuous]
        .into_iter()
        .flatten()
        .collect()
}
