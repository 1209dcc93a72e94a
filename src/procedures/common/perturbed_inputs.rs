//! A run whose inputs are perturbed, for every procedure that is re-integrated. In: formulas, results, perturbed sources. Out: the
//! uncertain sources of the formulas, inputs with those sources perturbed, contributions.

use crate::run::inputs::Inputs;
use crate::run::stop::Stop;
use psd_plan::formula::{Formula, ProcedureId, Results, UncertaintyStatus};
use psd_plan::uncertainty::engine::{
    Contributions, Evaluate, Evaluation, Progress, Propagation, Shifts, Unknown,
};
use psd_plan::uncertainty::{InstrumentUncertainty, Moved, Source, sources_of};
use psd_plan::{DeclaredNoise, Plan};

/// The reason why no uncertainty of a run is reported.
pub(crate) const LEADS_ELSEWHERE: &str =
    "re-integration along the recorded path does not reproduce the recorded results";

/// A run of a procedure whose results are uncertain.
#[derive(Clone, Copy)]
pub(crate) struct UncertainRun<'run> {
    pub whole: &'run Plan,
    pub results: &'run dyn Results,
    pub procedure: ProcedureId,
    pub noise: DeclaredNoise,
    /// The amount by which its damping ratio was raised to zero.
    lift: f64,
    /// Index of the impact in the procedure, from 0: each impact has its own errors.
    pub impact: u16,
}

impl<'run> UncertainRun<'run> {
    pub(crate) fn new(whole: &'run Plan, inputs: &Inputs<'run>, noise: DeclaredNoise) -> Self {
        Self {
            whole,
            results: inputs.results(),
            procedure: inputs.procedure(),
            noise,
            lift: inputs.lift(),
            impact: 0,
        }
    }

    /// For a later impact of the same procedure, counted from 0.
    pub(crate) fn of_impact(self, index: usize) -> Self {
        Self {
            impact: u16::try_from(index).unwrap_or(u16::MAX),
            ..self
        }
    }

    /// The instruments on so many axes.
    pub(crate) fn instruments(&self, axes: usize) -> InstrumentUncertainty {
        InstrumentUncertainty::of(self.whole, self.noise, axes)
    }

    /// Calls with inputs that evaluate results with the sources perturbed.
    pub(crate) fn with_inputs<T>(
        &self,
        shifts: Shifts<'_>,
        then: &mut dyn FnMut(&mut Inputs<'_>) -> Result<T, Stop>,
    ) -> Result<T, String> {
        let results = &Moved {
            results: self.results,
            shifts,
        };
        then(&mut Inputs::moved(results, self.procedure, self.lift))
            .map_err(|stop| out_of_bounds(&stop))
    }

    /// Contributions of the inputs and of the instruments on so many `axes` to the values of a recorded run.
    pub(crate) fn contributions<P: Evaluate>(
        &self,
        evaluate: &P,
        axes: usize,
        inputs: Vec<Source>,
        recorded: RecordedValues,
        progress: Progress<'_, Stop>,
    ) -> Result<Contributions, Unknown<Stop>> {
        let propagation = Propagation {
            procedure: self.procedure,
            impact: self.impact,
            evaluate,
            instruments: &self.instruments(axes),
            inputs,
            steps: (recorded.steps * axes) as u64,
            reported: Some(recorded.reported),
            nominal: recorded.nominal,
        };
        propagation.contributions(progress)
    }
}

/// The values of a run along its recorded path.
pub(crate) struct RecordedValues {
    /// Number of recorded steps.
    pub steps: usize,
    /// As the run reported them.
    pub reported: Vec<f64>,
    /// As they follow from the recorded path; None: they are evaluated.
    pub nominal: Option<Evaluation>,
}

/// Sources of the results and statements that `formulas` read, followed by the `stated` ones with their uncertainties.
///
/// # Errors
/// The uncertainty of a result that they read is withheld.
pub(crate) fn uncertain_inputs(
    formulas: &[&Formula],
    stated: impl Iterator<Item = (Source, f64)>,
    results: &dyn Results,
) -> Result<Vec<Source>, String> {
    let mut references = Vec::new();
    for formula in formulas {
        formula.collect_references(&mut references);
    }
    for reference in &references {
        if let UncertaintyStatus::Withheld(why) = results.uncertainty_status(*reference, None) {
            return Err(why);
        }
    }
    let mut sources = sources_of(&references, results);
    for formula in formulas {
        formula.collect_stated(&mut sources);
    }
    sources.extend(
        stated
            .filter(|(_, uncertainty)| *uncertainty > 0.0)
            .map(|(source, _)| source),
    );
    Ok(sources)
}

pub(crate) fn out_of_bounds(stop: &Stop) -> String {
    format!("an input perturbed by its uncertainty is invalid: {stop}")
}
