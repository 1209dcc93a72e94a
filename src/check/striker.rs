//! `striker NAME { … }`: mass, velocity or height of fall, gap.

use super::checker::Checker;
use super::faults::names as fault;
use crate::plan::Striker;
use crate::source::Span;

/// Standard gravity, m/s².
const STANDARD_GRAVITY: f64 = 9.806_65;

/// A striker whose entries are all right; None where a fault was reported.
pub fn striker(checker: &mut Checker, block: usize) -> Option<Striker> {
    let declared = &checker.scope.blocks[block];
    let mass = checker.constant(block, "mass");
    match (checker.given(block, "velocity"), checker.given(block, "drop_height")) {
        (Some((_, velocity)), Some((_, height))) => {
            checker.faults.push(fault::velocity_twice(height.key.span, velocity.key.span));
            checker.quantity(block, "drop_height");
        }
        (None, None) if checker.misspelt(block, &["velocity", "drop_height"]) => {}
        (None, None) => {
            let head = declared.block.head;
            checker.faults.push(fault::missing_field(declared.kind, declared.name, head, "velocity", "velocity = 1 m/s"));
        }
        _ => {}
    }
    let (velocity, gap) = (velocity(checker, block), checker.constant(block, "gap"));
    Some(Striker { name: declared.name?.node.clone(), mass: mass?, velocity: velocity?, gap: gap? })
}

/// `velocity`, else √(2·gn·h).
fn velocity(checker: &mut Checker, block: usize) -> Option<f64> {
    if checker.given(block, "velocity").is_some() {
        return checker.constant(block, "velocity");
    }
    checker.constant(block, "drop_height").map(|height| (2.0 * STANDARD_GRAVITY * height).sqrt())
}

/// The value of `pendulum.energy` and its like; None where the striker has a fault that is reported in its place.
pub fn export(checker: &mut Checker, block: usize, name: &str, _asked_at: Span) -> Option<f64> {
    match name {
        "mass" => checker.constant(block, "mass"),
        "velocity" => velocity(checker, block),
        "gap" => checker.constant(block, "gap"),
        "drop_height" if checker.given(block, "drop_height").is_some() => checker.constant(block, "drop_height"),
        "drop_height" => velocity(checker, block).map(|velocity| velocity * velocity / (2.0 * STANDARD_GRAVITY)),
        _ => Some(0.5 * checker.constant(block, "mass")? * velocity(checker, block)?.powi(2)),
    }
}
