//! The pre-test check of a real rig, before the first step: the readings at rest, and the stiffness in a small move. A
//! wrong polarity, unit or scale and a dead sensor are found here, while nothing can be damaged. In: the rig, the plan's
//! expectations. Out: the findings, as a note of the record, or the reason why the run does not begin.

use super::motion::Motion;
use super::session::Session;
use super::start;
use super::start::remedy;
use super::stop::Stop;
use psd_physics::structure::assemblies::on_the_rig;
use psd_plan::record::EventKind;
use psd_plan::{AxialAxis, Plan, PretestCheck, RealLink};
use psd_rig::safety::failpoint;
use psd_rig::safety::failpoint::Guarding;
use psd_rig::{Reading, of_axis};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

/// Time between the two readings at rest \[s\].
const REST: f64 = 1.0;
/// Difference from the expected change of a stiffness that is a remark, as a fraction of it, beside the scatter of two probes in noises.
const UNEXPECTED: f64 = 0.5;
const PROBE_SCATTER: f64 = 12.0;

/// Requests the motion enable, then tests the rig axis by axis. No motion has occurred before; `afterwards` describes the motion after
/// the check.
pub(crate) fn pass(
    plan: &Plan,
    link: &RealLink,
    afterwards: &str,
    session: &mut Session<'_>,
) -> Result<(), Stop> {
    let axes = session.guard.commanded().len();
    let checks: Vec<PretestCheck> = (0..axes).map(|axis| link.pretest_check_of(axis)).collect();
    let mut probes: Vec<String> = checks
        .iter()
        .map(|pretest_check| stated(pretest_check.probe, Dimension::LENGTH))
        .collect();
    probes.dedup();
    let probes = probes.join(", ");
    let by = if axes == 1 {
        format!("by {probes}")
    } else {
        format!("each of its {axes} axes in turn, {probes}")
    };
    // No motion enable is requested for a rig at a different position.
    start::check(plan, link, session.guard.found())?;
    let does = format!(
        "it MOVES {by} and back (pre-test check), then {afterwards}{}",
        axial_loads(plan)
    );
    let note = format!("release rig {}: {does}", plan.rig.name);
    let position = Some(start::describe(session));
    session.release(
        &note,
        &Motion {
            position,
            ..Motion::of(plan, session.identity(), does)
        },
    )?;

    let first = session.guard.read()?;
    session.guard.pause(REST)?;
    let at_rest = session.guard.read()?;
    for reading in [&first, &at_rest] {
        start::check(plan, link, (&reading.displacement, &reading.force))?;
    }
    start::log_datum(link, session);
    for (axis, (pretest_check, force)) in checks.iter().zip(&at_rest.force).enumerate() {
        if failpoint::on(Guarding::PretestZero)
            && !(0.0..=pretest_check.zero).contains(&force.abs())
        {
            return refuse(format!(
                "{}{} at rest (limit {}): {}",
                session
                    .guard
                    .named_axis(axis)
                    .map_or_else(String::new, |axis| format!("axis {axis}: ")),
                readable(*force, Dimension::FORCE),
                stated(pretest_check.zero, Dimension::FORCE),
                remedy(at_rest.displacement[axis], *force, pretest_check)
            ));
        }
    }
    let mut before = at_rest.clone();
    for (axis, pretest_check) in checks.iter().enumerate() {
        session.stop_if_requested()?;
        // Each axis is compared with the reading at rest before its move, after the previous axis has returned.
        let (column, back) = probe(axis, pretest_check, &before, session)?;
        before = back;
        session.probed.push(column[axis]);
        let force = readable(at_rest.force[axis], Dimension::FORCE);
        let drift = readable(
            (at_rest.force[axis] - first.force[axis]) / REST,
            Dimension::FORCE,
        );
        let found = readable(column[axis], Dimension::STIFFNESS);
        let probe = stated(pretest_check.probe, Dimension::LENGTH);
        let text = format!(
            "{force} at rest, zero drift {drift}/s, stiffness {found} in a move of {probe}"
        );
        let text = match session.guard.named_axis(axis) {
            None => format!("pre-test check passed: {text}"),
            Some(axis) => format!(
                "pre-test check passed by axis {axis}: {text}{}",
                others(&column, axis)
            ),
        };
        session.event(EventKind::Note, text);
    }
    Ok(())
}

