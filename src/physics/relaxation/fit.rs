//! Relaxation: the force that is lost while a specimen is held. In: holds, each with its readings and how it was reached. Out:
//! the time constant, what is left to relax, the stiffness with and without it, each with its standard error. It knows no rig.

use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};

use super::maxwell::{MaxwellBranch, Travel};
use crate::identification::{StatedVariance, fit_line};

/// A specimen held at one place.
#[derive(Clone, Debug, PartialEq)]
pub struct Hold {
    /// Number of the step it belongs to.
    pub step: u64,
    /// m
    pub displacement: f64,
    /// s from the last reading before to the begin of the move here.
    pub waited_for: f64,
    /// s that the move took, evenly.
    pub moved_for: f64,
    /// s from its end to the first reading: time at rest while the rig settled.
    pub settled_for: f64,
    /// s since the first reading, N.
    pub readings: Vec<(f64, f64)>,
}

/// By what the forces of holds are told; R in N, X in m, t in s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxationModel {
    /// R = R∞ + A e^(−t/τ) in every hold, with one τ for all.
    Exponential,
    /// R = R₀ + K∞ X + q, q' = K₁ X' − q/τ through all moves and holds; a move is taken as even from its begin to its end.
    StandardLinearSolid,
}

/// What holds tell of a specimen that comes to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RelaxationFit {
    pub model: RelaxationModel,
    /// τ, s, with its standard error, as all that follow.
    pub time_constant: (f64, f64),
    /// Of each hold: force when all has relaxed, and what there was to relax at its first reading, N.
    pub holds: Vec<[f64; 2]>,
    /// K∞, N/m: of the exponential the slope of the relaxed forces, where three holds tell it.
    pub relaxed_stiffness: Option<(f64, f64)>,
    /// K₁ of the standard linear solid, N/m.
    pub branch_stiffness: Option<(f64, f64)>,
    /// Force that the worst hold had still to lose at its last reading, N.
    pub remaining: (f64, f64),
    /// ∂remaining/∂ as (amplitude A, its error, correlation with τ) of the worst hold, for the pause that a force accuracy needs.
    pub worst: Amplitude,
    /// Standard deviation of a reading about the fit, N.
    pub scatter: f64,
    /// Degrees of freedom of that scatter: the readings less all that was found.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
}

/// What the hold that loses most has to lose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitude {
    /// A, N
    pub force: f64,
    pub error: f64,
    /// Covariance of A and τ, N·s.
    pub covariance: f64,
}

impl RelaxationFit {
    /// s to hold until less than `accuracy` (N) is left to relax: τ ln(|A|/accuracy), with its standard error.
    #[must_use]
    pub fn needed_pause(&self, accuracy: f64) -> (f64, f64) {
        let (tau, tau_error) = self.time_constant;
        let Amplitude {
            force,
            error,
            covariance,
        } = self.worst;
        let times = (force.abs() / accuracy).ln();
        if times <= 0.0 {
            return (0.0, 0.0);
        }
        let variance = (times * tau_error).powi(2)
            + (tau / force * error).powi(2)
            + 2.0 * times * tau / force * covariance;
        (tau * times, variance.max(0.0).sqrt())
    }

    /// Degrees of freedom by which the relaxed stiffness is known: of the exponential it is the slope of a line through the holds.
    #[must_use]
    pub fn degrees_of_stiffness(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
        let holds = self.holds.len() as f64;
        if self.model == RelaxationModel::Exponential {
            (holds - 2.0).max(1.0)
        } else {
            self.degrees
        }
    }

    /// Force of a hold `seconds` after its first reading, N.
    #[must_use]
    pub fn force(&self, hold: usize, seconds: f64) -> Option<f64> {
        let [relaxed, amplitude] = self.holds.get(hold)?;
        Some(relaxed + amplitude * (-seconds / self.time_constant.0).exp())
    }
}

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unrelaxed {
    /// Fewer readings than numbers to find.
    TooFew,
    /// The readings are as well told by forces that stay (BIC).
    Steady,
    /// Faster than the readings, or slower than the holds.
    OutOfReach,
}

/// Time constants tried first, over all that the readings could tell.
const TRIED: u32 = 32;
/// Steps of Gauss and Newton from the best of them.
const MOST_STEPS: usize = 60;
/// Scatter below this share of the largest force is rounding and no relaxation.
const ROUNDING: f64 = 1e-10;

