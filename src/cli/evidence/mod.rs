//! What proves a run folder: its files as they lie there, what its record gives when it is played back, the two held
//! against each other and against the manifest, and who has signed it. In: a folder. Out: findings. Nothing here writes.

mod check;
#[cfg(test)]
mod damaged_tests;
mod folder;
#[cfg(test)]
mod header_tests;
mod issues;
pub mod keys;
mod rebuilt;
mod sidecar;
#[cfg(test)]
mod sidecar_tests;
mod signature;
mod standing;
#[cfg(test)]
mod tests;

pub use check::{Finding, examine};
pub use folder::{Folder, MANIFEST};
pub use issues::{ISSUE, IssueFile, One, OneKind, held as held_issue, may_be_stated};
pub use rebuilt::{PlayedBack, Rebuilt};
pub use signature::{Statement, file_name, sign as sign_manifest};
pub use standing::stands;
