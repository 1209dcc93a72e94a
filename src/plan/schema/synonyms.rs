//! Words of textbooks and of other programs, each with the word that a plan has for it. The suggestions of the check read them, where the
//! first word is unknown and the second one is known.

/// What is written, and the name of the field, argument, option, block or function.
pub const SYNONYMS: &[(&str, &str)] = &[
    ("A", "area"),
    ("E", "youngs_modulus"),
    ("G", "shear_modulus"),
    ("I", "second_moment"),
    ("L", "length"),
    ("span", "length"),
    ("c", "damping"),
    ("k", "stiffness"),
    ("m", "mass"),
    ("rho", "density"),
    ("v", "velocity"),
    ("v0", "velocity"),
    ("zeta", "damping_ratio"),
    ("rayleigh", "damping_ratio"),
    ("dt", "time_step"),
    ("steps", "time_step"),
    ("t_end", "duration"),
    ("yield", "yield_force"),
    ("fy", "yield_force"),
    ("hardening", "post_yield_ratio"),
    ("supports", "ends"),
    ("cycles", "repeats"),
    ("newmark", "tangent"),
    ("central_difference", "explicit"),
    ("hht", "alpha_os"),
    ("hertzian", "hertz"),
    ("gaussian", "normal"),
    ("sigma", "sd"),
    ("std", "sd"),
    ("ln", "log"),
    ("ramp", "stiffness ramp"),
    ("sweep", "damping sweep"),
    ("earthquake", "shake"),
];

#[cfg(test)]
mod tests {
    use super::SYNONYMS;
    use crate::schema::{BLOCKS, FUNCTIONS, Field};
    use std::collections::BTreeSet;

    fn add(fields: &[Field], found: &mut BTreeSet<String>) {
        for field in fields {
            found.insert(field.name.to_owned());
            for variant in field.ty.variants() {
                if found.insert(variant.name.to_owned()) {
                    add(variant.arguments, found);
                }
            }
        }
    }

    #[test]
    fn each_stands_for_a_word_of_the_language() {
        let mut known: BTreeSet<String> = BLOCKS.iter().map(|block| block.words()).collect();
        known.extend(FUNCTIONS.iter().map(|function| function.name.to_owned()));
        for block in BLOCKS {
            add(block.fields, &mut known);
        }
        for (written, name) in SYNONYMS {
            assert!(known.contains(*name), "{name}");
            assert!(written != name, "{written}");
        }
    }
}
