//! The steps of a structure on a rig, whatever excites it: predict, command, settle, pause, read, feed back. In continuous mode the
//! actuators follow smooth paths together (`continuous_motion`) and are read as they pass their targets. In: a [`Stepped`] that computes
//! and keeps the steps, the settings of the steps, the rig behind its guard. Out: every step completed, checked and reported, or the
//! reason of the end. It knows no ground, no striker and no equation.
//!
//! If an actuator was not at its target (lag, resolution), the reading is corrected to the target by the I-modification,
//! r* = `r_m` − `K_I`(`d_m` − d̃). The force of a damper of the specimen is in the reading, at the actuator's velocity:
//! c·v/`time_scale`.

use super::continuous_motion::{ContinuousMotion, Waypoint};
use super::end_of_step::{AxesState, Balance, EndOfStep, Errors};
use super::ideal_run::IdealRun;
use super::operator_stability_watch::StifferSprings;
use super::setting::{Start, Steps};
use super::tracking::{At, Monitors, TrackingSummary};
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::run::{Keep, StepReport};
use psd_physics::structure::assemblies::Assemblies;
use psd_physics::structure::elements::ElementReading;
use psd_physics::tracking::monitor::Tracking;
use psd_plan::{InspectTrigger, Mode, Stepping};
use psd_rig::{IdealSteps, Reading};

/// Computes the steps of a structure. It is at the end of the last step.
pub(crate) trait Stepped: EndOfStep {
    /// Sets the target of each axis at the end of the next step \[m\]. Within one step it is always the same.
    fn predict(&mut self, target: &mut [f64]);

    /// Predicted velocity of each axis at its target \[m/s\]. True if a contact force contributes to it.
    fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool;

    /// Effective forces of the recursion at the start \[N\].
    fn effective_force_at_start(&self, start: &Start) -> Vec<f64>;

    /// Sets the effective forces of the recursion at the targets of the last step \[N\].
    fn effective_force(&self, force: &mut [f64]);

    /// The elements of a frame of matrices at the targets of the step in progress.
    fn read_elements(&mut self, elements: &[ElementReading]);

    /// Ends the step with a reading.
    fn complete(&mut self, reading: &Reading);

    /// Takes `count` steps of a run on an ideal rig from its start, if it can take them without a return after each one. False, with no
    /// step: it cannot.
    fn in_one_go(&mut self, _count: u64, _run: &mut IdealRun<'_, '_>) -> bool {
        false
    }

    /// Keeps the reading that exceeded a limit on the way to the target: the step after the last one kept, of this length \[s\], has not
    /// ended.
    fn cut_off(&mut self, target: &[f64], reading: &Reading, time_step: f64, wall_time: f64);

    /// Whether the run ends before all steps are done.
    fn over(&self) -> bool;
}

/// All steps, from the present position of the rig. A run that keeps its results alone keeps its last step.
pub(crate) fn run<S: Stepped>(
    steps: &Steps,
    plan: &Stepping,
    followed: &mut TrackingSummary,
    session: &mut Session<'_>,
    begin: impl FnOnce(&Start) -> Result<(S, StifferSprings), Stop>,
) -> Result<(), Stop> {
    let (commanded, reading) = session.floors_at_rest()?;
    let start = Start {
        commanded,
        reading,
        readings: session.storey_readings(),
        elements: session.elements_read(),
        resolved: session.resolved_storey_readings(),
    };
    let (mut stepped, stiffer) = begin(&start)?;
    let monitors = Monitors::new(
        session.assemblies().cloned(),
        plan.i_modification,
        &At {
            commanded: &start.commanded,
            reading: &start.reading,
            elements: &start.elements,
            effective_force: &stepped.effective_force_at_start(&start),
        },
    );
    let motion = match plan.mode {
        Mode::Continuous { time_scale } => Some(ContinuousMotion::from_rest(
            session.guard.commanded(),
            time_scale,
            steps.time_step,
        )),
        Mode::RampAndHold => None,
    };
    let keeps_steps = session.keep != Keep::Results;
    stepped.sum_up();
    if keeps_steps {
        stepped.keep(monitors.tracking(), session.guard.time());
    }
    let mut taken = StepsTaken {
        stepped,
        stiffer,
        monitors,
        motion,
        keeps_steps,
        target: start.commanded,
        reading: start.reading,
        wall_time: session.guard.time(),
        is_cut_off: false,
    };
    let is_interrupted = plan.mode != Mode::RampAndHold || !plan.inspect.is_empty();
    let ideal = if is_interrupted || taken.target != taken.reading.displacement {
        None
    } else {
        session.ideal_steps(steps.pause)
    };
    let ended = match ideal {
        Some(ideal) => taken.all_ideally(steps, ideal, followed, session),
        None => taken.all(steps, plan, followed, session),
    };
    let StepsTaken {
        mut stepped,
        target,
        reading,
        is_cut_off,
        ..
    } = taken;
    if is_cut_off {
        stepped.read_elements(&session.elements_read());
        stepped.cut_off(&target, &reading, steps.time_step, session.guard.time());
    }
    ended
}

