//! Piecewise linear with kinematic hardening: elastic–plastic elements in parallel. In: a displacement. Out: the force there, exact for a
//! move of any length.

use super::RestoringForce;

/// Elastic–plastic elements in parallel (Iwan's model): with slopes k₁ > k₂ > … of the backbone between its points x₁ < x₂ < …,
/// element i has the stiffness kᵢ − kᵢ₊₁ and yields at xᵢ; the last slope is elastic. Unloading and reloading follow Masing's rule: the
/// backbone, twice as large.
#[derive(Clone, Debug, PartialEq)]
pub struct Multilinear {
    elements: Vec<Element>,
    /// Slope after the last backbone point but one \[N/m\].
    last_slope: f64,
    displacement: f64,
}

/// k (x − p), at most k x_y in either direction; updated by the return map of perfect plasticity.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Element {
    stiffness: f64,
    yield_force: f64,
    force: f64,
}

impl Multilinear {
    /// From the backbone points, displacement \[m\] and force \[N\]: at least one, both rising, each slope smaller than the one before.
    #[must_use]
    pub fn new(points: &[[f64; 2]]) -> Self {
        let mut before = [0.0, 0.0];
        let slopes: Vec<f64> = points
            .iter()
            .map(|point| {
                let slope = (point[1] - before[1]) / (point[0] - before[0]);
                before = *point;
                slope
            })
            .collect();
        let elements = points.iter().zip(slopes.windows(2)).map(|(point, slopes)| {
            let stiffness = slopes[0] - slopes[1];
            Element {
                stiffness,
                yield_force: stiffness * point[0],
                force: 0.0,
            }
        });
        Self {
            elements: elements.collect(),
            last_slope: slopes.last().copied().unwrap_or(0.0),
            displacement: 0.0,
        }
    }
}

impl RestoringForce for Multilinear {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let moved = displacement - self.displacement;
        self.displacement = displacement;
        let mut force = self.last_slope * displacement;
        for element in &mut self.elements {
            let trial = element.force + element.stiffness * moved;
            element.force = trial.clamp(-element.yield_force, element.yield_force);
            force += element.force;
        }
        force
    }

    fn initial_stiffness(&self) -> f64 {
        self.last_slope
            + self
                .elements
                .iter()
                .map(|element| element.stiffness)
                .sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Bilinear, BilinearCurve};
    use super::*;

    const CORNERS: [[f64; 2]; 3] = [[0.001, 1000.0], [0.003, 2000.0], [0.008, 3000.0]];

    #[test]
    fn the_first_loading_goes_through_its_corners_and_beyond() {
        let mut model = Multilinear::new(&CORNERS);
        assert!((model.initial_stiffness() - 1e6).abs() < 1e-9);
        for [displacement, force] in &CORNERS {
            assert!((model.move_to(*displacement) - force).abs() < 1e-9);
        }
        assert!(
            (model.move_to(0.010) - 3400.0).abs() < 1e-9,
            "200 N/mm goes on"
        );
    }

    /// Masing: after a reversal at (x_t, R_t) the branch is R = R_t − 2 F((x_t − x)/2) with the backbone F; a closed inner loop is
    /// erased.
    #[test]
    fn unloading_is_the_first_loading_twice_as_large_and_inner_loops_are_forgotten() {
        let mut turned = Multilinear::new(&CORNERS);
        let top = turned.move_to(0.010);
        for step in 1..=40 {
            let travel = f64::from(step) * 0.0005;
            let by_masing = top - 2.0 * Multilinear::new(&CORNERS).move_to(travel / 2.0);
            let mut one = turned.clone();
            assert!(
                (one.move_to(0.010 - travel) - by_masing).abs() < 1e-8,
                "{travel} m back"
            );
        }
        let mut straight = turned.clone();
        turned.move_to(0.004);
        turned.move_to(0.006);
        turned.move_to(0.004);
        assert!((turned.move_to(-0.002) - straight.move_to(-0.002)).abs() < 1e-9);
    }

    /// Closed form: each element of yield displacement x_y dissipates 4 k x_y (A − x_y) per cycle of amplitude A > x_y.
    #[test]
    fn a_cycle_takes_the_energy_of_its_elements() {
        let amplitude = 0.006;
        let slopes: [f64; 3] = [1e6, 5e5, 2e5];
        let by_hand = 4.0 * (slopes[0] - slopes[1]) * 0.001 * (amplitude - 0.001)
            + 4.0 * (slopes[1] - slopes[2]) * 0.003 * (amplitude - 0.003);
        let mut model = Multilinear::new(&CORNERS);
        model.move_to(amplitude);
        let energy = super::super::tests::energy_along(
            &mut model,
            amplitude,
            &[-amplitude, amplitude],
            1e-6,
        );
        assert!(
            (energy / by_hand - 1.0).abs() < 1e-6,
            "{energy} J is not {by_hand} J"
        );
    }

    #[test]
    fn two_slopes_are_the_bilinear_specimen() {
        let (mut two, mut bilinear) = (
            Multilinear::new(&[[0.01, 10.0], [0.03, 12.0]]),
            Bilinear::new(BilinearCurve {
                stiffness: 1000.0,
                yield_force: 10.0,
                post_yield_ratio: 0.1,
            }),
        );
        for displacement in [0.03, 0.01, -0.02, 0.05, 0.0] {
            assert!((two.move_to(displacement) - bilinear.move_to(displacement)).abs() < 1e-12);
        }
    }
}
