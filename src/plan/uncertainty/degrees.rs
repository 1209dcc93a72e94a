//! Effective degrees of freedom and coverage factors. In: contributions, with the degrees of freedom of their sources. Out: effective
//! degrees of freedom, the coverage factor k and the expanded uncertainty U = k·u, for verdicts and for all printed results.

use super::{Contribution, Source, combined};
use crate::formula::{ProcedureId, Results};
use psd_physics::statistics::student_t;

/// Monte Carlo trials of the reading errors of one impact, at most: their standard uncertainty has a relative standard uncertainty of
/// 1/√(2·64), 9 %.
pub const MOST_DRAWS: u16 = 64;

/// With fewer effective degrees of freedom than this an observation is made: U is then more than 3.3 times u.
pub const FEW: u8 = 3;

/// The uncertainty of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasurementUncertainty {
    /// u, in the number's own unit.
    pub standard: f64,
    /// Effective degrees of freedom of u; infinite if no part of u was estimated from readings.
    pub degrees: f64,
}

impl MeasurementUncertainty {
    /// A standard uncertainty that was not estimated from readings.
    #[must_use]
    pub const fn exact(standard: f64) -> Self {
        Self {
            standard,
            degrees: f64::INFINITY,
        }
    }

    /// k, so that ±k·u has a coverage probability of 95.45 %.
    #[must_use]
    pub fn coverage(self) -> f64 {
        student_t::coverage(self.degrees)
    }

    /// U = k·u
    #[must_use]
    pub fn expanded(self) -> f64 {
        self.coverage() * self.standard
    }
}

/// Contributions whose sizes were estimated together, from the same scatter or the same trials.
#[derive(Clone, Copy, PartialEq)]
enum Estimate {
    /// Readings about a fit: fits of one procedure with equal degrees of freedom count as one.
    Scatter(ProcedureId, f64),
    /// Trials of one impact of a procedure.
    Draws(ProcedureId, u16),
}

/// u of one number and its effective degrees of freedom by Welch and Satterthwaite, ν = u⁴/Σ uᵢ⁴/νᵢ (JCGM 100:2008, G.4.1, eq. G.2b).
/// The formula requires independent estimates: slope and intercept of one line have independent errors, but one scatter gives the
/// size of both, so that their squares are added first. n trials have n degrees of freedom. Uncertainties that plan, rig and program
/// state have infinitely many (G.4.3). None without contributions.
#[must_use]
pub fn measurement_uncertainty(
    parts: &[Contribution],
    results: &dyn Results,
) -> Option<MeasurementUncertainty> {
    let standard = combined(parts)?;
    let mut estimates: Vec<(Estimate, f64, f64)> = Vec::new();
    for part in parts.iter().filter(|part| part.amount != 0.0) {
        let (of, degrees, each) = match part.source {
            Source::Fit { procedure, .. } | Source::FitEntry { procedure, .. } => {
                let degrees = results.degrees(part.source);
                (Estimate::Scatter(procedure, degrees), degrees, 0.0)
            }
            Source::Readings { procedure, draw } | Source::Drawn { procedure, draw } => {
                (Estimate::Draws(procedure, draw / MOST_DRAWS), 0.0, 1.0)
            }
            _ => continue,
        };
        let square = part.variance();
        match estimates.iter_mut().find(|(known, ..)| *known == of) {
            Some((_, squares, degrees)) => {
                *squares += square;
                *degrees += each;
            }
            None => estimates.push((of, square, degrees + each)),
        }
    }
    let variance: f64 = parts.iter().map(Contribution::variance).sum();
    let spread: f64 = estimates
        .iter()
        .map(|(_, squares, degrees)| squares * squares / degrees)
        .sum();
    let degrees = if spread > 0.0 {
        variance * variance / spread
    } else {
        f64::INFINITY
    };
    Some(MeasurementUncertainty { standard, degrees })
}

