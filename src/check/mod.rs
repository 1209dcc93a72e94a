//! Syntax tree → plan, all errors at once. In: the text of the plan and a [`Loader`] for the files it uses.
//! Out: a [`Checked`].

mod arrival;
mod axes;
mod axis_devices;
mod behaviour;
mod calendar;
mod call;
mod checker;
mod choice;
mod curve;
mod cycle;
mod damping_sweep;
mod data;
mod device;
mod dialect;
mod drift;
mod escalate;
mod expression;
mod faults;
mod fields;
mod fits;
mod frame;
mod golden;
mod ground;
mod ground_record;
mod guarded;
mod impact;
mod imports;
mod inspect;
mod integrator;
mod left;
mod limits;
mod literal;
mod matrix;
mod mode;
mod move_block;
mod names;
mod parameters;
mod plan_block;
mod portal;
mod print;
mod procedures;
mod real_rig;
mod record_size;
mod report;
mod require;
mod rig;
mod scope;
mod shake;
mod specimen;
mod stepping;
mod stiffness_ramp;
mod storey_impact;
mod striker;
mod table_file;
#[cfg(test)]
mod tests;
pub mod tracking;
mod unload;
mod warnings;

pub use checker::{DEEPEST_VALUES, MOST_TERMS};
pub use ground_record::MOST_SAMPLES as MOST_GROUND_SAMPLES;
pub use imports::{DEEPEST, MOST_FILES};
pub use literal::MOST_ENTRIES;
pub use stiffness_ramp::MOST_READINGS;

use crate::diagnostic::{Code, Diagnostic};
use crate::plan::{BlowOn, Plan, PlanFile, Procedure, ProcedureKind, Specimen};
use crate::schema::Kind;
use crate::source::{FileId, Sources, Span};
use checker::Checker;
use scope::Scope;

/// Gives the text of used files. Paths are relative to the plan's folder, with `/`, already free of `..`.
pub trait Loader {
    /// # Errors
    /// Why the file cannot be used.
    fn load(&self, path: &str) -> Result<String, LoadFault>;
}

/// Why a used file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadFault {
    NotFound,
    /// A folder, device, link out of the folder, too large, no UTF-8: the reason for a person.
    Refused(String),
}

/// What the command line says of the plan.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `--rig NAME`
    pub rig: Option<String>,
    /// `--set name=value`, in order.
    pub settings: Vec<(String, String)>,
    /// `--date`, ISO 8601.
    pub date: Option<String>,
    /// A run is to begin, the command line names nobody, and nobody can be asked.
    pub unattended: bool,
    /// The plan is of a record: names of older versions are read.
    pub recorded: bool,
}

/// The outcome of a check. `plan` is there if no error stands.
#[derive(Debug)]
pub struct Checked {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
    /// Where the rig of the run says how it is reached; empty for the ideal one.
    pub rig_links: Vec<Span>,
}

/// Checks a plan and all it uses.
#[must_use]
pub fn check(name: &str, text: &str, loader: &dyn Loader, options: &Options) -> Checked {
    let mut sources = Sources::default();
    let mut faults = Vec::new();
    let imports = imports::load(name, text, loader, &mut sources, &mut faults);
    let unread = unread_lines(&sources, &faults);
    let files: Vec<PlanFile> =
        sources.iter().map(|(_, file)| PlanFile { name: file.name.clone(), text: file.text.clone() }).collect();
    let settings = parameters::read_settings(&mut sources, &imports.asts, &options.settings, &mut faults);
    let scope = Scope::collect(&imports.asts, &settings, &mut faults);
    let mut checker = Checker::new(&sources, &scope, loader, faults, unread, imports.incomplete);
    let plan = plan(&mut checker, name, files, options);
    let rig_links = rig::links_of_run(&checker, options.rig.as_deref());
    let mut diagnostics = checker.faults;
    let misspelt: Vec<Span> = imports.asts.iter().flat_map(|ast| ast.misspelt.iter().copied()).collect();
    // What follows from a fault that was told at the same place is not told again.
    let at = |fault: &Diagnostic, places: &[Span]| fault.span().is_some_and(|at| touches(at, places));
    diagnostics.retain(|fault| is_of_the_text(fault) || !at(fault, &misspelt));
    let mut explained = checker.explained;
    explained.sort_unstable();
    diagnostics.retain(|fault| fault.code != Code::UnknownName || !at(fault, &explained));
    diagnostics.sort_by_key(|fault| fault.span().map(|span| (span.file, span.start, span.end)));
    let plan = plan.filter(|_| !diagnostics.iter().any(Diagnostic::is_error));
    faults::cap(&mut diagnostics);
    Checked { plan, diagnostics, sources, rig_links }
}

