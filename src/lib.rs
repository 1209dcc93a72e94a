//! psd: a small language for pseudo-dynamic structural tests, and the program that runs it.
//!
//! ```text
//! text → syntax (Ast) → check (Plan) → run (Record) → verdict → report
//! ```
//!
//! Each arrow is one public function. No stage calls back, and no stage after `check` reads text. The stages are engines:
//! everything that concerns one procedure only is in its folder of `procedures`. Text, physics, plan, language and rigs are crates of their
//! own, which this one joins. The program `psd` is the folder `cli`.

pub mod check;
pub mod codes;
pub mod golden;
pub mod procedures;
pub mod remote;
pub mod report;
pub mod run;
pub mod study;
pub mod verdict;

#[cfg(test)]
mod tests;
