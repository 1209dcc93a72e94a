//! Frames of matrices with elements: a frame of storeys moves as its matrix and elements, in every arrangement; elements between any
//! degrees of freedom move as an independent recursion.

use super::hybrid::{
    APART, COMPUTED, INTEGRATORS, SPLITS, TESTED, bilinear, bouc_wen, elastic, floors, same, shake,
    shaken, struck, twice,
};
use super::scaled::{SCALES, model_on_the_rig};
use crate::procedures::unload::tables;
use crate::tests::testing::run_unwatched;
use crate::tests::uncertainty::frame::{entry, from};
use psd_physics::structure::Damping;
use psd_physics::structure::assemblies::Assemblies;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::structure::widen;
use psd_plan::formula::Formula::Constant;
use psd_plan::procedures::impact::block::STOREY_ENERGY;
use psd_plan::procedures::shake::block::{
    FINAL_DRIFT, MAX_BASE_SHEAR, MAX_DRIFT, MAX_ELEMENT_FORCE,
};
use psd_plan::procedures::unload::block::{RESIDUAL_DRIFT, RESIDUAL_SHEAR};
use psd_plan::record::{
    FloorMotion, Floors as _, History, Outcome, Record, UnloadHistory, UnloadStep, Unloaded,
};
use psd_plan::uncertainty::Source;
use psd_plan::{
    Behaviour, Contact, Element, Frame, Integrator, Link, Mode, Part, Plan, ProcedureKind, Scale,
    Storey, VirtualLink,
};

/// An element of this stiffness \[N/m\].
fn element(from: usize, to: usize, stiffness: f64, model: fn(f64) -> Behaviour) -> Element {
    Element {
        ends: [from, to].map(|degree| degree.checked_sub(1)),
        stiffness,
        stiffness_uncertainty: 0.0,
        behaviour: model(stiffness),
        damping: 0.0,
        coulomb: 0.0,
        part: TESTED,
    }
}

fn of_storey((index, storey): (usize, &Storey)) -> Element {
    Element {
        ends: [index.checked_sub(1), Some(index)],
        stiffness: storey.stiffness,
        stiffness_uncertainty: storey.stiffness_uncertainty,
        behaviour: storey.behaviour.clone(),
        damping: storey.damping,
        coulomb: storey.coulomb,
        part: storey.part,
    }
}

fn frame(plan: &Plan) -> &Frame {
    plan.specimens[0].frame.as_ref().unwrap()
}

/// The same frame: storeys that `in_matrix` selects are in K, the others are elements.
fn as_elements(mut plan: Plan, in_matrix: fn(&Storey) -> bool) -> Plan {
    let storeys = &frame(&plan).storeys;
    let kept = |storey: &Storey| Storey {
        stiffness: if in_matrix(storey) {
            storey.stiffness
        } else {
            0.0
        },
        ..storey.clone()
    };
    let matrix = Frame::of_storeys(storeys.iter().map(kept).collect());
    let elements = storeys.iter().enumerate();
    let elements = elements.filter(|(_, storey)| !in_matrix(storey));
    let elements = elements.map(of_storey).collect();
    let frame = Frame::of_matrices(matrix.mass, matrix.stiffness).with_elements(elements);
    plan.specimens[0].frame = Some(frame);
    plan
}

fn no(_: &Storey) -> bool {
    false
}

fn is_computed(storey: &Storey) -> bool {
    storey.part == Part::Computed
}

/// The energies of every step are those of the other run.
fn same_energies(found: &Record, wanted: &Record, case: &str) {
    let steps = |record: &Record| match &record.procedures[0].history {
        History::Shake(history) => history.steps.clone(),
        other => panic!("{other:?}"),
    };
    let (found, wanted) = (steps(found), steps(wanted));
    let largest = wanted.iter().map(|step| step.energies.input.abs());
    let largest = largest.fold(0.0, f64::max);
    for (found, wanted) in found.iter().zip(&wanted) {
        let (a, b) = (found.energies, wanted.energies);
        for (a, b) in [
            (a.kinetic, b.kinetic),
            (a.restoring, b.restoring),
            (a.damping, b.damping),
            (a.input, b.input),
            (a.error, b.error),
        ] {
            assert!((a - b).abs() <= 1e-11 * largest, "{case}: {a} for {b}");
        }
    }
}

#[test]
fn storeys_move_as_their_matrix_and_elements() {
    for model in [elastic, bilinear, bouc_wen] {
        for integrator in INTEGRATORS {
            for parts in [[TESTED; 3]].into_iter().chain(SPLITS) {
                let plan = shaken(parts, model, integrator);
                let storeys = run_unwatched(&plan);
                let elements = run_unwatched(&as_elements(plan, no));
                let case = format!("{integrator:?}, {:?}, {parts:?}", model(1.0));
                same(&elements, &storeys, 0, 1e-12, &case);
                same_energies(&elements, &storeys, &case);
                same_results(&elements, &storeys, &case);
            }
        }
    }
}

