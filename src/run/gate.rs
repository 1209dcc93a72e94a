//! The gate of a real rig, before the first step: the readings at rest, and the stiffness that a tiny move shows. A
//! wrong sign, unit or scale and a dead sensor are found here, while nothing can be broken. In: the rig, what the plan
//! expects. Out: what was found, as a note of the record, or why the run does not begin.

use super::session::Session;
use super::stop::Stop;
use crate::plan::{Plan, RealLink};
use crate::quantity::Dimension;
use crate::quantity::display::{readable, stated};
use crate::record::EventKind;
use crate::rig::failpoint::{self, Guarding};

/// Time between the two readings at rest, s.
const REST: f64 = 1.0;

/// Asks for the release, then tries the rig. Nothing else has moved by then; `afterwards` says how it will.
pub(super) fn pass(plan: &Plan, link: &RealLink, afterwards: &str, session: &mut Session<'_>) -> Result<(), Stop> {
    let gate = &link.gate;
    let probe = stated(gate.probe, Dimension::LENGTH);
    session.inspect(&format!("release rig {}: it will move by {probe} to prove itself, then {afterwards}", plan.rig.name))?;

    let (_, first) = session.read()?;
    session.guard.pause(REST)?;
    let (home_reading, at_rest) = session.read()?;
    let drift = (at_rest - first) / REST;
    let shown = |force| readable(force, Dimension::FORCE);
    if failpoint::on(Guarding::GateZero) && !within(at_rest.abs(), 0.0, gate.zero) {
        return refuse(format!(
            "{} at rest, {} is allowed: zero the cell, or take the load off",
            shown(at_rest),
            stated(gate.zero, Dimension::FORCE)
        ));
    }

    let home = session.commanded();
    session.go_to(home + gate.probe, None)?;
    let (x, r) = session.read()?;
    session.go_to(home, None)?;
    session.read()?;
    let (moved, change) = (x - home_reading, r - at_rest);
    if moved == 0.0 {
        return refuse(format!("the displacement did not change in a move of {probe}: the transducer is dead, or too coarse"));
    }
    let stiffness = change / moved;
    if failpoint::on(Guarding::GateSign) && (stiffness < 0.0 || moved * gate.probe < 0.0) {
        let text = "displacement and force have opposite signs: turn one of them, or the rig's `sign`";
        return refuse(text.to_owned());
    }
    let (low, high) = (gate.stiffness.low, gate.stiffness.high);
    let bound = |value| stated(value, Dimension::STIFFNESS);
    let found = readable(stiffness, Dimension::STIFFNESS);
    if failpoint::on(Guarding::GateStiffness) && !within(stiffness, low, high) {
        return refuse(format!(
            "the move of {probe} shows {}, outside {} .. {}: look for a wrong unit or scale",
            found,
            bound(low),
            bound(high)
        ));
    }
    let text = format!("{} at rest, drift {}/s, stiffness {} in a move of {probe}", shown(at_rest), shown(drift), found);
    session.event(EventKind::Note, format!("gate passed: {text}"));
    Ok(())
}

/// NaN is within nothing.
fn within(value: f64, low: f64, high: f64) -> bool {
    low <= value && value <= high
}

fn refuse(reason: String) -> Result<(), Stop> {
    Err(Stop::Gate { reason })
}
