//! What stands on a bench: a specimen of one degree of freedom, or a frame with a ram at every floor. In: where the rams
//! stand. Out: the restoring force of each. It knows no rig, no sensor and no time.

use crate::mechanics::damping::CellDamping;
use crate::mechanics::frame::{drifts, floor_forces};
use crate::mechanics::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Frame};

#[derive(Debug)]
pub(super) enum Structure {
    One {
        specimen: Box<SpecimenModel>,
        damping: CellDamping,
    },
    /// Each storey resists its drift, and what it resists more the faster it is bent.
    Storeys {
        models: Vec<SpecimenModel>,
        rates: Vec<CellDamping>,
        shear: Vec<f64>,
    },
    /// R = K X, row by row.
    Matrix(Vec<Vec<f64>>),
}

impl Structure {
    /// `damping`: c of c·v, N·s/m.
    pub(super) fn of_one(behaviour: &Behaviour, damping: f64) -> Self {
        let specimen = Box::new(SpecimenModel::new(behaviour));
        Self::One { specimen, damping: CellDamping::new(damping, 0.0).with_rate_of(behaviour) }
    }

    pub(super) fn of_frame(frame: &Frame) -> Self {
        if frame.storeys.is_empty() {
            return Self::Matrix(frame.stiffness.clone());
        }
        let storeys = || frame.storeys.iter().map(|storey| &storey.behaviour);
        Self::Storeys {
            models: storeys().map(SpecimenModel::new).collect(),
            rates: storeys().map(|behaviour| CellDamping::new(0.0, 0.0).with_rate_of(behaviour)).collect(),
            shear: vec![0.0; frame.storeys.len()],
        }
    }

    /// Restoring forces (N) with the rams at these places (m).
    pub(super) fn bend(&mut self, places: &[f64]) -> Vec<f64> {
        match self {
            Self::One { specimen, .. } => places.iter().map(|place| specimen.move_to(*place)).collect(),
            Self::Storeys { models, shear, .. } => {
                let (mut drift, mut forces) = (vec![0.0; places.len()], vec![0.0; places.len()]);
                drifts(places, &mut drift);
                for ((shear, model), drift) in shear.iter_mut().zip(models).zip(drift) {
                    *shear = model.move_to(drift);
                }
                floor_forces(shear, &mut forces);
                forces
            }
            Self::Matrix(rows) => rows.iter().map(|row| row.iter().zip(places).map(|(k, x)| k * x).sum()).collect(),
        }
    }

    /// What the cells feel of `forces` (N) while the rams go at these velocities (m/s).
    pub(super) fn felt(&mut self, forces: &[f64], velocities: &[f64]) -> Vec<f64> {
        match self {
            Self::One { damping, .. } => forces.iter().zip(velocities).map(|(force, v)| damping.felt(*force, *v)).collect(),
            Self::Storeys { rates, shear, .. } if velocities.iter().any(|velocity| *velocity != 0.0) => {
                let mut apart = vec![0.0; velocities.len()];
                drifts(velocities, &mut apart);
                // What a fault of the specimen took away is not felt either: only what speed adds is added.
                let added = rates.iter_mut().zip(&*shear).zip(apart).map(|((rate, shear), v)| rate.felt(*shear, v) - shear);
                let mut more = vec![0.0; velocities.len()];
                floor_forces(&added.collect::<Vec<f64>>(), &mut more);
                forces.iter().zip(more).map(|(force, more)| force + more).collect()
            }
            Self::Storeys { .. } | Self::Matrix(_) => forces.to_vec(),
        }
    }

    /// Friction on the cell of a specimen of one degree of freedom, N.
    pub(super) const fn set_friction(&mut self, friction: f64) {
        if let Self::One { damping, .. } = self {
            damping.coulomb = friction;
        }
    }

    /// The ram goes this way now: friction is against the last motion.
    pub(super) const fn goes(&mut self, direction: f64) {
        if let Self::One { damping, .. } = self {
            damping.last_direction = direction;
        }
    }
}
