//! An impact, step by step, on one degree of freedom or on one floor of many: prediction, the force read back, the striker, the
//! energies. In: a structure, a striker, readings. Out: targets, and the end of each step. It commands no rig: the caller moves the
//! specimen to the targets and returns the readings.

use std::any::Any;

use super::energy::{Energies, kinetic_energy};
use super::{ImpactError, ImpactInput, ImpactSetup, ImpactState, Sink, Until};
use crate::contact::state::StepState;
use crate::contact::{
    Advance, AnyContact, Approaching, Decided, ImpulseContact, Start, StrikerEnd,
};
use crate::integrator::Integrator;
use crate::integrator::input::SolverInput;
use crate::integrator::solver::Solver;
use crate::integrator::state::State;
use crate::integrator::step_form::{StepContact, StepForm};
use crate::integrator::substep::{Striker, Substep, Workspace};
use crate::integrator::tangents::{HasTangents, Tangents};
use crate::structure::assemblies::StoreyReadings;
use crate::structure::elements::ElementReading;
use crate::structure::matrix::one_degree::Unforced;
use crate::structure::matrix::{Factor, Matrix, Vector};

/// A pseudo-dynamic impact test: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct ImpactSolver<V: HasTangents = f64> {
    structure: Solver<V>,
    law: AnyContact,
    striker: Striker,
    decided: Decided,
    /// The step in progress, of a law that divides the step.
    passed: Advance,
    workspace: Workspace<V>,
    reach: Option<Reach<V>>,
    unloaded: V,
    /// ½ Ms V0² \[J\].
    striker_energy: f64,
    /// [`ImpactState::input`] without the work of a weight \[J\].
    first_input: f64,
    state: ImpactState,
    striker_stopped: bool,
}

/// That on one floor of a frame.
pub type FrameImpactSolver = ImpactSolver<Vec<f64>>;

/// Bounds of the displacement and velocity that the energy of a structure still allows at its struck degree of freedom.
#[derive(Clone, Debug)]
struct Reach<V: Vector> {
    /// K − G
    stiffness: <V::Matrix as Matrix>::Factor,
    gravity: Option<V::Matrix>,
    /// e_sᵀ(K − G)⁻¹e_s \[m/N\]
    compliance: f64,
    /// e_sᵀM⁻¹e_s \[1/kg\]
    mobility: f64,
}

impl<V: Vector> Reach<V> {
    /// None if the structure does not resist.
    fn new(form: &StepForm<V>, struck: usize) -> Option<Self> {
        let unit = |factor: &<V::Matrix as Matrix>::Factor| {
            let mut unit = V::zero(form.matrices.mass.rows());
            unit.as_mut_slice()[struck] = 1.0;
            factor.solve(&mut unit);
            unit.as_slice()[struck]
        };
        let stiffness = Factor::of(&form.matrices.net(&form.matrices.stiffness)).ok()?;
        let (compliance, mobility) = (unit(&stiffness), unit(form.mass_factor()));
        Some(Self {
            stiffness,
            gravity: form.matrices.gravity.clone(),
            compliance,
            mobility,
        })
    }

    /// R, or R − G X with weights \[N\].
    fn net(&self, state: &State<V>) -> V {
        let mut net = state.restoring_force.clone();
        if self.gravity.is_some() {
            net.update([&state.gravity_force], |force, [gravity]| force - gravity);
        }
        net
    }

    /// ½RᵀK⁻¹R: elastic energy of a structure in this state \[J\].
    fn stored(&self, state: &State<V>) -> f64 {
        let force = self.net(state);
        let mut bent = force.clone();
        self.stiffness.solve(&mut bent);
        0.5 * bent.dot(&force)
    }

