//! What of the program an impact goes through, as the self-test names it. In: a procedure of the plan. Out: parts.

use crate::physics::self_test::Part;
use crate::plan::{Contact, Impact, StoreyImpact};
use crate::procedures::stepping::self_tested::stepped;

/// The parts that one degree of freedom goes through, each with those it goes together with.
pub(crate) fn struck(impact: &Impact) -> Vec<Vec<Part>> {
    let law = match impact.contact {
        Contact::Rigid => Part::Rigid,
        Contact::Limit { .. } => Part::Limit,
        Contact::Restitution { .. } => Part::Restitution,
        Contact::Hertz { .. } => Part::Hertz,
    };
    stepped(&impact.stepping, false, Some(law))
}

/// The same of a storey.
pub(crate) fn struck_storey(impact: &StoreyImpact) -> Vec<Vec<Part>> {
    let law = match impact.contact {
        Contact::Rigid => Part::FrameRigid,
        Contact::Limit { .. } => Part::FrameLimit,
        Contact::Restitution { .. } => Part::FrameRestitution,
        Contact::Hertz { .. } => Part::FrameHertz,
    };
    stepped(&impact.stepping, true, Some(law))
}
