//! `preload NAME { … }`, and the order of the procedures beside it. In: its block, the rig, all procedures. Out: its parameters, and the
//! axial load of the storeys.

use crate::codes::{E678, W743};
use psd_language::check::checker::Checker;
use psd_language::check::rig::CheckedRig;
use psd_plan::procedures::preload::block as schema;
use psd_plan::procedures::unload::block::KEEP_AXIAL_LOAD;
use psd_plan::schema::rig as rig_schema;
use psd_plan::{AxialAxis, Frame, Limits, Preload, Procedure, ProcedureKind, Specimen};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

pub fn preload(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let storey = checker.count(block, schema::STOREY.name);
    let force = checker.constant(block, schema::FORCE.name);
    Some(ProcedureKind::Preload(Preload {
        storey: storey? as usize - 1,
        force: force?,
    }))
}

#[derive(Violation)]
#[violation(E678, "`preload` of storey {storey}, but no axial axis loads it")]
#[help(
    "add it to the `axes` of the rig, after the others: axis(axial: {storey}, control: force(rate: 5 kN/s, tolerance: 0.5 kN), p_delta: 100 %, displacement: -4 mm .. 4 mm)"
)]
struct NoAxialAxis {
    storey: usize,
    #[label("no axial axis")]
    span: Span,
}

#[derive(Violation)]
#[violation(
    E678,
    "a second `preload` of storey {storey}: its axial load is constant"
)]
#[help("remove one of them")]
struct SecondPreload {
    storey: usize,
    #[label("loads it again")]
    span: Span,
}

#[derive(Violation)]
#[violation(E678, "the axial axis of storey {storey} has no `preload`")]
#[help(
    "add a block such as `preload column {{ storey = {storey}  force = 262.5 kN }}`, or remove the axis"
)]
struct NoPreload {
    storey: usize,
    #[label("not used")]
    axes: Span,
}

#[derive(Violation)]
#[violation(E678, "no axial axis of the rig holds a load")]
#[help("remove `keep_axial_load`")]
struct NoLoadToKeep {
    #[label("nothing to keep")]
    span: Span,
}

#[derive(Violation)]
#[violation(E678, "`{keyword}` moves storey {storey} {when}")]
#[help("{}", help)]
struct MovesUnloaded {
    keyword: &'static str,
    storey: usize,
    when: &'static str,
    #[label("no axial load here")]
    span: Span,
    help: &'static str,
}

#[derive(Violation)]
#[violation(
    E678,
    "storey {storey} falls over under its axial load: the P-Δ per drift is {ratio} of its stiffness (below 1 expected)"
)]
#[help("write a smaller `force`, or a larger `stiffness` or `height`")]
struct FallsUnderAxialLoad {
    storey: usize,
    ratio: String,
    #[label("axial load")]
    span: Span,
}

/// In numbers of the prototype: the axial load on the rig, and the weight that the storey carries.
#[derive(Violation)]
#[violation(
    W743,
    "the axial load of storey {storey} is {load} in the prototype, {times} times the weight that it carries, {weight}"
)]
#[help(
    "check `force` and `gravity`: the load on the rig is the weight times λ_f/n, here {} (a load by intention needs no change)",
    on_the_rig
)]
struct AnotherLoadThanItsWeight {
    storey: usize,
    load: String,
    times: String,
    weight: String,
    on_the_rig: String,
    #[label("axial load")]
    span: Span,
}

/// Of axial load and weight: beyond it one of them is probably a number of the other scale.
const OTHER: f64 = 1.5;

/// A load of the prototype on a specimen at a scale, or the reverse.
fn warn_of_another_load(checker: &mut Checker, frame: &Frame, preload: &Preload, span: Span) {
    let Some(storey) = frame.storeys.get(preload.storey) else {
        return;
    };
    let is_weighed = frame.storeys.iter().any(|storey| storey.gravity > 0.0);
    let weight = frame.axial_loads().get(preload.storey).copied();
    let Some(weight) = weight.filter(|weight| is_weighed && *weight > 0.0) else {
        return;
    };
    let scale = storey.part.scale().forces();
    let load = preload.force * scale;
    let times = load / weight;
    if !(1.0 / OTHER..=OTHER).contains(&times) {
        checker.report(AnotherLoadThanItsWeight {
            storey: preload.storey + 1,
            load: readable(load, Dimension::FORCE),
            times: stated(times, Dimension::NUMBER),
            weight: readable(weight, Dimension::FORCE),
            on_the_rig: readable(weight / scale, Dimension::FORCE),
            span,
        });
    }
}

