//! All integration tests in one binary: one link, one module a concern.

mod cli;
mod docs;
mod explain;
mod house;
mod lang;
mod outputs;
mod physics;
mod plans;
mod reference;
mod serve;
