//! The check of every block, from syntax tree to plan: names, units, values, ranges. In: syntax trees and a [`Loader`] for the files that
//! they use. Out: parts of the plan, and diagnostics. It knows no particular procedure, and it runs nothing.

pub mod checker;
pub mod declarations;
pub mod declared;
pub mod expressions;
pub mod imports;
pub mod rig;
pub mod scope;
pub mod tested;
pub mod violations;
pub mod warnings;
pub mod wording;

pub use checker::{DEEPEST_VALUES, MOST_TERMS};
pub use declarations::ground::record::MOST_SAMPLES as MOST_GROUND_SAMPLES;
pub use declarations::study::MOST_SAMPLE_ROWS;
pub use expressions::literal::MOST_ENTRIES;
pub use imports::{DEEPEST, MOST_FILES};

/// Loads the text of used files. Paths are relative to the plan's folder, with `/`, already free of `..`.
pub type Loader<'l> = dyn Fn(&str) -> Result<String, LoadError> + 'l;

/// The [`Loader`] of a plan that uses no file.
///
/// # Errors
/// Every path: there is no file.
pub fn no_files(_: &str) -> Result<String, LoadError> {
    Err(LoadError::NotFound)
}

/// Why a used file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadError {
    NotFound,
    /// A folder, a device, a link out of the folder, a file that is too large or not UTF-8: the reason, for the reader.
    Refused(String),
}
