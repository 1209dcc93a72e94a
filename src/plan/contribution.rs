//! Contributions to the uncertainty of a number, one per source. Sources are independent: numbers that share a source are correlated
//! accordingly (JCGM 100:2008, 5.2 and F.1.2.3). In: contributions. Out: standard uncertainties.

use super::source::Source;

/// The effect of one source on one number. For [`Source::TimeStep`] it is the difference from the value of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    pub source: Source,
    /// Index of the number in a list result, from 0; 0 for a result that is one number.
    pub entry: usize,
    /// Change of the number when the source is perturbed by its standard uncertainty, in the unit of the number.
    pub amount: f64,
    /// Whether the response of the number to the source is smooth. If not, `amount` is the largest change that was found.
    pub smooth: bool,
}

impl Contribution {
    #[must_use]
    pub const fn new(source: Source, amount: f64) -> Self {
        Self {
            source,
            entry: 0,
            amount,
            smooth: true,
        }
    }

    /// One of each source that has an effect.
    #[must_use]
    pub fn of_each(parts: impl IntoIterator<Item = (Source, f64)>) -> Vec<Self> {
        let parts = parts.into_iter().filter(|(_, amount)| *amount != 0.0);
        parts
            .map(|(source, amount)| Self::new(source, amount))
            .collect()
    }

    /// Its part of u²; 0 for the time step.
    #[must_use]
    pub fn variance(&self) -> f64 {
        if self.source.is_of_uncertainty() {
            self.amount * self.amount
        } else {
            0.0
        }
    }
}

/// Adds `part` to the contribution of the same source in `parts`: the contributions of one source to one number are summed.
pub fn share(parts: &mut Vec<Contribution>, part: Contribution) {
    match parts
        .iter_mut()
        .find(|known| known.source == part.source && known.entry == part.entry)
    {
        Some(known) => {
            known.amount += part.amount;
            known.smooth &= part.smooth;
        }
        None => parts.push(part),
    }
}

/// u of each of `count` entries of a list; None for an entry without contributions.
#[must_use]
pub fn combined_entries(contributions: &[Contribution], count: usize) -> Vec<Option<f64>> {
    let mut squares = vec![None; count];
    for part in contributions {
        if let Some(square) = squares.get_mut(part.entry) {
            *square = Some(square.unwrap_or(0.0) + part.variance());
        }
    }
    squares
        .into_iter()
        .map(|square: Option<f64>| square.map(f64::sqrt))
        .collect()
}

/// u = √Σ cᵢ² of independent contributions to one number (JCGM 100:2008, eq. 10); None without contributions.
#[must_use]
pub fn combined(contributions: &[Contribution]) -> Option<f64> {
    let variance = contributions
        .iter()
        .map(Contribution::variance)
        .reduce(|sum, square| sum + square)?;
    Some(variance.sqrt())
}
