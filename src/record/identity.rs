//! The identity of a rig, as it reports it.

use serde::{Deserialize, Serialize};

/// Who the rig says it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    pub name: String,
    pub model: String,
    pub serial: String,
    pub firmware: String,
    /// Random word of this power-up, where the rig has one: another word means that its position is not to be trusted.
    pub boot: Option<String>,
    /// Nothing real moved.
    pub simulated: bool,
}
