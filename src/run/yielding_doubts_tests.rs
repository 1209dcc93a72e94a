//! Uncertainty of a frame that yields forth and back on moving ground, against the same frame shaken with another mass and on
//! another ground: specimen by specimen, what one run foretells is what those runs come to.

use super::frame_doubts_tests::{constant, entry, from, shaken, storey};
use super::testing::run_unwatched;
use crate::plan::{Behaviour, Plan, ProcedureKind, ShakeDamping, Storey};
use crate::uncertainty::Source;

const MASS: f64 = 2000.0;
const STIFFNESS: f64 = 2e6;
/// Standard uncertainty of mass and ground, of their values.
const SHARE: f64 = 0.02;

/// Six seconds that grow and fade, m/s², 10 ms apart, about the frame's own second-long swing and a slower one.
fn accelerations() -> Vec<f64> {
    let at = |sample: u32| {
        let time = 0.01 * f64::from(sample);
        let swell = (0.5 * time).sin() * (-0.15 * time).exp();
        swell * (6.5 * (24.0 * time).sin() + 4.0 * (9.0 * time + 0.4).sin() + 2.5 * (41.0 * time + 1.1).sin())
    };
    (0..=600).map(at).collect()
}

fn plan(behaviour: &Behaviour, mass: f64, ground: f64) -> Plan {
    let of = Storey { behaviour: behaviour.clone(), mass_uncertainty: SHARE * MASS, ..storey(mass, STIFFNESS) };
    let mut plan = shaken(vec![of], accelerations().into_iter().map(|each| ground * each).collect(), 4e-3);
    let ProcedureKind::Shake(shake) = &mut plan.procedures[0].kind else { panic!("no shake") };
    shake.damping = ShakeDamping::Rayleigh(constant(0.03));
    plan.grounds[0].scale_uncertainty = SHARE;
    plan
}

/// Bilinear, multilinear and of Bouc and Wen, each of which one supposition describes: the largest drift and the base shear are within
/// 30 % as uncertain as they are, whatever else might be supposed of a specimen that swings back.
#[test]
fn a_shake_that_yields_forth_and_back_is_as_uncertain_as_it_is() {
    let corner = |place: f64, force: f64| [place, force];
    let kinds = [
        ("bilinear", Behaviour::Bilinear { stiffness: STIFFNESS, yield_force: 9e3, hardening: 0.03 }),
        ("stiffer bilinear", Behaviour::Bilinear { stiffness: STIFFNESS, yield_force: 9e3, hardening: 0.2 }),
        ("multilinear", Behaviour::Multilinear { corners: vec![corner(4e-3, 8e3), corner(9e-3, 1.2e4), corner(0.03, 1.5e4)] }),
        ("bouc_wen", Behaviour::BoucWen { stiffness: STIFFNESS, yield_force: 9e3, hardening: 0.05, sharpness: 2.0, beta: 0.5 }),
        (
            "softer bouc_wen",
            Behaviour::BoucWen { stiffness: STIFFNESS, yield_force: 8e3, hardening: 0.1, sharpness: 1.0, beta: 0.7 },
        ),
    ];
    let sources = [(Source::StoreyMass { specimen: 0, storey: 0 }, [SHARE, 0.0]), (Source::GroundScale(0), [0.0, SHARE])];
    for (name, behaviour) in kinds {
        let run =
            |by: f64, [mass, ground]: [f64; 2]| run_unwatched(&plan(&behaviour, MASS * (1.0 + by * mass), 1.0 + by * ground));
        let record = run(0.0, [0.0; 2]);
        for result in ["max_drift", "max_base_shear"] {
            let (value, parts) = entry(&record, result, 0);
            let (mut told, mut truth) = (0.0, 0.0);
            for (source, shares) in sources {
                let moved = |by: f64| entry(&run(by, shares), result, 0).0;
                let (up, down) = (moved(1.0), moved(-1.0));
                told += from(&parts, source).powi(2);
                truth += (0.5 * (up - down)).powi(2).max(0.25 * (up - value).powi(2).max((down - value).powi(2)));
            }
            let ratio = (told / truth).sqrt();
            assert!(
                (0.75..1.3).contains(&ratio),
                "{name}: {result} {value:e} is {ratio} times as uncertain as it is, {:e}",
                truth.sqrt()
            );
        }
    }
}
