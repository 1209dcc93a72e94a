//! `stiffness ramp NAME { … }`

use crate::language::check::checker::{Checker, Context};
use crate::language::check::declarations::curve;
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::expressions::fields::whole;
use crate::language::check::expressions::read_field::ReadField;
use crate::language::check::messages::{specimens, values};
use crate::plan::declaration::reader;
use crate::plan::procedures::stiffness_ramp::block as schema;
use crate::plan::procedures::stiffness_ramp::block::NAMES;
use crate::plan::procedures::stiffness_ramp::parameters::stiffness_ramp_fields;
use crate::plan::{
    ProcedureKind, RampFit, RelaxationLaw, RelaxationModel, StiffnessRamp, WatchedHold,
    WatchedModel,
};
use crate::text::source::Span;

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
        return checker.fail(values::too_many(
            "readings",
            readings,
            MOST_READINGS,
            head,
            "write fewer `samples` or `repeats`",
        ));
    }
    Some(ProcedureKind::StiffnessRamp(ramp))
}

stiffness_ramp_fields!(reader);

/// Refuses a relaxation that is fitted to pauses of no duration.
fn held(checker: &mut Checker, block: usize) -> Option<()> {
    let pause = checker.quantity(block, NAMES.pause);
    match checker.field(block, NAMES.relaxation) {
        Some((_, entry)) if pause.and_then(|pause| pause.constant()) == Some(0.0) => {
            checker.fail(specimens::relaxation_without_hold(entry.value.span))
        }
        _ => Some(()),
    }
}

impl ReadField for RampFit {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        let Some((entry, _)) = checker.field(block, field) else {
            return Some(Self::Linear);
        };
        let context = checker.context_of(block, entry);
        let chosen = checker.choice(block, field)?;
        match chosen.variant.name {
            "multilinear" => curve::breaks(checker, &chosen, context).map(Self::Multilinear),
            "bilinear" => Some(Self::Bilinear),
            _ => Some(Self::Linear),
        }
    }
}

/// The readings during the pauses.
impl ReadField for Option<WatchedHold> {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        match checker.field(block, field) {
            Some((entry, written)) => {
                let context = checker.context_of(block, entry);
                let chosen = checker.choice(block, field)?;
                relaxation(checker, &chosen, context, written.value.span).map(Some)
            }
            None => Some(None),
        }
    }
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
        checker
            .diagnostics
            .push(specimens::few_decades(readings, at));
    }
    Some(WatchedHold {
        model: WatchedModel::Reached { law, rate },
        readings,
    })
}
