//! The steps of an impact, one after the other. In: what is known before the first step, the rig behind its guard. Out:
//! every step as it ended, and what they come to. It judges no plan.

use super::StepReport;
use super::continuous;
use super::impact::Setting;
use super::session::{self, Session};
use super::stiffer::{Judged, Stiffer};
use super::stop::Stop;
use super::triggers::Triggers;
use super::watch::Watch;
use crate::mechanics::impact::{ImpactSolver, ImpactState};
use crate::mechanics::monitor::{Monitor, Tracking};
use crate::mechanics::summary::SummaryBuilder;
use crate::plan::{Impact, Mode, Stepping};
use crate::record::ImpactStep;
use crate::rig::DeclaredNoise;

pub(super) struct Strike {
    pub(super) setting: Setting,
    /// Steps of the procedure done before these.
    before: u64,
    pub steps: Vec<ImpactStep>,
    pub summary: SummaryBuilder,
    pub watch: Watch,
}

impl Strike {
    /// `before` steps of the procedure are done already.
    pub(super) fn new(setting: &Setting, before: u64) -> Self {
        Self {
            setting: *setting,
            before,
            steps: room_for(setting.steps),
            summary: SummaryBuilder::new(&setting.input),
            watch: Watch::default(),
        }
    }

    pub(super) fn run(&mut self, plan: &Impact, session: &mut Session<'_>) -> Result<(), Stop> {
        if let Mode::Continuous { time_scale } = plan.stepping.mode {
            return continuous::run(self, plan, time_scale, session);
        }
        let Setting { input, steps, pause, .. } = self.setting;
        let mut triggers = Triggers::new(&plan.stepping.inspect);
        // X starts where the actuator was sent to, and R₀ is read there once, before the first step.
        let start = session.commanded();
        let (measured, restoring_force) = session.read()?;
        let mut solver = ImpactSolver::new(&input, start, restoring_force);
        let mut monitor = Monitor::new_as(start, measured, restoring_force, solver.taken_at(start, measured, restoring_force));
        let first = ImpactState { measured_displacement: measured, ..*solver.state() };
        self.take(&first, monitor.tracking(), session);
        let mut stiffer = self.stiffer(&plan.stepping, (measured, restoring_force), session);
        for _ in 0..steps {
            let target = solver.predict();
            session.guard.move_to(&[target], None)?;
            session.guard.pause(pause)?;
            let (reading, broken) = session.read_kept()?;
            let (measured, restoring_force) = session::first(&reading);
            let taken = solver.taken(measured, restoring_force);
            let tracking = monitor.take_as(target, measured, restoring_force, taken);
            if let Some(stop) = broken {
                self.take(solver.complete(measured, restoring_force), tracking, session);
                return Err(stop);
            }
            stiffer.take((measured, restoring_force), false, "the specimen", session);
            let state = *solver.complete(measured, restoring_force);
            self.step(&state, tracking, session)?;
            if solver.over(plan.until) {
                break;
            }
            if let Some(reason) = triggers.after(state.step, state.time, restoring_force) {
                session.inspect(&reason)?;
            }
        }
        Ok(())
    }

    /// Watches whether the specimen is stiffer than the integrator takes it for; `first` is what was read before the first step.
    pub(super) fn stiffer(&self, plan: &Stepping, first: (f64, f64), session: &Session<'_>) -> Stiffer {
        let Setting { input, .. } = self.setting;
        let DeclaredNoise { force, resolution } = session.guard.declared_noise();
        let judged = Judged {
            integrator: plan.integrator,
            operator_stiffness: input.operator_stiffness,
            mobility: 1.0 / input.mass,
            time_step: input.time_step,
            // A quantum q is spread evenly over ±q/2.
            noise: (force, resolution / 12_f64.sqrt()),
            moving: plan.mode != Mode::StepAndPause,
        };
        Stiffer::new(judged, first)
    }

    /// A step has ended: it is kept, judged and told.
    pub(super) fn step(&mut self, state: &ImpactState, tracking: Tracking, session: &mut Session<'_>) -> Result<(), Stop> {
        self.take(state, tracking, session);
        let error = error_fraction(state);
        let share = tracking.share_of(state.input);
        self.watch.judge(share, session);
        session.guard.check_energy_error(error)?;
        session.guard.check_tracking(share, tracking.nrms_error)?;
        session.step_done(StepReport {
            step: self.before + state.step,
            time: state.time,
            command: state.target,
            displacement: state.measured_displacement,
            velocity: Some(state.velocity),
            acceleration: Some(state.acceleration),
            force: state.restoring_force,
            speed: None,
            energy_error: Some(error),
            tracking: Some(tracking),
            tracking_energy_error: share,
            others: Vec::new(),
        })
    }

    pub(super) fn take(&mut self, state: &ImpactState, tracking: Tracking, session: &Session<'_>) {
        self.summary.push(state);
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
            tracking,
        });
    }
}

/// Room for the steps to come, as far as it is cheap: `duration` is often far beyond the end.
fn room_for(steps: u64) -> Vec<ImpactStep> {
    Vec::with_capacity(usize::try_from(steps + 1).unwrap_or(usize::MAX).min(100_000))
}

/// Energy error over the input; of no input, any error is infinite.
fn error_fraction(state: &ImpactState) -> f64 {
    if state.energies.error == 0.0 { 0.0 } else { state.energies.error / state.input }
}
