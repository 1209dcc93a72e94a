//! Loops of force and displacement: energy, secant stiffness and equivalent damping of one cycle. In: the points of a
//! cycle in order. Out: a [`Loop`]. It knows no rig and no plan.

/// What one cycle comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// Half the width of the loop, a, m.
    pub amplitude: f64,
    /// ∫R dX from the first point to the last by the trapezoid, J: positive where energy was spent. The ends of a
    /// cycle are at one place, so that it is the area of the loop.
    pub energy: f64,
    /// N
    pub max_force: f64,
    /// N
    pub min_force: f64,
    /// From the leftmost point to the rightmost, `K_sec`, N/m; None without motion.
    pub stiffness: Option<f64>,
    /// Equivalent viscous damping, `E_D / (4π E_S0)` with `E_S0 = ½ K_sec a²` (Jacobsen 1930; Chopra, Dynamics of
    /// Structures, sec. 3.9). About the middle of the loop, so that it means the same of one-sided cycles. None where
    /// the loop has no positive stiffness.
    pub damping_ratio: Option<f64>,
}

/// The loop through `points` (m, N); None of fewer than two.
#[must_use]
pub fn loop_of(points: &[(f64, f64)]) -> Option<Loop> {
    let (first, rest) = points.split_first().filter(|(_, rest)| !rest.is_empty())?;
    let (mut left, mut right) = (*first, *first);
    let (mut max_force, mut min_force) = (first.1, first.1);
    for point in rest {
        left = if point.0 < left.0 { *point } else { left };
        right = if point.0 > right.0 { *point } else { right };
        max_force = max_force.max(point.1);
        min_force = min_force.min(point.1);
    }
    let energy = points.windows(2).map(|pair| work(pair[0], pair[1])).sum();
    let width = right.0 - left.0;
    let amplitude = 0.5 * width;
    let stiffness = (width > 0.0).then(|| (right.1 - left.1) / width);
    let damping_ratio = stiffness.filter(|stiffness| *stiffness > 0.0).map(|stiffness| {
        let stored = 0.5 * stiffness * amplitude * amplitude;
        energy / (4.0 * std::f64::consts::PI * stored)
    });
    Some(Loop { amplitude, energy, max_force, min_force, stiffness, damping_ratio })
}

/// ∫R dX between two points by the trapezoid, J.
#[must_use]
pub fn work(from: (f64, f64), to: (f64, f64)) -> f64 {
    0.5 * (from.1 + to.1) * (to.0 - from.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::specimen::{Bilinear, Elastic, RestoringForce};

    /// Points of one cycle to +a, −a and back, `points` to the quarter.
    fn cycle(model: &mut dyn RestoringForce, amplitude: f64, points: u32) -> Vec<(f64, f64)> {
        let mut path = vec![(0.0, model.move_to(0.0))];
        let (mut from, ends) = (0.0, [(amplitude, 1), (-amplitude, 2), (0.0, 1)]);
        for (to, quarters) in ends {
            let count = points * quarters;
            for point in 1..=count {
                let x = if point == count { to } else { from + (to - from) * f64::from(point) / f64::from(count) };
                path.push((x, model.move_to(x)));
            }
            from = to;
        }
        path
    }

    #[test]
    fn an_elastic_loop_has_no_area() {
        let found = loop_of(&cycle(&mut Elastic { stiffness: 2000.0 }, 0.01, 7)).unwrap();
        assert!(found.energy.abs() < 1e-16 && found.damping_ratio.unwrap().abs() < 1e-15);
        assert!((found.stiffness.unwrap() - 2000.0).abs() < 1e-9 && (found.amplitude - 0.01).abs() < 1e-18);
        assert!((found.max_force - 20.0).abs() < 1e-12 && (found.min_force + 20.0).abs() < 1e-12);
    }

    /// A closed loop of the bilinear model is a parallelogram of area `4 F_y (1 − α)(u_m − u_y)`, and its ζ is
    /// `2(µ − 1)(1 − α) / (π µ (1 + αµ − α))` with µ = `u_m/u_y` (Chopra, sec. 7.12, of the same definition).
    #[test]
    fn a_bilinear_loop_has_the_area_of_its_parallelogram_and_the_error_falls_with_the_points() {
        let (stiffness, yield_force, hardening, amplitude) = (1000.0, 10.0, 0.1, 0.033);
        let yields_at = yield_force / stiffness;
        let exact = 4.0 * yield_force * (1.0 - hardening) * (amplitude - yields_at);
        let ductility = amplitude / yields_at;
        let ratio = 2.0 * (ductility - 1.0) * (1.0 - hardening)
            / (std::f64::consts::PI * ductility * (1.0 + hardening * ductility - hardening));
        let of = |points: u32| {
            let mut model = Bilinear::new(stiffness, yield_force, hardening);
            // The first cycle begins on the virgin curve: the second is the closed loop.
            cycle(&mut model, amplitude, points);
            loop_of(&cycle(&mut model, amplitude, points)).unwrap()
        };
        // A corner inside a step of h cuts off at most (1 − α) K h²/8; a loop has four corners, two of them targets.
        for points in [10, 40, 160, 640] {
            let step = amplitude / f64::from(points);
            let most = 2.0 * (1.0 - hardening) * stiffness * step * step / 8.0;
            let error = (of(points).energy - exact).abs();
            assert!(error <= most * (1.0 + 1e-9), "{points} points: {error} J, at most {most} J");
        }
        let fine = of(6600);
        assert!((fine.energy / exact - 1.0).abs() < 1e-6, "{} J is not {exact} J", fine.energy);
        assert!((fine.damping_ratio.unwrap() / ratio - 1.0).abs() < 1e-6);
        let secant = (yield_force + hardening * stiffness * (amplitude - yields_at)) / amplitude;
        assert!((fine.stiffness.unwrap() - secant).abs() < 1e-6);
    }

    #[test]
    fn nothing_has_no_loop_and_rest_no_stiffness() {
        assert_eq!(loop_of(&[(0.0, 1.0)]), None);
        let rest = loop_of(&[(0.1, 1.0), (0.1, 2.0)]).unwrap();
        assert_eq!((rest.stiffness, rest.damping_ratio, rest.max_force), (None, None, 2.0));
    }
}