    /// Largest speed \[m/s\] and least displacement \[m\] of the struck degree of freedom from here on, as far as the structure is
    /// elastic.
    fn bounds(&self, state: &State<V>, struck: usize) -> (f64, f64) {
        let force = self.net(state);
        let mut bent = force.clone();
        self.stiffness.solve(&mut bent);
        let stored = bent.dot(&force).max(0.0);
        let twice_energy = 2.0 * state.energies.kinetic + stored;
        let rest = state.displacement.as_slice()[struck] - bent.as_slice()[struck];
        (
            (twice_energy * self.mobility).sqrt(),
            rest - (twice_energy * self.compliance).sqrt(),
        )
    }
}

impl ImpactSolver {
    /// An impact on one degree of freedom. R₀ is read once before the first step; M Ẍ₀ = −CẊ₀ − R₀ with the structure at rest.
    ///
    /// # Errors
    /// The structure cannot be stepped, or law and integrator cannot be combined.
    pub fn new(
        input: &ImpactInput,
        initial_displacement: f64,
        initial_restoring_force: f64,
    ) -> Result<Self, ImpactError> {
        let structure = SolverInput {
            matrices: &input.matrices(),
            operator_stiffness: &input.operator_stiffness,
            integrator: input.integrator,
            i_modification: input.i_modification,
            tangents: Tangents::Storeys {
                largest_ratio: input.max_tangent_ratio,
            },
            time_step: input.time_step,
            initial_displacement,
            initial_restoring_force,
            initial_load: 0.0,
            readings: &[StoreyReadings::of_one(input.noise)],
            elements: None,
        };
        Self::on(&structure, &input.setup())
    }
}

impl<V: HasTangents> ImpactSolver<V> {
    /// An impact on one degree of freedom of a structure, under its initial load throughout.
    ///
    /// # Errors
    /// The structure cannot be stepped, the struck degree of freedom is not in it, or law and integrator cannot be combined.
    pub fn on(input: &SolverInput<V>, setup: &ImpactSetup) -> Result<Self, ImpactError> {
        let ImpactSetup {
            struck,
            mass,
            velocity,
            gap,
            gravity,
            law,
        } = *setup;
        let order = input.matrices.mass.rows();
        if struck >= order {
            return Err(ImpactError::NoSuchDegreeOfFreedom { struck, order });
        }
        let mut structure = Solver::new(input)?;
        structure.form.strike(struck);
        let reach = Reach::new(&structure.form, struck);
        let struck_mass = structure
            .form
            .struck()
            .map_or(f64::NAN, |(_, push)| 1.0 / push.as_slice()[struck]);
        let time_step = input.time_step;
        let approaching = Approaching {
            mass: struck_mass,
            striker_mass: mass,
            velocity,
            time_step,
        };
        let striker = Striker {
            struck,
            mass,
            gravity,
            time_step,
        };
        let law = AnyContact::new(law, input.integrator, approaching, &striker)?;
        structure.form.is_divided = matches!(law, AnyContact::Divided(_));
        let striker_energy = kinetic_energy(mass, velocity);
        let stored = reach
            .as_ref()
            .map_or(0.0, |reach| reach.stored(structure.state()));
        let first_input = striker_energy + stored;
        let advance = Advance {
            striker_displacement: structure.state().displacement.as_slice()[struck] - gap,
            striker_velocity: velocity,
            state: StepState::Free,
            contact_force: 0.0,
            indentation: 0.0,
            contact_loss: 0.0,
            damping_work: 0.0,
            indentation_work: 0.0,
            contacts: 0,
        };
        let energies = Energies {
            striker: striker_energy,
            ..Energies::default()
        };
        Ok(Self {
            state: impact_state(
                structure.state(),
                struck,
                &advance,
                stiffness_at(&structure, struck),
                energies,
                first_input,
            ),
            workspace: Workspace::new(&structure.form),
            unloaded: structure.state().load.clone(),
            structure,
            law,
            striker,
            decided: Decided::FREE,
            passed: advance,
            reach,
            striker_energy,
            first_input,
            striker_stopped: false,
        })
    }

    /// The elements of a frame of matrices at the targets of the step in progress, before it is completed.
    pub fn read_elements(&mut self, elements: &[ElementReading]) {
        self.structure.read_elements(elements);
    }

