//! `require "rarely too far" scatter.probability(fails: "stays in travel") < 2 %`: requirements that a study decides. In: those
//! requirements of the plan, and its studies. Out: [`StudyRequirement`]s, and whether the runs can show their limits at all.

use super::{known, spaced};
use crate::check::checker::{Checker, Context, Reads};
use crate::check::messages::{names, studies as message, types};
use crate::check::scope::Meaning;
use crate::syntax::ast::{BinaryOperator, Expr, ExprKind};
use psd_physics::study::Confidence;
use psd_physics::study::probability::clopper_pearson::fewest_clean_runs;
use psd_plan::Comparison;
use psd_plan::schema::study as schema;
use psd_plan::schema::{Field, Kind};
use psd_plan::study::{Runs, Study, StudyEvent, StudyRequirement};
use psd_text::source::Span;
use psd_text::units::Dimension;

const LIMIT: Context = Context {
    entry: None,
    reads: Reads::Nothing("a limit of a probability"),
    critical: false,
};

/// Every requirement on a probability; None if one has an error. `studies`: None for each with an error.
pub(super) fn requirements(
    checker: &mut Checker,
    studies: &[Option<Study>],
) -> Option<Vec<StudyRequirement>> {
    let read: Vec<Option<StudyRequirement>> = (0..checker.scope.study_requirements.len())
        .map(|index| requirement(checker, index, studies))
        .collect();
    let requirements: Vec<StudyRequirement> = read.into_iter().collect::<Option<_>>()?;
    for (index, study) in studies.iter().enumerate() {
        let Some(study) = study else { continue };
        let own = requirements.iter().any(|one| one.study == index);
        rule_ends(checker, index, study, own);
    }
    Some(requirements)
}

/// Whether the rule of a study has a requirement that can end it.
fn rule_ends(checker: &mut Checker, index: usize, study: &Study, own: bool) {
    let any = match study.runs {
        Runs::Fixed(_) | Runs::Rare(_) => return,
        Runs::Decided { .. } => own,
        Runs::HalfWidth { .. } => !checker.scope.requirements.is_empty(),
    };
    let block = checker.scope.of_kind(Kind::Study).nth(index);
    let until = block.and_then(|(block, _)| checker.field(block, schema::UNTIL.name));
    if let Some((_, entry)) = until.filter(|_| !any) {
        let span = entry.value.span;
        let rule = checker.text(span).split('(').next().unwrap_or_default();
        let half_width = matches!(study.runs, Runs::HalfWidth { .. });
        checker.diagnostics.push(message::nothing_to_decide(
            rule,
            &study.name,
            half_width,
            span,
        ));
    }
}

fn requirement(
    checker: &mut Checker,
    index: usize,
    studies: &[Option<Study>],
) -> Option<StudyRequirement> {
    let declared = &checker.scope.study_requirements[index];
    let (label, condition) = (&declared.label.node, declared.condition);
    let (probability, comparison, limit) = compared(checker, condition)?;
    let event = event(checker, probability);
    let written = limit.span;
    // The dimension of another member's limit is not known.
    let named = matches!(&probability.kind, ExprKind::Member { name, .. } if name.node == schema::PROBABILITY.name);
    if !named {
        return None;
    }
    let limit = checker.single(limit, LIMIT).and_then(|typed| {
        checker.expect(typed, Dimension::NUMBER, schema::PROBABILITY.name, limit)
    });
    let limit = limit?;
    let limit = known(checker, limit.constant(), written)?;
    if !(limit > 0.0 && limit < 1.0) {
        let text = checker.text(written);
        return checker.fail(message::impossible_limit(limit, text, written));
    }
    let (study, event) = event?;
    if let Some(Some(of)) = studies.get(study) {
        warn_of_few_runs(checker, study, of, comparison, limit, written);
    }
    Some(StudyRequirement {
        label: label.clone(),
        text: spaced(checker.text(condition.span)),
        study,
        event,
        comparison,
        limit,
    })
}

/// The probability, how it is compared, and its limit: `2 % > p` is `p < 2 %`.
fn compared<'a>(
    checker: &mut Checker<'a>,
    condition: &'a Expr,
) -> Option<(&'a Expr, Comparison, &'a Expr)> {
    match &condition.kind {
        ExprKind::Parenthesised(inner) => return compared(checker, inner),
        ExprKind::Binary {
            operator,
            left,
            right,
        } => {
            let comparison = match operator.node {
                BinaryOperator::Less => Some((Comparison::Less, Comparison::Greater)),
                BinaryOperator::LessEqual => {
                    Some((Comparison::LessEqual, Comparison::GreaterEqual))
                }
                BinaryOperator::Greater => Some((Comparison::Greater, Comparison::Less)),
                BinaryOperator::GreaterEqual => {
                    Some((Comparison::GreaterEqual, Comparison::LessEqual))
                }
                _ => None,
            };
            if let Some((comparison, mirrored)) = comparison {
                let is_probability = |side: &Expr| matches!(side.kind, ExprKind::Member { .. });
                match (is_probability(left), is_probability(right)) {
                    (true, false) => return Some((left, comparison, right)),
                    (false, true) => return Some((right, mirrored, left)),
                    _ => {}
                }
                if !is_probability(left) {
                    return checker.fail(message::probability_misplaced(condition.span));
                }
            }
        }
        _ => {}
    }
    checker.fail(message::probability_compared(condition.span))
}

