//! Operator, machine and start time of a run.

/// Data of a run that do not follow from its plan. Operator and machine are only in the run log of a real rig.
#[derive(Clone, Debug, Default)]
pub struct Circumstances {
    pub operator: Option<String>,
    pub host: Option<String>,
    /// UTC.
    pub began: Option<String>,
    /// Protocol of the clients that drive the rig, real or not.
    pub served: Option<String>,
}

impl Circumstances {
    /// Operator, machine and start time: they distinguish a run on a real rig from every other run.
    pub const fn identifying(&self) -> [&Option<String>; 3] {
        [&self.operator, &self.host, &self.began]
    }
}
