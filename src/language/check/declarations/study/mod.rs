//! `study` and `fragility`: many runs of the plan with scattered inputs. In: their blocks, and the requirements on their probabilities. Out:
//! the studies of the plan. They run nothing.

mod arguments;
mod correlation;
mod distribution;
mod ends;
mod fragility;
mod inputs;
mod probability;
mod rare;
mod samples;
mod samples_file;
mod target;
mod varied;

pub use samples_file::MOST_ROWS as MOST_SAMPLE_ROWS;

use crate::check::checker::{Checker, Context, Reads, Shape};
use crate::check::violations::{NeedsTheRun, ReadsNoResult};
use crate::codes::{E304, E660, E665};
use crate::syntax::ast::{Expr, ExprKind};
use psd_physics::study::Confidence;
use psd_plan::schema::{Kind, study as schema};
use psd_plan::study::{Collected, MOST_RUNS, Runs, Sampling, Studies, Study};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

#[derive(Violation)]
#[violation(E665, "a study is simulated: it cannot run on a real rig")]
#[help("remove `--rig`, or name a virtual rig")]
struct StudyOnARealRig {
    #[label("a real rig")]
    head: Span,
}

/// The studies of the plan; None if one has an error.
pub fn studies(checker: &mut Checker) -> Option<Studies> {
    if let Some(rig) = checker.real_rig.filter(|_| checker.for_studies) {
        let head = checker.scope.blocks[rig].block.head;
        checker.report(StudyOnARealRig { head });
    }
    let blocks = |checker: &Checker, kind| {
        let of_kind = checker.scope.of_kind(kind);
        of_kind.map(|(index, _)| index).collect::<Vec<usize>>()
    };
    let mut studies: Vec<Option<Study>> = blocks(checker, Kind::Study)
        .into_iter()
        .map(|block| study(checker, block))
        .collect();
    let fragilities: Vec<_> = blocks(checker, Kind::Fragility)
        .into_iter()
        .map(|block| fragility::fragility(checker, block))
        .collect();
    let requirements = probability::requirements(checker, &studies);
    for (index, study) in studies.iter_mut().enumerate() {
        if let (Some(of), Some(requirements)) = (&study, &requirements)
            && matches!(of.runs, Runs::Rare(_))
        {
            *study = rare::completed(checker, index, of.clone(), requirements);
        }
    }
    Some(Studies {
        studies: studies.into_iter().collect::<Option<_>>()?,
        fragilities: fragilities.into_iter().collect::<Option<_>>()?,
        requirements: requirements?,
    })
}

fn study(checker: &mut Checker, block: usize) -> Option<Study> {
    let confidence = confidence(checker, block);
    let runs = runs(checker, block, confidence);
    let variation = inputs::variation(checker, block, schema::VARY.name, None);
    let collect = collect(checker, block);
    Some(Study {
        name: checker.scope.blocks[block].name?.node.clone(),
        variation: variation?,
        runs: runs?,
        confidence: confidence?,
        collect: collect?,
    })
}

fn confidence(checker: &mut Checker, block: usize) -> Option<Confidence> {
    let level = checker.constant(block, schema::CONFIDENCE.name)?;
    Confidence::new(level).ok()
}

/// How the points of a study are chosen.
fn sampling(checker: &mut Checker, block: usize) -> Option<Sampling> {
    let word = checker.word(block, schema::SAMPLING.name, Sampling::default().name())?;
    let all = [
        Sampling::Random,
        Sampling::LatinHypercube,
        Sampling::Sobol,
        Sampling::Subset,
    ];
    all.into_iter().find(|sampling| sampling.name() == word)
}

/// A whole number that is too large for a `count`.
fn whole(checker: &mut Checker, block: usize, field: &str) -> Option<u64> {
    checker.constant(block, field).and_then(as_whole)
}

fn as_whole(value: f64) -> Option<u64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked on the left"
    )]
    ((0.0..=9_007_199_254_740_992.0).contains(&value) && value.fract() == 0.0)
        .then_some(value as u64)
}

/// `stated`: `runs` or `until`.
#[derive(Violation)]
#[violation(
    E660,
    "a subset simulation ends by its levels and has no number of runs"
)]
#[help("remove `runs` or `until`; `points` and `replicates` of `subset` state the size")]
struct RunsOfSubset {
    #[label("number of runs")]
    stated: Span,
    #[label("ends once its levels reach the limit")]
    sampling: Span,
}

#[derive(Violation)]
#[violation(E660, "the number of runs is stated twice")]
#[help("remove `runs`; `at_most` of `until` limits the number of runs")]
struct RunsAndUntil {
    #[label("ends by its results")]
    until: Span,
    #[label("ends after these runs")]
    runs: Span,
}

#[derive(Violation)]
#[violation(
    E660,
    "a Latin hypercube has a fixed number of runs and cannot end by its results"
)]
#[help("write `runs = 10000` instead of `until`, or `sampling = {}`", Sampling::Random.name())]
struct HypercubeCannotGrow {
    #[label("unknown number of runs")]
    until: Span,
    #[label("fixed number of runs")]
    sampling: Span,
}