    /// Before the first step: where the structure was measured \[m\].
    pub fn measured_at_start(&mut self, measured_displacement: V::View<'_>) {
        self.structure.measured_at_start(measured_displacement);
        self.state.measured_displacement =
            self.structure.state().measured_displacement.as_slice()[self.striker.struck];
    }

    /// Displacements to command in this step \[m\]. A second call before `complete` gives the same values.
    #[inline]
    pub fn predict(&mut self) -> V::View<'_> {
        let Self {
            structure,
            law,
            striker,
            decided,
            passed,
            workspace,
            unloaded,
            state,
            ..
        } = self;
        match law {
            AnyContact::Impulse(law) => {
                let start = start(state);
                let contact = Impulse {
                    law,
                    start: &start,
                    decided,
                };
                structure.predict_with(unloaded.view(), contact)
            }
            AnyContact::Divided(law) => {
                let start = start(state);
                structure.predict_by(unloaded.view(), |form, from, load_end, to| {
                    let Some((mut substep, mut scratch)) =
                        Substep::new(form, &from, load_end, workspace)
                    else {
                        return 0.0;
                    };
                    *passed = law.pass(&mut substep, striker, &start, &mut scratch, to);
                    passed.damping_work
                })
            }
        }
    }

    /// Velocities that the step is predicted to end with, m/s, and whether a contact force has its share in them: exact under
    /// `tangent`; under the others the structure keeps its own acceleration, of an impact only the half of the impulse that this step
    /// still has is added, and a limit force lasts.
    pub fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool {
        self.predict();
        self.structure.predicted_velocity(velocity);
        let before = self.state.contact_force;
        match &self.law {
            AnyContact::Impulse(law) if self.structure.form.integrator != Integrator::Tangent => {
                let over = if before >= law.force_limit { 0.0 } else { 0.5 };
                let mut change = V::zero(velocity.len());
                self.structure
                    .form
                    .push(-over * self.striker.time_step * before, &mut change);
                for (velocity, change) in velocity.iter_mut().zip(change.as_slice()) {
                    *velocity += change;
                }
                before > 0.0
            }
            AnyContact::Impulse(_) => before > 0.0 || self.structure.form.contact_force() > 0.0,
            AnyContact::Divided(_) => before > 0.0 || self.passed.contact_force > 0.0,
        }
    }

    /// Ends the step with the readings at the targets.
    #[inline]
    pub fn complete(
        &mut self,
        measured_displacement: V::View<'_>,
        restoring_force: V::View<'_>,
    ) -> &ImpactState {
        if !self.structure.is_predicted() {
            self.predict();
        }
        let start = start(&self.state);
        let Self {
            structure,
            law,
            decided,
            ..
        } = self;
        match law {
            AnyContact::Impulse(law) => {
                let contact = Impulse {
                    law,
                    start: &start,
                    decided,
                };
                structure.complete_with(measured_displacement, restoring_force, contact);
            }
            AnyContact::Divided(_) => {
                structure.complete(measured_displacement, restoring_force);
            }
        }
        self.follow(&start);
        &self.state
    }

    /// The striker, and the energies of both.
    #[inline]
    fn follow(&mut self, start: &Start) {
        let Self {
            structure,
            law,
            striker,
            decided,
            passed,
            ..
        } = &*self;
        let (after, struck) = (structure.state(), striker.struck);
        let advance = match law {
            AnyContact::Impulse(law) => {
                let (displacement, velocity) = (
                    after.displacement.as_slice()[struck],
                    after.velocity.as_slice()[struck],
                );
                // The tangent form moves by it; explicit Newmark and α-OS do not.
                let moved = if structure.form.integrator == Integrator::Tangent {
                    displacement - start.displacement
                } else {
                    0.5 * striker.time_step * (start.velocity + velocity)
                };
                let end = [displacement, velocity, moved];
                let touching = self.state.state != StepState::Free;
                of_impulse(
                    law.advance(0.5 * striker.time_step, start, decided, end),
                    *decided,
                    touching,
                )
            }
            AnyContact::Divided(_) => *passed,
        };
        let (balance, before) = (&after.energies, &self.state.energies);
        let fallen = advance.striker_displacement - start.striker_displacement;
        let mut energies = Energies {
            striker: kinetic_energy(striker.mass, advance.striker_velocity),
            structure: balance.kinetic,
            restoring: balance.restoring,
            damping: balance.damping,
            contact_loss: before.contact_loss + advance.contact_loss,
            indentation: before.indentation + advance.indentation_work,
            weight: before.weight + striker.mass * striker.gravity * fallen,
            gravity: balance.gravity,
            error: 0.0,
        };
        energies.error = energies.missing(self.striker_energy, balance.input);
        let input = self
            .state
            .input
            .max(self.first_input + energies.weight + energies.gravity);
        let contacts = self.state.contacts + u64::from(advance.contacts);
        let stiffness = stiffness_at(structure, struck);
        self.state = ImpactState {
            contacts,
            ..impact_state(after, struck, &advance, stiffness, energies, input)
        };
        self.striker_stopped |= self.state.striker_velocity <= 0.0;
    }

    /// Effective forces r* \[N\] at these targets for these readings \[m\], \[N\].
    #[must_use]
    pub fn effective_force_at(
        &self,
        target: V::View<'_>,
        measured: V::View<'_>,
        force: V::View<'_>,
    ) -> V {
        self.structure.effective_force_at(target, measured, force)
    }

    /// Effective forces r* at the targets of the last step \[N\].
    #[must_use]
    pub fn effective_force(&self) -> V::View<'_> {
        self.structure.effective_force()
    }

    /// The struck degree of freedom and the striker at the end of the last step.
    #[must_use]
    pub const fn state(&self) -> &ImpactState {
        &self.state
    }

    /// G X at these displacements \[m\], in \[N\]; empty without weights.
    #[must_use]
    pub fn gravity_force(&self, displacement: V::View<'_>) -> Vec<f64> {
        self.structure.gravity_force(displacement)
    }

    /// Index of the struck degree of freedom.
    #[must_use]
    pub const fn struck(&self) -> usize {
        self.striker.struck
    }

    /// This solver, if it has one degree of freedom that is no frame.
    #[must_use]
    pub fn of_one_degree(&self) -> Option<&ImpactSolver> {
        (self as &dyn Any).downcast_ref()
    }

    /// The whole structure there.
    #[must_use]
    pub const fn structure(&self) -> &State<V> {
        self.structure.state()
    }

    /// Whether striker and structure have separated finally, if the structure is elastic and unloaded from here on. The striker moves
    /// back, and one of two conditions applies. It is faster than the energy of the structure can ever move the struck degree of freedom,
    /// `|Ẋ_s| ≤ √(2E e_sᵀM⁻¹e_s)`, or it is out of its reach, `√(2E e_sᵀK⁻¹e_s)` from its unloaded position. A falling striker always
    /// returns.
    #[must_use]
    pub fn rebounded(&self) -> bool {
        let state = &self.state;
        let (gap, back) = (
            state.striker_displacement - state.displacement,
            -state.striker_velocity,
        );
        let apart = state.state == StepState::Free && gap < state.indentation && back > 0.0;
        if state.step == 0 || self.striker.gravity > 0.0 || !apart {
            return false;
        }
        let Some(reach) = &self.reach else {
            return false;
        };
        let (fastest, farthest) = reach.bounds(self.structure.state(), self.striker.struck);
        back >= fastest || state.striker_displacement < farthest + state.indentation
    }

    /// Whether the run has ended before its duration.
    #[must_use]
    pub fn over(&self, until: Until) -> bool {
        until.reached(
            || self.finished(),
            || self.rebounded(),
            |drift| self.structure.state().drifts_to(drift),
        )
    }

    /// Whether the last step ended with Ẋs ≤ 0 and Ẋ ≤ 0.
    #[must_use]
    pub fn finished(&self) -> bool {
        let state = &self.state;
        state.step > 0 && state.striker_velocity <= 0.0 && state.velocity <= 0.0
    }

    /// The impact to its end, `steps` steps at most, on whatever `read` finds: it is given the solver to predict the step with, and
    /// gives displacement \[m\] and force \[N\] at its target. The steps are those of `predict` and `complete`.
    #[inline]
    pub fn run<K: Sink<V>>(
        &mut self,
        until: Option<Until>,
        steps: u64,
        mut read: impl FnMut(&mut Self) -> [V; 2],
        sink: &mut K,
    ) {
        for _ in 0..steps {
            let [displacement, force] = read(self);
            self.complete(displacement.view(), force.view());
            let over = until.is_some_and(|until| self.over(until));
            sink.push(self.structure.state(), &self.state, over);
            if over {
                break;
            }
        }
    }
}

