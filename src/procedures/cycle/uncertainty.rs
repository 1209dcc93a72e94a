//! The uncertainty of the results of a `cycle`. In: the recorded loops. Out: the contributions of each source, and of the unknown curve
//! between the points of each loop. The backbone fit has its own scatter, and is not touched here.

use psd_plan::schema::ResultKind;
use std::convert::Infallible;

use super::results::results;
use crate::procedures::common::fit_uncertainty::Fits;
use crate::procedures::common::loop_sampling::{left_open_by, of_open};
use crate::procedures::common::results::{Layout, give, index_of, values};
use crate::procedures::stiffness_ramp::curve;
use psd_physics::identification::cyclic::{LoopPoint, loop_of};
use psd_physics::reintegration::perturbation::{Perturbation, ReadingErrors};
use psd_plan::Cycle;
use psd_plan::formula::ProcedureId;
use psd_plan::procedures::cycle::block as schema;
use psd_plan::record::{CycleHistory, CycleStep, NamedResult, WholeCycle};
use psd_plan::uncertainty::engine::{Evaluate, Evaluation, Propagation, Shifts};
use psd_plan::uncertainty::{Contribution, InstrumentUncertainty, Source};

/// Results with one entry per cycle.
const LISTS: [&str; 4] = [
    schema::AMPLITUDES.name,
    schema::ENERGIES.name,
    schema::DAMPING_RATIOS.name,
    schema::STIFFNESSES.name,
];

/// Results that follow from the loops.
const OF_LOOPS: [&str; 6] = [
    schema::DISSIPATED_ENERGY.name,
    schema::MAX_FORCE.name,
    schema::MIN_FORCE.name,
    schema::EQUIVALENT_DAMPING_RATIO.name,
    schema::STIFFNESS.name,
    schema::LAST_STIFFNESS.name,
];

/// The points of a backbone, in words.
pub(crate) const ENDS: &str = "ends of first cycles";

/// The recorded loops.
pub(crate) struct RecordedLoops<'a> {
    pub history: &'a CycleHistory,
    /// Number of samples of which each reading is the mean.
    pub samples: u32,
    /// Noise of the cell in this run \[N\].
    pub noise: f64,
    /// The part of the energy of each loop that its points leave undetermined \[J\].
    pub left_open: &'a [f64],
}

impl RecordedLoops<'_> {
    /// The results that follow from them.
    fn layout(&self) -> Layout {
        let lists = LISTS
            .into_iter()
            .map(|name| (name, self.history.cycles.len()));
        OF_LOOPS
            .into_iter()
            .map(|name| (name, 1))
            .chain(lists)
            .collect()
    }
}

impl Evaluate for RecordedLoops<'_> {
    type Inputs = ();

    fn inputs(&self, _: Shifts<'_>) -> Result<(), String> {
        Ok(())
    }

    fn evaluate(&self, readings: &Perturbation, (): &()) -> Evaluation {
        let mut perturbed = perturbed(self.history, readings, self.samples);
        for cycle in &mut perturbed.cycles {
            let points: Vec<LoopPoint> = points_of(&perturbed.steps, cycle)
                .map(CycleStep::point)
                .collect();
            if let Some(found) = loop_of(&points) {
                cycle.found = found;
            }
        }
        let noise = readings
            .trial
            .map_or(self.noise, |_| readings.axes[0].errors.noise);
        Evaluation::of_readings(values(
            &self.layout(),
            &results(&perturbed, noise / f64::from(self.samples).sqrt()),
        ))
    }
}

/// The readings of perturbed instruments, with means of so many samples; without a fit.
fn perturbed(history: &CycleHistory, by: &Perturbation, samples: u32) -> CycleHistory {
    let mut other = CycleHistory {
        backbone: None,
        ..history.clone()
    };
    for step in &mut other.steps {
        let exact = (step.displacement, step.restoring_force);
        (step.displacement, step.restoring_force) = by.read(step.step, 0, samples, exact);
    }
    other
}

