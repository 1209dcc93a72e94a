//! Verification of a run folder. In: the folder. Out: findings on its files, on the replay of its
//! run log, on the manifest, signatures and issued reports. Checking writes nothing.

mod check;
mod consistency;
mod finding;
mod folder;
mod issues;
pub mod keys;
pub(crate) mod names;
mod rebuilt;
mod sidecar;
mod signature;
#[cfg(test)]
mod tests;

pub use check::examine;
pub use consistency::check_consistency;
pub use finding::{Finding, Judgement};
pub use folder::Folder;
pub use issues::{IssueFile, One, OneKind, may_be_stated};
pub use names::{ISSUE, MANIFEST};
pub use rebuilt::{Rebuilt, ReplayedRun};
pub use signature::{Statement, file_name, sign as sign_manifest};
