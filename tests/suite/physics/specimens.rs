//! Properties of every specimen model on any path: finite forces within the capacity, and no more energy released than absorbed. A large
//! move ends at the same force as many small ones.

use proptest::prelude::*;
use psd_physics::specimen::{RestoringForce, SpecimenModel};
use psd_plan::{Behaviour, Bolted, Breaks, Capping, Deterioration, Pinching, Table, Unloading};

/// Stiffness 1 N/m to 3 N/m and yield near 1 m: the models have no absolute scale.
fn simple() -> impl Strategy<Value = Behaviour> {
    let stiffness = || 1.0..3.0_f64;
    let force = || 0.5..2.0_f64;
    let post_yield_ratio = || prop_oneof![Just(0.0), 0.0..0.5_f64];
    let capacity = || prop_oneof![Just(f64::INFINITY), 1.0..60.0_f64];
    let tires = (
        prop::array::uniform4(capacity()),
        0.5..2.0_f64,
        0.01..0.5_f64,
    )
        .prop_map(
            |([strength, capping, unloading, reloading], exponent, residual)| Deterioration {
                strength,
                capping,
                unloading,
                reloading,
                exponent,
                residual,
            },
        );
    // Boxed, like all deeply nested values; otherwise its tree is on the stack of a test.
    let tires = tires.boxed();
    // Beyond any yield point, which is at most at 2 m.
    let capped =
        (2.0..6.0_f64, 0.01..0.5_f64, 0.01..0.5_f64).prop_map(|(displacement, slope, residual)| {
            Capping {
                displacement,
                slope,
                residual,
            }
        });
    let capped = capped.boxed();
    let falls = (prop::option::of(tires.clone()), prop::option::of(capped));
    let shape = (0.0..=1.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64);
    let wearing = (stiffness(), force(), post_yield_ratio(), tires.clone()).prop_map(
        |(stiffness, yield_force, post_yield_ratio, deterioration)| {
            Behaviour::DeterioratingBilinear {
                stiffness,
                yield_force,
                post_yield_ratio,
                deterioration,
            }
        },
    );
    let pinching = (stiffness(), force(), post_yield_ratio(), shape, falls).prop_map(
        |(
            stiffness,
            yield_force,
            post_yield_ratio,
            (force_factor, displacement_factor, unloading_exponent),
            (tires, capping),
        )| {
            // One element never loses its strength, whatever deteriorates the others.
            let residual = |capping: Capping| Capping {
                residual: tires.map_or(capping.residual, |rule| rule.residual),
                ..capping
            };
            Behaviour::Pinching(Pinching {
                stiffness,
                yield_force,
                post_yield_ratio,
                force_factor,
                displacement_factor,
                unloading_exponent,
                capping: capping.map(residual),
                deterioration: tires,
            })
        },
    );
    let pinching = pinching.boxed();
    prop_oneof![
        stiffness().prop_map(|stiffness| Behaviour::Elastic { stiffness }),
        (stiffness(), force(), post_yield_ratio()).prop_map(
            |(stiffness, yield_force, post_yield_ratio)| {
                Behaviour::Bilinear {
                    stiffness,
                    yield_force,
                    post_yield_ratio,
                }
            }
        ),
        (0.2..1.0_f64, 0.1..2.0_f64, 0.0..0.9_f64, 0.0..0.9_f64).prop_map(
            |(x, more, soft, softer)| {
                let corners = vec![[x, 2.0 * x], [x + more, 2.0 * x + 2.0 * soft * more]];
                let last = [x + more + 1.0, corners[1][1] + 2.0 * soft * softer];
                Behaviour::Multilinear {
                    corners: [corners, vec![last]].concat(),
                }
            }
        ),
        (
            stiffness(),
            force(),
            post_yield_ratio(),
            1.0..12.0_f64,
            0.5..=1.0_f64
        )
            .prop_map(
                |(stiffness, yield_force, post_yield_ratio, sharpness, beta)| {
                    Behaviour::BoucWen {
                        stiffness,
                        yield_force,
                        post_yield_ratio,
                        sharpness,
                        beta,
                    }
                }
            ),
        pinching,
        wearing,
        (stiffness(), force(), post_yield_ratio()).prop_map(
            |(stiffness, half_displacement, residual)| {
                Behaviour::Degrading {
                    stiffness,
                    half_displacement,
                    residual,
                }
            }
        ),
        (
            stiffness(),
            force(),
            0.0..1.0_f64,
            prop_oneof![Just(0.0), 0.1..0.5_f64]
        )
            .prop_map(|(stiffness, bearing_force, clearance, slip_force)| {
                Behaviour::Bolted(Bolted {
                    stiffness,
                    bearing_force,
                    clearance,
                    slip_force,
                })
            }),
        table(),
    ]
}

