//! The history of an `escalate`: every impact as an impact history.

use crate::record::{ImpactHistory, NamedResult, Rest, StruckFrame};
use crate::uncertainty::Contribution;

/// One impact.
#[derive(Clone, Debug)]
pub struct SeriesImpact {
    /// V0, m/s
    pub velocity: f64,
    /// ½ Ms V0², J
    pub energy: f64,
    /// The results of an impact, in the order of the schema.
    pub results: Vec<NamedResult>,
    pub history: ImpactHistory,
    /// Whether the condition was satisfied. None if the impact was not completed or was not conclusive.
    pub held: Option<bool>,
    /// The position and force of the specimen after it: the next impact begins there.
    pub rest: Option<Rest>,
}

impl SeriesImpact {
    /// All floors, if a frame was struck.
    #[must_use]
    pub const fn storey(&self) -> Option<&StruckFrame> {
        self.history.frame.as_ref()
    }

    /// One of its results.
    #[must_use]
    pub fn result(&self, name: &str) -> Option<&NamedResult> {
        NamedResult::of(&self.results, name)
    }

    /// A number among its results.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.result(name)?.value.number()
    }

    /// A list among its results.
    #[must_use]
    pub fn list(&self, name: &str) -> Option<&[f64]> {
        self.result(name)?.value.list()
    }

    /// Displacement \[m\] and force \[N\] of the struck floor after it.
    #[must_use]
    pub fn rest_of_struck(&self) -> Option<(f64, f64)> {
        let struck = self.storey().map_or(0, |history| history.struck);
        self.rest.as_ref().map(|rest| rest.of(struck))
    }

    /// The uncertainty contributions of both.
    #[must_use]
    pub fn rest_contributions(&self) -> Option<[Vec<Contribution>; 2]> {
        let struck = self.storey().map_or(0, |history| history.struck);
        self.rest
            .as_ref()
            .map(|rest| rest.contributions_at_floor(struck))
    }
}

/// A series of impacts, in their order.
#[derive(Clone, Debug, Default)]
pub struct EscalateHistory {
    pub impacts: Vec<SeriesImpact>,
}

impl EscalateHistory {
    /// The impacts on a frame, one by one; none for one degree of freedom.
    pub fn storeys(&self) -> impl Iterator<Item = &StruckFrame> {
        self.impacts.iter().filter_map(SeriesImpact::storey)
    }
}
