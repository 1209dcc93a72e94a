//! `mode = …` of a procedure that integrates: whether the actuator stops at every target. In: a block. Out: the mode, or an error, and a
//! warning where damping would count twice.

use crate::codes::{E644, E645, W716};
use psd_language::check::checker::Checker;
use psd_language::syntax::ast::{Argument, Expr, ExprKind};
use psd_plan::procedures::impact::block as impact;
use psd_plan::schema::devices::DIALECT;
use psd_plan::schema::{Kind, methods, rig, specimen};
use psd_plan::{Dialect, Impact, Mode, PointTarget, Specimen};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

struct ContinuousOnARealRig<'a> {
    dialect: &'a str,
    span: Span,
}

impl Violation for ContinuousOnARealRig<'_> {
    const CODE: Code = E644;

    fn diagnostic(self) -> Diagnostic {
        let Self { dialect, span } = self;
        let message =
            format!("continuous mode requires a rig that follows a path; `{dialect}` does not");
        Diagnostic::new(Self::CODE, message)
        .at(span, format!("`{dialect}` stops at every target"))
        .help("write `mode = ramp_and_hold`; or use a `native` controller with `GLIDE`, or a virtual rig")
    }
}

#[derive(Violation)]
#[violation(
    E645,
    "`{field}` has no effect in continuous mode: the actuator never stops"
)]
#[help("remove `{field}`, or write `mode = ramp_and_hold`")]
struct StopsBetweenReadings<'a> {
    field: &'a str,
    #[label("requires a stop")]
    span: Span,
    #[label("does not stop")]
    mode: Span,
}

#[derive(Violation)]
#[violation(
    E644,
    "the real rig has an axial axis: beside it the controller moves to targets only"
)]
#[help("move to targets, or use a virtual rig")]
struct ContinuousUnderAxialLoad {
    #[label("reads during the motion")]
    span: Span,
}

/// The mode that a block names, otherwise `ramp_and_hold`.
pub fn mode(checker: &mut Checker, block: usize) -> Option<Mode> {
    let Some((entry, written)) = checker.field(block, methods::MODE.name) else {
        return Some(Mode::RampAndHold);
    };
    let (context, at) = (checker.context_of(block, entry), written.value.span);
    let chosen = checker.choice(block, methods::MODE.name)?;
    if chosen.variant.name == "ramp_and_hold" {
        return Some(Mode::RampAndHold);
    }
    let time_scale = checker.constant_argument(&chosen, methods::TIME_SCALE.name, context)?;
    if let Some(dialect) = checker
        .real_rig
        .and_then(|rig| stops_at_targets(checker, rig))
    {
        return checker.fail(ContinuousOnARealRig { dialect, span: at });
    }
    beside_no_axial_axis(checker, at)?;
    let stops = [methods::PAUSE.name, methods::INSPECT.name]
        .into_iter()
        .find_map(|field| checker.field(block, field).map(|(_, entry)| (field, entry)));
    if let Some((field, entry)) = stops {
        return checker.fail(StopsBetweenReadings {
            field,
            span: entry.span,
            mode: at,
        });
    }
    Some(Mode::Continuous { time_scale })
}

/// Refuses a motion with readings on a real rig that has an axial axis.
pub fn beside_no_axial_axis(checker: &mut Checker, span: Span) -> Option<()> {
    match checker.real_rig {
        Some(rig) if has_axial_axis(checker, rig) => {
            checker.fail(ContinuousUnderAxialLoad { span })
        }
        _ => Some(()),
    }
}

/// Whether the list of axes of a rig has an axial one.
fn has_axial_axis(checker: &Checker<'_>, rig: usize) -> bool {
    let Some((_, written)) = checker.field(rig, rig::AXES.name) else {
        return false;
    };
    let is_axial = |axis: &Expr| {
        let ExprKind::Call { arguments, .. } = &axis.kind else {
            return false;
        };
        let mut names = arguments
            .iter()
            .filter_map(|argument| argument.name.as_ref());
        names.any(|name| name.node == rig::AXIAL)
    };
    match &written.value.kind {
        ExprKind::List { items, .. } => items.iter().any(is_axial),
        _ => is_axial(&written.value),
    }
}

/// The protocol of a real rig that follows no path and does not read displacement and force at one instant: any except `native`. An
/// unknown one is reported elsewhere.
pub fn stops_at_targets<'a>(checker: &Checker<'a>, rig: usize) -> Option<&'a str> {
    let (_, written) = checker
        .field(rig, rig::LINK.name)
        .or_else(|| checker.field(rig, rig::ACTUATOR.name))?;
    let ExprKind::Call { arguments, .. } = &written.value.kind else {
        return None;
    };
    let is_dialect = |(index, argument): &(usize, &Argument)| match &argument.name {
        Some(name) => name.node == DIALECT.name,
        None => *index == 1,
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
    let is_measured = specimen.is_some_and(|specimen| specimen.damping > 0.0);
    if computed && is_measured && matches!(impact.stepping.mode, Mode::Continuous { .. }) {
        let fields = [impact::DAMPING.name, specimen::DAMPING.name];
        warn_of_damping_twice(checker, block, impact.specimen, fields);
    }
}

#[derive(Violation)]
#[violation(
    W716,
    "damping is counted twice: in continuous mode the measured force already contains the specimen's damping"
)]
#[help(
    "remove the procedure's damping, or write only the part that is not measured: measured damping is divided by the time scale"
)]
struct DampingTwice {
    #[label("computed here")]
    computed: Span,
    #[label("already measured here")]
    measured: Span,
}

/// Warns at the field of the block whose damping is computed, and at the field of the specimen with this index whose damping is measured.
pub fn warn_of_damping_twice(
    checker: &mut Checker,
    block: usize,
    specimen: usize,
    [computed, measured]: [&str; 2],
) {
    let of_specimen = checker
        .scope
        .of_kind(Kind::Specimen)
        .nth(specimen)
        .map(|(index, _)| index);
    let at = |block, field| checker.field(block, field).map(|(_, entry)| entry.span);
    if let (Some(computed), Some(measured)) = (
        at(block, computed),
        of_specimen.and_then(|index| at(index, measured)),
    ) {
        checker.report(DampingTwice { computed, measured });
    }
}