/// Checks the axial loads of a plan, and enters each in its storey: the P-Δ in the reading of the rig is not computed a second time.
pub(crate) fn check_axial_loads(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    specimens: &mut [Option<Specimen>],
    rig: Option<&CheckedRig>,
) {
    let Some(rig) = rig else { return };
    let axes: Vec<AxialAxis> = rig
        .plan
        .axial_axes(&Limits::NONE)
        .map(|(axis, _)| axis)
        .collect();
    let on_rig = procedures
        .iter()
        .find_map(|(_, procedure)| procedure.as_ref()?.kind.specimen())
        .unwrap_or(0);
    let mut loaded = vec![false; axes.len()];
    for (block, procedure) in procedures {
        let Some(Procedure { kind, .. }) = procedure else {
            return;
        };
        let head = checker.scope.blocks[*block].block.head;
        match kind {
            ProcedureKind::Preload(preload) => {
                let storey = preload.storey + 1;
                let span = checker.value_or_head(*block, schema::STOREY.name);
                let axis = axes.iter().position(|axis| axis.storey == preload.storey);
                let Some(axis) = axis else {
                    return checker.report(NoAxialAxis { storey, span });
                };
                if loaded[axis] {
                    return checker.report(SecondPreload { storey, span });
                }
                for (loaded, axis) in loaded.iter_mut().zip(&axes) {
                    *loaded |= axis.storey == preload.storey;
                }
                let frame = specimens.get_mut(on_rig).and_then(Option::as_mut);
                if let Some(frame) = frame.and_then(|specimen| specimen.frame.as_mut()) {
                    let span = checker.value_or_head(*block, schema::FORCE.name);
                    if let Some(ratio) = enter(frame, &axes[axis], preload.force) {
                        let ratio = format!("{ratio:.3}");
                        return checker.report(FallsUnderAxialLoad {
                            storey,
                            ratio,
                            span,
                        });
                    }
                    warn_of_another_load(checker, frame, preload, span);
                }
            }
            ProcedureKind::Inspect { .. } => {}
            _ => {
                if let Some(axis) = loaded.iter().position(|loaded| !loaded) {
                    return checker.report(MovesUnloaded {
                        keyword: kind.keyword(),
                        storey: axes[axis].storey + 1,
                        when: "before its `preload`",
                        span: head,
                        help: "move the `preload` above it",
                    });
                }
                if let ProcedureKind::Unload(unload) = kind {
                    if axes.is_empty() && unload.keep_axial_load {
                        let span = checker.value_or_head(*block, KEEP_AXIAL_LOAD.name);
                        return checker.report(NoLoadToKeep { span });
                    }
                    if !axes.is_empty() && !unload.keep_axial_load {
                        return check_after_unloading(checker, procedures, *block, &axes);
                    }
                }
            }
        }
    }
    if let (Some(axis), Some(block)) = (loaded.iter().position(|loaded| !loaded), rig.block)
        && let Some((_, written)) = checker.field(block, rig_schema::AXES.name)
    {
        checker.report(NoPreload {
            storey: axes[axis].storey + 1,
            axes: written.key.span,
        });
    }
}

/// `unload` takes the axial load off: nothing moves the storeys afterwards.
fn check_after_unloading(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    unload: usize,
    axes: &[AxialAxis],
) {
    let after = procedures.iter().skip_while(|(block, _)| *block != unload);
    for (block, procedure) in after.skip(1) {
        let Some(Procedure { kind, .. }) = procedure else {
            continue;
        };
        if !matches!(kind, ProcedureKind::Inspect { .. }) {
            let span = checker.scope.blocks[*block].block.head;
            return checker.report(MovesUnloaded {
                keyword: kind.keyword(),
                storey: axes[0].storey + 1,
                when: "after `unload` took its axial load off",
                span,
                help: "end the plan with this `unload`, and write `keep_axial_load = true` in every one before it",
            });
        }
    }
}

/// Enters the axial load in its storey. The ratio of P-Δ and initial stiffness, if the storey is unstable at rest: under its weights, or
/// under the axial load alone.
fn enter(frame: &mut Frame, axis: &AxialAxis, force: f64) -> Option<f64> {
    let storey = frame.storeys.get_mut(axis.storey)?;
    storey.axial_load = axis.p_delta * force * storey.part.scale().forces();
    let (stiffness, on_the_rig) = (storey.stiffness, storey.axial_stiffness());
    let of_weights = *frame.gravity_stiffness().get(axis.storey)?;
    let ratio = of_weights.max(on_the_rig) / stiffness;
    (ratio >= 1.0).then_some(ratio)
}
