//! The check of a plan from its text to what it asks for: every block in turn, what they say together, the warnings last. In: the text
//! and a loader of used files. Out: the plan, or why there is none. It knows no particular procedure.

use super::checker::Checker;
use super::declared::Declared;
use super::scope::Scope;
use super::{
    Checked, Loader, Options, declarations, expressions, imports, messages, procedures, rig,
    warnings,
};
use crate::plan::{Plan, PlanFile, Procedure};
use crate::procedures as slices;
use crate::schema::Kind;
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::{FileId, Sources, Span};

/// Checks a plan and all it uses.
#[must_use]
pub fn check(name: &str, text: &str, loader: &dyn Loader, options: &Options) -> Checked {
    let mut sources = Sources::default();
    let mut faults = Vec::new();
    let imports = imports::load(name, text, loader, &mut sources, &mut faults);
    let unread = unread_lines(&sources, &faults);
    let files: Vec<PlanFile> = sources
        .iter()
        .map(|(_, file)| PlanFile {
            name: file.name.clone(),
            text: file.text.clone(),
        })
        .collect();
    let settings = expressions::parameters::read_settings(
        &mut sources,
        &imports.asts,
        &options.settings,
        &mut faults,
    );
    let scope = Scope::collect(&imports.asts, &settings, &mut faults);
    let mut checker = Checker::new(&sources, &scope, loader, faults, unread, imports.incomplete);
    let plan = plan(&mut checker, name, files, options);
    let rig_links = rig::links_of_run(&checker, options.rig.as_deref());
    let mut diagnostics = checker.faults;
    let misspelt: Vec<Span> = imports
        .asts
        .iter()
        .flat_map(|ast| ast.misspelt.iter().copied())
        .collect();
    // What follows from a fault that was told at the same place is not told again.
    let at =
        |fault: &Diagnostic, places: &[Span]| fault.span().is_some_and(|at| touches(at, places));
    diagnostics.retain(|fault| is_of_the_text(fault) || !at(fault, &misspelt));
    let mut explained = checker.explained;
    explained.sort_unstable();
    diagnostics.retain(|fault| fault.code != Code::UnknownName || !at(fault, &explained));
    diagnostics.sort_by_key(|fault| fault.span().map(|span| (span.file, span.start, span.end)));
    let plan = plan.filter(|_| !diagnostics.iter().any(Diagnostic::is_error));
    messages::cap(&mut diagnostics);
    Checked {
        plan,
        diagnostics,
        sources,
        rig_links,
    }
}

fn is_of_the_text(fault: &Diagnostic) -> bool {
    fault.code.id().starts_with("E1")
}

/// Whether a place has a character in common with one of those, which are in order.
fn touches(place: Span, places: &[Span]) -> bool {
    let before =
        places.partition_point(|other| (other.file, other.start) < (place.file, place.end));
    before
        .checked_sub(1)
        .and_then(|last| places.get(last))
        .is_some_and(|last| last.file == place.file && place.start < last.end)
}

/// The lines at which the text could not be read.
fn unread_lines(sources: &Sources, faults: &[Diagnostic]) -> Vec<Span> {
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
    let labels = faults
        .iter()
        .filter(|fault| is_of_the_text(fault))
        .flat_map(|fault| &fault.labels);
    labels.map(|label| line(label.span)).collect()
}

