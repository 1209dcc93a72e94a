//! The steps of a structure on an ideal rig, on which no tracking error can arise. In: a structure that computes its steps, the rig behind
//! its guard. Out: every step completed, checked and reported, or the reason of the end. A structure that can takes its steps in a loop of
//! its own, and calls this one to read and to end a step.

#![allow(
    clippy::inline_always,
    reason = "a part of the loop over the steps, which computes what its parts read"
)]

use super::end_of_step::{EndOfStep, Errors};
use super::operator_stability_watch::StifferSprings;
use crate::run::StepReport;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::tracking::monitor::Tracking;
use psd_rig::{IdealSteps, Reading};

/// The steps of a run on an ideal rig.
pub(crate) struct IdealRun<'a, 'rig> {
    pub(super) ideal: IdealSteps,
    /// If a reading can show that a specimen is stiffer than its model.
    pub(super) watched: Option<&'a mut StifferSprings>,
    /// The tracking of each axis, which stays as it is, and of all.
    pub(super) axes: &'a [Tracking],
    pub(super) tracking: Tracking,
    pub(super) keeps_steps: bool,
    /// \[m\]
    pub(super) target: &'a mut [f64],
    pub(super) reading: &'a mut Reading,
    /// Rig time at the end of the last step \[s\].
    pub(super) wall_time: f64,
    /// Whether a contact force acted in the last step.
    pub(super) struck: bool,
    /// None if the observer does not follow the steps.
    pub(super) report: Option<StepReport>,
    /// The reference of the errors at the last completed step \[J\].
    pub(super) input: Option<f64>,
    /// The limit that the reading of the step in progress exceeded.
    pub(super) beyond: Option<Stop>,
    /// Why the run has ended before its duration.
    pub(super) stop: Option<Stop>,
    pub(super) session: &'a mut Session<'rig>,
}

impl IdealRun<'_, '_> {
    /// The target of each axis at the end of the next step \[m\], to be set before [`Self::read`].
    pub(crate) const fn target(&mut self) -> &mut [f64] {
        self.target
    }

    /// Moves to the target and reads there. None: the run ends before this step.
    #[inline(always)]
    pub(crate) fn read(&mut self) -> Option<&Reading> {
        match self
            .session
            .step_ideally(self.ideal, self.target, self.reading)
        {
            Ok(None) => Some(self.reading),
            Ok(Some(ended)) => {
                self.beyond = Some(ended.fault.into());
                Some(self.reading)
            }
            Err(stop) => {
                self.stop = Some(stop);
                None
            }
        }
    }

    /// Takes the end of a step. False: the run ends with it.
    #[inline(always)]
    pub(crate) fn end(&mut self, end: &mut impl EndOfStep) -> bool {
        let balance = end.sum_up();
        self.wall_time = self.reading.time;
        if self.keeps_steps {
            end.keep(self.axes, self.wall_time);
        }
        if self.beyond.is_some() {
            self.stop = self.beyond.take();
            return false;
        }
        if let Some(stiffer) = &mut self.watched {
            let before = std::mem::replace(&mut self.struck, end.is_struck());
            stiffer.take(self.reading, &[], before || self.struck, self.session);
        }
        self.input = Some(balance.input);
        let energy_error = balance.relative_error();
        let checked = self.session.guard.check_energy_error(energy_error);
        let ended = checked.map_err(Stop::from).and_then(|()| {
            let (state, before) = (end.axes(), end.before());
            let Some(report) = &mut self.report else {
                self.session.step_passed(state.step + before);
                return Ok(());
            };
            let errors = Errors {
                energy_error,
                tracking: self.tracking,
                tracking_energy_error: self.tracking.share_of(balance.input),
            };
            errors.report(&state, report);
            report.step += before;
            self.session.step_done(report)
        });
        self.stop = ended.err();
        self.stop.is_none()
    }

    /// Keeps the end of the last step, of a run that keeps its results alone.
    pub(crate) fn keep_last(&self, end: &mut impl EndOfStep) {
        if !self.keeps_steps {
            end.keep(self.axes, self.wall_time);
        }
    }
}