/// The deformations of the elements are the drifts of the storeys, their forces the shears, their energies those of the storeys.
fn same_results(elements: &Record, storeys: &Record, case: &str) {
    let list = |record: &Record, name: &str| {
        let result = record.procedures[0].result(name);
        result.map(|result| result.value.values().to_vec())
    };
    let mut shears = vec![0.0; 3];
    for floors in floors(storeys, 0) {
        widen(&mut shears, &floors.shear());
    }
    let of_storeys = [MAX_DRIFT, FINAL_DRIFT, STOREY_ENERGY]
        .map(|kind| (kind.name, list(storeys, kind.name)))
        .into_iter()
        .chain([(MAX_ELEMENT_FORCE.name, Some(shears))]);
    for (name, wanted) in of_storeys {
        let found = list(elements, name);
        assert_eq!(found.is_some(), wanted.is_some(), "{case}: {name}");
        let (found, wanted) = (found.unwrap_or_default(), wanted.unwrap_or_default());
        let largest = wanted.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert_eq!(found.len(), wanted.len(), "{case}: {name}");
        for (found, wanted) in found.iter().zip(&wanted) {
            let off = (found - wanted).abs();
            assert!(
                off <= 1e-11 * largest,
                "{case}: {name} {found} for {wanted}"
            );
        }
    }
}

/// Computed storeys that stay elastic are the stiffness matrix. The tangent of the tested storey is its own secant.
#[test]
fn elastic_storeys_can_be_in_the_matrix() {
    for integrator in INTEGRATORS {
        for tested in 0..3 {
            let mut plan = shaken([COMPUTED; 3], elastic, integrator);
            let yields = |storeys: &mut [Storey]| {
                storeys[tested].part = TESTED;
                storeys[tested].behaviour = bilinear(storeys[tested].stiffness);
            };
            plan.specimens[0].frame = Some(frame(&plan).with(yields));
            let storeys = run_unwatched(&plan);
            let elements = run_unwatched(&as_elements(plan, is_computed));
            let case = format!("{integrator:?}, storey {tested} tested");
            same(&elements, &storeys, 0, 1e-12, &case);
        }
    }
}

#[test]
fn an_impact_on_storeys_is_that_on_their_elements() {
    for (integrator, contact) in [
        (Integrator::Tangent, Contact::Rigid),
        (
            Integrator::Explicit,
            Contact::Limit {
                force: Constant(2e4),
            },
        ),
        (Integrator::AlphaOs { alpha: 0.0 }, Contact::Rigid),
    ] {
        for floor in 0..3 {
            for parts in SPLITS {
                let plan = struck(parts, floor, integrator, contact.clone());
                let storeys = run_unwatched(&plan);
                let elements = run_unwatched(&as_elements(plan, no));
                let case = format!("{integrator:?}, floor {floor}, {parts:?}");
                same(&elements, &storeys, 0, 1e-11, &case);
                same_results(&elements, &storeys, &case);
            }
        }
    }
}

#[test]
fn without_a_stop_storeys_move_as_their_elements() {
    for parts in [[TESTED, COMPUTED, COMPUTED], [COMPUTED, TESTED, COMPUTED]] {
        let mut plan = shaken(parts, bilinear, Integrator::AlphaOs { alpha: -0.05 });
        shake(&mut plan).stepping.mode = Mode::Continuous { time_scale: 100.0 };
        let storeys = run_unwatched(&plan);
        let elements = run_unwatched(&as_elements(plan, no));
        same(&elements, &storeys, 0, 1e-11, &format!("{parts:?}"));
    }
}

/// Elements from the ground to the deck and between piers, three in a circle, beside a matrix that couples all degrees of freedom.
fn bridge(parts: [Part; 4], model: fn(f64) -> Behaviour, integrator: Integrator) -> Plan {
    let mut plan = shaken([TESTED; 3], elastic, integrator);
    shake(&mut plan).damping = psd_plan::ShakeDamping::Rayleigh(Constant(0.0));
    let mass = vec![
        vec![2000.0, 100.0, 0.0],
        vec![100.0, 1500.0, 50.0],
        vec![0.0, 50.0, 1000.0],
    ];
    let stiffness = vec![
        vec![3e5, -1e5, -5e4],
        vec![-1e5, 1.2e5, 0.0],
        vec![-5e4, 0.0, 6e4],
    ];
    let elements = [
        element(0, 1, 4e5, model),
        element(1, 3, 2e5, model),
        element(3, 2, 1.5e5, model),
        element(2, 1, 1e5, model),
    ];
    let elements = elements.into_iter().zip(parts);
    let elements = elements.map(|(element, part)| Element { part, ..element });
    let frame = Frame::of_matrices(mass, stiffness).with_elements(elements.collect());
    plan.specimens[0].frame = Some(frame);
    plan
}