fn plan(
    checker: &mut Checker,
    name: &str,
    files: Vec<PlanFile>,
    options: &Options,
) -> Option<Plan> {
    checker.recorded = options.recorded;
    checker.real_rig = rig::real_rig_of_run(checker, options.rig.as_deref());
    for block in 0..checker.scope.blocks.len() {
        checker.entries_of(block);
    }
    let (title, particulars) =
        declarations::plan_block::plan_block(checker, options.date.as_deref());
    if options.unattended {
        rig::real::attended(checker, &particulars);
    }
    let parameters = checker.parameters();
    let of_kind = |checker: &Checker, kind| {
        checker
            .scope
            .of_kind(kind)
            .map(|(index, _)| index)
            .collect::<Vec<_>>()
    };
    let specimens: Vec<_> = of_kind(checker, Kind::Specimen)
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
    procedures::hold_specimen(checker, &procedures);
    procedures::hold_axes(checker, &procedures, &specimens, rig.as_ref());
    // Of two `limits` nobody knows which holds.
    if let Some(limits) = limits
        .as_ref()
        .filter(|_| !checker.scope.twice.contains(&Kind::Limits))
    {
        declarations::limits::hold_start(checker, limits);
        declarations::limits::hold_targets(checker, limits);
        slices::hold_limits(checker, &procedures, limits);
    }
    let declared = Declared {
        specimens: &specimens,
        strikers: &strikers,
        grounds: &grounds,
    };
    for (block, procedure) in &procedures {
        if let Some(procedure) = procedure {
            slices::judge(checker, *block, &procedure.kind, &declared);
        }
    }
    let requirements = checker.requirements();
    let by_place: Vec<Option<Procedure>> = procedures
        .iter()
        .map(|(_, procedure)| procedure.clone())
        .collect();
    let report = declarations::report::report(checker, &by_place);
    let golden = declarations::golden::golden(checker);
    if !checker.faults.iter().any(Diagnostic::is_error) {
        let head = checker
            .scope
            .of_kind(Kind::Plan)
            .map(|(_, block)| block.block.head)
            .next();
        let head = head.unwrap_or_else(|| Span::new(FileId(0), 0, 0));
        if let Some(rig) = &rig {
            rig::real::warn(checker, rig);
            rig::drift::warn(checker, rig);
        }
        if let Some(limits) = &limits {
            declarations::specimen::warn_of_short_tables(checker, &specimens, limits);
        }
        if let Some(report) = &report {
            declarations::print::warn(checker, report);
        }
        slices::hold_reads(checker, &procedures);
        let rule = declarations::plan_block::decision_rule(&particulars);
        warnings::left::warn(checker, &procedures, requirements.as_deref().unwrap_or(&[]));
        warnings::guarded::warn(
            checker,
            &procedures,
            requirements.as_deref().unwrap_or(&[]),
            rule,
        );
        warnings::whole_plan(
            checker,
            &procedures,
            requirements.as_deref().unwrap_or(&[]),
            &grounds,
            head,
        );
    }
    let mut settings: std::collections::BTreeMap<String, String> =
        std::collections::BTreeMap::new();
    settings.extend(options.settings.iter().cloned());
    let rig_block = rig.as_ref().and_then(|rig| rig.block);
    let plan = Plan {
        title: title.unwrap_or_else(|| stem(name).to_owned()),
        parameters,
        specimens: specimens.into_iter().collect::<Option<_>>()?,
        strikers: strikers.into_iter().collect::<Option<_>>()?,
        grounds: grounds.into_iter().collect::<Option<_>>()?,
        rig: rig?.plan,
        limits: limits?.limits,
        procedures: by_place.into_iter().collect::<Option<_>>()?,
        requirements: requirements?,
        decision_rule: declarations::plan_block::decision_rule(&particulars),
        particulars,
        report: report?,
        golden: golden?,
        rehearses: None,
        unloads_at_once: false,
        files: [files, checker.data_files()].concat(),
        settings: settings.into_iter().collect(),
    };
    if !checker.faults.iter().any(Diagnostic::is_error) {
        let blocks: Vec<usize> = procedures.iter().map(|(block, _)| *block).collect();
        warnings::tracking::warn(checker, &plan, &blocks, rig_block);
        warnings::record_size::fits(checker, &plan, &blocks);
    }
    Some(plan)
}

/// `plans/beam.psd` is `beam`.
fn stem(name: &str) -> &str {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    file.strip_suffix(".psd").unwrap_or(file)
}
