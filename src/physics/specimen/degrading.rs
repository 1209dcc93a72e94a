//! Stiffness that falls with the peak displacement. In: a displacement. Out: the force there, exact for a move of any length.

use super::RestoringForce;

/// R = K(x_m) X with the peak displacement x_m so far, K(x) = K (r + (1 − r)/(1 + x/h)): half of the loss occurs at x = h. Without a
/// residual the backbone is the hyperbola R = K X/(1 + X/h), which never exceeds K h. It unloads to the origin: a crack closes, without
/// plastic deformation. Energy dissipated up to x_m:
/// ∫R dX − ½ K(x_m) x_m² = (1 − r) K h² [s − ln(1 + s) − ½ s²/(1 + s)], s = x_m/h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degrading {
    curve: DegradingCurve,
    farthest: f64,
}

/// The parameters of the backbone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DegradingCurve {
    /// K \[N/m\]
    pub stiffness: f64,
    /// h \[m\]
    pub half_displacement: f64,
    /// r, 0 to 1.
    pub residual: f64,
}

impl Degrading {
    /// A spring that has not moved.
    #[must_use]
    pub const fn new(curve: DegradingCurve) -> Self {
        Self {
            curve,
            farthest: 0.0,
        }
    }
}

impl RestoringForce for Degrading {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let DegradingCurve {
            stiffness,
            half_displacement,
            residual,
        } = self.curve;
        self.farthest = self.farthest.max(displacement.abs());
        let left = residual + (1.0 - residual) / (1.0 + self.farthest / half_displacement);
        stiffness * left * displacement
    }

    fn initial_stiffness(&self) -> f64 {
        self.curve.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::energy_along;
    use super::*;

    #[test]
    fn the_first_loading_is_the_hyperbola_and_unloading_goes_to_the_origin() {
        let mut model = Degrading::new(DegradingCurve {
            stiffness: 1e6,
            half_displacement: 0.002,
            residual: 0.0,
        });
        assert!((model.move_to(0.002) - 1000.0).abs() < 1e-9, "half of K X");
        assert!((model.move_to(0.006) - 1500.0).abs() < 1e-9, "a quarter");
        assert!((model.move_to(0.003) - 750.0).abs() < 1e-9);
        assert_eq!(model.move_to(0.0), 0.0);
        assert!(
            (model.move_to(-0.003) + 750.0).abs() < 1e-9,
            "the other way it is as weak"
        );
        let mut stubborn = Degrading::new(DegradingCurve {
            stiffness: 1e6,
            half_displacement: 0.002,
            residual: 0.25,
        });
        assert!((stubborn.move_to(0.002) - 1250.0).abs() < 1e-9);
    }

    #[test]
    fn the_energy_lost_is_that_of_the_closed_form() {
        let (stiffness, half, residual, far) = (1e6, 0.002, 0.2, 0.007);
        let mut model = Degrading::new(DegradingCurve {
            stiffness,
            half_displacement: half,
            residual,
        });
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
