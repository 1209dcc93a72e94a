//! The axes of a checked rig: what each actuator with its load cell says of itself, and what holds for it where it says
//! nothing. In: the rig of a plan, the place of an axis. Out: its sign, its limits, its gate, its readings, its calibration.

use crate::plan::{
    Calibration, DeviceLink, Gate, Interval, Limits, ReadingRules, RealLink, RigPlan,
};

/// What one axis of a real rig says of itself. None: as the rig says of all.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AxisPlan {
    /// +1 or −1
    pub sign: Option<f64>,
    /// m
    pub resolution: Option<f64>,
    /// N
    pub noise: Option<f64>,
    /// N
    pub force_range: Option<Interval>,
    /// Beside the limits of the run, m and N.
    pub displacement: Option<Interval>,
    pub force: Option<Interval>,
    pub gate: Option<Gate>,
    pub calibration: AxisCalibration,
    /// Of its own, in place of the rig's.
    pub actuator: Option<DeviceLink>,
    pub load_cell: Option<DeviceLink>,
}

/// Where the numbers of one axis are traced to. None: as the rig says of all.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AxisCalibration {
    pub reference: Option<String>,
    /// `YYYY-MM-DD`
    pub due: Option<String>,
    pub force_class: Option<String>,
    /// N, by size.
    pub force_calibrated: Option<Interval>,
    /// Reference of the displacement alone.
    pub displacement: Option<String>,
    /// `YYYY-MM-DD`
    pub displacement_due: Option<String>,
    pub displacement_class: Option<String>,
    /// m, by size.
    pub displacement_calibrated: Option<Interval>,
    /// Of a cell that gives raw counts: N per count.
    pub newtons_per_count: Option<f64>,
    /// Count at no force.
    pub zero_count: Option<f64>,
    /// Standard, a share of the force.
    pub force_uncertainty: Option<f64>,
    /// Standard, a share of the displacement.
    pub displacement_uncertainty: Option<f64>,
    /// Standard, N.
    pub zero_uncertainty: Option<f64>,
}

impl AxisCalibration {
    /// What the rig says of all, with what this axis says in its place.
    fn over(&self, all: &Calibration) -> Calibration {
        let or = |own: &Option<String>, all: &Option<String>| own.clone().or_else(|| all.clone());
        let of_all = all.displacement.clone();
        let day = or(
            &self.displacement_due,
            &of_all.as_ref().and_then(|(_, day)| day.clone()),
        );
        let reference = or(&self.displacement, &of_all.map(|(reference, _)| reference));
        Calibration {
            reference: or(&self.reference, &all.reference),
            due: or(&self.due, &all.due),
            force_class: or(&self.force_class, &all.force_class),
            force_calibrated: self.force_calibrated.or(all.force_calibrated),
            displacement: reference.map(|reference| (reference, day)),
            displacement_class: or(&self.displacement_class, &all.displacement_class),
            displacement_calibrated: self.displacement_calibrated.or(all.displacement_calibrated),
            force_uncertainty: self.force_uncertainty.unwrap_or(all.force_uncertainty),
            displacement_uncertainty: self
                .displacement_uncertainty
                .unwrap_or(all.displacement_uncertainty),
            zero_uncertainty: self.zero_uncertainty.unwrap_or(all.zero_uncertainty),
            zero_drift: all.zero_drift,
            newtons_per_count: self.newtons_per_count.or(all.newtons_per_count),
            zero_count: self.zero_count.unwrap_or(all.zero_count),
        }
    }
}

impl RigPlan {
    /// Factor on displacement and force signs of the axis at this place: +1 or −1.
    #[must_use]
    pub fn sign_of(&self, axis: usize) -> f64 {
        self.own(axis).and_then(|own| own.sign).unwrap_or(self.sign)
    }

    /// Where the numbers of the axis at this place are traced to, and how well they are known.
    #[must_use]
    pub fn calibration_of(&self, axis: usize) -> Calibration {
        self.own(axis).map_or_else(
            || self.calibration.clone(),
            |own| own.calibration.over(&self.calibration),
        )
    }

    /// The limits of the run for the axis at this place: its own narrow them.
    #[must_use]
    pub fn limits_of(&self, axis: usize, run: &Limits) -> Limits {
        let narrowed =
            |all: Interval, own: Option<Interval>| own.map_or(all, |own| all.intersection(own));
        self.own(axis).map_or(*run, |own| Limits {
            displacement: narrowed(run.displacement, own.displacement),
            force: narrowed(run.force, own.force),
            ..*run
        })
    }

    /// The limits of the run for every axis; empty where no axis has any of its own.
    #[must_use]
    pub fn limits_of_axes(&self, run: &Limits) -> Vec<Limits> {
        let axes = self.link.as_real().map_or(0, |link| link.axes.len());
        (0..axes).map(|axis| self.limits_of(axis, run)).collect()
    }

    fn own(&self, axis: usize) -> Option<&AxisPlan> {
        self.link.as_real().and_then(|link| link.axes.get(axis))
    }
}

impl RealLink {
    /// The gate of the axis at this place.
    #[must_use]
    pub fn gate_of(&self, axis: usize) -> Gate {
        self.axes
            .get(axis)
            .and_then(|own| own.gate)
            .unwrap_or(self.gate)
    }

    /// What the axis at this place declares of its readings.
    #[must_use]
    pub fn readings_of(&self, axis: usize) -> ReadingRules {
        let all = self.readings;
        self.axes.get(axis).map_or(all, |own| ReadingRules {
            resolution: own.resolution.unwrap_or(all.resolution),
            noise: own.noise.unwrap_or(all.noise),
            force_range: own.force_range.unwrap_or(all.force_range),
            ..all
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_has_what_it_says_and_else_what_the_rig_says_of_all() {
        let text = |text: &str| Some(text.to_owned());
        let all = Calibration {
            reference: text("all"),
            due: text("2027-01-01"),
            displacement: Some(("scale".to_owned(), text("2027-02-01"))),
            force_uncertainty: 0.005,
            zero_uncertainty: 2.0,
            zero_count: 17.0,
            ..Calibration::default()
        };
        assert_eq!(AxisCalibration::default().over(&all), all);
        let own = AxisCalibration {
            reference: text("cell 2"),
            displacement_due: text("2027-03-01"),
            force_uncertainty: Some(0.01),
            displacement_uncertainty: Some(0.002),
            zero_uncertainty: Some(0.0),
            ..AxisCalibration::default()
        };
        let wanted = Calibration {
            reference: text("cell 2"),
            displacement: Some(("scale".to_owned(), text("2027-03-01"))),
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.002,
            zero_uncertainty: 0.0,
            ..all.clone()
        };
        assert_eq!(own.over(&all), wanted);
        // Without one of the rig's, its own certificate stands alone.
        let alone = AxisCalibration {
            displacement: text("scale 2"),
            ..AxisCalibration::default()
        };
        let none = Calibration {
            displacement: None,
            ..all
        };
        assert_eq!(
            alone.over(&none).displacement,
            Some(("scale 2".to_owned(), None))
        );
    }
}
