//! `unload`: takes the load off, of one degree of freedom or of all floors of a frame together. In: the stiffness with which
//! the forces are expected to fall. Out: the way there, and where the specimen rests. Each target is on this side of where the forces
//! are 0, by the slopes that the moves before it showed (`physics/frame/unloading_path.rs`); the guard holds every one against the limits.

use super::uncertainty::RestUncertainty;
use crate::physics::frame::{Damping, Loaded, Unloading, UnloadingPath};
use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::formula::{Formula, ResultValue};
use crate::plan::{Frame, FrameUnload, Plan, Unload};
use crate::record::{EventKind, History, NamedResult, RampStep, Rest, UnloadStep};
use crate::rig::Reading;
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::schema::ResultKind;
use crate::schema::procedures::unload as schema;
use crate::uncertainty::{Contribution, combined};
use crate::units::Dimension;
use crate::units::display::readable;

/// Targets on the way, at most: a specimen that bends as it is expected to needs three.
pub(crate) const MOST_TARGETS: u64 = 50;
/// Of the force at the start: as near to none as is asked for where nothing else bounds it.
const SMALL: f64 = 1e-3;
/// Noise of the cell in a reading that is not to be mistaken for load, standard deviations.
pub(crate) const NOISE: f64 = 3.0;
/// Of a place, in units of its last digit: what adding the drifts of storeys up leaves.
const ROUNDING: f64 = 8.0;

pub(crate) fn perform(
    plan: &Unload,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut steps = Vec::new();
    let outcome = inputs
        .positive("stiffness", &plan.stiffness, Dimension::STIFFNESS)
        .and_then(|stiffness| {
            asked(
                (plan.within.as_ref(), plan.speed.as_ref()),
                &Unloading::of_one(stiffness),
                whole,
                inputs,
                session,
                &mut steps,
            )
        });
    let results = of_farthest(outcome.as_ref().ok());
    // The start is no move.
    let moved = steps.iter().skip(1).map(of_one).collect();
    Performed {
        history: History::Move(moved),
        results,
        stop: outcome.err(),
    }
}

fn of_one(step: &UnloadStep) -> RampStep {
    RampStep {
        step: step.step,
        wall_time: step.wall_time,
        command: step.command[0],
        displacement: step.displacement[0],
        restoring_force: step.restoring_force[0],
        force_scatter: 0.0,
        relaxation: 0.0,
        tangent_stiffness: step.tangent_stiffness[0],
        returning: true,
    }
}

/// The same of a frame.
pub(crate) fn perform_frame(
    plan: &FrameUnload,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut steps = Vec::new();
    // `check` has seen that the specimen is a frame.
    let frame = whole.specimens[plan.specimen].frame.as_ref();
    let known = frame.map_or_else(|| Err(Stop::no_frame()), of_frame);
    let outcome = known.and_then(|unloading| {
        asked(
            (plan.within.as_ref(), plan.speed.as_ref()),
            &unloading,
            whole,
            inputs,
            session,
            &mut steps,
        )
    });
    let results = frame_results(outcome.as_ref().ok());
    Performed {
        history: History::FrameUnload(steps),
        results,
        stop: outcome.err(),
    }
}

/// How the forces of a frame are expected to fall.
pub(crate) fn of_frame(frame: &Frame) -> Result<Unloading, Stop> {
    let unfit = |reason: String| Stop::BadInput {
        field: "specimen",
        value: 0.0,
        dimension: Dimension::NUMBER,
        wanted: reason.into(),
    };
    let properties = FrameProperties::of(frame, &Damping::None);
    let properties =
        properties.map_err(|reason| unfit(format!("a frame that can be unloaded: {reason}")))?;
    Unloading::of(&properties.matrices.stiffness)
        .map_err(|reason| unfit(format!("a stiffness that resists: {reason}")))
}

/// Where the floor rests that rests farthest out, and what the one still carries that carries most.
fn of_farthest(rest: Option<&Rest>) -> Vec<NamedResult> {
    let told = |kind: ResultKind, found: Option<(f64, Vec<Contribution>)>| {
        let (value, contributions) = found.unzip();
        let contributions = contributions.unwrap_or_default();
        let result = kind.found_with(value.map(|value| (value, combined(&contributions))));
        NamedResult {
            contributions,
            ..result
        }
    };
    let place = rest.map(|rest| {
        let [floor, _] = rest.floors_of_largest();
        let [parts, _] = rest.doubts_of(floor);
        (rest.largest().0, parts)
    });
    let force = rest.map(|rest| {
        let [_, floor] = rest.floors_of_largest();
        let [_, parts] = rest.doubts_of(floor);
        (rest.largest().1, parts)
    });
    vec![
        told(schema::RESIDUAL_DISPLACEMENT, place),
        told(schema::RESIDUAL_FORCE, force),
    ]
}

