//! The uncertainty engine: the contribution of each source to each result of a procedure. In: a procedure as a pure function of its
//! inputs and readings. Out: for each number, half the difference of the results at ±u of each source (JCGM 100:2008, 5.1.3 and 5.1.4),
//! the results of Monte Carlo trials of the reading errors (JCGM 101:2008), and the differences in finer time steps. It knows no procedure and no
//! rig.

use super::cost::TrialBudget;
use super::instruments::InstrumentUncertainty;
pub use super::instruments::Shifts;
use super::threads::in_threads;
use super::{Contribution, MOST_DRAWS, Refinement, Source};
use crate::formula::ProcedureId;
use psd_physics::reintegration::perturbation::{Perturbation, sign_of_input};

/// Relative difference within which a re-integrated run must reproduce the recorded results.
pub const CLOSE: f64 = 1e-9;
/// The effects of a source to either side may differ by this fraction of the larger one. Beyond it the response to this input is strongly
/// non-linear. It is twice the error of half the difference.
const ONE_SIDED: f64 = 0.2;
/// As `ONE_SIDED`, for half the difference at ±u and at ±u/2.
const HALVED: f64 = 0.1;
/// An input that cannot be perturbed by its full uncertainty to either side is perturbed by at least this fraction of it.
const LEAST_SHARE: f64 = 1e-3;
/// The second halving of the step may change a result by this fraction of the first change. A first-order scheme gives one half; the rest
/// is a margin for higher terms. Otherwise the steps do not converge yet, and their effect is an estimate.
const CONVERGES: f64 = 0.75;
/// If a run reaches this many times the displacement of the recorded one, it grows without bound.
const FARTHER: f64 = 10.0;
const GROWS: &str =
    "errors of its readings, re-integrated along the recorded path, grow without bound";

/// A procedure as a pure function of its readings and inputs.
pub trait Evaluate: Sync {
    type Inputs;

    /// Inputs with these sources perturbed.
    ///
    /// # Errors
    /// An input is out of its bounds.
    fn inputs(&self, shifts: Shifts<'_>) -> Result<Self::Inputs, String>;

    /// The results with these readings and inputs.
    fn evaluate(&self, readings: &Perturbation, inputs: &Self::Inputs) -> Evaluation;
}

/// Results of one evaluation.
#[derive(Clone, Debug, Default)]
pub struct Evaluation {
    /// NaN if a result does not exist.
    pub values: Vec<f64>,
    /// The values at the departure of the run from its record.
    pub before_departure: Option<Vec<f64>>,
    /// Peak absolute displacement \[m\].
    pub farthest: f64,
}

impl Evaluation {
    /// Values that follow from the readings directly.
    #[must_use]
    pub const fn of_readings(values: Vec<f64>) -> Self {
        Self {
            values,
            before_departure: None,
            farthest: 0.0,
        }
    }

    /// The evaluation of a run that could not be integrated.
    #[must_use]
    pub fn none(count: usize) -> Self {
        Self::of_readings(vec![f64::NAN; count])
    }

    /// Whether the record determines a value.
    fn is_known(&self, index: usize) -> bool {
        self.before_departure
            .as_ref()
            .is_none_or(|before| before[index].to_bits() == self.values[index].to_bits())
    }
}

/// Why no uncertainty is reported.
#[derive(Debug)]
pub enum Unknown<E> {
    /// The caller ended the propagation.
    Ended(E),
    Reason(String),
}

impl<E> From<String> for Unknown<E> {
    fn from(reason: String) -> Self {
        Self::Reason(reason)
    }
}

/// Receives the number of evaluations done and their total number; an error ends the propagation.
pub type Progress<'a, E> = &'a mut dyn FnMut(usize, usize) -> Result<(), E>;

/// Contributions to each of the values of a procedure.
pub type Contributions = Vec<Vec<Contribution>>;

/// The propagation of one procedure, or of one impact of a series.
pub struct Propagation<'a, P> {
    pub procedure: ProcedureId,
    /// From 0: each impact of a series has separate reading errors.
    pub impact: u16,
    pub evaluate: &'a P,
    pub instruments: &'a InstrumentUncertainty,
    /// Uncertain inputs, each once.
    pub inputs: Vec<Source>,
    /// The length of one evaluation: steps of one degree of freedom.
    pub steps: u64,
    /// The values that the run reported, if it is integrated in time steps.
    pub reported: Option<Vec<f64>>,
    /// The results with unperturbed readings and inputs; None: they are evaluated.
    pub nominal: Option<Evaluation>,
}