/// Least squares over τ, and for each τ over all that is linear (variable projection). Standard errors are
/// those of the linearised model at the optimum. `start` is where the first move began, m.
///
/// # Errors
/// The readings do not tell a time constant.
pub fn fit_relaxation(
    holds: &[Hold],
    start: f64,
    model: RelaxationModel,
) -> Result<RelaxationFit, Unrelaxed> {
    fit_relaxation_stated(holds, start, model, StatedVariance::default())
}

/// The same of readings with stated errors.
///
/// # Errors
/// The readings do not tell a time constant.
pub fn fit_relaxation_stated(
    holds: &[Hold],
    start: f64,
    model: RelaxationModel,
    stated: StatedVariance,
) -> Result<RelaxationFit, Unrelaxed> {
    let problem = Problem {
        holds,
        start,
        model,
    };
    let count: usize = holds.iter().map(|hold| hold.readings.len()).sum();
    let numbers = if model == RelaxationModel::Exponential {
        2 * holds.len() + 1
    } else {
        4
    };
    if count <= numbers || holds.is_empty() {
        return Err(Unrelaxed::TooFew);
    }
    let times = || {
        holds
            .iter()
            .flat_map(|hold| hold.readings.iter().map(|(time, _)| *time))
    };
    let longest = times().fold(0.0, f64::max);
    let shortest = times()
        .filter(|time| *time > 0.0)
        .fold(f64::INFINITY, f64::min);
    if longest <= 0.0 {
        return Err(Unrelaxed::TooFew);
    }
    let (low, high) = (0.2 * shortest, 30.0 * longest);
    let tried =
        (0..TRIED).map(|index| low * (high / low).powf(f64::from(index) / f64::from(TRIED - 1)));
    let solved = tried.map(|tau| {
        (
            tau,
            problem
                .solve(tau)
                .map_or(f64::INFINITY, |solved| solved.squares),
        )
    });
    let best = solved
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .ok_or(Unrelaxed::TooFew)?;
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let (count, numbers) = (count as f64, numbers as f64);
    let steady = problem.steady();
    let largest = holds
        .iter()
        .flat_map(|hold| &hold.readings)
        .fold(0.0, |most: f64, (_, force)| most.max(force.abs()));
    let mean_square = |squares: f64| {
        (squares / count)
            .max((ROUNDING * largest).powi(2))
            .max(f64::MIN_POSITIVE)
    };
    let more = numbers - steady.numbers;
    if count * (mean_square(steady.squares) / mean_square(best.1)).ln() <= more * count.ln() {
        return Err(Unrelaxed::Steady);
    }
    let tau = problem.polished(best.0);
    if !(tau > 1.01 * low && tau < 0.99 * high) {
        return Err(Unrelaxed::OutOfReach);
    }
    problem
        .stated(tau, count - numbers, stated)
        .ok_or(Unrelaxed::OutOfReach)
}

struct Problem<'a> {
    holds: &'a [Hold],
    start: f64,
    model: RelaxationModel,
}

/// The linear numbers for one τ: of each hold R∞ and A; of the solid R₀, K∞ and K₁ besides.
struct Solved {
    squares: f64,
    holds: Vec<[f64; 2]>,
    solid: [f64; 3],
}

struct Steady {
    squares: f64,
    numbers: f64,
}

