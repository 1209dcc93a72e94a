//! A page of `psd explain`: its text, its plans and its cases. In: the text of `explain/CODE.md`. Out: what a reader is shown, and every
//! plan block with its options and its position. It does not know the language of a plan.

use std::ops::Range;

/// The heading above the cases of a page. No reader of `psd explain` sees what follows it.
const CASES: &str = "\n## Cases\n";

/// A page. Its plans are its code blocks marked `psd`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page<'a> {
    /// The page for a reader: everything before its cases.
    pub shown: &'a str,
    /// The plans that a reader is shown.
    pub plans: Vec<PagePlan<'a>>,
    /// The plans below the heading `## Cases`.
    pub cases: Vec<PagePlan<'a>>,
}

/// One `psd` block of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PagePlan<'a> {
    /// The heading `### …` above the block. Empty: none.
    pub heading: &'a str,
    /// The words after `psd`.
    pub info: &'a str,
    pub text: &'a str,
    /// The bytes of the text in the page.
    pub range: Range<usize>,
    /// The line of the page on which the text begins, from 1.
    pub line: usize,
}

impl<'a> Page<'a> {
    #[must_use]
    pub fn read(page: &'a str) -> Self {
        let end = page.find(CASES).map_or(page.len(), |at| at + 1);
        let (plans, cases) = plans_of(page)
            .into_iter()
            .partition(|plan: &PagePlan<'_>| plan.range.start < end);
        Self {
            shown: &page[..end],
            plans,
            cases,
        }
    }

    /// The title: the first line without the code.
    #[must_use]
    pub fn title(&self) -> &'a str {
        let heading = self.shown.lines().next().unwrap_or_default();
        heading.split_once(": ").map_or("", |(_, title)| title)
    }

    /// The shown plan whose first word is `kind`.
    #[must_use]
    pub fn plan(&self, kind: &str) -> Option<&PagePlan<'a>> {
        self.plans.iter().find(|plan| plan.is(kind))
    }
}

impl<'a> PagePlan<'a> {
    /// The value of `key="…"` among the words after `psd`.
    #[must_use]
    pub fn option(&self, key: &str) -> Option<&'a str> {
        let mut words = self.info.split('"');
        while let (Some(before), Some(value)) = (words.next(), words.next()) {
            if before.split_whitespace().next_back()?.strip_suffix('=') == Some(key) {
                return Some(value);
            }
        }
        None
    }

    /// Whether `kind` is the first word after `psd`.
    #[must_use]
    pub fn is(&self, kind: &str) -> bool {
        self.info.split_whitespace().next() == Some(kind)
    }
}

/// Every `psd` block, in order. A block without an end reaches to the end of the page.
fn plans_of(page: &str) -> Vec<PagePlan<'_>> {
    let mut plans = Vec::new();
    let mut heading = "";
    let mut open: Option<(&str, usize, usize)> = None;
    let mut in_block = false;
    let mut at = 0;
    for (index, whole) in page.split_inclusive('\n').enumerate() {
        let (begin, line) = (at, whole.trim_end_matches('\n'));
        at += whole.len();
        if in_block {
            if line == "```" {
                in_block = false;
                plans.extend(
                    open.take()
                        .map(|(info, start, line)| plan(page, heading, info, start..begin, line)),
                );
            }
        } else if let Some(info) = line.strip_prefix("```") {
            in_block = true;
            open = info
                .strip_prefix("psd")
                .map(|info| (info.trim(), at, index + 2));
        } else if let Some(name) = line.strip_prefix("### ") {
            heading = name;
        }
    }
    plans
        .extend(open.map(|(info, start, line)| plan(page, heading, info, start..page.len(), line)));
    plans
}

fn plan<'a>(
    page: &'a str,
    heading: &'a str,
    info: &'a str,
    range: Range<usize>,
    line: usize,
) -> PagePlan<'a> {
    PagePlan {
        heading,
        info,
        text: &page[range.clone()],
        range,
        line,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# E202: unknown field\n\nWhy.\n\n```psd wrong rig=\"bench\" set=\"a=2 m\"\nbad\n```\n\n```text\n```\n\n## Cases\n\n### a field\n\n```psd with=\"beam\"\none\ntwo\n```\n";

    #[test]
    fn a_page_is_its_text_its_plans_and_its_cases() {
        let page = Page::read(PAGE);
        assert_eq!(page.title(), "unknown field");
        assert!(page.shown.ends_with("```text\n```\n\n"));
        let wrong = page.plan("wrong").unwrap();
        assert_eq!((wrong.text, wrong.line, wrong.heading), ("bad\n", 6, ""));
        assert_eq!(wrong.option("set"), Some("a=2 m"));
        assert_eq!(wrong.option("rig"), Some("bench"));
        assert_eq!(wrong.option("ig"), None);
        assert!(page.plan("right").is_none());
        let case = &page.cases[0];
        assert_eq!(
            (case.heading, case.text, case.line),
            ("a field", "one\ntwo\n", 17)
        );
        assert_eq!(&PAGE[case.range.clone()], case.text);
        assert_eq!(page.cases.len(), 1);
    }

    #[test]
    fn a_page_without_cases_is_shown_whole() {
        let page = Page::read("# E1: a\n\n```psd right\nopen\n");
        assert_eq!(page.shown.len(), 27);
        assert_eq!(page.plan("right").unwrap().text, "open\n");
        assert!(page.cases.is_empty());
    }
}
