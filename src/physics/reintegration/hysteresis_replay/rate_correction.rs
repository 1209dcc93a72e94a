//! What is in the readings of an actuator that passed its targets without a stop. In: readings, and the velocity that was
//! foretold for each target. Out: how far behind the specimen was, what a damper of it gave, and the readings without both:
//! the specimen as it would be read at rest. It knows no way but the recorded one.
//!
//! # Why a way under way must be told without its velocity
//!
//! The force of a specimen with a damper is r = f(x) + c·v, and a way that is told as force over place has for its slope
//!
//! ```text
//! dr/dx = f' + c·a/v
//! ```
//!
//! which has no bound where the way turns. Let a motion x = A cos ωt be taken again a share ε larger. At its turn (t = 0) the
//! force has grown by εkA, as it should. Along the next branch, which is shifted to the new turn, it would grow by
//!
//! ```text
//! δr = εkA + (k + cω cot ωt)·εA(cos ωt − 1)     truly: εkA cos ωt − εcωA sin ωt
//! ```
//!
//! At the quarter the damper gives nothing more, where it should give all of −εcωA; and as the next turn comes near, at
//! ωt = π − ωs, δr gains 2εcA/s. The last reading before the turn is half a step from it on the mean, s = ½Δt, so that
//! each turn leaves behind a force
//!
//! ```text
//! δr/(k·εA) = 4c/(k·Δt)
//! ```
//!
//! times what the deviation itself should come to, and the next branch begins with it: a finer step makes it worse. With
//! C/K = 9 ms and Δt = 10 ms that is 3.6 at every turn. The same holds of a lag: where the actuator is τv behind, the
//! measured place has the slope 1 − τa/v over the target, and the correction r − K(d_m − d) takes (K − f')·τa/v with it.
//!
//! So the readings are told over the place of the specimen, x = d − τv, with c·v taken off them, and what is read again is
//! r + c·v at the velocity of the way that is taken again. The slope is f' then, as it is of a way with a stop at each step.
//!
//! A specimen that yields turns between two readings, at a place that nobody reads: they lie on two curves, and the slope from
//! one to the other, (K − f')·½as²/Δx with Δx as small as chance will have it, is none of either. The turn is where the
//! velocity, which goes evenly from one reading to the next, vanishes; each curve leads to it along its own tangent.
//!
//! # How τ and c are found
//!
//! τ is the least squares of d − `d_m` on v. For c every few readings of a branch are taken together: their tangent f' is one
//! number, so that Δr = f'Δx + cΔv, and what is left of Δv when its share along Δx is taken off tells c. That is most where
//! a/v changes most, beside the turns, and there only v counts, whatever the specimen does. Each few have their own c, and
//! the middle of all, each weighed by what it tells, is not moved by those in which the specimen yields.

use super::Reading;
use super::pieces::branches_of;

/// Increments taken together: few enough that the tangent is one, one more than the two unknowns need.
const TOGETHER: usize = 4;
/// Of the specimen's velocity after its lag and of that after its velocity.
const ROUNDS: usize = 6;
/// How many times its own uncertainty a number must be to count.
const SURE: f64 = 3.0;
/// Standard deviation of a normal number whose median distance is 1.
const OF_MEDIAN: f64 = 1.4826;

/// Readings made under way.
#[derive(Clone, Debug)]
pub(super) struct ContinuousReadings {
    /// Of the specimen behind its target, s.
    lag: f64,
    /// Of the specimen, N·s/m.
    damping: f64,
    /// From one reading to the next, s.
    time_step: f64,
    /// As they were read, with the velocity that the specimen had, m/s.
    passed: Vec<(Reading, f64)>,
}

/// How fast an actuator and the specimen on it go, m/s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Speed {
    /// As foretold for a target.
    predicted: f64,
    pub actual: f64,
}

