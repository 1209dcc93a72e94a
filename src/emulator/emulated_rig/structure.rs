//! The structure on an emulated rig: a specimen of one degree of freedom, or a frame with an actuator at every floor. In: positions and
//! moves of the actuators. Out: the restoring force at each. It knows no rig and no sensor.

use crate::physics::relaxation::maxwell::Motion;
use crate::physics::relaxation::relaxation_state::{Deformed, RelaxationState};
use crate::physics::specimen::SpecimenModel;
use crate::physics::structure::cell_damping::CellDamping;
use crate::physics::structure::{drifts, floor_forces};
use crate::plan::{Behaviour, Frame, Storey};

#[derive(Debug)]
pub(crate) enum Structure {
    One {
        specimen: Box<SpecimenModel>,
        damping: CellDamping,
        relaxing: Box<RelaxationState>,
        force: f64,
    },
    /// Each storey has a restoring-force model and damping.
    Storeys {
        models: Vec<SpecimenModel>,
        dampers: Vec<CellDamping>,
        relaxing: Vec<RelaxationState>,
        shear: Vec<f64>,
    },
    /// R = K X, row by row.
    Matrix(Vec<Vec<f64>>),
}

impl Structure {
    /// `damping`: c of c·v \[N·s/m\].
    pub(crate) fn of_one(behaviour: &Behaviour, damping: f64) -> Self {
        let specimen = Box::new(SpecimenModel::new(behaviour));
        let damping = CellDamping::new(damping, 0.0).with_rate_of(behaviour);
        Self::One {
            specimen,
            damping,
            relaxing: Box::new(RelaxationState::new(behaviour)),
            force: 0.0,
        }
    }

    pub(crate) fn of_frame(frame: &Frame) -> Self {
        if frame.storeys.is_empty() {
            return Self::Matrix(frame.stiffness.clone());
        }
        let damper = |storey: &Storey| {
            CellDamping::new(storey.damping, storey.coulomb).with_rate_of(&storey.behaviour)
        };
        Self::Storeys {
            models: frame
                .storeys
                .iter()
                .map(|storey| SpecimenModel::new(&storey.behaviour))
                .collect(),
            dampers: frame.storeys.iter().map(damper).collect(),
            relaxing: frame
                .storeys
                .iter()
                .map(|storey| RelaxationState::new(&storey.behaviour))
                .collect(),
            shear: vec![0.0; frame.storeys.len()],
        }
    }

    /// Calculates the restoring forces \[N\] at these positions of the actuators \[m\]. The last increments \[m\] took the time
    /// `going` at constant velocity. The actuators were at rest for the other `seconds`.
    pub(crate) fn bend(
        &mut self,
        positions: &[f64],
        moved: &[f64],
        going: f64,
        seconds: f64,
    ) -> Vec<f64> {
        let bent = |specimen: &mut SpecimenModel,
                    relaxing: &mut RelaxationState,
                    force: f64,
                    position: f64,
                    moved: f64| {
            let velocity = if moved == 0.0 { 0.0 } else { moved / going };
            let force = relaxing.advance(
                specimen,
                &Motion::even(velocity, going),
                Deformed {
                    displacement: position - moved,
                    force,
                },
                position,
            );
            relaxing.advance(
                specimen,
                &Motion::rest(seconds - going),
                Deformed {
                    displacement: position,
                    force,
                },
                position,
            )
        };
        match self {
            Self::One {
                specimen,
                relaxing,
                force,
                ..
            } => {
                *force = bent(specimen, relaxing, *force, positions[0], moved[0]);
                vec![*force]
            }
            Self::Storeys {
                models,
                relaxing,
                shear,
                ..
            } => {
                let (mut drift, mut apart, mut forces) = (
                    vec![0.0; positions.len()],
                    vec![0.0; positions.len()],
                    vec![0.0; positions.len()],
                );
                drifts(positions, &mut drift);
                drifts(moved, &mut apart);
                let storeys = models
                    .iter_mut()
                    .zip(relaxing)
                    .zip(&mut *shear)
                    .zip(drift.into_iter().zip(apart));
                for (((model, relaxing), shear), (drift, moved)) in storeys {
                    *shear = bent(model, relaxing, *shear, drift, moved);
                }
                floor_forces(shear, &mut forces);
                forces
            }
            Self::Matrix(rows) => rows
                .iter()
                .map(|row| row.iter().zip(positions).map(|(k, x)| k * x).sum())
                .collect(),
        }
    }

    /// Calculates the forces on the load cells from `forces` \[N\] at these velocities of the actuators \[m/s\].
    pub(crate) fn actuator_forces(&mut self, forces: &[f64], velocities: &[f64]) -> Vec<f64> {
        match self {
            Self::One {
                damping, relaxing, ..
            } => {
                let relaxing = relaxing.force();
                forces
                    .iter()
                    .zip(velocities)
                    .map(|(force, v)| damping.measured_force(*force, *v) + relaxing)
                    .collect()
            }
            Self::Storeys {
                dampers,
                relaxing,
                shear,
                ..
            } => {
                let mut apart = vec![0.0; velocities.len()];
                drifts(velocities, &mut apart);
                // A fault can reduce the specimen's force. Only the forces in parallel with it are added here.
                let relaxing = relaxing.iter().map(RelaxationState::force);
                let storeys = dampers.iter_mut().zip(&*shear).zip(apart).zip(relaxing);
                let beside = storeys.map(|(((damper, shear), v), relaxing)| {
                    damper.measured_force(*shear, v) - shear + relaxing
                });
                let mut more = vec![0.0; velocities.len()];
                floor_forces(&beside.collect::<Vec<f64>>(), &mut more);
                forces
                    .iter()
                    .zip(more)
                    .map(|(force, more)| force + more)
                    .collect()
            }
            Self::Matrix(_) => forces.to_vec(),
        }
    }

    /// Sets the friction on the load cell of a specimen of one degree of freedom \[N\].
    pub(crate) const fn set_friction(&mut self, friction: f64) {
        if let Self::One { damping, .. } = self {
            damping.coulomb = friction;
        }
    }

    /// Sets the present velocities of the actuators \[m/s\]: friction acts against the last motion.
    pub(crate) fn goes(&mut self, velocities: &[f64]) {
        let mut apart = vec![0.0; velocities.len()];
        drifts(velocities, &mut apart);
        let dampers = match self {
            Self::One { damping, .. } => std::slice::from_mut(damping),
            Self::Storeys { dampers, .. } => dampers,
            Self::Matrix(_) => return,
        };
        for (damper, velocity) in dampers
            .iter_mut()
            .zip(apart)
            .filter(|(_, velocity)| *velocity != 0.0)
        {
            damper.last_direction = velocity.signum();
        }
    }
}
