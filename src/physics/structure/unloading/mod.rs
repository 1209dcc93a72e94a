//! Unloading of a frame. In: the initial stiffness, then displacements and forces of the floors. Out: the distance of each floor from its
//! unloaded position. It moves nothing.
//!
//! In a shear building each storey's shear is a function of its own storey drift, so that the system is uncoupled. Storey j is off by
//! −Vⱼ/kⱼ, and kⱼ is the secant that a move showed. Elements, each with an axis of its own, are unloaded in the same way: displacements
//! are then their deformations, and forces their own. Any other frame uses K⁻¹ of the initial stiffness throughout.

mod line;
mod path;

pub use path::UnloadingPath;

use self::line::Line;
use super::matrix::{BandFactor, NotPositiveDefinite, SymmetricBand};
use super::shear_building::{drifts, shears, storeys_of};

/// A stiffness shown by a move is accepted within this factor of the expected one.
pub(super) const BELIEVED: f64 = 16.0;

/// The unloading stiffness, as far as it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Unloading {
    slopes: Slopes,
    /// Largest sum of a row of |K| \[N/m\].
    stiffest: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Slopes {
    /// The stiffness of each storey or element \[N/m\]: expected, and as the last move showed it.
    Storeys {
        expected: Vec<f64>,
        shown: Vec<f64>,
        /// Whether each stands on the one below.
        stacked: bool,
    },
    Whole(BandFactor),
}

/// Positions \[m\] and restoring forces \[N\] of the floors; deformations and forces of elements.
#[derive(Clone, Copy, Debug)]
pub struct Loaded<'a> {
    pub displacement: &'a [f64],
    pub force: &'a [f64],
}

impl Unloading {
    /// # Errors
    /// If the initial stiffness is not positive definite.
    pub fn of(stiffness: &SymmetricBand) -> Result<Self, NotPositiveDefinite> {
        let factor = BandFactor::new(stiffness)?;
        let order = stiffness.order();
        let row = |row: usize| {
            (0..order)
                .map(|column| stiffness.entry(row, column).abs())
                .sum()
        };
        let stiffest = (0..order).map(row).fold(0.0, f64::max);
        let slopes = match storeys_of(stiffness) {
            Some(expected) => Slopes::Storeys {
                shown: expected.clone(),
                expected,
                stacked: true,
            },
            None => Slopes::Whole(factor),
        };
        Ok(Self { slopes, stiffest })
    }

    /// One degree of freedom, with K > 0 \[N/m\].
    #[must_use]
    pub fn of_one(stiffness: f64) -> Self {
        Self::of_elements(vec![stiffness], stiffness)
    }

    /// Elements that are unloaded each on its own, with K > 0 of every element, and the largest of a tested one \[N/m\].
    #[must_use]
    pub fn of_elements(expected: Vec<f64>, stiffest: f64) -> Self {
        Self {
            slopes: Slopes::Storeys {
                shown: expected.clone(),
                expected,
                stacked: false,
            },
            stiffest,
        }
    }

    /// The force at every floor for a displacement resolution `quantum` \[m\], in N: a smaller force is not distinguished from zero.
    #[must_use]
    pub const fn force_of(&self, quantum: f64) -> f64 {
        self.stiffest * quantum
    }

    /// The move of each floor or element \[m\] by which these forces \[N\] become zero.
    #[must_use]
    pub fn moves(&self, force: &[f64]) -> Vec<f64> {
        match &self.slopes {
            Slopes::Storeys { shown, .. } => {
                let loads = self.loads(force).into_iter().zip(shown);
                self.positions(loads.map(|(load, stiffness)| -load / stiffness))
            }
            Slopes::Whole(factor) => {
                let mut moves: Vec<f64> = force.iter().map(|force| -force).collect();
                factor.solve_in_place(&mut moves);
                moves
            }
        }
    }

    /// Whether each storey stands on the one below.
    const fn is_stacked(&self) -> bool {
        matches!(self.slopes, Slopes::Storeys { stacked: true, .. })
    }

