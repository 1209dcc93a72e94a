//! psd: a small language for pseudo-dynamic structural tests, and the program that runs it.
//!
//! ```text
//! text → syntax (Ast) → check (Plan) → run (Record) → verdict → report
//! ```
//!
//! Each arrow is one public function. No stage calls back, and no stage after `check` reads text. The stages are engines:
//! everything that concerns one procedure only is in its folder of `procedures`.

pub use psd_language as language;
pub use psd_physics as physics;
pub use psd_plan::{self as plan, record, schema, uncertainty};
pub use psd_rig::{self as rig, emulator};
pub use psd_text::{self as text, units};

pub mod check;

pub mod run;

pub mod procedures;

pub mod verdict;

pub mod report;

pub mod remote;

pub mod codes;
pub(crate) mod evidence;
pub(crate) mod files;
pub mod golden;

pub mod study;

pub mod cli;

#[cfg(test)]
mod tests;
