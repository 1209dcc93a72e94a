//! An impact on one storey of a frame, as a report states it: the contact, the modes, the response and the energy of each
//! storey, the energy balance, the contact log. In: a plan and a record. Out: blocks.

use super::{at_the_end, peak_force};
use crate::procedures::frame::report::{
    element_table, entry, frame_of, integrated, mode_table, noise_note, storey_table,
};
use crate::procedures::impact::contact;
use crate::procedures::stepping::energy;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::sections::results::{budget_table, tracking};
use crate::report::{Run, number};
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{ImpactHistory, ProcedureRecord, StruckFrame};
use psd_plan::{Frame, Impact, Mode, StoreyTarget};
use psd_text::units::Dimension;

/// The results that a reader looks for first.
pub(crate) const HEADLINE: &[&str] = &[
    schema::MAX_DRIFT.name,
    schema::MAX_BASE_SHEAR.name,
    schema::MAX_DISPLACEMENT.name,
    schema::ABSORBED_ENERGY.name,
    schema::STOP_TIME.name,
    schema::FINAL_DRIFT.name,
];

/// The blocks below its results.
pub(super) fn report(
    run: &Run<'_>,
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    struck: &StruckFrame,
    body: &mut Vec<Block>,
) {
    let Some(target) = impact.storey() else {
        return;
    };
    let Some(modes) = &struck.modes else { return };
    let frame = frame_of(run, impact.specimen);
    let mut sentences = method(impact, target, history, struck, frame);
    sentences.extend(peak_force(procedure, "this time step"));
    sentences.extend(contact::note(&impact.contact).map(str::to_owned));
    sentences.extend(struck_mass(run, impact, target, frame));
    sentences.extend(tracking::sentence(procedure));
    body.push(Block::paragraph(sentences.join(" ")));
    body.push(mode_table(modes, &struck.damping_ratios));
    if struck.floors.is_empty() {
        return;
    }
    body.push(storey_table(
        procedure,
        &struck.floors,
        frame,
        schema::FLOOR_DISPLACEMENT,
    ));
    body.extend(element_table(procedure, &struck.floors));
    body.extend(noise_note(run, &struck.floors));
    body.push(storey_energies(procedure));
    body.extend(tracking::table(procedure, frame));
    at_the_end(impact, procedure, history, body);
}

/// The struck storey, and the integration of the frame.
fn method(
    impact: &Impact,
    target: &StoreyTarget,
    history: &ImpactHistory,
    struck: &StruckFrame,
    frame: Option<&Frame>,
) -> Vec<String> {
    let time = |value| number::text(value, Dimension::TIME);
    let step = time(history.time_step);
    let critical = if impact.contact.spring().is_some() {
        "a tenth of the shortest period of the frame with the striker in contact (tangent at the largest indentation) is"
    } else {
        "a tenth of the frame's shortest period is"
    };
    let mut sentences = vec![
        format!(
            "Floor {} is struck. Contact law: {}.",
            struck.struck + 1,
            impact.contact.title()
        ),
        integrated(
            frame,
            impact.stepping.integrator,
            &target.damping,
            &struck.damping_ratios,
        ),
        format!(
            "Time step {step}; {critical} {}.",
            time(history.critical_time_step)
        ),
    ];
    if impact.stepping.i_modification {
        sentences.push(
            "The forces were corrected to the target displacements, r* = r − K(d measured − d commanded), with the \
             initial stiffness (I-modification)."
                .to_owned(),
        );
    }
    if let Mode::Continuous { time_scale } = impact.stepping.mode {
        sentences.push(format!(
            "The actuators moved together without stops, with a time scale of {}; the restoring forces include the \
             damping of the storeys at that speed.",
            number::text(time_scale, Dimension::NUMBER)
        ));
    }
    sentences
}

/// The mass that an impact of no duration meets: that of the floor alone; under the rigid law, e = Ms/(Ms + 2M) with it.
fn struck_mass(
    run: &Run<'_>,
    impact: &Impact,
    target: &StoreyTarget,
    frame: Option<&Frame>,
) -> Option<String> {
    let striker = run.plan.strikers.get(impact.striker)?.mass;
    let floor = frame?.storeys.get(target.storey)?.mass;
    let mass = number::stated(floor, Dimension::MASS);
    let implied = contact::implied_restitution(&impact.contact, striker, floor);
    let implied = implied.map(|implied| format!("; the rigid law then implies {implied}"));
    Some(format!(
        "The effective mass of an instantaneous impact is the mass of the floor alone, {mass}{}.",
        implied.unwrap_or_default()
    ))
}

/// The energy that each storey or element absorbed: its shear over its drift, or its force over its deformation, to the end of the run.
fn storey_energies(procedure: &ProcedureRecord) -> Block {
    let Some(result) = procedure.result(schema::STOREY_ENERGY.name) else {
        return Block::note(String::new());
    };
    let energies = result.value.list().unwrap_or_default();
    let input = procedure.number(schema::STRIKER_ENERGY.name).unwrap_or(0.0);
    let word = budget_table::entry_kind(schema::STOREY_ENERGY.name, procedure);
    let row = |(storey, energy): (usize, &f64)| -> Vec<Text> {
        vec![
            format!("{word} {}", storey + 1).into(),
            entry(result, storey),
            energy::fraction(*energy, input).into(),
        ]
    };
    let title = if word == "element" {
        "Energy in each element at the end of the run, ∫F dδ; the stiffness matrix has the rest"
    } else {
        "Energy in each storey at the end of the run, ∫V dδ"
    };
    let columns = vec![
        Column::words(title, 1),
        Column::numbers("Energy"),
        Column::numbers("Fraction of striker energy"),
    ];
    Block::Table(Table {
        columns,
        rows: energies.iter().enumerate().map(row).collect(),
    })
}
