//! `move`: to an absolute displacement. A limited increment makes it several equal ones, each a step of the record.

use crate::procedures::stiffness_ramp::points::secant;
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use psd_plan::Move;
use psd_plan::procedures::move_to::block as schema;
use psd_plan::record::{History, MoveStep};

pub(crate) fn perform(
    plan: &Move,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut steps = Vec::new();
    let stop = go(plan, inputs, session, &mut steps).err();
    Performed {
        history: History::Move(steps),
        results: Vec::new(),
        stop,
    }
}

fn go(
    plan: &Move,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
    steps: &mut Vec<MoveStep>,
) -> Result<(), Stop> {
    let to = inputs.number(&schema::TO, &plan.to)?;
    let speed = inputs.speed(plan.speed.as_ref())?;
    for (step, target) in (1..).zip(session.guard.increments_to(&[to])) {
        let moved = session.guard.move_to(&target, speed);
        let (reading, broken) = session.read_after(moved)?;
        let (displacement, restoring_force) = first(&reading);
        let wall_time = session.guard.time();
        steps.push(MoveStep {
            step,
            wall_time,
            command: target[0],
            displacement,
            restoring_force,
            tangent_stiffness: tangent(steps.last(), displacement, restoring_force),
        });
        if let Some(stop) = broken {
            return Err(stop);
        }
        session.measured(step, wall_time, (displacement, restoring_force))?;
    }
    Ok(())
}

fn tangent(before: Option<&MoveStep>, displacement: f64, restoring_force: f64) -> Option<f64> {
    let before = before?;
    secant(
        (before.displacement, before.restoring_force),
        (displacement, restoring_force),
    )
}
