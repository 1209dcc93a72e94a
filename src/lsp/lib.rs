//! The language server: what an editor asks about a plan. In: messages of the Language Server Protocol, over any connection. Out: answers
//! from the syntax, the vocabulary and the check of the language. It opens no file, reads no clock and runs nothing: the check of a whole
//! plan, its simulation and the files come from the [`Program`] that starts it.

mod analysis;
mod answers;
mod cursor;
mod documents;
mod fixes;
mod occurrences;
mod program;
mod server;
mod text;
mod transport;
mod units;
mod uri;

#[cfg(test)]
mod tests;

pub use answers::describe;
pub use program::{Checked, Program, SimulatedRequirement, SimulatedResult, Simulation};
pub use server::{Ended, run};
pub use transport::serve;
pub use units::units_of;
