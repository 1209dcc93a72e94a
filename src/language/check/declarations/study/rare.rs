//! `sampling = subset(points: 1000)`: a study of a rare failure. In: the block, and the requirements on probabilities. Out: a [`RareEvent`]
//! with the one requirement of the plan that it is about.

use crate::check::checker::{Checker, Context, Reads};
use crate::codes::{E401, E664};
use psd_plan::schema::{Kind, study as schema};
use psd_plan::study::{RareEvent, Runs, Study, StudyEvent, StudyRequirement};
use psd_plan::{Comparison, Test};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

#[derive(Violation)]
#[violation(E401, "a level has a multiple of ten points, here {points}")]
#[help("write `points: 1000`")]
struct PointsOfALevel {
    points: u32,
    #[label("a tenth of the points begins the next level")]
    span: Span,
}

/// Points and replicates; the requirement is known only once all of them are read.
pub(super) fn levels(checker: &mut Checker, block: usize) -> Option<RareEvent> {
    let chosen = checker.choice(block, schema::SAMPLING.name)?;
    let (entry, written) = checker.field(block, schema::SAMPLING.name)?;
    let context = checker.context_of(block, entry);
    let span = written.value.span;
    let mut count = |field: psd_plan::schema::Field| {
        let value = checker.optional_argument(&chosen, field.name, context)?;
        let value = value.or_else(|| field.default_number())?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "its range was checked"
        )]
        Some(value as u32)
    };
    let (points, replicates) = (count(schema::POINTS), count(schema::LEVEL_REPLICATES));
    let (points, replicates) = (points?, replicates?);
    if points % 10 != 0 {
        return checker.fail(PointsOfALevel { points, span });
    }
    Some(RareEvent {
        points,
        replicates,
        numbers: 0,
        requirement: 0,
        falls: false,
    })
}

struct OneRareFailure<'a> {
    study: &'a str,
    found: usize,
    span: Span,
}

impl Violation for OneRareFailure<'_> {
    const CODE: Code = E664;

    fn diagnostic(self) -> Diagnostic {
        let Self { study, found, span } = self;
        let message = if found == 0 {
            "no requirement is about a probability of this study".to_owned()
        } else {
            format!("a subset simulation is about one requirement of the plan, here {found}")
        };
        let help = if found == 0 {
            format!(
                "add one, such as `require \"rarely fails\" {study}.probability(fails: \"…\") < 0.001 %`"
            )
        } else {
            "write a study for each requirement".to_owned()
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, "no distance from a limit")
            .help(help)
    }
}

/// A requirement without a distance from its limit.
#[derive(Violation)]
#[violation(E664, "\"{label}\" does not compare one result with a constant")]
#[help("write one comparison, such as `hit.max_displacement < 50 mm`, or `sampling = random`")]
struct NoDistance<'a> {
    label: &'a str,
    #[label("no single limit")]
    condition: Span,
    #[label("its levels approach one limit")]
    sampling: Span,
}

/// The study with the requirement that it is about: one result of a run, compared with a constant.
pub(super) fn completed(
    checker: &mut Checker,
    index: usize,
    study: Study,
    requirements: &[StudyRequirement],
) -> Option<Study> {
    let Runs::Rare(rare) = study.runs else {
        return Some(study);
    };
    let block = checker.scope.of_kind(Kind::Study).nth(index);
    let (block, _) = block?;
    let (_, written) = checker.field(block, schema::SAMPLING.name)?;
    let span = written.value.span;
    let own = requirements.iter().filter(|it| it.study == index);
    let mut of_runs: Vec<usize> = own
        .map(|it| match it.event {
            StudyEvent::Fails { requirement } | StudyEvent::Holds { requirement } => requirement,
        })
        .collect();
    of_runs.dedup();
    let [requirement] = of_runs[..] else {
        return checker.fail(OneRareFailure {
            study: &study.name,
            found: of_runs.len(),
            span,
        });
    };
    let declared = &checker.scope.requirements[requirement];
    let (label, condition) = (declared.label.node.clone(), declared.condition);
    let context = Context {
        entry: None,
        reads: Reads::All,
        critical: false,
    };
    // Its own errors are reported where it is read.
    let before = checker.diagnostics.len();
    let conditions = checker.conditions_at(condition, context);
    checker.diagnostics.truncate(before);
    let conditions = conditions?;
    let falls = match &conditions[..] {
        [only] => match &only.test {
            Test::Compare { comparison, limit } if limit.constant().is_some() => match comparison {
                Comparison::Less | Comparison::LessEqual => Some(false),
                Comparison::Greater | Comparison::GreaterEqual => Some(true),
                Comparison::Equal | Comparison::NotEqual => None,
            },
            _ => None,
        },
        _ => None,
    };
    let Some(falls) = falls else {
        return checker.fail(NoDistance {
            label: &label,
            condition: condition.span,
            sampling: span,
        });
    };
    let numbers = u32::try_from(study.variation.sources.len()).ok()?;
    Some(Study {
        runs: Runs::Rare(RareEvent {
            numbers,
            requirement,
            falls,
            ..rare
        }),
        ..study
    })
}
