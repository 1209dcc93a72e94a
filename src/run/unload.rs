//! `unload`: takes the load off. In: the stiffness with which the force is expected to fall. Out: the way there, and where
//! the specimen rests. Each target is where the force would be 0 along the stiffness that the last move showed; the guard
//! holds every one against the limits.

use super::Performed;
use super::inputs::Inputs;
use super::results::result;
use super::session::Session;
use super::stiffness_ramp::secant;
use super::stop::Stop;
use crate::plan::Unload;
use crate::quantity::Dimension;
use crate::quantity::display::readable;
use crate::record::{EventKind, History, RampStep};

/// Targets on the way, at most: a specimen that bends as it is expected to needs one or two.
pub(super) const MOST_TARGETS: u64 = 50;
/// A stiffness shown by a move is believed within this factor of the expected one.
const BELIEVED: f64 = 4.0;
/// Of the force at the start: as near to none as is asked for where nothing else bounds it.
const SMALL: f64 = 1e-3;
/// Noise of the cell in a reading that is not to be mistaken for load, standard deviations.
const NOISE: f64 = 3.0;

/// Where a specimen came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rest {
    /// m
    pub displacement: f64,
    /// What it still carries, N.
    pub force: f64,
}

pub(super) fn perform(plan: &Unload, inputs: &mut Inputs<'_>, session: &mut Session<'_>) -> Performed {
    let mut steps = Vec::new();
    let outcome = go(plan, inputs, session, &mut steps);
    let rest = outcome.as_ref().ok();
    let results = vec![
        result("residual_displacement", Dimension::LENGTH, rest.map(|rest| rest.displacement)),
        result("residual_force", Dimension::FORCE, rest.map(|rest| rest.force)),
    ];
    Performed { history: History::Move(steps), results, stop: outcome.err() }
}

fn go(plan: &Unload, inputs: &mut Inputs<'_>, session: &mut Session<'_>, steps: &mut Vec<RampStep>) -> Result<Rest, Stop> {
    let stiffness = inputs.positive("stiffness", &plan.stiffness, Dimension::STIFFNESS)?;
    let within = plan.within.as_ref().map(|within| inputs.positive("within", within, Dimension::FORCE)).transpose()?;
    let speed = inputs.speed(plan.speed.as_ref())?;
    to_rest(stiffness, within, speed, 0, session, steps)
}

/// Takes the load off; `before` steps of the procedure are done already.
pub(super) fn to_rest(
    stiffness: f64,
    within: Option<f64>,
    speed: Option<f64>,
    before: u64,
    session: &mut Session<'_>,
    steps: &mut Vec<RampStep>,
) -> Result<Rest, Stop> {
    let (mut displacement, mut force) = session.read()?;
    let noise = session.guard.declared_noise();
    let tells = (NOISE * noise.force).max(stiffness * noise.resolution);
    let within = within.unwrap_or_else(|| tells.max(SMALL * force.abs()).max(f64::MIN_POSITIVE));
    let mut slope = stiffness;
    for step in before + 1..=before + MOST_TARGETS {
        if force.abs() <= within {
            return Ok(Rest { displacement, force });
        }
        let target = session.commanded() - force / slope;
        session.go_to(target, speed)?;
        let (moved_to, felt) = session.read()?;
        let wall_time = session.guard.time();
        let tangent_stiffness = secant((displacement, force), (moved_to, felt));
        steps.push(RampStep {
            step,
            wall_time,
            command: target,
            displacement: moved_to,
            restoring_force: felt,
            force_scatter: 0.0,
            relaxation: 0.0,
            tangent_stiffness,
            returning: true,
        });
        session.measured(step, wall_time, moved_to, felt)?;
        let nearer = felt.abs() < force.abs();
        (displacement, force) = (moved_to, felt);
        if !nearer {
            break;
        }
        slope = tangent_stiffness.map_or(slope, |shown| shown.clamp(stiffness / BELIEVED, BELIEVED * stiffness));
    }
    if force.abs() > within {
        let (left, wanted) = (readable(force, Dimension::FORCE), readable(within, Dimension::FORCE));
        session.event(EventKind::Remark, format!("the load could not be taken off to within {wanted}: {left} is left"));
    }
    Ok(Rest { displacement, force })
}
