//! `preload`: the axial force grows at the rate of its axis, in tenths with a reading each. The first tenth is the check of the axis: at
//! each reading the guard compares the force with its target, and the displacement with its band. No lateral axis moves. On a real rig the
//! stiffness of the lateral axes is then measured again.

use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::pretest_check;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_plan::formula::Formula::Constant;
use psd_plan::procedures::preload::block as schema;
use psd_plan::record::{AxialReading, EventKind, History, NamedResult};
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{Plan, Preload};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Steps of the force.
pub(crate) const STEPS: u32 = 10;

pub(crate) fn perform(
    plan: &Preload,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let loaded = load(plan, inputs, session);
    let stop = loaded
        .and_then(|()| pretest_check::pass_under_load(whole, session))
        .err();
    let at_the_end: Option<AxialReading> = session
        .guard
        .axial_readings()
        .iter()
        .rfind(|reading| reading.storey == plan.storey as u64 + 1)
        .copied()
        .filter(|_| stop.is_none());
    Performed {
        history: History::Preload,
        results: results(plan, whole, at_the_end),
        stop,
    }
}

/// The last reading, as uncertain as the cell and the transducer of its axis.
fn results(plan: &Preload, whole: &Plan, at_the_end: Option<AxialReading>) -> Vec<NamedResult> {
    let mut axes = whole.rig.axial_axes(&whole.limits);
    let position = axes.position(|(axis, _)| axis.storey == plan.storey);
    let axis = whole.degrees_of_freedom() + position.unwrap_or(0);
    let calibration = whole.rig.calibration_of(axis);
    let (force, displacement) = at_the_end
        .map(|reading| (reading.force, reading.displacement))
        .unzip();
    vec![
        schema::AXIAL_FORCE.found_by(
            force,
            Contribution::of_each([
                (
                    Source::ForceScale(axis),
                    force.unwrap_or(0.0) * calibration.force_uncertainty,
                ),
                (Source::ForceZero(axis), calibration.zero()),
            ]),
        ),
        schema::AXIAL_DISPLACEMENT.found_by(
            displacement,
            Contribution::of_each([(
                Source::DisplacementScale(axis),
                displacement.unwrap_or(0.0) * calibration.displacement_uncertainty,
            )]),
        ),
    ]
}

fn load(plan: &Preload, inputs: &mut Inputs<'_>, session: &mut Session<'_>) -> Result<(), Stop> {
    inputs.number(&schema::FORCE, &Constant(plan.force))?;
    for step in 1..=STEPS {
        let force = plan.force * f64::from(step) / f64::from(STEPS);
        let (reading, stop) = session.load_axially(Some(plan.storey), force)?;
        if let Some(stop) = stop {
            return Err(stop);
        }
        if step == 1 {
            session.event(
                EventKind::Note,
                format!(
                    "axial axis of storey {}: the force followed to {}",
                    plan.storey + 1,
                    readable(force, Dimension::FORCE)
                ),
            );
        }
        let wall_time = session.guard.time();
        session.measured_all(u64::from(step), wall_time, &reading)?;
    }
    Ok(())
}
