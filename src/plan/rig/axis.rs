//! The axes of a checked rig: the entries of each actuator with its load cell. The rig's entry applies if an axis has none. In: the rig
//! of a plan, the index of an axis. Out: its polarity, limits, pre-test check, reading rules and calibration.

use crate::{
    Calibration, DeviceLink, Frame, Interval, Limits, Link, Part, PretestCheck, ReadingRules,
    RealLink, RigPlan, Storey,
};

/// The entries of one axis of a real rig. None: the rig's entry applies.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AxisPlan {
    /// The storey that it moves, from 0; None: the tested storeys in their order.
    pub storey: Option<usize>,
    /// The element that it moves, from 0; None: the tested elements in their order.
    pub element: Option<usize>,
    /// Polarity: +1 or −1.
    pub polarity: Option<f64>,
    /// \[m\]
    pub resolution: Option<f64>,
    /// \[N\]
    pub noise: Option<f64>,
    /// \[N\]
    pub force_range: Option<Interval>,
    /// Beside the limits of the run \[m, N\].
    pub displacement: Option<Interval>,
    pub force: Option<Interval>,
    pub pretest_check: Option<PretestCheck>,
    pub calibration: AxisCalibration,
    /// The pre-test check of this axis, instead of that of the rig.
    pub actuator: Option<DeviceLink>,
    pub load_cell: Option<DeviceLink>,
    /// None: it moves a storey sideways.
    pub axial: Option<AxialAxis>,
}

/// An axis that loads a storey along its height, in force control. Its forces are positive if they compress the storey, and its
/// displacements if they shorten it. The limits of its displacement are its band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialAxis {
    /// From 0.
    pub storey: usize,
    /// At which its force changes \[N/s\].
    pub rate: f64,
    /// Largest difference of its force from the target \[N\].
    pub tolerance: f64,
    /// φ of the P-Δ φ N u/h in the lateral reading.
    pub p_delta: f64,
}

/// The column of an axial axis on the rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialColumn {
    /// Its position among the tested storeys, from 0 at the lowest.
    pub tested: usize,
    /// Height on the rig \[m\].
    pub height: f64,
    /// φ of the P-Δ φ N u/h in the lateral reading.
    pub p_delta: f64,
}

impl AxialAxis {
    /// The column that it loads; None if the storey is not tested or has no height.
    #[must_use]
    pub fn column(&self, frame: &Frame) -> Option<AxialColumn> {
        let storey = frame.storeys.get(self.storey)?;
        let is_tested = |storey: &&Storey| storey.part != Part::Computed;
        is_tested(&storey).then_some(())?;
        Some(AxialColumn {
            tested: frame.storeys[..self.storey]
                .iter()
                .filter(is_tested)
                .count(),
            height: storey.height? * storey.part.scale().displacement,
            p_delta: self.p_delta,
        })
    }
}

/// The calibrations of one axis. None: the rig's entry applies.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AxisCalibration {
    pub reference: Option<String>,
    /// `YYYY-MM-DD`
    pub due: Option<String>,
    pub force_class: Option<String>,
    /// Absolute value \[N\].
    pub force_calibrated: Option<Interval>,
    /// Calibration reference of the displacement, if it is a separate one.
    pub displacement: Option<String>,
    /// `YYYY-MM-DD`
    pub displacement_due: Option<String>,
    pub displacement_class: Option<String>,
    /// Absolute value \[m\].
    pub displacement_calibrated: Option<Interval>,
    /// For a load cell that returns raw counts: the scale factor \[N per count\].
    pub newtons_per_count: Option<f64>,
    /// Zero offset: the count at zero force.
    pub zero_offset: Option<f64>,
    /// Standard uncertainty, as a fraction of the force.
    pub force_uncertainty: Option<f64>,
    /// Standard uncertainty, as a fraction of the displacement.
    pub displacement_uncertainty: Option<f64>,
    /// Standard uncertainty \[N\].
    pub zero_uncertainty: Option<f64>,
}

impl AxisCalibration {
    /// The calibration of the rig, with the entries of this axis replaced.
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
            zero_offset: self.zero_offset.unwrap_or(all.zero_offset),
        }
    }
}

impl RigPlan {
    /// Polarity of the axis with this index, the factor of displacement and force: +1 or −1.
    #[must_use]
    pub fn polarity_of(&self, axis: usize) -> f64 {
        self.own(axis)
            .and_then(|own| own.polarity)
            .unwrap_or(self.polarity)
    }

    /// Calibration of the axis with this index, with its uncertainties.
    #[must_use]
    pub fn calibration_of(&self, axis: usize) -> Calibration {
        self.own(axis).map_or_else(
            || self.calibration.clone(),
            |own| own.calibration.over(&self.calibration),
        )
    }

    /// The limits of the run for the axis with this index: its own limits narrow them.
    #[must_use]
    pub fn limits_of(&self, axis: usize, run: &Limits) -> Limits {
        self.own(axis).map_or(*run, |own| own.limits(run))
    }

    /// The limits of the run for every axis; empty if no axis has separate limits.
    #[must_use]
    pub fn limits_of_axes(&self, run: &Limits) -> Vec<Limits> {
        let axes = self.listed_axes().len();
        (0..axes).map(|axis| self.limits_of(axis, run)).collect()
    }

    /// The axial axes, in the order of the list, each with its limits.
    pub fn axial_axes(&self, run: &Limits) -> impl Iterator<Item = (AxialAxis, Limits)> {
        let axes = self.listed_axes().iter();
        axes.filter_map(|axis| Some((axis.axial?, axis.limits(run))))
    }

    /// The axes of its list; none without a list.
    #[must_use]
    pub fn listed_axes(&self) -> &[AxisPlan] {
        match &self.link {
            Link::Real(link) => &link.axes,
            Link::Virtual(_) => &self.simulated_axes,
        }
    }

    fn own(&self, axis: usize) -> Option<&AxisPlan> {
        self.listed_axes().get(axis)
    }
}

impl AxisPlan {
    /// The limits of the run, narrowed by those of the axis. The displacement of an axial axis has another direction than those of the run.
    fn limits(&self, run: &Limits) -> Limits {
        let narrowed =
            |all: Interval, own: Option<Interval>| own.map_or(all, |own| all.intersection(own));
        let displacement = match self.axial {
            Some(_) => Interval::ALL,
            None => run.displacement,
        };
        Limits {
            displacement: narrowed(displacement, self.displacement),
            force: narrowed(run.force, self.force),
            ..*run
        }
    }
}

impl RealLink {
    /// The pre-test check of the axis with this index.
    #[must_use]
    pub fn pretest_check_of(&self, axis: usize) -> PretestCheck {
        self.axes
            .get(axis)
            .and_then(|own| own.pretest_check)
            .unwrap_or(self.pretest_check)
    }

    /// The reading rules of the axis with this index.
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
    fn an_axis_has_its_own_values_or_those_of_the_rig() {
        let text = |text: &str| Some(text.to_owned());
        let all = Calibration {
            reference: text("all"),
            due: text("2027-01-01"),
            displacement: Some(("scale".to_owned(), text("2027-02-01"))),
            force_uncertainty: 0.005,
            zero_uncertainty: 2.0,
            zero_offset: 17.0,
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
        // If the rig has no calibration certificate, the certificate of the axis alone applies.
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