impl<P: Evaluate> Propagation<'_, P> {
    /// The contributions of every source to every value.
    ///
    /// # Errors
    /// An input is out of its bounds however little it is perturbed, errors grow without bound, or the caller ends the propagation.
    pub fn contributions<E>(&self, progress: Progress<'_, E>) -> Result<Contributions, Unknown<E>> {
        let mut sources: Vec<Source> = self
            .inputs
            .iter()
            .copied()
            .chain(self.instruments.sources())
            .collect();
        sources.sort_unstable();
        sources.dedup();
        let (sources, mut steps): (Vec<Source>, Vec<Source>) = sources
            .into_iter()
            .partition(|source| source.is_of_uncertainty());
        if self.reported.is_some() {
            steps = Refinement::ALL.map(Source::TimeStep).to_vec();
        }
        let budget = TrialBudget::new(self.steps, &sources, self.instruments.has_reading_errors());
        let (drawn, moved): (Vec<Source>, Vec<Source>) = sources
            .into_iter()
            .partition(|source| budget.draws(*source));
        let first = self.impact.saturating_mul(MOST_DRAWS);
        let trials = (first..first.saturating_add(budget.trials)).map(Perturbed::Trial);
        let parts: Vec<Perturbed> = steps
            .into_iter()
            .chain(moved)
            .map(Perturbed::Source)
            .chain(trials)
            .collect();
        let nominal = match &self.nominal {
            Some(nominal) => nominal.clone(),
            None => self.evaluate.evaluate(
                &self.instruments.perturbed(&[], None),
                &self.evaluate.inputs(&[])?,
            ),
        };
        let propagation = Prepared {
            propagation: self,
            budget,
            drawn,
            nominal,
        };
        let effects = in_threads(&parts, &|part| propagation.effects(*part), progress)
            .map_err(Unknown::Ended)?;
        let mut contributions: Contributions = vec![Vec::new(); propagation.nominal.values.len()];
        for (part, effects) in parts.into_iter().zip(effects) {
            let source = propagation.source(part);
            for (parts, effect) in contributions.iter_mut().zip(effects?) {
                parts.extend(effect.map(|(amount, smooth)| Contribution {
                    smooth,
                    ..Contribution::new(source, amount)
                }));
            }
        }
        for (parts, nominal) in contributions.iter_mut().zip(&propagation.nominal.values) {
            mark_if_not_converging(*nominal, parts);
        }
        Ok(contributions)
    }
}

/// One re-integration with an input perturbed, or with simulated reading errors.
#[derive(Clone, Copy)]
enum Perturbed {
    Source(Source),
    Trial(u16),
}

/// The effect on each value, and whether the value follows smoothly; None if the value does not exist.
type Effects = Vec<Option<(f64, bool)>>;

struct Prepared<'a, P> {
    propagation: &'a Propagation<'a, P>,
    budget: TrialBudget,
    /// Inputs that are varied in the trials of the reading errors.
    drawn: Vec<Source>,
    nominal: Evaluation,
}

