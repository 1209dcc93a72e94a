//! `stiffness ramp NAME { … }`

use super::checker::Checker;
use super::curve;
use super::faults::values;
use crate::plan::{ProcedureKind, RampFit, StiffnessRamp};

/// Most readings of one ramp.
pub const MOST_READINGS: f64 = 1e7;

pub fn stiffness_ramp(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let specimen = checker.specimen_of(block);
    let displacements = checker.quantities(block, "displacements");
    let pause = checker.quantity(block, "pause");
    let (samples, repeats) = (checker.count(block, "samples"), checker.count(block, "repeats"));
    let return_path = checker.word(block, "return", "false").map(|word| word == "true");
    let fit = fit(checker, block);
    let speed = checker.optional(block, "speed");
    let (displacements, samples, repeats) = (displacements?, samples?, repeats?);
    #[expect(clippy::cast_precision_loss, reason = "a list has at most 100,000 entries")]
    let readings = displacements.len() as f64 * f64::from(samples) * f64::from(repeats);
    if readings > MOST_READINGS {
        let head = checker.scope.blocks[block].block.head;
        return checker.fail(values::too_many("readings", readings, MOST_READINGS, head, "take fewer `samples` or `repeats`"));
    }
    Some(ProcedureKind::StiffnessRamp(StiffnessRamp {
        specimen: specimen?,
        displacements,
        pause: pause?,
        samples,
        repeats,
        return_path: return_path?,
        fit: fit?,
        speed: speed?,
    }))
}

fn fit(checker: &mut Checker, block: usize) -> Option<RampFit> {
    let Some((entry, _)) = checker.given(block, "fit") else { return Some(RampFit::Linear) };
    let place = checker.place(block, entry);
    let chosen = checker.choice(block, "fit")?;
    match chosen.variant.name {
        "multilinear" => curve::breaks(checker, &chosen, place).map(RampFit::Multilinear),
        "bilinear" => Some(RampFit::Bilinear),
        _ => Some(RampFit::Linear),
    }
}
