//! A structure on a rig, step by step: targets out, readings in. In: matrices, an integrator, loads. Out: the motion and its
//! energy. It commands no rig: whoever does asks for the next targets and gives back what was measured there.

use thiserror::Error;

use super::step_form::{Matrices, Moment, Motion, StepForm};
use super::tangents::{FollowedTangents as _, Following, Tangents};
use crate::frame::NotPositiveDefinite;
use crate::integrator::Integrator;
use crate::matrix::{Factor as _, Matrix, Vector};
use crate::structure::energies::{Ends, FrameEnergies};

/// All a run starts from; the structure is at rest.
#[derive(Clone, Copy, Debug)]
pub struct SolverInput<'a, V: Vector> {
    pub matrices: &'a Matrices<V>,
    /// `K_I` of α-OS and of the I-modification, N/m: the initial stiffness, or one above it.
    pub operator_stiffness: &'a V::Matrix,
    pub integrator: Integrator,
    /// Whether the recursion takes r* = `r_m` − `K_I`(`d_m` − d̃) in place of the reading.
    pub i_modification: bool,
    pub tangents: Tangents,
    /// Δt, s
    pub time_step: f64,
    /// m
    pub initial_displacement: V::View<'a>,
    /// Read once before the first step, N.
    pub initial_restoring_force: V::View<'a>,
    /// F(0), N
    pub initial_load: V::View<'a>,
    /// Standard deviation of a load cell, N.
    pub force_noise: f64,
    /// Of a displacement reading, m.
    pub resolution: f64,
}

/// That of a frame.
pub type FrameInput<'a> = SolverInput<'a, Vec<f64>>;

/// Why a structure cannot be stepped.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameError {
    #[error("a frame has at least one degree of freedom")]
    Empty,
    #[error("{what} is of order {found}, not {expected}")]
    Order {
        what: &'static str,
        found: usize,
        expected: usize,
    },
    #[error("the mass matrix is {0}")]
    Mass(NotPositiveDefinite),
    #[error("mass, damping and stiffness over a step are {0}")]
    Step(NotPositiveDefinite),
    #[error(
        "storeys are followed by their own tangents only where the stiffness is that of a shear building"
    )]
    NoStoreys,
    #[error("a step of {0} s is none")]
    TimeStep(f64),
}

/// The end of a step; step 0 is the start.
#[derive(Clone, Debug, PartialEq)]
pub struct State<V> {
    pub step: u64,
    /// s
    pub time: f64,
    /// Computed X, m.
    pub displacement: V,
    /// Imposed on the specimen, m: X itself, but under α-OS the position predicted for it.
    pub target: V,
    /// m
    pub measured_displacement: V,
    /// m/s
    pub velocity: V,
    /// m/s²
    pub acceleration: V,
    /// Measured, N.
    pub restoring_force: V,
    /// What the recursion takes for the force at X, N: the reading, but for what the I-modification and α-OS correct.
    pub force_at_computed: V,
    /// F at the end of the step, N.
    pub load: V,
    /// `k_t` of each storey for the step to come, N/m; nothing of a frame whose storeys are not followed.
    pub storey_stiffness: V,
    pub energies: FrameEnergies,
}

/// That of a frame, one entry a degree of freedom.
pub type FrameState = State<Vec<f64>>;

/// The run on a rig: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct Solver<V: Vector> {
    pub(crate) form: StepForm<V>,
    tangents: Option<V::Tangents>,
    modification: Option<V::Matrix>,
    state: State<V>,
    /// The step under way; it becomes the state.
    next: Motion<V>,
    load_end: V,
    predicted: bool,
    /// The force that the recursion takes at the target, N, and how far the specimen is from there, m.
    taken: V,
    away: V,
    /// Of dampers in a step whose velocity jumps, J.
    damping_work: Option<f64>,
}

/// That of a frame.
pub type FrameSolver = Solver<Vec<f64>>;

