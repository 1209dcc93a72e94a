//! `stiffness ramp NAME { … }`

use crate::codes::{E650, W726};
use crate::procedures::common::violations::TooManyInProcedure;
use psd_language::check::checker::{Checker, Context};
use psd_language::check::declarations::curve;
use psd_language::check::expressions::choice::Chosen;
use psd_language::check::expressions::fields::whole;
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::schema::procedures::SPEED;
use psd_plan::{
    ProcedureKind, RampFit, RelaxationLaw, RelaxationModel, StiffnessRamp, WatchedHold,
    WatchedModel,
};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

/// Readings of a pause that span two decades of time: the first comes after one hundredth of it.
const ENOUGH_READINGS: u32 = 10;

/// Most readings of one ramp.
pub const MOST_READINGS: f64 = 1e7;

pub fn stiffness_ramp(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let ramp = read(checker, block);
    held(checker, block)?;
    let ramp = ramp?;
    let of_holds = ramp.relaxation.map_or(0.0, |hold| f64::from(hold.readings));
    #[expect(
        clippy::cast_precision_loss,
        reason = "a list has at most 100,000 entries"
    )]
    let readings = ramp.displacements.len() as f64
        * (f64::from(ramp.samples) * f64::from(ramp.repeats) + of_holds);
    if readings > MOST_READINGS {
        let head = checker.scope.blocks[block].block.head;
        return checker.fail(TooManyInProcedure {
            what: "readings",
            found: readings,
            most: MOST_READINGS,
            span: head,
            help: "write fewer `samples` or `repeats`",
        });
    }
    Some(ProcedureKind::StiffnessRamp(ramp))
}

/// Reads every field before it fails, so that all errors are reported at once.
fn read(checker: &mut Checker<'_>, block: usize) -> Option<StiffnessRamp> {
    let specimen = checker.specimen_of(block);
    let displacements = checker.quantities(block, schema::DISPLACEMENTS.name);
    let pause = checker.quantity(block, schema::PAUSE.name);
    let samples = checker.count(block, schema::SAMPLES.name);
    let repeats = checker.count(block, schema::REPEATS.name);
    let return_path = checker.word(block, schema::RETURN.name, "false");
    let fit = fit(checker, block);
    let relaxation = watched_hold(checker, block);
    let speed = checker.optional(block, SPEED.name);
    Some(StiffnessRamp {
        specimen: specimen?,
        displacements: displacements?,
        pause: pause?,
        samples: samples?,
        repeats: repeats?,
        return_path: return_path? == "true",
        fit: fit?,
        relaxation: relaxation?,
        speed: speed?,
    })
}

#[derive(Violation)]
#[violation(E650, "`relaxation` requires a `pause`")]
#[help("add a line such as `pause = 5 s`")]
struct RelaxationWithoutHold {
    #[label("no readings without a pause")]
    relaxation: Span,
}

/// Refuses a relaxation that is fitted to pauses of no duration.
fn held(checker: &mut Checker, block: usize) -> Option<()> {
    let pause = checker.quantity(block, schema::PAUSE.name);
    match checker.field(block, schema::WATCHED_RELAXATION.name) {
        Some((_, entry)) if pause.and_then(|pause| pause.constant()) == Some(0.0) => {
            checker.fail(RelaxationWithoutHold {
                relaxation: entry.value.span,
            })
        }
        _ => Some(()),
    }
}

/// The curve that is fitted; a line if nothing is stated.
fn fit(checker: &mut Checker<'_>, block: usize) -> Option<RampFit> {
    let Some((entry, _)) = checker.field(block, schema::FIT.name) else {
        return Some(RampFit::Linear);
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choice(block, schema::FIT.name)?;
    match chosen.variant.name {
        "multilinear" => curve::breaks(checker, &chosen, context).map(RampFit::Multilinear),
        "bilinear" => Some(RampFit::Bilinear),
        _ => Some(RampFit::Linear),
    }
}

/// The readings during the pauses: `Some(None)` if the plan states none.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn watched_hold(checker: &mut Checker<'_>, block: usize) -> Option<Option<WatchedHold>> {
    match checker.field(block, schema::WATCHED_RELAXATION.name) {
        Some((entry, written)) => {
            let context = checker.context_of(block, entry);
            let chosen = checker.choice(block, schema::WATCHED_RELAXATION.name)?;
            relaxation(checker, &chosen, context, written.value.span).map(Some)
        }
        None => Some(None),
    }
}

/// The time range of the readings of a dwell, last over first.
#[derive(Violation)]
#[violation(
    W726,
    "{readings} readings per pause cannot distinguish relaxation laws"
)]
#[help("write ten `readings` or more, which span two decades of time")]
struct FewDecades {
    readings: u32,
    #[label(
        "last reading at {spanned} × the first time",
        spanned = u64::from(readings) * u64::from(readings)
    )]
    span: Span,
}

/// The model that is `chosen` at a span.
fn relaxation<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    span: Span,
) -> Option<WatchedHold> {
    let readings = checker
        .constant_argument(chosen, schema::READINGS.name, context)
        .and_then(whole);
    let decay = match chosen.variant.name {
        "standard_linear_solid" => Some(RelaxationModel::StandardLinearSolid),
        "exponential" => Some(RelaxationModel::Exponential),
        _ => None,
    };
    if let Some(model) = decay {
        let accuracy = checker.optional_argument(chosen, schema::ACCURACY.name, context);
        return Some(WatchedHold {
            model: WatchedModel::Decay {
                model,
                accuracy: accuracy?,
            },
            readings: readings?,
        });
    }
    let (rate, readings) = (
        checker.constant_argument(chosen, schema::ALLOWED_RATE.name, context)?,
        readings?,
    );
    let law = (chosen.variant.name == "logarithmic").then_some(RelaxationLaw::Logarithmic);
    if law.is_none() && readings < ENOUGH_READINGS {
        let at = chosen
            .find(schema::READINGS.name)
            .and_then(|(_, given)| given)
            .map_or(span, |given| given.span);
        checker.report(FewDecades { readings, span: at });
    }
    Some(WatchedHold {
        model: WatchedModel::Reached { law, rate },
        readings,
    })
}