/// A x = b by elimination with the largest pivot.
fn solved(a: &[[f64; 3]; 3], mut b: [f64; 3]) -> [f64; 3] {
    let mut a = *a;
    for pivot in 0..3 {
        let largest = (pivot..3).max_by(|i, j| a[*i][pivot].abs().total_cmp(&a[*j][pivot].abs()));
        a.swap(pivot, largest.unwrap());
        b.swap(pivot, largest.unwrap());
        for row in pivot + 1..3 {
            let factor = a[row][pivot] / a[pivot][pivot];
            let of_pivot = a[pivot];
            for (entry, of_pivot) in a[row].iter_mut().zip(of_pivot).skip(pivot) {
                *entry -= factor * of_pivot;
            }
            b[row] -= factor * b[pivot];
        }
    }
    for row in (0..3).rev() {
        for column in row + 1..3 {
            b[row] -= a[row][column] * b[column];
        }
        b[row] /= a[row][row];
    }
    b
}

fn times(a: &[[f64; 3]; 3], x: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|column| a[row][column] * x[column]).sum())
}

/// Kinematic bilinear, written as an elastic spring and an elastic, perfectly plastic one side by side.
#[derive(Clone, Copy, Default)]
struct Yielding {
    plastic: f64,
    deformation: f64,
    force: f64,
}

impl Yielding {
    fn go(&mut self, stiffness: f64, deformation: f64) -> f64 {
        let (ratio, yield_force) = (0.05, 0.01 * stiffness);
        let own = (1.0 - ratio) * stiffness;
        let most = (1.0 - ratio) * yield_force;
        let trial = own * (deformation - self.plastic);
        let held = trial.clamp(-most, most);
        self.plastic = deformation - held / own;
        self.deformation = deformation;
        self.force = ratio * stiffness * deformation + held;
        self.force
    }
}

/// Displacements of the bridge by the published recursions, with full matrices.
fn recursion(plan: &Plan, integrator: Integrator) -> Vec<[f64; 3]> {
    let frame = frame(plan);
    let dense = |rows: &[Vec<f64>]| -> [[f64; 3]; 3] {
        std::array::from_fn(|row| std::array::from_fn(|column| rows[row][column]))
    };
    let (mass, matrix) = (dense(&frame.mass), dense(&frame.computed_stiffness));
    let springs: Vec<([f64; 3], f64)> = frame
        .elements
        .iter()
        .map(|element| {
            let mut side = [0.0; 3];
            if let Some(from) = element.ends[0] {
                side[from] = -1.0;
            }
            if let Some(to) = element.ends[1] {
                side[to] = 1.0;
            }
            (side, element.stiffness)
        })
        .collect();
    let with = |tangents: &[f64], factor: f64| -> [[f64; 3]; 3] {
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let springs = springs.iter().zip(tangents);
                let springs = springs.map(|((side, _), k)| k * side[row] * side[column]);
                mass[row][column] + factor * (matrix[row][column] + springs.sum::<f64>())
            })
        })
    };
    let ground = &plan.grounds[0].accelerations;
    let load = |step: usize| times(&mass, &[1.0; 3]).map(|mass| -mass * ground[step]);
    let initial: Vec<f64> = springs.iter().map(|(_, stiffness)| *stiffness).collect();
    let (mut states, mut tangents) = (vec![Yielding::default(); 4], initial.clone());
    let force_at = |x: &[f64; 3], states: &mut Vec<Yielding>, tangents: &mut Vec<f64>| {
        let mut force = times(&matrix, x);
        for (((side, stiffness), state), tangent) in
            springs.iter().zip(states.iter_mut()).zip(tangents)
        {
            let deformation = (0..3).map(|degree| side[degree] * x[degree]).sum::<f64>();
            let before = *state;
            let element = state.go(*stiffness, deformation);
            let moved = deformation - before.deformation;
            if moved != 0.0 {
                *tangent = ((element - before.force) / moved).clamp(0.0, 2.0 * stiffness);
            }
            for degree in 0..3 {
                force[degree] += side[degree] * element;
            }
        }
        force
    };
    let dt = 0.01;
    let (mut x, mut v) = ([0.0; 3], [0.0; 3]);
    let mut force = [0.0; 3];
    let mut a = solved(&mass, load(0));
    let mut path = vec![x];
    for step in 1..ground.len() {
        let next = load(step);
        if integrator == Integrator::Tangent {
            let k = |now: &[[f64; 3]; 3], x: &[f64; 3]| {
                let moved = times(now, x);
                let inert = times(&mass, x);
                [0, 1, 2].map(|i| moved[i] - inert[i])
            };
            let glide = [0, 1, 2].map(|i| dt * v[i] + 0.25 * dt * dt * a[i]);
            let stiff = k(&with(&tangents, 1.0), &glide);
            let right = [0, 1, 2].map(|i| next[i] - force[i] - stiff[i]);
            let after = solved(&with(&tangents, 0.25 * dt * dt), right);
            for i in 0..3 {
                x[i] += dt * v[i] + 0.25 * dt * dt * (a[i] + after[i]);
                v[i] += 0.5 * dt * (a[i] + after[i]);
            }
            a = after;
            force = force_at(&x, &mut states, &mut tangents);
        } else {
            let is_split = integrator != Integrator::Explicit;
            let beta = if is_split { 0.25 } else { 0.0 };
            let target = [0, 1, 2].map(|i| x[i] + dt * v[i] + dt * dt * (0.5 - beta) * a[i]);
            let read = force_at(&target, &mut states, &mut tangents);
            let right = [0, 1, 2].map(|i| next[i] - read[i]);
            let after = solved(&with(&initial, beta * dt * dt), right);
            v = [0, 1, 2].map(|i| v[i] + 0.5 * dt * (a[i] + after[i]));
            x = [0, 1, 2].map(|i| target[i] + beta * dt * dt * after[i]);
            a = after;
        }
        path.push(x);
    }
    path
}