/// As [`measurement_uncertainty`], for each of `count` entries of a list.
#[must_use]
pub fn measurement_uncertainties(
    parts: &[Contribution],
    count: usize,
    results: &dyn Results,
) -> Vec<Option<MeasurementUncertainty>> {
    let of_entry = |entry| {
        parts
            .iter()
            .filter(|part| part.entry == entry)
            .copied()
            .collect::<Vec<Contribution>>()
    };
    (0..count)
        .map(|entry| measurement_uncertainty(&of_entry(entry), results))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::{ResultReference, ResultValue};

    /// Two fits: that of procedure 0 with 4 degrees of freedom, that of procedure 1 with 9.
    struct Two;

    impl Results for Two {
        fn result(&self, _: ResultReference) -> Option<ResultValue> {
            None
        }

        fn degrees(&self, source: Source) -> f64 {
            match source {
                Source::Fit {
                    procedure: ProcedureId(0),
                    ..
                } => 4.0,
                Source::Fit { .. } => 9.0,
                _ => f64::INFINITY,
            }
        }
    }

    fn fit(procedure: usize, result: &'static str, amount: f64) -> Contribution {
        Contribution::new(
            Source::Fit {
                procedure: ProcedureId(procedure),
                result,
            },
            amount,
        )
    }

    fn degrees(parts: &[Contribution]) -> f64 {
        measurement_uncertainty(parts, &Two).unwrap().degrees
    }

    /// By hand: u² = 9 + 16 = 25, ν = 625/(81/4 + 256/9) = 12.83; beside a known contribution a fit has less weight.
    #[test]
    fn estimates_combine_by_welch_and_satterthwaite() {
        let by_hand = 625.0 / (81.0 / 4.0 + 256.0 / 9.0);
        assert!(
            (degrees(&[fit(0, "stiffness", 3.0), fit(1, "damping", -4.0)]) - by_hand).abs() < 1e-12
        );
        let stated = Contribution::new(Source::ForceScale(0), 4.0);
        assert!(
            (degrees(&[fit(0, "stiffness", 3.0), stated]) - 625.0 / (81.0 / 4.0)).abs() < 1e-12
        );
        assert_eq!(degrees(&[stated]), f64::INFINITY);
        assert_eq!(measurement_uncertainty(&[], &Two), None);
        assert_eq!(
            measurement_uncertainty(&[fit(0, "stiffness", 0.0)], &Two),
            Some(MeasurementUncertainty::exact(0.0))
        );
    }

    /// JCGM 100:2008, G.4.1, example: components of 0.25 %, 0.57 % and 0.82 % with 9, 4 and 14 degrees of freedom have 19. Here the first
    /// is from Monte Carlo trials.
    #[test]
    fn the_example_of_the_guide() {
        struct Guide;
        impl Results for Guide {
            fn result(&self, _: ResultReference) -> Option<ResultValue> {
                None
            }
            fn degrees(&self, source: Source) -> f64 {
                if matches!(
                    source,
                    Source::Fit {
                        procedure: ProcedureId(0),
                        ..
                    }
                ) {
                    4.0
                } else {
                    14.0
                }
            }
        }
        let draw = |draw| {
            Contribution::new(
                Source::Readings {
                    procedure: ProcedureId(2),
                    draw,
                },
                0.25 / 3.0,
            )
        };
        let parts: Vec<Contribution> = (0..9)
            .map(draw)
            .chain([fit(0, "a", 0.57), fit(1, "b", 0.82)])
            .collect();
        let known = measurement_uncertainty(&parts, &Guide).unwrap();
        assert!(
            (known.standard - 1.03).abs() < 0.005 && (known.degrees - 19.0).abs() < 0.05,
            "{known:?}"
        );
        // The trials of the next impact are another nine.
        let next = |draw| {
            Contribution::new(
                Source::Readings {
                    procedure: ProcedureId(2),
                    draw,
                },
                1.0,
            )
        };
        let of_two: Vec<Contribution> =
            (0..9).chain(MOST_DRAWS..MOST_DRAWS + 9).map(next).collect();
        assert!(
            (super::measurement_uncertainty(&of_two, &Guide)
                .unwrap()
                .degrees
                - 18.0)
                .abs()
                < 1e-9
        );
    }

    /// Slope and intercept of one line: every result of both has the degrees of freedom of the line, and no more.
    #[test]
    fn an_uncertainty_from_one_scatter_has_its_degrees_of_freedom() {
        let parts = [fit(0, "stiffness", 2.0), fit(0, "intercept_force", 2.0)];
        let known = measurement_uncertainty(&parts, &Two).unwrap();
        assert!((known.degrees - 4.0).abs() < 1e-12);
        assert!((known.expanded() / (2.87 * 8_f64.sqrt()) - 1.0).abs() < 2e-3);
        let entries = [
            parts[0],
            Contribution {
                entry: 2,
                ..parts[1]
            },
        ];
        let of = measurement_uncertainties(&entries, 3, &Two);
        assert_eq!(
            (
                of[0].map(|known| known.degrees),
                of[1],
                of[2].map(|known| known.standard)
            ),
            (Some(4.0), None, Some(2.0))
        );
    }
}