/// `scatter.probability(fails: "stays in travel")`: the study, and the event.
fn event<'a>(checker: &mut Checker<'a>, written: &'a Expr) -> Option<(usize, StudyEvent)> {
    let ExprKind::Member {
        base,
        name,
        arguments,
    } = &written.kind
    else {
        return None;
    };
    let ExprKind::Name(owner) = &base.kind else {
        return checker.fail(message::probability_misplaced(base.span));
    };
    let study = study(checker, owner, base.span)?;
    if name.node != schema::PROBABILITY.name {
        return checker.fail(message::no_such_member(owner, &name.node, name.span));
    }
    let chosen = checker.arguments_of(&schema::PROBABILITY, arguments, written.span)?;
    let mut label = |field: Field| {
        if let Some((_, Some(written))) = chosen.find(field.name)
            && let Some(required) = required(checker, field, written)
        {
            let span = written.span;
            return checker.fail(types::requirement_wanted(field.name, span, &required));
        }
        let (text, span) = checker.text_argument(&chosen, field.name)??;
        run_requirement(checker, &text, span).map(Some)
    };
    let given = |field: Field| chosen.span(field.name).is_some();
    match (given(schema::FAILS), given(schema::HOLDS)) {
        (true, false) => {
            let requirement = label(schema::FAILS)??;
            Some((study, StudyEvent::Fails { requirement }))
        }
        (false, true) => {
            let requirement = label(schema::HOLDS)??;
            Some((study, StudyEvent::Holds { requirement }))
        }
        _ => checker.fail(message::event_wanted(written.span)),
    }
}

/// The requirement that a comparison stands for which is written in place of its name: `hit.max_displacement <= 11 mm` for
/// `fails: hit.max_displacement > 11 mm`. None for anything else.
fn required(checker: &Checker, field: Field, written: &Expr) -> Option<String> {
    use BinaryOperator::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    let ExprKind::Binary {
        operator,
        left,
        right,
    } = &written.kind
    else {
        return None;
    };
    let opposite = match operator.node {
        Less => GreaterEqual,
        LessEqual => Greater,
        Greater => LessEqual,
        GreaterEqual => Less,
        Equal => NotEqual,
        NotEqual => Equal,
        _ => return None,
    };
    let holds = field.name == schema::HOLDS.name;
    let operator = if holds { operator.node } else { opposite };
    let (left, right) = (checker.text(left.span), checker.text(right.span));
    Some(format!("{left} {} {right}", operator.symbol()))
}

/// The study of this name, as an index.
fn study(checker: &mut Checker, owner: &str, span: Span) -> Option<usize> {
    match checker.scope.meaning(owner) {
        Some(Meaning::Block(block)) if checker.scope.blocks[block].kind.kind == Kind::Study => {
            Some(checker.scope.index_in_kind(block))
        }
        Some(Meaning::Poisoned) => None,
        None if checker.may_be_lost(owner) => None,
        _ => {
            let declared = checker.scope.of_kind(Kind::Study);
            let known: Vec<&str> = declared
                .filter_map(|(_, block)| block.name)
                .map(|name| name.node.as_str())
                .collect();
            checker.fail(names::unknown_block_name(Kind::Study, owner, span, &known))
        }
    }
}

/// The requirement of a run with this name, as an index.
fn run_requirement(checker: &mut Checker, label: &str, span: Span) -> Option<usize> {
    let scope = checker.scope;
    let known: Vec<&str> = scope
        .requirements
        .iter()
        .map(|one| one.label.node.as_str())
        .collect();
    if let Some(at) = known.iter().position(|known| *known == label) {
        return Some(at);
    }
    let mut others = scope.study_requirements.iter();
    if others.any(|one| one.label.node == label) {
        return checker.fail(message::requirement_of_a_study(label, span));
    }
    checker.fail(message::unknown_requirement(label, span, &known))
}

/// A limit so near to 0 or 1 that not even runs without an exception show it.
fn warn_of_few_runs(
    checker: &mut Checker,
    index: usize,
    study: &Study,
    comparison: Comparison,
    limit: f64,
    span: Span,
) {
    let away = match comparison {
        Comparison::Greater | Comparison::GreaterEqual => 1.0 - limit,
        _ => limit,
    };
    // The decision is by a two-sided interval, of which one end counts.
    let one_sided = Confidence::new(1.0 - 0.5 * study.confidence.error());
    let fewest = one_sided.map_or(0, |confidence| fewest_clean_runs(away, confidence));
    let most = study.runs.at_most();
    if most < fewest && !matches!(study.runs, Runs::Rare(_)) {
        let block = checker.scope.of_kind(Kind::Study).nth(index);
        let field = |name| {
            let (block, _) = block.as_ref()?;
            checker
                .field(*block, name)
                .map(|(_, entry)| entry.value.span)
        };
        let at = field(schema::RUNS.name).or_else(|| field(schema::UNTIL.name));
        checker
            .diagnostics
            .push(message::too_few_runs(most, span, fewest, at));
    }
}
