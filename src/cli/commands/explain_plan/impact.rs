//! Rows of an impact in `check --explain`: time step, duration and predicted peaks. In: its history. Out: rows.

use super::cells::row;
use psd_physics::identification::damping_ratio;
use psd_physics::structure::Matrices;
use psd_plan::procedures::impact::block as impact;
use psd_plan::record::{ImpactHistory, ImpactStep, ProcedureRecord};
use psd_plan::schema::procedures::STIFFNESS;
use psd_text::units::Dimension;
use psd_text::units::display::{readable, significant};

/// The computed damping of an impact on one degree of freedom, and its fraction of the critical one. No row without damping.
pub(super) fn damping(procedure: &ProcedureRecord) -> Vec<Vec<String>> {
    let input = |name| {
        let found = procedure.inputs.iter().find(|(field, ..)| *field == name);
        found.map_or(0.0, |(_, estimate, _)| estimate.value)
    };
    let matrices = Matrices {
        mass: input(impact::MASS.name),
        damping: input(impact::DAMPING.name),
        stiffness: input(STIFFNESS.name),
        gravity: None,
    };
    if matrices.damping <= 0.0 {
        return Vec::new();
    }
    let ratio = significant(100.0 * damping_ratio(&matrices), 3);
    let damping = readable(matrices.damping, Dimension::DAMPING);
    vec![row([
        "damping",
        &format!("{damping}, {ratio} % of critical"),
    ])]
}

/// Time steps and predicted peaks of an impact.
pub(super) fn rows(history: &ImpactHistory) -> Vec<Vec<String>> {
    let peak = |read: fn(&ImpactStep) -> f64, dimension| {
        let largest = history
            .steps
            .iter()
            .map(|step| (read(step).abs(), step.time))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        largest.map_or_else(String::new, |(value, time)| {
            format!(
                "{} at {}",
                readable(value, dimension),
                readable(time, Dimension::TIME)
            )
        })
    };
    let ratio = history.time_step / history.critical_time_step;
    let comparison = if ratio > 1.0 {
        "ABOVE critical"
    } else {
        "of it"
    };
    let ends = history.steps.last().map_or(0.0, |step| step.time);
    vec![
        row([
            "critical time step",
            &readable(history.critical_time_step, Dimension::TIME),
        ]),
        row([
            "chosen time step",
            &format!(
                "{}, {} {comparison}",
                readable(history.time_step, Dimension::TIME),
                significant(ratio, 3)
            ),
        ]),
        row([
            "simulated time",
            &format!(
                "{} in {} steps",
                readable(ends, Dimension::TIME),
                history.steps.len().saturating_sub(1)
            ),
        ]),
        row([
            "peak displacement",
            &peak(|step| step.computed, Dimension::LENGTH),
        ]),
        row([
            "peak restoring force",
            &peak(|step| step.restoring_force, Dimension::FORCE),
        ]),
        row([
            "peak contact force",
            &peak(|step| step.contact_force, Dimension::FORCE),
        ]),
        row([
            "peak velocity of the structure",
            &peak(|step| step.velocity, Dimension::VELOCITY),
        ]),
    ]
}
