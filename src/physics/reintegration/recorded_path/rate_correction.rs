//! Lag and damping in the readings of a continuous motion. In: readings, and the velocity predicted for each target. Out: the lag of the
//! specimen, its viscous damping, and the readings without both, as of the specimen at rest. It knows only the recorded path.
//!
//! # Why the velocity must be removed from a continuous path
//!
//! The force of a specimen with a damper is r = f(x) + c·v, and the path of force over displacement has the slope
//!
//! ```text
//! dr/dx = f' + c·a/v
//! ```
//!
//! which is unbounded at a reversal. Let a motion x = A cos ωt be retraced with an amplitude larger by the fraction ε. At its reversal
//! (t = 0) the force has grown by εkA, as it should. Along the next branch, which is shifted to the new reversal, it would grow by
//!
//! ```text
//! δr = εkA + (k + cω cot ωt)·εA(cos ωt − 1)     truly: εkA cos ωt − εcωA sin ωt
//! ```
//!
//! At the quarter period the damper adds nothing, where it should add −εcωA; and near the next reversal, at ωt = π − ωs, δr gains
//! 2εcA/s. The last reading before the reversal is half a step from it on average, s = ½Δt, so that each reversal leaves a force
//!
//! ```text
//! δr/(k·εA) = 4c/(k·Δt)
//! ```
//!
//! relative to the deviation itself, and the next branch begins with it: a finer step increases it. With C/K = 9 ms and Δt = 10 ms it is
//! 3.6 at every reversal. The same applies to a lag: where the actuator is τv behind, the measured displacement has the slope 1 − τa/v
//! over the target, and the correction r − K(d_m − d) adds (K − f')·τa/v.
//!
//! The readings are therefore given over the displacement of the specimen, x = d − τv, minus c·v, and a retraced reading is r + c·v at
//! the velocity of the retraced motion. The slope is then f', as for ramp-and-hold.
//!
//! A specimen that yields reverses between two readings: they lie on two curves, and the slope from one to the other,
//! (K − f')·½as²/Δx with an arbitrarily small Δx, is that of neither. The reversal is where the velocity, linear from one reading to the
//! next, is zero; each curve is extended to it along its own tangent.
//!
//! # Estimation of τ and c
//!
//! τ is the least-squares slope of d − `d_m` on v. For c every few increments of a branch are grouped: their tangent f' is one number, so
//! that Δr = f'Δx + cΔv, and the part of Δv orthogonal to Δx determines c. It is largest where a/v changes most, near the reversals. Each
//! group has its own c; the weighted median of all is not affected by the groups in which the specimen yields.

use super::{ContinuousMotion, Reading, branches_of};

/// Increments of a group: few enough for one tangent, more than the two unknowns.
const TOGETHER: usize = 4;
/// Iterations of velocity and lag, which depend on each other.
const ROUNDS: usize = 6;
/// Significance of a value, in its standard uncertainties.
const SURE: f64 = 3.0;
/// Standard deviation of a normal variable whose median absolute deviation is 1.
const OF_MEDIAN: f64 = 1.4826;

/// Readings of a continuous motion.
#[derive(Clone, Debug)]
pub(super) struct ContinuousReadings {
    /// Lag of the specimen behind its target τ \[s\].
    lag: f64,
    /// Damping of the specimen c \[N·s/m\].
    damping: f64,
    /// From one reading to the next \[s\].
    time_step: f64,
    /// The readings, with the velocity of the specimen \[m/s\].
    passed: Vec<(Reading, f64)>,
}

/// The specimen at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    /// \[m\]
    pub position: f64,
    /// \[m/s\]
    pub velocity: f64,
}

/// Velocities of an actuator and of the specimen on it \[m/s\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Speed {
    /// Predicted for a target.
    predicted: f64,
    pub actual: f64,
}

