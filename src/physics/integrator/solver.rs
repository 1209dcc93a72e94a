//! A structure on a rig, step by step. In: matrices, an integrator, loads, readings. Out: targets, the motion and its energy. It commands
//! no rig: the caller moves the specimen to the targets and returns the readings.

use super::input::{FrameError, SolverInput};
use super::state::State;
use super::step_form::{Moment, Motion, StepContact, StepForm};
use super::tangents::{FollowedTangents as _, HasTangents, Tangents};
use crate::integrator::Integrator;
use crate::structure::elements::{ElementReading, Elements};
use crate::structure::energies::{Ends, FrameEnergies};
use crate::structure::matrix::{Factor as _, Matrix, Vector};

/// A pseudo-dynamic test: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct Solver<V: HasTangents> {
    pub(crate) form: StepForm<V>,
    tangents: Option<V::Tangents>,
    modification: Option<V::Matrix>,
    /// Of a frame of matrices; None without elements.
    elements: Option<Elements>,
    /// R − G X at the computed displacement \[N\]; None without weights.
    net: Option<V>,
    state: State<V>,
    /// The end of the step in progress; it becomes the state.
    next: Motion<V>,
    load_end: V,
    predicted: bool,
    /// Effective force r* of the recursion at the target \[N\], and the tracking error \[m\].
    effective_force: V,
    /// With weights R* − G X at the target \[N\] afterwards.
    tracking_error: V,
    /// Work of the dampers in a step whose velocity jumps \[J\].
    damping_work: Option<f64>,
}

/// That of a frame.
pub type FrameSolver = Solver<Vec<f64>>;

