//! A striker against one floor of a frame: the contact of an impact, the structure a vector. In: a frame, a striker, a
//! contact law, what a rig read. Out: targets, the motion of both bodies, the energy. It commands no rig.
//!
//! The paper's laws, rigid and limit, are those of the impact of one degree of freedom (eq. 4; `law::ImpulseContact`), with
//! every integrator: ½Ms joins M̂ at the struck degree of freedom alone. `restitution` is here the scheme of Moreau and
//! Jean with θ = ½: in a step at whose end the gap would be closed,
//!
//! ```text
//! p = max(0, [(Ẋs − Ẋ_f) + e(Ẋs − Ẋ)] / (e_sᵀM̂⁻¹e_s + 1/Ms)),   Ẋ₁ = Ẋ_f + M̂⁻¹e_s p,   Ẋs₁ = Ẋs − p/Ms
//! ```
//!
//! so that a blow is a jump of the velocities at a step's end and not, as with one degree of freedom, at its own instant.
//! `hertz` follows a blow in parts of a step, each with a factor of its own: it is for one degree of freedom.

use thiserror::Error;

use super::solver::{FrameError, FrameInput, FrameSolver, FrameState};
use crate::mechanics::contact::{ContactLaw, StepState};
use crate::mechanics::energy::Energies;
use crate::plan::Integrator;

/// All a frame's impact starts from.
#[derive(Clone, Copy, Debug)]
pub struct FrameImpactInput<'a> {
    pub frame: FrameInput<'a>,
    /// The struck degree of freedom, from 0.
    pub struck: usize,
    /// Ms, kg
    pub striker_mass: f64,
    /// V0, m/s
    pub striker_velocity: f64,
    /// m, at least 0
    pub gap: f64,
    pub law: ContactLaw,
}

/// Why there is no impact to follow.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameImpactError {
    #[error(transparent)]
    Frame(#[from] FrameError),
    #[error("degree of freedom {} is struck, but there are {order}", struck + 1)]
    NoSuchPlace { struck: usize, order: usize },
    #[error("hertz contact is for one degree of freedom")]
    Hertz,
    #[error("restitution is integrated in tangent form only")]
    JumpsNeedTangent,
}

/// The striker and the contact at the end of a step; the frame's own state is beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrikerState {
    /// m
    pub displacement: f64,
    /// m/s
    pub velocity: f64,
    /// Impulse of the step over Δt, N.
    pub contact_force: f64,
    /// Permanent, m.
    pub indentation: f64,
    pub state: StepState,
    /// `striker + structure + restoring + damping + contact_loss + error` is ½MsV0² and the work of the loads.
    pub energies: Energies,
}

/// The impact on a rig: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct FrameImpactSolver {
    frame: FrameSolver,
    contact: Contact,
    time_step: f64,
    input_energy: f64,
    striker: StrikerState,
    state: StepState,
}

/// What decides on the contact force.
#[derive(Clone, Copy, Debug)]
struct Contact {
    struck: usize,
    law: ContactLaw,
    striker_mass: f64,
}

/// Striker and struck floor at a step's start.
#[derive(Clone, Copy)]
struct Start {
    displacement: f64,
    velocity: f64,
    striker_displacement: f64,
    striker_velocity: f64,
    indentation: f64,
}

impl Contact {
    /// F of a step, N: at most what the law bears, never a pull.
    fn force(&self, start: &Start, time_step: f64, free: f64, response: f64) -> (StepState, f64) {
        let yielding = time_step / self.striker_mass + response;
        match self.law {
            ContactLaw::Restitution { coefficient } => {
                let place = start.displacement + 0.5 * time_step * (start.velocity + free);
                if start.striker_displacement + time_step * start.striker_velocity < place {
                    return (StepState::Free, 0.0);
                }
                let closing = start.striker_velocity - start.velocity;
                let needed = (start.striker_velocity - free + coefficient * closing) / yielding;
                if needed > 0.0 { (StepState::Contact, needed) } else { (StepState::Free, 0.0) }
            }
            law => {
                // No tolerance: δp was stored as this very difference.
                if start.striker_displacement - start.displacement < start.indentation {
                    return (StepState::Free, 0.0);
                }
                let limit = if let ContactLaw::Limit { force } = law { force } else { f64::INFINITY };
                let needed = (start.striker_velocity - free) / yielding;
                match needed {
                    needed if needed > limit => (StepState::Limit, limit),
                    needed if needed >= 0.0 => (StepState::Contact, needed),
                    _ => (StepState::Free, 0.0),
                }
            }
        }
    }

    const fn jumps(&self) -> bool {
        matches!(self.law, ContactLaw::Restitution { .. })
    }
}

