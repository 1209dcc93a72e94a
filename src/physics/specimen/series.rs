//! Two specimens in series: one force, displacements that add. In: the displacement of both. Out: their force.

use super::{RestoringForce, SpecimenModel};

/// f₁(u) = f₂(x − u). Neither force falls while its displacement grows. Over a move by Δx the difference f₁(u) − f₂(x − u) therefore does
/// not fall over u between u₀ and u₀ + Δx and changes its sign there. The root is always bracketed, and each part moves in the direction
/// of the whole. If both parts yield at the same force there are many roots: the first part then moves only as far as it must, so that
/// many small moves end at the same point as a large one. The root is found by false position with the Illinois rule, with bisection if
/// it is slow, to the last bits of u.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    first: SpecimenModel,
    second: SpecimenModel,
    /// u \[m\]
    first_displacement: f64,
    displacement: f64,
    force: f64,
}

/// Largest number of evaluations of one move: bisection alone from 1 m to 1e-19 m takes 64.
const MOST_TRIALS: usize = 200;
/// Relative resolution of a displacement.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Series {
    /// Any number of parts, at least one, nested from the last.
    #[must_use]
    pub fn of(parts: impl DoubleEndedIterator<Item = SpecimenModel>) -> SpecimenModel {
        let nested = parts.rev().reduce(|second, first| {
            let (first_displacement, displacement, force) = (0.0, 0.0, 0.0);
            SpecimenModel::Series(Box::new(Self {
                first,
                second,
                first_displacement,
                displacement,
                force,
            }))
        });
        nested.unwrap_or(SpecimenModel::Parallel(Vec::new()))
    }

    /// Both forces with the first part at `first`.
    fn forces(&self, first: f64, displacement: f64) -> (f64, f64) {
        (
            self.first.clone().move_to(first),
            self.second.clone().move_to(displacement - first),
        )
    }

    /// u of the root that is nearest to the present displacement of the first part.
    fn solve(&self, displacement: f64) -> f64 {
        let moved = displacement - self.displacement;
        // The displacement of the first part ahead of equilibrium: it does not fall along the move.
        let excess = |first: f64| {
            let (ahead, behind) = self.forces(first, displacement);
            (ahead - behind) * moved.signum()
        };
        let (mut near, mut far) = (self.first_displacement, self.first_displacement + moved);
        let (mut at_near, mut at_far) = (excess(near), excess(far));
        if at_near >= 0.0 {
            return near;
        }
        let between = |position: f64, near: f64, far: f64| {
            near.min(far) < position && position < near.max(far)
        };
        let mut kept_far = None;
        for trial in 0..MOST_TRIALS {
            let width = far - near;
            let by_position = far - at_far * (width / (at_far - at_near));
            let by_position = Some(by_position)
                .filter(|position| trial % 4 != 3 && between(*position, near, far));
            let middle = by_position.unwrap_or(near + 0.5 * width);
            if !between(middle, near, far) {
                break;
            }
            let found = excess(middle);
            // It is one of many roots if a slightly nearer value is a root too.
            if found == 0.0 && excess(middle - ROUNDING * middle.abs() * moved.signum()) < 0.0 {
                return middle;
            }
            if found >= 0.0 {
                (far, at_far) = (middle, found);
                if kept_far == Some(false) {
                    at_near *= 0.5;
                }
                kept_far = Some(false);
            } else {
                (near, at_near) = (middle, found);
                if kept_far == Some(true) {
                    at_far *= 0.5;
                }
                kept_far = Some(true);
            }
        }
        if -at_near < at_far { near } else { far }
    }
}

impl RestoringForce for Series {
    fn move_to(&mut self, displacement: f64) -> f64 {
        if displacement != self.displacement {
            let first = self.solve(displacement);
            let (ahead, behind) = (
                self.first.move_to(first),
                self.second.move_to(displacement - first),
            );
            // The rest of their difference is the rounding of u, multiplied by the stiffness of either part.
            let (stiff, soft) = (
                self.first.initial_stiffness(),
                self.second.initial_stiffness(),
            );
            let total = stiff + soft;
            self.force = if total > 0.0 {
                (ahead * soft + behind * stiff) / total
            } else {
                0.5 * (ahead + behind)
            };
            self.first_displacement = first;
            self.displacement = displacement;
        }
        self.force
    }

