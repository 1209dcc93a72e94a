//! The inputs of a study. In: distributions, rows of a measured table, rank correlations, a design of points. Out: the values of run i,
//! which depend on the seed and i alone. It knows no model.

use thiserror::Error;

use super::correlation::{Correlation, CorrelationError, Pair};
use super::distribution::{Distribution, Tails, normal};
use super::sampling::{Design, DesignError, Sampler};

/// Where one or several values of a run come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// One value.
    Distribution(Distribution),
    /// A whole row of a table of measurements, every row as likely, with one value from each column. What was measured together stays
    /// together.
    Rows(Vec<Vec<f64>>),
}

/// The reason why a study has no inputs.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum InputError {
    #[error(transparent)]
    Design(#[from] DesignError),
    #[error(transparent)]
    Correlation(#[from] CorrelationError),
    #[error("a study has at least one input")]
    NoInputs,
    #[error("a table of measurements has at least one row and one column")]
    EmptyTable(usize),
    #[error(
        "row {row} differs from the first row in its number of values, or has a value that is not finite"
    )]
    DefectiveRow { source_at: usize, row: usize },
    #[error("the rows of a table are drawn together and cannot be correlated with another input")]
    CorrelatedTable(usize),
}

/// The inputs, with the points at which they are drawn.
#[derive(Clone, Debug)]
pub struct StudyInputs {
    sources: Vec<Source>,
    correlation: Option<Correlation>,
    sampler: Sampler,
}

impl StudyInputs {
    /// `pairs` refer to `sources` by their places.
    ///
    /// # Errors
    /// No inputs, a defective table, correlations that contradict each other, a design that does not go with so many inputs.
    pub fn new(
        sources: Vec<Source>,
        pairs: &[Pair],
        design: Design,
        seed: u64,
    ) -> Result<Self, InputError> {
        if sources.is_empty() {
            return Err(InputError::NoInputs);
        }
        for (at, source) in sources.iter().enumerate() {
            let Source::Rows(rows) = source else { continue };
            let width = rows.first().map_or(0, Vec::len);
            if width == 0 {
                return Err(InputError::EmptyTable(at));
            }
            let sound = |row: &Vec<f64>| row.len() == width && row.iter().all(|v| v.is_finite());
            if let Some(row) = rows.iter().position(|row| !sound(row)) {
                return Err(InputError::DefectiveRow { source_at: at, row });
            }
            if pairs.iter().any(|pair| pair.inputs.contains(&at)) {
                return Err(InputError::CorrelatedTable(at));
            }
        }
        let count = u32::try_from(sources.len()).map_err(|_| DesignError::TooManyInputs {
            inputs: sources.len(),
        })?;
        let correlation = if pairs.is_empty() {
            None
        } else {
            Some(Correlation::new(sources.len(), pairs)?)
        };
        let sampler = Sampler::new(design, seed, count)?;
        Ok(Self {
            sources,
            correlation,
            sampler,
        })
    }

    /// The values at a point in standard normal space, in the order of the sources; they replace those in `values`.
    pub fn at(&self, point: &[f64], values: &mut Vec<f64>) {
        values.clear();
        let mut scores = point.to_vec();
        if let Some(correlation) = &self.correlation {
            correlation.apply(&mut scores);
        }
        for (source, score) in self.sources.iter().zip(scores) {
            match source {
                Source::Distribution(law) => values.push(law.quantile(Tails::of_score(score))),
                Source::Rows(rows) => values.extend(drawn(rows, normal::below(score))),
            }
        }
    }

    /// The values of a run, in the order of the sources; they replace those in `values`.
    pub fn draw(&self, run: u64, values: &mut Vec<f64>) {
        values.clear();
        let uniform = |at: usize| {
            self.sampler
                .uniform(run, u32::try_from(at).expect("counted"))
        };
        if let Some(correlation) = &self.correlation {
            let mut scores: Vec<f64> = (0..self.sources.len())
                .map(|at| Tails::of_uniform(uniform(at)).score())
                .collect();
            correlation.apply(&mut scores);
            for (at, source) in self.sources.iter().enumerate() {
                match source {
                    Source::Distribution(law) => {
                        values.push(law.quantile(Tails::of_score(scores[at])));
                    }
                    Source::Rows(rows) => values.extend(drawn(rows, uniform(at))),
                }
            }
            return;
        }
        for (at, source) in self.sources.iter().enumerate() {
            match source {
                Source::Distribution(law) => {
                    values.push(law.quantile(Tails::of_uniform(uniform(at))));
                }
                Source::Rows(rows) => values.extend(drawn(rows, uniform(at))),
            }
        }
    }
}

