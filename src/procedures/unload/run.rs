//! `unload`: moves one degree of freedom, or all floors or elements of a frame together, to zero restoring force. In: the stiffness with which the
//! forces are expected to fall. Out: the unloading path, and the unloaded position. Each target is before the position of zero force, by
//! the slopes of the moves before it (`physics/structure/unloading/path.rs`); the guard compares every one with the limits.
//!
//! Under an axial load it has three parts: to zero lateral force under the load; the load goes while the lateral axes hold; to zero lateral
//! force again, because the residual displacement left φ N u/h.

use crate::procedures::common::perturbed_inputs::UncertainRun;
use crate::procedures::stepping::setting::frame_of;
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::statistics::samples::peak;
use psd_physics::structure::assemblies::on_the_rig;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::structure::{Damping, Loaded, Unloading, UnloadingPath};
use psd_plan::procedures::unload::block as schema;
use psd_plan::record::{
    EventKind, History, NamedResult, Rest, UnloadHistory, UnloadStep, Unloaded,
};
use psd_plan::schema::ResultKind;
use psd_plan::schema::procedures::SPECIMEN;
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::uncertainty::{Contribution, NOISE};
use psd_plan::{Frame, Plan, Unload};
use psd_rig::Reading;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Targets of the unloading path, at most: a specimen with the expected stiffness needs three.
pub(crate) const MOST_TARGETS: u64 = 50;
/// Fraction of the force at the start that counts as zero if no other bound applies.
const SMALL: f64 = 1e-3;
/// Rounding of a position from adding up storey drifts, in units of its last digit.
const ROUNDING: f64 = 8.0;

pub(crate) fn perform(
    plan: &Unload,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut steps = Vec::new();
    let outcome = unload(plan, whole, inputs, session, &mut steps);
    let rest = outcome.as_ref().ok();
    let (of, results) = match plan.stiffness {
        Some(_) => (Unloaded::OneAxis, of_farthest(rest)),
        None if whole.tests_elements() => (Unloaded::Elements, element_results(rest)),
        None => (Unloaded::Floors, frame_results(rest)),
    };
    if of == Unloaded::OneAxis && !steps.is_empty() {
        // The start is not a move.
        steps.remove(0);
    }
    Performed {
        history: History::Unload(UnloadHistory { of, steps }),
        results,
        stop: outcome.err(),
    }
}

/// The expected unloading of a frame.
pub(crate) fn of_frame(frame: &Frame) -> Result<Unloading, Stop> {
    if frame.has_elements() {
        let elements = frame.elements.iter();
        let tested = on_the_rig(frame).map(|(element, _)| element.stiffness);
        return Ok(Unloading::of_elements(
            elements.map(|element| element.stiffness).collect(),
            tested.fold(0.0, f64::max),
        ));
    }
    let unfit = |reason: String| Stop::bad_input(SPECIMEN.name, 0.0, Dimension::NUMBER, reason);
    let properties = FrameProperties::of(frame, &Damping::None);
    let properties =
        properties.map_err(|reason| unfit(format!("a frame that can be unloaded: {reason}")))?;
    Unloading::of(&properties.matrices.stiffness)
        .map_err(|reason| unfit(format!("a stiffness that resists: {reason}")))
}

/// The position of the floor that is farthest from 0, and the largest remaining force.
fn of_farthest(rest: Option<&Rest>) -> Vec<NamedResult> {
    let number = |kind: ResultKind, found: Option<(f64, Vec<Contribution>)>| {
        let (value, contributions) = found.unzip();
        kind.found_by(value, contributions.unwrap_or_default())
    };
    let position = rest.map(|rest| {
        let [floor, _] = rest.floors_of_largest();
        let [parts, _] = rest.contributions_at_floor(floor);
        (rest.largest().0, parts)
    });
    let force = rest.map(|rest| {
        let [_, floor] = rest.floors_of_largest();
        let [_, parts] = rest.contributions_at_floor(floor);
        (rest.largest().1, parts)
    });
    let mut position = number(schema::RESIDUAL_DISPLACEMENT, position);
    withhold_position(rest, [&mut position]);
    vec![position, number(schema::RESIDUAL_FORCE, force)]
}

/// Withholds the uncertainty of positions at which the specimen is not unloaded.
pub(crate) fn withhold_position<'a>(
    rest: Option<&Rest>,
    positions: impl IntoIterator<Item = &'a mut NamedResult>,
) {
    if let Some(reason) = rest.and_then(|rest| rest.incomplete.as_deref()) {
        positions
            .into_iter()
            .for_each(|position| position.withhold(reason));
    }
}

fn list(kind: ResultKind, known: Option<(Vec<f64>, Vec<Contribution>)>) -> NamedResult {
    let (values, contributions) = known.unzip();
    kind.found_list_by(values, contributions.unwrap_or_default())
}

/// In the order of the reference.
fn element_results(rest: Option<&Rest>) -> Vec<NamedResult> {
    let mut results = of_farthest(rest);
    let deformation = rest.map(|rest| (rest.displacement.clone(), rest.position_contributions()));
    let mut deformation = list(schema::RESIDUAL_DRIFT, deformation);
    withhold_position(rest, [&mut deformation]);
    let force = rest.map(|rest| (rest.force.clone(), rest.force_contributions()));
    results.extend([deformation, list(schema::RESIDUAL_SHEAR, force)]);
    results
}

