//! Elastic–plastic with two slopes. In: a displacement. Out: the force there, by an exact return map.

use super::RestoringForce;
use crate::number::{Number, numbers};

/// The parameters of a curve with two slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearCurve {
    /// K \[N/m\]
    pub stiffness: f64,
    /// `F_y` \[N\]
    pub yield_force: f64,
    /// Post-yield stiffness ratio `K_p/K`, 0 to 1.
    pub post_yield_ratio: f64,
}

numbers! {
    /// The lines of an elastic–plastic model.
    pub(crate) struct BilinearLines {
        /// K \[N/m\]
        stiffness,
        /// `K_p` \[N/m\]
        hardened,
        /// Half of the height of the band between the two parallel lines \[N\].
        half_band,
    }
}

/// Elastic–plastic with kinematic hardening: the force has the stiffness K between two parallel lines of slope `K_p`,
/// `R = K_p X ± (1 − K_p/K) F_y`, and along the line it meets. The elastic trial cut to the band is the exact return map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilinear {
    lines: BilinearLines,
    displacement: f64,
    force: f64,
}

impl Bilinear {
    /// A spring at zero displacement.
    #[must_use]
    pub fn new(curve: BilinearCurve) -> Self {
        Self {
            lines: BilinearLines {
                stiffness: curve.stiffness,
                hardened: curve.post_yield_ratio * curve.stiffness,
                half_band: (1.0 - curve.post_yield_ratio) * curve.yield_force,
            },
            displacement: 0.0,
            force: 0.0,
        }
    }

    /// Whether it has not been displaced yet.
    pub(crate) fn is_undisplaced(&self) -> bool {
        self.displacement == 0.0 && self.force == 0.0
    }

    pub(crate) const fn lines(&self) -> BilinearLines {
        self.lines
    }
}

#[allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]
impl<N: Number> BilinearLines<N> {
    /// The force \[N\] at `displacement` \[m\] after a move from (X, R).
    #[inline(always)]
    pub(crate) fn force(&self, [from, force]: [N; 2], displacement: N) -> N {
        let trial = force + self.stiffness * (displacement - from);
        let middle = self.hardened * displacement;
        trial
            .larger(middle - self.half_band)
            .smaller(middle + self.half_band)
    }
}

impl RestoringForce for Bilinear {
    #[inline]
    fn move_to(&mut self, displacement: f64) -> f64 {
        self.force = self
            .lines
            .force([self.displacement, self.force], displacement);
        self.displacement = displacement;
        self.force
    }

    fn initial_stiffness(&self) -> f64 {
        self.lines.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// K 1000 N/m, `F_y` 10 N, `K_p` 100 N/m: yield at 10 mm, 20 N of elastic range, then the loop closes on itself.
    #[test]
    fn bilinear_corners_by_hand() {
        let mut model = Bilinear::new(BilinearCurve {
            stiffness: 1000.0,
            yield_force: 10.0,
            post_yield_ratio: 0.1,
        });
        let corners = [
            (0.010, 10.0),
            (0.030, 12.0),
            (0.010, -8.0),
            (-0.010, -10.0),
            (0.010, 10.0),
            (0.030, 12.0),
            (0.020, 2.0),
            (0.030, 12.0),
        ];
        for (displacement, force) in corners {
            let found = model.move_to(displacement);
            assert!(
                (found - force).abs() < 1e-12,
                "{displacement} m: {found} N is not {force} N"
            );
        }
        assert_eq!(model.initial_stiffness(), 1000.0);
    }

    /// The path is exact: a yield point is reached in one move or in many.
    #[test]
    fn bilinear_does_not_depend_on_the_size_of_its_moves() {
        let (mut once, mut often) = (
            Bilinear::new(BilinearCurve {
                stiffness: 1000.0,
                yield_force: 10.0,
                post_yield_ratio: 0.1,
            }),
            Bilinear::new(BilinearCurve {
                stiffness: 1000.0,
                yield_force: 10.0,
                post_yield_ratio: 0.1,
            }),
        );
        let mut from = 0.0;
        for to in [0.030, -0.020, 0.005] {
            for i in 1..=100 {
                often.move_to(from + (to - from) * f64::from(i) / 100.0);
            }
            assert!((once.move_to(to) - often.move_to(to)).abs() < 1e-12);
            from = to;
        }
    }
}
