//! Many impacts at once, for studies. In: the inputs of the impacts and their specimens. Out: the results of each, bit for bit those of
//! [`super::simulate`]. It keeps no steps.
//!
//! The tangent form under the rigid and the limit law, with elastic and bilinear specimens and exact readings, runs in lanes: one loop steps
//! thirty-two impacts with the vectors of the processor. The equations of contact, motion, specimen and results are those of a single
//! impact, written for any [`crate::number::Number`]: branches are selections, and no product and sum are fused. An impact that ends
//! gives its lane to the next one. All other impacts run one by one.

mod lanes;
mod reach;
mod rows;
#[cfg(test)]
mod tests;

use fearless_simd::{Level, Simd, dispatch};

use super::summary::{
    ImpactEnding, ImpactSummary, LastEnd, RunningResults, SummaryBuilder, Wanted,
};
use super::{ImpactError, ImpactInput, ImpactSolver, ImpactState, Sink, Until, simulate};
use crate::contact::ContactLaw;
use crate::integrator::Integrator;
use crate::integrator::state::State;
use crate::specimen::{Bilinear, Elastic, RestoringForce, SpecimenModel};
use crate::statistics::DeclaredNoise;
use lanes::Lanes;
pub use reach::Reach;
use reach::RunningReach;
use rows::LANES;

/// An impact on an ideal rig from rest at X = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    pub input: ImpactInput,
    pub specimen: SpecimenModel,
}

/// The results of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Batched {
    pub summary: ImpactSummary,
    pub ending: ImpactEnding,
    pub reach: Reach,
}

impl Batched {
    /// After `steps` steps; `before` are the results before the last one.
    fn new(
        summary: ImpactSummary,
        steps: u64,
        [before, after]: [&RunningResults; 2],
        reach: &RunningReach,
        last: &LastEnd,
    ) -> Self {
        let grown = |now: f64, before: f64| now > 0.0 && now > before;
        Self {
            ending: ImpactEnding {
                still_striking: steps > 0 && summary.stop_time.is_none(),
                touched: summary.contacts > 0,
                still_rising: summary.still_rising,
                speeding_up: grown(last.velocity.abs(), before.max_velocity),
                pushing_harder: grown(last.contact_force, before.max_contact_force),
            },
            reach: reach.finish(after),
            summary,
        }
    }
}

/// Sums up the steps of an impact that runs alone.
struct Builder {
    summary: SummaryBuilder,
    /// Before the last step.
    before: RunningResults,
    steps: u64,
    reach: RunningReach,
    /// X at the last step end.
    displacement: f64,
}

impl<V> Sink<V> for Builder {
    fn push(&mut self, _: &State<V>, state: &ImpactState, _: bool) {
        self.before = self.summary.results;
        self.steps = state.step;
        self.summary.push(state);
        self.reach.add(self.displacement, &state.step_end());
        self.displacement = state.displacement;
    }
}

/// The specimen of an impact in a lane: elastic is bilinear without a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LaneSpecimen {
    Elastic(Elastic),
    Bilinear(Bilinear),
}

impl Impact {
    /// Whether it runs in a lane with this end condition.
    #[must_use]
    pub fn is_batched(&self, until: Option<Until>) -> bool {
        self.lane_specimen(until).is_some()
    }

    fn lane_specimen(&self, until: Option<Until>) -> Option<LaneSpecimen> {
        let input = &self.input;
        let exact = input.noise == DeclaredNoise::NONE;
        let law = matches!(input.law, ContactLaw::Rigid | ContactLaw::Limit { .. });
        if matches!(until, Some(Until::Rebound | Until::Drift(_)))
            || input.integrator != Integrator::Tangent
            || !(exact && law)
        {
            return None;
        }
        match &self.specimen {
            SpecimenModel::Elastic(model) => Some(LaneSpecimen::Elastic(*model)),
            SpecimenModel::Bilinear(model) if model.is_undisplaced() => {
                Some(LaneSpecimen::Bilinear(*model))
            }
            _ => None,
        }
    }

    /// The results of this impact alone.
    ///
    /// # Errors
    /// As [`ImpactSolver::new`].
    pub fn run(&self, until: Option<Until>, steps: u64) -> Result<Batched, ImpactError> {
        let start = ImpactSolver::new(&self.input, 0.0, self.specimen.clone().move_to(0.0))?;
        let mut builder = Builder {
            summary: SummaryBuilder::new(&self.input),
            before: RunningResults::START,
            steps: 0,
            reach: RunningReach::START,
            displacement: 0.0,
        };
        builder.push(start.structure(), start.state(), false);
        self.simulate(until, steps, &mut builder)?;
        let Builder {
            summary,
            before,
            steps,
            reach,
            ..
        } = builder;
        let (after, last) = (summary.results, summary.last);
        let results = [&before, &after];
        Ok(Batched::new(
            summary.finish(),
            steps,
            results,
            &reach,
            &last,
        ))
    }

