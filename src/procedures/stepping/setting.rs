//! The quantities that the steps of a procedure need before the first one: time step, duration, number of steps, and for a frame its
//! properties and tangents; the state of rig and structure there. In: a procedure of the plan, a frame where it tests one, the first
//! reading. Out: numbers, each inside its domain, and the initial state of a solver. It knows no ground and no striker.

use std::fmt::Display;

use crate::run::inputs::{Inputs, in_range};
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::structure::Damping;
use psd_physics::structure::assemblies::StoreyReadings;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_plan::record::EventKind;
use psd_plan::schema::{frames, methods};
use psd_plan::{
    Frame, Integrator, MOST_STEPS, Plan, ShakeDamping, Stepping, rayleigh, step_count, steps_in,
};
use psd_rig::Reading;
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// The steps of a procedure, as many as its duration needs.
#[derive(Clone, Copy)]
pub(crate) struct Steps {
    /// Δt \[s\]
    pub time_step: f64,
    /// \[s\]
    pub critical_time_step: f64,
    /// Number of steps.
    pub count: u64,
    /// s, at every step.
    pub pause: f64,
    /// c of `K_t within [0, c·K]`
    pub max_tangent_ratio: f64,
}

/// The times of a procedure that integrates \[s\].
#[derive(Clone, Copy)]
pub(crate) struct Times {
    pub time_step: f64,
    pub critical_time_step: f64,
    pub duration: f64,
}

impl Steps {
    /// A frame has several `axes`.
    pub(crate) fn evaluate(
        plan: &Stepping,
        times: Times,
        axes: usize,
        inputs: &mut Inputs<'_>,
    ) -> Result<Self, Stop> {
        let Times {
            time_step,
            critical_time_step,
            duration,
        } = times;
        let pause = inputs.number(&methods::PAUSE, &plan.pause)?;
        let max_tangent_ratio =
            inputs.number(&methods::MAX_TANGENT_RATIO, &plan.max_tangent_ratio)?;
        check_one_step(time_step, duration)?;
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
        let axes = axes as f64;
        if steps_in(duration, time_step) * axes > MOST_STEPS {
            let wanted = format!("long enough for at most {} steps", MOST_STEPS / axes);
            return Err(Stop::bad_input(
                methods::TIME_STEP.name,
                time_step,
                Dimension::TIME,
                wanted,
            ));
        }
        Ok(Self {
            time_step,
            critical_time_step,
            count: step_count(duration, time_step),
            pause,
            max_tangent_ratio,
        })
    }
}

/// A frame and its steps.
pub(crate) struct FrameSteps {
    pub properties: FrameProperties,
    pub tangents: Tangents,
    pub steps: Steps,
}

impl FrameSteps {
    pub(crate) fn evaluate(
        properties: FrameProperties,
        plan: &Stepping,
        times: Times,
        inputs: &mut Inputs<'_>,
    ) -> Result<Self, Stop> {
        let steps = Steps::evaluate(plan, times, properties.matrices.order(), inputs)?;
        let tangents = if properties.has_tangents() && plan.integrator == Integrator::Tangent {
            Tangents::Storeys {
                largest_ratio: steps.max_tangent_ratio,
            }
        } else {
            Tangents::Initial
        };
        Ok(Self {
            properties,
            tangents,
            steps,
        })
    }

    /// Degrees of freedom.
    pub(crate) fn order(&self) -> usize {
        self.properties.matrices.order()
    }
}

/// The state when the first step begins.
pub(crate) struct Start {
    /// Commanded positions of the floors \[m\]: X starts there.
    pub commanded: Vec<f64>,
    /// One reading there: it contains R₀.
    pub reading: Reading,
    /// Of each storey or element.
    pub readings: Vec<StoreyReadings>,
    /// Those of a frame of matrices there.
    pub elements: Vec<ElementReading>,
    /// The same with the resolution of the forces as a part of their noise.
    pub resolved: Vec<StoreyReadings>,
}

impl Start {
    /// The initial state of a frame, with these loads on its floors \[N\].
    pub(crate) fn input<'a>(
        &'a self,
        frame: &'a FrameSteps,
        plan: &Stepping,
        load: &'a [f64],
    ) -> FrameInput<'a> {
        let FrameProperties {
            matrices, elements, ..
        } = &frame.properties;
        FrameInput {
            elements: elements
                .as_ref()
                .map(|elements| (elements, self.elements.as_slice())),
            matrices,
            operator_stiffness: &frame.properties.operator,
            integrator: plan.integrator,
            i_modification: plan.i_modification,
            tangents: frame.tangents,
            time_step: frame.steps.time_step,
            initial_displacement: &self.commanded,
            initial_restoring_force: &self.reading.force,
            initial_load: load,
            readings: &self.readings,
        }
    }
}

