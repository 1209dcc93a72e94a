//! Results of procedures, as formulas read them. In: a reference to a result. Out: its value and its contributions, or both with one
//! source perturbed.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::contribution::Contribution;
use super::source::{ProcedureId, Source};

/// Which number of a result is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultPart {
    Value,
    /// `.u`, the standard uncertainty.
    Uncertainty,
}

/// A result of a procedure: `k0.stiffness`, `k0.stiffness.u`. `name` is the schema's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResultReference {
    pub procedure: ProcedureId,
    pub name: &'static str,
    pub part: ResultPart,
}

/// The value of a result: one number or a list, with the standard uncertainty of a number that was measured.
#[derive(Clone, Debug, PartialEq)]
pub enum ResultValue {
    /// `value` is None where the result does not exist in this run (no stop time: the striker did not stop).
    Number {
        value: Option<f64>,
        uncertainty: Option<f64>,
    },
    List(Vec<f64>),
}

impl ResultValue {
    /// The number; None for a list, and if it does not exist in this run.
    #[must_use]
    pub const fn number(&self) -> Option<f64> {
        match self {
            Self::Number { value, .. } => *value,
            Self::List(_) => None,
        }
    }

    /// The entries of a list; None for a number.
    #[must_use]
    pub fn list(&self) -> Option<&[f64]> {
        match self {
            Self::Number { .. } => None,
            Self::List(values) => Some(values),
        }
    }

    /// The entries of a list, or the number if it exists in this run.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Number { value, .. } => value.as_slice(),
            Self::List(values) => values,
        }
    }
}

/// What a run knows of the uncertainty of a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UncertaintyStatus {
    /// By definition it has none: a count, a number that describes the run. Also a result that does not exist.
    Exact,
    /// Every declared source is in it: it has an expanded uncertainty U.
    Known,
    /// The plan does not declare what it requires, so that it has no U. The text says what.
    Partial(String),
    /// Its uncertainty could not be evaluated, however large it is. The text gives the reason.
    Withheld(String),
}

impl UncertaintyStatus {
    /// The status of a number that reads both: the one that knows less, of equals the first.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let rank = |status: &Self| match status {
            Self::Exact => 0,
            Self::Known => 1,
            Self::Partial(_) => 2,
            Self::Withheld(_) => 3,
        };
        if rank(&other) > rank(&self) {
            other
        } else {
            self
        }
    }
}

/// The results that formulas read.
pub trait Results: Sync {
    /// Other results, of which these give another view: what a view does not state is theirs.
    fn base(&self) -> Option<&dyn Results> {
        None
    }

    /// The result, or None if its procedure has not run to it.
    fn result(&self, reference: ResultReference) -> Option<ResultValue>;

    /// The uncertainty contributions of the result; by default its whole uncertainty is one separate contribution.
    fn contributions(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
        if let Some(base) = self.base() {
            return base.contributions(reference);
        }
        let ResultReference {
            procedure, name, ..
        } = reference;
        match self.result(reference) {
            Some(ResultValue::Number {
                uncertainty: Some(own),
                ..
            }) => {
                let result = Source::Fit {
                    procedure,
                    result: name,
                };
                vec![Contribution::new(result, own)].into()
            }
            _ => Cow::default(),
        }
    }

    /// Degrees of freedom of the uncertainty of a source; infinite if it was not estimated from readings.
    fn degrees(&self, source: Source) -> f64 {
        self.base()
            .map_or(f64::INFINITY, |base| base.degrees(source))
    }

    /// The perturbation of a source, in its standard uncertainties.
    fn moved(&self, source: Source) -> f64 {
        self.base().map_or(0.0, |base| base.moved(source))
    }

    /// What is known of the uncertainty of the result, or of one entry of a list; by default it is exact.
    fn uncertainty_status(
        &self,
        reference: ResultReference,
        entry: Option<usize>,
    ) -> UncertaintyStatus {
        self.base().map_or(UncertaintyStatus::Exact, |base| {
            base.uncertainty_status(reference, entry)
        })
    }
}

/// No procedure has run: constants only.
pub struct NoResults;

impl Results for NoResults {
    fn result(&self, _: ResultReference) -> Option<ResultValue> {
        None
    }
}

/// Results as they would be with these sources perturbed, each by so many of its standard uncertainties.
pub struct Moved<'a> {
    pub results: &'a dyn Results,
    pub shifts: &'a [(Source, f64)],
}

impl Results for Moved<'_> {
    fn base(&self) -> Option<&dyn Results> {
        Some(self.results)
    }

    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let mut found = self.results.result(reference)?;
        if reference.part != ResultPart::Value {
            return Some(found);
        }
        let parts = self.results.contributions(reference);
        for (source, by) in self.shifts {
            for part in parts.iter().filter(|part| part.source == *source) {
                let value = match &mut found {
                    ResultValue::Number { value, .. } => value.as_mut(),
                    ResultValue::List(values) => values.get_mut(part.entry),
                };
                if let Some(value) = value {
                    *value += by * part.amount;
                }
            }
        }
        Some(found)
    }

    fn moved(&self, source: Source) -> f64 {
        let mine = self.shifts.iter().filter(|(shifted, _)| *shifted == source);
        mine.fold(self.results.moved(source), |moved, (_, by)| moved + by)
    }
}

/// Results of which some are read once for each source: value and contributions of these are found once. In finer steps, a value is a
/// sum over its contributions.
pub struct ReadOnce<'a> {
    results: &'a dyn Results,
    found: Vec<Found<'a>>,
}

struct Found<'a> {
    reference: ResultReference,
    value: Option<ResultValue>,
    contributions: Cow<'a, [Contribution]>,
}