/// Measured points of any shape: toes, yield points, decreasing branches.
fn table() -> impl Strategy<Value = Behaviour> {
    let side = || prop::collection::vec((0.1..1.0_f64, 0.0..2.0_f64), 1..5);
    let unloading = prop_oneof![
        Just(Unloading::InitialStiffness),
        Just(Unloading::AlongTheCurve)
    ];
    (side(), side(), unloading, 0.5..1.5_f64).prop_filter_map(
        "a table has a force",
        |(ahead, behind, unloading, last)| {
            let rising = |side: Vec<(f64, f64)>, direction: f64| {
                let mut at = 0.0;
                let mut points: Vec<[f64; 2]> = Vec::new();
                for (step, force) in side {
                    at += step;
                    points.push([direction * at, direction * force]);
                }
                points.push([direction * (at + 1.0), direction * last]);
                points
            };
            let mut points = rising(behind, -1.0);
            points.reverse();
            points.push([0.0, 0.0]);
            points.extend(rising(ahead, 1.0));
            Some(Behaviour::Table(Table {
                file: "points.csv".to_owned(),
                points,
                unloading,
                scale: 1.0,
            }))
        },
    )
}

fn any() -> impl Strategy<Value = Behaviour> {
    let pair = || (simple(), simple());
    prop_oneof![
        4 => simple(),
        1 => pair().prop_filter_map("in series nothing falls", |(a, b)| {
            (a.never_falls() && b.never_falls()).then(|| Behaviour::Series(vec![a, b]))
        }),
        1 => pair().prop_map(|(a, b)| Behaviour::Parallel(vec![a, b])),
        1 => (simple(), 0.5..3.0_f64).prop_map(|(of, at)| Behaviour::Fracture { of: Box::new(of), at: Breaks::Displacement(at) }),
    ]
}

/// Reversal points of a path from 0.
fn turns() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-4.0..4.0_f64, 1..8)
}

/// Apparent release of energy, by trapezia: displacement \[m\], energy \[J\], energy exchanged \[J\].
fn given_back(behaviour: &Behaviour, turns: &[f64], pieces: u32) -> Option<[f64; 3]> {
    let mut model = SpecimenModel::new(behaviour);
    let (mut position, mut force, mut energy, mut scale) = (0.0, model.move_to(0.0), 0.0, 0.0);
    displacements(turns, pieces).into_iter().find_map(|to| {
        let next = model.move_to(to);
        energy += 0.5 * (force + next) * (to - position);
        scale += (0.5 * (force + next) * (to - position)).abs();
        (position, force) = (to, next);
        (energy < -2e-3 * scale - 1e-12).then_some([to, energy, scale])
    })
}

