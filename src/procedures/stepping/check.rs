//! The fields that impacts and shakes share, and the checks of the steps of a frame. In: a block. Out: its stepping, or errors. It knows
//! no striker and no ground.

use super::{integrator_check, mode_check};
use crate::language::check::checker::{Checker, Context};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::expressions::fields::whole as whole_number;
use crate::language::check::messages::{frames as fault, methods, values, whole};
use crate::physics::structure::frame_properties::FrameProperties;
use crate::physics::structure::storeys_of;
use crate::plan::formula::{Formula, NoResults, Operator};
use crate::plan::{
    Contact, Frame, InspectTrigger, Integrator, MOST_STEPS, Mode, ShakeDamping, Stepping, steps_in,
};

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
        .word(block, "allow_unstable", "false")
        .map(|word| word == "true");
    let unsaid = if matches!(mode, Some(Mode::Continuous { .. })) {
        "true"
    } else {
        "false"
    };
    let i_modification = checker
        .word(block, "i_modification", unsaid)
        .map(|word| word == "true");
    let time_step = match checker.field(block, "time_step") {
        Some(_) => checker.quantity(block, "time_step"),
        None => Some(Formula::Binary(
            Operator::Divide,
            Box::new(Formula::CriticalTimeStep),
            Box::new(Formula::Constant(finer)),
        )),
    };
    let pause = checker.quantity(block, "pause");
    let max_tangent_ratio = checker.quantity(block, "max_tangent_ratio");
    if let (Some(Integrator::Explicit | Integrator::AlphaOs { .. }), Some((_, entry))) =
        (integrator, checker.field(block, "max_tangent_ratio"))
    {
        let name = integrator.map_or("", Integrator::name);
        let message = format!(
            "`max_tangent_ratio` bounds the tangent that is measured, and `{name}` measures none"
        );
        checker.diagnostics.push(values::no_effect(
            message,
            entry.key.span,
            "has no effect",
            "leave it out, or write `integrator = tangent`",
        ));
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

/// The steps of a frame, and their duration \[s\], if it is known before the run.
pub struct FrameSteps<'a> {
    pub specimen: usize,
    pub frame: &'a Frame,
    pub damping: &'a ShakeDamping,
    pub stepping: &'a Stepping,
    pub duration: Option<f64>,
}

/// Checks the time step of a frame as far as it is known before the run: stability, the critical step (of the modes, or `critical`'s),
/// the number of steps. Gives the properties of the frame and the step \[s\] where further checks are possible.
pub fn judge(
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
    mode_check::storeys_damped_twice(checker, block, steps);
    let head = checker.scope.blocks[block].block.head;
    let at = |checker: &Checker, field| {
        checker
            .field(block, field)
            .map_or(head, |(_, entry)| entry.value.span)
    };
    let known = damping.known()?;
    let ratios = at(checker, "damping_ratio");
    if let ShakeDamping::Modal(given) = damping
        && given.len() != frame.degrees_of_freedom()
    {
        return checker.fail(fault::damping_ratios(
            given.len(),
            frame.degrees_of_freedom(),
            ratios,
        ));
    }
    let properties = match FrameProperties::of(frame, &known) {
        Ok(properties) => properties,
        Err(reason) => return checker.fail(fault::damping_impossible(&reason.to_string(), ratios)),
    };
    if let (Integrator::Tangent, None, Some((_, entry))) = (
        stepping.integrator,
        storeys_of(&properties.matrices.stiffness),
        checker.field(block, "max_tangent_ratio"),
    ) {
        let message = "`max_tangent_ratio` bounds the tangent that each storey shows, and full matrices keep the initial stiffness";
        checker.diagnostics.push(values::no_effect(
            message.to_owned(),
            entry.key.span,
            "has no effect",
            "leave it out",
        ));
    }
    let critical = critical(&properties);
    let step = stepping
        .time_step
        .evaluate(&NoResults, critical)
        .ok()?
        .value;
    let step_at = at(checker, "time_step");
    let behaves = if checker.real_rig.is_some() {
        None
    } else {
        Some(frame)
    };
    let limit = properties.longest_stable_step(stepping.integrator, behaves);
    if step > limit {
        return checker.fail(if stepping.allow_unstable {
            fault::unstable_though(step_at, step, limit)
        } else {
            methods::unstable(step_at, stepping.integrator, step, limit)
        });
    }
    beyond_duration(checker, block, Some(step), duration);
    if let Some(critical) = critical.filter(|critical| step > *critical) {
        checker
            .diagnostics
            .push(whole::step_above_critical(step_at, step, critical));
    }
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
    let rows =
        duration.map(|duration| steps_in(duration, step) * frame.degrees_of_freedom() as f64);
    if let Some(rows) = rows.filter(|rows| *rows > MOST_STEPS) {
        let help = "shorten `duration` or take a longer `time_step`";
        checker.diagnostics.push(values::too_many(
            "steps of its storeys",
            rows,
            MOST_STEPS,
            at(checker, "duration"),
            help,
        ));
    }
    Some((properties, step))
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
    let head = checker.scope.blocks[block].block.head;
    let at = |field| {
        checker
            .field(block, field)
            .map_or(head, |(_, entry)| entry.value.span)
    };
    checker.diagnostics.push(values::step_beyond_duration(
        at("time_step"),
        step,
        at("duration"),
        duration,
    ));
}

/// The inspection triggers of a block.
fn triggers(checker: &mut Checker, block: usize) -> Option<Vec<InspectTrigger>> {
    let Some((entry, _)) = checker.field(block, "inspect") else {
        return Some(Vec::new());
    };
    let place = checker.context_of(block, entry);
    let chosen = checker.choices(block, "inspect")?;
    let triggers: Vec<Option<InspectTrigger>> = chosen
        .iter()
        .map(|chosen| trigger(checker, chosen, place))
        .collect();
    triggers.into_iter().collect()
}

fn trigger<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Context,
) -> Option<InspectTrigger> {
    Some(match chosen.variant.name {
        "every" => InspectTrigger::Every(
            checker
                .constant_argument(chosen, "steps", place)
                .and_then(whole_number)?,
        ),
        "force_drop" => {
            InspectTrigger::ForceDrop(checker.constant_argument(chosen, "fraction", place)?)
        }
        _ => InspectTrigger::At(checker.constant_argument(chosen, "time", place)?),
    })
}
