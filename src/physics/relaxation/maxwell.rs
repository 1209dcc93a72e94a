//! A Maxwell branch: a spring and a dashpot in series, in parallel with a specimen. In: the motion of the specimen. Out: the force of
//! the branch, in closed form, so that neither the length of a dwell nor the number of evaluations matters. It knows no specimen.
//!
//! The branch force q follows q' = K₁ x' − q/τ with τ = c/K₁. The same equation describes the relaxed part of a force that relaxes by a
//! fraction of itself, with the force for x and a number for K₁.

use crate::tracking::trajectory::Rate;

/// Motion of an actuator over some time: v(t) = v + a t + ½ j t² + `fading`·exp(−t/`lag`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// At its begin.
    pub start: Rate,
    /// Velocity at the begin that decays by a first-order lag \[m/s\].
    pub fading: f64,
    /// Time constant of that decay \[s\]; 0 without it.
    pub lag: f64,
    /// Duration \[s\].
    pub seconds: f64,
}

impl Motion {
    /// At rest.
    #[must_use]
    pub const fn rest(seconds: f64) -> Self {
        Self::even(0.0, seconds)
    }

    /// At constant velocity \[m/s\].
    #[must_use]
    pub const fn even(velocity: f64, seconds: f64) -> Self {
        Self {
            start: Rate {
                velocity,
                acceleration: 0.0,
                jerk: 0.0,
            },
            fading: 0.0,
            lag: 0.0,
            seconds,
        }
    }

    /// The motion with every rate times `factor`: the rate of a force with the slope `factor`.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.start;
        let start = Rate {
            velocity: factor * velocity,
            acceleration: factor * acceleration,
            jerk: factor * jerk,
        };
        Self {
            start,
            fading: factor * self.fading,
            ..*self
        }
    }

    /// Displacement over the first `seconds` \[m\].
    #[must_use]
    pub fn displacement(&self, seconds: f64) -> f64 {
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.start;
        let faded = if self.fading == 0.0 {
            0.0
        } else {
            -self.fading * self.lag * (-seconds / self.lag).exp_m1()
        };
        seconds * (velocity + seconds * (0.5 * acceleration + seconds * jerk / 6.0)) + faded
    }

    /// The part between two times \[s\].
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.start;
        let velocity = velocity + from * (acceleration + 0.5 * from * jerk);
        let start = Rate {
            velocity,
            acceleration: acceleration + from * jerk,
            jerk,
        };
        let fading = if self.fading == 0.0 {
            0.0
        } else {
            self.fading * (-from / self.lag).exp()
        };
        Self {
            start,
            fading,
            lag: self.lag,
            seconds: to - from,
        }
    }

    /// Motion relative to that of the storey below, over the same time and with the same lag.
    #[must_use]
    pub fn relative_to(&self, below: &Self) -> Self {
        let (one, other) = (self.start, below.start);
        let start = Rate {
            velocity: one.velocity - other.velocity,
            acceleration: one.acceleration - other.acceleration,
            jerk: one.jerk - other.jerk,
        };
        // The motion of an actuator at rest does not decay.
        let lag = if self.fading == 0.0 {
            below.lag
        } else {
            self.lag
        };
        Self {
            start,
            fading: self.fading - below.fading,
            lag,
            ..*self
        }
    }
}

/// q' = K₁ x' − q/τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxwellBranch {
    /// K₁ \[N/m\]
    stiffness: f64,
    /// τ = c/K₁ \[s\]
    time_constant: f64,
    /// q \[N\]
    force: f64,
}

impl MaxwellBranch {
    /// K₁ \[N/m\] and τ \[s\], without force.
    #[must_use]
    pub const fn new(stiffness: f64, time_constant: f64) -> Self {
        Self {
            stiffness,
            time_constant,
            force: 0.0,
        }
    }

    /// K₁ \[N/m\]
    #[must_use]
    pub const fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// q \[N\]
    #[must_use]
    pub const fn force(&self) -> f64 {
        self.force
    }

    /// |dq/dt| after a dwell of `seconds` \[N/s\].
    #[must_use]
    pub fn rate_after(&self, seconds: f64) -> f64 {
        (self.force / self.time_constant).abs() * (-seconds / self.time_constant).exp()
    }

    /// An instantaneous displacement \[m\].
    pub fn jump(&mut self, moved: f64) {
        self.force += self.stiffness * moved;
    }

    /// q(T) = q e^(−T/τ) + K₁ ∫ v(s) e^(−(T−s)/τ) ds.
    pub fn follow(&mut self, motion: &Motion) {
        let Motion {
            start,
            fading,
            lag,
            seconds,
        } = *motion;
        if seconds <= 0.0 {
            return;
        }
        let tau = self.time_constant;
        let [once, by_time, by_square] = weights(seconds, tau);
        let mut moved =
            start.velocity * once + start.acceleration * by_time + 0.5 * start.jerk * by_square;
        if fading != 0.0 {
            moved += fading * faded(seconds, [lag, tau]);
        }
        self.force = self.force * (-seconds / tau).exp() + self.stiffness * moved;
    }
}

