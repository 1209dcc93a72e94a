//! What the steps of a frame need before the first one, whatever moves it: its properties, a time step that it can be
//! integrated with, how many steps there are, tangents. In: a frame of the plan and how the plan steps. Out: numbers, each
//! inside its domain. It knows no ground and no striker.

use super::pace::Pace;
use crate::physics::frame::{Damping, Tangents, storeys_of};
use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::{
    Frame, Integrator, MOST_STEPS, ShakeDamping, Stepping, rayleigh, step_count, steps_in,
};
use crate::record::EventKind;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::units::Dimension;
use crate::units::display::stated;

/// Everything the steps of a frame need.
pub(crate) struct FrameSteps {
    pub properties: FrameProperties,
    pub tangents: Tangents,
    /// c of `K_t within [0, c·K]`
    pub max_tangent_ratio: f64,
    /// s
    pub time_step: f64,
    /// s
    pub critical_time_step: f64,
    pub steps: u64,
    /// s
    pub pause: f64,
}

/// The properties of a frame with this damping.
pub(crate) fn properties(
    frame: &Frame,
    plan: &ShakeDamping,
    inputs: &mut Inputs<'_>,
) -> Result<FrameProperties, Stop> {
    let (damping, value) = damping(plan, inputs)?;
    FrameProperties::of(frame, &damping).map_err(|reason| Stop::BadInput {
        field: "damping_ratio",
        value,
        dimension: Dimension::NUMBER,
        wanted: format!("other: {reason}").into(),
    })
}

/// The damping, and a ratio of it for a message.
fn damping(plan: &ShakeDamping, inputs: &mut Inputs<'_>) -> Result<(Damping, f64), Stop> {
    let known = |ratio: f64| match ratio {
        ratio if (0.0..=1.0).contains(&ratio) => Ok(ratio),
        value => Err(Stop::BadInput {
            field: "damping_ratio",
            value,
            dimension: Dimension::NUMBER,
            wanted: "between 0 and 1".into(),
        }),
    };
    Ok(match plan {
        ShakeDamping::Rayleigh(ratio) => {
            let ratio = known(inputs.damping("damping_ratio", ratio, Dimension::NUMBER)?)?;
            (rayleigh(ratio), ratio)
        }
        ShakeDamping::Modal(ratios) => {
            let ratios = inputs.list("damping_ratio", ratios)?;
            let ratios = ratios
                .into_iter()
                .map(known)
                .collect::<Result<Vec<f64>, Stop>>()?;
            let first = ratios.first().copied().unwrap_or(0.0);
            (Damping::Modal(ratios), first)
        }
    })
}

/// The time step, s, `critical` (s) the critical one: what `check` could not know of it is held against stability here.
pub(crate) fn time_step(
    plan: &Stepping,
    (frame, properties): (&Frame, &FrameProperties),
    critical: f64,
    inputs: &mut Inputs<'_>,
    session: &Session<'_>,
) -> Result<f64, Stop> {
    let time_step = inputs
        .positive_estimate(
            "time_step",
            &plan.time_step,
            Dimension::TIME,
            Some(critical),
        )?
        .value;
    stable(
        plan,
        time_step,
        properties.longest_stable_step(plan.integrator, Some(frame).filter(|_| session.reckoned())),
    )?;
    Ok(time_step)
}

/// Says of steps longer than the critical one (both s) that they are: what `check` could not know, and what a reader of the results must.
pub(crate) fn above_critical(time_step: f64, critical: f64, session: &mut Session<'_>) {
    if time_step > critical {
        let (step, critical) = (
            stated(time_step, Dimension::TIME),
            stated(critical, Dimension::TIME),
        );
        let text = format!(
            "the time step {step} is above the critical time step {critical} (W701): peaks between two steps are missed"
        );
        session.event(EventKind::Remark, text);
    }
}

/// A duration that holds one step at least.
pub(crate) fn holds_a_step(time_step: f64, duration: f64) -> Result<(), Stop> {
    if time_step <= duration {
        return Ok(());
    }
    let wanted = format!(
        "no longer than the run, {}",
        stated(duration, Dimension::TIME)
    );
    Err(Stop::BadInput {
        field: "time_step",
        value: time_step,
        dimension: Dimension::TIME,
        wanted: wanted.into(),
    })
}

/// Whether a plan may take a time step, `limit` the longest that is stable (s).
pub(crate) fn stable(plan: &Stepping, time_step: f64, limit: f64) -> Result<(), Stop> {
    if time_step <= limit || plan.allow_unstable {
        return Ok(());
    }
    let wanted = format!(
        "at most {}, the stability limit of `{}`",
        stated(limit, Dimension::TIME),
        plan.integrator.name()
    );
    Err(Stop::BadInput {
        field: "time_step",
        value: time_step,
        dimension: Dimension::TIME,
        wanted: wanted.into(),
    })
}

impl FrameSteps {
    /// How many there are, and how long they take.
    pub(crate) const fn pace(&self) -> Pace {
        Pace {
            time_step: self.time_step,
            steps: self.steps,
            pause: self.pause,
        }
    }

    /// Steps of `time_step` in `duration`; both times, and the critical step, in s.
    pub(crate) fn new(
        properties: FrameProperties,
        plan: &Stepping,
        (time_step, critical_time_step, duration): (f64, f64, f64),
        inputs: &mut Inputs<'_>,
    ) -> Result<Self, Stop> {
        let pause = inputs.not_negative("pause", &plan.pause, Dimension::TIME)?;
        let max_tangent_ratio = inputs.positive(
            "max_tangent_ratio",
            &plan.max_tangent_ratio,
            Dimension::NUMBER,
        )?;
        holds_a_step(time_step, duration)?;
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
        let floors = properties.matrices.order() as f64;
        if steps_in(duration, time_step) * floors > MOST_STEPS {
            let wanted = format!("long enough for at most {} steps", MOST_STEPS / floors);
            return Err(Stop::BadInput {
                field: "time_step",
                value: time_step,
                dimension: Dimension::TIME,
                wanted: wanted.into(),
            });
        }
        let tangents = match storeys_of(&properties.matrices.stiffness) {
            Some(_) if plan.integrator == Integrator::Tangent => Tangents::Storeys {
                largest_ratio: max_tangent_ratio,
            },
            _ => Tangents::Initial,
        };
        let steps = step_count(duration, time_step);
        Ok(Self {
            properties,
            tangents,
            max_tangent_ratio,
            time_step,
            critical_time_step,
            steps,
            pause,
        })
    }
}