impl ContinuousReadings {
    /// `velocities` are those foretold for the targets, m/s, and of the same time as `time_step` (s); `resolution` in m.
    pub fn of(readings: Vec<Reading>, velocities: &[f64], time_step: f64, resolution: f64) -> Self {
        let predicted: Vec<f64> = velocities
            .iter()
            .copied()
            .chain(std::iter::repeat(0.0))
            .take(readings.len())
            .collect();
        let passed = readings
            .into_iter()
            .zip(predicted.iter().copied())
            .collect();
        let mut found = Self {
            lag: 0.0,
            damping: 0.0,
            time_step,
            passed,
        };
        // How fast the specimen goes hangs on how far it is behind.
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

    /// The readings as if the specimen had stood where it was read.
    pub fn at_rest(&self) -> Vec<Reading> {
        let at_rest = |(reading, velocity): &(Reading, f64)| Reading {
            target: self.place(reading.target, *velocity),
            force: reading.force - self.damping * velocity,
            ..*reading
        };
        self.passed.iter().map(at_rest).collect()
    }

    /// Once a target is passed for which a velocity (m/s) is foretold: ẋ = (d − x)/τ, the foretold one even from step to step, of which
    /// there are `finer` for each of the record.
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

    /// Of the specimen, m/s.
    pub fn velocities(&self) -> impl Iterator<Item = f64> {
        self.passed.iter().map(|(_, velocity)| *velocity)
    }

    /// Standard deviation of the forces that are told without their velocity, N, of a specimen of `stiffness` (N/m): the place that τ
    /// tells is not quite where it was read, beyond what its quantum of `resolution` (m) makes of it, and ẋ = (d − x)/τ.
    pub fn unsure(&self, stiffness: f64, resolution: f64) -> f64 {
        if self.lag <= 0.0 {
            return 0.0;
        }
        let off = |(reading, velocity): &(Reading, f64)| {
            (reading.displacement - self.place(reading.target, *velocity)).powi(2)
        };
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let mean = self.passed.iter().map(off).sum::<f64>() / self.passed.len() as f64;
        (stiffness + self.damping.abs() / self.lag)
            * (mean - resolution * resolution / 12.0).max(0.0).sqrt()
    }

    /// Where the specimen turned between the reading at `step` and the next, m; None if it did not.
    pub fn turned(&self, step: usize) -> Option<f64> {
        let at = |step: usize| {
            self.passed
                .get(step)
                .map(|(reading, velocity)| (self.place(reading.target, *velocity), *velocity))
        };
        self.turn_between(at(step)?, at(step + 1)?, 1)
    }

    /// Where it turns between two places (m) with their velocities (m/s), a step apart, of which there are `finer` for each of the
    /// record. What is nearer to it tells more of it.
    pub fn turn_between(
        &self,
        (from, before): (f64, f64),
        (to, after): (f64, f64),
        finer: u8,
    ) -> Option<f64> {
        let time_step = self.time_step / f64::from(finer);
        (before * after < 0.0).then(|| {
            let share = before / (before - after);
            let rest = 1.0 - share;
            let onwards = from + 0.5 * before * share * time_step;
            let backwards = to - 0.5 * after * rest * time_step;
            let (near, far) = (rest * rest, share * share);
            (near * onwards + far * backwards) / (near + far)
        })
    }

    /// Where the specimen is as the actuator passes a target (m), itself with a velocity (m/s).
    pub fn place(&self, target: f64, velocity: f64) -> f64 {
        target - self.lag * velocity
    }

    /// What is read where at rest it would be `force`, and `recorded` at the place of the reading of `step`, N. At the
    /// recorded place and velocity it is the recorded force, to the bit.
    pub fn force(&self, step: usize, (force, recorded): (f64, f64), velocity: f64) -> f64 {
        let (reading, passed_with) = self.passed[step];
        reading.force + (force - recorded) + self.damping * (velocity - passed_with)
    }

    /// As it was read.
    pub fn reading(&self, step: usize) -> &Reading {
        &self.passed[step].0
    }
}

/// How long the specimen is behind, of how far it is behind (m) at which velocity (m/s); s.
pub fn lag(behind: impl Iterator<Item = (f64, f64)>, resolution: f64) -> f64 {
    let (both, own) = behind.fold((0.0, 0.0), |(both, own), (behind, velocity)| {
        (both + behind * velocity, own + velocity * velocity)
    });
    let unsure = resolution / 12.0_f64.sqrt() / own.sqrt();
    let lag = both / own;
    if lag.abs() > SURE * unsure { lag } else { 0.0 }
}

/// What the force gains with the velocity beside what it gains with the place, N·s/m.
fn damping(readings: &[Reading], velocities: &[f64]) -> f64 {
    // Of each few increments: c (N·s/m), and what it tells (m²/s²).
    let mut told: Vec<(f64, f64)> = Vec::new();
    for (begin, end, _) in branches_of(velocities.iter().copied()) {
        // The increment in which it turned has two tangents.
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
                told.push((both / own, own));
            }
            first += TOGETHER;
        }
    }
    let Some(middle) = weighted_median(&mut told) else {
        return 0.0;
    };
    let (all, squares) = told.iter().fold((0.0, 0.0), |(all, squares), (_, weight)| {
        (all + weight, squares + weight * weight)
    });
    let mut off: Vec<(f64, f64)> = told
        .iter()
        .map(|(found, weight)| ((found - middle).abs(), *weight))
        .collect();
    let unsure = OF_MEDIAN * weighted_median(&mut off).unwrap_or(0.0) * squares.sqrt() / all;
    if middle.abs() > SURE * unsure {
        middle
    } else {
        0.0
    }
}

