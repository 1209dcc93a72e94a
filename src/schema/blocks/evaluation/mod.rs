//! The blocks that evaluate runs: `report`, `golden`, `study`, `fragility`.

pub(crate) mod golden;
pub(crate) mod report;
pub(crate) mod study;
