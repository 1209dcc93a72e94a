//! A striker against one floor of a frame: the contact of an impact, the structure a vector. In: a frame, a striker, a
//! contact law, what a rig read. Out: targets, the motion of both bodies, the energy. It commands no rig.
//!
//! Every law is that of the impact of one degree of freedom. The paper's, rigid and limit (eq. 4; `law::ImpulseContact`),
//! go with every integrator: ½Ms joins M̂ at the struck degree of freedom alone. `hertz` and `restitution` find the instant
//! of a blow inside a step by the tangent's prediction, and are for the tangent form.

use thiserror::Error;

use super::factor::{BandFactor, NotPositiveDefinite};
use super::hertz;
use super::passage::{Passage, Passed, Start, Striker};
use super::restitution::Restitution;
use super::schemes::Course;
use super::solver::{FrameError, FrameInput, FrameSolver, FrameState};
use crate::mechanics::contact::{ContactLaw, StepState};
use crate::mechanics::energy::Energies;
use crate::mechanics::law::{Bodies, HertzContact, begun};
use crate::plan::{Integrator, Until};

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
    /// Acceleration of the striker along its way, m/s²: gn of a weight that falls.
    pub gravity: f64,
    pub law: ContactLaw,
}

/// Why there is no impact to follow.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameImpactError {
    #[error(transparent)]
    Frame(#[from] FrameError),
    #[error("degree of freedom {} is struck, but there are {order}", struck + 1)]
    NoSuchPlace { struck: usize, order: usize },
    #[error("{0} finds the instant of a blow by the tangent's prediction, which only `tangent` has")]
    NeedsTangent(&'static str),
    #[error("the stiffness is {0}")]
    Stiffness(NotPositiveDefinite),
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
    /// `striker + structure + restoring + damping + contact_loss + error` is ½MsV0² and the work of the weight and the loads.
    pub energies: Energies,
    /// Energy put into the test so far, J, as [`crate::mechanics::impact::ImpactState`] has it.
    pub input: f64,
    /// Blows so far: contacts that began.
    pub contacts: u64,
}

/// The impact on a rig: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct FrameImpactSolver {
    frame: FrameSolver,
    law: Law,
    striker: Striker,
    time_step: f64,
    input_energy: f64,
    /// With what a frame that is loaded at the start gives back, J.
    first_input: f64,
    now: StrikerState,
    state: StepState,
    /// The step under way, of a law that finds its own way through it.
    passed: Option<Passed>,
    reach: Reach,
}

/// What decides on the contact force.
#[derive(Clone, Copy, Debug)]
enum Law {
    /// Rigid up to a limit force, N.
    Impulse(f64),
    Hertz(HertzContact),
    Restitution(Restitution),
}

/// How far and how fast a frame can still move its struck floor with the energy that it has.
#[derive(Clone, Debug)]
struct Reach {
    stiffness: BandFactor,
    mass: super::band::SymmetricBand,
    /// e_sᵀK⁻¹e_s, m/N
    compliance: f64,
    /// e_sᵀM⁻¹e_s, 1/kg
    mobility: f64,
}

impl Reach {
    fn new(input: &FrameInput, struck: usize) -> Result<Self, FrameImpactError> {
        let unit = |factor: &BandFactor| {
            let mut unit = vec![0.0; input.matrices.order()];
            unit[struck] = 1.0;
            factor.solve_in_place(&mut unit);
            unit[struck]
        };
        let stiffness = BandFactor::new(&input.matrices.stiffness).map_err(FrameImpactError::Stiffness)?;
        let mass = BandFactor::new(&input.matrices.mass).map_err(FrameError::Mass)?;
        let (compliance, mobility) = (unit(&stiffness), unit(&mass));
        Ok(Self { stiffness, mass: input.matrices.mass.clone(), compliance, mobility })
    }

