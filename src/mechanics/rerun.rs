//! An impact integrated again on the way that a run recorded, with an input moved a little. In: the input, the way, how it
//! is distorted. Out: what the impact comes to, told between the ends of steps, so that it follows the inputs smoothly.
//! It moves no rig and knows no uncertainty.

use super::extremes::farther;
use super::impact::{ImpactInput, ImpactSolver, ImpactState};
use super::recorded_path::{Distortion, Reading, RecordedPath};
use super::summary::{ImpactSummary, SummaryBuilder};
use crate::plan::Until;

/// What an impact comes to, SI; NaN where it does not exist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// As the run itself tells them, at the ends of steps.
    pub summary: ImpactSummary,
    /// As they are between them.
    pub values: [f64; OUTCOMES.len()],
    /// The farthest it went where the record tells nothing, m.
    pub unseen: f64,
    /// The farthest from its zero that it was at the end of a step, m.
    pub farthest: f64,
}

/// Names of the values, as the results are called.
pub const OUTCOMES: [&str; 14] = [
    "max_displacement",
    "time_of_max_displacement",
    "stop_time",
    "final_displacement",
    "max_velocity",
    "max_contact_force",
    "impulse",
    "restitution",
    "indentation",
    "indentation_energy",
    "absorbed_energy",
    "restoring_energy",
    "damping_energy",
    "striker_energy",
];

/// Takes the run again, for `steps` steps at most.
#[must_use]
pub fn rerun(input: &ImpactInput, until: Until, steps: u64, path: &RecordedPath, distortion: Distortion) -> Outcome {
    let mut again = path.again(distortion);
    let start = again.start();
    let found = integrate(input, until, steps, start, |target, velocity| again.pass(target, velocity));
    Outcome { unseen: again.unseen(), ..found }
}

/// The velocities foretold for the targets of a run that did not stop at them, m/s: `readings` are all of its own.
#[must_use]
pub fn foretold(input: &ImpactInput, until: Until, steps: u64, readings: &[Reading]) -> Vec<f64> {
    let mut velocities = vec![0.0];
    let Some(first) = readings.first() else { return velocities };
    let start = (first.target, first.displacement, first.force);
    integrate(input, until, steps, start, |_, velocity| {
        let reading = readings[velocities.len().min(readings.len() - 1)];
        velocities.push(velocity);
        (reading.displacement, reading.force)
    });
    velocities
}

/// The impact from a place (m) and the displacement (m) and force (N) read there, on whatever is `read` at its
/// targets, for each of which a velocity (m/s) is foretold.
pub(crate) fn integrate(
    input: &ImpactInput,
    until: Until,
    steps: u64,
    (place, displacement, force): (f64, f64, f64),
    mut read: impl FnMut(f64, f64) -> (f64, f64),
) -> Outcome {
    let mut solver = ImpactSolver::new(input, place, force);
    let mut before = ImpactState { measured_displacement: displacement, ..*solver.state() };
    let mut told = Telling::new(input, until, &before);
    for _ in 0..steps {
        let target = solver.predict();
        let (velocity, _) = solver.predicted_velocity();
        let (displacement, force) = read(target, velocity);
        let now = *solver.complete(displacement, force);
        let over = solver.over(until);
        told.take(&before, &now, over);
        if over {
            break;
        }
        before = now;
    }
    told.finish()
}

/// What an impact comes to, collected from the ends of its steps.
pub struct Telling {
    summary: SummaryBuilder,
    between: Between,
    end: Ending,
    farthest: f64,
    until: Until,
    time_step: f64,
}

impl Telling {
    /// Before the first step, which begins at `start`.
    #[must_use]
    pub fn new(input: &ImpactInput, until: Until, start: &ImpactState) -> Self {
        let mut summary = SummaryBuilder::new(input);
        summary.push(start);
        let end = Ending { share: 1.0, displacement: start.displacement, restoring: 0.0, damping: 0.0 };
        let farthest = farther(0.0, start.displacement);
        Self { summary, between: Between::new(start), end, farthest, until, time_step: input.time_step }
    }

    /// Takes the ends of a step; `over` where the run ends with it.
    pub fn take(&mut self, before: &ImpactState, now: &ImpactState, over: bool) {
        self.summary.push(now);
        self.farthest = farther(self.farthest, now.displacement);
        self.between.take(before, now, self.time_step);
        self.end = Ending::of(before, now, over && self.until == Until::StrikerStop, self.time_step);
    }

    /// Share of the last step at which the run ends.
    #[must_use]
    pub const fn share(&self) -> f64 {
        self.end.share
    }

    /// The results, as far as steps were taken.
    #[must_use]
    pub fn finish(self) -> Outcome {
        let Self { summary, between, end, farthest, .. } = self;
        let summary = summary.finish();
        let values = [
            between.displacement,
            between.time,
            between.stop_time.unwrap_or(f64::NAN),
            end.displacement,
            summary.max_velocity,
            summary.max_contact_force,
            summary.impulse,
            summary.restitution.unwrap_or(f64::NAN),
            summary.indentation,
            summary.indentation_energy,
            between.absorbed,
            end.restoring,
            end.damping,
            summary.striker_energy,
        ];
        Outcome { summary, values, unseen: 0.0, farthest }
    }
}