    fn initial_stiffness(&self) -> f64 {
        1.0 / (1.0 / self.first.initial_stiffness() + 1.0 / self.second.initial_stiffness())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Bilinear, BilinearCurve, Elastic};
    use super::*;
    use crate::specimen::{Behaviour, Bolted};

    const SPRING: Behaviour = Behaviour::Elastic { stiffness: 3000.0 };
    const YIELDS: Behaviour = Behaviour::Bilinear {
        stiffness: 1500.0,
        yield_force: 10.0,
        post_yield_ratio: 0.2,
    };

    fn series(parts: &[Behaviour]) -> SpecimenModel {
        SpecimenModel::new(&Behaviour::Series(parts.to_vec()))
    }

    /// Elastic 3000 N/m in series with bilinear 1500 N/m, 10 N, 300 N/m: together bilinear 1000 N/m, 10 N, then 1/(1/3000 + 1/300) =
    /// 272.73 N/m.
    #[test]
    fn a_spring_behind_a_bilinear_one_is_a_bilinear_one() {
        let mut found = series(&[SPRING, YIELDS]);
        let mut by_hand = Bilinear::new(BilinearCurve {
            stiffness: 1000.0,
            yield_force: 10.0,
            post_yield_ratio: 3000.0 / 11.0 / 1000.0,
        });
        assert!((found.initial_stiffness() - 1000.0).abs() < 1e-9);
        for displacement in [0.005, 0.02, 0.05, 0.03, -0.04, -0.01, 0.0] {
            let (force, hand) = (found.move_to(displacement), by_hand.move_to(displacement));
            assert!(
                (force - hand).abs() < 1e-10,
                "{displacement} m: {force} N is not {hand} N"
            );
        }
    }

    #[test]
    fn springs_are_added_by_their_flexibilities_and_one_is_itself() {
        let mut three = series(&[SPRING, SPRING, Behaviour::Elastic { stiffness: 1e9 }]);
        let stiffness = 1.0 / (2.0 / 3000.0 + 1e-9);
        assert!((three.move_to(0.7) / (0.7 * stiffness) - 1.0).abs() < 1e-12);
        assert!((three.move_to(-1e-9) / (-1e-9 * stiffness) - 1.0).abs() < 1e-6);
        assert_eq!(
            series(&[SPRING]),
            SpecimenModel::Elastic(Elastic { stiffness: 3000.0 })
        );
    }

    /// The paper's supports: a beam in series with a joint with clearance. Zero force over the clearance, then K of both in series.
    #[test]
    fn a_beam_behind_a_joint_with_clearance() {
        let joint = Behaviour::Bolted(Bolted {
            stiffness: 6000.0,
            bearing_force: 100.0,
            clearance: 0.001,
            slip_force: 0.0,
        });
        let mut found = series(&[SPRING, joint]);
        assert!(found.move_to(0.001).abs() < 1e-12);
        assert!(
            (found.move_to(0.002) - 2.0).abs() < 1e-9,
            "2000 N/m over 1 mm"
        );
        assert!((found.move_to(-0.002) + 2.0).abs() < 1e-9);
    }

    #[test]
    fn it_does_not_depend_on_the_size_of_its_moves() {
        let wen = Behaviour::BoucWen {
            stiffness: 2000.0,
            yield_force: 8.0,
            post_yield_ratio: 0.05,
            sharpness: 2.0,
            beta: 0.6,
        };
        let (mut once, mut often) = (
            series(&[wen.clone(), YIELDS, SPRING]),
            series(&[wen, YIELDS, SPRING]),
        );
        let mut from = 0.0;
        for to in [0.04, -0.03, 0.01, 0.02] {
            for i in 1..=50 {
                often.move_to(from + (to - from) * f64::from(i) / 50.0);
            }
            let apart = once.move_to(to) - often.move_to(to);
            assert!(apart.abs() < 1e-6 * 8.0, "{apart} N");
            from = to;
        }
    }
}
