//! What the rounding of readings leaves open of what is fitted to holds while a force relaxes. In: the fit with the slopes of its numbers
//! by every reading, the holds, the quanta of the rig. Out: a standard uncertainty for each result, to be held against what its own
//! scatter shows.
//!
//! A reading lies where the fit says, in quanta, and what the readings leave open is a quantum from one end of the ramp to the other, and
//! one over the whole of a decay: forces that fall by few quanta may as well fall by one more.

use super::rounding_doubts::Quanta;
use crate::formula::ResultValue;
use crate::mechanics::reached_fit::LawFit;
use crate::mechanics::relaxation::{Hold, RelaxationFit};
use crate::mechanics::relaxation_law::RelaxationLaw;
use crate::mechanics::rounding::{Rounded, along};
use crate::record::{NamedResult, RampHistory};

/// A result by its name, its variance by rounding and its own standard error.
pub(super) type Found = (&'static str, f64, f64);

/// Of every result that is fitted to the holds of a ramp.
pub(super) fn of_holds(ramp: &RampHistory, quanta: Quanta, results: &[NamedResult]) -> Vec<Found> {
    let told: Vec<Found> = if let Some(fit) = ramp.relaxation.as_deref() {
        of_decay(ramp, fit, quanta, results)
    } else if let Some(fit) = &ramp.reached {
        of_law(ramp, fit.best(), quanta)
    } else {
        Vec::new()
    };
    told.into_iter().filter(|(_, variance, own)| variance.is_finite() && own.is_finite()).collect()
}

fn of_decay(ramp: &RampHistory, fit: &RelaxationFit, quanta: Quanta, results: &[NamedResult]) -> Vec<Found> {
    let Some(weights) = fit.weights(&ramp.holds) else { return Vec::new() };
    let tau = fit.time_constant.0;
    let forces = forces(&ramp.holds, |hold, seconds| fit.force(hold, seconds));
    let rounding = Rounding::of(ramp, &forces, tau, quanta);
    let amplitude = fit.worst.force;
    let last = ramp.holds.get(fit.worst_hold).and_then(|hold| hold.readings.last()).map_or(0.0, |(time, _)| *time);
    let fall = (-last / tau).exp();
    let [time_at, amplitude_at, relaxed_at, branch_at] = &weights.by_place;
    let both = |by_amplitude: f64, by_time: f64| {
        let sum = |amplitude: &[f64], time: &[f64]| -> Vec<f64> {
            amplitude.iter().zip(time).map(|(amplitude, time)| by_amplitude * amplitude + by_time * time).collect()
        };
        rounding.variance(&sum(&weights.amplitude, &weights.time_constant), &sum(amplitude_at, time_at))
    };
    let mut told = vec![("time_constant", rounding.variance(&weights.time_constant, time_at), fit.time_constant.1)];
    if let Some((_, own)) = fit.relaxed_stiffness {
        told.push(("relaxed_stiffness", rounding.variance(&weights.relaxed_stiffness, relaxed_at), own));
    }
    if let Some((_, own)) = fit.branch_stiffness {
        told.push(("branch_stiffness", rounding.variance(&weights.branch_stiffness, branch_at), own));
    }
    // |A|e^(−T/τ), and τ ln(|A|/accuracy).
    told.push(("remaining_relaxation", both(fall, amplitude * fall * last / (tau * tau)), fit.remaining.1));
    let pause = results.iter().find(|result| result.name == "needed_pause").map(|result| &result.value);
    if let Some(ResultValue::Number { value: Some(pause), uncertainty: Some(own) }) = pause {
        told.push(("needed_pause", both(tau / amplitude, pause / tau), *own));
    }
    told
}

fn of_law(ramp: &RampHistory, fit: &LawFit, quanta: Quanta) -> Vec<Found> {
    // As fits take as many holds as they can, so do their weights.
    let holds = &ramp.holds[..fit.reached.len().min(ramp.holds.len())];
    let forces = forces(holds, |hold, seconds| fit.force(hold, seconds));
    let rounding = Rounding::of(ramp, &forces, fit.time.0, quanta);
    let errors = [fit.share.1, fit.time.1, fit.rate.1, fit.remaining.map_or(f64::NAN, |(_, error)| error), fit.needed_pause.1];
    let time = if fit.law == RelaxationLaw::Exponential { "time_constant" } else { "reference_time" };
    let names = ["relaxation_share", time, "relaxation_rate", "remaining_relaxation", "needed_pause"];
    let told = names.into_iter().zip(&fit.weights).zip(errors);
    told.map(|((name, weights), own)| (name, rounding.variance(weights, &[]), own)).collect()
}

/// By the fit, reading by reading, N.
fn forces(holds: &[Hold], of: impl Fn(usize, f64) -> Option<f64>) -> Vec<f64> {
    let each = |(index, hold): (usize, &Hold)| {
        hold.readings.iter().map(|(time, force)| of(index, *time).unwrap_or(*force)).collect::<Vec<f64>>()
    };
    holds.iter().enumerate().flat_map(each).collect()
}

struct Rounding {
    quanta: Quanta,
    force: Rounded,
    place: Rounded,
}

impl Rounding {
    fn of(ramp: &RampHistory, forces: &[f64], time: f64, quanta: Quanta) -> Self {
        let each = |quantum: f64| if quantum > 0.0 { 1.0 / quantum } else { 0.0 };
        let readings = || ramp.holds.iter().flat_map(|hold| hold.readings.iter().map(move |(seconds, _)| (hold, *seconds)));
        let places: Vec<f64> = readings().map(|(hold, _)| hold.displacement).take(forces.len()).collect();
        let decays: Vec<f64> = readings().map(|(_, seconds)| (-seconds / time).exp()).take(forces.len()).collect();
        let commands = ramp.holds.iter().map(|hold| {
            let step = usize::try_from(hold.step).ok().and_then(|step| ramp.steps.get(step.checked_sub(1)?));
            step.map_or(hold.displacement, |step| step.command)
        });
        let commands: Vec<f64> = commands.collect();
        Self {
            quanta,
            force: Rounded {
                places: forces.iter().map(|force| force * each(quanta.force)).collect(),
                open: vec![along(&places), along(&decays)],
                noise: quanta.noise * each(quanta.force),
                samples: 1,
            },
            place: Rounded {
                places: commands.iter().map(|place| place * each(quanta.displacement)).collect(),
                open: vec![along(&commands)],
                noise: 0.0,
                samples: 1,
            },
        }
    }

    /// Of a number with these slopes by the readings of the force, and by the places of the holds.
    fn variance(&self, by_force: &[f64], by_place: &[f64]) -> f64 {
        let of = |quantum: f64, rounded: &Rounded, weights: &[f64]| {
            let counts = quantum > 0.0 && !weights.is_empty();
            if counts { quantum * quantum * rounded.variance(weights) } else { 0.0 }
        };
        of(self.quanta.force, &self.force, by_force) + of(self.quanta.displacement, &self.place, by_place)
    }
}
