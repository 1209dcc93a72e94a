//! The schema of the language as data: every block, field, variant, default, range, result and function,
//! written once. The check, the suggestions, the reference and the tools read it. It knows no
//! syntax and no plan.

pub mod blocks;
pub mod columns;
mod constructors;
mod functions;
pub mod sections;
mod synonyms;
mod types;

pub use blocks::evaluation::{golden, report, reproduces, study};
pub use blocks::{
    behaviours, curves, devices, frames, ground, limits, methods, plan_block, procedures, rig,
    specimen, striker,
};
pub use columns::Column;
pub use functions::{CONSTANTS, FUNCTIONS, FunctionKind, Takes, constant};
pub use synonyms::SYNONYMS;
pub use types::{
    BlockKind, Field, FieldType, Kind, Naming, Peak, Possible, Presence, Printed, Range,
    ResultKind, RigKind, Variant,
};

use psd_text::units::{Dimension, display};

/// Every kind of block, in the order of the reference: the declarations, the procedures, and the blocks about the run.
pub const BLOCKS: &[&BlockKind] = &joined::<
    { DECLARATIONS.len() + procedures::BLOCKS.len() + ABOUT_THE_RUN.len() },
>([DECLARATIONS, procedures::BLOCKS, ABOUT_THE_RUN]);

const DECLARATIONS: &[&BlockKind] = &[
    &blocks::plan_block::PLAN,
    &blocks::specimen::SPECIMEN,
    &blocks::striker::STRIKER,
    &blocks::ground::GROUND,
    &blocks::limits::LIMITS,
    &blocks::rig::RIG,
];

const ABOUT_THE_RUN: &[&BlockKind] = &[
    &blocks::evaluation::reproduces::REPRODUCES,
    &blocks::evaluation::report::REPORT,
    &blocks::evaluation::golden::GOLDEN,
    &blocks::evaluation::study::STUDY,
    &blocks::evaluation::study::FRAGILITY,
];

/// These lists as one, of `N` blocks.
const fn joined<const N: usize>(
    lists: [&'static [&'static BlockKind]; 3],
) -> [&'static BlockKind; N] {
    let mut all = [lists[0][0]; N];
    let (mut position, mut list) = (0, 0);
    while list < lists.len() {
        let mut entry = 0;
        while entry < lists[list].len() {
            all[position] = lists[list][entry];
            (position, entry) = (position + 1, entry + 1);
        }
        list += 1;
    }
    all
}

/// Keywords of items that are not blocks, for suggestions.
pub const ITEM_WORDS: &[&str] = &["use", "param", "let", "require"];

/// The kind whose keyword begins these words; the longest one that matches.
#[must_use]
pub fn block_of_words(words: &[&str]) -> Option<&'static BlockKind> {
    BLOCKS
        .iter()
        .copied()
        .filter(|block| words.starts_with(block.keyword))
        .max_by_key(|block| block.keyword.len())
}

/// The entry of a kind of block.
#[must_use]
pub const fn block(kind: Kind) -> &'static BlockKind {
    match kind {
        Kind::Plan => &blocks::plan_block::PLAN,
        Kind::Specimen => &blocks::specimen::SPECIMEN,
        Kind::Striker => &blocks::striker::STRIKER,
        Kind::Ground => &blocks::ground::GROUND,
        Kind::Limits => &blocks::limits::LIMITS,
        Kind::Rig => &blocks::rig::RIG,
        Kind::Reproduces => &blocks::evaluation::reproduces::REPRODUCES,
        Kind::Report => &blocks::evaluation::report::REPORT,
        Kind::Golden => &blocks::evaluation::golden::GOLDEN,
        Kind::Study => &blocks::evaluation::study::STUDY,
        Kind::Fragility => &blocks::evaluation::study::FRAGILITY,
        Kind::Procedure(procedure) => procedures::block(procedure),
    }
}

