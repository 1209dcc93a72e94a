//! The critical time step of one degree of freedom. In: mass, stiffness. Out: a time. It integrates nothing.

use std::f64::consts::PI;

/// Critical time step of one degree of freedom, s: a tenth of the period (Melo et al. 2006, eq. 7).
#[must_use]
pub fn critical_time_step(mass: f64, stiffness: f64) -> f64 {
    2.0 * PI / 10.0 * (mass / stiffness).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MASS: f64 = 1.0;
    const STIFFNESS: f64 = 400.0;

    /// T = 2π√(1/400) s.
    #[test]
    fn critical_step_is_a_tenth_of_the_period() {
        assert!((critical_time_step(MASS, STIFFNESS) - 0.031_415_926_535_897_93).abs() < 1e-16);
    }
}
