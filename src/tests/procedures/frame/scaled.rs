//! Specimens at a scale, one of several equal parts: the prototype has the results of the test at full scale. The rig has other numbers.

use super::gravity::weighed;
use super::hybrid::{
    COMPUTED, INTEGRATORS, SPLITS, TESTED, bilinear, bouc_wen, elastic, floors, same, shake,
    shaken, struck, twice,
};
use crate::procedures::unload::tables;
use crate::tests::testing::run_unwatched;
use polars::prelude::Column;
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{Event, FloorMotion, Floors as _, History, Outcome, Record};
use psd_plan::{
    Behaviour, Contact, Integrator, Interval, Link, Mode, Part, Plan, Scale, Storey, VirtualLink,
};

/// Half scale; one of two equal parts; scales of displacement and of force that are not those of lengths; all together.
pub(super) const SCALES: [Scale; 4] = [
    of(0.5, 0.25, 1.0),
    of(1.0, 1.0, 2.0),
    of(0.5, 0.3, 1.0),
    of(0.4, 0.3, 3.0),
];

pub(super) const fn of(displacement: f64, force: f64, represents: f64) -> Scale {
    Scale {
        displacement,
        force,
        represents,
    }
}

/// The model of the specimen on the rig: displacements λ_x, forces λ_f/n.
pub(super) fn model_on_the_rig(behaviour: &Behaviour, scale: &Scale) -> Behaviour {
    let mut model = behaviour.clone();
    match &mut model {
        Behaviour::Elastic { stiffness } => *stiffness = scale.stiffness_on_the_rig(*stiffness),
        Behaviour::Bilinear {
            stiffness,
            yield_force,
            ..
        }
        | Behaviour::BoucWen {
            stiffness,
            yield_force,
            ..
        } => {
            *stiffness = scale.stiffness_on_the_rig(*stiffness);
            *yield_force *= scale.force / scale.represents;
        }
        other => panic!("{other:?}"),
    }
    model
}

/// The same test with every tested storey at a scale, on the rig that it needs. Numbers of the prototype do not change.
pub(crate) fn at_scale(plan: &Plan, scale: Scale) -> Plan {
    let mut plan = plan.clone();
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    let (length, force) = (scale.displacement, scale.force / scale.represents);
    let scaled = |storeys: &mut [Storey]| {
        for storey in storeys {
            let Part::Tested { scale: of_part, .. } = &mut storey.part else {
                continue;
            };
            *of_part = scale;
            storey.behaviour = model_on_the_rig(&storey.behaviour, &scale);
            storey.damping *= force / length;
            storey.coulomb *= force;
        }
    };
    plan.specimens[0].frame = Some(frame.with(scaled));
    if let Link::Virtual(link) = &mut plan.rig.link {
        link.noise *= force;
        link.force_resolution *= force;
        link.resolution *= length;
        link.drift *= force;
    }
    plan.rig.calibration.zero_uncertainty *= force;
    plan
}

/// The same prototype, with its specimens at every scale.
fn moves_as_at_full_scale(plan: &Plan, case: &str) {
    let full = run_unwatched(plan);
    for scale in SCALES {
        let found = run_unwatched(&at_scale(plan, scale));
        same(&found, &full, 0, 1e-12, &format!("{case}, {scale:?}"));
    }
}

#[test]
fn the_prototype_moves_as_at_full_scale() {
    for model in [elastic, bilinear, bouc_wen] {
        for integrator in INTEGRATORS {
            for parts in [[TESTED; 3]].into_iter().chain(SPLITS) {
                let plan = shaken(parts, model, integrator);
                let case = format!("{integrator:?}, {:?}, {parts:?}", model(1.0));
                moves_as_at_full_scale(&plan, &case);
            }
        }
    }
}

/// No storey is stiffer than its model. The forces of a cell of 5 N resolution are steps of up to 40 N of the prototype: they are not a
/// stiffness.
#[test]
fn no_storey_is_reported_as_stiffer_by_its_rounding_errors() {
    for model in [elastic, bilinear] {
        for parts in [[TESTED; 3]].into_iter().chain(SPLITS) {
            for scale in SCALES {
                let mut plan = shaken(parts, model, Integrator::AlphaOs { alpha: -0.05 });
                shake(&mut plan).stepping.time_step = Constant(0.002);
                let mut plan = at_scale(&plan, scale);
                plan.rig.link = Link::Virtual(VirtualLink {
                    force_resolution: 5.0,
                    ..VirtualLink::default()
                });
                let record = run_unwatched(&plan);
                let stiffer = |event: &&Event| event.text.starts_with("W718");
                let found = record.events.iter().find(stiffer);
                assert!(found.is_none(), "{parts:?}, {scale:?}: {found:?}");
            }
        }
    }
}

