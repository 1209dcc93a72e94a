//! The captions of the charts of a frame. In: a plan. Out: sentences.

use crate::report::Run;
use crate::report::wording::specimen::{measured, weights};

/// The caption of the drifts.
pub(crate) fn drifts(run: &Run<'_>, name: &str, chosen: &str) -> String {
    let drift = if run.plan.tests_elements() {
        "deformation of each element"
    } else {
        "drift of each storey"
    };
    format!("{name}: {drift} against simulated time{chosen}.")
}

/// The caption of the loops.
pub(crate) fn loops(run: &Run<'_>, name: &str, chosen: &str) -> String {
    if run.plan.tests_elements() {
        let force = measured("force of each element", run.plan.frame_on_the_rig());
        return format!(
            "{name}: {force} against its deformation; the area of a loop is the energy absorbed by the element{chosen}."
        );
    }
    format!(
        "{name}: {} against drift; the area of a loop is the energy absorbed by the storey{chosen}.",
        storey_shear(run)
    )
}

/// The storey shear of a caption, with what of it was measured.
pub(crate) fn storey_shear(run: &Run<'_>) -> String {
    measured("storey shear", run.plan.frame_on_the_rig())
}

/// The sum of the restoring forces in a caption, with what of it was measured.
fn restoring_forces(run: &Run<'_>) -> String {
    let frame = run.plan.frame_on_the_rig();
    let sum = measured("restoring forces", frame);
    match frame.and_then(weights) {
        None => sum,
        Some(_) => format!("{sum} net of P-Δ"),
    }
}

/// The caption of the tracking of a frame.
pub(crate) fn followed(run: &Run<'_>, name: &str, chosen: &str) -> String {
    let of = if run.plan.tests_elements() {
        "element"
    } else {
        "floor"
    };
    format!(
        "{name}: tracking error of each {of}'s actuator{chosen}, and the tracking indicator of all of them over the \
         largest command; a falling indicator shows that lag adds energy to the test."
    )
}

/// The caption of the mode shapes.
pub(crate) fn modes(name: &str) -> String {
    format!("{name}: natural mode shapes and periods, floor by floor from the ground up.")
}

/// The caption of the base shear.
pub(crate) fn base_shear(run: &Run<'_>, name: &str) -> String {
    let forces = restoring_forces(run);
    format!("{name}: base shear, the sum of the {forces}, against simulated time.")
}