    /// The load of each storey or element \[N\].
    fn loads(&self, force: &[f64]) -> Vec<f64> {
        let mut loads = force.to_vec();
        if self.is_stacked() {
            shears(force, &mut loads);
        }
        loads
    }

    /// The drift of each storey, or the deformation of each element \[m\].
    fn drifts(&self, displacement: &[f64]) -> Vec<f64> {
        let mut drift = displacement.to_vec();
        if self.is_stacked() {
            drifts(displacement, &mut drift);
        }
        drift
    }

    /// The moves of the floors or elements \[m\], from those of the storeys or elements.
    fn positions(&self, moves: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut below = 0.0;
        let position = |moves: f64| {
            if !self.is_stacked() {
                return moves;
            }
            below += moves;
            below
        };
        moves.map(position).collect()
    }

    /// Drift \[m\] and load \[N\] of each storey or element.
    fn parts_at(&self, at: Loaded<'_>) -> Vec<(f64, f64)> {
        let drifts = self.drifts(at.displacement).into_iter();
        drifts.zip(self.loads(at.force)).collect()
    }

    /// Change of drift \[m\] and of load \[N\] of each storey or element.
    fn between(&self, from: Loaded<'_>, to: Loaded<'_>) -> [Vec<f64>; 2] {
        let less = |to: &[f64], from: &[f64]| -> Vec<f64> {
            to.iter().zip(from).map(|(to, from)| to - from).collect()
        };
        [
            self.drifts(&less(to.displacement, from.displacement)),
            self.loads(&less(to.force, from.force)),
        ]
    }

    /// The expected stiffness of each storey or element \[N/m\]; None for a frame that is not a shear building.
    #[must_use]
    pub fn storeys(&self) -> Option<&[f64]> {
        match &self.slopes {
            Slopes::Storeys { expected, .. } => Some(expected),
            Slopes::Whole(_) => None,
        }
    }

