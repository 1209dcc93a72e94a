//! An impact, step by step: prediction, the force read back, the tangent stiffness, the energies. It commands no rig:
//! whoever does asks for the next displacement and gives back what was measured there.

use super::contact::{ContactLaw, StepState};
use super::energy::Energies;
use super::integrator::Motion;
use super::law::{Advance, Bodies, Start};
use super::scheme::{AnyScheme, Scheme};
use super::specimen::RestoringForce;
use super::tangent::TangentStiffness;
use crate::plan::{Integrator, Until};

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
    pub integrator: Integrator,
    /// `K_I` of α-OS and of the I-modification, N/m.
    pub operator_stiffness: f64,
    /// Whether the recursion takes r* = `r_m` − `K_I`(`d_m` − d̃) in place of the reading: the force where the specimen was
    /// to be, as long as it is nearly elastic.
    pub i_modification: bool,
    /// Standard deviation of the load cell, N.
    pub force_noise: f64,
    /// Of the displacement reading, m.
    pub resolution: f64,
}

impl ImpactInput {
    /// What a contact law needs of both bodies and the step.
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

    /// What there is to be put into the test when it begins, J: the striker's ½ Ms V0², and of a specimen that carries a load
    /// already what it gives back elastically, `stored` = ½R²/K. What a weight that falls adds comes to it on the way.
    #[must_use]
    pub fn first_input(&self, stored: f64) -> f64 {
        self.striker_energy() + stored
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
    /// Imposed on the specimen, m: X itself, but under α-OS the place it was foretold at.
    pub target: f64,
    /// m
    pub measured_displacement: f64,
    /// m/s
    pub velocity: f64,
    /// m/s²
    pub acceleration: f64,
    /// Measured, N.
    pub restoring_force: f64,
    /// What the recursion takes for the force at X, N: the reading, but for what the I-modification and α-OS correct.
    pub force_at_computed: f64,
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
    /// Energy put into the test so far, J: what errors are shares of ([`ImpactInput::first_input`]).
    pub input: f64,
    /// Blows so far: contacts that began.
    pub contacts: u64,
}

/// The step of one scheme: the code that the interactive solver and the simulation share.
#[derive(Clone, Debug)]
struct Step<S> {
    bodies: Bodies,
    scheme: S,
    input_energy: f64,
    /// [`ImpactState::input`] but for the work of a weight, J.
    first_input: f64,
    tangent: TangentStiffness,
    /// `K_I` of the I-modification, N/m; 0 without it.
    modification: f64,
    state: ImpactState,
}

impl<S: Scheme> Step<S> {
    fn new(input: &ImpactInput, scheme: S, displacement: f64, restoring_force: f64) -> Self {
        let input_energy = input.striker_energy();
        let first_input = input.first_input(0.5 * restoring_force * restoring_force / input.stiffness);
        let first = (displacement, restoring_force);
        let (noise, resolution) = (input.force_noise, input.resolution);
        Self {
            bodies: input.bodies(),
            scheme,
            input_energy,
            first_input,
            tangent: TangentStiffness::new(input.stiffness, input.max_tangent_ratio, noise, resolution, first),
            modification: if input.i_modification { input.operator_stiffness } else { 0.0 },
            state: ImpactState {
                step: 0,
                time: 0.0,
                displacement,
                target: displacement,
                measured_displacement: displacement,
                velocity: 0.0,
                acceleration: -restoring_force / input.mass,
                restoring_force,
                force_at_computed: restoring_force,
                contact_force: 0.0,
                striker_displacement: displacement - input.gap,
                striker_velocity: input.striker_velocity,
                tangent_stiffness: input.stiffness,
                indentation: 0.0,
                state: StepState::Free,
                energies: Energies { striker: input_energy, ..Energies::default() },
                input: first_input,
                contacts: 0,
            },
        }
    }

    fn start(&self) -> Start {
        let state = &self.state;
        Start {
            structure: Motion {
                displacement: state.displacement,
                velocity: state.velocity,
                acceleration: state.acceleration,
                restoring_force: state.force_at_computed,
            },
            striker_displacement: state.striker_displacement,
            striker_velocity: state.striker_velocity,
            contact_force: state.contact_force,
            touching: state.state != StepState::Free,
            tangent_stiffness: state.tangent_stiffness,
            indentation: state.indentation,
        }
    }

    #[inline]
    fn predict(&mut self) -> S::Prediction {
        let start = self.start();
        self.scheme.predict(&self.bodies, &start)
    }

    /// r* = r_m − K_I(d_m − d̃), N. Without it not even a rounding changes.
    #[inline]
    fn felt(&self, target: f64, measured_displacement: f64, restoring_force: f64) -> f64 {
        match self.modification {
            0.0 => restoring_force,
            stiffness => restoring_force - stiffness * (measured_displacement - target),
        }
    }

