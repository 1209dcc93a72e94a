//! `plan "Title" { … }`: the title, the edition and the administrative data of the report.

use crate::check::checker::Checker;
use crate::check::expressions::calendar;
use crate::check::violations::{NeedsTheRun, NotADay};
use crate::codes::{E401, E408};
use crate::syntax::ast::ExprKind;
use psd_plan::DecisionRule;
use psd_plan::schema::{FieldType, Kind, plan_block as schema};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::unit::ICE_POINT;

/// The edition that this version reads.
const EDITION: f64 = 1.0;

/// Fields whose value must be a day of the calendar.
const DAYS: [&str; 2] = [schema::DATE.name, schema::ISSUED.name];

#[derive(Violation)]
#[violation(E408, "this version reads edition 1 of the language, not {text}")]
#[help("write `edition = 1`, or use the version of psd for which the plan was written")]
struct UnknownEdition<'a> {
    #[label("unknown edition")]
    span: Span,
    text: &'a str,
}

/// Title, if given, and the administrative data in the schema's order.
pub fn plan_block(
    checker: &mut Checker,
    date: Option<&str>,
) -> (Option<String>, Vec<(&'static str, String)>) {
    let block = checker
        .scope
        .of_kind(Kind::Plan)
        .map(|(index, _)| index)
        .next();
    let mut particulars = Vec::new();
    for field in psd_plan::schema::block(Kind::Plan).fields {
        let given = block.and_then(|block| match field.ty {
            FieldType::Text if field.name == schema::TEMPERATURE.name => {
                temperature(checker, block)
            }
            FieldType::Text => checker.text_field(block, field.name),
            FieldType::Choice(_) => checker
                .choice(block, field.name)
                .map(|chosen| chosen.variant.name.to_owned()),
            _ => None,
        });
        if let (true, Some(day), Some(block)) = (DAYS.contains(&field.name), &given, block)
            && !calendar::is_day(day)
            && let Some((_, written)) = checker.field(block, field.name)
        {
            checker.report(NotADay {
                day,
                span: written.value.span,
            });
        }
        let text = if field.name == schema::DATE.name {
            date.map(str::to_owned).or(given)
        } else {
            given
        };
        particulars.extend(text.map(|text| (field.name, text)));
    }
    let Some(block) = block else {
        return (None, particulars);
    };
    if let (Some(edition), Some((_, written))) = (
        checker.constant(block, schema::EDITION.name),
        checker.field(block, schema::EDITION.name),
    ) && edition != EDITION
    {
        checker.report(UnknownEdition {
            span: written.value.span,
            text: checker.text(written.value.span),
        });
    }
    let title = checker.scope.blocks[block]
        .block
        .title
        .as_ref()
        .map(|title| title.node.clone());
    (title, particulars)
}

/// The temperature during the test as the report prints it: a string of the plan, or a number in degrees Celsius.
fn temperature(checker: &mut Checker, block: usize) -> Option<String> {
    let name = schema::TEMPERATURE.name;
    let (entry, written) = checker.field(block, name)?;
    if let ExprKind::Text(text) = &written.value.kind {
        return Some(text.clone());
    }
    let context = checker.context_of(block, entry);
    let typed = checker.single(&written.value, context)?;
    let typed = checker.expect(typed, Dimension::TEMPERATURE, name, &written.value)?;
    let Some(kelvin) = typed.constant() else {
        return checker.fail(NeedsTheRun {
            span: written.value.span,
            text: checker.text(written.value.span),
        });
    };
    if kelvin < 0.0 {
        return checker.fail(BelowAbsoluteZero {
            span: written.value.span,
        });
    }
    Some(format!("{} °C", ((kelvin - ICE_POINT) * 1e6).round() / 1e6))
}

#[derive(Violation)]
#[violation(E401, "`temperature` must be at least 0 K, which is -273.15 degC")]
#[help("write the temperature during the test, as in `23 degC`")]
struct BelowAbsoluteZero {
    #[label("too small")]
    span: Span,
}

/// The decision rule that the block names; simple acceptance if it names none.
pub fn decision_rule(particulars: &[(&'static str, String)]) -> DecisionRule {
    let named = particulars
        .iter()
        .find(|(field, _)| *field == schema::DECISION_RULE.name)
        .map(|(_, word)| word.as_str());
    if named == Some(DecisionRule::Guarded.name()) {
        DecisionRule::Guarded
    } else {
        DecisionRule::Simple
    }
}
