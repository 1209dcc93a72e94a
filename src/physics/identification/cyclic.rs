//! Loops of force and displacement: energy, secant stiffness and equivalent damping of one cycle. In: the points of a
//! cycle in order. Out: a [`Loop`]. It knows no rig and no plan.

/// One reading of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopPoint {
    /// Commanded displacement \[m\].
    pub command: f64,
    /// \[m\]
    pub displacement: f64,
    /// \[N\]
    pub force: f64,
}

/// The results of one cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// Half the width of the loop, a \[m\].
    pub amplitude: f64,
    /// ∫R dX from the first point to the last by the trapezoidal rule \[J\]: positive if energy was dissipated. A cycle begins and ends
    /// at one position, so that this is the area of the loop.
    pub energy: f64,
    /// \[N\]
    pub max_force: f64,
    /// \[N\]
    pub min_force: f64,
    /// Displacement \[m\] and force \[N\] at the leftmost and at the rightmost command. If a position is commanded twice, as the start of
    /// a one-sided cycle, the last reading counts: it closes the loop, and the choice does not depend on errors of readings.
    pub ends: [(f64, f64); 2],
    /// From the left end to the right, `K_sec` \[N/m\]; None without motion.
    pub stiffness: Option<f64>,
    /// Equivalent viscous damping, `E_D / (4π E_S0)` with `E_S0 = ½ K_sec a²`. A damper C = 2ζ√(KM) that moves at ω = √(K/M) dissipates π
    /// C ω a² = 4πζ·½Ka² per cycle. It refers to the middle of the loop, so that it has the same meaning for one-sided cycles. None if
    /// the loop has no positive stiffness.
    pub damping_ratio: Option<f64>,
}

/// The loop through `points`; None for fewer than two.
#[must_use]
pub fn loop_of(points: &[LoopPoint]) -> Option<Loop> {
    let (first, rest) = points.split_first().filter(|(_, rest)| !rest.is_empty())?;
    let (mut left, mut right) = (first, first);
    let (mut max_force, mut min_force) = (first.force, first.force);
    for point in rest {
        left = if point.command <= left.command {
            point
        } else {
            left
        };
        right = if point.command >= right.command {
            point
        } else {
            right
        };
        max_force = max_force.max(point.force);
        min_force = min_force.min(point.force);
    }
    let energy = points
        .windows(2)
        .map(|pair| work(pair[0].point(), pair[1].point()))
        .sum();
    let width = right.displacement - left.displacement;
    let amplitude = 0.5 * width;
    let stiffness = (width > 0.0).then(|| (right.force - left.force) / width);
    let damping_ratio = stiffness
        .filter(|stiffness| *stiffness > 0.0)
        .map(|stiffness| {
            let stored = 0.5 * stiffness * amplitude * amplitude;
            energy / (4.0 * std::f64::consts::PI * stored)
        });
    Some(Loop {
        amplitude,
        energy,
        max_force,
        min_force,
        ends: [left.point(), right.point()],
        stiffness,
        damping_ratio,
    })
}

impl LoopPoint {
    fn point(&self) -> (f64, f64) {
        (self.displacement, self.force)
    }
}

