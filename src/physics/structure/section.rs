//! Cross-sections of beams and columns, bent about the axis across their depth. In: dimensions \[m\]. Out: area, second moment and
//! plastic modulus.

use std::f64::consts::PI;

/// A cross-section. The load acts along its depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// A \[m²\]
    pub area: f64,
    /// I = ∫z² dA about the neutral axis \[m⁴\]
    pub second_moment: f64,
    /// Z = ∫|z| dA \[m³\]: the plastic moment is Z times the yield stress.
    pub plastic_modulus: f64,
}

/// A solid rectangle: A = bd, I = bd³/12, Z = bd²/4.
#[must_use]
pub fn rectangle(width: f64, depth: f64) -> Section {
    Section {
        area: width * depth,
        second_moment: width * depth.powi(3) / 12.0,
        plastic_modulus: width * depth.powi(2) / 4.0,
    }
}

/// A round pipe with outer diameter D and bore d = D − 2t, solid if t = D/2: A = π(D² − d²)/4, I = π(D⁴ − d⁴)/64, Z = (D³ − d³)/6.
#[must_use]
pub fn pipe(diameter: f64, thickness: f64) -> Section {
    let bore = diameter - 2.0 * thickness;
    Section {
        area: PI * (diameter.powi(2) - bore.powi(2)) / 4.0,
        second_moment: PI * (diameter.powi(4) - bore.powi(4)) / 64.0,
        plastic_modulus: (diameter.powi(3) - bore.powi(3)) / 6.0,
    }
}

/// Dimensions of a symmetric I \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// b of the flanges
    pub width: f64,
    /// d of the whole
    pub depth: f64,
    pub flange_thickness: f64,
    pub web_thickness: f64,
}

/// A symmetric I without fillets: a rectangle of width b and depth d, less two of height h = d − 2t_f and of width b − t_w together.
/// A = bd − (b − t_w)h, I = (bd³ − (b − t_w)h³)/12, Z = (bd² − (b − t_w)h²)/4.
#[must_use]
pub fn i_section(profile: Profile) -> Section {
    let Profile {
        width,
        depth,
        flange_thickness,
        web_thickness,
    } = profile;
    let height = depth - 2.0 * flange_thickness;
    let (whole, cut) = (
        rectangle(width, depth),
        rectangle(width - web_thickness, height),
    );
    Section {
        area: whole.area - cut.area,
        second_moment: whole.second_moment - cut.second_moment,
        plastic_modulus: whole.plastic_modulus - cut.plastic_modulus,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A section as strips: width at each height z, by the midpoint rule with 200,000 strips.
    fn by_strips(depth: f64, width: impl Fn(f64) -> f64) -> Section {
        let strips = 200_000;
        let height = depth / f64::from(strips);
        let mut sums = [0.0; 3];
        for strip in 0..strips {
            let z = (f64::from(strip) + 0.5) * height - depth / 2.0;
            let area = width(z) * height;
            sums[0] += area;
            sums[1] += area * z * z;
            sums[2] += area * z.abs();
        }
        Section {
            area: sums[0],
            second_moment: sums[1],
            plastic_modulus: sums[2],
        }
    }

    fn assert_near(found: Section, wanted: Section, tolerance: f64) {
        for (found, wanted) in [
            (found.area, wanted.area),
            (found.second_moment, wanted.second_moment),
            (found.plastic_modulus, wanted.plastic_modulus),
        ] {
            assert!((found / wanted - 1.0).abs() < tolerance, "{found} {wanted}");
        }
    }

    #[test]
    fn closed_forms_are_the_integrals_over_strips() {
        assert_near(rectangle(0.06, 0.012), by_strips(0.012, |_| 0.06), 1e-9);
        let chord = |diameter: f64, z: f64| (diameter * diameter - 4.0 * z * z).max(0.0).sqrt();
        let wall = by_strips(0.1, |z| chord(0.1, z) - chord(0.09, z));
        assert_near(pipe(0.1, 0.005), wall, 1e-6);
        // The web ends on a strip: 200,000 · 8/160 is whole.
        let profile = by_strips(0.16, |z| if z.abs() > 0.072 { 0.082 } else { 0.005 });
        assert_near(
            i_section(Profile {
                width: 0.082,
                depth: 0.16,
                flange_thickness: 0.008,
                web_thickness: 0.005,
            }),
            profile,
            1e-9,
        );
    }

    #[test]
    fn limits_of_a_shape_are_simpler_shapes() {
        // A pipe of half its diameter is solid: πD⁴/64 and D³/6.
        let solid = pipe(0.1, 0.05);
        assert_near(
            solid,
            Section {
                area: PI * 0.01 / 4.0,
                second_moment: PI * 1e-4 / 64.0,
                plastic_modulus: 1e-3 / 6.0,
            },
            1e-14,
        );
        // An I with a web as wide as its flanges is a rectangle.
        assert_near(
            i_section(Profile {
                width: 0.06,
                depth: 0.012,
                flange_thickness: 0.003,
                web_thickness: 0.06,
            }),
            rectangle(0.06, 0.012),
            1e-14,
        );
    }
}