impl<V: HasTangents> Solver<V> {
    /// M Ẍ₀ = F₀ − R₀ + G X₀.
    ///
    /// # Errors
    /// If vectors and matrices are not of one order, or no acceleration follows from them.
    pub fn new(input: &SolverInput<V>) -> Result<Self, FrameError> {
        let matrices = input.matrices;
        let order = matrices.mass.rows();
        input.check(order)?;
        let zero = || V::zero(order);
        let copied = |view: V::View<'_>| {
            let mut vector = zero();
            vector.set(view);
            vector
        };
        let displacement = copied(input.initial_displacement);
        let (force, load) = (
            copied(input.initial_restoring_force),
            copied(input.initial_load),
        );
        let tangent_form = input.integrator == Integrator::Tangent;
        let tangents = match input.tangents {
            Tangents::Storeys { largest_ratio } => {
                let followed = match input.elements {
                    Some((elements, read)) => V::Tangents::of_elements(
                        elements,
                        largest_ratio,
                        input.readings,
                        &displacement,
                        read,
                    ),
                    None => V::Tangents::new(
                        &matrices.stiffness,
                        largest_ratio,
                        input.readings,
                        &displacement,
                        &force,
                    ),
                };
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
        let (mut gravity_force, mut net) = (V::default(), None);
        if let Some(gravity) = &matrices.gravity {
            gravity_force = zero();
            gravity.product(&displacement, &mut gravity_force);
            let mut force = force.clone();
            force.update([&gravity_force], |force, [gravity]| force - gravity);
            net = Some(force);
        }
        let mut acceleration = zero();
        acceleration.update(
            [&load, net.as_ref().unwrap_or(&force)],
            |_, [load, force]| load - force,
        );
        form.mass_factor().solve(&mut acceleration);
        let velocity = zero();
        let mut read = Vec::new();
        if let Some((elements, start)) = input.elements {
            read.extend_from_slice(start);
            let motion = [displacement.as_slice(), velocity.as_slice()];
            elements.complete(motion, input.i_modification, &mut read);
        }
        Ok(Self {
            form,
            modification: input
                .i_modification
                .then(|| input.operator_stiffness.clone()),
            elements: input.elements.map(|(elements, _)| elements.clone()),
            state: State {
                step: 0,
                time: 0.0,
                target: displacement.clone(),
                measured_displacement: displacement.clone(),
                displacement,
                velocity,
                acceleration,
                restoring_force: force.clone(),
                gravity_force,
                force_at_computed: force,
                load,
                storey_stiffness: tangents
                    .as_ref()
                    .map(|followed| followed.stiffness().clone())
                    .unwrap_or_default(),
                elements: read,
                energies: FrameEnergies::default(),
            },
            tangents,
            net,
            next: Motion::at_rest(order),
            load_end: zero(),
            predicted: false,
            effective_force: zero(),
            tracking_error: zero(),
            damping_work: None,
        })
    }

    /// Measured displacement before the first step \[m\].
    pub fn measured_at_start(&mut self, measured_displacement: V::View<'_>) {
        self.state.measured_displacement.set(measured_displacement);
    }

    /// The elements of a frame of matrices at the targets of the step in progress, before it is completed.
    pub fn read_elements(&mut self, elements: &[ElementReading]) {
        self.state.elements.clear();
        self.state.elements.extend_from_slice(elements);
    }

    /// G X at these displacements \[m\], in \[N\]; empty without weights.
    #[must_use]
    pub fn gravity_force(&self, displacement: V::View<'_>) -> Vec<f64> {
        let Some(gravity) = &self.form.matrices.gravity else {
            return Vec::new();
        };
        let (mut at, mut force) = (V::default(), V::zero(gravity.rows()));
        at.set(displacement);
        gravity.product(&at, &mut force);
        force.as_slice().to_vec()
    }

    /// Displacements to command in this step \[m\], under the loads at its end \[N\]. Called again before `complete`, it returns the
    /// same, whatever the loads.
    #[inline]
    pub fn predict(&mut self, load_end: V::View<'_>) -> V::View<'_> {
        self.predict_with(load_end, ())
    }

    /// Predicted velocities at the end of the step predicted last \[m/s\]: exact in the tangent form, at constant acceleration under the
    /// other integrators.
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

    /// [`Self::predict`] with a contact.
    #[inline]
    pub(crate) fn predict_with(
        &mut self,
        load_end: V::View<'_>,
        contact: impl StepContact,
    ) -> V::View<'_> {
        if !self.predicted {
            self.predicted = true;
            self.load_end.set(load_end);
            self.damping_work = None;
            let Self {
                form,
                tangents,
                state,
                net,
                next,
                load_end,
                ..
            } = self;
            let from = state.moment(net.as_ref());
            if form.integrator == Integrator::Tangent {
                let tangents = tangents.as_ref();
                V::predict(form, tangents, &from, load_end, next, contact);
            } else {
                form.impose(&from, next);
            }
        }
        self.next.displacement.view()
    }

    /// The same in tangent form, with a contact law that divides the step and returns the work of the dampers \[J\].
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
                self.state.moment(self.net.as_ref()),
                &self.load_end,
                &mut self.next,
            ));
        }
        self.next.displacement.view()
    }

    /// Whether the step in progress has its targets.
    pub(crate) const fn is_predicted(&self) -> bool {
        self.predicted
    }

    /// Ends the step with the readings at the targets. Without a prediction before it, the loads are those of its start.
    #[inline]
    pub fn complete(
        &mut self,
        measured_displacement: V::View<'_>,
        restoring_force: V::View<'_>,
    ) -> &State<V> {
        self.complete_with(measured_displacement, restoring_force, ())
    }

    #[inline]
    pub(crate) fn complete_with(
        &mut self,
        measured_displacement: V::View<'_>,
        restoring_force: V::View<'_>,
        contact: impl StepContact,
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
            elements,
            net,
            state,
            next,
            load_end,
            effective_force,
            tracking_error,
            ..
        } = self;
        state.measured_displacement.set(measured_displacement);
        state.restoring_force.set(restoring_force);
        state.target.set(next.displacement.view());
        let effective_force = match modification {
            Some(operator) => {
                correct(
                    operator,
                    &state.target,
                    &state.measured_displacement,
                    &state.restoring_force,
                    tracking_error,
                    effective_force,
                );
                if let Some(elements) = elements {
                    elements.correct(&state.elements, effective_force.as_mut_slice());
                }
                &*effective_force
            }
            None => &state.restoring_force,
        };
        let is_tangent = form.integrator == Integrator::Tangent;
        match net {
            None if is_tangent => next.force.set(effective_force.view()),
            None => form.correct(
                &state.moment(None),
                load_end,
                effective_force,
                next,
                contact,
            ),
            Some(net) => {
                let read = tracking_error;
                if let Some(gravity) = &form.matrices.gravity {
                    gravity.product(&state.target, &mut state.gravity_force);
                }
                read.update(
                    [effective_force, &state.gravity_force],
                    |_, [force, gravity]| force - gravity,
                );
                if is_tangent {
                    net.set(read.view());
                    next.force.set(effective_force.view());
                } else {
                    form.correct(&state.moment(Some(net)), load_end, read, next, contact);
                    net.set(next.force.view());
                    if let Some(gravity) = &form.matrices.gravity {
                        gravity.mul_add(1.0, &next.displacement, &mut next.force);
                    }
                }
            }
        }
        if let Some(tangents) = tangents
            && tangents.take(
                &state.measured_displacement,
                &state.restoring_force,
                &state.elements,
            )
        {
            if form.integrator == Integrator::Tangent {
                V::follow(form, tangents);
            }
            state.storey_stiffness.set(tangents.stiffness().view());
        }
        self.accept();
        &self.state
    }

    /// Effective forces r* \[N\] at these targets for these readings \[m\], \[N\].
    #[must_use]
    pub fn effective_force_at(
        &self,
        target: V::View<'_>,
        measured: V::View<'_>,
        force: V::View<'_>,
    ) -> V {
        let copy = |view: V::View<'_>| {
            let mut vector = V::default();
            vector.set(view);
            vector
        };
        let force = copy(force);
        let Some(operator) = &self.modification else {
            return force;
        };
        let (mut tracking_error, mut effective_force) =
            (self.tracking_error.clone(), self.effective_force.clone());
        correct(
            operator,
            &copy(target),
            &copy(measured),
            &force,
            &mut tracking_error,
            &mut effective_force,
        );
        if let Some(elements) = &self.elements {
            elements.correct(&self.state.elements, effective_force.as_mut_slice());
        }
        effective_force
    }

    /// Effective forces r* at the targets of the last step \[N\].
    #[must_use]
    pub fn effective_force(&self) -> V::View<'_> {
        if self.modification.is_some() {
            self.effective_force.view()
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
            modification,
            elements,
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
        state.displacement.take_over(&mut next.displacement);
        state.velocity.take_over(&mut next.velocity);
        state.acceleration.take_over(&mut next.acceleration);
        state.force_at_computed.take_over(&mut next.force);
        state.load.take_over(load_end);
        if let Some(elements) = elements {
            elements.complete(
                [state.displacement.as_slice(), state.velocity.as_slice()],
                modification.is_some(),
                &mut state.elements,
            );
        }
        state.step += 1;
        // A signed number is converted in one instruction.
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = state.step.cast_signed() as f64 * time_step;
        state.time = time;
    }

    /// The structure at the end of the last step.
    #[must_use]
    pub const fn state(&self) -> &State<V> {
        &self.state
    }
}