#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a table has far fewer rows than 2^52, and the number is below their count"
)]
fn drawn(rows: &[Vec<f64>], uniform: f64) -> &[f64] {
    &rows[((uniform * rows.len() as f64) as usize).min(rows.len() - 1)]
}

#[cfg(test)]
mod tests {
    use super::super::distribution::Spread;
    use super::*;

    fn sources() -> Vec<Source> {
        let table = vec![vec![1.0, 10.0], vec![2.0, 20.0], vec![3.0, 30.0]];
        vec![
            Source::Distribution(Distribution::normal(5.0, Spread::Cv(0.1)).unwrap()),
            Source::Rows(table),
            Source::Distribution(Distribution::weibull(2.0, Spread::Cv(0.2)).unwrap()),
        ]
    }

    fn rows(inputs: &StudyInputs, runs: u64) -> Vec<Vec<f64>> {
        let mut values = Vec::new();
        (0..runs)
            .map(|run| {
                inputs.draw(run, &mut values);
                values.clone()
            })
            .collect()
    }

    /// The first 300 runs of a study of 1000 runs are the study of 300 runs, bit for bit, also with correlations.
    #[test]
    fn a_smaller_study_is_the_beginning_of_a_larger_one() {
        let pair = Pair {
            inputs: [0, 2],
            correlation: 0.7,
        };
        for design in [Design::Random, Design::Sobol { replicates: 16 }] {
            for pairs in [&[][..], &[pair]] {
                let inputs = || StudyInputs::new(sources(), pairs, design, 42).unwrap();
                assert_eq!(rows(&inputs(), 1000)[..300], rows(&inputs(), 300));
            }
        }
    }

    /// The scores of the numbers of a run give its values, with correlations and rows.
    #[test]
    fn the_values_at_a_point_are_those_of_a_run_with_the_same_scores() {
        let pair = Pair {
            inputs: [0, 2],
            correlation: 0.7,
        };
        for pairs in [&[][..], &[pair]] {
            let inputs = StudyInputs::new(sources(), pairs, Design::Random, 42).unwrap();
            let mut values = Vec::new();
            for (run, drawn) in (0..).zip(rows(&inputs, 50)) {
                let score = |at| Tails::of_uniform(inputs.sampler.uniform(run, at)).score();
                inputs.at(&[score(0), score(1), score(2)], &mut values);
                for (value, drawn) in values.iter().zip(&drawn) {
                    assert!(
                        (value - drawn).abs() < 1e-9 * drawn.abs(),
                        "{value} {drawn}"
                    );
                }
            }
        }
    }

    /// Each row comes as one, and a third of the time: 10,000 draws, four standard errors.
    #[test]
    fn rows_of_a_table_are_drawn_together() {
        let inputs = StudyInputs::new(sources(), &[], Design::Random, 1).unwrap();
        let mut counts = [0_u32; 3];
        for values in rows(&inputs, 10_000) {
            assert_eq!(values[2], 10.0 * values[1]);
            counts[[1.0, 2.0, 3.0]
                .iter()
                .position(|row| *row == values[1])
                .unwrap()] += 1;
        }
        for count in counts {
            assert!(
                (f64::from(count) - 10_000.0 / 3.0).abs() < 4.0 * 47.2,
                "{count}"
            );
        }
    }

    #[test]
    fn defective_inputs_are_refused() {
        let refused =
            |sources, pairs: &[Pair]| StudyInputs::new(sources, pairs, Design::Random, 1).err();
        assert_eq!(refused(vec![], &[]), Some(InputError::NoInputs));
        assert_eq!(
            refused(vec![Source::Rows(vec![])], &[]),
            Some(InputError::EmptyTable(0))
        );
        assert_eq!(
            refused(vec![Source::Rows(vec![vec![1.0], vec![f64::NAN]])], &[]),
            Some(InputError::DefectiveRow {
                source_at: 0,
                row: 1
            })
        );
        let pair = Pair {
            inputs: [0, 1],
            correlation: 0.7,
        };
        assert_eq!(
            refused(sources(), &[pair]),
            Some(InputError::CorrelatedTable(1))
        );
    }
}
