//! Beams by geometry: stiffness at the struck section and the mass that moves with it in the first mode.

use crate::plan::Ends;

/// Stiffness of a uniform beam at the struck section (tip of a cantilever, middle of the others), N/m. Partly built-in
/// ends, with `r = k_θ L / EI` at each, run from simply supported (r = 0) to built-in (r = ∞).
#[must_use]
pub fn stiffness(length: f64, youngs_modulus: f64, second_moment: f64, ends: Ends) -> f64 {
    let bending = youngs_modulus * second_moment;
    let unit = bending / (length * length * length);
    match ends {
        Ends::Cantilever => 3.0 * unit,
        Ends::SimplySupported => 48.0 * unit,
        Ends::BuiltIn => 192.0 * unit,
        Ends::PartlyBuiltIn { rotational_stiffness } => {
            let ratio = rotational_stiffness * length / bending;
            if ratio.is_infinite() { 192.0 * unit } else { 192.0 * unit * (ratio + 2.0) / (ratio + 8.0) }
        }
    }
}

/// Equivalent mass over the beam's own, with the static deflection as the shape (the paper's is ½); none is tabulated
/// for partly built-in ends.
#[must_use]
pub const fn first_mode_mass_factor(ends: Ends) -> Option<f64> {
    match ends {
        Ends::Cantilever => Some(33.0 / 140.0),
        Ends::SimplySupported => Some(17.0 / 35.0),
        Ends::BuiltIn => Some(13.0 / 35.0),
        Ends::PartlyBuiltIn { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partly_built_in_ends_lie_between_the_two_it_joins() {
        let of = |rotational_stiffness| stiffness(2.0, 7.0e10, 3.0e-8, Ends::PartlyBuiltIn { rotational_stiffness });
        let simple = stiffness(2.0, 7.0e10, 3.0e-8, Ends::SimplySupported);
        let built_in = stiffness(2.0, 7.0e10, 3.0e-8, Ends::BuiltIn);
        assert!((of(0.0) / simple - 1.0).abs() < 1e-15);
        assert!((of(1e30) / built_in - 1.0).abs() < 1e-15);
        assert_eq!(of(f64::INFINITY), built_in);
        assert!(simple < of(1000.0) && of(1000.0) < built_in);
    }

    #[test]
    fn closed_forms() {
        // EI = 2100 N·m², L³ = 8 m³.
        assert!((stiffness(2.0, 7.0e10, 3.0e-8, Ends::Cantilever) - 787.5).abs() < 1e-9);
        assert!((stiffness(2.0, 7.0e10, 3.0e-8, Ends::SimplySupported) - 12_600.0).abs() < 1e-8);
        assert!((stiffness(2.0, 7.0e10, 3.0e-8, Ends::BuiltIn) - 50_400.0).abs() < 1e-7);
        // r = 4: 192·(6/12) = 96 times EI/L³.
        let partly = Ends::PartlyBuiltIn { rotational_stiffness: 4200.0 };
        assert!((stiffness(2.0, 7.0e10, 3.0e-8, partly) - 25_200.0).abs() < 1e-8);
    }

    /// ∫ shape² over the length, by Simpson, is the factor.
    #[test]
    fn mass_factors_are_the_integral_of_the_static_shape_squared() {
        let integral = |shape: fn(f64) -> f64| {
            let n = 2000;
            let h = 1.0 / f64::from(n);
            (0..=n)
                .map(|i| {
                    let weight = if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
                    weight * shape(f64::from(i) * h).powi(2)
                })
                .sum::<f64>()
                * h
                / 3.0
        };
        // One variable: from the fixed end to the tip, or from a support to the middle, where the shape is 1.
        let cantilever = integral(|s| 0.5 * s * s * (3.0 - s));
        let simple = integral(|s| 0.5 * s * (3.0 - s * s));
        let built_in = integral(|s| s * s * (3.0 - 2.0 * s));
        for (ends, value) in [(Ends::Cantilever, cantilever), (Ends::SimplySupported, simple), (Ends::BuiltIn, built_in)] {
            assert!((first_mode_mass_factor(ends).unwrap() - value).abs() < 1e-10, "{ends:?}: {value}");
        }
    }
}
