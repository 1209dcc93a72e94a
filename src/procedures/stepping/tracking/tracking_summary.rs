//! The tracking of all axes over a run. In: at every step the tracking of each axis, and the energy of the test. Out: an observation
//! where the tracking energy is large, results of all axes together and of each. It stops nothing: the guard does.

use super::remarks::Watch;
use crate::physics::tracking::monitor::Tracking;
use crate::record::NamedResult;
use crate::run::session::Session;
use crate::schema::ResultKind;
use crate::schema::procedures::tracking as schema;

#[derive(Debug, Default)]
pub(crate) struct Followed {
    watch: Watch,
    /// At the last step.
    axes: Vec<Tracking>,
    /// For each axis, the energy error over the energy of the test, signed: the peak absolute value so far.
    worst: Vec<f64>,
}

impl Followed {
    /// Adds a step, `energy` \[J\] that of the test so far. Gives all axes together, and their energy error over that energy.
    pub(crate) fn assess(
        &mut self,
        axes: &[Tracking],
        energy: f64,
        session: &mut Session<'_>,
    ) -> (Tracking, Option<f64>) {
        let tracking = Tracking::together(axes);
        let share = tracking.share_of(energy);
        self.watch.assess(share, session);
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

    /// Energy error of all axes over the energy of the test, signed: the peak absolute value.
    pub(crate) const fn worst(&self) -> Option<f64> {
        self.watch.worst
    }

    /// All axes together, after the last step that was judged.
    pub(crate) fn of_all(&self) -> [NamedResult; 4] {
        let tracking = Some(Tracking::together(&self.axes)).filter(|_| !self.axes.is_empty());
        tracking_results(self.worst(), tracking)
    }

    /// Each axis, in the order of the reference.
    pub(crate) fn of_each(&self) -> [NamedResult; 4] {
        let list = |kind: ResultKind, values: Vec<f64>| {
            kind.found_list(Some(values).filter(|values| !values.is_empty()))
        };
        let ended = |value: fn(&Tracking) -> f64| self.axes.iter().map(value).collect();
        [
            list(schema::FLOOR_TRACKING_ENERGY_ERROR, self.worst.clone()),
            list(
                schema::FLOOR_TRACKING_INDICATOR,
                ended(|axis| axis.indicator),
            ),
            list(schema::FLOOR_NRMS_ERROR, ended(|axis| axis.nrms_error)),
            list(schema::FLOOR_PEAK_ERROR, ended(|axis| axis.peak_error)),
        ]
    }
}

/// Results of all axes together, in the order of the reference: energies and areas add, of the others the largest counts. `worst` is the
/// largest energy error over the energy of the test.
pub(crate) fn tracking_results(worst: Option<f64>, tracking: Option<Tracking>) -> [NamedResult; 4] {
    [
        schema::TRACKING_ENERGY_ERROR.found(worst),
        schema::TRACKING_INDICATOR.found(tracking.map(|all| all.indicator)),
        schema::NRMS_ERROR.found(tracking.map(|all| all.nrms_error)),
        schema::PEAK_ERROR.found(tracking.map(|all| all.peak_error)),
    ]
}
