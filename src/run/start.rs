//! The required position of a real rig when a run begins: the plan's zero. The plan's targets are relative to it. The first target would
//! move a rig at a different position by the whole difference. In: readings at rest. Out: the reason why the run does not begin.

use super::replay::Bands;
use super::session::Session;
use super::stop::Stop;
use crate::plan::{Datum, Gate, Plan, RealLink};
use crate::record::EventKind;
use crate::rig::safety::failpoint;
use crate::rig::safety::failpoint::Guarding;
use crate::rig::{named_axis, position_and_force};
use crate::units::Dimension;
use crate::units::display::{plain, readable, stated};

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
        link.gate_of(axis).probe
    }
}

/// Whether the rig is at the plan's zero. Run logs of older versions do not state its position, and were not checked.
pub(super) fn check(
    plan: &Plan,
    link: &RealLink,
    session: &Session<'_>,
    (places, forces): AtRest<'_>,
) -> Result<(), Stop> {
    if session.guard.datum().is_none() || !failpoint::on(Guarding::PretestStart) {
        return Ok(());
    }
    for (axis, (place, force)) in places.iter().zip(forces).enumerate() {
        let (band, gate) = (band(plan, link, axis), link.gate_of(axis));
        if within(place.abs(), 0.0, band) {
            continue;
        }
        let who = named_axis(axis, places.len())
            .map_or_else(|| "it".to_owned(), |axis| format!("axis {axis}"));
        let at = readable(*place, Dimension::LENGTH);
        let remedy = match link.datum {
            Datum::Machine if within(force.abs(), 0.0, gate.zero) => {
                "bring it there with `psd rig jog`; or, where the specimen carries no load here, say `datum = here`".to_owned()
            }
            Datum::Machine => remedy(*place, *force, &gate),
            Datum::Here | Datum::At(_) => "it does not rest: something moves it".to_owned(),
        };
        return Err(Stop::Gate {
            reason: format!(
                "{who} stands at {at}, and the plan begins at 0, within {}: {remedy}",
                stated(band, Dimension::LENGTH)
            ),
        });
    }
    Ok(())
}

/// The position and force of the rig, and the position in its own coordinate if the plan's zero is different.
pub(super) fn describe(session: &Session<'_>) -> String {
    let (places, forces) = session.guard.found();
    let stands = format!("at {}", position_and_force(places, forces));
    let own = session.guard.datum().unwrap_or_default();
    if own.iter().all(|place| *place == 0.0) {
        return stands;
    }
    let own: Vec<String> = own
        .iter()
        .map(|place| plain(*place, Dimension::LENGTH, 6))
        .collect();
    format!(
        "{stands}; the plan's zero is {} of the rig's own",
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
    let places: Vec<String> = datum
        .iter()
        .map(|place| plain(*place, Dimension::LENGTH, 6))
        .collect();
    session.event(
        EventKind::Note,
        format!(
            "the plan's zero is where the rig stands: {} of its own",
            places.join(", ")
        ),
    );
}

/// The advice for a force at rest. If the specimen would carry about this force at the position of the rig, an earlier run left the rig
/// there.
pub(super) fn remedy(displacement: f64, force: f64, gate: &Gate) -> String {
    let carried = force / displacement;
    let bent = within(carried, 0.5 * gate.stiffness.low, 2.0 * gate.stiffness.high)
        && displacement.abs() > gate.probe;
    if bent {
        let place = readable(displacement, Dimension::LENGTH);
        format!(
            "it stands at {place}, as a run without `unload` at its end leaves it: go back with `psd rig jog`, or start a stand-in anew"
        )
    } else {
        "zero the cell, or take the load off".to_owned()
    }
}

/// NaN is outside every interval.
pub(super) fn within(value: f64, low: f64, high: f64) -> bool {
    low <= value && value <= high
}
