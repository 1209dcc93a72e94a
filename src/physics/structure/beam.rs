//! Beams by geometry: stiffness at the struck section and the mass that moves with it in the first mode.

/// A beam by geometry: its stiffness at the struck section \[N/m\], and the data from which it follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    pub stiffness: f64,
    /// \[m\]
    pub length: f64,
    /// \[Pa\]
    pub youngs_modulus: f64,
    /// \[m⁴\]
    pub second_moment: f64,
    pub ends: Ends,
    /// Shear stiffness κGA \[N\]. None: a slender beam.
    pub shear: Option<f64>,
    /// Distance of the struck section from the first support \[m\]. None: the tip of a cantilever, the middle of the others.
    pub at: Option<f64>,
    /// q·A·L \[kg\], if the specimen states density, area and length.
    pub own_mass: Option<f64>,
}

/// The supports of a beam (3EI/L³, 48EI/L³, 192EI/L³, (192EI/L³)(r+2)/(r+8)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    Cantilever,
    SimplySupported,
    BuiltIn,
    /// Rotational stiffness of each end \[N·m/rad\].
    PartlyBuiltIn {
        rotational_stiffness: f64,
    },
}

/// Masses of the equivalent single degree of freedom of a beam or portal \[kg\]. They have the same kinetic energy: M = ∫m φ² ds, with a
/// shape φ that is 1 where the load does work. The load then needs no factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentMasses {
    /// φ is the elastic deflection under the static load: before any hinge forms.
    pub elastic: f64,
    /// φ is the shape of the governing mechanism with rigid links between the hinges: after the last hinge formed. None without a
    /// mechanism.
    pub plastic: Option<f64>,
    /// Half of each member at either end (for the beam: half at midspan and half at the corners), moved elastically: Melo et al. 2006,
    /// Fig. 5. There a swaying frame has the mass of its beam and of one column, and a beam half its own.
    pub lumped: f64,
    /// The total mass that moves or bends.
    pub whole: f64,
}

/// A uniform beam between its supports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// L \[m\]
    pub length: f64,
    /// EI \[N·m²\]
    pub bending: f64,
}

/// Stiffness of a uniform beam at the struck section (tip of a cantilever, middle of the others) \[N/m\]. Partly built-in ends, with `r =
/// k_θ L / EI` at each, range from simply supported (r = 0) to built-in (r = ∞).
///
/// `shear` is κGA \[N\] of Timoshenko's beam. The shear force is P along a cantilever and ±P/2 along the halves of the others, for any
/// support of their ends. The shear strain P/κGA therefore adds PL/κGA to the tip and (P/2)(L/2)/κGA = PL/4κGA to midspan. Bending does
/// not change: moments of the symmetric beams follow from rotations of the sections alone.
#[must_use]
pub fn stiffness(span: Span, ends: Ends, shear: Option<f64>) -> f64 {
    let Span { length, bending } = span;
    let unit = bending / (length * length * length);
    let by_bending = match ends {
        Ends::Cantilever => 3.0 * unit,
        Ends::SimplySupported => 48.0 * unit,
        Ends::BuiltIn => 192.0 * unit,
        Ends::PartlyBuiltIn {
            rotational_stiffness,
        } => {
            let ratio = rotational_stiffness * length / bending;
            if ratio.is_infinite() {
                192.0 * unit
            } else {
                192.0 * unit * (ratio + 2.0) / (ratio + 8.0)
            }
        }
    };
    let part = if ends == Ends::Cantilever { 1.0 } else { 4.0 };
    shear.map_or(by_bending, |shear| {
        1.0 / (1.0 / by_bending + length / (part * shear))
    })
}

/// The ends of a span by `r = k_θ L / EI`, as the fraction `c = r/(1 + r)`, which is 0 if pinned and 1 if built in.
fn rotational_fraction(ends: Ends, span: Span) -> f64 {
    match ends {
        Ends::Cantilever | Ends::SimplySupported => 0.0,
        Ends::BuiltIn => 1.0,
        Ends::PartlyBuiltIn {
            rotational_stiffness,
        } => {
            let ratio = rotational_stiffness * span.length / span.bending;
            if ratio.is_infinite() {
                1.0
            } else {
                ratio / (1.0 + ratio)
            }
        }
    }
}

/// What the end moments of a span depend on: `c = r/(1 + r)` of its ends, and φ = EI/κGAL².
#[derive(Clone, Copy)]
struct EndsOfSpan {
    fraction: f64,
    shear: f64,
}

