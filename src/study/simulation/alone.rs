//! One run of a study on the simulated rig of its plan. In: the plan with the values of the run. Out: its record. It keeps no run log
//! and evaluates no uncertainty: the scatter of the study takes its place.

use crate::run::{Keep, Unwatched, run_with};
use psd_plan::Plan;
use psd_plan::record::Record;
use psd_rig::virtual_rig;

/// Runs the plan as `psd run` does on its virtual rig, an ideal one if it names none. The results are the same to the last bit.
pub fn simulate(plan: &Plan) -> Record {
    let mut rig = virtual_rig(plan);
    run_with(plan, rig.as_mut(), &mut Unwatched, Keep::Results)
}
