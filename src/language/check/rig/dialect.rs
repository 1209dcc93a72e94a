//! The protocol of a device: `native`, `scpi(1 N)`, `modbus(…)`. In: the chosen variant. Out: a [`Dialect`].

use super::line_text::line_text;
use crate::language::check::checker::{Checker, Context};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::{names, rigs, values};
use crate::plan::{Dialect, ModbusMap, ModbusNumber};

pub fn dialect<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<Dialect> {
    Some(match chosen.variant.name {
        "scpi" => {
            let newtons_per_unit = checker.list_argument(chosen, "newtons_per_unit", context)?;
            for newtons in &newtons_per_unit {
                not_zero(checker, chosen, "newtons_per_unit", *newtons)?;
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
    let text = line_text(checker, chosen, "control_point")??;
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    let is_name =
        |name: &String| !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
    let twice = names
        .iter()
        .enumerate()
        .any(|(at, name)| names[..at].contains(name));
    match chosen.span("control_point") {
        Some(span) if twice || !names.iter().all(is_name) => {
            checker.fail(rigs::bad_line_text("control_point", span))
        }
        _ => Some(names),
    }
}

fn not_zero(checker: &mut Checker, chosen: &Chosen, name: &str, value: f64) -> Option<()> {
    match chosen.span(name) {
        Some(span) if value == 0.0 => checker.fail(values::zero(name, span)),
        _ => Some(()),
    }
}

/// Arguments that require one another: a register, and the register or scale without which its number has no meaning or effect.
const TOGETHER: &[(&str, &str)] = &[
    ("force", "force_unit"),
    ("position", "length_unit"),
    ("target", "position"),
    ("target", "length_unit"),
    ("speed", "speed_unit"),
    ("status", "moving_mask"),
    ("command", "start_word"),
    ("command", "stop_word"),
];

fn modbus<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<ModbusMap> {
    let number = checker
        .chosen_argument(chosen, "number")
        .and_then(|number| modbus_number(checker, &number));
    let unit = checker
        .constant_argument(chosen, "unit", context)
        .and_then(crate::language::check::expressions::fields::whole);
    let mut register = |name: &str| -> Option<Option<u16>> {
        let value = checker.optional_argument(chosen, name, context)?;
        Some(
            value
                .and_then(crate::language::check::expressions::fields::whole)
                .and_then(|value| u16::try_from(value).ok()),
        )
    };
    let (target, speed, position) = (register("target"), register("speed"), register("position"));
    let (force, status, moving_mask) = (
        register("force"),
        register("status"),
        register("moving_mask"),
    );
    let (command, start_word, stop_word) = (
        register("command"),
        register("start_word"),
        register("stop_word"),
    );
    let length_unit = checker.optional_argument(chosen, "length_unit", context);
    let speed_unit = checker.optional_argument(chosen, "speed_unit", context);
    let force_unit = checker.optional_argument(chosen, "force_unit", context);
    let lacking = TOGETHER
        .iter()
        .find(|(one, other)| chosen.span(one).is_some() && chosen.span(other).is_none());
    if let Some((one, other)) = lacking
        && let Some(span) = chosen.span(one)
    {
        return checker.fail(names::argument_needs(chosen.variant.name, one, other, span));
    }
    if let Some(force_unit) = force_unit? {
        not_zero(checker, chosen, "force_unit", force_unit)?;
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
    let high_word_first =
        checker.chosen_argument(chosen, "order")?.variant.name == "high_word_first";
    Some(match chosen.variant.name {
        "int32" => ModbusNumber::Int32 { high_word_first },
        _ => ModbusNumber::Float32 { high_word_first },
    })
}
