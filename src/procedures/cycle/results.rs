//! The results of displacement cycles. In: the recorded loops. Out: results in the order of the reference.

use crate::procedures::stiffness_ramp::curve;
use psd_physics::statistics::noisy_largest::NoisyLargest;
use psd_plan::procedures::cycle::block as schema;
use psd_plan::record::{CycleHistory, NamedResult, WholeCycle};
use psd_plan::schema::ResultKind;

/// In the order of the reference; `noise` is the standard deviation of a force at its position \[N\].
pub(crate) fn results(history: &CycleHistory, noise: f64) -> Vec<NamedResult> {
    let cycles = &history.cycles;
    let largest = |sign: f64| {
        NoisyLargest::of(
            noise,
            history.steps.iter().map(|step| sign * step.restoring_force),
        )
        .value()
    };
    let list = |kind: ResultKind, read: fn(&WholeCycle) -> f64| {
        kind.found_list(Some(cycles.iter().map(read).collect()))
    };
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_TARGETS")]
    let count = cycles.len() as f64;
    let total = (!cycles.is_empty()).then(|| cycles.iter().map(|cycle| cycle.found.energy).sum());
    let mut results = vec![
        schema::DISSIPATED_ENERGY.found(total),
        schema::MAX_FORCE.found(largest(1.0)),
        schema::MIN_FORCE.found(largest(-1.0).map(|pull| -pull)),
        schema::EQUIVALENT_DAMPING_RATIO
            .found(cycles.last().and_then(|cycle| cycle.found.damping_ratio)),
        schema::STIFFNESS.found(cycles.first().and_then(|cycle| cycle.found.stiffness)),
        schema::LAST_STIFFNESS.found(cycles.last().and_then(|cycle| cycle.found.stiffness)),
        schema::CYCLES.found(Some(count)),
        list(schema::AMPLITUDES, |cycle| cycle.found.amplitude),
        list(schema::ENERGIES, |cycle| cycle.found.energy),
        list(schema::DAMPING_RATIOS, |cycle| {
            cycle.found.damping_ratio.unwrap_or(f64::NAN)
        }),
        list(schema::STIFFNESSES, |cycle| {
            cycle.found.stiffness.unwrap_or(f64::NAN)
        }),
    ];
    results.extend(curve::yielding(history.backbone.as_ref()));
    results.extend(curve::lists(history.backbone.as_ref()));
    results
}
