//! The peak absolute displacement and force of the channels of a run, from its tables. In: a record. Out: numbers.

use psd_physics::structure::assemblies::Assemblies;
use psd_physics::structure::elements::ElementReading;
use psd_plan::Plan;
use psd_plan::record::{FloorMotion, ImpactHistory, UnloadHistory, Unloaded};

/// Takes displacement \[m\] and force \[N\] of every floor, and the elements of a frame of matrices.
pub(crate) type Take<'a> = dyn FnMut(&[f64], &[f64], &[ElementReading]) + 'a;

/// Readings of the floors become those of the axes, if the rig carries a part of a frame.
pub(crate) fn of_axes(
    plan: &Plan,
    give: &mut dyn FnMut(&[f64], &[f64]),
) -> impl FnMut(&[f64], &[f64], &[ElementReading]) {
    let assemblies = plan.frame_on_the_rig().and_then(Assemblies::of);
    move |displacement, force, elements| match &assemblies {
        None => give(displacement, force),
        Some(assemblies) => {
            let [displacement, force] = assemblies.axes_read([displacement, force], elements);
            give(&displacement, &force);
        }
    }
}

/// Gives every step of a frame, row by row of its table.
pub(crate) fn of_floors<'a>(floors: impl Iterator<Item = &'a FloorMotion>, give: &mut Take<'_>) {
    for floors in floors {
        give(
            &floors.displacement,
            &floors.restoring_force,
            &floors.elements,
        );
    }
}

/// Gives displacement \[m\] and force \[N\] of every floor of an impact, row by row of its table.
pub(crate) fn of_impact(history: &ImpactHistory, give: &mut Take<'_>) {
    match &history.frame {
        None => history
            .steps
            .iter()
            .for_each(|step| give(&[step.displacement], &[step.restoring_force], &[])),
        Some(frame) => of_floors(frame.floors.iter().map(|step| &step.floors), give),
    }
}

/// Gives displacement \[m\] and force \[N\] of one axis, row by row of a table.
pub(crate) fn of_axis<S>(steps: &[S], read: impl Fn(&S) -> (f64, f64), give: &mut Take<'_>) {
    for step in steps {
        let (displacement, force) = read(step);
        give(&[displacement], &[force], &[]);
    }
}

/// Gives every step of an unloading, row by row of its table.
pub(crate) fn of_unloading(history: &UnloadHistory, give: &mut Take<'_>) {
    for step in &history.steps {
        match history.of {
            Unloaded::OneAxis | Unloaded::Floors => {
                give(&step.displacement, &step.restoring_force, &[]);
            }
            Unloaded::Elements => give(&[], &[], &step.elements()),
        }
    }
}