impl ContinuousReadings {
    /// `resolution` in \[m\].
    pub fn of(readings: &[Reading], motion: ContinuousMotion<&[f64]>, resolution: f64) -> Self {
        let predicted: Vec<f64> = motion
            .velocities
            .iter()
            .copied()
            .chain(std::iter::repeat(0.0))
            .take(readings.len())
            .collect();
        let passed = readings
            .iter()
            .copied()
            .zip(predicted.iter().copied())
            .collect();
        let mut found = Self {
            lag: 0.0,
            damping: 0.0,
            time_step: motion.time_step,
            passed,
        };
        // The velocity of the specimen depends on its lag.
        for _ in 0..ROUNDS {
            let behind = found
                .passed
                .iter()
                .map(|(reading, actual)| (reading.target - reading.displacement, *actual));
            found.lag = lag(behind, resolution);
            let mut speed = Speed::default();
            for (step, predicted) in predicted.iter().enumerate() {
                speed = found.speed(speed, *predicted, 1);
                found.passed[step].1 = speed.actual;
            }
        }
        found.damping = damping(&found.at_rest(), &found.velocities().collect::<Vec<f64>>());
        found
    }

    /// The readings as of the specimen at rest at each position.
    pub fn at_rest(&self) -> Vec<Reading> {
        let at_rest = |(reading, velocity): &(Reading, f64)| Reading {
            target: self.position(reading.target, *velocity),
            force: reading.force - self.damping * velocity,
            ..*reading
        };
        self.passed.iter().map(at_rest).collect()
    }

    /// Velocities at a target for which `predicted` \[m/s\] is known: ẋ = (d − x)/τ, with the predicted velocity linear from step to step,
    /// of which there are `finer` for each of the record.
    pub fn speed(&self, before: Speed, predicted: f64, finer: u8) -> Speed {
        if self.lag <= 0.0 {
            return Speed {
                predicted,
                actual: predicted,
            };
        }
        let time_step = self.time_step / f64::from(finer);
        let slower = (predicted - before.predicted) / time_step * self.lag;
        let fading = (before.actual - before.predicted + slower) * (-time_step / self.lag).exp();
        Speed {
            predicted,
            actual: predicted - slower + fading,
        }
    }

    /// Velocities of the specimen \[m/s\].
    pub fn velocities(&self) -> impl Iterator<Item = f64> {
        self.passed.iter().map(|(_, velocity)| *velocity)
    }

    /// Standard deviation of the forces at rest \[N\] for a specimen of `stiffness` \[N/m\]: the position by τ differs from the measured
    /// one beyond the quantization of `resolution` \[m\], and ẋ = (d − x)/τ.
    pub fn force_uncertainty(&self, stiffness: f64, resolution: f64) -> f64 {
        if self.lag <= 0.0 {
            return 0.0;
        }
        let off = |(reading, velocity): &(Reading, f64)| {
            (reading.displacement - self.position(reading.target, *velocity)).powi(2)
        };
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let mean = self.passed.iter().map(off).sum::<f64>() / self.passed.len() as f64;
        (stiffness + self.damping.abs() / self.lag)
            * (mean - resolution * resolution / 12.0).max(0.0).sqrt()
    }

    /// Position of a reversal between the reading at `step` and the next \[m\]; None without one.
    pub fn turned(&self, step: usize) -> Option<f64> {
        let at = |step: usize| {
            let (reading, velocity) = self.passed.get(step)?;
            Some(Passage {
                position: self.position(reading.target, *velocity),
                velocity: *velocity,
            })
        };
        self.reversal_between(at(step)?, at(step + 1)?, 1)
    }

    /// Position of a reversal between two passages \[m\] that are a step apart, of which there are `finer` for each of the record. The
    /// nearer end has the larger weight.
    pub fn reversal_between(&self, from: Passage, to: Passage, finer: u8) -> Option<f64> {
        let time_step = self.time_step / f64::from(finer);
        (from.velocity * to.velocity < 0.0).then(|| {
            let share = from.velocity / (from.velocity - to.velocity);
            let rest = 1.0 - share;
            let onwards = from.position + 0.5 * from.velocity * share * time_step;
            let backwards = to.position - 0.5 * to.velocity * rest * time_step;
            let (near, far) = (rest * rest, share * share);
            (near * onwards + far * backwards) / (near + far)
        })
    }

    /// Position of the specimen \[m\] as the actuator passes a target \[m\], at its velocity \[m/s\].
    pub fn position(&self, target: f64, velocity: f64) -> f64 {
        target - self.lag * velocity
    }

    /// Force in motion \[N\], for a force at rest that is `more` \[N\] than at the position of the reading of `step`. At the recorded
    /// position and velocity it is the recorded force, bit-identical.
    pub fn force(&self, step: usize, more: f64, velocity: f64) -> f64 {
        let (reading, passed_with) = self.passed[step];
        reading.force + more + self.damping * (velocity - passed_with)
    }

