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
