//! An impact, step by step: prediction, the force read back, the tangent stiffness, the energies. It commands no rig:
//! whoever does asks for the next displacement and gives back what was measured there.

use super::contact::{ContactLaw, StepState};
use super::energy::Energies;
use super::integrator::Motion;
use super::law::{Advance, AnyContact, Bodies, Law, Start};
use super::specimen::RestoringForce;

/// A tangent stiffness needs a change of force this many times the load cell's noise.
const NOISE_MULTIPLE: f64 = 10.0;

/// All an impact starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactInput {
    /// M, kg
    pub mass: f64,
    /// C, N·s/m
    pub damping: f64,
    /// K0, N/m
    pub stiffness: f64,
    /// Ms, kg
    pub striker_mass: f64,
    /// V0, m/s
    pub striker_velocity: f64,
    /// m, at least 0
    pub gap: f64,
    /// Acceleration of the striker along its way, m/s²: gn of a weight that falls.
    pub gravity: f64,
    /// Δt, s
    pub time_step: f64,
    /// c of `K_t within [0, c·K0]`
    pub max_tangent_ratio: f64,
    pub law: ContactLaw,
    /// Standard deviation of the load cell, N.
    pub force_noise: f64,
    /// Of the displacement reading, m.
    pub resolution: f64,
}

impl ImpactInput {
    #[must_use]
    pub const fn bodies(&self) -> Bodies {
        Bodies {
            mass: self.mass,
            damping: self.damping,
            striker_mass: self.striker_mass,
            gravity: self.gravity,
            time_step: self.time_step,
        }
    }

    /// ½ Ms V0², J.
    #[must_use]
    pub fn striker_energy(&self) -> f64 {
        0.5 * self.striker_mass * self.striker_velocity * self.striker_velocity
    }
}

/// The end of a step; step 0 is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactState {
    pub step: u64,
    /// s
    pub time: f64,
    /// Computed X, m.
    pub displacement: f64,
    /// m
    pub measured_displacement: f64,
    /// m/s
    pub velocity: f64,
    /// m/s²
    pub acceleration: f64,
    /// N
    pub restoring_force: f64,
    /// Mean over the step, N.
    pub contact_force: f64,
    /// m
    pub striker_displacement: f64,
    /// m/s
    pub striker_velocity: f64,
    /// N/m, for the step to come.
    pub tangent_stiffness: f64,
    /// Permanent, m.
    pub indentation: f64,
    pub state: StepState,
    /// Under `hertz` the contact loss holds also the energy stored in the contact, given back as it opens.
    pub energies: Energies,
}

/// The step of one contact law: the code that the interactive solver and the simulation share.
#[derive(Clone, Debug)]
struct Step<L> {
    bodies: Bodies,
    law: L,
    input_energy: f64,
    /// m, the smallest change of measured displacement that gives a stiffness.
    least_change: f64,
    largest_tangent: f64,
    state: ImpactState,
}

impl<L: Law> Step<L> {
    fn new(input: &ImpactInput, law: L, displacement: f64, restoring_force: f64) -> Self {
        let input_energy = input.striker_energy();
        Self {
            bodies: input.bodies(),
            law,
            input_energy,
            least_change: input.resolution.max(NOISE_MULTIPLE * input.force_noise / input.stiffness),
            largest_tangent: input.max_tangent_ratio * input.stiffness,
            state: ImpactState {
                step: 0,
                time: 0.0,
                displacement,
                measured_displacement: displacement,
                velocity: 0.0,
                acceleration: -restoring_force / input.mass,
                restoring_force,
                contact_force: 0.0,
                striker_displacement: displacement - input.gap,
                striker_velocity: input.striker_velocity,
                tangent_stiffness: input.stiffness,
                indentation: 0.0,
                state: StepState::Free,
                energies: Energies { striker: input_energy, ..Energies::default() },
            },
        }
    }