    #[inline]
    fn accept(&mut self, prediction: &S::Prediction, measured_displacement: f64, restoring_force: f64) {
        self.tangent.take(measured_displacement, restoring_force);
        let target = self.scheme.target(prediction);
        let felt = self.felt(target, measured_displacement, restoring_force);
        let advance: Advance = self.scheme.complete(&self.bodies, &self.start(), prediction, felt);
        let before = &self.state;
        let Motion { displacement, velocity, acceleration, restoring_force: force_at_computed } = advance.structure;
        let moved = displacement - before.displacement;
        let mut energies = Energies {
            striker: 0.5 * self.bodies.striker_mass * advance.striker_velocity * advance.striker_velocity,
            structure: 0.5 * self.bodies.mass * velocity * velocity,
            restoring: before.energies.restoring + 0.5 * (before.force_at_computed + force_at_computed) * moved,
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
            target,
            measured_displacement,
            velocity,
            acceleration,
            restoring_force,
            force_at_computed,
            contact_force: advance.contact_force,
            striker_displacement: advance.striker_displacement,
            striker_velocity: advance.striker_velocity,
            tangent_stiffness: self.tangent.value(),
            indentation: advance.indentation,
            state: advance.state,
            energies,
            input: before.input.max(self.first_input + energies.weight),
            contacts: before.contacts + u64::from(advance.contacts),
        };
    }
}

/// The impact on a rig: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct ImpactSolver {
    step: Step<AnyScheme>,
    predicted: Option<<AnyScheme as Scheme>::Prediction>,
    striker_stopped: bool,
    /// K0, N/m
    stiffness: f64,
}

impl ImpactSolver {
    /// R₀ is read once before the first step; M Ẍ₀ = −CẊ₀ − R₀ with the structure at rest.
    #[must_use]
    pub fn new(input: &ImpactInput, initial_displacement: f64, initial_restoring_force: f64) -> Self {
        let step = Step::new(input, AnyScheme::new(input), initial_displacement, initial_restoring_force);
        Self { step, predicted: None, striker_stopped: false, stiffness: input.stiffness }
    }

    /// Displacement to command in this step, m. Asked again before `complete`, it is the same.
    pub fn predict(&mut self) -> f64 {
        let step = &mut self.step;
        let prediction = self.predicted.get_or_insert_with(|| step.predict());
        step.scheme.target(prediction)
    }

    /// Velocity that the step is foretold to end with, m/s, and whether a contact force has its share in it: exact under
    /// `tangent`, with the structure's own acceleration kept under the others. A blow at its end changes it.
    pub fn predicted_velocity(&mut self) -> (f64, bool) {
        let step = &mut self.step;
        let start = step.start();
        let prediction = self.predicted.get_or_insert_with(|| step.predict());
        (step.scheme.velocity(&step.bodies, &start, prediction), step.scheme.struck(&start, prediction))
    }

    /// What the recursion takes for the force at the target of this step where this is measured, N.
    pub fn taken(&mut self, measured_displacement: f64, restoring_force: f64) -> f64 {
        let target = self.predict();
        self.step.felt(target, measured_displacement, restoring_force)
    }

    /// The same of a place (m) that is no target of a step.
    #[must_use]
    pub fn taken_at(&self, place: f64, measured_displacement: f64, restoring_force: f64) -> f64 {
        self.step.felt(place, measured_displacement, restoring_force)
    }

    /// Ends the step with what was measured at its end.
    pub fn complete(&mut self, measured_displacement: f64, restoring_force: f64) -> &ImpactState {
        let prediction = self.predicted.take().unwrap_or_else(|| self.step.predict());
        self.step.accept(&prediction, measured_displacement, restoring_force);
        self.striker_stopped |= self.step.state.striker_velocity <= 0.0;
        &self.step.state
    }

    /// Structure and striker at the end of the last step.
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

    /// Whether the run has come to its end before its duration.
    #[must_use]
    pub fn over(&self, until: Until) -> bool {
        until.reached(|| self.finished(), || self.rebounded())
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

/// An impact on an ideal rig, one scheme and one specimen compiled together: `steps` steps from rest at X = 0. A law is
/// a scheme, in tangent form. The scheme is the one given, whatever `input` says.
pub fn simulate<M: Scheme, S: RestoringForce, K: Sink>(
    input: &ImpactInput,
    scheme: M,
    specimen: &mut S,
    steps: u64,
    sink: &mut K,
) -> ImpactState {
    let mut step = Step::new(input, scheme, 0.0, specimen.move_to(0.0));
    for _ in 0..steps {
        let prediction = step.predict();
        let target = step.scheme.target(&prediction);
        let restoring_force = specimen.move_to(target);
        step.accept(&prediction, target, restoring_force);
        sink.push(&step.state);
    }
    step.state
}