/// The force at the start of a step is the reading of the last one; α-OS adds `K_I`(d − d̃) in its own equation only.
#[test]
fn elements_between_any_degrees_of_freedom_move_as_an_independent_recursion() {
    let arrangements = [
        [TESTED; 4],
        [COMPUTED; 4],
        [TESTED, COMPUTED, TESTED, COMPUTED],
        [COMPUTED, TESTED, COMPUTED, COMPUTED],
    ];
    for integrator in [
        Integrator::Tangent,
        Integrator::Explicit,
        Integrator::AlphaOs { alpha: 0.0 },
    ] {
        for parts in arrangements {
            let plan = bridge(parts, bilinear, integrator);
            let wanted = recursion(&plan, integrator);
            let found = floors(&run_unwatched(&plan), 0);
            let largest = wanted
                .iter()
                .flatten()
                .fold(0.0, |a: f64, b| a.max(b.abs()));
            assert!(largest > 0.03, "the elements yield: {largest}");
            assert_eq!(found.len(), wanted.len());
            for (found, wanted) in found.iter().zip(&wanted) {
                for (found, wanted) in found.computed.iter().zip(wanted) {
                    let off = (found - wanted).abs();
                    assert!(off < 1e-11 * largest, "{integrator:?}, {parts:?}: {off}");
                }
            }
        }
    }
}

/// An elastic element, on the rig or computed, is its stiffness in K: the frame of that matrix is on the rig as a whole.
#[test]
fn a_linear_element_is_its_stiffness_in_the_matrix() {
    for integrator in INTEGRATORS {
        for parts in [
            [TESTED; 4],
            [COMPUTED; 4],
            [TESTED, COMPUTED, COMPUTED, TESTED],
        ] {
            let mut plan = bridge(parts, elastic, integrator);
            shake(&mut plan).damping = psd_plan::ShakeDamping::Rayleigh(Constant(0.05));
            let elements = run_unwatched(&plan);
            let Frame {
                mass, stiffness, ..
            } = frame(&plan).clone();
            let frame = Frame::of_matrices(mass, stiffness);
            let ratios = |frame: &Frame| {
                let of = FrameProperties::of(frame, &Damping::rayleigh(0.05)).unwrap();
                (of.modes.periods.clone(), of.damping_ratios())
            };
            assert_eq!(ratios(&frame), ratios(self::frame(&plan)));
            plan.specimens[0].frame = Some(frame);
            let whole = run_unwatched(&plan);
            let case = format!("{integrator:?}, {parts:?}");
            same(&elements, &whole, 0, 1e-12, &case);
            same_energies(&elements, &whole, &case);
        }
    }
}

/// No energy of the tangent form is lost: constant average acceleration closes exactly on elastic elements.
#[test]
fn the_energy_of_elastic_elements_closes() {
    let plan = bridge(
        [TESTED, COMPUTED, TESTED, COMPUTED],
        elastic,
        Integrator::Tangent,
    );
    let record = run_unwatched(&plan);
    let History::Shake(history) = &record.procedures[0].history else {
        panic!()
    };
    let largest = history.steps.iter().map(|step| step.energies.input.abs());
    let largest = largest.fold(0.0, f64::max);
    for step in &history.steps {
        assert!(step.energies.error.abs() < 1e-12 * largest && largest > 0.0);
    }
}

#[test]
fn elements_at_a_scale_move_as_at_full_scale() {
    for integrator in INTEGRATORS {
        let plan = bridge([TESTED, COMPUTED, TESTED, TESTED], bilinear, integrator);
        let full = run_unwatched(&plan);
        for scale in SCALES {
            let mut plan = plan.clone();
            let mut elements = frame(&plan).elements.clone();
            for element in &mut elements {
                if let Part::Tested { scale: own, .. } = &mut element.part {
                    *own = scale;
                    element.behaviour = model_on_the_rig(&element.behaviour, &scale);
                }
            }
            plan.specimens[0].frame = Some(frame(&plan).clone().with_elements(elements));
            let found = run_unwatched(&plan);
            same(
                &found,
                &full,
                0,
                1e-12,
                &format!("{integrator:?}, {scale:?}"),
            );
            let read = |record: &Record| floors(record, 0).last().unwrap().elements.clone();
            for (found, full) in read(&found).iter().zip(read(&full)) {
                assert!((found.force - full.force).abs() < 1e-9 * full.force.abs());
                assert!((found.deformation - full.deformation).abs() < 1e-12);
            }
        }
    }
}

