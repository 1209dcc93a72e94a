//! An impact on one storey of a frame, as a report tells it: the contact, the modes, what each storey went through and took,
//! the energy, the blows. In: a plan and a record. Out: blocks.

use super::super::document::{Block, Column, Table, Text};
use super::super::{Run, number};
use super::results::{contact_law, contact_work, energy_balance, percent, scalar};
use super::{contact_log, followed, frames};
use crate::formula::ResultValue;
use crate::plan::{Contact, Mode, ProcedureKind, StoreyImpact};
use crate::quantity::Dimension;
use crate::record::{ProcedureRecord, StoreyImpactHistory};

pub(super) fn struck(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    history: &StoreyImpactHistory,
    body: &mut Vec<Block>,
) {
    let Some(ProcedureKind::StoreyImpact(impact)) = run.plan.procedures.get(index).map(|planned| &planned.kind) else { return };
    let Some(modes) = &history.modes else { return };
    body.push(Block::paragraph(told(run, impact, procedure, history)));
    body.push(frames::mode_table(modes, &history.damping_ratios));
    if history.floors.is_empty() {
        return;
    }
    let frame = run.plan.specimens.get(impact.specimen).and_then(|specimen| specimen.frame.as_ref());
    body.push(frames::storey_table(procedure, &history.floors, frame, "floor_displacement"));
    body.push(storey_energies(procedure));
    body.extend(followed::table(procedure));
    energy_balance(contact_work(run, index), &history.blow, body);
    contact_log::table(&history.blow, body);
}

/// What was struck, how it was integrated, and what a reader of the peak force must know.
fn told(run: &Run<'_>, impact: &StoreyImpact, procedure: &ProcedureRecord, history: &StoreyImpactHistory) -> String {
    let time = |value| number::text(value, Dimension::TIME);
    let step = time(history.blow.time_step);
    let critical = match impact.contact {
        Contact::Hertz { .. } => {
            "a tenth of the shortest period of the frame with the striker on it, by the contact's tangent at \
                                  its deepest, is"
        }
        _ => "a tenth of the frame's shortest period is",
    };
    let mut sentences = vec![
        format!("Floor {} is struck. Contact law: {}.", history.struck + 1, contact_law(&impact.contact)),
        frames::integrated(
            frames::frame_of(run, impact.specimen),
            impact.stepping.integrator,
            &impact.damping,
            &history.damping_ratios,
        ),
        format!("Time step {step}; {critical} {}.", time(history.blow.critical_time_step)),
    ];
    if impact.stepping.i_modification {
        sentences.push(
            "The forces were corrected to where the floors were to be, r* = r − K(d measured − d commanded), with the initial \
             stiffness (I-modification)."
                .to_owned(),
        );
    }
    if let Mode::Continuous { time_scale } = impact.stepping.mode {
        sentences.push(format!(
            "The actuators did not stop at the steps: they moved together at {} times the virtual time, and what dampers of the \
             storeys do at that speed is in the restoring forces.",
            number::text(time_scale, Dimension::NUMBER)
        ));
    }
    if let (Some(peak), Some(impulse)) = (scalar(procedure, "max_contact_force"), scalar(procedure, "impulse")) {
        sentences.push(format!(
            "Peak contact force {} with an impulse of {} at this time step.",
            number::text(peak, Dimension::FORCE),
            number::text(impulse, Dimension::IMPULSE)
        ));
    }
    if matches!(impact.contact, Contact::Rigid) {
        sentences.push(
            "Under the rigid law the contact force grows as the inverse of the time step: only the impulse is a property of the \
             blow, the peak is not."
                .to_owned(),
        );
    }
    sentences.extend(met(run, impact));
    sentences.extend(followed::sentence(procedure));
    sentences.join(" ")
}

/// What a blow of no duration meets: the mass of that floor alone, and under the rigid law e = Ms/(Ms + 2M) with it.
fn met(run: &Run<'_>, impact: &StoreyImpact) -> Option<String> {
    let frame = run.plan.specimens.get(impact.specimen)?.frame.as_ref()?;
    let striker = run.plan.strikers.get(impact.striker)?.mass;
    let floor = frame.storeys.get(impact.struck)?.mass;
    let mass = number::stated(floor, Dimension::MASS);
    let implied = matches!(impact.contact, Contact::Rigid).then(|| {
        let restitution = number::text(striker / (striker + 2.0 * floor), Dimension::NUMBER);
        format!("; the rigid law then implies a coefficient of restitution e = Ms/(Ms + 2M) = {restitution}")
    });
    Some(format!("A blow of no duration meets the mass of that floor alone, {mass}{}.", implied.unwrap_or_default()))
}

/// What each storey took of the energy: its shear over its drift, to the end of the run.
fn storey_energies(procedure: &ProcedureRecord) -> Block {
    let Some(result) = procedure.result("storey_energy") else { return Block::note(String::new()) };
    let energies = match &result.value {
        ResultValue::List(energies) => energies.as_slice(),
        ResultValue::Number { .. } => &[],
    };
    let input = scalar(procedure, "striker_energy").unwrap_or(0.0);
    let row = |(storey, energy): (usize, &f64)| -> Vec<Text> {
        let share = if input > 0.0 { percent(energy / input) } else { "—".to_owned() };
        vec![format!("storey {}", storey + 1).into(), frames::entry(result, storey), share.into()]
    };
    let columns = vec![
        Column::words("Energy in each storey at the end of the run, ∫V dδ", 1),
        Column::numbers("Energy"),
        Column::numbers("Of the striker's"),
    ];
    Block::Table(Table { columns, rows: energies.iter().enumerate().map(row).collect() })
}
