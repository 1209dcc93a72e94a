//! What `psd check --explain` prints of a ground-motion test. In: the steps of a dry run. Out: rows of text.

use crate::procedures::common::predicted::{Predicted, row};
use crate::procedures::frame::predicted::{floor_peaks, of_modes, peaks};
use crate::procedures::stepping::predicted::{TimeSteps, growth_of_frame};
use psd_physics::structure::Damping;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_plan::record::ShakeHistory;
use psd_plan::{Frame, Integrator, Part, Plan, Shake};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, significant};

/// `by_tracking`: the energy that tracking errors add or remove.
pub(crate) fn predicted(
    plan: &Plan,
    shake: &Shake,
    name: &str,
    history: &ShakeHistory,
    by_tracking: &[Vec<String>],
) -> Vec<Predicted> {
    let modes = history.modes.as_ref();
    let growth = growth_of_frame(
        plan,
        &shake.stepping,
        history.time_step,
        modes,
        &history.damping_ratios,
        &history.steps,
    );
    let frame = plan.specimens[shake.specimen].frame.as_ref();
    let steps = steps(history, frame, shake.stepping.integrator);
    let rows = [&steps, &growth, by_tracking].concat();
    of_modes(name, modes, &history.damping_ratios)
        .into_iter()
        .chain([Predicted::new(format!("{name}, shake"), rows)])
        .collect()
}

/// The computed storey that dictates the critical step, and the limit of explicit Newmark.
fn dictated(history: &ShakeHistory, frame: &Frame, integrator: Integrator) -> Option<String> {
    let highest = history.modes.as_ref()?.shapes.last()?;
    let (storey, fraction) = frame.most_strained(highest)?;
    if frame.storeys[storey].part != Part::Computed {
        return None;
    }
    let storey = storey + 1;
    let fraction = significant(100.0 * fraction, 2);
    let dictated = format!(
        "; the computed storey {storey} dictates it, with {fraction} % of the strain energy of the highest mode"
    );
    if integrator != Integrator::Explicit {
        return Some(dictated);
    }
    let limit = FrameProperties::of(frame, &Damping::None)
        .ok()?
        .longest_stable_step(integrator, Some(frame));
    let limit = readable(limit, Dimension::TIME);
    Some(format!(
        "{dictated}; `explicit` is stable up to {limit}, `alpha_os` at every step"
    ))
}

/// The time step and the predicted peaks.
fn steps(
    history: &ShakeHistory,
    frame: Option<&Frame>,
    integrator: Integrator,
) -> Vec<Vec<String>> {
    let Some(last) = history.steps.last() else {
        return Vec::new();
    };
    let dictated = frame.and_then(|frame| dictated(history, frame, integrator));
    let time_steps = TimeSteps {
        length: history.time_step,
        critical: history.critical_time_step,
        cause: dictated.unwrap_or_default(),
        number: history.steps.len() - 1,
        end: last.floors.time,
    };
    let mut rows = time_steps.rows().to_vec();
    rows.extend(floor_peaks(&history.steps));
    rows.push(row(
        "largest ground acceleration",
        peaks(
            &history.steps,
            |step| vec![step.ground_acceleration],
            Dimension::ACCELERATION,
        ),
    ));
    rows
}
