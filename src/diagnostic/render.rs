//! Diagnostics for a person.