/// P-Δ is that of the prototype: no scale enters it.
#[test]
fn a_prototype_with_weights_moves_as_at_full_scale() {
    for integrator in INTEGRATORS {
        for parts in [[TESTED; 3]].into_iter().chain(SPLITS) {
            let plan = weighed(shaken(parts, bilinear, integrator));
            moves_as_at_full_scale(&plan, &format!("{integrator:?}, {parts:?}"));
        }
    }
}

#[test]
fn a_struck_prototype_moves_as_at_full_scale() {
    for parts in [[TESTED; 3], [TESTED, COMPUTED, TESTED]] {
        for (floor, contact) in [
            (0, Contact::Rigid),
            (
                2,
                Contact::Limit {
                    force: Constant(2e4),
                },
            ),
        ] {
            let plan = struck(parts, floor, Integrator::Tangent, contact);
            moves_as_at_full_scale(&plan, &format!("{parts:?}, floor {floor}"));
        }
    }
}

/// Every number of the record and every contribution to its uncertainty differs by less than `within` of the largest of its kind.
fn same_results(found: &Record, wanted: &Record, within: f64, case: &str) {
    let mut contributions = 0;
    for (found, wanted) in found.procedures.iter().zip(&wanted.procedures) {
        for (found, wanted) in found.results.iter().zip(&wanted.results) {
            let case = format!("{case}: {}", wanted.name);
            assert_eq!(found.withheld, wanted.withheld, "{case}");
            let (values, expected) = (found.value.values(), wanted.value.values());
            assert_eq!(values.len(), expected.len(), "{case}");
            let largest = expected
                .iter()
                .fold(0.0_f64, |most, value| most.max(value.abs()));
            for (value, expected) in values.iter().zip(expected) {
                let off = (value - expected).abs();
                assert!(
                    off <= within * largest + 1e-15,
                    "{case}: {value} for {expected}"
                );
            }
            assert_eq!(
                found.contributions.len(),
                wanted.contributions.len(),
                "{case}"
            );
            let largest = wanted
                .contributions
                .iter()
                .fold(0.0_f64, |most, part| most.max(part.amount.abs()));
            for (part, expected) in found.contributions.iter().zip(&wanted.contributions) {
                contributions += 1;
                assert_eq!(
                    (part.source, part.entry),
                    (expected.source, expected.entry),
                    "{case}"
                );
                let off = (part.amount - expected.amount).abs();
                assert!(
                    off <= within * largest + 1e-15,
                    "{case}: {part:?} for {expected:?}"
                );
            }
        }
    }
    assert!(contributions > 50, "{case}");
}

/// A rig with n σ/λ_f of noise, r/λ_x of resolution and the zero error n z/λ_f in the prototype is one that has them at full scale: each
/// reading, each result and each uncertainty is the same, also of the unloading between two tests.
#[test]
fn noise_resolution_and_calibration_of_the_rig_are_those_of_the_prototype_through_the_scale() {
    for parts in [
        [TESTED; 3],
        [TESTED, COMPUTED, COMPUTED],
        [COMPUTED, TESTED, TESTED],
    ] {
        let mut plan = twice(parts);
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 20.0,
            force_resolution: 2.0,
            resolution: 1e-5,
            seed: 3,
            ..VirtualLink::default()
        });
        plan.rig.calibration.force_uncertainty = 0.01;
        plan.rig.calibration.displacement_uncertainty = 0.002;
        plan.rig.calibration.zero_uncertainty = 5.0;
        let full = run_unwatched(&plan);
        for scale in [of(0.5, 0.25, 1.0), of(1.0, 1.0, 2.0), of(0.5, 0.125, 4.0)] {
            let scaled = run_unwatched(&at_scale(&plan, scale));
            same_results(&scaled, &full, 1e-9, &format!("{parts:?}, {scale:?}"));
        }
    }
}

/// The actuators lag and the specimen has a damper: c λ_f/(n λ_x) on the rig.
#[test]
fn without_a_stop_a_prototype_moves_as_at_full_scale() {
    for parts in [[TESTED; 3], [TESTED, COMPUTED, TESTED]] {
        let mut plan = shaken(parts, elastic, Integrator::AlphaOs { alpha: -0.05 });
        shake(&mut plan).stepping.mode = Mode::Continuous { time_scale: 100.0 };
        plan.rig.link = Link::Virtual(VirtualLink {
            lag: 0.02,
            ..VirtualLink::default()
        });
        let frame = plan.specimens[0].frame.as_ref().unwrap();
        let damped = |storeys: &mut [Storey]| {
            for storey in storeys.iter_mut().filter(|storey| storey.part != COMPUTED) {
                storey.damping = 2e4;
            }
        };
        plan.specimens[0].frame = Some(frame.with(damped));
        let full = run_unwatched(&plan);
        for scale in SCALES {
            let scaled = run_unwatched(&at_scale(&plan, scale));
            same(&scaled, &full, 0, 1e-11, &format!("{parts:?}, {scale:?}"));
            let tracking = |record: &Record| {
                let results = record.procedures[0].results.iter();
                let results = results.filter(|result| result.name.contains("error"));
                results
                    .flat_map(|result| result.value.values().to_vec())
                    .collect::<Vec<f64>>()
            };
            let (found, wanted) = (tracking(&scaled), tracking(&full));
            assert!(wanted.len() > 4 && wanted.iter().any(|error| error.abs() > 1e-6));
            for (found, wanted) in found.iter().zip(wanted) {
                assert!(
                    (found - wanted).abs() <= 1e-9 * wanted.abs(),
                    "{found} for {wanted}"
                );
            }
        }
    }
}

