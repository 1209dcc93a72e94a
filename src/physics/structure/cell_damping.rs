//! Force of a load cell beside the restoring force while a specimen moves: viscous and Coulomb damping, and the rate dependence of
//! strength. In: a restoring force, a velocity. Out: the force that the load cell measures.

use crate::specimen::Behaviour;

/// Viscous and Coulomb damping on the load cell. Friction keeps the direction of the last motion through a pause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellDamping {
    /// \[N·s/m\]
    pub viscous: f64,
    /// \[N\]
    pub coulomb: f64,
    /// +1 or −1; 0 before the first motion.
    pub last_direction: f64,
    /// For a specimen with a rate-dependent strength.
    pub rate: Option<StrengthRate>,
}

/// R (1 + (|v|/v₀)^n) in motion (the law of Cowper and Symonds, n = 1/q, here for force and velocity). At rest the increase is zero: a
/// ramp-and-hold test does not measure it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrengthRate {
    /// v₀ \[m/s\]
    pub reference_velocity: f64,
    /// n
    pub exponent: f64,
}

impl StrengthRate {
    /// The rate dependence that `behaviour` states, if any.
    #[must_use]
    pub const fn of(behaviour: &Behaviour) -> Option<Self> {
        match behaviour {
            Behaviour::Rate {
                reference_velocity,
                exponent,
                ..
            } => Some(Self {
                reference_velocity: *reference_velocity,
                exponent: *exponent,
            }),
            _ => None,
        }
    }

    /// The relative increase of the restoring force at `velocity` \[m/s\].
    #[must_use]
    pub fn gain(&self, velocity: f64) -> f64 {
        if velocity == 0.0 {
            0.0
        } else {
            (velocity.abs() / self.reference_velocity).powf(self.exponent)
        }
    }
}

impl CellDamping {
    /// c·v and a constant friction force: `viscous` \[N·s/m\], `coulomb` \[N\].
    #[must_use]
    pub const fn new(viscous: f64, coulomb: f64) -> Self {
        Self {
            viscous,
            coulomb,
            last_direction: 0.0,
            rate: None,
        }
    }

    /// The same, for a specimen with this behaviour.
    #[must_use]
    pub const fn with_rate_of(mut self, behaviour: &Behaviour) -> Self {
        self.rate = StrengthRate::of(behaviour);
        self
    }

    /// Whether the cell reads the restoring force alone, at any velocity.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.viscous == 0.0 && self.coulomb == 0.0 && self.rate.is_none()
    }

    /// Force of the load cell at `velocity` \[m/s\], for a specimen with `restoring_force` \[N\] at rest \[N\].
    pub fn measured_force(&mut self, restoring_force: f64, velocity: f64) -> f64 {
        let gained = self
            .rate
            .map_or(0.0, |rate| restoring_force * rate.gain(velocity));
        restoring_force + gained + self.force(velocity)
    }

    /// Force at `velocity` \[m/s\], in N: `c·v + F_c·sign` of the last motion.
    pub fn force(&mut self, velocity: f64) -> f64 {
        if velocity != 0.0 {
            self.last_direction = velocity.signum();
        }
        self.viscous * velocity + self.coulomb * self.last_direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_keeps_its_sign_through_a_pause() {
        let mut damping = CellDamping::new(10.0, 3.0);
        assert_eq!(damping.force(0.0), 0.0);
        assert_eq!(damping.force(0.5), 8.0);
        assert_eq!(damping.force(0.0), 3.0);
        assert_eq!(damping.force(-0.5), -8.0);
        assert_eq!(damping.force(0.0), -3.0);
    }

    /// 100 N at v₀/32 and v₀, n = 1/5: one and a half times, and twice.
    #[test]
    fn strength_grows_with_the_speed_and_is_gone_at_rest() {
        let of = Box::new(Behaviour::Elastic { stiffness: 1.0 });
        let behaviour = Behaviour::Rate {
            of,
            reference_velocity: 0.32,
            exponent: 0.2,
        };
        let mut damping = CellDamping::new(10.0, 3.0).with_rate_of(&behaviour);
        assert!((damping.measured_force(100.0, 0.01) - (150.0 + 0.1 + 3.0)).abs() < 1e-12);
        assert!((damping.measured_force(-100.0, -0.32) - (-200.0 - 3.2 - 3.0)).abs() < 1e-12);
        assert_eq!(damping.measured_force(100.0, 0.0), 97.0);
        assert_eq!(CellDamping::new(0.0, 0.0).measured_force(100.0, 1.0), 100.0);
    }
}
