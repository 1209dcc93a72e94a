//! A frame on moving ground, as a report states it: the ground-motion record, the response, the energy. In: a plan and a record. Out:
//! blocks.

use crate::procedures::frame::report::{
    element_table, frame_of, integrated, mode_table, noise_note, storey_table,
};
use crate::procedures::frame::results::reached;
use crate::procedures::stepping::energy;
use crate::report::document::Block;
use crate::report::sections::results::{actuators, tracking};
use crate::report::{Run, number};
use psd_physics::statistics::samples::peak;
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::{Floors, ProcedureRecord, ShakeHistory};
use psd_plan::{Ground, Shake};
use psd_text::units::Dimension;

/// The blocks below the results of a ground-motion test: its integration, the modes, the storeys, the energy.
pub(crate) fn report(
    run: &Run<'_>,
    shake: &Shake,
    procedure: &ProcedureRecord,
    history: &ShakeHistory,
    body: &mut Vec<Block>,
) {
    let Some(modes) = &history.modes else { return };
    body.push(Block::paragraph(
        integration(run, shake, procedure, history).join(" "),
    ));
    body.push(mode_table(modes, &history.damping_ratios));
    if !history.steps.is_empty() {
        let frame = frame_of(run, shake.specimen);
        body.push(storey_table(
            procedure,
            &history.steps,
            frame,
            schema::MAX_DISPLACEMENT,
        ));
        body.extend(element_table(procedure, &history.steps));
        body.extend(noise_note(run, &history.steps));
        body.extend(tracking::table(procedure, frame));
        body.push(energy_balance(history));
    }
}

/// The integration of the frame, and the ground motion on it.
fn integration(
    run: &Run<'_>,
    shake: &Shake,
    procedure: &ProcedureRecord,
    history: &ShakeHistory,
) -> Vec<String> {
    let time = |value| number::text(value, Dimension::TIME);
    let mut sentences = vec![
        integrated(
            frame_of(run, shake.specimen),
            shake.stepping.integrator,
            &shake.damping,
            &history.damping_ratios,
        ),
        format!(
            "Time step {}; a tenth of the shortest period is {}.",
            time(history.time_step),
            time(history.critical_time_step)
        ),
    ];
    sentences.extend(actuators::motion(
        shake.stepping.i_modification,
        shake.stepping.mode,
    ));
    sentences.extend(tracking::sentence(procedure));
    let elements = history.steps.first().is_some_and(Floors::has_elements);
    sentences.extend(shake.until.map(|limit| {
        if let Some(member) = history.drift_reached {
            let reached = reached(elements, member, limit);
            return format!("The run ended when {reached}, before its duration.");
        }
        let limit = number::stated(limit, Dimension::LENGTH);
        if elements {
            format!("A deformation of {limit} would have ended the run; no element reached it.")
        } else {
            format!("A drift of {limit} would have ended the run; no storey reached it.")
        }
    }));
    if let Some(ground) = run.plan.grounds.get(shake.ground) {
        sentences.push(format!(
            "The record is linear between its samples; each step uses its value at the end of the step: {}.",
            resampled(ground, history)
        ));
    }
    sentences
}

/// Largest acceleration as applied beside that of the record over the same time and with the same factor.
fn resampled(ground: &Ground, history: &ShakeHistory) -> String {
    let applied = peak(history.steps.iter().map(|step| step.ground_acceleration));
    let text = |value| number::text(value, Dimension::ACCELERATION);
    format!(
        "peak applied acceleration {}, of the record before scaling {}",
        text(applied),
        text(ground.peak())
    )
}

/// The input energy of the ground motion, and its parts at the end.
fn energy_balance(history: &ShakeHistory) -> Block {
    let e = history
        .steps
        .last()
        .map(|step| step.energies)
        .unwrap_or_default();
    let parts = [
        ("kinetic, relative to the ground", e.kinetic),
        ("restoring forces, ∫R dX", e.restoring),
        ("damping, ∫CẊ dX", e.damping),
        ("integration error", e.error),
    ];
    let weighs = history.steps.last().is_some_and(Floors::weighs);
    let name = if weighs {
        "input, −∫Mι üg dX plus work of gravity, ½XᵀGX"
    } else {
        "input, −∫Mι üg dX"
    };
    energy::balance_table((name, e.input + e.gravity), &parts)
}
