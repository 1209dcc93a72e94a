//! The protocol of a device: `native`, `scpi(1 N)`, `modbus(…)`. In: the chosen variant. Out: a [`Dialect`].

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{BadLineText, ZeroFactor};
use crate::codes::E213;
use psd_plan::schema::devices as schema;
use psd_plan::{Dialect, ModbusMap, ModbusNumber};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::line_text::line_text;

pub fn dialect<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<Dialect> {
    Some(match chosen.variant.name {
        "scpi" => {
            let newtons_per_unit =
                checker.list_argument(chosen, schema::NEWTONS_PER_UNIT.name, context)?;
            for newtons in &newtons_per_unit {
                not_zero(checker, chosen, schema::NEWTONS_PER_UNIT.name, *newtons)?;
            }
            Dialect::Scpi { newtons_per_unit }
        }
        "modbus" => Dialect::Modbus(modbus(checker, chosen, context)?),
        "nees" => Dialect::Nees {
            control_points: control_points(checker, chosen)?,
        },
        name => Dialect::without_arguments(name)?,
    })
}

/// Names separated by commas, each once: a reply refers to them by name.
fn control_points<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>) -> Option<Vec<String>> {
    let text = line_text(checker, chosen, schema::CONTROL_POINT.name)??;
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    let is_name =
        |name: &String| !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
    let twice = names
        .iter()
        .enumerate()
        .any(|(at, name)| names[..at].contains(name));
    match chosen.span(schema::CONTROL_POINT.name) {
        Some(span) if twice || !names.iter().all(is_name) => checker.fail(BadLineText {
            field: schema::CONTROL_POINT.name,
            span,
        }),
        _ => Some(names),
    }
}

fn not_zero(checker: &mut Checker, chosen: &Chosen, name: &str, value: f64) -> Option<()> {
    match chosen.span(name) {
        Some(span) if value == 0.0 => checker.fail(ZeroFactor { field: name, span }),
        _ => Some(()),
    }
}

/// Arguments that require one another: a register, and the register or scale without which its number has no meaning or effect.
const TOGETHER: &[(&str, &str)] = &[
    (schema::FORCE.name, schema::FORCE_UNIT.name),
    (schema::POSITION.name, schema::LENGTH_UNIT.name),
    (schema::TARGET.name, schema::POSITION.name),
    (schema::TARGET.name, schema::LENGTH_UNIT.name),
    (schema::SPEED.name, schema::SPEED_UNIT.name),
    (schema::STATUS.name, schema::MOVING_MASK.name),
    (schema::COMMAND.name, schema::START_WORD.name),
    (schema::COMMAND.name, schema::STOP_WORD.name),
];

#[derive(Violation)]
#[violation(E213, "`{argument}` of `{variant}` requires `{other}`")]
#[help("add `{other}: …`, or remove `{argument}`")]
struct ArgumentNeeds<'a> {
    variant: &'a str,
    argument: &'a str,
    other: &'a str,
    #[label("`{other}` is missing")]
    span: Span,
}

fn modbus<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<ModbusMap> {
    let number = checker
        .chosen_argument(chosen, schema::NUMBER.name)
        .and_then(|number| modbus_number(checker, &number));
    let unit = checker
        .constant_argument(chosen, schema::UNIT.name, context)
        .and_then(crate::check::expressions::fields::whole);
    let mut register = |name: &str| -> Option<Option<u16>> {
        let value = checker.optional_argument(chosen, name, context)?;
        Some(
            value
                .and_then(crate::check::expressions::fields::whole)
                .and_then(|value| u16::try_from(value).ok()),
        )
    };
    let (target, speed, position) = (
        register(schema::TARGET.name),
        register(schema::SPEED.name),
        register(schema::POSITION.name),
    );
    let (force, status, moving_mask) = (
        register(schema::FORCE.name),
        register(schema::STATUS.name),
        register(schema::MOVING_MASK.name),
    );
    let (command, start_word, stop_word) = (
        register(schema::COMMAND.name),
        register(schema::START_WORD.name),
        register(schema::STOP_WORD.name),
    );
    let length_unit = checker.optional_argument(chosen, schema::LENGTH_UNIT.name, context);
    let speed_unit = checker.optional_argument(chosen, schema::SPEED_UNIT.name, context);
    let force_unit = checker.optional_argument(chosen, schema::FORCE_UNIT.name, context);
    let missing = TOGETHER
        .iter()
        .find(|(one, other)| chosen.span(one).is_some() && chosen.span(other).is_none());
    if let Some((one, other)) = missing
        && let Some(span) = chosen.span(one)
    {
        return checker.fail(ArgumentNeeds {
            variant: chosen.variant.name,
            argument: one,
            other,
            span,
        });
    }
    if let Some(force_unit) = force_unit? {
        not_zero(checker, chosen, schema::FORCE_UNIT.name, force_unit)?;
    }
    Some(ModbusMap {
        unit: u8::try_from(unit?).ok()?,
        number: number?,
        target: target?,
        speed: speed?,
        position: position?,
        force: force?,
        status: status?,
        moving_mask: moving_mask?.unwrap_or(0),
        command: command?,
        start_word: start_word?.unwrap_or(0),
        stop_word: stop_word?.unwrap_or(0),
        length_unit: length_unit?.unwrap_or(1.0),
        speed_unit: speed_unit?.unwrap_or(1.0),
        force_unit: force_unit?.unwrap_or(1.0),
    })
}

fn modbus_number<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>) -> Option<ModbusNumber> {
    if chosen.variant.name == "int16" {
        return Some(ModbusNumber::Int16);
    }
    let high_word_first = checker
        .chosen_argument(chosen, schema::WORD_ORDER.name)?
        .variant
        .name
        == "high_word_first";
    Some(match chosen.variant.name {
        "int32" => ModbusNumber::Int32 { high_word_first },
        _ => ModbusNumber::Float32 { high_word_first },
    })
}
