//! A specimen that fractures. In: a displacement. Out: the force of the intact specimen, then zero.

use super::{RestoringForce, SpecimenModel};

/// Criterion of fracture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Breaks {
    /// |X| \[m\]
    Displacement(f64),
    /// |R| \[N\]
    Force(f64),
}

/// Fractures at the first displacement where |X| or |R| reaches its bound. The force is evaluated along a move, not at its end alone: at
/// intervals of a fraction `INTERVAL` of the bound by the initial stiffness, so that a force that exceeds the bound and falls below it
/// within one move is detected.
#[derive(Clone, Debug, PartialEq)]
pub struct Fracture {
    of: SpecimenModel,
    at: Breaks,
    broken: bool,
    displacement: f64,
}

/// Interval of evaluation as a fraction of the bound: x = fraction · F / K.
const INTERVAL: f64 = 0.01;
/// Evaluations of one move, at most: the intervals of a longer move are larger.
const MOST_LOOKS: f64 = 10_000.0;

impl Fracture {
    /// Intact so far.
    #[must_use]
    pub const fn new(of: SpecimenModel, at: Breaks) -> Self {
        Self {
            of,
            at,
            broken: false,
            displacement: 0.0,
        }
    }
}

impl RestoringForce for Fracture {
    fn move_to(&mut self, displacement: f64) -> f64 {
        if self.broken {
            return 0.0;
        }
        let from = std::mem::replace(&mut self.displacement, displacement);
        if let Breaks::Force(bound) = self.at {
            let looks = ((displacement - from).abs() * self.of.initial_stiffness()
                / (INTERVAL * bound))
                .ceil()
                .min(MOST_LOOKS);
            let mut look = 1.0;
            while look < looks && !self.broken {
                self.broken = self
                    .of
                    .move_to(from + (displacement - from) * (look / looks))
                    .abs()
                    >= bound;
                look += 1.0;
            }
            if self.broken {
                return 0.0;
            }
        }
        let force = self.of.move_to(displacement);
        self.broken = match self.at {
            Breaks::Displacement(bound) => displacement.abs() >= bound,
            Breaks::Force(bound) => force.abs() >= bound,
        };
        if self.broken { 0.0 } else { force }
    }

    fn initial_stiffness(&self) -> f64 {
        self.of.initial_stiffness()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Elastic;
    use super::*;
    use crate::specimen::{Table, Unloading};

    fn spring(at: Breaks) -> Fracture {
        Fracture::new(SpecimenModel::Elastic(Elastic { stiffness: 1000.0 }), at)
    }

    #[test]
    fn it_breaks_in_either_direction_and_stays_broken() {
        for at in [Breaks::Displacement(0.02), Breaks::Force(20.0)] {
            for direction in [1.0, -1.0] {
                let mut model = spring(at);
                assert_eq!(model.move_to(direction * 0.019), direction * 19.0);
                assert_eq!(model.move_to(0.0), 0.0);
                assert_eq!(
                    model.move_to(direction * 0.02),
                    0.0,
                    "{at:?}: at the bound it is broken"
                );
                assert_eq!(model.move_to(direction * 0.001), 0.0);
            }
        }
        assert_eq!(spring(Breaks::Force(1.0)).initial_stiffness(), 1000.0);
    }

    /// It rises to 30 N at 30 mm and falls to 5 N at 60 mm: every move to there passes 25 N.
    #[test]
    fn a_peak_within_one_move_breaks_it_however_large_the_move() {
        let points = vec![[0.0, 0.0], [0.03, 30.0], [0.06, 5.0]];
        let table = Table {
            file: "points.csv".to_owned(),
            points,
            unloading: Unloading::AlongTheCurve,
            scale: 1.0,
        };
        for moves in [1_u32, 3, 200] {
            let mut model = Fracture::new(super::super::table::model(&table), Breaks::Force(25.0));
            for step in 1..=moves {
                model.move_to(0.06 * f64::from(step) / f64::from(moves));
            }
            assert_eq!(model.move_to(0.01), 0.0, "{moves} moves");
        }
    }
}