    /// ½RᵀK⁻¹R: what a frame under these forces (N) gives back elastically, J.
    fn stored(&self, force: &[f64]) -> f64 {
        let mut bent = force.to_vec();
        self.stiffness.solve_in_place(&mut bent);
        0.5 * bent.iter().zip(force).map(|(bent, force)| bent * force).sum::<f64>()
    }

    /// Largest speed (m/s) and least displacement (m) of the struck floor from here on, as far as the frame is elastic.
    fn of(&self, frame: &FrameState, struck: usize) -> (f64, f64) {
        let mut bent = frame.restoring_force.clone();
        self.stiffness.solve_in_place(&mut bent);
        let stored: f64 = bent.iter().zip(&frame.restoring_force).map(|(bent, force)| bent * force).sum();
        let twice_energy = self.mass.form(&frame.velocity, &frame.velocity) + stored.max(0.0);
        let rest = frame.displacement[struck] - bent[struck];
        ((twice_energy * self.mobility).sqrt(), rest - (twice_energy * self.compliance).sqrt())
    }
}

/// F of a step, N: at most the limit, never a pull.
fn impulse(limit: f64, striker: Striker, start: &Start, time_step: f64, free: f64, response: f64) -> (StepState, f64) {
    // No tolerance: δp was stored as this very difference.
    if start.striker_displacement - start.displacement < start.indentation {
        return (StepState::Free, 0.0);
    }
    let falling = start.striker_velocity + striker.gravity * time_step;
    match (falling - free) / (time_step / striker.mass + response) {
        needed if needed > limit => (StepState::Limit, limit),
        needed if needed >= 0.0 => (StepState::Contact, needed),
        _ => (StepState::Free, 0.0),
    }
}

impl FrameImpactSolver {
    /// # Errors
    /// If the frame is none, the struck place is not in it, or law and integrator do not go together.
    pub fn new(input: &FrameImpactInput) -> Result<Self, FrameImpactError> {
        let order = input.frame.matrices.order();
        if input.struck >= order {
            return Err(FrameImpactError::NoSuchPlace { struck: input.struck, order });
        }
        let tangent = input.frame.integrator == Integrator::Tangent;
        let mut frame = FrameSolver::new(&input.frame)?;
        frame.strike(input.struck)?;
        let reach = Reach::new(&input.frame, input.struck)?;
        let law = match input.law {
            ContactLaw::Rigid => Law::Impulse(f64::INFINITY),
            ContactLaw::Limit { force } => Law::Impulse(force),
            ContactLaw::Hertz { .. } if !tangent => return Err(FrameImpactError::NeedsTangent("hertz")),
            ContactLaw::Hertz { stiffness, loss, force_limit } => {
                let bodies = Bodies {
                    mass: 1.0 / reach.mobility,
                    damping: 0.0,
                    striker_mass: input.striker_mass,
                    gravity: input.gravity,
                    time_step: input.frame.time_step,
                };
                Law::Hertz(HertzContact::new(stiffness, loss, force_limit, &bodies, input.striker_velocity))
            }
            ContactLaw::Restitution { .. } if !tangent => return Err(FrameImpactError::NeedsTangent("restitution")),
            ContactLaw::Restitution { coefficient } => Law::Restitution(Restitution { coefficient, joined: false }),
        };
        let input_energy = 0.5 * input.striker_mass * input.striker_velocity * input.striker_velocity;
        let first_input = input_energy + reach.stored(input.frame.initial_restoring_force);
        let now = StrikerState {
            displacement: input.frame.initial_displacement[input.struck] - input.gap,
            velocity: input.striker_velocity,
            contact_force: 0.0,
            indentation: 0.0,
            state: StepState::Free,
            energies: Energies { striker: input_energy, ..Energies::default() },
            input: first_input,
            contacts: 0,
        };
        Ok(Self {
            frame,
            law,
            striker: Striker { struck: input.struck, mass: input.striker_mass, gravity: input.gravity },
            time_step: input.frame.time_step,
            input_energy,
            first_input,
            now,
            state: StepState::Free,
            passed: None,
            reach,
        })
    }

