//! The cases below `## Cases` on the pages of `psd explain`: each is a plan with what psd finds in it. `cargo xtask
//! generate language` writes what psd finds now into the pages.

use std::fs;
use std::ops::Range;
use std::sync::LazyLock;

use psd::check::{Checked, check, no_files};
use psd::codes::{W740, W741};
use psd_text::diagnostic::page::{Page, PagePlan};
use psd_text::diagnostic::{Code, Severity};
use similar::TextDiff;

use super::annotated::{annotated, plain};
use super::{exit_code, play, verdict_lines};
use crate::explain_pages::{FOLDER, options_of, page_path, page_text, shared_text};

/// A case of a page.
pub struct PageCase {
    /// The code of its page.
    pub code: Code,
    /// Its heading, which distinguishes it from the other cases of the page.
    pub name: String,
    /// Its plan, without the shared plans before it.
    pub plan: String,
    /// The lines of the shared plans before it.
    before: usize,
    pub checked: Checked,
    /// The plan as the page has it, and where.
    written: String,
    range: Range<usize>,
    line: usize,
}

impl PageCase {
    fn read(code: Code, written: &PagePlan<'_>, shared: &Page<'_>) -> Self {
        let plan = plain(written.text);
        let before = shared_plans(written, shared);
        let text = format!("{before}{plan}");
        Self {
            code,
            name: written.heading.to_owned(),
            before: before.lines().count(),
            checked: check("plan.psd", &text, &no_files, &options_of(written)),
            plan,
            written: written.text.to_owned(),
            range: written.range.clone(),
            line: written.line,
        }
    }

    /// The plan with what psd finds, and how its run ends.
    fn found(&self) -> String {
        let played = play(&self.checked);
        let end = played
            .as_ref()
            .map_or_else(String::new, |(record, assessment)| {
                verdict_lines(record, assessment)
            });
        let Checked {
            diagnostics,
            sources,
            ..
        } = &self.checked;
        annotated(&self.plan, self.before, diagnostics, sources, &end)
            .unwrap_or_else(|error| panic!("{}: {error}", self.place(self.line)))
    }

    /// `src/…/E202.md:64 (unknown field)`
    fn place(&self, line: usize) -> String {
        format!("{FOLDER}/{}.md:{line} ({})", self.code, self.name)
    }
}

/// The names of the shared plans that a case begins with: `with="beam, hammer"`.
fn shared_names<'a>(written: &PagePlan<'a>) -> impl Iterator<Item = &'a str> {
    let names = written.option("with").unwrap_or_default();
    names.split(", ").filter(|name| !name.is_empty())
}

/// The shared plans that a case begins with, each with an empty line after it.
fn shared_plans(written: &PagePlan<'_>, shared: &Page<'_>) -> String {
    let text = |name: &str| {
        let plan = shared
            .plans
            .iter()
            .find(|plan| plan.option("shared") == Some(name));
        plan.unwrap_or_else(|| panic!("no plan `{name}` is shared"))
            .text
    };
    shared_names(written)
        .flat_map(|name| [text(name), "\n"])
        .collect()
}

/// Every case of every page.
pub static PAGE_CASES: LazyLock<Vec<PageCase>> = LazyLock::new(|| {
    let shared = shared_text();
    let shared = Page::read(&shared);
    let mut cases = Vec::new();
    for code in psd::codes::all() {
        let text = page_text(code);
        let page = Page::read(&text);
        cases.extend(
            page.cases
                .iter()
                .map(|written| PageCase::read(code, written, &shared)),
        );
    }
    cases
});

#[test]
fn the_cases_of_a_page_have_what_psd_finds_below_the_lines_where_it_finds_it() {
    let writes = std::env::var_os("PSD_BLESS").is_some();
    let mut differences = Vec::new();
    for code in psd::codes::all() {
        let mut page = page_text(code);
        // From the last to the first: a change moves what follows it.
        for case in PAGE_CASES.iter().filter(|case| case.code == code).rev() {
            let found = case.found();
            if found != case.written {
                let difference = TextDiff::from_lines(&case.written, &found);
                let difference = difference.unified_diff().header("page", "psd").to_string();
                let same = case.written.lines().zip(found.lines());
                let same = same.take_while(|(written, found)| written == found);
                let line = case.line + same.count();
                differences.push(format!("{}\n{difference}", case.place(line)));
                page.replace_range(case.range.clone(), &found);
            }
        }
        if writes {
            fs::write(page_path(code), page).expect("the page can be written");
        }
    }
    assert!(
        differences.is_empty() || writes,
        "cargo xtask generate language accepts what psd finds:\n\n{}",
        differences.join("\n")
    );
}

#[test]
fn a_case_gives_the_code_of_its_page_and_nothing_that_follows_from_it() {
    let mut faults = Vec::new();
    for case in PAGE_CASES.iter() {
        let code = case.code;
        let found = &case.checked.diagnostics;
        let relevant = found
            .iter()
            .filter(|it| code.severity() != Severity::Error || it.is_error());
        let given: Vec<Code> = relevant.map(|diagnostic| diagnostic.code).collect();
        if given != [code] {
            faults.push(format!("{}: {given:?}", case.place(case.line)));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_case_of_an_error_has_no_plan_and_a_case_of_a_warning_runs_and_meets_its_requirements() {
    for case in PAGE_CASES.iter() {
        let exit = exit_code(play(&case.checked).as_ref());
        let expected = match case.code {
            // The warnings of a dry run predict that the run does not.
            W740 | W741 => exit == 4 || exit == 1,
            code if code.severity() == Severity::Error => exit == 2,
            _ => exit == 0,
        };
        assert!(expected, "{}: {exit}", case.place(case.line));
    }
}

#[test]
fn the_cases_of_a_page_have_names_of_their_own() {
    let cases = &PAGE_CASES;
    for (index, case) in cases.iter().enumerate() {
        let same = |other: &PageCase| other.code == case.code && other.name == case.name;
        assert!(!case.name.is_empty(), "{}", case.place(case.line));
        assert!(
            !cases[..index].iter().any(same),
            "{}: twice",
            case.place(case.line)
        );
    }
}

#[test]
fn every_shared_plan_is_used() {
    let pages: Vec<String> = psd::codes::all()
        .iter()
        .map(|code| page_text(*code))
        .collect();
    let pages: Vec<Page<'_>> = pages.iter().map(|text| Page::read(text)).collect();
    let cases = pages.iter().flat_map(|page| &page.cases);
    let used: Vec<&str> = cases.flat_map(shared_names).collect();
    let shared = shared_text();
    for plan in Page::read(&shared).plans {
        let name = plan.option("shared").expect("a shared plan has a name");
        assert!(used.contains(&name), "no case begins with `{name}`");
    }
}
