//! How the floors of a frame were followed over a run. In: at every step what each axis has come to, and the energy of the test.
//! Out: a remark where it is worth one, results of all axes together and of each. It stops nothing: that is the guard's.

use super::remarks::Watch;
use crate::physics::tracking::monitor::Tracking;
use crate::plan::formula::ResultValue;
use crate::procedures::results::result;
use crate::record::NamedResult;
use crate::run::session::Session;
use crate::units::Dimension;

#[derive(Debug, Default)]
pub(crate) struct Followed {
    watch: Watch,
    /// At the last step.
    axes: Vec<Tracking>,
    /// Of each axis, energy error over the energy of the test, the largest by size so far, signed.
    worst: Vec<f64>,
}

impl Followed {
    /// Takes a step, `energy` (J) that of the test so far; all axes together, and their share of the energy.
    pub(crate) fn judge(
        &mut self,
        axes: &[Tracking],
        energy: f64,
        session: &mut Session<'_>,
    ) -> (Tracking, Option<f64>) {
        let tracking = Tracking::together(axes);
        let share = tracking.share_of(energy);
        self.watch.judge(share, session);
        self.worst.resize(axes.len(), 0.0);
        for (worst, axis) in self.worst.iter_mut().zip(axes) {
            let share = axis.share_of(energy).unwrap_or(0.0);
            if share.abs() > worst.abs() {
                *worst = share;
            }
        }
        axes.clone_into(&mut self.axes);
        (tracking, share)
    }

    /// Energy error of all axes over the energy of the test, the largest by size, signed.
    pub(crate) const fn worst(&self) -> Option<f64> {
        self.watch.worst
    }

    /// Of all axes together, in the order of the reference: energies and areas add, of the others the largest counts.
    pub(crate) fn of_all(&self) -> [NamedResult; 4] {
        let tracking = Some(Tracking::together(&self.axes)).filter(|_| !self.axes.is_empty());
        let ended = |name, dimension, value: fn(Tracking) -> f64| {
            result(name, dimension, tracking.map(value))
        };
        [
            result("tracking_energy_error", Dimension::NUMBER, self.worst()),
            ended("tracking_indicator", Dimension::AREA, |all| all.indicator),
            ended("nrms_error", Dimension::NUMBER, |all| all.nrms_error),
            ended("peak_error", Dimension::LENGTH, |all| all.peak_error),
        ]
    }

    /// Of each axis, in the order of the reference.
    pub(crate) fn of_each(&self) -> [NamedResult; 4] {
        let list = |name, dimension, values: Vec<f64>| {
            if values.is_empty() {
                return result(name, dimension, None);
            }
            NamedResult {
                name,
                dimension,
                value: ResultValue::List(values),
                contributions: Vec::new(),
            }
        };
        let ended = |value: fn(&Tracking) -> f64| self.axes.iter().map(value).collect();
        [
            list(
                "floor_tracking_energy_error",
                Dimension::NUMBER,
                self.worst.clone(),
            ),
            list(
                "floor_tracking_indicator",
                Dimension::AREA,
                ended(|axis| axis.indicator),
            ),
            list(
                "floor_nrms_error",
                Dimension::NUMBER,
                ended(|axis| axis.nrms_error),
            ),
            list(
                "floor_peak_error",
                Dimension::LENGTH,
                ended(|axis| axis.peak_error),
            ),
        ]
    }
}
