//! An impact on one storey of a frame, as a report tells it: the contact, the modes, what each storey went through and took,
//! the energy, the blows. In: a plan and a record. Out: blocks.

use super::contact_log;
use super::report::{contact_law, contact_work, energy_balance};
use crate::plan::formula::ResultValue;
use crate::plan::{Contact, Mode, ProcedureKind, StoreyImpact};
use crate::procedures::base_excitation;
use crate::record::{ImpactHistory, ProcedureRecord, StruckFrame};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number::percent;
use crate::report::sections::results::tracking;
use crate::report::{Run, number};
use crate::units::Dimension;

pub(crate) fn struck(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    struck: &StruckFrame,
    body: &mut Vec<Block>,
) {
    let Some(ProcedureKind::StoreyImpact(impact)) =
        run.plan.procedures.get(index).map(|planned| &planned.kind)
    else {
        return;
    };
    let Some(modes) = &struck.modes else { return };
    body.push(Block::paragraph(told(
        run, impact, procedure, history, struck,
    )));
    body.push(base_excitation::report::mode_table(
        modes,
        &struck.damping_ratios,
    ));
    if struck.floors.is_empty() {
        return;
    }
    let frame = run
        .plan
        .specimens
        .get(impact.specimen)
        .and_then(|specimen| specimen.frame.as_ref());
    body.push(base_excitation::report::storey_table(
        procedure,
        &struck.floors,
        frame,
        "floor_displacement",
    ));
    body.push(storey_energies(procedure));
    body.extend(tracking::table(procedure));
    energy_balance(contact_work(run, index), history, body);
    contact_log::table(history, body);
}

/// What was struck, how it was integrated, and what a reader of the peak force must know.
fn told(
    run: &Run<'_>,
    impact: &StoreyImpact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    struck: &StruckFrame,
) -> String {
    let time = |value| number::text(value, Dimension::TIME);
    let step = time(history.time_step);
    let critical = match impact.contact {
        Contact::Hertz { .. } => {
            "a tenth of the shortest period of the frame with the striker on it, by the contact's tangent at \
                                  its deepest, is"
        }
        _ => "a tenth of the frame's shortest period is",
    };
    let mut sentences = vec![
        format!(
            "Floor {} is struck. Contact law: {}.",
            struck.struck + 1,
            contact_law(&impact.contact)
        ),
        base_excitation::report::integrated(
            base_excitation::report::frame_of(run, impact.specimen),
            impact.stepping.integrator,
            &impact.damping,
            &struck.damping_ratios,
        ),
        format!(
            "Time step {step}; {critical} {}.",
            time(history.critical_time_step)
        ),
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
    if let (Some(peak), Some(impulse)) = (
        procedure.number("max_contact_force"),
        procedure.number("impulse"),
    ) {
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
    sentences.extend(tracking::sentence(procedure));
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
    Some(format!(
        "A blow of no duration meets the mass of that floor alone, {mass}{}.",
        implied.unwrap_or_default()
    ))
}

/// What each storey took of the energy: its shear over its drift, to the end of the run.
fn storey_energies(procedure: &ProcedureRecord) -> Block {
    let Some(result) = procedure.result("storey_energy") else {
        return Block::note(String::new());
    };
    let energies = match &result.value {
        ResultValue::List(energies) => energies.as_slice(),
        ResultValue::Number { .. } => &[],
    };
    let input = procedure.number("striker_energy").unwrap_or(0.0);
    let row = |(storey, energy): (usize, &f64)| -> Vec<Text> {
        let share = if input > 0.0 {
            percent(energy / input)
        } else {
            "—".to_owned()
        };
        vec![
            format!("storey {}", storey + 1).into(),
            base_excitation::report::entry(result, storey),
            share.into(),
        ]
    };
    let columns = vec![
        Column::words("Energy in each storey at the end of the run, ∫V dδ", 1),
        Column::numbers("Energy"),
        Column::numbers("Of the striker's"),
    ];
    Block::Table(Table {
        columns,
        rows: energies.iter().enumerate().map(row).collect(),
    })
}
