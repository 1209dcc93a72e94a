//! A constant of the report of an unloading.

/// The method by which the contributions to its uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "In closed form, from the unloaded position: R + K(x₀ − x) = 0 with the \
 stiffness measured during the unloading.";