/// An actuator ends every increment 5 % short. Its element has the measured deformation, its degrees of freedom the imposed displacement.
#[test]
fn the_i_modification_corrects_each_element_in_its_own_coordinates() {
    for integrator in INTEGRATORS {
        let mut plan = bridge([TESTED, COMPUTED, TESTED, TESTED], elastic, integrator);
        let ideal = floors(&run_unwatched(&plan), 0);
        plan.rig.link = Link::Virtual(VirtualLink {
            tracking: 0.05,
            ..VirtualLink::default()
        });
        shake(&mut plan).stepping.i_modification = true;
        let record = run_unwatched(&plan);
        let short = floors(&record, 0);
        let largest = |of: fn(&FloorMotion) -> f64| {
            short
                .iter()
                .map(of)
                .fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        assert!(largest(|at| at.elements[2].deformation - at.elements[2].target) > 1e-4);
        assert_eq!(
            largest(|at| at.elements[1].deformation - at.elements[1].target),
            0.0
        );
        assert_eq!(largest(|at| at.displacement[1] - at.command[1]), 0.0);
        let most = largest(|at| at.computed[2]);
        for (short, ideal) in short.iter().zip(&ideal) {
            for (short, ideal) in short.computed.iter().zip(&ideal.computed) {
                assert!(
                    (short - ideal).abs() < 1e-10 * most,
                    "{integrator:?}: {}",
                    (short - ideal).abs()
                );
            }
        }
        let errors = record.procedures[0].result("floor_peak_error").unwrap();
        let errors = errors.value.values();
        assert!(
            errors.len() == 4 && errors[1] == 0.0 && errors[2] > 1e-4,
            "{errors:?}"
        );
    }
}

/// The second test begins where the rig is, with K and the computed elements in balance.
/// The element from the ground to the second degree of freedom of a frame whose rows are no storeys.
#[test]
fn the_deformation_of_an_element_ends_the_run() {
    let parts = [COMPUTED, TESTED, COMPUTED, COMPUTED];
    let mut plan = bridge(parts, bilinear, Integrator::Explicit);
    let mut frame = frame(&plan).clone();
    frame.elements[1].ends = [None, Some(1)];
    plan.specimens[0].frame = Some(frame);
    let whole = run_unwatched(&plan);
    let peaks = |record: &Record| {
        let result = record.procedures[0].result(MAX_DRIFT.name).unwrap();
        result.value.values().to_vec()
    };
    let limit = 0.5 * peaks(&whole)[1];
    shake(&mut plan).until = Some(limit);
    let record = run_unwatched(&plan);
    assert_eq!(record.outcome, Outcome::Completed);
    let floors = floors(&record, 0);
    let (last, before) = floors.split_last().unwrap();
    let deformed = |floors: &FloorMotion| -> Vec<f64> {
        let x = &floors.computed;
        [x[0], x[1], x[1] - x[2], x[0] - x[1]]
            .map(f64::abs)
            .to_vec()
    };
    let reached = |floors: &FloorMotion| deformed(floors).iter().position(|by| *by >= limit);
    let element = reached(last).unwrap() + 1;
    assert!(before.iter().all(|floors| reached(floors).is_none()));
    let said = format!("element {element} reached a deformation of");
    assert!(record.events.iter().any(|event| event.text.contains(&said)));
    let largest = |element: usize| {
        let each = floors.iter().map(|floors| deformed(floors)[element]);
        each.fold(0.0, f64::max)
    };
    for (element, peak) in peaks(&record).into_iter().enumerate() {
        assert!(
            (peak - largest(element)).abs() < 1e-12 * limit,
            "{element}: {peak}"
        );
    }
}

/// The only element on the ground carries the base shear, with the noise of its load cell.
#[test]
fn the_force_of_an_element_has_the_noise_and_the_budget_of_its_cell() {
    let mut plan = shaken([TESTED, COMPUTED, COMPUTED], bilinear, Integrator::Explicit);
    let Link::Virtual(link) = &mut plan.rig.link else {
        panic!()
    };
    link.noise = 40.0;
    plan.rig.calibration.force_uncertainty = 0.01;
    let mut plan = as_elements(plan, no);
    let mut frame = frame(&plan).clone();
    // The noise of the base shear is not that of the first element of the list.
    frame.elements.swap(0, 1);
    plan.specimens[0].frame = Some(frame);
    let record = run_unwatched(&plan);
    let (shear, of_shear) = entry(&record, MAX_BASE_SHEAR.name, 0);
    let (force, of_force) = entry(&record, MAX_ELEMENT_FORCE.name, 1);
    assert!((shear - force).abs() < 1e-9 * shear, "{shear}, {force}");
    let read = floors(&record, 0)
        .iter()
        .map(|floors| floors.elements[1].force.abs())
        .fold(0.0, f64::max);
    assert!(
        force < read - 1.0,
        "{force} is without noise, {read} with it"
    );
    let source = Source::ForceScale(0);
    let (wanted, found) = (from(&of_shear, source), from(&of_force, source));
    assert!(
        (wanted - found).abs() < 1e-9 * wanted.abs() && wanted != 0.0,
        "{wanted}, {found}"
    );
}

/// After a test without an unloading. The actuator holds what it held.
#[test]
fn a_second_test_begins_where_the_first_ended() {
    for parts in [[TESTED, COMPUTED, COMPUTED], [COMPUTED, TESTED, COMPUTED]] {
        let mut plan = twice(parts);
        plan.procedures.remove(1);
        let storeys = run_unwatched(&plan);
        let elements = run_unwatched(&as_elements(plan, no));
        same(&elements, &storeys, 1, 1e-9, &format!("{parts:?}"));
    }
    let mut plan = bridge(
        [TESTED, COMPUTED, COMPUTED, COMPUTED],
        bilinear,
        Integrator::Explicit,
    );
    let again = plan.procedures[0].clone();
    plan.procedures.push(psd_plan::Procedure {
        name: "again".to_owned(),
        ..again
    });
    let record = run_unwatched(&plan);
    let (ended, begins) = (floors(&record, 0), floors(&record, 1));
    let (ended, begins) = (ended.last().unwrap(), &begins[0]);
    assert!((begins.command[0] - ended.command[0]).abs() < 1e-15);
    // The actuator holds the first degree of freedom; the others have no force.
    let ended = ended.restoring_force[2].abs();
    for force in &begins.restoring_force[1..] {
        assert!(force.abs() < 1e-2 * ended, "{force} after {ended}");
    }
}

/// The budget of the same frame as storeys: calibration of the tested one, stiffness of the computed ones.
/// Two tested piers between the same ends: they come to rest at different deformations, and no displacement of the frame has both. The first
/// step of another test would move them together.
#[test]
fn no_test_begins_at_deformations_that_the_frame_cannot_have() {
    let mut plan = bridge(
        [TESTED, COMPUTED, COMPUTED, COMPUTED],
        bilinear,
        Integrator::Explicit,
    );
    let mut frame = frame(&plan).clone();
    let first = frame.elements[0].clone();
    let stronger = Behaviour::Bilinear {
        stiffness: first.stiffness,
        yield_force: 1e9,
        post_yield_ratio: 0.0,
    };
    frame.elements.insert(
        1,
        Element {
            behaviour: stronger,
            ..first
        },
    );
    plan.specimens[0].frame = Some(frame);
    let again = psd_plan::Procedure {
        name: "again".to_owned(),
        ..plan.procedures[0].clone()
    };
    plan.procedures.push(again.clone());
    let straight = run_unwatched(&plan);
    assert_eq!(straight.outcome, Outcome::Completed);
    let unload = psd_plan::Procedure {
        name: "rest".to_owned(),
        kind: super::rest(None),
    };
    plan.procedures.insert(1, unload);
    let record = run_unwatched(&plan);
    let (Outcome::Blocked { reason }, [Some(_), Some(_)]) = (
        &record.outcome,
        [0, 1].map(|at| record.procedures.get(at).filter(|it| it.complete)),
    ) else {
        panic!("{:?}", record.outcome)
    };
    assert!(reason.contains("one shape of the frame"), "{reason}");
}

#[test]
fn elements_have_the_budget_of_storeys() {
    let mut plan = shaken([COMPUTED, TESTED, COMPUTED], bilinear, Integrator::Explicit);
    let uncertain = |storeys: &mut [Storey]| {
        for storey in storeys {
            storey.stiffness_uncertainty = 6e3;
        }
    };
    plan.specimens[0].frame = Some(frame(&plan).with(uncertain));
    plan.rig.calibration.force_uncertainty = 0.01;
    plan.rig.calibration.displacement_uncertainty = 0.002;
    let storeys = run_unwatched(&plan);
    let elements = run_unwatched(&as_elements(plan, no));
    let of_storey = |storey| Source::StoreyStiffness {
        specimen: 0,
        storey,
    };
    let of_element = |element| Source::ElementStiffness {
        specimen: 0,
        element,
    };
    let mut pairs: Vec<(Source, Source)> = (0..3).map(|i| (of_storey(i), of_element(i))).collect();
    for own in [Source::ForceScale(0), Source::DisplacementScale(0)] {
        pairs.push((own, own));
    }
    for (result, count) in [
        (MAX_DRIFT.name, 3),
        (FINAL_DRIFT.name, 3),
        (MAX_BASE_SHEAR.name, 1),
    ] {
        for index in 0..count {
            let [(_, storeys), (_, elements)] =
                [&storeys, &elements].map(|record| entry(record, result, index));
            for (storey, element) in &pairs {
                let (wanted, found) = (from(&storeys, *storey), from(&elements, *element));
                assert!(
                    (found - wanted).abs() <= 1e-6 * wanted.abs() && wanted != 0.0,
                    "{result}[{index}], {element:?}: {found} for {wanted}"
                );
            }
        }
    }
}

/// The stiffness matrix is computed: its uncertainty is that of the force of the model.
#[test]
fn the_computed_matrix_is_uncertain() {
    let plan = |by: f64, uncertainty: f64| {
        let mut plan = bridge(
            [TESTED, COMPUTED, TESTED, COMPUTED],
            elastic,
            Integrator::Explicit,
        );
        let mut frame = frame(&plan).scaled([1.0, 1.0 + by]);
        frame.matrix_uncertainty = [0.0, uncertainty];
        plan.specimens[0].frame = Some(frame);
        run_unwatched(&plan)
    };
    let drift = |record: &Record, index: usize| entry(record, FINAL_DRIFT.name, index).0;
    let (record, more, less) = (plan(0.0, 0.01), plan(0.01, 0.0), plan(-0.01, 0.0));
    for index in 0..3 {
        let wanted = 0.5 * (drift(&more, index) - drift(&less, index));
        let (_, parts) = entry(&record, FINAL_DRIFT.name, index);
        let found = from(&parts, Source::StiffnessMatrix(0));
        assert!(
            (found.abs() - wanted.abs()).abs() < 0.02 * wanted.abs() && wanted != 0.0,
            "{found} for {wanted}"
        );
    }
}

/// Their deformations and forces at the end of the unloading, and its steps.
fn rests(record: &Record) -> ([Vec<f64>; 2], &[UnloadStep]) {
    assert_eq!(record.outcome, Outcome::Completed);
    let rest = &record.procedures[1];
    let list = |name: &str| rest.result(name).unwrap().value.values().to_vec();
    let History::Unload(UnloadHistory {
        of: Unloaded::Elements,
        steps,
    }) = &rest.history
    else {
        panic!("{:?}", rest.history)
    };
    (
        [list(RESIDUAL_DRIFT.name), list(RESIDUAL_SHEAR.name)],
        steps,
    )
}

/// Shaken, unloaded and shaken again: storeys that are separate specimens, and the same storeys as elements.
#[test]
fn storeys_unload_as_their_elements() {
    for parts in [
        [TESTED, APART, APART],
        [TESTED, APART, COMPUTED],
        [COMPUTED, TESTED, APART],
        [TESTED, COMPUTED, COMPUTED],
        [COMPUTED, TESTED, COMPUTED],
    ] {
        let plan = twice(parts);
        let storeys = run_unwatched(&plan);
        let elements = run_unwatched(&as_elements(plan, no));
        let ([found, left], _) = rests(&elements);
        let wanted = storeys.procedures[1].result(RESIDUAL_DRIFT.name).unwrap();
        let wanted = wanted.value.values();
        assert_eq!((found.len(), wanted.len()), (3, 3));
        for ((found, wanted), left) in found.iter().zip(wanted).zip(&left) {
            assert!(
                (found - wanted).abs() < 1e-11 && wanted.abs() > 1e-5 && left.abs() < 1e-6,
                "{parts:?}: {found} for {wanted}, {left} N left"
            );
        }
        same(&elements, &storeys, 2, 1e-8, &format!("{parts:?}"));
    }
}

/// A bridge that is shaken, unloaded and shaken again.
fn unloaded(parts: [Part; 4]) -> Plan {
    let mut plan = bridge(parts, bilinear, Integrator::Explicit);
    let procedures = twice([TESTED; 3]).procedures;
    plan.procedures.extend(procedures.into_iter().skip(1));
    let ProcedureKind::Unload(unload) = &mut plan.procedures[1].kind else {
        panic!()
    };
    unload.within = None;
    plan
}

/// Piers that yielded rest at their plastic deformation, whatever K and the other elements carry: the force falls along k from the
/// last step of the test. The next test begins where the axes are.
#[test]
fn each_pier_rests_at_its_own_plastic_deformation() {
    let parts = [TESTED, COMPUTED, TESTED, COMPUTED];
    let plan = unloaded(parts);
    let record = run_unwatched(&plan);
    let ([deformation, left], steps) = rests(&record);
    let end = floors(&record, 0).last().unwrap().elements.clone();
    let begin = floors(&record, 2)[0].elements.clone();
    for (element, part) in parts.into_iter().enumerate() {
        let stiffness = frame(&plan).elements[element].stiffness;
        let plastic = end[element].deformation - end[element].force / stiffness;
        assert!((deformation[element] - plastic).abs() < 1e-9 && plastic.abs() > 1e-4);
        assert!(left[element].abs() < 1e-3 && end[element].force.abs() > 10.0);
        if part == TESTED {
            assert!((begin[element].deformation - plastic).abs() < 1e-9);
            assert!(begin[element].force.abs() < 1e-3);
        } else {
            let stays = |step: &UnloadStep| step.displacement[element] == deformation[element];
            assert!(steps.iter().all(stays));
        }
    }
    assert_eq!(steps.len(), 4, "the start and three moves");
}

/// With noise, every pier comes to rest within what its cell can show.
#[test]
fn noise_ends_the_unloading_of_elements_within_their_readings() {
    let (noise, resolution) = (20.0, 1e-6);
    for seed in 1..20 {
        let mut plan = unloaded([TESTED, COMPUTED, TESTED, COMPUTED]);
        plan.rig.link = Link::Virtual(VirtualLink {
            noise,
            resolution,
            seed,
            ..VirtualLink::default()
        });
        let record = run_unwatched(&plan);
        let ([deformation, left], _) = rests(&record);
        let end = floors(&record, 0).last().unwrap().elements.clone();
        assert!(record.procedures[1].result(RESIDUAL_DRIFT.name).is_some());
        for element in [0, 2] {
            let stiffness = frame(&plan).elements[element].stiffness;
            let plastic = end[element].deformation - end[element].force / stiffness;
            let off = stiffness * (deformation[element] - plastic);
            // Three standard deviations of the force are zero; the readings of start and end have noise too.
            assert!(left[element].abs() <= 3.0 * noise && end[element].force.abs() > 10.0 * noise);
            assert!(off.abs() < 8.0 * noise, "seed {seed}: {off} N");
        }
    }
}

/// The numbers of the rig are beside those of the prototype; none for a computed element. The specimen at a scale rests as at full scale.
#[test]
fn elements_at_a_scale_unload_as_at_full_scale() {
    let plan = unloaded([TESTED, COMPUTED, TESTED, COMPUTED]);
    let full = run_unwatched(&plan);
    let ([wanted, _], _) = rests(&full);
    for scale in SCALES {
        let mut plan = plan.clone();
        let mut elements = frame(&plan).elements.clone();
        if let Part::Tested { scale: own, .. } = &mut elements[2].part {
            *own = scale;
        }
        elements[2].behaviour = model_on_the_rig(&elements[2].behaviour, &scale);
        plan.specimens[0].frame = Some(frame(&plan).clone().with_elements(elements));
        let record = run_unwatched(&plan);
        let ([found, _], steps) = rests(&record);
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-10, "{found} for {wanted}");
        }
        let scaled = Assemblies::of(frame(&plan)).filter(Assemblies::is_scaled);
        let written = tables::elements_written(steps, scaled.as_ref());
        let read = |name: &str| {
            let column = written.iter().find(|column| column.name() == name);
            column.map(|column| column.f64().unwrap().to_vec())
        };
        let Some(rig) = read("displacement_rig_m") else {
            assert!(scaled.is_none());
            continue;
        };
        let [command, deformation, force, command_rig, force_rig] = [
            "command_m",
            "deformation_m",
            "restoring_force_n",
            "command_rig_m",
            "force_rig_n",
        ]
        .map(|name| read(name).unwrap());
        let near = |found: Option<f64>, wanted: f64| {
            (found.unwrap() - wanted).abs() <= 1e-12 * wanted.abs()
        };
        for row in (0..rig.len()).step_by(4) {
            for (element, scale) in [(0, Scale::FULL), (2, scale)] {
                let of = |values: &[Option<f64>]| values[row + element].unwrap();
                let row = row + element;
                assert!(near(rig[row], scale.displacement * of(&deformation)));
                assert!(near(command_rig[row], scale.displacement * of(&command)));
                assert!(near(force_rig[row], of(&force) / scale.forces()));
            }
            assert_eq!((rig[row + 1], force_rig[row + 3]), (None, None));
        }
    }
}