/// ∫R dX between two points by the trapezoidal rule \[J\].
#[must_use]
pub fn work(from: (f64, f64), to: (f64, f64)) -> f64 {
    0.5 * (from.1 + to.1) * (to.0 - from.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::specimen::{Bilinear, BilinearCurve, Elastic, RestoringForce};

    fn read(position: f64, model: &mut dyn RestoringForce) -> LoopPoint {
        LoopPoint {
            command: position,
            displacement: position,
            force: model.move_to(position),
        }
    }

    /// Points of one cycle to +a, −a and back, `points` per quarter.
    fn cycle(model: &mut dyn RestoringForce, amplitude: f64, points: u32) -> Vec<LoopPoint> {
        let mut path = vec![read(0.0, model)];
        let (mut from, ends) = (0.0, [(amplitude, 1), (-amplitude, 2), (0.0, 1)]);
        for (to, quarters) in ends {
            let count = points * quarters;
            for point in 1..=count {
                let x = if point == count {
                    to
                } else {
                    from + (to - from) * f64::from(point) / f64::from(count)
                };
                path.push(read(x, model));
            }
            from = to;
        }
        path
    }

    #[test]
    fn an_elastic_loop_has_no_area() {
        let found = loop_of(&cycle(&mut Elastic { stiffness: 2000.0 }, 0.01, 7)).unwrap();
        assert!(found.energy.abs() < 1e-16 && found.damping_ratio.unwrap().abs() < 1e-15);
        assert!(
            (found.stiffness.unwrap() - 2000.0).abs() < 1e-9
                && (found.amplitude - 0.01).abs() < 1e-18
        );
        assert!((found.max_force - 20.0).abs() < 1e-12 && (found.min_force + 20.0).abs() < 1e-12);
    }

    /// A closed loop of the bilinear model is a parallelogram of area `4 F_y (1 − α)(u_m − u_y)`, and its ζ is
    /// `2(µ − 1)(1 − α) / (π µ (1 + αµ − α))` with µ = `u_m/u_y`: that area over 2π `K_sec` `u_m²`,
    /// `K_sec` = K(1 + αµ − α)/µ.
    #[test]
    fn a_bilinear_loop_has_the_area_of_its_parallelogram_and_the_error_falls_with_the_points() {
        let (stiffness, yield_force, post_yield_ratio, amplitude) = (1000.0, 10.0, 0.1, 0.033);
        let yields_at = yield_force / stiffness;
        let exact = 4.0 * yield_force * (1.0 - post_yield_ratio) * (amplitude - yields_at);
        let ductility = amplitude / yields_at;
        let ratio = 2.0 * (ductility - 1.0) * (1.0 - post_yield_ratio)
            / (std::f64::consts::PI
                * ductility
                * (1.0 + post_yield_ratio * ductility - post_yield_ratio));
        let of = |points: u32| {
            let mut model = Bilinear::new(BilinearCurve {
                stiffness,
                yield_force,
                post_yield_ratio,
            });
            // The first cycle begins on the virgin curve: the second is the closed loop.
            cycle(&mut model, amplitude, points);
            loop_of(&cycle(&mut model, amplitude, points)).unwrap()
        };
        // A corner inside a step of h cuts off at most (1 − α) K h²/8; a loop has four corners, two of them targets.
        for points in [10, 40, 160, 640] {
            let step = amplitude / f64::from(points);
            let most = 2.0 * (1.0 - post_yield_ratio) * stiffness * step * step / 8.0;
            let error = (of(points).energy - exact).abs();
            assert!(
                error <= most * (1.0 + 1e-9),
                "{points} points: {error} J, at most {most} J"
            );
        }
        let fine = of(6600);
        assert!(
            (fine.energy / exact - 1.0).abs() < 1e-6,
            "{} J is not {exact} J",
            fine.energy
        );
        assert!((fine.damping_ratio.unwrap() / ratio - 1.0).abs() < 1e-6);
        let secant =
            (yield_force + post_yield_ratio * stiffness * (amplitude - yields_at)) / amplitude;
        assert!((fine.stiffness.unwrap() - secant).abs() < 1e-6);
    }

    #[test]
    fn nothing_has_no_loop_and_rest_no_stiffness() {
        let still = |force| LoopPoint {
            command: 0.1,
            displacement: 0.1,
            force,
        };
        assert_eq!(loop_of(&[still(1.0)]), None);
        let rest = loop_of(&[still(1.0), still(2.0)]).unwrap();
        assert_eq!(
            (rest.stiffness, rest.damping_ratio, rest.max_force),
            (None, None, 2.0)
        );
    }
    /// Pushed to `a` and back from the virgin state: the start position is read twice, at zero force and at the force that holds it
    /// there. Whatever the errors of the two readings, the loop begins at the second.
    #[test]
    fn a_one_sided_loop_is_closed_by_its_last_reading() {
        for error in [-1e-6, 0.0, 1e-6] {
            let mut model = Bilinear::new(BilinearCurve {
                stiffness: 1000.0,
                yield_force: 10.0,
                post_yield_ratio: 0.0,
            });
            let mut points = vec![
                read(0.0, &mut model),
                read(0.03, &mut model),
                read(0.0, &mut model),
            ];
            points[2].displacement += error;
            let found = loop_of(&points).unwrap();
            assert_eq!(found.ends, [(error, -10.0), (0.03, 10.0)]);
            assert!((found.stiffness.unwrap() - 20.0 / (0.03 - error)).abs() < 1e-9);
            for point in &mut points {
                *point = LoopPoint {
                    command: -point.command,
                    displacement: -point.displacement,
                    force: -point.force,
                };
            }
            let pulled = loop_of(&points).unwrap();
            assert_eq!(
                (pulled.stiffness, pulled.damping_ratio),
                (found.stiffness, found.damping_ratio)
            );
        }
    }
}