impl Problem<'_> {
    fn kernel(&self, tau: f64) -> Vec<f64> {
        kernel(self.holds, self.start, tau)
    }

    fn solve(&self, tau: f64) -> Option<Solved> {
        match self.model {
            RelaxationModel::Exponential => {
                let each: Option<Vec<[f64; 2]>> = self
                    .holds
                    .iter()
                    .map(|hold| exponential(hold, tau))
                    .collect();
                let holds = each?;
                let squares = self.squares(&holds, tau);
                Some(Solved {
                    squares,
                    holds,
                    solid: [0.0; 3],
                })
            }
            RelaxationModel::StandardLinearSolid => {
                let kernel = self.kernel(tau);
                let rows = self.holds.iter().zip(&kernel).flat_map(|(hold, begins)| {
                    hold.readings.iter().map(move |(time, force)| {
                        (
                            [1.0, hold.displacement, begins * (-time / tau).exp()],
                            *force,
                        )
                    })
                });
                let solid = three(rows)?;
                let holds: Vec<[f64; 2]> = self
                    .holds
                    .iter()
                    .zip(&kernel)
                    .map(|(hold, begins)| {
                        [solid[0] + solid[1] * hold.displacement, solid[2] * begins]
                    })
                    .collect();
                Some(Solved {
                    squares: self.squares(&holds, tau),
                    holds,
                    solid,
                })
            }
        }
    }

    fn residuals<'h>(&'h self, holds: &'h [[f64; 2]], tau: f64) -> impl Iterator<Item = f64> + 'h {
        self.holds
            .iter()
            .zip(holds)
            .flat_map(move |(hold, [relaxed, amplitude])| {
                hold.readings
                    .iter()
                    .map(move |(time, force)| force - relaxed - amplitude * (-time / tau).exp())
            })
    }

    fn squares(&self, holds: &[[f64; 2]], tau: f64) -> f64 {
        self.residuals(holds, tau).map(|left| left * left).sum()
    }

    /// With forces that stay in every hold, or that follow one line.
    fn steady(&self) -> Steady {
        #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
        let holds = self.holds.len() as f64;
        match self.model {
            RelaxationModel::Exponential => {
                let of = |hold: &Hold| {
                    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
                    let mean = hold.readings.iter().map(|(_, force)| force).sum::<f64>()
                        / hold.readings.len() as f64;
                    hold.readings
                        .iter()
                        .map(|(_, force)| (force - mean).powi(2))
                        .sum::<f64>()
                };
                Steady {
                    squares: self.holds.iter().map(of).sum(),
                    numbers: holds,
                }
            }
            RelaxationModel::StandardLinearSolid => {
                let points = self.holds.iter().flat_map(|hold| {
                    hold.readings
                        .iter()
                        .map(|(_, force)| (hold.displacement, *force))
                });
                let (x, r): (Vec<f64>, Vec<f64>) = points.unzip();
                let squares = fit_line(&x, &r).map_or(f64::INFINITY, |fit| {
                    x.iter()
                        .zip(&r)
                        .map(|(x, r)| (r - fit.intercept - fit.slope * x).powi(2))
                        .sum()
                });
                Steady {
                    squares,
                    numbers: 2.0,
                }
            }
        }
    }

    /// How the readings change with τ at the optimum of the rest, and how much of it the rest cannot make up for.
    fn slope(&self, tau: f64) -> Option<(Solved, Vec<f64>)> {
        let solved = self.solve(tau)?;
        let change = match self.model {
            RelaxationModel::Exponential => {
                let of = |(hold, [_, amplitude]): (&Hold, &[f64; 2])| {
                    let by = *amplitude / (tau * tau);
                    hold.readings
                        .iter()
                        .map(move |(time, _)| by * time * (-time / tau).exp())
                        .collect::<Vec<f64>>()
                };
                self.holds.iter().zip(&solved.holds).flat_map(of).collect()
            }
            RelaxationModel::StandardLinearSolid => {
                let part = 1e-5 * tau;
                let (less, more) = (self.kernel(tau - part), self.kernel(tau + part));
                let of = |(index, hold): (usize, &Hold)| {
                    let at = |begins: f64, tau: f64, time: f64| begins * (-time / tau).exp();
                    let by = solved.solid[2] / (2.0 * part);
                    let (less, more) = (less[index], more[index]);
                    let each = hold.readings.iter().map(move |(time, _)| {
                        by * (at(more, tau + part, *time) - at(less, tau - part, *time))
                    });
                    each.collect::<Vec<f64>>()
                };
                self.holds.iter().enumerate().flat_map(of).collect()
            }
        };
        Some((solved, change))
    }

    /// Gauss and Newton in ln τ, every step halved until it leaves less.
    fn polished(&self, from: f64) -> f64 {
        let mut tau = from;
        for _ in 0..MOST_STEPS {
            let Some((solved, change)) = self.slope(tau) else {
                break;
            };
            let left: Vec<f64> = self.residuals(&solved.holds, tau).collect();
            let Some(own) = self.own(&change, tau) else {
                break;
            };
            let size: f64 = own.iter().map(|part| part * part).sum();
            let step = own
                .iter()
                .zip(&left)
                .map(|(part, left)| part * left)
                .sum::<f64>()
                / size
                / tau;
            if step.abs() < 1e-10 {
                break;
            }
            let mut share = step.clamp(-1.0, 1.0);
            let better = (0..12).find_map(|_| {
                let next = tau * share.exp();
                share *= 0.5;
                self.solve(next)
                    .filter(|found| found.squares < solved.squares)
                    .map(|_| next)
            });
            match better {
                Some(next) => tau = next,
                None => break,
            }
        }
        tau
    }

    /// The part of a change of the readings that no other number of the model can make up for.
    fn own(&self, change: &[f64], tau: f64) -> Option<Vec<f64>> {
        let shifted: Vec<Hold> = {
            let mut left = change.iter();
            let of = |hold: &Hold| {
                let readings = hold
                    .readings
                    .iter()
                    .zip(left.by_ref())
                    .map(|((time, _), change)| (*time, *change))
                    .collect();
                Hold {
                    readings,
                    ..hold.clone()
                }
            };
            self.holds.iter().map(of).collect()
        };
        let problem = Problem {
            holds: &shifted,
            start: self.start,
            model: self.model,
        };
        let solved = problem.solve(tau)?;
        Some(problem.residuals(&solved.holds, tau).collect())
    }

    fn stated(&self, tau: f64, freedom: f64, stated: StatedVariance) -> Option<RelaxationFit> {
        let (solved, change) = self.slope(tau)?;
        let own: f64 = self.own(&change, tau)?.iter().map(|part| part * part).sum();
        // The force does not follow the displacement within a hold.
        let (variance, shown) = stated.counted(solved.squares / freedom, 0.0);
        let tau_error = (variance / own).sqrt();
        let mut fit = RelaxationFit {
            model: self.model,
            time_constant: (tau, tau_error),
            relaxed_stiffness: None,
            branch_stiffness: None,
            remaining: (0.0, 0.0),
            worst: Amplitude {
                force: 0.0,
                error: 0.0,
                covariance: 0.0,
            },
            scatter: variance.sqrt(),
            degrees: freedom,
            shown,
            holds: solved.holds.clone(),
        };
        let last = |hold: &Hold| hold.readings.last().map_or(0.0, |(time, _)| *time);
        let left =
            |index: usize| (solved.holds[index][1] * (-last(&self.holds[index]) / tau).exp()).abs();
        let worst = (0..self.holds.len()).max_by(|a, b| left(*a).total_cmp(&left(*b)))?;
        let amplitude = solved.holds[worst][1];
        match self.model {
            RelaxationModel::Exponential => {
                let offset: usize = self.holds[..worst]
                    .iter()
                    .map(|hold| hold.readings.len())
                    .sum();
                let readings = &self.holds[worst].readings;
                let change = &change[offset..offset + readings.len()];
                let normal = normal(readings, tau).try_inverse()?;
                let along = readings.iter().zip(change).fold(
                    Vector2::zeros(),
                    |sum, ((time, _), change)| {
                        sum + Vector2::new(1.0, (-time / tau).exp()) * *change
                    },
                );
                // A moves with τ as the least squares make it.
                let by_tau = -(normal * along)[1];
                let error = (variance * normal[(1, 1)] + (by_tau * tau_error).powi(2)).sqrt();
                fit.worst = Amplitude {
                    force: amplitude,
                    error,
                    covariance: by_tau * tau_error * tau_error,
                };
                let (x, r): (Vec<f64>, Vec<f64>) = self
                    .holds
                    .iter()
                    .zip(&solved.holds)
                    .map(|(hold, [relaxed, _])| (hold.displacement, *relaxed))
                    .unzip();
                // The errors of the readings of a hold are in its relaxed force.
                let each = self.holds.iter().filter_map(|hold| {
                    Some(self::normal(&hold.readings, tau).try_inverse()?[(0, 0)])
                });
                #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
                let of_hold = StatedVariance {
                    force: stated.force * each.sum::<f64>() / x.len() as f64,
                    ..stated
                };
                let line = fit_line(&x, &r).map(|line| line.stated(&x, of_hold, line.slope));
                fit.relaxed_stiffness = line.map(|line| (line.slope, line.slope_error));
            }
            RelaxationModel::StandardLinearSolid => {
                let kernel = self.kernel(tau);
                let rows = self.holds.iter().zip(&kernel).flat_map(|(hold, begins)| {
                    hold.readings.iter().map(move |(time, _)| {
                        [1.0, hold.displacement, begins * (-time / tau).exp()]
                    })
                });
                let mut normal = Matrix4::zeros();
                for (row, change) in rows.zip(&change) {
                    let row = Vector4::new(row[0], row[1], row[2], *change);
                    normal += row * row.transpose();
                }
                let unit = Matrix4::from_diagonal(&normal.diagonal().map(|size| 1.0 / size.sqrt()));
                let covariance = unit * (unit * normal * unit).try_inverse()? * unit * variance;
                let error = |effect: Vector4<f64>| {
                    (effect.transpose() * covariance * effect)[(0, 0)]
                        .max(0.0)
                        .sqrt()
                };
                // All readings of a hold have the error of its place in common.
                let places: Vec<f64> = self.holds.iter().map(|hold| hold.displacement).collect();
                let of_places = |stiffness: f64| {
                    let common = StatedVariance {
                        force: 0.0,
                        ..stated
                    };
                    let line = fit_line(&places, &places)?.stated(&places, common, stiffness);
                    Some(line.slope_error)
                };
                let with_places = |stiffness: f64, effect: Vector4<f64>| {
                    (
                        stiffness,
                        error(effect).hypot(of_places(stiffness).unwrap_or(0.0)),
                    )
                };
                fit.relaxed_stiffness = Some(with_places(
                    solved.solid[1],
                    Vector4::new(0.0, 1.0, 0.0, 0.0),
                ));
                fit.branch_stiffness = Some(with_places(
                    solved.solid[2],
                    Vector4::new(0.0, 0.0, 1.0, 0.0),
                ));
                let part = 1e-5 * tau;
                let by_tau = solved.solid[2]
                    * (self.kernel(tau + part)[worst] - self.kernel(tau - part)[worst])
                    / (2.0 * part);
                let effect = Vector4::new(0.0, 0.0, kernel[worst], by_tau);
                let with_tau =
                    (effect.transpose() * covariance * Vector4::new(0.0, 0.0, 0.0, 1.0))[(0, 0)];
                fit.worst = Amplitude {
                    force: amplitude,
                    error: error(effect),
                    covariance: with_tau,
                };
            }
        }
        let seconds = last(&self.holds[worst]);
        let fall = (-seconds / tau).exp();
        let by_tau = amplitude * fall * seconds / (tau * tau);
        let Amplitude {
            error, covariance, ..
        } = fit.worst;
        let spread = (fall * error).powi(2)
            + (by_tau * tau_error).powi(2)
            + 2.0 * fall * by_tau * covariance;
        fit.remaining = ((amplitude * fall).abs(), spread.max(0.0).sqrt());
        Some(fit)
    }
}

