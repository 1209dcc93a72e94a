//! The blocks that evaluate runs: `report`, `golden`, `study`, `fragility`.

pub mod golden;
pub mod report;
pub mod reproduces;
pub mod study;