/// The steps so far, and the numbers of the present step.
struct StepsTaken<S> {
    stepped: S,
    stiffer: StifferSprings,
    monitors: Monitors,
    motion: Option<ContinuousMotion>,
    keeps_steps: bool,
    /// \[m\]
    target: Vec<f64>,
    reading: Reading,
    /// Rig time at the end of the last step \[s\].
    wall_time: f64,
    /// Whether a reading exceeded a limit on the way to the target.
    is_cut_off: bool,
}

impl<S: Stepped> StepsTaken<S> {
    fn all(
        &mut self,
        steps: &Steps,
        plan: &Stepping,
        followed: &mut TrackingSummary,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let ended = self.each(steps, plan, followed, session);
        if !self.keeps_steps {
            self.stepped.keep(self.monitors.tracking(), self.wall_time);
        }
        ended
    }

    fn each(
        &mut self,
        steps: &Steps,
        plan: &Stepping,
        followed: &mut TrackingSummary,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let mut triggers = Triggers::new(&plan.inspect);
        let mut effective_force = vec![0.0; self.target.len()];
        let mut report = StepReport::default();
        let mut struck = false;
        for _ in 0..steps.count {
            if let Some(stop) = self.read_next(steps, session)? {
                if self.is_cut_off {
                    return Err(stop);
                }
                self.complete(&mut effective_force, session);
                return Err(stop);
            }
            let balance = self.complete(&mut effective_force, session);
            let Self {
                stepped,
                stiffer,
                monitors,
                reading,
                ..
            } = self;
            let (before, now) = (struck, stepped.is_struck());
            stiffer.take(reading, &session.elements_read(), before || now, session);
            struck = now;
            let (tracking, tracking_energy_error) =
                followed.assess(monitors.tracking(), balance.input, session);
            let errors = Errors {
                energy_error: balance.relative_error(),
                tracking,
                tracking_energy_error,
            };
            session.guard.check_energy_error(errors.energy_error)?;
            session
                .guard
                .check_tracking(errors.tracking_energy_error, errors.tracking.nrms_error)?;
            let state = stepped.axes();
            errors.report(&state, &mut report);
            session.report_axes(&mut report);
            report.step += stepped.before();
            session.step_done(&mut report)?;
            if stepped.over() {
                break;
            }
            let AxesState {
                step, time, force, ..
            } = stepped.axes();
            if let Some(reason) = triggers.after(step, time, force.iter().sum()) {
                session.inspect(&reason)?;
            }
        }
        let braked = self.motion.as_ref().map(|motion| motion.brake(session));
        braked.unwrap_or(Ok(()))
    }

    /// All steps on an ideal rig: no tracking error can arise.
    fn all_ideally(
        &mut self,
        steps: &Steps,
        ideal: IdealSteps,
        followed: &mut TrackingSummary,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let Self {
            stepped,
            stiffer,
            monitors,
            keeps_steps,
            target,
            reading,
            wall_time,
            ..
        } = self;
        let mut run = IdealRun {
            ideal,
            watched: Some(stiffer).filter(|stiffer| stiffer.watches()),
            axes: monitors.tracking(),
            tracking: Tracking::together(monitors.tracking()),
            keeps_steps: *keeps_steps,
            target,
            reading,
            wall_time: *wall_time,
            struck: false,
            report: session.is_followed().then(StepReport::default),
            input: None,
            beyond: None,
            stop: None,
            session,
        };
        if !stepped.in_one_go(steps.count, &mut run) {
            for _ in 0..steps.count {
                stepped.predict(run.target());
                let Some(reading) = run.read() else {
                    break;
                };
                stepped.complete(reading);
                if !run.end(stepped) || stepped.over() {
                    break;
                }
            }
            run.keep_last(stepped);
        }
        let IdealRun { input, stop, .. } = run;
        // The reference of the errors never falls: the last one shows whether any was above zero.
        if let Some(input) = input {
            followed.assess(monitors.tracking(), input, session);
        }
        stop.map_or(Ok(()), Err)
    }

    /// Moves to the next target and reads there; the stop of a reading that exceeded a limit, there or on the way.
    fn read_next(
        &mut self,
        steps: &Steps,
        session: &mut Session<'_>,
    ) -> Result<Option<Stop>, Stop> {
        let Self {
            stepped,
            motion,
            target,
            reading,
            is_cut_off,
            ..
        } = self;
        let Some(motion) = motion else {
            stepped.predict(target);
            let ended = session.step_floors(target, steps.pause, steps.time_step, reading)?;
            return Ok(ended.map(|ended| {
                *is_cut_off = !ended.is_reached;
                ended.fault.into()
            }));
        };
        let assemblies = session.assemblies().cloned();
        let waypoints = || waypoints(stepped, target, assemblies.as_ref());
        let (read, stop) = motion.step(waypoints, session)?;
        *is_cut_off = stop.is_some();
        if *is_cut_off {
            stepped.predict(target);
        }
        *reading = session.floors_read(target, steps.time_step, !*is_cut_off, read);
        Ok(stop)
    }

