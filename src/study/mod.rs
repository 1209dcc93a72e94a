//! Studies of a plan: many runs with scattered inputs, in one process or many. In: a parsed plan and a study of it. Out: the data set of
//! its runs, one file; `answers` are the numbers that follow from it, `report` its figures and pages: both need the data set alone.

pub mod answers;
pub mod cluster;
pub mod collection;
pub mod console;
pub mod counts;
pub mod data_set;
pub mod definition;
pub mod draws;
pub mod metadata;
pub mod report;
pub mod simulation;
pub mod stopping;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
