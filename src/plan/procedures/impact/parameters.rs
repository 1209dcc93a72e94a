//! A checked `impact`: a computed striker meets a structure on the rig, either one degree of freedom or one floor of a frame. In:
//! formulas from the check. Out: SI numbers, and the critical time step if its inputs are known. It integrates nothing.

use crate::formula::Formula;
use crate::{ShakeDamping, Stepping, Striker, Until};
use psd_physics::contact::contact_time_step::Approach;
use psd_physics::contact::{ContactLaw, ContactSpring};

/// A striker, which is computed, meets a structure, which is on the rig (Melo et al. 2006, eqs. 4 and 5).
#[derive(Clone, Debug)]
pub struct Impact {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// Index into `Plan::strikers`.
    pub striker: usize,
    pub target: ImpactTarget,
    pub contact: Contact,
    pub stepping: Stepping,
    /// Upper bound of the simulated time \[s\].
    pub duration: Formula,
    pub until: Until,
}

/// The part of the specimen that the striker meets.
#[derive(Clone, Debug)]
pub enum ImpactTarget {
    /// A specimen of one degree of freedom.
    Point(PointTarget),
    /// One floor of a frame.
    Storey(StoreyTarget),
}

/// A struck degree of freedom.
#[derive(Clone, Debug)]
pub struct PointTarget {
    /// M \[kg\].
    pub mass: Formula,
    /// Standard uncertainty of the mass of the specimen \[kg\]; 0 if none is stated or if the mass is not the specimen's.
    pub mass_uncertainty: f64,
    /// K0 \[N/m\].
    pub stiffness: Formula,
    /// C of eqs. 4–5 \[N·s/m\].
    pub damping: Formula,
}

/// A struck floor; the specimen has a frame.
#[derive(Clone, Debug)]
pub struct StoreyTarget {
    /// The struck floor, from 0.
    pub storey: usize,
    pub damping: ShakeDamping,
    /// Standard uncertainty of each damping ratio; 0 if none is stated.
    pub damping_uncertainty: f64,
}

impl Impact {
    /// The struck degree of freedom; None if a floor is struck.
    #[must_use]
    pub const fn point(&self) -> Option<&PointTarget> {
        match &self.target {
            ImpactTarget::Point(point) => Some(point),
            ImpactTarget::Storey(_) => None,
        }
    }

    /// The struck floor; None if one degree of freedom is struck.
    #[must_use]
    pub const fn storey(&self) -> Option<&StoreyTarget> {
        match &self.target {
            ImpactTarget::Point(_) => None,
            ImpactTarget::Storey(storey) => Some(storey),
        }
    }

    /// State of the striker at contact, if `known` contains the stiffness of the contact law.
    pub fn approach(
        &self,
        striker: &Striker,
        known: impl Fn(&Formula) -> Option<f64>,
    ) -> Option<Approach> {
        let spring = match self.contact.spring() {
            Some(spring) => Some(ContactSpring {
                stiffness: known(spring.stiffness)?,
                exponent: spring.exponent,
            }),
            None => None,
        };
        Some(striker.approach(spring))
    }

    /// Critical time step of an impact of this striker on one degree of freedom \[s\], if `known` contains mass and stiffnesses. None if
    /// a floor is struck.
    pub fn critical_time_step(
        &self,
        striker: &Striker,
        known: impl Fn(&Formula) -> Option<f64>,
    ) -> Option<f64> {
        let PointTarget {
            mass, stiffness, ..
        } = self.point()?;
        let approach = self.approach(striker, &known)?;
        Some(approach.critical_time_step(known(mass)?, known(stiffness)?))
    }
}

/// The contact law of striker and structure, with formulas for its numbers.
pub type Contact = ContactLaw<Formula>;
