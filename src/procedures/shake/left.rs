//! The motion at the end of a ground-motion test, for the next procedure. In: the test and the ground motions. Out: a description and the
//! help.

use crate::procedures::facts::Motion;
use psd_physics::structure::Damping;
use psd_plan::formula::Formula;
use psd_plan::{Ground, Shake};

/// A damped frame comes to rest if the ground is at rest for long enough.
pub(crate) fn left(shake: &Shake, grounds: &[Option<Ground>]) -> Motion<'static> {
    Motion {
        what: "shake",
        ends: "ends at its last step, possibly in motion",
        help: "unload in between: `unload rest { }`; or let the frame come to rest: a longer `duration`, with a `damping_ratio`",
        rests: shake.until.is_none() && comes_to_rest(shake, grounds),
    }
}

/// Whether the ground is at rest before the run of a damped frame ends.
fn comes_to_rest(shake: &Shake, grounds: &[Option<Ground>]) -> bool {
    let still = grounds
        .get(shake.ground)
        .and_then(Option::as_ref)
        .map(Ground::duration);
    let longer = shake
        .duration
        .as_ref()
        .and_then(Formula::constant)
        .zip(still)
        .is_some_and(|(all, moving)| all > moving);
    longer && shake.damping.known() != Some(Damping::None)
}
