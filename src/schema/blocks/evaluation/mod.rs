//! The blocks that evaluate runs: `report`, `golden`, `study`, `fragility`.

pub(crate) mod golden;
pub(crate) mod report;
pub(crate) mod reproduces;
pub(crate) mod study;
