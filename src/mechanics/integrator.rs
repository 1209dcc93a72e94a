//! Newmark's constant average acceleration (Melo et al. 2006, eqs. 2c, 2d, 5, 7) in tangent form, over any length of
//! step. It knows a mass on a spring; contact is the laws' concern.

use std::f64::consts::PI;

/// Critical time step of one degree of freedom, s: a tenth of the period (Melo et al. 2006, eq. 7).
#[must_use]
pub fn critical_time_step(mass: f64, stiffness: f64) -> f64 {
    2.0 * PI / 10.0 * (mass / stiffness).sqrt()
}

/// Motion of the structure and the force it meets at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// m
    pub displacement: f64,
    /// m/s
    pub velocity: f64,
    /// m/s²
    pub acceleration: f64,
    /// N: read at a step's start, inside a step the tangent's prediction.
    pub restoring_force: f64,
}

/// The left and right sides of eq. (5): `inertia · Ẍ₁ = load`, kg and N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    pub inertia: f64,
    pub load: f64,
}

impl Motion {
    /// Eq. (5) for a body of `mass` with `damping` and the tangent `stiffness` over `duration`.
    #[inline]
    #[must_use]
    pub fn balance(&self, mass: f64, damping: f64, stiffness: f64, duration: f64) -> Balance {
        let half = 0.5 * duration;
        let glide = self.velocity + half * self.acceleration;
        let drift = duration * (self.velocity + 0.5 * half * self.acceleration);
        Balance {
            inertia: mass + half * (damping + half * stiffness),
            load: -self.restoring_force - damping * glide - stiffness * drift,
        }
    }

    /// Eqs. (2c), (2d): on to the end of `duration` with the acceleration found there.
    #[inline]
    #[must_use]
    pub fn follow(&self, acceleration: f64, stiffness: f64, duration: f64) -> Self {
        let velocity = self.velocity + 0.5 * duration * (self.acceleration + acceleration);
        let displacement = self.displacement + 0.5 * duration * (self.velocity + velocity);
        let restoring_force = self.restoring_force + stiffness * (displacement - self.displacement);
        Self { displacement, velocity, acceleration, restoring_force }
    }

    /// A whole step under no other force.
    #[inline]
    #[must_use]
    pub fn free(&self, mass: f64, damping: f64, stiffness: f64, duration: f64) -> Self {
        let balance = self.balance(mass, damping, stiffness, duration);
        self.follow(balance.load / balance.inertia, stiffness, duration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MASS: f64 = 1.0;
    const STIFFNESS: f64 = 400.0;

    /// Free vibration from X = 0 at 1 m/s: error of X against sin ωt / ω after `steps` steps to a fixed instant.
    fn error(damping: f64, steps: u32) -> f64 {
        let end = 0.37;
        let duration = end / f64::from(steps);
        let rate = damping / (2.0 * MASS);
        let damped = (STIFFNESS / MASS - rate * rate).sqrt();
        let mut motion = Motion { displacement: 0.0, velocity: 1.0, acceleration: -damping / MASS, restoring_force: 0.0 };
        for _ in 0..steps {
            motion = motion.free(MASS, damping, STIFFNESS, duration);
        }
        motion.displacement - (-rate * end).exp() * (damped * end).sin() / damped
    }

    #[test]
    fn free_vibration_is_of_second_order() {
        for damping in [0.0, 6.0] {
            let order = (error(damping, 400) / error(damping, 800)).log2();
            assert!((order - 2.0).abs() < 0.02, "C {damping}: order {order}");
            assert!(error(damping, 800).abs() < 5e-6);
        }
    }

    /// Constant average acceleration neither feeds nor drains a linear vibration, at any step.
    #[test]
    fn undamped_energy_stays() {
        for duration in [1e-3, 0.1] {
            let mut motion = Motion { displacement: 0.0, velocity: 1.0, acceleration: 0.0, restoring_force: 0.0 };
            for _ in 0..1000 {
                motion = motion.free(MASS, 0.0, STIFFNESS, duration);
            }
            let energy = MASS * motion.velocity.powi(2) + STIFFNESS * motion.displacement.powi(2);
            assert!((energy - 1.0).abs() < 1e-11, "{energy}");
        }
    }

    /// T = 2π√(1/400) s.
    #[test]
    fn critical_step_is_a_tenth_of_the_period() {
        assert!((critical_time_step(MASS, STIFFNESS) - 0.031_415_926_535_897_93).abs() < 1e-16);
    }
}
