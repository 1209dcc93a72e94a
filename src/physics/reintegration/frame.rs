//! A frame re-integrated along the force–displacement path that a run recorded, with an input perturbed: on moving ground, or struck on
//! one floor. In: the frame and its load, the path, the perturbed readings. Out: the results of the run, between the ends of
//! steps, so that they follow the inputs smoothly. It moves no rig and knows no uncertainty.

use std::cell::Cell;

use super::frame_path::{FramePath, FrameRetrace};
use super::impact::{ImpactResults, Outcome};
use crate::contact::ContactLaw;
use crate::contact::state::StepState;
use crate::impact::Until;
use crate::impact::peaks::{Peak, PeakDisplacements, farther};
use crate::impact::{FrameImpactSolver, ImpactError, ImpactInput, ImpactSetup, ImpactState, Sink};
use crate::integrator::Integrator;
use crate::integrator::input::{FrameError, FrameInput};
use crate::integrator::solver::FrameSolver;
use crate::integrator::state::FrameState;
use crate::integrator::tangents::Tangents;
use crate::reintegration::perturbation::Perturbation;
use crate::structure::assemblies::StoreyReadings;
use crate::structure::elements::Elements;
use crate::structure::{FrameMatrices, SymmetricBand, widen};

/// The settings with which a frame is integrated.
#[derive(Clone, Debug)]
pub struct FrameRun {
    pub matrices: FrameMatrices,
    /// `K_I` of α-OS and of the I-modification \[N/m\].
    pub operator: SymmetricBand,
    pub integrator: Integrator,
    pub i_modification: bool,
    pub tangents: Tangents,
    /// \[s\]
    pub time_step: f64,
    /// Largest number of steps.
    pub steps: u64,
    /// The elements of a frame of matrices.
    pub elements: Option<Elements>,
    /// The factor on the stiffness of every storey that is computed, and at last that on the stiffness of the files beside elements; empty
    /// for 1.
    pub computed_factors: Vec<f64>,
    /// Of each storey, as the run used them.
    pub readings: Vec<StoreyReadings>,
    /// Whether the floors passed their targets without a stop.
    pub continuous: bool,
}

/// A striker on one floor.
#[derive(Clone, Copy, Debug)]
pub struct FloorImpact {
    /// From 0.
    pub struck: usize,
    pub law: ContactLaw,
    pub until: Until,
    /// The struck floor and the striker, as for an impact on one degree of freedom.
    pub body: ImpactInput,
}

/// The results of the floors in SI, with one entry per floor, or per storey or element.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Floors {
    pub max_displacement: Vec<f64>,
    pub max_drift: Vec<f64>,
    /// Storey drift or deformation of an element at the end.
    pub final_drift: Vec<f64>,
    /// Of each element of a frame of matrices; empty without elements.
    pub max_element_force: Vec<f64>,
    pub max_base_shear: f64,
}

impl Floors {
    /// Peak |X| of all floors \[m\]; NaN if one is NaN.
    #[must_use]
    pub fn farthest(&self) -> f64 {
        self.max_displacement
            .iter()
            .fold(0.0, |most, position| farther(most, *position))
    }
}

/// Results of a run: at the ends of steps, as the run itself reports them, and interpolated between them.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorsOutcome {
    pub ends: Floors,
    pub between: Floors,
    /// The interpolated ones at the departure of the run from the record.
    pub before_departure: Option<Floors>,
    /// Velocities predicted for the floors at the targets of a continuous motion \[m/s\]; given if the path does not know them.
    pub velocities: Vec<Vec<f64>>,
}

/// Results of an impact on one floor.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorImpactOutcome {
    pub impact: Outcome,
    pub floors: FloorsOutcome,
    pub striker: StrikerOutcome,
    /// The interpolated ones at the departure of the run from the record.
    pub before_departure: Option<StrikerOutcome>,
}