/// r* = `r_m` − `K_I`(`d_m` − d̃) \[N\].
#[inline]
fn correct<V: Vector>(
    operator: &V::Matrix,
    target: &V,
    measured: &V,
    force: &V,
    tracking_error: &mut V,
    effective_force: &mut V,
) {
    effective_force.set(force.view());
    tracking_error.update([measured, target], |_, [measured, target]| {
        measured - target
    });
    operator.mul_add(-1.0, tracking_error, effective_force);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Matrices;

    const MASS: f64 = 1.0;
    const STIFFNESS: f64 = 400.0;

    /// A mass on a spring, released at 1 m, after `steps` steps in tangent form.
    fn vibration(damping: f64, time_step: f64, steps: u32) -> State<f64> {
        let matrices = Matrices {
            mass: MASS,
            damping,
            stiffness: STIFFNESS,
            gravity: None,
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
            readings: &[],
            elements: None,
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

    /// Constant average acceleration conserves the energy of a linear vibration at any step.
    #[test]
    fn undamped_energy_is_conserved() {
        for time_step in [1e-3, 0.1] {
            let end = vibration(0.0, time_step, 1000);
            let energy = MASS * end.velocity.powi(2) + STIFFNESS * end.displacement.powi(2);
            assert!((energy / STIFFNESS - 1.0).abs() < 1e-11, "{energy}");
        }
    }
}
