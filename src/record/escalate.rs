//! What an `escalate` records: every blow as an impact of its own.

use super::{ImpactHistory, NamedResult};

/// One blow.
#[derive(Clone, Debug)]
pub struct Blow {
    /// V0, m/s
    pub velocity: f64,
    /// ½ Ms V0², J
    pub energy: f64,
    /// Those of an impact, in the schema's order.
    pub results: Vec<NamedResult>,
    pub history: ImpactHistory,
    /// Whether the condition held; None where the blow did not run to its end.
    pub held: Option<bool>,
    /// Displacement (m) and force (N) after it, once the specimen was brought to where the next blow begins.
    pub rest: Option<(f64, f64)>,
}

#[derive(Clone, Debug, Default)]
pub struct EscalateHistory {
    pub blows: Vec<Blow>,
}
