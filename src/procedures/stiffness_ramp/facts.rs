//! The facts about a stiffness ramp that check and report need without running it. In: the ramp. Out: facts.

use super::{figures, report};
use crate::procedures::facts::{Facts, Listed, Recorded};
use psd_physics::self_test::SelfTestPart;
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::record::StiffnessRampHistory;
use psd_plan::{RampFit, StiffnessRamp};

pub(crate) fn facts() -> Facts<'static> {
    Facts {
        figures: figures::FIGURES,
        ..Facts::default()
    }
}

pub(crate) fn listed() -> Listed {
    Listed {
        headline: vec![
            schema::STIFFNESS.name,
            schema::YIELD_FORCE.name,
            schema::YIELD_DISPLACEMENT.name,
            schema::TIME_CONSTANT.name,
            schema::MAX_FORCE.name,
        ],
        ..Listed::default()
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
