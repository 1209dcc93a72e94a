//! Stiffness that falls with the peak displacement. In: a displacement. Out: the force there, exact for a move of any length.

use super::RestoringForce;

/// R = K(x_m) X with the peak displacement x_m so far, K(x) = K (r + (1 − r)/(1 + x/h)): half of the loss occurs at x = h. Without a
/// residual the backbone is the hyperbola R = K X/(1 + X/h), which never exceeds K h. It unloads to the origin: a crack closes, without
/// plastic deformation. Energy dissipated up to x_m:
/// ∫R dX − ½ K(x_m) x_m² = (1 − r) K h² [s − ln(1 + s) − ½ s²/(1 + s)], s = x_m/h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degrading {
    stiffness: f64,
    half_displacement: f64,
    residual: f64,
    farthest: f64,
}

impl Degrading {
    /// `stiffness` K \[N/m\], `half_displacement` h \[m\], `residual` r, 0 to 1.
    #[must_use]
    pub const fn new(stiffness: f64, half_displacement: f64, residual: f64) -> Self {
        Self {
            stiffness,
            half_displacement,
            residual,
            farthest: 0.0,
        }
    }
}

impl RestoringForce for Degrading {
    fn move_to(&mut self, displacement: f64) -> f64 {
        self.farthest = self.farthest.max(displacement.abs());
        let left =
            self.residual + (1.0 - self.residual) / (1.0 + self.farthest / self.half_displacement);
        self.stiffness * left * displacement
    }

    fn initial_stiffness(&self) -> f64 {
        self.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::energy_along;
    use super::*;

    #[test]
    fn the_first_loading_is_the_hyperbola_and_unloading_goes_to_the_origin() {
        let mut model = Degrading::new(1e6, 0.002, 0.0);
        assert!((model.move_to(0.002) - 1000.0).abs() < 1e-9, "half of K X");
        assert!((model.move_to(0.006) - 1500.0).abs() < 1e-9, "a quarter");
        assert!((model.move_to(0.003) - 750.0).abs() < 1e-9);
        assert_eq!(model.move_to(0.0), 0.0);
        assert!(
            (model.move_to(-0.003) + 750.0).abs() < 1e-9,
            "the other way it is as weak"
        );
        let mut stubborn = Degrading::new(1e6, 0.002, 0.25);
        assert!((stubborn.move_to(0.002) - 1250.0).abs() < 1e-9);
    }

    #[test]
    fn the_energy_lost_is_that_of_the_closed_form() {
        let (stiffness, half, residual, far) = (1e6, 0.002, 0.2, 0.007);
        let mut model = Degrading::new(stiffness, half, residual);
        let lost = energy_along(&mut model, 0.0, &[far, 0.0], 1e-6);
        let s: f64 = far / half;
        let by_hand =
            (1.0 - residual) * stiffness * half * half * (s - s.ln_1p() - 0.5 * s * s / (1.0 + s));
        assert!(
            (lost / by_hand - 1.0).abs() < 1e-6,
            "{lost} J is not {by_hand} J"
        );
        let again = energy_along(&mut model, 0.0, &[far, -far, 0.0], 1e-6);
        assert!(
            again.abs() < 1e-9 * lost,
            "the same cycle again takes nothing"
        );
    }
}
