//! Uncertainty of an impact, for every pair of specimen and contact law: a re-run of the virtual specimen with one input perturbed is
//! compared with the re-integration along the recorded path.

use crate::procedures::common::results::Evaluated;
use crate::procedures::impact::results::re_integrated;
use crate::procedures::impact::setting::Setting;
use crate::run::inputs::Inputs;
use crate::tests::testing::{elastic_plan, every, impact, number, run_unwatched};
use psd_physics::impact::ImpactInput;
use psd_physics::reintegration::impact::integrate;
use psd_physics::reintegration::recorded_path::Reading;
use psd_physics::specimen::{RestoringForce, SpecimenModel};
use psd_plan::formula::{Formula, ProcedureId};
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{
    Behaviour, Bolted, Calibration, Contact, Impact, Link, Pinching, Plan, ProcedureKind, Until,
    VirtualLink,
};
use psd_rig::DeclaredNoise;

const SOURCES: [Source; 4] = [
    Source::StrikerVelocity(0),
    Source::StrikerMass(0),
    Source::ForceScale(0),
    Source::DisplacementScale(0),
];

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

/// A specimen of about 300 N/m and 20 N, whose force scale is `force` and whose displacement scale is `displacement`.
fn specimens(force: f64, displacement: f64) -> Vec<(&'static str, Behaviour)> {
    let stiffness = 300.0 * force / displacement;
    let yield_force = 20.0 * force;
    let corner = |x: f64, r: f64| [x * displacement, r * force];
    vec![
        ("elastic", Behaviour::Elastic { stiffness }),
        (
            "bilinear",
            Behaviour::Bilinear {
                stiffness,
                yield_force,
                post_yield_ratio: 0.1,
            },
        ),
        (
            "plastic",
            Behaviour::Bilinear {
                stiffness,
                yield_force: 1.25 * yield_force,
                post_yield_ratio: 0.0,
            },
        ),
        (
            "multilinear",
            Behaviour::Multilinear {
                corners: vec![corner(0.05, 15.0), corner(0.1, 22.0), corner(0.3, 30.0)],
            },
        ),
        (
            "bouc_wen",
            Behaviour::BoucWen {
                stiffness,
                yield_force,
                post_yield_ratio: 0.1,
                sharpness: 2.0,
                beta: 0.5,
            },
        ),
        (
            "pinching",
            Behaviour::Pinching(Pinching {
                stiffness,
                yield_force,
                post_yield_ratio: 0.05,
                force_factor: 0.4,
                displacement_factor: 0.5,
                unloading_exponent: 0.0,
                capping: None,
                deterioration: None,
            }),
        ),
        (
            "degrading",
            Behaviour::Degrading {
                stiffness,
                half_displacement: 0.1 * displacement,
                residual: 0.0,
            },
        ),
        (
            "bolted",
            Behaviour::Bolted(Bolted {
                stiffness: 2.0 * stiffness,
                bearing_force: 2.0 * yield_force,
                clearance: 0.005 * displacement,
                slip_force: 0.5 * yield_force,
            }),
        ),
    ]
}

fn laws() -> Vec<(&'static str, Contact)> {
    vec![
        ("rigid", Contact::Rigid),
        (
            "limit",
            Contact::Limit {
                force: constant(1500.0),
            },
        ),
        (
            "restitution",
            Contact::Restitution {
                coefficient: constant(0.6),
            },
        ),
        (
            "hertz",
            Contact::Hertz {
                stiffness: constant(1e6),
                loss: constant(0.0),
                force_limit: None,
            },
        ),
        (
            "hertz with loss",
            Contact::Hertz {
                stiffness: constant(1e6),
                loss: constant(0.3),
                force_limit: None,
            },
        ),
    ]
}

/// Results of an impact on the virtual specimen.
fn truth(input: &ImpactInput, until: Until, steps: u64, behaviour: &Behaviour) -> Evaluated {
    let mut model = SpecimenModel::new(behaviour);
    let force = model.move_to(0.0);
    let start = Reading {
        target: 0.0,
        displacement: 0.0,
        force,
    };
    let found = integrate(input, until, steps, start, |target, _| {
        (target, model.move_to(target))
    });
    re_integrated(&found.unwrap().values)
}

struct Cell {
    source: Source,
    outcome: &'static str,
    reported: Contribution,
    /// The larger change of the two perturbations.
    truth: f64,
    value: f64,
}

/// Intensity, duration and uncertainty of an impact.
#[derive(Clone, Copy, Debug)]
struct ImpactCase {
    /// \[kg\]
    striker: f64,
    /// \[m/s\]
    velocity: f64,
    /// \[s\]
    time_step: f64,
    /// \[s\]
    duration: f64,
    until: Until,
    /// Relative standard uncertainty of each source.
    share: f64,
}

