//! The pages of `psd explain`: each code has one, and its wrong and right plans behave as the page states.
//!
//! A page's plans are its fenced blocks. The first word after `psd` gives the kind: `wrong`, `right`, or `file="lib/a.psd"`. Such a file
//! can be used by both plans (`*` matches any digits). `name="a.md"` is the name of a plan that is not `plan.psd`. `set="speed=2 m/s"` and `rig="name"` are options of the command line. With
//! `unattended="yes"` a run begins without an operator.

use psd::language::check::{Checked, LoadError, Options, check};
use psd::language::syntax::{format, format_document, parse};
use psd::text::diagnostic::{Code, Severity};
use psd::text::markdown::is_document;
use psd::text::source::Sources;

/// Codes that do not depend on the plan alone: they are about the machine that is to run it.
const OF_THE_MACHINE: &[Code] = &[Code::DiskSpace];

/// One fenced block of a page.
struct Fence {
    info: String,
    text: String,
}

impl Fence {
    /// The value of `key="…"` in the info string.
    fn option(&self, key: &str) -> Option<&str> {
        let (_, rest) = self.info.split_once(&format!("{key}=\""))?;
        rest.split_once('"').map(|(value, _)| value)
    }

    /// The name of the plan's file.
    fn name(&self) -> &str {
        self.option("name").unwrap_or("plan.psd")
    }

    fn is(&self, word: &str) -> bool {
        self.info.split_whitespace().next() == Some(word)
    }
}

/// The fenced `psd` blocks of a page, in order.
fn fences(page: &str) -> Vec<Fence> {
    let mut found = Vec::new();
    let mut rest = page;
    while let Some((_, after)) = rest.split_once("```psd") {
        let (info, body) = after.split_once('\n').expect("a fence is a line");
        let (text, next) = body.split_once("```").expect("the fence is closed");
        found.push(Fence {
            info: info.trim().to_owned(),
            text: text.to_owned(),
        });
        rest = next;
    }
    found
}

/// The text of a file of one page.
fn file_of(page: &[Fence], path: &str) -> Result<String, LoadError> {
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
        .map(|fence| fence.text.clone())
        .ok_or(LoadError::NotFound)
}

fn checked(code: Code, kind: &str) -> Checked {
    let fences = fences(code.page());
    let plan = fences
        .iter()
        .find(|fence| fence.is(kind))
        .unwrap_or_else(|| panic!("the page of {code} has a {kind} plan"));
    let settings = plan
        .option("set")
        .and_then(|setting| setting.split_once('='));
    let options = Options {
        today: None,
        rig: plan.option("rig").map(str::to_owned),
        settings: settings
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .collect(),
        date: None,
        unattended: plan.option("unattended").is_some(),
        for_studies: false,
    };
    check(
        plan.name(),
        &plan.text,
        &|path: &str| file_of(&fences, path),
        &options,
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
    for &code in Code::ALL
        .iter()
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
    for &code in Code::ALL {
        let page = code.page();
        let title = page
            .lines()
            .next()
            .unwrap_or_default()
            .strip_prefix(&format!("# {code}: "));
        assert!(
            title.is_some_and(|title| title.len() > 3),
            "the page of {code} has no title"
        );
        let fences = fences(page);
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
    for &code in Code::ALL {
        for fence in fences(code.page()) {
            let mut sources = Sources::default();
            let file = sources.add(fence.name(), fence.text.as_str());
            let (ast, faults) = parse(&sources, file);
            if faults.is_empty() {
                let formatted = if is_document(fence.name()) {
                    format_document(&fence.text)
                } else {
                    format(&ast, &fence.text)
                };
                assert_eq!(
                    formatted, fence.text,
                    "{code}: psd fmt would change a plan of the page"
                );
            }
        }
    }
}
