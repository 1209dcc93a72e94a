//! Frames: unloading, impact series on a storey, frames of which the rig carries a part at any scale, weights on the floors, and axial loads
//! on the rig.

mod elements;
pub(crate) mod escalate;
pub(crate) mod gravity;
pub(crate) mod hybrid;
pub(crate) mod preload;
pub(crate) mod scaled;
mod unloading;

use crate::procedures::unload::run::{of_frame, to_rest};
use crate::run::Unwatched;
use crate::run::session::Session;
use crate::tests::testing::elastic_plan;
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{Rest, UnloadStep};
use psd_plan::{Behaviour, Frame, Part, Plan, ProcedureKind, Storey, Unload};
use psd_rig::virtual_rig;

pub(super) const STIFFNESS: [f64; 3] = [4e6, 2e6, 1e6];
pub(super) const YIELD: [f64; 3] = [40e3, 20e3, 10e3];

pub(super) fn storey(index: usize, post_yield_ratio: f64) -> Storey {
    let (stiffness, yield_force) = (STIFFNESS[index], YIELD[index]);
    Storey {
        mass: 1000.0,
        mass_uncertainty: 0.0,
        stiffness_uncertainty: 0.0,
        stiffness,
        height: None,
        behaviour: Behaviour::Bilinear {
            stiffness,
            yield_force,
            post_yield_ratio,
        },
        damping: 0.0,
        coulomb: 0.0,
        gravity: 0.0,
        part: Part::TESTED,
        axial_load: 0.0,
    }
}

/// Three storeys that each yield at a drift of 10 mm.
pub(crate) fn three(post_yield_ratio: f64) -> Plan {
    let mut plan = elastic_plan(1.0, vec![rest(None)]);
    plan.specimens[0].frame = Some(Frame::of_storeys(
        (0..3)
            .map(|index| storey(index, post_yield_ratio))
            .collect(),
    ));
    plan.specimens[0].behaviour = None;
    plan
}

pub(super) fn rest(within: Option<f64>) -> ProcedureKind {
    ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: None,
        within: within.map(Constant),
        speed: None,
        keep_axial_load: false,
    })
}

/// Pushes the floors to these drifts \[m\] one after the other, then unloads them.
pub(super) fn unloaded(
    plan: &Plan,
    drifts: [f64; 3],
    within: Option<f64>,
) -> (Rest, Vec<UnloadStep>) {
    let mut rig = virtual_rig(plan);
    let mut watched = Unwatched;
    let mut session = Session::begin(plan, rig.as_mut(), &mut watched)
        .unwrap_or_else(|_| panic!("the rig is refused"));
    let mut displacement = 0.0;
    let displacements: Vec<f64> = drifts
        .iter()
        .map(|drift| {
            displacement += drift;
            displacement
        })
        .collect();
    session.go_to_all(&displacements, None).unwrap();
    let unloading = of_frame(plan.specimens[0].frame.as_ref().unwrap()).unwrap();
    let mut steps = Vec::new();
    let rest = to_rest(unloading, within, None, 0, &mut session, &mut steps).unwrap();
    (rest, steps)
}

pub(crate) fn close(found: &[f64], wanted: &[f64], within: f64) {
    assert!(
        found
            .iter()
            .zip(wanted)
            .all(|(found, wanted)| (found - wanted).abs() <= within),
        "{found:?}, not {wanted:?}"
    );
}
