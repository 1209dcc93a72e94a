//! Impacts, impact series and contact laws on one degree of freedom.

pub(crate) mod contacts;
pub(crate) mod series;
pub(crate) mod single;
