//! What a load cell reads beside the restoring force while a specimen is moved: viscous and Coulomb damping.

/// Viscous and Coulomb damping on the load cell. Friction keeps the direction of the last motion through a pause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellDamping {
    /// N·s/m
    pub viscous: f64,
    /// N
    pub coulomb: f64,
    /// +1 or −1; 0 before the first motion.
    pub last_direction: f64,
}

impl CellDamping {
    #[must_use]
    pub const fn new(viscous: f64, coulomb: f64) -> Self {
        Self { viscous, coulomb, last_direction: 0.0 }
    }

    /// Force at `velocity` (m/s), N: `c·v + F_c·sign` of the last motion.
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
}