/// Share of a step at which a velocity that falls evenly from `before` to `now` is none; None where it does not get there.
fn crossing(before: f64, now: f64) -> Option<f64> {
    (before > 0.0 && now <= 0.0).then(|| before / (before - now))
}

/// The peak and the stop, inside their steps.
struct Between {
    /// m
    displacement: f64,
    /// s
    time: f64,
    /// J
    absorbed: f64,
    /// s
    stop_time: Option<f64>,
}

impl Between {
    const fn new(start: &ImpactState) -> Self {
        Self { displacement: start.displacement, time: 0.0, absorbed: 0.0, stop_time: None }
    }

    /// Inside a step the velocity goes evenly from one end to the other: the trapezoidal rule, eq. (2d).
    fn take(&mut self, before: &ImpactState, now: &ImpactState, time_step: f64) {
        let [displacement, time, absorbed] = match crossing(before.velocity, now.velocity) {
            Some(share) => {
                let further = 0.5 * before.velocity * share * time_step;
                let force = before.force_at_computed;
                [before.displacement + further, before.time + share * time_step, before.energies.restoring + force * further]
            }
            None => [now.displacement, now.time, now.energies.restoring],
        };
        if displacement > self.displacement {
            (self.displacement, self.time, self.absorbed) = (displacement, time, absorbed);
        }
        if self.stop_time.is_none() && now.striker_velocity <= 0.0 {
            let share = crossing(before.striker_velocity, now.striker_velocity).unwrap_or(1.0);
            self.stop_time = Some(before.time + share * time_step);
        }
    }
}

/// The end of the run, inside its last step where that ends it by a velocity that comes to nothing.
struct Ending {
    /// Of the last step.
    share: f64,
    /// m
    displacement: f64,
    /// J
    restoring: f64,
    damping: f64,
}

impl Ending {
    fn of(before: &ImpactState, now: &ImpactState, stopped: bool, time_step: f64) -> Self {
        let crossings = [(before.velocity, now.velocity), (before.striker_velocity, now.striker_velocity)];
        let last = crossings.into_iter().filter_map(|(before, now)| crossing(before, now)).reduce(f64::max);
        let share = last.filter(|_| stopped).unwrap_or(1.0);
        let mean_velocity = before.velocity + 0.5 * share * (now.velocity - before.velocity);
        let inside = |before: f64, now: f64| before + share * (now - before);
        Self {
            share,
            displacement: if share < 1.0 { before.displacement + share * time_step * mean_velocity } else { now.displacement },
            restoring: inside(before.energies.restoring, now.energies.restoring),
            damping: inside(before.energies.damping, now.energies.damping),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::contact::ContactLaw;
    use crate::plan::Integrator;

    const STIFFNESS: f64 = 327.65;

    fn input(time_step: f64) -> ImpactInput {
        ImpactInput {
            mass: 1.0,
            damping: 0.0,
            stiffness: STIFFNESS,
            striker_mass: 10.0,
            striker_velocity: 1.0,
            gap: 0.0,
            gravity: 0.0,
            time_step,
            max_tangent_ratio: 10.0,
            law: ContactLaw::Restitution { coefficient: 0.0 },
            integrator: Integrator::Tangent,
            operator_stiffness: STIFFNESS,
            i_modification: false,
            force_noise: 0.0,
            resolution: 0.0,
        }
    }

    fn line() -> RecordedPath {
        let reading = |place: f64| Reading { target: place, displacement: place, force: STIFFNESS * place };
        RecordedPath::new(vec![reading(0.0), reading(0.05)], STIFFNESS, 0.0, 0.0).unwrap()
    }

    /// Perfectly plastic: both go on with V = `Ms·V0/(M + Ms)`, to V/ω after a quarter period, ω = √(K/(M + Ms)). The ends of
    /// steps miss peak and stop by up to a step; what is told between them does not.
    #[test]
    fn peak_and_stop_are_told_between_the_ends_of_steps() {
        let frequency = (STIFFNESS / 11.0_f64).sqrt();
        let (peak, quarter) = (10.0 / 11.0 / frequency, 0.25 * std::f64::consts::TAU / frequency);
        for time_step in [4e-3, 1e-3, 2.5e-4] {
            let found = rerun(&input(time_step), Until::StrikerStop, 2000, &line(), Distortion::NONE);
            let (near, missed) = (found.values[2] - quarter, found.summary.stop_time.unwrap() - quarter);
            assert!(near.abs() < 20.0 * time_step * time_step, "at {time_step}: {near}");
            assert!((0.0..=time_step).contains(&missed));
            assert_eq!(found.values[1], found.values[2]);
            // The scheme's own period is long by (ωΔt)²/12; the peak only loses what is left of rounding.
            assert!((found.values[0] / peak - 1.0).abs() < 0.2 * (frequency * time_step).powi(2), "{time_step}");
            assert!((found.values[3] / found.values[0] - 1.0).abs() < 1e-9, "the run ends at the peak");
            let energy = 0.5 * STIFFNESS * found.values[0] * found.values[0];
            assert!((found.values[10] / energy - 1.0).abs() < 2.0 * frequency * frequency * time_step * time_step);
        }
    }
}