/// The end of a study: a number of runs, or a rule.
fn runs(checker: &mut Checker, block: usize, confidence: Option<Confidence>) -> Option<Runs> {
    let key = |checker: &Checker, field: &str| {
        let found = checker.field(block, field);
        found.map(|(_, entry)| entry.key.span.to(entry.value.span))
    };
    let (runs, until) = (
        key(checker, schema::RUNS.name),
        key(checker, schema::UNTIL.name),
    );
    if let (Some(Sampling::Subset), Some(sampling)) = (
        sampling(checker, block),
        key(checker, schema::SAMPLING.name),
    ) {
        if let Some(stated) = runs.or(until) {
            return checker.fail(RunsOfSubset { stated, sampling });
        }
        return rare::levels(checker, block).map(Runs::Rare);
    }
    let Some(until) = until else {
        return whole(checker, block, schema::RUNS.name).map(Runs::Fixed);
    };
    if let Some(runs) = runs {
        return checker.fail(RunsAndUntil { until, runs });
    }
    if let (Some(Sampling::LatinHypercube), Some(sampling)) = (
        sampling(checker, block),
        key(checker, schema::SAMPLING.name),
    ) {
        return checker.fail(HypercubeCannotGrow { until, sampling });
    }
    let chosen = checker.choice(block, schema::UNTIL.name)?;
    let (entry, _) = checker.field(block, schema::UNTIL.name)?;
    let context = checker.context_of(block, entry);
    let own = checker.optional_argument(&chosen, schema::RULE_CONFIDENCE.name, context);
    let at_most = checker.constant_argument(&chosen, schema::AT_MOST.name, context);
    let rule = chosen.variant.name;
    let width = match rule {
        schema::DECIDED => Some(None),
        _ => checker
            .constant_argument(&chosen, schema::HALF_WIDTH.name, context)
            .map(Some),
    };
    let at_most = as_whole(at_most?).filter(|runs| *runs <= MOST_RUNS)?;
    let confidence = match own? {
        Some(level) => Confidence::new(level).ok()?,
        None => confidence?,
    };
    Some(match width? {
        None => Runs::Decided {
            confidence,
            at_most,
        },
        Some(half_width) => Runs::HalfWidth {
            half_width,
            confidence,
            at_most,
        },
    })
}

/// The numbers that are kept for every run, each once.
fn collect(checker: &mut Checker, block: usize) -> Option<Vec<Collected>> {
    let Some((entry, written)) = checker.field(block, schema::COLLECT.name) else {
        return Some(Vec::new());
    };
    let context = Context {
        entry: Some((block, entry)),
        reads: Reads::All,
        critical: false,
    };
    let read: Vec<Option<Collected>> = items(&written.value)
        .iter()
        .map(|item| collected(checker, item, context))
        .collect();
    let mut collect: Vec<Collected> = Vec::new();
    for one in read.into_iter().collect::<Option<Vec<_>>>()? {
        if collect.iter().all(|before| before.text != one.text) {
            collect.push(one);
        }
    }
    Some(collect)
}

/// `exceeds` with a list, a list result or a result that is not a number.
#[derive(Violation)]
#[violation(E304, "`{text}` is a list: a study keeps one number for each run")]
#[help("write `max({text})`, or one entry: `{text}[0]`")]
struct NumberPerRunWanted<'a> {
    text: &'a str,
    #[label("a list")]
    span: Span,
}

fn collected<'a>(checker: &mut Checker<'a>, item: &'a Expr, context: Context) -> Option<Collected> {
    let typed = checker.value(item, context)?;
    let text = spaced(checker.text(item.span));
    if typed.shape == Shape::List {
        return checker.fail(NumberPerRunWanted {
            text: &text,
            span: item.span,
        });
    }
    // A result that is an input of the study is a number in each run.
    if !reads_a_result(&typed.formula) && checker.results.is_empty() {
        return checker.fail(ReadsNoResult {
            text: &text,
            example: "hit.max_displacement",
            span: item.span,
        });
    }
    Some(Collected {
        text,
        value: typed.formula,
        dimension: typed.dimension,
    })
}

fn reads_a_result(formula: &psd_plan::formula::Formula) -> bool {
    let mut references = Vec::new();
    formula.collect_references(&mut references);
    !references.is_empty()
}

/// The entries of a list, or the one entry.
fn items(written: &Expr) -> &[Expr] {
    match &written.kind {
        ExprKind::List { items, unit: None } => items,
        _ => std::slice::from_ref(written),
    }
}

/// A text of several lines on one line.
fn spaced(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The seed of a study.
fn seed(checker: &mut Checker, block: usize) -> Option<u64> {
    whole(checker, block, schema::SEED.name)
}

/// A number known before the run that an expression gives, with its span for other errors.
fn known(checker: &mut Checker, value: Option<f64>, span: Span) -> Option<f64> {
    match value {
        Some(value) => Some(value),
        None => checker.fail(NeedsTheRun {
            span,
            text: checker.text(span),
        }),
    }
}