    /// Ends the step with the reading.
    fn complete(&mut self, effective_force: &mut [f64], session: &Session<'_>) -> Balance {
        let Self {
            stepped,
            monitors,
            reading,
            ..
        } = self;
        let elements = session.elements_read();
        stepped.read_elements(&elements);
        stepped.complete(reading);
        stepped.effective_force(effective_force);
        monitors.take(&At {
            commanded: stepped.axes().target,
            reading,
            elements: &elements,
            effective_force,
        });
        let balance = stepped.sum_up();
        self.wall_time = session.guard.time();
        if self.keeps_steps {
            stepped.keep(monitors.tracking(), self.wall_time);
        }
        balance
    }
}

/// The waypoint of each axis at the end of this step.
fn waypoints(
    stepped: &mut impl Stepped,
    target: &mut [f64],
    assemblies: Option<&Assemblies>,
) -> Vec<Waypoint> {
    stepped.predict(target);
    let mut velocities = vec![0.0; target.len()];
    let struck = stepped.predicted_velocity(&mut velocities);
    let of_axes = |floors: &[f64]| {
        assemblies.map_or_else(|| floors.to_vec(), |assemblies| assemblies.axes_of(floors))
    };
    of_axes(target)
        .into_iter()
        .zip(of_axes(&velocities))
        .map(|(position, velocity)| Waypoint {
            position,
            velocity,
            struck,
        })
        .collect()
}

/// The triggers of the plan with their states.
pub(crate) struct Triggers {
    armed: Vec<Armed>,
}

struct Armed {
    trigger: InspectTrigger,
    /// Largest |R| since its last trigger \[N\].
    largest_force: f64,
    fired: bool,
}

impl Triggers {
    pub(crate) fn new(triggers: &[InspectTrigger]) -> Self {
        let armed = |trigger: &InspectTrigger| Armed {
            trigger: trigger.clone(),
            largest_force: 0.0,
            fired: false,
        };
        Self {
            armed: triggers.iter().map(armed).collect(),
        }
    }

    /// The first reason for an inspection after `step` at the simulated time `time` \[s\] with restoring force `force` \[N\].
    pub(crate) fn after(&mut self, step: u64, time: f64, force: f64) -> Option<String> {
        let mut reason = None;
        for armed in &mut self.armed {
            if let Some(found) = armed.after(step, time, force) {
                reason.get_or_insert(found);
            }
        }
        reason
    }
}

impl Armed {
    fn after(&mut self, step: u64, time: f64, force: f64) -> Option<String> {
        match self.trigger {
            InspectTrigger::Every(steps) => (steps > 0 && step.is_multiple_of(u64::from(steps)))
                .then(|| format!("inspection every {steps} steps")),
            InspectTrigger::ForceDrop(fraction) => {
                let size = force.abs();
                let dropped = size < (1.0 - fraction) * self.largest_force;
                // After an inspection, only a further fall from here counts.
                self.largest_force = if dropped {
                    size
                } else {
                    self.largest_force.max(size)
                };
                dropped
                    .then(|| format!("the restoring force fell by {} % or more", fraction * 100.0))
            }
            InspectTrigger::At(moment) => {
                // Half a billionth for a step end that rounding put just before the moment.
                let due = !self.fired && time >= moment * (1.0 - 5e-10);
                self.fired |= due;
                due.then(|| format!("inspection at {moment} s of test time"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_off_every_n_steps_once_at_a_time_and_once_a_drop() {
        let steps = |triggers: &[InspectTrigger]| {
            let mut triggers = Triggers::new(triggers);
            let forces = [10.0, 50.0, 100.0, 95.0, 89.0, 85.0, 81.0, 80.0, 100.0];
            let due = |(step, force): (u64, &f64)| {
                #[expect(clippy::cast_precision_loss, reason = "nine steps")]
                let time = step as f64 * 0.1;
                triggers.after(step, time, *force).map(|_| step)
            };
            (1..).zip(&forces).filter_map(due).collect::<Vec<_>>()
        };
        assert_eq!(steps(&[InspectTrigger::Every(4)]), [4, 8]);
        assert_eq!(steps(&[InspectTrigger::At(0.3)]), [3]);
        // 89 is below 90 % of 100; 80 is below 90 % of 89.
        assert_eq!(steps(&[InspectTrigger::ForceDrop(0.1)]), [5, 8]);
        assert_eq!(
            steps(&[InspectTrigger::At(0.4), InspectTrigger::Every(4)]),
            [4, 8]
        );
    }
}