/// Calls with the fit of the backbone; the loops have their contributions already.
pub(crate) fn with_fits(
    history: &CycleHistory,
    plan: &Cycle,
    instruments: &InstrumentUncertainty,
    give: &mut dyn FnMut(&Fits<'_>),
) {
    let shown = history.backbone.as_ref().map_or(1.0, |fit| fit.shown);
    let stated = instruments.stated_variance(0, plan.samples);
    let refit = |by: &Perturbation| {
        let points = perturbed(history, by, plan.samples).backbone_points();
        let fit = plan
            .fit
            .and_then(|count| curve::fitted(&points, count, ENDS, stated).0);
        let mut results = curve::yielding(fit.as_ref()).to_vec();
        results.extend(curve::lists(fit.as_ref()));
        results
    };
    give(&Fits {
        refit: Some(&refit),
        line: None,
        bilinear: None,
        curve: history.backbone.as_ref(),
        shown: &|_| shown,
        common_resolution: true,
    });
}

/// Gives the results of the loops their contributions.
pub(crate) fn propagate(
    loops: &RecordedLoops<'_>,
    instruments: &InstrumentUncertainty,
    procedure: ProcedureId,
    results: &mut [NamedResult],
) {
    let propagation = Propagation {
        procedure,
        impact: 0,
        evaluate: loops,
        instruments,
        inputs: Vec::new(),
        steps: loops.history.steps.len() as u64,
        reported: None,
        nominal: None,
    };
    let layout = loops.layout();
    // Inputs have no bounds here, and no one waits for progress.
    if let Ok(mut contributions) = propagation.contributions::<Infallible>(&mut |_, _| Ok(())) {
        for (kind, entry, amount) in of_sampling(loops.history, loops.left_open) {
            let sampling = Contribution::new(Source::LoopSampling { procedure }, amount);
            if let Some(first) = index_of(&layout, kind) {
                contributions[first + entry].push(sampling);
            }
        }
        give(&layout, contributions, results);
    }
}

/// The part of the energy of each loop that its points leave undetermined \[J\]; each reading is the mean of so many samples.
pub(crate) fn left_open_by_points(
    history: &CycleHistory,
    samples: u32,
    errors: ReadingErrors,
) -> Vec<f64> {
    let of_cycle = |cycle: &WholeCycle| {
        let points =
            points_of(&history.steps, cycle).map(|step| (step.displacement, step.restoring_force));
        left_open_by(
            &points.collect::<Vec<_>>(),
            cycle.found.stiffness.unwrap_or(0.0),
            errors,
            samples,
        )
    };
    history.cycles.iter().map(of_cycle).collect()
}

/// Uncertainties of the results due to the points of the loops. Loops are alike, and so are their corners.
fn of_sampling(history: &CycleHistory, open: &[f64]) -> Vec<(ResultKind, usize, f64)> {
    let uncertain: Vec<f64> = open.iter().copied().map(of_open).collect();
    // ζ = E_D/(4π·½K a²)
    let ratio = |(cycle, energy): (&WholeCycle, &f64)| {
        let stored = 0.5 * cycle.found.stiffness? * cycle.found.amplitude * cycle.found.amplitude;
        (stored > 0.0).then(|| energy / (4.0 * std::f64::consts::PI * stored))
    };
    let ratios: Vec<f64> = history
        .cycles
        .iter()
        .zip(&uncertain)
        .map(|each| ratio(each).unwrap_or(0.0))
        .collect();
    let of_each = uncertain.iter().zip(&ratios).enumerate();
    let lists = of_each.flat_map(|(entry, (energy, ratio))| {
        [
            (schema::ENERGIES, entry, *energy),
            (schema::DAMPING_RATIOS, entry, *ratio),
        ]
    });
    let whole = [
        (schema::DISSIPATED_ENERGY, 0, uncertain.iter().sum()),
        (
            schema::EQUIVALENT_DAMPING_RATIO,
            0,
            ratios.last().copied().unwrap_or(0.0),
        ),
    ];
    lists.chain(whole).collect()
}

/// The readings of a cycle, which begins with the last one of the cycle before it.
fn points_of<'a>(
    steps: &'a [CycleStep],
    cycle: &WholeCycle,
) -> impl Iterator<Item = &'a CycleStep> {
    let first = steps.partition_point(|step| step.cycle < cycle.cycle);
    let after = steps.partition_point(|step| step.cycle <= cycle.cycle);
    steps[first.saturating_sub(1)..after].iter()
}

#[cfg(test)]
mod tests;