    #[inline]
    fn advance(&mut self) -> Advance {
        let state = &self.state;
        let start = Start {
            structure: Motion {
                displacement: state.displacement,
                velocity: state.velocity,
                acceleration: state.acceleration,
                restoring_force: state.restoring_force,
            },
            striker_displacement: state.striker_displacement,
            striker_velocity: state.striker_velocity,
            contact_force: state.contact_force,
            tangent_stiffness: state.tangent_stiffness,
            indentation: state.indentation,
        };
        self.law.advance(&self.bodies, &start)
    }

    /// Eq. (6): the secant of what was measured, or the last one where the change is too small to tell.
    #[inline]
    fn tangent(&self, measured_displacement: f64, restoring_force: f64) -> f64 {
        let change = measured_displacement - self.state.measured_displacement;
        if change.abs() > self.least_change {
            ((restoring_force - self.state.restoring_force) / change).clamp(0.0, self.largest_tangent)
        } else {
            self.state.tangent_stiffness
        }
    }

    #[inline]
    fn accept(&mut self, advance: &Advance, measured_displacement: f64, restoring_force: f64) {
        let tangent_stiffness = self.tangent(measured_displacement, restoring_force);
        let before = &self.state;
        let Motion { displacement, velocity, acceleration, .. } = advance.structure;
        let moved = displacement - before.displacement;
        let mut energies = Energies {
            striker: 0.5 * self.bodies.striker_mass * advance.striker_velocity * advance.striker_velocity,
            structure: 0.5 * self.bodies.mass * velocity * velocity,
            restoring: before.energies.restoring + 0.5 * (before.restoring_force + restoring_force) * moved,
            damping: before.energies.damping + advance.damping_work,
            contact_loss: before.energies.contact_loss + advance.contact_loss,
            indentation: before.energies.indentation + advance.indentation_work,
            weight: before.energies.weight
                + self.bodies.striker_mass * self.bodies.gravity * (advance.striker_displacement - before.striker_displacement),
            error: 0.0,
        };
        energies.error = self.input_energy + energies.weight
            - (energies.striker + energies.structure + energies.restoring + energies.damping + energies.contact_loss);
        let step = before.step + 1;
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = step as f64 * self.bodies.time_step;
        self.state = ImpactState {
            step,
            time,
            displacement,
            measured_displacement,
            velocity,
            acceleration,
            restoring_force,
            contact_force: advance.contact_force,
            striker_displacement: advance.striker_displacement,
            striker_velocity: advance.striker_velocity,
            tangent_stiffness,
            indentation: advance.indentation,
            state: advance.state,
            energies,
        };
    }
}

/// The impact on a rig: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct ImpactSolver {
    step: Step<AnyContact>,
    predicted: Option<Advance>,
    striker_stopped: bool,
    /// K0, N/m
    stiffness: f64,
}

impl ImpactSolver {
    /// R₀ is read once before the first step; M Ẍ₀ = −CẊ₀ − R₀ with the structure at rest.
    #[must_use]
    pub fn new(input: &ImpactInput, initial_displacement: f64, initial_restoring_force: f64) -> Self {
        let law = AnyContact::new(input.law, &input.bodies(), input.striker_velocity);
        let step = Step::new(input, law, initial_displacement, initial_restoring_force);
        Self { step, predicted: None, striker_stopped: false, stiffness: input.stiffness }
    }

    /// Displacement to command for the end of the step, m. Asked again before `complete`, it is the same.
    pub fn predict(&mut self) -> f64 {
        let step = &mut self.step;
        self.predicted.get_or_insert_with(|| step.advance()).structure.displacement
    }

    /// Ends the step with what was measured at its end.
    pub fn complete(&mut self, measured_displacement: f64, restoring_force: f64) -> &ImpactState {
        let advance = self.predicted.take().unwrap_or_else(|| self.step.advance());
        self.step.accept(&advance, measured_displacement, restoring_force);
        self.striker_stopped |= self.step.state.striker_velocity <= 0.0;
        &self.step.state
    }

