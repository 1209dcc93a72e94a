//! An unloading as a report gives it: a constant of its text.

/// How the contributions to its uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "told in closed form of where the specimen carries no load, R + K(x₀ − x) = 0 with the stiffness that it showed on the way there";
