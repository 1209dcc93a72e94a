//! An impact re-integrated along the force–displacement path that a run recorded, with an input perturbed. In: the input, the path, the
//! perturbed readings. Out: the results of the impact, between the ends of steps, so that they follow the inputs smoothly.
//! It moves no rig and knows no uncertainty.

#![allow(
    clippy::inline_always,
    reason = "a part of the loop over the steps, which computes what its parts read"
)]

use std::cell::Cell;

use super::recorded_path::{Reading, RecordedPath};
use crate::impact::peaks::farther;
use crate::impact::summary::{ImpactSummary, SummaryBuilder};
use crate::impact::{ImpactError, ImpactInput, ImpactSolver, ImpactState, Sink, Until, from_start};
use crate::integrator::state::State;
use crate::reintegration::perturbation::Perturbation;

/// Results of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    pub values: ImpactValues,
    /// The values at the departure from the record.
    pub before_departure: Option<ImpactValues>,
    /// Peak |X| at the ends of steps \[m\].
    pub farthest: f64,
}

/// The results of an impact, SI: as the run itself reports them at the ends of steps, and those that are interpolated between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactValues {
    pub summary: ImpactSummary,
    /// \[m\]
    pub max_displacement: f64,
    /// \[s\]
    pub time_of_max_displacement: f64,
    /// \[s\]; NaN if the striker does not stop.
    pub stop_time: f64,
    /// \[m\]
    pub final_displacement: f64,
    /// \[J\]
    pub absorbed_energy: f64,
    /// \[J\]
    pub restoring_energy: f64,
    /// \[J\]
    pub damping_energy: f64,
}

/// Re-integrates the run, for `steps` steps of the record at most.
///
/// # Errors
/// The structure, with its inputs perturbed, cannot be stepped.
pub fn rerun(
    input: &ImpactInput,
    until: Until,
    steps: u64,
    path: &RecordedPath,
    readings: &Perturbation,
) -> Result<Outcome, ImpactError> {
    let finer = readings.finer;
    let input = &ImpactInput {
        time_step: input.time_step / f64::from(finer),
        ..*input
    };
    let mut retrace = path.retrace(finer);
    let recorded = retrace.start();
    let (displacement, force) = readings.read(0, 0, 1, (recorded.displacement, recorded.force));
    let start = Reading {
        target: readings.axes[0].displaced(recorded.target),
        displacement,
        force,
    };
    let mut reading = 0;
    // Each step waits for its reading, so the arithmetic of unchanged instruments is left out.
    let unchanged = readings.leaves_unchanged(0);
    run(
        input,
        until,
        steps * u64::from(finer),
        start,
        |target, velocity| {
            if unchanged {
                return (retrace.pass(target, velocity), retrace.departed());
            }
            reading += 1;
            let read = retrace.pass(
                readings.recorded_position(0, target),
                readings.recorded(0, velocity),
            );
            (readings.read(reading, 0, 1, read), retrace.departed())
        },
    )
}

/// Predicted velocities at the targets of a run with continuous motion \[m/s\]; `readings` are all readings of that run.
#[must_use]
pub fn predicted_velocities(
    input: &ImpactInput,
    until: Until,
    steps: u64,
    readings: &[Reading],
) -> Vec<f64> {
    let mut velocities = vec![0.0];
    let Some(first) = readings.first() else {
        return velocities;
    };
    // No velocity is predicted for a structure that cannot be integrated.
    let _ = integrate(input, until, steps, *first, |_, velocity| {
        let reading = readings[velocities.len().min(readings.len() - 1)];
        velocities.push(velocity);
        (reading.displacement, reading.force)
    });
    velocities
}

/// Integrates the impact from a first reading. For each target \[m\] and its predicted
/// velocity \[m/s\], `read` gives displacement \[m\] and force \[N\].
///
/// # Errors
/// As [`ImpactSolver::new`].
pub fn integrate(
    input: &ImpactInput,
    until: Until,
    steps: u64,
    start: Reading,
    mut read: impl FnMut(f64, f64) -> (f64, f64),
) -> Result<Outcome, ImpactError> {
    run(input, until, steps, start, |target, velocity| {
        (read(target, velocity), false)
    })
}

