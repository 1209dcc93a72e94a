//! The order of a check: every block in turn, then conditions on several of them, then the warnings. In: the syntax trees and a loader of
//! data files. Out: the plan, or diagnostics with the reasons why it is missing. It does not depend on any particular procedure.

use crate::procedures as slices;
use crate::procedures::facts::Left;
use psd_language::check::checker::{Checker, FixedValues};
use psd_language::check::declarations::limits::CheckedLimits;
use psd_language::check::declared::Declared;
use psd_language::check::rig::CheckedRig;
use psd_language::check::{declarations, rig, warnings as of_the_language};
use psd_language::codes::E203;
use psd_plan::schema::Kind;
use psd_plan::{
    Golden, Ground, Limits, Parameter, Plan, PlanFile, Procedure, Report, Reproduction,
    Requirement, Specimen, Striker, Studies,
};
use psd_text::diagnostic::Diagnostic;
use psd_text::markdown::is_document;
use psd_text::source::{FileId, Sources, Span};

use super::parts::Parts;
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
    pub files: &'a [PlanFile],
    /// The parameters that are set from outside, in order of their names.
    pub settings: &'a [(String, String)],
}

/// All parts of a plan, for the next check with other bound values.
#[derive(Default)]
pub struct PlanParts {
    title: Parts<Titled>,
    parameters: Parts<Option<Parameter>>,
    specimens: Parts<Option<Specimen>>,
    strikers: Parts<Option<Striker>>,
    grounds: Parts<Option<Ground>>,
    rig: Parts<Bounded>,
    procedures: Parts<(usize, Option<Procedure>)>,
    requirements: Parts<Option<Vec<Requirement>>>,
    reproductions: Parts<Option<Vec<Reproduction>>>,
    studies: Parts<Option<Studies>>,
    report: Parts<Option<Report>>,
    golden: Parts<Option<Golden>>,
    texts: Parts<Texts>,
    /// Values that the check before left as they are for this one.
    pub values: FixedValues,
}

/// What the `plan` block states.
struct Titled {
    title: Option<String>,
    particulars: Vec<(&'static str, String)>,
}

/// The rig of the run, within its limits.
struct Bounded {
    rig: Option<CheckedRig>,
    limits: Option<CheckedLimits>,
}

/// What a plan keeps as text.
struct Texts {
    files: Vec<PlanFile>,
    settings: Vec<(String, String)>,
}

impl PlanParts {
    /// Whether no bound value reaches what decides a run.
    pub fn decide_alike(&self) -> bool {
        self.requirements.are_fixed() && self.studies.are_fixed() && self.rig.are_fixed()
    }

    /// The plan of these parts, which are in it from here on; None if one has an error.
    fn plan(&mut self, name: &str) -> Option<Plan> {
        fn all<T>(parts: &mut Parts<Option<T>>) -> Option<Vec<T>> {
            std::mem::take(&mut parts.checked).into_iter().collect()
        }
        fn only<T>(parts: &mut Parts<T>) -> Option<T> {
            parts.checked.pop()
        }
        let Titled { title, particulars } = only(&mut self.title)?;
        let parameters = self.parameters.checked.iter().flatten();
        let Bounded { rig, limits } = self.rig.checked.first()?;
        let procedures = std::mem::take(&mut self.procedures.checked);
        let Texts { files, settings } = only(&mut self.texts)?;
        Some(Plan {
            title: title.unwrap_or_else(|| stem(name).to_owned()),
            parameters: parameters.cloned().collect(),
            specimens: all(&mut self.specimens)?,
            strikers: all(&mut self.strikers)?,
            grounds: all(&mut self.grounds)?,
            rig: rig.as_ref()?.plan.clone(),
            limits: limits.as_ref()?.limits,
            procedures: procedures
                .into_iter()
                .map(|(_, procedure)| procedure)
                .collect::<Option<_>>()?,
            requirements: only(&mut self.requirements)??,
            reproductions: only(&mut self.reproductions)??,
            decision_rule: declarations::plan_block::decision_rule(&particulars),
            particulars,
            report: only(&mut self.report)??,
            golden: only(&mut self.golden)??,
            check_run_of: None,
            studies: only(&mut self.studies)??,
            files,
            settings,
        })
    }