/// The start of the next step.
#[inline]
const fn start(state: &ImpactState) -> Start {
    Start {
        displacement: state.displacement,
        velocity: state.velocity,
        striker_displacement: state.striker_displacement,
        striker_velocity: state.striker_velocity,
        contact_force: state.contact_force,
        indentation: state.indentation,
    }
}

/// The contact of a step under a law of impulses.
struct Impulse<'a> {
    law: &'a ImpulseContact,
    start: &'a Start,
    decided: &'a mut Decided,
}

impl StepContact for Impulse<'_> {
    #[inline]
    fn force(&mut self, free: f64, compliance: f64) -> f64 {
        *self.decided = self.law.decide(self.start, free, compliance);
        self.decided.force
    }

    #[inline]
    fn joined(&mut self, half: f64, unforced: &Unforced) -> [f64; 2] {
        let (state, ratio) = self.law.join::<true>(self.start, unforced, half);
        self.decided.state = state;
        ratio
    }

    #[inline]
    fn settled(&mut self, velocity: f64) -> f64 {
        let Decided { state, force } = &mut *self.decided;
        *force = self.law.settled(self.start, *state, velocity);
        *force
    }
}

/// The step of such a law; `touching`: the step before it was one in contact.
#[inline]
fn of_impulse(end: StrikerEnd, decided: Decided, touching: bool) -> Advance {
    let state = decided.state;
    Advance {
        striker_displacement: end.displacement,
        striker_velocity: end.velocity,
        state,
        contact_force: decided.force,
        indentation: end.indentation,
        contact_loss: end.contact_loss,
        damping_work: 0.0,
        indentation_work: end.indentation_work,
        contacts: u32::from(!touching && state != StepState::Free),
    }
}

