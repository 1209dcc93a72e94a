//! The order of a check: every block in turn, then conditions on several of them, then the warnings. In: the syntax trees and a loader of
//! data files. Out: the plan, or diagnostics with the reasons why it is missing. It does not depend on any particular procedure.

use crate::procedures as slices;
use crate::procedures::facts::Left;
use psd_language::check::checker::Checker;
use psd_language::check::declared::Declared;
use psd_language::check::{declarations, rig, warnings as of_the_language};
use psd_language::codes::E203;
use psd_plan::schema::Kind;
use psd_plan::{Plan, PlanFile, Procedure, Studies};
use psd_text::diagnostic::Diagnostic;
use psd_text::markdown::is_document;
use psd_text::source::{FileId, Sources, Span};

use super::{Options, golden, procedures, report, warnings};

/// Whether a check also looks for warnings.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Findings {
    /// Errors, without the studies of the plan.
    ErrorsAlone,
    /// Errors, with its studies.
    OfStudies,
    WarningsToo,
}

/// The parts of a plan that are kept as text.
pub struct PlanText<'a> {
    /// The name of the plan's file.
    pub name: &'a str,
    /// The plan, then every file that it uses.
    pub files: Vec<PlanFile>,
    /// The parameters that are set from outside, in order of their names.
    pub settings: Vec<(String, String)>,
}

/// The diagnostics in the order of the text, without those that only follow from another at the same position. `misspelt` contains the
/// positions that were not read as they are written. `explained` contains those that one diagnostic explains in full.
pub fn reportable(
    mut diagnostics: Vec<Diagnostic>,
    misspelt: &[Span],
    mut explained: Vec<Span>,
) -> Vec<Diagnostic> {
    let is_within = |diagnostic: &Diagnostic, positions: &[Span]| {
        diagnostic
            .span()
            .is_some_and(|span| touches(span, positions))
    };
    diagnostics.retain(|found| is_of_the_text(found) || !is_within(found, misspelt));
    explained.sort_unstable();
    diagnostics.retain(|found| found.code != E203 || !is_within(found, &explained));
    diagnostics.sort_by_key(|found| found.span().map(|span| (span.file, span.start, span.end)));
    diagnostics
}

/// Whether it is about the syntax.
fn is_of_the_text(diagnostic: &Diagnostic) -> bool {
    diagnostic.code.id().starts_with("E1")
}

/// Whether a span has a character in common with one of the others, which are in order.
fn touches(span: Span, others: &[Span]) -> bool {
    let before = others.partition_point(|other| (other.file, other.start) < (span.file, span.end));
    before
        .checked_sub(1)
        .and_then(|last| others.get(last))
        .is_some_and(|last| last.file == span.file && span.start < last.end)
}

/// The lines at which the text could not be parsed, in order, each once.
pub fn unread_lines(sources: &Sources, errors: &[Diagnostic]) -> Vec<Span> {
    let line = |span: Span| {
        let text = &sources.file(span.file).text;
        let (start, end) = (
            text.floor_char_boundary(span.range().start),
            text.floor_char_boundary(span.range().end),
        );
        let first = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let last = text[end..]
            .find('\n')
            .map_or(text.len(), |newline| end + newline);
        Span::new(span.file, first, last)
    };
    let labels = errors
        .iter()
        .filter(|error| is_of_the_text(error))
        .flat_map(|error| &error.labels);
    let mut lines: Vec<Span> = labels.map(|label| line(label.span)).collect();
    lines.sort_unstable();
    lines.dedup_by(|next, kept| {
        let joins = next.file == kept.file && next.start <= kept.end;
        if joins {
            kept.end = kept.end.max(next.end);
        }
        joins
    });
    lines
}

