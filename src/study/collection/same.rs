//! Whether two data sets contain runs of one study. In: their metadata. Out: what differs, in words.

use thiserror::Error;

use crate::study::data_set::{Metadata, StudyKind};
use psd_plan::study::Sampling;

/// Why runs cannot be put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Difference {
    #[error("another version of psd made its runs")]
    Version,
    #[error("its runs are of another plan, or of the plan before it was changed")]
    Plan,
    #[error("its runs have other `--set` values")]
    Settings,
    #[error("it contains another study")]
    Study,
    #[error("its runs have another seed")]
    Seed,
    #[error("a Latin hypercube has as many strata as runs: a study of more runs has other runs")]
    LatinHypercube,
    #[error("its number of runs differs")]
    Runs,
    #[error("its inputs, results or requirements differ")]
    Columns,
}

/// The first difference of two files, neither of which has to be whole.
///
/// # Errors
/// There is one.
pub fn same(found: &Metadata, wanted: &Metadata) -> Result<(), Difference> {
    grown(found, wanted)?;
    if found.at_most == wanted.at_most {
        Ok(())
    } else {
        Err(Difference::Runs)
    }
}

/// The same for a study that may grow: its first runs are those of the smaller one.
///
/// # Errors
/// There is a difference.
pub fn grown(found: &Metadata, wanted: &Metadata) -> Result<(), Difference> {
    let differences = [
        (found.version != wanted.version, Difference::Version),
        (found.settings != wanted.settings, Difference::Settings),
        (found.digest != wanted.digest, Difference::Plan),
        (found.study != wanted.study, Difference::Study),
        (found.seed != wanted.seed, Difference::Seed),
        (
            found.at_most != wanted.at_most && wanted.sampling == Sampling::LatinHypercube,
            Difference::LatinHypercube,
        ),
    ];
    if let Some((_, difference)) = differences.into_iter().find(|(differs, _)| *differs) {
        return Err(difference);
    }
    let mut alike = found.clone();
    alike.at_most = wanted.at_most;
    if let (StudyKind::Fragility(stripes), StudyKind::Fragility(others)) =
        (&mut alike.kind, &wanted.kind)
    {
        stripes.runs = others.runs;
    }
    if alike.belongs_to(wanted) {
        Ok(())
    } else {
        Err(Difference::Columns)
    }
}
