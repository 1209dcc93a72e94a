//! `cycle NAME { … }`: amplitudes, or a protocol that gives them.

use crate::codes::{E646, E647};
use crate::procedures::common::violations::TooManyInProcedure;
use crate::procedures::stepping::check::mode_check::beside_no_axial_axis;
use psd_language::check::checker::{Checker, Context};
use psd_language::check::declarations::curve;
use psd_language::check::expressions::fields::whole;
use psd_language::check::violations::{MissingField, NoEffect};
use psd_language::codes::E208;
use psd_plan::formula::{Formula, Operator};
use psd_plan::procedures::cycle::block as schema;
use psd_plan::schema::procedures::SPEED;
use psd_plan::{BreakCount, Cycle, CycleInspection, Level, MOST_TARGETS, ProcedureKind, Sides};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

#[derive(Violation)]
#[violation(E646, "`rate` requires `speed`: the actuator is read while it moves")]
#[help("add a line such as `speed = 1 mm/s`, or remove `rate` for ramp-and-hold")]
struct RateWithoutSpeed {
    #[label("readings during motion")]
    rate: Span,
    #[label("`speed` is missing")]
    head: Span,
}

#[derive(Violation)]
#[violation(
    E647,
    "`{field}` has no effect with `rate`: the actuator does not stop between the ends"
)]
#[help("remove `{field}` or `rate`")]
struct NoUseWithRate<'a> {
    field: &'a str,
    #[label("for ramp-and-hold only")]
    span: Span,
    #[label("motion without stops")]
    rate: Span,
}

pub fn cycle(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let head = checker.scope.blocks[block].block.head;
    let specimen = checker.specimen_of(block);
    let levels = levels(checker, block);
    let sides = checker.word(block, schema::SIDES.name, "both");
    let about = checker.quantity(block, schema::ABOUT.name);
    let points = checker.count(block, schema::POINTS.name);
    let samples = checker.count(block, schema::SAMPLES.name);
    let pause = checker.quantity(block, schema::PAUSE.name);
    let (speed, rate) = (
        checker.optional(block, SPEED.name),
        checker.optional(block, schema::RATE.name),
    );
    if let Some((_, rate)) = checker.field(block, schema::RATE.name) {
        beside_no_axial_axis(checker, rate.span);
        if checker.field(block, SPEED.name).is_none() && !checker.misspelt(block, &[SPEED.name]) {
            checker.report(RateWithoutSpeed {
                rate: rate.span,
                head,
            });
        }
        for field in [schema::POINTS.name, schema::SAMPLES.name] {
            if let Some((_, entry)) = checker.field(block, field) {
                checker.report(NoUseWithRate {
                    field,
                    span: entry.span,
                    rate: rate.span,
                });
            }
        }
    }
    let inspect = inspections(checker, block);
    let fit = fit(checker, block);
    let cycle = Cycle {
        specimen: specimen?,
        levels: levels?,
        sides: match sides? {
            "push" => Sides::Push,
            "pull" => Sides::Pull,
            _ => Sides::Both,
        },
        about: about?,
        points: points?,
        samples: samples?,
        pause: pause?,
        speed: speed?,
        rate: rate?,
        inspect: inspect?,
        fit: fit?,
    };
    #[expect(
        clippy::cast_precision_loss,
        reason = "a count far below 2^53, or far above the bound"
    )]
    let readings = cycle.targets() as f64 * f64::from(cycle.samples);
    if readings > MOST_TARGETS {
        let help = "write fewer `repeats`, `points` or `samples`";
        return checker.fail(TooManyInProcedure {
            what: "readings",
            found: readings,
            most: MOST_TARGETS,
            span: head,
            help,
        });
    }
    Some(ProcedureKind::Cycle(cycle))
}

/// The curve of the backbone; None if an error was reported.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn fit(checker: &mut Checker, block: usize) -> Option<Option<BreakCount>> {
    let Some((entry, _)) = checker.field(block, schema::FIT.name) else {
        return Some(None);
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choice(block, schema::FIT.name)?;
    curve::breaks(checker, &chosen, context).map(Some)
}

#[derive(Violation)]
#[violation(E208, "amplitudes given twice: by `amplitudes` and by `protocol`")]
#[help("remove one of them")]
struct AmplitudesTwice {
    #[label("given again")]
    span: Span,
    #[label("first given here")]
    first: Span,
}

