//! The input values of every run of a study. In: a study or a fragility of the plan, its number of runs. Out: the values of run i, which
//! depend on the seed and i alone. It knows no plan text and no result.

use psd_physics::study::inputs::{InputError, StudyInputs};
use psd_physics::study::sampling::Design;
use psd_plan::study::{REPLICATES, Sampling, Variation};

/// Difference of the seeds of two stripes: the odd number nearest to 2⁶⁴ over the golden ratio, so that near seeds give unrelated streams.
const BETWEEN_STRIPES: u64 = 0x9e37_79b9_7f4a_7c15;

/// The values of all runs.
#[derive(Clone, Debug)]
pub struct Draws {
    /// Values of the intensity, SI; empty for a study.
    stripes: Vec<f64>,
    /// One for a study, one for each stripe of a fragility; none if a fragility varies nothing else.
    inputs: Vec<StudyInputs>,
}

impl Draws {
    /// The values of a study of `runs` runs.
    ///
    /// # Errors
    /// As [`StudyInputs::new`].
    pub fn of_study(variation: &Variation, runs: u64) -> Result<Self, InputError> {
        Ok(Self {
            stripes: Vec::new(),
            inputs: vec![inputs(variation, variation.seed, runs)?],
        })
    }

    /// The values of a fragility with `runs` runs at each of its `stripes`: run i is number i / stripes at stripe i mod stripes. So
    /// more runs leave the first ones as they are.
    ///
    /// # Errors
    /// As [`StudyInputs::new`].
    pub fn of_fragility(
        stripes: &[f64],
        variation: Option<&Variation>,
        runs: u64,
    ) -> Result<Self, InputError> {
        let of_stripe = |stripe: u64, variation: &Variation| {
            let seed = variation
                .seed
                .wrapping_add(stripe.wrapping_mul(BETWEEN_STRIPES));
            inputs(variation, seed, runs)
        };
        let inputs = match variation {
            Some(variation) => (0..stripes.len() as u64)
                .map(|stripe| of_stripe(stripe, variation))
                .collect::<Result<_, _>>()?,
            None => Vec::new(),
        };
        Ok(Self {
            stripes: stripes.to_vec(),
            inputs,
        })
    }

    /// The values of a study at a point in standard normal space; they replace those in `values`.
    pub fn at(&self, point: &[f64], values: &mut Vec<f64>) {
        self.inputs[0].at(point, values);
    }

    /// The values of a run, in the order of the columns of inputs; they replace those in `values`.
    pub fn draw(&self, run: u64, values: &mut Vec<f64>) {
        values.clear();
        let stripes = self.stripes.len() as u64;
        if stripes == 0 {
            self.inputs[0].draw(run, values);
            return;
        }
        let stripe = usize::try_from(run % stripes).expect("below the number of stripes");
        if let Some(inputs) = self.inputs.get(stripe) {
            inputs.draw(run / stripes, values);
        }
        values.insert(0, self.stripes[stripe]);
    }
}

fn inputs(variation: &Variation, seed: u64, runs: u64) -> Result<StudyInputs, InputError> {
    let design = match variation.sampling {
        // The points of a subset simulation follow from its runs: see `at`.
        Sampling::Random | Sampling::Subset => Design::Random,
        Sampling::LatinHypercube => Design::LatinHypercube { runs },
        Sampling::Sobol => Design::Sobol {
            replicates: REPLICATES,
        },
    };
    StudyInputs::new(
        variation.sources.clone(),
        &variation.correlations,
        design,
        seed,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::testing::variation;

    fn values(draws: &Draws, runs: u64) -> Vec<Vec<f64>> {
        let mut values = Vec::new();
        let mut of_run = |run| {
            draws.draw(run, &mut values);
            values.clone()
        };
        (0..runs).map(&mut of_run).collect()
    }

    #[test]
    fn more_runs_at_each_stripe_leave_the_first_ones_as_they_are() {
        let stripes = [0.5, 1.0, 1.5];
        for sampling in [Sampling::Random, Sampling::Sobol] {
            let variation = Variation {
                sampling,
                ..variation()
            };
            let of = |runs| Draws::of_fragility(&stripes, Some(&variation), runs).unwrap();
            let [short, long] = [10, 40].map(|runs| values(&of(runs), 3 * runs));
            assert_eq!(long[..30], short);
            assert!(
                short
                    .iter()
                    .enumerate()
                    .all(|(i, run)| run[0] == stripes[i % 3])
            );
            assert_ne!(short[0][1], short[1][1], "stripes are drawn apart");
        }
    }

    /// Every stripe is a whole hypercube: each tenth of the range of the first input is met once.
    #[test]
    fn each_stripe_is_a_latin_hypercube() {
        let variation = Variation {
            sampling: Sampling::LatinHypercube,
            ..variation()
        };
        let draws = Draws::of_fragility(&[1.0, 2.0], Some(&variation), 10).unwrap();
        let law = match &variation.sources[0] {
            psd_physics::study::inputs::Source::Distribution(law) => *law,
            rows @ psd_physics::study::inputs::Source::Rows(_) => panic!("{rows:?}"),
        };
        for stripe in 0..2 {
            let mut tenths: Vec<u32> = values(&draws, 20)
                .into_iter()
                .skip(stripe)
                .step_by(2)
                .map(|run| {
                    (0..10)
                        .take_while(|tenth| {
                            let edge = f64::from(tenth + 1) / 10.0;
                            law.quantile(psd_physics::study::distribution::Tails::of_uniform(
                                edge.min(1.0 - f64::EPSILON),
                            )) <= run[1]
                        })
                        .count()
                        .try_into()
                        .unwrap()
                })
                .collect();
            tenths.sort_unstable();
            assert_eq!(tenths, (0..10).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_fragility_without_other_inputs_has_its_intensity_alone() {
        let draws = Draws::of_fragility(&[1.0, 2.0], None, 5).unwrap();
        assert_eq!(values(&draws, 3), [[1.0], [2.0], [1.0]]);
    }
}
