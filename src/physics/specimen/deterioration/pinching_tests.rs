//! Pinched hysteresis with cyclic deterioration: each mode by hand, no deterioration without a stated capacity, and never more dissipated
//! energy than the capacity.

use super::pinching::PinchedHysteresis;
use super::pinching::tests::PLAN;
use crate::specimen::tests::energy_along;
use crate::specimen::{Capping, Deterioration, Pinching, RestoringForce};

/// Infinite capacities.
const NO_WEAR: Deterioration = Deterioration {
    strength: f64::INFINITY,
    capping: f64::INFINITY,
    unloading: f64::INFINITY,
    reloading: f64::INFINITY,
    exponent: 1.0,
    residual: 0.1,
};

const TIRES: Pinching = Pinching {
    displacement_factor: 1.0,
    deterioration: Some(Deterioration {
        strength: 40.0,
        ..NO_WEAR
    }),
    ..PLAN
};

/// Perfectly plastic to 5 mm and back to zero force: 1000·(5 − 1) mN·m = 4 J of γ F_y x_y = 40 J. β = 4/(40 − 4): in the opposite
/// direction it yields at 8/9 of 1 kN. There to −3 mm from −1 mm, and so on.
#[test]
fn strength_is_lost_by_the_energy_of_each_excursion() {
    let mut model = PinchedHysteresis::new(TIRES);
    model.move_to(0.005);
    assert!((model.move_to(0.004)).abs() < 1e-9);
    let weaker = 1000.0 * (1.0 - 4.0 / 36.0);
    // Break point at zero displacement: 0.4 of the force at 4/5 of the distance.
    assert!((model.move_to(0.0) + 0.4 * weaker * 4.0 / 5.0).abs() < 1e-9);
    assert!(
        (model.move_to(-0.001) + weaker).abs() < 1e-9
            && (model.move_to(-0.003) + weaker).abs() < 1e-9
    );
    let at_break = 0.32 * weaker;
    let absorbed = 1e-3 * (0.5 * 4.0 * at_break + 0.5 * (at_break + weaker) + 2.0 * weaker)
        - 0.5 * weaker * weaker / 1e6;
    model.move_to(-0.003 + weaker / 1e6);
    model.move_to(0.005);
    let forwards = 1000.0 * (1.0 - absorbed / (40.0 - 4.0 - absorbed));
    let found = model.move_to(0.006);
    assert!(
        (found - forwards).abs() < 1e-9,
        "{found} N is not {forwards} N"
    );
}

/// Elastic cycles dissipate nothing and lose no strength. Plastic cycles lose strength at every reversal, never gain it, and never fall
/// below the residual. The absorbed energy equals ∫R dX, with trapezoids fine enough for a negligible error.
#[test]
fn deterioration_is_monotone_and_its_energy_is_the_work_done() {
    let mut model = PinchedHysteresis::new(TIRES);
    for _ in 0..5 {
        model.move_to(0.0009);
        model.move_to(-0.0009);
    }
    assert_eq!(model.degradation.strength, [1.0; 2]);
    model.move_to(0.0);
    let (mut work, mut strength) = (0.0, model.degradation.strength);
    for cycle in 1..=30 {
        let amplitude = 1e-3 * (2.0 + 0.1 * f64::from(cycle));
        work += energy_along(&mut model, 0.0, &[amplitude, -amplitude, 0.0], 1e-5);
        assert!(
            model
                .degradation
                .strength
                .iter()
                .zip(strength)
                .all(|(now, before)| *now <= before && *now >= 0.1),
            "{:?}",
            model.degradation.strength
        );
        strength = model.degradation.strength;
    }
    assert_eq!(strength, [0.1; 2], "worn out");
    let counted = model.degradation.energy[0] + model.degradation.energy[1];
    assert!(
        (counted / work - 1.0).abs() < 1e-4,
        "{counted} J are counted, {work} J were done"
    );
}

const fn degraded(rule: Deterioration) -> Pinching {
    Pinching {
        deterioration: Some(rule),
        ..TIRES
    }
}