/// ∫₀ᵀ sⁿ e^(−(T−s)/τ) ds for n = 0, 1, 2: by parts, or, where T is short against τ and the parts nearly cancel, by the series
/// Tⁿ⁺¹ Σ (−T/τ)ᵏ n!/(n+k+1)!.
fn weights(seconds: f64, tau: f64) -> [f64; 3] {
    let ratio = seconds / tau;
    if ratio > 1.0 {
        let once = -tau * (-ratio).exp_m1();
        let by_time = tau * (seconds - once);
        return [once, by_time, tau * (seconds * seconds - 2.0 * by_time)];
    }
    let series = |power: u32| {
        let mut term = seconds.powi(power.cast_signed() + 1) / f64::from(power + 1);
        let (mut sum, mut next) = (0.0, f64::from(power + 1));
        while term.abs() > f64::EPSILON * 1e-2 * f64::abs(sum) {
            sum += term;
            next += 1.0;
            term *= -ratio / next;
        }
        sum
    };
    [series(0), series(1), series(2)]
}

/// ∫₀ᵀ e^(−s/τ₁) e^(−(T−s)/τ₂) ds of two time constants \[s\], also where they are equal. Which comes first does not matter.
fn faded(seconds: f64, [lag, tau]: [f64; 2]) -> f64 {
    let apart = (1.0 / lag - 1.0 / tau) * seconds;
    let slower = lag.max(tau);
    let share = if apart == 0.0 {
        1.0
    } else {
        -(-apart.abs()).exp_m1() / apart.abs()
    };
    seconds * (-seconds / slower).exp() * share
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_midpoints(branch: &MaxwellBranch, motion: &Motion) -> f64 {
        let (mut force, parts) = (branch.force, 100_000);
        let step = motion.seconds / f64::from(parts);
        let half = 0.5 * step / branch.time_constant;
        for part in 0..parts {
            let time = step * (f64::from(part) + 0.5);
            let fading = if motion.lag > 0.0 {
                motion.fading * (-time / motion.lag).exp()
            } else {
                0.0
            };
            let Rate {
                velocity,
                acceleration,
                jerk,
            } = motion.start;
            let velocity = velocity + time * (acceleration + 0.5 * time * jerk) + fading;
            force = (force * (1.0 - half) + step * branch.stiffness * velocity) / (1.0 + half);
        }
        force
    }

    /// The trapezoid of q' = K₁ v − q/τ over a hundred thousand parts, for every mixture of the times.
    #[test]
    fn it_is_the_integral_of_its_equation() {
        for (tau, lag) in [
            (0.3, 0.05),
            (0.05, 0.3),
            (0.2, 0.2),
            (40.0, 0.1),
            (0.01, 0.0),
        ] {
            let fading = if lag > 0.0 { -0.02 } else { 0.0 };
            let start = Rate {
                velocity: 0.01,
                acceleration: -0.04,
                jerk: 0.3,
            };
            let motion = Motion {
                start,
                fading,
                lag,
                seconds: 0.5,
            };
            let mut branch = MaxwellBranch {
                force: 7.0,
                ..MaxwellBranch::new(4000.0, tau)
            };
            let by_steps = by_midpoints(&branch, &motion);
            branch.follow(&motion);
            assert!(
                (branch.force - by_steps).abs() < 1e-6,
                "τ {tau}: {} N, by steps {by_steps} N",
                branch.force
            );
        }
    }

    /// A ramp of velocity v for T: K₁ v τ (1 − e^(−T/τ)); a pause then leaves e^(−t/τ) of it.
    #[test]
    fn a_ramp_and_a_hold_are_those_of_the_standard_linear_solid() {
        let mut branch = MaxwellBranch::new(2e5, 1.5);
        branch.follow(&Motion::even(1e-3, 2.0));
        let held = 2e5 * 1e-3 * 1.5 * (1.0 - (-2.0_f64 / 1.5).exp());
        assert!((branch.force / held - 1.0).abs() < 1e-14);
        assert!((branch.rate_after(0.6) - held / 1.5 * (-0.4_f64).exp()).abs() < 1e-12);
        branch.follow(&Motion::rest(0.6));
        assert!((branch.force / (held * (-0.4_f64).exp()) - 1.0).abs() < 1e-14);
        // In an instant it is a spring of K₁, and after long nothing.
        branch.follow(&Motion::rest(1e4));
        branch.follow(&Motion::even(1e3, 1e-9));
        assert!(
            (branch.force / 0.2 - 1.0).abs() < 1e-8,
            "1 µm on 200 kN/m: {}",
            branch.force
        );
    }

    /// On either side of T = τ.
    #[test]
    fn it_does_not_depend_on_the_number_of_evaluations() {
        for (seconds, tau) in [(0.9, 1.0), (1.1, 1.0), (1e-3, 1e3)] {
            let (mut once, mut often) =
                (MaxwellBranch::new(1e5, tau), MaxwellBranch::new(1e5, tau));
            let rate = |time: f64| Rate {
                velocity: 0.01 + time * (0.02 + 0.5 * time * 0.5),
                acceleration: 0.02 + time * 0.5,
                jerk: 0.5,
            };
            once.follow(&Motion {
                start: rate(0.0),
                fading: 0.0,
                lag: 0.0,
                seconds,
            });
            for part in 0..64 {
                let from = seconds * f64::from(part) / 64.0;
                often.follow(&Motion {
                    start: rate(from),
                    fading: 0.0,
                    lag: 0.0,
                    seconds: seconds / 64.0,
                });
            }
            assert!(
                (once.force / often.force - 1.0).abs() < 1e-12,
                "{} N is not {} N",
                once.force,
                often.force
            );
        }
    }
}