fn is_of_the_text(fault: &Diagnostic) -> bool {
    fault.code.id().starts_with("E1")
}

/// Whether a place has a character in common with one of those, which are in order.
fn touches(place: Span, places: &[Span]) -> bool {
    let before = places.partition_point(|other| (other.file, other.start) < (place.file, place.end));
    before.checked_sub(1).and_then(|last| places.get(last)).is_some_and(|last| last.file == place.file && place.start < last.end)
}

/// The lines at which the text could not be read.
fn unread_lines(sources: &Sources, faults: &[Diagnostic]) -> Vec<Span> {
    let line = |span: Span| {
        let text = &sources.file(span.file).text;
        let (start, end) = (text.floor_char_boundary(span.range().start), text.floor_char_boundary(span.range().end));
        let first = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let last = text[end..].find('\n').map_or(text.len(), |newline| end + newline);
        Span::new(span.file, first, last)
    };
    let labels = faults.iter().filter(|fault| is_of_the_text(fault)).flat_map(|fault| &fault.labels);
    labels.map(|label| line(label.span)).collect()
}

fn plan(checker: &mut Checker, name: &str, files: Vec<PlanFile>, options: &Options) -> Option<Plan> {
    checker.recorded = options.recorded;
    checker.real_rig = rig::real_rig_of_run(checker, options.rig.as_deref());
    for block in 0..checker.scope.blocks.len() {
        checker.entries_of(block);
    }
    let (title, particulars) = plan_block::plan_block(checker, options.date.as_deref());
    if options.unattended {
        real_rig::attended(checker, &particulars);
    }
    let parameters = checker.parameters();
    let of_kind = |checker: &Checker, kind| checker.scope.of_kind(kind).map(|(index, _)| index).collect::<Vec<_>>();
    let specimens: Vec<_> =
        of_kind(checker, Kind::Specimen).into_iter().map(|block| specimen::specimen(checker, block)).collect();
    let strikers: Vec<_> = of_kind(checker, Kind::Striker).into_iter().map(|block| striker::striker(checker, block)).collect();
    let grounds: Vec<_> = of_kind(checker, Kind::Ground).into_iter().map(|block| ground::ground(checker, block)).collect();
    let mut rig = rig::rig_of_run(checker, options.rig.as_deref());
    let limits = checker.limits(rig.as_ref().and_then(|rig| rig.limits));
    real_rig::complete(checker, rig.as_mut(), limits.as_ref());
    let procedures = procedures::procedures(checker);
    procedures::hold_specimen(checker, &procedures);
    procedures::hold_axes(checker, &procedures, &specimens, rig.as_ref());
    // Of two `limits` nobody knows which holds.
    if let Some(limits) = limits.as_ref().filter(|_| !checker.scope.twice.contains(&Kind::Limits)) {
        limits::hold_start(checker, limits);
        limits::hold_targets(checker, limits);
        limits::hold_cycles(checker, &procedures, limits);
    }
    for (block, procedure) in &procedures {
        if let Some(Procedure { kind: ProcedureKind::Impact(impact), .. }) = procedure
            && let Some(Some(striker)) = strikers.get(impact.striker)
        {
            impact::judge(checker, *block, impact, striker, specimens.get(impact.specimen).and_then(Option::as_ref));
            arrival::hold(checker, *block, striker, impact.duration.constant());
        }
        if let Some(Procedure { kind: ProcedureKind::Escalate(escalate), .. }) = procedure
            && let BlowOn::Specimen(impact) = &escalate.blow
            && let Some(Some(striker)) = strikers.get(impact.striker)
        {
            let specimen = specimens.get(impact.specimen).and_then(Option::as_ref);
            impact::judge(checker, *block, impact, &escalate.fastest(striker), specimen);
            arrival::hold(checker, *block, &escalate.slowest(striker), impact.duration.constant());
        }
        if let Some(Procedure { kind: ProcedureKind::StoreyImpact(impact), .. }) = procedure
            && let Some(Some(Specimen { frame: Some(frame), .. })) = specimens.get(impact.specimen)
            && let Some(Some(striker)) = strikers.get(impact.striker)
        {
            storey_impact::judge(checker, *block, impact, frame, striker);
            arrival::hold(checker, *block, striker, impact.duration.constant());
        }
        if let Some(Procedure { kind: ProcedureKind::Escalate(escalate), .. }) = procedure
            && let BlowOn::Storey(impact) = &escalate.blow
            && let Some(Some(Specimen { frame: Some(frame), .. })) = specimens.get(impact.specimen)
            && let Some(Some(striker)) = strikers.get(impact.striker)
        {
            storey_impact::judge(checker, *block, impact, frame, &escalate.fastest(striker));
            arrival::hold(checker, *block, &escalate.slowest(striker), impact.duration.constant());
        }
        if let Some(Procedure { kind: ProcedureKind::Shake(shaking), .. }) = procedure
            && let Some(Some(Specimen { frame: Some(frame), .. })) = specimens.get(shaking.specimen)
            && let Some(Some(ground)) = grounds.get(shaking.ground)
        {
            shake::judge(checker, *block, shaking, frame, ground);
        }
    }
    let requirements = checker.requirements();
    let by_place: Vec<Option<Procedure>> = procedures.iter().map(|(_, procedure)| procedure.clone()).collect();
    let report = report::report(checker, &by_place);
    let golden = golden::golden(checker);
    if !checker.faults.iter().any(Diagnostic::is_error) {
        let head = checker.scope.of_kind(Kind::Plan).map(|(_, block)| block.block.head).next();
        let head = head.unwrap_or_else(|| Span::new(FileId(0), 0, 0));
        if let Some(rig) = &rig {
            real_rig::warn(checker, rig);
            drift::warn(checker, rig);
        }
        if let Some(limits) = &limits {
            specimen::warn_of_short_tables(checker, &specimens, limits);
        }
        if let Some(report) = &report {
            print::warn(checker, report);
        }
        fits::hold(checker, &procedures);
        fits::hold_entries(checker, &procedures);
        let rule = plan_block::decision_rule(&particulars);
        left::warn(checker, &procedures, requirements.as_deref().unwrap_or(&[]));
        guarded::warn(checker, &procedures, requirements.as_deref().unwrap_or(&[]), rule);
        warnings::whole_plan(checker, &procedures, requirements.as_deref().unwrap_or(&[]), &grounds, head);
    }
    let mut settings: std::collections::BTreeMap<String, String> = std::collections::BTreeMap::new();
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
        decision_rule: plan_block::decision_rule(&particulars),
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
        tracking::warn(checker, &plan, &blocks, rig_block);
        record_size::fits(checker, &plan, &blocks);
    }
    Some(plan)
}

/// `plans/beam.psd` is `beam`.
fn stem(name: &str) -> &str {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    file.strip_suffix(".psd").unwrap_or(file)
}