/// To 5 mm it has absorbed 4.5 J, of which 0.5 J are released: β = 4/(40 − 4). It unloads with 8/9 of K, to 1.125 mm before. A return
/// before the force is zero and a second reversal there cost nothing more; 1 mm farther costs its 1 J.
#[test]
fn the_unloading_stiffness_falls_by_what_it_took_until_it_turned() {
    let mut model = PinchedHysteresis::new(degraded(Deterioration {
        unloading: 40.0,
        ..NO_WEAR
    }));
    model.move_to(0.005);
    let soft = 1e6 * (1.0 - 4.0 / 36.0);
    assert!((model.move_to(0.0045) - (1000.0 - 5e-4 * soft)).abs() < 1e-9);
    assert!(
        (model.move_to(0.005) - 1000.0).abs() < 1e-9,
        "back up the same line"
    );
    assert!(
        (model.move_to(0.0045) - (1000.0 - 5e-4 * soft)).abs() < 1e-9,
        "and down it again"
    );
    model.move_to(0.006);
    // It has now absorbed 5.5 J in all; the old unloading branch would release F²/2K_u.
    let stored = 0.5 * 1e6 / soft;
    let charged = 5.5 - stored - 4.0;
    let softer = soft * (1.0 - charged / (40.0 - 5.5 + stored));
    assert!((model.move_to(0.0055) - (1000.0 - 5e-4 * softer)).abs() < 1e-9);
    model.move_to(0.006 - 1000.0 / softer);
    assert!(
        (model.move_to(-0.004) + 1000.0).abs() < 1e-9,
        "its strength is whole"
    );
    let backwards = model.move_to(-0.0038);
    assert!(
        model.degradation.unloading * 1e6 < softer,
        "both sides soften"
    );
    assert!((backwards + (1000.0 - 2e-4 * model.degradation.unloading * 1e6)).abs() < 1e-9);
}

/// 4 J of 40 J until the force is zero at 4 mm: the opposite peak is at −(1 + 1/9) mm, with the break point at zero displacement.
#[test]
fn the_peak_that_it_reloads_to_moves_out() {
    let mut model = PinchedHysteresis::new(degraded(Deterioration {
        reloading: 40.0,
        ..NO_WEAR
    }));
    model.move_to(0.005);
    model.move_to(0.004);
    let peak = 1e-3 * (1.0 + 4.0 / 36.0);
    let at_break = 400.0 * 0.004 / (peak + 0.004);
    assert!((model.move_to(0.0) + at_break).abs() < 1e-9);
    let share = 0.001 / peak;
    assert!((model.move_to(-0.001) + at_break + share * (1000.0 - at_break)).abs() < 1e-9);
    assert!(
        (model.move_to(-peak) + 1000.0).abs() < 1e-9
            && (model.move_to(-0.004) + 1000.0).abs() < 1e-9
    );
}

const CAPPED: Pinching = Pinching {
    capping: Some(Capping {
        displacement: 0.003,
        slope: 0.1,
        residual: 0.2,
    }),
    displacement_factor: 1.0,
    ..PLAN
};

/// Capped at 3 mm, it falls by 100 N per mm to 200 N at 11 mm: 0.5 + 2 + 4.8 + 1.8 J up to 20 mm, in one move.
#[test]
fn a_capped_backbone_falls_to_its_residual() {
    for moves in [1, 7, 1000] {
        let mut model = PinchedHysteresis::new(CAPPED);
        for part in 1..=moves {
            model.move_to(0.02 * f64::from(part) / f64::from(moves));
        }
        assert!(
            (model.degradation.energy[1] - 9.1).abs() < 1e-9,
            "{} J",
            model.degradation.energy[1]
        );
    }
    let mut model = PinchedHysteresis::new(CAPPED);
    for (displacement, force) in [
        (0.003, 1000.0),
        (0.005, 800.0),
        (0.0045, 300.0),
        (0.005, 800.0),
        (0.008, 500.0),
        (0.012, 200.0),
    ] {
        let found = model.move_to(displacement);
        assert!(
            (found - force).abs() < 1e-9,
            "{displacement} m: {found} N is not {force} N"
        );
    }
}