/// The axial loads of the plan, as the end of a sentence about its motion.
fn axial_loads(plan: &Plan) -> String {
    let loads = plan.procedures.iter();
    let loads = loads.filter_map(|procedure| procedure.kind.axial_load());
    let axes: Vec<AxialAxis> = plan
        .rig
        .axial_axes(&plan.limits)
        .map(|(axis, _)| axis)
        .collect();
    let text = |(storey, force): (usize, f64)| {
        let axis = axes.iter().find(|axis| axis.storey == storey)?;
        Some(format!(
            "; AXIAL of storey {} LOADS it to {} at {} and holds this in FORCE CONTROL until `unload`, also if psd ends",
            storey + 1,
            stated(force, Dimension::FORCE),
            stated(axis.rate, Dimension::FORCE_RATE)
        ))
    };
    loads.filter_map(text).collect()
}

/// Measures the stiffness of the lateral axes again under the axial loads. Each part of the specimen changes by −φ N/h of its storey. Another
/// change is a remark: a wrong direction or share of the load, or a specimen that the load stiffens.
pub(crate) fn pass_under_load(plan: &Plan, session: &mut Session<'_>) -> Result<(), Stop> {
    let (Some(link), Some(frame)) = (plan.rig.link.as_real(), plan.frame_on_the_rig()) else {
        return Ok(());
    };
    let unloaded = session.probed.clone();
    for (axis, before) in unloaded.into_iter().enumerate() {
        session.stop_if_requested()?;
        let pretest_check = link.pretest_check_of(axis);
        let at_rest = session.guard.read()?;
        let (column, _) = move_and_return(axis, &pretest_check, &at_rest, session)?;
        let loads = session.guard.axial_loads().collect::<Vec<_>>();
        let leaning = |(storey, force): &(usize, f64)| {
            let axes = plan.rig.axial_axes(&plan.limits);
            let mut axes = axes.filter(|(axial, _)| axial.storey == *storey);
            let column = axes.next()?.0.column(frame)?;
            // An axis imposes the drifts of its own storey and of the one above it in the same assembly.
            let is_moved = column.tested == axis
                || column.tested == axis + 1 && !on_the_rig(frame).nth(axis + 1)?.1;
            is_moved.then_some(column.p_delta * force / column.height)
        };
        let expected: f64 = loads.iter().filter_map(leaning).sum();
        let lost = before - column[axis];
        let text = format!(
            "under the axial load the stiffness{} is {}, lower by {} ({} expected)",
            of_axis(session.guard.named_axis(axis)),
            readable(column[axis], Dimension::STIFFNESS),
            readable(lost, Dimension::STIFFNESS),
            readable(expected, Dimension::STIFFNESS)
        );
        let scatter = PROBE_SCATTER * link.readings_of(axis).noise / pretest_check.probe.abs();
        let kind = if (lost - expected).abs() > UNEXPECTED * expected.abs() + scatter {
            EventKind::Remark
        } else {
            EventKind::Note
        };
        session.event(kind, text);
    }
    Ok(())
}

