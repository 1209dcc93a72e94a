//! The peak absolute displacement and force of the channels of a run, from its tables. In: a record. Out: numbers.

use psd_plan::record::ImpactHistory;

/// Gives displacement \[m\] and force \[N\] of every axis of an impact, row by row of its table.
pub(crate) fn of_impact(history: &ImpactHistory, give: &mut dyn FnMut(&[f64], &[f64])) {
    match &history.frame {
        None => history
            .steps
            .iter()
            .for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        Some(frame) => frame
            .floors
            .iter()
            .for_each(|step| give(&step.floors.displacement, &step.floors.restoring_force)),
    }
}

/// Gives displacement \[m\] and force \[N\] of one axis, row by row of a table.
pub(crate) fn of_axis<S>(
    steps: &[S],
    read: impl Fn(&S) -> (f64, f64),
    give: &mut dyn FnMut(&[f64], &[f64]),
) {
    for step in steps {
        let (displacement, force) = read(step);
        give(&[displacement], &[force]);
    }
}
