//! Measurement uncertainty. An uncertain number is a sum of contributions, one per source, and
//! sources are independent: numbers that share a source are correlated accordingly (JCGM 100:2008,
//! 5.2 and F.1.2.3). In: contributions. Out: standard uncertainties, and results with one source
//! perturbed.

mod cost;
mod degrees;
pub mod engine;
mod instruments;
mod threads;

pub use crate::plan::contribution::{Contribution, combined, combined_entries, share};
pub use crate::plan::results::{Moved, sources_of};
pub use crate::plan::source::Source;
pub use degrees::{FEW, Known, MOST_DRAWS, known, known_entries};
pub use instruments::InstrumentUncertainty;