/// Results of an impact on one floor beside those of the impact and of the floors.
#[derive(Clone, Debug, PartialEq)]
pub struct StrikerOutcome {
    /// ∫ shear d(storey drift) of each storey, or of the force of each element \[J\].
    pub storey_energy: Vec<f64>,
    /// Steps in contact from the first touch on.
    pub first_contact_steps: u64,
    /// Final velocity of the striker \[m/s\].
    pub striker_velocity: f64,
}

impl FrameRun {
    fn input<'a>(
        &'a self,
        retrace: &'a FrameRetrace,
        load: &'a [f64],
        time_step: f64,
    ) -> FrameInput<'a> {
        FrameInput {
            matrices: &self.matrices,
            operator_stiffness: &self.operator,
            integrator: self.integrator,
            i_modification: self.i_modification,
            tangents: self.tangents,
            time_step,
            initial_displacement: retrace.start(),
            initial_restoring_force: retrace.force(),
            initial_load: load,
            readings: &self.readings,
            elements: self
                .elements
                .as_ref()
                .map(|elements| (elements, retrace.elements())),
        }
    }

    /// Re-integrates a ground-motion test; ground accelerations \[m/s²\] at the ends of the finer steps from 0 on.
    ///
    /// # Errors
    /// The frame, with its inputs perturbed, cannot be stepped.
    pub fn under_ground_motion(
        &self,
        ground: &[f64],
        path: &FramePath,
        readings: &Perturbation,
    ) -> Result<FloorsOutcome, FrameError> {
        let mut retrace = path.retrace(readings, &self.computed_factors);
        let mut load = vec![0.0; self.matrices.order()];
        let at = |step: usize| ground.get(step).copied().unwrap_or(0.0);
        self.matrices.ground_load(at(0), &mut load);
        let time_step = self.time_step / f64::from(readings.finer);
        let mut solver = FrameSolver::new(&self.input(&retrace, &load, time_step))?;
        let mut peaks = Peaks::new(solver.state(), time_step);
        peaks.take(solver.state(), 1.0);
        let mut velocities_at_targets = TargetVelocities::new(self, path);
        for step in (1..)
            .take(usize::try_from(self.steps * u64::from(readings.finer)).unwrap_or(usize::MAX))
        {
            self.matrices.ground_load(at(step), &mut load);
            solver.predict(&load);
            let velocities =
                velocities_at_targets.predicted_velocities(&mut |to| solver.predicted_velocity(to));
            retrace.move_to(solver.predict(&load), velocities);
            if retrace.departed() {
                peaks.departs();
            }
            solver.read_elements(retrace.elements());
            peaks.take(
                solver.complete(retrace.displacement(), retrace.force()),
                1.0,
            );
        }
        Ok(peaks.finish(velocities_at_targets))
    }

    /// Re-integrates an impact on one floor.
    ///
    /// # Errors
    /// As [`Self::under_ground_motion`].
    pub fn struck(
        &self,
        impact: &FloorImpact,
        path: &FramePath,
        readings: &Perturbation,
    ) -> Result<FloorImpactOutcome, ImpactError> {
        let mut retrace = path.retrace(readings, &self.computed_factors);
        let order = self.matrices.order();
        let FloorImpact {
            struck,
            law,
            until,
            mut body,
        } = *impact;
        body.time_step /= f64::from(readings.finer);
        let unloaded = vec![0.0; order];
        let setup = ImpactSetup {
            struck,
            law,
            ..body.setup()
        };
        let mut solver =
            FrameImpactSolver::on(&self.input(&retrace, &unloaded, body.time_step), &setup)?;
        let start = ImpactState {
            measured_displacement: retrace.displacement()[struck],
            ..*solver.state()
        };
        let departed = Cell::new(false);
        let mut found = StruckFloors {
            impact: ImpactResults::new(&body, until, &start),
            peaks: Peaks::new(solver.structure(), body.time_step),
            energy: StoreyWork::new(solver.structure()),
            first_contact_steps: 0,
            first_is_over: false,
            last: start,
            departed: &departed,
            before_departure: None,
        };
        found.peaks.take(solver.structure(), 1.0);
        let mut velocities_at_targets = TargetVelocities::new(self, path);
        let read = |solver: &mut FrameImpactSolver| {
            let velocities = velocities_at_targets.predicted_velocities(&mut |to| {
                solver.predicted_velocity(to);
            });
            retrace.move_to(solver.predict(), velocities);
            solver.read_elements(retrace.elements());
            departed.set(retrace.departed());
            [retrace.displacement().to_vec(), retrace.force().to_vec()]
        };
        let steps = self.steps * u64::from(readings.finer);
        solver.run(Some(until), steps, read, &mut found);
        Ok(FloorImpactOutcome {
            impact: found.impact.finish(),
            striker: found.energy.outcome(found.first_contact_steps, &found.last),
            before_departure: found.before_departure,
            floors: found.peaks.finish(velocities_at_targets),
        })
    }
}

