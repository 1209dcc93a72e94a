//! The pages of `psd explain`: each code has one, and its wrong and right plans behave as the page states.
//!
//! The first word after `psd` gives the kind of a plan: `wrong`, `right`, or `file="lib/a.psd"`. Such a file can be used by both plans
//! (`*` matches any digits). `name="a.md"` is the name of a plan that is not `plan.psd`. The other options: `explain_pages.rs`.

use psd::check::{Checked, LoadError, check};
use psd::codes::E629;
use psd_language::syntax::{format, format_document, parse};
use psd_text::diagnostic::page::{Page, PagePlan};
use psd_text::diagnostic::{Code, Severity};
use psd_text::markdown::is_document;
use psd_text::source::Sources;

use super::explain_pages::{options_of, page_text};

/// Codes that do not depend on the plan alone: they are about the machine that is to run it.
const OF_THE_MACHINE: &[Code] = &[E629];

/// The name of the plan's file.
fn name_of<'a>(plan: &PagePlan<'a>) -> &'a str {
    plan.option("name").unwrap_or("plan.psd")
}

/// The text of a file of one page.
fn file_of(page: &[PagePlan<'_>], path: &str) -> Result<String, LoadError> {
    let holds = |pattern: &str| match pattern.split_once('*') {
        Some((head, tail)) => path
            .strip_prefix(head)
            .and_then(|rest| rest.strip_suffix(tail))
            .is_some_and(|middle| {
                !middle.is_empty() && middle.bytes().all(|byte| byte.is_ascii_digit())
            }),
        None => path == pattern,
    };
    page.iter()
        .find(|fence| fence.option("file").is_some_and(holds))
        .map(|fence| fence.text.to_owned())
        .ok_or(LoadError::NotFound)
}

fn checked(code: Code, kind: &str) -> Checked {
    let text = page_text(code);
    let page = Page::read(&text);
    let plan = page
        .plan(kind)
        .unwrap_or_else(|| panic!("the page of {code} has a {kind} plan"));
    check(
        name_of(plan),
        plan.text,
        &|path: &str| file_of(&page.plans, path),
        &options_of(plan),
    )
}

/// `E202 unknown field …` of each diagnostic, for the message of a failing test.
fn diagnostics_of(checked: &Checked) -> Vec<String> {
    checked
        .diagnostics
        .iter()
        .map(|diagnostic| format!("{}: {}", diagnostic.code, diagnostic.message))
        .collect()
}

/// Every code for which `holds` fails, with the actual result.
fn faults_of(kind: &str, holds: impl Fn(Code, &Checked) -> bool) -> Vec<String> {
    let mut faults = Vec::new();
    for code in psd::codes::all()
        .into_iter()
        .filter(|code| !OF_THE_MACHINE.contains(code))
    {
        let checked = checked(code, kind);
        if !holds(code, &checked) {
            faults.push(format!(
                "{code}, {kind} plan: {:?}",
                diagnostics_of(&checked)
            ));
        }
    }
    faults
}

#[test]
fn every_page_starts_with_its_code_and_has_one_wrong_and_one_right_plan_where_a_plan_gives_it() {
    for code in psd::codes::all() {
        let text = page_text(code);
        let title = text
            .lines()
            .next()
            .unwrap_or_default()
            .strip_prefix(&format!("# {code}: "));
        assert!(
            title.is_some_and(|title| title.len() > 3),
            "the page of {code} has no title"
        );
        let fences = Page::read(&text).plans;
        let plans = usize::from(!OF_THE_MACHINE.contains(&code));
        for kind in ["wrong", "right"] {
            assert_eq!(
                fences.iter().filter(|fence| fence.is(kind)).count(),
                plans,
                "{kind} plans on the page of {code}"
            );
        }
        let other = fences.iter().find(|fence| {
            !fence.is("wrong") && !fence.is("right") && fence.option("file").is_none()
        });
        assert!(
            other.is_none(),
            "the page of {code} has a plan that is neither wrong, right nor a file"
        );
    }
}

#[test]
fn the_wrong_plan_of_a_page_gives_its_code_and_no_other() {
    let faults = faults_of("wrong", |code, checked| {
        let relevant: Vec<Code> = match code.severity() {
            Severity::Error => checked
                .diagnostics
                .iter()
                .filter(|it| it.is_error())
                .map(|it| it.code)
                .collect(),
            Severity::Warning => checked.diagnostics.iter().map(|it| it.code).collect(),
        };
        relevant == [code] && checked.plan.is_none() == (code.severity() == Severity::Error)
    });
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_right_plan_of_a_page_gives_no_error_and_not_the_code() {
    let faults = faults_of("right", |code, checked| {
        checked.plan.is_some()
            && checked
                .diagnostics
                .iter()
                .all(|diagnostic| !diagnostic.is_error() && diagnostic.code != code)
    });
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_plans_of_the_pages_are_written_as_the_formatter_writes_them() {
    for code in psd::codes::all() {
        for fence in Page::read(&page_text(code)).plans {
            let mut sources = Sources::default();
            let file = sources.add(name_of(&fence), fence.text);
            let (ast, faults) = parse(&sources, file);
            if faults.is_empty() {
                let formatted = if is_document(name_of(&fence)) {
                    format_document(fence.text)
                } else {
                    format(&ast, fence.text)
                };
                assert_eq!(
                    formatted, fence.text,
                    "{code}: psd fmt would change a plan of the page"
                );
            }
        }
    }
}