    /// Expects the slope that the last moves agree on, where that is softer: `points` are the readings of the branch, `noise` gives the
    /// standard deviations of the shear \[N\] and of the storey drift \[m\] of a storey, `least` \[m\] is the least significant travel.
    #[must_use]
    pub fn expecting_the_branch<'a>(
        mut self,
        points: impl IntoIterator<Item = Loaded<'a>>,
        noise: &dyn Fn(usize) -> (f64, f64),
        least: f64,
    ) -> Self {
        let mut lines: Vec<Line> = Vec::new();
        for at in points {
            let read = self.parts_at(at);
            if lines.is_empty() {
                lines = read.into_iter().map(Line::new).collect();
            } else {
                for (storey, (line, at)) in lines.iter_mut().zip(read).enumerate() {
                    line.learn(at, noise(storey));
                }
            }
        }
        let Slopes::Storeys {
            expected, shown, ..
        } = &mut self.slopes
        else {
            return self;
        };
        for (storey, line) in lines.iter().enumerate() {
            if let Some(slope) = line.slope(noise(storey), least) {
                expected[storey] = slope.min(expected[storey]);
                shown[storey] = expected[storey];
            }
        }
        self
    }

    /// The secant of each storey or element \[N/m\] if a move changed its storey drift, and none if there are no storeys.
    #[must_use]
    pub fn secants(&self, from: Loaded<'_>, to: Loaded<'_>) -> Vec<Option<f64>> {
        let [moved, changed] = self.between(from, to);
        let secant = |(moved, changed): (f64, f64)| {
            (moved != 0.0 && self.storeys().is_some()).then(|| changed / moved)
        };
        moved.into_iter().zip(changed).map(secant).collect()
    }

    /// Learns the secants of a move for the storeys for which `sure` is true. Its arguments: the storey from 0, its expected stiffness
    /// \[N/m\] and its change of storey drift \[m\].
    pub fn learn_where(
        &mut self,
        from: Loaded<'_>,
        to: Loaded<'_>,
        sure: &dyn Fn(usize, f64, f64) -> bool,
    ) {
        let secants = self.secants(from, to);
        let [moved, _] = self.between(from, to);
        let Slopes::Storeys {
            expected, shown, ..
        } = &mut self.slopes
        else {
            return;
        };
        for (storey, ((shown, expected), secant)) in
            shown.iter_mut().zip(expected).zip(&secants).enumerate()
        {
            if let Some(secant) = secant.filter(|_| sure(storey, *expected, moved[storey])) {
                *shown = secant.clamp(*expected / BELIEVED, BELIEVED * *expected);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::shear_building::{floor_forces, storey_stiffness};
    use super::*;

    /// Storeys of 3 and 2 N/m under forces 1 and 4 N of their floors: shears 5 and 4 N, storey drifts 5/3 and 2 m.
    #[test]
    fn a_shear_building_falls_apart_into_its_storeys() {
        let stiffness = storey_stiffness(&[3.0, 2.0]);
        let unloading = Unloading::of(&stiffness).unwrap();
        let moves = unloading.moves(&[1.0, 4.0]);
        assert!(
            (moves[0] + 5.0 / 3.0).abs() < 1e-15 && (moves[1] + 5.0 / 3.0 + 2.0).abs() < 1e-15,
            "{moves:?}"
        );
        // Rows of |K|: 5 + 2 and 2 + 2.
        assert!((unloading.force_of(0.5) - 3.5).abs() < 1e-15);
    }

    /// The same by K⁻¹, for a frame with a spring from its top to the ground, which is not a shear building.
    #[test]
    fn any_other_frame_is_solved_as_a_whole() {
        let stiffness = SymmetricBand::from_dense(&[vec![5.0, -2.0], vec![-2.0, 6.0]]).unwrap();
        let braced = SymmetricBand::from_dense(&[vec![5.0, -6.0], vec![-6.0, 9.0]]).unwrap();
        for matrix in [stiffness, braced] {
            let unloading = Unloading::of(&matrix).unwrap();
            let displacements = [0.25, -0.5];
            let mut force = [0.0; 2];
            matrix.mul_into(&displacements, &mut force);
            for (moves, displacement) in unloading.moves(&force).iter().zip(displacements) {
                assert!((moves + displacement).abs() < 1e-14);
            }
        }
    }

    /// A storey that unloads at half its stiffness is off by twice as much; a secant from noise is not accepted.
    #[test]
    fn each_storey_is_off_by_the_stiffness_that_it_shows() {
        let mut unloading = Unloading::of(&storey_stiffness(&[3.0, 2.0])).unwrap();
        let softer = storey_stiffness(&[1.5, 2.0]);
        let force_at = |displacements: &[f64]| {
            let mut force = [0.0; 2];
            softer.mul_into(displacements, &mut force);
            force
        };
        let (displacements, next) = ([1.0, 1.5], [0.7, 1.1]);
        let (force, force_of) = (force_at(&displacements), force_at(&next));
        let [from, to] =
            [(&displacements, &force), (&next, &force_of)].map(|(displacement, force)| Loaded {
                displacement,
                force,
            });
        assert!(
            unloading
                .secants(from, to)
                .into_iter()
                .zip([1.5, 2.0])
                .all(|(one, other)| (one.unwrap() - other).abs() < 1e-12)
        );
        unloading.learn_where(from, to, &|_, _, _| true);
        assert!(
            unloading
                .moves(&force_of)
                .iter()
                .zip(next)
                .all(|(moves, displacement)| (moves + displacement).abs() < 1e-14)
        );
        let mut noisy = [0.0; 2];
        floor_forces(&[100.0, -100.0], &mut noisy);
        let [from, to] = [([0.0, 0.0], [0.0, 0.0]), ([1e-3, 2e-3], noisy)];
        let [from, to] = [&from, &to].map(|(displacement, force)| Loaded {
            displacement,
            force,
        });
        assert!(
            unloading
                .secants(from, to)
                .iter()
                .all(|secant| secant.is_some_and(|secant| secant.abs() > 9e4))
        );
        unloading.learn_where(from, to, &|_, _, _| true);
        let moves = unloading.moves(&[0.0, 12.0]);
        assert!(
            (moves[0] + 0.25).abs() < 1e-12 && (moves[1] + 0.25 + 96.0).abs() < 1e-12,
            "{moves:?}"
        );
    }
}
