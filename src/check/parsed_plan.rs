//! A plan that is parsed once and checked as often as its parameters take other values. In: the text of the plan and of its files. Out:
//! checked plans. After the first check it reads no file. Other numbers of its inputs: `binding`.

use std::collections::BTreeMap;

use crate::codes::E666;
use psd_language::check::checker::{Checker, End};
use psd_language::check::expressions::data_file::DataFile;
use psd_language::check::expressions::overrides::LocatedSetting;
use psd_language::check::expressions::parameters::read_settings;
use psd_language::check::scope::{Scope, Setting};
use psd_language::check::wording::shown;
use psd_language::check::{imports, rig};
use psd_language::codes::{E107, W733};
use psd_language::syntax::ast::Ast;
use psd_language::syntax::limits::ERRORS;
use psd_plan::schema::Kind;
use psd_plan::{Plan, PlanFile};
use psd_text::diagnostic::{Code, Diagnostic, Severity, Violation};
use psd_text::source::{Sources, Span};

use super::driver::{self, Findings, PlanParts, PlanText};
use super::{Checked, Loader, Options};

/// Checks a plan and all it uses.
#[must_use]
pub fn check(name: &str, text: &str, loader: &Loader<'_>, options: &Options) -> Checked {
    ParsedPlan::parse(name, text, loader, options).check(loader)
}

/// The syntax trees of a plan and its files, with everything else that does not change when a parameter does.
pub struct ParsedPlan {
    name: String,
    options: Options,
    /// Every file that was parsed, and every `--set`.
    sources: Sources,
    pub(super) trees: Vec<Ast>,
    files: Vec<PlanFile>,
    pub(super) settings: BTreeMap<String, Setting>,
    /// Errors that were found before any check.
    pub(super) errors: Vec<Diagnostic>,
    /// Lines that could not be parsed.
    unread: Vec<Span>,
    /// Whether some file could not be read, so that names may be missing.
    incomplete: bool,
    /// The data files that the last check with a loader read.
    pub(super) data: Vec<DataFile>,
}

/// Most ends of inputs at which a plan is checked: each is a check of its own.
const MOST_ENDS: usize = 64;

/// What a check is made with.
pub(super) struct Given<'a> {
    pub scope: &'a Scope<'a>,
    /// Errors that were found before.
    pub errors: Vec<Diagnostic>,
    /// Values of fields from outside the plan.
    pub settings: &'a [LocatedSetting<'a>],
    /// The numbers that are bound, by their inputs, SI.
    pub bound: &'a [f64],
    /// The texts of `--set`.
    pub written: &'a [(String, String)],
    pub loader: &'a Loader<'a>,
    pub data: Vec<DataFile>,
    pub findings: Findings,
}

/// The findings of one check.
pub(super) struct Outcome {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    data: Vec<DataFile>,
    ends: Vec<End>,
    tails: Vec<End>,
}

/// Keeps the first diagnostics of many, errors before warnings, and counts the others.
fn cap(diagnostics: &mut Vec<Diagnostic>) {
    let errors = diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.is_error())
        .count();
    let mut left = [ERRORS, ERRORS.saturating_sub(errors)];
    let mut out: Vec<Diagnostic> = Vec::new();
    for diagnostic in std::mem::take(diagnostics) {
        let left = &mut left[usize::from(!diagnostic.is_error())];
        if *left > 0 {
            *left -= 1;
            diagnostics.push(diagnostic);
        } else {
            out.push(diagnostic);
        }
    }
    let Some(first) = out
        .iter()
        .find(|diagnostic| diagnostic.is_error())
        .or(out.first())
    else {
        return;
    };
    let one = if first.is_error() {
        Severity::Error
    } else {
        Severity::Warning
    };
    let message = format!(
        "{} more errors are not listed (at most {ERRORS})",
        out.len()
    );
    let more = Diagnostic {
        severity: one,
        ..Diagnostic::new(E107, message)
    };
    let more = first
        .span()
        .into_iter()
        .fold(more, |more, span| more.at(span, "first unlisted error"));
    diagnostics.push(more.help("correct the listed errors first"));
}

/// `value`: an end of the distribution or intensity `name`, at which the plan has the error `reason`. `help`: [`INSIDE`] or [`ENDS`].
struct InvalidEnd<'a> {
    name: &'a str,
    value: &'a str,
    reason: &'a Diagnostic,
    span: Span,
    help: &'a str,
}

impl Violation for InvalidEnd<'_> {
    const CODE: Code = E666;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            value,
            reason,
            span,
            help,
        } = self;
        let message = format!(
            "the plan has an error where `{name}` is {value}: {}",
            reason.message
        );
        let diagnostic = Diagnostic::new(Self::CODE, message).at(span, "reaches this value");
        let cause = reason.labels.iter().filter(|label| label.span != span);
        cause
            .take(1)
            .fold(diagnostic, |diagnostic, label| {
                diagnostic.at(label.span, "invalid there")
            })
            .help(help)
    }
}

/// `value`: one draw of `name` in 1000 is beyond it, and the plan has the error `reason` there.
#[derive(Violation)]
#[violation(
    W733,
    "one run in 1000 or more has no result, where `{name}` is beyond {value}: {}",
    reason.message
)]
#[help("{}", help)]
struct RunsWithoutResult<'a> {
    name: &'a str,
    value: &'a str,
    reason: &'a Diagnostic,
    #[label("reaches this value")]
    span: Span,
    help: &'a str,
}

