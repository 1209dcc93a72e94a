//! Pure numerics: integrator, contact, specimen models, identification, energy. SI throughout; no rig, no plan text.

pub mod contact;
pub mod energy;
pub mod identification;