fn cells(specimen: usize, contact: &Contact, case: ImpactCase) -> Vec<Cell> {
    let ImpactCase {
        striker,
        velocity,
        time_step,
        duration,
        until,
        share,
    } = case;
    let stepping = every(time_step);
    let struck = Impact {
        contact: contact.clone(),
        stepping,
        duration: constant(duration),
        until,
        ..impact(constant(300.0))
    };
    let mut plan: Plan = elastic_plan(300.0, vec![ProcedureKind::Impact(struck.clone())]);
    plan.specimens[0].behaviour = Some(specimens(1.0, 1.0)[specimen].1.clone());
    (plan.strikers[0].mass, plan.strikers[0].velocity) = (striker, velocity);
    plan.strikers[0].mass_uncertainty = share * striker;
    plan.strikers[0].velocity_uncertainty = share * velocity;
    plan.rig.calibration = Calibration {
        force_uncertainty: share,
        displacement_uncertainty: share,
        ..Calibration::default()
    };
    let record = run_unwatched(&plan);
    let mut inputs = Inputs::new(&record, ProcedureId(0));
    let setting = Setting::of_point(
        &struck,
        struck.point().unwrap(),
        &plan.strikers[0],
        &mut inputs,
        DeclaredNoise::NONE,
    )
    .ok()
    .unwrap();
    let at = |source: Source, by: f64| {
        let mut input = setting.input;
        let (mut force, mut displacement) = (1.0, 1.0);
        match source {
            Source::StrikerVelocity(_) => input.striker_velocity *= 1.0 + by * share,
            Source::StrikerMass(_) => input.striker_mass *= 1.0 + by * share,
            Source::ForceScale(_) => force += by * share,
            _ => displacement += by * share,
        }
        truth(
            &input,
            until,
            setting.steps().count,
            &specimens(force, displacement)[specimen].1,
        )
    };
    let nominal = at(SOURCES[0], 0.0);
    let mut found = Vec::new();
    for source in SOURCES {
        let (up, down) = (at(source, 1.0), at(source, -1.0));
        for (index, (kind, values)) in nominal.iter().enumerate() {
            let (outcome, nominal) = (kind.name, values[0]);
            let result = record.procedures[0].result(outcome).unwrap();
            let Some(reported) = result
                .contributions
                .iter()
                .find(|part| part.source == source)
            else {
                continue;
            };
            let change = |moved: &Evaluated| (moved[index].1[0] - nominal).abs();
            let truth = change(&up).max(change(&down));
            found.push(Cell {
                source,
                outcome,
                reported: *reported,
                truth,
                value: nominal,
            });
        }
    }
    found
}

/// Fractions that a run must reach.
#[derive(Clone, Copy, Debug)]
struct Held {
    /// Fraction of the contributions that are marked smooth, on specimens that follow Masing's rule.
    smooth: f64,
    /// Minimum of a marked contribution on such a specimen, relative to the true effect of its source. A jump need not have its maximum
    /// where it is evaluated.
    marked: f64,
}

/// Elements in parallel, by their index among the specimens.
fn keeps_masing(specimen: usize) -> bool {
    specimen < 4
}

/// The contribution of a smooth source equals its true effect, within −25 % and +50 %. A marked one is at least its fraction of the true
/// effect. For specimens that do not follow Masing's rule, marked contributions are not checked.
fn compare(case: ImpactCase, specimens_and_laws: &[(usize, usize)], held: Held) {
    let (mut smooth, mut all) = (0.0, 0.0);
    for (specimen, law) in specimens_and_laws {
        let (name, _) = &specimens(1.0, 1.0)[*specimen];
        let (law, contact) = &laws()[*law];
        for Cell {
            source,
            outcome,
            reported,
            truth,
            value,
        } in cells(*specimen, contact, case)
        {
            let amount = reported.amount.abs();
            let nothing = 1e-6 * value.abs();
            let (least, most) = match (reported.smooth, keeps_masing(*specimen)) {
                (true, _) => (0.75, 1.5),
                (false, true) => (held.marked, f64::INFINITY),
                (false, false) => (0.0, f64::INFINITY),
            };
            assert!(
                (least * truth - nothing..=most * truth + nothing).contains(&amount),
                "{name}, {law}: {outcome} by {source:?} is {amount:e} ({}), truly {truth:e}; {case:?}",
                if reported.smooth { "smooth" } else { "marked" }
            );
            if keeps_masing(*specimen) {
                all += 1.0;
                smooth += f64::from(u8::from(reported.smooth));
            }
        }
    }
    assert!(
        smooth >= held.smooth * all,
        "{smooth} of {all} are smooth; {case:?}"
    );
}