/// Every displacement of a path whose legs are divided into `pieces`.
fn displacements(turns: &[f64], pieces: u32) -> Vec<f64> {
    let mut from = 0.0;
    let mut all = Vec::new();
    for to in turns {
        all.extend((1..=pieces).map(|piece| {
            if piece == pieces {
                *to
            } else {
                from + (to - from) * f64::from(piece) / f64::from(pieces)
            }
        }));
        from = *to;
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_number_is_lost_and_no_force_is_beyond_what_it_carries(behaviour in any(), turns in turns()) {
        let mut model = SpecimenModel::new(&behaviour);
        let bound = behaviour.capacity() * (1.0 + 1e-7);
        prop_assert!(model.initial_stiffness() > 0.0);
        prop_assert!((model.initial_stiffness() / behaviour.initial_stiffness() - 1.0).abs() < 1e-12);
        prop_assert!(model.move_to(0.0).abs() < 1e-12);
        for position in turns {
            let force = model.move_to(position);
            prop_assert!(force.is_finite());
            prop_assert!(force.abs() <= bound, "{force} N at {position} m, it carries {bound} N");
        }
    }

    /// The stiffness bound of the stability check is an upper bound of every slope, and not too high: some path reaches nine tenths of it
    /// in `a_stiffest_slope_is_reached`.
    #[test]
    fn no_slope_is_beyond_the_largest(behaviour in any(), turns in turns()) {
        let mut model = SpecimenModel::new(&behaviour);
        let (mut position, mut force) = (0.0, model.move_to(0.0));
        let bound = behaviour.largest_stiffness().expect("every model here has a bound");
        prop_assert!(bound >= behaviour.initial_stiffness() * (1.0 - 1e-12));
        for to in displacements(&turns, 40) {
            let next = model.move_to(to);
            let most = bound * (to - position).abs() * (1.0 + 1e-6) + 1e-7;
            prop_assert!((next - force) * (to - position).signum() <= most, "{} at {to}, at most {bound}", (next - force) / (to - position));
            (position, force) = (to, next);
        }
    }

    /// From the initial state, on any path: ∫R dX ≥ 0. A closed cycle from there thus dissipates energy too. The apparent release of
    /// trapezoids across a breakpoint decreases with the segment length.
    #[test]
    fn nothing_gives_back_more_energy_than_it_took(behaviour in any(), turns in turns()) {
        let (mut given, mut pieces) = (Some([0.0; 3]), 300);
        while given.is_some() && pieces <= 30_000 {
            given = given_back(&behaviour, &turns, pieces);
            pieces *= 10;
        }
        prop_assert!(given.is_none(), "at, energy, to and fro: {given:?}");
    }

    /// Exact models to rounding; Bouc–Wen to its stated 1e-7 of a yield force, more if a solver in series depends on it.
    #[test]
    fn large_moves_end_where_small_ones_do(behaviour in any(), turns in turns()) {
        let (mut large, mut small) = (SpecimenModel::new(&behaviour), SpecimenModel::new(&behaviour));
        let mut small_displacements = displacements(&turns, 37).into_iter();
        for to in &turns {
            let by_large = large.move_to(*to);
            let mut by_small = 0.0;
            for position in small_displacements.by_ref().take(37) {
                by_small = small.move_to(position);
            }
            prop_assert!((by_large - by_small).abs() < 1e-6, "{by_large} N is not {by_small} N at {to} m");
        }
    }

    /// A low-level check run uses a specimen with the measured stiffness: every force is scaled by the same factor, at every
    /// displacement.
    #[test]
    fn a_scaled_behaviour_is_the_same_times_a_factor(behaviour in any(), turns in turns(), factor in 0.5..2.0_f64) {
        let (mut model, mut scaled) = (SpecimenModel::new(&behaviour), SpecimenModel::new(&behaviour.scaled(factor)));
        for position in turns {
            let (force, times) = (model.move_to(position), scaled.move_to(position));
            prop_assert!((times - factor * force).abs() < 1e-8 * (1.0 + force.abs()), "{times} N is not {factor} × {force} N");
        }
    }
}

/// Two parts in series that yield at one force can share a displacement in many combinations. A large move selects the one of small
/// moves. Examples: at zero force, a table between its toes and a spring that has pinched; at the yield force, two equal parts.
#[test]
fn parts_that_yield_at_one_force_share_a_large_move_as_small_ones() {
    let toes = vec![
        [-1.1, -0.5],
        [-0.1, -0.0],
        [0.0, 0.0],
        [0.1, 0.0],
        [1.1, 0.5],
    ];
    let table = |unloading| {
        Behaviour::Table(Table {
            file: "points.csv".to_owned(),
            points: toes.clone(),
            unloading,
            scale: 1.0,
        })
    };
    let pinching = Behaviour::Pinching(Pinching {
        stiffness: 1.948_780_769_769_375_6,
        yield_force: 0.5,
        post_yield_ratio: 0.0,
        force_factor: 0.0,
        displacement_factor: 0.0,
        unloading_exponent: 0.0,
        capping: None,
        deterioration: None,
    });
    let yields = || Behaviour::Bilinear {
        stiffness: 2.0,
        yield_force: 0.5,
        post_yield_ratio: 0.0,
    };
    let turns = [-3.988_847_520_979_166_3, 0.0, -0.633_495_342_963_283];
    for (first, second) in [
        (table(Unloading::InitialStiffness), pinching.clone()),
        (pinching, table(Unloading::AlongTheCurve)),
        (yields(), yields()),
    ] {
        for parts in [vec![first.clone(), second.clone()], vec![second, first]] {
            let behaviour = Behaviour::Series(parts);
            let (mut large, mut small) = (
                SpecimenModel::new(&behaviour),
                SpecimenModel::new(&behaviour),
            );
            let mut small_displacements = displacements(&turns, 37).into_iter();
            for to in turns {
                let by_small = small_displacements
                    .by_ref()
                    .take(37)
                    .map(|position| small.move_to(position))
                    .last()
                    .unwrap();
                let by_large = large.move_to(to);
                assert!(
                    (by_large - by_small).abs() < 1e-12,
                    "{behaviour:?}: {by_large} N is not {by_small} N at {to} m"
                );
            }
        }
    }
}

/// A joint bears before its faces slip, and a Bouc–Wen spring with β = 1 unloads: both at twice the initial stiffness.
#[test]
fn a_stiffest_slope_is_reached() {
    let bolted = Behaviour::Bolted(Bolted {
        stiffness: 1e6,
        bearing_force: 1e4,
        clearance: 1e-4,
        slip_force: 1e3,
    });
    let bouc_wen = Behaviour::BoucWen {
        stiffness: 1e6,
        yield_force: 1e3,
        post_yield_ratio: 0.0,
        sharpness: 1.0,
        beta: 1.0,
    };
    for (behaviour, from, to) in [(bolted, 1.5e-4, 1.6e-4), (bouc_wen, 1e-2, 1e-2 - 1e-6)] {
        let mut model = SpecimenModel::new(&behaviour);
        let before = model.move_to(from);
        let slope = (model.move_to(to) - before) / (to - from);
        assert!((slope / 2e6 - 1.0).abs() < 1e-3, "{slope}");
        assert_eq!(
            (behaviour.initial_stiffness(), behaviour.largest_stiffness()),
            (1e6, Some(2e6))
        );
    }
}
