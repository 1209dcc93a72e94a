//! The points of a study in the unit cube: random, a Latin hypercube, or a Sobol' sequence. In: a seed, a run, an input. Out: a number
//! between 0 and 1. It knows no distribution and no model.
//!
//! A number depends on the seed, the run and the input alone. A study of random or Sobol' points may grow, and a smaller study is the
//! beginning of the larger one, bit for bit. A Latin hypercube divides every input into as many strata as it has runs, so it cannot grow.

mod direction_numbers;
pub mod latin_hypercube;
mod mixing;
pub mod philox;
pub mod sobol;

use thiserror::Error;

use latin_hypercube::Permutation;
use philox::{Philox, Purpose};
use sobol::SobolSequence;

/// How the points of a study are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Independent points.
    Random,
    /// One point in each of `runs` strata of every input.
    LatinHypercube { runs: u64 },
    /// Scrambled Sobol' sequences, run by run in turn. The scatter of their means gives an interval; 16 are enough for it.
    Sobol { replicates: u32 },
}

/// The reason why a design has no points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum DesignError {
    #[error("a Latin hypercube has at least one run")]
    NoRuns,
    #[error("a Sobol' study has at least one replicate")]
    NoReplicates,
    #[error("a Sobol' sequence has at most {most} inputs, here {inputs}", most = sobol::MOST_INPUTS)]
    TooManyInputs { inputs: usize },
}

/// The points of a design.
#[derive(Clone, Debug)]
pub struct Sampler {
    stream: Philox,
    points: Points,
}

#[derive(Clone, Debug)]
enum Points {
    Random,
    /// One permutation of the strata for each input.
    LatinHypercube(Vec<Permutation>),
    Sobol {
        replicates: u64,
        sequence: SobolSequence,
    },
}

impl Sampler {
    /// The points of `inputs` inputs.
    ///
    /// # Errors
    /// A Latin hypercube without runs; a Sobol' study without replicates or with too many inputs.
    pub fn new(design: Design, seed: u64, inputs: u32) -> Result<Self, DesignError> {
        let stream = Philox::new(seed);
        let points = match design {
            Design::Random => Points::Random,
            Design::LatinHypercube { runs: 0 } => return Err(DesignError::NoRuns),
            Design::LatinHypercube { runs } => {
                let key = |input| stream.bits(Purpose::Permutation, 0, input);
                let of_input = |input| Permutation::new(runs, key(input));
                Points::LatinHypercube((0..inputs).map(of_input).collect())
            }
            Design::Sobol { replicates: 0 } => return Err(DesignError::NoReplicates),
            Design::Sobol { replicates } => Points::Sobol {
                replicates: u64::from(replicates),
                sequence: SobolSequence::new(inputs as usize)?,
            },
        };
        Ok(Self { stream, points })
    }

    /// The number of this input in this run, between 0 and 1, both excluded.
    ///
    /// # Panics
    /// If there is no such input, or no such run in a Latin hypercube.
    #[must_use]
    pub fn uniform(&self, run: u64, input: u32) -> f64 {
        match &self.points {
            Points::Random => self.stream.uniform(Purpose::Value, run, input),
            Points::LatinHypercube(permutations) => {
                let inside = self.stream.uniform(Purpose::Value, run, input);
                permutations[input as usize].point(run, inside)
            }
            Points::Sobol {
                replicates,
                sequence,
            } => {
                let key = self.stream.bits(Purpose::Scramble, run % replicates, input);
                sequence.scrambled(run / replicates, input as usize, key)
            }
        }
    }
}

/// The upper 52 bits as a number between 0 and 1, the middle of its interval of width 2⁻⁵². Both ends are excluded, 1 − u is exact.
#[expect(clippy::cast_precision_loss, reason = "52 bits fit")]
fn unit_interval(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_inside_the_interval() {
        assert_eq!(unit_interval(0), f64::EPSILON / 2.0);
        assert_eq!(unit_interval(u64::MAX), 1.0 - f64::EPSILON / 2.0);
    }

    /// Runs taken backwards, one by one from new samplers, are the runs of one sampler, bit for bit.
    #[test]
    fn a_point_depends_on_seed_run_and_input_alone() {
        for design in [
            Design::Random,
            Design::LatinHypercube { runs: 1000 },
            Design::Sobol { replicates: 16 },
        ] {
            let sampler = Sampler::new(design, 5, 4).unwrap();
            let forwards: Vec<u64> = (0..1000)
                .flat_map(|run| (0..4).map(move |input| (run, input)))
                .map(|(run, input)| sampler.uniform(run, input).to_bits())
                .collect();
            for (at, expected) in forwards.iter().enumerate().rev() {
                // More inputs than before: the earlier ones keep their numbers.
                let sampler = Sampler::new(design, 5, 4 + u32::from(at.is_multiple_of(3))).unwrap();
                let (run, input) = (at as u64 / 4, u32::try_from(at % 4).unwrap());
                assert_eq!(sampler.uniform(run, input).to_bits(), *expected);
            }
            let other = Sampler::new(design, 6, 4).unwrap();
            assert_ne!(other.uniform(0, 0).to_bits(), forwards[0]);
        }
    }

    #[test]
    fn a_design_without_points_is_refused() {
        let refused = |design, inputs| Sampler::new(design, 1, inputs).err();
        assert_eq!(
            refused(Design::LatinHypercube { runs: 0 }, 1),
            Some(DesignError::NoRuns)
        );
        assert_eq!(
            refused(Design::Sobol { replicates: 0 }, 1),
            Some(DesignError::NoReplicates)
        );
        assert_eq!(
            refused(Design::Sobol { replicates: 1 }, 65),
            Some(DesignError::TooManyInputs { inputs: 65 })
        );
    }
}