/// End moments of a span of L = EI = 1 under a unit load at `a`, as the force method gives them. The ends of the simple beam rotate by
/// `θ₁ = ab(1 + b)/6` and `θ₂ = ab(1 + a)/6`, b = 1 − a. A unit moment rotates its end by 1/3 + φ and the other by 1/6 − φ; φ = EI/κGAL² of
/// Timoshenko's beam. With springs r at the ends, `(F + I/r) M = θ`; times `c = r/(1 + r)`.
fn end_moments(a: f64, ends: EndsOfSpan) -> ([f64; 2], [f64; 2]) {
    let EndsOfSpan { fraction, shear } = ends;
    let b = 1.0 - a;
    let rotations = [a * b * (1.0 + b) / 6.0, a * b * (1.0 + a) / 6.0];
    let own = fraction * (1.0 / 3.0 + shear) + (1.0 - fraction);
    let other = fraction * (1.0 / 6.0 - shear);
    let determinant = own * own - other * other;
    let [one, two] = rotations.map(|rotation| fraction * rotation);
    let moments = [
        (own * one - other * two) / determinant,
        (own * two - other * one) / determinant,
    ];
    (moments, rotations)
}

/// Stiffness of a uniform beam at the distance `at` from its first support, or from the fixed end of a cantilever \[N/m\]. The deflection
/// under a unit load there is a³/3EI + a/κGA of a cantilever, and a²b²/3EIL + ab/κGAL − θ·M of a span with the end moments M, whose
/// work θ·M follows from reciprocity. Simply supported: 3EIL/a²b²; built in, without shear: 3EIL³/a³b³.
#[must_use]
pub fn stiffness_at(span: Span, ends: Ends, shear: Option<f64>, at: f64) -> f64 {
    let Span { length, bending } = span;
    let a = at / length;
    let shear = shear.map_or(0.0, |shear| bending / (shear * length * length));
    let deflection = if ends == Ends::Cantilever {
        a.powi(3) / 3.0 + a * shear
    } else {
        let b = 1.0 - a;
        let (moments, rotations) = end_moments(
            a,
            EndsOfSpan {
                fraction: rotational_fraction(ends, span),
                shear,
            },
        );
        let relieved = moments[0] * rotations[0] + moments[1] * rotations[1];
        (a * b).powi(2) / 3.0 + a * b * shear - relieved
    };
    bending / (length.powi(3) * deflection)
}

/// Ends of fixity factor `p = 1/(1 + 3EI/(k_θ L))`, 0 pinned, 1 built in: `k_θ = 3EI/L · p/(1 − p)`.
#[must_use]
pub fn ends_of_fixity(factor: f64, span: Span) -> Ends {
    if factor >= 1.0 {
        Ends::BuiltIn
    } else if factor <= 0.0 {
        Ends::SimplySupported
    } else {
        Ends::PartlyBuiltIn {
            rotational_stiffness: 3.0 * span.bending / span.length * factor / (1.0 - factor),
        }
    }
}

/// Equivalent mass over the beam's own, with the static deflection by bending as the shape (the paper's is ½).
#[must_use]
pub fn first_mode_mass_factor(beam: &Beam) -> f64 {
    if let Some(at) = beam.at {
        return mass_factor_at(beam, at / beam.length);
    }
    match beam.ends {
        Ends::Cantilever => 33.0 / 140.0,
        Ends::SimplySupported => 17.0 / 35.0,
        Ends::BuiltIn => 13.0 / 35.0,
        Ends::PartlyBuiltIn {
            rotational_stiffness,
        } => partly_built_in_mass_factor(
            rotational_stiffness * beam.length / (beam.youngs_modulus * beam.second_moment),
        ),
    }
}

/// ∫φ² over the length, φ the static deflection by bending under a load at `a` (L = 1), 1 at `a`. A cantilever is straight beyond the load: 33a/140 +
/// ((3 − a)³ − 8a³)/36a². A span has a cubic on either side of the load, so that four points of Gauss are exact.
fn mass_factor_at(beam: &Beam, a: f64) -> f64 {
    if beam.ends == Ends::Cantilever {
        return 33.0 / 140.0 * a + ((3.0 - a).powi(3) - 8.0 * a.powi(3)) / (36.0 * a * a);
    }
    let span = Span {
        length: beam.length,
        bending: beam.youngs_modulus * beam.second_moment,
    };
    let (moments, _) = end_moments(
        a,
        EndsOfSpan {
            fraction: rotational_fraction(beam.ends, span),
            shear: 0.0,
        },
    );
    // From the left support for x ≤ a; from the right one, with a and b exchanged, beyond.
    let deflection = |x: f64| {
        let load = if x <= a {
            let b = 1.0 - a;
            b * x * (1.0 - b * b - x * x)
        } else {
            let y = 1.0 - x;
            a * y * (1.0 - a * a - y * y)
        };
        let by_moments = x * (1.0 - x) * (moments[0] * (2.0 - x) + moments[1] * (1.0 + x));
        (load - by_moments) / 6.0
    };
    let squared = |from: f64, to: f64| {
        let (middle, half) = (f64::midpoint(from, to), (to - from) / 2.0);
        let sum: f64 = GAUSS
            .iter()
            .map(|(node, weight)| {
                let both = deflection(middle - half * node).powi(2)
                    + deflection(middle + half * node).powi(2);
                weight * both
            })
            .sum();
        half * sum
    };
    (squared(0.0, a) + squared(a, 1.0)) / deflection(a).powi(2)
}