/// An impact on one floor, collected from the ends of its steps.
struct StruckFloors<'a> {
    impact: ImpactResults,
    peaks: Peaks,
    energy: StoreyWork,
    first_contact_steps: u64,
    first_is_over: bool,
    /// At the end of the last step.
    last: ImpactState,
    /// Whether the reading of the step in progress departed from the record.
    departed: &'a Cell<bool>,
    before_departure: Option<StrikerOutcome>,
}

impl Sink<Vec<f64>> for StruckFloors<'_> {
    fn push(&mut self, frame: &FrameState, now: &ImpactState, over: bool) {
        if self.departed.get() && self.before_departure.is_none() {
            self.impact.departs();
            self.peaks.departs();
            self.before_departure = Some(self.energy.outcome(self.first_contact_steps, &self.last));
        }
        self.impact.take(now, over);
        self.peaks.take(frame, self.impact.share());
        self.energy.take(frame, self.impact.share());
        match now.state {
            StepState::Free => self.first_is_over |= self.first_contact_steps > 0,
            _ if !self.first_is_over => self.first_contact_steps += 1,
            _ => {}
        }
        self.last = *now;
    }
}

/// Velocities of the floors at their targets in a run without stops \[m/s\].
struct TargetVelocities {
    /// At the end of the step in progress; empty for a run that stops.
    now: Vec<f64>,
    gathers: bool,
    gathered: Vec<Vec<f64>>,
}

impl TargetVelocities {
    /// From rest.
    fn new(run: &FrameRun, path: &FramePath) -> Self {
        let now = vec![
            0.0;
            if run.continuous {
                run.matrices.order()
            } else {
                0
            }
        ];
        let gathers = run.continuous && !path.knows_velocities();
        Self {
            gathered: if gathers {
                vec![now.clone()]
            } else {
                Vec::new()
            },
            gathers,
            now,
        }
    }

    fn predicted_velocities(&mut self, predict: &mut dyn FnMut(&mut [f64])) -> &[f64] {
        if !self.now.is_empty() {
            predict(&mut self.now);
        }
        if self.gathers {
            self.gathered.push(self.now.clone());
        }
        &self.now
    }
}

/// Peaks of all floors, and of all storeys or elements, step by step.
struct Peaks {
    ends: Floors,
    displacement: PeakDisplacements,
    drift: PeakDisplacements,
    element_force: Vec<Peak>,
    base_shear: Peak,
    time_step: f64,
    velocity: Vec<f64>,
    /// Storey drift, or deformation, and its velocity at the end of the last step.
    last: Vec<(f64, f64)>,
    /// The same inside the last step, where the run ends.
    final_inside: Vec<f64>,
    before_departure: Option<Floors>,
}

impl Peaks {
    fn new(start: &FrameState, time_step: f64) -> Self {
        let (floors, members) = (start.displacement.len(), start.members());
        let nothing = || vec![0.0; members];
        let ends = Floors {
            max_displacement: vec![0.0; floors],
            max_drift: nothing(),
            final_drift: nothing(),
            max_element_force: vec![0.0; start.elements.len()],
            max_base_shear: 0.0,
        };
        Self {
            ends,
            displacement: PeakDisplacements::new(floors, time_step),
            drift: PeakDisplacements::new(members, time_step),
            element_force: vec![Peak::default(); start.elements.len()],
            base_shear: Peak::default(),
            time_step,
            velocity: nothing(),
            last: vec![(0.0, 0.0); members],
            final_inside: nothing(),
            before_departure: None,
        }
    }