/// The value that half the weight is below; None of none.
fn weighted_median(weighed: &mut [(f64, f64)]) -> Option<f64> {
    weighed.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
    let half = 0.5 * weighed.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut below = 0.0;
    let found = weighed.iter().find(|(_, weight)| {
        below += weight;
        below >= half
    });
    found.map(|(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::specimen::{Bilinear, RestoringForce};

    const STIFFNESS: f64 = 1000.0;
    const DAMPING: f64 = 9.0;
    const LAG: f64 = 4e-3;

    /// Two swings that fade, from rest: place, velocity and acceleration of the specimen, 2 ms a step.
    fn way() -> Vec<[f64; 3]> {
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

    /// Targets ahead of the specimen by τẋ, what was read there, and the velocities foretold for them.
    fn read(model: &mut impl RestoringForce, damping: f64, noise: f64) -> ContinuousReadings {
        let way = way();
        let reading = |(step, [place, velocity, _]): (usize, &[f64; 3])| {
            let sign = if step % 7 < 3 || step % 5 == 1 {
                noise
            } else {
                -noise
            };
            let force = model.move_to(*place) + damping * velocity + sign;
            Reading {
                target: place + LAG * velocity,
                displacement: (place / 1e-6).round() * 1e-6,
                force,
            }
        };
        let readings = way.iter().enumerate().map(reading).collect();
        let predicted: Vec<f64> = way
            .iter()
            .map(|[_, velocity, acceleration]| velocity + LAG * acceleration)
            .collect();
        ContinuousReadings::of(readings, &predicted, TIME_STEP, 1e-6)
    }

    /// An elastic and a yielding specimen, exactly and with noise: τ by 1 µm of quantum, c by hand.
    #[test]
    fn lag_and_damper_are_found_whatever_the_specimen_does() {
        for (yield_force, noise, within) in [
            (1e9, 0.0, 5e-3),
            (20.0, 0.0, 5e-3),
            (1e9, 0.01, 0.05),
            (20.0, 0.01, 0.05),
        ] {
            let found = read(
                &mut Bilinear::new(STIFFNESS, yield_force, 0.1),
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

    /// What noise alone shows is no damper.
    #[test]
    fn noise_is_no_damper() {
        assert_eq!(
            read(&mut Bilinear::new(STIFFNESS, 20.0, 0.1), 0.0, 0.5).damping,
            0.0
        );
    }

    #[test]
    fn without_its_velocity_a_reading_is_that_of_the_specimen_and_with_it_what_was_read() {
        let found = read(&mut Bilinear::new(STIFFNESS, 1e9, 0.1), DAMPING, 0.0);
        let mut largest = 0.0_f64;
        for (step, (at_rest, (reading, velocity))) in
            found.at_rest().iter().zip(&found.passed).enumerate()
        {
            largest = largest.max((at_rest.force - STIFFNESS * at_rest.target).abs());
            assert_eq!(found.place(reading.target, *velocity), at_rest.target);
            assert_eq!(
                found.force(step, (at_rest.force, at_rest.force), *velocity),
                reading.force
            );
        }
        // 120 N at most, 6 N of them the damper's.
        assert!(largest < 0.1, "{largest} N");
    }

    /// ½·a·t² of an even velocity, from either side; where it keeps its direction, none.
    #[test]
    fn a_turn_between_two_readings_is_where_the_velocity_vanishes() {
        let way = read(&mut Bilinear::new(STIFFNESS, 1e9, 0.1), 0.0, 0.0);
        for turn in [1e-4, 1e-3, 1.9e-3] {
            let place = |time: f64| 0.5 * -3.0 * (time - turn).powi(2);
            let at = |time: f64| (place(time), -3.0 * (time - turn));
            let found = way.turn_between(at(0.0), at(TIME_STEP), 1).unwrap();
            assert!(found.abs() < 1e-15, "{found} m");
        }
        assert_eq!(way.turn_between((0.0, 1.0), (1e-3, 2.0), 1), None);
    }
}
