//! Constants that the reports of all procedures that integrate share.

use crate::schema::procedures::base_excitation as schema;

/// The method by which the contributions to the uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "each input in turn was moved by ± its standard uncertainty and the run integrated again along its own recorded \
    force–displacement path; half the difference of the results is the contribution, the root sum of squares is u (JCGM 100:2008). \
    An input at its bound was moved to the other side alone. The time step contributes the most that the same path, integrated \
    again in half and a quarter of it, differs by. The contact law and the slowness of the test are not among the inputs";

/// Results of a frame that have a budget even if no requirement reads any.
pub(crate) const FRAME_BUDGET: &[&str] = &[schema::MAX_DRIFT.name, schema::MAX_BASE_SHEAR.name];