/// On an ideal rig every actuator is at its target, whatever the scale: there is nothing to correct.
#[test]
fn the_i_modification_of_an_ideal_rig_changes_nothing() {
    for scale in SCALES {
        for parts in [[TESTED; 3], [TESTED, COMPUTED, TESTED]] {
            let mut plan = at_scale(&shaken(parts, bilinear, Integrator::Explicit), scale);
            let without = run_unwatched(&plan);
            shake(&mut plan).stepping.i_modification = true;
            same(
                &run_unwatched(&plan),
                &without,
                0,
                1e-12,
                &format!("{parts:?}, {scale:?}"),
            );
        }
    }
}

/// The rig reaches λ_x of the drift and λ_f/n of the shear: limits just beyond are kept, limits just below stop the test.
#[test]
fn limits_bind_in_numbers_of_the_rig() {
    for scale in SCALES {
        let plan = at_scale(
            &shaken([TESTED, COMPUTED, COMPUTED], bilinear, Integrator::Explicit),
            scale,
        );
        let steps = floors(&run_unwatched(&plan), 0);
        let largest = |of: fn(&FloorMotion) -> f64| {
            let values = steps.iter().map(|floors| of(floors).abs());
            values.fold(0.0, f64::max)
        };
        let drift = scale.displacement * largest(|floors| floors.displacement[0]);
        let shear = scale.force / scale.represents * largest(|floors| floors.shear()[0]);
        let within = |end: f64| Interval {
            low: -end,
            high: end,
        };
        for (share, completes) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
            for (displacement, force) in
                [(share * drift, 2.0 * shear), (2.0 * drift, share * shear)]
            {
                let mut limited = plan.clone();
                limited.limits.displacement = within(displacement);
                limited.limits.force = within(force);
                let outcome = run_unwatched(&limited).outcome;
                assert_eq!(
                    outcome == Outcome::Completed,
                    completes,
                    "{scale:?}, {displacement}, {force}"
                );
            }
        }
    }
}

/// A table has the numbers of the axes beside those of the floors if a specimen has a scale, none for a computed storey.
#[test]
fn a_table_has_the_numbers_of_the_rig_beside_those_of_the_prototype() {
    let full = twice([TESTED, COMPUTED, TESTED]);
    let columns = |plan: &Plan| {
        let record = run_unwatched(plan);
        let frame = plan.frame_on_the_rig().unwrap();
        let scaled = Assemblies::of(frame).filter(Assemblies::is_scaled);
        match &record.procedures[1].history {
            History::Unload(history) => tables::unloading(&history.steps, scaled.as_ref()),
            other => panic!("{other:?}"),
        }
    };
    let has_rig = |columns: &[Column]| columns.iter().any(|it| it.name().contains("_rig_"));
    assert!(!has_rig(&columns(&full)));
    let written = columns(&at_scale(&full, of(0.5, 0.25, 2.0)));
    let read = |name: &str| {
        let column = written.iter().find(|column| column.name() == name);
        column.unwrap().f64().unwrap().to_vec()
    };
    let [command, displacement, force] =
        ["command_m", "displacement_m", "storey_shear_n"].map(read);
    let rig = ["command_rig_m", "displacement_rig_m", "force_rig_n"].map(read);
    let near = |found: Option<f64>, wanted: f64| (found.unwrap() - wanted).abs() < 1e-12;
    let mut largest = 0.0_f64;
    for row in (0..command.len()).step_by(3) {
        for (floors, factor, found) in [(&command, 0.5, &rig[0]), (&displacement, 0.5, &rig[1])] {
            let floor = |index: usize| floors[row + index].unwrap();
            assert!(near(found[row], factor * floor(0)));
            assert_eq!(found[row + 1], None);
            assert!(near(found[row + 2], factor * (floor(2) - floor(1))));
            largest = largest.max(floor(0).abs());
        }
        for storey in [0, 2] {
            assert!(near(
                rig[2][row + storey],
                0.125 * force[row + storey].unwrap()
            ));
        }
    }
    assert!(largest > 1e-3);
}