impl<V: Vector> Solver<V> {
    /// M Ẍ₀ = F₀ − R₀.
    ///
    /// # Errors
    /// If vectors and matrices are not of one order, or no acceleration follows from them.
    pub fn new(input: &SolverInput<V>) -> Result<Self, FrameError> {
        let matrices = input.matrices;
        let order = matrices.mass.rows();
        check(input, order)?;
        let zero = || V::zero(order);
        let of = |view: V::View<'_>| {
            let mut vector = zero();
            vector.set(view);
            vector
        };
        let displacement = of(input.initial_displacement);
        let (force, load) = (of(input.initial_restoring_force), of(input.initial_load));
        let tangent_form = input.integrator == Integrator::Tangent;
        let tangents = match input.tangents {
            Tangents::Storeys { largest_ratio } => {
                let following = Following {
                    largest_ratio,
                    force_noise: input.force_noise,
                    resolution: input.resolution,
                };
                let followed =
                    V::Tangents::new(&matrices.stiffness, following, &displacement, &force);
                Some(followed.ok_or(FrameError::NoStoreys)?)
            }
            Tangents::Initial => None,
        };
        let operator = if tangent_form {
            &matrices.stiffness
        } else {
            input.operator_stiffness
        };
        <V::Matrix as Matrix>::Factor::of(&matrices.mass).map_err(FrameError::Mass)?;
        let form = StepForm::new(matrices, operator, input.integrator, input.time_step)
            .map_err(FrameError::Step)?;
        let mut acceleration = zero();
        acceleration.update([&load, &force], |_, [load, force]| load - force);
        form.mass_factor().solve(&mut acceleration);
        Ok(Self {
            form,
            modification: input
                .i_modification
                .then(|| input.operator_stiffness.clone()),
            state: State {
                step: 0,
                time: 0.0,
                target: displacement.clone(),
                measured_displacement: displacement.clone(),
                displacement,
                velocity: zero(),
                acceleration,
                restoring_force: force.clone(),
                force_at_computed: force,
                load,
                storey_stiffness: tangents
                    .as_ref()
                    .map(|followed| followed.stiffness().clone())
                    .unwrap_or_default(),
                energies: FrameEnergies::default(),
            },
            tangents,
            next: Motion::at_rest(order),
            load_end: zero(),
            predicted: false,
            taken: zero(),
            away: zero(),
            damping_work: None,
        })
    }

    /// Before the first step: where the structure was measured, m.
    pub fn measured_at_start(&mut self, measured_displacement: V::View<'_>) {
        self.state.measured_displacement.set(measured_displacement);
    }

    /// Displacements to command in this step, m, under the loads at its end (N). Asked again before `complete`, they are
    /// the same whatever the loads.
    pub fn predict(&mut self, load_end: V::View<'_>) -> V::View<'_> {
        self.predict_with(load_end, |_, _| 0.0)
    }

    /// Velocities that the step is predicted to end with, m/s: exact under `tangent`, with the acceleration kept under the
    /// others. The step is the one predicted last.
    pub fn predicted_velocity(&self, velocity: &mut [f64]) {
        if self.form.integrator == Integrator::Tangent {
            velocity.copy_from_slice(self.next.velocity.as_slice());
            return;
        }
        let kept = self
            .state
            .velocity
            .as_slice()
            .iter()
            .zip(self.state.acceleration.as_slice());
        for (to, (now, acceleration)) in velocity.iter_mut().zip(kept) {
            *to = now + self.form.time_step * acceleration;
        }
    }

    /// [`Self::predict`] with a contact force, as `decide` has it from `v_free` (m/s) and w (m/s/N).
    #[inline]
    pub(crate) fn predict_with(
        &mut self,
        load_end: V::View<'_>,
        decide: impl FnOnce(f64, f64) -> f64,
    ) -> V::View<'_> {
        if !self.predicted {
            self.predicted = true;
            self.load_end.set(load_end);
            self.damping_work = None;
            let Self {
                form,
                state,
                next,
                load_end,
                ..
            } = self;
            if form.integrator == Integrator::Tangent {
                form.predict(&state.moment(), load_end, next, decide);
            } else {
                form.impose(&state.moment(), next);
            }
        }
        self.next.displacement.view()
    }

    /// The same in tangent form, with a contact law that follows its own path through the step and gives the work of the dampers
    /// on it, J.
    #[inline]
    pub(crate) fn predict_by(
        &mut self,
        load_end: V::View<'_>,
        pass: impl FnOnce(&StepForm<V>, Moment<V>, &V, &mut Motion<V>) -> f64,
    ) -> V::View<'_> {
        if !self.predicted {
            self.predicted = true;
            self.load_end.set(load_end);
            self.damping_work = Some(pass(
                &self.form,
                self.state.moment(),
                &self.load_end,
                &mut self.next,
            ));
        }
        self.next.displacement.view()
    }

    /// Whether the step under way has its targets.
    pub(crate) const fn is_predicted(&self) -> bool {
        self.predicted
    }

    /// Ends the step with what was measured at the targets. Without a prediction before it, under the loads of its start.
    pub fn complete(
        &mut self,
        measured_displacement: V::View<'_>,
        restoring_force: V::View<'_>,
    ) -> &State<V> {
        self.complete_with(measured_displacement, restoring_force, |_, _| 0.0)
    }

    #[inline]
    pub(crate) fn complete_with(
        &mut self,
        measured_displacement: V::View<'_>,
        restoring_force: V::View<'_>,
        decide: impl FnOnce(f64, f64) -> f64,
    ) -> &State<V> {
        if !self.predicted {
            let load = self.state.load.clone();
            self.predict(load.view());
        }
        self.predicted = false;
        let Self {
            form,
            tangents,
            modification,
            state,
            next,
            load_end,
            taken,
            away,
            ..
        } = self;
        state.measured_displacement.set(measured_displacement);
        state.restoring_force.set(restoring_force);
        state.target.set(next.displacement.view());
        let taken = match modification {
            Some(operator) => {
                correct(
                    operator,
                    &state.target,
                    &state.measured_displacement,
                    &state.restoring_force,
                    away,
                    taken,
                );
                &*taken
            }
            None => &state.restoring_force,
        };
        if form.integrator == Integrator::Tangent {
            next.force.set(taken.view());
        } else {
            form.correct(&state.moment(), load_end, taken, next, decide);
        }
        if let Some(tangents) = tangents
            && tangents.take(&state.measured_displacement, &state.restoring_force)
        {
            if form.integrator == Integrator::Tangent {
                // A storey's tangent is not negative, so that M̂ has a factor as M has; if rounding ever denied it, the last
                // one serves on.
                let _ = form.take_tangents(tangents);
            }
            state.storey_stiffness.set(tangents.stiffness().view());
        }
        self.accept();
        &self.state
    }

    /// What the recursion takes for the forces at these targets (m) where this is measured, m and N.
    #[must_use]
    pub fn taken_at(&self, target: V::View<'_>, measured: V::View<'_>, force: V::View<'_>) -> V {
        let copy = |view: V::View<'_>| {
            let mut vector = V::default();
            vector.set(view);
            vector
        };
        let force = copy(force);
        let Some(operator) = &self.modification else {
            return force;
        };
        let (mut away, mut taken) = (self.away.clone(), self.taken.clone());
        correct(
            operator,
            &copy(target),
            &copy(measured),
            &force,
            &mut away,
            &mut taken,
        );
        taken
    }

    /// What the recursion took for the forces at the targets of the last step, N.
    #[must_use]
    pub fn taken(&self) -> V::View<'_> {
        if self.modification.is_some() {
            self.taken.view()
        } else {
            self.state.restoring_force.view()
        }
    }

    #[inline]
    fn accept(&mut self) {
        let Self {
            form,
            state,
            next,
            load_end,
            damping_work,
            ..
        } = self;
        let time_step = form.time_step;
        let ends = Ends {
            displacement: [&state.displacement, &next.displacement],
            velocity: [&state.velocity, &next.velocity],
            restoring_force: [&state.force_at_computed, &next.force],
            load: [&state.load, load_end],
        };
        let (matrices, damped, scratch) = form.scratch();
        let damping_work = if damped { *damping_work } else { Some(0.0) };
        state.energies = state
            .energies
            .advance(matrices, time_step, &ends, damping_work, scratch);
        std::mem::swap(&mut state.displacement, &mut next.displacement);
        std::mem::swap(&mut state.velocity, &mut next.velocity);
        std::mem::swap(&mut state.acceleration, &mut next.acceleration);
        std::mem::swap(&mut state.force_at_computed, &mut next.force);
        std::mem::swap(&mut state.load, load_end);
        state.step += 1;
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = state.step as f64 * time_step;
        state.time = time;
    }

    /// The structure at the end of the last step.
    #[must_use]
    pub const fn state(&self) -> &State<V> {
        &self.state
    }
}