/// K_t of the struck degree of freedom \[N/m\].
#[inline]
fn stiffness_at<V: HasTangents>(structure: &Solver<V>, struck: usize) -> f64 {
    if !structure.state().elements.is_empty() {
        return structure.form.operator().at(struck, struck);
    }
    let followed = structure.state().storey_stiffness.as_slice();
    followed
        .get(struck)
        .copied()
        .unwrap_or_else(|| structure.form.matrices.stiffness.at(struck, struck))
}

/// The struck degree of freedom and the striker.
#[inline]
pub(super) fn impact_state<V: Vector>(
    state: &State<V>,
    struck: usize,
    advance: &Advance,
    tangent_stiffness: f64,
    energies: Energies,
    input: f64,
) -> ImpactState {
    let at = |vector: &V| vector.as_slice()[struck];
    ImpactState {
        step: state.step,
        time: state.time,
        displacement: at(&state.displacement),
        target: at(&state.target),
        measured_displacement: at(&state.measured_displacement),
        velocity: at(&state.velocity),
        acceleration: at(&state.acceleration),
        restoring_force: at(&state.restoring_force),
        force_at_computed: at(&state.force_at_computed),
        contact_force: advance.contact_force,
        striker_displacement: advance.striker_displacement,
        striker_velocity: advance.striker_velocity,
        tangent_stiffness,
        indentation: advance.indentation,
        state: advance.state,
        energies,
        input,
        contacts: u64::from(advance.contacts),
    }
}