impl FrameImpactSolver {
    /// # Errors
    /// If the frame is none, the struck place is not in it, or law and integrator do not go together.
    pub fn new(input: &FrameImpactInput) -> Result<Self, FrameImpactError> {
        let order = input.frame.matrices.order();
        let contact = Contact { struck: input.struck, law: input.law, striker_mass: input.striker_mass };
        if input.struck >= order {
            return Err(FrameImpactError::NoSuchPlace { struck: input.struck, order });
        }
        if matches!(input.law, ContactLaw::Hertz { .. }) {
            return Err(FrameImpactError::Hertz);
        }
        if contact.jumps() && input.frame.integrator != Integrator::Tangent {
            return Err(FrameImpactError::JumpsNeedTangent);
        }
        let mut frame = FrameSolver::new(&input.frame)?;
        frame.strike(input.struck, contact.jumps())?;
        let input_energy = 0.5 * input.striker_mass * input.striker_velocity * input.striker_velocity;
        let striker = StrikerState {
            displacement: input.frame.initial_displacement[input.struck] - input.gap,
            velocity: input.striker_velocity,
            contact_force: 0.0,
            indentation: 0.0,
            state: StepState::Free,
            energies: Energies { striker: input_energy, ..Energies::default() },
        };
        Ok(Self { frame, contact, time_step: input.frame.time_step, input_energy, striker, state: StepState::Free })
    }

    fn start(&self) -> Start {
        let (frame, striker) = (self.frame.state(), &self.striker);
        Start {
            displacement: frame.displacement[self.contact.struck],
            velocity: frame.velocity[self.contact.struck],
            striker_displacement: striker.displacement,
            striker_velocity: striker.velocity,
            indentation: striker.indentation,
        }
    }

    /// Displacements to command in this step, m, under the loads at its end (N).
    pub fn predict(&mut self, load_end: &[f64]) -> &[f64] {
        let (start, time_step) = (self.start(), self.time_step);
        let Self { frame, contact, state, .. } = self;
        frame.predict_with(load_end, &mut |free, response| {
            let force;
            (*state, force) = contact.force(&start, time_step, free, response);
            force
        })
    }

    /// Ends the step with what was measured at the targets.
    pub fn complete(&mut self, measured_displacement: &[f64], restoring_force: &[f64]) -> (&FrameState, &StrikerState) {
        let (start, time_step) = (self.start(), self.time_step);
        let Self { frame, contact, state, .. } = self;
        frame.complete_with(measured_displacement, restoring_force, &mut |free, response| {
            let force;
            (*state, force) = contact.force(&start, time_step, free, response);
            force
        });
        self.follow(&start);
        (self.frame.state(), &self.striker)
    }

    /// The striker, and the energies of both.
    fn follow(&mut self, start: &Start) {
        let (frame, time_step, mass) = (self.frame.state(), self.time_step, self.contact.striker_mass);
        let force = self.frame.contact_force();
        let (place, speed) = (frame.displacement[self.contact.struck], frame.velocity[self.contact.struck]);
        let velocity = match self.state {
            StepState::Free => start.striker_velocity,
            StepState::Contact if !self.contact.jumps() => speed,
            _ => start.striker_velocity - force * time_step / mass,
        };
        let striker_moved = 0.5 * time_step * (start.striker_velocity + velocity);
        let displacement = start.striker_displacement + striker_moved;
        let mut indentation = start.indentation;
        if self.state == StepState::Limit {
            indentation = indentation.max(displacement - place);
        }
        // A force acts at both ends of a step, of which the trapezoid gives the structure the mean; a jump acts in its own.
        let way = 0.5 * time_step * (start.velocity + speed);
        let given = if self.contact.jumps() { force } else { 0.5 * (self.striker.contact_force + force) };
        let dented = if self.state == StepState::Limit { force * (indentation - start.indentation) } else { 0.0 };
        let before = &self.striker.energies;
        let mut energies = Energies {
            striker: 0.5 * mass * velocity * velocity,
            structure: frame.energies.kinetic,
            restoring: frame.energies.restoring,
            damping: frame.energies.damping,
            contact_loss: before.contact_loss + force * striker_moved - given * way,
            indentation: before.indentation + dented,
            weight: 0.0,
            error: 0.0,
        };
        energies.error = self.input_energy + frame.energies.input
            - (energies.striker + energies.structure + energies.restoring + energies.damping + energies.contact_loss);
        self.striker = StrikerState { displacement, velocity, contact_force: force, indentation, state: self.state, energies };
    }

    #[must_use]
    pub const fn frame(&self) -> &FrameState {
        self.frame.state()
    }

    #[must_use]
    pub const fn striker(&self) -> &StrikerState {
        &self.striker
    }

    /// Whether the last step ended with the striker and the struck floor no longer on their way.
    #[must_use]
    pub fn finished(&self) -> bool {
        let frame = self.frame.state();
        frame.step > 0 && self.striker.velocity <= 0.0 && frame.velocity[self.contact.struck] <= 0.0
    }
}