    /// Adds the end of a step, of which the run counts this fraction.
    fn take(&mut self, state: &FrameState, share: f64) {
        state.drifts(&mut self.ends.final_drift);
        state.drift_velocities(&mut self.velocity);
        widen(&mut self.ends.max_displacement, &state.displacement);
        widen(&mut self.ends.max_drift, &self.ends.final_drift);
        let forces = self
            .ends
            .max_element_force
            .iter_mut()
            .zip(&mut self.element_force);
        for ((largest, peak), element) in forces.zip(&state.elements) {
            *largest = largest.max(element.force.abs());
            peak.take(element.force);
        }
        let shear = state.base_shear();
        self.ends.max_base_shear = self.ends.max_base_shear.max(shear.abs());
        self.displacement.take(
            state
                .displacement
                .iter()
                .copied()
                .zip(state.velocity.iter().copied()),
        );
        let drift = || {
            self.ends
                .final_drift
                .iter()
                .copied()
                .zip(self.velocity.iter().copied())
        };
        self.drift.take(drift());
        for (storey, now) in drift().enumerate() {
            let (before, speed) = self.last[storey];
            let mean = speed + 0.5 * share * (now.1 - speed);
            self.final_inside[storey] = if share < 1.0 {
                before + share * self.time_step * mean
            } else {
                now.0
            };
            self.last[storey] = now;
        }
        self.base_shear.take(shear);
    }

    /// From the next step on the path differs from the record.
    fn departs(&mut self) {
        if self.before_departure.is_none() {
            self.before_departure = Some(self.between());
        }
    }

    fn between(&self) -> Floors {
        Floors {
            max_displacement: self.displacement.largest().to_vec(),
            max_drift: self.drift.largest().to_vec(),
            final_drift: self.final_inside.clone(),
            max_element_force: self.element_force.iter().map(Peak::largest).collect(),
            max_base_shear: self.base_shear.largest(),
        }
    }

    fn finish(self, velocities_at_targets: TargetVelocities) -> FloorsOutcome {
        let between = self.between();
        FloorsOutcome {
            ends: self.ends,
            between,
            before_departure: self.before_departure,
            velocities: velocities_at_targets.gathered,
        }
    }
}

/// ∫ shear d(storey drift) of each storey, or of the force of each element, by the trapezoidal rule \[J\].
struct StoreyWork {
    drift: Vec<f64>,
    shear: Vec<f64>,
    storeys: Vec<f64>,
}

impl StoreyWork {
    fn new(start: &FrameState) -> Self {
        let nothing = || vec![0.0; start.members()];
        let mut work = Self {
            drift: nothing(),
            shear: nothing(),
            storeys: nothing(),
        };
        start.drifts(&mut work.drift);
        start.shears_at_computed(&mut work.shear);
        work
    }

    /// Adds the end of a step, of which the run counts this fraction.
    fn take(&mut self, state: &FrameState, share: f64) {
        let (mut drift, mut shear) = (vec![0.0; self.drift.len()], vec![0.0; self.shear.len()]);
        state.drifts(&mut drift);
        state.shears_at_computed(&mut shear);
        for storey in 0..drift.len() {
            let moved = drift[storey] - self.drift[storey];
            self.storeys[storey] += share * 0.5 * (self.shear[storey] + shear[storey]) * moved;
        }
        (self.drift, self.shear) = (drift, shear);
    }

    fn outcome(&self, first_contact_steps: u64, end: &ImpactState) -> StrikerOutcome {
        StrikerOutcome {
            storey_energy: self.storeys.clone(),
            first_contact_steps,
            striker_velocity: end.striker_velocity,
        }
    }
}
