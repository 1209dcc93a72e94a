//! What a plan does not say of its rig, and no uncertainty knows therefore. In: the rig of a plan. Out: words. It judges nothing: a
//! plan may well leave out what is small.

use super::{Calibration, RigPlan};

impl RigPlan {
    /// Uncertainties of the rig that the plan does not declare of one of so many axes at least.
    #[must_use]
    pub fn undeclared(&self, axes: usize) -> Vec<&'static str> {
        let lacks = |read| self.lacks(axes, read);
        let all = [
            (FORCE, lacks(|calibration| calibration.force_uncertainty)),
            (DISPLACEMENT, lacks(|calibration| calibration.displacement_uncertainty)),
            ("the zero of the load cell", lacks(|calibration| calibration.zero_uncertainty)),
            ("the drift of that zero in the run", self.drift.is_none()),
        ];
        all.into_iter().filter(|(_, lacking)| *lacking).map(|(name, _)| name).collect()
    }

    /// The calibrations without which a budget of so many axes is partial, and no expanded uncertainty follows from it.
    #[must_use]
    pub fn undeclared_calibrations(&self, axes: usize) -> Vec<&'static str> {
        self.undeclared(axes).into_iter().filter(|name| [FORCE, DISPLACEMENT].contains(name)).collect()
    }

    fn lacks(&self, axes: usize, read: fn(&Calibration) -> f64) -> bool {
        (0..axes.max(1)).any(|axis| read(&self.calibration_of(axis)) == 0.0)
    }
}

const FORCE: &str = "the calibration of the force";
const DISPLACEMENT: &str = "the calibration of the displacement";

#[cfg(test)]
mod tests {
    use crate::plan::{Calibration, DriftCheck, ZeroAfter};
    use crate::run::testing::empty_plan;

    #[test]
    fn what_is_not_declared_is_named() {
        let mut rig = empty_plan().rig;
        assert_eq!(rig.undeclared(1).len(), 4);
        rig.calibration = Calibration {
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.001,
            zero_uncertainty: 1.0,
            ..Calibration::default()
        };
        assert_eq!(rig.undeclared(2), ["the drift of that zero in the run"]);
        rig.drift = Some(DriftCheck { force: 5.0, displacement: None, over: 1.0, after: ZeroAfter::Start });
        assert!(rig.undeclared(2).is_empty());
    }
}