impl ParsedPlan {
    /// Parses a plan, the files that it uses, and the values of `--set`.
    #[must_use]
    pub fn parse(name: &str, text: &str, loader: &Loader<'_>, options: &Options) -> Self {
        let mut sources = Sources::default();
        let mut errors = Vec::new();
        let imports = imports::load(name, text, loader, &mut sources, &mut errors);
        let unread = driver::unread_lines(&sources, &errors);
        let files = sources
            .iter()
            .map(|(_, file)| PlanFile {
                name: file.name.clone(),
                text: file.text.as_str().into(),
            })
            .collect();
        let settings = read_settings(&mut sources, &imports.asts, &options.settings, &mut errors);
        Self {
            name: name.to_owned(),
            options: options.clone(),
            sources,
            trees: imports.asts,
            files,
            settings,
            errors,
            unread,
            incomplete: imports.incomplete,
            data: Vec::new(),
        }
    }

    /// Checks the plan as it is written, with the values of `--set`. Keeps the data files that the plan names for [`Self::bind`].
    pub fn check(&mut self, loader: &Loader<'_>) -> Checked {
        let mut errors = self.errors.clone();
        let scope = Scope::collect(&self.trees, &self.settings, &mut errors);
        let given = Given {
            scope: &scope,
            errors,
            settings: &LocatedSetting::all(&scope, &self.settings),
            bound: &[],
            written: &self.written_settings(),
            loader,
            data: Vec::new(),
            findings: Findings::WarningsToo,
        };
        let mut rigs = Vec::new();
        let mut rig_links = Vec::new();
        let mut outcome = self.evaluate(given, &mut PlanParts::default(), None, |checker| {
            let declared = checker.scope.of_kind(Kind::Rig);
            rigs.extend(declared.filter_map(|(_, block)| Some(block.name?.node.clone())));
            rig_links = rig::links_of_run(checker, self.options.rig.as_deref());
        });
        self.data = std::mem::take(&mut outcome.data);
        self.try_ends(&mut outcome);
        cap(&mut outcome.diagnostics);
        Checked {
            plan: outcome.plan,
            diagnostics: outcome.diagnostics,
            sources: self.sources.clone(),
            rigs,
            rig_links,
        }
    }

    /// Whether the plan is valid at the ends of the inputs of its studies, and at values that one draw in 1000 exceeds. Not where a value is set: a run of a study is one point, and the
    /// ends of the other inputs do not matter there.
    fn try_ends(&self, outcome: &mut Outcome) {
        if outcome.plan.is_none() || !self.settings.is_empty() {
            return;
        }
        let mut reported = Vec::new();
        for end in outcome.ends.iter().take(MOST_ENDS) {
            let value = BTreeMap::from([(end.name.clone(), end.value)]);
            let Err(errors) = self.bind(&value) else {
                continue;
            };
            if let Some(first) = errors.first().filter(|_| !reported.contains(&end.span)) {
                reported.push(end.span);
                let shown = end.value.in_plan_syntax();
                let diagnostic = InvalidEnd {
                    name: &end.name,
                    value: &shown,
                    reason: first,
                    span: end.span,
                    help: end.help,
                }
                .diagnostic();
                outcome.diagnostics.push(diagnostic);
            }
        }
        if !reported.is_empty() {
            outcome.plan = None;
        }
        for tail in outcome.tails.iter().take(MOST_ENDS) {
            if reported.contains(&tail.span) {
                continue;
            }
            let value = BTreeMap::from([(tail.name.clone(), tail.value)]);
            if let Some(first) = self.bind(&value).err().iter().flatten().next() {
                reported.push(tail.span);
                let shown = shown(tail.value.value, tail.value.dimension);
                let diagnostic = RunsWithoutResult {
                    name: &tail.name,
                    value: &shown,
                    reason: first,
                    span: tail.span,
                    help: tail.help,
                }
                .diagnostic();
                outcome.diagnostics.push(diagnostic);
            }
        }
        if !reported.is_empty() {
            outcome
                .diagnostics
                .sort_by_key(|found| found.span().map(|span| (span.file, span.start, span.end)));
        }
    }

    /// The texts of `--set`, in order of their names; if several have one name, the last.
    pub(super) fn written_settings(&self) -> Vec<(String, String)> {
        let settings: BTreeMap<_, _> = self.options.settings.iter().cloned().collect();
        settings.into_iter().collect()
    }

    /// Checks the trees. With the parts and the plan of a check before, only what bound values reach. `also` asks the checker afterwards.
    pub(super) fn evaluate(
        &self,
        given: Given<'_>,
        parts: &mut PlanParts,
        before: Option<Plan>,
        also: impl FnOnce(&Checker<'_>),
    ) -> Outcome {
        let mut checker = Checker::new(
            &self.sources,
            given.scope,
            given.loader,
            given.errors,
            self.unread.clone(),
            self.incomplete,
        );
        checker.data = given.data;
        checker.bound = given.bound;
        checker.real_rig = rig::real_rig_of_run(&checker, self.options.rig.as_deref());
        checker.override_fields(given.settings);
        checker.begin_with(std::mem::take(&mut parts.values));
        let text = PlanText {
            name: &self.name,
            files: &self.files,
            settings: given.written,
        };
        let plan = driver::plan(
            &mut checker,
            parts,
            before,
            &text,
            &self.options,
            given.findings,
        );
        also(&checker);
        parts.values = checker.fixed_values();
        let misspelt = self.trees.iter().flat_map(|tree| tree.misspelt.iter());
        let misspelt: Vec<Span> = misspelt.copied().collect();
        let diagnostics = driver::reportable(checker.diagnostics, &misspelt, checker.explained);
        Outcome {
            plan: plan.filter(|_| !diagnostics.iter().any(Diagnostic::is_error)),
            diagnostics,
            data: checker.data,
            ends: checker.ends,
            tails: checker.tails,
        }
    }
}
