//! `shake NAME { … }`: the frame, the ground under it, damping, and a time step that is stable.

use super::checker::{Checker, Shape};
use super::faults::{frames as fault, methods, types, values, whole};
use super::{frame, impact, integrator, mode};
use crate::formula::{Formula, NoResults, Operator};
use crate::mechanics::frame_properties::FrameProperties;
use crate::plan::{Contact, Frame, Ground, MOST_STEPS, Mode, ProcedureKind, Shake, ShakeDamping};
use crate::schema::Kind;

pub fn shake(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let declared = &checker.scope.blocks[block];
    let head = declared.block.head;
    let ground = checker.reference(block, "ground", Kind::Ground);
    let specimen = checker.specimen_block(block);
    let damping = damping(checker, block);
    let damping_uncertainty = damping_uncertainty(checker, block, damping.as_ref());
    let mode = mode::mode(checker, block);
    let integrator = integrator::integrator(checker, block, mode, Some(&Contact::Rigid));
    let allow_unstable = checker.word(block, "allow_unstable", "false").map(|word| word == "true");
    let unsaid = if matches!(mode, Some(Mode::Continuous { .. })) { "true" } else { "false" };
    let i_modification = checker.word(block, "i_modification", unsaid).map(|word| word == "true");
    let max_tangent_ratio = checker.quantity(block, "max_tangent_ratio");
    let time_step = match checker.given(block, "time_step") {
        Some(_) => checker.quantity(block, "time_step"),
        None => Some(fifth_of_critical()),
    };
    let scale = checker.quantity(block, "scale");
    let duration = checker.optional(block, "duration");
    let pause = checker.quantity(block, "pause");
    let inspect = impact::triggers(checker, block);
    let specimen = specimen?;
    if !frame::is_frame(checker, specimen) {
        let tested = &checker.scope.blocks[specimen];
        let (name, declared) = (tested.name.map_or("", |name| name.node.as_str()), tested.block.head);
        let at = checker.given(block, "specimen").map_or(head, |(_, entry)| entry.value.span);
        return checker.fail(fault::no_storeys(name, at, declared));
    }
    Some(ProcedureKind::Shake(Shake {
        specimen: checker.scope.place_in_kind(specimen),
        ground: checker.scope.place_in_kind(ground?),
        damping: damping?,
        damping_uncertainty: damping_uncertainty?,
        integrator: integrator?,
        allow_unstable: allow_unstable?,
        i_modification: i_modification?,
        mode: mode?,
        max_tangent_ratio: max_tangent_ratio?,
        time_step: time_step?,
        scale: scale?,
        duration: duration?,
        pause: pause?,
        inspect: inspect?,
    }))
}

fn fifth_of_critical() -> Formula {
    Formula::Binary(Operator::Divide, Box::new(Formula::CriticalTimeStep), Box::new(Formula::Constant(5.0)))
}

/// One number is Rayleigh's, a list has one for each mode.
pub fn damping(checker: &mut Checker, block: usize) -> Option<ShakeDamping> {
    let Some((entry, written)) = checker.given(block, "damping_ratio") else {
        return Some(ShakeDamping::Rayleigh(Formula::Constant(0.0)));
    };
    let typed = checker.entry(block, entry, written.value.span)?;
    Some(match typed.shape {
        Shape::Number => ShakeDamping::Rayleigh(typed.formula),
        Shape::List if matches!(typed.formula, Formula::List(_)) => ShakeDamping::Modal(typed.parts()),
        Shape::List => return checker.fail(types::list_for_number(written.value.span)),
    })
}

/// Standard, of each ratio: no ratio less its uncertainty is below 0.
pub fn damping_uncertainty(checker: &mut Checker, block: usize, damping: Option<&ShakeDamping>) -> Option<f64> {
    const FIELD: &str = "damping_ratio_uncertainty";
    let uncertainty = checker.constant(block, FIELD)?;
    let ratios = match damping? {
        ShakeDamping::Rayleigh(ratio) => std::slice::from_ref(ratio),
        ShakeDamping::Modal(ratios) => ratios,
    };
    let least = ratios.iter().filter_map(Formula::constant).reduce(f64::min);
    match (least.filter(|least| uncertainty > *least), checker.given(block, FIELD)) {
        (Some(least), Some((_, entry))) => {
            let at = entry.value.span;
            checker.fail(fault::damping_too_uncertain(uncertainty, least, at))
        }
        _ => Some(uncertainty),
    }
}

/// What the time step of a shake must be held against, as far as it is known before the run: stability, the shortest
/// period, the record, the number of steps.
pub fn judge(checker: &mut Checker, block: usize, shake: &Shake, frame: &Frame, ground: &Ground) {
    mode::storeys_damped_twice(checker, block, (shake.specimen, shake.mode, &shake.damping), frame);
    let head = checker.scope.blocks[block].block.head;
    let at = |checker: &Checker, field| checker.given(block, field).map_or(head, |(_, entry)| entry.value.span);
    let Some(damping) = shake.damping.known() else { return };
    let ratios = at(checker, "damping_ratio");
    if let ShakeDamping::Modal(given) = &shake.damping
        && given.len() != frame.degrees_of_freedom()
    {
        checker.faults.push(fault::damping_ratios(given.len(), frame.degrees_of_freedom(), ratios));
        return;
    }
    let properties = match FrameProperties::of(frame, &damping) {
        Ok(properties) => properties,
        Err(reason) => {
            checker.faults.push(fault::damping_impossible(&reason.to_string(), ratios));
            return;
        }
    };
    let critical = properties.critical_time_step();
    let Some(step) = shake.time_step.evaluate(&NoResults, Some(critical)).ok().map(|estimate| estimate.value) else { return };
    let step_at = at(checker, "time_step");
    let behaves = if checker.real_rig.is_some() { None } else { Some(frame) };
    let limit = properties.longest_stable_step(shake.integrator, behaves);
    if step > limit {
        checker.faults.push(if shake.allow_unstable {
            fault::unstable_though(step_at, step, limit)
        } else {
            methods::unstable(step_at, shake.integrator, step, limit)
        });
        return;
    }
    if step > critical {
        checker.faults.push(whole::step_above_critical(step_at, step, critical));
    }
    let spacing = ground.spacing().0;
    if step > spacing * (1.0 + 1e-9) {
        checker.faults.push(fault::record_finer_than_step(step_at, step, spacing, &ground.name));
    }
    let duration = shake.duration.as_ref().map_or(Some(ground.duration()), Formula::constant);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
    let rows = duration.map(|duration| (duration / step).ceil() * frame.degrees_of_freedom() as f64);
    if let Some(rows) = rows.filter(|rows| *rows > MOST_STEPS) {
        let help = "shorten `duration` or take a longer `time_step`";
        checker.faults.push(values::too_many("steps of its storeys", rows, MOST_STEPS, at(checker, "duration"), help));
    }
}
