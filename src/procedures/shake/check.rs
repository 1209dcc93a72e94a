//! `shake NAME { … }`: the frame, the ground motion, damping, and a stable time step.

use crate::codes::{E624, W713};
use crate::procedures::stepping;
use crate::procedures::stepping::check::damping_check::{damping, damping_uncertainty};
use crate::procedures::stepping::check::frame_check;
use crate::procedures::stepping::check::frame_check::FrameSteps;
use psd_language::check::checker::Checker;
use psd_language::check::declarations::specimen::frame;
use psd_language::check::declared::Declared;
use psd_language::check::wording::shown;
use psd_plan::formula::Formula;
use psd_plan::procedures::shake::block as schema;
use psd_plan::schema::procedures::SPECIMEN;
use psd_plan::schema::{Kind, methods};
use psd_plan::{Contact, ProcedureKind, Shake};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

#[derive(Violation)]
#[violation(E624, "specimen `{specimen}` has no storeys; `shake` requires a frame")]
#[help("write `storeys = [storey(mass: 2 t, stiffness: 3 MN/m)]` instead of mass and behaviour")]
struct NoStoreys<'a> {
    specimen: &'a str,
    #[label("requires storeys")]
    span: Span,
    #[label("no storeys")]
    declared: Span,
}

pub fn shake(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let ground = checker.reference(block, schema::GROUND.name, Kind::Ground);
    let specimen = checker.specimen_block(block);
    let damping = damping(checker, block);
    let damping_uncertainty = damping_uncertainty(checker, block, damping.as_ref());
    let stepping = stepping::check::stepping(checker, block, Some(&Contact::Rigid), 5.0);
    let scale = checker.quantity(block, schema::SCALE.name);
    let duration = checker.optional(block, methods::DURATION.name);
    let until = until(checker, block);
    let specimen = specimen?;
    if !frame::is_frame(checker, specimen) {
        let tested = &checker.scope.blocks[specimen];
        let (name, declared) = (
            tested.name.map_or("", |name| name.node.as_str()),
            tested.block.head,
        );
        let at = checker.value_or_head(block, SPECIMEN.name);
        return checker.fail(NoStoreys {
            specimen: name,
            span: at,
            declared,
        });
    }
    Some(ProcedureKind::Shake(Shake {
        specimen: checker.scope.index_in_kind(specimen),
        ground: checker.scope.index_in_kind(ground?),
        damping: damping?,
        damping_uncertainty: damping_uncertainty?,
        stepping: stepping?,
        scale: scale?,
        duration: duration?,
        until: until?,
    }))
}

/// The drift that ends the run \[m\]; `Some(None)` if the run has its whole duration.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn until(checker: &mut Checker, block: usize) -> Option<Option<f64>> {
    let Some((entry, _)) = checker.field(block, schema::UNTIL.name) else {
        return Some(None);
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choice(block, schema::UNTIL.name)?;
    if chosen.variant.name != methods::DRIFT_REACHED.name {
        return Some(None);
    }
    let drift = checker.constant_argument(&chosen, methods::REACHED.name, context)?;
    Some(Some(drift))
}

struct RecordFinerThanStep<'a> {
    span: Span,
    step: f64,
    spacing: f64,
    ground: &'a str,
}

impl Violation for RecordFinerThanStep<'_> {
    const CODE: Code = W713;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            span,
            step,
            spacing,
            ground,
        } = self;
        let (step, spacing) = (
            shown(step, Dimension::TIME),
            shown(spacing, Dimension::TIME),
        );
        Diagnostic::new(
        Self::CODE,
        format!("ground peaks may be missed: time step {step} exceeds the sample spacing {spacing} of `{ground}`"),
    )
    .at(span, format!("{step}, sample spacing is {spacing}"))
    .help(format!("write `time_step = {spacing}` or less"))
    }
}

/// Checks the time step of a ground-motion test, as far as it is known before the run: against the limits of any frame, and against the
/// time step of the record.
pub(crate) fn check_declared(
    checker: &mut Checker,
    block: usize,
    shake: &Shake,
    declared: &Declared<'_>,
) {
    let (Some(frame), Some(ground)) = (
        declared.frame(shake.specimen),
        declared.ground(shake.ground),
    ) else {
        return;
    };
    let duration = shake
        .duration
        .as_ref()
        .map_or(Some(ground.duration()), Formula::constant);
    let Shake {
        specimen,
        damping,
        stepping,
        ..
    } = shake;
    let steps = FrameSteps {
        specimen: *specimen,
        frame,
        damping,
        stepping,
        duration,
    };
    let Some((_, step)) = frame_check::check(checker, block, &steps, |properties| {
        Some(properties.critical_time_step())
    }) else {
        return;
    };
    let spacing = ground.spacing().0;
    if step > spacing * (1.0 + 1e-9) {
        let at = checker.value_or_head(block, methods::TIME_STEP.name);
        checker.report(RecordFinerThanStep {
            span: at,
            step,
            spacing,
            ground: &ground.name,
        });
    }
}
