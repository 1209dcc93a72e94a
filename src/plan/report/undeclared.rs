//! The uncertainties of striker, specimen and rig that a plan does not declare, and that no budget therefore includes. In: a plan. Out:
//! phrases for the report. It makes no statement of conformity: a plan may leave out contributions that are small.

use crate::{Calibration, Frame, Plan, RigPlan};

/// The uncertain inputs of striker and specimen that a procedure depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dependence {
    /// Index into `Plan::strikers`.
    pub striker: Option<usize>,
    /// Standard uncertainty of the mass of one degree of freedom \[kg\]; 0 where none is stated.
    pub mass_uncertainty: Option<f64>,
    /// Index into `Plan::specimens` of a frame, whose masses it depends on.
    pub frame: Option<usize>,
}

impl Plan {
    /// Uncertainties of the striker, the specimen and the rig that the plan does not declare and a procedure depends on.
    #[must_use]
    pub fn undeclared(&self, dependence: Dependence) -> Vec<&'static str> {
        let striker = dependence
            .striker
            .and_then(|striker| self.strikers.get(striker));
        let frame = dependence
            .frame
            .and_then(|specimen| self.specimens.get(specimen))
            .and_then(|specimen| specimen.frame.as_ref());
        let mass_of_frame = frame.is_some_and(|frame| {
            let storeys = frame
                .storeys
                .iter()
                .any(|storey| storey.mass_uncertainty == 0.0);
            if frame.storeys.is_empty() {
                frame.matrix_uncertainty[0] == 0.0
            } else {
                storeys
            }
        });
        let mass_of_one = dependence.mass_uncertainty == Some(0.0);
        let own = [
            (
                "striker mass",
                striker.is_some_and(|striker| striker.mass_uncertainty == 0.0),
            ),
            (
                "striker velocity",
                striker.is_some_and(|striker| striker.velocity_uncertainty == 0.0),
            ),
            ("specimen mass", mass_of_one || mass_of_frame),
            (
                "weights of the floors",
                frame.is_some_and(Frame::computes_p_delta),
            ),
            (
                "axial load and its share of P-Δ",
                frame.is_some() && self.rig.axial_axes(&self.limits).next().is_some(),
            ),
        ];
        let own = own
            .into_iter()
            .filter(|(_, undeclared)| *undeclared)
            .map(|(name, _)| name);
        own.chain(self.rig.undeclared(self.degrees_of_freedom()))
            .collect()
    }
}

impl RigPlan {
    /// Uncertainties of the rig that the plan does not declare for at least one of its axes.
    #[must_use]
    pub fn undeclared(&self, axes: usize) -> Vec<&'static str> {
        let lacks = |read| self.lacks(axes, read);
        let all = [
            (
                FORCE_CALIBRATION,
                lacks(|calibration| calibration.force_uncertainty),
            ),
            (
                DISPLACEMENT_CALIBRATION,
                lacks(|calibration| calibration.displacement_uncertainty),
            ),
            (
                "zero offset of the load cell",
                lacks(|calibration| calibration.zero_uncertainty),
            ),
            ("zero drift in the run", self.zero_drift.is_none()),
        ];
        all.into_iter()
            .filter(|(_, undeclared)| *undeclared)
            .map(|(name, _)| name)
            .collect()
    }

    /// The calibrations without which a budget is partial, so that no expanded uncertainty follows from it.
    #[must_use]
    pub fn undeclared_calibrations(&self, axes: usize) -> Vec<&'static str> {
        self.undeclared(axes)
            .into_iter()
            .filter(|name| [FORCE_CALIBRATION, DISPLACEMENT_CALIBRATION].contains(name))
            .collect()
    }

    fn lacks(&self, axes: usize, read: fn(&Calibration) -> f64) -> bool {
        (0..axes.max(1)).any(|axis| read(&self.calibration_of(axis)) == 0.0)
    }
}

/// In messages and reports, by axis.
pub const FORCE_CALIBRATION: &str = "force calibration";
/// The same.
pub const DISPLACEMENT_CALIBRATION: &str = "displacement calibration";

#[cfg(test)]
mod tests {
    use crate::testing::empty_plan;
    use crate::{Calibration, DriftCheck, ZeroAfter};

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
        assert_eq!(rig.undeclared(2), ["zero drift in the run"]);
        rig.zero_drift = Some(DriftCheck {
            force: 5.0,
            displacement: None,
            over: 1.0,
            after: ZeroAfter::Start,
        });
        assert!(rig.undeclared(2).is_empty());
    }
}