/// The input error of a structure that cannot be integrated with `time_step` \[s\].
pub(crate) fn not_stepped(time_step: f64, error: &impl Display) -> Stop {
    let wanted = format!("one that can be stepped: {error}");
    Stop::bad_input(methods::TIME_STEP.name, time_step, Dimension::TIME, wanted)
}

/// The frame of a specimen; `check` refuses a procedure on a frame whose specimen has none.
pub(crate) fn frame_of(plan: &Plan, specimen: usize) -> Result<&Frame, Stop> {
    plan.specimens[specimen]
        .frame
        .as_ref()
        .ok_or_else(Stop::no_frame)
}

/// The properties of a frame with this damping.
pub(crate) fn properties(
    frame: &Frame,
    plan: &ShakeDamping,
    inputs: &mut Inputs<'_>,
) -> Result<FrameProperties, Stop> {
    let (damping, value) = damping(plan, inputs)?;
    FrameProperties::of(frame, &damping).map_err(|reason| {
        Stop::bad_input(
            frames::DAMPING_RATIO.name,
            value,
            Dimension::NUMBER,
            format!("other: {reason}"),
        )
    })
}

/// The damping, and one of its ratios for a message.
fn damping(plan: &ShakeDamping, inputs: &mut Inputs<'_>) -> Result<(Damping, f64), Stop> {
    let field = &frames::DAMPING_RATIO;
    Ok(match plan {
        ShakeDamping::Rayleigh(ratio) => {
            let ratio = inputs.damping(field, ratio)?;
            in_range(field.name, ratio, field)?;
            (rayleigh(ratio), ratio)
        }
        ShakeDamping::Modal(ratios) => {
            let ratios = inputs.list(field, ratios)?;
            let first = ratios.first().copied().unwrap_or(0.0);
            (Damping::Modal(ratios), first)
        }
    })
}

/// The time step \[s\]; `critical` is the critical one \[s\].
pub(crate) fn time_step(
    plan: &Stepping,
    critical: f64,
    inputs: &mut Inputs<'_>,
) -> Result<f64, Stop> {
    let time_step = inputs.estimate(&methods::TIME_STEP, &plan.time_step, Some(critical))?;
    Ok(time_step.value)
}

/// Refuses an unstable time step, s, of a frame. `check` cannot know one that depends on results.
pub(crate) fn stable_on_frame(
    plan: &Stepping,
    time_step: f64,
    frame: &Frame,
    properties: &FrameProperties,
    session: &Session<'_>,
) -> Result<(), Stop> {
    let model = Some(frame).filter(|_| session.is_simulated());
    stable(
        plan,
        time_step,
        properties.longest_stable_step(plan.integrator, model),
    )
}

/// Refuses a time step beyond `limit`, the longest stable one (both s), unless the plan allows it.
pub(crate) fn stable(plan: &Stepping, time_step: f64, limit: f64) -> Result<(), Stop> {
    if time_step <= limit || plan.allow_unstable {
        return Ok(());
    }
    let wanted = format!(
        "at most {}, the stability limit of `{}`",
        stated(limit, Dimension::TIME),
        plan.integrator.name()
    );
    Err(Stop::bad_input(
        methods::TIME_STEP.name,
        time_step,
        Dimension::TIME,
        wanted,
    ))
}

/// Notes a time step above the critical one: `check` could not know it, and a reader of the results must.
pub(crate) fn above_critical(steps: &Steps, session: &mut Session<'_>) {
    if steps.time_step > steps.critical_time_step {
        let (step, critical) = (
            stated(steps.time_step, Dimension::TIME),
            stated(steps.critical_time_step, Dimension::TIME),
        );
        let text = format!(
            "peaks may be wrong: time step {step} exceeds the critical time step {critical} (W701)"
        );
        session.event(EventKind::Remark, text);
    }
}

/// A duration that holds one step at least.
fn check_one_step(time_step: f64, duration: f64) -> Result<(), Stop> {
    if time_step <= duration {
        return Ok(());
    }
    let wanted = format!(
        "no longer than the run, {}",
        stated(duration, Dimension::TIME)
    );
    Err(Stop::bad_input(
        methods::TIME_STEP.name,
        time_step,
        Dimension::TIME,
        wanted,
    ))
}