/// Checks every block, then all of them together. None if a part of the plan has an error.
pub fn plan(
    checker: &mut Checker,
    text: PlanText,
    options: &Options,
    findings: Findings,
) -> Option<Plan> {
    checker.for_studies = options.for_studies;
    checker.real_rig = rig::real_rig_of_run(checker, options.rig.as_deref());
    // Other values of the parameters leave the entries of a block as they are.
    if findings == Findings::WarningsToo {
        for block in 0..checker.scope.blocks.len() {
            checker.entries_of(block);
        }
    }
    let (title, particulars) =
        declarations::plan_block::plan_block(checker, options.date.as_deref());
    if options.unattended {
        rig::real::check_operator(checker, &particulars);
    }
    let parameters = checker.parameters();
    let of_kind = |checker: &Checker, kind| {
        checker
            .scope
            .of_kind(kind)
            .map(|(index, _)| index)
            .collect::<Vec<_>>()
    };
    let mut specimens: Vec<_> = of_kind(checker, Kind::Specimen)
        .into_iter()
        .map(|block| declarations::specimen::specimen(checker, block))
        .collect();
    let strikers: Vec<_> = of_kind(checker, Kind::Striker)
        .into_iter()
        .map(|block| declarations::striker::striker(checker, block))
        .collect();
    let grounds: Vec<_> = of_kind(checker, Kind::Ground)
        .into_iter()
        .map(|block| declarations::ground::ground(checker, block))
        .collect();
    let mut rig = rig::rig_of_run(checker, options.rig.as_deref());
    let limits = checker.limits(rig.as_ref().and_then(|rig| rig.limits));
    rig::real::complete(checker, rig.as_mut(), limits.as_ref());
    let procedures = procedures::procedures(checker);
    procedures::check_specimen(checker, &procedures);
    procedures::check_axes(checker, &procedures, &specimens, rig.as_ref());
    slices::preload::check::check_axial_loads(checker, &procedures, &mut specimens, rig.as_ref());
    // Two `limits` blocks are an error; the targets are compared with neither of them.
    if let Some(limits) = limits
        .as_ref()
        .filter(|_| !checker.scope.twice.contains(&Kind::Limits))
    {
        declarations::limits::check_start(checker, limits);
        declarations::limits::check_targets(checker, limits);
        declarations::limits::check_forces(checker, limits, &specimens);
        slices::check_limits(checker, &procedures, limits);
    }
    let declared = Declared {
        specimens: &specimens,
        strikers: &strikers,
        grounds: &grounds,
    };
    for (block, procedure) in &procedures {
        if let Some(procedure) = procedure {
            slices::check_declared(checker, *block, &procedure.kind, &declared);
        }
    }
    let requirements = checker.requirements();
    let reproductions = declarations::reproduces::reproductions(checker);
    // Studies bind the plan again and again, and their runs read no study.
    let studies = match findings {
        Findings::WarningsToo | Findings::OfStudies => declarations::study::studies(checker),
        Findings::ErrorsAlone => Some(Studies::default()),
    };
    let report = report::report(checker, &procedures);
    let golden = golden::golden(checker);
    if !has_error(checker) {
        let warns = findings == Findings::WarningsToo;
        if warns {
            if let Some(rig) = &rig {
                let today = options.today.as_deref();
                rig::real_warnings::warn(checker, rig, &specimens, today);
                rig::zero_drift::warn(checker, rig);
            }
            if let Some(limits) = &limits {
                declarations::specimen::warn_of_short_tables(checker, &specimens, limits);
            }
            if let Some(report) = &report {
                declarations::print::warn(checker, report);
            }
        }
        slices::check_reads(checker, &procedures);
        if warns {
            let head = checker
                .scope
                .of_kind(Kind::Plan)
                .map(|(_, block)| block.block.head)
                .next();
            let head = head.unwrap_or_else(|| Span::new(FileId(0), 0, 0));
            let rule = declarations::plan_block::decision_rule(&particulars);
            let requirements = requirements.as_deref().unwrap_or(&[]);
            warnings::left::warn(checker, &procedures, requirements);
            if let Some(limits) = &limits {
                let (limits, positive) = (&limits.limits, slices::stays_positive);
                of_the_language::decided::check(
                    checker,
                    &procedures,
                    requirements,
                    limits,
                    positive,
                );
            }
            of_the_language::guarded::warn(checker, &procedures, requirements, rule);
            let reproductions = reproductions.as_deref().unwrap_or(&[]);
            let stated = warnings::Stated {
                requirements,
                reproductions,
            };
            let left = Left {
                grounds: &grounds,
                specimens: &specimens,
            };
            warnings::whole_plan(checker, &procedures, stated, left, head);
        }
    }
    let rig_block = rig.as_ref().and_then(|rig| rig.block);
    let (blocks, in_plan_order): (Vec<usize>, Vec<Option<Procedure>>) =
        procedures.into_iter().unzip();
    let plan = Plan {
        title: title.unwrap_or_else(|| stem(text.name).to_owned()),
        parameters,
        specimens: specimens.into_iter().collect::<Option<_>>()?,
        strikers: strikers.into_iter().collect::<Option<_>>()?,
        grounds: grounds.into_iter().collect::<Option<_>>()?,
        rig: rig?.plan,
        limits: limits?.limits,
        procedures: in_plan_order.into_iter().collect::<Option<_>>()?,
        requirements: requirements?,
        reproductions: reproductions?,
        decision_rule: declarations::plan_block::decision_rule(&particulars),
        particulars,
        report: report?,
        golden: golden?,
        check_run_of: None,
        studies: studies?,
        files: text.files.into_iter().chain(checker.data_files()).collect(),
        settings: text.settings,
    };
    if !has_error(checker) {
        if findings == Findings::WarningsToo {
            warnings::tracking::warn(checker, &plan, &blocks, rig_block);
            of_the_language::guarded::warn_of_partial(checker, &plan, rig_block);
            if options.dry_run {
                warnings::dry_run::warn(checker, &plan, &blocks);
            }
        }
        warnings::recorded_steps::check(checker, &plan, &blocks);
    }
    Some(plan)
}

fn has_error(checker: &Checker) -> bool {
    checker.diagnostics.iter().any(Diagnostic::is_error)
}

/// The title of a plan without one: `beam` for `plans/beam.psd`.
fn stem(name: &str) -> &str {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    match file.rsplit_once('.') {
        Some((stem, "psd")) => stem,
        Some((stem, _)) if is_document(file) => stem,
        _ => file,
    }
}
