//! Errors of integration and control: E64x, W71x and W718.

use super::shown;
use psd_plan::Integrator;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::{self, minus, significant};

pub fn law_needs_the_tangent(integrator: &str, named: Span, law: &str, struck: Span) -> Diagnostic {
    let message = format!(
        "`{law}` requires the tangent stiffness within a step, which `{integrator}` does not have"
    );
    Diagnostic::new(Code::LawNeedsTangent, message)
        .at(struck, "requires a tangent")
        .at(
            named,
            format!("`{integrator}` has the force only at the end"),
        )
        .help("write `integrator = tangent`, or `contact = rigid`, or `contact = limit(1500 N)`")
}

pub fn unstable(span: Span, integrator: Integrator, step: f64, limit: f64) -> Diagnostic {
    let time = |value| shown(value, Dimension::TIME);
    let (step, longest) = (time(step), time(limit));
    let why = match integrator {
        Integrator::AlphaOs { .. } => "the specimen is stiffer than the `stiffness` of α-OS",
        Integrator::Tangent | Integrator::Explicit => {
            "explicit Newmark is stable up to the period over π"
        }
    };
    Diagnostic::new(
        Code::Unstable,
        format!("time step {step} exceeds the stability limit {longest}: {why}"),
    )
    .at(span, format!("{step}, stable up to {longest}"))
    .help("write `time_step = critical / 20`; `allow_unstable = true` permits the step")
}

/// α-OS with a `K_I` \[N/m\] below the specimen's stiffness, within the limit \[s\] that follows.
pub fn stiffer_than_operator(specimen: f64, operator: f64, span: Span, limit: f64) -> Diagnostic {
    let (specimen, operator) = (
        shown(specimen, Dimension::STIFFNESS),
        shown(operator, Dimension::STIFFNESS),
    );
    let limit = shown(limit, Dimension::TIME);
    let message = format!(
        "motion may grow: specimen stiffness {specimen} exceeds the {operator} of α-OS, which is then stable up to {limit} only"
    );
    Diagnostic::new(Code::StifferThanOperator, message)
        .at(span, format!("K_I = {operator}"))
        .help("write the high end of the ramp's interval: a `stiffness` above the specimen's is stable at every step")
}

/// The tangent form with a bound on its tangent \[N/m\] below the specimen's stiffness.
pub fn stiffer_than_tangent(span: Span, specimen: f64, bound: f64) -> Diagnostic {
    let (specimen, bound) = (
        shown(specimen, Dimension::STIFFNESS),
        shown(bound, Dimension::STIFFNESS),
    );
    let message = format!(
        "motion may grow: specimen stiffness {specimen} exceeds the upper bound {bound} of the tangent"
    );
    Diagnostic::new(Code::StifferThanOperator, message)
        .at(span, "tangent limited to `max_tangent_ratio` times this")
        .help(
            "write the stiffness of the specimen at its stiffest, or a larger `max_tangent_ratio`",
        )
}

pub fn continuous_on_a_real_rig(dialect: &str, span: Span) -> Diagnostic {
    let message =
        format!("continuous mode requires a rig that follows a path; `{dialect}` does not");
    Diagnostic::new(Code::NoPathToFollow, message)
        .at(span, format!("`{dialect}` stops at every target"))
        .help("write `mode = ramp_and_hold`; or use a `native` controller with `GLIDE`, or a virtual rig")
}

pub fn read_apart(sweep: Span, link: Span, label: String) -> Diagnostic {
    let message = "a damping sweep requires simultaneous readings of displacement and force";
    Diagnostic::new(Code::ReadApart, message)
        .at(sweep, "read one after the other")
        .at(link, label)
        .help("write a damping value, as in `damping = 6 N*s/m`, or use one `native` device for both readings")
}

pub fn stops_between_readings(field: &str, span: Span, mode: Span) -> Diagnostic {
    Diagnostic::new(
        Code::StopsBetweenReadings,
        format!("`{field}` has no effect in continuous mode: the actuator never stops"),
    )
    .at(span, "requires a stop")
    .at(mode, "does not stop")
    .help(format!("remove `{field}`, or write `mode = ramp_and_hold`"))
}

pub fn damping_twice(computed: Span, measured: Span) -> Diagnostic {
    let message = "damping is counted twice: in continuous mode the measured force already contains the specimen's damping";
    Diagnostic::new(Code::DampingTwice, message)
        .at(computed, "computed here")
        .at(measured, "already measured here")
        .help("remove the procedure's damping, or write only the part that is not measured: measured damping is divided by the time scale")
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
        "tracking may stop `{name}`: actuator delay adds {} to the energy of a vibration per cycle (limit {} of the input energy)",
        percent(*energy),
        percent(*bound)
    );
    let correct = "write `i_modification = true`, which corrects the force to the target";
    let help = match late.remedy {
        Remedy::Shorter(step) => {
            format!(
                "{correct}; or write a `time_step` of at most {}",
                time(step)
            )
        }
        Remedy::Slower(scale) => format!(
            "{correct}; or write a `time_scale` of at least {}",
            significant(scale, 3)
        ),
        Remedy::Longer(pause) => {
            format!(
                "{correct}; or add {} to `pause`, or a tolerance in `settle`",
                time(pause)
            )
        }
    };
    let misses = [
        (*short != 0.0).then(|| format!("undershoots increments by {}", percent(short.abs()))),
        (*lag > 0.0).then(|| format!("lags by {}", time(*lag))),
    ];
    let misses: Vec<String> = misses.into_iter().flatten().collect();
    let amounts = format!(
        "{}: delay {} of simulated time, damping ratio {}",
        misses.join(" and "),
        minus(&time(late.delay)),
        minus(&percent(*damping_ratio))
    );
    Diagnostic::new(Code::TrackingStops, message)
        .at(head, "integrated with this delay")
        .at(link, amounts)
        .help(help)
}

/// `step` and `duration` in \[s\]. `written`: whether the plan states the time step, which otherwise follows from the period.
pub fn step_beyond_duration(
    at: Span,
    written: bool,
    step: f64,
    duration_at: Span,
    duration: f64,
) -> Diagnostic {
    let stated = |time| display::stated(time, Dimension::TIME);
    let message = format!(
        "time step {} is longer than the run, {}",
        stated(step),
        stated(duration)
    );
    Diagnostic::new(Code::OutOfRange, message)
        .at(at, "less than one step")
        .at(duration_at, "length of the run")
        .help(if written {
            "write a shorter `time_step`, or a longer `duration`"
        } else {
            "check mass and stiffness: the time step is a fraction of the period; or write a longer `duration`"
        })
}
