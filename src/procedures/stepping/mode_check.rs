//! `mode = …` of a procedure that integrates: whether the actuator stops at every target. In: a block. Out: the mode, or an error, and a
//! warning where damping would count twice.

use super::check::FrameSteps;
use crate::language::check::checker::Checker;
use crate::language::check::messages::methods as fault;
use crate::language::syntax::ast::{Argument, ExprKind};
use crate::plan::{Dialect, Impact, Mode, PointTarget, ShakeDamping, Specimen};
use crate::schema::Kind;

/// The mode that a block names, otherwise ramp-and-hold (`step_and_pause`).
pub fn mode(checker: &mut Checker, block: usize) -> Option<Mode> {
    let Some((entry, written)) = checker.field(block, "mode") else {
        return Some(Mode::StepAndPause);
    };
    let (place, at) = (checker.context_of(block, entry), written.value.span);
    let chosen = checker.choice(block, "mode")?;
    if chosen.variant.name == "step_and_pause" {
        return Some(Mode::StepAndPause);
    }
    let time_scale = checker.constant_argument(&chosen, "time_scale", place)?;
    if let Some(dialect) = checker
        .real_rig
        .and_then(|rig| stops_at_targets(checker, rig))
    {
        return checker.fail(fault::continuous_on_a_real_rig(dialect, at));
    }
    let stops = ["pause", "inspect"]
        .into_iter()
        .find_map(|field| checker.field(block, field).map(|(_, entry)| (field, entry)));
    if let Some((field, entry)) = stops {
        return checker.fail(fault::stops_on_the_way(field, entry.span, at));
    }
    Some(Mode::Continuous { time_scale })
}

/// The protocol of a real rig that follows no path and does not read displacement and force at one instant: any except `native`. An
/// unknown one is reported elsewhere.
pub fn stops_at_targets<'a>(checker: &Checker<'a>, rig: usize) -> Option<&'a str> {
    let (_, written) = checker
        .field(rig, "link")
        .or_else(|| checker.field(rig, "actuator"))?;
    let ExprKind::Call { arguments, .. } = &written.value.kind else {
        return None;
    };
    let is_dialect = |(place, argument): &(usize, &Argument)| match &argument.name {
        Some(name) => name.node == "dialect",
        None => *place == 1,
    };
    let (_, dialect) = arguments.iter().enumerate().find(is_dialect)?;
    let word = match &dialect.value.kind {
        ExprKind::Name(name) => name.as_str(),
        ExprKind::Call { name, .. } => name.node.as_str(),
        _ => return None,
    };
    (word != Dialect::Native.name()).then_some(word)
}

/// The material's damping is in the force of a continuous run already.
pub fn damping_twice(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    point: &PointTarget,
    specimen: Option<&Specimen>,
) {
    let computed = point.damping.constant().is_none_or(|damping| damping > 0.0);
    let felt = specimen.is_some_and(|specimen| specimen.damping > 0.0);
    if !(computed && felt && matches!(impact.stepping.mode, Mode::Continuous { .. })) {
        return;
    }
    let of_specimen = checker
        .scope
        .of_kind(Kind::Specimen)
        .nth(impact.specimen)
        .map(|(index, _)| index);
    let at = |block, field| checker.field(block, field).map(|(_, entry)| entry.span);
    if let (Some(computed), Some(felt)) = (
        at(block, "damping"),
        of_specimen.and_then(|index| at(index, "damping")),
    ) {
        checker
            .diagnostics
            .push(fault::damping_twice(computed, felt));
    }
}

/// The same for a frame, whose storeys have damping.
pub fn storeys_damped_twice(checker: &mut Checker, block: usize, steps: &FrameSteps<'_>) {
    let computed = match steps.damping {
        ShakeDamping::Rayleigh(ratio) => ratio.constant().is_none_or(|ratio| ratio > 0.0),
        ShakeDamping::Modal(ratios) => ratios
            .iter()
            .any(|ratio| ratio.constant().is_none_or(|ratio| ratio > 0.0)),
    };
    let felt = steps
        .frame
        .storeys
        .iter()
        .any(|storey| storey.damping > 0.0);
    if !(computed && felt && matches!(steps.stepping.mode, Mode::Continuous { .. })) {
        return;
    }
    let of_specimen = checker
        .scope
        .of_kind(Kind::Specimen)
        .nth(steps.specimen)
        .map(|(index, _)| index);
    let at = |block, field| checker.field(block, field).map(|(_, entry)| entry.span);
    let felt = of_specimen.and_then(|index| at(index, "storeys"));
    if let (Some(computed), Some(felt)) = (at(block, "damping_ratio"), felt) {
        checker
            .diagnostics
            .push(fault::damping_twice(computed, felt));
    }
}