    /// The recorded reading of a step.
    pub fn reading(&self, step: usize) -> &Reading {
        &self.passed[step].0
    }
}

/// Lag τ \[s\] from pairs of distance behind the target \[m\] and velocity \[m/s\]; 0 where it is not significant.
pub fn lag(behind: impl Iterator<Item = (f64, f64)>, resolution: f64) -> f64 {
    let (both, own) = behind.fold((0.0, 0.0), |(both, own), (behind, velocity)| {
        (both + behind * velocity, own + velocity * velocity)
    });
    let force_uncertainty = resolution / 12.0_f64.sqrt() / own.sqrt();
    let lag = both / own;
    if lag.abs() > SURE * force_uncertainty {
        lag
    } else {
        0.0
    }
}

/// Damping c: derivative of the force by the velocity at constant position \[N·s/m\]; 0 where it is not significant.
fn damping(readings: &[Reading], velocities: &[f64]) -> f64 {
    // For each group: c [N·s/m] and its weight [m²/s²].
    let mut slopes: Vec<(f64, f64)> = Vec::new();
    for (begin, end, _) in branches_of(velocities.iter().copied()) {
        // The increment with the reversal has two tangents.
        let mut first = if begin == 0 { 0 } else { begin + 1 };
        while first + TOGETHER <= end {
            let increments = || {
                (first..first + TOGETHER).map(|step| {
                    let (near, far) = (&readings[step], &readings[step + 1]);
                    (
                        far.target - near.target,
                        velocities[step + 1] - velocities[step],
                        far.force - near.force,
                    )
                })
            };
            let (along, square) = increments().fold((0.0, 0.0), |(along, square), (x, v, _)| {
                (along + x * v, square + x * x)
            });
            let beside = |x: f64, v: f64| {
                if square > 0.0 {
                    v - x * along / square
                } else {
                    v
                }
            };
            let (both, own) = increments().fold((0.0, 0.0), |(both, own), (x, v, r)| {
                let beside = beside(x, v);
                (both + beside * r, own + beside * beside)
            });
            if own > 0.0 {
                slopes.push((both / own, own));
            }
            first += TOGETHER;
        }
    }
    let Some(middle) = weighted_median(&mut slopes) else {
        return 0.0;
    };
    let (all, squares) = slopes
        .iter()
        .fold((0.0, 0.0), |(all, squares), (_, weight)| {
            (all + weight, squares + weight * weight)
        });
    let mut off: Vec<(f64, f64)> = slopes
        .iter()
        .map(|(found, weight)| ((found - middle).abs(), *weight))
        .collect();
    let force_uncertainty =
        OF_MEDIAN * weighted_median(&mut off).unwrap_or(0.0) * squares.sqrt() / all;
    if middle.abs() > SURE * force_uncertainty {
        middle
    } else {
        0.0
    }
}

