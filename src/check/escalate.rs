//! `escalate NAME { … }`: the fields of an impact, its levels, and the condition that lets the next blow follow.

use super::checker::{Checker, Place, Reads};
use super::faults::{cyclic as fault, names, values};
use super::striker::STANDARD_GRAVITY;
use super::{impact, storey_impact};
use crate::formula::{Formula, Function, Operator};
use crate::plan::{Between, BlowOn, Condition, Escalate, MOST_BLOWS, ProcedureKind};
use crate::schema::Kind;
use crate::source::Span;

/// The fields each of which gives the levels.
const LEVELS: [&str; 3] = ["speeds", "drop_heights", "energies"];

pub fn escalate(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let own = checker.scope.blocks[block].procedure?;
    let velocities = velocities(checker, block);
    let condition = condition(checker, block);
    let between = checker.word(block, "between", "unload");
    let inspect_between = checker.word(block, "inspect_between", "false").map(|word| word == "true");
    let blow = match storey_impact::struck_frame(checker, block) {
        Some((specimen, frame)) => storey_impact::storey_impact(checker, block, specimen, frame.as_ref()).map(BlowOn::Storey),
        None => impact::blow(checker, block).map(BlowOn::Specimen),
    };
    Some(ProcedureKind::Escalate(Escalate {
        own,
        blow: blow?,
        velocities: velocities?,
        condition: condition?,
        between: match between? {
            "home" => Between::Home,
            "stay" => Between::Stay,
            _ => Between::Unload,
        },
        inspect_between: inspect_between?,
    }))
}

/// The striker's velocity of each blow: v, √(2·gn·h) or √(2E/Ms).
fn velocities(checker: &mut Checker, block: usize) -> Option<Vec<Formula>> {
    let declared = &checker.scope.blocks[block];
    let (kind, name, head) = (declared.kind, declared.name, declared.block.head);
    let given: Vec<(&str, Span, Span)> = LEVELS
        .into_iter()
        .filter_map(|field| checker.given(block, field).map(|(_, entry)| (field, entry.key.span, entry.value.span)))
        .collect();
    let (field, span) = match given.as_slice() {
        [(field, _, span)] => (*field, *span),
        [] => {
            if !checker.misspelt(block, &LEVELS) {
                checker.faults.push(names::missing_field(kind, name, head, "speeds", "speeds = [0.5, 1, 1.5] m/s"));
            }
            return None;
        }
        [(first, at, _), rest @ ..] => {
            for (again, span, _) in rest {
                checker.faults.push(fault::levels_twice(again, *span, first, *at));
            }
            return None;
        }
    };
    let levels = checker.quantities(block, field)?;
    if levels.len() > MOST_BLOWS {
        #[expect(clippy::cast_precision_loss, reason = "a list has at most 100,000 entries")]
        let (found, most) = (levels.len() as f64, MOST_BLOWS as f64);
        return checker.fail(values::too_many("blows", found, most, span, "take fewer levels"));
    }
    let known: Vec<f64> = levels.iter().filter_map(Formula::constant).collect();
    if known.windows(2).any(|pair| pair[1] <= pair[0]) {
        checker.faults.push(fault::levels_do_not_rise(field, span));
    }
    let root = |twice: f64, of: Formula| {
        let product = Formula::Binary(Operator::Multiply, Box::new(Formula::Constant(twice)), Box::new(of));
        let root = Formula::Call(Function::Sqrt, vec![product]);
        root.constant().map_or(root, Formula::Constant)
    };
    Some(match field {
        "speeds" => levels,
        "drop_heights" => levels.into_iter().map(|height| root(2.0 * STANDARD_GRAVITY, height)).collect(),
        _ => {
            let hammer = checker.reference(block, "striker", Kind::Striker)?;
            let mass = checker.constant(hammer, "mass")?;
            levels.into_iter().map(|energy| root(2.0 / mass, energy)).collect()
        }
    })
}

/// `while`: conditions on the results of a blow, by their own names.
fn condition(checker: &mut Checker, block: usize) -> Option<Vec<Condition>> {
    let own = checker.scope.blocks[block].procedure?;
    let (entry, written) = checker.given(block, "while")?;
    let place = Place { entry: Some((block, entry)), reads: Reads::Blow(own), critical: false };
    let conditions = checker.conditions_at(&written.value, place)?;
    let mut references = Vec::new();
    for condition in &conditions {
        condition.collect_references(&mut references);
    }
    if !references.iter().any(|reference| reference.procedure == own) {
        let text = checker.text(written.value.span);
        return checker.fail(fault::condition_without_blow(text, written.value.span));
    }
    Some(conditions)
}