impl<P: Evaluate> Prepared<'_, P> {
    fn source(&self, perturbed: Perturbed) -> Source {
        let procedure = self.propagation.procedure;
        match perturbed {
            Perturbed::Source(source) => source,
            Perturbed::Trial(draw) if self.budget.together => Source::Drawn { procedure, draw },
            Perturbed::Trial(draw) => Source::Readings { procedure, draw },
        }
    }

    fn effects(&self, perturbed: Perturbed) -> Result<Effects, String> {
        match perturbed {
            Perturbed::Source(Source::TimeStep(steps)) => self.of_the_time_step(steps),
            Perturbed::Source(source) => self.of_source(source),
            Perturbed::Trial(trial) => self.of_trial(trial),
        }
    }

    fn run(&self, readings: &Perturbation, inputs: &P::Inputs) -> Result<Evaluation, String> {
        let found = self.propagation.evaluate.evaluate(readings, inputs);
        let grows = found.farthest.is_nan() || found.farthest > FARTHER * self.nominal.farthest;
        if grows {
            Err(GROWS.to_owned())
        } else {
            Ok(found)
        }
    }

    /// The results with a source perturbed; None if the input is then out of its bounds.
    fn perturbed(&self, source: Source, by: f64) -> Result<Option<Evaluation>, String> {
        let shifts = [(source, by)];
        let Ok(inputs) = self.propagation.evaluate.inputs(&shifts) else {
            return Ok(None);
        };
        self.run(
            &self.propagation.instruments.perturbed(&shifts, None),
            &inputs,
        )
        .map(Some)
    }

    fn of_source(&self, source: Source) -> Result<Effects, String> {
        let mut share = 1.0;
        let [up, down] = loop {
            let sides = [
                self.perturbed(source, share)?,
                self.perturbed(source, -share)?,
            ];
            if sides.iter().any(Option::is_some) {
                break sides;
            }
            if share < LEAST_SHARE {
                return Err(self
                    .propagation
                    .evaluate
                    .inputs(&[(source, share)])
                    .err()
                    .unwrap_or_default());
            }
            share *= 0.5;
        };
        // To the same sides as the full perturbation.
        let half = |whole: &Option<Evaluation>, by: f64| match whole {
            Some(_) => self.perturbed(source, by),
            None => Ok(None),
        };
        let halves = if self.budget.halves {
            Some([half(&up, 0.5 * share)?, half(&down, -0.5 * share)?])
        } else {
            None
        };
        let all = || {
            up.iter()
                .chain(&down)
                .chain(halves.iter().flatten().flatten())
        };
        let effect = |(index, nominal): (usize, &f64)| {
            let sides = |[up, down]: [&Option<Evaluation>; 2]| {
                one_sided(
                    *nominal,
                    [up, down].map(|found| found.as_ref().map(|found| found.values[index])),
                )
            };
            let (amount, smooth) = effect(
                *nominal,
                sides([&up, &down]),
                halves.as_ref().map(|[up, down]| sides([up, down])),
            );
            let known = amount == 0.0 || all().all(|found| found.is_known(index));
            Some((amount / share, smooth && known))
        };
        Ok(self.nominal.values.iter().enumerate().map(effect).collect())
    }

    /// The differences of the results in other steps from the reported ones. Inputs that are results of earlier procedures are those in
    /// the same steps. A procedure without time steps has only such inputs.
    fn of_the_time_step(&self, steps: Refinement) -> Result<Effects, String> {
        let Propagation {
            evaluate,
            instruments,
            reported,
            ..
        } = self.propagation;
        let found = if steps == Refinement::Own {
            self.nominal.clone()
        } else {
            let readings = instruments.perturbed(&[], None);
            let finer = reported.as_ref().map_or(readings.finer, |_| steps.finer());
            self.run(
                &Perturbation { finer, ..readings },
                &evaluate.inputs(&[(Source::TimeStep(steps), 1.0)])?,
            )?
        };
        let reported = reported.as_ref().unwrap_or(&self.nominal.values);
        let effect = |(index, reported): (usize, &f64)| {
            let amount = found.values[index] - reported;
            let known = amount == 0.0 || found.is_known(index);
            reported.is_finite().then_some((amount, known))
        };
        Ok(reported.iter().enumerate().map(effect).collect())
    }

    fn of_trial(&self, trial: u16) -> Result<Effects, String> {
        let evaluate = self.propagation.evaluate;
        let drawn = self.drawn.iter().enumerate();
        let mut shifts: Vec<(Source, f64)> = drawn
            .map(|(index, source)| (*source, sign_of_input(trial, index)))
            .collect();
        if evaluate.inputs(&shifts).is_err() {
            // An input that cannot be perturbed to one side is perturbed to the other.
            for shift in &mut shifts {
                if evaluate.inputs(&[*shift]).is_err() {
                    shift.1 = -shift.1;
                }
            }
        }
        let found = self.run(
            &self.propagation.instruments.perturbed(&shifts, Some(trial)),
            &evaluate.inputs(&shifts)?,
        )?;
        let root = f64::from(self.budget.trials).sqrt();
        // A result that does not exist has no uncertainty; its trials are not evaluated.
        let effect = |(found, nominal): (&f64, &f64)| {
            nominal
                .is_finite()
                .then(|| ((found - nominal) / root, true))
        };
        Ok(found
            .values
            .iter()
            .zip(&self.nominal.values)
            .map(effect)
            .collect())
    }
}

/// Results at both sides; if an input cannot be perturbed to one side, the same difference as at the other side.
fn one_sided(nominal: f64, sides: [Option<f64>; 2]) -> [f64; 2] {
    let mirrored = |value: f64| nominal + (nominal - value);
    match sides {
        [Some(up), Some(down)] => [up, down],
        [Some(up), None] => [up, mirrored(up)],
        [None, Some(down)] => [mirrored(down), down],
        [None, None] => [f64::NAN; 2],
    }
}

/// The effect of a perturbation by ±u, and whether it is smooth: `[up, down]`, and the same at ±u/2 if it was evaluated. If the two sides
/// or the two sizes disagree, the effect is the largest change.
fn effect(nominal: f64, [up, down]: [f64; 2], half: Option<[f64; 2]>) -> (f64, bool) {
    let (above, below, central) = (up - nominal, nominal - down, 0.5 * (up - down));
    let halved = half.map_or(central, |[up, down]| up - down);
    let widest = above.abs().max(below.abs());
    let rounding = CLOSE * nominal.abs();
    let one_sided = (above - below).abs() > ONE_SIDED * widest + rounding;
    let step_dependent = (central - halved).abs() > HALVED * widest + rounding;
    if one_sided || step_dependent {
        return (
            widest
                .max(central.abs())
                .max(halved.abs())
                .copysign(central),
            false,
        );
    }
    (central, true)
}

/// Marks the effects of the time step on a number if the steps do not converge yet.
fn mark_if_not_converging(nominal: f64, parts: &mut [Contribution]) {
    let of = |steps| {
        let part = parts
            .iter()
            .find(|part| part.source == Source::TimeStep(steps));
        part.map_or(0.0, |part| part.amount)
    };
    let [own, half, quarter] = Refinement::ALL.map(of);
    let converges =
        (quarter - half).abs() <= CONVERGES * (own - half).abs() + CLOSE * nominal.abs();
    for part in parts
        .iter_mut()
        .filter(|part| !part.source.is_of_uncertainty())
    {
        part.smooth &= converges;
    }
}

#[cfg(test)]
mod tests;
