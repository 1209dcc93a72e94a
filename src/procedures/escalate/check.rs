//! `escalate NAME { … }`: the fields of an impact, its levels, and the condition for the next impact.

use crate::codes::{E648, W721};
use crate::procedures::common::violations::TooManyInProcedure;
use crate::procedures::impact;
use psd_language::check::checker::{Checker, Context, Reads};
use psd_language::check::violations::MissingField;
use psd_language::codes::E208;
use psd_plan::formula::{Formula, Function, Operator};
use psd_plan::procedures::escalate::block as schema;
use psd_plan::procedures::impact::block::STRIKER;
use psd_plan::schema::{Kind, striker};
use psd_plan::{Between, Condition, Escalate, MOST_IMPACTS, ProcedureKind};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::unit::STANDARD_GRAVITY;

/// The fields that give the levels; exactly one of them is given.
const LEVELS: [&str; 3] = [
    schema::SPEEDS.name,
    schema::DROP_HEIGHTS.name,
    schema::ENERGIES.name,
];

pub fn escalate(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let own = checker.scope.blocks[block].procedure?;
    let levels = levels(checker, block);
    let condition = condition(checker, block);
    let between = checker.word(block, schema::BETWEEN.name, "unload");
    let inspect_between = checker
        .word(block, schema::INSPECT_BETWEEN.name, "false")
        .map(|word| word == "true");
    let impact = impact::check::fields(checker, block);
    let (velocities, energies) = levels?;
    Some(ProcedureKind::Escalate(Escalate {
        own,
        impact: impact?,
        velocities,
        energies,
        condition: condition?,
        between: match between? {
            "home" => Between::Home,
            "stay" => Between::Stay,
            _ => Between::Unload,
        },
        inspect_between: inspect_between?,
    }))
}

#[derive(Violation)]
#[violation(E208, "impacts given twice: by `{first_field}` and by `{again}`")]
#[help("remove one of them")]
struct LevelsTwice<'a> {
    again: &'a str,
    #[label("given again")]
    span: Span,
    first_field: &'a str,
    #[label("first given here")]
    first: Span,
}

#[derive(Violation)]
#[violation(W721, "`{field}` do not increase from impact to impact")]
#[help("sort them, so that the first failure has the lowest energy")]
struct LevelsDoNotRise<'a> {
    field: &'a str,
    #[label("not in increasing order")]
    span: Span,
}

/// The velocity of the striker in each impact: v, √(2·gn·h) or √(2E/Ms), and its energy where the plan gives energies.
fn levels(checker: &mut Checker, block: usize) -> Option<(Vec<Formula>, Option<Vec<Formula>>)> {
    let declared = &checker.scope.blocks[block];
    let (kind, name, head) = (declared.kind, declared.name, declared.block.head);
    let given: Vec<(&str, Span, Span)> = LEVELS
        .into_iter()
        .filter_map(|field| {
            checker
                .field(block, field)
                .map(|(_, entry)| (field, entry.key.span, entry.value.span))
        })
        .collect();
    let (field, span) = match given.as_slice() {
        [(field, _, span)] => (*field, *span),
        [] => {
            if !checker.misspelt(block, &LEVELS) {
                checker.report(MissingField {
                    kind,
                    name,
                    head,
                    field: schema::SPEEDS.name,
                    example: "speeds = [0.5, 1, 1.5] m/s",
                });
            }
            return None;
        }
        [(first, at, _), rest @ ..] => {
            for (again, span, _) in rest {
                checker.report(LevelsTwice {
                    again,
                    span: *span,
                    first_field: first,
                    first: *at,
                });
            }
            return None;
        }
    };
    let levels = checker.quantities(block, field)?;
    if levels.len() > MOST_IMPACTS {
        #[expect(
            clippy::cast_precision_loss,
            reason = "a list has at most 100,000 entries"
        )]
        let (found, most) = (levels.len() as f64, MOST_IMPACTS as f64);
        return checker.fail(TooManyInProcedure {
            what: "impacts",
            found,
            most,
            span,
            help: "write fewer levels",
        });
    }
    let known: Vec<f64> = levels.iter().filter_map(Formula::constant).collect();
    if known.windows(2).any(|pair| pair[1] <= pair[0]) {
        checker.report(LevelsDoNotRise { field, span });
    }
    let root = |twice: f64, of: Formula| {
        let product = Formula::Binary(
            Operator::Multiply,
            Box::new(Formula::Constant(twice)),
            Box::new(of),
        );
        let root = Formula::Call(Function::Sqrt, vec![product]);
        root.constant().map_or(root, Formula::Constant)
    };
    Some(match field {
        _ if field == schema::SPEEDS.name => (levels, None),
        _ if field == schema::DROP_HEIGHTS.name => (
            levels
                .into_iter()
                .map(|height| root(2.0 * STANDARD_GRAVITY, height))
                .collect(),
            None,
        ),
        _ => {
            let hammer = checker.reference(block, STRIKER.name, Kind::Striker)?;
            let mass = checker.constant(hammer, striker::MASS.name)?;
            (
                levels
                    .iter()
                    .cloned()
                    .map(|energy| root(2.0 / mass, energy))
                    .collect(),
                Some(levels),
            )
        }
    })
}

#[derive(Violation)]
#[violation(
    E648,
    "`{text}` reads no result of an impact: it is the same after every one"
)]
#[help("name a result of the impact, such as `max_displacement < 20 mm`")]
struct ConditionWithoutResult<'a> {
    text: &'a str,
    #[label("constant condition")]
    span: Span,
}

/// `while`: conditions on the results of an impact, by their own names.
fn condition(checker: &mut Checker, block: usize) -> Option<Vec<Condition>> {
    let own = checker.scope.blocks[block].procedure?;
    let (entry, written) = checker.field(block, schema::WHILE.name)?;
    let context = Context {
        entry: Some((block, entry)),
        reads: Reads::Impact(own),
        critical: false,
    };
    let conditions = checker.conditions_at(&written.value, context)?;
    let mut references = Vec::new();
    for condition in &conditions {
        condition.collect_references(&mut references);
    }
    if !references
        .iter()
        .any(|reference| reference.procedure == own)
    {
        let text = checker.text(written.value.span);
        return checker.fail(ConditionWithoutResult {
            text,
            span: written.value.span,
        });
    }
    Some(conditions)
}
