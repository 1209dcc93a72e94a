//! A specimen that breaks once and for all. In: a displacement. Out: the force of what it is made of, then none.

use super::{RestoringForce, SpecimenModel};

/// What a specimen breaks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Breaks {
    /// m, either way
    Displacement(f64),
    /// N, either way
    Force(f64),
}

/// Breaks at the first place where |X| or |R| is at least what it bears. The force is looked at along a move, and not where it
/// ends alone: at most a share `STRETCH` of the bound apart by the initial stiffness, so that a force that rises past the bound and
/// falls back within one move is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Fracture {
    of: SpecimenModel,
    at: Breaks,
    broken: bool,
    displacement: f64,
}

/// How far apart the force is looked at, as a share of the bound it is held to: x = share · F / K.
const STRETCH: f64 = 0.01;
/// Looks in one move, at most: a longer move is looked at as often, further apart.
const MOST_LOOKS: f64 = 10_000.0;

impl Fracture {
    /// Whole so far.
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
                / (STRETCH * bound))
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
    fn it_breaks_either_way_and_stays_broken() {
        for at in [Breaks::Displacement(0.02), Breaks::Force(20.0)] {
            for way in [1.0, -1.0] {
                let mut model = spring(at);
                assert_eq!(model.move_to(way * 0.019), way * 19.0);
                assert_eq!(model.move_to(0.0), 0.0);
                assert_eq!(
                    model.move_to(way * 0.02),
                    0.0,
                    "{at:?}: at the bound it is broken"
                );
                assert_eq!(model.move_to(way * 0.001), 0.0);
            }
        }
        assert_eq!(spring(Breaks::Force(1.0)).initial_stiffness(), 1000.0);
    }

    /// It rises to 30 N at 30 mm and falls to 5 N at 60 mm: however it goes there, 25 N is passed.
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
