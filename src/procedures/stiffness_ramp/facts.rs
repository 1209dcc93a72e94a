//! The facts about a stiffness ramp that check and report need without running it. In: the ramp. Out: facts.

use super::{figures, report};
use crate::physics::self_test::SelfTestPart;
use crate::plan::procedures::stiffness_ramp::block as schema;
use crate::plan::{RampFit, StiffnessRamp};
use crate::procedures::facts::{Facts, Recorded};
use crate::record::StiffnessRampHistory;

pub(crate) fn facts() -> Facts<'static> {
    Facts {
        figures: figures::FIGURES,
        headline: vec![
            schema::STIFFNESS.name,
            schema::YIELD_FORCE.name,
            schema::YIELD_DISPLACEMENT.name,
            schema::TIME_CONSTANT.name,
            schema::MAX_FORCE.name,
        ],
        ..Facts::default()
    }
}

pub(crate) fn recorded(history: &StiffnessRampHistory) -> Recorded {
    Recorded {
        lists_are_tabled: history.multilinear.is_some(),
        uncertainty: report::UNCERTAINTY,
        ..Recorded::default()
    }
}

/// The fit that a ramp uses.
pub(crate) const fn self_tested(ramp: &StiffnessRamp) -> SelfTestPart {
    match ramp.fit {
        RampFit::Linear => SelfTestPart::LineFit,
        RampFit::Bilinear | RampFit::Multilinear(_) => SelfTestPart::CurveFit,
    }
}
