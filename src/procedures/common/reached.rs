//! The peak absolute displacement and force of the channels of a run, from its tables. In: a record. Out: numbers.

use psd_physics::structure::substructures::Assemblies;
use psd_plan::Plan;
use psd_plan::record::ImpactHistory;

/// Readings of the floors become those of the axes, if the rig carries a part of a frame.
pub(crate) fn of_axes(
    plan: &Plan,
    give: &mut dyn FnMut(&[f64], &[f64]),
) -> impl FnMut(&[f64], &[f64]) {
    let assemblies = plan.frame_on_the_rig().and_then(Assemblies::of);
    move |displacement, force| match &assemblies {
        None => give(displacement, force),
        Some(assemblies) => give(
            &assemblies.axes_of(displacement),
            &assemblies.forces_of(force),
        ),
    }
}

/// Gives displacement \[m\] and force \[N\] of every floor of an impact, row by row of its table.
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
