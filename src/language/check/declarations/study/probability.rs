//! `require "rarely too far" scatter.probability(fails: "stays in travel") < 2 %`: requirements that a study decides. In: those
//! requirements of the plan, and its studies. Out: [`StudyRequirement`]s, and whether the runs can show their limits at all.

use crate::check::checker::{Checker, Context, Reads};
use crate::check::scope::Meaning;
use crate::check::violations::{EventWanted, ProbabilityMisplaced, UnknownBlockName};
use crate::codes::{E203, E206, E304, E401, E663, E664, W731};
use crate::syntax::ast::{BinaryOperator, Expr, ExprKind};
use psd_physics::study::Confidence;
use psd_physics::study::probability::clopper_pearson::fewest_clean_runs;
use psd_plan::Comparison;
use psd_plan::schema::{Field, Kind, study as schema};
use psd_plan::study::{Runs, Study, StudyEvent, StudyRequirement};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::{known, spaced};

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

/// `until` without a requirement that could end the study. `rule`: its word.
struct NothingToDecide<'a> {
    rule: &'a str,
    study: &'a str,
    any: bool,
    span: Span,
}

impl Violation for NothingToDecide<'_> {
    const CODE: Code = E664;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            rule,
            study,
            any,
            span,
        } = self;
        let (message, help) = if any {
            (
                "the plan has no requirement whose probability could end this study",
                "add a requirement on the results of a run, or write `runs = 10000`".to_owned(),
            )
        } else {
            (
                "no requirement is about a probability of this study",
                format!(
                    "add one, such as `require \"rarely fails\" {study}.probability(fails: \"…\") < 2 %`, or write `runs = 10000`"
                ),
            )
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, format!("`{rule}` never ends it"))
            .help(help)
    }
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
        checker.report(NothingToDecide {
            rule,
            study: &study.name,
            any: half_width,
            span,
        });
    }
}

#[derive(Violation)]
#[violation(
    E401,
    "a limit of a probability is between 0 and 1, both excluded, here {value}"
)]
#[help("write a limit such as `2 %`")]
struct ImpossibleProbability<'a> {
    value: f64,
    text: &'a str,
    #[label("`{text}` is always or never met")]
    span: Span,
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
        return checker.fail(ImpossibleProbability {
            value: limit,
            text,
            span: written,
        });
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

/// `and`, `==`, `within`, two probabilities.
#[derive(Violation)]
#[violation(E663, "a probability is compared with one limit")]
#[help("write `<`, `<=`, `>` or `>=` and a limit such as `2 %`; write one `require` for each")]
struct ProbabilityCompared {
    #[label("not such a comparison")]
    span: Span,
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
                    return checker.fail(ProbabilityMisplaced {
                        span: condition.span,
                    });
                }
            }
        }
        _ => {}
    }
    checker.fail(ProbabilityCompared {
        span: condition.span,
    })
}

#[derive(Violation)]
#[violation(E206, "study `{study}` has no `{member}`")]
#[help("write `probability(fails: \"…\")`, with the name of a requirement")]
struct NoSuchStudyMember<'a> {
    study: &'a str,
    member: &'a str,
    #[label("unknown")]
    span: Span,
}

/// A condition in place of the name of a requirement. `required`: the requirement that it stands for.
#[derive(Violation)]
#[violation(E304, "`{field}` requires the name of a requirement")]
#[help("add `require \"stays within\" {required}`, then write `{field}: \"stays within\"`")]
struct RequirementWanted<'a> {
    field: &'a str,
    #[label("a condition")]
    span: Span,
    required: &'a str,
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
        return checker.fail(ProbabilityMisplaced { span: base.span });
    };
    let study = study(checker, owner, base.span)?;
    if name.node != schema::PROBABILITY.name {
        return checker.fail(NoSuchStudyMember {
            study: owner,
            member: &name.node,
            span: name.span,
        });
    }
    let chosen = checker.arguments_of(&schema::PROBABILITY, arguments, written.span)?;
    let mut label = |field: Field| {
        if let Some((_, Some(written))) = chosen.find(field.name)
            && let Some(required) = required(checker, field, written)
        {
            let span = written.span;
            return checker.fail(RequirementWanted {
                field: field.name,
                span,
                required: &required,
            });
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
        _ => checker.fail(EventWanted { span: written.span }),
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
            checker.fail(UnknownBlockName {
                kind: Kind::Study,
                name: owner,
                span,
                known: &known,
            })
        }
    }
}

/// A requirement that a study itself decides.
#[derive(Violation)]
#[violation(E203, "\"{label}\" is itself a requirement on a study")]
#[help("write the name of a requirement on the results of a run")]
struct RequirementOfAStudy<'a> {
    label: &'a str,
    #[label("not decided by a run")]
    span: Span,
}

struct UnknownRequirement<'a> {
    label: &'a str,
    span: Span,
    known: &'a [&'a str],
}

impl Violation for UnknownRequirement<'_> {
    const CODE: Code = E203;

    fn diagnostic(self) -> Diagnostic {
        let Self { label, span, known } = self;
        let help = match psd_text::suggest::nearest(label, known.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None if known.is_empty() => "add a requirement on the results of a run".to_owned(),
            None => format!(
                "write one of: {}",
                known
                    .iter()
                    .take(10)
                    .map(|name| format!("\"{name}\""))
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
        };
        Diagnostic::new(Self::CODE, format!("no requirement is named \"{label}\""))
            .at(span, "unknown requirement")
            .help(help)
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
        return checker.fail(RequirementOfAStudy { label, span });
    }
    checker.fail(UnknownRequirement {
        label,
        span,
        known: &known,
    })
}

/// To one or two digits.
fn rounded_up(count: u64) -> u64 {
    let mut unit = 1_u64;
    while count / unit >= 100 {
        unit *= 10;
    }
    count.div_ceil(unit) * unit
}

struct TooFewRuns {
    most: u64,
    limit: Span,
    fewest: u64,
    at: Option<Span>,
}

impl Violation for TooFewRuns {
    const CODE: Code = W731;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            most,
            limit,
            fewest,
            at,
        } = self;
        let diagnostic = Diagnostic::new(
        Self::CODE,
        format!(
            "{most} runs cannot show this limit, even if none is against it: that takes {fewest}"
        ),
    )
    .at(limit, "always undecided, or not met");
        let diagnostic = at.into_iter().fold(diagnostic, |diagnostic, span| {
            diagnostic.at(span, "too few runs")
        });
        diagnostic.help(format!(
            "write `runs = {}` or more, `until = decided(at_most: {})`, or `sampling = subset`",
            rounded_up(fewest),
            rounded_up(fewest.saturating_mul(10))
        ))
    }
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
        checker.report(TooFewRuns {
            most,
            limit: span,
            fewest,
            at,
        });
    }
}