/// In the order of the reference.
fn frame_results(rest: Option<&Rest>) -> Vec<NamedResult> {
    let mut results = of_farthest(rest);
    let mut positions = [
        list(
            schema::FLOOR_DISPLACEMENT,
            rest.map(|rest| (rest.displacement.clone(), rest.position_contributions())),
        ),
        list(
            schema::RESIDUAL_DRIFT,
            rest.map(|rest| (rest.drift(), rest.drift_contributions())),
        ),
    ];
    withhold_position(rest, &mut positions);
    results.extend(positions);
    results.push(list(
        schema::RESIDUAL_SHEAR,
        rest.map(|rest| (rest.shear(), rest.shear_contributions())),
    ));
    results
}

/// Moves to zero restoring force as the block requests it.
fn unload(
    plan: &Unload,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
    steps: &mut Vec<UnloadStep>,
) -> Result<Rest, Stop> {
    let unloading = match &plan.stiffness {
        Some(stiffness) => Unloading::of_one(inputs.number(&STIFFNESS, stiffness)?),
        None => of_frame(frame_of(whole, plan.specimen)?)?,
    };
    let within = plan
        .within
        .as_ref()
        .map(|within| inputs.number(&schema::WITHIN, within))
        .transpose()?;
    let speed = inputs.speed(plan.speed.as_ref())?;
    let mut rest = to_rest(unloading.clone(), within, speed, 0, session, steps)?;
    let uncertain = UncertainRun::new(whole, inputs, session.guard.declared_noise());
    if plan.keep_axial_load || session.guard.axial_loads().next().is_none() {
        uncertain.unloaded(&mut rest, &unloading, steps);
        return Ok(rest);
    }
    let (without, broken) = session.load_axially(None, 0.0)?;
    if let Some(stop) = broken {
        return Err(stop);
    }
    let first = steps.last().map_or(0, |step| step.step) + 1;
    let wall_time = session.guard.time();
    session.measured_all(first, wall_time, &without)?;
    let unloading = of_frame(&without_axial_loads(frame_of(whole, plan.specimen)?))?;
    let mut last = Vec::new();
    let rested = to_rest(unloading.clone(), within, speed, first, session, &mut last);
    let rested = rested.map(|mut rest| {
        uncertain.unloaded(&mut rest, &unloading, &last);
        rest
    });
    steps.append(&mut last);
    rested
}

fn without_axial_loads(frame: &Frame) -> Frame {
    let mut frame = frame.clone();
    for storey in &mut frame.storeys {
        storey.axial_load = 0.0;
    }
    frame
}

/// Moves to zero restoring force; `before` steps of the procedure are done already. The first of `steps` is the start.
pub(crate) fn to_rest(
    unloading: Unloading,
    within: Option<f64>,
    speed: Option<f64>,
    before: u64,
    session: &mut Session<'_>,
    steps: &mut Vec<UnloadStep>,
) -> Result<Rest, Stop> {
    let (start, mut at) = session.loaded_at_rest()?;
    let secants = vec![None; at.force.len()];
    steps.push(step_of(before, start, &at, secants, session));
    let noise = session.floor_noise();
    let rounding = ROUNDING * f64::EPSILON * peak(&at.displacement);
    let detectable = (NOISE * noise.force).max(unloading.force_of(noise.resolution.max(rounding)));
    let by_readings = within.is_none();
    let within = within.unwrap_or_else(|| {
        detectable
            .max(SMALL * peak(&at.force))
            .max(f64::MIN_POSITIVE)
    });
    let mut path = UnloadingPath::new(unloading, noise, loaded(&at));
    for step in before + 1..=before + MOST_TARGETS {
        if peak(&at.force) <= within {
            return Ok(rest(at));
        }
        // Another reading has another error.
        let waits = by_readings && path.passed_by_noise(&at.force);
        let increments = if waits {
            vec![0.0; at.force.len()]
        } else {
            path.moves(&at.force)
        };
        let target: Vec<f64> = session
            .loaded_commanded()
            .into_iter()
            .zip(increments)
            .map(|(position, increment)| position + increment)
            .collect();
        let moved = session.loaded_go_to(&target, speed);
        let (reached, broken) = session.loaded_after(moved)?;
        let secants = path.learn(loaded(&at), loaded(&reached));
        let kept = step_of(step, target, &reached, secants, session);
        let wall_time = kept.wall_time;
        steps.push(kept);
        if let Some(stop) = broken {
            return Err(stop);
        }
        session.measured_all(step, wall_time, &reached)?;
        let nearer = path.left(&reached.force) < path.left(&at.force);
        let passed = path.passed(&reached.force);
        at = reached;
        if !waits && (!nearer || passed) {
            break;
        }
    }
    if peak(&at.force) > within {
        let (force, wanted) = (
            rest(at.clone()).largest().1,
            readable(within, Dimension::FORCE),
        );
        let force = readable(force, Dimension::FORCE);
        let incomplete = format!("unloading incomplete: remaining force {force} (limit {wanted})");
        session.event(EventKind::Remark, incomplete.clone());
        return Ok(Rest {
            incomplete: Some(incomplete),
            ..rest(at)
        });
    }
    Ok(rest(at))
}

/// A step at the present time of the rig.
fn step_of(
    step: u64,
    command: Vec<f64>,
    reading: &Reading,
    secants: Vec<Option<f64>>,
    session: &Session<'_>,
) -> UnloadStep {
    UnloadStep {
        step,
        wall_time: session.guard.time(),
        command,
        displacement: reading.displacement.clone(),
        restoring_force: reading.force.clone(),
        tangent_stiffness: secants,
    }
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