    #[must_use]
    pub const fn state(&self) -> &ImpactState {
        &self.step.state
    }

    /// Whether some step has ended with Ẋs ≤ 0.
    #[must_use]
    pub const fn striker_stopped(&self) -> bool {
        self.striker_stopped
    }

    /// Whether striker and structure are apart for good, as far as the structure is elastic from here on: the striker
    /// moves back, and either faster than the structure ever can, `√(Ẋ² + R²/(M K0))`, or from behind where it can get
    /// to. A striker that falls always comes back.
    #[must_use]
    pub fn rebounded(&self) -> bool {
        let state = &self.step.state;
        let Bodies { mass, gravity, .. } = self.step.bodies;
        let (gap, back) = (state.striker_displacement - state.displacement, -state.striker_velocity);
        if state.step == 0 || gravity > 0.0 || state.state != StepState::Free || gap >= state.indentation || back <= 0.0 {
            return false;
        }
        let fastest = state.velocity.hypot(state.restoring_force / (mass * self.stiffness).sqrt());
        let farthest = state.displacement - state.restoring_force / self.stiffness - fastest * (mass / self.stiffness).sqrt();
        back >= fastest || state.striker_displacement < farthest + state.indentation
    }

    /// Whether the last step ended with Ẋs ≤ 0 and Ẋ ≤ 0.
    #[must_use]
    pub fn finished(&self) -> bool {
        let state = &self.step.state;
        state.step > 0 && state.striker_velocity <= 0.0 && state.velocity <= 0.0
    }
}

/// Takes the steps of a simulation.
pub trait Sink {
    fn push(&mut self, state: &ImpactState);
}

/// Keeps nothing.
impl Sink for () {
    fn push(&mut self, _: &ImpactState) {}
}

/// Columns to fill again and again: memory once touched is a quarter of the price.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    pub time: Vec<f64>,
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
    pub restoring_force: Vec<f64>,
    pub contact_force: Vec<f64>,
    pub striker_displacement: Vec<f64>,
    pub striker_velocity: Vec<f64>,
    pub tangent_stiffness: Vec<f64>,
}

impl Columns {
    fn all(&mut self) -> [&mut Vec<f64>; 8] {
        [
            &mut self.time,
            &mut self.displacement,
            &mut self.velocity,
            &mut self.restoring_force,
            &mut self.contact_force,
            &mut self.striker_displacement,
            &mut self.striker_velocity,
            &mut self.tangent_stiffness,
        ]
    }

    /// Empty, with room for so many steps: filling them then takes no memory.
    pub fn prepare(&mut self, steps: usize) {
        for column in self.all() {
            column.clear();
            column.reserve(steps);
        }
    }
}

impl Sink for Columns {
    #[inline]
    fn push(&mut self, state: &ImpactState) {
        self.time.push(state.time);
        self.displacement.push(state.displacement);
        self.velocity.push(state.velocity);
        self.restoring_force.push(state.restoring_force);
        self.contact_force.push(state.contact_force);
        self.striker_displacement.push(state.striker_displacement);
        self.striker_velocity.push(state.striker_velocity);
        self.tangent_stiffness.push(state.tangent_stiffness);
    }
}

/// An impact on an ideal rig, one law and one specimen compiled together: `steps` steps from rest at X = 0. The law is
/// the one given, whatever `input.law` says.
pub fn simulate<L: Law, S: RestoringForce, K: Sink>(
    input: &ImpactInput,
    law: L,
    specimen: &mut S,
    steps: u64,
    sink: &mut K,
) -> ImpactState {
    let mut step = Step::new(input, law, 0.0, specimen.move_to(0.0));
    for _ in 0..steps {
        let advance = step.advance();
        let restoring_force = specimen.move_to(advance.structure.displacement);
        step.accept(&advance, advance.structure.displacement, restoring_force);
        sink.push(&step.state);
    }
    step.state
}
