//! The impact that a series repeats, on one degree of freedom or on one storey of a frame. In: the impact of the plan, evaluated once; a
//! velocity for each repetition. Out: each repetition as a separate impact. It decides nothing about the next one.

use crate::procedures::impact::run::{ImpactRun, strike};
use crate::procedures::impact::setting::Setting;
use crate::procedures::impact::uncertainty::UncertaintyInputs;
use crate::procedures::stepping::setting::{Steps, frame_of};
use crate::procedures::unload;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::impact::ImpactInput;
use psd_physics::structure::Unloading;
use psd_plan::{Escalate, Impact, ImpactTarget, Plan, Striker};

pub(crate) struct RepeatedImpact<'a> {
    plan: &'a Impact,
    setting: Setting,
    uncertainty: UncertaintyInputs<'a>,
    unloading: Unloading,
}

impl<'a> RepeatedImpact<'a> {
    /// The impact at the highest of these velocities \[m/s\]. All have its time step, the shortest under a contact of finite stiffness.
    pub(crate) fn evaluate<'record: 'a>(
        plan: &'a Escalate,
        velocities: &[f64],
        whole: &'a Plan,
        inputs: &mut Inputs<'record>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let plan = &plan.impact;
        let fastest = Striker {
            velocity: velocities.iter().copied().fold(0.0, f64::max),
            ..whole.strikers[plan.striker].clone()
        };
        let setting = Setting::evaluate(plan, whole, &fastest, inputs, session)?;
        let unloading = match &plan.target {
            ImpactTarget::Point(_) => Unloading::of_one(setting.input.stiffness),
            ImpactTarget::Storey(_) => unload::run::of_frame(frame_of(whole, plan.specimen)?)?,
        };
        let uncertainty = UncertaintyInputs::new(plan, whole, inputs, session);
        Ok(Self {
            plan,
            setting,
            uncertainty,
            unloading,
        })
    }

    /// The steps of every impact.
    pub(crate) const fn steps(&self) -> &Steps {
        self.setting.steps()
    }

    /// ½ Ms v² of an impact at this velocity \[J\].
    pub(crate) fn energy(&self, striker_velocity: f64) -> f64 {
        ImpactInput {
            striker_velocity,
            ..self.setting.input
        }
        .striker_energy()
    }

    /// Impact number `index`, from 0, at this velocity \[m/s\]; `before` steps of the procedure are done already.
    pub(crate) fn strike(
        &mut self,
        index: usize,
        striker_velocity: f64,
        before: u64,
        session: &mut Session<'_>,
    ) -> ImpactRun {
        self.setting.input.striker_velocity = striker_velocity;
        let uncertainty = self.uncertainty.of_impact(index);
        strike(self.plan, &self.setting, &uncertainty, before, session)
    }

    /// The unloading path after an impact.
    pub(crate) const fn unloading(&self) -> &Unloading {
        &self.unloading
    }
}
