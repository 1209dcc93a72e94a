//! The fields that impacts and shakes share. In: a block. Out: its stepping, or errors. It knows no striker and no ground.

pub(crate) mod damping_check;
pub(crate) mod frame_check;
pub(crate) mod integrator_check;
pub(crate) mod mode_check;

use psd_language::check::checker::{Checker, Context};
use psd_language::check::expressions::choice::Chosen;
use psd_language::check::expressions::fields::whole as whole_number;
use psd_language::check::violations::NoEffect;
use psd_language::codes::E401;
use psd_plan::formula::{Formula, Operator};
use psd_plan::schema::methods;
use psd_plan::{Contact, InspectTrigger, Integrator, Mode, Stepping};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::{Dimension, display};

/// The fields of a block that steps; where it gives no time step, the critical one over `finer`.
pub fn stepping(
    checker: &mut Checker,
    block: usize,
    contact: Option<&Contact>,
    finer: f64,
) -> Option<Stepping> {
    let mode = mode_check::mode(checker, block);
    let integrator = integrator_check::integrator(checker, block, mode, contact);
    let allow_unstable = checker
        .word(block, methods::ALLOW_UNSTABLE.name, "false")
        .map(|word| word == "true");
    let unsaid = if matches!(mode, Some(Mode::Continuous { .. })) {
        "true"
    } else {
        "false"
    };
    let i_modification = checker
        .word(block, methods::I_MODIFICATION.name, unsaid)
        .map(|word| word == "true");
    let time_step = match checker.field(block, methods::TIME_STEP.name) {
        Some(_) => checker.quantity(block, methods::TIME_STEP.name),
        None => Some(Formula::Binary(
            Operator::Divide,
            Box::new(Formula::CriticalTimeStep),
            Box::new(Formula::Constant(finer)),
        )),
    };
    let pause = checker.quantity(block, methods::PAUSE.name);
    let max_tangent_ratio = checker.quantity(block, methods::MAX_TANGENT_RATIO.name);
    if let (Some(Integrator::Explicit | Integrator::AlphaOs { .. }), Some((_, entry))) = (
        integrator,
        checker.field(block, methods::MAX_TANGENT_RATIO.name),
    ) {
        let name = integrator.map_or("", Integrator::name);
        let message = format!("`max_tangent_ratio` has no effect: `{name}` measures no tangent");
        checker.report(NoEffect {
            message,
            span: entry.key.span,
            label: "no effect",
            help: "remove it, or write `integrator = tangent`",
        });
    }
    let inspect = triggers(checker, block);
    Some(Stepping {
        integrator: integrator?,
        allow_unstable: allow_unstable?,
        i_modification: i_modification?,
        mode: mode?,
        time_step: time_step?,
        pause: pause?,
        max_tangent_ratio: max_tangent_ratio?,
        inspect: inspect?,
    })
}

/// `step` and `duration` in \[s\]. `written`: whether the plan states the time step, which otherwise follows from the period.
struct StepBeyondDuration {
    at: Span,
    written: bool,
    step: f64,
    duration_at: Span,
    duration: f64,
}

impl Violation for StepBeyondDuration {
    const CODE: Code = E401;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            at,
            written,
            step,
            duration_at,
            duration,
        } = self;
        let stated = |time| display::stated(time, Dimension::TIME);
        let message = format!(
            "time step {} is longer than the run, {}",
            stated(step),
            stated(duration)
        );
        Diagnostic::new(Self::CODE, message)
        .at(at, "less than one step")
        .at(duration_at, "length of the run")
        .help(if written {
            "write a shorter `time_step`, or a longer `duration`"
        } else {
            "check mass and stiffness: the time step is a fraction of the period; or write a longer `duration`"
        })
    }
}

/// Refuses a time step that is longer than the run; both times in s.
pub(crate) fn beyond_duration(
    checker: &mut Checker,
    block: usize,
    step: Option<f64>,
    duration: Option<f64>,
) {
    let Some((step, duration)) = step
        .zip(duration)
        .filter(|(step, duration)| step > duration)
    else {
        return;
    };
    let at = |field| checker.value_or_head(block, field);
    let written = checker
        .field(block, methods::TIME_STEP.name)
        .is_some_and(|(_, entry)| !checker.text(entry.value.span).contains("critical"));
    checker.report(StepBeyondDuration {
        at: at(methods::TIME_STEP.name),
        written,
        step,
        duration_at: at(methods::DURATION.name),
        duration,
    });
}

/// The inspection triggers of a block.
fn triggers(checker: &mut Checker, block: usize) -> Option<Vec<InspectTrigger>> {
    let Some((entry, _)) = checker.field(block, methods::INSPECT.name) else {
        return Some(Vec::new());
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choices(block, methods::INSPECT.name)?;
    let triggers: Vec<Option<InspectTrigger>> = chosen
        .iter()
        .map(|chosen| trigger(checker, chosen, context))
        .collect();
    triggers.into_iter().collect()
}

fn trigger<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<InspectTrigger> {
    Some(match chosen.variant.name {
        "every" => InspectTrigger::Every(
            checker
                .constant_argument(chosen, methods::STEPS_BETWEEN.name, context)
                .and_then(whole_number)?,
        ),
        "force_drop" => InspectTrigger::ForceDrop(checker.constant_argument(
            chosen,
            methods::FRACTION.name,
            context,
        )?),
        _ => {
            InspectTrigger::At(checker.constant_argument(chosen, methods::AT_TIME.name, context)?)
        }
    })
}
