//! The cost of a propagation: the number of evaluations. In: the length of a run, its sources. Out: a bound that is the same for every
//! procedure.

use super::{MOST_DRAWS, Source};

/// Smallest number of Monte Carlo trials of the reading errors.
const FEWEST_DRAWS: u16 = 8;
/// Smallest number of trials if inputs are varied in the same trials.
const FEWEST_DRAWS_OF_INPUTS: u16 = 16;
/// Approximate number of steps of all trials together, and of all perturbations of inputs: the cost limit of a long run.
const STEPS_OF_DRAWS: u64 = 512_000;
const STEPS_OF_MOVES: u64 = 512_000;
/// Number of input perturbations that are allowed for a run of any length.
const MOVES_OF_ANY: u64 = 24;

/// The number of evaluations of a propagation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TrialBudget {
    /// Whether every input is also perturbed by half its uncertainty, to check that the results are proportional.
    pub halves: bool,
    /// Whether inputs that exist once per storey are varied together in the trials of the reading errors.
    pub together: bool,
    pub trials: u16,
}

impl TrialBudget {
    /// `steps` of one degree of freedom; `sampled`: whether the readings have errors.
    pub fn new(steps: u64, sources: &[Source], sampled: bool) -> Self {
        let alike = sources.iter().filter(|source| is_alike(**source)).count();
        let together = alike > 0
            && 2 * sources.len() as u64 > (STEPS_OF_MOVES / steps.max(1)).max(MOVES_OF_ANY);
        let moved = if together {
            sources.len() - alike
        } else {
            sources.len()
        } as u64;
        let halves = 4 * moved * steps <= STEPS_OF_MOVES;
        let of_steps = u16::try_from(STEPS_OF_DRAWS / steps.max(1))
            .unwrap_or(u16::MAX)
            .clamp(FEWEST_DRAWS, MOST_DRAWS);
        let trials = match (sampled, together) {
            (_, true) => of_steps.max(FEWEST_DRAWS_OF_INPUTS),
            (true, false) => of_steps,
            (false, false) => 0,
        };
        Self {
            halves,
            together,
            trials,
        }
    }

    /// Whether a source is varied in the trials of the reading errors.
    pub const fn draws(self, source: Source) -> bool {
        self.together && is_alike(source)
    }
}

/// Whether an input is one of many of its kind: one per storey, mode or axis.
const fn is_alike(source: Source) -> bool {
    matches!(
        source,
        Source::StoreyMass { .. }
            | Source::StoreyStiffness { .. }
            | Source::ElementStiffness { .. }
            | Source::DampingRatio { .. }
            | Source::ForceScale(_)
            | Source::DisplacementScale(_)
            | Source::ForceZero(_)
            | Source::ForceBelowRange(_)
            | Source::DisplacementBelowRange(_)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However long the run and however many its inputs, a propagation needs only a few times as many steps.
    #[test]
    fn the_cost_of_a_study_is_bounded() {
        let sources = |inputs: usize, alike: usize| -> Vec<Source> {
            (0..inputs - alike)
                .map(Source::StrikerMass)
                .chain((0..alike).map(Source::ForceScale))
                .collect()
        };
        let runs = |steps, inputs, alike| {
            let budget = TrialBudget::new(steps, &sources(inputs, alike), true);
            let moved = if budget.together {
                inputs - alike
            } else {
                inputs
            };
            moved * if budget.halves { 4 } else { 2 } + usize::from(budget.trials)
        };
        assert_eq!(
            TrialBudget::new(1000, &sources(7, 3), true),
            TrialBudget {
                halves: true,
                together: false,
                trials: 64
            }
        );
        assert_eq!(TrialBudget::new(1000, &sources(7, 3), false).trials, 0);
        for steps in [1_u64, 100, 8_000, 52_000, 1_000_000, 10_000_000] {
            for alike in [0, 3, 320] {
                let inputs = alike + 8;
                let bound = (STEPS_OF_DRAWS + STEPS_OF_MOVES).max(steps * (MOVES_OF_ANY + 16));
                let runs = runs(steps, inputs, alike) as u64;
                assert!(
                    runs * steps <= bound || inputs * 4 + 64 >= 1300,
                    "{runs} runs of {steps} steps, {inputs} inputs"
                );
            }
        }
        assert_eq!(runs(52_000, 6, 3), 2 * 6 + 9);
        assert_eq!(runs(10_000_000, 328, 320), 2 * 8 + 16);
    }
}
