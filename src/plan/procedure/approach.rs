//! How soft the meeting of striker and structure is, as a plan says it. In: a blow of a plan, whoever knows its formulas.
//! Out: its critical time step. It strikes nothing.

use crate::physics::contact::contact_time_step::Approach;
use crate::plan::formula::Formula;
use crate::plan::{Contact, Impact, Striker};

impl Contact {
    /// k of a contact of finite stiffness, N/m^1.5; None of a law that has none.
    #[must_use]
    pub const fn stiffness(&self) -> Option<&Formula> {
        match self {
            Self::Hertz { stiffness, .. } => Some(stiffness),
            Self::Rigid | Self::Limit { .. } | Self::Restitution { .. } => None,
        }
    }

    /// How this striker arrives, as far as `known` knows the stiffness it meets.
    pub fn approach(
        &self,
        striker: &Striker,
        known: impl Fn(&Formula) -> Option<f64>,
    ) -> Option<Approach> {
        let hertz = match self.stiffness() {
            Some(stiffness) => Some(known(stiffness)?),
            None => None,
        };
        Some(striker.approach(hertz))
    }
}

impl Impact {
    /// Critical time step of a blow of this striker, s, as far as `known` knows mass and stiffnesses.
    pub fn critical_time_step(
        &self,
        striker: &Striker,
        known: impl Fn(&Formula) -> Option<f64>,
    ) -> Option<f64> {
        let approach = self.contact.approach(striker, &known)?;
        Some(approach.critical_time_step(known(&self.mass)?, known(&self.stiffness)?))
    }
}