/// Weighted median; None for an empty list.
fn weighted_median(weighted: &mut [(f64, f64)]) -> Option<f64> {
    weighted.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
    let half = 0.5 * weighted.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut below = 0.0;
    let found = weighted.iter().find(|(_, weight)| {
        below += weight;
        below >= half
    });
    found.map(|(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::specimen::{Bilinear, BilinearCurve, RestoringForce};

    const STIFFNESS: f64 = 1000.0;
    const DAMPING: f64 = 9.0;
    const LAG: f64 = 4e-3;

    /// Two decaying oscillations from rest: position, velocity and acceleration of the specimen, every 2 ms.
    fn motion() -> Vec<[f64; 3]> {
        let at = |time: f64| {
            let of = |size: f64, frequency: f64| {
                let (sine, cosine) = (frequency * time).sin_cos();
                let (fade, out) = (size * (-FADES * time).exp(), 1.0 - cosine);
                let velocity = frequency * sine - FADES * out;
                let acceleration =
                    frequency * (frequency * cosine - 2.0 * FADES * sine) + FADES * FADES * out;
                [fade * out, fade * velocity, fade * acceleration]
            };
            let (slow, fast) = (of(0.05, 11.0), of(0.01, 25.0));
            [0, 1, 2].map(|order: usize| slow[order] + fast[order])
        };
        (0..3000)
            .map(|step| at(TIME_STEP * f64::from(step)))
            .collect()
    }

    const FADES: f64 = 0.3;
    const TIME_STEP: f64 = 2e-3;

    /// Targets ahead of the specimen by τẋ, the readings there, and the velocities predicted for them.
    fn read(model: &mut impl RestoringForce, damping: f64, noise: f64) -> ContinuousReadings {
        let motion = motion();
        let reading = |(step, [position, velocity, _]): (usize, &[f64; 3])| {
            let sign = if step % 7 < 3 || step % 5 == 1 {
                noise
            } else {
                -noise
            };
            let force = model.move_to(*position) + damping * velocity + sign;
            Reading {
                target: position + LAG * velocity,
                displacement: (position / 1e-6).round() * 1e-6,
                force,
            }
        };
        let readings: Vec<Reading> = motion.iter().enumerate().map(reading).collect();
        let predicted: Vec<f64> = motion
            .iter()
            .map(|[_, velocity, acceleration]| velocity + LAG * acceleration)
            .collect();
        let motion = ContinuousMotion {
            velocities: predicted.as_slice(),
            time_step: TIME_STEP,
        };
        ContinuousReadings::of(&readings, motion, 1e-6)
    }

    /// An elastic and a yielding specimen, exact and with noise: τ with a resolution of 1 µm, c in closed form.
    #[test]
    fn lag_and_damping_are_identified_for_any_specimen() {
        for (yield_force, noise, within) in [
            (1e9, 0.0, 5e-3),
            (20.0, 0.0, 5e-3),
            (1e9, 0.01, 0.05),
            (20.0, 0.01, 0.05),
        ] {
            let found = read(
                &mut Bilinear::new(BilinearCurve {
                    stiffness: STIFFNESS,
                    yield_force,
                    post_yield_ratio: 0.1,
                }),
                DAMPING,
                noise,
            );
            assert!((found.lag / LAG - 1.0).abs() < 2e-3, "{} s", found.lag);
            assert!(
                (found.damping / DAMPING - 1.0).abs() < within,
                "{yield_force} N, {noise} N: {} N·s/m",
                found.damping
            );
        }
    }

    #[test]
    fn noise_is_not_counted_as_damping() {
        assert_eq!(
            read(
                &mut Bilinear::new(BilinearCurve {
                    stiffness: STIFFNESS,
                    yield_force: 20.0,
                    post_yield_ratio: 0.1
                }),
                0.0,
                0.5
            )
            .damping,
            0.0
        );
    }

    #[test]
    fn readings_at_rest_are_those_of_the_specimen_and_in_motion_the_recorded_ones() {
        let found = read(
            &mut Bilinear::new(BilinearCurve {
                stiffness: STIFFNESS,
                yield_force: 1e9,
                post_yield_ratio: 0.1,
            }),
            DAMPING,
            0.0,
        );
        let mut largest = 0.0_f64;
        for (step, (at_rest, (reading, velocity))) in
            found.at_rest().iter().zip(&found.passed).enumerate()
        {
            largest = largest.max((at_rest.force - STIFFNESS * at_rest.target).abs());
            assert_eq!(found.position(reading.target, *velocity), at_rest.target);
            assert_eq!(found.force(step, 0.0, *velocity), reading.force);
        }
        // 120 N at most, 6 N of them the damper's.
        assert!(largest < 0.1, "{largest} N");
    }

    /// ½·a·t² of an even velocity, from either side; where it keeps its direction, none.
    #[test]
    fn a_reversal_between_two_readings_is_where_the_velocity_is_zero() {
        let motion = read(
            &mut Bilinear::new(BilinearCurve {
                stiffness: STIFFNESS,
                yield_force: 1e9,
                post_yield_ratio: 0.1,
            }),
            0.0,
            0.0,
        );
        for reversal in [1e-4, 1e-3, 1.9e-3] {
            let position = |time: f64| 0.5 * -3.0 * (time - reversal).powi(2);
            let at = |time: f64| Passage {
                position: position(time),
                velocity: -3.0 * (time - reversal),
            };
            let found = motion.reversal_between(at(0.0), at(TIME_STEP), 1).unwrap();
            assert!(found.abs() < 1e-15, "{found} m");
        }
        let passes = |position: f64, velocity: f64| Passage { position, velocity };
        assert_eq!(
            motion.reversal_between(passes(0.0, 1.0), passes(1e-3, 2.0), 1),
            None
        );
    }
}