/// To 5 mm and back to zero force it absorbs 4.3 J − 0.32 J. The opposite falling line, 1300 N at zero displacement, moves in by β of it.
#[test]
fn the_post_capping_line_moves_in() {
    let mut model = PinchedHysteresis::new(Pinching {
        deterioration: Some(Deterioration {
            capping: 40.0,
            ..NO_WEAR
        }),
        ..CAPPED
    });
    model.move_to(0.005);
    model.move_to(0.0042);
    let meets = 1300.0 * (1.0 - 3.98 / (40.0 - 3.98));
    assert!(
        (model.move_to(-0.0015) + 1000.0).abs() < 1e-9,
        "before the line the strength is whole"
    );
    assert!((model.move_to(-0.003) + (meets - 300.0)).abs() < 1e-9);
    assert!(
        (model.move_to(-0.02) + 200.0).abs() < 1e-9,
        "and the residual stays"
    );
}

const REVERSALS: [f64; 12] = [
    0.003, -0.002, 0.006, 0.001, 0.0055, -0.007, -0.004, -0.0065, 0.009, -0.012, 0.02, 0.0,
];

/// Infinite capacities give the undeteriorated law, bit-identical, also if it is capped.
#[test]
fn without_a_capacity_nothing_wears() {
    for plan in [
        PLAN,
        CAPPED,
        Pinching {
            unloading_exponent: 1.0,
            post_yield_ratio: 0.3,
            ..PLAN
        },
    ] {
        let mut whole = PinchedHysteresis::new(plan);
        let mut unworn = PinchedHysteresis::new(Pinching {
            deterioration: Some(NO_WEAR),
            ..plan
        });
        for direction in REVERSALS {
            assert_eq!(
                whole.move_to(direction).to_bits(),
                unworn.move_to(direction).to_bits(),
                "{plan:?} at {direction} m"
            );
        }
        assert_eq!(unworn.degradation.unloading, 1.0);
    }
}

/// With several modes together: the remaining strength never grows, and no cycle releases more than it absorbed. Once the whole capacity
/// is used, and not before, the strength is down to its residual. If it reloads ever farther, it never absorbs that much.
#[test]
fn modes_together_wear_it_out_within_its_capacity() {
    // 1 N · 1 m is the unit: 60 J in all.
    let capacity = 60.0;
    for reloading in [f64::INFINITY, capacity] {
        let rule = Deterioration {
            strength: capacity,
            capping: capacity,
            unloading: capacity,
            reloading,
            ..NO_WEAR
        };
        let mut model = PinchedHysteresis::new(Pinching {
            deterioration: Some(rule),
            ..CAPPED
        });
        let (mut work, mut before) = (0.0, model.degradation);
        for cycle in 1..=60 {
            let amplitude = 1e-3 * (2.0 + 0.3 * f64::from(cycle));
            let absorbed = energy_along(&mut model, 0.0, &[amplitude, -amplitude, 0.0], 1e-5);
            assert!(absorbed >= 0.0, "cycle {cycle} gave back {absorbed} J");
            work += absorbed;
            let now = model.degradation;
            let pairs = now
                .strength
                .iter()
                .zip(before.strength)
                .chain(now.capping.iter().zip(before.capping));
            assert!(
                pairs
                    .chain([(&now.unloading, before.unloading)])
                    .all(|(now, before)| *now <= before),
                "{now:?}"
            );
            assert!(
                now.energy[0] < capacity || now.strength.contains(&0.1),
                "{now:?}"
            );
            before = now;
        }
        if reloading.is_finite() {
            assert!(
                model.degradation.energy[0] < capacity
                    && model.degradation.strength.iter().all(|left| *left < 0.3),
                "{:?}",
                model.degradation
            );
        } else {
            assert_eq!(model.degradation.strength, [0.1; 2], "worn out");
            assert!(
                model.degradation.capping.iter().all(|left| *left < 0.1),
                "{:?}",
                model.degradation.capping
            );
        }
        let counted = model.degradation.energy[0] + model.degradation.energy[1];
        assert!(
            (counted / work - 1.0).abs() < 1e-3,
            "{counted} J are counted, {work} J were done"
        );
    }
}
