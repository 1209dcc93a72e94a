//! What noise, resolution and calibration make of a stiffness that two readings tell: the first secant of a ramp, and the tangent at its
//! last increment. In: what was recorded, what the rig declares of a reading. Out: contributions; of a rig that declares nothing, none,
//! for two readings have no scatter to tell it by.

use super::attribution::of_calibration;
use super::rounding_doubts::Quanta;
use crate::formula::{ProcedureId, ResultValue};
use crate::mechanics::rounding::Rounded;
use crate::plan::{Calibration, StiffnessRamp};
use crate::record::{NamedResult, RampHistory, RampStep};
use crate::uncertainty::{Contribution, Source};

/// A reading: m, N, and of how many samples it is the mean.
type Read = (f64, f64, u32);

/// Gives both their contributions.
pub(super) fn give(
    (asked, ramp): (&StiffnessRamp, &RampHistory),
    (quanta, calibration): (Quanta, &Calibration),
    procedure: ProcedureId,
    results: &mut [NamedResult],
) {
    let samples = asked.samples.max(1);
    let read = |step: &RampStep| (step.displacement, step.restoring_force, samples);
    let start = ramp.start.map(|(place, force)| (place, force, 1));
    let first = start.zip(ramp.steps.first().map(read));
    let last = ramp.steps.iter().rposition(|step| !step.returning).and_then(|last| {
        let before = ramp.steps.get(last.checked_sub(1)?).filter(|before| !before.returning)?;
        Some((read(before), read(&ramp.steps[last])))
    });
    for (name, ends) in [("secant_stiffness", first), ("tangent_stiffness", last)] {
        let Some(result) = results.iter_mut().find(|result| result.name == name) else { continue };
        if let (ResultValue::Number { value: Some(value), .. }, Some((from, to))) = (&result.value, ends) {
            let (value, amount) = (*value, between(from, to, quanta));
            let source = Source::Secant { procedure, result: name };
            result.contributions = vec![Contribution::new(source, amount)];
            result.contributions.retain(|part| part.amount > 0.0);
            result.contributions.extend(of_calibration(result, value, calibration));
        }
    }
}

/// u of the stiffness between two readings, N/m. What their distance is in quanta they tell to a quantum themselves.
fn between(from: Read, to: Read, quanta: Quanta) -> f64 {
    let ((x0, r0, n0), (x1, r1, n1)) = (from, to);
    let (way, force) = (x1 - x0, r1 - r0);
    let weights = [-1.0 / way, 1.0 / way];
    let rounded = |values: [f64; 2], quantum: f64, noise: f64| {
        if quantum <= 0.0 {
            return 0.0;
        }
        let places = values.map(|value| value / quantum).to_vec();
        let rounded = Rounded { places, open: vec![vec![0.0, 1.0]], noise: noise / quantum, samples: n0.min(n1) };
        quantum * quantum * rounded.variance(&weights)
    };
    let of_noise = quanta.noise.powi(2) * (1.0 / f64::from(n0) + 1.0 / f64::from(n1)) / (way * way);
    let of_force = rounded([r0, r1], quanta.force, quanta.noise);
    let of_place = (force / way).powi(2) * rounded([x0, x1], quanta.displacement, 0.0);
    (of_noise + of_force + of_place).sqrt()
}