impl<'a> ReadOnce<'a> {
    #[must_use]
    pub fn new(references: &[ResultReference], results: &'a dyn Results) -> Self {
        let found = |reference: &ResultReference| Found {
            reference: *reference,
            value: results.result(*reference),
            contributions: results.contributions(*reference),
        };
        Self {
            results,
            found: references.iter().map(found).collect(),
        }
    }

    fn found(&self, reference: ResultReference) -> Option<&Found<'a>> {
        self.found.iter().find(|found| found.reference == reference)
    }
}

impl Results for ReadOnce<'_> {
    fn base(&self) -> Option<&dyn Results> {
        Some(self.results)
    }

    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        match self.found(reference) {
            Some(found) => found.value.clone(),
            None => self.results.result(reference),
        }
    }

    fn contributions(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
        match self.found(reference) {
            Some(found) => Cow::Borrowed(&found.contributions),
            None => self.results.contributions(reference),
        }
    }
}

/// Every source of the results that are read, each once, in the order of their first appearance.
#[must_use]
pub fn sources_of(references: &[ResultReference], results: &dyn Results) -> Vec<Source> {
    let (mut sources, mut known) = (Vec::new(), BTreeSet::new());
    for reference in references
        .iter()
        .filter(|reference| reference.part == ResultPart::Value)
    {
        let parts = results.contributions(*reference);
        let first = parts
            .iter()
            .filter(|part| part.amount != 0.0 && known.insert(part.source));
        sources.extend(first.map(|part| part.source));
    }
    sources
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contribution::{combined, combined_entries, share};
    use crate::formula::{Formula, Operator};

    /// Slope and intercept of one line, and a separate number.
    struct OneLine;

    const CORRELATION: f64 = -0.8;

    const fn reference(name: &'static str) -> ResultReference {
        ResultReference {
            procedure: ProcedureId(0),
            name,
            part: ResultPart::Value,
        }
    }

    const fn source(result: &'static str) -> Source {
        Source::Fit {
            procedure: ProcedureId(0),
            result,
        }
    }

    impl Results for OneLine {
        fn result(&self, reference: ResultReference) -> Option<ResultValue> {
            let (value, uncertainty) = match reference.name {
                "stiffness" => (100.0, 2.0),
                "intercept_force" => (5.0, 0.5),
                _ => (7.0, 0.3),
            };
            Some(ResultValue::Number {
                value: Some(value),
                uncertainty: Some(uncertainty),
            })
        }

        fn contributions(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
            match reference.name {
                "stiffness" => vec![Contribution::new(source("stiffness"), 2.0)].into(),
                "intercept_force" => vec![
                    Contribution::new(source("stiffness"), 0.5 * CORRELATION),
                    Contribution::new(source("intercept_force"), 0.5 * 0.6),
                ]
                .into(),
                name => vec![Contribution::new(source(name), 0.3)].into(),
            }
        }
    }

    /// R = K·x + R₀ at x: u² = x²u(K)² + u(R₀)² + 2x·r·u(K)·u(R₀) (JCGM 100:2008, eq. 16), not their plain sum.
    #[test]
    fn numbers_of_one_fit_are_correlated() {
        let line = |x: f64| {
            let slope = Formula::Binary(
                Operator::Multiply,
                Box::new(Formula::Result(reference("stiffness"))),
                Box::new(Formula::Constant(x)),
            );
            Formula::Binary(
                Operator::Add,
                Box::new(slope),
                Box::new(Formula::Result(reference("intercept_force"))),
            )
        };
        for x in [0.0, 0.1, 0.2, 1.0] {
            let by_hand = (4.0 * x * x + 0.25 + 2.0 * x * CORRELATION * 2.0 * 0.5_f64).sqrt();
            let u = line(x)
                .evaluate(&OneLine, None)
                .unwrap()
                .uncertainty
                .unwrap();
            assert!((u - by_hand).abs() < 1e-12, "at {x}: {u} {by_hand}");
        }
        // The contributions of independent sources are combined.
        let other = Formula::Binary(
            Operator::Add,
            Box::new(line(0.0)),
            Box::new(Formula::Result(reference("mass"))),
        );
        let u = other.evaluate(&OneLine, None).unwrap().uncertainty.unwrap();
        assert!((u - 0.5_f64.hypot(0.3)).abs() < 1e-12);
    }

    /// The contributions of one source are summed before they are squared, separately for each entry of a list.
    #[test]
    fn what_shares_a_source_adds_up_entry_by_entry() {
        let of = |entry, amount| Contribution {
            entry,
            ..Contribution::new(source("stiffness"), amount)
        };
        let mut parts = Vec::new();
        for part in [
            of(0, 3.0),
            of(1, 1.0),
            of(0, 1.0),
            Contribution::new(source("mass"), 3.0),
        ] {
            share(&mut parts, part);
        }
        assert_eq!(parts.len(), 3);
        assert_eq!(combined_entries(&parts, 3), [Some(5.0), Some(1.0), None]);
    }

    #[test]
    fn a_moved_source_moves_what_it_is_in_and_nothing_else() {
        let moved = Moved {
            results: &OneLine,
            shifts: &[(source("stiffness"), -0.5)],
        };
        let value = |name| match moved.result(reference(name)) {
            Some(ResultValue::Number {
                value: Some(value), ..
            }) => value,
            other => panic!("{other:?}"),
        };
        assert_eq!(
            (value("stiffness"), value("intercept_force"), value("mass")),
            (99.0, 5.2, 7.0)
        );
        assert_eq!(
            sources_of(
                &[reference("intercept_force"), reference("stiffness")],
                &OneLine
            )
            .len(),
            2
        );
        assert_eq!(combined(&[]), None);
    }
}