/// The amplitudes in order, each with its number of cycles; None if an error was reported.
fn levels(checker: &mut Checker, block: usize) -> Option<Vec<Level>> {
    let declared = &checker.scope.blocks[block];
    let repeats = match checker.field(block, schema::REPEATS.name) {
        Some(_) => Some(checker.count(block, schema::REPEATS.name)?),
        None => None,
    };
    match (
        checker.field(block, schema::GIVEN_AMPLITUDES.name),
        checker.field(block, schema::PROTOCOL.name),
    ) {
        (Some((_, amplitudes)), Some((_, protocol))) => checker.fail(AmplitudesTwice {
            span: protocol.key.span,
            first: amplitudes.key.span,
        }),
        (None, None)
            if checker.misspelt(
                block,
                &[schema::GIVEN_AMPLITUDES.name, schema::PROTOCOL.name],
            ) =>
        {
            None
        }
        (None, None) => {
            let example = "amplitudes = [1, 2, 5] mm";
            checker.fail(MissingField {
                kind: declared.kind,
                name: declared.name,
                head: declared.block.head,
                field: schema::GIVEN_AMPLITUDES.name,
                example,
            })
        }
        (Some(_), None) => {
            let cycles = repeats.unwrap_or(1);
            let amplitudes = checker.quantities(block, schema::GIVEN_AMPLITUDES.name)?;
            Some(
                amplitudes
                    .into_iter()
                    .map(|amplitude| Level { amplitude, cycles })
                    .collect(),
            )
        }
        (None, Some((entry, _))) => {
            let context = checker.context_of(block, entry);
            let (amplitudes, own) = protocol(checker, block, context)?;
            let cycles = repeats.unwrap_or(own);
            Some(
                amplitudes
                    .into_iter()
                    .map(|amplitude| Level { amplitude, cycles })
                    .collect(),
            )
        }
    }
}

/// The ratio of one amplitude to the one before in protocols like that of FEMA 461 (2007).
const FEMA_RATIO: f64 = 1.4;
/// Number of cycles at each amplitude of such a protocol.
const FEMA_CYCLES: u32 = 2;

/// The amplitudes of a protocol, and the number of cycles at each.
fn protocol(checker: &mut Checker, block: usize, context: Context) -> Option<(Vec<Formula>, u32)> {
    let chosen = checker.choice(block, schema::PROTOCOL.name)?;
    let levels = checker
        .constant_argument(&chosen, schema::LEVELS.name, context)
        .and_then(whole)?;
    let times = |factor: f64, of: &Formula| product(Formula::Constant(factor), of.clone());
    Some(match chosen.variant.name {
        "ramped" => {
            let (first, last) = (
                checker.argument(&chosen, schema::FIRST.name, context)?,
                checker.argument(&chosen, schema::LAST.name, context)?,
            );
            if let (1, Some(span)) = (levels, chosen.span(schema::LAST.name)) {
                let message = "a ramp of one level has its first amplitude alone".to_owned();
                checker.report(NoEffect {
                    message,
                    span,
                    label: "never reached",
                    help: "write `levels` of 2 or more",
                });
            }
            let amplitude = |level: u32| {
                // The ends are the stated values, without rounding.
                match (level, levels - 1) {
                    (0, _) => first.clone(),
                    (level, steps) if level == steps => last.clone(),
                    (level, steps) => {
                        let share = f64::from(level) / f64::from(steps);
                        Formula::Binary(
                            Operator::Add,
                            Box::new(times(1.0 - share, &first)),
                            Box::new(times(share, &last)),
                        )
                    }
                }
            };
            ((0..levels).map(amplitude).collect(), 1)
        }
        "geometric" => {
            let (first, ratio) = (
                checker.argument(&chosen, schema::FIRST.name, context)?,
                checker.argument(&chosen, schema::RATIO.name, context)?,
            );
            let amplitude = |level: u32| {
                let power = Formula::Constant(f64::from(level));
                product(
                    Formula::Binary(Operator::Power, Box::new(ratio.clone()), Box::new(power)),
                    first.clone(),
                )
            };
            ((0..levels).map(amplitude).collect(), 1)
        }
        _ => {
            let largest = checker.argument(&chosen, schema::LARGEST.name, context)?;
            let amplitude =
                |level: u32| times(FEMA_RATIO.powf(-f64::from(levels - 1 - level)), &largest);
            ((0..levels).map(amplitude).collect(), FEMA_CYCLES)
        }
    })
}

fn product(one: Formula, other: Formula) -> Formula {
    let formula = Formula::Binary(Operator::Multiply, Box::new(one), Box::new(other));
    formula.constant().map_or(formula, Formula::Constant)
}

fn inspections(checker: &mut Checker, block: usize) -> Option<Vec<CycleInspection>> {
    let Some((entry, _)) = checker.field(block, schema::INSPECT.name) else {
        return Some(Vec::new());
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choices(block, schema::INSPECT.name)?;
    let each = chosen.iter().map(|chosen| {
        Some(match chosen.variant.name {
            "every" => CycleInspection::Every(
                checker
                    .constant_argument(chosen, schema::AMPLITUDES_BETWEEN.name, context)
                    .and_then(whole)?,
            ),
            _ => CycleInspection::ForceDrop(checker.constant_argument(
                chosen,
                schema::FRACTION.name,
                context,
            )?),
        })
    });
    let each: Vec<Option<CycleInspection>> = each.collect();
    each.into_iter().collect()
}
