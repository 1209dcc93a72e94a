//! A constant of the report of an unloading.

/// The method by which the contributions to its uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "told in closed form of where the specimen carries no load, R + K(x₀ − x) = 0 with the stiffness that it showed on the way there";
