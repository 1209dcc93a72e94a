//! `stiffness ramp NAME { … }`

use crate::language::check::checker::Checker;
use crate::language::check::declarations::curve;
use crate::language::check::expressions::fields::whole;
use crate::language::check::messages::{specimens, values};
use crate::plan::{
    ProcedureKind, RampFit, RelaxationLaw, RelaxationModel, StiffnessRamp, WatchedHold,
    WatchedModel,
};

/// Readings of a pause that span two decades of time: the first comes after one hundredth of it.
const ENOUGH_READINGS: u32 = 10;

/// Most readings of one ramp.
pub const MOST_READINGS: f64 = 1e7;

pub fn stiffness_ramp(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let specimen = checker.specimen_of(block);
    let displacements = checker.quantities(block, "displacements");
    let pause = checker.quantity(block, "pause");
    let (samples, repeats) = (
        checker.count(block, "samples"),
        checker.count(block, "repeats"),
    );
    let return_path = checker
        .word(block, "return", "false")
        .map(|word| word == "true");
    let fit = fit(checker, block);
    let relaxation = relaxation(checker, block);
    let speed = checker.optional(block, "speed");
    let (displacements, samples, repeats, pause) = (displacements?, samples?, repeats?, pause?);
    if let Some((_, entry)) = checker.field(block, "relaxation")
        && pause.constant() == Some(0.0)
    {
        return checker.fail(specimens::relaxation_without_hold(entry.value.span));
    }
    #[expect(
        clippy::cast_precision_loss,
        reason = "a list has at most 100,000 entries"
    )]
    let readings = displacements.len() as f64
        * (f64::from(samples) * f64::from(repeats)
            + relaxation
                .flatten()
                .map_or(0.0, |hold| f64::from(hold.readings)));
    if readings > MOST_READINGS {
        let head = checker.scope.blocks[block].block.head;
        return checker.fail(values::too_many(
            "readings",
            readings,
            MOST_READINGS,
            head,
            "take fewer `samples` or `repeats`",
        ));
    }
    Some(ProcedureKind::StiffnessRamp(StiffnessRamp {
        specimen: specimen?,
        displacements,
        pause,
        samples,
        repeats,
        return_path: return_path?,
        fit: fit?,
        relaxation: relaxation?,
        speed: speed?,
    }))
}

fn fit(checker: &mut Checker, block: usize) -> Option<RampFit> {
    let Some((entry, _)) = checker.field(block, "fit") else {
        return Some(RampFit::Linear);
    };
    let place = checker.context_of(block, entry);
    let chosen = checker.choice(block, "fit")?;
    match chosen.variant.name {
        "multilinear" => curve::breaks(checker, &chosen, place).map(RampFit::Multilinear),
        "bilinear" => Some(RampFit::Bilinear),
        _ => Some(RampFit::Linear),
    }
}

/// The readings during the pauses; None if an error was reported.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn relaxation(checker: &mut Checker, block: usize) -> Option<Option<WatchedHold>> {
    let Some((entry, written)) = checker.field(block, "relaxation") else {
        return Some(None);
    };
    let place = checker.context_of(block, entry);
    let chosen = checker.choice(block, "relaxation")?;
    let readings = checker
        .constant_argument(&chosen, "readings", place)
        .and_then(whole);
    let decay = match chosen.variant.name {
        "standard_linear_solid" => Some(RelaxationModel::StandardLinearSolid),
        "exponential" => Some(RelaxationModel::Exponential),
        _ => None,
    };
    if let Some(model) = decay {
        let accuracy = checker.optional_argument(&chosen, "accuracy", place);
        return Some(Some(WatchedHold {
            model: WatchedModel::Decay {
                model,
                accuracy: accuracy?,
            },
            readings: readings?,
        }));
    }
    let (rate, readings) = (
        checker.constant_argument(&chosen, "rate", place)?,
        readings?,
    );
    let law = (chosen.variant.name == "logarithmic").then_some(RelaxationLaw::Logarithmic);
    if law.is_none() && readings < ENOUGH_READINGS {
        let at = chosen
            .find("readings")
            .and_then(|(_, given)| given)
            .map_or(written.value.span, |given| given.span);
        checker
            .diagnostics
            .push(specimens::few_decades(readings, at));
    }
    Some(Some(WatchedHold {
        model: WatchedModel::Reached { law, rate },
        readings,
    }))
}