    fn start(&self) -> Start {
        let (frame, now) = (self.frame.state(), &self.now);
        Start {
            displacement: frame.displacement[self.striker.struck],
            velocity: frame.velocity[self.striker.struck],
            striker_displacement: now.displacement,
            striker_velocity: now.velocity,
            indentation: now.indentation,
        }
    }

    /// Displacements to command in this step, m, under the loads at its end (N).
    pub fn predict(&mut self, load_end: &[f64]) -> &[f64] {
        let start = self.start();
        let Self { frame, law, striker, time_step, state, passed, .. } = self;
        let (striker, time_step) = (*striker, *time_step);
        match law {
            Law::Impulse(limit) => frame.predict_with(load_end, &mut |free, response| {
                let force;
                (*state, force) = impulse(*limit, striker, &start, time_step, free, response);
                force
            }),
            Law::Hertz(_) | Law::Restitution(_) => frame.predict_by(load_end, &mut |schemes, from, load_end, to| {
                let course = Course::at(from);
                to.clone_from(&course);
                // M has a factor since the frame was accepted, and M̂ with it: without one the step would be none.
                let Ok(mut passage) = Passage::new(schemes, from, load_end, striker.struck) else { return 0.0 };
                let through = match law {
                    Law::Hertz(law) => hertz::pass(law, &mut passage, striker, &start, course, to),
                    Law::Restitution(law) => law.pass(&mut passage, striker, &start, course, to),
                    Law::Impulse(_) => return 0.0,
                };
                *passed = Some(through);
                through.damping_work
            }),
        }
    }

    /// Velocities that the step predicted last is foretold to end with, m/s, and whether a contact force has its share in
    /// them: exact under `tangent`; under the others what the frame does by itself it keeps doing, a blow is over but for the
    /// half of its impulse that this step still has, and a limit force lasts.
    pub fn predicted_velocity(&self, velocity: &mut [f64]) -> bool {
        self.frame.predicted_velocity(velocity);
        let before = self.now.contact_force;
        match &self.law {
            Law::Impulse(limit) if self.frame.decides_afterwards() => {
                let over = if before >= *limit { 0.0 } else { 0.5 };
                self.frame.push(-over * self.time_step * before, velocity);
                before > 0.0
            }
            Law::Impulse(_) => before > 0.0 || self.frame.contact_force() > 0.0,
            Law::Hertz(_) | Law::Restitution(_) => before > 0.0 || self.passed.is_some_and(|passed| passed.contact_force > 0.0),
        }
    }

    /// Whether the run has come to its end before its duration.
    #[must_use]
    pub fn over(&self, until: Until) -> bool {
        until.reached(|| self.finished(), || self.rebounded())
    }

    /// Ends the step with what was measured at the targets.
    pub fn complete(&mut self, measured_displacement: &[f64], restoring_force: &[f64]) -> (&FrameState, &StrikerState) {
        if !self.frame.is_predicted() {
            let load = self.frame.state().load.clone();
            self.predict(&load);
        }
        let start = self.start();
        let Self { frame, law, striker, time_step, state, .. } = self;
        let limit = if let Law::Impulse(limit) = law { *limit } else { 0.0 };
        frame.complete_with(measured_displacement, restoring_force, &mut |free, response| {
            let force;
            (*state, force) = impulse(limit, *striker, &start, *time_step, free, response);
            force
        });
        self.follow(&start);
        (self.frame.state(), &self.now)
    }

