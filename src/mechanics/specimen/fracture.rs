//! A specimen that breaks once and for all. In: a displacement. Out: the force of what it is made of, then none.

use super::{RestoringForce, SpecimenModel};
use crate::plan::Breaks;

/// Breaks at the first place where |X| or |R| is at least what it bears. The displacement at which it breaks does not depend
/// on the size of the moves; the force is looked at where a move ends, so that one which rises past the bound and falls
/// back within a single move is not seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Fracture {
    of: SpecimenModel,
    at: Breaks,
    broken: bool,
}

impl Fracture {
    /// Whole so far.
    #[must_use]
    pub const fn new(of: SpecimenModel, at: Breaks) -> Self {
        Self { of, at, broken: false }
    }
}

impl RestoringForce for Fracture {
    fn move_to(&mut self, displacement: f64) -> f64 {
        if self.broken {
            return 0.0;
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
                assert_eq!(model.move_to(way * 0.02), 0.0, "{at:?}: at the bound it is broken");
                assert_eq!(model.move_to(way * 0.001), 0.0);
            }
        }
        assert_eq!(spring(Breaks::Force(1.0)).initial_stiffness(), 1000.0);
    }
}
