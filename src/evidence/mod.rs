//! Verification of a run folder. In: the folder. Out: findings on its files, on the replay of its
//! run log, on the manifest, signatures and issued reports. Checking writes nothing.

#[cfg(test)]
mod build_tests;
mod check;
mod consistency;
#[cfg(test)]
mod damaged_tests;
mod finding;
mod folder;
#[cfg(test)]
mod header_tests;
mod issues;
pub mod keys;
mod names;
mod rebuilt;
mod sidecar;
#[cfg(test)]
mod sidecar_tests;
mod signature;
#[cfg(test)]
mod tests;

pub use check::examine;
pub use consistency::check_consistency;
pub use finding::Finding;
pub use folder::Folder;
pub use issues::{IssueFile, One, OneKind, held as held_issue, may_be_stated};
pub use names::{ISSUE, MANIFEST};
pub use rebuilt::{PlayedBack, Rebuilt};
pub use signature::{Statement, file_name, sign as sign_manifest};