    /// Where the striker is after a step of impulses, and what the contact lost.
    fn impulses(&self, start: &Start) -> Passed {
        let (frame, time_step, Striker { struck, mass, gravity }) = (self.frame.state(), self.time_step, self.striker);
        let force = self.frame.contact_force();
        let (place, speed) = (frame.displacement[struck], frame.velocity[struck]);
        let falling = start.striker_velocity + gravity * time_step;
        let velocity = match self.state {
            StepState::Free => falling,
            StepState::Contact => speed,
            StepState::Limit => falling - force * time_step / mass,
        };
        let striker_moved = 0.5 * time_step * (start.striker_velocity + velocity);
        let displacement = start.striker_displacement + striker_moved;
        let limited = self.state == StepState::Limit;
        let indentation = if limited { start.indentation.max(displacement - place) } else { start.indentation };
        // A force acts at both ends of a step, of which the trapezoid gives the structure the mean.
        let way = 0.5 * time_step * (start.velocity + speed);
        Passed {
            structure: (),
            striker_displacement: displacement,
            striker_velocity: velocity,
            state: self.state,
            contact_force: force,
            indentation,
            contact_loss: force * striker_moved - 0.5 * (self.now.contact_force + force) * way,
            damping_work: 0.0,
            indentation_work: if limited { force * (indentation - start.indentation) } else { 0.0 },
            contacts: begun(self.now.state != StepState::Free, self.state),
        }
    }

    /// The striker, and the energies of both.
    fn follow(&mut self, start: &Start) {
        let passed = self.passed.take().unwrap_or_else(|| self.impulses(start));
        let (frame, before, Striker { mass, gravity, .. }) = (&self.frame.state().energies, &self.now.energies, self.striker);
        let Passed { striker_displacement: displacement, striker_velocity: velocity, .. } = passed;
        let mut energies = Energies {
            striker: 0.5 * mass * velocity * velocity,
            structure: frame.kinetic,
            restoring: frame.restoring,
            damping: frame.damping,
            contact_loss: before.contact_loss + passed.contact_loss,
            indentation: before.indentation + passed.indentation_work,
            weight: before.weight + mass * gravity * (displacement - start.striker_displacement),
            error: 0.0,
        };
        energies.error = self.input_energy + energies.weight + frame.input
            - (energies.striker + energies.structure + energies.restoring + energies.damping + energies.contact_loss);
        self.now = StrikerState {
            displacement,
            velocity,
            contact_force: passed.contact_force,
            indentation: passed.indentation,
            state: passed.state,
            energies,
            input: self.now.input.max(self.first_input + energies.weight),
            contacts: self.now.contacts + u64::from(passed.contacts),
        };
    }

    /// All floors at the end of the last step.
    #[must_use]
    pub const fn frame(&self) -> &FrameState {
        self.frame.state()
    }

    /// What the recursion took for the forces at the targets of the last step, where `read` was read, N.
    #[must_use]
    pub fn taken<'a>(&'a self, read: &'a [f64]) -> &'a [f64] {
        self.frame.taken(read)
    }

    /// The striker and its contact there.
    #[must_use]
    pub const fn striker(&self) -> &StrikerState {
        &self.now
    }

    /// Whether the last step ended with the striker and the struck floor no longer on their way.
    #[must_use]
    pub fn finished(&self) -> bool {
        let frame = self.frame.state();
        frame.step > 0 && self.now.velocity <= 0.0 && frame.velocity[self.striker.struck] <= 0.0
    }

    /// Whether striker and floor are apart for good, as far as the frame is elastic and unloaded from here on: the striker
    /// moves back, and either faster than the energy of the frame can ever move that floor, `|Ẋ_s| ≤ √(2E e_sᵀM⁻¹e_s)`, or from
    /// behind where it can get to, `√(2E e_sᵀK⁻¹e_s)` from its rest. A striker that falls always comes back.
    #[must_use]
    pub fn rebounded(&self) -> bool {
        let (frame, now, struck) = (self.frame.state(), &self.now, self.striker.struck);
        let (gap, back) = (now.displacement - frame.displacement[struck], -now.velocity);
        let apart = now.state == StepState::Free && gap < now.indentation && back > 0.0;
        if frame.step == 0 || self.striker.gravity > 0.0 || !apart {
            return false;
        }
        let (fastest, farthest) = self.reach.of(frame, struck);
        back >= fastest || now.displacement < farthest + now.indentation
    }
}