/// What is left to relax at the first reading of each hold, by K₁ = 1 N/m.
fn kernel(holds: &[Hold], start: f64, tau: f64) -> Vec<f64> {
    let (mut branch, mut at) = (MaxwellBranch::new(1.0, tau), start);
    let each = holds.iter().map(|hold| {
        let moved = hold.displacement - at;
        at = hold.displacement;
        let seconds = hold.moved_for.max(1e-9);
        branch.follow(&Travel::rest(hold.waited_for));
        branch.follow(&Travel::even(moved / seconds, seconds));
        branch.follow(&Travel::rest(hold.settled_for));
        let force = branch.force();
        branch.follow(&Travel::rest(
            hold.readings.last().map_or(0.0, |(time, _)| *time),
        ));
        force
    });
    each.collect()
}

/// Σ of the squares and products of 1 and e^(−t/τ).
fn normal(readings: &[(f64, f64)], tau: f64) -> Matrix2<f64> {
    readings.iter().fold(Matrix2::zeros(), |sum, (time, _)| {
        let row = Vector2::new(1.0, (-time / tau).exp());
        sum + row * row.transpose()
    })
}

/// R∞ and A of one hold; None where its readings cannot tell them apart.
fn exponential(hold: &Hold, tau: f64) -> Option<[f64; 2]> {
    let (fall, force): (Vec<f64>, Vec<f64>) = hold
        .readings
        .iter()
        .map(|(time, force)| ((-time / tau).exp(), *force))
        .unzip();
    // About the means, so that no digits are lost where the fall is slow.
    let line = fit_line(&fall, &force)?;
    Some([line.intercept, line.slope])
}

/// Least squares of three numbers, with the second and third about their means over the first.
fn three(rows: impl Iterator<Item = ([f64; 3], f64)>) -> Option<[f64; 3]> {
    let rows: Vec<([f64; 3], f64)> = rows.collect();
    let mut normal = nalgebra::Matrix3::zeros();
    let mut load = nalgebra::Vector3::zeros();
    let sizes = rows.iter().fold([0.0_f64; 3], |most, (row, _)| {
        [0, 1, 2].map(|index| most[index].max(row[index].abs()))
    });
    for (row, force) in &rows {
        let row = nalgebra::Vector3::new(row[0], row[1] / sizes[1], row[2] / sizes[2]);
        normal += row * row.transpose();
        load += row * *force;
    }
    let solved = normal.cholesky()?.solve(&load);
    let solved = [solved[0], solved[1] / sizes[1], solved[2] / sizes[2]];
    solved
        .iter()
        .all(|number| number.is_finite())
        .then_some(solved)
}