/// Makes a small move of one axis alone, and returns. Gives the column of the stiffness matrix \[N/m\]: the change of force of every axis
/// divided by the travel. Also gives the reading after the return.
fn probe(
    axis: usize,
    pretest_check: &PretestCheck,
    before: &Reading,
    session: &mut Session<'_>,
) -> Result<(Vec<f64>, Reading), Stop> {
    let (column, back) = move_and_return(axis, pretest_check, before, session)?;
    let probe = stated(pretest_check.probe, Dimension::LENGTH);
    let of = of_axis(session.guard.named_axis(axis));
    let stiffness = column[axis];
    let (low, high) = (pretest_check.stiffness.low, pretest_check.stiffness.high);
    let bound = |value| stated(value, Dimension::STIFFNESS);
    let found = readable(stiffness, Dimension::STIFFNESS);
    if failpoint::on(Guarding::PretestStiffness) && !pretest_check.stiffness.contains(stiffness) {
        let (low, high) = (bound(low), bound(high));
        return refuse(format!(
            "the stiffness{of} in a move of {probe} is {found}, outside {low} .. {high}: check unit and scale"
        ));
    }
    Ok((column, back))
}

/// Gives the column of the stiffness matrix \[N/m\] and the reading after the return, as [`probe`].
fn move_and_return(
    axis: usize,
    pretest_check: &PretestCheck,
    before: &Reading,
    session: &mut Session<'_>,
) -> Result<(Vec<f64>, Reading), Stop> {
    let home = session.guard.commanded().to_vec();
    let mut out = home.clone();
    out[axis] += pretest_check.probe;
    session.go_to_all(&out, None)?;
    let there = session.guard.read()?;
    session.go_to_all(&home, None)?;
    let back = session.guard.read()?;

    let probe = stated(pretest_check.probe, Dimension::LENGTH);
    let of = of_axis(session.guard.named_axis(axis));
    let moved = there.displacement[axis] - before.displacement[axis];
    if moved == 0.0 {
        return refuse(format!(
            "the displacement{of} did not change in a move of {probe}: the transducer is dead, or its resolution is too coarse"
        ));
    }
    let column: Vec<f64> = there
        .force
        .iter()
        .zip(&before.force)
        .map(|(force, rest)| (force - rest) / moved)
        .collect();
    let stiffness = column[axis];
    if failpoint::on(Guarding::PretestPolarity)
        && (stiffness < 0.0 || moved * pretest_check.probe < 0.0)
    {
        return refuse(format!(
            "displacement and force{of} have opposite polarity: reverse one of them, or change the rig's `polarity`"
        ));
    }
    Ok((column, back))
}

/// The effect of the move of one axis (from 1) on the others.
fn others(column: &[f64], axis: usize) -> String {
    let coupled = (1..).zip(column).filter(|(other, _)| *other != axis);
    let listed: Vec<String> = coupled
        .map(|(other, stiffness)| {
            format!(
                "{} in axis {other}",
                readable(*stiffness, Dimension::STIFFNESS)
            )
        })
        .collect();
    if listed.is_empty() {
        String::new()
    } else {
        format!("; with {}", listed.join(", "))
    }
}

fn refuse<T>(reason: String) -> Result<T, Stop> {
    Err(Stop::PretestCheck { reason })
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::Interval;

    #[test]
    fn a_loaded_specimen_is_distinguished_from_a_cell_with_a_zero_offset() {
        let pretest_check = PretestCheck {
            probe: 1e-4,
            stiffness: Interval {
                low: 250e3,
                high: 350e3,
            },
            zero: 20.0,
        };
        assert!(
            remedy(7.86e-3, 2353.0, &pretest_check).contains("is at 7.860 mm"),
            "{}",
            remedy(7.86e-3, 2353.0, &pretest_check)
        );
        assert!(remedy(-7.86e-3, -1500.0, &pretest_check).contains("psd rig jog"));
        for (displacement, force) in [
            (0.0, 2353.0),
            (1e-5, 3.0),
            (7.86e-3, 40.0),
            (7.86e-3, -2353.0),
        ] {
            assert!(
                remedy(displacement, force, &pretest_check).starts_with("zero the load cell"),
                "{displacement} m, {force} N"
            );
        }
    }
}
