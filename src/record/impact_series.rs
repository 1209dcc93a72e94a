//! What an `escalate` records: every blow as an impact of its own.

use super::{ImpactHistory, NamedResult, Rest, StruckFrame};
use crate::plan::formula::ResultValue;
use crate::uncertainty::Contribution;

/// One blow.
#[derive(Clone, Debug)]
pub struct Blow {
    /// V0, m/s
    pub velocity: f64,
    /// ½ Ms V0², J
    pub energy: f64,
    /// Those of an impact, in the schema's order.
    pub results: Vec<NamedResult>,
    pub history: ImpactHistory,
    /// Whether the condition held; None where the blow did not run to its end, or decided nothing.
    pub held: Option<bool>,
    /// Where the specimen was brought to after it, and what it carries there: the next blow begins there.
    pub rest: Option<Rest>,
}

impl Blow {
    /// The striker and what it strikes, step by step; of a frame, the struck floor.
    #[must_use]
    pub const fn impact(&self) -> &ImpactHistory {
        &self.history
    }

    /// All floors, where a frame was struck.
    #[must_use]
    pub const fn storey(&self) -> Option<&StruckFrame> {
        self.history.frame.as_ref()
    }

    /// A number among its results.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        match self
            .results
            .iter()
            .find(|result| result.name == name)?
            .value
        {
            ResultValue::Number { value, .. } => value,
            ResultValue::List(_) => None,
        }
    }

    /// A list among its results.
    #[must_use]
    pub fn list(&self, name: &str) -> Option<&[f64]> {
        match &self
            .results
            .iter()
            .find(|result| result.name == name)?
            .value
        {
            ResultValue::List(values) => Some(values),
            ResultValue::Number { .. } => None,
        }
    }

    /// Displacement (m) and force (N) after it, of the struck floor.
    #[must_use]
    pub fn rest_of_struck(&self) -> Option<(f64, f64)> {
        let struck = self.storey().map_or(0, |history| history.struck);
        self.rest.as_ref().map(|rest| rest.of(struck))
    }

    /// What is uncertain of both.
    #[must_use]
    pub fn doubts_of_rest(&self) -> Option<[Vec<Contribution>; 2]> {
        let struck = self.storey().map_or(0, |history| history.struck);
        self.rest.as_ref().map(|rest| rest.doubts_of(struck))
    }
}

/// A row of blows, in the order struck.
#[derive(Clone, Debug, Default)]
pub struct EscalateHistory {
    pub blows: Vec<Blow>,
}

impl EscalateHistory {
    /// The blows on a frame, blow by blow; none where one degree of freedom is struck.
    pub fn storeys(&self) -> impl Iterator<Item = &StruckFrame> {
        self.blows.iter().filter_map(Blow::storey)
    }
}
