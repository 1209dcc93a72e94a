//! A result of a procedure as a run finds it: with or without uncertainty, as a number or a list. A number that is not finite does not
//! exist in the run.

use crate::formula::ResultValue;
use crate::record::NamedResult;
use crate::schema::ResultKind;
use crate::uncertainty::{Contribution, combined};

impl ResultKind {
    /// This result without uncertainty; None if it does not exist in this run.
    pub fn found(self, value: Option<f64>) -> NamedResult {
        self.found_with(value.map(|value| (value, None)))
    }

    /// This result with its standard uncertainty, if it has one. One that is not finite is withheld.
    pub fn found_with(self, value: Option<(f64, Option<f64>)>) -> NamedResult {
        let value = value.filter(|(value, _)| value.is_finite());
        let own = value.and_then(|(_, uncertainty)| uncertainty);
        let mut result = self.holding(ResultValue::Number {
            value: value.map(|(value, _)| value),
            uncertainty: own,
        });
        if own.is_some_and(|own| !own.is_finite()) {
            result.withhold(NOT_DETERMINED);
        }
        result
    }

    /// This result with the uncertainty that its contributions combine to.
    pub fn found_by(self, value: Option<f64>, contributions: Vec<Contribution>) -> NamedResult {
        let mut result = self.found_with(value.map(|value| (value, combined(&contributions))));
        if result.withheld.is_none() {
            result.contributions = contributions;
        }
        result
    }

    /// This result as a list; None if it does not exist in this run.
    pub fn found_list(self, values: Option<Vec<f64>>) -> NamedResult {
        match values {
            Some(values) => self.holding(ResultValue::List(values)),
            None => self.found(None),
        }
    }

    /// This result as a list with the contributions to its entries.
    pub fn found_list_by(
        self,
        values: Option<Vec<f64>>,
        contributions: Vec<Contribution>,
    ) -> NamedResult {
        NamedResult {
            contributions,
            ..self.found_list(values)
        }
    }

    const fn holding(self, value: ResultValue) -> NamedResult {
        NamedResult {
            name: self.name,
            value,
            dimension: self.dimension,
            contributions: Vec::new(),
            withheld: None,
        }
    }
}

/// Why a fitted result has no standard error.
const NOT_DETERMINED: &str = "its readings do not determine its standard error";