/// In the order of the reference.
fn frame_results(rest: Option<&Rest>) -> Vec<NamedResult> {
    let list = |kind: ResultKind, known: Option<(Vec<f64>, Vec<Contribution>)>| match known {
        Some((values, contributions)) => NamedResult {
            name: kind.name,
            dimension: kind.dimension,
            value: ResultValue::List(values),
            contributions,
        },
        None => kind.found(None),
    };
    let mut results = of_farthest(rest);
    results.extend([
        list(
            schema::FLOOR_DISPLACEMENT,
            rest.map(|rest| (rest.displacement.clone(), rest.doubts_of_places())),
        ),
        list(
            schema::RESIDUAL_DRIFT,
            rest.map(|rest| (rest.drift(), rest.doubts_of_drifts())),
        ),
        list(
            schema::RESIDUAL_SHEAR,
            rest.map(|rest| (rest.shear(), rest.doubts_of_shears())),
        ),
    ]);
    results
}

/// Takes the load off as a block asks for it.
fn asked(
    (within, speed): (Option<&Formula>, Option<&Formula>),
    unloading: &Unloading,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
    steps: &mut Vec<UnloadStep>,
) -> Result<Rest, Stop> {
    let within = within
        .map(|within| inputs.positive("within", within, Dimension::FORCE))
        .transpose()?;
    let speed = inputs.speed(speed)?;
    let mut rest = to_rest(unloading.clone(), within, speed, 0, session, steps)?;
    RestUncertainty::new(whole, inputs, session).unloaded(&mut rest, unloading, steps);
    Ok(rest)
}

/// Takes the load off; `before` steps of the procedure are done already. The first of `steps` is where it began.
pub(crate) fn to_rest(
    unloading: Unloading,
    within: Option<f64>,
    speed: Option<f64>,
    before: u64,
    session: &mut Session<'_>,
    steps: &mut Vec<UnloadStep>,
) -> Result<Rest, Stop> {
    let mut at = session.guard.read()?;
    let start = session.guard.commanded().to_vec();
    keep(
        (before, start),
        &at,
        vec![None; at.force.len()],
        session,
        steps,
    );
    let noise = session.guard.declared_noise();
    let rounding = ROUNDING * f64::EPSILON * largest(&at.displacement);
    let tells = (NOISE * noise.force).max(unloading.felt(noise.resolution.max(rounding)));
    let mut left = largest(&at.force);
    let within = within.unwrap_or_else(|| tells.max(SMALL * left).max(f64::MIN_POSITIVE));
    let mut path = UnloadingPath::new(unloading, (noise.force, noise.resolution), loaded(&at));
    if session.unloads_at_once {
        path = path.at_once();
    }
    for step in before + 1..=before + MOST_TARGETS {
        if left <= within {
            return Ok(rest(at));
        }
        let way = path.way(&at.force);
        let target: Vec<f64> = session
            .guard
            .commanded()
            .iter()
            .zip(way)
            .map(|(place, way)| place + way)
            .collect();
        session.go_to_all(&target, speed)?;
        let (reached, broken) = session.read_kept()?;
        let secants = path.learn(loaded(&at), loaded(&reached));
        let wall_time = keep((step, target), &reached, secants, session, steps);
        if let Some(stop) = broken {
            return Err(stop);
        }
        session.measured_all(step, wall_time, &reached)?;
        let nearer = path.left(&reached.force) < path.left(&at.force);
        let passed = path.passed(&reached.force);
        (left, at) = (largest(&reached.force), reached);
        if !nearer || passed {
            break;
        }
    }
    if left > within {
        let (force, wanted) = (
            rest(at.clone()).largest().1,
            readable(within, Dimension::FORCE),
        );
        let force = readable(force, Dimension::FORCE);
        session.event(
            EventKind::Remark,
            format!("the load could not be taken off to within {wanted}: {force} is left"),
        );
    }
    Ok(rest(at))
}

/// Keeps a step; gives the rig's time, s.
fn keep(
    (step, command): (u64, Vec<f64>),
    at: &Reading,
    secants: Vec<Option<f64>>,
    session: &Session<'_>,
    steps: &mut Vec<UnloadStep>,
) -> f64 {
    let wall_time = session.guard.time();
    steps.push(UnloadStep {
        step,
        wall_time,
        command,
        displacement: at.displacement.clone(),
        restoring_force: at.force.clone(),
        tangent_stiffness: secants,
    });
    wall_time
}

fn loaded(reading: &Reading) -> Loaded<'_> {
    Loaded {
        displacement: &reading.displacement,
        force: &reading.force,
    }
}

fn rest(reading: Reading) -> Rest {
    Rest {
        displacement: reading.displacement,
        force: reading.force,
        ..Rest::default()
    }
}

/// Largest size.
fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| largest.max(value.abs()))
}