/// As [`integrate`], for a path that also reports whether it has departed from its record.
fn run(
    input: &ImpactInput,
    until: Until,
    steps: u64,
    first: Reading,
    mut read: impl FnMut(f64, f64) -> ((f64, f64), bool),
) -> Result<Outcome, ImpactError> {
    let solver = ImpactSolver::new(input, first.target, first.force)?;
    let start = ImpactState {
        measured_displacement: first.displacement,
        ..*solver.state()
    };
    let departed = Cell::new(false);
    let mut results = Departing {
        results: ImpactResults::new(input, until, &start),
        departed: &departed,
    };
    let measure = |[target, velocity]: [f64; 2]| {
        let (reading, has_departed) = read(target, velocity);
        departed.set(has_departed);
        reading.into()
    };
    from_start(input, solver, Some(until), steps, measure, &mut results);
    Ok(results.results.finish())
}

/// Results of an impact, collected from the ends of its steps.
pub struct ImpactResults {
    summary: SummaryBuilder,
    between: Between,
    farthest: f64,
    before_departure: Option<ImpactValues>,
    until: Until,
    time_step: f64,
    /// The ends of the last two steps.
    before: StepEnd,
    now: StepEnd,
    /// Whether the run ends inside the last step, where a velocity is zero.
    stopped: bool,
}

/// The numbers at the end of a step that are interpolated within steps.
#[derive(Clone, Copy)]
struct StepEnd {
    /// \[s\]
    time: f64,
    /// \[m\]
    displacement: f64,
    /// \[m/s\]
    velocity: f64,
    striker_velocity: f64,
    /// \[N\]
    force: f64,
    /// \[J\]
    restoring: f64,
    damping: f64,
}

impl StepEnd {
    #[inline]
    const fn of(state: &ImpactState) -> Self {
        Self {
            time: state.time,
            displacement: state.displacement,
            velocity: state.velocity,
            striker_velocity: state.striker_velocity,
            force: state.force_at_computed,
            restoring: state.energies.restoring,
            damping: state.energies.damping,
        }
    }
}

/// Keeps the results as they were before the path departed from its record.
struct Departing<'a> {
    results: ImpactResults,
    /// Whether the reading of the step in progress departed.
    departed: &'a Cell<bool>,
}

impl<V> Sink<V> for Departing<'_> {
    #[inline(always)]
    fn push(&mut self, _: &State<V>, now: &ImpactState, over: bool) {
        if self.departed.get() {
            self.results.departs();
        }
        self.results.take(now, over);
    }
}

impl<V> Sink<V> for ImpactResults {
    fn push(&mut self, _: &State<V>, now: &ImpactState, over: bool) {
        self.take(now, over);
    }
}

impl ImpactResults {
    /// Before the first step, which begins at `start`.
    #[must_use]
    pub fn new(input: &ImpactInput, until: Until, start: &ImpactState) -> Self {
        let mut summary = SummaryBuilder::new(input);
        summary.push(start);
        let farthest = farther(0.0, start.displacement);
        let start = StepEnd::of(start);
        Self {
            summary,
            between: Between::new(&start),
            farthest,
            before_departure: None,
            until,
            time_step: input.time_step,
            before: start,
            now: start,
            stopped: false,
        }
    }

    /// Adds the end of a step; `over`: the run ends with this step.
    #[inline(always)]
    pub fn take(&mut self, now: &ImpactState, over: bool) {
        self.summary.push(now);
        self.farthest = farther(self.farthest, now.displacement);
        self.before = std::mem::replace(&mut self.now, StepEnd::of(now));
        self.between.take(&self.before, &self.now, self.time_step);
        self.stopped = over && self.until == Until::StrikerStop;
    }

    /// Fraction of the last step at which the run ends.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.end().share
    }

    fn end(&self) -> Ending {
        Ending::of(&self.before, &self.now, self.stopped, self.time_step)
    }

    /// From the next step on the path differs from the record.
    pub fn departs(&mut self) {
        if self.before_departure.is_none() {
            self.before_departure = Some(self.values(&self.summary.clone().finish()));
        }
    }

    /// The results of the steps so far.
    #[must_use]
    pub fn finish(&self) -> Outcome {
        let summary = self.summary.clone().finish();
        let Self {
            farthest,
            before_departure,
            ..
        } = *self;
        Outcome {
            values: self.values(&summary),
            before_departure,
            farthest,
        }
    }

    fn values(&self, summary: &ImpactSummary) -> ImpactValues {
        let (between, end) = (&self.between, self.end());
        ImpactValues {
            summary: *summary,
            max_displacement: between.displacement,
            time_of_max_displacement: between.time,
            stop_time: between.stop_time.unwrap_or(f64::NAN),
            final_displacement: end.displacement,
            absorbed_energy: between.absorbed,
            restoring_energy: end.restoring,
            damping_energy: end.damping,
        }
    }
}

