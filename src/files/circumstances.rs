//! The place and the people of a run on a real rig.

/// What only a real rig's record says of the place and the people.
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
    /// Who, where and when: what makes a run on a real rig another than every other.
    pub const fn told(&self) -> [&Option<String>; 3] {
        [&self.operator, &self.host, &self.began]
    }
}
