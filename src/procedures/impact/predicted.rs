//! What `psd check --explain` prints of an impact: damping, time step, duration and predicted peaks. In: the steps of a dry run. Out: rows
//! of text.

use crate::procedures::common::predicted::{Predicted, row};
use crate::procedures::frame::predicted::{floor_peaks, of_modes};
use crate::procedures::stepping::predicted::{
    PointMotion, TimeSteps, growth_of_frame, growth_of_point,
};
use psd_physics::identification::damping_ratio;
use psd_physics::statistics::samples::peak;
use psd_physics::structure::Matrices;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{ImpactHistory, ImpactStep, ProcedureRecord, StruckFrame};
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::{Impact, Plan};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, significant};

/// `by_tracking`: the energy that tracking errors add or remove. Nothing of an impact without a step.
pub(crate) fn predicted(
    plan: &Plan,
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    by_tracking: &[Vec<String>],
) -> Vec<Predicted> {
    match &history.frame {
        Some(frame) if frame.floors.is_empty() => Vec::new(),
        Some(frame) => of_storey(plan, impact, &procedure.name, history, frame, by_tracking),
        None if history.steps.is_empty() => Vec::new(),
        None => {
            let damping = damping(procedure);
            let growth = growth(plan, impact, procedure, history);
            let rows = [&damping, &rows(history), &growth, by_tracking].concat();
            vec![Predicted::new(format!("{}, impact", procedure.name), rows)]
        }
    }
}

fn of_storey(
    plan: &Plan,
    impact: &Impact,
    name: &str,
    history: &ImpactHistory,
    frame: &StruckFrame,
    by_tracking: &[Vec<String>],
) -> Vec<Predicted> {
    let modes = frame.modes.as_ref();
    let growth = growth_of_frame(
        plan,
        &impact.stepping,
        history.time_step,
        modes,
        &frame.damping_ratios,
        &frame.floors,
    );
    let heading = format!("{name}, impact on storey {}", frame.struck + 1);
    let peaks = floor_peaks(&frame.floors);
    let rows = [&rows(history), &peaks, &growth, by_tracking].concat();
    of_modes(name, modes, &frame.damping_ratios)
        .into_iter()
        .chain([Predicted::new(heading, rows)])
        .collect()
}

/// An input of the procedure as it was evaluated.
fn input(procedure: &ProcedureRecord, name: &str) -> Option<f64> {
    let found = procedure.inputs.iter().find(|(field, ..)| *field == name);
    found.map(|(_, estimate, _)| estimate.value)
}

/// The predicted growth of the amplitude by tracking errors.
fn growth(
    plan: &Plan,
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
) -> Vec<Vec<String>> {
    let input = |name| input(procedure, name);
    let (Some(mass), Some(stiffness)) = (input(schema::MASS.name), input(STIFFNESS.name)) else {
        return Vec::new();
    };
    let motion = PointMotion {
        angular_frequency: (stiffness / mass).sqrt(),
        amplitude: peak(history.steps.iter().map(|step| step.computed)),
        duration: history.steps.last().map_or(0.0, |step| step.time),
    };
    growth_of_point(plan, &impact.stepping, history.time_step, &motion)
}

/// The computed damping of an impact on one degree of freedom, and its fraction of the critical one. No row without damping.
fn damping(procedure: &ProcedureRecord) -> Vec<Vec<String>> {
    let input = |name| input(procedure, name).unwrap_or(0.0);
    let matrices = Matrices {
        mass: input(schema::MASS.name),
        damping: input(schema::DAMPING.name),
        stiffness: input(STIFFNESS.name),
        gravity: None,
    };
    if matrices.damping <= 0.0 {
        return Vec::new();
    }
    let ratio = significant(100.0 * damping_ratio(&matrices), 3);
    let damping = readable(matrices.damping, Dimension::DAMPING);
    vec![row("damping", format!("{damping}, {ratio} % of critical"))]
}

/// Time steps and predicted peaks of an impact.
fn rows(history: &ImpactHistory) -> Vec<Vec<String>> {
    let peak = |read: fn(&ImpactStep) -> f64, dimension| {
        let largest = history
            .steps
            .iter()
            .map(|step| (read(&step).abs(), step.time))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        largest.map_or_else(String::new, |(value, time)| {
            format!(
                "{} at {}",
                readable(value, dimension),
                readable(time, Dimension::TIME)
            )
        })
    };
    let time_steps = TimeSteps {
        length: history.time_step,
        critical: history.critical_time_step,
        cause: String::new(),
        number: history.steps.len().saturating_sub(1),
        end: history.steps.last().map_or(0.0, |step| step.time),
    };
    let peaks = [
        row(
            "peak displacement",
            peak(|step| step.computed, Dimension::LENGTH),
        ),
        row(
            "peak restoring force",
            peak(|step| step.restoring_force, Dimension::FORCE),
        ),
        row(
            "peak contact force",
            peak(|step| step.contact_force, Dimension::FORCE),
        ),
        row(
            "peak velocity of the structure",
            peak(|step| step.velocity, Dimension::VELOCITY),
        ),
    ];
    time_steps.rows().into_iter().chain(peaks).collect()
}
