//! The check of the steps of a frame. In: a block, its frame, damping and stepping. Out: errors and warnings, or the properties of the
//! frame and its time step. It knows no striker and no ground.

use crate::codes::E627;
use crate::procedures::common::violations::{
    StepAboveCritical, TooManyInProcedure, UnstableAsAllowed, UnstableStep,
};
use psd_language::check::checker::Checker;
use psd_language::check::violations::NoEffect;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_plan::formula::NoResults;
use psd_plan::schema::{frames, methods, specimen};
use psd_plan::{Frame, Integrator, MOST_STEPS, Mode, Part, ShakeDamping, Stepping, steps_in};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::beyond_duration;
use super::mode_check::warn_of_damping_twice;

/// The steps of a frame, and their duration \[s\], if it is known before the run.
pub struct FrameSteps<'a> {
    pub specimen: usize,
    pub frame: &'a Frame,
    pub damping: &'a ShakeDamping,
    pub stepping: &'a Stepping,
    pub duration: Option<f64>,
}

#[derive(Violation)]
#[violation(E627, "number of damping ratios differs: {found} for {modes} modes")]
#[help("write one ratio per mode, the longest period first, or one number for Rayleigh damping")]
struct DampingRatios {
    found: usize,
    modes: usize,
    #[label("one per mode required")]
    span: Span,
}

#[derive(Violation)]
#[violation(E627, "no damping matrix has these ratios: {reason}")]
#[help("write one ratio per mode: `damping_ratio = [2, 3] %`")]
struct DampingImpossible<'a> {
    reason: &'a str,
    #[label("not possible")]
    span: Span,
}

/// Checks the time step of a frame as far as it is known before the run: stability, the critical step (of the modes, or `critical`'s),
/// the number of steps. Gives the properties of the frame and the step \[s\] where further checks are possible.
pub fn check(
    checker: &mut Checker,
    block: usize,
    steps: &FrameSteps,
    critical: impl FnOnce(&FrameProperties) -> Option<f64>,
) -> Option<(FrameProperties, f64)> {
    let FrameSteps {
        frame,
        damping,
        stepping,
        duration,
        ..
    } = *steps;
    storeys_damped_twice(checker, block, steps);
    let at = |checker: &Checker, field| checker.value_or_head(block, field);
    let known = damping.known()?;
    let ratios = at(checker, frames::DAMPING_RATIO.name);
    if let ShakeDamping::Modal(given) = damping
        && given.len() != frame.degrees_of_freedom()
    {
        return checker.fail(DampingRatios {
            found: given.len(),
            modes: frame.degrees_of_freedom(),
            span: ratios,
        });
    }
    let properties = match FrameProperties::of(frame, &known) {
        Ok(properties) => properties,
        Err(reason) => {
            return checker.fail(DampingImpossible {
                reason: &reason.to_string(),
                span: ratios,
            });
        }
    };
    if let (Integrator::Tangent, false, Some((_, entry))) = (
        stepping.integrator,
        properties.has_tangents(),
        checker.field(block, methods::MAX_TANGENT_RATIO.name),
    ) {
        let message = "`max_tangent_ratio` has no effect: full matrices keep the initial stiffness";
        checker.report(NoEffect {
            message: message.to_owned(),
            span: entry.key.span,
            label: "no effect",
            help: "remove it",
        });
    }
    let critical = critical(&properties);
    let step = stepping
        .time_step
        .evaluate(&NoResults, critical)
        .ok()?
        .value;
    let step_at = at(checker, methods::TIME_STEP.name);
    let behaves = if checker.real_rig.is_some() {
        None
    } else {
        Some(frame)
    };
    let limit = properties.longest_stable_step(stepping.integrator, behaves);
    if step > limit {
        return checker.fail(if stepping.allow_unstable {
            UnstableAsAllowed {
                span: step_at,
                step,
                limit,
            }
            .diagnostic()
        } else {
            UnstableStep {
                span: step_at,
                integrator: stepping.integrator,
                step,
                limit,
                computed: dictated_by(frame, &properties, stepping.integrator),
            }
            .diagnostic()
        });
    }
    beyond_duration(checker, block, Some(step), duration);
    if let Some(critical) = critical.filter(|critical| step > *critical) {
        checker.report(StepAboveCritical {
            span: step_at,
            step,
            critical,
        });
    }
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
    let rows =
        duration.map(|duration| steps_in(duration, step) * frame.degrees_of_freedom() as f64);
    if let Some(rows) = rows.filter(|rows| *rows > MOST_STEPS) {
        let help = "reduce `duration` or increase `time_step`";
        checker.report(TooManyInProcedure {
            what: "steps of its storeys",
            found: rows,
            most: MOST_STEPS,
            span: at(checker, methods::DURATION.name),
            help,
        });
    }
    Some((properties, step))
}

/// The damping of the storeys is in the measured forces of a continuous run already.
fn storeys_damped_twice(checker: &mut Checker, block: usize, steps: &FrameSteps<'_>) {
    let computed = match steps.damping {
        ShakeDamping::Rayleigh(ratio) => ratio.constant().is_none_or(|ratio| ratio > 0.0),
        ShakeDamping::Modal(ratios) => ratios
            .iter()
            .any(|ratio| ratio.constant().is_none_or(|ratio| ratio > 0.0)),
    };
    let is_measured = steps.frame.members().any(|member| member.damping > 0.0);
    if computed && is_measured && matches!(steps.stepping.mode, Mode::Continuous { .. }) {
        let members = if steps.frame.has_elements() {
            specimen::ELEMENTS.name
        } else {
            specimen::STOREYS.name
        };
        let fields = [frames::DAMPING_RATIO.name, members];
        warn_of_damping_twice(checker, block, steps.specimen, fields);
    }
}

/// The computed storey that dictates the longest step of explicit Newmark, from 0.
fn dictated_by(
    frame: &Frame,
    properties: &FrameProperties,
    integrator: Integrator,
) -> Option<usize> {
    let highest = properties.modes.shapes.last()?;
    let (storey, _) = frame.most_strained(highest)?;
    let computed = frame.storeys[storey].part == Part::Computed;
    (computed && integrator == Integrator::Explicit).then_some(storey)
}