/// How a result is printed. The name of its procedure and an index may be part of the name.
#[must_use]
pub fn printed(result: &str) -> Printed {
    let name = result.rsplit('.').next().unwrap_or(result);
    let name = name.split('[').next().unwrap_or(name);
    let mut results = BLOCKS.iter().flat_map(|block| block.results);
    results
        .find(|kind| kind.name == name && kind.printed != Printed::InUnits)
        .map_or(Printed::InUnits, |kind| kind.printed)
}

/// The unit that a result is printed in, and its factor to SI units.
#[must_use]
pub fn printed_unit(result: &str, value: f64, dimension: Dimension) -> (String, f64) {
    if printed(result) == Printed::InPercent {
        ("%".to_owned(), 0.01)
    } else {
        display::unit(value, dimension)
    }
}

/// A result with four significant digits in its unit.
#[must_use]
pub fn readable_result(result: &str, value: f64, dimension: Dimension) -> String {
    let (unit, factor) = printed_unit(result, value, dimension);
    display::join(&display::digits(value, factor, dimension), &unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ProcedureBlock;

    #[test]
    fn the_longest_keyword_wins_and_a_name_is_no_part_of_it() {
        assert_eq!(
            block_of_words(&["stiffness", "ramp", "k0"]).map(|block| block.kind),
            Some(Kind::Procedure(ProcedureBlock::StiffnessRamp))
        );
        assert_eq!(
            block_of_words(&["inspect"]).map(|block| block.kind),
            Some(Kind::Procedure(ProcedureBlock::Inspect))
        );
        assert!(block_of_words(&["stiffness", "k0"]).is_none());
    }

    #[test]
    fn a_block_is_listed_under_its_own_kind() {
        for listed in BLOCKS {
            assert_eq!(block(listed.kind).keyword, listed.keyword);
        }
    }

    #[test]
    fn every_default_with_a_unit_has_the_dimension_of_its_field() {
        /// The field, its arguments, and theirs.
        fn all(field: &'static Field) -> Vec<&'static Field> {
            let variants = field.ty.variants().iter();
            let inner = variants.flat_map(|variant| variant.arguments);
            [vec![field], inner.flat_map(all).collect()].concat()
        }
        for field in BLOCKS.iter().flat_map(|block| block.fields).flat_map(all) {
            if let (Presence::Default { unit, .. }, Some(dimension)) =
                (field.presence, field.dimension())
                && !unit.is_empty()
            {
                assert_eq!(
                    psd_text::units::unit::parse(unit).unwrap().dimension,
                    dimension,
                    "{}",
                    field.name
                );
            }
        }
    }

    /// A largest value is a peak only if the motion went on past it; the verdict asks each result.
    #[test]
    fn a_largest_value_of_a_motion_states_after_which_peak_it_is_final() {
        use crate::procedures::{escalate, impact, shake};
        use procedures::tracking;
        let of_the_actuator = [
            tracking::PEAK_ERROR,
            tracking::FLOOR_PEAK_ERROR,
            tracking::TRACKING_ENERGY_ERROR,
        ];
        let motions = [
            impact::block::RESULTS,
            shake::block::RESULTS,
            escalate::block::RESULTS,
        ];
        for result in motions.into_iter().flatten() {
            let mut words = result.doc.split(|letter: char| !letter.is_alphanumeric());
            let largest = words.any(|word| ["largest", "peak"].contains(&word));
            let exempt = of_the_actuator.iter().any(|kind| kind.name == result.name);
            let of_impact = result.made_of.and_then(|kind| kind.peak);
            let stated = result.peak.or(of_impact).is_some();
            assert!(stated || exempt || !largest, "{}", result.name);
        }
    }

    #[test]
    fn no_block_declares_a_name_twice() {
        for block in BLOCKS {
            for names in [
                block
                    .fields
                    .iter()
                    .map(|field| field.name)
                    .collect::<Vec<_>>(),
                block.results.iter().map(|result| result.name).collect(),
            ] {
                let mut sorted = names.clone();
                sorted.sort_unstable();
                sorted.dedup();
                assert_eq!(sorted.len(), names.len(), "{:?}", block.keyword);
            }
        }
    }
}
