//! A run whose energy balance does not close reports it, for every procedure.

use crate::tests::testing::{number, run_unwatched};
use crate::tests::uncertainty::frame::{base_excited_plan, constant};
use psd_plan::record::{EventKind, Record};
use psd_plan::{Behaviour, ProcedureKind, ShakeDamping, Storey};

/// Two storeys that yield, by the tangent form, under ground motion of 20 s followed by a rest of 40 s.
fn yielding(time_step: f64) -> Record {
    let storey = |mass: f64, stiffness: f64, yield_force: f64| {
        Storey::new(
            mass,
            stiffness,
            Behaviour::Bilinear {
                stiffness,
                yield_force,
                post_yield_ratio: 0.05,
            },
        )
    };
    let swings = |sample: u32| {
        3.0 * (0.126 * f64::from(sample)).sin() + 2.0 * (0.31 * f64::from(sample)).sin()
    };
    let storeys = vec![storey(2000.0, 3e6, 9e3), storey(1500.0, 2.4e6, 7e3)];
    let mut plan = base_excited_plan(storeys, (0..2000).map(swings).collect(), time_step);
    if let ProcedureKind::Shake(shake) = &mut plan.procedures[0].kind {
        shake.damping = ShakeDamping::Rayleigh(constant(0.02));
        shake.duration = Some(constant(60.0));
    }
    run_unwatched(&plan)
}

#[test]
fn an_energy_balance_error_is_reported() {
    let has_remark = |record: &Record| {
        record.events.iter().any(|event| {
            event.kind == EventKind::Remark && event.text.contains("energy balance error")
        })
    };
    let error = |record: &Record| number(record, 0, "energy_error").0.unwrap().abs();
    let (fine, coarse) = (yielding(1e-3), yielding(0.04));
    assert!(error(&fine) < 0.1 && !has_remark(&fine), "{}", error(&fine));
    assert!(
        error(&coarse) > 0.1 && has_remark(&coarse),
        "{}",
        error(&coarse)
    );
}
