//! psd: a small language for pseudo-dynamic structural tests, and the program that runs it.
//!
//! ```text
//! text → syntax (Ast) → check (Plan) → run (Record) → verdict → output
//! ```
//!
//! Each arrow is one public function that takes the left and gives the right. No stage calls back, and no stage after
//! `check` sees text. `mechanics` holds the numerics, `rig` the door to hardware, `cli` the program around them all.

pub mod digest;
pub mod inert;
pub mod legible;
pub mod source;

pub mod diagnostic;
pub mod quantity;
pub mod suggest;

pub mod syntax;

pub mod formula;
pub mod plan;
pub mod schema;
pub mod uncertainty;

pub mod check;

pub mod mechanics;
pub mod record;
pub mod rig;
pub mod simulator;

pub mod run;
pub mod serve;

pub mod verdict;

pub mod output;

pub mod comparison;
pub mod golden;

pub mod cli;