/// The unloaded position of an element has the budget of the same storey: calibration, zero offset and readings of its axis.
#[test]
fn unloaded_elements_have_the_budget_of_storeys() {
    let mut plan = twice([COMPUTED, TESTED, COMPUTED]);
    plan.procedures.truncate(2);
    plan.rig.calibration.force_uncertainty = 0.01;
    plan.rig.calibration.displacement_uncertainty = 0.002;
    plan.rig.calibration.zero_uncertainty = 50.0;
    plan.rig.link = Link::Virtual(VirtualLink {
        noise: 1.0,
        resolution: 1e-7,
        ..VirtualLink::default()
    });
    let ProcedureKind::Unload(unload) = &mut plan.procedures[1].kind else {
        panic!()
    };
    unload.within = Some(Constant(5.0));
    let mut storeys = run_unwatched(&plan);
    let mut elements = run_unwatched(&as_elements(plan, no));
    for record in [&mut storeys, &mut elements] {
        record.procedures.remove(0);
    }
    for (result, sources) in [
        (
            RESIDUAL_DRIFT.name,
            &[Source::DisplacementScale(0), Source::ForceZero(0)][..],
        ),
        (
            RESIDUAL_SHEAR.name,
            &[Source::ForceScale(0), Source::ForceZero(0)],
        ),
    ] {
        let [(_, storey), (_, element)] =
            [&storeys, &elements].map(|record| entry(record, result, 1));
        assert_eq!(storey.len(), element.len());
        for source in sources {
            let (wanted, found) = (from(&storey, *source), from(&element, *source));
            assert!(
                (found - wanted).abs() <= 1e-6 * wanted.abs() && wanted != 0.0,
                "{result}, {source:?}: {found} for {wanted}"
            );
        }
    }
}
