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

/// For a beam with a known mass: from its static deflection, and half of it (Melo et al. 2006, Fig. 5).
#[must_use]
pub fn equivalent_masses(beam: &Beam) -> Option<EquivalentMasses> {
    let whole = beam.own_mass?;
    Some(EquivalentMasses {
        elastic: first_mode_mass_factor(beam) * whole,
        plastic: None,
        lumped: whole / 2.0,
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
            own_mass: None,
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
