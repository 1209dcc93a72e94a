//! The steps of an impact, on one degree of freedom or on one floor of a frame: the striker beside the structure, and every step kept.
//! In: a solver at the present position of the rig. Out: the history and its summary. `step_loop` takes the steps on the rig; the
//! equations are in `physics`.

pub(crate) mod batched;

use super::summary::StruckSummary;
use crate::physics::impact::ImpactSolver;
use crate::physics::integrator::tangents::HasTangents;
use crate::physics::tracking::monitor::Tracking;
use crate::plan::{Stepping, Until};
use crate::procedures::stepping::axes::AxesState;
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::run::Steps;
use crate::procedures::stepping::start::Start;
use crate::procedures::stepping::step_loop;
use crate::procedures::stepping::step_loop::{Balance, Stepped};
use crate::procedures::stepping::tracking::tracking_summary::Followed;
use crate::record::{FloorMotion, FloorStep, ImpactStep};
use crate::rig::Reading;
use crate::run::session::Session;
use crate::run::stop::Stop;

/// The settings of the steps of an impact.
pub(crate) struct ImpactSteps<'a> {
    pub stepping: &'a Stepping,
    pub steps: &'a Steps,
    pub until: Until,
    /// Steps of the procedure done before these.
    pub before: u64,
}

/// The record of an impact in progress.
pub(crate) struct Kept {
    /// The struck degree of freedom and the striker.
    pub steps: Vec<ImpactStep>,
    /// Every floor of a frame.
    pub floors: Vec<FloorStep>,
    pub summary: StruckSummary,
    pub followed: Followed,
}

impl Kept {
    /// Before the first of `steps` steps. Capacity is reserved for at most 100,000 of them: `duration` is often far beyond the end.
    pub(crate) fn new(summary: StruckSummary, steps: u64) -> Self {
        let capacity = usize::try_from(steps + 1)
            .unwrap_or(usize::MAX)
            .min(100_000);
        Self {
            steps: Vec::with_capacity(capacity),
            floors: Vec::new(),
            summary,
            followed: Followed::default(),
        }
    }
}

impl ImpactSteps<'_> {
    /// All steps, with the solver that `begin` makes from the present position of the rig.
    pub(crate) fn run<V: HasTangents>(
        &self,
        kept: &mut Kept,
        session: &mut Session<'_>,
        begin: impl FnOnce(&Start) -> Result<(ImpactSolver<V>, StifferSprings), Stop>,
    ) -> Result<(), Stop> {
        let Kept {
            steps,
            floors,
            summary,
            followed,
        } = kept;
        let (until, before) = (self.until, self.before);
        step_loop::run(self.steps, self.stepping, followed, session, |start| {
            let (mut solver, stiffer) = begin(start)?;
            solver.measured_at_start(V::view_of(&start.reading.displacement));
            Ok((
                Struck {
                    solver,
                    until,
                    before,
                    steps,
                    floors,
                    summary,
                },
                stiffer,
            ))
        })
    }
}

/// The structure in motion, with its striker.
struct Struck<'a, V: HasTangents> {
    solver: ImpactSolver<V>,
    until: Until,
    before: u64,
    steps: &'a mut Vec<ImpactStep>,
    floors: &'a mut Vec<FloorStep>,
    summary: &'a mut StruckSummary,
}

impl<V: HasTangents> Stepped for Struck<'_, V> {
    fn axes(&self) -> AxesState<'_> {
        AxesState::of(self.solver.structure())
    }

    fn predict(&mut self) -> Vec<f64> {
        V::slice_of(&self.solver.predict()).to_vec()
    }

    fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool {
        self.solver.predicted_velocity(velocity)
    }

    fn effective_force_at_start(&self, start: &Start) -> Vec<f64> {
        let Reading {
            displacement,
            force,
            ..
        } = &start.reading;
        let effective_force = self.solver.effective_force_at(
            V::view_of(&start.commanded),
            V::view_of(displacement),
            V::view_of(force),
        );
        effective_force.as_slice().to_vec()
    }

    fn effective_force(&self) -> Vec<f64> {
        V::slice_of(&self.solver.effective_force()).to_vec()
    }

    fn complete(&mut self, reading: &Reading) {
        self.solver.complete(
            V::view_of(&reading.displacement),
            V::view_of(&reading.force),
        );
    }

    fn keep(&mut self, axes: &[Tracking], session: &Session<'_>) -> Balance {
        let state = self.solver.state();
        self.summary.push(self.solver.structure(), state);
        self.steps.push(ImpactStep {
            step: state.step,
            time: state.time,
            wall_time: session.guard.time(),
            state: state.state,
            command: state.target,
            computed: state.displacement,
            displacement: state.measured_displacement,
            velocity: state.velocity,
            acceleration: state.acceleration,
            restoring_force: state.restoring_force,
            contact_force: state.contact_force,
            striker_displacement: state.striker_displacement,
            striker_velocity: state.striker_velocity,
            tangent_stiffness: state.tangent_stiffness,
            indentation: state.indentation,
            energies: state.energies,
            tracking: Tracking::together(axes),
        });
        if let Some(floors) = self.summary.floors() {
            self.floors.push(FloorStep {
                floors: FloorMotion::of_state(self.solver.structure(), axes),
                storey_energy: floors.storey_energy().to_vec(),
            });
        }
        Balance {
            error: state.energies.error,
            input: state.input,
        }
    }

    fn cut_off(&mut self, reading: &Reading, time_step: f64, session: &Session<'_>) {
        let (target, struck) = (self.predict(), self.solver.struck());
        let Some(last) = self.steps.last() else {
            return;
        };
        let time = last.time + time_step;
        let step = ImpactStep {
            step: last.step + 1,
            time,
            wall_time: session.guard.time(),
            command: target[struck],
            computed: reading.displacement[struck],
            displacement: reading.displacement[struck],
            restoring_force: reading.force[struck],
            ..*last
        };
        self.steps.push(step);
        self.summary.moved_to(struck, reading, time);
        if let Some(last) = self.floors.last() {
            let floors = last
                .floors
                .cut_off(time, &target, &reading.displacement, &reading.force);
            let storey_energy = last.storey_energy.clone();
            self.floors.push(FloorStep {
                floors,
                storey_energy,
            });
        }
    }

    fn is_struck(&self) -> bool {
        self.solver.state().contact_force > 0.0
    }

    fn before(&self) -> u64 {
        self.before
    }

    fn over(&self) -> bool {
        self.solver.over(self.until)
    }
}
