//! Errors of integration and control: E64x, W71x and W718.

use super::shown;
use crate::plan::Integrator;
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;
use crate::units::Dimension;
use crate::units::display::{minus, significant};

pub fn law_needs_the_tangent(integrator: &str, named: Span, law: &str, struck: Span) -> Diagnostic {
    let message = format!(
        "`{law}` finds the instant of a blow inside a step by the tangent stiffness; `{integrator}` has none"
    );
    Diagnostic::new(Code::LawNeedsTangent, message)
        .at(struck, "this law looks inside the step")
        .at(
            named,
            format!("`{integrator}` knows the force only at its end"),
        )
        .help(
            "write `integrator = tangent`, or take `contact = rigid` or `contact = limit(1500 N)`",
        )
}

pub fn unstable(span: Span, integrator: Integrator, step: f64, limit: f64) -> Diagnostic {
    let time = |value| shown(value, Dimension::TIME);
    let (step, longest) = (time(step), time(limit));
    let why = match integrator {
        Integrator::AlphaOs { .. } => {
            "the specimen is stiffer than the `stiffness` that α-OS splits with"
        }
        Integrator::Tangent | Integrator::Explicit => {
            "explicit Newmark is stable up to the period over π"
        }
    };
    Diagnostic::new(
        Code::Unstable,
        format!("the time step {step} is beyond the stability limit {longest}: {why}"),
    )
    .at(span, format!("{step}, stable up to {longest}"))
    .help("write `time_step = critical / 20`; `allow_unstable = true` runs it all the same")
}

/// α-OS with a `K_I` \[N/m\] below the specimen's stiffness, within the limit \[s\] that follows.
pub fn stiffer_than_operator(span: Span, specimen: f64, operator: f64, limit: f64) -> Diagnostic {
    let (specimen, operator) = (
        shown(specimen, Dimension::STIFFNESS),
        shown(operator, Dimension::STIFFNESS),
    );
    let limit = shown(limit, Dimension::TIME);
    let message = format!(
        "the specimen has {specimen}, more than the {operator} that α-OS splits with: it is stable up to {limit} only"
    );
    Diagnostic::new(Code::StifferThanOperator, message)
        .at(span, format!("K_I = {operator}"))
        .help("take the high end of what the ramp finds: a `stiffness` above the specimen's is stable for every step")
}

/// The tangent form with a bound on its tangent \[N/m\] below the specimen's stiffness.
pub fn stiffer_than_tangent(span: Span, specimen: f64, bound: f64) -> Diagnostic {
    let (specimen, bound) = (
        shown(specimen, Dimension::STIFFNESS),
        shown(bound, Dimension::STIFFNESS),
    );
    let message = format!(
        "the specimen reaches {specimen}, and the tangent is taken for no more than {bound}: it may be unstable"
    );
    Diagnostic::new(Code::StifferThanOperator, message)
        .at(span, "`max_tangent_ratio` times this is the most that is believed")
        .help("write the stiffness of the specimen where it is stiff, or a larger `max_tangent_ratio`")
}

pub fn continuous_on_a_real_rig(dialect: &str, span: Span) -> Diagnostic {
    let message = format!(
        "continuous mode needs a rig that follows a path without stopping, and `{dialect}` cannot say one"
    );
    Diagnostic::new(Code::NoPathToFollow, message)
        .at(span, format!("`{dialect}` says one target at a time, and stops there"))
        .help("write `mode = step_and_pause`; or use a rig that speaks `native`, which has `GLIDE`, or a virtual rig")
}

pub fn read_apart(sweep: Span, link: Span, label: String) -> Diagnostic {
    let message = "a damping sweep reads on the way, and this rig reads displacement and force one after the other";
    Diagnostic::new(Code::ReadApart, message)
        .at(sweep, "the way between the two would be taken for damping")
        .at(link, label)
        .help("give the damping instead, as in `damping = 6 N*s/m`; or use one device that speaks `native`, for both")
}

pub fn stops_on_the_way(field: &str, span: Span, mode: Span) -> Diagnostic {
    Diagnostic::new(
        Code::StopsOnTheWay,
        format!("`{field}` stops the actuator, and `continuous` never does"),
    )
    .at(span, "would stop it")
    .at(mode, "does not stop")
    .help(format!(
        "leave `{field}` out, or write `mode = step_and_pause`"
    ))
}

pub fn damping_twice(computed: Span, measured: Span) -> Diagnostic {
    let message = "damping counts twice: in continuous mode the damper of the specimen is in the force that is read";
    Diagnostic::new(Code::DampingTwice, message)
        .at(computed, "computed here")
        .at(measured, "and felt here, at the speed of the actuator")
        .help("leave the procedure's damping out, or make it what the specimen's does not show: its damping is felt divided by the time scale")
}

/// An actuator with a delay.
pub struct Late<'a> {
    pub name: &'a str,
    /// The energy that one cycle absorbs, over that of the vibration.
    pub energy: f64,
    /// The limit at which a run is held, over the input energy.
    pub bound: f64,
    /// As a fraction of each increment.
    pub short: f64,
    /// Laboratory time \[s\].
    pub lag: f64,
    /// Simulated time \[s\].
    pub delay: f64,
    /// The effect of the delay.
    pub damping_ratio: f64,
    pub remedy: Remedy,
}

/// A change that would keep a run below its bound.
pub enum Remedy {
    /// A time step of at most this \[s\].
    Shorter(f64),
    /// A time scale of at least this.
    Slower(f64),
    /// A pause that is longer by this \[s\].
    Longer(f64),
}

pub fn tracking_is_late(late: &Late, head: Span, link: Span) -> Diagnostic {
    let percent = |share: f64| format!("{} %", significant(100.0 * share, 2));
    let time = |seconds: f64| shown(seconds, Dimension::TIME);
    let Late {
        name,
        energy,
        bound,
        short,
        lag,
        damping_ratio,
        ..
    } = late;
    let message = format!(
        "tracking may stop `{name}`: the delay of the actuator adds {} to the energy of a vibration in each cycle, and a run is held at {} of \
         the input energy",
        percent(*energy),
        percent(*bound)
    );
    let correct = "write `i_modification = true`, which corrects the force to the target";
    let help = match late.remedy {
        Remedy::Shorter(step) => {
            format!("{correct}; or take a `time_step` of at most {}", time(step))
        }
        Remedy::Slower(scale) => format!(
            "{correct}; or take a `time_scale` of at least {}",
            significant(scale, 3)
        ),
        Remedy::Longer(pause) => {
            format!(
                "{correct}; or let it arrive, by a `pause` that is {} longer or a band in `settle`",
                time(pause)
            )
        }
    };
    let misses = [
        (*short != 0.0).then(|| format!("misses {} of each increment", percent(short.abs()))),
        (*lag > 0.0).then(|| format!("lags by {}", time(*lag))),
    ];
    let misses: Vec<String> = misses.into_iter().flatten().collect();
    let amounts = format!(
        "{}: late by {} of virtual time, as a damping ratio of {}",
        misses.join(" and "),
        minus(&time(late.delay)),
        minus(&percent(*damping_ratio))
    );
    Diagnostic::new(Code::TrackingStops, message)
        .at(head, "integrated with this delay")
        .at(link, amounts)
        .help(help)
}