    /// The steps of this impact alone.
    ///
    /// # Errors
    /// As [`ImpactSolver::new`].
    pub fn simulate<K: Sink>(
        &self,
        until: Option<Until>,
        steps: u64,
        sink: &mut K,
    ) -> Result<(), ImpactError> {
        let mut specimen = self.specimen.clone();
        simulate(&self.input, &mut specimen, until, steps, sink)?;
        Ok(())
    }
}

/// The results of many impacts, in their order: each until its end or for so many steps. A result that is not wanted is that of the start.
///
/// # Errors
/// Each impact has its own, as [`ImpactSolver::new`].
#[must_use]
pub fn run(
    impacts: &[Impact],
    until: Option<Until>,
    steps: u64,
    wanted: Wanted,
) -> Vec<Result<Batched, ImpactError>> {
    run_on(Level::new(), impacts, until, steps, wanted)
}

/// With these vectors of the processor. The results are the same for all.
fn run_on(
    level: Level,
    impacts: &[Impact],
    until: Option<Until>,
    steps: u64,
    wanted: Wanted,
) -> Vec<Result<Batched, ImpactError>> {
    // Lanes differ in what their loop contains: yielding specimens, limited forces.
    let mut queues: [Vec<usize>; 4] = Default::default();
    let mut results: Vec<Option<Result<Batched, ImpactError>>> = Vec::new();
    for (index, impact) in impacts.iter().enumerate() {
        let start = ImpactSolver::new(&impact.input, 0.0, 0.0);
        results.push(match (start, impact.lane_specimen(until)) {
            (Err(error), _) => Some(Err(error)),
            (Ok(_), Some(specimen)) if steps > 0 => {
                let yields = matches!(specimen, LaneSpecimen::Bilinear(_));
                let limited = impact.input.law != ContactLaw::Rigid;
                queues[usize::from(yields) + 2 * usize::from(limited)].push(index);
                None
            }
            (Ok(_), _) => Some(impact.run(until, steps)),
        });
    }
    let [plain, yielding, limited, both] = queues;
    let terms = Terms {
        ends_at_stop: until.is_some_and(|until| until == Until::StrikerStop),
        steps,
        wanted,
    };
    let mut take = |index: usize, result| results[index] = Some(Ok(result));
    dispatch!(level, simd => {
        in_lanes::<_, false, false>(simd, impacts, &plain, &terms, &mut take);
        in_lanes::<_, true, false>(simd, impacts, &yielding, &terms, &mut take);
        in_lanes::<_, false, true>(simd, impacts, &limited, &terms, &mut take);
        in_lanes::<_, true, true>(simd, impacts, &both, &terms, &mut take);
    });
    let finished = impacts
        .iter()
        .zip(results)
        .map(|(impact, result)| match result {
            // Beyond the largest numbers, selections and branches differ in what is not a number.
            Some(Ok(result)) if !is_finite(&result.summary) => impact.run(until, steps),
            Some(result) => result,
            None => impact.run(until, steps),
        });
    finished.collect()
}

fn is_finite(summary: &ImpactSummary) -> bool {
    summary.energy_error.is_finite() && summary.final_displacement.is_finite()
}

/// When impacts end, and what is found of them.
struct Terms {
    ends_at_stop: bool,
    /// At most.
    steps: u64,
    wanted: Wanted,
}

/// Steps the impacts at these places, thirty-two at a time. A part of its caller, which is compiled for several vector units.
#[allow(
    clippy::inline_always,
    reason = "a function of its own has the vectors of the portable build"
)]
#[inline(always)]
fn in_lanes<S: Simd, const YIELDS: bool, const LIMITED: bool>(
    simd: S,
    impacts: &[Impact],
    indices: &[usize],
    terms: &Terms,
    take: &mut impl FnMut(usize, Batched),
) {
    let Terms {
        ends_at_stop,
        steps,
        wanted,
    } = *terms;
    if indices.is_empty() {
        return;
    }
    let mut lanes = Lanes::new(wanted);
    let mut waiting = indices.iter().copied();
    let mut running: [Option<usize>; LANES] = [None; LANES];
    let mut begin = |lanes: &mut Lanes, lane: usize| {
        let index = waiting.next();
        if let Some(index) = index {
            lanes.begin(lane, &impacts[index], steps);
        } else {
            lanes.rest(lane);
        }
        index
    };
    for (lane, running) in running.iter_mut().enumerate() {
        *running = begin(&mut lanes, lane);
    }
    lanes.look_ahead(ends_at_stop);
    let mut refill = |lanes: &mut Lanes| {
        lanes.follow();
        for (lane, running) in running.iter_mut().enumerate() {
            if let Some(index) = *running
                && lanes.is_over(lane)
            {
                take(index, lanes.results(lane, &impacts[index].input));
                *running = begin(lanes, lane);
            }
        }
        lanes.look_ahead(ends_at_stop);
        running.iter().any(Option::is_some)
    };
    loop {
        if lanes.step::<S, YIELDS, LIMITED, 0>(simd) && !refill(&mut lanes) {
            break;
        }
        if lanes.step::<S, YIELDS, LIMITED, 1>(simd) && !refill(&mut lanes) {
            break;
        }
    }
}
