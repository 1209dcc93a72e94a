//! The quantities of an impact that are known before the first step. In: an impact of the plan, its formulas, a striker. Out: numbers,
//! each inside its domain, and the steps that they lead to. It moves nothing.

use super::contact;
use crate::procedures::stepping;
use crate::procedures::stepping::setting::{FrameSteps, Steps, Times, frame_of, stable};
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::contact::ContactLaw;
use psd_physics::contact::contact_time_step::Approach;
use psd_physics::impact::ImpactInput;
use psd_physics::integrator::stability::{Met, longest_stable_step};
use psd_physics::structure::Matrices;
use psd_plan::formula::Estimate;
use psd_plan::procedures::impact::block as schema;
use psd_plan::schema::methods;
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::{Frame, Impact, ImpactTarget, Plan, PointTarget, Stepping, StoreyTarget, Striker};
use psd_rig::DeclaredNoise;

/// Everything known before the first step.
pub(crate) struct Setting {
    /// The striker and the struck degree of freedom; for a struck floor, that floor alone.
    pub input: ImpactInput,
    /// The approach that the critical time step belongs to: in a series of impacts, that of the fastest.
    pub approach: Approach,
    /// Velocity of its striker at the start, before the gap \[m/s\].
    pub fastest: f64,
    pub structure: StruckStructure,
}

/// The structure on the rig, and its steps.
pub(crate) enum StruckStructure {
    /// One degree of freedom.
    Point(Steps),
    /// A frame, one floor of which is struck.
    Storey(Box<FrameSteps>),
}

/// One struck degree of freedom.
struct Struck {
    matrices: Matrices<f64>,
    /// `K_I` of α-OS and of the I-modification \[N/m\].
    operator_stiffness: f64,
    law: ContactLaw,
    noise: DeclaredNoise,
}

impl Struck {
    /// The impact of a striker of the plan on it, by the integrator of the plan.
    const fn by(&self, striker: &Striker, stepping: &Stepping, steps: &Steps) -> ImpactInput {
        ImpactInput {
            mass: self.matrices.mass,
            damping: self.matrices.damping,
            stiffness: self.matrices.stiffness,
            striker_mass: striker.mass,
            striker_velocity: striker.velocity,
            gap: striker.gap,
            gravity: striker.gravity,
            time_step: steps.time_step,
            max_tangent_ratio: steps.max_tangent_ratio,
            law: self.law,
            integrator: stepping.integrator,
            operator_stiffness: self.operator_stiffness,
            i_modification: stepping.i_modification,
            noise: self.noise,
        }
    }
}

impl Setting {
    pub(crate) fn evaluate(
        plan: &Impact,
        whole: &Plan,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        match &plan.target {
            ImpactTarget::Point(point) => {
                let noise = session.guard.declared_noise();
                Self::of_point(plan, point, striker, inputs, noise)
            }
            ImpactTarget::Storey(storey) => {
                let frame = frame_of(whole, plan.specimen)?;
                Self::of_storey(plan, storey, frame, striker, inputs, session)
            }
        }
    }

    /// An impact on one degree of freedom.
    pub(crate) fn of_point(
        plan: &Impact,
        point: &PointTarget,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        noise: DeclaredNoise,
    ) -> Result<Self, Stop> {
        let mass = inputs.number(&schema::MASS, &point.mass)?;
        inputs.also_uncertain(point.mass_uncertainty);
        let stiffness = inputs.estimate(&STIFFNESS, &point.stiffness, None)?;
        let (stiffness, operator_stiffness) = (stiffness.value, upper_end(stiffness));
        let damping = inputs.damping(&schema::DAMPING, &point.damping)?;
        let law = contact::with_numbers(&plan.contact, inputs)?;
        let approach = striker.approach(contact::spring(law));
        let critical = approach.critical_time_step(mass, stiffness);
        let time_step = stepping::setting::time_step(&plan.stepping, critical, inputs)?;
        let duration = inputs.number(&methods::DURATION, &plan.duration)?;
        let steps = Steps::evaluate(
            &plan.stepping,
            Times {
                time_step,
                critical_time_step: critical,
                duration,
            },
            1,
            inputs,
        )?;
        // `check` cannot know the stability limit where the stiffness is a result of an earlier procedure.
        let matrices = Matrices {
            mass,
            damping,
            stiffness,
            gravity: None,
        };
        let limit = longest_stable_step(plan.stepping.integrator, &Met::one(&matrices, stiffness));
        stable(&plan.stepping, time_step, limit)?;
        let structure = Struck {
            matrices,
            operator_stiffness,
            law,
            noise,
        };
        Ok(Self {
            input: structure.by(striker, &plan.stepping, &steps),
            approach,
            fastest: striker.velocity,
            structure: StruckStructure::Point(steps),
        })
    }

    /// An impact on one floor of a frame.
    fn of_storey(
        plan: &Impact,
        target: &StoreyTarget,
        frame: &Frame,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let properties = stepping::setting::properties(frame, &target.damping, inputs)?;
        let law = contact::with_numbers(&plan.contact, inputs)?;
        let approach = striker.approach(contact::spring(law));
        let critical = properties.critical_on_impact(target.storey, &approach);
        let time_step = stepping::setting::time_step(&plan.stepping, critical, inputs)?;
        stepping::setting::stable_on_frame(&plan.stepping, time_step, frame, &properties, session)?;
        let duration = inputs.number(&methods::DURATION, &plan.duration)?;
        let times = Times {
            time_step,
            critical_time_step: critical,
            duration,
        };
        let frame_steps = FrameSteps::evaluate(properties, &plan.stepping, times, inputs)?;
        let noise = session.guard.declared_noise();
        let stiffness = frame.stiffness[target.storey][target.storey];
        let floor = Struck {
            matrices: Matrices {
                mass: frame_steps.properties.struck_mass(target.storey),
                damping: 0.0,
                stiffness,
                gravity: None,
            },
            operator_stiffness: stiffness,
            law,
            noise,
        };
        Ok(Self {
            input: floor.by(striker, &plan.stepping, &frame_steps.steps),
            approach,
            fastest: striker.velocity,
            structure: StruckStructure::Storey(Box::new(frame_steps)),
        })
    }

    pub(crate) const fn steps(&self) -> &Steps {
        match &self.structure {
            StruckStructure::Point(steps) => steps,
            StruckStructure::Storey(frame) => &frame.steps,
        }
    }

    /// The frame whose floor is struck; None for one degree of freedom.
    pub(crate) const fn frame(&self) -> Option<&FrameSteps> {
        match &self.structure {
            StruckStructure::Point(_) => None,
            StruckStructure::Storey(frame) => Some(frame),
        }
    }

    /// Adds mass to a struck degree of freedom \[kg\] and adapts the critical time step.
    pub(crate) fn add_mass(&mut self, mass: f64) {
        self.input.mass += mass;
        if let StruckStructure::Point(steps) = &mut self.structure {
            steps.critical_time_step = self
                .approach
                .critical_time_step(self.input.mass, self.input.stiffness);
        }
    }
}

/// `K_I`: the upper end of the interval of the stiffness (two standard uncertainties). α-OS is stable only as long as the specimen is
/// not stiffer (never a noisy secant).
fn upper_end(stiffness: Estimate) -> f64 {
    stiffness.value + 2.0 * stiffness.uncertainty.unwrap_or(0.0)
}
