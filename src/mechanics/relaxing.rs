//! All that relaxes with a specimen: branches beside it, and what it loses of its own force. In: a behaviour, then how it was
//! moved, in time, and its force. Out: what the load cell feels more. The rigs carry it, for a behaviour knows nothing of time.

use super::logarithmic::{LossOfReached, Went};
use super::maxwell::{MaxwellBranch, Travel};
use crate::plan::Behaviour;

/// What the load cell feels beside the behaviour that was moved.
#[derive(Clone, Debug, Default)]
pub struct Relaxing {
    /// The outermost first.
    beside: Vec<MaxwellBranch>,
    lost: Option<LossOfReached>,
}

impl Relaxing {
    /// Of a specimen that nobody has moved yet.
    #[must_use]
    pub fn of(behaviour: &Behaviour) -> Self {
        let mut left = behaviour;
        let mut beside = Vec::new();
        while let Behaviour::Maxwell { of, stiffness, time_constant } = left {
            beside.push(MaxwellBranch::new(*stiffness, *time_constant));
            left = of;
        }
        let lost = match left {
            Behaviour::Logarithmic { of, share, reference_time, longest } => {
                Some(LossOfReached::new(*share, *reference_time, *longest, of.largest_stiffness()))
            }
            _ => None,
        };
        Self { beside, lost }
    }

    /// Whether nothing relaxes.
    #[must_use]
    pub const fn is_none(&self) -> bool {
        self.beside.is_empty() && self.lost.is_none()
    }

    /// `travel` is how the specimen was moved, `went` how far, and the force it has without this.
    pub fn follow(&mut self, travel: &Travel, went: Went) {
        for branch in &mut self.beside {
            branch.follow(travel);
        }
        if let Some(lost) = &mut self.lost {
            lost.follow(travel, went);
        }
    }

    /// N, beside the specimen's own.
    #[must_use]
    pub fn force(&self) -> f64 {
        let beside: f64 = self.beside.iter().map(MaxwellBranch::force).sum();
        self.lost.as_ref().map_or(beside, |lost| beside + lost.force())
    }

    /// What it adds to the stiffness of a fast move, N/m.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.beside.iter().map(MaxwellBranch::stiffness).sum()
    }

    /// All that dies away at rest.
    pub fn dying(&self) -> impl Iterator<Item = &MaxwellBranch> {
        self.beside.iter().chain(self.lost.iter().flat_map(LossOfReached::branches))
    }
}
