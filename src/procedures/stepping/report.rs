//! Constants that the reports of all procedures that integrate share.

use psd_plan::procedures::shake::block as schema;
use psd_plan::schema::procedures::tracking;

/// The method by which the contributions to the uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "Each input was perturbed by ± its standard uncertainty, one at a time, and the \
 run was re-integrated along its recorded force–displacement path. Half the difference of the results is the \
 contribution, and u is the root sum of squares (JCGM 100:2008). An input at its bound was perturbed to one side \
 only. The contact law and rate effects are not among the inputs. The time step is a systematic effect that is bounded, \
 not corrected, and not in U: the run was re-integrated with half and a quarter of it. The ends of its interval are \
 these differences, and three times the remainder of a method of first order.";

/// Results of a frame that have a budget even if no requirement reads any.
pub(crate) const FRAME_BUDGET: &[&str] = &[schema::MAX_DRIFT.name, schema::MAX_BASE_SHEAR.name];

/// The tracking of the actuators, which a sentence and a table state.
pub(crate) const TRACKING: &[&str] = &[
    tracking::TRACKING_ENERGY_ERROR.name,
    tracking::TRACKING_INDICATOR.name,
    tracking::NRMS_ERROR.name,
    tracking::PEAK_ERROR.name,
    tracking::FLOOR_TRACKING_ENERGY_ERROR.name,
    tracking::FLOOR_TRACKING_INDICATOR.name,
    tracking::FLOOR_NRMS_ERROR.name,
    tracking::FLOOR_PEAK_ERROR.name,
];