    /// The parts of a plan that was made of these are theirs again. `blocks`: those of its procedures.
    fn take_back(&mut self, plan: Plan, blocks: &[usize]) {
        fn some<T>(values: Vec<T>) -> Vec<Option<T>> {
            values.into_iter().map(Some).collect()
        }
        self.title.checked.push(Titled {
            title: Some(plan.title),
            particulars: plan.particulars,
        });
        self.specimens.checked = some(plan.specimens);
        self.strikers.checked = some(plan.strikers);
        self.grounds.checked = some(plan.grounds);
        let procedures = plan.procedures.into_iter().map(Some);
        self.procedures.checked = blocks.iter().copied().zip(procedures).collect();
        self.requirements.checked.push(Some(plan.requirements));
        self.reproductions.checked.push(Some(plan.reproductions));
        self.studies.checked.push(Some(plan.studies));
        self.report.checked.push(Some(plan.report));
        self.golden.checked.push(Some(plan.golden));
        self.texts.checked.push(Texts {
            files: plan.files,
            settings: plan.settings,
        });
    }
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

/// Checks every block, then all of them together. None if a part of the plan has an error. With the parts of the check before, and the
/// plan that it gave, only the parts that bound values reach are checked again.
pub fn plan(
    checker: &mut Checker,
    parts: &mut PlanParts,
    before: Option<Plan>,
    text: &PlanText<'_>,
    options: &Options,
    findings: Findings,
) -> Option<Plan> {
    checker.for_studies = options.for_studies;
    let blocks_of = |checker: &Checker, kind| -> Vec<usize> {
        let blocks = checker.scope.of_kind(kind);
        blocks.map(|(index, _)| index).collect()
    };
    let blocks: Vec<usize> = checker.scope.procedures().map(|(index, _)| index).collect();
    match before {
        Some(before) => parts.take_back(before, &blocks),
        None => *parts = PlanParts::default(),
    }
    // Other values of the parameters leave the entries of a block as they are.
    if findings == Findings::WarningsToo {
        for block in 0..checker.scope.blocks.len() {
            checker.entries_of(block);
        }
    }
    parts.title.check(0, checker, |checker| {
        let (title, particulars) =
            declarations::plan_block::plan_block(checker, options.date.as_deref());
        Titled { title, particulars }
    });
    let particulars = &parts.title.checked[0].particulars;
    if options.unattended {
        rig::real::check_operator(checker, particulars);
    }
    for index in 0..checker.scope.values.len() {
        let work = |checker: &mut Checker| checker.parameter(index);
        parts.parameters.check(index, checker, work);
    }
    let specimens = blocks_of(checker, Kind::Specimen);
    let work = declarations::specimen::specimen;
    parts.specimens.check_each(&specimens, checker, work);
    let strikers = blocks_of(checker, Kind::Striker);
    let work = declarations::striker::striker;
    parts.strikers.check_each(&strikers, checker, work);
    let grounds = blocks_of(checker, Kind::Ground);
    let work = declarations::ground::ground;
    parts.grounds.check_each(&grounds, checker, work);
    parts.rig.check(0, checker, |checker| {
        let mut rig = rig::rig_of_run(checker, options.rig.as_deref());
        let limits = checker.limits(rig.as_ref().and_then(|rig| rig.limits));
        rig::real::complete(checker, rig.as_mut(), limits.as_ref());
        Bounded { rig, limits }
    });
    let Bounded { rig, limits } = &parts.rig.checked[0];
    parts
        .procedures
        .check_each(&blocks, checker, procedures::procedure);
    let procedures = &parts.procedures.checked;
    procedures::check_specimen(checker, procedures);
    procedures::check_axes(checker, procedures, &parts.specimens.checked, rig.as_ref());
    let specimens = &mut parts.specimens.checked;
    slices::preload::check::check_axial_loads(checker, procedures, specimens, rig.as_ref());
    let is_axial = |rig: &CheckedRig| rig.plan.axial_axes(&Limits::NONE).next().is_some();
    if rig.as_ref().is_some_and(is_axial) {
        // A frame contains its axial loads from here on.
        parts.specimens.release();
    }
    let specimens = &parts.specimens.checked;
    // Two `limits` blocks are an error; the targets are compared with neither of them.
    if let Some(limits) = limits
        .as_ref()
        .filter(|_| !checker.scope.twice.contains(&Kind::Limits))
    {
        declarations::limits::check_start(checker, limits);
        declarations::limits::check_targets(checker, limits);
        declarations::limits::check_forces(checker, limits, specimens);
        slices::check_limits(checker, procedures, limits);
    }
    let declared = Declared {
        specimens,
        strikers: &parts.strikers.checked,
        grounds: &parts.grounds.checked,
    };
    for (block, procedure) in procedures {
        if let Some(procedure) = procedure {
            slices::check_declared(checker, *block, &procedure.kind, &declared);
        }
    }
    let work = |checker: &mut Checker| checker.requirements();
    parts.requirements.check(0, checker, work);
    let work = declarations::reproduces::reproductions;
    parts.reproductions.check(0, checker, work);
    // Studies bind the plan again and again, and their runs read no study.
    parts.studies.check(0, checker, |checker| match findings {
        Findings::WarningsToo | Findings::OfStudies => declarations::study::studies(checker),
        Findings::ErrorsAlone => Some(Studies::default()),
    });
    if !parts.procedures.are_fixed() {
        // It names their figures and results.
        parts.report.release();
    }
    let work = |checker: &mut Checker| report::report(checker, procedures);
    parts.report.check(0, checker, work);
    parts.golden.check(0, checker, golden::golden);
    parts.texts.check(0, checker, |checker| Texts {
        files: text
            .files
            .iter()
            .cloned()
            .chain(checker.data_files())
            .collect(),
        settings: text.settings.to_vec(),
    });
    if !has_error(checker) {
        let warns = findings == Findings::WarningsToo;
        if warns {
            if let Some(rig) = rig {
                let today = options.today.as_deref();
                rig::real_warnings::warn(checker, rig, specimens, today);
                rig::zero_drift::warn(checker, rig);
            }
            if let Some(limits) = limits {
                declarations::specimen::warn_of_short_tables(checker, specimens, limits);
            }
            if let Some(report) = &parts.report.checked[0] {
                declarations::print::warn(checker, report);
            }
        }
        slices::check_reads(checker, procedures);
        if warns {
            let head = checker
                .scope
                .of_kind(Kind::Plan)
                .map(|(_, block)| block.block.head)
                .next();
            let head = head.unwrap_or_else(|| Span::new(FileId(0), 0, 0));
            let rule = declarations::plan_block::decision_rule(particulars);
            let requirements = parts.requirements.checked[0].as_deref().unwrap_or(&[]);
            warnings::left::warn(checker, procedures, requirements);
            if let Some(limits) = limits {
                let (limits, positive) = (&limits.limits, slices::stays_positive);
                of_the_language::decided::check(
                    checker,
                    procedures,
                    requirements,
                    limits,
                    positive,
                );
            }
            of_the_language::guarded::warn(checker, procedures, requirements, rule);
            let reproductions = parts.reproductions.checked[0].as_deref().unwrap_or(&[]);
            let stated = warnings::Stated {
                requirements,
                reproductions,
            };
            let left = Left {
                grounds: &parts.grounds.checked,
                specimens,
            };
            warnings::whole_plan(checker, procedures, stated, left, head);
        }
    }
    let rig_block = rig.as_ref().and_then(|rig| rig.block);
    let plan = parts.plan(text.name)?;
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