fn every_specimen_by_every_law() -> Vec<(usize, usize)> {
    (0..specimens(1.0, 1.0).len())
        .flat_map(|specimen| (0..laws().len()).map(move |law| (specimen, law)))
        .collect()
}

const STRUCK: ImpactCase = ImpactCase {
    striker: 10.0,
    velocity: 1.0,
    time_step: 1e-3,
    duration: 0.6,
    until: Until::StrikerStop,
    share: 1e-3,
};

/// A heavy striker that hits repeatedly during the outward motion.
#[test]
fn repeated_impacts_contribute_their_true_effect() {
    compare(
        STRUCK,
        &every_specimen_by_every_law(),
        Held {
            smooth: 0.7,
            marked: 0.5,
        },
    );
    compare(
        ImpactCase {
            share: 1e-2,
            ..STRUCK
        },
        &every_specimen_by_every_law(),
        Held {
            smooth: 0.5,
            marked: 0.5,
        },
    );
}

/// A light striker. Afterwards the structure moves back through its rest position, yields in reverse and returns.
#[test]
fn swinging_back_contributes_what_it_truly_does() {
    let swinging = ImpactCase {
        striker: 1.5,
        velocity: 3.0,
        duration: 1.5,
        until: Until::Duration,
        ..STRUCK
    };
    compare(
        swinging,
        &every_specimen_by_every_law(),
        Held {
            smooth: 0.6,
            marked: 0.35,
        },
    );
    compare(
        ImpactCase {
            share: 1e-2,
            ..swinging
        },
        &every_specimen_by_every_law(),
        Held {
            smooth: 0.5,
            marked: 0.35,
        },
    );
}

/// Bilinear and degrading models with Hertz's contact, a bilinear one with restitution, in steps of a tenth.
#[test]
fn finer_steps_contribute_as_much() {
    let fine = ImpactCase {
        time_step: 1e-4,
        share: 2e-3,
        ..STRUCK
    };
    compare(
        fine,
        &[(1, 3), (6, 3), (1, 2)],
        Held {
            smooth: 0.7,
            marked: 0.5,
        },
    );
}

/// Readings of a specimen that yields and is hit again, each with u = 0.2 N. Their effect on the largest displacement equals the scatter
/// of runs that differ only in these readings. The effect of the velocity equals that of a run with exact readings.
#[test]
fn noise_does_not_hide_what_an_input_does() {
    const RUNS: u64 = 40;
    let plan = |seed: u64| {
        let struck = Impact {
            contact: laws()[1].1.clone(),
            stepping: every(1e-3),
            duration: constant(0.6),
            ..impact(constant(300.0))
        };
        let mut plan = elastic_plan(300.0, vec![ProcedureKind::Impact(struck)]);
        plan.specimens[0].behaviour = Some(specimens(1.0, 1.0)[1].1.clone());
        plan.strikers[0].velocity_uncertainty = 1e-2;
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 0.2,
            seed,
            ..VirtualLink::default()
        });
        plan
    };
    let exact = cells(
        1,
        &laws()[1].1,
        ImpactCase {
            share: 1e-2,
            ..STRUCK
        },
    );
    let of_velocity =
        |cell: &&Cell| cell.outcome == "max_displacement" && cell.source == SOURCES[0];
    let truth = exact.iter().find(of_velocity).unwrap().truth;
    let records: Vec<_> = (1..=RUNS).map(|seed| run_unwatched(&plan(seed))).collect();
    let found = |index: usize| number(&records[index], 0, "max_displacement").0.unwrap();
    let count = f64::from(u32::try_from(RUNS).unwrap());
    let mean = (0..records.len()).map(found).sum::<f64>() / count;
    let scatter = ((0..records.len())
        .map(|index| (found(index) - mean).powi(2))
        .sum::<f64>()
        / (count - 1.0))
        .sqrt();
    // Each record predicts with its own yield points, which have the same reading uncertainty as the other points.
    for record in &records[..8] {
        let parts = &record.procedures[0]
            .result("max_displacement")
            .unwrap()
            .contributions;
        let of_readings = |part: &&Contribution| matches!(part.source, Source::Readings { .. });
        let u = parts
            .iter()
            .filter(of_readings)
            .map(|part| part.amount.powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(
            (0.5..2.0).contains(&(u / scatter)),
            "{scatter} m of runs, {u} m predicted"
        );
        let of_velocity = parts
            .iter()
            .find(|part| part.source == SOURCES[0])
            .unwrap()
            .amount
            .abs();
        assert!(
            (0.75..1.5).contains(&(of_velocity / truth)),
            "{of_velocity} m by the velocity, truly {truth} m"
        );
    }
}
