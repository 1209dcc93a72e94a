//! Uncertainty of a blow against the truth, specimen by specimen and contact by contact: the virtual specimen itself, struck
//! again with one input moved, says what the recorded way taken again should have foretold.

use super::impact::Setting;
use super::inputs::Inputs;
use super::testing::{elastic_plan, every, impact, run_unwatched};
use crate::formula::{Formula, ProcedureId};
use crate::mechanics::impact::ImpactInput;
use crate::mechanics::rerun::{OUTCOMES, integrate};
use crate::mechanics::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Bolted, Calibration, Contact, Impact, Pinching, Plan, ProcedureKind, Until};
use crate::rig::DeclaredNoise;
use crate::uncertainty::{Contribution, Source};

const SOURCES: [Source; 4] =
    [Source::StrikerVelocity(0), Source::StrikerMass(0), Source::ForceScale(0), Source::DisplacementScale(0)];

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

/// About 300 N/m and 20 N, whose newtons are `force` and whose metres `displacement` of those.
fn specimens(force: f64, displacement: f64) -> Vec<(&'static str, Behaviour)> {
    let stiffness = 300.0 * force / displacement;
    let yield_force = 20.0 * force;
    let corner = |x: f64, r: f64| [x * displacement, r * force];
    vec![
        ("elastic", Behaviour::Elastic { stiffness }),
        ("bilinear", Behaviour::Bilinear { stiffness, yield_force, hardening: 0.1 }),
        ("plastic", Behaviour::Bilinear { stiffness, yield_force: 1.25 * yield_force, hardening: 0.0 }),
        ("multilinear", Behaviour::Multilinear { corners: vec![corner(0.05, 15.0), corner(0.1, 22.0), corner(0.3, 30.0)] }),
        ("bouc_wen", Behaviour::BoucWen { stiffness, yield_force, hardening: 0.1, sharpness: 2.0, beta: 0.5 }),
        (
            "pinching",
            Behaviour::Pinching(Pinching {
                stiffness,
                yield_force,
                hardening: 0.05,
                force_factor: 0.4,
                displacement_factor: 0.5,
                unloading_exponent: 0.0,
                deterioration: None,
            }),
        ),
        ("degrading", Behaviour::Degrading { stiffness, half_displacement: 0.1 * displacement, residual: 0.0 }),
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
        ("limit", Contact::Limit { force: constant(1500.0) }),
        ("restitution", Contact::Restitution { coefficient: constant(0.6) }),
        ("hertz", Contact::Hertz { stiffness: constant(1e6), loss: constant(0.0), force_limit: None }),
    ]
}

/// What a blow comes to on the virtual specimen.
fn truth(input: &ImpactInput, until: Until, steps: u64, behaviour: &Behaviour) -> [f64; OUTCOMES.len()] {
    let mut model = SpecimenModel::new(behaviour);
    let force = model.move_to(0.0);
    integrate(input, until, steps, (0.0, 0.0, force), |target| (target, model.move_to(target))).values
}

struct Cell {
    source: Source,
    outcome: &'static str,
    told: Contribution,
    /// The larger change of the two sides.
    truth: f64,
    value: f64,
}

/// How hard, for how long, and how uncertain.
#[derive(Clone, Copy, Debug)]
struct Blow {
    /// kg
    striker: f64,
    /// m/s
    velocity: f64,
    /// s
    duration: f64,
    until: Until,
    /// Standard uncertainty of each source, of its value.
    share: f64,
}

fn cells(specimen: usize, contact: &Contact, blow: Blow) -> Vec<Cell> {
    let Blow { striker, velocity, duration, until, share } = blow;
    let blow = Impact {
        contact: contact.clone(),
        stepping: every(1e-3),
        duration: constant(duration),
        until,
        ..impact(constant(300.0))
    };
    let mut plan: Plan = elastic_plan(300.0, vec![ProcedureKind::Impact(blow.clone())]);
    plan.specimens[0].behaviour = Some(specimens(1.0, 1.0)[specimen].1.clone());
    (plan.strikers[0].mass, plan.strikers[0].velocity) = (striker, velocity);
    plan.strikers[0].mass_uncertainty = share * striker;
    plan.strikers[0].velocity_uncertainty = share * velocity;
    plan.rig.calibration = Calibration { force_uncertainty: share, displacement_uncertainty: share, ..Calibration::default() };
    let record = run_unwatched(&plan);
    let mut inputs = Inputs::new(&record, ProcedureId(0));
    let setting = Setting::evaluate(&blow, &plan.strikers[0], &mut inputs, DeclaredNoise::default()).ok().unwrap();
    let at = |source: Source, by: f64| {
        let mut input = setting.input;
        let (mut force, mut displacement) = (1.0, 1.0);
        match source {
            Source::StrikerVelocity(_) => input.striker_velocity *= 1.0 + by * share,
            Source::StrikerMass(_) => input.striker_mass *= 1.0 + by * share,
            Source::ForceScale(_) => force += by * share,
            _ => displacement += by * share,
        }
        truth(&input, until, setting.steps, &specimens(force, displacement)[specimen].1)
    };
    let nominal = at(SOURCES[0], 0.0);
    let mut found = Vec::new();
    for source in SOURCES {
        let (up, down) = (at(source, 1.0), at(source, -1.0));
        for (index, outcome) in OUTCOMES.into_iter().enumerate() {
            let result = record.procedures[0].result(outcome).unwrap();
            let Some(told) = result.contributions.iter().find(|part| part.source == source) else { continue };
            let change = |moved: f64| (moved - nominal[index]).abs();
            let truth = change(up[index]).max(change(down[index]));
            found.push(Cell { source, outcome, told: *told, truth, value: nominal[index] });
        }
    }
    found
}

/// A source that is called smooth contributes what it truly does, to a quarter less and a half more; one that is marked, no
/// less than half of it: what jumps need not be at its worst where it is looked at.
fn judge(blow: Blow, least_smooth: f64) {
    let (mut smooth, mut all) = (0.0, 0.0);
    for (specimen, (name, _)) in specimens(1.0, 1.0).into_iter().enumerate() {
        for (law, contact) in laws() {
            for Cell { source, outcome, told, truth, value } in cells(specimen, &contact, blow) {
                let amount = told.amount.abs();
                let nothing = 1e-6 * value.abs();
                let most = if told.smooth { 1.5 * truth + nothing } else { f64::INFINITY };
                let least = if told.smooth { 0.75 } else { 0.5 } * truth - nothing;
                assert!(
                    (least..=most).contains(&amount),
                    "{name}, {law}: {outcome} by {source:?} is {amount:e} ({}), truly {truth:e}; {blow:?}",
                    if told.smooth { "smooth" } else { "marked" }
                );
                all += 1.0;
                smooth += f64::from(u8::from(told.smooth));
            }
        }
    }
    assert!(smooth >= least_smooth * all, "{smooth} of {all} are smooth; {blow:?}");
}

const STRUCK: Blow = Blow { striker: 10.0, velocity: 1.0, duration: 0.6, until: Until::StrikerStop, share: 1e-3 };

/// A heavy striker that hits again and again on the way out.
#[test]
fn blow_upon_blow_contributes_what_it_truly_does() {
    judge(STRUCK, 0.6);
    judge(Blow { share: 1e-2, ..STRUCK }, 0.5);
}