/// Fraction of a step at which a velocity that falls linearly from `before` to `now` is zero; None if it does not reach zero.
fn crossing(before: f64, now: f64) -> Option<f64> {
    (before > 0.0 && now <= 0.0).then(|| before / (before - now))
}

/// The peak and the stop, inside their steps.
struct Between {
    /// \[m\]
    displacement: f64,
    /// \[s\]
    time: f64,
    /// \[J\]
    absorbed: f64,
    /// \[s\]
    stop_time: Option<f64>,
}

impl Between {
    const fn new(start: &StepEnd) -> Self {
        Self {
            displacement: start.displacement,
            time: 0.0,
            absorbed: 0.0,
            stop_time: None,
        }
    }

    /// Inside a step the velocity is linear: the trapezoidal rule, eq. (2d).
    #[inline(always)]
    fn take(&mut self, before: &StepEnd, now: &StepEnd, time_step: f64) {
        let [displacement, time, absorbed] = match crossing(before.velocity, now.velocity) {
            Some(share) => {
                let further = 0.5 * before.velocity * share * time_step;
                [
                    before.displacement + further,
                    before.time + share * time_step,
                    before.restoring + before.force * further,
                ]
            }
            None => [now.displacement, now.time, now.restoring],
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

/// The end of the run, inside its last step if the run ends at a velocity of zero.
struct Ending {
    /// Fraction of the last step.
    share: f64,
    /// \[m\]
    displacement: f64,
    /// \[J\]
    restoring: f64,
    damping: f64,
}

impl Ending {
    fn of(before: &StepEnd, now: &StepEnd, stopped: bool, time_step: f64) -> Self {
        let crossings = [
            (before.velocity, now.velocity),
            (before.striker_velocity, now.striker_velocity),
        ];
        let last = crossings
            .into_iter()
            .filter_map(|(before, now)| crossing(before, now))
            .reduce(f64::max);
        let share = last.filter(|_| stopped).unwrap_or(1.0);
        let mean_velocity = before.velocity + 0.5 * share * (now.velocity - before.velocity);
        let inside = |before: f64, now: f64| before + share * (now - before);
        Self {
            share,
            displacement: if share < 1.0 {
                before.displacement + share * time_step * mean_velocity
            } else {
                now.displacement
            },
            restoring: inside(before.restoring, now.restoring),
            damping: inside(before.damping, now.damping),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactLaw;
    use crate::integrator::Integrator;
    use crate::statistics::DeclaredNoise;

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
            noise: DeclaredNoise::NONE,
        }
    }

    fn line() -> RecordedPath {
        let reading = |position: f64| Reading {
            target: position,
            displacement: position,
            force: STIFFNESS * position,
        };
        RecordedPath::new(
            vec![reading(0.0), reading(0.05)],
            None,
            STIFFNESS,
            DeclaredNoise::NONE,
        )
        .unwrap()
    }

    /// Perfectly plastic: both continue with V = `Ms·V0/(M + Ms)`, to V/ω after a quarter period, ω = √(K/(M + Ms)). The ends of steps
    /// miss peak and stop by up to a step; the interpolated values do not.
    #[test]
    fn peak_and_stop_are_interpolated_within_steps() {
        let frequency = (STIFFNESS / 11.0_f64).sqrt();
        let (peak, quarter) = (
            10.0 / 11.0 / frequency,
            0.25 * std::f64::consts::TAU / frequency,
        );
        for time_step in [4e-3, 1e-3, 2.5e-4] {
            let found = rerun(
                &input(time_step),
                Until::StrikerStop,
                2000,
                &line(),
                &Perturbation::none(1),
            )
            .unwrap();
            let (near, missed) = (
                found.values.stop_time - quarter,
                found.values.summary.stop_time.unwrap() - quarter,
            );
            assert!(
                near.abs() < 20.0 * time_step * time_step,
                "at {time_step}: {near}"
            );
            assert!((0.0..=time_step).contains(&missed));
            assert_eq!(
                found.values.time_of_max_displacement,
                found.values.stop_time
            );
            // The period of the scheme is longer by (ωΔt)²/12; the peak only has a rounding error.
            assert!(
                (found.values.max_displacement / peak - 1.0).abs()
                    < 0.2 * (frequency * time_step).powi(2),
                "{time_step}"
            );
            assert!(
                (found.values.final_displacement / found.values.max_displacement - 1.0).abs()
                    < 1e-9,
                "the run ends at the peak"
            );
            let energy =
                0.5 * STIFFNESS * found.values.max_displacement * found.values.max_displacement;
            assert!(
                (found.values.absorbed_energy / energy - 1.0).abs()
                    < 2.0 * frequency * frequency * time_step * time_step
            );
        }
    }
}
