//! Actuators of an emulated rig along the height of a storey, behind all others, with the force control of their controller. In: a force and
//! its rate, time, the drift of the storey. Out: the force, its P-Δ, the displacement. The column does not shorten by its force, only
//! by its drift: u²/(2 h). So a displacement that is held keeps the force.

use super::actuator::ActuatorSettings;
use super::{ActuatorModel, EmulatedRig, seed_of};
use psd_plan::{AxialColumn, Interval};

/// What the controller keeps \[N\], \[N/s\], and the band of the displacement in its own coordinate \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceControl {
    pub target: f64,
    pub rate: f64,
    pub tolerance: f64,
    pub band: Interval,
}

/// Why the controller left force control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftForceControl {
    Band,
    Cell,
}

#[derive(Debug)]
pub struct AxialActuator {
    column: AxialColumn,
    /// In the coordinate of its controller \[N\].
    force: f64,
    /// None: it holds its displacement.
    control: Option<ForceControl>,
    left: Option<LeftForceControl>,
}

impl AxialActuator {
    fn moving(&self) -> bool {
        self.control
            .is_some_and(|control| control.target != self.force)
    }

    /// Its force after further `seconds`; whether it changed.
    fn advance(&mut self, seconds: f64) -> bool {
        let Some(control) = self.control.filter(|_| self.moving()) else {
            return false;
        };
        let (left, step) = (control.target - self.force, control.rate * seconds);
        self.force = if left.abs() <= step {
            control.target
        } else {
            self.force + step.copysign(left)
        };
        true
    }
}

impl EmulatedRig {
    /// Adds axial actuators behind the others.
    #[must_use]
    pub fn with_axial(mut self, axial: &[(ActuatorSettings, AxialColumn)]) -> Self {
        for (settings, column) in axial {
            let number = self.actuators.len() as u64;
            let seed = seed_of(self.settings.seed, number);
            self.actuators.push(ActuatorModel::new(*settings, seed));
            self.axial.push(AxialActuator {
                column: *column,
                force: 0.0,
                control: None,
                left: None,
            });
        }
        self
    }

    /// Number of actuators that move a storey sideways, or an element.
    pub(super) const fn lateral(&self) -> usize {
        self.actuators.len() - self.axial.len()
    }

    fn axial_of(&self, actuator: usize) -> Option<&AxialActuator> {
        self.axial.get(actuator.checked_sub(self.lateral())?)
    }

    fn axial_of_mut(&mut self, actuator: usize) -> Option<&mut AxialActuator> {
        let index = actuator.checked_sub(self.lateral())?;
        self.axial.get_mut(index)
    }

    /// Whether the actuator with this index loads a storey along its height.
    #[must_use]
    pub fn is_axial(&self, actuator: usize) -> bool {
        self.axial_of(actuator).is_some()
    }

    /// The actuator goes to a force and holds it from now on.
    pub fn control_force(&mut self, actuator: usize, control: ForceControl) {
        if let Some(axial) = self.axial_of_mut(actuator) {
            axial.control = Some(control);
        }
    }

    /// The present force control of the actuator; None: it holds its displacement.
    #[must_use]
    pub fn force_control(&self, actuator: usize) -> Option<ForceControl> {
        self.axial_of(actuator)?.control
    }

    /// Why the actuator left force control, until it is cleared.
    #[must_use]
    pub fn left_force_control(&self, actuator: usize) -> Option<LeftForceControl> {
        self.axial_of(actuator)?.left
    }

    /// The controller clears the reason.
    pub fn clear_left_force_control(&mut self, actuator: usize) {
        if let Some(axial) = self.axial_of_mut(actuator) {
            axial.left = None;
        }
    }

    /// A controller that starts holds displacements.
    pub fn end_force_control(&mut self, actuator: usize) {
        if let Some(axial) = self.axial_of_mut(actuator) {
            (axial.control, axial.left) = (None, None);
        }
    }

    /// The force of the axial actuator with this index \[N\], without errors of its load cell. None: it moves a storey sideways.
    #[must_use]
    pub fn axial_force(&self, actuator: usize) -> Option<f64> {
        self.axial_of(actuator).map(|axial| axial.force)
    }

    /// The force stops to change, and is held.
    pub(super) fn hold_force(&mut self, actuator: usize) {
        if let Some(axial) = self.axial_of_mut(actuator) {
            let force = axial.force;
            if let Some(control) = &mut axial.control {
                control.target = force;
            }
        }
    }

    pub(super) fn force_moves(&self, actuator: usize) -> bool {
        self.axial_of(actuator).is_some_and(AxialActuator::moving)
    }

    /// The forces after further `seconds`, with their P-Δ; whether one changed.
    pub(super) fn advance_axial(&mut self, seconds: f64) -> bool {
        let lateral = self.lateral();
        let mut changed = false;
        for (axial, actuator) in self.axial.iter_mut().zip(&self.actuators[lateral..]) {
            changed |= axial.advance(seconds);
            let AxialColumn {
                tested,
                height,
                p_delta,
            } = axial.column;
            let compression = actuator.settings.sign * axial.force;
            self.structure.lean(tested, p_delta * compression / height);
        }
        changed
    }

    /// The displacements follow the drifts. The controller leaves force control where its transducer or its cell shows that it must.
    pub(super) fn follow_drifts(&mut self) {
        let (lateral, time) = (self.lateral(), self.time);
        let axes = self.axial.iter_mut().zip(&mut self.actuators[lateral..]);
        for (axial, actuator) in axes {
            let drift = self.structure.drift(axial.column.tested);
            let shortening = drift * drift / (2.0 * axial.column.height);
            actuator.come_to(actuator.settings.sign * shortening);
            let Some(control) = axial.control else {
                continue;
            };
            let displacement = actuator.faults.read_displacement(actuator.at, time);
            let sensed = actuator.faults.sense_force(axial.force, time);
            let left = if !control.band.contains(displacement) {
                Some(LeftForceControl::Band)
            } else if (sensed - axial.force).abs() > control.tolerance {
                Some(LeftForceControl::Cell)
            } else {
                None
            };
            if left.is_some() {
                (axial.control, axial.left) = (None, left);
            }
        }
    }
}
