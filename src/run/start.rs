//! The required position of a real rig when a run begins: the plan's zero. The plan's targets are relative to it. The first target would
//! move a rig at a different position by the whole difference. In: readings at rest. Out: the reason why the run does not begin.

use super::replay::Bands;
use super::session::Session;
use super::stop::Stop;
use psd_plan::record::EventKind;
use psd_plan::{Datum, Plan, PretestCheck, RealLink};
use psd_rig::safety::failpoint;
use psd_rig::safety::failpoint::Guarding;
use psd_rig::{named_axis, position_and_force};
use psd_text::units::Dimension;
use psd_text::units::display::{plain, readable, stated};

/// Displacements of every axis \[m\], and forces \[N\].
pub(super) type AtRest<'a> = (&'a [f64], &'a [f64]);

/// The largest distance of the axis with this index from the plan's zero \[m\]: its settling band.
pub fn band(plan: &Plan, link: &RealLink, axis: usize) -> f64 {
    let settled = Bands::of(&plan.rig, link)
        .displacement
        .get(axis)
        .copied()
        .unwrap_or(0.0);
    // If the rig accepts any settled position, it is near enough if its distance has no effect on the specimen.
    if settled > 0.0 {
        settled
    } else {
        link.pretest_check_of(axis).probe
    }
}

/// Whether the rig is at the plan's zero.
pub(super) fn check(
    plan: &Plan,
    link: &RealLink,
    (positions, forces): AtRest<'_>,
) -> Result<(), Stop> {
    if !failpoint::on(Guarding::PretestStart) {
        return Ok(());
    }
    for (axis, (position, force)) in positions.iter().zip(forces).enumerate() {
        let (band, pretest_check) = (band(plan, link, axis), link.pretest_check_of(axis));
        if (0.0..=band).contains(&position.abs()) {
            continue;
        }
        let who = named_axis(axis, positions.len())
            .map_or_else(|| "it".to_owned(), |axis| format!("axis {axis}"));
        let at = readable(*position, Dimension::LENGTH);
        let remedy = match link.datum {
            Datum::Machine if (0.0..=pretest_check.zero).contains(&force.abs()) => {
                "move it there with `psd rig jog`; or, if the specimen carries no load here, write `datum = here`".to_owned()
            }
            Datum::Machine => remedy(*position, *force, &pretest_check),
            Datum::Here | Datum::At(_) => "it is not at rest".to_owned(),
        };
        return Err(Stop::PretestCheck {
            reason: format!(
                "{who} is at {at}, but the plan starts at 0, within {}: {remedy}",
                stated(band, Dimension::LENGTH)
            ),
        });
    }
    Ok(())
}

/// The position and force of the rig, and the position in its own coordinate if the plan's zero is different.
pub(super) fn describe(session: &Session<'_>) -> String {
    let (positions, forces) = session.guard.found();
    let described = format!("at {}", position_and_force(positions, forces));
    let own = session.guard.datum().unwrap_or_default();
    if own.iter().all(|position| *position == 0.0) {
        return described;
    }
    let own: Vec<String> = own
        .iter()
        .map(|position| plain(*position, Dimension::LENGTH, 6))
        .collect();
    format!(
        "{described}; the plan's zero is at {} in the rig's own coordinate",
        own.join(", ")
    )
}

/// Logs the position of the plan's zero, if it is not the rig's own.
pub(super) fn log_datum(link: &RealLink, session: &mut Session<'_>) {
    let Some(datum) = session
        .guard
        .datum()
        .filter(|_| link.datum != Datum::Machine)
    else {
        return;
    };
    let positions: Vec<String> = datum
        .iter()
        .map(|position| plain(*position, Dimension::LENGTH, 6))
        .collect();
    session.event(
        EventKind::Note,
        format!(
            "the plan's zero is the present position of the rig: {} in its own coordinate",
            positions.join(", ")
        ),
    );
}

/// The advice for a force at rest. If the specimen would carry about this force at the position of the rig, an earlier run left the rig
/// there.
pub(super) fn remedy(displacement: f64, force: f64, pretest_check: &PretestCheck) -> String {
    let carried = force / displacement;
    // NaN is in no range.
    let bent = (0.5 * pretest_check.stiffness.low..=2.0 * pretest_check.stiffness.high)
        .contains(&carried)
        && displacement.abs() > pretest_check.probe;
    if bent {
        let position = readable(displacement, Dimension::LENGTH);
        format!(
            "it is at {position}, as after a run without a final `unload`: move it back with `psd rig jog`, or restart the rig \
             emulator"
        )
    } else {
        "zero the load cell, or remove the load".to_owned()
    }
}