/// r* = `r_m` − `K_I`(`d_m` − d̃), N.
#[inline]
fn correct<V: Vector>(
    operator: &V::Matrix,
    target: &V,
    measured: &V,
    force: &V,
    away: &mut V,
    taken: &mut V,
) {
    taken.set(force.view());
    away.update([measured, target], |_, [measured, target]| {
        measured - target
    });
    operator.mul_add(-1.0, away, taken);
}

impl<V> State<V> {
    #[inline]
    pub(crate) const fn moment(&self) -> Moment<'_, V> {
        Moment {
            displacement: &self.displacement,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            force: &self.force_at_computed,
            load: &self.load,
        }
    }
}

fn check<V: Vector>(input: &SolverInput<V>, order: usize) -> Result<(), FrameError> {
    if order == 0 {
        return Err(FrameError::Empty);
    }
    if !(input.time_step > 0.0 && input.time_step.is_finite()) {
        return Err(FrameError::TimeStep(input.time_step));
    }
    let orders = [
        ("damping", input.matrices.damping.rows()),
        ("stiffness", input.matrices.stiffness.rows()),
        ("the operator's stiffness", input.operator_stiffness.rows()),
        (
            "the initial displacement",
            V::order_of(input.initial_displacement),
        ),
        (
            "the initial restoring force",
            V::order_of(input.initial_restoring_force),
        ),
        ("the initial load", V::order_of(input.initial_load)),
    ];
    let other = orders.into_iter().find(|(_, found)| *found != order);
    other.map_or(Ok(()), |(what, found)| {
        Err(FrameError::Order {
            what,
            found,
            expected: order,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const MASS: f64 = 1.0;
    const STIFFNESS: f64 = 400.0;

    /// A mass on a spring that is let go at 1 m, `steps` steps in tangent form on.
    fn vibration(damping: f64, time_step: f64, steps: u32) -> State<f64> {
        let matrices = Matrices {
            mass: MASS,
            damping,
            stiffness: STIFFNESS,
        };
        let input = SolverInput {
            matrices: &matrices,
            operator_stiffness: &STIFFNESS,
            integrator: Integrator::Tangent,
            i_modification: false,
            tangents: Tangents::Initial,
            time_step,
            initial_displacement: 1.0,
            initial_restoring_force: STIFFNESS,
            initial_load: 0.0,
            force_noise: 0.0,
            resolution: 0.0,
        };
        let mut solver = Solver::<f64>::new(&input).expect("a mass on a spring");
        for _ in 0..steps {
            let target = solver.predict(0.0);
            solver.complete(target, STIFFNESS * target);
        }
        solver.state().clone()
    }

    /// Error of X against the free vibration after `steps` steps to a fixed instant.
    fn error(damping: f64, steps: u32) -> f64 {
        let end = 0.37;
        let rate = damping / (2.0 * MASS);
        let damped = (STIFFNESS / MASS - rate * rate).sqrt();
        let exact =
            (-rate * end).exp() * ((damped * end).cos() + rate / damped * (damped * end).sin());
        vibration(damping, end / f64::from(steps), steps).displacement - exact
    }

    #[test]
    fn free_vibration_is_of_second_order() {
        for damping in [0.0, 6.0] {
            let order = (error(damping, 400) / error(damping, 800)).log2();
            assert!((order - 2.0).abs() < 0.02, "C {damping}: order {order}");
            assert!(error(damping, 800).abs() < 1e-4);
        }
    }

    /// Constant average acceleration neither feeds nor drains a linear vibration, at any step.
    #[test]
    fn undamped_energy_stays() {
        for time_step in [1e-3, 0.1] {
            let end = vibration(0.0, time_step, 1000);
            let energy = MASS * end.velocity.powi(2) + STIFFNESS * end.displacement.powi(2);
            assert!((energy / STIFFNESS - 1.0).abs() < 1e-11, "{energy}");
        }
    }
}