/// Nodes and weights of Gauss with four points, exact to the seventh degree: Abramowitz and Stegun, table 25.4.
const GAUSS: [(f64, f64); 2] = [
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
];

/// The lumped mass over the beam's own: half of each part at the struck section; half of the part beyond the load of a cantilever at its
/// tip, which moves by (3 − a)/2a.
fn lumped_factor(beam: &Beam) -> f64 {
    match (beam.ends, beam.at) {
        (Ends::Cantilever, Some(at)) => {
            let a = at / beam.length;
            0.5 + (1.0 - a) / 2.0 * ((3.0 - a) / (2.0 * a)).powi(2)
        }
        _ => 0.5,
    }
}

/// For a beam with a known mass: from its static deflection, and half of it (Melo et al. 2006, Fig. 5).
#[must_use]
pub fn equivalent_masses(beam: &Beam) -> Option<EquivalentMasses> {
    let whole = beam.own_mass?;
    Some(EquivalentMasses {
        elastic: first_mode_mass_factor(beam) * whole,
        plastic: None,
        lumped: lumped_factor(beam) * whole,
        whole,
    })
}

/// The factor with partly built-in ends, `r = k_θ L / EI` at each: the built-in shape φ_b = s²(3 − 2s) and the rotation of the ends
/// 2s − s² (s from a support to the middle), in the ratio (r + 2) : 6; with ∫φ_b² = 13/35, ∫φ_b(2s − s²) = 13/30, ∫(2s − s²)² = 8/15.
#[must_use]
pub fn partly_built_in_mass_factor(ratio: f64) -> f64 {
    if ratio.is_infinite() {
        return 13.0 / 35.0;
    }
    let (built_in, turned, all) = (ratio + 2.0, 6.0, ratio + 8.0);
    (13.0 / 35.0 * built_in * built_in
        + 2.0 * 13.0 / 30.0 * built_in * turned
        + 8.0 / 15.0 * turned * turned)
        / (all * all)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPAN: Span = Span {
        length: 2.0,
        bending: 7.0e10 * 3.0e-8,
    };

    #[test]
    fn partly_built_in_ends_lie_between_the_two_it_joins() {
        let of = |rotational_stiffness| {
            stiffness(
                SPAN,
                Ends::PartlyBuiltIn {
                    rotational_stiffness,
                },
                None,
            )
        };
        let simple = stiffness(SPAN, Ends::SimplySupported, None);
        let built_in = stiffness(SPAN, Ends::BuiltIn, None);
        assert!((of(0.0) / simple - 1.0).abs() < 1e-15);
        assert!((of(1e30) / built_in - 1.0).abs() < 1e-15);
        assert_eq!(of(f64::INFINITY), built_in);
        assert!(simple < of(1000.0) && of(1000.0) < built_in);
    }

    #[test]
    fn closed_forms() {
        // EI = 2100 N·m², L³ = 8 m³.
        assert!((stiffness(SPAN, Ends::Cantilever, None) - 787.5).abs() < 1e-9);
        assert!((stiffness(SPAN, Ends::SimplySupported, None) - 12_600.0).abs() < 1e-8);
        assert!((stiffness(SPAN, Ends::BuiltIn, None) - 50_400.0).abs() < 1e-7);
        // r = 4: 192·(6/12) = 96 times EI/L³.
        let partly = Ends::PartlyBuiltIn {
            rotational_stiffness: 4200.0,
        };
        assert!((stiffness(SPAN, partly, None) - 25_200.0).abs() < 1e-8);
    }

    /// ∫ shape² over the length, by Simpson, is the factor.
    #[test]
    fn mass_factors_are_the_integral_of_the_static_shape_squared() {
        let integral = |shape: &dyn Fn(f64) -> f64| {
            let n = 2000;
            let h = 1.0 / f64::from(n);
            (0..=n)
                .map(|i| {
                    let weight = if i == 0 || i == n {
                        1.0
                    } else {
                        f64::from(2 + 2 * (i % 2))
                    };
                    weight * shape(f64::from(i) * h).powi(2)
                })
                .sum::<f64>()
                * h
                / 3.0
        };
        // One variable: from the fixed end to the tip, or from a support to the middle, where the shape is 1.
        let cantilever = integral(&|s| 0.5 * s * s * (3.0 - s));
        let simple = integral(&|s| 0.5 * s * (3.0 - s * s));
        let built_in = integral(&|s| s * s * (3.0 - 2.0 * s));
        for (ends, value) in [
            (Ends::Cantilever, cantilever),
            (Ends::SimplySupported, simple),
            (Ends::BuiltIn, built_in),
        ] {
            let factor = first_mode_mass_factor(&beam(ends));
            assert!((factor - value).abs() < 1e-10, "{ends:?}: {value}");
        }
        // Between them: the simply supported beam with an end moment m·WL/8, m = r/(r + 2) of that of the built-in beam, by the
        // moment-area theorem. Shape and end value follow from M(s) = W L s/4 − m WL/8, s from a support to the middle.
        for ratio in [0.3, 4.0, 70.0] {
            let m = ratio / (ratio + 2.0);
            // y'' = −M: y = m s²/4·½ − s³/24 + c s, y'(1) = 0, in units of WL³/(4EI)·½ that cancel.
            let slope = 0.5 * 0.25 - m * 0.125;
            let deflection = |s: f64| m * s * s / 16.0 - s * s * s / 24.0 + slope * s;
            let value = integral(&|s| deflection(s) / deflection(1.0));
            let rotational_stiffness = ratio * 7.0e10 * 3.0e-8 / 2.0;
            let factor = first_mode_mass_factor(&beam(Ends::PartlyBuiltIn {
                rotational_stiffness,
            }));
            assert!(
                (factor - value).abs() < 1e-10,
                "r = {ratio}: {factor} is not {value}"
            );
        }
        let rigid = Ends::PartlyBuiltIn {
            rotational_stiffness: f64::INFINITY,
        };
        assert_eq!(first_mode_mass_factor(&beam(rigid)), 13.0 / 35.0);
    }

    fn beam(ends: Ends) -> Beam {
        let (length, youngs_modulus, second_moment) = (2.0, 7.0e10, 3.0e-8);
        let stiffness = stiffness(
            Span {
                length,
                bending: youngs_modulus * second_moment,
            },
            ends,
            None,
        );
        Beam {
            stiffness,
            length,
            youngs_modulus,
            second_moment,
            ends,
            shear: None,
            at: None,
            own_mass: None,
        }
    }

    const ALL: [Ends; 4] = [
        Ends::Cantilever,
        Ends::SimplySupported,
        Ends::BuiltIn,
        Ends::PartlyBuiltIn {
            rotational_stiffness: 4200.0,
        },
    ];

    #[test]
    fn at_the_middle_or_the_tip_it_is_the_beam_without_a_position() {
        for ends in ALL {
            let at = if ends == Ends::Cantilever { 2.0 } else { 1.0 };
            for shear in [None, Some(5000.0)] {
                let ratio = stiffness_at(SPAN, ends, shear, at) / stiffness(SPAN, ends, shear);
                assert!((ratio - 1.0).abs() < 1e-14, "{ends:?}: {ratio}");
            }
            let plain = beam(ends);
            let positioned = Beam {
                at: Some(at),
                ..plain
            };
            let ratio = first_mode_mass_factor(&positioned) / first_mode_mass_factor(&plain);
            assert!((ratio - 1.0).abs() < 1e-14, "{ends:?}: {ratio}");
            assert!((lumped_factor(&positioned) - 0.5).abs() < 1e-15);
        }
    }

    /// EI = 2100 N·m², L = 2 m, a = 0.5 m, b = 1.5 m.
    #[test]
    fn closed_forms_off_the_middle() {
        let of = |ends| stiffness_at(SPAN, ends, None, 0.5);
        // 3EI/a³, 3EIL/a²b², 3EIL³/a³b³.
        let near = |found: f64, wanted: f64| {
            assert!((found / wanted - 1.0).abs() < 1e-13, "{found} {wanted}");
        };
        near(of(Ends::Cantilever), 6300.0 / 0.125);
        near(of(Ends::SimplySupported), 12_600.0 / 0.5625);
        near(of(Ends::BuiltIn), 50_400.0 / 0.421_875);
        // From either end.
        for ends in [ALL[1], ALL[2], ALL[3]] {
            near(of(ends), stiffness_at(SPAN, ends, None, 1.5));
        }
    }

    /// Two elements of Timoshenko's beam between built-in ends, with the rotation at the load condensed: a(12, 6l, (4 + Φ)l²), a =
    /// EI/(l³(1 + Φ)), Φ = 12EI/(κGA l²).
    #[test]
    fn shear_of_built_in_ends_is_that_of_two_elements() {
        let shear = 20_000.0;
        for at in [0.3, 0.9, 1.4] {
            let element = |length: f64| {
                let phi = 12.0 * SPAN.bending / (shear * length * length);
                let unit = SPAN.bending / (length.powi(3) * (1.0 + phi));
                [
                    12.0 * unit,
                    6.0 * unit * length,
                    (4.0 + phi) * unit * length * length,
                ]
            };
            let (left, right) = (element(at), element(2.0 - at));
            let coupling = right[1] - left[1];
            let condensed = left[0] + right[0] - coupling * coupling / (left[2] + right[2]);
            let found = stiffness_at(SPAN, Ends::BuiltIn, Some(shear), at);
            assert!((found / condensed - 1.0).abs() < 1e-13, "{at}: {found}");
        }
    }

    /// The shape of the closed forms, by Simpson on either side of the load.
    #[test]
    fn mass_factors_off_the_middle_are_integrals_of_the_shape() {
        let simpson = |from: f64, to: f64, shape: &dyn Fn(f64) -> f64| {
            let n = 2000;
            let step = (to - from) / f64::from(n);
            let weight = |i: i32| match i {
                0 => 1.0,
                i if i == n => 1.0,
                i => f64::from(2 + 2 * (i % 2)),
            };
            (0..=n)
                .map(|i| weight(i) * shape(from + f64::from(i) * step).powi(2))
                .sum::<f64>()
                * step
                / 3.0
        };
        let a = 0.35;
        let b = 1.0 - a;
        let factor = |ends| {
            let positioned = Beam {
                at: Some(a * 2.0),
                ..beam(ends)
            };
            first_mode_mass_factor(&positioned)
        };
        // x²(3a − x)/2a³, then (3x − a)/2a.
        let cantilever = simpson(0.0, a, &|x| x * x * (3.0 * a - x) / (2.0 * a.powi(3)))
            + simpson(a, 1.0, &|x| (3.0 * x - a) / (2.0 * a));
        // bx(1 − b² − x²)/2a²b² on the side of a.
        let side = |x: f64, a: f64, b: f64| b * x * (1.0 - b * b - x * x) / (2.0 * (a * b).powi(2));
        let simple = simpson(0.0, a, &|x| side(x, a, b)) + simpson(0.0, b, &|y| side(y, b, a));
        // x²b²(3a − x(3a + b))/(2a³b³) on the side of a.
        let fixed = |x: f64, a: f64, b: f64| {
            x * x * b * b * (3.0 * a - x * (3.0 * a + b)) / (2.0 * (a * b).powi(3))
        };
        let built_in = simpson(0.0, a, &|x| fixed(x, a, b)) + simpson(0.0, b, &|y| fixed(y, b, a));
        for (ends, value) in [
            (Ends::Cantilever, cantilever),
            (Ends::SimplySupported, simple),
            (Ends::BuiltIn, built_in),
        ] {
            let found = factor(ends);
            assert!(
                (found / value - 1.0).abs() < 1e-9,
                "{ends:?}: {found} {value}"
            );
        }
    }

    /// κGA = 5000 N: the cantilever gains L/κGA = 0.4 mm/N, the others a quarter of it.
    #[test]
    fn shear_adds_its_flexibility() {
        let half = ends_of_fixity(0.5, SPAN);
        for (ends, gain) in [
            (Ends::Cantilever, 4e-4),
            (Ends::SimplySupported, 1e-4),
            (Ends::BuiltIn, 1e-4),
            (half, 1e-4),
        ] {
            let of = |shear| 1.0 / stiffness(SPAN, ends, shear);
            assert!(
                (of(Some(5000.0)) - of(None) - gain).abs() < 1e-15,
                "{ends:?}"
            );
        }
    }

    /// p = ½ is r = 3: 192·5/11 EI/L³.
    #[test]
    fn fixity_runs_from_pinned_to_built_in() {
        let of = |factor| stiffness(SPAN, ends_of_fixity(factor, SPAN), None);
        assert!((of(0.0) - 12_600.0).abs() < 1e-8 && (of(1.0) - 50_400.0).abs() < 1e-8);
        assert!((of(0.5) - 50_400.0 * 5.0 / 11.0).abs() < 1e-8);
    }
}
