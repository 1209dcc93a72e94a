//! The identity of a rig, as it reports it.

use serde::{Deserialize, Serialize};

/// The identity that a rig reports.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    pub name: String,
    pub model: String,
    pub serial: String,
    pub firmware: String,
    /// Random boot identifier of this power-up, if the rig has one. A different identifier means that its position cannot be trusted.
    pub boot: Option<String>,
    /// Whether no physical specimen moved.
    pub simulated: bool,
}
