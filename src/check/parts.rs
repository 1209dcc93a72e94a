//! The parts of a plan that is checked again and again with other bound values. In: a part, and how it is checked. Out: the part, checked
//! again only if a bound value reaches it. It knows no particular part.

use psd_language::check::checker::{Checker, Traced};
use psd_plan::formula::ResultReference;
use psd_text::source::Span;

/// Parts of one kind in the order of the plan, such as its specimens.
pub struct Parts<T> {
    pub checked: Vec<T>,
    /// What each part reads; None if a bound value reaches it, or if it has findings.
    fixed: Vec<Option<Reads>>,
}

/// The results that a part reads.
struct Reads {
    results: Vec<(ResultReference, Span)>,
    entries: Vec<(ResultReference, usize, Span)>,
}

impl<T> Default for Parts<T> {
    fn default() -> Self {
        Self {
            checked: Vec::new(),
            fixed: Vec::new(),
        }
    }
}

impl<T> Parts<T> {
    /// Checks the part with this number, the next one or an earlier one. One that is fixed is as it was.
    pub fn check(
        &mut self,
        number: usize,
        checker: &mut Checker,
        work: impl FnOnce(&mut Checker) -> T,
    ) {
        if let Some(Some(reads)) = self.fixed.get(number) {
            checker.read.extend_from_slice(&reads.results);
            checker.list_entries_read.extend_from_slice(&reads.entries);
            return;
        }
        let [found, results, entries] = checker.left_behind();
        let Traced { value, is_bound } = checker.traced(work);
        let is_fixed = !is_bound && checker.diagnostics.len() == found;
        let fixed = is_fixed.then(|| Reads {
            results: checker.read[results..].to_vec(),
            entries: checker.list_entries_read[entries..].to_vec(),
        });
        if number == self.checked.len() {
            self.checked.push(value);
            self.fixed.push(fixed);
        } else {
            self.checked[number] = value;
            self.fixed[number] = fixed;
        }
    }

    /// Checks the part of each of these blocks.
    pub fn check_each(
        &mut self,
        blocks: &[usize],
        checker: &mut Checker,
        work: impl Fn(&mut Checker, usize) -> T,
    ) {
        for (number, block) in blocks.iter().enumerate() {
            self.check(number, checker, |checker| work(checker, *block));
        }
    }

    /// Whether no bound value reaches any of them.
    pub fn are_fixed(&self) -> bool {
        self.fixed.iter().all(Option::is_some)
    }

    /// All of them are checked again next time.
    pub fn release(&mut self) {
        self.fixed.fill_with(|| None);
    }
}
