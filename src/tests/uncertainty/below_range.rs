//! Readings below the lower end of a calibrated range: their contribution by hand.

use super::impact::{MASS, STIFFNESS, STRIKER, from, plan, sticking};
use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
use psd_plan::formula::Formula::Constant;
use psd_plan::uncertainty::Source;
use psd_plan::{Calibration, Interval, Link, Plan, ProcedureKind, StiffnessRamp, VirtualLink};

/// Four steps of 10 mm at 1 kN/m: 10, 20, 30 and 40 N.
fn ramp_to_40_newtons(calibration: Calibration) -> Plan {
    let four = StiffnessRamp {
        displacements: (1..=4)
            .map(|step| Constant(0.01 * f64::from(step)))
            .collect(),
        ..ramp(1.0)
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::StiffnessRamp(four)]);
    plan.rig.calibration = calibration;
    plan
}

/// The first force, 10 N, is 5 N below the range: with 1 % it can be δ = 0.05 N off beyond its factor. With x − x̄ of −15, −5, 5 and 15 mm
/// and Σ(x − x̄)² = 500 mm², the slope changes by −15 mm·δ/500 mm² = −1.5 N/m, the intercept by δ/4 + 25 mm·1.5 N/m = 0.05 N. The first
/// secant changes by δ/10 mm = 5 N/m. The largest force is in the range.
#[test]
fn a_force_below_the_range_moves_the_line_by_its_lever() {
    let record = run_unwatched(&ramp_to_40_newtons(Calibration {
        force_uncertainty: 0.01,
        force_calibrated: Some(Interval {
            low: 15.0,
            high: 1e6,
        }),
        ..Calibration::default()
    }));
    let source = Source::ForceBelowRange(0);
    for (name, by_hand) in [
        ("stiffness", -1.5),
        ("intercept_force", 0.05),
        ("secant_stiffness", 5.0),
        ("max_force", 0.0),
    ] {
        let found = from(&record, name, source);
        assert!((found - by_hand).abs() < 1e-9, "{name}: {found}");
    }
    // Beside 1 % of 1 kN/m by the factor; the line has no scatter.
    let u = number(&record, 0, "stiffness").1.unwrap();
    assert!((u - 10_f64.hypot(1.5)).abs() < 1e-6, "{u}");
}

/// The first displacement, 10 mm, is 5 mm below the range: with 2 % it can be 0.1 mm off, which is a force of 0.1 N in the same place.
#[test]
fn a_displacement_below_the_range_moves_the_line_by_its_lever() {
    let record = run_unwatched(&ramp_to_40_newtons(Calibration {
        displacement_uncertainty: 0.02,
        displacement_calibrated: Some(Interval {
            low: 0.015,
            high: 1e6,
        }),
        ..Calibration::default()
    }));
    let found = from(&record, "stiffness", Source::DisplacementBelowRange(0));
    // −K·Σ(x − x̄)·δ/Σ(x − x̄)², to the second order in δ.
    assert!(
        (found - 1000.0 * 0.015 * 1e-4 / 500e-6).abs() < 1e-3,
        "{found}"
    );
}

/// A range that begins at zero, and one that begins below the smallest reading, leave the factor alone.
#[test]
fn readings_inside_the_range_have_the_factor_alone() {
    for low in [0.0, 9.0] {
        let record = run_unwatched(&ramp_to_40_newtons(Calibration {
            force_uncertainty: 0.01,
            force_calibrated: Some(Interval { low, high: 1e6 }),
            ..Calibration::default()
        }));
        for name in ["stiffness", "intercept_force"] {
            assert_eq!(from(&record, name, Source::ForceBelowRange(0)), 0.0);
        }
    }
}

/// Noise gives the reading before the first step either sign. It cannot be distinguished from zero, so that only the first force is off:
/// by 1 % of 15 N − F₁, which σ of 0.05 N changes by 1 % of itself, 0.05 N/m, here four times.
#[test]
fn noise_about_zero_does_not_decide_the_error_of_a_secant() {
    for seed in 1..=10 {
        let mut plan = ramp_to_40_newtons(Calibration {
            force_uncertainty: 0.01,
            force_calibrated: Some(Interval {
                low: 15.0,
                high: 1e6,
            }),
            ..Calibration::default()
        });
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 0.05,
            seed,
            ..VirtualLink::default()
        });
        let record = run_unwatched(&plan);
        let found = from(&record, "secant_stiffness", Source::ForceBelowRange(0));
        assert!((found - 5.0).abs() < 0.2, "seed {seed}: {found}");
    }
}

/// ∫F dx up to the peak X is the energy E. Forces below a = 20 N that are too large by u·(a − F) add u·a²/2K, so that dX = −u·a²/(2K·KX).
/// Displacements below a = 60 mm that are too large by u·(a − x) show a force that is K·u·(a − x) smaller: dX = u·a²/2X. The first reading,
/// at zero, has no error: half of a step of 0.9 mm, of 60 mm, twice.
#[test]
fn forces_and_displacements_below_the_range_change_the_work_of_an_impact() {
    let mut impact = plan(sticking(1e-3));
    impact.rig.calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.01,
        force_calibrated: Some(Interval {
            low: 20.0,
            high: 1e6,
        }),
        displacement_calibrated: Some(Interval {
            low: 0.06,
            high: 1e6,
        }),
        ..Calibration::default()
    };
    let record = run_unwatched(&impact);
    let peak = STRIKER / (STIFFNESS * (MASS + STRIKER)).sqrt();
    for (source, by_hand) in [
        (
            Source::ForceBelowRange(0),
            -0.01 * 20.0 * 20.0 / (2.0 * STIFFNESS * STIFFNESS * peak),
        ),
        (
            Source::DisplacementBelowRange(0),
            0.01 * 0.06 * 0.06 / (2.0 * peak),
        ),
    ] {
        let found = from(&record, "max_displacement", source);
        assert!(
            (found / by_hand - 1.0).abs() < 0.03,
            "{source:?}: {found}, by hand {by_hand}"
        );
    }
}
